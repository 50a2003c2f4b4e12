//! Mechanics of one notch of a cutout tube.
//!
//! The tube is cut from one side to the depth g; the wall left on the other side is the hinge. Let d = g − r_o be the
//! distance from the tube's axis to the cut's floor. What is left of a disc of radius r_j beyond d is a circular segment
//! of half angle α_j = acos(d / r_j):
//!
//! - area A_j = r_j² (α − sin α cos α), centroid y_j = 2 r_j³ sin³α / (3 A_j),
//! - second moments about the tube's axis: parallel to the chord r_j⁴ (α − sin α cos α + 2 sin³α cos α) / 4, along the
//!   line of symmetry r_j⁴ (3 α − 3 sin α cos α − 2 sin³α cos α) / 12.
//!
//! The wall is the outer segment minus the inner one (index o, i). Its neutral axis is ȳ = (y_o A_o − y_i A_i)/A, and its
//! bending moment of inertia I = I_o − I_i − A ȳ². Euler-Bernoulli beam over the notch's height h: stiffness
//! k = E I / h, valid while the strip stays elastic and bends evenly.
//!
//! Source: the usual notched-tube continuum model (asymmetric cutout wrists), small strains.

use super::error::MechanismError;

/// Cross-section and height of a notch.
///
/// ```
/// use std::f64::consts::PI;
///
/// use smam::mechanism::{NotchGeometry, NotchedTube};
///
/// let notch = NotchedTube::STOCK.notch;
/// // PTFE of 0.5 GPa, eight notches in series: 1.05 mN m/rad; a tendon on the cut's side has a lever of 2.6 mm.
/// assert!((notch.stiffness_n_m_rad(0.5e9) / 8.0 / 1.048e-3 - 1.0).abs() < 1e-3);
/// assert!((notch.lever_m() / 2.617e-3 - 1.0).abs() < 1e-3);
/// assert!((notch.tendon_pull_m(1e-3) / (notch.lever_m() * 1e-3) - 1.0).abs() < 1e-3);
/// // Scratched only, the section is a ring.
/// let scratched = NotchGeometry { cut_depth_m: 1e-9, ..notch };
/// let ring_m4 = PI / 4.0 * (notch.outer_radius_m.powi(4) - notch.inner_radius_m.powi(4));
/// assert!((scratched.second_moment_m4() / ring_m4 - 1.0).abs() < 1e-4);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotchGeometry {
    /// r_o, m.
    pub outer_radius_m: f64,
    /// r_i, m.
    pub inner_radius_m: f64,
    /// g, from the outer surface, m; 0 < g < 2 r_o.
    pub cut_depth_m: f64,
    /// h, the opening along the tube, m.
    pub notch_height_m: f64,
}

/// Area and moments of the cut wall (or of one circular segment) in the tube's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Section {
    area: f64,
    first_moment: f64,
    /// ∫ y² dA, y away from the cut.
    along_y: f64,
    /// ∫ x² dA, x along the chord.
    along_x: f64,
}

impl NotchGeometry {
    /// # Errors
    /// Sizes that make no tube or leave no wall.
    pub fn check(&self) -> Result<(), MechanismError> {
        let NotchGeometry { outer_radius_m: outer, inner_radius_m: inner, cut_depth_m: depth, notch_height_m: height } =
            *self;
        let rules = [
            ("outer_radius_m", outer, outer > 0.0 && outer.is_finite(), "> 0"),
            ("inner_radius_m", inner, inner >= 0.0 && inner < outer, ">= 0 and below the outer one"),
            ("cut_depth_m", depth, depth > 0.0 && depth < 2.0 * outer, "between 0 and the outer diameter"),
            ("notch_height_m", height, height > 0.0 && height.is_finite(), "> 0"),
        ];
        match rules.iter().find(|(_, _, ok, _)| !ok) {
            Some((key, value, _, rule)) => {
                let problem = format!("{key} = {value} must be {rule}");
                Err(MechanismError::spec("notch", key, problem, "give a number in that range, in m"))
            }
            None => Ok(()),
        }
    }

    /// A, the area of the wall that is left, m².
    pub fn area_m2(&self) -> f64 {
        self.section().area
    }

    /// ȳ, distance of the neutral axis from the tube's axis, away from the cut, m.
    pub(crate) fn neutral_axis_m(&self) -> f64 {
        let section = self.section();
        section.first_moment / section.area
    }

    /// I about the neutral axis, m⁴.
    pub fn second_moment_m4(&self) -> f64 {
        let section = self.section();
        section.along_y - section.first_moment.powi(2) / section.area
    }

    /// Second moment about the line of symmetry, m⁴ (sideways bending; also used for the strip's inertia).
    pub(crate) fn sideways_second_moment_m4(&self) -> f64 {
        self.section().along_x
    }

    /// k = E I / h of one notch, N m/rad; n notches in series have k/n.
    pub fn stiffness_n_m_rad(&self, youngs_modulus_pa: f64) -> f64 {
        youngs_modulus_pa * self.second_moment_m4() / self.notch_height_m
    }

