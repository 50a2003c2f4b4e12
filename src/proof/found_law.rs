//! What was found of a law that nobody chose.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::ProofError;
use super::holdout::gap_on_holdout;
use super::row::read;
use crate::conceal::{DrawnLaw, Place, Reads, Remembers, Rig, Secret, Truth};
use crate::diagnose::{Diagnosis, NamedEffect};
use crate::laws::{Law, Symbol};
use crate::scene::Scene;

/// An answer held against a drawn law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FoundLaw {
    /// The law that was hidden, and the one that was answered, as text.
    pub hidden: String,
    pub answered: Option<String>,
    /// Of the forms that the answer calls equally good (the first is the answer itself): which one acts at the port, and which one
    /// does so over the right variable.
    pub port_rank: Option<usize>,
    pub rank: Option<usize>,
    /// How many forms there are.
    pub set_size: usize,
    /// Relative L2 distance of the answered curve from the true one: over what was visited, and over one and a half times as much.
    pub curve_error: Option<f64>,
    pub curve_error_beyond: Option<f64>,
    /// Share of the gap that is closed with more stroke.
    pub gap_larger: Option<f64>,
}

/// Holds the answer in a folder against the first law that a case hides; none where it hides none.
///
/// # Errors
/// Files that are not there or hold something else, scenes that cannot be run.
pub fn found_law(truth: &Truth, answer: &Path, larger: &Path) -> Result<Option<FoundLaw>, ProofError> {
    let Some((secret, law)) = drawn_law(truth) else { return Ok(None) };
    let path = answer.join("diagnosis.json");
    let diagnosis: Diagnosis =
        serde_json::from_str(&read(&path)?).map_err(|e| ProofError::Format { file: path, message: e.to_string() })?;
    let sought = Sought::of(law, truth.rig, secret.muscle);
    // With a second thing hidden the answer is the one that is nearest to this law.
    let named = diagnosis.effects.iter();
    let own = named.min_by_key(|e| (sought.rank(e).unwrap_or(usize::MAX), sought.port_rank(e).unwrap_or(usize::MAX)));
    let gap_larger = match larger.is_file() {
        true => Some(gap_on_holdout(truth, answer, larger)?),
        false => None,
    };
    let scene = Scene::load(&answer.join("scene.toml").display().to_string(), &[]).ok();
    let answered = own.and_then(|e| scene.as_ref()?.laws.iter().find(|l| l.address.to_string() == e.port));
    let curve = own.and_then(|e| e.curve.as_ref()).and_then(|c| Some((*c.x.first()?, *c.x.last()?)));
    let error = |beyond: f64| {
        let (low, high) = curve?;
        sought.curve_error(secret, answered?, (low, high), beyond)
    };
    Ok(Some(FoundLaw {
        hidden: law.table(truth.rig, secret.muscle, secret.size).replace('\n', "; "),
        answered: own.map(|e| format!("{} {} {}", e.port, e.acts, e.law)),
        port_rank: own.and_then(|e| sought.port_rank(e)),
        rank: own.and_then(|e| sought.rank(e)),
        set_size: own.map_or(0, |e| 1 + e.forms.len()),
        curve_error: error(1.0),
        curve_error_beyond: error(1.5),
        gap_larger,
    }))
}

/// The first drawn law that a case hides.
fn drawn_law(truth: &Truth) -> Option<(&Secret, DrawnLaw)> {
    truth.secrets.iter().find_map(|secret| Some((secret, secret.law?)))
}

/// Probability from which an answer is certain of a place.
const CERTAIN: f64 = 0.9;

/// Whether an answer is certain of the place of the law that a case hides.
pub(super) fn is_certain_of_the_law(truth: &Truth, diagnosis: &Diagnosis) -> bool {
    let Some((secret, law)) = drawn_law(truth) else { return false };
    let sought = Sought::of(law, truth.rig, secret.muscle);
    diagnosis.effects.iter().any(|e| e.probability >= CERTAIN && sought.port_rank(e) == Some(1))
}

/// A law that an answer should hold.
struct Sought {
    port: String,
    law: DrawnLaw,
    /// The ports at which the same law may be written, and the variables that it has there.
    written: Vec<(String, Vec<&'static str>)>,
}

impl Sought {
    /// The law of a part of a rig.
    fn of(law: DrawnLaw, rig: Rig, muscle: usize) -> Self {
        let port = |place: Place| place.port(rig, muscle);
        let written = law.writings().into_iter();
        let written = written.map(|w| (port(w.place), w.over.into_iter().map(Reads::name).collect()));
        Self { port: port(law.place), law, written: written.collect() }
    }

