//! Equal hinges in series as one coordinate: their sum.

use std::sync::Arc;

use nalgebra::DMatrix;

use crate::mechanism::{LinkPoint, Mechanism, Route};
use crate::scene::Scene;
use crate::system::PlantState;
use crate::system::SystemError;
use crate::system::build::{Built, slides};
use crate::system::coordinates::{CoordinateStop, Coordinates};
use crate::system::plant::Plant;
use crate::system::posed::{Posed, Posture};

/// A plant on few coordinates.
pub(super) struct Lumped {
    pub plant: Plant<f64>,
    pub state: PlantState<f64>,
    /// Of each coordinate (muscle ends too): how many hinges it stands for.
    pub hinges: Vec<usize>,
    /// Names of the joints of each joint coordinate, and whether they slide.
    pub names: Vec<Vec<String>>,
    pub slides: Vec<bool>,
    pub spring_table: Vec<Option<usize>>,
    /// Where links stand; none without a mechanism.
    pub posture: Option<Arc<Posture>>,
    pub link_names: Vec<String>,
}

/// Refuses scenes whose mechanism cannot be reduced.
pub(super) fn refuse_what_has_none(scene: &Scene, built: &Built) -> Result<(), SystemError> {
    let refuse = |table: &str, message: &str, remedy: &str| {
        Err(SystemError::Name {
            file: scene.path.clone(),
            table: table.to_owned(),
            message: format!("{message}: there is no reduced-order model of this scene"),
            remedy: remedy.to_owned(),
        })
    };
    if scene.file.mechanism.as_ref().is_some_and(|m| !m.body.is_empty() && m.contact.is_some()) {
        let remedy = "remove [mechanism.contact] if they touch nothing while recorded, else record without them";
        return refuse("[[mechanism.body]]", "bodies that links may touch need the rigid-body engine", remedy);
    }
    if !built.displacements.is_empty() {
        let remedy = "diagnose a recording of a scene without it";
        return refuse("[muscles.displacement]", "a displacement model has no forces", remedy);
    }
    Ok(())
}

/// Joins equal hinges and takes the inertia of the start pose.
pub(super) fn lump(scene: &Scene, mechanism: Option<&Mechanism>, built: Built) -> Result<Lumped, SystemError> {
    let full = &built.plant;
    let names: Vec<String> =
        mechanism.iter().flat_map(|m| m.coordinates()).map(|coordinate| coordinate.name.clone()).collect();
    let joints = names.len();
    let inertia = joint_inertia(mechanism, joints);
    let via = via(&built.routes);
    // A cable on via points has another lever on each hinge, and another in each pose.
    let alone: Vec<bool> = names.iter().map(|name| !via.is_empty() || has_own_law(scene, name)).collect();
    let groups = groups(full, &alone, &built.state, &inertia);
    let shares = Shares::of(&groups, joints, full.dim());
    let entry = |i: usize, j: usize| match i < joints && j < joints {
        true => inertia[(i, j)],
        false => full.coordinates.inertia[i * full.dim() + j],
    };
    let coordinates = Coordinates {
        inertia: shares.matrix(entry),
        damping: shares.sum(&full.coordinates.damping, 2),
        stiffness: shares.sum(&full.coordinates.stiffness, 2),
        rest: shares.sum(&full.coordinates.rest, 0),
        force: shares.sum(&with_weights(mechanism, loads(scene, &names)), 1),
        stops: groups.iter().enumerate().flat_map(|(new, group)| lumped_stops(full, new, group)).collect(),
        contact: None,
    };
    let posture = mechanism.map(|m| {
        Arc::new(Posture {
            linkage: m.linkage().clone(),
            shares: shares.place[..joints].to_vec(),
            joints: groups.len(),
            via,
            loads: shares.sum(&loads(scene, &names), 1),
        })
    });
    // Elsewhere levers stand still, and weights are those of the start pose.
    let posed = posture.clone().filter(|p| !p.via.is_empty()).map(|p| Box::new(Posed::new(p)));
    let mut plant = Plant { coordinates, posed, ..full.clone() };
    plant.muscles.iter_mut().for_each(|m| m.jacobian = shares.sum(&m.jacobian, 1));
    plant.cables.iter_mut().for_each(|c| c.jacobian = shares.sum(&c.jacobian, 1));
    let state = built.state.on_coordinates(&shares.sum(built.state.y(), 0));
    let mut hinges: Vec<usize> = groups.iter().map(Vec::len).collect();
    hinges.resize(shares.dim, 1);
    let group_names: Vec<Vec<String>> = groups.iter().map(|g| g.iter().map(|&i| names[i].clone()).collect()).collect();
    let tables = scene.file.mechanism.as_ref().map_or(&[][..], |m| &m.joint);
    let spring_table = group_names.iter().map(|g| tables.iter().rposition(|t| t.joints.contains(&g[0]))).collect();
    let kinds = slides(mechanism.map_or(&[][..], Mechanism::coordinates));
    let slides = groups.iter().map(|g| kinds[g[0]]).collect();
    // Bodies come after the links; where nothing touches them they are no part of the model.
    let bodies = scene.file.mechanism.as_ref().map_or(0, |m| m.body.len());
    let mut link_names = mechanism.map_or_else(Vec::new, |m| m.link_names().to_vec());
    link_names.truncate(link_names.len().saturating_sub(bodies));
    Ok(Lumped { plant, state, hinges, names: group_names, slides, spring_table, posture, link_names })
}

