//! Where a law sits in a plant: which element, and where each of its variables is read.

use crate::laws::{Address, Carrier, Law, Port, Quantity, Symbol, Variable};
use crate::scalar::Scalar;
use crate::system::plant::{Drive, Plant};

use super::Site;

/// Where the value of a symbol is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    Elongation(usize),
    Speed(usize),
    Pressure(usize),
    SyringePressure(usize),
    Flow(usize),
    /// An input, by its index, and its slope.
    Input(usize),
    InputSpeed(usize),
    /// What an input, by its index, takes in of a cable for each of its units.
    Drive(usize, f64),
    DriveSpeed(usize, f64),
    FrictionState(usize),
    Stretch(usize),
    Tension(usize),
    /// Position along a direction, by its index, and its rate.
    Along(usize),
    AlongSpeed(usize),
    Time,
    Parameter(usize),
    State(usize),
    Constant(f64),
}

/// Message and remedy.
pub type Wrong = (String, String);

/// A sum of joints that moves as one.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// 1 for each coordinate of the sum.
    pub direction: Vec<f64>,
    /// Whether its joints slide.
    pub slides: bool,
}

/// What of a plant decides where laws sit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rig {
    /// Of each muscle: its cable, its plunger's input, whether fluid drives it.
    muscles: Vec<(Option<usize>, Option<usize>)>,
    pub directions: Vec<Direction>,
    /// Of each cable the direction of the joints that it turns, and that of joints without a name.
    turned: Vec<Option<usize>>,
    /// Of each cable the input that drives it, and what one unit of that takes in, m.
    driven: Vec<Option<(usize, f64)>>,
    main: Option<usize>,
    /// Names of the joints of each coordinate, with their direction.
    named: Vec<(String, usize)>,
}

impl Rig {
    /// Looks at a plant.
    pub fn of<D: Scalar>(plant: &Plant<D>, site: &Site) -> Self {
        let mut rig = Self::default();
        let joints = site.joints;
        rig.main = rig.add(&site.direction, site);
        for cable in &plant.cables {
            let turned: Vec<f64> =
                cable.jacobian.iter().enumerate().map(|(i, l)| f64::from(u8::from(i < joints && *l != 0.0))).collect();
            let at = rig.add(&turned, site);
            rig.turned.push(at);
            rig.driven.push(cable.drive);
        }
        for (i, names) in site.names.iter().enumerate() {
            let mut unit = vec![0.0; plant.dim()];
            unit[i] = 1.0;
            if let ([name], Some(at)) = (names.as_slice(), rig.add(&unit, site)) {
                rig.named.push((name.clone(), at));
            }
        }
        for muscle in &plant.muscles {
            let pulls = |c: &crate::system::CablePlant<D>| {
                muscle.jacobian[joints..].iter().zip(&c.jacobian[joints..]).any(|(a, b)| a * b != 0.0)
            };
            let plunger = match &muscle.drive {
                Drive::Hydraulic { plunger, .. } => Some(*plunger),
                Drive::Pressure { .. } => None,
            };
            rig.muscles.push((plant.cables.iter().position(pulls), plunger));
        }
        rig
    }

    /// The index of a direction; none of one that moves nothing.
    fn add(&mut self, direction: &[f64], site: &Site) -> Option<usize> {
        let first = direction.iter().position(|d| *d != 0.0)?;
        if let Some(known) = self.directions.iter().position(|d| d.direction == direction) {
            return Some(known);
        }
        let slides = site.slides.get(first).copied().unwrap_or(false);
        self.directions.push(Direction { direction: direction.to_vec(), slides });
        Some(self.directions.len() - 1)
    }

    /// The elements at which a law acts: muscles, cables or directions, by their index.
    ///
    /// # Errors
    /// A port that the rig does not have.
    pub fn places(&self, address: &Address) -> Result<Vec<usize>, Wrong> {
        let lacks = |what: &str, count: usize| {
            let remedy = match count {
                0 => "remove the law, or put it on a scene that has one".to_owned(),
                n => format!("number it from 1 to {n}"),
            };
            Err((format!("port = \"{address}\": {what}"), remedy))
        };
        let found: Vec<usize> = match address.port.spec().carrier {
            Carrier::Muscle => address.indices(self.muscles.len()).collect(),
            Carrier::Cable => address.indices(self.turned.len()).collect(),
            Carrier::Joint => return self.joint(address),
            Carrier::Alone | Carrier::Sensor => return Ok(Vec::new()),
        };
        let count = if address.port.spec().carrier == Carrier::Cable { self.turned.len() } else { self.muscles.len() };
        if found.is_empty() {
            return lacks("the scene does not have this element", count);
        }
        let is_fluid = address.port < Port::Pull;
        if is_fluid && found.iter().any(|&m| self.muscles[m].1.is_none()) {
            return lacks("the muscle's pressure is an input, no fluid is simulated before it", 0);
        }
        Ok(found)
    }

    fn joint(&self, address: &Address) -> Result<Vec<usize>, Wrong> {
        let Some(name) = &address.of else {
            let remedy = "name the joint: joint(NAME).torque".to_owned();
            return self
                .main
                .map(|d| vec![d])
                .ok_or((format!("port = \"{address}\": nothing in the scene moves a joint"), remedy));
        };
        let found = self.named.iter().find(|(known, _)| known == name).map(|(_, d)| vec![*d]);
        found.ok_or_else(|| {
            let known: Vec<&str> = self.named.iter().map(|(name, _)| name.as_str()).collect();
            let remedy = match known.is_empty() {
                true => "the mechanism has no free joint: remove the law".to_owned(),
                false => format!("the free joints are {}", known.join(", ")),
            };
            (format!("port = \"{address}\": \"{name}\" is no free joint of the mechanism"), remedy)
        })
    }

