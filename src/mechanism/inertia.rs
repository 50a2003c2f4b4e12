//! Mass, centre of mass and inertia of rigid groups of links.

use nalgebra::{Matrix3, SymmetricEigen, Vector3};
use rapier3d_f64::math::{Pose, Rotation};

use super::convert::{na_vector, rotation_from_matrix, rotation_matrix};

/// Inertial properties in some frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Inertial {
    pub mass_kg: f64,
    pub com_m: Vector3<f64>,
    /// About the centre of mass, along the frame's axes, kg m².
    pub inertia_kg_m2: Matrix3<f64>,
}

impl Inertial {
    pub fn point(mass_kg: f64, com_m: Vector3<f64>) -> Self {
        Self { mass_kg, com_m, inertia_kg_m2: Matrix3::zeros() }
    }

    /// The same mass seen from a frame in which this one's frame has `pose`.
    pub fn seen_from(&self, pose: &Pose) -> Self {
        let rotation = rotation_matrix(&pose.rotation);
        Self {
            mass_kg: self.mass_kg,
            com_m: rotation * self.com_m + na_vector(pose.translation),
            inertia_kg_m2: rotation * self.inertia_kg_m2 * rotation.transpose(),
        }
    }

    /// Both as one rigid body: I = Σ Iᵢ + mᵢ (|d|² 1 − d dᵀ), d from the common centre of mass.
    pub fn merged(&self, other: &Self) -> Self {
        let mass_kg = self.mass_kg + other.mass_kg;
        if mass_kg <= 0.0 {
            return *self;
        }
        let com_m = (self.com_m * self.mass_kg + other.com_m * other.mass_kg) / mass_kg;
        Self { mass_kg, com_m, inertia_kg_m2: self.inertia_about(&com_m) + other.inertia_about(&com_m) }
    }

    fn inertia_about(&self, point: &Vector3<f64>) -> Matrix3<f64> {
        let d = self.com_m - point;
        self.inertia_kg_m2 + (Matrix3::identity() * d.norm_squared() - d * d.transpose()) * self.mass_kg
    }

    /// Principal moments (kg m²) and the rotation of their axes.
    ///
    /// Moments are raised to at least 1e-8 of the largest and m (0.01 mm)²: the engine cannot hold a body that turns
    /// without inertia, and this is far below anything measurable.
    pub fn principal(&self) -> (Vector3<f64>, Rotation) {
        let (moments, axes) = principal_axes(&self.inertia_kg_m2);
        let floor = (1e-8 * moments.amax()).max(1e-10 * self.mass_kg);
        (moments.map(|m| m.max(floor)), axes)
    }

    /// This inertia after [`Self::principal`]'s floor.
    pub fn with_floor(&self) -> Self {
        let (moments, axes) = self.principal();
        let axes = rotation_matrix(&axes);
        Self { inertia_kg_m2: axes * Matrix3::from_diagonal(&moments) * axes.transpose(), ..*self }
    }

    /// Why no real body has this inertia, if so.
    pub fn fault(&self) -> Option<String> {
        let (moments, _) = principal_axes(&self.inertia_kg_m2);
        let slack = 1e-6 * moments.amax();
        if moments.iter().any(|m| !m.is_finite() || *m < -slack) {
            return Some("its inertia matrix has a negative principal moment".into());
        }
        let broken = (0..3).any(|i| moments[i] > moments.sum() - moments[i] + slack);
        broken.then(|| "one principal moment of inertia exceeds the sum of the others".into())
    }
}

fn principal_axes(inertia: &Matrix3<f64>) -> (Vector3<f64>, Rotation) {
    let off_diagonal = [inertia.m12, inertia.m13, inertia.m23];
    // Most URDFs are diagonal: their axes then stay exactly those of the frame.
    if off_diagonal.iter().all(|v| *v == 0.0) || inertia.iter().any(|v| !v.is_finite()) {
        return (inertia.diagonal(), Rotation::IDENTITY);
    }
    // Absurd values could keep the iteration going for ever.
    let Some(eigen) = SymmetricEigen::try_new(*inertia, f64::EPSILON, 1000) else {
        return (Vector3::repeat(f64::NAN), Rotation::IDENTITY);
    };
    let mut axes = eigen.eigenvectors;
    if axes.determinant() < 0.0 {
        axes.column_mut(2).neg_mut();
    }
    (eigen.eigenvalues, rotation_from_matrix(&axes))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::convert::pose_from_urdf;

    #[test]
    fn two_points_make_a_dumbbell() {
        let a = Inertial::point(2e-6, Vector3::new(0.0, 1e-3, 0.0));
        let b = Inertial::point(1e-6, Vector3::new(0.0, -2e-3, 0.0));
        let both = a.merged(&b);
        assert!(both.com_m.norm() < 1e-18);
        let expected = 2e-6 * 1e-6 + 1e-6 * 4e-6;
        assert!((both.inertia_kg_m2.m11 / expected - 1.0).abs() < 1e-12);
        assert!(both.inertia_kg_m2.m22.abs() < 1e-20);
    }

    #[test]
    fn principal_axes_rebuild_a_tilted_inertia() {
        let body = Inertial {
            mass_kg: 1e-3,
            com_m: Vector3::zeros(),
            inertia_kg_m2: Matrix3::from_diagonal(&Vector3::new(1e-9, 2e-9, 2.5e-9)),
        };
        let tilted = body.seen_from(&pose_from_urdf([0.0; 3], [0.3, -0.7, 1.1]));
        let error = (tilted.with_floor().inertia_kg_m2 - tilted.inertia_kg_m2).amax();
        assert!(error < 1e-22, "{error:e}");
        assert!(tilted.fault().is_none());
    }
}
