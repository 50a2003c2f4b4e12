//! All effects there are: the catalogue's, each in a file, and laws that were written down during the run.

use std::ops::Deref;
use std::sync::{LazyLock, PoisonError, RwLock, RwLockReadGuard};

use super::Entry;

/// The text of each file of `entries/`.
macro_rules! files {
    ($($id:literal,)*) => { &[$(($id, include_str!(concat!("entries/", $id, ".toml"))),)*] };
}

/// The catalogue, along the chain: an entry more is a file more, and a line here.
const FILES: &[(&str, &str)] = files![
    "plunger_backlash",
    "seal_friction",
    "trapped_air",
    "leak",
    "chamber_leak",
    "chamber_gap",
    "chamber_orifice",
    "line_restriction",
    "thermal_expansion",
    "rubber_yeoh",
    "rubber_mooney_rivlin",
    "rubber_ogden",
    "rubber_gent",
    "viscoelasticity",
    "mullins_softening",
    "coil_preload",
    "plastic_set",
    "pressure_friction",
    "drive_backlash",
    "drive_nonlinearity",
    "cable_slack",
    "tendon_friction",
    "gravity_load",
    "bearing_friction",
    "tendon_coupling",
    "external_contact",
    "notch_closure",
    "sensor_lag",
    "sensor_delay",
    "sensor_drift",
    "sensor_gain",
    "hypothetical_force",
    "hypothetical_flow",
];

/// Which entry: its place among all, the catalogue's first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct EntryId(u32);

/// Entries are never taken away: each stays for as long as the program runs.
static ENTRIES: LazyLock<RwLock<Vec<&'static Entry>>> = LazyLock::new(|| {
    // A file with a fault would be left out; a test below reads every one.
    let all = FILES.iter().flat_map(|(id, text)| Entry::read(id, text));
    RwLock::new(all.map(|entry| &*Box::leak(Box::new(entry))).collect())
});

fn entries() -> RwLockReadGuard<'static, Vec<&'static Entry>> {
    ENTRIES.read().unwrap_or_else(PoisonError::into_inner)
}

impl EntryId {
    /// The entry, for as long as the program runs.
    pub fn entry(self) -> &'static Entry {
        // An id exists only once its entry does.
        entries()[self.0 as usize]
    }

    /// An entry that is there, or a new one.
    pub(super) fn known_or(is_same: impl Fn(&Entry) -> bool, new: impl FnOnce() -> Entry) -> Self {
        let mut entries = ENTRIES.write().unwrap_or_else(PoisonError::into_inner);
        if let Some(at) = entries.iter().position(|known| is_same(known)) {
            return Self(at as u32);
        }
        entries.push(Box::leak(Box::new(new())));
        Self(entries.len() as u32 - 1)
    }
}

impl Deref for EntryId {
    type Target = Entry;

    fn deref(&self) -> &Entry {
        self.entry()
    }
}

/// The catalogue, along the chain.
///
/// ```
/// use smam::effects::{catalogue, find};
///
/// let leak = find("leak").expect("of the catalogue");
/// assert_eq!((leak.name.as_str(), leak.element.name(), leak.equation.as_str()), ("leak", "line", "Q_leak = G p_m"));
/// assert_eq!(leak.parameters[0].key, "conductance_m3_s_pa");
/// // The first parameter is the size of the effect: zero, where it is absent, is within the range of each.
/// assert!(catalogue().all(|e| (e.parameters[0].range.min..=e.parameters[0].range.max).contains(&0.0)));
/// ```
pub fn catalogue() -> impl Iterator<Item = EntryId> + Clone {
    let count = entries().iter().take_while(|entry| entry.is_listed).count();
    (0..count as u32).map(EntryId)
}

/// The entry of the catalogue in this file; several may share a name.
pub fn find(id: &str) -> Option<EntryId> {
    catalogue().find(|entry| entry.id == id)
}

/// Names of the catalogue, each once.
pub fn names() -> Vec<&'static str> {
    let mut names: Vec<&str> = catalogue().map(|entry| entry.entry().name.as_str()).collect();
    names.dedup();
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_can_be_read_and_is_listed() {
        for (id, text) in FILES {
            let entry = Entry::read(id, text).unwrap_or_else(|e| panic!("entries/{id}.toml: {e}"));
            for p in &entry.parameters {
                let inside = |x: f64| x >= p.range.min && x <= p.range.max;
                assert!(inside(p.typical) && p.default.is_none_or(inside), "{id} {}", p.key);
            }
        }
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src/effects/entries");
        assert_eq!(std::fs::read_dir(folder).expect("the folder").count(), FILES.len(), "a file is not in FILES");
    }

    #[test]
    fn every_id_and_every_code_stands_once() {
        let ids: Vec<EntryId> = catalogue().collect();
        assert_eq!(ids.len(), FILES.len());
        for (i, id) in ids.iter().enumerate() {
            assert_eq!(find(&id.id), Some(*id));
            assert!(ids[..i].iter().all(|other| other.native.is_none() || other.native != id.native), "{}", id.id);
        }
    }
}
