//! What may be hidden in a plant: numbers of its physics beyond the stock rigs', all zero in those.

/// Hidden physics of one muscle, its line and its syringe. All zero: the stock muscle.
#[derive(Clone, Debug, Default)]
pub struct MuscleSecrets {
    pub air_m3: f64,
    pub air_exponent: f64,
    /// Conductance, m³/(s Pa), and by how much it grows per Pa.
    pub leak: f64,
    pub leak_growth_1_pa: f64,
    pub restriction: f64,
    /// Added to the restriction while the fluid comes back, and its growth with flow, s/m³.
    pub return_restriction: f64,
    pub restriction_growth_s_m3: f64,
    pub growth_m3_s: f64,
    /// Over which the growth dies away; 0: never.
    pub growth_fades_s: f64,
    pub play_m: f64,
    /// Stiffness and time of two branches, and their hardening, 1/m².
    pub branches: [(f64, f64); 2],
    pub branch_hardening_1_m2: f64,
    pub softening: f64,
    /// Saturating exponential instead of the hyperbolic tangent.
    pub softens_exponentially: bool,
    pub preload_n: f64,
    pub preload_exponential: bool,
    pub set_rate_1_s: f64,
    pub set_threshold_m: f64,
    pub set_power: f64,
    pub load_n: f64,
    pub coil_loss_1_s: f64,
    pub barrel_m3_pa: f64,
    pub barrel_s: f64,
    pub rate_force_n: f64,
    pub fibre_n_m: f64,
    pub fibre_breaks_s: f64,
    pub ripple_m: f64,
    pub ripple_hz: f64,
    pub area_growth_1_m: f64,
    pub cubic_n_m3: f64,
}

/// Hidden physics of the mechanism and its cables.
#[derive(Clone, Debug, Default)]
pub struct MechanismSecrets {
    pub bearing_n_m: f64,
    pub bearing_rad: f64,
    /// Smooth in the speed instead of Dahl's state.
    pub bearing_by_speed: bool,
    pub slack_m: [f64; 2],
    pub capstan: f64,
    pub capstan_by_speed: bool,
    pub coupling_m: f64,
    pub wall_n_m_rad: f64,
    pub wall_rad: f64,
    pub wall_power: f64,
    pub notch_n_m_rad: f64,
    pub notch_rad: f64,
    pub load_n_m: f64,
}
