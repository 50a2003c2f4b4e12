//! Where links stand as a function of the coordinates, for any number type: what the engine knows of the present pose alone.
//!
//! Poses go from the root outwards, `T_child = T_parent F M(q)`: `F` the joint's frame, `M` a turn about its axis or a way along it. The
//! derivative of a point by a joint's angle is `axis x (point - joint)`, by its way `axis`.

use nalgebra::{Matrix3, Vector3};

use crate::scalar::Scalar;

use super::assembly::{Assembly, Weight};
use super::convert::{na_vector, rotation_matrix};
use super::coordinate::CoordinateKind;
use super::joints::JointModel;
use super::reduce::Share;
use super::route::LinkPoint;

/// A turn and a place, m.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Frame<D> {
    turn: [[D; 3]; 3],
    place: [D; 3],
}

/// A body that a joint carries.
#[derive(Clone, Debug)]
struct Carried {
    parent: usize,
    frame: Frame<f64>,
    axis: [f64; 3],
    kind: CoordinateKind,
    share: Share,
}

/// The links of a mechanism without the engine.
#[derive(Clone, Debug, Default)]
pub struct Linkage {
    /// Bodies after the root, parents first.
    carried: Vec<Carried>,
    /// Body of each link, and its frame there.
    links: Vec<(usize, Frame<f64>)>,
    weights: Vec<Weight>,
    gravity_m_s2: [f64; 3],
}

/// A linkage at one place of its coordinates.
pub struct Placement<'a, D> {
    linkage: &'a Linkage,
    /// Of each body, the root first.
    bodies: Vec<Frame<D>>,
    /// Axis of each carried body's joint in the world.
    axes: Vec<[D; 3]>,
}

impl Linkage {
    /// `shares` of each joint, as they hang on coordinates.
    pub(super) fn new(
        assembly: &Assembly,
        joints: &[JointModel],
        shares: &[Option<Share>],
        gravity_m_s2: [f64; 3],
    ) -> Self {
        let frame =
            |pose: &rapier3d_f64::math::Pose| Frame::of(&rotation_matrix(&pose.rotation), &na_vector(pose.translation));
        let carried = assembly.bodies.iter().filter_map(|body| {
            let joint = body.joint?;
            let (model, share) = (&joints[joint], shares[joint]?);
            Some(Carried { parent: body.parent, frame: frame(&body.frame), axis: model.axis, kind: model.kind, share })
        });
        Self {
            carried: carried.collect(),
            links: assembly.placement.iter().map(|(body, pose)| (*body, frame(pose))).collect(),
            weights: assembly.weights.clone(),
            gravity_m_s2,
        }
    }

    /// The links where the coordinates are `q`, rad or m.
    pub fn at<D: Scalar>(&self, q: &[D]) -> Placement<'_, D> {
        let mut bodies = vec![Frame::<f64>::STILL.lift()];
        let mut axes = Vec::with_capacity(self.carried.len());
        for own in &self.carried {
            let before = bodies[own.parent].after(&own.frame);
            let position = q[own.share.coordinate] * own.share.multiplier + own.share.offset;
            axes.push(before.turned(&own.axis.map(D::constant)));
            bodies.push(before.moved(&own.axis, own.kind, position));
        }
        Placement { linkage: self, bodies, axes }
    }
}

