//! A look at the raw XML for what the URDF reader drops without a word.

use std::collections::BTreeSet;

use super::remarks::Remarks;

/// Elements that are read, each only where the URDF format has it.
const READ: &[(&str, &[&str])] = &[
    ("", &["robot"]),
    ("robot", &["link", "joint", "material"]),
    ("link", &["inertial", "visual", "collision"]),
    ("inertial", &["origin", "mass", "inertia"]),
    ("visual", &["origin", "geometry", "material"]),
    ("collision", &["origin", "geometry"]),
    ("geometry", &["box", "cylinder", "sphere", "mesh", "capsule"]),
    ("material", &["color"]),
    ("joint", &["origin", "parent", "child", "axis", "limit", "dynamics", "mimic"]),
];

/// What the scan found.
#[derive(Debug, Default, PartialEq)]
pub(super) struct XmlScan {
    /// Dropped elements.
    pub remarks: Remarks,
    /// Names of the links that have an `<inertial>`.
    pub links_with_inertial: BTreeSet<String>,
}

struct Open<'a> {
    element: &'a str,
    name: &'a str,
}

/// Walks the tags of a document that an XML parser has already accepted.
pub(super) fn scan(xml: &str) -> XmlScan {
    let mut found = XmlScan::default();
    let mut open: Vec<Open> = Vec::new();
    let mut dropped_depth: Option<usize> = None;
    let mut rest = xml;
    while let Some((tag, after)) = next_tag(rest) {
        rest = after;
        if tag.starts_with('/') {
            open.pop();
            if dropped_depth.is_some_and(|depth| open.len() <= depth) {
                dropped_depth = None;
            }
            continue;
        }
        let element = tag_name(tag);
        if dropped_depth.is_none() && !look_at(element, &open, &mut found) && !tag.ends_with('/') {
            dropped_depth = Some(open.len());
        }
        if !tag.ends_with('/') {
            let name = attribute(tag, "name").unwrap_or("");
            open.push(Open { element, name });
        }
    }
    found
}

/// How deep elements stand in each other, in a document that nobody has looked at yet.
pub(super) fn depth(xml: &str) -> usize {
    let (mut here, mut deepest, mut rest) = (0usize, 0, xml);
    while let Some((tag, after)) = next_tag(rest) {
        rest = after;
        if tag.starts_with('/') {
            here = here.saturating_sub(1);
        } else if !tag.ends_with('/') {
            here += 1;
            deepest = deepest.max(here);
        }
    }
    deepest
}

/// Notes one start tag; false when the element is dropped by the reader.
fn look_at(element: &str, open: &[Open], found: &mut XmlScan) -> bool {
    let parent = open.last().map_or("", |o| o.element);
    let read = READ.iter().any(|(p, children)| *p == parent && children.contains(&element));
    let owner = open.iter().rev().find(|o| !o.name.is_empty());
    if !read {
        let about = owner.map_or("robot".to_owned(), |o| format!("{} \"{}\"", o.element, o.name));
        let kind = format!("<{element}> is not read and has no effect; what it describes belongs into the scene file");
        found.remarks.add(kind, about);
    }
    if element == "inertial"
        && let Some(link) = owner
    {
        found.links_with_inertial.insert(link.name.to_owned());
    }
    read
}

/// The text between the next `<` and its `>`, and what follows; comments and declarations are skipped.
fn next_tag(mut rest: &str) -> Option<(&str, &str)> {
    loop {
        rest = &rest[rest.find('<')? + 1..];
        let skip_to = match rest {
            r if r.starts_with("!--") => "-->",
            r if r.starts_with("![CDATA[") => "]]>",
            r if r.starts_with('?') => "?>",
            r if r.starts_with('!') => ">",
            _ => {
                let end = tag_end(rest)?;
                return Some((&rest[..end], &rest[end + 1..]));
            }
        };
        rest = &rest[rest.find(skip_to)? + skip_to.len()..];
    }
}

/// Index of the `>` that ends a tag; one inside a quoted attribute does not.
fn tag_end(tag: &str) -> Option<usize> {
    let mut quote = None;
    tag.char_indices()
        .find(|&(_, c)| {
            match quote {
                Some(q) if c == q => quote = None,
                None if c == '"' || c == '\'' => quote = Some(c),
                _ => {}
            }
            quote.is_none() && c == '>'
        })
        .map(|(i, _)| i)
}

fn tag_name(tag: &str) -> &str {
    tag.split(|c: char| c.is_whitespace() || c == '/').next().unwrap_or("")
}

/// Value of an attribute of a start tag.
fn attribute<'a>(tag: &'a str, key: &str) -> Option<&'a str> {
    let mut rest = tag;
    loop {
        let at = rest.find(key)?;
        let before_is_space = rest[..at].ends_with(char::is_whitespace);
        rest = &rest[at + key.len()..];
        let value = rest.trim_start().strip_prefix('=').map(str::trim_start);
        if let (true, Some(value)) = (before_is_space, value) {
            let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
            return value[1..].split(quote).next();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dropped_elements_are_named_with_their_owner() {
        let found = scan(
            r#"<?xml version="1.0"?><!-- <link name="no"/> --><robot name="r">
            <link name="a"><inertial><mass value="1"/></inertial></link>
            <transmission name="t"><joint name="x"/></transmission>
            <joint name="j" type="revolute"><safety_controller k_velocity="1"/></joint>
            <gazebo:thing text="a > b"/></robot>"#,
        );
        let lines = found.remarks.lines();
        assert_eq!(lines.len(), 3, "{lines:?}");
        assert!(lines[0].starts_with("<transmission>") && lines[0].ends_with("robot \"r\""), "{lines:?}");
        assert!(lines[1].starts_with("<safety_controller>") && lines[1].ends_with("joint \"j\""), "{lines:?}");
        assert!(lines[2].starts_with("<gazebo:thing>"), "{lines:?}");
        assert!(found.links_with_inertial.contains("a"));
    }

    #[test]
    fn depth_counts_what_is_open() {
        let found = ["", "<a/>", "<a><b/><b><c/></b></a>", "</a><a>", "<!-- <a><b> --><a>", "<a"].map(depth);
        assert_eq!(found, [0, 0, 2, 1, 1, 0]);
    }

    #[test]
    fn broken_text_does_not_panic() {
        for text in ["", "<", "<a", "<a b='", "</", "<!--", "<a name>", "<é name=\"ü\">", "<a name="] {
            scan(text);
        }
    }
}
