//! How much a header's words are like a channel's name.

/// Words that labs use for one thing, in English, German and Chinese.
const ALIKE: [&[&str]; 8] = [
    &["plunger", "piston", "syringe", "kolben", "spritze", "stroke", "hub", "活塞"],
    &[
        "elongation",
        "extension",
        "stretch",
        "dehnung",
        "displacement",
        "disp",
        "weg",
        "laser",
        "position",
        "pos",
        "verschiebung",
        "位移",
        "x",
    ],
    &["pressure", "druck", "p", "press", "压力", "压强"],
    &["force", "kraft", "load", "f", "loadcell", "力"],
    &["tension", "zug", "zugkraft", "cable"],
    &["angle", "winkel", "theta", "bend", "bending", "tip", "rotation", "角度"],
    &["jaw", "forceps", "grip", "greifer"],
    &["drive", "motor", "antrieb"],
];

/// Words for the time.
const TIME: [&str; 15] = [
    "time",
    "t",
    "zeit",
    "timestamp",
    "stamp",
    "elapsed",
    "seconds",
    "x_value",
    "clock",
    "temps",
    "tiempo",
    "datetime",
    "date/time",
    "uhrzeit",
    "时间",
];

/// Whether a header names the time.
pub(super) fn is_time(quantity: &str) -> bool {
    let words = words(quantity);
    TIME.contains(&quantity.to_lowercase().as_str()) || words.iter().any(|word| TIME.contains(&word.as_str()))
}

/// 0 for nothing in common, 1 for the same name.
pub(super) fn likeness(quantity: &str, base: &str) -> f64 {
    let (ours, theirs) = (words(quantity), words(base));
    if ours == theirs {
        return 1.0;
    }
    let number = |words: &[String]| words.iter().find(|w| w.bytes().all(|b| b.is_ascii_digit())).cloned();
    // The second pressure is not the first.
    if let (Some(a), Some(b)) = (number(&ours), number(&theirs))
        && a != b
    {
        return 0.0;
    }
    let names: Vec<&String> = theirs.iter().filter(|w| !w.bytes().all(|b| b.is_ascii_digit())).collect();
    let same = names.iter().filter(|w| ours.contains(w)).count();
    let alike = names.iter().filter(|w| ours.iter().any(|o| are_alike(o, w))).count();
    let numbers_agree = if number(&ours) == number(&theirs) { 0.1 } else { 0.0 };
    (0.8 * same as f64 + 0.5 * alike.saturating_sub(same) as f64) / names.len().max(1) as f64
        + if same + alike > 0 { numbers_agree } else { 0.0 }
}

fn are_alike(a: &str, b: &str) -> bool {
    ALIKE.iter().any(|words| words.contains(&a) && words.contains(&b))
}

/// Lower-case words and numbers: `Pressure2 left` is pressure, 2, left.
fn words(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut last = ' ';
    for letter in text.to_lowercase().chars() {
        let begins = !last.is_alphanumeric() || last.is_ascii_digit() != letter.is_ascii_digit();
        match (letter.is_alphanumeric(), words.last_mut()) {
            (true, Some(word)) if !begins => word.push(letter),
            (true, _) => words.push(letter.to_string()),
            (false, _) => {}
        }
        last = letter;
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_compared_by_words() {
        assert_eq!(likeness("Plunger 1", "plunger_1"), 1.0);
        assert_eq!(likeness("Druck 2", "pressure_1"), 0.0);
        assert!(likeness("Druck 1", "pressure_1") > likeness("Druck", "pressure_1"));
        assert!(likeness("Laser", "elongation") > 0.4);
        assert_eq!(likeness("Temperature", "elongation"), 0.0);
        assert!(is_time("Zeit") && is_time("Time stamp") && is_time("X_Value") && !is_time("Temperature"));
    }
}
