//! Units of the numbers in a file, as labs write them: more than a column's name may end in.

use super::super::Unit;

/// A unit of numbers in a file: `value_si = factor * value`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FileUnit {
    /// How `recordings.toml` writes it: `mmHg`.
    pub name: &'static str,
    /// Other spellings that headers use, told apart by case where the name is.
    spellings: &'static [&'static str],
    /// Suffix of the SI unit of the same quantity: `pa`.
    pub si_suffix: &'static str,
    /// SI units in one of this unit.
    pub factor: f64,
}

const fn unit(
    name: &'static str,
    spellings: &'static [&'static str],
    si_suffix: &'static str,
    factor: f64,
) -> FileUnit {
    FileUnit { name, spellings, si_suffix, factor }
}

/// Standard gravity, m/s² (exact by definition; kgf, gf and lbf count by it).
const STANDARD_GRAVITY: f64 = 9.806_65;
/// Pound, kg (exact by definition).
const POUND_KG: f64 = 0.453_592_37;

/// Every unit that numbers in a file may have. The inch is 25.4 mm, the psi one lbf per square inch, the conventional
/// millimetre of mercury 133.322387415 Pa, a revolution 2π rad.
pub const FILE_UNITS: &[FileUnit] = &[
    unit("m", &["metre", "meter"], "m", 1.0),
    unit("cm", &[], "m", 1e-2),
    unit("mm", &["millimetre", "millimeter"], "m", 1e-3),
    unit("um", &["µm", "μm", "micron", "microns"], "m", 1e-6),
    unit("in", &["inch", "inches", "\""], "m", 0.0254),
    unit("rad", &["radian", "radians"], "rad", 1.0),
    unit("deg", &["°", "degree", "degrees", "Grad"], "rad", std::f64::consts::PI / 180.0),
    unit("rev", &["turn", "turns", "revolution", "revolutions"], "rad", 2.0 * std::f64::consts::PI),
    unit("Pa", &["pascal"], "pa", 1.0),
    unit("kPa", &["kpa", "KPa"], "pa", 1e3),
    unit("MPa", &["mpa", "Mpa", "N/mm2", "N/mm²"], "pa", 1e6),
    unit("mbar", &["hPa"], "pa", 1e2),
    unit("bar", &["barg", "bar(g)"], "pa", 1e5),
    unit("atm", &[], "pa", 101_325.0),
    unit("psi", &["psig", "lbf/in2"], "pa", 6_894.757_293_168_361),
    unit("mmHg", &["mmhg", "torr"], "pa", 133.322_387_415),
    unit("N", &["newton", "newtons"], "n", 1.0),
    unit("mN", &["mn"], "n", 1e-3),
    unit("kN", &["kn"], "n", 1e3),
    unit("gf", &[], "n", 1e-3 * STANDARD_GRAVITY),
    unit("kgf", &["kp"], "n", STANDARD_GRAVITY),
    unit("lbf", &["lb"], "n", POUND_KG * STANDARD_GRAVITY),
    unit("N m", &["nm", "Nm", "N·m", "N*m"], "nm", 1.0),
    unit("V", &["v", "volt", "volts"], "v", 1.0),
    unit("mV", &["mv"], "v", 1e-3),
    unit("s", &["sec", "secs", "second", "seconds"], "s", 1.0),
    unit("ms", &["msec", "millisecond", "milliseconds"], "s", 1e-3),
    unit("us", &["µs", "μs", "microsecond", "microseconds"], "s", 1e-6),
    unit("ns", &["nsec", "nanosecond", "nanoseconds"], "s", 1e-9),
    unit("min", &["minute", "minutes"], "s", 60.0),
    unit("h", &["hr", "hour", "hours"], "s", 3600.0),
    // Not "d", in which names of what is desired end.
    unit("day", &["days"], "s", 86_400.0),
    unit("Hz", &["hz"], "hz", 1.0),
    unit("kg", &[], "kg", 1.0),
    unit("g", &[], "kg", 1e-3),
    unit("m3", &["m³"], "m3", 1.0),
    unit("mL", &["ml", "cm3", "cm³"], "m3", 1e-6),
    unit("uL", &["ul", "µL", "μL", "µl"], "m3", 1e-9),
    unit("m/s", &["m_s"], "m_s", 1.0),
    unit("mm/s", &["mm_s"], "m_s", 1e-3),
    unit("rad/s", &["rad_s"], "rad_s", 1.0),
    unit("deg/s", &["°/s", "deg_s"], "rad_s", std::f64::consts::PI / 180.0),
    unit("m3/s", &["m3_s", "m³/s"], "m3_s", 1.0),
    unit("mL/s", &["ml_s", "ml/s"], "m3_s", 1e-6),
    unit("uL/s", &["ul_s", "µL/s", "µl/s"], "m3_s", 1e-9),
    unit("percent", &["%"], "ratio", 1e-2),
    unit("ratio", &[], "ratio", 1.0),
];

