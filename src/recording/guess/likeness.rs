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

/// Words that German headers join to others, before or behind: `Kolbenweg`, `Federkraft`, `Drehwinkel`.
const JOINED: [&str; 13] = [
    "kolben",
    "spritzen",
    "spritze",
    "hub",
    "dehnung",
    "weg",
    "verschiebung",
    "druck",
    "kraft",
    "winkel",
    "greifer",
    "antrieb",
    "zeit",
];
/// Rows of [`ALIKE`]: what is about the plunger, and lengths of anything.
const PLUNGER: usize = 0;
const LENGTH: usize = 1;

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
    // The length that a plunger went is none of the muscle.
    let is_of_plunger =
        same == 0 && ours.iter().any(|o| is_one_of(PLUNGER, o)) && names.iter().all(|w| is_one_of(LENGTH, w));
    let a_word = if is_of_plunger { 0.25 } else { 0.5 };
    let numbers_agree = if number(&ours) == number(&theirs) { 0.1 } else { 0.0 };
    (0.8 * same as f64 + a_word * alike.saturating_sub(same) as f64) / names.len().max(1) as f64
        + if same + alike > 0 { numbers_agree } else { 0.0 }
}

fn are_alike(a: &str, b: &str) -> bool {
    ALIKE.iter().any(|words| words.contains(&a) && words.contains(&b))
}

fn is_one_of(row: usize, word: &str) -> bool {
    ALIKE[row].contains(&word)
}

/// Lower-case words and numbers: `Pressure2 left` is pressure, 2, left; `Kolbenweg` is kolben, weg.
fn words(text: &str) -> Vec<String> {
    let is_known =
        |word: &String| TIME.contains(&word.as_str()) || ALIKE.iter().any(|row| row.contains(&word.as_str()));
    let parts = |word: String| if is_known(&word) { vec![word] } else { taken_apart(word) };
    plain_words(text).into_iter().flat_map(parts).collect()
}

/// The parts of a joined word; a word of which no part is known stays whole.
fn taken_apart(word: String) -> Vec<String> {
    let longest =
        |fits: &dyn Fn(&str) -> bool| JOINED.iter().copied().filter(|known| fits(known)).max_by_key(|k| k.len());
    if let Some(last) = longest(&|known| word.len() > known.len() && word.ends_with(known)) {
        let before = word[..word.len() - last.len()].trim_end_matches('s');
        let before = JOINED.iter().copied().find(|known| before.starts_with(known)).unwrap_or(before);
        // Syringes have a plural of their own.
        let before = if before == "spritzen" { "spritze" } else { before };
        return vec![before.to_owned(), last.to_owned()];
    }
    match longest(&|known| word.len() > known.len() && word.starts_with(known)) {
        Some("spritzen") => vec!["spritze".to_owned()],
        Some(first) => vec![first.to_owned(), word[first.len()..].to_owned()],
        None => vec![word],
    }
}

fn plain_words(text: &str) -> Vec<String> {
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
        assert_eq!(words("Spritzendruck 2"), ["spritze", "druck", "2"]);
        assert!(is_time("Messzeit") && is_time("Zeitstempel"));
        for (header, base) in [
            ("Kolbenweg", "plunger"),
            ("Kolbenhub", "plunger"),
            ("Muskeldruck", "pressure"),
            ("Kolbendruck", "pressure"),
            ("Federkraft", "force"),
            ("Drehwinkel", "angle"),
            ("Muskeldehnung", "elongation"),
            ("Druck", "pressure"),
            ("Kraft", "force"),
            ("Winkel", "angle"),
            ("Weg", "elongation"),
        ] {
            assert!(likeness(header, base) >= 0.5, "{header}, {base}: {}", likeness(header, base));
        }
        assert!(likeness("Kolbenweg", "elongation") < likeness("Weg", "elongation"));
        assert_eq!(likeness("Eindruck", "force"), 0.0);
        assert!(is_time("Zeit") && is_time("Time stamp") && is_time("X_Value") && !is_time("Temperature"));
    }
}
