//! Scenes made to any number of parts.

use std::fmt::Write as _;
use std::path::Path;

use crate::files::write_whole;
use crate::scene::Scene;
use crate::stock;

use super::BenchError;

/// A tube of `count` hinges in series, 2 mm apart, bent by one muscle through a cable; springs and dampers are such that
/// all together stay those of the stock catheter.
pub fn hinges(folder: &Path, count: usize) -> Result<Scene, BenchError> {
    let mut urdf = String::from("<robot name=\"tube\"><link name=\"segment_0\"/>\n");
    for i in 1..=count {
        let mass_kg = 6.4e-4 / count as f64;
        let _ = write!(
            urdf,
            "<link name=\"segment_{i}\"><inertial><mass value=\"{mass_kg}\"/><inertia ixx=\"1e-9\" iyy=\"1e-9\" izz=\"1e-9\" \
             ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>\n<joint name=\"notch_{i}\" type=\"continuous\"><origin \
             xyz=\"0.002 0 0\"/><parent link=\"segment_{}\"/><child link=\"segment_{i}\"/><axis xyz=\"0 1 0\"/></joint>\n",
            i - 1
        );
    }
    urdf.push_str("</robot>\n");
    let joints: Vec<String> = (1..=count).map(|i| format!("\"notch_{i}\"")).collect();
    let levers: Vec<String> = joints.iter().map(|j| format!("{{ joint = {j}, lever_m = 2.62e-3 }}")).collect();
    let parts = format!(
        "[[mechanism.joint]]\njoints = [{}]\nstiffness_n_m_rad = {}\ndamping_n_m_s_rad = {}\n\n[[cable]]\nname = \"tendon\"\n\
         stiffness_n_m = 4000.0\ndamping_n_s_m = 0.4\nroute.lever = [{}]\n\n[[muscle]]\nname = \"muscle\"\ninput = \"plunger_mm\"\n\
         cable = \"tendon\"\n\n{INPUT}[[output]]\nchannel = \"bend_deg\"\nquantity = \"joint_position\"\nof = [{}]\n",
        joints.join(", "),
        1.05e-3 * count as f64,
        2e-5 * count as f64,
        levers.join(", "),
        joints.join(", ")
    );
    scene(folder, &format!("tube_{count}"), &urdf, &parts)
}

const INPUT: &str =
    "[[input]]\nchannel = \"plunger_mm\"\nprogram = { kind = \"sine\", stroke_m = 1.0e-3, frequency_hz = 0.5 }\n\n";

/// `count` muscles side by side, each on a slider of its own, all driven alike.
pub fn muscles(folder: &Path, count: usize) -> Result<Scene, BenchError> {
    let mut urdf = String::from("<robot name=\"row\"><link name=\"bench\"/>\n");
    let mut parts = String::from(INPUT);
    for i in 1..=count {
        let _ = write!(
            urdf,
            "<link name=\"carriage_{i}\"><inertial><mass value=\"0.005\"/><inertia ixx=\"1e-6\" iyy=\"1e-6\" izz=\"1e-6\" \
             ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>\n<joint name=\"slide_{i}\" type=\"prismatic\"><origin \
             xyz=\"0.05 {} 0\"/><parent link=\"bench\"/><child link=\"carriage_{i}\"/><axis xyz=\"1 0 0\"/><limit lower=\"-0.05\" \
             upper=\"0.2\" effort=\"20\" velocity=\"1\"/></joint>\n",
            0.01 * i as f64
        );
        let _ = write!(
            parts,
            "[[muscle]]\nname = \"muscle_{i}\"\ninput = \"plunger_mm\"\njoint = \"slide_{i}\"\n\n[[output]]\nchannel = \
             \"elongation_{i}_mm\"\nquantity = \"elongation\"\nof = [\"muscle_{i}\"]\n\n"
        );
    }
    urdf.push_str("</robot>\n");
    scene(folder, &format!("row_{count}"), &urdf, &parts)
}

/// The stock bench's hydraulics and muscle with another mechanism, and what hangs on it.
fn scene(folder: &Path, name: &str, urdf: &str, parts: &str) -> Result<Scene, BenchError> {
    let file = folder.join(format!("{name}.urdf"));
    write_whole(&file, urdf).map_err(|source| BenchError::Write { file, source })?;
    let stock = Scene::load("muscle_bench", &[])?;
    let text = stock::read_text(&stock.path).map_err(|source| BenchError::Read { file: stock.path.clone(), source })?;
    let before = text.split("[mechanism]").next().unwrap_or_default();
    let text = format!("{before}[mechanism]\nurdf = \"{name}.urdf\"\n\n{parts}");
    Ok(Scene::parse(&text, &folder.join(format!("{name}.toml")), &[])?)
}
