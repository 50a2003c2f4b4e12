//! Numbers of keys as a person reads them: `preload_n` 0.010079 is 10.1 mN. The unit comes from the key's suffix.

use crate::recording::parse_column;

/// What a key's number is measured in.
#[derive(Clone, Copy, Debug, PartialEq)]
struct KeyUnit {
    suffix: &'static str,
    /// Symbol of the SI unit.
    symbol: &'static str,
    /// What stands in for it: symbols with their size in SI units, smallest first. Empty: the SI unit alone.
    steps: &'static [(&'static str, f64)],
}

const fn unit(suffix: &'static str, symbol: &'static str, steps: &'static [(&'static str, f64)]) -> KeyUnit {
    KeyUnit { suffix, symbol, steps }
}

/// By suffix. `_a_b` is a over b, but for the two that [`of_key`] knows.
const UNITS: &[KeyUnit] = &[
    unit("m", "m", &[("nm", 1e-9), ("µm", 1e-6), ("mm", 1e-3), ("m", 1.0)]),
    unit("m2", "m²", &[("µm²", 1e-12), ("mm²", 1e-6), ("m²", 1.0)]),
    unit("m3", "m³", &[("mm³", 1e-9), ("mL", 1e-6), ("m³", 1.0)]),
    unit("m3_s", "m³/s", &[("mm³/s", 1e-9), ("mL/s", 1e-6), ("m³/s", 1.0)]),
    unit("m3_pa", "m³/Pa", &[]),
    unit("m3_s_pa", "m³/(s Pa)", &[]),
    unit("n", "N", &[("µN", 1e-6), ("mN", 1e-3), ("N", 1.0)]),
    unit("n_m", "N/m", &[("mN/m", 1e-3), ("N/m", 1.0), ("kN/m", 1e3)]),
    unit("n_s_m", "N s/m", &[("mN s/m", 1e-3), ("N s/m", 1.0)]),
    unit("n_m_rad", "N m/rad", &[("µN m/rad", 1e-6), ("mN m/rad", 1e-3), ("N m/rad", 1.0)]),
    unit("n_m_s_rad", "N m s/rad", &[("nN m s/rad", 1e-9), ("µN m s/rad", 1e-6), ("mN m s/rad", 1e-3)]),
    unit("n_pa", "N/Pa", &[("mN/MPa", 1e-9), ("N/MPa", 1e-6), ("N/kPa", 1e-3)]),
    unit("pa", "Pa", &[("Pa", 1.0), ("kPa", 1e3), ("MPa", 1e6), ("GPa", 1e9)]),
    unit("pa_s", "Pa s", &[("mPa s", 1e-3), ("Pa s", 1.0)]),
    unit("pa_s2_m6", "Pa s²/m⁶", &[]),
    unit("s", "s", &[("µs", 1e-6), ("ms", 1e-3), ("s", 1.0)]),
    unit("1_s", "1/s", &[]),
    unit("1_m", "1/m", &[]),
    unit("1_m2", "1/m²", &[]),
    unit("1_pa", "1/Pa", &[]),
    unit("1_n", "1/N", &[]),
    unit("j", "J", &[("µJ", 1e-6), ("mJ", 1e-3), ("J", 1.0)]),
    unit("kg", "kg", &[("mg", 1e-6), ("g", 1e-3), ("kg", 1.0)]),
    unit("kg_m3", "kg/m³", &[]),
    unit("rad", "rad", &[("µrad", 1e-6), ("mrad", 1e-3), ("rad", 1.0)]),
];
const TORQUE: KeyUnit = unit("n_m", "N m", &[("µN m", 1e-6), ("mN m", 1e-3), ("N m", 1.0)]);

/// How the numbers of one key are shown: in one unit, however many they are.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    /// SI units in one of the unit shown.
    pub factor: f64,
    /// The unit's symbol; empty for what has none.
    pub symbol: String,
}

