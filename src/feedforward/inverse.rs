//! A hysteresis model run backwards.

use crate::hysteresis::HysteresisModel;

/// What the plunger can do, and what the model is trusted with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Least and greatest input, mm.
    pub input_mm: [f64; 2],
    /// Greatest speed of the input, mm/s.
    pub speed_mm_s: f64,
    /// Slopes of the model below this share of its mean slope are taken to be this large: just after a reversal a
    /// model may be flat, or turn, and its inverse would run away.
    pub least_slope: f64,
}

/// The inverse of a model in time: it keeps the model's state, so that it knows the branch it is on.
///
/// Each step solves `G(x, z(x)) = wanted` for the input `x` in the direction in which the output must go, `z(x)` being
/// the state after going straight to `x`. Lengths in mm.
///
/// ```
/// use smam::feedforward::{Inverse, Limits};
/// use smam::hysteresis::{HysteresisModel, PlayElement, PrandtlIshlinskii};
///
/// let play = PlayElement { weight: 2.0, half_width: 0.1 };
/// let muscle = HysteresisModel::PrandtlIshlinskii(PrandtlIshlinskii::classical(4.0, vec![play]));
/// let limits = Limits { input_mm: [0.0, 3.0], speed_mm_s: 5.0, least_slope: 0.1 };
/// let mut inverse = Inverse::new(&muscle, limits, 0.0);
/// // Out, 6 x - 0.2 = 8.8; on the way back 0.2 mm of the plunger move it by 4 mm per mm only.
/// assert!((inverse.step(8.8, 1.0) - 1.5).abs() < 1e-6);
/// assert!((inverse.step(8.0, 1.0) - 1.3).abs() < 1e-6);
/// ```
#[derive(Clone, Debug)]
pub struct Inverse<'a> {
    model: &'a HysteresisModel<f64>,
    limits: Limits,
    /// Mean slope of the output over the input range, signed.
    slope: f64,
    state: Vec<f64>,
    input_mm: f64,
    /// Time in which the wanted output could not be followed, s.
    clipped_s: f64,
}

/// A programme of the plunger, and how long it fell short of what was wanted.
#[derive(Clone, Debug, PartialEq)]
pub struct Programme {
    pub input_mm: Vec<f64>,
    /// Time in which a limit or the least slope held the input back, s.
    pub clipped_s: f64,
}

/// The programme for wanted outputs (mm) at given times (s), from rest at the input `start_mm`.
///
/// There and back through a play of 0.1 mm, which the programme crosses at each turn:
///
/// ```
/// use smam::feedforward::{Limits, programme};
/// use smam::hysteresis::{HysteresisModel, PlayElement, PrandtlIshlinskii};
///
/// let play = PlayElement { weight: 2.0, half_width: 0.1 };
/// let muscle = HysteresisModel::PrandtlIshlinskii(PrandtlIshlinskii::classical(4.0, vec![play]));
/// let limits = Limits { input_mm: [0.0, 3.0], speed_mm_s: 5.0, least_slope: 0.1 };
/// let (time_s, wanted_mm) = ([0.0, 1.0, 2.0, 3.0], [0.0, 9.0, 5.0, 8.0]);
/// let plunger = programme(&muscle, limits, 0.0, &time_s, &wanted_mm);
/// let reached_mm = muscle.follow(&time_s, &plunger.input_mm);
/// assert!(reached_mm.iter().zip(&wanted_mm).all(|(a, b)| (a - b).abs() < 1e-6));
/// assert_eq!(plunger.clipped_s, 0.0);
/// // 30 mm are more than 3 mm of plunger give: it goes as far as it may, and says how long that fell short.
/// let short = programme(&muscle, limits, 0.0, &[0.0, 1.0], &[0.0, 30.0]);
/// assert_eq!((short.input_mm[1], short.clipped_s), (3.0, 1.0));
/// ```
pub fn programme(
    model: &HysteresisModel<f64>,
    limits: Limits,
    start_mm: f64,
    time_s: &[f64],
    wanted_mm: &[f64],
) -> Programme {
    let mut inverse = Inverse::new(model, limits, start_mm);
    let mut last_s = None;
    let follow = |(&time, &wanted): (&f64, &f64)| {
        let duration = last_s.map_or(0.0, |last: f64| time - last);
        last_s = Some(time);
        inverse.step(wanted, duration)
    };
    let input_mm = time_s.iter().zip(wanted_mm).map(follow).collect();
    Programme { input_mm, clipped_s: inverse.clipped_s() }
}

impl<'a> Inverse<'a> {
    /// At rest at an input.
    pub fn new(model: &'a HysteresisModel<f64>, limits: Limits, start_mm: f64) -> Self {
        let [low, high] = limits.input_mm;
        // There and back, so that the hysteresis does not count.
        let there = model.follow(&[0.0, 1.0, 2.0], &[low, high, low]);
        let slope = (there[1] - 0.5 * (there[0] + there[2])) / (high - low);
        Self { state: model.rest(start_mm), model, limits, slope, input_mm: start_mm, clipped_s: 0.0 }
    }

