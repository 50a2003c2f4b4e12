//! Effects into the equations.

use crate::effects::{
    Backlash, CoilPreload, Effect, ElementKind, MaxwellBranch, Mullins, Native, PlasticSet, TendonFriction, TrappedAir,
    Wall, WrittenLaw, logarithmic_creep,
};
use crate::laws::Law;
use crate::muscle::Friction;
use crate::scalar::Scalar;

use super::extras::{AngleWall, CableFriction, ConstantLoad, Coupling, JointFriction};
use super::laws::{PlantLaws, Wrong};
use super::plant::{Drive, Plant, dot};
use super::state::PlantState;

/// What the effects of the mechanism act on: the joints that the first cable bends, else the first muscle's joint.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Site {
    /// 1 for each coordinate whose sum is the bending angle (or the slider's position).
    pub direction: Vec<f64>,
    /// How many equal hinges in series each coordinate stands for.
    pub hinges: Vec<usize>,
    /// Lever of a weight: the cable's, m; 1 on a slider.
    pub lever: f64,
    /// Number of the mechanism's coordinates; muscle ends follow.
    pub joints: usize,
    /// Of each of them the names of the joints that it stands for, and whether they slide.
    pub names: Vec<Vec<String>>,
    pub slides: Vec<bool>,
    /// Wrap of each cable that does not move with the joints, rad.
    pub fixed_wrap_rad: Vec<f64>,
}

impl Site {
    /// Finds the site in a plant.
    ///
    /// `joints`: names of those of each coordinate, and whether they slide.
    pub fn of<D: Scalar>(
        plant: &Plant<D>,
        (names, slides): (Vec<Vec<String>>, Vec<bool>),
        hinges: Vec<usize>,
        fixed_wrap_rad: Vec<f64>,
    ) -> Self {
        let joints = names.len();
        let levers = match (plant.cables.first(), plant.muscles.first()) {
            (Some(cable), _) => cable.jacobian.clone(),
            (None, Some(muscle)) => muscle.jacobian.clone(),
            (None, None) => Vec::new(),
        };
        let direction = levers.iter().enumerate().map(|(i, l)| f64::from(u8::from(i < joints && *l != 0.0))).collect();
        let lever = levers.iter().take(joints).find(|l| **l != 0.0).map_or(0.0, |l| l.abs());
        Self { direction, hinges, lever, joints, names, slides, fixed_wrap_rad }
    }

    /// The coordinates of the site, each with its number of hinges.
    fn coordinates(&self) -> impl Iterator<Item = (usize, usize)> {
        (0..self.direction.len()).filter(|&i| self.direction[i] != 0.0).map(|i| (i, self.hinges[i]))
    }

    fn unit(&self, coordinate: usize) -> Vec<f64> {
        let mut direction = vec![0.0; self.direction.len()];
        direction[coordinate] = 1.0;
        direction
    }
}

/// Puts an effect into a plant. Sensors, and seals of an axis, are none of the plant's: nothing happens then.
///
/// The element must exist in the plant; scenes are checked for it.
pub(super) fn install<D: Scalar>(plant: &mut Plant<D>, site: &Site, effect: &Effect<D>) {
    if let Some(written) = &effect.entry.law {
        // At zero an effect of the catalogue is absent to the last bit; derivatives to its size need it all the same.
        let is_absent = effect.entry.is_listed && D::DERIVATIVES == 0 && effect.values[0].is_at(0.0);
        if !is_absent {
            install_written(plant, site, written, effect);
        }
        return;
    }
    match effect.element.kind {
        ElementKind::Syringe | ElementKind::Line | ElementKind::Muscle => {
            effect.element.indices(plant.muscles.len()).for_each(|i| on_muscle(plant, i, effect));
        }
        ElementKind::Cable => {
            effect.element.indices(plant.cables.len()).for_each(|i| on_cable(plant, site, i, effect));
        }
        ElementKind::Mechanism => on_mechanism(plant, site, effect),
        ElementKind::Sensor => {}
    }
}

fn on_muscle<D: Scalar>(plant: &mut Plant<D>, index: usize, effect: &Effect<D>) {
    let v = &effect.values;
    let muscle = &mut plant.muscles[index];
    let extras = &mut muscle.extras;
    match effect.entry.native {
        Some(Native::PlungerBacklash) => extras.backlash = Some(Backlash { width_m: v[0] }),
        Some(Native::TrappedAir) => extras.air = Some(TrappedAir { free_volume_m3: v[0], kappa: v[1] }),
        Some(Native::Leak) => extras.leak_m3_s_pa = Some(v[0]),
        Some(Native::ThermalExpansion) => extras.growth_m3_s = Some(v[0]),
        Some(Native::LineRestriction) => {
            extras.restriction_ratio = Some(v[0]);
            if let Drive::Hydraulic { chain, .. } = &mut muscle.drive {
                chain.resistance_pa_s_m3 += chain.resistance_pa_s_m3 * v[0];
                chain.quadratic_pa_s2_m6 += v[1] / chain.segments() as f64;
            }
        }
        Some(Native::Viscoelasticity) => {
            let together = MaxwellBranch { stiffness_n_m: v[0], relaxation_time_s: v[1] };
            if v[2].is_above(0.0) {
                let relaxed_n_m = muscle.elastic.stiffness_at_rest_n_m();
                extras.branches.extend(logarithmic_creep(together, v[2].value(), relaxed_n_m));
            } else {
                extras.branches.push(together);
            }
        }
        Some(Native::MullinsSoftening) => {
            extras.mullins = Some(Mullins { softening_ratio: v[0], energy_scale_j: v[1] })
        }
        Some(Native::CoilPreload) => extras.preload = Some(CoilPreload { preload_n: v[0] }),
        Some(Native::PlasticSet) => extras.plastic = Some(PlasticSet { set_rate_1_s: v[0], threshold_m: v[1] }),
        Some(Native::PressureFriction) => {
            if let Some(friction) = &mut muscle.friction {
                friction.m1_n_pa += v[0];
            }
        }
        Some(Native::GravityLoad) => {
            plant.mechanism.loads.push(ConstantLoad { direction: muscle.jacobian.clone(), force: v[0] });
        }
        _ => {}
    }
}

