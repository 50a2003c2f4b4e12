//! Units of measure, as far as laws need them.

use std::fmt;
use std::ops::{Div, Mul};

/// Exponents of kilogram, metre and second; an angle counts as a plain number.
///
/// ```
/// use smam::laws::Dimension;
///
/// # fn main() -> Result<(), String> {
/// let viscous = Dimension::parse("N s/m")?;
/// assert_eq!(viscous, Dimension::of_name("damping_n_s_m").ok_or("it ends in a unit")?);
/// assert_eq!(viscous.to_string(), "N s/m");
/// assert_eq!(Dimension::parse("m3/(s Pa)")?, Dimension::parse("m^3/s/Pa")?);
/// assert!(Dimension::parse("mm").is_err_and(|message| message.contains("SI")));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Dimension {
    kg: f64,
    m: f64,
    s: f64,
}

/// Exponents that differ by less are the same: roots of roots round.
const SAME: f64 = 1e-9;

impl PartialEq for Dimension {
    fn eq(&self, other: &Self) -> bool {
        let pairs = [(self.kg, other.kg), (self.m, other.m), (self.s, other.s)];
        pairs.iter().all(|(a, b)| (a - b).abs() < SAME)
    }
}

impl Mul for Dimension {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self { kg: self.kg + other.kg, m: self.m + other.m, s: self.s + other.s }
    }
}

impl Div for Dimension {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        self * other.power(-1.0)
    }
}

/// Base and derived units that may stand in a unit's text.
const UNITS: [(&str, Dimension); 10] = [
    ("1", Dimension::NONE),
    ("rad", Dimension::NONE),
    ("m", Dimension { kg: 0.0, m: 1.0, s: 0.0 }),
    ("s", Dimension { kg: 0.0, m: 0.0, s: 1.0 }),
    ("kg", Dimension { kg: 1.0, m: 0.0, s: 0.0 }),
    ("N", Dimension { kg: 1.0, m: 1.0, s: -2.0 }),
    ("Pa", Dimension { kg: 1.0, m: -1.0, s: -2.0 }),
    ("J", Dimension { kg: 1.0, m: 2.0, s: -2.0 }),
    ("W", Dimension { kg: 1.0, m: 2.0, s: -3.0 }),
    ("Hz", Dimension { kg: 0.0, m: 0.0, s: -1.0 }),
];

/// Endings of units that are not taken, and what to write instead. Longer ones come first.
const PREFIXED: [(&str, &str); 17] = [
    ("mm3_s", "m3_s"),
    ("n_mm", "n_m"),
    ("mm_s", "m_s"),
    ("mm3", "m3"),
    ("mm2", "m2"),
    ("mm", "m"),
    ("um", "m"),
    ("cm", "m"),
    ("kpa", "pa"),
    ("mpa", "pa"),
    ("bar", "pa"),
    ("psi", "pa"),
    ("mn", "n"),
    ("kn", "n"),
    ("deg_s", "rad_s"),
    ("deg", "rad"),
    ("ms", "s"),
];

/// How names end, and the unit that is meant. Longer endings come first; of units of the same dimension the first one is
/// how the dimension is written.
const ENDINGS: [(&str, &str); 41] = [
    ("n_m_s_rad", "N m s/rad"),
    ("n_m_rad", "N m/rad"),
    ("n_s_m", "N s/m"),
    ("m3_s_pa", "m3/(s Pa)"),
    ("pa_s2_m6", "Pa s2/m6"),
    ("pa_s2_m3", "Pa s2/m3"),
    ("pa_s_m3", "Pa s/m3"),
    ("pa_s", "Pa s"),
    ("m3_pa", "m3/Pa"),
    ("m2_pa", "m2/Pa"),
    ("n_pa", "N/Pa"),
    ("m_pa", "m/Pa"),
    ("m3_s", "m3/s"),
    ("m_s2", "m/s2"),
    ("m_s", "m/s"),
    ("m_n", "m/N"),
    ("rad_s2", "1/s2"),
    ("rad_s", "1/s"),
    ("kg_m3", "kg/m3"),
    ("kg_m2", "kg m2"),
    ("n_m3", "N/m3"),
    ("n_m2", "N/m2"),
    ("n_m", "N/m"),
    ("n_s", "N s"),
    ("pa_m", "Pa/m"),
    ("pa_n", "Pa/N"),
    ("1_s", "1/s"),
    ("1_m2", "1/m2"),
    ("1_m", "1/m"),
    ("1_pa", "1/Pa"),
    ("1_n", "1/N"),
    ("m3", "m3"),
    ("m2", "m2"),
    ("m", "m"),
    ("s", "s"),
    ("kg", "kg"),
    ("n", "N"),
    ("pa", "Pa"),
    ("j", "J"),
    ("w", "W"),
    ("hz", "Hz"),
];

