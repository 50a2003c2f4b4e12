//! Units as column-name suffixes: `plunger_1_mm` is the quantity `plunger_1` in millimetres.

use super::RecordingError;
use std::f64::consts::PI;

/// A unit a column name may end in: `value_si = factor * value`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// What a column name ends in, without the underscore: `kpa`.
    pub suffix: &'static str,
    /// How a figure prints it: `kPa`.
    pub symbol: &'static str,
    /// Suffix of the SI unit of the same quantity: `pa`.
    pub si_suffix: &'static str,
    /// SI units in one of this unit: 1000 for `kpa`.
    pub factor: f64,
}

impl Unit {
    /// A value of this unit, in the SI unit.
    pub fn to_si(&self, value: f64) -> f64 {
        value * self.factor
    }

    /// A value of the SI unit, in this unit.
    pub fn from_si(&self, value_si: f64) -> f64 {
        value_si / self.factor
    }
}

const fn unit(suffix: &'static str, symbol: &'static str, si_suffix: &'static str, factor: f64) -> Unit {
    Unit { suffix, symbol, si_suffix, factor }
}

/// Every unit known. `_nm` is newton metre, `_mn` millinewton, `_mpa` megapascal.
pub const KNOWN_UNITS: &[Unit] = &[
    unit("m", "m", "m", 1.0),
    unit("mm", "mm", "m", 1e-3),
    unit("um", "µm", "m", 1e-6),
    unit("rad", "rad", "rad", 1.0),
    unit("deg", "°", "rad", PI / 180.0),
    unit("pa", "Pa", "pa", 1.0),
    unit("kpa", "kPa", "pa", 1e3),
    unit("mpa", "MPa", "pa", 1e6),
    unit("bar", "bar", "pa", 1e5),
    unit("psi", "psi", "pa", 6_894.757_293_168_361),
    unit("n", "N", "n", 1.0),
    unit("mn", "mN", "n", 1e-3),
    unit("nm", "N m", "nm", 1.0),
    unit("s", "s", "s", 1.0),
    unit("ms", "ms", "s", 1e-3),
    unit("v", "V", "v", 1.0),
    unit("mv", "mV", "v", 1e-3),
    unit("kg", "kg", "kg", 1.0),
    unit("g", "g", "kg", 1e-3),
    unit("m3", "m³", "m3", 1.0),
    unit("ml", "mL", "m3", 1e-6),
    unit("ul", "µL", "m3", 1e-9),
    unit("hz", "Hz", "hz", 1.0),
    unit("ratio", "1", "ratio", 1.0),
    unit("percent", "%", "ratio", 1e-2),
    unit("m_s", "m/s", "m_s", 1.0),
    unit("mm_s", "mm/s", "m_s", 1e-3),
    unit("rad_s", "rad/s", "rad_s", 1.0),
    unit("deg_s", "°/s", "rad_s", PI / 180.0),
    unit("m3_s", "m³/s", "m3_s", 1.0),
    unit("ml_s", "mL/s", "m3_s", 1e-6),
    unit("ul_s", "µL/s", "m3_s", 1e-9),
];

/// A column name taken apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColumnName<'a> {
    /// The name without its unit: `plunger_1`.
    pub base: &'a str,
    /// The unit the name ends in.
    pub unit: Unit,
}

impl ColumnName<'_> {
    /// The name the same quantity has in SI units: `plunger_1_m`.
    pub fn si_column(&self) -> String {
        format!("{}_{}", self.base, self.unit.si_suffix)
    }
}

/// Text for the axis of a column: `plunger 1 (mm)`; a name without a unit stays as it is.
pub fn axis_label(column: &str) -> String {
    let label = |name: ColumnName| format!("{} ({})", name.base.replace('_', " "), name.unit.symbol);
    parse_column(column).map_or_else(|_| column.to_owned(), label)
}

/// Splits a column name into quantity and unit.
///
/// The longest suffix wins: `rate_deg_s` is degrees per second, never a `rate_deg` in seconds.
///
/// ```
/// use smam::recording::parse_column;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let pressure = parse_column("pressure_1_kpa")?;
/// assert_eq!((pressure.base, pressure.si_column()), ("pressure_1", "pressure_1_pa".to_owned()));
/// assert_eq!(pressure.unit.to_si(1900.0), 1.9e6);
/// // Degrees per second, and no duration.
/// assert_eq!(parse_column("bend_deg_s")?.unit.symbol, "°/s");
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`RecordingError::UnknownUnit`], which names the column and the known suffixes.
pub fn parse_column(column: &str) -> Result<ColumnName<'_>, RecordingError> {
    KNOWN_UNITS
        .iter()
        .filter_map(|unit| {
            let base = column.strip_suffix(unit.suffix)?.strip_suffix('_')?;
            (!base.is_empty()).then_some(ColumnName { base, unit: *unit })
        })
        .max_by_key(|name| name.unit.suffix.len())
        .ok_or_else(|| RecordingError::UnknownUnit { column: column.to_owned() })
}

/// The known suffixes as an error prints them: `_m, _mm, ...`.
pub(super) fn known_suffixes() -> String {
    let suffixes: Vec<String> = KNOWN_UNITS.iter().map(|u| format!("_{}", u.suffix)).collect();
    suffixes.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suffix_gives_quantity_and_factor() {
        let name = parse_column("plunger_1_mm").unwrap();
        assert_eq!((name.base, name.unit.suffix), ("plunger_1", "mm"));
        assert_eq!(name.si_column(), "plunger_1_m");
        assert_eq!((axis_label("plunger_1_mm").as_str(), axis_label("laps").as_str()), ("plunger 1 (mm)", "laps"));
        let bend = parse_column("bend_deg").unwrap().unit;
        assert!((bend.to_si(180.0) - PI).abs() < 1e-15);
        assert!((bend.from_si(PI) - 180.0).abs() < 1e-12);
    }

    #[test]
    fn rate_is_no_duration() {
        let name = parse_column("drive_deg_s").unwrap();
        assert_eq!((name.base, name.unit.suffix), ("drive", "deg_s"));
    }

    #[test]
    fn every_si_suffix_is_a_unit_of_factor_one() {
        for unit in KNOWN_UNITS {
            let si = KNOWN_UNITS.iter().find(|u| u.suffix == unit.si_suffix).unwrap();
            assert_eq!(si.factor, 1.0, "{}", unit.suffix);
        }
    }

    #[test]
    fn unknown_suffix_is_refused() {
        assert_eq!(
            parse_column("pressure_torr").unwrap_err().to_string(),
            "column \"pressure_torr\": its name ends in no known unit\n  remedy: rename it to end in one of \
             _m, _mm, _um, _rad, _deg, _pa, _kpa, _mpa, _bar, _psi, _n, _mn, _nm, _s, _ms, _v, _mv, \
             _kg, _g, _m3, _ml, _ul, _hz, _ratio, _percent, _m_s, _mm_s, _rad_s, _deg_s, _m3_s, \
             _ml_s, _ul_s"
        );
        assert!(parse_column("mm").is_err());
        assert!(parse_column("_mm").is_err());
    }
}
