//! Laws from sample to sample: on what a channel shows, and on elements that stand alone.

use std::sync::Arc;

use crate::laws::{Law, Memory, Program, Quantity, Symbol};
use crate::scalar::Scalar;

/// Steps between two samples in which the states of such a law go on; what it reads is straight between them.
const STEPS: usize = 8;

/// A law, and what it remembers from sample to sample.
#[derive(Clone, Debug)]
pub struct LawSampled<D> {
    law: Law,
    values: Vec<D>,
    states: Vec<D>,
    /// The sample before: its time and what was read.
    last: Option<(f64, Vec<D>)>,
    registers: Vec<D>,
}

impl<D: Scalar> LawSampled<D> {
    /// At its start.
    pub fn new(law: &Law, values: Vec<D>) -> Self {
        let states = vec![D::constant(0.0); law.states.len()];
        Self { law: law.clone(), values, states, last: None, registers: Vec::new() }
    }

    /// The law that it is.
    pub fn law(&self) -> &Law {
        &self.law
    }

    /// Name and port.
    pub fn title(&self) -> String {
        format!("{} ({})", self.law.name, self.law.address)
    }

    /// Gives a parameter another value.
    pub fn set(&mut self, parameter: usize, value: D) {
        self.values[parameter] = value;
    }

    /// Goes on to a sample and evaluates; times must increase. `reads` are the port's variables but time, in their order.
    pub fn at(&mut self, time_s: f64, reads: &[D]) -> D {
        if !self.states.is_empty() {
            match self.last.take() {
                None => self.begin(time_s, reads),
                Some((from_s, from)) => self.go_on((from_s, &from), (time_s, reads)),
            }
            self.last = Some((time_s, reads.to_vec()));
        }
        self.now(time_s, reads)
    }

    /// Its value with the memory that it has.
    pub fn now(&mut self, time_s: f64, reads: &[D]) -> D {
        let programs = Arc::clone(&self.law.programs);
        self.evaluate(&programs.value, 0, time_s, reads)
    }

    fn begin(&mut self, time_s: f64, reads: &[D]) {
        let programs = Arc::clone(&self.law.programs);
        for s in 0..self.states.len() {
            let program = if self.law.states[s].follows_start { &programs.follows } else { &programs.starts };
            self.states[s] = self.evaluate(program, s, time_s, reads);
        }
    }

    /// Rates by exponential steps, exact for what is linear in state and reading, and never unstable; what follows an expression
    /// follows it to the end.
    fn go_on(&mut self, (from_s, from): (f64, &[D]), (to_s, to): (f64, &[D])) {
        let programs = Arc::clone(&self.law.programs);
        let h = (to_s - from_s) / STEPS as f64;
        let between = |share: f64| -> Vec<D> {
            from.iter().zip(to).map(|(&from, &to)| from + (to - from) * (share / STEPS as f64)).collect()
        };
        for k in 0..STEPS {
            let [first, last] = [k as f64, k as f64 + 1.0].map(|share| (from_s + share * h, between(share)));
            let moved: Vec<D> = (0..self.states.len())
                .map(|s| {
                    let slope = self.evaluate(&programs.rate_slopes, 3 * s, first.0, &first.1) * h;
                    let first = self.evaluate(&programs.rates, s, first.0, &first.1);
                    let last = self.evaluate(&programs.rates, s, last.0, &last.1);
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

    fn evaluate(&mut self, program: &Program, output: usize, time_s: f64, reads: &[D]) -> D {
        let mut registers = std::mem::take(&mut self.registers);
        registers.resize(program.registers().max(registers.len()), D::constant(0.0));
        let variables = self.law.address.port.spec().variables();
        let variable = |quantity: Quantity| {
            let at = variables.iter().position(|own| *own == quantity);
            at.and_then(|at| reads.get(at)).map_or(D::constant(time_s), |x| *x)
        };
        let read = |symbol: &usize| match self.law.symbols[*symbol] {
            Symbol::Variable(v) => variable(v.quantity),
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
