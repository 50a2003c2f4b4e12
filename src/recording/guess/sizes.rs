//! Which unit the size of a column's numbers speaks for, where none is stated.

use super::super::Unit;
use super::super::table::{FileUnit, file_unit};

/// What a soft muscle's quantities come to at most, by the suffix of their SI unit, and the units that labs write them in.
const USUAL: [(&str, [f64; 2], &[&str]); 4] = [
    ("m", [2e-4, 0.3], &["mm", "cm", "m", "um"]),
    ("pa", [5e3, 1e7], &["kPa", "bar", "MPa", "Pa", "mbar"]),
    ("n", [1e-2, 300.0], &["N", "mN", "kN"]),
    ("rad", [0.02, 12.6], &["deg", "rad"]),
];

/// The comment on a column without a unit. `greatest` is the greatest of its numbers.
pub(super) fn no_unit(taken: Unit, greatest: Option<f64>) -> String {
    let taken_as = format!("taken as {}", taken.symbol);
    match (greatest.and_then(|greatest| Some((greatest, fitting(taken, greatest)?))), example(taken)) {
        (Some((greatest, unit)), _) if unit.factor != taken.factor => format!(
            "# No unit is stated: the numbers, up to {greatest}, are {taken_as}. By their size they may be {0}: unit = \"{0}\"\n",
            unit.name
        ),
        (Some((greatest, _)), Some(other)) => format!(
            "# No unit is stated: the numbers, up to {greatest}, are {taken_as}, which fits their size. If they are in another unit, \
             say so: unit = \"{other}\"\n"
        ),
        (_, Some(other)) => {
            format!(
                "# No unit is stated: the numbers are {taken_as}. If they are in another unit, say so: unit = \"{other}\"\n"
            )
        }
        (_, None) => format!("# No unit is stated: the numbers are {taken_as}.\n"),
    }
}

fn usual(taken: Unit) -> Option<&'static (&'static str, [f64; 2], &'static [&'static str])> {
    USUAL.iter().find(|(suffix, ..)| *suffix == taken.si_suffix)
}

/// The unit in which numbers up to `greatest` are of a usual size: that of the column if it is one, else the first that labs write.
fn fitting(taken: Unit, greatest: f64) -> Option<&'static FileUnit> {
    let (_, [low, high], names) = usual(taken)?;
    let units = || names.iter().filter_map(|name| file_unit(name));
    let fits = |unit: &&FileUnit| (*low..=*high).contains(&(greatest * unit.factor));
    units().filter(|unit| unit.factor == taken.factor).find(fits).or_else(|| units().find(fits))
}

/// Another unit of the quantity.
fn example(taken: Unit) -> Option<&'static str> {
    let (.., names) = usual(taken)?;
    names.iter().copied().find(|name| file_unit(name).is_some_and(|unit| unit.factor != taken.factor))
}

#[cfg(test)]
mod tests {
    use super::super::super::parse_column;
    use super::*;

    #[test]
    fn the_unit_that_fits_the_size_is_named() {
        for (column, greatest, unit) in [
            ("plunger_mm", 0.003, "m"),
            ("plunger_mm", 3.0, "mm"),
            ("elongation_mm", 27_000.0, "um"),
            ("pressure_kpa", 18.0, "kPa"),
            ("pressure_kpa", 1.8, "bar"),
            ("pressure_kpa", 1.8e6, "Pa"),
            ("force_n", 4_500.0, "mN"),
            ("angle_deg", 2.5, "deg"),
        ] {
            let taken = parse_column(column).unwrap().unit;
            assert_eq!(fitting(taken, greatest).map(|u| u.name), Some(unit), "{column} {greatest}");
        }
        let words = no_unit(parse_column("pressure_kpa").unwrap().unit, Some(1.8e6));
        assert!(words.contains("By their size they may be Pa: unit = \"Pa\""), "{words}");
        assert!(!no_unit(parse_column("force_n").unwrap().unit, Some(1.0)).contains("cm"));
    }
}