    /// Where a law's symbols are read, for the element of this index.
    ///
    /// # Errors
    /// A variable that the element does not have.
    pub fn sources(&self, law: &Law, at: usize) -> Result<Vec<Source>, Wrong> {
        let source = |symbol: &Symbol| match symbol {
            Symbol::Parameter(p) => Ok(Source::Parameter(*p)),
            Symbol::State(s) => Ok(Source::State(*s)),
            Symbol::Constant(x) => Ok(Source::Constant(*x)),
            Symbol::Variable(variable) => self.variable(law, *variable, at),
        };
        law.symbols.iter().map(source).collect()
    }

    fn variable(&self, law: &Law, variable: Variable, at: usize) -> Result<Source, Wrong> {
        let own = Own::of(self, law.address.port, at);
        let wrong = |why: &str, remedy: &str| {
            let message = format!("the variable {} does not exist at {}: {why}", variable.name(), law.address);
            Err((message, remedy.to_owned()))
        };
        let muscle = variable.of.or(own.muscle);
        let muscle = muscle.filter(|m| *m < self.muscles.len());
        let cable = variable.of.or(own.cable).filter(|c| *c < self.turned.len());
        let plunger = muscle.and_then(|m| self.muscles[m].1);
        let several = "number it where a rig has several: pressure_1_pa";
        let no_muscle = || wrong("it is that of no single muscle", several);
        let no_fluid = || wrong("no fluid is simulated before the muscle", "use pressure_pa");
        match (variable.quantity, muscle) {
            (Quantity::Time, _) => Ok(Source::Time),
            (Quantity::Stretch, _) => {
                cable.map_or_else(|| wrong("it is that of no single cable", several), |c| Ok(Source::Stretch(c)))
            }
            (Quantity::Tension, _) => cable.map_or_else(
                || wrong("no cable pulls there", "use pressure_pa or elongation_m"),
                |c| Ok(Source::Tension(c)),
            ),
            (Quantity::Drive | Quantity::DriveSpeed, _) => match cable.and_then(|c| self.driven[c]) {
                Some((input, m)) if variable.quantity == Quantity::Drive => Ok(Source::Drive(input, m)),
                Some((input, m)) => Ok(Source::DriveSpeed(input, m)),
                None => wrong("no input drives the cable itself", "use stretch_m, or give the cable a drive"),
            },
            (Quantity::Angle, _) => own.along(self, false).map_or_else(
                || wrong("no joint turns there", "use elongation_m, or position_m of a slider"),
                |d| Ok(Source::Along(d)),
            ),
            (Quantity::AngularSpeed, _) => own
                .along(self, false)
                .map_or_else(|| wrong("no joint turns there", "use speed_m_s"), |d| Ok(Source::AlongSpeed(d))),
            (Quantity::Position, _) => own
                .along(self, true)
                .map_or_else(|| wrong("no joint slides there", "use angle_rad"), |d| Ok(Source::Along(d))),
            (Quantity::Speed, _) if variable.of.is_none() && own.along(self, true).is_some() && own.is_joint => {
                Ok(own.along(self, true).map_or(Source::Time, Source::AlongSpeed))
            }
            (_, None) => no_muscle(),
            (Quantity::Elongation, Some(m)) => Ok(Source::Elongation(m)),
            (Quantity::Speed, Some(m)) => Ok(Source::Speed(m)),
            (Quantity::Pressure, Some(m)) if own.is_before_line && variable.of.is_none() => {
                Ok(Source::SyringePressure(m))
            }
            (Quantity::Pressure, Some(m)) => Ok(Source::Pressure(m)),
            (Quantity::FrictionState, Some(m)) => Ok(Source::FrictionState(m)),
            (Quantity::SyringePressure | Quantity::Flow | Quantity::Plunger | Quantity::PlungerSpeed, Some(_))
                if plunger.is_none() =>
            {
                no_fluid()
            }
            (Quantity::SyringePressure, Some(m)) => Ok(Source::SyringePressure(m)),
            (Quantity::Flow, Some(m)) => Ok(Source::Flow(m)),
            (Quantity::Plunger, Some(_)) => Ok(Source::Input(plunger.unwrap_or(0))),
            (Quantity::PlungerSpeed, Some(_)) => Ok(Source::InputSpeed(plunger.unwrap_or(0))),
            (Quantity::Reading, Some(_)) => wrong("it is for sensors", "use a variable of the element"),
        }
    }
}

/// The element's own muscle, cable and joints.
struct Own {
    muscle: Option<usize>,
    cable: Option<usize>,
    direction: Option<usize>,
    is_before_line: bool,
    is_joint: bool,
}

impl Own {
    fn of(rig: &Rig, port: Port, at: usize) -> Self {
        let is_before_line = port <= Port::SyringeCompliance;
        let one = |count: usize| (count == 1).then_some(0);
        match port.spec().carrier {
            Carrier::Muscle => {
                let cable = rig.muscles[at].0;
                let direction = cable.map_or(rig.main, |c| rig.turned[c]);
                Self { muscle: Some(at), cable, direction, is_before_line, is_joint: false }
            }
            Carrier::Cable => {
                let muscle = rig.muscles.iter().position(|(cable, _)| *cable == Some(at));
                Self { muscle, cable: Some(at), direction: rig.turned[at], is_before_line, is_joint: false }
            }
            _ => {
                let (muscle, cable) = (one(rig.muscles.len()), one(rig.turned.len()));
                Self { muscle, cable, direction: Some(at), is_before_line, is_joint: true }
            }
        }
    }

    /// The direction of its joints, if they slide or turn as asked.
    fn along(&self, rig: &Rig, slides: bool) -> Option<usize> {
        self.direction.filter(|d| rig.directions[*d].slides == slides)
    }
}