    /// Place among the forms of an answer of the first at the right port, counted from 1: the law's own, or one where it may be written too.
    fn port_rank(&self, effect: &NamedEffect) -> Option<usize> {
        self.first(effect, |port, law| port == self.port || self.is_written(port, law))
    }

    /// The same at the right port, over the right variables.
    fn rank(&self, effect: &NamedEffect) -> Option<usize> {
        self.first(effect, |port, law| self.is_written(port, law))
    }

    fn is_written(&self, port: &str, law: &str) -> bool {
        self.written.iter().any(|(own, over)| own == port && is_over(law, over, self.turns()))
            || self.is_ahead(port, law)
    }

    /// Whether a law is over how far a variable is ahead of what follows it. Where dv/dt = u, a lag r of the rate u, dr/dt = (u - r)/T, is
    /// (v - s)/T with ds/dt = (v - s)/T: the same law in other words.
    fn is_ahead(&self, port: &str, law: &str) -> bool {
        let integral = match self.law.reads {
            Some(Reads::Speed) => "elongation_m",
            Some(Reads::AngularSpeed) => "angle_rad",
            _ => return false,
        };
        let is_lag = matches!(self.law.remembers, Remembers::Lag(_)) && self.law.times.is_none();
        let value = law.split(';').next().unwrap_or(law);
        let differences = value.matches(&format!("({integral} - s)")).count();
        let is_ahead = differences > 0 && value.matches(integral).count() == differences;
        is_lag && port == self.port && is_ahead && is_over(law, &[integral], None)
    }

    /// The rate by whose sign the law may tell rising from falling: of what it reads, where it remembers anything.
    fn turns(&self) -> Option<&'static str> {
        let rate = match self.law.reads? {
            Reads::Elongation => "speed_m_s",
            Reads::Angle => "angular_speed_rad_s",
            _ => return None,
        };
        (self.law.remembers != Remembers::Nothing).then_some(rate)
    }

    /// Place of the first form, counted from 1, whose port and text are right.
    fn first(&self, effect: &NamedEffect, is_right: impl Fn(&str, &str) -> bool) -> Option<usize> {
        let forms = effect.forms.iter().map(|form| (&form.port, &form.law));
        std::iter::once((&effect.port, &effect.law))
            .chain(forms)
            .position(|(port, law)| is_right(port, law))
            .map(|i| i + 1)
    }

    /// Distance of curves of one variable without memory; what a calibrated number takes up counts as none.
    fn curve_error(&self, secret: &Secret, answered: &Law, (low, high): (f64, f64), beyond: f64) -> Option<f64> {
        let is_plain = self.law.times.is_none() && self.law.remembers == Remembers::Nothing;
        let over = answered.variables();
        let is_same = over.len() == 1 && self.law.reads.is_some_and(|r| over[0].name() == r.name());
        if !is_plain || !is_same || !answered.states.is_empty() || answered.address.to_string() != self.port {
            return None;
        }
        let one = if self.law.place.acts() == "scales" { 1.0 } else { 0.0 };
        let points = (0..=200).map(|i| beyond * (low + (high - low) * f64::from(i) / 200.0));
        let pairs: Vec<(f64, f64)> =
            points.map(|x| (one + self.law.value(secret.size, x / self.law.scale, 1.0), value(answered, x))).collect();
        let factor = if self.is_calibrated() {
            let (cross, own) = pairs.iter().fold((0.0, 0.0), |(c, o), (t, a)| (c + t * a, o + a * a));
            cross / own
        } else {
            1.0
        };
        let left: f64 = pairs.iter().map(|(t, a)| (t - factor * a).powi(2)).sum();
        let whole: f64 = pairs.iter().map(|(t, _)| (t - one).powi(2)).sum();
        Some((left / whole.max(f64::MIN_POSITIVE)).sqrt())
    }

    /// Whether a number of the scene's calibration scales the same term: a factor of the law is then that number's.
    fn is_calibrated(&self) -> bool {
        matches!(self.law.place, Place::Wall | Place::Friction | Place::SyringeCompliance)
    }
}

/// Whether a law's text reads these variables and no others; it may read `turns` as well.
fn is_over(text: &str, wanted: &[&str], turns: Option<&str>) -> bool {
    let words = || text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
    let is_variable = |w: &&str| crate::laws::QUANTITIES.iter().any(|q| q.name() == **w);
    let is_known = |w: &str| wanted.contains(&w) || turns == Some(w);
    wanted.iter().all(|w| words().any(|x| x == *w)) && words().filter(is_variable).all(is_known)
}

