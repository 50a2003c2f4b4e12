//! That what acts on a joint fits its kind: a muscle's end and a force a slider, a torque a hinge.

use super::SystemError;
use crate::mechanism::{CoordinateKind, Mechanism};
use crate::scene::Scene;

/// Refuses muscles and loads on joints of the other kind: newtons would be taken for newton metres, metres for radians.
pub(super) fn check(scene: &Scene, mechanism: Option<&Mechanism>) -> Result<(), SystemError> {
    let coordinates = mechanism.map_or(&[][..], Mechanism::coordinates);
    let kind = |joint: &str| coordinates.iter().find(|c| c.name == joint).map(|c| c.kind);
    let error = |table: String, message: String, remedy: &str| {
        Err(SystemError::Name { file: scene.path.clone(), table, message, remedy: remedy.to_owned() })
    };
    for muscle in &scene.file.muscle {
        let Some(joint) = muscle.joint.as_deref().filter(|joint| kind(joint) == Some(CoordinateKind::Angle)) else {
            continue;
        };
        return error(
            format!("[[muscle]] \"{}\"", muscle.name),
            format!("joint = \"{joint}\" is a hinge, and a muscle's free end moves along a line"),
            "name a prismatic joint, or let the muscle pull a [[cable]] whose route has a lever on the hinge",
        );
    }
    for load in &scene.file.load {
        let table = format!("[[load]] \"{}\"", load.joint);
        match (kind(&load.joint), load.force_n, load.torque_n_m) {
            (Some(CoordinateKind::Angle), Some(force), _) => {
                let message = format!("force_n = {force} is a force, and this joint is a hinge");
                return error(table, message, "write torque_n_m in its place, in N m");
            }
            (Some(CoordinateKind::Length), _, Some(torque)) => {
                let message = format!("torque_n_m = {torque} is a torque, and this joint is a slider");
                return error(table, message, "write force_n in its place, in N");
            }
            _ => {}
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::scene::{Override, Scene};
    use crate::system::Simulation;

    fn refused(scene: &str, change: &str) -> String {
        let change = Override::parse(change).expect("written rightly");
        let scene = Scene::load(scene, &[change]).expect("nothing that needs the mechanism");
        Simulation::new(scene).err().map_or_else(String::new, |e| e.to_string())
    }

    #[test]
    fn what_acts_on_a_joint_fits_its_kind() {
        let load = |key: &str| format!("load=[{{joint=\"pulley\", {key}=0.01}}]");
        let said = refused("antagonistic_pulley", &load("force_n"));
        assert!(said.contains("[[load]] \"pulley\": force_n = 0.01") && said.contains("write torque_n_m"), "{said}");
        assert_eq!(refused("antagonistic_pulley", &load("torque_n_m")), "");
        let said = refused("muscle_bench", "load=[{joint=\"slide\", torque_n_m=0.1}]");
        assert!(said.contains("is a slider") && said.contains("write force_n"), "{said}");
        let muscle = "muscle=[{name=\"a\", input=\"plunger_1_mm\", joint=\"pulley\"}]";
        let outputs = "output=[{channel=\"angle_deg\", quantity=\"joint_position\", of=[\"pulley\"]}]";
        let changes = [muscle, outputs, "cable=[]", "view={}", "expect=[]", "calibrate=[]"];
        let changes: Vec<Override> = changes.iter().map(|c| Override::parse(c).expect("written rightly")).collect();
        let scene = Scene::load("antagonistic_pulley", &changes).expect("nothing that needs the mechanism");
        let said = Simulation::new(scene).err().map_or_else(String::new, |e| e.to_string());
        assert!(said.contains("[[muscle]] \"a\": joint = \"pulley\" is a hinge"), "{said}");
    }
}
