//! Every port of a scene combined with every variable that its law may depend on.

use super::acting::{Action, action, injected};
use super::addresses::addresses;
use super::reading::{Reading, readings};
use super::shapes::{CONSTANT, SHAPES};
use super::slots::{Slot, greatest};
use crate::diagnose::case::{Case, CaseChannel};
use crate::diagnose::fit::Fit;
use crate::laws::{Acts, Carrier, Dimension, Law, LawTable, PORTS, Port, PortSpec, QUANTITIES, Quantity, Surroundings};
use crate::recording::parse_column;
use crate::scene::on_channel;

/// Extent of the grammar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// A shape over a variable.
    Plain,
    /// More shapes, products of two variables, and memory.
    Wide,
    /// Nonlinear sensors: a shape over the reading.
    Channels,
}

/// Variables tried at a port without a number in the name.
fn variables(spec: &PortSpec) -> &'static [Quantity] {
    use Quantity as Q;
    match spec.carrier {
        Carrier::Muscle if spec.element == "muscle" => &[Q::Elongation, Q::Speed, Q::Pressure, Q::Time],
        Carrier::Muscle if spec.element == "plunger" => &[Q::Pressure, Q::Plunger, Q::Time],
        Carrier::Muscle => &[Q::Pressure, Q::Flow, Q::Elongation, Q::Time],
        Carrier::Cable => &[Q::Angle, Q::Tension, Q::Stretch, Q::Drive, Q::AngularSpeed, Q::Time],
        Carrier::Joint => &[Q::Angle, Q::AngularSpeed, Q::Time],
        // A curve over its stretch is what a strip's rubber laws are for.
        Carrier::Alone if spec.element == "strip" => &[Q::Time],
        Carrier::Alone => spec.variables(),
        Carrier::Sensor => &[],
    }
}

/// All slots of a case's scene within reach: variables that move in the open runs, and constants.
pub fn slots(case: &Case, from: &Fit, reach: Reach) -> Vec<Slot> {
    let mut slots = match reach {
        Reach::Plain => [over_variables(case, from), constants(case)].concat(),
        Reach::Wide => {
            let mut own = over_variables(case, from);
            let more = own.iter().flat_map(|slot| beyond(case, slot, &own)).collect::<Vec<_>>();
            own.iter_mut().for_each(|slot| slot.shapes = slot.more_shapes());
            [own, more].concat()
        }
        Reach::Channels => on_channels(case, from),
    };
    slots.retain(|slot| case.has_clock || !slot.needs_clock());
    slots
}

/// Slots with products or memory at the place of a plain one.
fn beyond(case: &Case, own: &Slot, all: &[Slot]) -> Vec<Slot> {
    let quantity = |slot: &Slot| Some(QUANTITIES.iter().find(|q| q.name() == slot.variable)?.quantity);
    let here: Vec<&Slot> = all.iter().filter(|slot| slot.address == own.address).collect();
    let known: Vec<(Quantity, f64)> = here.iter().filter_map(|s| Some((quantity(s)?, s.scale))).collect();
    let Some(variable) = quantity(own) else { return Vec::new() };
    let slot = |reading: Reading| {
        let other = reading.other().and_then(|q| here.iter().find(|slot| quantity(slot) == Some(q)));
        let runs = case.runs.iter().filter(|run| !run.is_held_out).enumerate();
        let series: Vec<Vec<f64>> = runs
            .map(|(r, run)| reading.series(&own.series[r], other.map_or(&[][..], |o| &o.series[r]), &run.drive.times_s))
            .collect();
        let factors = other.and_then(|o| o.series.iter().map(|series| reading.factor(series)).collect());
        let scale = 0.5 * greatest(&series);
        (scale > 0.0).then(|| Slot { reading, series, factors, scale, shapes: &SHAPES, ..own.clone() })
    };
    readings(variable, &known).into_iter().filter_map(slot).collect()
}

/// Slots of constants that are parameters of the rig. Those that add to the fluid or pull are left out: a steady flow or
/// pressure is physics.
pub fn constants(case: &Case) -> Vec<Slot> {
    constants_at(case, is_parameter)
}

/// Slots of steady flows, pressures and forces.
pub fn steady(case: &Case) -> Vec<Slot> {
    let mut slots = constants_at(case, |port| !is_parameter(port));
    slots.retain(|slot| case.has_clock || !slot.needs_clock());
    slots
}

fn is_parameter(port: Port) -> bool {
    port == Port::RestLength || action(port).is_some_and(|(acts, ..)| acts == Acts::Scales)
}

