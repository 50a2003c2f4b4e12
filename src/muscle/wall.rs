//! The silicone wall: held by the coil, or free to come off it.

mod unilateral;

use super::error::{MuscleError, positive};
use super::material::Material;
use super::section::{Section, SectionEnergy};
use super::table::{HeldTable, MaterialTable, held_invariant};
use crate::scalar::Scalar;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::sync::Arc;

/// The unloaded tube inside the coil. Stock: 0.255, 0.525, 50 mm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WallGeometry {
    /// Radius of the tube's bore, m.
    pub inner_radius_m: f64,
    /// Outer radius of the tube = inner radius of the coil `R_c`, m.
    pub outer_radius_m: f64,
    /// Rest length `L0`, m.
    pub rest_length_m: f64,
}

/// What the coil does to the wall's outer radius.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WallCondition {
    /// The outer radius stays `R_c` (stock): the coil pushes and, against physics, pulls.
    #[default]
    Held,
    /// The coil only pushes: the outer radius is what the pressure makes of it, at most `R_c`.
    Unilateral,
}

/// Elongations between which the wall's law holds, m; open ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElongationRange {
    pub min_m: f64,
    pub max_m: f64,
}

/// The wall at one elongation and pressure.
///
/// `Pi = U - p V` is stationary in the outer radius; `F = dPi/dL` at constant pressure, `V = -dPi/dp`, so
/// `dF/dp = -dV/dL` in every state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallState<D> {
    /// Pull `dPi/dL`, the pressure's part included, N.
    pub pull_n: D,
    /// Fluid inside the wall, m^3.
    pub volume_m3: D,
    /// Elastic energy `U`, J.
    pub energy_j: D,
    /// Outer radius of the wall, m.
    pub outer_radius_m: D,
    /// `dF/de` at constant pressure, N/m.
    pub dpull_de: D,
    /// `dF/dp` = minus the effective area, m^2.
    pub dpull_dp: D,
    /// `dV/dp` = the wall's own compliance, m^3/Pa.
    pub dvolume_dp: D,
}

/// An incompressible hyperelastic tube in a coil, open at no end.
///
/// Held: a ring of reference radius `B` has, at `lambda = 1 + e/L0`, the radius
/// `b^2 = R_c^2 - (R_c^2 - B^2)/lambda`, so `lambda_theta = b/B`, `lambda_r = 1/(lambda lambda_theta)`, and
/// `U = L0 integral of W 2 pi B dB`. The fluid's volume is `pi R_c^2 L` minus the constant volume of the wall:
/// `dV/dL = pi R_c^2` whatever the bore. Range: `e > -L0 (r0/R_c)^2`, where the bore closes.
///
/// ```
/// use smam::muscle::{Material, Wall, WallCondition, WallGeometry};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let tube = WallGeometry { inner_radius_m: 0.255e-3, outer_radius_m: 0.525e-3, rest_length_m: 0.05 };
/// let wall = Wall::new(tube, Material::Yeoh { c1_pa: 0.255e6_f64, c2_pa: 0.0155e6, c3_pa: 0.0 })?;
/// let [at, on] = [0.030, 0.031].map(|elongation_m| wall.state(WallCondition::Held, elongation_m, 1e6));
/// // Pressure pushes on the coil's bore, and a muscle that grows by a millimetre takes in a millimetre of that bore.
/// assert_eq!(at.dpull_dp, -tube.coil_area_m2());
/// assert!(((on.volume_m3 - at.volume_m3) / (1e-3 * tube.coil_area_m2()) - 1.0).abs() < 1e-9);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Wall<D> {
    geometry: WallGeometry,
    material: Material<D>,
    shared: Arc<Shared>,
    /// Pull of this material, if the law is linear in its moduli.
    pull: Option<Arc<MaterialTable<D>>>,
}

/// What depends on the geometry alone.
#[derive(Debug)]
struct Shared {
    section: Section,
    table: HeldTable,
}

impl WallGeometry {
    /// Area of the coil's bore `A_c = pi R_c^2`, m^2.
    pub fn coil_area_m2(&self) -> f64 {
        PI * self.outer_radius_m * self.outer_radius_m
    }

    /// Volume of the silicone, m^3; constant.
    pub(crate) fn silicone_volume_m3(&self) -> f64 {
        self.coil_area_m2() * self.rest_length_m * (1.0 - self.bore_share())
    }

    /// `(r0/R_c)^2`.
    fn bore_share(&self) -> f64 {
        (self.inner_radius_m / self.outer_radius_m).powi(2)
    }

    fn check(&self) -> Result<(), MuscleError> {
        positive("inner_radius_m", self.inner_radius_m)?;
        positive("outer_radius_m", self.outer_radius_m)?;
        positive("rest_length_m", self.rest_length_m)?;
        if self.inner_radius_m < self.outer_radius_m {
            return Ok(());
        }
        Err(MuscleError::NoWall { inner_m: self.inner_radius_m, outer_m: self.outer_radius_m })
    }
}

