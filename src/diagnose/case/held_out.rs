//! Holds out part of the recordings, to test the answer on it.

use super::{Case, CaseRun};

impl Case {
    /// Holds out the last run unless the recordings say which; of a single run its last third, and of every run if
    /// there is no input, because then no run predicts another.
    pub(super) fn seal(&mut self) {
        if self.runs.iter().any(|r| r.is_held_out) && self.runs.iter().any(|r| !r.is_held_out) {
            return;
        }
        self.runs.iter_mut().for_each(|r| r.is_held_out = false);
        let is_driven = !self.scene.file.input.is_empty();
        if let [_, .., last] = self.runs.as_mut_slice()
            && is_driven
        {
            last.is_held_out = true;
            return;
        }
        let note = match self.runs.len() {
            1 => "one run only: its last third is held back",
            _ => "nothing drives these runs: the last third of each is held back",
        };
        self.notes.push(note.to_owned());
        let ends = self.runs.iter().map(|run| run.cut_at(run.times_s().len() * 2 / 3));
        let (open, held_out): (Vec<CaseRun>, Vec<CaseRun>) = ends.map(|[open, held_out]| (open, held_out)).unzip();
        self.runs = open.into_iter().chain(held_out).collect();
    }

    /// Cuts a single run at sample `cut`: open before it, held out after.
    #[doc(hidden)]
    pub fn seal_from(&mut self, cut: usize) {
        self.runs = self.runs[..1].iter().flat_map(|run| run.cut_at(cut)).collect();
    }
}

impl CaseRun {
    /// The open part before sample `cut`, and the held-out rest, which is simulated from the start.
    fn cut_at(&self, cut: usize) -> [Self; 2] {
        let cut = cut.min(self.times_s().len());
        let (mut open, mut held_out) = (self.clone(), self.clone());
        open.keep(0..cut);
        open.is_held_out = false;
        held_out.open_part = Some(held_out.measured.clone());
        held_out.open_part.iter_mut().flatten().for_each(|m| m[cut..].fill(f64::NAN));
        held_out.measured.iter_mut().for_each(|m| m[..cut].fill(f64::NAN));
        held_out.is_held_out = true;
        [open, held_out]
    }

    fn keep(&mut self, range: std::ops::Range<usize>) {
        let end = self.lead_in + range.end;
        self.drive.times_s.truncate(end);
        self.drive.inputs.iter_mut().for_each(|x| x.truncate(end));
        self.measured.iter_mut().for_each(|m| m.truncate(range.end));
    }
}