    /// Mean slope of the output over the input range, signed.
    pub fn slope(&self) -> f64 {
        self.slope
    }

    /// Time in which the wanted output could not be followed, s.
    pub fn clipped_s(&self) -> f64 {
        self.clipped_s
    }

    /// The input that brings the wanted output at the end of the next `duration_s`, mm.
    pub fn step(&mut self, wanted_mm: f64, duration_s: f64) -> f64 {
        let here = self.model.output(self.input_mm, &self.state);
        let gap = wanted_mm - here;
        let reach = self.limits.speed_mm_s * duration_s;
        if gap == 0.0 || reach <= 0.0 || !gap.is_finite() {
            return self.input_mm;
        }
        let way = gap.signum() * self.slope.signum();
        let gained = |distance: f64| (self.after(way * distance, duration_s).0 - here) * gap.signum();
        let (distance, is_clipped) = self.distance(gap.abs(), reach, gained);
        let [low, high] = self.limits.input_mm;
        let aim = self.input_mm + way * distance;
        let input = aim.max(low).min(high);
        if is_clipped || input != aim {
            self.clipped_s += duration_s;
        }
        let (_, state) = self.after(input - self.input_mm, duration_s);
        self.state = state;
        self.input_mm = input;
        input
    }

    /// How far to go for a `gap`, and whether a limit cut it; `gained(d)` is what going `d` brings of it.
    fn distance(&self, gap: f64, reach: f64, gained: impl Fn(f64) -> f64) -> (f64, bool) {
        let least = self.limits.least_slope * self.slope.abs();
        let probe = 1e-3 * reach;
        let slope = gained(probe) / probe;
        if slope < least {
            return ((gap / least).min(reach), true);
        }
        let mut low = 0.0;
        let mut high = (gap / slope).min(reach);
        while gained(high) < gap {
            if high >= reach {
                return (reach, true);
            }
            (low, high) = (high, (2.0 * high).min(reach));
        }
        // Halving: branches of a model may have kinks, and forty steps are cheap.
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if gained(middle) < gap { low = middle } else { high = middle }
        }
        (high, false)
    }

    /// Output and state after going straight by `step_mm`.
    fn after(&self, step_mm: f64, duration_s: f64) -> (f64, Vec<f64>) {
        let mut state = self.state.clone();
        let to = self.input_mm + step_mm;
        self.model.advance(&mut state, self.input_mm, to, duration_s);
        (self.model.output(to, &state), state)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hysteresis::{PaperModel, PlayElement, PrandtlIshlinskii};

    const LIMITS: Limits = Limits { input_mm: [0.0, 3.0], speed_mm_s: 20.0, least_slope: 0.1 };

    fn wanted(reach: f64) -> (Vec<f64>, Vec<f64>) {
        let time_s: Vec<f64> = (0..=2000).map(|i| f64::from(i) * 0.01).collect();
        let shape = |t: &f64| reach * 0.5 * (1.0 - (std::f64::consts::TAU * 0.1 * t).cos());
        let wanted = time_s.iter().map(shape).collect();
        (time_s, wanted)
    }

    fn worst_after(model: &HysteresisModel<f64>, least_mm: f64, reach: f64) -> (f64, f64) {
        let (time_s, wanted) = wanted(reach);
        let limits = Limits { input_mm: [least_mm, 3.0], ..LIMITS };
        let found = programme(model, limits, 0.0, &time_s, &wanted);
        let output = model.follow(&time_s, &found.input_mm);
        let worst = output.iter().zip(&wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        (worst, found.clipped_s)
    }

    #[test]
    fn plays_are_inverted_to_rounding() {
        let plays = [0.1, 0.3].map(|half_width| PlayElement { weight: 2.0, half_width });
        let model = HysteresisModel::PrandtlIshlinskii(PrandtlIshlinskii::classical(4.0, plays.to_vec()));
        // Back to no output takes an input below zero: the plays hang over.
        let (worst, clipped_s) = worst_after(&model, -1.0, 20.0);
        assert!(worst < 1e-6 && clipped_s == 0.0, "{worst} mm, {clipped_s} s");
    }

    /// The printed model rises a little after the plunger turns back: no input follows there, and it is said.
    #[test]
    fn the_printed_model_is_followed_but_for_where_it_turns() {
        let model = HysteresisModel::Paper(PaperModel::printed());
        let (worst, clipped_s) = worst_after(&model, 0.0, 20.0);
        assert!(worst < 0.6, "{worst} mm");
        assert!(clipped_s > 0.0 && clipped_s < 2.0, "{clipped_s} s");
    }

    #[test]
    fn what_the_plunger_cannot_reach_is_clipped() {
        let model = HysteresisModel::PrandtlIshlinskii(PrandtlIshlinskii::classical(4.0, Vec::new()));
        let found = programme(&model, LIMITS, 0.0, &[0.0, 1.0, 2.0], &[0.0, 20.0, 20.0]);
        assert_eq!(found.input_mm, [0.0, 3.0, 3.0]);
        assert_eq!(found.clipped_s, 2.0);
    }
}
