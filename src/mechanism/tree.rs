//! The kinematic tree of a URDF: unique names, one root, no loops.

use std::collections::BTreeMap;
use std::path::Path;

use urdf_rs::Robot;

use super::error::{MechanismError, known_names};

/// Links in an order in which parents come first.
#[derive(Debug)]
pub(super) struct Tree {
    /// Link indices, root first.
    pub order: Vec<usize>,
    /// Index of the joint that carries each link; `None` for the root.
    pub carrier: Vec<Option<usize>>,
    /// Index of each joint's parent link.
    pub parent: Vec<usize>,
}

impl Tree {
    /// Checks names and connections.
    pub fn new(file: &Path, robot: &Robot) -> Result<Self, MechanismError> {
        let links = index_names(file, "link", robot.links.iter().map(|l| l.name.as_str()))?;
        index_names(file, "joint", robot.joints.iter().map(|j| j.name.as_str()))?;
        let mut carrier = vec![None; robot.links.len()];
        let mut parent = Vec::with_capacity(robot.joints.len());
        for (index, joint) in robot.joints.iter().enumerate() {
            parent.push(find(file, &links, &joint.name, &joint.parent.link)?);
            let child = find(file, &links, &joint.name, &joint.child.link)?;
            if let Some(other) = carrier[child].replace(index) {
                let problem = format!(
                    "carries link \"{}\", which joint \"{}\" carries already",
                    joint.child.link, robot.joints[other].name
                );
                let remedy = "a URDF is a tree: cut the loop";
                return Err(MechanismError::urdf(file, "joint", &joint.name, problem, remedy));
            }
        }
        let order = order_from_root(file, robot, &carrier, &parent)?;
        Ok(Self { order, carrier, parent })
    }
}

fn index_names<'a>(
    file: &Path,
    element: &'static str,
    names: impl Iterator<Item = &'a str>,
) -> Result<BTreeMap<&'a str, usize>, MechanismError> {
    let mut index = BTreeMap::new();
    for (i, name) in names.enumerate() {
        if index.insert(name, i).is_some() {
            let problem = "this name is used twice";
            return Err(MechanismError::urdf(file, element, name, problem, "rename one"));
        }
    }
    Ok(index)
}

fn find(file: &Path, links: &BTreeMap<&str, usize>, joint: &str, link: &str) -> Result<usize, MechanismError> {
    links.get(link).copied().ok_or_else(|| {
        let problem = format!("there is no link \"{link}\"");
        let remedy = known_names(links.keys().copied());
        MechanismError::urdf(file, "joint", joint, problem, remedy)
    })
}

fn order_from_root(
    file: &Path,
    robot: &Robot,
    carrier: &[Option<usize>],
    parent: &[usize],
) -> Result<Vec<usize>, MechanismError> {
    let roots: Vec<usize> = (0..carrier.len()).filter(|&l| carrier[l].is_none()).collect();
    let [root] = roots[..] else {
        let names: Vec<&str> = roots.iter().map(|&l| robot.links[l].name.as_str()).collect();
        let problem = format!("has {} root links ({})", roots.len(), names.join(", "));
        let remedy = "exactly one link must be carried by no joint";
        return Err(MechanismError::urdf(file, "robot", &robot.name, problem, remedy));
    };
    let mut order = vec![root];
    let mut next = 0;
    while next < order.len() {
        let here = order[next];
        order.extend((0..carrier.len()).filter(|&l| carrier[l].is_some_and(|j| parent[j] == here)));
        next += 1;
    }
    if let Some(lost) = (0..carrier.len()).find(|l| !order.contains(l)) {
        let problem = "is in a loop that never reaches the root";
        let remedy = "a URDF is a tree: cut the loop";
        let name = &robot.links[lost].name;
        return Err(MechanismError::urdf(file, "link", name, problem, remedy));
    }
    Ok(order)
}