impl Dimension {
    /// A plain number.
    pub(crate) const NONE: Self = Self { kg: 0.0, m: 0.0, s: 0.0 };

    /// The dimension raised to a power.
    pub fn power(self, n: f64) -> Self {
        Self { kg: self.kg * n, m: self.m * n, s: self.s * n }
    }

    /// The unit that a name ends in (`gap_m`, `conductance_m3_s_pa`); none where it ends in no unit. A name with `torque` or
    /// `moment` in it that ends in `_n_m` is in N m, any other one in N/m.
    pub fn of_name(name: &str) -> Option<Self> {
        let ends_in =
            |ending: &str| name.strip_suffix(ending).is_some_and(|rest| rest.len() > 1 && rest.ends_with('_'));
        if name.ends_with("_rad") && !ends_in("n_m_rad") && !ends_in("n_m_s_rad") {
            return Some(Self::NONE);
        }
        let (ending, unit) = ENDINGS.iter().find(|(ending, _)| ends_in(ending))?;
        let is_torque = *ending == "n_m" && (name.contains("torque") || name.contains("moment"));
        Self::parse(if is_torque { "N m" } else { unit }).ok()
    }

    /// The ending of a name that is a unit with a prefix, or another that SI does not have, and the name as it should be; none where it has
    /// none.
    pub(crate) fn with_prefix(name: &str) -> Option<(&'static str, String)> {
        let ending = |(wrong, right): &(&'static str, &str)| {
            let rest = name.strip_suffix(wrong)?.strip_suffix('_').filter(|rest| !rest.is_empty())?;
            Some((*wrong, format!("{rest}_{right}")))
        };
        PREFIXED.iter().find_map(ending)
    }

    /// Reads the text of a unit: SI units without prefixes, powers as digits, `/` for what is divided by.
    ///
    /// # Errors
    /// The word that is no unit, in a sentence.
    pub fn parse(text: &str) -> Result<Self, String> {
        let spread = text.replace(['(', ')', '*', '·', '^'], " ").replace('²', "2").replace('³', "3");
        let mut dimension = Self::NONE;
        for (i, part) in spread.split('/').enumerate() {
            for word in part.split_whitespace() {
                let unit = one_unit(word).or_else(|| joined_power(part, word)).ok_or_else(|| {
                    format!("\"{word}\" in \"{text}\" is no SI unit without prefix; write it like \"N s/m\" or \"m3/(s Pa)\"")
                })?;
                dimension = if i == 0 { dimension * unit } else { dimension / unit };
            }
        }
        Ok(dimension)
    }
}

/// `m3`, `Pa`, `1`.
fn one_unit(word: &str) -> Option<Dimension> {
    if let Some((_, unit)) = UNITS.iter().find(|(name, _)| *name == word) {
        return Some(*unit);
    }
    let split = word.find(|c: char| c.is_ascii_digit())?;
    let (name, power) = word.split_at(split);
    let unit = UNITS.iter().find(|(known, _)| *known == name)?.1;
    let power: f64 = power.parse().ok().filter(|n| *n < 10.0)?;
    Some(unit.power(power))
}

