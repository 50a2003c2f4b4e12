//! The nearest right word to a wrong one.

/// `; did you mean "role"?` when a known word is near, else nothing.
pub fn did_you_mean(word: &str, known: &[&str]) -> String {
    known
        .iter()
        .map(|candidate| (edit_distance(word, candidate), candidate))
        .min()
        .filter(|(distance, _)| *distance <= (word.chars().count() / 3).max(1))
        .map_or(String::new(), |(_, near)| format!(", did you mean \"{near}\"?"))
}

/// Letters to insert, delete or replace to turn one word into the other (Levenshtein).
fn edit_distance(from: &str, to: &str) -> usize {
    let to: Vec<char> = to.chars().collect();
    let mut row: Vec<usize> = (0..=to.len()).collect();
    for (i, letter) in from.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, other) in to.iter().enumerate() {
            let replaced = diagonal + usize::from(letter != *other);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[to.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edit_distance_of_known_words() {
        assert_eq!(edit_distance("kitten", "sitting"), 3);
        assert_eq!(edit_distance("", "role"), 4);
        assert_eq!(edit_distance("role", "role"), 0);
    }

    #[test]
    fn only_near_words_are_proposed() {
        assert_eq!(did_you_mean("rol", &["role", "column"]), ", did you mean \"role\"?");
        assert_eq!(did_you_mean("weather", &["role", "column"]), "");
    }
}
