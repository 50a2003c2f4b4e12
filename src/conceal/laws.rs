//! Laws of the plant without memory: softened rubber, a coil wound tight, pressures of fluid, air and vapour.

use super::hidden::MuscleSecrets;
use super::stock::{ATMOSPHERE_PA, BOILING_PA, DOWNSTREAM_COMPLIANCE_M3_PA};

/// How a boiling node gives way, m³/Pa: a hundred times more than the compliances do.
const VAPOUR_M3_PA: f64 = 1e-12;

/// Share of the wall's force left `below` its greatest energy, J.
pub fn softening(s: &MuscleSecrets, below: f64) -> f64 {
    let depth = below.max(0.0) / 0.02;
    let grown = if s.softens_exponentially { 1.0 - (-depth).exp() } else { depth.tanh() };
    1.0 - s.softening * grown
}

pub fn preload(s: &MuscleSecrets, e: f64) -> f64 {
    let share = if s.preload_exponential { e.signum() * (1.0 - (-e.abs() / 3e-4).exp()) } else { (e / 2.5e-4).tanh() };
    s.preload_n * share
}

/// Pressure of a node that holds less than it does when it begins to boil; none where it holds more.
pub fn boiling(volume_m3: f64, boiling_m3: f64) -> Option<f64> {
    (volume_m3 < boiling_m3).then(|| BOILING_PA + (volume_m3 - boiling_m3) / VAPOUR_M3_PA)
}

/// Volume pressed into the compliance at the muscle, and into a bubble there.
pub fn far_volume_m3(s: &MuscleSecrets, pressure_pa: f64) -> f64 {
    let squeezed = |ratio: f64| s.air_m3 * (1.0 - ratio.powf(1.0 / s.air_exponent));
    let air = if s.air_m3 == 0.0 { 0.0 } else { squeezed(ATMOSPHERE_PA / (ATMOSPHERE_PA + pressure_pa)) };
    DOWNSTREAM_COMPLIANCE_M3_PA * pressure_pa + air
}

/// Pressure at the muscle. The volume grows with pressure and ever less steeply: Newton's iteration from below is monotone.
pub fn far_pressure_pa(s: &MuscleSecrets, volume_m3: f64) -> f64 {
    if let Some(pressure) = boiling(volume_m3, far_volume_m3(s, BOILING_PA)) {
        return pressure;
    }
    if s.air_m3 == 0.0 {
        return volume_m3 / DOWNSTREAM_COMPLIANCE_M3_PA;
    }
    let mut pressure = BOILING_PA;
    for _ in 0..60 {
        let ratio = ATMOSPHERE_PA / (ATMOSPHERE_PA + pressure);
        let air = s.air_m3 / (s.air_exponent * ATMOSPHERE_PA) * ratio.powf(1.0 / s.air_exponent + 1.0);
        let step = (volume_m3 - far_volume_m3(s, pressure)) / (DOWNSTREAM_COMPLIANCE_M3_PA + air);
        pressure += step;
        if step.abs() < 1e-4 {
            break;
        }
    }
    pressure
}
