//! Times of rows: increasing, or put right as declared.

use super::super::survey::median;
use super::looked_at::ClockFaults;
use super::options::{FileOptions, TimeSource};

/// Eleven days without a sample: a simulation would run across them, so it is rather the unit that is wrong.
const LONGEST_GAP_S: f64 = 1e6;

/// The times of a file's rows, s, in the order of its rows.
#[derive(Clone, Debug)]
pub(super) struct Clock {
    may_split: bool,
    may_merge: bool,
    interval_s: Option<f64>,
    pub(super) time_s: Vec<f64>,
    /// First rows of the parts.
    starts: Vec<usize>,
    repeated: usize,
}

impl Clock {
    pub(super) fn new(options: &FileOptions) -> Self {
        let interval_s = match options.time {
            TimeSource::Column => None,
            TimeSource::Interval(s) | TimeSource::Index(s) => Some(s),
        };
        Self {
            may_split: options.split_at_restart,
            may_merge: options.merge_repeated,
            interval_s,
            time_s: Vec::new(),
            starts: vec![0],
            repeated: 0,
        }
    }

    /// The time of a row of a file without clock.
    pub(super) fn tick(&mut self) {
        let row = self.time_s.len() as f64;
        self.time_s.extend(self.interval_s.map(|s| row * s));
    }

    /// Takes the time of the next row.
    pub(super) fn push(&mut self, time_s: f64) -> Result<(), String> {
        if time_s.is_nan() {
            return Err("the time is missing\n  remedy: give every row its time, or remove the row".to_owned());
        }
        if let Some(previous_s) = self.time_s.last().copied() {
            self.follow(time_s, previous_s)?;
        }
        self.time_s.push(time_s);
        Ok(())
    }

    fn follow(&mut self, time_s: f64, previous_s: f64) -> Result<(), String> {
        if time_s - previous_s > LONGEST_GAP_S {
            return Err(format!(
                "{time_s:e} is more than {LONGEST_GAP_S:e} s after {previous_s}\n  remedy: give the time in seconds, or split the \
                 file where nothing was recorded"
            ));
        }
        if time_s > previous_s {
            return Ok(());
        }
        let (is_repeated, said) = (time_s == previous_s, format!("{time_s} is not after {previous_s}\n  remedy: "));
        match (is_repeated, self.may_merge, self.may_split) {
            (true, true, _) => self.repeated += 1,
            (false, _, true) => self.starts.push(self.time_s.len()),
            (true, ..) => {
                return Err(format!(
                    "{said}remove repeated rows, sort the rows by time, or split the file where its clock starts anew; or say \
                     merge_repeated = true in recordings.toml: the mean of the rows of one stamp"
                ));
            }
            (false, ..) => {
                return Err(format!(
                    "{said}sort the rows by time, if they stand in a wrong order; if the clock starts anew here, split the file, or say \
                     split_at_restart = true in recordings.toml: a run of its own from there"
                ));
            }
        }
        Ok(())
    }

    /// Rows of the parts.
    fn parts(&self) -> Vec<std::ops::Range<usize>> {
        let ends = self.starts[1..].iter().copied().chain([self.time_s.len()]);
        self.starts.iter().copied().zip(ends).map(|(from, to)| from..to).collect()
    }

    /// Times and values of each part, rows of one stamp made one.
    pub(super) fn cut(&self, columns: &[Vec<f64>]) -> Vec<(Vec<f64>, Vec<Vec<f64>>)> {
        let part = |rows: std::ops::Range<usize>| {
            let time_s = &self.time_s[rows.clone()];
            let merged = |column: &Vec<f64>| means(time_s, &column[rows.clone()]);
            let mut own = time_s.to_vec();
            own.dedup();
            (own, columns.iter().map(merged).collect())
        };
        self.parts().into_iter().map(part).collect()
    }

    /// What had to be put right.
    pub(super) fn faults(&self) -> ClockFaults {
        let swaps = self.swapped().count();
        ClockFaults { rows: self.time_s.len(), restarts: self.starts.len() - 1 - swaps, swaps, repeats: self.repeated }
    }

