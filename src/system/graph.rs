//! What a running scene shows: the fixed graph and one frame.

use super::Simulation;
use super::channels::Channels;
use super::observe::{CableFrame, Frame, JointGraph, LawFrame, MuscleFrame, MuscleGraph, SceneGraph};
use crate::mechanism::{CoordinateKind, Mechanism};

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
        let drawn = self.scene.file.muscle.iter().zip(&self.scene.makes).map(|(m, make)| {
            let coil = make.tube.as_ref().map(|t| t.coil);
            MuscleGraph {
                name: m.name.clone(),
                outer_diameter_m: coil.map_or(1.45e-3, |c| c.outer_diameter_m),
                coil_turns: coil.map_or(250.0, |c| c.turns),
                rest_length_m: make.rest_length_m,
                anchor_m: m.anchor_m,
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
            energy_j: self.energy.as_ref().map_or(Vec::new(), |book| book.lines()),
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
        Some([0, 1, 2].map(|k| spec.anchor_m[k] + spec.direction[k] * length))
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