impl FileUnit {
    /// A value of this unit in the unit of a column of the same quantity.
    pub fn into_column(&self, column: Unit, value: f64) -> f64 {
        // No detour between equal units, so that the number stays the file's to the last bit.
        if self.factor == column.factor { value } else { value * self.factor / column.factor }
    }
}

/// The unit that a text means: as written first, since `mN` and `MN` differ; else without regard to case.
///
/// ```
/// use smam::recording::file_unit;
///
/// assert_eq!(file_unit("°").map(|u| u.name), Some("deg"));
/// assert_eq!(file_unit("KPA").map(|u| u.name), Some("kPa"));
/// assert_eq!(file_unit("furlong"), None);
/// ```
pub fn file_unit(text: &str) -> Option<&'static FileUnit> {
    let text = text.trim();
    let spelt = |unit: &&FileUnit| unit.name == text || unit.spellings.contains(&text);
    if let Some(unit) = FILE_UNITS.iter().find(spelt) {
        return Some(unit);
    }
    // Giga and mega would become milli.
    if text.starts_with('M') && text.chars().count() <= 2 {
        return None;
    }
    let lower = text.to_lowercase();
    FILE_UNITS.iter().find(|u| u.name.to_lowercase() == lower || u.spellings.iter().any(|s| s.to_lowercase() == lower))
}

/// The units as an error lists them.
pub(in crate::recording) fn known_file_units() -> String {
    FILE_UNITS.iter().map(|u| u.name).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::super::super::{KNOWN_UNITS, parse_column};
    use super::*;

    /// Closed forms: 1 atm = 760 mmHg = 14.6959 psi = 101325 Pa, a kilogram-force 2.2046 pound-force.
    #[test]
    fn factors_agree_with_each_other() {
        let factor = |name: &str| file_unit(name).unwrap().factor;
        assert!((760.0 * factor("mmHg") - 101_325.0).abs() < 0.1);
        assert_eq!((factor("atm"), factor("N/mm²")), (101_325.0, 1e6));
        assert!((14.695_949 * factor("psi") - 101_325.0).abs() < 0.01);
        assert!((factor("lbf") / factor("in").powi(2) / factor("psi") - 1.0).abs() < 1e-12);
        assert!((factor("kgf") / factor("lbf") - 2.204_622_6).abs() < 1e-6);
        assert!((factor("rev") / factor("deg") - 360.0).abs() < 1e-9);
    }

    #[test]
    fn every_unit_of_a_column_is_one_of_a_file() {
        for known in KNOWN_UNITS {
            let unit = file_unit(known.suffix).unwrap_or_else(|| panic!("{}", known.suffix));
            assert_eq!((unit.si_suffix, unit.factor), (known.si_suffix, known.factor), "{}", known.suffix);
        }
    }

    #[test]
    fn case_tells_milli_from_mega() {
        assert_eq!(file_unit("mN").unwrap().factor, 1e-3);
        assert_eq!(file_unit("MN"), None);
        assert_eq!(file_unit("MPa").unwrap().factor, 1e6);
        assert_eq!(file_unit("MM"), None);
    }

    #[test]
    fn conversion_keeps_equal_units_to_the_bit() {
        let kpa = parse_column("pressure_kpa").unwrap().unit;
        assert_eq!(file_unit("bar").unwrap().into_column(kpa, 1.5), 150.0);
        assert_eq!(file_unit("kPa").unwrap().into_column(kpa, 0.1 + 0.2), 0.1 + 0.2);
    }
}