impl Scale {
    /// For the numbers of a key of which `greatest` is the largest. A rate of a sensor (`_per_s`) has the unit of its
    /// channel; a ratio, a count, a power none.
    pub fn of(key: &str, channel: Option<&str>, greatest: f64) -> Self {
        let plain = |symbol: String| Self { factor: 1.0, symbol };
        if key.ends_with("_per_s") {
            let own = channel.and_then(|c| parse_column(c).ok()).map_or("", |name| name.unit.symbol);
            return plain(if own.is_empty() { "1/s".to_owned() } else { format!("{own}/s") });
        }
        let Some(unit) = of_key(key) else { return plain(String::new()) };
        // From a tenth of a unit on: 0.3 mm, not 300 µm. A rounded 0.09996 belongs to it.
        let fits = |(_, size): &&(&str, f64)| greatest.abs() >= 0.09995 * size;
        let step = match greatest == 0.0 || !greatest.is_finite() {
            true => None,
            false => unit.steps.iter().rev().find(fits).or(unit.steps.first()),
        };
        match step {
            // Still far too small for the smallest step: powers of ten of the SI unit.
            Some((_, size)) if greatest.abs() < 1e-3 * size => plain(unit.symbol.to_owned()),
            Some((symbol, size)) => Self { factor: *size, symbol: (*symbol).to_owned() },
            None => plain(unit.symbol.to_owned()),
        }
    }

    /// A number in the unit shown, to three digits.
    pub fn digits(&self, value_si: f64) -> String {
        to_digits(value_si / self.factor, 3)
    }

    /// As short as it is exact to six digits, with its unit: `0.3 mm`, `1e-16 m³/(s Pa)`.
    pub fn short(&self, value_si: f64) -> String {
        let value = value_si / self.factor;
        let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
        let is_plain = rounded == 0.0 || (1e-3..1e5).contains(&rounded.abs());
        let number = if is_plain { format!("{rounded}") } else { format!("{rounded:e}") };
        with(&without_minus_zero(number), &self.symbol)
    }

    /// The same with its unit: `10.1 mN`.
    pub fn text(&self, value_si: f64) -> String {
        with(&self.digits(value_si), &self.symbol)
    }

    /// A value and its interval, to the second digit of the interval's half-width: `10.08 mN`, `10.05 to 10.11 mN`.
    pub(crate) fn with_interval(&self, value_si: f64, low_si: f64, high_si: f64) -> [String; 2] {
        let [value, low, high] = [value_si, low_si, high_si].map(|v| v / self.factor);
        let write = |v: f64| to_place(v, 0.5 * (high - low));
        [with(&write(value), &self.symbol), with(&format!("{} to {}", write(low), write(high)), &self.symbol)]
    }
}

/// A number of a key with its unit: `10.1 mN`.
pub fn quantity(key: &str, channel: Option<&str>, value_si: f64) -> String {
    Scale::of(key, channel, value_si).text(value_si)
}

/// A number to the second digit of its uncertainty (the same unit), at most nine digits.
pub fn to_place(value: f64, uncertainty: f64) -> String {
    if !value.is_finite() || !uncertainty.is_finite() || uncertainty <= 0.0 {
        return to_digits(value, 4);
    }
    let last = uncertainty.log10().floor() as i32 - 1;
    let first = if value == 0.0 { last } else { value.abs().log10().floor() as i32 };
    if (-4..6).contains(&first) {
        return without_minus_zero(format!("{value:.*}", (-last).clamp(0, 8 - first.min(8)) as usize));
    }
    format!("{value:.*e}", (first - last).clamp(1, 8) as usize)
}

/// A range of a recorded column: `elongation 0.0 to 6.6 mm`.
pub fn column_range(column: &str, low: f64, high: f64) -> String {
    let (name, symbol) = parse_column(column)
        .map_or_else(|_| (column.to_owned(), ""), |name| (name.base.replace('_', " "), name.unit.symbol));
    let decimals = (1.0 - (high - low).abs().max(f64::MIN_POSITIVE).log10().floor()).clamp(0.0, 6.0) as usize;
    let write = |v: f64| without_minus_zero(format!("{v:.decimals$}"));
    with(&format!("{name} {} to {}", write(low), write(high)), symbol)
}

/// So many digits; `0.0213`, `12.5`, `1830`, `1.00e-16`.
fn to_digits(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return without_minus_zero(format!("{value}"));
    }
    // The power after rounding: 0.9996 is 1.00.
    let rounded: f64 = format!("{value:.*e}", (digits - 1) as usize).parse().unwrap_or(value);
    let power = rounded.abs().log10().floor() as i32;
    match (-4..6).contains(&power) {
        true => format!("{value:.*}", (digits - 1 - power).max(0) as usize),
        false => format!("{value:.*e}", (digits - 1) as usize),
    }
}

fn without_minus_zero(text: String) -> String {
    let is_zero = text.starts_with('-') && text.chars().all(|c| matches!(c, '-' | '0' | '.'));
    if is_zero { text[1..].to_owned() } else { text }
}

