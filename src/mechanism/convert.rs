//! Conversions between URDF, engine, linear algebra and the plain types of [`super::geometry`].

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use rapier3d_f64::math::{Pose, Rotation, Vector};

use super::geometry;

/// URDF pose: translation, then fixed-axis roll, pitch, yaw (R = Rz Ry Rx).
pub(super) fn pose_from_urdf(xyz: [f64; 3], rpy: [f64; 3]) -> Pose {
    let rotation =
        Rotation::from_rotation_z(rpy[2]) * Rotation::from_rotation_y(rpy[1]) * Rotation::from_rotation_x(rpy[0]);
    Pose::from_parts(Vector::from_array(xyz), rotation)
}

pub(super) fn plain_pose(pose: &Pose) -> geometry::Pose {
    geometry::Pose { translation_m: pose.translation.to_array(), rotation_xyzw: pose.rotation.to_array() }
}

pub(super) fn rotation_matrix(rotation: &Rotation) -> Matrix3<f64> {
    let [x, y, z, w] = rotation.to_array();
    UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)).to_rotation_matrix().into_inner()
}

pub(super) fn rotation_from_matrix(matrix: &Matrix3<f64>) -> Rotation {
    let q = UnitQuaternion::from_matrix(matrix);
    Rotation::from_xyzw(q.i, q.j, q.k, q.w).normalize()
}

pub(super) fn na_vector(v: Vector) -> Vector3<f64> {
    Vector3::new(v.x, v.y, v.z)
}

pub(super) fn engine_vector(v: &Vector3<f64>) -> Vector {
    Vector::new(v.x, v.y, v.z)
}
