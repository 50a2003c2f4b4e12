//! What a running scene shows: the fixed graph and one frame.

use nalgebra::Vector3;

use super::Simulation;
use super::channels::Channels;
use super::observe::{CableFrame, Frame, JointGraph, LawFrame, MuscleFrame, MuscleGraph, SceneGraph};
use crate::mechanism::{CoordinateKind, Mechanism};
use crate::scene::MuscleSpec;

/// From the fixed end of a muscle to its cable's first point, in lengths of the muscle at the start.
const GAP: f64 = 1.3;

/// Between muscles that would lie in one place, m.
const BESIDE_M: f64 = 0.006;

impl Simulation {
    /// What stays the same during the run.
    pub(super) fn graph(&self, channels: &Channels) -> SceneGraph {
        let file = &self.scene.file;
        let find = |name: &String| channels.names.iter().position(|n| n == name);
        let links = self.mechanism.as_ref().map_or(Vec::new(), |m| m.link_names().to_vec());
        SceneGraph {
            name: file.name.clone(),
            channels: channels.names.clone(),
            input_count: file.input.len(),
            tip_link: file.view.tip_link.as_ref().and_then(|t| links.iter().position(|l| l == t)),
            links,
            visuals: self.mechanism.as_ref().map_or(Vec::new(), |m| m.visuals().to_vec()),
            joints: self.mechanism.as_ref().map_or(Vec::new(), joint_graphs),
            cables: file.cable.iter().map(|c| c.name.clone()).collect(),
            muscles: self.muscle_graphs(),
            laws: self.built.plant.laws.as_ref().map_or(Vec::new(), |laws| laws.graphs()),
            loops: file.view.loops.iter().filter_map(|(x, y)| Some((find(x)?, find(y)?))).collect(),
            camera_target_m: file.view.camera_target_m,
            camera_position_m: file.view.camera_position_m,
        }
    }

    fn muscle_graphs(&self) -> Vec<MuscleGraph> {
        let muscles = self.scene.file.muscle.iter().zip(&self.scene.makes).zip(&self.anchors_m);
        let drawn = muscles.map(|((m, make), anchor_m)| {
            let coil = make.tube.as_ref().map(|t| t.coil);
            MuscleGraph {
                name: m.name.clone(),
                outer_diameter_m: coil.map_or(1.45e-3, |c| c.outer_diameter_m),
                coil_turns: coil.map_or(250.0, |c| c.turns),
                rest_length_m: make.rest_length_m,
                anchor_m: *anchor_m,
                direction: m.direction,
            }
        });
        drawn.collect()
    }

    /// The present instant.
    pub(super) fn frame(&self, channels: &mut Channels, events: Vec<String>) -> Frame {
        let mut values = Vec::new();
        channels.read(self, &mut values);
        let joints = self.mechanism.as_ref().map_or(0, |m| m.coordinates().len());
        Frame {
            time_s: self.time_s,
            channels: values,
            link_poses: self.mechanism.as_ref().map_or(Vec::new(), |m| m.link_poses()),
            cables: self.cable_frames(),
            muscles: self.muscle_frames(),
            laws: self.law_frames(),
            contacts: self.mechanism.as_ref().map_or(Vec::new(), |m| m.contacts()),
            joint_positions: self.built.state.y()[..joints].to_vec(),
            events,
            energy_j: self.energy.as_ref().map_or(Vec::new(), |balance| balance.lines()),
        }
    }

    fn cable_frames(&self) -> Vec<CableFrame> {
        let spans = self.end_spans();
        let Some(mechanism) = &self.mechanism else { return Vec::new() };
        let frames = self.built.routes.iter().enumerate().map(|(i, route)| {
            let mut points = mechanism.cable_points(route);
            if let Some(end) = self.muscle_end_of_cable(i) {
                points.insert(0, end);
            }
            CableFrame { points_m: points, tension_n: self.built.plant.cable(i, &self.built.state, &spans, 0.0).2 }
        });
        frames.collect()
    }

    /// Where the muscle that pulls a cable ends now, m.
    fn muscle_end_of_cable(&self, cable: usize) -> Option<[f64; 3]> {
        let name = &self.scene.file.cable[cable].name;
        let index = self.scene.file.muscle.iter().position(|m| m.cable.as_ref() == Some(name))?;
        let spec = &self.scene.file.muscle[index];
        let make = self.scene.makes.get(index)?;
        let length = make.rest_length_m + self.muscle_frames().get(index)?.elongation_m;
        let anchor_m = self.anchors_m.get(index)?;
        Some([0, 1, 2].map(|k| anchor_m[k] + spec.direction[k] * length))
    }