/// A number with its unit; degrees follow without a space.
pub(super) fn with(number: &str, symbol: &str) -> String {
    match symbol {
        "" | "1" => number.to_owned(),
        _ if symbol.starts_with('°') => format!("{number}{symbol}"),
        _ => format!("{number} {symbol}"),
    }
}

/// The unit of a key; `None` for ratios, coefficients, powers. A further branch's `_2` is no part of it.
fn of_key(key: &str) -> Option<KeyUnit> {
    let number = key.rsplit_once('_').filter(|(_, n)| !n.is_empty() && n.chars().all(|c| c.is_ascii_digit()));
    let key = number.map_or(key, |(base, _)| base);
    // The unit of a sensor's rate is that of its channel.
    if key.ends_with("_per_s") {
        return None;
    }
    if key.contains("torque") && key.ends_with("_n_m") {
        return Some(TORQUE);
    }
    let is_own = |unit: &&KeyUnit| key.strip_suffix(unit.suffix).is_some_and(|base| base.ends_with('_'));
    UNITS.iter().filter(is_own).max_by_key(|unit| unit.suffix.len()).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_suffix_gives_unit_and_prefix() {
        let cases = [
            ("preload_n", 1.0079e-2, "10.1 mN"),
            ("friction_per_pressure_n_pa", 2.53e-7, "0.253 N/MPa"),
            ("free_volume_m3", 1e-9, "1.00 mm³"),
            ("cubic_1_m2", -640.0, "-640 1/m²"),
            ("conductance_m3_s_pa", 1e-16, "1.00e-16 m³/(s Pa)"),
            ("volume_rate_m3_s", -5e-11, "-0.0500 mm³/s"),
            ("relaxation_time_s_2", 0.4, "0.400 s"),
            ("coulomb_torque_n_m", 2e-4, "0.200 mN m"),
            ("stiffness_n_m", 6.0, "6.00 N/m"),
            ("stiffness_n_m_rad", 1e-3, "1.00 mN m/rad"),
            ("angle_rad", 0.6, "0.600 rad"),
            ("material.c1_pa", 265_280.0, "0.265 MPa"),
            ("quadratic_pa_s2_m6", 1e18, "1.00e18 Pa s²/m⁶"),
            ("set_rate_1_s", 2e-3, "0.00200 1/s"),
            ("slack_length_m", 0.000_999_96, "1.00 mm"),
            ("softening_ratio", 0.1, "0.100"),
            ("kappa", 1.0, "1.00"),
            ("weight_n", 0.0, "0 N"),
            ("weight_n", 1e-12, "1.00e-12 N"),
        ];
        for (key, value, text) in cases {
            assert_eq!(quantity(key, None, value), text, "{key}");
        }
        assert_eq!(quantity("rate_per_s", Some("pressure_kpa"), -0.107), "-0.107 kPa/s");
    }

    #[test]
    fn given_numbers_are_written_short() {
        let short = |key: &str, value: f64| Scale::of(key, None, value).short(value);
        let shown =
            [short("bore_m", 3e-4), short("conductance_m3_s_pa", 2e-16), short("width_m", 4e-5), short("kappa", 1.0)];
        assert_eq!(shown, ["0.3 mm", "2e-16 m³/(s Pa)", "40 µm", "1"]);
        assert_eq!([with("3.4", "°"), with("3.4", "°/s"), with("3.4", "1")], ["3.4°", "3.4°/s", "3.4"]);
    }

    #[test]
    fn digits_end_at_the_second_of_the_interval() {
        let scale = Scale::of("preload_n", None, 1.0079e-2);
        assert_eq!(scale.with_interval(1.0079e-2, 1.0049e-2, 1.0109e-2), ["10.079 mN", "10.049 to 10.109 mN"]);
        let scale = Scale::of("m0_n", None, 0.5);
        assert_eq!(scale.with_interval(0.5, -0.7, 1.7), ["0.5 N", "-0.7 to 1.7 N"]);
        assert_eq!(to_place(1.302_815, 1.17), "1.3");
        assert_eq!(to_place(0.0, 0.2), "0.00");
        assert_eq!(to_place(7.5511e-15, 1e-18), "7.5511e-15");
        assert_eq!(to_place(2.0, f64::NAN), "2.000");
    }

    #[test]
    fn ranges_read_as_words() {
        assert_eq!(column_range("elongation_mm", -0.0199, 6.6349), "elongation 0.0 to 6.6 mm");
        assert_eq!(column_range("pressure_1_kpa", -93.2602, 494.2042), "pressure 1 -93 to 494 kPa");
        assert_eq!(column_range("odd", 1.0, 3.0), "odd 1.0 to 3.0");
    }
}
