//! The mechanism: loading, and what can be read from it.

use std::path::Path;

use nalgebra::DMatrix;
use rapier3d_f64::dynamics::{Multibody, MultibodyIndex, RigidBodyHandle};
use rapier3d_f64::math::Pose;
use urdf_rs::Robot;

use super::assembly::{Source, Weight};
use super::convert::plain_pose;
use super::coordinate::Coordinate;
use super::error::MechanismError;
use super::geometry::{self, Visual};
use super::joints::{self, JointModel};
use super::linkage::Linkage;
use super::reduce::{Share, reduce};
use super::spec::MechanismSpec;
use super::tree::Tree;
use super::world::{self, Body, Built, Dof, World, leader_of};
use super::{free_bodies, shapes, urdf_file};

/// A rapier multibody behind independent joint coordinates.
///
/// Vectors of positions, velocities and forces are in the order of [`Mechanism::coordinates`];
/// a slice of another length is filled or read as far as it goes. Link indices count the URDF's
/// links in its order, then the free bodies.
///
/// ```
/// use nalgebra::DMatrix;
/// use smam::mechanism::{Mechanism, MechanismSpec};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = tempfile::tempdir()?;
/// let urdf = r#"<robot name="pendulum"><link name="base"/>
///   <link name="rod"><inertial><origin xyz="0.1 0 0"/><mass value="0.2"/>
///     <inertia ixx="1e-6" ixy="0" ixz="0" iyy="1e-6" iyz="0" izz="1e-6"/></inertial></link>
///   <joint name="hinge" type="revolute"><parent link="base"/><child link="rod"/><axis xyz="0 0 1"/>
///     <limit effort="1" velocity="1"/></joint></robot>"#;
/// std::fs::write(folder.path().join("pendulum.urdf"), urdf)?;
/// let spec = MechanismSpec {
///     urdf: "pendulum.urdf".into(),
///     gravity_m_s2: [0.0, -9.81, 0.0],
///     links_have_weight: true,
///     ..MechanismSpec::default()
/// };
/// let pendulum = Mechanism::load(&spec, folder.path())?;
/// // Held level: M = I + m l^2, and its weight turns it by -m g l.
/// let (mut inertia_kg_m2, mut torque_n_m) = (DMatrix::zeros(1, 1), [0.0]);
/// pendulum.mass_matrix(&mut inertia_kg_m2);
/// pendulum.weight(&mut torque_n_m);
/// assert!((inertia_kg_m2[(0, 0)] - (1e-6 + 0.2 * 0.01)).abs() < 1e-9);
/// assert!((torque_n_m[0] + 0.2 * 9.81 * 0.1).abs() < 1e-9);
/// # Ok(())
/// # }
/// ```
#[derive(Clone)]
pub struct Mechanism {
    pub(super) world: World,
    pub(super) multibody: Option<MultibodyIndex>,
    pub(super) bodies: Vec<Body>,
    pub(super) dofs: Vec<Dof>,
    /// The dof that is each coordinate itself.
    pub(super) leaders: Vec<usize>,
    pub(super) coordinates: Vec<Coordinate>,
    pub(super) joints: Vec<JointModel>,
    pub(super) shares: Vec<Option<Share>>,
    pub(super) link_names: Vec<String>,
    pub(super) moved: Vec<Moved>,
    /// Body of each URDF link, and the link's frame in it.
    pub(super) placement: Vec<(usize, Pose)>,
    pub(super) free_bodies: Vec<RigidBodyHandle>,
    pub(super) visuals: Vec<Visual>,
    pub(super) weights: Vec<Weight>,
    pub(super) warnings: Vec<String>,
    linkage: Linkage,
    /// Columns: what one unit of each coordinate moves each dof.
    pub(super) projection: DMatrix<f64>,
    /// Bare mass matrix over all dofs, at the current pose.
    pub(super) full_mass: DMatrix<f64>,
    /// Length of the last step, for contact forces.
    pub(super) last_step_s: f64,
}

/// What a joint moves, for drawing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moved {
    /// The link: its frame stands in the joint.
    pub link: usize,
    /// Axis in that frame, a unit vector.
    pub axis: [f64; 3],
}

impl Mechanism {
    /// Reads the URDF (relative to `base_dir`) and puts every joint at its initial position, at rest.
    ///
    /// # Errors
    /// Whatever would change the mechanics unnoticed is refused, naming file, element and remedy; what is merely
    /// ignored is listed by [`Mechanism::warnings`]. URDF joint limits are not enforced (the engine's limit rows
    /// converge badly): stops come from the scene, and [`Mechanism::beyond_limits`] tells where one is missed. Effort
    /// and velocity limits describe a motor controller and have no meaning here.
    pub fn load(spec: &MechanismSpec, base_dir: &Path) -> Result<Self, MechanismError> {
        let file = crate::stock::join(base_dir, &spec.urdf);
        Self::parse(&urdf_file::text(&file)?, &file, spec)
    }

