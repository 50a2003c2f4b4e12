//! Laws that nobody chose: place, variable, form and numbers are drawn, out of more than the diagnosis' grammar can say.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::begin::log_uniform;
use super::form::Form;
use super::secrets::{Part, Secret};
use super::stock::Rig;

/// Where a law acts, by the name that users know.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Place {
    #[serde(rename = "muscle.wall")]
    Wall,
    #[serde(rename = "muscle.coil")]
    Coil,
    #[serde(rename = "muscle.friction")]
    Friction,
    #[serde(rename = "muscle.damping")]
    Damping,
    #[serde(rename = "muscle.area")]
    Area,
    #[serde(rename = "muscle.pull")]
    Pull,
    #[serde(rename = "muscle.rest_length")]
    RestLength,
    #[serde(rename = "line.resistance")]
    Resistance,
    #[serde(rename = "line.pressure_drop")]
    PressureDrop,
    #[serde(rename = "line.outflow")]
    Outflow,
    #[serde(rename = "line.compliance")]
    LineCompliance,
    #[serde(rename = "syringe.compliance")]
    SyringeCompliance,
    #[serde(rename = "syringe.flow")]
    SyringeFlow,
    #[serde(rename = "cable.stiffness")]
    CableStiffness,
    #[serde(rename = "cable.lever")]
    Lever,
    #[serde(rename = "cable.transmission")]
    Transmission,
    #[serde(rename = "joint.torque")]
    Torque,
    #[serde(rename = "joint.stiffness")]
    JointStiffness,
    #[serde(rename = "joint.damping")]
    JointDamping,
}

/// What a law depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Reads {
    #[serde(rename = "elongation_m")]
    Elongation,
    #[serde(rename = "speed_m_s")]
    Speed,
    #[serde(rename = "pressure_pa")]
    Pressure,
    #[serde(rename = "flow_m3_s")]
    Flow,
    #[serde(rename = "tension_n")]
    Tension,
    #[serde(rename = "angle_rad")]
    Angle,
    #[serde(rename = "angular_speed_rad_s")]
    AngularSpeed,
    #[serde(rename = "time_s")]
    Time,
}

/// Number of places.
pub const PLACES: usize = Place::JointDamping as usize + 1;

/// How a law remembers what it depends on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Remembers {
    Nothing,
    /// Behind by one lag, or by two in series, s each.
    Lag(f64),
    TwoLags(f64),
    /// The greatest value so far.
    Greatest,
    /// So much of the law is left while the variable falls.
    Falling(f64),
}

/// A law: `size times form(x) times y`, with `x` the variable over its scale, `y` a second one over its own or 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DrawnLaw {
    pub place: Place,
    /// `None`: a number of one part that is another than those of its equals.
    pub reads: Option<Reads>,
    pub scale: f64,
    pub form: Form,
    pub remembers: Remembers,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub times: Option<(Reads, f64)>,
}

impl Place {
    const ALL: [Self; PLACES] = [
        Self::Wall,
        Self::Coil,
        Self::Friction,
        Self::Damping,
        Self::Area,
        Self::Pull,
        Self::RestLength,
        Self::Resistance,
        Self::PressureDrop,
        Self::Outflow,
        Self::LineCompliance,
        Self::SyringeCompliance,
        Self::SyringeFlow,
        Self::CableStiffness,
        Self::Lever,
        Self::Transmission,
        Self::Torque,
        Self::JointStiffness,
        Self::JointDamping,
    ];

    /// The word of its element, and the word after the dot.
    fn words(self) -> (Part, &'static str) {
        match self {
            Self::Wall => (Part::Muscle, "wall"),
            Self::Coil => (Part::Muscle, "coil"),
            Self::Friction => (Part::Muscle, "friction"),
            Self::Damping => (Part::Muscle, "damping"),
            Self::Area => (Part::Muscle, "area"),
            Self::Pull => (Part::Muscle, "pull"),
            Self::RestLength => (Part::Muscle, "rest_length"),
            Self::Resistance => (Part::Line, "resistance"),
            Self::PressureDrop => (Part::Line, "pressure_drop"),
            Self::Outflow => (Part::Line, "outflow"),
            Self::LineCompliance => (Part::Line, "compliance"),
            Self::SyringeCompliance => (Part::Syringe, "compliance"),
            Self::SyringeFlow => (Part::Syringe, "flow"),
            Self::CableStiffness => (Part::Cable, "stiffness"),
            Self::Lever => (Part::Cable, "lever"),
            Self::Transmission => (Part::Cable, "transmission"),
            Self::Torque => (Part::Mechanism, "torque"),
            Self::JointStiffness => (Part::Mechanism, "stiffness"),
            Self::JointDamping => (Part::Mechanism, "damping"),
        }
    }

    /// Size of what is added, SI, to begin with; `None` where a law scales.
    fn added(self) -> Option<f64> {
        Some(match self {
            Self::Pull => 0.03,
            Self::RestLength => 3e-4,
            Self::PressureDrop => 3e4,
            Self::Outflow | Self::SyringeFlow => 3e-11,
            Self::Torque => 2e-4,
            _ => return None,
        })
    }

