//! Formulas of the catalogue as they are printed: Greek letters for their names.

const LETTERS: [(&str, &str); 8] = [
    ("alpha", "α"),
    ("beta", "β"),
    ("kappa", "κ"),
    ("mu", "μ"),
    ("omega", "ω"),
    ("sum", "Σ"),
    ("tau", "τ"),
    ("theta", "θ"),
];

/// Whole words only: `theta_max` is θ_max, `beta dT/dt` is β dT/dt, `mullins` stays.
pub fn greek(formula: &str) -> String {
    let mut printed = String::new();
    let mut rest = formula;
    while let Some(first) = rest.chars().next() {
        let length = rest.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(rest.len()).max(first.len_utf8());
        let (word, behind) = rest.split_at(length);
        printed += LETTERS.iter().find(|(name, _)| *name == word).map_or(word, |(_, letter)| letter);
        rest = behind;
    }
    printed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_words_become_letters() {
        assert_eq!(greek("T_i = T_0 exp(-mu z sum |theta|)"), "T_i = T_0 exp(-μ z Σ |θ|)");
        assert_eq!(greek("tau = tau_c z, |omega|/theta_pre"), "τ = τ_c z, |ω|/θ_pre");
        assert_eq!(greek("mullins, beyond τ"), "mullins, beyond τ");
    }
}
