//! Channels grouped into plots: the unit is the end of a name, the quantity a word in it.

/// Channels that share a plot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Group {
    /// Part of the entity path: `pressure_kpa`.
    pub(super) key: String,
    /// With its unit: `Pressure (kPa)`.
    pub(super) title: String,
    /// Indices into the scene's channels.
    pub(super) members: Vec<usize>,
    rank: usize,
}

/// A channel's name taken apart: `pressure_1_kpa` is `pressure`, `kpa`, with the label `pressure 1`.
struct Parts<'a> {
    quantity: &'a str,
    unit: &'a str,
    symbol: &'static str,
}

/// Endings of names and how the units are written; longer endings first where one ends another.
const UNITS: [(&str, &str); 31] = [
    ("m3_s", "m³/s"),
    ("mm3_s", "mm³/s"),
    ("ml_s", "ml/s"),
    ("ml_min", "ml/min"),
    ("ul_s", "µl/s"),
    ("mm_s", "mm/s"),
    ("m_s", "m/s"),
    ("rad_s", "rad/s"),
    ("deg_s", "°/s"),
    ("n_mm", "N·mm"),
    ("n_m", "N·m"),
    ("nm", "N·m"),
    ("kpa", "kPa"),
    ("mpa", "MPa"),
    ("pa", "Pa"),
    ("bar", "bar"),
    ("mm3", "mm³"),
    ("m3", "m³"),
    ("ml", "ml"),
    ("ul", "µl"),
    ("um", "µm"),
    ("mm", "mm"),
    ("deg", "°"),
    ("rad", "rad"),
    ("mn", "mN"),
    ("mj", "mJ"),
    ("n", "N"),
    ("j", "J"),
    ("m", "m"),
    ("s", "s"),
    ("v", "V"),
];

/// Quantities in the order in which their plots appear: along the chain.
const QUANTITIES: [&str; 14] = [
    "plunger",
    "pressure",
    "elongation",
    "angle",
    "tension",
    "force",
    "position",
    "flow",
    "volume",
    "pull",
    "moment",
    "torque",
    "velocity",
    "stretch",
];

/// Plots of the channels, in the order of the chain.
pub(super) fn groups(names: &[String]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (index, name) in names.iter().enumerate() {
        let key = key(name);
        match groups.iter_mut().find(|group| group.key == key) {
            Some(group) => group.members.push(index),
            None => groups.push(new_group(key, name, index)),
        }
    }
    groups.sort_by_key(|group| group.rank);
    groups
}

/// Name of a channel without its unit, for a legend.
pub(super) fn label(name: &str) -> String {
    let unit = parts(name).unit;
    let stem = name.strip_suffix(unit).map_or(name, |stem| stem.trim_end_matches('_'));
    if stem.is_empty() { name.to_owned() } else { stem.replace('_', " ") }
}

/// Name of a channel with its unit, for an axis: `tip force (N)`.
pub(super) fn axis_title(name: &str) -> String {
    with_unit(label(name), parts(name).symbol)
}

/// Group that a channel belongs to.
pub(super) fn key(name: &str) -> String {
    let parts = parts(name);
    if parts.unit.is_empty() {
        return parts.quantity.to_owned();
    }
    format!("{}_{}", parts.quantity, parts.unit)
}

/// How a channel's unit is written.
pub(super) fn symbol(name: &str) -> &'static str {
    parts(name).symbol
}

/// What to show large: a bending angle, else any output in degrees, else the first output.
pub(super) fn headline(names: &[String], input_count: usize) -> Option<usize> {
    let is_angle = |name: &str| parts(name).unit == "deg";
    let bending = names.iter().position(|name| is_angle(name) && name.contains("bend"));
    let output = || (input_count..names.len()).find(|&index| is_angle(&names[index]));
    bending.or_else(output).or((input_count < names.len()).then_some(input_count))
}

fn new_group(key: String, name: &str, index: usize) -> Group {
    let Parts { quantity, symbol, .. } = parts(name);
    let known = QUANTITIES.iter().position(|known| *known == quantity);
    Group {
        key,
        title: with_unit(capitalised(&quantity.replace('_', " ")), symbol),
        members: vec![index],
        rank: known.unwrap_or(QUANTITIES.len()),
    }
}

fn parts(name: &str) -> Parts<'_> {
    let found = UNITS.iter().find(|(unit, _)| name.strip_suffix(unit).is_some_and(|stem| stem.ends_with('_')));
    let (unit, symbol) = found.copied().unwrap_or(("", ""));
    let stem = name.strip_suffix(unit).unwrap_or(name).trim_end_matches('_');
    let word = QUANTITIES.into_iter().find(|known| stem.split('_').any(|word| word == *known));
    let quantity = word.unwrap_or_else(|| stem.trim_end_matches(|c: char| c.is_ascii_digit() || c == '_'));
    let quantity = if quantity.is_empty() { name } else { quantity };
    Parts { quantity, unit, symbol }
}

fn with_unit(text: String, symbol: &str) -> String {
    if symbol.is_empty() { text } else { format!("{text} ({symbol})") }
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(list: &[&str]) -> Vec<String> {
        list.iter().map(|name| (*name).to_owned()).collect()
    }

    #[test]
    fn plots_follow_the_chain_and_name_their_units() {
        let channels = names(&[
            "tension_left_n",
            "pressure_1_kpa",
            "plunger_1_mm",
            "elongation_1_mm",
            "pressure_2_kpa",
            "bending_angle_deg",
        ]);
        let groups = groups(&channels);
        let titles: Vec<_> = groups.iter().map(|group| group.title.as_str()).collect();
        assert_eq!(titles, ["Plunger (mm)", "Pressure (kPa)", "Elongation (mm)", "Angle (°)", "Tension (N)"]);
        assert_eq!(groups[1].members, [1, 4]);
        assert_eq!(headline(&channels, 1), Some(5));
    }

    #[test]
    fn unknown_quantities_keep_their_own_plot() {
        assert_eq!(key("sheath_curvature_2"), "sheath_curvature");
        assert_eq!(key("syringe_1_pressure_pa"), "pressure_pa");
        assert_eq!(key("x"), "x");
        assert_eq!(axis_title("tip_force_mn"), "tip force (mN)");
        assert_eq!(label("leak_ml_s"), "leak");
        assert_eq!(label("1_kpa"), "1");
    }
}
