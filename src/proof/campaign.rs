//! Which cases a proof consists of, and one case's way from a seed to an answer.

use std::fs;
use std::path::{Path, PathBuf};

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::ProofError;
use crate::conceal::{Hiding, Rig, SEALED, draw, seal, write_case};
use crate::diagnose::{Case, Options, Step, diagnose, write_answer};
use crate::files::write_whole;

/// How many cases, and from which seed they are drawn.
///
/// ```
/// use smam::conceal::Hiding;
/// use smam::proof::Plan;
///
/// let cases = Plan { hiding: 60, nothing: 60, laws: 0, seed: 1 }.cases();
/// // Half hide nothing, and so do half of any first part.
/// let nothing = |count: usize| cases[..count].iter().filter(|case| case.hiding == Hiding::Nothing).count();
/// assert_eq!((cases.len(), nothing(120), nothing(40)), (120, 60, 20));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Cases in which something is missing.
    pub hiding: usize,
    /// Cases in which nothing is.
    pub nothing: usize,
    /// Cases that hide laws which nobody chose, after the others.
    pub laws: usize,
    pub seed: u64,
}

/// A case that is planned, not yet drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Planned {
    pub name: String,
    pub rig: Rig,
    pub hiding: Hiding,
    pub seed: u64,
}

/// One case of each so many is held on a mechanism: they take longer.
const MECHANISMS_EVERY: usize = 10;

impl Plan {
    /// All cases, those without anything missing spread among the others, so that any first part of them is a fair one.
    pub fn cases(&self) -> Vec<Planned> {
        let count = self.hiding + self.nothing;
        let mut nothing_so_far = 0;
        let others = (0..count).map(|i| {
            let nothing_due = (i + 1) * self.nothing / count.max(1);
            let is_nothing = nothing_due > nothing_so_far;
            nothing_so_far = nothing_due;
            self.case(i, is_nothing)
        });
        others.chain((0..self.laws).map(|i| self.law_case(i))).collect()
    }

    /// Rigs in turn; of ten cases eight hide one law, the others two, or one beside an effect of the catalogue.
    fn law_case(&self, index: usize) -> Planned {
        let seed = !self.seed.wrapping_mul(1_000_003).wrapping_add(index as u64);
        let is_one = ChaCha8Rng::seed_from_u64(seed).random_bool(0.8);
        Planned {
            name: format!("l{}_{index:05}", self.seed),
            rig: Rig::ALL[index % Rig::ALL.len()],
            hiding: if is_one { Hiding::Law } else { Hiding::Laws },
            seed,
        }
    }

    fn case(&self, index: usize, is_nothing: bool) -> Planned {
        let seed = self.seed.wrapping_mul(1_000_003).wrapping_add(index as u64);
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let rig = match random.random_range(0..2 * MECHANISMS_EVERY) {
            0 => Rig::AntagonisticPulley,
            1 => Rig::BendingCatheter,
            _ => Rig::MuscleBench,
        };
        // Of those that hide something: three eighths one effect, as many several, a quarter what is not listed.
        let hiding = match random.random_range(0..8) {
            _ if is_nothing => Hiding::Nothing,
            0..3 => Hiding::One,
            3..6 => Hiding::Several,
            _ => Hiding::Unlisted,
        };
        Planned { name: format!("s{}_{index:05}", self.seed), rig, hiding, seed }
    }
}

/// Folders of a proof: what is concealed and what was answered.
#[derive(Clone, Debug)]
pub struct Folders {
    pub cases: PathBuf,
    pub answers: PathBuf,
}

impl Folders {
    pub fn below(out: &Path) -> Self {
        Self { cases: out.join("cases"), answers: out.join("answers") }
    }

    /// The same cases with other answers.
    pub fn with_answers(&self, answers: PathBuf) -> Self {
        Self { cases: self.cases.clone(), answers }
    }

    pub fn holdout(&self, name: &str) -> PathBuf {
        self.cases.join(format!("{name}.holdout.csv"))
    }

    pub fn larger(&self, name: &str) -> PathBuf {
        self.cases.join(format!("{name}.larger.csv"))
    }

    /// File that is written last of an answer.
    fn took(&self, name: &str) -> PathBuf {
        self.answers.join(name).join("seconds.txt")
    }

    /// Seal of a case that was written whole; none of one that was not.
    pub fn seal_of(&self, name: &str) -> Option<String> {
        let is_whole = self.cases.join(name).join("recordings.toml").is_file();
        let sealed = self.cases.join(SEALED).join(format!("{name}.json"));
        fs::read_to_string(sealed).ok().filter(|_| is_whole).map(|text| seal(&text))
    }

    /// Whether a case was answered whole.
    pub fn is_answered(&self, name: &str) -> bool {
        self.took(name).is_file()
    }

    /// How long the diagnosis took, s.
    pub fn seconds(&self, name: &str) -> Option<f64> {
        fs::read_to_string(self.took(name)).ok()?.trim().parse().ok()
    }
}

/// Draws a case and writes it; returns its seal.
///
/// # Errors
/// A plant that cannot be integrated, a folder that cannot be written.
pub fn conceal_case(planned: &Planned, folders: &Folders) -> Result<String, ProofError> {
    let drawn = draw(&planned.name, planned.rig, planned.hiding, planned.seed)?;
    Ok(write_case(&drawn, &folders.cases)?)
}

/// Diagnoses a case from what everyone may see, a step left out if one is given, and writes the answer.
///
/// # Errors
/// A folder that cannot be read or written.
pub fn answer_case(name: &str, folders: &Folders, without: Option<Step>) -> Result<(), ProofError> {
    let begun = std::time::Instant::now();
    let recordings = folders.cases.join(name);
    let mut case = Case::load(&[recordings.as_path()], None, &[])?;
    if let Some(step) = without {
        case.leave_out(step);
    }
    let outcome = diagnose(case, Options { seed: 1 }, &|_| {})?;
    let took = begun.elapsed().as_secs_f64();
    write_answer(&outcome, &folders.answers.join(name))?;
    let path = folders.took(name);
    write_whole(&path, &format!("{took:.2}\n")).map_err(|source| ProofError::Write { file: path, source })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_first_part_of_a_plan_is_a_fair_one() {
        let cases = Plan { hiding: 60, nothing: 60, laws: 0, seed: 1 }.cases();
        let nothing = |part: &[Planned]| part.iter().filter(|c| c.hiding == Hiding::Nothing).count();
        assert_eq!(cases.len(), 120);
        assert_eq!(nothing(&cases), 60);
        assert_eq!(nothing(&cases[..40]), 20);
        assert!(Hiding::Nothing != cases[0].hiding || Hiding::Nothing != cases[1].hiding);
        let longer = Plan { hiding: 100, nothing: 100, laws: 0, seed: 1 }.cases();
        assert_eq!(longer[17], cases[17]);
    }
}
