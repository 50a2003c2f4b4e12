//! Drawn laws in a plant: what they read, what they remember, what they do to its terms.

use super::drawn::{DrawnLaw, PLACES, Place, Reads, Remembers, TURNING_M_S, TURNING_RAD_S};

/// A drawn law on one of the plant's muscles, with its size.
#[derive(Clone, Copy, Debug)]
pub struct Acting {
    pub law: DrawnLaw,
    pub size: f64,
    pub muscle: usize,
}

/// States of each law: two of its memory, over the variable's scale, and how much further its cable has gone, m.
pub const LAW_STATES: usize = 3;
pub const LAW_SCALE: [f64; LAW_STATES] = [1.0, 1.0, 1e-3];
const TRAVEL: usize = 2;
/// Time constant of what is a jump in the ideal law, s.
const GREATEST_S: f64 = 5e-3;

/// What laws do to the terms of one muscle, its line, its cable; those of the joint stand with the first.
#[derive(Clone, Copy, Debug)]
pub struct Acts {
    scale: [f64; PLACES],
    add: [f64; PLACES],
    /// How much further its cable has gone than its lever says, m.
    pub travel_m: f64,
}

impl Acts {
    pub const NEUTRAL: Self = Self { scale: [1.0; PLACES], add: [0.0; PLACES], travel_m: 0.0 };

    pub fn scale(&self, place: Place) -> f64 {
        self.scale[place as usize]
    }

    pub fn add(&self, place: Place) -> f64 {
        self.add[place as usize]
    }
}

/// Variables around a muscle, SI.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seen {
    pub elongation_m: f64,
    pub speed_m_s: f64,
    pub near_pa: f64,
    pub far_pa: f64,
    pub flow_m3_s: f64,
    pub tension_n: f64,
    pub angle_rad: f64,
    pub angular_speed_rad_s: f64,
    pub time_s: f64,
}

impl Seen {
    fn read(&self, reads: Reads, place: Place) -> f64 {
        match reads {
            Reads::Elongation => self.elongation_m,
            Reads::Speed => self.speed_m_s,
            Reads::Pressure if matches!(place, Place::SyringeCompliance | Place::SyringeFlow) => self.near_pa,
            Reads::Pressure => self.far_pa,
            Reads::Flow => self.flow_m3_s,
            Reads::Tension => self.tension_n,
            Reads::Angle => self.angle_rad,
            Reads::AngularSpeed => self.angular_speed_rad_s,
            Reads::Time => self.time_s,
        }
    }
}

impl Acting {
    /// The variable over its scale.
    fn x(&self, seen: &Seen) -> f64 {
        self.law.reads.map_or(0.0, |reads| seen.read(reads, self.law.place) / self.law.scale)
    }

    /// What its memory holds at rest.
    pub fn start(&self, seen: &Seen) -> [f64; LAW_STATES] {
        let x = self.x(seen);
        [x, x, 0.0]
    }

    /// Joins what the law does now to the acts of its muscle.
    pub fn join(&self, seen: &Seen, memory: &[f64], acts: &mut Acts) {
        let (x, left) = match self.law.remembers {
            Remembers::Nothing => (self.x(seen), 1.0),
            Remembers::Lag(_) | Remembers::Greatest => (memory[0], 1.0),
            Remembers::TwoLags(_) => (memory[1], 1.0),
            Remembers::Falling(left) => (self.x(seen), falling(left, self.law.reads, seen)),
        };
        let y = self.law.times.map_or(1.0, |(reads, scale)| seen.read(reads, self.law.place) / scale);
        let value = left * self.law.value(self.size, x, y);
        match self.law.place.acts() {
            "adds" => acts.add[self.law.place as usize] += value,
            // Nothing of a rig turns negative.
            _ => acts.scale[self.law.place as usize] *= (1.0 + value).max(0.05),
        }
        acts.travel_m += memory[TRAVEL];
    }

    /// Rates of its states; `travel_m_s` is how fast the cable goes further than its lever says.
    pub fn rates(&self, seen: &Seen, memory: &[f64], travel_m_s: f64, rates: &mut [f64]) {
        let x = self.x(seen);
        (rates[0], rates[1]) = match self.law.remembers {
            Remembers::Lag(time_s) => ((x - memory[0]) / time_s, 0.0),
            Remembers::TwoLags(time_s) => ((x - memory[0]) / time_s, (memory[0] - memory[1]) / time_s),
            Remembers::Greatest => ((x - memory[0]).max(0.0) / GREATEST_S, 0.0),
            Remembers::Nothing | Remembers::Falling(_) => (0.0, 0.0),
        };
        rates[TRAVEL] = if self.law.place == Place::Lever { travel_m_s } else { 0.0 };
    }
}

/// Share of a law that stands while its variable rises or falls.
fn falling(left: f64, reads: Option<Reads>, seen: &Seen) -> f64 {
    let rising = match reads {
        Some(Reads::Angle) => (seen.angular_speed_rad_s / TURNING_RAD_S).tanh(),
        _ => (seen.speed_m_s / TURNING_M_S).tanh(),
    };
    0.5 * (1.0 + left) + 0.5 * (1.0 - left) * rising
}
