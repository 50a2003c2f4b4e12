//! The muscle: a silicone microtube in a coil. Energies, pulls and volumes; no time, no IO.
//!
//! `F_pull = dU/dL - p A_c + F_fric + c de/dt` with the elongation `e = L - L0` in m (> 0: longer), the gauge
//! pressure `p` in Pa and `A_c = pi R_c^2`. The wall gives `dU/dL` (and, where it may leave the coil, the
//! pressure's part too), the coil its spring, the friction its force; whoever steps time adds them up.
//!
//! The stock muscle at its end:
//!
//! ```
//! use smam::muscle::{Coil, Material, Wall, WallGeometry, YIELD_STRETCH};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let tube = WallGeometry { inner_radius_m: 0.255e-3, outer_radius_m: 0.525e-3, rest_length_m: 0.05 };
//! let wall = Wall::new(tube, Material::Yeoh { c1_pa: 0.255e6_f64, c2_pa: 0.0155e6, c3_pa: 0.0 })?;
//! let coil = Coil { stiffness_n_m: 28.3_f64, preload_n: 0.0 };
//! // At 175 mm, where the coil yields, wall and coil pull with 6.3 N ...
//! let elongation_m = (YIELD_STRETCH - 1.0) * tube.rest_length_m;
//! let pull_n = wall.pull_n(elongation_m) + coil.pull_n(elongation_m);
//! assert!((pull_n - 6.31).abs() < 0.03);
//! // ... and 7.3 MPa in the bore would hold them.
//! assert!((pull_n / tube.coil_area_m2() / 7.29e6 - 1.0).abs() < 0.01);
//! # Ok(())
//! # }
//! ```

mod coil;
mod error;
mod friction;
mod material;
mod rubber_term;
mod section;
mod strip;
mod table;
mod wall;

#[cfg(test)]
mod friction_tests;
#[cfg(test)]
mod unilateral_tests;
#[cfg(test)]
mod wall_tests;

pub use coil::{Coil, SAFE_STRETCH, YIELD_STRETCH, spring_rate};
pub use error::MuscleError;
pub use friction::Friction;
pub use material::{Material, OgdenTerm};
pub use wall::{Wall, WallCondition, WallGeometry};

// The program's own: not part of what the documentation offers.
#[doc(hidden)]
pub use {
    coil::{Stop, StopPush},
    friction::RateJacobian,
    rubber_term::RubberTerm,
    wall::{ElongationRange, WallState},
};
