//! A finger of one's own: a URDF of two phalanges, bent and stretched by two muscles of the stock make.
//!
//! ```text
//! cargo run --release --example own_finger
//! ```

use std::error::Error;

use smam::mechanism::{JointSpec, LeverSpec, MechanismSpec, RouteSpec};
use smam::recording::figures;
use smam::scene::{OutputSpec, Quantity, Scene, ViewSpec};
use smam::system::{Schedule, Simulation, record};

const FINGER: &str = r#"<robot name="finger">
  <link name="palm"/>
  <link name="proximal"><inertial><origin xyz="0.02 0 0"/><mass value="0.012"/>
    <inertia ixx="4e-7" ixy="0" ixz="0" iyy="2e-6" iyz="0" izz="2e-6"/></inertial>
    <visual><origin xyz="0.02 0 0"/><geometry><box size="0.04 0.012 0.012"/></geometry></visual></link>
  <link name="distal"><inertial><origin xyz="0.0125 0 0"/><mass value="0.007"/>
    <inertia ixx="2e-7" ixy="0" ixz="0" iyy="5e-7" iyz="0" izz="5e-7"/></inertial>
    <visual><origin xyz="0.0125 0 0"/><geometry><box size="0.025 0.010 0.010"/></geometry></visual></link>
  <joint name="knuckle" type="revolute"><parent link="palm"/><child link="proximal"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="2" effort="1" velocity="10"/></joint>
  <joint name="middle" type="revolute"><origin xyz="0.04 0 0"/><parent link="proximal"/><child link="distal"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="2" effort="1" velocity="10"/></joint>
</robot>"#;

/// A tendon that passes both joints, over 8 mm and 5 mm; of the other sign on the back of the finger.
fn tendon(side: f64) -> RouteSpec {
    let over = |joint: &str, lever_m: f64| LeverSpec { joint: joint.to_owned(), lever_m: side * lever_m };
    RouteSpec { lever: vec![over("knuckle", 8e-3), over("middle", 5e-3)], ..RouteSpec::default() }
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let urdf = folder.path().join("finger.urdf");
    std::fs::write(&urdf, FINGER)?;
    // The pulley's muscles, line and programme; another mechanism, and other routes for the tendons.
    let mut file = Scene::load("antagonistic_pulley", &[])?.file;
    file.name = "finger".to_owned();
    let springs = JointSpec {
        joints: vec!["knuckle".to_owned(), "middle".to_owned()],
        stiffness_n_m_rad: Some(2e-3),
        damping_n_m_s_rad: Some(2e-5),
        ..JointSpec::default()
    };
    file.mechanism = Some(MechanismSpec { urdf: urdf.clone(), joint: vec![springs], ..MechanismSpec::default() });
    file.cable[0].route = tendon(1.0);
    file.cable[1].route = tendon(-1.0);
    file.output.retain(|o| o.quantity != Quantity::JointPosition);
    file.output.extend(["knuckle", "middle"].map(|joint| OutputSpec {
        channel: format!("{joint}_deg"),
        quantity: Quantity::JointPosition,
        of: vec![joint.to_owned()],
        counts_from_start: false,
        arc_length_m: None,
    }));
    file.expect.clear();
    file.view = ViewSpec::default();
    let scene = Scene::from_file(file, &folder.path().join("finger.toml"))?;
    let recording = record(&mut Simulation::new(scene)?, &Schedule::even(20.0, 0.01))?;
    for column in ["knuckle_deg", "middle_deg"] {
        let angle_deg = &recording.channel(column)?.values;
        println!("{column}: {:.1} to {:.1}", figures::least(angle_deg), figures::greatest(angle_deg));
    }
    Ok(())
}
