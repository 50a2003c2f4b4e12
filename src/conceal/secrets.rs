//! What may be hidden in a plant: physics of the catalogue, in its own form or in an altered one, and physics that the
//! catalogue does not hold.

use serde::{Deserialize, Serialize};

use super::acting::Acting;
use super::drawn::DrawnLaw;
use super::plant::Plant;
use super::stock::Rig;

/// Something hidden, with its numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Secret {
    /// The catalogue's name, or our own for what is not in it.
    pub name: String,
    pub element: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub channel: Option<String>,
    pub in_catalogue: bool,
    /// Whether the law has another form than the catalogue's.
    pub is_altered: bool,
    /// The number that the law is proportional to, or nearly, and what it is called; SI.
    pub key: String,
    pub size: f64,
    /// A further number: a time, an angle, a threshold.
    pub second: f64,
    /// The muscle it sits on, from 0.
    pub muscle: usize,
    /// Of one that nobody thought of: what was drawn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub law: Option<DrawnLaw>,
}

/// Where a secret sits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    Syringe,
    Line,
    Muscle,
    Cable,
    Mechanism,
    Sensor,
}

impl Part {
    fn name(self) -> &'static str {
        match self {
            Self::Syringe => "syringe",
            Self::Line => "line",
            Self::Muscle => "muscle",
            Self::Cable => "cable",
            Self::Mechanism => "mechanism",
            Self::Sensor => "sensor",
        }
    }

    /// Its name on a rig: numbered where there is one for each of two muscles.
    pub fn on(self, rig: Rig, muscle: usize) -> String {
        let plain = matches!(self, Self::Mechanism | Self::Sensor) || rig.muscles() == 1;
        if plain { self.name().to_owned() } else { format!("{}_{}", self.name(), muscle + 1) }
    }
}

/// A kind of secret.
pub struct Kind {
    pub name: &'static str,
    pub part: Part,
    pub in_catalogue: bool,
    pub key: &'static str,
    /// A size to start from; the draw scales it.
    pub typical: f64,
    pub largest: f64,
    /// Whether it may be negative.
    pub is_signed: bool,
    /// Range of the further number.
    pub second: (f64, f64),
    rigs: fn(Rig) -> bool,
    install: fn(&mut Plant, &Secret),
}

const EVERY: fn(Rig) -> bool = |_| true;
const BENCH: fn(Rig) -> bool = |r| r == Rig::MuscleBench;
const PULLEY: fn(Rig) -> bool = |r| r == Rig::AntagonisticPulley;
const CATHETER: fn(Rig) -> bool = |r| r == Rig::BendingCatheter;
const MOVES: fn(Rig) -> bool = |r| r != Rig::MuscleBench;
const NOTHING: fn(&mut Plant, &Secret) = |_, _| {};
const UNUSED: (f64, f64) = (1.0, 1.0);