impl<D: Scalar> Placement<'_, D> {
    /// A point of a link in the world, m.
    pub fn point(&self, at: &LinkPoint) -> [D; 3] {
        let (body, in_body) = &self.linkage.links[at.link];
        let own = in_body.lift::<D>().applied(&at.point_m.map(D::constant));
        self.bodies[*body].applied(&own)
    }

    /// A link's origin as another link sees it, m.
    pub(crate) fn origin_in(&self, link: usize, frame: usize) -> [D; 3] {
        let origin = self.point(&LinkPoint { link, point_m: [0.0; 3] });
        let (body, in_body) = &self.linkage.links[frame];
        self.bodies[*body].after(in_body).seen(&origin)
    }

    /// The rotation vector of a link, from another or from the world, rad.
    pub(crate) fn rotation_from(&self, link: usize, frame: Option<usize>) -> [D; 3] {
        let turn = |link: usize| {
            let (body, in_body) = &self.linkage.links[link];
            self.bodies[*body].after(in_body).turn
        };
        let own = turn(link);
        let from = frame.map_or_else(|| Frame::<f64>::STILL.lift().turn, turn);
        let column = |m: &[[D; 3]; 3], j: usize| [m[0][j], m[1][j], m[2][j]];
        rotation_vector(&[0, 1, 2].map(|i| [0, 1, 2].map(|j| dot(&column(&from, i), &column(&own, j)))))
    }

    /// Length of straight segments through points, m, and its derivative by each coordinate, m/rad or m/m.
    pub fn path_length(&self, points: &[LinkPoint], slope: &mut [D]) -> D {
        slope.fill(D::constant(0.0));
        let world: Vec<[D; 3]> = points.iter().map(|p| self.point(p)).collect();
        let mut length = D::constant(0.0);
        for (ends, world) in points.windows(2).zip(world.windows(2)) {
            let segment = minus(&world[1], &world[0]);
            let square = dot(&segment, &segment);
            let bodies = [self.linkage.links[ends[0].link].0, self.linkage.links[ends[1].link].0];
            if !square.is_above(0.0) {
                continue;
            }
            let distance = square.sqrt();
            length += distance;
            // Within one rigid body nothing changes.
            if bodies[0] != bodies[1] {
                let unit = segment.map(|x| x / distance);
                self.push(bodies[1], &world[1], &unit, slope);
                self.push(bodies[0], &world[0], &unit.map(|x| -x), slope);
            }
        }
        length
    }

    /// Generalised force of gravity on what has weight, N m or N.
    pub fn weight(&self, out: &mut [D]) {
        out.fill(D::constant(0.0));
        for weight in &self.linkage.weights {
            let point = self.bodies[weight.body].applied(&[0, 1, 2].map(|i| D::constant(weight.point_m[i])));
            let force = self.linkage.gravity_m_s2.map(|g| D::constant(g * weight.mass_kg));
            self.push(weight.body, &point, &force, out);
        }
    }

    /// Adds what a force at a world point of a body does along each coordinate.
    fn push(&self, body: usize, point: &[D; 3], force: &[D; 3], out: &mut [D]) {
        let mut body = body;
        while let Some(own) = body.checked_sub(1).map(|i| &self.linkage.carried[i]) {
            let axis = &self.axes[body - 1];
            let along = match own.kind {
                CoordinateKind::Length => dot(axis, force),
                CoordinateKind::Angle => dot(&cross(axis, &minus(point, &self.bodies[body].place)), force),
            };
            out[own.share.coordinate] += along * own.share.multiplier;
            body = own.parent;
        }
    }
}

impl Frame<f64> {
    const STILL: Self = Self { turn: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], place: [0.0; 3] };

    fn of(turn: &Matrix3<f64>, place: &Vector3<f64>) -> Self {
        Self { turn: [0, 1, 2].map(|i| [0, 1, 2].map(|j| turn[(i, j)])), place: [0, 1, 2].map(|i| place[i]) }
    }

    fn lift<D: Scalar>(&self) -> Frame<D> {
        Frame { turn: self.turn.map(|row| row.map(D::constant)), place: self.place.map(D::constant) }
    }
}

impl<D: Scalar> Frame<D> {
    fn turned(&self, v: &[D; 3]) -> [D; 3] {
        self.turn.each_ref().map(|row| dot(row, v))
    }

    fn applied(&self, point: &[D; 3]) -> [D; 3] {
        let turned = self.turned(point);
        [0, 1, 2].map(|i| turned[i] + self.place[i])
    }

    /// A world point in this frame.
    fn seen(&self, point: &[D; 3]) -> [D; 3] {
        let apart = minus(point, &self.place);
        [0, 1, 2].map(|j| self.turn[0][j] * apart[0] + self.turn[1][j] * apart[1] + self.turn[2][j] * apart[2])
    }

    /// A frame that is fixed in this one, in the world.
    fn after(&self, own: &Frame<f64>) -> Self {
        let columns = [0, 1, 2].map(|j| self.turned(&[0, 1, 2].map(|i| D::constant(own.turn[i][j]))));
        Self {
            turn: [0, 1, 2].map(|i| [0, 1, 2].map(|j| columns[j][i])),
            place: self.applied(&own.place.map(D::constant)),
        }
    }

    /// Turned about, or moved along, an axis of its own.
    fn moved(&self, axis: &[f64; 3], kind: CoordinateKind, by: D) -> Self {
        match kind {
            CoordinateKind::Length => Self { place: self.applied(&axis.map(|a| by * a)), ..*self },
            CoordinateKind::Angle => {
                let columns = [0, 1, 2].map(|j| {
                    let mut unit = [0.0; 3];
                    unit[j] = 1.0;
                    self.turned(&turned_about(axis, by, &unit))
                });
                Self { turn: [0, 1, 2].map(|i| [0, 1, 2].map(|j| columns[j][i])), place: self.place }
            }
        }
    }
}

