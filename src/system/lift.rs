//! A plant of plain numbers as one of another number type: every number a constant.

use crate::hydraulics::Chain;
use crate::muscle::{Coil, Friction, Stop};
use crate::scalar::Scalar;

use super::extras::{MechanismExtras, MuscleExtras};
use super::{CablePlant, Coordinates, Drive, Elastic, MusclePlant, Plant};

fn all<D: Scalar>(values: &[f64]) -> Vec<D> {
    values.iter().map(|&x| D::constant(x)).collect()
}

impl Plant<f64> {
    /// The same plant over `D`. It must carry no effects yet: those are installed over `D`.
    pub(super) fn lift<D: Scalar>(&self) -> Plant<D> {
        Plant {
            coordinates: self.coordinates.lift(),
            muscles: self.muscles.iter().map(MusclePlant::lift).collect(),
            cables: self.cables.iter().map(CablePlant::lift).collect(),
            mechanism: MechanismExtras::default(),
            laws: self.laws.as_ref().map(|laws| Box::new(laws.lift())),
            posed: self.posed.as_ref().map(|posed| Box::new(posed.lift())),
        }
    }
}

impl Coordinates<f64> {
    fn lift<D: Scalar>(&self) -> Coordinates<D> {
        Coordinates {
            inertia: all(&self.inertia),
            damping: all(&self.damping),
            stiffness: all(&self.stiffness),
            rest: self.rest.clone(),
            force: all(&self.force),
            stops: self.stops.clone(),
            contact: None,
        }
    }
}

impl MusclePlant<f64> {
    fn lift<D: Scalar>(&self) -> MusclePlant<D> {
        let c = D::constant;
        MusclePlant {
            drive: self.drive.lift(),
            elastic: self.elastic.lift(),
            friction: self.friction.map(|f| Friction {
                m0_n: c(f.m0_n),
                m1_n_pa: c(f.m1_n_pa),
                presliding_length_m: c(f.presliding_length_m),
                a: c(f.a),
                nu: c(f.nu),
                n: c(f.n),
                rho: c(f.rho),
            }),
            damping_n_s_m: c(self.damping_n_s_m),
            stop: self.stop.map(|s| Stop { stiffness_n_m: c(s.stiffness_n_m), damping_n_s_m: c(s.damping_n_s_m) }),
            jacobian: self.jacobian.clone(),
            elongation_0_m: self.elongation_0_m,
            extras: MuscleExtras::default(),
            slow_at: 0,
        }
    }
}

impl Drive<f64> {
    fn lift<D: Scalar>(&self) -> Drive<D> {
        match self {
            Self::Pressure { pressure } => Drive::Pressure { pressure: *pressure },
            Self::Hydraulic { chain, syringe_area_m2, plunger } => Drive::Hydraulic {
                chain: Chain {
                    compliance_m3_pa: all(&chain.compliance_m3_pa),
                    resistance_pa_s_m3: D::constant(chain.resistance_pa_s_m3),
                    quadratic_pa_s2_m6: D::constant(chain.quadratic_pa_s2_m6),
                    inertance_pa_s2_m3: D::constant(chain.inertance_pa_s2_m3),
                    cavitation_pressure_pa: chain.cavitation_pressure_pa,
                    end_share_m3_pa: chain.end_share_m3_pa,
                },
                syringe_area_m2: *syringe_area_m2,
                plunger: *plunger,
            },
        }
    }
}

impl Elastic<f64> {
    fn lift<D: Scalar>(&self) -> Elastic<D> {
        let c = D::constant;
        match self {
            Self::Tube { wall, condition, coil, area_growth_1_m } => Elastic::Tube {
                wall: wall.with_material(wall.material().map(D::constant)),
                condition: *condition,
                coil: Coil { stiffness_n_m: c(coil.stiffness_n_m), preload_n: c(coil.preload_n) },
                area_growth_1_m: c(*area_growth_1_m),
            },
            Self::Linear { stiffness_n_m, pressure_gain_m2 } => {
                Elastic::Linear { stiffness_n_m: c(*stiffness_n_m), pressure_gain_m2: c(*pressure_gain_m2) }
            }
        }
    }
}

impl CablePlant<f64> {
    fn lift<D: Scalar>(&self) -> CablePlant<D> {
        CablePlant {
            stiffness_n_m: D::constant(self.stiffness_n_m),
            damping_n_s_m: D::constant(self.damping_n_s_m),
            stretch_0_m: D::constant(self.stretch_0_m),
            jacobian: self.jacobian.clone(),
            drive: self.drive,
            friction: None,
            lean: None,
        }
    }
}