impl<D: Scalar> Wall<D> {
    /// Checks the numbers and tabulates the geometry (about a millisecond; see [`Wall::with_material`]).
    pub fn new(geometry: WallGeometry, material: Material<D>) -> Result<Self, MuscleError> {
        geometry.check()?;
        material.map(|x| x.value()).check()?;
        let section = Section::new(geometry.bore_share());
        let table = HeldTable::new(&section);
        Ok(Self::on(geometry, material, Arc::new(Shared { section, table })))
    }

    /// The same tube of another material or number type, on the same table.
    pub fn with_material<E: Scalar>(&self, material: Material<E>) -> Wall<E> {
        Wall::on(self.geometry, material, Arc::clone(&self.shared))
    }

    fn on(geometry: WallGeometry, material: Material<D>, shared: Arc<Shared>) -> Self {
        let (rest, area) = (geometry.rest_length_m, geometry.coil_area_m2());
        let pull = material.linear_coefficients().map(|c| Arc::new(shared.table.of_material(&c, rest, area)));
        Self { geometry, material, shared, pull }
    }

    pub fn geometry(&self) -> &WallGeometry {
        &self.geometry
    }

    pub fn material(&self) -> &Material<D> {
        &self.material
    }

    /// Axial stretch `lambda = 1 + e/L0`.
    pub fn stretch(&self, elongation_m: D) -> D {
        elongation_m / self.geometry.rest_length_m + 1.0
    }

    /// Elastic energy `U` of the held wall, J.
    pub fn energy_j(&self, elongation_m: D) -> D {
        let lambda = self.stretch(elongation_m);
        let tabulated = self.material.linear_coefficients().and_then(|c| self.shared.table.energy(&c, lambda));
        let energy = match tabulated {
            Some(energy) => energy,
            None => self.held_section(lambda).u,
        };
        energy * (self.geometry.coil_area_m2() * self.geometry.rest_length_m)
    }

    /// `dU/dL` of the held wall, N.
    pub fn pull_n(&self, elongation_m: D) -> D {
        self.pull_and_stiffness(elongation_m).0
    }

    /// `d2U/dL2` of the held wall, N/m.
    pub fn stiffness_n_m(&self, elongation_m: D) -> D {
        self.pull_and_stiffness(elongation_m).1
    }

    /// `dU/dL` (N) and `d2U/dL2` (N/m) of the held wall.
    #[inline]
    pub fn pull_and_stiffness(&self, elongation_m: D) -> (D, D) {
        let tabulated = self.pull.as_ref().and_then(|table| table.pull_and_stiffness(elongation_m));
        tabulated.unwrap_or_else(|| self.integrated_pull_and_stiffness(elongation_m))
    }

    #[cold]
    fn integrated_pull_and_stiffness(&self, elongation_m: D) -> (D, D) {
        let section = self.held_section(self.stretch(elongation_m));
        let area = self.geometry.coil_area_m2();
        (section.u_l * area, section.u_ll * (area / self.geometry.rest_length_m))
    }

    /// The wall at an elongation and a pressure, under either condition.
    pub fn state(&self, condition: WallCondition, elongation_m: D, pressure_pa: D) -> WallState<D> {
        match condition {
            WallCondition::Held => self.held(elongation_m, pressure_pa),
            WallCondition::Unilateral => self.unilateral(elongation_m, pressure_pa),
        }
    }

    /// The wall on the coil: `F = dU/dL - p A_c`.
    pub fn held(&self, elongation_m: D, pressure_pa: D) -> WallState<D> {
        let area = self.geometry.coil_area_m2();
        let (pull, stiffness) = self.pull_and_stiffness(elongation_m);
        WallState {
            pull_n: pull - pressure_pa * area,
            volume_m3: (elongation_m + self.geometry.rest_length_m) * area - self.geometry.silicone_volume_m3(),
            energy_j: self.energy_j(elongation_m),
            outer_radius_m: D::constant(self.geometry.outer_radius_m),
            dpull_de: stiffness,
            dpull_dp: D::constant(-area),
            dvolume_dp: D::constant(0.0),
        }
    }

    /// Where the held wall's law holds: the bore open and, for Gent, no ring past its limit.
    pub fn valid_range(&self) -> ElongationRange {
        let bore = self.shared.section.sigma_bore();
        let rest = self.geometry.rest_length_m;
        let limit = self.material.largest_invariant();
        let reach = |toward: f64| rest * (last_within(bore, limit, toward) - 1.0);
        ElongationRange {
            min_m: reach(1.0 - bore),
            max_m: if limit.is_finite() { reach((limit + 3.0).sqrt()) } else { f64::INFINITY },
        }
    }

    fn held_section(&self, lambda: D) -> SectionEnergy<D> {
        self.section_energy(lambda, D::constant(1.0))
    }

    fn section_energy(&self, lambda: D, squared_radius: D) -> SectionEnergy<D> {
        self.shared.section.energy(&self.material, lambda, squared_radius)
    }
}

/// The stretch between 1 and `toward` at which the bore's ring, the most strained one, reaches `I1 - 3 = limit`.
fn last_within(sigma_bore: f64, limit: f64, toward: f64) -> f64 {
    let (mut inside, mut outside) = (1.0, toward);
    for _ in 0..60 {
        let middle = 0.5 * (inside + outside);
        if held_invariant(middle, sigma_bore) < limit {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    inside
}