/// Rodrigues: `v cos a + (axis x v) sin a + axis (axis . v) (1 - cos a)`.
fn turned_about<D: Scalar>(axis: &[f64; 3], angle: D, v: &[f64; 3]) -> [D; 3] {
    let (sin, cos) = (angle.sin(), angle.cos());
    let across = Vector3::from(*axis).cross(&Vector3::from(*v));
    let along = Vector3::from(*axis).dot(&Vector3::from(*v));
    [0, 1, 2].map(|i| cos * v[i] + sin * across[i] + (-cos + 1.0) * (axis[i] * along))
}

/// Below this sine of the angle, squared, the vector is a series in it: its length has no derivative at zero.
const SMALL: f64 = 1e-4;
/// Steps of Newton's iteration from 0 to any angle below 3.1 rad; the last ones triple the digits.
const NEWTON: usize = 12;

/// Axis times angle of a rotation matrix: `w a/sin(a)`, `w` its skew part, `a` from `|w| = sin(a)` and `cos(a) = (trace - 1)/2`.
fn rotation_vector<D: Scalar>(turn: &[[D; 3]; 3]) -> [D; 3] {
    let skew = [turn[2][1] - turn[1][2], turn[0][2] - turn[2][0], turn[1][0] - turn[0][1]].map(|x| x * 0.5);
    let square = dot(&skew, &skew);
    let (sin, cos) = (square.sqrt(), (turn[0][0] + turn[1][1] + turn[2][2] - 1.0) * 0.5);
    let angle = (0..NEWTON).fold(D::constant(0.0), |angle, _| angle + sin * angle.cos() - cos * angle.sin());
    // asin(s)/s = 1 + s²/6 + 3 s⁴/40.
    let series = square * square * (3.0 / 40.0) + square / 6.0 + 1.0;
    let longer = square.select_above(D::constant(SMALL), angle / sin, series);
    skew.map(|x| x * longer)
}

