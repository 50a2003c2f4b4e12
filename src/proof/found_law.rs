//! What was found of a law that nobody chose.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::ProofError;
use super::holdout::gap_on_holdout;
use super::row::read;
use crate::conceal::{DrawnLaw, Place, Remembers, Secret, Truth};
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
    let Some((secret, law)) = truth.secrets.iter().find_map(|s| Some((s, s.law?))) else { return Ok(None) };
    let path = answer.join("diagnosis.json");
    let diagnosis: Diagnosis =
        serde_json::from_str(&read(&path)?).map_err(|e| ProofError::Format { file: path, message: e.to_string() })?;
    let sought = Sought { port: law.port(truth.rig, secret.muscle), law };
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

/// A law that an answer should hold.
struct Sought {
    port: String,
    law: DrawnLaw,
}

impl Sought {
    /// Place among the forms of an answer of the first at the right port, counted from 1.
    fn port_rank(&self, effect: &NamedEffect) -> Option<usize> {
        let ports = std::iter::once(&effect.port).chain(effect.forms.iter().map(|f| &f.port));
        ports.into_iter().position(|port| *port == self.port).map(|i| i + 1)
    }

    /// The same at the right port, over the right variables.
    fn rank(&self, effect: &NamedEffect) -> Option<usize> {
        let own = (&effect.port, self.is_over(&effect.law));
        let forms = effect.forms.iter().map(|f| (&f.port, self.is_over(&f.law)));
        std::iter::once(own).chain(forms).position(|(port, is_over)| *port == self.port && is_over).map(|i| i + 1)
    }

    /// Whether a law's text reads what the hidden one does and nothing else.
    fn is_over(&self, text: &str) -> bool {
        let words = || text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
        let wanted: Vec<&str> =
            self.law.reads.iter().chain(self.law.times.iter().map(|(r, _)| r)).map(|r| r.name()).collect();
        let is_variable = |w: &&str| crate::laws::QUANTITIES.iter().any(|q| q.name() == **w);
        wanted.iter().all(|w| words().any(|x| x == *w)) && words().filter(is_variable).all(|w| wanted.contains(&w))
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