    /// The same from the text of the URDF; `file` is where it stands: meshes are looked for from there.
    ///
    /// # Errors
    /// As [`Mechanism::load`].
    pub fn parse(urdf: &str, file: &Path, spec: &MechanismSpec) -> Result<Self, MechanismError> {
        let (robot, mut scan) = urdf_file::parse(urdf, file)?;
        check_spec(spec)?;
        let mut remarks = std::mem::take(&mut scan.remarks);
        let tree = Tree::new(file, &robot)?;
        let joints = joints::resolve(file, &robot, &spec.joint, &mut remarks)?;
        let (coordinates, shares) = reduce(&joints)?;
        let source = Source { file, robot: &robot, scan: &scan, tree: &tree, joints: &joints, spec };
        let assembly = source.assemble(&mut remarks)?;
        let mut visuals = shapes::visuals(file, &robot, &mut remarks)?;
        let mut built = world::build(&assembly, &joints, &shares, spec.gravity_m_s2);
        if let Some(contact) = &spec.contact {
            built.add_contacts(file, &robot, &assembly, contact)?;
        }
        let mut link_names: Vec<String> = robot.links.iter().map(|l| l.name.clone()).collect();
        let linkage = Linkage::new(&assembly, &joints, &shares, spec.gravity_m_s2);
        let free_bodies = free_bodies::insert(spec, &mut link_names, &mut visuals, &mut built)?;
        let mut mechanism = Self {
            link_names,
            moved: moved(&robot, &joints, &coordinates),
            free_bodies,
            visuals,
            placement: assembly.placement,
            weights: assembly.weights,
            warnings: remarks.lines(),
            linkage,
            ..Self::new(built, joints, coordinates, shares)
        };
        mechanism.refresh_mass();
        mechanism.check_mass(file)?;
        Ok(mechanism)
    }

    /// The moving parts, without names, drawings and weights.
    fn new(built: Built, joints: Vec<JointModel>, coordinates: Vec<Coordinate>, shares: Vec<Option<Share>>) -> Self {
        let leader = |c| leader_of(&built.dofs, c);
        Self {
            leaders: (0..coordinates.len()).filter_map(leader).collect(),
            projection: projection(&built.dofs, coordinates.len()),
            full_mass: DMatrix::zeros(built.dofs.len(), built.dofs.len()),
            world: World(built.world),
            multibody: built.multibody,
            bodies: built.bodies,
            dofs: built.dofs,
            coordinates,
            joints,
            shares,
            link_names: Vec::new(),
            moved: Vec::new(),
            placement: Vec::new(),
            free_bodies: Vec::new(),
            visuals: Vec::new(),
            weights: Vec::new(),
            warnings: Vec::new(),
            linkage: Linkage::default(),
            last_step_s: 0.0,
        }
    }

    /// Where its links stand, as a function of the coordinates.
    pub fn linkage(&self) -> &Linkage {
        &self.linkage
    }

    /// What the URDF holds that has no effect, one line for each kind.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Joints that are beyond their limits in the URDF, where the scene has no stop.
    pub fn beyond_limits(&self) -> impl Iterator<Item = &str> {
        let beyond = |(joint, share): &(&JointModel, &Option<Share>)| {
            let leader = share.and_then(|share| Some((share, *self.leaders.get(share.coordinate)?)));
            let position = leader.map(|(share, dof)| share.multiplier * self.dof_position(dof) + share.offset);
            position.is_some_and(|position| joint.is_beyond_limits(position))
        };
        self.joints.iter().zip(&self.shares).filter(beyond).map(|(joint, _)| joint.name.as_str())
    }

    /// The independent joint coordinates.
    pub fn coordinates(&self) -> &[Coordinate] {
        &self.coordinates
    }

    /// Position of each coordinate, rad or m.
    pub fn positions(&self, out: &mut [f64]) {
        for (value, &dof) in out.iter_mut().zip(&self.leaders) {
            *value = self.dof_position(dof);
        }
    }

    /// The engine's velocity of each coordinate, rad/s or m/s.
    pub fn velocities(&self, out: &mut [f64]) {
        for (value, &dof) in out.iter_mut().zip(&self.leaders) {
            *value = self.multibody().map_or(0.0, |m| m.generalized_velocity()[dof]);
        }
    }

