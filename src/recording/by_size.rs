//! Units by size: a channel that moves a thousand times as far as its simulation is in another unit.

use super::figures::{correlation, spread};
use super::noise_sd;
use super::table::{FILE_UNITS, FileUnit};
use super::{Unit, parse_column};

/// Ratios outside of this are no physics that was left out.
const NO_PHYSICS: f64 = 20.0;
/// Ratios outside of this make one ask for the unit.
const ODD: f64 = 3.0;
/// How near to a unit's factor a ratio counts as that unit's, as a logarithm: beyond all physics, and where physics may do it.
const NEAR: f64 = 0.7;
const NEAR_AMONG_PHYSICS: f64 = 0.25;

/// What the size of a channel's motion says of its unit.
#[derive(Clone, Debug, PartialEq)]
pub enum BySize {
    /// It is wrong: what to say of it, and what to do.
    Wrong(String),
    /// It may be wrong.
    Odd(String),
}

/// Judges the unit of a column by how many times as far it moves as its simulation does.
///
/// Numbers in a unit U, taken as the column's C, move C/U times as far. What to do is never to rename the column (the scene's channel
/// would be another) but to say which unit the numbers have, so that they are converted.
///
/// ```
/// use smam::recording::{BySize, unit_by_size};
///
/// // Radians under the name of degrees, psi under that of kilopascals.
/// assert!(matches!(unit_by_size("bend_deg", 0.0175), Some(BySize::Wrong(words)) if words.contains("unit = \"rad\"")));
/// assert!(matches!(unit_by_size("pressure_kpa", 0.15), Some(BySize::Odd(words)) if words.contains("unit = \"psi\"")));
/// assert_eq!(unit_by_size("force_n", 1.5), None);
/// ```
pub fn unit_by_size(column: &str, ratio: f64) -> Option<BySize> {
    let size = ratio.ln().abs();
    if !size.is_finite() || size <= ODD.ln() {
        return None;
    }
    let unit = parse_column(column).ok()?.unit;
    let is_beyond = size > NO_PHYSICS.ln();
    let (nearest, off) = nearest(unit, ratio)?;
    let near = if is_beyond { NEAR.min(size / 3.0) } else { NEAR_AMONG_PHYSICS };
    let moves = format!("{column}: moves {ratio:.3e} times as far as the scene does");
    match (is_beyond, off < near) {
        (true, true) => {
            Some(BySize::Wrong(format!("{moves}, as numbers in {} would: {}", nearest.name, remedy(nearest, unit))))
        }
        (true, false) if is_prefix(ratio) => Some(BySize::Wrong(format!(
            "{moves}: a factor of a thousand (milli, kilo); say in its [[channel]] which unit the numbers have, or scale = 1000 or 0.001"
        ))),
        (_, false) => Some(BySize::Odd(format!("{moves}: make sure of its unit before believing what is named"))),
        (false, true) => Some(BySize::Odd(format!(
            "{moves}: make sure of its unit before believing what is named ({} in place of {}? {})",
            nearest.name,
            unit.symbol,
            remedy(nearest, unit)
        ))),
    }
}

fn remedy(nearest: &FileUnit, taken: Unit) -> String {
    format!("if they are, say unit = \"{}\" in its [[channel]] where {} is taken now", nearest.name, taken.symbol)
}

fn is_prefix(ratio: f64) -> bool {
    (ratio.ln().abs() - 1000f64.ln()).abs() < NEAR
}

/// The other unit of the quantity whose numbers would move so, and how far off, as a logarithm.
fn nearest(unit: Unit, ratio: f64) -> Option<(&'static FileUnit, f64)> {
    // An atmosphere is 1.3 % from a bar: size does not tell them apart, and labs write bars.
    let same =
        FILE_UNITS.iter().filter(|u| u.si_suffix == unit.si_suffix && u.factor != unit.factor && u.name != "atm");
    let off = |u: &FileUnit| (ratio * u.factor / unit.factor).ln().abs();
    same.map(|u| (u, off(u))).min_by(|a, b| a.1.total_cmp(&b.1))
}

