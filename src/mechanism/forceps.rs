//! Two jaws at the end of a tube.

use nalgebra::{Matrix3, Vector3};

use super::error::MechanismError;
use super::inertia::Inertial;
use super::urdf_text::{Place, UrdfText, cuboid, cylinder, sphere};

/// Two jaws that turn about one pin across the tube, `jaw_right` mimicking `jaw_left`; positive is open.
///
/// Their inner faces are inclined so that they are parallel when they hold a ball of `ball_diameter_m`: a wedge would
/// press it out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forceps {
    /// From the pin to the jaw's tip, m.
    pub jaw_length_m: f64,
    /// Width of the inner face, m.
    pub jaw_width_m: f64,
    /// Ball between parallel faces, m.
    pub ball_diameter_m: f64,
    /// Of one jaw, kg.
    pub jaw_mass_kg: f64,
    /// Of one jaw about the pin, with what its cable and opening string drag along, kg m².
    pub jaw_inertia_kg_m2: f64,
}

impl Forceps {
    /// The stock forceps: jaws of 6.5 mm, 1e-9 kg m² each, for a ball of 3 mm.
    pub const STOCK: Forceps = Forceps {
        jaw_length_m: 6.5e-3,
        jaw_width_m: 2.0e-3,
        ball_diameter_m: 3.0e-3,
        jaw_mass_kg: 8e-6,
        jaw_inertia_kg_m2: 1e-9,
    };

    /// Angle of one jaw at which the faces are parallel: its tip is at z = 0 when closed, rad.
    fn face_angle(&self) -> f64 {
        (self.ball_diameter_m / 2.0).atan2(self.jaw_length_m)
    }

    /// # Errors
    /// Sizes that make no jaw, or an inertia about the pin below that of the mass alone.
    pub fn check(&self) -> Result<(), MechanismError> {
        let remedy = "give a larger number, in SI units";
        let error = |key: &str, problem: String| Err(MechanismError::spec("forceps", key, problem, remedy));
        let values = [
            ("jaw_length_m", self.jaw_length_m),
            ("jaw_width_m", self.jaw_width_m),
            ("ball_diameter_m", self.ball_diameter_m),
            ("jaw_mass_kg", self.jaw_mass_kg),
            ("jaw_inertia_kg_m2", self.jaw_inertia_kg_m2),
        ];
        if let Some((key, value)) = values.iter().find(|(_, v)| !(*v > 0.0 && v.is_finite())) {
            return error(key, format!("{key} = {value} must be > 0"));
        }
        let least = self.jaw_mass_kg * self.centre().norm_squared();
        if self.jaw_inertia_kg_m2 <= least {
            let problem = format!("{:e} must exceed m d² = {least:e}", self.jaw_inertia_kg_m2);
            return error("jaw_inertia_kg_m2", problem);
        }
        Ok(())
    }

    /// Centre of mass of the left jaw in its link.
    fn centre(&self) -> Vector3<f64> {
        Vector3::new(0.6 * self.jaw_length_m, 0.0, 0.3 * self.ball_diameter_m)
    }
}

/// Appends clevis, jaws and joints after a tip link whose tube ends at `end`.
pub(super) fn append(forceps: &Forceps, tip: &str, end: Place, tube_radius_m: f64, urdf: &mut UrdfText) {
    let [x, _, z] = end.xyz;
    let pin = Place::at(x + 0.6e-3, 0.0, z);
    jaw(forceps, "jaw_left_link", 1.0, tube_radius_m, urdf);
    jaw(forceps, "jaw_right_link", -1.0, tube_radius_m, urdf);
    urdf.hinge("jaw_left", [tip, "jaw_left_link"], pin, "0 -1 0", "");
    let mimic = "<mimic joint=\"jaw_left\" multiplier=\"1\" offset=\"0\"/>";
    urdf.hinge("jaw_right", [tip, "jaw_right_link"], pin, "0 1 0", mimic);
}

