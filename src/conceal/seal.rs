//! Seals: a hash in the open, the answer apart.

use sha2::{Digest, Sha256};

use super::case::Truth;

/// The answer as the text that is sealed.
///
/// # Errors
/// None in practice: a truth holds nothing that JSON cannot say but numbers that are not finite.
pub fn sealed_text(truth: &Truth) -> Result<String, serde_json::Error> {
    Ok(format!("{}\n", serde_json::to_string_pretty(truth)?))
}

/// SHA-256 of a text, in hexadecimal.
///
/// ```
/// use smam::conceal::seal;
///
/// assert_eq!(seal("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
/// ```
pub fn seal(text: &str) -> String {
    Sha256::digest(text.as_bytes()).iter().map(|b| format!("{b:02x}")).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_seal_is_sha_256() {
        let known = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(super::seal("abc"), known);
    }
}