#[rustfmt::skip]
/// Everything that may be hidden.
pub const KINDS: &[Kind] = &[
    Kind { name: "trapped_air", part: Part::Line, in_catalogue: true, key: "free_volume_m3", typical: 1e-9, largest: 5e-8, is_signed: false, second: (1.0, 1.4), rigs: EVERY,
        install: |p, s| { let m = &mut p.muscles[s.muscle]; m.air_m3 = s.size; m.air_exponent = if s.is_altered { s.second } else { 1.0 }; } },
    Kind { name: "leak", part: Part::Line, in_catalogue: true, key: "conductance_m3_s_pa", typical: 5e-17, largest: 2e-14, is_signed: false, second: UNUSED, rigs: EVERY,
        install: |p, s| { let m = &mut p.muscles[s.muscle]; m.leak = s.size; m.leak_growth_1_pa = if s.is_altered { 1.2e-7 } else { 0.0 }; } },
    Kind { name: "line_restriction", part: Part::Line, in_catalogue: true, key: "resistance_ratio", typical: 20.0, largest: 3e3, is_signed: false, second: UNUSED, rigs: EVERY,
        install: |p, s| { let m = &mut p.muscles[s.muscle]; m.restriction = s.size; m.restriction_growth_s_m3 = if s.is_altered { 1e7 } else { 0.0 }; } },
    Kind { name: "thermal_expansion", part: Part::Line, in_catalogue: true, key: "volume_rate_m3_s", typical: 3e-11, largest: 5e-10, is_signed: true, second: (400.0, 900.0), rigs: EVERY,
        install: |p, s| { let m = &mut p.muscles[s.muscle]; m.growth_m3_s = s.size; m.growth_fades_s = if s.is_altered { s.second } else { 0.0 }; } },
    Kind { name: "plunger_backlash", part: Part::Syringe, in_catalogue: true, key: "width_m", typical: 3e-5, largest: 5e-4, is_signed: false, second: UNUSED, rigs: EVERY,
        install: |p, s| p.muscles[s.muscle].play_m = s.size },
    Kind { name: "viscoelasticity", part: Part::Muscle, in_catalogue: true, key: "stiffness_n_m", typical: 4.0, largest: 60.0, is_signed: false, second: (0.8, 15.0), rigs: EVERY,
        install: |p, s| { let m = &mut p.muscles[s.muscle]; m.branches[0] = (s.size, s.second); m.branch_hardening_1_m2 = if s.is_altered { 600.0 } else { 0.0 }; } },
    Kind { name: "mullins_softening", part: Part::Muscle, in_catalogue: true, key: "softening_ratio", typical: 0.1, largest: 0.6, is_signed: false, second: UNUSED, rigs: EVERY,
        install: |p, s| { let m = &mut p.muscles[s.muscle]; m.softening = s.size; m.softens_exponentially = s.is_altered; } },
    Kind { name: "coil_preload", part: Part::Muscle, in_catalogue: true, key: "preload_n", typical: 0.05, largest: 1.0, is_signed: false, second: UNUSED, rigs: BENCH,
        install: |p, s| { let m = &mut p.muscles[s.muscle]; m.preload_n = s.size; m.preload_exponential = s.is_altered; } },
    Kind { name: "plastic_set", part: Part::Muscle, in_catalogue: true, key: "set_rate_1_s", typical: 1e-3, largest: 0.05, is_signed: false, second: (0.012, 0.02), rigs: BENCH,
        install: |p, s| { let m = &mut p.muscles[s.muscle]; m.set_rate_1_s = s.size; m.set_threshold_m = s.second; m.set_power = if s.is_altered { 1.3 } else { 1.0 }; } },
    Kind { name: "gravity_load", part: Part::Muscle, in_catalogue: true, key: "weight_n", typical: 0.05, largest: 1.0, is_signed: true, second: UNUSED, rigs: BENCH,
        install: |p, s| p.muscles[s.muscle].load_n = s.size },
    Kind { name: "bearing_friction", part: Part::Mechanism, in_catalogue: true, key: "coulomb_torque_n_m", typical: 2e-4, largest: 3e-3, is_signed: false, second: (0.006, 0.02), rigs: PULLEY,
        install: |p, s| { let m = &mut p.mechanism; m.bearing_n_m = s.size; m.bearing_rad = s.second; m.bearing_by_speed = s.is_altered; } },
    Kind { name: "cable_slack", part: Part::Cable, in_catalogue: true, key: "slack_length_m", typical: 3e-4, largest: 4e-3, is_signed: false, second: UNUSED, rigs: MOVES,
        install: |p, s| p.mechanism.slack_m[s.muscle] = s.size },
    Kind { name: "tendon_friction", part: Part::Cable, in_catalogue: true, key: "friction_coefficient", typical: 0.08, largest: 0.5, is_signed: false, second: UNUSED, rigs: CATHETER,
        install: |p, s| { let m = &mut p.mechanism; m.capstan = s.size; m.capstan_by_speed = s.is_altered; } },
    Kind { name: "tendon_coupling", part: Part::Mechanism, in_catalogue: true, key: "lever_m", typical: 3e-4, largest: 2e-3, is_signed: true, second: UNUSED, rigs: CATHETER,
        install: |p, s| p.mechanism.coupling_m = s.size },
    Kind { name: "external_contact", part: Part::Mechanism, in_catalogue: true, key: "stiffness_n_m_rad", typical: 2e-3, largest: 0.2, is_signed: false, second: (0.35, 0.7), rigs: MOVES,
        install: |p, s| { let m = &mut p.mechanism; m.wall_n_m_rad = s.size; m.wall_rad = s.second; m.wall_power = if s.is_altered { 1.3 } else { 1.0 }; } },
    Kind { name: "notch_closure", part: Part::Mechanism, in_catalogue: true, key: "stiffness_n_m_rad", typical: 5e-2, largest: 1.0, is_signed: false, second: (0.16, 0.24), rigs: CATHETER,
        install: |p, s| { let m = &mut p.mechanism; m.notch_n_m_rad = s.size; m.notch_rad = s.second; } },
    Kind { name: "sensor_lag", part: Part::Sensor, in_catalogue: true, key: "time_constant_s", typical: 0.03, largest: 1.0, is_signed: false, second: UNUSED, rigs: EVERY, install: NOTHING },
    Kind { name: "sensor_drift", part: Part::Sensor, in_catalogue: true, key: "rate_per_s", typical: 2e-3, largest: 10.0, is_signed: true, second: UNUSED, rigs: EVERY, install: NOTHING },
    Kind { name: "sensor_gain", part: Part::Sensor, in_catalogue: true, key: "gain_error", typical: 0.02, largest: 0.4, is_signed: true, second: UNUSED, rigs: EVERY, install: NOTHING },
    // Not in the catalogue.
    Kind { name: "coil_ages", part: Part::Muscle, in_catalogue: false, key: "stiffness_loss_1_s", typical: 2e-4, largest: 3e-3, is_signed: false, second: UNUSED, rigs: EVERY,
        install: |p, s| p.muscles[s.muscle].coil_loss_1_s = s.size },
    Kind { name: "barrel_swells", part: Part::Syringe, in_catalogue: false, key: "compliance_m3_pa", typical: 1e-15, largest: 2e-14, is_signed: false, second: (8.0, 40.0), rigs: EVERY,
        install: |p, s| { let m = &mut p.muscles[s.muscle]; m.barrel_m3_pa = s.size; m.barrel_s = s.second; } },
    Kind { name: "rate_stiffening", part: Part::Muscle, in_catalogue: false, key: "force_n", typical: 5e-3, largest: 0.3, is_signed: false, second: UNUSED, rigs: EVERY,
        install: |p, s| p.muscles[s.muscle].rate_force_n = s.size },
    Kind { name: "fibre_breaks", part: Part::Muscle, in_catalogue: false, key: "stiffness_n_m", typical: 1.0, largest: 20.0, is_signed: false, second: (55.0, 95.0), rigs: EVERY,
        install: |p, s| { let m = &mut p.muscles[s.muscle]; m.fibre_n_m = s.size; m.fibre_breaks_s = s.second; } },
    Kind { name: "pump_ripple", part: Part::Syringe, in_catalogue: false, key: "amplitude_m", typical: 1e-5, largest: 3e-4, is_signed: false, second: (2.0, 6.0), rigs: EVERY,
        install: |p, s| { let m = &mut p.muscles[s.muscle]; m.ripple_m = s.size; m.ripple_hz = s.second; } },
    Kind { name: "area_grows", part: Part::Muscle, in_catalogue: false, key: "growth_1_m", typical: 0.3, largest: 8.0, is_signed: true, second: UNUSED, rigs: EVERY,
        install: |p, s| p.muscles[s.muscle].area_growth_1_m = s.size },
    Kind { name: "wall_stiffens", part: Part::Muscle, in_catalogue: false, key: "cubic_n_m3", typical: 4e3, largest: 3e5, is_signed: false, second: UNUSED, rigs: EVERY,
        install: |p, s| p.muscles[s.muscle].cubic_n_m3 = s.size },
    Kind { name: "one_way_restriction", part: Part::Line, in_catalogue: false, key: "resistance_ratio", typical: 30.0, largest: 3e3, is_signed: false, second: UNUSED, rigs: EVERY,
        install: |p, s| p.muscles[s.muscle].return_restriction = s.size },
    Kind { name: "jaw_play", part: Part::Sensor, in_catalogue: false, key: "width_rad", typical: 0.02, largest: 0.3, is_signed: false, second: UNUSED, rigs: CATHETER, install: NOTHING },
    Kind { name: "sensor_sticks", part: Part::Sensor, in_catalogue: false, key: "width", typical: 0.05, largest: 100.0, is_signed: false, second: UNUSED, rigs: EVERY, install: NOTHING },
    Kind { name: "sensor_slips", part: Part::Sensor, in_catalogue: false, key: "jump", typical: 0.1, largest: 200.0, is_signed: true, second: (0.3, 0.7), rigs: EVERY, install: NOTHING },
];