    /// Names of the URDF's links, then of the free bodies.
    pub fn link_names(&self) -> &[String] {
        &self.link_names
    }

    /// What each coordinate's joint moves.
    pub fn moved(&self) -> &[Moved] {
        &self.moved
    }

    /// Pose of each link, then of each free body, in the world.
    pub fn link_poses(&self) -> Vec<geometry::Pose> {
        let links = (0..self.placement.len()).map(|link| plain_pose(&self.link_pose(link)));
        let free = self.free_bodies.iter().map(|h| {
            let pose = self.world.0.bodies.get(*h).map_or(Pose::IDENTITY, |b| *b.position());
            plain_pose(&pose)
        });
        links.chain(free).collect()
    }

    /// What to draw, fixed to links and free bodies.
    pub fn visuals(&self) -> &[Visual] {
        &self.visuals
    }

    pub(super) fn multibody(&self) -> Option<&Multibody> {
        self.world.0.multibody_joints.get_multibody(self.multibody?)
    }

    /// Pose of a URDF link in the world.
    pub(super) fn link_pose(&self, link: usize) -> Pose {
        let (body, in_body) = self.placement[link];
        self.body_pose(body) * in_body
    }

    pub(super) fn body_pose(&self, body: usize) -> Pose {
        let link = self.multibody().and_then(|m| m.link(self.bodies[body].link_id));
        link.map_or(Pose::IDENTITY, |l| *l.local_to_world())
    }

    pub(super) fn dof_position(&self, dof: usize) -> f64 {
        let dof = &self.dofs[dof];
        let link = self.multibody().and_then(|m| m.link(self.bodies[dof.body].link_id));
        link.map_or(0.0, |l| l.joint().coords()[dof.axis()])
    }

    fn check_mass(&self, file: &Path) -> Result<(), MechanismError> {
        let mass = self.projection.tr_mul(&(&self.full_mass * &self.projection));
        for (coordinate, moved) in self.coordinates.iter().zip(mass.diagonal().iter()) {
            if !(*moved > 0.0 && moved.is_finite()) {
                let problem = format!("moves no inertia (M = {moved:e})");
                let remedy = "give the links it carries mass and inertia";
                let name = &coordinate.name;
                return Err(MechanismError::urdf(file, "joint", name, problem, remedy));
            }
        }
        Ok(())
    }
}

/// What each coordinate's joint moves. Coordinates are named after joints, and a URDF's joints have links.
fn moved(robot: &Robot, joints: &[JointModel], coordinates: &[Coordinate]) -> Vec<Moved> {
    let of = |c: &Coordinate| {
        let joint = joints.iter().position(|j| j.name == c.name)?;
        let child = &robot.joints[joint].child.link;
        let link = robot.links.iter().position(|l| l.name == *child)?;
        Some(Moved { link, axis: joints[joint].axis })
    };
    coordinates.iter().map(|c| of(c).unwrap_or_default()).collect()
}

fn projection(dofs: &[Dof], coordinates: usize) -> DMatrix<f64> {
    DMatrix::from_fn(dofs.len(), coordinates, |row, column| {
        let share = dofs[row].share;
        if share.coordinate == column { share.multiplier } else { 0.0 }
    })
}

fn check_spec(spec: &MechanismSpec) -> Result<(), MechanismError> {
    if !spec.gravity_m_s2.iter().all(|g| g.is_finite()) {
        let problem = format!("gravity_m_s2 = {:?} is not finite", spec.gravity_m_s2);
        return Err(MechanismError::spec("gravity", "gravity_m_s2", problem, "give [0.0, 0.0, -9.81], or what it is"));
    }
    let Some(contact) = &spec.contact else {
        return Ok(());
    };
    if contact.pgs_iterations == 0 {
        let problem = "pgs_iterations = 0 solves no contact";
        return Err(MechanismError::spec(
            "contact",
            "pgs_iterations",
            problem,
            "give 1 or more; 100 to 200 at steps of 1 ms",
        ));
    }
    let values = [
        ("natural_frequency_hz", contact.natural_frequency_hz),
        ("damping_ratio", contact.damping_ratio),
        ("length_unit_m", contact.length_unit_m),
    ];
    let positive = values.iter().find(|(_, v)| !(*v > 0.0 && v.is_finite()));
    let friction = Some(("friction_coefficient", contact.friction_coefficient));
    let friction = friction.filter(|(_, v)| !(*v >= 0.0 && v.is_finite()));
    match positive.copied().or(friction) {
        Some((key, value)) => {
            let problem = format!("{value} is out of range");
            Err(MechanismError::spec("contact", key, problem, "give a positive number"))
        }
        None => Ok(()),
    }
}
