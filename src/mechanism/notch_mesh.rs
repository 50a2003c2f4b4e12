//! What a notched tube looks like: a piece of the whole tube, and the wall that a notch leaves, as meshes of unit length.

use std::f64::consts::PI;

use super::notch::NotchGeometry;
use super::stl::{self, Triangles};

/// Facets of a whole circle.
const FACETS: usize = 48;

/// A cross-section: outer and inner corner at each step along the wall, as (y, z).
type Section = Vec<([f64; 2], [f64; 2])>;

/// Binary STL of the whole tube, 1 m long, centred on the origin, along x.
pub(super) fn tube_stl(notch: &NotchGeometry) -> Vec<u8> {
    let corner = |k: usize| {
        let angle = -PI + 2.0 * PI * k as f64 / FACETS as f64;
        (at(notch.outer_radius_m, angle), at(notch.inner_radius_m, angle))
    };
    stl::binary(&extruded(&(0..=FACETS).map(corner).collect()))
}

/// Binary STL of the wall below the floor of a notch, 1 m long, centred on the tube's axis, along x.
pub(super) fn strip_stl(notch: &NotchGeometry) -> Vec<u8> {
    let floor_m = notch.outer_radius_m - notch.cut_depth_m;
    let half_angle = |radius_m: f64| (-floor_m / radius_m).clamp(-1.0, 1.0).acos();
    let (outer, inner) = (half_angle(notch.outer_radius_m), half_angle(notch.inner_radius_m));
    let steps = ((outer / PI * FACETS as f64).ceil() as usize).max(4);
    let corner = |k: usize| {
        let share = 2.0 * k as f64 / steps as f64 - 1.0;
        let out = at(notch.outer_radius_m, share * outer);
        // A cut that leaves less than the wall meets no bore: the section is a cap under its chord.
        let inside = if inner > 0.0 { at(notch.inner_radius_m, share * inner) } else { [out[0], floor_m] };
        (out, inside)
    };
    stl::binary(&extruded(&(0..=steps).map(corner).collect()))
}

/// A point of a circle; angles count from -z.
fn at(radius_m: f64, angle: f64) -> [f64; 2] {
    [radius_m * angle.sin(), -radius_m * angle.cos()]
}

/// A section pulled from x = -0.5 to 0.5, closed on all sides.
fn extruded(section: &Section) -> Triangles {
    let mut mesh = Triangles::default();
    let point = |x: f64, [y, z]: [f64; 2]| [x, y, z];
    let mut quad = |a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]| {
        mesh.push([a, b, c].into_iter());
        mesh.push([a, c, d].into_iter());
    };
    for pair in section.windows(2) {
        let [(out, inside), (next_out, next_inside)] = [pair[0], pair[1]];
        quad(point(-0.5, out), point(-0.5, next_out), point(0.5, next_out), point(0.5, out));
        quad(point(-0.5, next_inside), point(-0.5, inside), point(0.5, inside), point(0.5, next_inside));
        quad(point(-0.5, out), point(-0.5, inside), point(-0.5, next_inside), point(-0.5, next_out));
        quad(point(0.5, out), point(0.5, next_out), point(0.5, next_inside), point(0.5, inside));
    }
    // The flanks of a strip; of a whole tube they lie on one another.
    for (out, inside) in [section.first(), section.last()].into_iter().flatten() {
        quad(point(-0.5, *out), point(0.5, *out), point(0.5, *inside), point(-0.5, *inside));
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::super::notched_tube::NotchedTube;
    use super::*;

    #[test]
    fn the_strip_stays_below_the_floor_of_the_notch_and_within_the_wall() {
        let notch = NotchedTube::STOCK.notch;
        let mesh = stl::read(&strip_stl(&notch)).expect("our own file");
        let floor_m = notch.outer_radius_m - notch.cut_depth_m;
        for [x, y, z] in mesh.vertices {
            let radius_m = y.hypot(z);
            assert!(x.abs() <= 0.5 && z <= floor_m + 1e-9, "{z} above {floor_m}");
            assert!(radius_m <= notch.outer_radius_m * (1.0 + 1e-6), "{radius_m}");
        }
    }

    #[test]
    fn the_tube_is_hollow() {
        let notch = NotchedTube::STOCK.notch;
        let mesh = stl::read(&tube_stl(&notch)).expect("our own file");
        let radii: Vec<f64> = mesh.vertices.iter().map(|[_, y, z]| y.hypot(*z)).collect();
        let least = radii.iter().copied().fold(f64::MAX, f64::min);
        assert!((least - notch.inner_radius_m).abs() < 1e-8, "{least}");
    }
}
