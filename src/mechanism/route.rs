//! Where cables run, and how their length depends on the joints.

use nalgebra::{DVector, Vector3};
use rapier3d_f64::math::Vector;

use super::convert::na_vector;
use super::coordinate::CoordinateKind;
use super::error::{MechanismError, known_names};
use super::model::Mechanism;
use super::spec::{LeverSpec, PointSpec, RouteSpec};

/// A point fixed in a link (or in the world, by the root link).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkPoint {
    /// Index of a URDF link.
    pub link: usize,
    /// In the link's frame, m.
    pub point_m: [f64; 3],
}

/// A lever on one coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arm {
    /// Index into [`Mechanism::coordinates`].
    pub coordinate: usize,
    /// Shortening of the path per unit of the coordinate, m/rad or m/m.
    pub lever_m: f64,
}

/// A cable's path through the mechanism.
#[derive(Clone, Debug, PartialEq)]
pub enum Route {
    /// L = constant − Σ lever · q, exactly: a cable on a pulley, or a tendon in a channel of fixed lever.
    /// L is counted from zero at all joints zero, so it may be negative.
    Levers {
        arms: Vec<Arm>,
        /// From joints that do not move and from offsets of followers, m.
        constant_m: f64,
        /// Only for drawing; a point at each lever where the scene gives none.
        draw: Vec<LinkPoint>,
    },
    /// L = Σ |pᵢ₊₁ − pᵢ|: straight segments through points fixed in links.
    Via(Vec<LinkPoint>),
}

impl Mechanism {
    /// Resolves the names of a route. A lever on a follower acts on its leader's coordinate.
    ///
    /// # Errors
    /// Unknown joints or links, both or neither of `lever` and `via`, a `via` route of one point.
    pub fn route(&self, spec: &RouteSpec) -> Result<Route, MechanismError> {
        match (spec.lever.is_empty(), spec.via.is_empty()) {
            (false, true) => self.lever_route(&spec.lever, self.points(&spec.draw)?),
            (true, false) if spec.via.len() >= 2 && spec.draw.is_empty() => Ok(Route::Via(self.points(&spec.via)?)),
            (true, false) => {
                let problem = "needs two points or more, and no `draw`";
                Err(MechanismError::spec("route", "via", problem, "give via two points or more, and leave draw out"))
            }
            _ => {
                let problem = "needs exactly one of them";
                Err(MechanismError::spec("route", "lever, via", problem, "give lever or via"))
            }
        }
    }

    /// Length of the path (m), and its derivative by each coordinate into `jacobian` (m/rad or m/m).
    ///
    /// A cable under tension T puts the generalised force −T ∂L/∂q on the coordinates.
    pub fn path_length(&self, route: &Route, jacobian: &mut [f64]) -> f64 {
        match route {
            Route::Levers { arms, constant_m, .. } => self.lever_length(arms, *constant_m, jacobian),
            Route::Via(points) => self.via_length(points, jacobian),
        }
    }

    /// The points to draw the cable through, in the world, m. A lever route without `draw` passes each joint at its
    /// lever.
    pub(crate) fn cable_points(&self, route: &Route) -> Vec<[f64; 3]> {
        let (Route::Levers { draw: points, .. } | Route::Via(points)) = route;
        points.iter().map(|p| self.world_point(p).to_array()).collect()
    }

    fn lever_length(&self, arms: &[Arm], constant_m: f64, jacobian: &mut [f64]) -> f64 {
        jacobian.fill(0.0);
        let mut length = constant_m;
        for arm in arms {
            length -= arm.lever_m * self.dof_position(self.leaders[arm.coordinate]);
            if let Some(slope) = jacobian.get_mut(arm.coordinate) {
                *slope -= arm.lever_m;
            }
        }
        length
    }

    fn via_length(&self, points: &[LinkPoint], jacobian: &mut [f64]) -> f64 {
        let world: Vec<Vector3<f64>> = points.iter().map(|p| na_vector(self.world_point(p))).collect();
        let mut length = 0.0;
        let mut slope = DVector::zeros(self.dofs.len());
        for (ends, world) in points.windows(2).zip(world.windows(2)) {
            let segment = world[1] - world[0];
            let distance = segment.norm();
            length += distance;
            let bodies = [self.placement[ends[0].link].0, self.placement[ends[1].link].0];
            // Within one rigid body nothing changes; nor has a segment without length a direction.
            if distance > 0.0 && bodies[0] != bodies[1] {
                let unit = segment / distance;
                self.add_point_force(bodies[1], &world[1], &unit, &mut slope);
                self.add_point_force(bodies[0], &world[0], &-unit, &mut slope);
            }
        }
        self.write_reduced(&slope, jacobian);
        length
    }

    fn world_point(&self, point: &LinkPoint) -> Vector {
        self.link_pose(point.link) * Vector::from_array(point.point_m)
    }

    fn lever_route(&self, levers: &[LeverSpec], draw: Vec<LinkPoint>) -> Result<Route, MechanismError> {
        let mut arms: Vec<Arm> = Vec::new();
        let mut constant_m = 0.0;
        for lever in levers {
            let error =
                |problem: String, remedy: String| MechanismError::spec("route.lever", &lever.joint, problem, remedy);
            let joint = self.joints.iter().position(|j| j.name == lever.joint).ok_or_else(|| {
                let known = known_names(self.joints.iter().map(|j| j.name.as_str()));
                error("the URDF has no such joint".into(), known)
            })?;
            if !lever.lever_m.is_finite() {
                return Err(error(format!("lever_m = {} is not finite", lever.lever_m), "give the lever in m".into()));
            }
            match self.shares[joint] {
                Some(share) => {
                    constant_m -= lever.lever_m * share.offset;
                    arms.push(Arm { coordinate: share.coordinate, lever_m: lever.lever_m * share.multiplier });
                }
                None => constant_m -= lever.lever_m * self.joints[joint].position,
            }
        }
        let draw = if draw.is_empty() { arms.iter().filter_map(|arm| self.seat(arm)).collect() } else { draw };
        Ok(Route::Levers { arms, constant_m, draw })
    }

    /// Where a cable is drawn at a joint if the scene does not say: a lever's length off the axis, on the link that the joint (of
    /// one that mimics, its leader) moves.
    fn seat(&self, arm: &Arm) -> Option<LinkPoint> {
        let moved = self.moved.get(arm.coordinate)?;
        let axis = Vector3::from(moved.axis);
        let across = axis.cross(&Vector3::x()).try_normalize(1e-6).unwrap_or_else(Vector3::y);
        // Of a slider it is no length: m of cable by m of motion.
        let offset_m = if self.coordinates[arm.coordinate].kind == CoordinateKind::Angle { arm.lever_m } else { 0.0 };
        Some(LinkPoint { link: moved.link, point_m: (offset_m * across).into() })
    }

    fn points(&self, specs: &[PointSpec]) -> Result<Vec<LinkPoint>, MechanismError> {
        let links = &self.link_names[..self.placement.len()];
        let resolve = |spec: &PointSpec| {
            let error = |problem: &str, remedy: String| MechanismError::spec("route", &spec.link, problem, remedy);
            if !spec.point_m.iter().all(|v| v.is_finite()) {
                return Err(error("point_m is not finite", "give x, y and z in m".into()));
            }
            let link = links.iter().position(|l| *l == spec.link).ok_or_else(|| {
                let known = known_names(links.iter().map(String::as_str));
                error("the URDF has no such link", known)
            })?;
            Ok(LinkPoint { link, point_m: spec.point_m })
        };
        specs.iter().map(resolve).collect()
    }
}