    /// Rows that stand behind a later one: the time goes on past both of them, as if nothing had been. A clock that starts anew goes on
    /// from where it has gone back to.
    fn swapped(&self) -> impl Iterator<Item = usize> + '_ {
        let t = &self.time_s;
        self.starts.windows(2).filter_map(move |pair| {
            let (from, at) = (pair[0], pair[1]);
            let goes_on = t.get(at + 1).is_none_or(|next| *next > t[at - 1]);
            (t[at] > t[from] && at + 1 < t.len() && goes_on).then_some(at)
        })
    }

    /// Refuses to split where no clock starts anew: between two rows in a wrong order, or at every row of a file in the order of
    /// another column.
    pub(super) fn check_order(&self) -> Result<(), String> {
        let (t, parts) = (&self.time_s, self.parts());
        if let Some(at) = self.swapped().next() {
            return Err(format!(
                "{} stands behind {}, and {} rows do so in all: they are in a wrong order, no clock starts anew there\n  remedy: sort the \
                 rows by time",
                t[at],
                t[at - 1],
                self.swapped().count()
            ));
        }
        let alone = parts.iter().filter(|rows| rows.len() == 1).count();
        if parts.len() > 2 && 2 * alone > parts.len() {
            return Err(format!(
                "the time goes back {} times in {} rows: no clock starts anew so often\n  remedy: sort the rows by time, or name another \
                 column as time_column",
                parts.len() - 1,
                t.len()
            ));
        }
        Ok(())
    }

    /// The median time between rows of one part, rounded off, s.
    fn usual_interval_s(&self) -> f64 {
        let mut intervals: Vec<f64> = self.time_s.windows(2).map(|w| w[1] - w[0]).filter(|dt| *dt > 0.0).collect();
        (median(&mut intervals).unwrap_or(0.01) * 1e9).round() / 1e9
    }

    /// Where most rows share their stamp, its clock is coarser than their pace: what keeps them all.
    fn said_of_pace(&self) -> String {
        if 2 * self.repeated < self.time_s.len() || self.starts.len() > 1 {
            return String::new();
        }
        let mut counts: Vec<f64> = self.time_s.chunk_by(|a, b| a == b).map(|rows| rows.len() as f64).collect();
        let rows = median(&mut counts).unwrap_or(1.0);
        let interval_s = (self.usual_interval_s() / rows * 1e6).round() / 1e6;
        format!(
            "; {rows} rows share one, so the stamps are coarser than the pace of the rows: if that was even, say interval_s = {interval_s} in \
             the place of the time column and of merge_repeated, which keeps every row"
        )
    }

    /// What was done to the times.
    pub(super) fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.repeated > 0 {
            let count = self.repeated;
            notes.push(format!(
                "merge_repeated: {count} rows had the stamp of the row before; each stamp has the mean of its rows{}",
                self.said_of_pace()
            ));
        }
        if self.starts.len() > 1 {
            let at: Vec<String> =
                self.starts[1..].iter().take(5).map(|i| format!("{} s", self.time_s[i - 1])).collect();
            let (parts, at) = (self.starts.len(), at.join(", "));
            notes.push(format!(
                "split_at_restart: {parts} runs of one file; the clock started anew after {at}. Each is simulated as a start from rest, \
                 without what the one before left behind (friction, creep); if the rig went on moving there, say interval_s = {} in the \
                 place of split_at_restart: one run with an even clock",
                self.usual_interval_s()
            ));
        }
        notes
    }
}

/// The mean of the values of each stamp, missing ones left out; alone they stay missing.
fn means(time_s: &[f64], values: &[f64]) -> Vec<f64> {
    let rows: Vec<(f64, f64)> = time_s.iter().copied().zip(values.iter().copied()).collect();
    let mean = |rows: &[(f64, f64)]| {
        let known: Vec<f64> = rows.iter().map(|(_, v)| *v).filter(|v| !v.is_nan()).collect();
        match known.as_slice() {
            [one] => *one,
            known => known.iter().sum::<f64>() / known.len() as f64,
        }
    };
    rows.chunk_by(|a, b| a.0 == b.0).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn restarts_split_and_repeats_merge() {
        let options = FileOptions { split_at_restart: true, merge_repeated: true, ..FileOptions::default() };
        let mut clock = Clock::new(&options);
        for t in [0.0, 0.1, 0.1, 0.2, 0.0, 0.1] {
            clock.push(t).unwrap();
        }
        let parts = clock.cut(&[vec![1.0, 2.0, 4.0, 5.0, f64::NAN, 7.0]]);
        assert_eq!(parts[0], (vec![0.0, 0.1, 0.2], vec![vec![1.0, 3.0, 5.0]]));
        assert!(parts[1].0 == [0.0, 0.1] && parts[1].1[0][0].is_nan() && parts[1].1[0][1] == 7.0);
        let notes = clock.notes();
        assert!(notes[0].contains("1 rows had the stamp") && notes[1].contains("2 runs of one file"), "{notes:?}");
    }

    #[test]
    fn neither_happens_unless_declared() {
        let mut clock = Clock::new(&FileOptions::default());
        clock.push(0.5).unwrap();
        assert!(clock.push(0.5).unwrap_err().contains("merge_repeated = true"));
        assert!(clock.push(0.4).unwrap_err().contains("split_at_restart = true"));
        assert!(clock.push(2e6).unwrap_err().contains("1e6 s after 0.5"));
        assert!(clock.push(f64::NAN).unwrap_err().contains("the time is missing"));
        assert_eq!(clock.time_s, [0.5]);
    }

    fn lenient(times: &[f64]) -> Clock {
        let options = FileOptions { split_at_restart: true, merge_repeated: true, ..FileOptions::default() };
        let mut clock = Clock::new(&options);
        times.iter().for_each(|t| clock.push(*t).unwrap());
        clock
    }

    #[test]
    fn rows_in_a_wrong_order_are_no_clock_that_starts_anew() {
        let swapped = lenient(&[0.0, 0.1, 0.3, 0.2, 0.4, 0.5]);
        assert_eq!((swapped.faults().restarts, swapped.faults().swaps), (0, 1));
        let said = swapped.check_order().unwrap_err();
        assert!(said.contains("0.2 stands behind 0.3") && said.contains("remedy: sort the rows"), "{said}");
        let falling: Vec<f64> = (0..20).rev().map(f64::from).collect();
        assert!(lenient(&falling).check_order().unwrap_err().contains("goes back 19 times in 20 rows"));
        // From zero, and from the middle of what was.
        for times in [&[0.0, 0.1, 0.2, 0.0, 0.1, 0.2][..], &[0.0, 0.1, 0.2, 0.3, 0.15, 0.25, 0.35]] {
            let clock = lenient(times);
            assert_eq!((clock.faults().restarts, clock.faults().swaps), (1, 0), "{times:?}");
            assert_eq!(clock.check_order(), Ok(()));
        }
    }

    #[test]
    fn whole_seconds_of_a_faster_clock_are_said() {
        let times: Vec<f64> = (0..200).map(|row| f64::from(row / 50)).collect();
        let notes = lenient(&times).notes();
        assert!(notes[0].contains("interval_s = 0.02"), "{notes:?}");
        assert!(!lenient(&[0.0, 0.1, 0.1, 0.2]).notes()[0].contains("interval_s"));
    }
}
