//! A loop with fewer samples, for the way to the optimum: what a long recording repeats need not be followed at every step.

use super::data::LoopRun;
use super::problem::counted_samples;

/// With so many samples that count, or fewer, nothing is thinned.
const ENOUGH: usize = 400;

/// The runs with about [`ENOUGH`] samples that count; `None` where they have hardly more.
///
/// Of each stretch of samples the first stays, those where the input is least and greatest (no turn is cut, and a state that follows the
/// path exactly comes to the same), and the first that shows the output.
pub(super) fn decimated(runs: &[LoopRun]) -> Option<Vec<LoopRun>> {
    let counted = counted_samples(runs);
    // A stretch without a turn keeps two of its samples.
    let stretch = 2 * counted / ENOUGH;
    (stretch > 3).then(|| runs.iter().map(|run| thin(run, stretch)).collect())
}

fn thin(run: &LoopRun, stretch: usize) -> LoopRun {
    let order = |a: &usize, b: &usize| run.input_mm[*a].total_cmp(&run.input_mm[*b]);
    let mut kept: Vec<usize> = Vec::new();
    for from in (0..run.time_s.len()).step_by(stretch) {
        let samples = from..(from + stretch).min(run.time_s.len());
        kept.push(from);
        kept.extend(samples.clone().find(|&i| run.output_mm[i].is_finite()));
        kept.extend(samples.clone().min_by(order));
        kept.extend(samples.max_by(order));
    }
    kept.sort_unstable();
    kept.dedup();
    let of = |values: &[f64]| kept.iter().map(|&i| values[i]).collect();
    LoopRun {
        name: run.name.clone(),
        time_s: of(&run.time_s),
        input_mm: of(&run.input_mm),
        output_mm: of(&run.output_mm),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(count: usize) -> LoopRun {
        let time_s: Vec<f64> = (0..count).map(|i| 0.01 * i as f64).collect();
        let input_mm = time_s.iter().map(|t| 1.5 - 1.5 * (2.1 * t).cos()).collect();
        let output_mm = time_s.iter().map(|t| if *t < 1.0 { f64::NAN } else { 9.0 * t.sin() }).collect();
        LoopRun { name: "loop".to_owned(), time_s, input_mm, output_mm }
    }

    #[test]
    fn turns_stay_and_about_enough_samples() {
        let whole = run(3000);
        let [thin] = &decimated(std::slice::from_ref(&whole)).expect("many samples")[..] else { panic!("one run") };
        assert!((350..560).contains(&thin.time_s.len()), "{}", thin.time_s.len());
        assert!(thin.time_s.is_sorted_by(|a, b| a < b) && thin.time_s[0] == 0.0);
        let turns = (1..2999).filter(|&i| {
            let [before, here, after] = [i - 1, i, i + 1].map(|k| whole.input_mm[k]);
            (here > before && here >= after) || (here < before && here <= after)
        });
        for turn in turns {
            let at = thin.time_s.iter().position(|t| *t == whole.time_s[turn]).expect("a turn is kept");
            assert_eq!(thin.input_mm[at], whole.input_mm[turn]);
        }
        assert!(thin.output_mm[0].is_nan());
    }

    /// An output that is slower than the input, shown in rows that nothing else would keep.
    #[test]
    fn an_output_in_every_fourth_row_is_still_seen() {
        let mut slow = run(10_000);
        slow.output_mm.iter_mut().enumerate().filter(|(i, _)| i % 4 != 1).for_each(|(_, y)| *y = f64::NAN);
        let thin = decimated(&[slow]).expect("many samples");
        assert!(counted_samples(&thin) > ENOUGH / 3, "{}", counted_samples(&thin));
    }

    #[test]
    fn few_samples_stay() {
        assert_eq!(decimated(&[run(700)]), None);
    }
}
