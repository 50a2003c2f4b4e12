//! A law's expression as a textbook prints it: `1 + 0.4 * exp(-abs(speed_m_s/0.002))` is 1 + 0.4 exp(-|v/0.002|).

use super::symbols::greek;

/// Stems of quantities and the letters that stand for them.
const LETTERS: [(&str, &str); 15] = [
    ("angle", "θ"),
    ("angular_speed", "ω"),
    ("elongation", "x"),
    ("flow", "Q"),
    ("friction_state", "z"),
    ("plunger", "s"),
    ("plunger_speed", "u"),
    ("position", "q"),
    ("pressure", "p"),
    ("reading", "y"),
    ("speed", "v"),
    ("stretch", "δ"),
    ("syringe_pressure", "P"),
    ("tension", "T"),
    ("time", "t"),
];
const UNITS: [&str; 8] = ["_m3_s", "_rad_s", "_m_s", "_pa", "_rad", "_m", "_n", "_s"];

/// A printed law: its text, and what its letters are called in a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Formula {
    pub(super) text: String,
    pub(super) letters: Vec<(String, String)>,
}

impl Formula {
    /// Reads an expression as laws write it.
    pub(super) fn of(expression: &str) -> Self {
        let mut formula = Self::default();
        // Of each open bracket what closes it.
        let mut closing: Vec<&str> = Vec::new();
        let mut rest = expression;
        while let Some(first) = rest.chars().next() {
            let length = word_length(rest).max(first.len_utf8());
            let (word, behind) = rest.split_at(length);
            rest = behind;
            match (word, first) {
                ("abs", _) if rest.starts_with('(') => {
                    closing.push("|");
                    formula.text.push('|');
                    rest = &rest[1..];
                    // A bracket within the bars says nothing.
                    if let Some(inner) = bracketed(rest) {
                        let part = formula.part(inner);
                        formula.text += &part;
                        formula.text.push('|');
                        closing.pop();
                        rest = &rest[inner.len() + 3..];
                    }
                }
                ("(", _) => {
                    closing.push(")");
                    formula.text.push('(');
                }
                (")", _) => formula.text += closing.pop().unwrap_or(")"),
                (" ", _) if rest.starts_with("* ") => {
                    formula.text.push('\u{a0}');
                    rest = &rest[2..];
                }
                ("*", _) => formula.text.push('·'),
                ("^", _) => rest = formula.raise(rest),
                (_, c) if c.is_ascii_digit() => formula.text += &number(word),
                (_, c) if c.is_ascii_alphabetic() => formula.name(word),
                _ => formula.text += word,
            }
        }
        formula
    }

    /// Prints a part of the expression; its letters are kept.
    fn part(&mut self, expression: &str) -> String {
        let part = Self::of(expression);
        let known = std::mem::take(&mut self.letters);
        self.letters = known.into_iter().chain(part.letters).collect();
        self.letters.dedup();
        part.text
    }

    /// A name: a quantity's letter, or as it is.
    fn name(&mut self, word: &str) {
        let Some(letter) = letter(word) else {
            self.text += &greek(word);
            return;
        };
        self.text += &letter;
        let entry = (letter, word.to_owned());
        if !self.letters.contains(&entry) {
            self.letters.push(entry);
        }
    }

    /// A whole power as a raised number; gives what follows it.
    fn raise<'a>(&mut self, rest: &'a str) -> &'a str {
        let digits = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
        if digits == 0 || rest[digits..].starts_with('.') {
            self.text.push('^');
            return rest;
        }
        self.text += &raised(&rest[..digits]);
        &rest[digits..]
    }

    /// `v: speed_m_s, t: time_s`.
    pub(super) fn legend(&self) -> String {
        self.letters.iter().map(|(letter, name)| format!("{letter}: `{name}`")).collect::<Vec<_>>().join(", ")
    }
}

/// Of `(a + b))...` what is within the inner brackets; none where a bracket is followed by anything but the outer one's end.
fn bracketed(text: &str) -> Option<&str> {
    let mut depth = 0;
    for (i, c) in text.char_indices() {
        match c {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return text[i..].starts_with("))").then(|| &text[1..i]);
        }
    }
    None
}

/// Length of the name or number that a text begins with; 0 where it begins with neither.
fn word_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let is_number = bytes.first().is_some_and(u8::is_ascii_digit);
    let belongs = |i: usize| {
        let c = bytes[i];
        let is_sign_of_power = is_number && (c == b'-' || c == b'+') && i > 0 && bytes[i - 1] == b'e';
        c.is_ascii_alphanumeric() || c == b'_' || (is_number && c == b'.') || is_sign_of_power
    };
    (0..bytes.len()).find(|&i| !belongs(i)).unwrap_or(bytes.len())
}

/// The letter of a quantity, with the number of its element: `elongation_2_m` is x₂.
fn letter(name: &str) -> Option<String> {
    let stem = UNITS.iter().find_map(|unit| name.strip_suffix(unit)).unwrap_or(name);
    let (stem, number) = match stem.rsplit_once('_') {
        Some((stem, number)) if number.bytes().all(|c| c.is_ascii_digit()) => (stem, number),
        _ => (stem, ""),
    };
    let (_, letter) = LETTERS.iter().find(|(known, _)| *known == stem)?;
    let lowered = number.bytes().filter_map(|c| char::from_u32(0x2080 + u32::from(c - b'0')));
    Some(letter.chars().chain(lowered).collect())
}

/// `1.2e-5` as 1.2×10⁻⁵, with at most four digits.
fn number(word: &str) -> String {
    let Ok(value) = word.parse::<f64>() else { return word.to_owned() };
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    let text = match rounded == 0.0 || (1e-3..1e5).contains(&rounded.abs()) {
        true => format!("{rounded}"),
        false => format!("{rounded:e}"),
    };
    match text.split_once('e') {
        Some((digits, power)) => format!("{digits}×10{}", raised(power)),
        None => text,
    }
}

fn raised(power: &str) -> String {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raise = |c: char| c.to_digit(10).map_or(if c == '-' { '⁻' } else { c }, |digit| RAISED[digit as usize]);
    power.chars().map(raise).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expressions_read_as_in_a_textbook() {
        let printed = |text: &str| Formula::of(text).text.replace('\u{a0}', " ");
        assert_eq!(printed("1 + 0.4 * exp(-abs(speed_m_s/0.002))"), "1 + 0.4 exp(-|v/0.002|)");
        assert_eq!(printed("1.23456e-7 * pressure_pa^2"), "1.235×10⁻⁷ p²");
        assert_eq!(printed("max(abs(angle_rad - 1), 0)"), "max(|θ - 1|, 0)");
        assert_eq!(printed("elongation_2_m^1.5 * kappa"), "x₂^1.5 κ");
        assert_eq!(printed("abs(time_s"), "|t");
        assert_eq!(printed("20000*a_b"), "20000·a_b");
        assert_eq!(printed("ln(1 + abs((time_s/34.8)))"), "ln(1 + |t/34.8|)");
        assert_eq!(printed("abs((time_s) + (1))"), "|(t) + (1)|");
    }

    #[test]
    fn letters_are_explained_once() {
        let formula = Formula::of("speed_m_s * abs(speed_m_s) + tension_n");
        assert_eq!(formula.legend(), "v: `speed_m_s`, T: `tension_n`");
    }
}
