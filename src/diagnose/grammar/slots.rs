//! Slots: every port of the scene combined with every variable its law may depend on.

use super::acting::{Action, action, injected};
use super::addresses::addresses;
use super::reading::{Reading, readings};
use super::shaped::ending;
use super::shapes::{CONSTANT, MORE_SHAPES, MORE_SHAPES_OF_ONE_RUN, SHAPES, Shape};
use crate::diagnose::case::{Case, CaseChannel};
use crate::diagnose::fit::{Fit, Placed};
use crate::laws::{
    Acts, Address, Carrier, Dimension, Law, LawTable, PORTS, Port, PortSpec, QUANTITIES, Quantity, Surroundings,
};
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

/// A law before it has a shape: where it acts, and on what it depends.
#[derive(Clone, Debug)]
pub struct Slot {
    pub address: String,
    pub port: Port,
    /// Empty for constants.
    pub variable: String,
    /// Argument of the shape.
    pub reading: Reading,
    shapes: &'static [Shape],
    /// Scale of the variable: half of its greatest magnitude.
    pub scale: f64,
    /// Argument of the shape in each open run, and what the shape is multiplied by there.
    pub(super) series: Vec<Vec<f64>>,
    factors: Option<Vec<Vec<f64>>>,
    pub action: Action,
    /// A constant law at the port.
    pub injected: Placed,
}

impl Slot {
    /// A slot whose shape is over a variable itself; `None` if the variable stays at zero.
    fn plain(
        (address, port, injected): (String, Port, Placed),
        (variable, series): (String, Vec<Vec<f64>>),
        (shapes, action): (&'static [Shape], Action),
    ) -> Option<Self> {
        let scale = 0.5 * greatest(&series);
        let (reading, factors) = (Reading::Plain, None);
        (scale > 0.0).then_some(Self {
            address,
            port,
            variable,
            reading,
            shapes,
            scale,
            series,
            factors,
            action,
            injected,
        })
    }

    /// Whether its law is a constant.
    pub fn is_constant(&self) -> bool {
        self.variable.is_empty()
    }

    /// Shapes of its law.
    pub fn shapes(&self) -> &'static [Shape] {
        self.shapes
    }

    /// Shapes that differ from those before them where the variable has been: where it is positive throughout, its magnitude is the variable.
    pub fn distinct(&self, shapes: &'static [Shape]) -> Vec<&'static Shape> {
        let mut found: Vec<(&Shape, Vec<f64>)> = Vec::new();
        for shape in shapes {
            let signal = self.signal_of_all(shape, self.scale);
            if found.iter().all(|(other, known)| other.start != shape.start || *known != signal) {
                found.push((shape, signal));
            }
        }
        found.into_iter().map(|(shape, _)| shape).collect()
    }

    /// The same slot with the wider shapes, for when simple ones leave a misfit.
    pub fn bent(&self) -> Self {
        Self { shapes: self.more_shapes(), ..self.clone() }
    }

    /// The law's signal in an open run for a shape at this scale, without its size.
    pub fn signal(&self, run: usize, shape: &Shape, scale: f64) -> Vec<f64> {
        let mut signal: Vec<f64> = self.series[run].iter().map(|x| (shape.at)(x / scale)).collect();
        if let Some(factors) = &self.factors {
            signal.iter_mut().zip(&factors[run]).for_each(|(y, factor)| *y *= factor);
        }
        signal
    }

    /// The same in all open runs, one after another.
    pub fn signal_of_all(&self, shape: &Shape, scale: f64) -> Vec<f64> {
        (0..self.series.len()).flat_map(|run| self.signal(run, shape, scale)).collect()
    }

    /// Whether it is over the clock of a single run: another could not contradict it.
    pub fn is_clock_of_one_run(&self) -> bool {
        self.series.len() < 2 && self.variable == Quantity::Time.spec().name()
    }

    fn more_shapes(&self) -> &'static [Shape] {
        if self.is_clock_of_one_run() { &MORE_SHAPES_OF_ONE_RUN } else { &MORE_SHAPES }
    }

    /// Basis shapes of its curve.
    pub fn basis(&self) -> impl Iterator<Item = &'static Shape> {
        let is_constant = self.is_constant();
        // Arguments with memory and products are many: a straight line and a parabola must do.
        let most = if self.reading == Reading::Plain { usize::MAX } else { 2 };
        self.shapes().iter().filter(move |s| s.is_basis || is_constant).take(most)
    }

    /// Whether its law needs a clock: it depends on a rate or on time.
    fn needs_clock(&self) -> bool {
        let of_rate = QUANTITIES.iter().any(|q| q.quantity.is_rate() && q.name() == self.variable);
        of_rate || self.port.is_of_rate() || self.reading.needs_clock()
    }

    /// Name of the parameter that scales its variable.
    pub fn scale_name(&self) -> String {
        format!("{SCALE}{}", ending(&self.variable))
    }

    /// Name of its law.
    pub fn name(&self) -> String {
        // joint(knuckle).stiffness: joint_knuckle_stiffness.
        format!("{}{}", self.address.replace(['.', '('], "_").replace(')', ""), self.reading.word())
    }
}

/// What the scale of a law's variable is called before its unit.
pub const SCALE: &str = "scale";

impl PartialEq for Slot {
    fn eq(&self, other: &Self) -> bool {
        (&self.address, &self.variable, &self.reading) == (&other.address, &other.variable, &other.reading)
    }
}

/// A place where a law may act: a port of one element, or of all equal ones at once.
#[derive(Clone, Debug)]
pub struct Place {
    pub address: String,
    pub port: Port,
    /// A constant law there, and a clearly visible size of it.
    pub injected: Placed,
    pub typical: f64,
}

impl Place {
    /// Whether it is a port of several elements at once.
    pub fn is_of_several(&self, places: &[Self]) -> bool {
        let has_number = |place: &Self| Address::parse(&place.address).is_ok_and(|a| a.number.is_some());
        !has_number(self) && places.iter().any(|other| other.port == self.port && has_number(other))
    }
}

/// Every place of a case's scene where a law may act.
pub fn places(case: &Case) -> Vec<Place> {
    let place = |port: Port, address: String| {
        let action = Action::at(port)?;
        let injected = injected(case, &address, &action)?;
        (case.has_clock || !port.is_of_rate()).then_some(Place { address, port, injected, typical: action.typical })
    };
    PORTS.iter().flat_map(|spec| addresses(case, spec).into_iter().filter_map(|a| place(spec.port, a))).collect()
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

/// Greatest magnitude of a variable in all runs.
fn greatest(series: &[Vec<f64>]) -> f64 {
    series.iter().flatten().fold(0.0, |most, x| most.max(x.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::case::{Noise, RunSet, made};
    use crate::diagnose::fit::{Model, Problem, made::Bench};

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

    /// Time is never negative: its magnitude is time itself. A speed goes both ways.
    #[test]
    fn shapes_that_are_the_same_where_a_variable_has_been_are_one() {
        let bench = Bench::with(&[]);
        let all = slots(&bench.case, &bench.baseline(), Reach::Plain);
        let texts = |variable: &str| -> Vec<&str> {
            let slot = all.iter().find(|slot| slot.variable == variable).expect("a slot");
            slot.distinct(&SHAPES).iter().map(|shape| shape.text).collect()
        };
        assert_eq!(texts("speed_m_s").len(), SHAPES.len());
        let of_time = texts("time_s");
        assert!(of_time.contains(&"x") && of_time.contains(&"x^2"), "{of_time:?}");
        assert!(!of_time.contains(&"abs(x)") && !of_time.contains(&"x*abs(x)"), "{of_time:?}");
    }
}
