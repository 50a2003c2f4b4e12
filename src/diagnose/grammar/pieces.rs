//! A law of straight pieces over one variable, for what no shape of the grammar follows.

use super::shaped::{SECOND_SIZE, SIZES, is_sum, sum_of};
use super::shapes::{LINE, RAMPS, Shape};
use super::slots::Slot;
use crate::diagnose::case::Case;
use crate::diagnose::fit::Variant;
use crate::effects::Entry;

/// Straight pieces between the least and the greatest value of the variable: the line from the first knot, and what is added to its slope at
/// each further one.
const PIECES: usize = SIZES.len();
/// Decimals of a knot, in scales of the variable: what is written is what is fitted.
const DECIMALS: f64 = 1e3;

/// One term of a curve of pieces: a line that starts at a knot.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Its signal is this shape at this scale, of which the term is so many times as much.
    pub shape: &'static Shape,
    pub scale: f64,
    pub times: f64,
    /// Where it starts, in scales of the slot; the first has no start.
    knot: Option<f64>,
}

/// The terms of a curve over where the slot's variable has been.
pub fn pieces(slot: &Slot) -> Vec<Piece> {
    let reach =
        slot.series.iter().flatten().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(x / slot.scale), high.max(x / slot.scale)]
        });
    let knot = |k: usize| {
        let share = k as f64 / PIECES as f64;
        ((reach[0] + share * (reach[1] - reach[0])) * DECIMALS).round() / DECIMALS
    };
    let ramp = |at: f64| {
        let (shape, size) = if at > 0.0 {
            (&RAMPS[0], at)
        } else if at < 0.0 {
            (&RAMPS[2], -at)
        } else {
            (&RAMPS[1], 1.0)
        };
        Piece { shape, scale: size * slot.scale, times: size, knot: Some(at) }
    };
    let line = Piece { shape: &LINE, scale: slot.scale, times: 1.0, knot: None };
    std::iter::once(line).chain((1..PIECES).map(|k| ramp(knot(k)))).collect()
}

impl Piece {
    fn text(&self) -> String {
        match self.knot {
            None => "x".to_owned(),
            Some(at) if at < 0.0 => format!("max(x + {}, 0)", -at),
            Some(at) => format!("max(x - {at}, 0)"),
        }
    }
}

/// The law of a slot as a curve of pieces, with the size of each.
pub fn in_pieces(case: &Case, slot: &Slot, sizes: &[f64]) -> Option<Variant> {
    let terms: Vec<String> = pieces(slot).iter().map(Piece::text).collect();
    let mut own = sum_of(case, slot, &terms)?;
    for (parameter, value) in own.placed.spec().parameters.iter().zip(&mut own.values) {
        if let Some((_, size)) = SIZES.iter().zip(sizes).find(|(name, _)| parameter.key == **name) {
            *value = size.clamp(parameter.range.min, parameter.range.max);
        }
    }
    Some(own)
}

/// Whether the law of an effect is such a curve; a law of a user's may have as many parameters of these names, and no such ramps.
pub fn is_in_pieces(own: &Entry) -> bool {
    let ramps = own.equation.matches("max(").count();
    own.unlisted().is_some()
        && ramps == PIECES - 1
        && SIZES.iter().all(|size| own.parameters.iter().any(|p| p.key == *size))
}

/// Whether a parameter of an effect is the size of it, or of one of its terms.
pub fn is_size(own: &Entry, parameter: usize) -> bool {
    let key = own.parameters[parameter].key.as_str();
    let is_of_term = is_sum(own) && key == SECOND_SIZE || is_in_pieces(own) && SIZES.contains(&key);
    parameter == 0 || is_of_term
}

/// Values of such a curve whose sizes are given, where the slot's variable has been, without the constant.
pub fn drawn(slot: &Slot, sizes: &[f64]) -> Vec<f64> {
    let pieces = pieces(slot);
    let mut sum: Vec<f64> = vec![0.0; slot.series.iter().map(Vec::len).sum()];
    for (piece, size) in pieces.iter().zip(sizes) {
        let signal = slot.signal_of_all(piece.shape, piece.scale);
        sum.iter_mut().zip(signal).for_each(|(sum, y)| *sum += size * piece.times * y);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::fit::made::Bench;
    use crate::diagnose::grammar::{Reach, slots};
    use crate::laws::Symbol;

    /// What is written is what is shown by signals: at negative, zero and positive values.
    #[test]
    fn the_text_of_a_curve_is_the_sum_of_its_signals() {
        let bench = Bench::with(&[]);
        let all = slots(&bench.case, &bench.baseline(), Reach::Plain);
        let sizes = [0.3, -0.2, 0.5, -1.0, 0.7, 0.1, -0.4, 0.9];
        for (address, variable) in [("line.outflow", "flow_m3_s"), ("muscle.wall", "elongation_m")] {
            let slot = all.iter().find(|s| s.address == address && s.variable == variable).expect("a slot");
            let typical = slot.action.typical;
            let own: Vec<f64> = sizes.iter().map(|size| size * typical).collect();
            let placed = in_pieces(&bench.case, slot, &own).expect("a law");
            assert!(is_in_pieces(placed.placed.spec()));
            let keys = &placed.placed.spec().parameters;
            let law = &placed.placed.spec().unlisted().expect("a law").law;
            let named = |name: &str| keys.iter().zip(&placed.values).find(|(p, _)| p.key == name).map(|(_, v)| *v);
            let level = if slot.action.acts == crate::laws::Acts::Scales { 1.0 } else { 0.0 };
            let values: Vec<f64> = slot.series.iter().flatten().copied().collect();
            for (x, shown) in values.iter().zip(drawn(slot, &own)).step_by(97) {
                let read = |symbol: &Symbol| match symbol {
                    Symbol::Parameter(p) => named(&law.parameters[*p].name).expect("a value"),
                    Symbol::Constant(c) => *c,
                    Symbol::Variable(_) | Symbol::State(_) => *x,
                };
                let symbols: Vec<f64> = law.symbols.iter().map(read).collect();
                let written = law.programs.value.value(&symbols) - level;
                assert!((written - shown).abs() < 1e-9 * typical, "{address} {x}: {written} {shown}");
            }
        }
    }
}