    /// a = r_i + ȳ: lever of a tendon along the inner wall on the cut's side, m.
    pub fn lever_m(&self) -> f64 {
        self.inner_radius_m + self.neutral_axis_m()
    }

    /// θ_max = h / (r_o + ȳ): the notch's edges touch, rad.
    pub fn closing_angle_rad(&self) -> f64 {
        self.notch_height_m / (self.outer_radius_m + self.neutral_axis_m())
    }

    /// Tendon drawn in at the bending angle θ: h − 2 (1/κ − r_i) sin(θ/2) with 1/κ = h/θ − ȳ, m; a θ for small angles.
    pub fn tendon_pull_m(&self, angle_rad: f64) -> f64 {
        if angle_rad.abs() < 1e-6 {
            return self.lever_m() * angle_rad;
        }
        let radius = self.notch_height_m / angle_rad - self.neutral_axis_m();
        self.notch_height_m - 2.0 * (radius - self.inner_radius_m) * (angle_rad / 2.0).sin()
    }

    fn section(&self) -> Section {
        let floor = self.cut_depth_m - self.outer_radius_m;
        let outer = segment(self.outer_radius_m, floor);
        let inner = segment(self.inner_radius_m, floor);
        Section {
            area: outer.area - inner.area,
            first_moment: outer.first_moment - inner.first_moment,
            along_y: outer.along_y - inner.along_y,
            along_x: outer.along_x - inner.along_x,
        }
    }
}

/// What a disc of this radius has beyond `floor` from its centre.
fn segment(radius: f64, floor: f64) -> Section {
    let half_angle = match radius {
        r if r > 0.0 => (floor / r).clamp(-1.0, 1.0).acos(),
        _ => 0.0,
    };
    let (sin, cos) = half_angle.sin_cos();
    let slice = half_angle - sin * cos;
    let cap = sin.powi(3) * cos;
    Section {
        area: radius.powi(2) * slice,
        first_moment: 2.0 / 3.0 * radius.powi(3) * sin.powi(3),
        along_y: radius.powi(4) * (slice + 2.0 * cap) / 4.0,
        along_x: radius.powi(4) * (3.0 * slice - 2.0 * cap) / 12.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::notched_tube::NotchedTube;

    const STOCK: NotchGeometry = NotchedTube::STOCK.notch;

    #[test]
    fn stock_lever_and_stiffness() {
        let lever = STOCK.lever_m() / 2.6174e-3 - 1.0;
        let total = STOCK.stiffness_n_m_rad(0.5e9) / 8.0 / 1.0482e-3 - 1.0;
        println!("lever error {lever:.1e}, stiffness error {total:.1e}");
        assert!(lever.abs() < 1e-4 && total.abs() < 1e-4, "{lever:e} {total:e}");
    }

    #[test]
    fn moments_match_a_numerical_quadrature() {
        for depth in [0.3e-3, 1.0e-3, 1.615e-3, 2.0e-3, 2.584e-3, 3.1e-3] {
            let notch = NotchGeometry { cut_depth_m: depth, ..STOCK };
            let [area, first, along_y, along_x] = quadrature(&notch);
            let mean = first / area;
            let pairs = [
                (notch.area_m2(), area),
                (notch.neutral_axis_m(), mean),
                (notch.second_moment_m4(), along_y - area * mean * mean),
                (notch.sideways_second_moment_m4(), along_x),
            ];
            for (have, want) in pairs {
                assert!((have / want - 1.0).abs() < 1e-5, "g = {depth}: {have:e} {want:e}");
            }
        }
    }

    /// Strips across the section, each with its exact width.
    fn quadrature(notch: &NotchGeometry) -> [f64; 4] {
        let (outer, inner) = (notch.outer_radius_m, notch.inner_radius_m);
        let (from, n) = (notch.cut_depth_m - outer, 2_000_000);
        let step = (outer - from) / f64::from(n);
        let mut sums = [0.0; 4];
        for i in 0..n {
            let y = from + (f64::from(i) + 0.5) * step;
            let half = |r: f64| (r * r - y * y).max(0.0).sqrt();
            let (o, i) = (half(outer), half(inner));
            let width = 2.0 * (o - i) * step;
            sums[0] += width;
            sums[1] += width * y;
            sums[2] += width * y * y;
            sums[3] += 2.0 / 3.0 * (o.powi(3) - i.powi(3)) * step;
        }
        sums
    }

    #[test]
    fn the_tendon_is_drawn_in_by_lever_times_angle() {
        let angle = 1e-3;
        let error = STOCK.tendon_pull_m(angle) / (STOCK.lever_m() * angle) - 1.0;
        assert!(error.abs() < 1e-4, "{error:e}");
        let large = STOCK.tendon_pull_m(0.3) / (STOCK.lever_m() * 0.3) - 1.0;
        assert!(large.abs() < 6e-3, "{large:e}");
    }

    #[test]
    fn impossible_notches_are_refused() {
        let deep = NotchGeometry { cut_depth_m: 4e-3, ..STOCK };
        let message = deep.check().unwrap_err().to_string();
        assert!(message.contains("cut_depth_m = 0.004"), "{message}");
    }
}
