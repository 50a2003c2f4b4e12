//! Elements of the chain, by the names that scenes and diagnoses use.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::laws::numbered;

/// A link of the chain from the plunger to what is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ElementKind {
    Syringe,
    Line,
    Muscle,
    Cable,
    Mechanism,
    Sensor,
}

impl ElementKind {
    /// All, along the chain.
    pub const ALL: [Self; 6] = [Self::Syringe, Self::Line, Self::Muscle, Self::Cable, Self::Mechanism, Self::Sensor];

    /// Its name in scenes and answers.
    pub fn name(self) -> &'static str {
        match self {
            Self::Syringe => "syringe",
            Self::Line => "line",
            Self::Muscle => "muscle",
            Self::Cable => "cable",
            Self::Mechanism => "mechanism",
            Self::Sensor => "sensor",
        }
    }

    /// Whether a rig with two muscles has one for each.
    pub(crate) fn is_numbered(self) -> bool {
        matches!(self, Self::Syringe | Self::Line | Self::Muscle | Self::Cable)
    }
}

/// An element of one rig: `line` where there is one, `line_1`, `line_2` where there are two; `line` then means both.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Element {
    pub kind: ElementKind,
    /// Counts from 0.
    pub index: usize,
    /// Whether the name carries the number.
    pub is_numbered: bool,
}

impl Element {
    /// Element `index` of `count` of its kind.
    pub fn of(kind: ElementKind, index: usize, count: usize) -> Self {
        Self { kind, index, is_numbered: count > 1 && kind.is_numbered() }
    }

    /// Which of `count` elements of the kind are meant; none where there is none.
    pub fn indices(&self, count: usize) -> std::ops::Range<usize> {
        if self.is_numbered { self.index..(self.index + 1).min(count) } else { 0..count }
    }

    /// Reads `line`, `line_2` (also written `line2`, `line 2`, `line[2]`); `None` for anything else.
    pub fn parse(text: &str) -> Option<Self> {
        let plain = |name: &str| ElementKind::ALL.into_iter().find(|k| k.name() == name);
        if let Some(kind) = plain(text) {
            return Some(Self { kind, index: 0, is_numbered: false });
        }
        let (name, number) = numbered(text)?;
        let kind = plain(name).filter(|k| k.is_numbered())?;
        Some(Self { kind, index: number.checked_sub(1)?, is_numbered: true })
    }
}

impl fmt::Display for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.kind.name())?;
        if self.is_numbered { write!(f, "_{}", self.index + 1) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plain_name_means_all_there_are() {
        let of = |name: &str, count: usize| Element::parse(name).map(|e| e.indices(count).collect::<Vec<_>>());
        assert_eq!(of("line", 2), Some(vec![0, 1]));
        assert_eq!(of("line_2", 2), Some(vec![1]));
        assert_eq!(of("syringe", 0), Some(vec![]));
    }

    #[test]
    fn names_go_there_and_back() {
        for name in ["syringe", "line_1", "muscle_2", "cable", "mechanism", "sensor"] {
            assert_eq!(Element::parse(name).map(|e| e.to_string()).as_deref(), Some(name));
        }
        for written in ["line2", "line 2", "line[2]"] {
            assert_eq!(Element::parse(written), Element::parse("line_2"), "{written}");
        }
        for wrong in ["", "line_0", "mechanism_1", "muscles", "line_x"] {
            assert_eq!(Element::parse(wrong), None, "{wrong}");
        }
    }
}