/// How many times as far a channel moves as its simulation; `None` where it shows little but noise, does not follow at all, or has too
/// few samples.
///
/// The ratio of the standard deviations over the samples that both have.
pub fn motion_ratio(time_s: &[f64], measured: &[f64], simulated: &[f64]) -> Option<f64> {
    /// A few samples move as they like.
    const LEAST_SAMPLES: usize = 50;
    /// In deviations of the noise.
    const NOISE_ALONE: f64 = 3.0;
    /// A channel that does not follow its simulation moves for another reason.
    const FOLLOWS: f64 = 0.3;
    let both = measured.iter().zip(simulated).filter(|(m, s)| m.is_finite() && s.is_finite());
    let (own, other): (Vec<f64>, Vec<f64>) = both.unzip();
    let moved = spread(&own);
    let is_noise = noise_sd(time_s, measured).is_some_and(|noise| moved < NOISE_ALONE * noise);
    let follows = own.len() >= LEAST_SAMPLES && !is_noise && correlation(&own, &other) > FOLLOWS;
    follows.then(|| moved / spread(&other))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every unit of a file, taken as the column's by mistake, is named; but where another quantity's factor is as near.
    #[test]
    fn each_unit_is_told_by_its_factor() {
        for (column, wrong) in [
            ("elongation_mm", "cm"),
            ("elongation_mm", "m"),
            ("elongation_mm", "um"),
            ("elongation_mm", "in"),
            ("bend_deg", "rad"),
            ("bend_deg", "rev"),
            ("pressure_kpa", "psi"),
            ("pressure_kpa", "bar"),
            ("pressure_kpa", "Pa"),
            ("pressure_kpa", "MPa"),
            ("force_n", "mN"),
            ("force_n", "kN"),
            ("force_n", "gf"),
            ("force_n", "kgf"),
            ("time_s", "ms"),
        ] {
            let factor = super::super::file_unit(wrong).unwrap().factor;
            for physics in [0.9, 1.0, 1.1] {
                let ratio = physics * parse_column(column).unwrap().unit.factor / factor;
                let (BySize::Wrong(words) | BySize::Odd(words)) = unit_by_size(column, ratio).unwrap();
                assert!(words.contains(&format!("unit = \"{wrong}\"")), "{column}, {wrong}: {words}");
            }
        }
    }

    /// The remedy, carried out, makes the ratio 1.
    #[test]
    fn what_it_says_makes_the_numbers_right() {
        let column = parse_column("elongation_mm").unwrap().unit;
        let (unit, _) = nearest(column, 1000.0).unwrap();
        assert!((unit.into_column(column, 1000.0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn physics_is_no_unit() {
        assert_eq!(unit_by_size("elongation_mm", 0.5), None);
        assert!(matches!(unit_by_size("elongation_mm", 4.5), Some(BySize::Odd(words)) if !words.contains("unit = ")));
        assert!(matches!(unit_by_size("bend_deg", 1000.0), Some(BySize::Wrong(_))));
        assert_eq!(unit_by_size("bend_deg", f64::INFINITY), None);
    }

    #[test]
    fn the_ratio_is_that_of_the_motions() {
        let time_s: Vec<f64> = (0..200).map(|i| 0.01 * f64::from(i)).collect();
        let simulated: Vec<f64> = time_s.iter().map(|t| (3.0 * t).sin()).collect();
        let measured: Vec<f64> = simulated.iter().map(|v| 5.0 + 0.01 * v).collect();
        assert!((motion_ratio(&time_s, &measured, &simulated).unwrap() - 0.01).abs() < 1e-9);
        let against: Vec<f64> = simulated.iter().map(|v| -v).collect();
        assert_eq!(motion_ratio(&time_s, &against, &simulated), None);
        assert_eq!(motion_ratio(&time_s, &[f64::NAN; 200], &simulated), None);
    }
}