impl Kind {
    /// Whether a rig can have it.
    pub fn fits(&self, rig: Rig) -> bool {
        (self.rigs)(rig)
    }
}

impl Secret {
    /// A secret of a kind at its typical size, before anything of it is drawn; on a channel if it is a sensor's.
    pub fn typical(kind: &Kind, rig: Rig, muscle: usize, channel: usize) -> Self {
        let output = &rig.outputs()[channel];
        let is_sensor = kind.part == Part::Sensor;
        // A sensor's error is counted in its channel's unit.
        let in_units = is_sensor && kind.key != "time_constant_s" && kind.key != "gain_error";
        let unit = if in_units { output.noise_sd / 0.02 } else { 1.0 };
        let part = if kind.name == "jaw_play" { Part::Mechanism } else { kind.part };
        Self {
            name: kind.name.to_owned(),
            element: part.on(rig, muscle),
            channel: is_sensor.then(|| output.column.to_owned()),
            in_catalogue: kind.in_catalogue,
            is_altered: false,
            key: kind.key.to_owned(),
            size: kind.typical * unit,
            second: (kind.second.0 * kind.second.1).sqrt(),
            muscle,
            law: None,
        }
    }

    /// Whether both are one thing in one place, of whatever size.
    pub fn is_same_thing(&self, other: &Self) -> bool {
        self.name == other.name && self.element == other.element && self.channel == other.channel
    }

