//! The muscle: a silicone microtube in a coil. Energies, pulls and volumes; no time, no IO.
//!
//! `F_pull = dU/dL - p A_c + F_fric + c de/dt` with the elongation `e = L - L0` in m (> 0: longer), the gauge
//! pressure `p` in Pa and `A_c = pi R_c^2`. The wall gives `dU/dL` (and, where it may leave the coil, the
//! pressure's part too), the coil its spring, the friction its force; whoever steps time adds them up.

mod coil;
mod error;
mod friction;
mod material;
mod section;
mod table;
mod wall;

#[cfg(test)]
mod friction_tests;
#[cfg(test)]
mod unilateral_tests;
#[cfg(test)]
mod wall_tests;

pub use coil::{Coil, SAFE_STRETCH, Stop, StopPush, YIELD_STRETCH, spring_rate};
pub use error::MuscleError;
pub use friction::{Friction, RateJacobian};
pub use material::{Material, OgdenTerm};
pub use wall::{ElongationRange, Wall, WallCondition, WallGeometry, WallState};
