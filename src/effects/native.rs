//! Entries whose law is code.

use serde::Deserialize;

/// Which code an entry of the catalogue stands for: asked only where that code is put into the equations.
///
/// `smam trial` numbers its cases, and with them their seeds, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Native {
    TrappedAir,
    Leak,
    LineRestriction,
    ThermalExpansion,
    PlungerBacklash,
    SealFriction,
    ChamberLeak,
    ChamberGap,
    ChamberOrifice,
    RubberYeoh,
    RubberMooneyRivlin,
    RubberOgden,
    RubberGent,
    Viscoelasticity,
    MullinsSoftening,
    CoilPreload,
    PlasticSet,
    PressureFriction,
    GravityLoad,
    BearingFriction,
    CableSlack,
    TendonFriction,
    TendonCoupling,
    ExternalContact,
    NotchClosure,
    SensorLag,
    SensorDelay,
    SensorDrift,
    SensorGain,
}