/// Whether a law names this very joint.
fn has_own_law(scene: &Scene, joint: &str) -> bool {
    scene.laws.iter().any(|law| law.address.of.as_deref() == Some(joint))
}

fn joint_inertia(mechanism: Option<&Mechanism>, joints: usize) -> DMatrix<f64> {
    let mut inertia = DMatrix::zeros(joints, joints);
    if let (Some(mechanism), true) = (mechanism, joints > 0) {
        mechanism.mass_matrix(&mut inertia);
    }
    inertia
}

/// Cables on via points.
fn via(routes: &[Route]) -> Vec<(usize, Vec<LinkPoint>)> {
    let points = |route: &Route| match route {
        Route::Via(points) => Some(points.clone()),
        Route::Levers { .. } => None,
    };
    routes.iter().enumerate().filter_map(|(i, route)| Some((i, points(route)?))).collect()
}

/// Loads on the joints.
fn loads(scene: &Scene, names: &[String]) -> Vec<f64> {
    let mut force = vec![0.0; names.len()];
    for load in &scene.file.load {
        if let Some(i) = names.iter().position(|n| *n == load.joint) {
            force[i] += load.force_n.or(load.torque_n_m).unwrap_or(0.0);
        }
    }
    force
}

/// The same with the weights in the start pose.
fn with_weights(mechanism: Option<&Mechanism>, loads: Vec<f64>) -> Vec<f64> {
    let mut force = vec![0.0; loads.len()];
    if let (Some(mechanism), false) = (mechanism, loads.is_empty()) {
        mechanism.weight(&mut force);
    }
    force.iter().zip(&loads).map(|(weight, load)| weight + load).collect()
}

/// How old coordinates go into new ones: hinges that are joined turn by equal shares of their group's angle.
struct Shares {
    /// Of each old coordinate: its new one and its share of it.
    place: Vec<(usize, f64)>,
    /// Number of the new ones.
    dim: usize,
}

impl Shares {
    /// Joints go by groups, what comes after them stays as it is.
    fn of(groups: &[Vec<usize>], joints: usize, full_dim: usize) -> Self {
        let mut place = vec![(0, 1.0); full_dim];
        for (new, group) in groups.iter().enumerate() {
            group.iter().for_each(|&old| place[old] = (new, 1.0 / group.len() as f64));
        }
        (joints..full_dim).for_each(|old| place[old].0 = groups.len() + old - joints);
        Self { place, dim: groups.len() + full_dim - joints }
    }

    /// Sums of values times a power of their shares: 0 of angles, 1 of forces and levers, 2 of springs and dampers.
    fn sum(&self, values: &[f64], power: usize) -> Vec<f64> {
        let mut sum = vec![0.0; self.dim];
        for (value, (new, share)) in values.iter().zip(&self.place) {
            sum[*new] += (0..power).fold(*value, |product, _| product * share);
        }
        sum
    }

    /// The same of a matrix, row by row.
    fn matrix(&self, entry: impl Fn(usize, usize) -> f64) -> Vec<f64> {
        let mut matrix = vec![0.0; self.dim * self.dim];
        for (i, (a, share_a)) in self.place.iter().enumerate() {
            for (j, (b, share_b)) in self.place.iter().enumerate() {
                matrix[a * self.dim + b] += entry(i, j) * share_a * share_b;
            }
        }
        matrix
    }
}

/// Joints that may be joined: equal in lever, spring, damper, rest, start and stops, and without a muscle on them.
fn groups(plant: &Plant<f64>, alone: &[bool], state: &PlantState<f64>, inertia: &DMatrix<f64>) -> Vec<Vec<usize>> {
    let joints = alone.len();
    let c = &plant.coordinates;
    let stops = |i: usize| -> Vec<CoordinateStop> {
        c.stops.iter().filter(|s| s.coordinate == i).map(|s| CoordinateStop { coordinate: 0, ..*s }).collect()
    };
    let bears_muscle = |i: usize| plant.muscles.iter().any(|m| m.jacobian[i] != 0.0);
    let alike = |a: usize, b: usize| {
        plant.cables.iter().all(|cable| {
            cable.jacobian[a] == cable.jacobian[b] && cable.jacobian[a] != 0.0 || {
                cable.jacobian[a] == 0.0 && cable.jacobian[b] == 0.0
            }
        }) && c.damping[a] == c.damping[b]
            && c.stiffness[a] == c.stiffness[b]
            && c.rest[a] == c.rest[b]
            && state.y()[a] == state.y()[b]
            && stops(a) == stops(b)
            && inertia[(a, b)] != 0.0
    };
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for i in 0..joints {
        let stays = |i: usize| alone[i] || bears_muscle(i);
        let home = groups.iter_mut().find(|g| !stays(i) && !stays(g[0]) && alike(g[0], i));
        match home {
            Some(group) => group.push(i),
            None => groups.push(vec![i]),
        }
    }
    groups
}

/// Stops of a group: met by all its hinges together.
fn lumped_stops(plant: &Plant<f64>, new: usize, group: &[usize]) -> Vec<CoordinateStop> {
    let n = group.len() as f64;
    let own = plant.coordinates.stops.iter().filter(|s| s.coordinate == group[0]);
    own.map(|s| CoordinateStop {
        coordinate: new,
        position: s.position * n,
        side: s.side,
        stiffness: s.stiffness / n,
        damping: s.damping / n,
    })
    .collect()
}