/// Sizes of one jaw and the side it is on.
struct JawShape {
    /// +1 for the jaw above the tube's axis, −1 for the one below.
    side: f64,
    /// From parallel faces to closed.
    angle: f64,
    half_ball: f64,
    thickness: f64,
    /// Where the face begins, and its length.
    start: f64,
    length: f64,
    width: f64,
}

impl JawShape {
    fn new(forceps: &Forceps, side: f64) -> Self {
        let half_ball = forceps.ball_diameter_m / 2.0;
        let start = 0.25 * forceps.jaw_length_m;
        Self {
            side,
            angle: forceps.face_angle(),
            half_ball,
            thickness: 0.4 * half_ball,
            start,
            length: forceps.jaw_length_m - start,
            width: forceps.jaw_width_m,
        }
    }

    /// A place laid out as when the faces are parallel (x, z), closed by `angle`, and pitched down by `pitch` more.
    fn place(&self, x: f64, z: f64, pitch: f64) -> Place {
        let (sin, cos) = self.angle.sin_cos();
        Place {
            xyz: [x * cos + z * sin, 0.0, self.side * (z * cos - x * sin)],
            rpy: [0.0, self.side * (self.angle + pitch), 0.0],
        }
    }

    /// The plate that grips.
    fn face(&self) -> (Place, String) {
        let z = self.half_ball + self.thickness / 2.0;
        let place = self.place(self.start + self.length / 2.0, z, 0.0);
        (place, cuboid([self.length, self.width, self.thickness]))
    }

    /// The arm from the pin to the face.
    fn heel(&self) -> (Place, String) {
        let rise = self.half_ball + self.thickness / 2.0;
        let place = self.place(self.start / 2.0, rise / 2.0, -rise.atan2(self.start));
        let length = self.start.hypot(rise) + self.thickness;
        (place, cuboid([length, 0.6 * self.width, self.thickness]))
    }

    /// The rib along the face's back.
    fn rib(&self) -> (Place, String) {
        let z = self.half_ball + 1.2 * self.thickness;
        let place = self.place(self.start + self.length / 2.0, z, 0.0);
        (place, cuboid([0.9 * self.length, 0.5 * self.width, 0.6 * self.thickness]))
    }

    fn tip(&self) -> (Place, String) {
        let z = self.half_ball + self.thickness / 2.0;
        (self.place(self.start + self.length, z, 0.0), sphere(0.6 * self.thickness))
    }
}

fn jaw(forceps: &Forceps, name: &str, side: f64, tube_radius_m: f64, urdf: &mut UrdfText) {
    let shape = JawShape::new(forceps, side);
    let across = Place { xyz: [0.0; 3], rpy: [std::f64::consts::FRAC_PI_2, 0.0, 0.0] };
    let pin = cylinder(0.35 * tube_radius_m, 1.4 * tube_radius_m);
    let parts = [
        (shape.face(), "grip"),
        (shape.heel(), "steel"),
        (shape.rib(), "steel"),
        (shape.tip(), "grip"),
        ((across, pin), "steel"),
    ];
    urdf.open_link(name);
    urdf.inertial(&jaw_inertial(forceps, side));
    for ((place, geometry), material) in &parts {
        urdf.visual(*place, geometry, material);
    }
    let (place, geometry) = shape.face();
    urdf.collision(place, &geometry);
    urdf.close_link();
}

/// Equal moments about the centre, so that the inertia about the pin is the one asked for.
fn jaw_inertial(forceps: &Forceps, side: f64) -> Inertial {
    let mut com_m = forceps.centre();
    let central = forceps.jaw_inertia_kg_m2 - forceps.jaw_mass_kg * com_m.norm_squared();
    com_m.z *= side;
    Inertial { mass_kg: forceps.jaw_mass_kg, com_m, inertia_kg_m2: Matrix3::from_diagonal_element(central) }
}
