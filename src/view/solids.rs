//! Static shapes of links.

use rerun::components::FillMode;
use rerun::{AsComponents, Boxes3D, Color, Cylinders3D, Ellipsoids3D, Mesh3D, Quaternion};

use super::colour::MEASURED;
use crate::mechanism::geometry::{Shape, Visual};

/// How a visual is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Look {
    /// In its own colour.
    Solid,
    /// See-through, in the colour of what was measured.
    Ghost,
}

/// A visual as Rerun draws it, without its pose.
pub(super) fn solid(visual: &Visual, look: Look) -> Box<dyn AsComponents> {
    let (colour, fill) = match look {
        Look::Solid => (colour(visual.colour_rgba), FillMode::Solid),
        Look::Ghost => (ghost(), FillMode::TransparentFillMajorWireframe),
    };
    match &visual.shape {
        Shape::Box { size_m } => Box::new(Boxes3D::from_sizes([*size_m]).with_colors([colour]).with_fill_mode(fill)),
        Shape::Cylinder { radius_m, length_m } => Box::new(
            Cylinders3D::from_lengths_and_radii([*length_m as f32], [*radius_m as f32])
                .with_colors([colour])
                .with_fill_mode(fill),
        ),
        Shape::Sphere { radius_m } => {
            Box::new(Ellipsoids3D::from_radii([*radius_m as f32]).with_colors([colour]).with_fill_mode(fill))
        }
        Shape::Mesh { vertices_m, triangles } => Box::new(mesh(vertices_m, triangles, colour)),
    }
}

/// Pale enough to see through where a mesh is filled.
fn ghost() -> Color {
    let [red, green, blue] = MEASURED;
    Color::from_unmultiplied_rgba(red, green, blue, 90)
}

/// Rerun's quaternion of ours.
pub(super) fn quaternion(xyzw: [f64; 4]) -> Quaternion {
    Quaternion::from_xyzw(xyzw.map(|part| part as f32))
}

/// Every triangle gets corners of its own, so that edges stay sharp under flat normals.
fn mesh(vertices_m: &[[f64; 3]], triangles: &[[u32; 3]], colour: Color) -> Mesh3D {
    let corners: Vec<[[f64; 3]; 3]> = triangles.iter().filter_map(|triangle| corners(vertices_m, *triangle)).collect();
    let normals = corners.iter().flat_map(|triangle| [normal(triangle); 3]);
    Mesh3D::new(corners.iter().flatten().copied()).with_vertex_normals(normals).with_albedo_factor(colour.0)
}

fn corners(vertices_m: &[[f64; 3]], triangle: [u32; 3]) -> Option<[[f64; 3]; 3]> {
    let corner = |index: u32| vertices_m.get(index as usize).copied();
    let [a, b, c] = triangle;
    Some([corner(a)?, corner(b)?, corner(c)?])
}

fn normal([a, b, c]: &[[f64; 3]; 3]) -> [f64; 3] {
    let edge = |to: &[f64; 3]| nalgebra::Vector3::from(*to) - nalgebra::Vector3::from(*a);
    let normal = edge(b).cross(&edge(c)).try_normalize(0.0);
    normal.map_or([0.0, 0.0, 1.0], Into::into)
}

fn colour(rgba: [f32; 4]) -> Color {
    let [r, g, b, a] = rgba.map(|part| (255.0 * part.clamp(0.0, 1.0)).round() as u8);
    Color::from_unmultiplied_rgba(r, g, b, a)
}
