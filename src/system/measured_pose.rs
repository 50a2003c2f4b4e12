//! Where the links were according to a recording: the scene's mechanism put into the measured angles.

use crate::mechanism::{Mechanism, Pose};
use crate::recording::parse_column;
use crate::scene::{OutputSpec, Quantity, Scene};

use super::SystemError;

/// Coordinates that a recorded column gives, and how: position = `offset + gain * value` (column's unit).
struct Reading<'a> {
    values: &'a [f64],
    coordinates: Vec<usize>,
    gain: f64,
    offset: f64,
}

/// Pose of each link at every sample of a recording; empty when no recorded column tells a joint of the mechanism.
///
/// A sum of angles is shared out evenly over its joints. Joints that were not recorded stay where they start, and a
/// missing sample keeps the last pose.
///
/// # Errors
/// A mechanism that cannot be loaded.
pub fn measured_poses(scene: &Scene, recorded: &[(&str, &[f64])]) -> Result<Vec<Vec<Pose>>, SystemError> {
    let Some(spec) = &scene.file.mechanism else { return Ok(Vec::new()) };
    let mut mechanism = Mechanism::load(spec, scene.folder())
        .map_err(|source| SystemError::Mechanism { file: scene.path.clone(), source })?;
    let readings: Vec<Reading> =
        recorded.iter().filter_map(|(column, values)| reading(scene, &mechanism, column, values)).collect();
    let count = readings.iter().map(|r| r.values.len()).min().unwrap_or(0);
    let mut positions: Vec<f64> = mechanism.coordinates().iter().map(|c| c.initial).collect();
    let mut poses = Vec::with_capacity(count);
    for i in 0..count {
        for r in readings.iter().filter(|r| r.values[i].is_finite()) {
            let each = r.offset + r.gain * r.values[i] / r.coordinates.len() as f64;
            r.coordinates.iter().for_each(|&c| positions[c] = each);
        }
        mechanism.place(&positions);
        poses.push(mechanism.link_poses());
    }
    Ok(poses)
}

fn reading<'a>(scene: &Scene, mechanism: &Mechanism, column: &str, values: &'a [f64]) -> Option<Reading<'a>> {
    let output = scene.file.output.iter().find(|o| o.channel == column)?;
    let gain = parse_column(column).ok()?.unit.factor;
    let find = |name: &String| mechanism.coordinates().iter().position(|c| c.name == *name);
    match output.quantity {
        Quantity::JointPosition => {
            let coordinates: Option<Vec<usize>> = output.of.iter().map(find).collect();
            Some(Reading { values, coordinates: coordinates.filter(|c| !c.is_empty())?, gain, offset: 0.0 })
        }
        Quantity::Elongation => {
            let (joint, elongation_0_m) = muscle_joint(scene, output)?;
            let coordinate = find(joint)?;
            // The muscle starts with its pre-elongation where the joint starts.
            let offset = mechanism.coordinates()[coordinate].initial - elongation_0_m;
            Some(Reading { values, coordinates: vec![coordinate], gain, offset })
        }
        _ => None,
    }
}

/// The joint that a muscle moves by itself, and its elongation at the start.
fn muscle_joint<'a>(scene: &'a Scene, output: &OutputSpec) -> Option<(&'a String, f64)> {
    let mut muscles = scene.file.muscle.iter().zip(&scene.makes);
    let (muscle, make) = muscles.find(|(m, _)| Some(&m.name) == output.of.first())?;
    Some((muscle.joint.as_ref()?, make.pre_elongation_ratio * make.rest_length_m))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::{Schedule, Simulation, record};

    /// Poses from recorded angles are those of the engine that recorded them.
    #[test]
    fn poses_are_those_that_were_recorded() {
        for (name, column) in
            [("muscle_bench", "elongation_mm"), ("antagonistic_pulley", "angle_deg"), ("bending_catheter", "bend_deg")]
        {
            let scene = Scene::load(name, &[]).unwrap_or_else(|e| panic!("{e}"));
            let mut simulation = Simulation::new(scene.clone()).unwrap_or_else(|e| panic!("{e}"));
            let recording = record(&mut simulation, &Schedule::even(2.5, 0.5)).unwrap_or_else(|e| panic!("{e}"));
            let values = &recording.find(column).expect("a channel").values;
            let poses = measured_poses(&scene, &[(column, values)]).unwrap_or_else(|e| panic!("{e}"));
            let mechanism = simulation.mechanism.as_ref().expect("loaded");
            let last = mechanism.link_poses();
            let tip = scene.file.view.tip_link.clone().expect("named");
            let link = mechanism.link_names().iter().position(|l| *l == tip).expect("a link");
            let (is, was) = (poses.last().expect("samples")[link], last[link]);
            let apart = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt();
            let moved = apart(was.translation_m, poses[0][link].translation_m);
            println!("{name}: {:.2e} m apart after {moved:.2e} m", apart(is.translation_m, was.translation_m));
            // The hinges of the catheter share the angle almost evenly.
            assert!(apart(is.translation_m, was.translation_m) < 2e-4, "{name}");
        }
    }

    #[test]
    fn nothing_that_tells_a_joint_is_no_pose() {
        let scene = Scene::load("muscle_bench", &[]).expect("stock");
        assert!(measured_poses(&scene, &[("pressure_kpa", &[1.0, 2.0])]).expect("loads").is_empty());
    }
}