    /// Puts the physics into a plant; what a sensor does is put upon its channel later.
    pub fn install(&self, plant: &mut Plant) {
        plant.laws.extend(self.law.map(|law| Acting { law, size: self.size, muscle: self.muscle }));
        if let Some(kind) = KINDS.iter().find(|k| k.name == self.name) {
            (kind.install)(plant, self);
        }
    }

    /// What a sensor that has it shows of a series.
    pub fn corrupt(&self, series: &mut [f64], interval_s: f64, begun_s: f64) {
        match self.name.as_str() {
            "sensor_lag" => lag(series, interval_s, self.size, if self.is_altered { 2 } else { 1 }),
            "sensor_drift" => {
                let wave = |t: f64| if self.is_altered { t + 4.0 * (t / 9.0).sin() } else { t };
                for_each(series, interval_s, |t, x| *x += self.size * wave(t));
            }
            "sensor_gain" => {
                let bend = if self.is_altered { 0.15 / greatest(series) } else { 0.0 };
                for_each(series, interval_s, |_, x| *x += self.size * *x * (1.0 + bend * x.abs()));
            }
            "jaw_play" => play(series, self.size.to_degrees()),
            "sensor_sticks" => play(series, self.size),
            "sensor_slips" => {
                let at = 40.0 + 60.0 * self.second;
                for_each(series, interval_s, |t, x| *x += if begun_s + t > at { self.size } else { 0.0 });
            }
            _ => {}
        }
    }
}

fn for_each(series: &mut [f64], interval_s: f64, mut change: impl FnMut(f64, &mut f64)) {
    series.iter_mut().enumerate().for_each(|(k, x)| change(k as f64 * interval_s, x));
}

fn greatest(series: &[f64]) -> f64 {
    series.iter().fold(f64::MIN_POSITIVE, |g, x| g.max(x.abs()))
}

/// Filters of first order in series, which share the time constant; exact for inputs that go straight from sample to
/// sample.
fn lag(series: &mut [f64], interval_s: f64, time_constant_s: f64, stages: usize) {
    let time_s = time_constant_s.max(1e-9) / stages as f64;
    let kept = (-interval_s / time_s).exp();
    for _ in 0..stages {
        let mut state = series.first().copied().unwrap_or(0.0);
        let mut before = state;
        for x in series.iter_mut() {
            let behind = time_s * (*x - before) / interval_s;
            state = *x - behind + (state - before + behind) * kept;
            before = *x;
            *x = state;
        }
    }
}

/// A play of a whole width, beginning in its middle.
fn play(series: &mut [f64], width: f64) {
    let mut held = series.first().copied().unwrap_or(0.0);
    for x in series {
        held = held.clamp(*x - 0.5 * width, *x + 0.5 * width);
        *x = held;
    }
}