/// Value of a law of one variable with its own numbers.
fn value(law: &Law, x: f64) -> f64 {
    let read = |symbol: &Symbol| match symbol {
        Symbol::Parameter(p) => law.parameters[*p].value,
        Symbol::Constant(c) => *c,
        Symbol::Variable(_) | Symbol::State(_) => x,
    };
    let by_symbol: Vec<f64> = law.symbols.iter().map(read).collect();
    law.programs.value.value(&by_symbol)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conceal::Form;
    use crate::diagnose::Form as Written;

    fn sought(place: Place, reads: Reads, times: Option<Reads>, remembers: Remembers) -> Sought {
        let times = times.map(|reads| (reads, 1.0));
        let law = DrawnLaw { place, reads: Some(reads), scale: 1.0, form: Form::Constant, remembers, times };
        Sought::of(law, Rig::MuscleBench, 0)
    }

    /// The ranks of an answer whose forms act at these ports with these texts.
    fn ranks(sought: &Sought, forms: &[(&str, &str)]) -> (Option<usize>, Option<usize>) {
        let form =
            |(port, law): &(&str, &str)| Written { port: (*port).into(), law: (*law).into(), ..Written::default() };
        let mut all: Vec<Written> = forms.iter().map(form).collect();
        let Written { port, law, .. } = all.remove(0);
        let effect = NamedEffect { port, law, forms: all, ..NamedEffect::default() };
        (sought.port_rank(&effect), sought.rank(&effect))
    }

    #[test]
    fn the_first_form_at_the_right_port_over_the_right_variables_counts() {
        let wall = sought(Place::Wall, Reads::Elongation, None, Remembers::Nothing);
        let forms =
            [("muscle.coil", "1 + elongation_m"), ("muscle.wall", "1 + time_s"), ("muscle.wall", "1 - elongation_m^2")];
        assert_eq!(ranks(&wall, &forms), (Some(2), Some(3)));
        assert_eq!(ranks(&wall, &forms[..1]), (None, None));
        // Over one variable more it is another law.
        assert_eq!(ranks(&wall, &[("muscle.wall", "1 + elongation_m*pressure_pa")]), (Some(1), None));
    }

    #[test]
    fn a_law_that_remembers_may_say_so_in_any_way() {
        let lagging = sought(Place::Pull, Reads::Elongation, None, Remembers::Lag(2.0));
        let behind = [("muscle.pull", "0.1 * s; ds/dt = (elongation_m - s)/2")];
        let rising = [("muscle.pull", "0.1 * elongation_m*(speed_m_s > 0)")];
        assert_eq!((ranks(&lagging, &behind).1, ranks(&lagging, &rising).1), (Some(1), Some(1)));
        let plain = sought(Place::Pull, Reads::Elongation, None, Remembers::Nothing);
        assert_eq!(ranks(&plain, &rising).1, None);
    }

    /// What lags a speed is how far the elongation is ahead of what follows it, and nothing else is.
    #[test]
    fn a_lag_of_a_rate_is_what_a_variable_is_ahead_by() {
        let of_speed = sought(Place::Pull, Reads::Speed, None, Remembers::Lag(0.8));
        let rank = |law: &str| ranks(&of_speed, &[("muscle.pull", law)]).1;
        assert_eq!(rank("3 * ((elongation_m - s)/0.005)^2; ds/dt = (elongation_m - s)/0.8"), Some(1));
        assert_eq!(rank("3 * (s/0.005)^2; ds/dt = (elongation_m - s)/0.8"), None);
        assert_eq!(rank("3 * (elongation_m - s)*elongation_m; ds/dt = (elongation_m - s)/0.8"), None);
        let plain = sought(Place::Pull, Reads::Speed, None, Remembers::Nothing);
        assert_eq!(ranks(&plain, &[("muscle.pull", "(elongation_m - s)/0.8; ds/dt = (elongation_m - s)/0.8")]).1, None);
    }

    /// A pressure drop in proportion to the flow is a resistance; at that port over anything else it is not this law.
    #[test]
    fn the_same_law_in_other_words_counts() {
        let drop = sought(Place::PressureDrop, Reads::Time, Some(Reads::Flow), Remembers::Nothing);
        assert_eq!(ranks(&drop, &[("line.resistance", "1 + time_s")]), (Some(1), Some(1)));
        assert_eq!(ranks(&drop, &[("line.resistance", "1 + pressure_pa")]), (None, None));
        assert_eq!(ranks(&drop, &[("line.pressure_drop", "time_s")]), (Some(1), None));
    }
}
