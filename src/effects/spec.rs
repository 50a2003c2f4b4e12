//! How an effect of the catalogue is described.

use super::{ElementKind, LawId};

/// Which law an effect is; the key of everything that must tell them apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    TrappedAir,
    Leak,
    LineRestriction,
    ThermalExpansion,
    PlungerBacklash,
    SealFriction,
    /// Gas that leaves a closed chamber: through a conductance, a gap, an orifice.
    ChamberLeak,
    ChamberGap,
    ChamberOrifice,
    /// What a rubber's law has beyond the neo-Hookean, in the shape of other laws.
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
    HypotheticalForce,
    HypotheticalFlow,
    /// One that is written down: an expression at a port.
    Law(LawId),
}

impl Kind {
    /// Whether it stands for physics nobody has named: never a candidate by itself.
    pub fn is_hypothetical(self) -> bool {
        match self {
            Self::HypotheticalForce | Self::HypotheticalFlow => true,
            // What the scene declares as a candidate has been named by whoever wrote it.
            Self::Law(id) => !id.law().table.candidate,
            _ => false,
        }
    }

    /// Whether one element may have it several times: relaxation has a spectrum, a polynomial several terms.
    pub fn may_repeat(self) -> bool {
        matches!(self, Self::Viscoelasticity | Self::HypotheticalForce | Self::HypotheticalFlow)
    }
}

/// Bounds of a number, both included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    pub min: f64,
    pub max: f64,
}

/// One number of an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterSpec {
    /// Key in scenes and answers; carries the SI unit.
    pub key: &'static str,
    /// Symbol in the law.
    pub symbol: &'static str,
    /// Outside it nothing physical is meant.
    pub range: Range,
    /// A size that is plain to see on a stock scene: where a fit starts.
    pub typical: f64,
    /// Value when a scene does not give it; `None`: it must be given.
    pub default: Option<f64>,
    /// Whether a diagnosis fits it, or leaves the default.
    pub is_fitted: bool,
}

/// One effect of the catalogue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EffectSpec {
    pub kind: Kind,
    pub name: &'static str,
    /// One line: what it is.
    pub title: &'static str,
    pub element: ElementKind,
    pub law: &'static str,
    pub source: &'static str,
    /// The first is the size: at zero the effect is absent.
    pub parameters: &'static [ParameterSpec],
}

impl EffectSpec {
    /// The parameter of a key.
    pub fn parameter(&self, key: &str) -> Option<&'static ParameterSpec> {
        self.parameters.iter().find(|p| p.key == key)
    }

    /// Values of all parameters where a fit starts.
    pub fn typical(&self) -> Vec<f64> {
        self.parameters.iter().map(|p| if p.is_fitted { p.typical } else { p.default.unwrap_or(p.typical) }).collect()
    }
}