fn constants_at(case: &Case, is_wanted: impl Fn(Port) -> bool) -> Vec<Slot> {
    let open = || case.runs.iter().filter(|run| !run.is_held_out);
    let wanted = PORTS.iter().filter(|spec| is_wanted(spec.port));
    let each = wanted.flat_map(|spec| addresses(case, spec).into_iter().map(|a| (spec.port, a)));
    let slot = |(port, address): (Port, String)| {
        let action = Action::at(port)?;
        let injected = injected(case, &address, &action)?;
        let series = open().map(|run| vec![1.0; run.drive.times_s.len()]).collect();
        let shapes = std::slice::from_ref(&CONSTANT);
        let (variable, reading) = (String::new(), Reading::Plain);
        let factors = None;
        Some(Slot { address, port, variable, reading, shapes, scale: 1.0, series, factors, action, injected })
    };
    each.filter_map(slot).collect()
}

/// A clearly visible share of the greatest reading.
const PLAIN_ON_A_CHANNEL: f64 = 0.02;

/// Slots on sensors. A straight line is a gain, which the catalogue has.
fn on_channels(case: &Case, from: &Fit) -> Vec<Slot> {
    let open = case.runs.iter().filter(|run| !run.is_held_out);
    let shown = open.map(|run| run.rom.simulate(&run.drive, &from.model.setting(case, run, &from.x)));
    let Some(shown) = shown.collect::<Option<Vec<_>>>() else { return Vec::new() };
    let slot = |channel: &CaseChannel| {
        let unit = parse_column(&channel.column).ok()?.unit;
        let series: Vec<Vec<f64>> =
            shown.iter().map(|run| run[channel.output].iter().map(|x| unit.to_si(*x)).collect()).collect();
        let around = on_channel(&channel.column);
        let own = around.channel.filter(|d| *d != Dimension::NONE);
        let unit = own.map_or_else(|| "1".to_owned(), |d| d.to_string());
        let action = Action { acts: Acts::Adds, unit, typical: PLAIN_ON_A_CHANNEL * greatest(&series), around };
        let address = format!("sensor.{}", channel.column);
        let injected = injected(case, &address, &action)?;
        let variable = Quantity::Reading.spec().name();
        Slot::plain((address, Port::Sensor, injected), (variable, series), (&SHAPES[1..], action))
    };
    case.channels.iter().filter_map(slot).collect()
}

/// Slots whose variable moves in the open runs.
fn over_variables(case: &Case, from: &Fit) -> Vec<Slot> {
    let mut asked = Vec::new();
    for spec in PORTS.iter().filter(|spec| action(spec.port).is_some()) {
        for address in addresses(case, spec) {
            for quantity in variables(spec) {
                let variable = quantity.spec().name();
                let probe = LawTable {
                    name: "probe".to_owned(),
                    port: address.clone(),
                    adds: Some(format!("0.0 * {variable}")),
                    ..LawTable::default()
                };
                let probe = match spec.adds.is_empty() {
                    true => None,
                    false => probe.law(&Surroundings::default()).ok(),
                };
                asked.extend(probe.map(|law| (law, address.clone(), spec.port, variable)));
            }
        }
    }
    let laws: Vec<Law> = asked.iter().map(|(law, ..)| law.clone()).collect();
    let open = case.runs.iter().filter(|run| !run.is_held_out);
    let Some(visited) = open
        .map(|run| run.rom.visited(&run.drive, &from.model.setting(case, run, &from.x), &laws))
        .collect::<Option<Vec<_>>>()
    else {
        return Vec::new();
    };
    let slot = |(i, (_, address, port, variable)): (usize, (Law, String, Port, String))| {
        let series: Vec<Vec<f64>> = visited.iter().map(|run| run[i].clone()).collect();
        let action = Action::at(port)?;
        let injected = injected(case, &address, &action)?;
        Slot::plain((address, port, injected), (variable, series), (&SHAPES, action))
    };
    asked.into_iter().enumerate().filter_map(slot).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::case::{Noise, RunSet, made};
    use crate::diagnose::fit::{Model, Problem};

    /// Rows that are only counted tell an order, and no pace.
    #[test]
    fn without_a_clock_nothing_goes_by_rate() {
        let mut case = made::recorded("antagonistic_pulley", &[], &["plunger_1_mm", "plunger_2_mm"], &["angle_deg"]);
        let of_rate = |case: &Case| {
            let noise = [Noise::white(0.01)];
            let problem = Problem { case, runs: case.subset(RunSet::Open), noise: &noise };
            let fit = problem.fit(&Model::baseline(), &problem.start(&Model::baseline(), None)).expect("a fit");
            let all = slots(case, &fit, Reach::Wide);
            (all.len(), all.iter().filter(|slot| slot.needs_clock()).count())
        };
        assert!(of_rate(&case).1 > 0);
        case.has_clock = false;
        assert_eq!(of_rate(&case).1, 0);
        assert!(of_rate(&case).0 > 0);
    }
}
