//! Laws on what a channel shows.

use crate::laws::{Law, Memory, Program, Quantity, Symbol};
use crate::scalar::Scalar;

/// Steps between two samples in which the states of a sensor's law go on; the reading is straight between them.
const STEPS: usize = 8;

/// A law on one channel, and what it remembers from sample to sample.
#[derive(Clone, Debug)]
pub struct LawSensor<D> {
    law: Law,
    values: Vec<D>,
    /// SI units in one of the channel's.
    factor: f64,
    states: Vec<D>,
    last: Option<(f64, D)>,
    registers: Vec<D>,
}

impl<D: Scalar> LawSensor<D> {
    /// At its start.
    pub fn new(law: &Law, values: Vec<D>, factor: f64) -> Self {
        let states = vec![D::constant(0.0); law.states.len()];
        Self { law: law.clone(), values, factor, states, last: None, registers: Vec::new() }
    }

    /// Name and port.
    pub fn title(&self) -> String {
        format!("{} ({})", self.law.name, self.law.address)
    }

    /// What is shown when the quantity is `value`, in the channel's unit; times must increase.
    pub fn show(&mut self, time_s: f64, value: D) -> D {
        let reading = value * self.factor;
        match self.last {
            None => self.begin(time_s, reading),
            Some((from_s, from)) => self.go_on((from_s, from), (time_s, reading)),
        }
        self.last = Some((time_s, reading));
        let programs = std::sync::Arc::clone(&self.law.programs);
        let own = self.evaluate(&programs.value, 0, time_s, reading);
        let shown = match self.law.acts {
            crate::laws::Acts::Adds => reading + own,
            crate::laws::Acts::Scales => reading * own,
        };
        shown / self.factor
    }

    fn begin(&mut self, time_s: f64, reading: D) {
        let programs = std::sync::Arc::clone(&self.law.programs);
        for s in 0..self.states.len() {
            let program = if self.law.states[s].follows_start { &programs.follows } else { &programs.starts };
            self.states[s] = self.evaluate(program, s, time_s, reading);
        }
    }

    /// Rates by exponential steps, exact for what is linear in state and reading, and never unstable; what follows an expression
    /// follows it to the end.
    fn go_on(&mut self, (from_s, from): (f64, D), (to_s, to): (f64, D)) {
        if self.states.is_empty() {
            return;
        }
        let programs = std::sync::Arc::clone(&self.law.programs);
        let h = (to_s - from_s) / STEPS as f64;
        for k in 0..STEPS {
            let at = |share: f64| ((from_s + share * h), from + (to - from) * (share / STEPS as f64));
            let moved: Vec<D> = (0..self.states.len())
                .map(|s| {
                    let [(from_s, from), (to_s, to)] = [at(k as f64), at(k as f64 + 1.0)];
                    let first = self.evaluate(&programs.rates, s, from_s, from);
                    let last = self.evaluate(&programs.rates, s, to_s, to);
                    let slope = self.evaluate(&programs.rate_slopes, 3 * s, from_s, from) * h;
                    let [phi_1, phi_2] = exponential(slope);
                    self.states[s] + (phi_1 * first + phi_2 * (last - first)) * h
                })
                .collect();
            self.states = moved;
        }
        for s in 0..self.states.len() {
            let before = self.states[s];
            let followed = self.evaluate(&programs.follows, s, to_s, to);
            let half = self.evaluate(&programs.widths, s, to_s, to) * 0.5;
            self.states[s] = match self.law.states[s].memory {
                Memory::Rate => before,
                Memory::Greatest => followed.select_above(before, followed, before),
                Memory::Play => super::play(before, followed, half),
            };
        }
    }

    fn evaluate(&mut self, program: &Program, output: usize, time_s: f64, reading: D) -> D {
        let mut registers = std::mem::take(&mut self.registers);
        registers.resize(program.registers().max(registers.len()), D::constant(0.0));
        let read = |symbol: &usize| match self.law.symbols[*symbol] {
            Symbol::Variable(v) if v.quantity == Quantity::Reading => reading,
            Symbol::Variable(_) => D::constant(time_s),
            Symbol::Parameter(p) => self.values[p],
            Symbol::State(s) => self.states[s],
            Symbol::Constant(x) => D::constant(x),
        };
        let values = program.symbols().iter().map(read);
        let value = match output {
            // A value's slopes are not asked for.
            0 => program.run_first(values, &mut registers),
            _ => {
                program.run(values, &mut registers);
                program.output(output, &registers)
            }
        };
        self.registers = registers;
        value
    }
}

/// `(exp z - 1)/z` and `(exp z - 1 - z)/z²`.
fn exponential<D: Scalar>(z: D) -> [D; 2] {
    /// Below, the differences would lose digits.
    const SMALL: f64 = 0.5;
    const TERMS: u32 = 14;
    if z.value().abs() > SMALL {
        let first = z.exp_m1() / z;
        return [first, (first - 1.0) / z];
    }
    let series = |from: u32| (0..TERMS).rev().fold(D::constant(0.0), |sum, k| (sum * z + 1.0) / f64::from(k + from));
    let first = series(1);
    // sum z^k/(k + 2)! = (1/2) (1 + z/3 (1 + z/4 (...))).
    [first, series(2)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{LawTable, Surroundings};

    fn shown(text: &str, at: &[(f64, f64)]) -> Vec<f64> {
        let table: LawTable = toml::from_str(&format!("name = 'x'\nport = 'sensor.angle_deg'\n{text}")).expect("TOML");
        let law = table.law(&Surroundings::default()).unwrap_or_else(|e| panic!("{e}"));
        let mut sensor = LawSensor::new(&law, law.values(), std::f64::consts::PI / 180.0);
        at.iter().map(|(t, x)| sensor.show(*t, *x)).collect()
    }

    /// A channel in degrees: what is added is in radians, what scales has no unit.
    #[test]
    fn gain_offset_and_lag_are_what_they_say() {
        let gain = shown("scales = '1 + 0.1'", &[(0.0, 10.0)]);
        assert!((gain[0] - 11.0).abs() < 1e-12);
        let offset = shown("adds = '0.5 * time_s'", &[(0.0, 0.0), (2.0, 0.0)]);
        assert!((offset[1] - 57.295_779_5).abs() < 1e-6);
        let lag = "adds = 's - reading'\nstate.s = { rate = '(reading - s)/tau_s', start = 'reading' }\nparameter.tau_s = { value = 0.05 }";
        let ramp: Vec<(f64, f64)> = (0..200).map(|i| (0.01 * f64::from(i), 0.02 * f64::from(i))).collect();
        // A settled first-order lag of a ramp of 2 per second is 2 tau behind.
        assert!((shown(lag, &ramp)[199] - (3.98 - 0.1)).abs() < 1e-4);
        let play = "adds = 's - reading'\nstate.s = { play_of = 'reading', width = '0.02' }";
        let turned = shown(play, &[(0.0, 0.0), (0.1, 10.0), (0.2, 9.9)]);
        let half = 0.01_f64.to_degrees();
        assert!((turned[1] - (10.0 - half)).abs() < 1e-9 && (turned[2] - turned[1]).abs() < 1e-9, "{turned:?}");
    }
}