fn dot<D: Scalar>(a: &[D; 3], b: &[D; 3]) -> D {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus<D: Scalar>(a: &[D; 3], b: &[D; 3]) -> [D; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross<D: Scalar>(a: &[D; 3], b: &[D; 3]) -> [D; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use num_dual::Dual64;

    use super::*;
    use crate::mechanism::{Mechanism, MechanismSpec, PointSpec, Route, RouteSpec};

    /// A finger of two joints that do not lie in one plane, a slider at its tip, and a follower.
    const FINGER: &str = r#"<robot name="finger"><link name="palm"/>
        <link name="near"><inertial><origin xyz="0.02 0.001 0"/><mass value="0.02"/>
          <inertia ixx="1e-6" ixy="0" ixz="0" iyy="1e-6" iyz="0" izz="1e-6"/></inertial></link>
        <link name="far"><inertial><origin xyz="0.01 0 0.002"/><mass value="0.01"/>
          <inertia ixx="1e-6" ixy="0" ixz="0" iyy="1e-6" iyz="0" izz="1e-6"/></inertial></link>
        <link name="nail"><inertial><mass value="0.002"/>
          <inertia ixx="1e-7" ixy="0" ixz="0" iyy="1e-7" iyz="0" izz="1e-7"/></inertial></link>
        <link name="tip"/>
        <joint name="base" type="revolute"><parent link="palm"/><child link="near"/><origin xyz="0.01 0.02 0.03" rpy="0.1 0.2 0.3"/>
          <axis xyz="0 0.6 0.8"/><limit effort="1" velocity="1"/></joint>
        <joint name="knuckle" type="revolute"><parent link="near"/><child link="far"/><origin xyz="0.04 0 0" rpy="0 0.5 0"/>
          <axis xyz="0 0 1"/><mimic joint="base" multiplier="0.7" offset="0.1"/><limit effort="1" velocity="1"/></joint>
        <joint name="slide" type="prismatic"><parent link="far"/><child link="nail"/><origin xyz="0.03 0 0"/>
          <axis xyz="1 0 0"/><limit effort="1" velocity="1"/></joint>
        <joint name="end" type="fixed"><parent link="nail"/><child link="tip"/><origin xyz="0.005 0.001 0" rpy="0 0 0.4"/></joint></robot>"#;

    fn finger() -> Mechanism {
        let spec =
            MechanismSpec { gravity_m_s2: [1.0, -9.81, 3.0], links_have_weight: true, ..MechanismSpec::default() };
        Mechanism::parse(FINGER, std::path::Path::new("finger.urdf"), &spec).unwrap_or_else(|e| panic!("{e}"))
    }

    fn via(finger: &Mechanism) -> Vec<LinkPoint> {
        let at = |link: &str, point_m| PointSpec { link: link.to_owned(), point_m };
        let route = RouteSpec {
            via: vec![
                at("palm", [0.0, 0.01, 0.0]),
                at("near", [0.01, 0.008, 0.001]),
                at("near", [0.03, 0.007, 0.0]),
                at("tip", [0.001, 0.004, 0.002]),
            ],
            ..RouteSpec::default()
        };
        match finger.route(&route) {
            Ok(Route::Via(points)) => points,
            other => panic!("{other:?}"),
        }
    }

    /// Points, lengths, levers and weights are the engine's in any pose.
    #[test]
    fn it_stands_where_the_engine_puts_it() {
        let mut finger = finger();
        let points = via(&finger);
        for q in [[0.0, 0.0], [0.4, 0.002], [-1.3, 0.01], [2.5, -0.004]] {
            finger.place(&q);
            let linkage = finger.linkage().clone();
            let here = linkage.at(&q);
            let poses = finger.link_poses();
            for (link, pose) in poses.iter().enumerate() {
                let own = here.point(&LinkPoint { link, point_m: [0.0; 3] });
                assert!((0..3).all(|i| (own[i] - pose.translation_m[i]).abs() < 1e-12), "{q:?} {link}");
            }
            let (tip, far) = (poses.len() - 1, 2);
            let seen = here.origin_in(tip, far);
            let wanted = poses[far].to_local(poses[tip].translation_m);
            assert!((0..3).all(|i| (seen[i] - wanted[i]).abs() < 1e-12), "{seen:?} {wanted:?}");
            let turned = here.rotation_from(tip, Some(0));
            let wanted = poses[tip].rotation_from(poses[0]);
            assert!((0..3).all(|i| (turned[i] - wanted[i]).abs() < 1e-11), "{q:?} {turned:?} {wanted:?}");
            let (mut own, mut wanted) = ([0.0; 2], [0.0; 2]);
            let length = here.path_length(&points, &mut own);
            let engine = finger.path_length(&Route::Via(points.clone()), &mut wanted);
            assert!(
                (length - engine).abs() < 1e-12 && (0..2).all(|i| (own[i] - wanted[i]).abs() < 1e-12),
                "{own:?} {wanted:?}"
            );
            here.weight(&mut own);
            finger.weight(&mut wanted);
            assert!((0..2).all(|i| (own[i] - wanted[i]).abs() < 1e-12), "{own:?} {wanted:?}");
        }
    }

    /// About one axis the vector is the angle, with a slope of one, also where it is none.
    #[test]
    fn a_rotation_vector_is_the_angle_about_its_axis() {
        for angle in [0.0, 1e-9, 5e-3, -0.011, 0.7, -2.0, 3.05] {
            let axis = [0.0, 0.6, 0.8];
            let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
                .map(|unit| turned_about(&axis, Dual64::new(angle, 1.0), &unit));
            let found = rotation_vector(&[0, 1, 2].map(|i| [0, 1, 2].map(|j| columns[j][i])));
            for (found, axis) in found.iter().zip(axis) {
                assert!((found.re - axis * angle).abs() < 1e-9 && (found.eps - axis).abs() < 1e-7, "{angle} {found:?}");
            }
        }
    }

    /// The derivative of the length by a coordinate is the lever, and that of the lever is its own slope.
    #[test]
    fn derivatives_go_through() {
        let finger = finger();
        let (points, linkage) = (via(&finger), finger.linkage());
        let at = |angle: f64| {
            let q = [Dual64::new(angle, 1.0), Dual64::from(0.002)];
            let mut slope = [Dual64::from(0.0); 2];
            let length = linkage.at(&q).path_length(&points, &mut slope);
            (length, slope)
        };
        let (length, slope) = at(0.7);
        assert!((length.eps - slope[0].re).abs() < 1e-14);
        let step = 1e-5;
        let rough = (at(0.7 + step).1[0].re - at(0.7 - step).1[0].re) / (2.0 * step);
        assert!((slope[0].eps - rough).abs() < 1e-9, "{} {rough}", slope[0].eps);
    }
}