fn on_cable<D: Scalar>(plant: &mut Plant<D>, site: &Site, index: usize, effect: &Effect<D>) {
    let v = &effect.values;
    let cable = &mut plant.cables[index];
    match effect.entry.native {
        Some(Native::CableSlack) => cable.stretch_0_m -= v[0],
        Some(Native::TendonFriction) => {
            let mut far = cable.jacobian.clone();
            far[site.joints..].fill(0.0);
            let fixed_wrap_rad = site.fixed_wrap_rad[index];
            let law = TendonFriction { friction_coefficient: v[0], fixed_wrap_rad, presliding_m: v[1] };
            cable.friction = Some(CableFriction { law, far, hinges: site.hinges.clone() });
        }
        _ => {}
    }
}

fn on_mechanism<D: Scalar>(plant: &mut Plant<D>, site: &Site, effect: &Effect<D>) {
    let v = &effect.values;
    let extras = &mut plant.mechanism;
    let direction = site.direction.clone();
    match effect.entry.native {
        Some(Native::GravityLoad) => extras.loads.push(ConstantLoad { direction, force: v[0] * site.lever }),
        Some(Native::TendonCoupling) => extras.couplings.push(Coupling { cable: 1, direction, lever_m: v[0] }),
        Some(Native::ExternalContact) => {
            extras.walls.push(AngleWall { direction, wall: Wall { stiffness_n_m_rad: v[0], angle_rad: v[1] } });
        }
        Some(Native::NotchClosure) => {
            for (i, hinges) in site.coordinates() {
                let n = hinges as f64;
                let wall = Wall { stiffness_n_m_rad: v[0] / n, angle_rad: v[1] * n };
                extras.walls.push(AngleWall { direction: site.unit(i), wall });
            }
        }
        Some(Native::BearingFriction) => {
            let total: usize = site.coordinates().map(|(_, n)| n).sum();
            for (i, hinges) in site.coordinates() {
                let law = Friction::dahl(v[0], D::constant(0.0), v[1] * (hinges as f64 / total as f64));
                extras.frictions.push(JointFriction { direction: site.unit(i), law });
            }
        }
        _ => {}
    }
}

/// Puts a law with the numbers of an effect into a plant. Where the rig cannot have it nothing happens: scenes are checked for it.
fn install_written<D: Scalar>(plant: &mut Plant<D>, site: &Site, written: &WrittenLaw, effect: &Effect<D>) {
    if !written.law.is_of_plant() {
        return;
    }
    let mut own = plant.laws.take().map_or_else(|| PlantLaws::new(plant, site), |laws| *laws);
    let _not_of_this_rig =
        own.add(&written.at(effect.element), written.values(&effect.values), plant.cables.len()).is_err();
    plant.laws = Some(Box::new(own));
}

/// Puts the laws of a scene into a plant.
///
/// # Errors
/// The law, and what of it the rig does not have.
pub(super) fn install_laws<D: Scalar>(plant: &mut Plant<D>, site: &Site, laws: &[Law]) -> Result<(), (String, Wrong)> {
    if laws.iter().all(|law| !law.is_of_plant()) {
        return Ok(());
    }
    let mut own = plant.laws.take().map_or_else(|| PlantLaws::new(plant, site), |laws| *laws);
    for law in laws.iter().filter(|law| law.is_of_plant()) {
        let values = law.values().into_iter().map(D::constant).collect();
        own.add(law, values, plant.cables.len()).map_err(|wrong| (law.name.clone(), wrong))?;
    }
    plant.laws = Some(Box::new(own));
    Ok(())
}

/// Gives a state the memory that the plant's effects and laws need: branches relaxed, pistons centred.
pub(super) fn settle_memory<D: Scalar>(plant: &mut Plant<D>, state: &mut PlantState<D>) {
    let mut slow = Vec::new();
    let mut energies = Vec::new();
    for muscle in &mut plant.muscles {
        let elongation = dot::<_, 0>(&muscle.jacobian, state.y()) + muscle.elongation_0_m;
        muscle.slow_at = slow.len();
        muscle.extras.count();
        slow.extend(std::iter::repeat_n(elongation, muscle.extras.branches.len()));
        slow.extend(muscle.extras.plastic.as_ref().map(|_| D::constant(0.0)));
        let softens = muscle.extras.mullins.is_some();
        energies.push(if softens { muscle.elastic.wall_energy_j(elongation) } else { D::constant(0.0) });
    }
    let sliding = if plant.cables.iter().any(|c| c.friction.is_some()) { plant.cables.len() } else { 0 };
    state.set_memory(plant.mechanism.frictions.len() + sliding, &slow);
    state.greatest_j = energies;
    PlantLaws::settle(plant, state);
}
