//! What a URDF holds that has no effect here, gathered by kind: other people's files repeat themselves.

/// Kinds in the order in which they were met, each with what it is about.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Remarks {
    kinds: Vec<(String, Vec<String>)>,
}

/// Names that one line gives before it counts the rest.
const NAMED: usize = 4;

impl Remarks {
    pub fn add(&mut self, kind: impl Into<String>, about: impl Into<String>) {
        let (kind, about) = (kind.into(), about.into());
        match self.kinds.iter_mut().find(|(known, _)| *known == kind) {
            Some((_, all)) => all.push(about),
            None => self.kinds.push((kind, vec![about])),
        }
    }

    /// One line per kind.
    pub fn lines(&self) -> Vec<String> {
        let line = |(kind, all): &(String, Vec<String>)| {
            let named = all[..all.len().min(NAMED)].join(", ");
            match all.len().saturating_sub(NAMED) {
                0 => format!("{kind}: {named}"),
                more => format!("{kind}: {named} and {more} more"),
            }
        };
        self.kinds.iter().map(line).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_line_per_kind_however_many_it_is_about() {
        let mut remarks = Remarks::default();
        for n in 0..20 {
            remarks.add("not read", format!("joint \"{n}\""));
        }
        remarks.add("not drawn", "a.dae");
        assert_eq!(
            remarks.lines(),
            ["not read: joint \"0\", joint \"1\", joint \"2\", joint \"3\" and 16 more", "not drawn: a.dae"]
        );
    }
}
