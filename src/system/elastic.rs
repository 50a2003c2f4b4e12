//! The conservative part of a muscle: what it pulls with at an elongation and a pressure.

use crate::effects::Mullins;
use crate::muscle::{Coil, Wall, WallCondition};
use crate::scalar::Scalar;

/// Elongation that tells the two tangents at rest apart: far above rounding, far below any stretch.
const JUST_STRETCHED_M: f64 = 1e-6;

/// Conservative law of a muscle.
#[derive(Clone, Debug)]
pub enum Elastic<D> {
    /// A microtube in a coil. While the coil holds the wall, `dV/de = A_c (1 + 2 b e)` with `b` = `area_growth_1_m`.
    Tube { wall: Wall<D>, condition: WallCondition, coil: Coil<D>, area_growth_1_m: D },
    /// `F_pull = k e + b p`: a muscle known only by its stiffness and by the pull that pressure adds
    /// (b > 0: contracts when pressurised, as twisted and coiled tubes do).
    Linear { stiffness_n_m: D, pressure_gain_m2: D },
}

/// Value and slopes of an [`Elastic`] law.
#[derive(Clone, Copy, Debug)]
pub struct ElasticPoint<D> {
    /// Pull, N, with the pressure's part in it.
    pub pull_n: D,
    /// `d pull / d elongation`, N/m.
    pub stiffness_n_m: D,
    /// `-d pull / d pressure = d volume / d elongation`, m².
    pub area_m2: D,
    /// `d volume / d pressure`, m³/Pa; zero for a wall held by its coil.
    pub compliance_m3_pa: D,
}

impl<D: Scalar> Elastic<D> {
    /// The law at elongation `e`, m, and gauge pressure `p`, Pa.
    pub fn at(&self, e: D, p: D) -> ElasticPoint<D> {
        match self {
            Self::Tube { wall, condition: WallCondition::Held, coil, area_growth_1_m } => {
                let (wall_pull, wall_stiffness) = wall.pull_and_stiffness(e);
                let (area, area_slope) = grown_area(wall, *area_growth_1_m, e);
                ElasticPoint {
                    pull_n: wall_pull + coil.pull_n(e) - p * area,
                    stiffness_n_m: wall_stiffness + coil.stiffness_n_m - p * area_slope,
                    area_m2: area,
                    compliance_m3_pa: D::constant(0.0),
                }
            }
            Self::Tube { wall, condition: WallCondition::Unilateral, coil, .. } => {
                let free = wall.unilateral(e, p);
                ElasticPoint {
                    pull_n: free.pull_n + coil.pull_n(e),
                    stiffness_n_m: free.dpull_de + coil.stiffness_n_m,
                    area_m2: -free.dpull_dp,
                    compliance_m3_pa: free.dvolume_dp,
                }
            }
            Self::Linear { stiffness_n_m, pressure_gain_m2 } => ElasticPoint {
                pull_n: *stiffness_n_m * e + *pressure_gain_m2 * p,
                stiffness_n_m: *stiffness_n_m,
                area_m2: -*pressure_gain_m2,
                compliance_m3_pa: D::constant(0.0),
            },
        }
    }

    /// Stiffness unstretched and without pressure, N/m.
    ///
    /// A wall that its coil holds from one side only has two there: pressed against the coil that of a held one, else that of a free
    /// one. Taken is the latter, which a stretch meets.
    pub(crate) fn stiffness_at_rest_n_m(&self) -> D {
        self.at(D::constant(JUST_STRETCHED_M), D::constant(0.0)).stiffness_n_m
    }

    /// The law with the wall softened by its first stretch; `greatest_j` is the greatest energy it had, J.
    ///
    /// A wall off its coil and a muscle known by its stiffness alone are softened as a whole.
    pub fn softened(&self, e: D, p: D, mullins: Option<&Mullins<D>>, greatest_j: D) -> ElasticPoint<D> {
        let mut point = self.at(e, p);
        let (Some(law), Self::Tube { wall, .. }) = (mullins, self) else { return point };
        let (pull, stiffness) = wall.pull_and_stiffness(e);
        let (factor, slope) = law.factor(wall.energy_j(e), greatest_j);
        point.pull_n += pull * (factor - 1.0);
        point.stiffness_n_m += stiffness * (factor - 1.0) + pull * pull * slope;
        point
    }

    /// Elastic energy of the wall alone, J; zero for a muscle without one.
    pub(crate) fn wall_energy_j(&self, e: D) -> D {
        match self {
            Self::Tube { wall, .. } => wall.energy_j(e),
            Self::Linear { .. } => D::constant(0.0),
        }
    }

    /// Pressure that holds the muscle at elongation `e` against an outside pull `load`, Pa, with the wall on its coil.
    pub(crate) fn holding_pressure_pa(&self, e: D, load_n: D) -> D {
        let zero = D::constant(0.0);
        match self {
            Self::Tube { wall, coil, area_growth_1_m, .. } => {
                let (wall_pull, _) = wall.pull_and_stiffness(e);
                (wall_pull + coil.pull_n(e) - load_n) / grown_area(wall, *area_growth_1_m, e).0
            }
            Self::Linear { .. } => zero,
        }
    }
}

/// `dV/de = A_c (1 + 2 b e)`, m², and its slope, m.
fn grown_area<D: Scalar>(wall: &Wall<D>, growth_1_m: D, e: D) -> (D, D) {
    let area = wall.geometry().coil_area_m2();
    let slope = growth_1_m * (2.0 * area);
    (slope * e + area, slope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::muscle::{Material, WallGeometry};

    #[test]
    fn at_rest_a_free_wall_stands_for_one_held_from_one_side() -> Result<(), Box<dyn std::error::Error>> {
        let tube = WallGeometry { inner_radius_m: 0.255e-3, outer_radius_m: 0.525e-3, rest_length_m: 0.05 };
        let material = Material::Yeoh { c1_pa: 0.255e6, c2_pa: 0.0155e6, c3_pa: 0.0 };
        let stiffness = |condition| -> Result<f64, Box<dyn std::error::Error>> {
            let wall = Wall::new(tube, material)?;
            let coil = Coil { stiffness_n_m: 0.0, preload_n: 0.0 };
            Ok(Elastic::Tube { wall, condition, coil, area_growth_1_m: 0.0 }.stiffness_at_rest_n_m())
        };
        // A free one is a bar of Young's modulus 6 c1: E A/L0.
        let section_m2 = std::f64::consts::PI * (0.525e-3_f64.powi(2) - 0.255e-3_f64.powi(2));
        let bar_n_m = 6.0 * 0.255e6 * section_m2 / 0.05;
        assert!((stiffness(WallCondition::Unilateral)? / bar_n_m - 1.0).abs() < 1e-3);
        assert!(stiffness(WallCondition::Held)? > 1.2 * bar_n_m);
        Ok(())
    }
}
