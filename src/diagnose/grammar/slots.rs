//! A place of the scene where a law may act, and a slot: that place with a variable that the law depends on.

use super::acting::{Action, injected};
use super::addresses::addresses;
use super::reading::Reading;
use super::shaped::ending;
use super::shapes::{MORE_SHAPES, MORE_SHAPES_OF_ONE_RUN, Shape};
use crate::diagnose::case::Case;
use crate::diagnose::fit::Placed;
use crate::laws::{Address, PORTS, Port, QUANTITIES, Quantity};

/// A law before it has a shape: where it acts, and on what it depends.
#[derive(Clone, Debug)]
pub struct Slot {
    pub address: String,
    pub port: Port,
    /// Empty for constants.
    pub variable: String,
    /// Argument of the shape.
    pub reading: Reading,
    pub(super) shapes: &'static [Shape],
    /// Scale of the variable: half of its greatest magnitude.
    pub scale: f64,
    /// Argument of the shape in each open run, and what the shape is multiplied by there.
    pub(super) series: Vec<Vec<f64>>,
    pub(super) factors: Option<Vec<Vec<f64>>>,
    pub action: Action,
    /// A constant law at the port.
    pub injected: Placed,
}

impl Slot {
    /// A slot whose shape is over a variable itself; `None` if the variable stays at zero.
    pub(super) fn plain(
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

    /// The element that its law acts on, as its port is addressed.
    pub fn element(&self) -> &str {
        self.address.rsplit_once('.').map_or(&self.address, |(element, _)| element)
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
    pub(super) fn is_clock_of_one_run(&self) -> bool {
        self.series.len() < 2 && self.variable == Quantity::Time.spec().name()
    }

    /// Whether a curve of straight pieces may be over it: of a variable itself, and of no clock that another run could not contradict.
    pub fn may_be_in_pieces(&self) -> bool {
        !self.is_constant() && self.reading == Reading::Plain && !self.is_clock_of_one_run()
    }

    pub(super) fn more_shapes(&self) -> &'static [Shape] {
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
    pub(super) fn needs_clock(&self) -> bool {
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

/// Greatest magnitude of a variable in all runs.
pub(super) fn greatest(series: &[Vec<f64>]) -> f64 {
    series.iter().flatten().fold(0.0, |most, x| most.max(x.abs()))
}

#[cfg(test)]
mod tests {
    use crate::diagnose::fit::made::Bench;
    use crate::diagnose::grammar::{Reach, SHAPES, slots};

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