    /// Where to draw the fixed end of each muscle, m: as the scene says, else behind the first point of its cable, or at the origin; beside
    /// those that are there already.
    pub(super) fn place_muscles(&self) -> Vec<[f64; 3]> {
        let lengths = self.scene.makes.iter().zip(self.muscle_frames()).map(|(m, f)| m.rest_length_m + f.elongation_m);
        let graph = self.scene.file.muscle.iter().zip(lengths);
        graph.fold(Vec::new(), |mut placed, (spec, length)| {
            let own = spec.anchor_m.unwrap_or_else(|| {
                let anchor = self.behind_cable(spec, GAP * length).unwrap_or_default();
                beside(anchor, spec.direction, &placed)
            });
            placed.push(own);
            placed
        })
    }

    /// A place so far behind the first point of the muscle's cable.
    fn behind_cable(&self, spec: &MuscleSpec, distance_m: f64) -> Option<[f64; 3]> {
        let cable = self.scene.file.cable.iter().position(|c| Some(&c.name) == spec.cable.as_ref())?;
        let first = *self.mechanism.as_ref()?.cable_points(self.built.routes.get(cable)?).first()?;
        Some([0, 1, 2].map(|k| first[k] - distance_m * spec.direction[k]))
    }

    fn law_frames(&self) -> Vec<LawFrame> {
        let plant = &self.built.plant;
        plant.laws.as_ref().map_or(Vec::new(), |laws| laws.frames(plant, &self.built.state, &self.end_spans()))
    }

    fn muscle_frames(&self) -> Vec<MuscleFrame> {
        let spans = self.end_spans();
        let frames = self.built.muscle_index.iter().enumerate().map(|(i, plant_index)| match plant_index {
            Some(m) => {
                let f = self.built.plant.muscle_forces(*m, &self.built.state, &spans, 0.0);
                MuscleFrame { elongation_m: f.elongation_m, pressure_pa: f.pressure_pa, pull_n: f.pull_n() }
            }
            None => {
                let input = self.built.displacements.iter().find(|d| d.muscle == i).map(|d| d.input);
                MuscleFrame { elongation_m: input.map_or(0.0, |i| spans[i].value), ..MuscleFrame::default() }
            }
        });
        frames.collect()
    }
}

/// The place itself, or the nearest one across the direction where no muscle lies yet.
fn beside(place: [f64; 3], direction: [f64; 3], taken: &[[f64; 3]]) -> [f64; 3] {
    let direction = Vector3::from(direction);
    let across = direction.cross(&Vector3::z()).try_normalize(1e-6).unwrap_or_else(Vector3::y);
    let moved = |times: usize| Vector3::from(place) - times as f64 * BESIDE_M * across;
    let is_free = |own: &Vector3<f64>| taken.iter().all(|other| (own - Vector3::from(*other)).norm() > 0.5 * BESIDE_M);
    // Of so many places one is free, but where the numbers are too large to tell them apart.
    (0..=taken.len()).map(moved).find(is_free).unwrap_or_else(|| place.into()).into()
}

fn joint_graphs(mechanism: &Mechanism) -> Vec<JointGraph> {
    let joints = mechanism.coordinates().iter().zip(mechanism.moved());
    let graph = joints.map(|(c, moved)| JointGraph {
        name: c.name.clone(),
        is_angle: c.kind == CoordinateKind::Angle,
        link: moved.link,
        axis: moved.axis,
    });
    graph.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn a_rig_that_says_nothing_of_drawing_is_drawn_apart_and_whole() {
        let mut scene = Scene::load("antagonistic_pulley", &[]).expect("a stock scene");
        scene.file.muscle.iter_mut().for_each(|muscle| muscle.anchor_m = None);
        scene.file.cable.iter_mut().for_each(|cable| cable.route.draw.clear());
        let simulation = Simulation::new(scene).expect("right");
        let [first, second] = [0, 1].map(|i| Vector3::from(simulation.anchors_m[i]));
        // On opposite sides of the pulley, as its levers are.
        assert!((first.y - 8e-3).abs() < 1e-12 && (second.y + 8e-3).abs() < 1e-12, "{first} {second}");
        for cable in simulation.cable_frames() {
            let [from, to] = cable.points_m[..] else { panic!("{:?}", cable.points_m) };
            assert!(from[0] < to[0] && (from[1] - to[1]).abs() < 1e-12, "{from:?} {to:?}");
        }
        let in_one_place = beside([0.0; 3], [1.0, 0.0, 0.0], &[[0.0; 3], [0.0, BESIDE_M, 0.0]]);
        assert_eq!(in_one_place, [0.0, 2.0 * BESIDE_M, 0.0]);
    }
}