/// A power that stood behind `^` has been parted from its unit: `m 3` for `m^3`. The word before carries the first power already.
fn joined_power(part: &str, word: &str) -> Option<Dimension> {
    let words: Vec<&str> = part.split_whitespace().collect();
    let at = words.iter().position(|w| *w == word).filter(|at| *at > 0)?;
    let power: f64 = word.parse().ok().filter(|n| *n >= 2.0 && *n < 10.0)?;
    one_unit(words[at - 1]).map(|unit| unit.power(power - 1.0))
}

impl fmt::Display for Dimension {
    /// As the field writes it, where it is one that names end in; else by kilogram, metre and second.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == Self::NONE {
            return f.write_str("a plain number");
        }
        let single = UNITS.iter().skip(2).find(|(_, d)| d == self).map(|(name, _)| *name);
        let usual = || ENDINGS.iter().map(|(_, unit)| *unit).find(|unit| Self::parse(unit).is_ok_and(|d| d == *self));
        if let Some(name) = single.or_else(usual) {
            return f.write_str(name);
        }
        let parts = [("kg", self.kg), ("m", self.m), ("s", self.s)];
        let side = |sign: f64| -> Vec<String> {
            parts.iter().filter(|(_, n)| sign * n > SAME).map(|(name, n)| raised(name, sign * n)).collect()
        };
        let (above, below) = (side(1.0), side(-1.0));
        f.write_str(&if above.is_empty() { "1".to_owned() } else { above.join(" ") })?;
        match &below[..] {
            [] => Ok(()),
            [one] => write!(f, "/{one}"),
            several => write!(f, "/({})", several.join(" ")),
        }
    }
}

/// A unit to a power: `m`, `m2`, `m^0.5`.
fn raised(name: &str, power: f64) -> String {
    let whole = power.round();
    match (power - whole).abs() < SAME {
        true if whole == 1.0 => name.to_owned(),
        true => format!("{name}{whole}"),
        false => format!("{name}^{power}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(text: &str) -> Dimension {
        Dimension::parse(text).unwrap_or_else(|e| panic!("{e}"))
    }

    #[test]
    fn what_is_written_is_read() {
        for text in ["s/m", "1/(m s)", "kg m/s", "kg2/m3", "m5", "1/s2", "N", "Pa s2/m6"] {
            let written = unit(text).to_string();
            assert_eq!(unit(&written), unit(text), "{text}: {written}");
        }
        assert_eq!((unit("s/m").to_string(), unit("1/m s").to_string()), ("s/m".to_owned(), "1/(m s)".to_owned()));
    }

    #[test]
    fn names_end_in_their_units() {
        for (name, text) in [
            ("speed_scale_m_s", "m/s"),
            ("stiffness_n_m", "N/m"),
            ("torque_n_m", "N m"),
            ("stiffness_n_m_rad", "N m"),
            ("damping_n_m_s_rad", "N m s"),
            ("conductance_m3_s_pa", "m3/s/Pa"),
            ("resistance_pa_s_m3", "Pa s/m3"),
            ("angle_rad", "1"),
            ("angular_speed_rad_s", "1/s"),
            ("tau_s", "s"),
        ] {
            assert_eq!(Dimension::of_name(name), Some(unit(text)), "{name}");
        }
        for name in ["a", "m", "s", "gain", "friction_coefficient", "_m"] {
            assert_eq!(Dimension::of_name(name), None, "{name}");
        }
    }

    #[test]
    fn units_are_written_as_the_field_writes_them() {
        for text in ["N", "Pa", "m3/s", "N s/m", "N/Pa", "Pa s/m3"] {
            assert_eq!(unit(text).to_string(), text);
        }
        assert_eq!(Dimension::NONE.to_string(), "a plain number");
        assert_eq!((unit("kg") * unit("m").power(0.5)).to_string(), "kg m^0.5");
        assert_eq!(unit("m^3/(s Pa)"), unit("m3/s/Pa"));
    }

    #[test]
    fn what_is_no_unit_is_named() {
        for text in ["mm", "kPa", "furlong", "N m/minute"] {
            assert!(Dimension::parse(text).is_err(), "{text}");
        }
    }
}
