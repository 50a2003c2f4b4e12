//! Plain geometry that leaves this folder: poses, shapes and contacts without any engine type in them.

use serde::{Deserialize, Serialize};

/// Position and orientation of a frame in the world.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Origin, m.
    pub translation_m: [f64; 3],
    /// Unit quaternion, order x, y, z, w.
    pub rotation_xyzw: [f64; 4],
}

impl Pose {
    /// The world frame itself.
    pub const IDENTITY: Pose = Pose { translation_m: [0.0; 3], rotation_xyzw: [0.0, 0.0, 0.0, 1.0] };

    /// A point of the world in this frame, m.
    pub(crate) fn to_local(self, point_m: [f64; 3]) -> [f64; 3] {
        let offset = nalgebra::Vector3::from(point_m) - nalgebra::Vector3::from(self.translation_m);
        self.rotation().inverse_transform_vector(&offset).into()
    }

    /// The rotation vector from another frame to this one, rad.
    pub(crate) fn rotation_from(self, frame: Self) -> [f64; 3] {
        (frame.rotation().inverse() * self.rotation()).scaled_axis().into()
    }

    fn rotation(self) -> nalgebra::UnitQuaternion<f64> {
        let [x, y, z, w] = self.rotation_xyzw;
        nalgebra::UnitQuaternion::new_normalize(nalgebra::Quaternion::new(w, x, y, z))
    }
}

/// What is read of a pose: of its place along an axis, or of its rotation vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PoseComponent {
    Position(usize),
    Rotation(usize),
}

/// A shape in its own frame: boxes and spheres centred, cylinders centred along z.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    Box {
        size_m: [f64; 3],
    },
    Cylinder {
        radius_m: f64,
        length_m: f64,
    },
    Sphere {
        radius_m: f64,
    },
    /// Triangles, already scaled to metres.
    Mesh {
        vertices_m: Vec<[f64; 3]>,
        triangles: Vec<[u32; 3]>,
    },
}

/// One thing to draw, fixed to a link (or to a free body).
#[derive(Clone, Debug, PartialEq)]
pub struct Visual {
    /// Index into the list of link names.
    pub link: usize,
    pub pose: Pose,
    pub shape: Shape,
    /// Red, green, blue, opacity, each 0..=1.
    pub colour_rgba: [f32; 4],
}

/// A touching point between two links or free bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    pub link_a: usize,
    pub link_b: usize,
    pub point_m: [f64; 3],
    /// Unit vector from a to b.
    pub normal: [f64; 3],
    /// Overlap, m; > 0 when the shapes interpenetrate.
    pub penetration_m: f64,
    /// Normal force, N.
    pub force_n: f64,
}