    /// Whether a law adds, in the word that users know; else it scales.
    pub fn acts(self) -> &'static str {
        if self.added().is_some() { "adds" } else { "scales" }
    }

    /// Port with the number of the part that has it.
    pub fn port(self, rig: Rig, muscle: usize) -> String {
        match self.words() {
            (Part::Mechanism, word) => format!("joint.{word}"),
            (part, word) => format!("{}.{word}", part.on(rig, muscle)),
        }
    }

    pub fn is_of_joint(self) -> bool {
        self.words().0 == Part::Mechanism
    }

    fn variables(self) -> &'static [Reads] {
        use Reads as R;
        match self.words().0 {
            Part::Muscle if self == Self::RestLength => &[R::Pressure, R::Time],
            Part::Muscle => &[R::Elongation, R::Speed, R::Pressure, R::Time],
            Part::Line => &[R::Pressure, R::Flow, R::Time],
            Part::Syringe => &[R::Pressure, R::Time],
            Part::Cable if self == Self::CableStiffness => &[R::Tension, R::Time],
            Part::Cable => &[R::Angle, R::Time],
            _ => &[R::Angle, R::AngularSpeed, R::Time],
        }
    }

    /// Whether a rig has it. A joint without a spring has no stiffness to scale, a bench neither cable nor joint.
    fn fits(self, rig: Rig) -> bool {
        match self.words().0 {
            Part::Cable | Part::Mechanism if rig == Rig::MuscleBench => false,
            _ => self != Self::JointStiffness || rig == Rig::BendingCatheter,
        }
    }
}

impl Reads {
    /// The name that users know.
    pub fn name(self) -> &'static str {
        match self {
            Self::Elongation => "elongation_m",
            Self::Speed => "speed_m_s",
            Self::Pressure => "pressure_pa",
            Self::Flow => "flow_m3_s",
            Self::Tension => "tension_n",
            Self::Angle => "angle_rad",
            Self::AngularSpeed => "angular_speed_rad_s",
            Self::Time => "time_s",
        }
    }

    /// About half of what it reaches, SI.
    fn typical(self) -> f64 {
        match self {
            Self::Elongation => 0.013,
            Self::Speed => 5e-3,
            Self::Pressure => 8e5,
            Self::Flow => 1e-8,
            Self::Tension => 0.6,
            Self::Angle => 0.3,
            Self::AngularSpeed => 0.3,
            Self::Time => 20.0,
        }
    }
}

/// Speeds over which a law that differs in falling changes hands, m/s and rad/s.
pub const TURNING_M_S: f64 = 2e-4;
pub const TURNING_RAD_S: f64 = 5e-3;
/// Greatest change of a law that scales: no part of a rig grows or dies away beyond it.
const LARGEST_SHARE: f64 = 4.0;
const LEAST_LEFT: f64 = 0.9;

impl DrawnLaw {
    /// Draws a law, and the part that has it.
    pub fn draw(rig: Rig, random: &mut ChaCha8Rng) -> Secret {
        let muscle = random.random_range(0..rig.muscles());
        let is_constant = rig.muscles() > 1 && random.random_bool(0.08);
        let possible: Vec<Place> = Place::ALL.into_iter().filter(|p| p.fits(rig)).collect();
        let unequal = [Place::Wall, Place::Coil, Place::Friction, Place::Area];
        let from = if is_constant { &unequal[..] } else { &possible[..] };
        let place = from[random.random_range(0..from.len())];
        let variables = place.variables();
        let reads = variables[random.random_range(0..variables.len())];
        let form = if is_constant { Form::Constant } else { Form::draw(random) };
        let remembers = if is_constant { Remembers::Nothing } else { Remembers::draw(reads, random) };
        let second = variables[random.random_range(0..variables.len())];
        let is_product = remembers == Remembers::Nothing && !is_constant && second != reads && random.random_bool(0.2);
        let scale = reads.typical() * random.random_range(0.5..1.6);
        // A cable over the angle is the first one's: the second of a catheter moves another joint.
        let is_first = rig == Rig::BendingCatheter && place.words().0 == Part::Cable;
        let muscle = if is_first { 0 } else { muscle };
        let law = Self {
            place,
            reads: (!is_constant).then_some(reads),
            scale,
            form,
            remembers,
            times: is_product.then(|| (second, second.typical() * random.random_range(0.5..1.6))),
        };
        law.secret(rig, muscle, if random.random_bool(0.5) { 1.0 } else { -1.0 })
    }

    /// As a secret of one part, of a size to begin with.
    pub fn secret(self, rig: Rig, muscle: usize, sign: f64) -> Secret {
        Secret {
            name: format!("drawn {}", self.place.words().1),
            element: self.place.words().0.on(rig, muscle),
            channel: None,
            in_catalogue: false,
            is_altered: false,
            key: "a".to_owned(),
            size: sign * self.place.added().unwrap_or(0.2),
            second: 0.0,
            muscle,
            law: Some(self),
        }
    }

