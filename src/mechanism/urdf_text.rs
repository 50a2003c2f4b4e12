//! Writing URDF elements, numbers to six digits so that the text is the same everywhere.

use std::fmt::Write;

use super::inertia::Inertial;

/// Position and orientation of something in its link.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Place {
    pub xyz: [f64; 3],
    pub rpy: [f64; 3],
}

impl Place {
    pub fn at(x: f64, y: f64, z: f64) -> Self {
        Self { xyz: [x, y, z], rpy: [0.0; 3] }
    }
}

/// A URDF under construction.
pub(super) struct UrdfText {
    text: String,
}

impl UrdfText {
    pub fn new(robot: &str, comment: &str) -> Self {
        Self { text: format!("<?xml version=\"1.0\"?>\n<!-- {comment} -->\n<robot name=\"{robot}\">\n") }
    }

    pub fn line(&mut self, line: &str) {
        self.text.push_str("  ");
        self.text.push_str(line);
        self.text.push('\n');
    }

    pub fn material(&mut self, name: &str, rgba: &str) {
        self.line(&format!("<material name=\"{name}\"><color rgba=\"{rgba}\"/></material>"));
    }

    pub fn open_link(&mut self, name: &str) {
        self.line(&format!("<link name=\"{name}\">"));
    }

    pub fn close_link(&mut self) {
        self.line("</link>");
    }

    pub fn inertial(&mut self, body: &Inertial) {
        let i = &body.inertia_kg_m2;
        let com = numbers(body.com_m.as_slice());
        self.line("  <inertial>");
        self.line(&format!("    <origin xyz=\"{com}\"/>"));
        self.line(&format!("    <mass value=\"{}\"/>", number(body.mass_kg)));
        self.line(&format!(
            "    <inertia ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" iyy=\"{}\" iyz=\"{}\" izz=\"{}\"/>",
            number(i.m11),
            number(i.m12),
            number(i.m13),
            number(i.m22),
            number(i.m23),
            number(i.m33)
        ));
        self.line("  </inertial>");
    }

    pub fn visual(&mut self, place: Place, geometry: &str, material: &str) {
        let origin = origin(place);
        self.line(&format!(
            "  <visual>{origin}<geometry>{geometry}</geometry><material name=\"{material}\"/></visual>"
        ));
    }

    pub fn collision(&mut self, place: Place, geometry: &str) {
        let origin = origin(place);
        self.line(&format!("  <collision>{origin}<geometry>{geometry}</geometry></collision>"));
    }

    /// A revolute joint; `extra` goes inside, after the limits.
    pub fn hinge(&mut self, name: &str, links: [&str; 2], place: Place, axis: &str, extra: &str) {
        let [parent, child] = links;
        self.line(&format!("<joint name=\"{name}\" type=\"revolute\">"));
        self.line(&format!("  {}", origin(place)));
        self.line(&format!("  <parent link=\"{parent}\"/>"));
        self.line(&format!("  <child link=\"{child}\"/>"));
        self.line(&format!("  <axis xyz=\"{axis}\"/>"));
        self.line("  <limit lower=\"-1.57\" upper=\"1.57\" effort=\"1\" velocity=\"100\"/>");
        if !extra.is_empty() {
            self.line(&format!("  {extra}"));
        }
        self.line("</joint>");
    }

    pub fn finish(mut self) -> String {
        self.text.push_str("</robot>\n");
        self.text
    }
}

pub(super) fn cylinder(radius_m: f64, length_m: f64) -> String {
    format!("<cylinder radius=\"{}\" length=\"{}\"/>", number(radius_m), number(length_m))
}

/// A mesh file, scaled along x, y, z.
pub(super) fn mesh(file: &str, scale: [f64; 3]) -> String {
    format!("<mesh filename=\"{file}\" scale=\"{}\"/>", numbers(&scale))
}

pub(super) fn cuboid(size_m: [f64; 3]) -> String {
    format!("<box size=\"{}\"/>", numbers(&size_m))
}

pub(super) fn sphere(radius_m: f64) -> String {
    format!("<sphere radius=\"{}\"/>", number(radius_m))
}

fn origin(place: Place) -> String {
    let mut text = format!("<origin xyz=\"{}\"", numbers(&place.xyz));
    if place.rpy != [0.0; 3] {
        // Writing to a string cannot fail.
        let _ = write!(text, " rpy=\"{}\"", numbers(&place.rpy));
    }
    text.push_str("/>");
    text
}

fn numbers(values: &[f64]) -> String {
    let words: Vec<String> = values.iter().map(|v| number(*v)).collect();
    words.join(" ")
}

/// Six significant digits, without trailing zeros.
fn number(value: f64) -> String {
    // Round-off of sums that should vanish would otherwise differ between machines.
    if value.abs() < 1e-18 {
        return "0".into();
    }
    let text = format!("{value:.5e}");
    match text.split_once('e') {
        Some((digits, exponent)) => {
            let digits = digits.trim_end_matches('0').trim_end_matches('.');
            match exponent {
                "0" => digits.to_owned(),
                _ => format!("{digits}e{exponent}"),
            }
        }
        None => text,
    }
}