    /// Port with the number of its part: `line_1.compliance`.
    pub fn port(&self, rig: Rig, muscle: usize) -> String {
        self.place.port(rig, muscle)
    }

    /// As a table that scenes hold, `[[law]]`.
    pub fn table(&self, rig: Rig, muscle: usize, size: f64) -> String {
        let acts = self.place.acts();
        let one = if acts == "adds" { "" } else { "1 + " };
        let (x, state) = self.variable();
        let second = self.times.map_or(String::new(), |(reads, scale)| format!("*({}/{scale:e})", reads.name()));
        let left = match self.remembers {
            Remembers::Falling(left) => {
                let (rate, turning) = match self.reads {
                    Some(Reads::Angle) => ("angular_speed_rad_s", TURNING_RAD_S),
                    _ => ("speed_m_s", TURNING_M_S),
                };
                format!("*(0.5*(1 + {left}) + 0.5*(1 - {left})*tanh({rate}/{turning:e}))")
            }
            _ => String::new(),
        };
        format!(
            "name = \"hidden\"\nport = \"{}\"\n{acts} = \"{one}{size:e}*{}{second}{left}\"\n{state}",
            self.port(rig, muscle),
            self.form.text(&x),
        )
    }

    /// What the form is over, as text, and the states that it needs.
    fn variable(&self) -> (String, String) {
        let plain = self.reads.map_or("0".to_owned(), |reads| format!("({}/{:e})", reads.name(), self.scale));
        let behind = |time_s: f64| format!("parameter.lag_s = {{ value = {time_s} }}\n");
        let lag = |state: &str, of: &str| {
            format!("state.{state} = {{ rate = \"({of} - {state})/lag_s\", start = \"{plain}\", unit = \"1\" }}\n")
        };
        match self.remembers {
            Remembers::Nothing | Remembers::Falling(_) => (plain, String::new()),
            Remembers::Lag(time_s) => ("r".to_owned(), lag("r", &plain) + &behind(time_s)),
            Remembers::TwoLags(time_s) => ("s".to_owned(), lag("r", &plain) + &lag("s", "r") + &behind(time_s)),
            Remembers::Greatest => ("r".to_owned(), format!("state.r = {{ greatest = \"{plain}\", unit = \"1\" }}\n")),
        }
    }

    /// Greatest size that it may be given, by which sign it has. What is scaled stays above a tenth of itself.
    pub fn bounds(&self) -> (f64, f64) {
        match self.place.added() {
            Some(typical) => (-1e3 * typical, 1e3 * typical),
            None if self.form.is_odd() => (-LEAST_LEFT, LEAST_LEFT),
            None => (-LEAST_LEFT, LARGEST_SHARE),
        }
    }

    /// The law's change at `x` and `y`, both over their scales.
    pub fn value(&self, size: f64, x: f64, y: f64) -> f64 {
        size * self.form.value(x) * y
    }
}

impl Remembers {
    fn draw(reads: Reads, random: &mut ChaCha8Rng) -> Self {
        // What only ever grows has no history of its own.
        if reads == Reads::Time {
            return Self::Nothing;
        }
        match random.random_range(0..20) {
            0 => Self::Lag(log_uniform(0.5, 20.0, random)),
            1 => Self::TwoLags(log_uniform(0.5, 10.0, random)),
            2 | 3 if !matches!(reads, Reads::Speed | Reads::Flow | Reads::AngularSpeed) => Self::Greatest,
            4 | 5 if matches!(reads, Reads::Elongation | Reads::Angle) => Self::Falling(random.random_range(0.2..0.7)),
            _ => Self::Nothing,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn draws_reach_every_place_and_every_kind_of_memory() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let drawn: Vec<DrawnLaw> = (0..600).flat_map(|i| DrawnLaw::draw(Rig::ALL[i % 3], &mut random).law).collect();
        for place in Place::ALL {
            assert!(drawn.iter().any(|l| l.place == place), "{place:?}");
        }
        for is in [
            |r: &Remembers| matches!(r, Remembers::Nothing),
            |r: &Remembers| matches!(r, Remembers::Lag(_)),
            |r: &Remembers| matches!(r, Remembers::TwoLags(_)),
            |r: &Remembers| matches!(r, Remembers::Greatest),
            |r: &Remembers| matches!(r, Remembers::Falling(_)),
        ] {
            assert!(drawn.iter().any(|l| is(&l.remembers)));
        }
        assert!(drawn.iter().any(|l| l.reads.is_none()) && drawn.iter().any(|l| l.times.is_some()));
        // Most are plain: one variable, no memory.
        let plain = drawn.iter().filter(|l| l.times.is_none() && l.remembers == Remembers::Nothing).count();
        assert!(plain > 400, "{plain}");
    }
}
