//! The lumped line against the exact transmission line with the same resistance, inertance and compliance per length.

use num_complex::Complex64;

use super::*;

fn line(segments: usize) -> (Line, Fluid) {
    let line = Line { length_m: 2.0, bore_m: 0.8e-3, segments, compliance_m3_pa: 1.0e-15, momentum_factor: 4.0 / 3.0 };
    (line, Fluid::default())
}

/// Pressure at the closed far end over pressure at the near end: `1 / cosh(Gamma)`.
fn exact_gain(line: &Line, fluid: &Fluid, omega: f64) -> Complex64 {
    let series = Complex64::new(line.resistance_pa_s_m3(fluid), omega * line.inertance_pa_s2_m3(fluid));
    let shunt = Complex64::new(0.0, omega * line.compliance_m3_pa);
    (series * shunt).sqrt().cosh().inv()
}

/// The same for the lumped chain: its end nodes carry half a share of the compliance.
fn lumped_gain(chain: &Chain<f64>, omega: f64) -> Complex64 {
    let n = chain.segments();
    let series = Complex64::new(chain.resistance_pa_s_m3, omega * chain.inertance_pa_s2_m3);
    let (mut pressure, mut flow) = (Complex64::new(1.0, 0.0), Complex64::new(0.0, 0.0));
    for j in (1..=n).rev() {
        flow += pressure * Complex64::new(0.0, omega * chain.compliance_m3_pa[j]);
        pressure += flow * series;
    }
    pressure.inv()
}

fn worst_error_to_50_hz(segments: usize) -> f64 {
    let (line, fluid) = line(segments);
    let chain = Chain::new(&line, &fluid, 0.0, 0.0);
    (1..=500)
        .map(|i| {
            let omega = std::f64::consts::TAU * 0.1 * f64::from(i);
            let exact = exact_gain(&line, &fluid, omega);
            (lumped_gain(&chain, omega) - exact).norm() / exact.norm()
        })
        .fold(0.0, f64::max)
}

#[test]
fn frequency_response_converges_to_the_exact_line() {
    let errors: Vec<f64> = [1, 2, 4, 8, 16].map(worst_error_to_50_hz).to_vec();
    assert!(errors[4] < 0.01, "16 segments: {errors:?}");
    for pair in errors.windows(2) {
        assert!(pair[1] < 0.3 * pair[0], "second order in the segment length: {errors:?}");
    }
}

/// A line's row and which of its nodes boil, at one instant.
#[derive(Clone)]
struct Instant {
    row: Vec<f64>,
    boils: Vec<bool>,
}

impl Instant {
    fn at(&self) -> ChainRow<'_, f64> {
        ChainRow::of(&self.row, self.boils.len() - 1)
    }
}

/// Runs a chain with the two-stage Rosenbrock step used by the whole system, closed at the far end.
fn run_closed(chain: &Chain<f64>, inflow: impl Fn(f64) -> f64, h: f64, steps: usize) -> Vec<Instant> {
    let gamma = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
    let port = Port { outflow_m3_s: 0.0, compliance_m3_pa: 0.0 };
    let mut solver = ChainSolver::new(chain.segments());
    let (mut row, mut boils) = (chain.at_rest(0.0), vec![false; chain.segments() + 1]);
    let zero = vec![0.0; row.len()];
    let (mut r, mut k1, mut k2, mut middle) = (zero.clone(), zero.clone(), zero.clone(), zero);
    let mut history = vec![Instant { row: row.clone(), boils: boils.clone() }];
    for i in 0..steps {
        let q = inflow((i as f64 + 0.5) * h);
        solver.factorise(chain, &row, &boils, &port, gamma * h);
        chain.rates(&row, &boils, q, &port, &mut r);
        solver.eliminate(&r);
        solver.back_substitute(0.0, &r, &boils, &mut k1);
        (0..row.len()).for_each(|i| middle[i] = row[i] + h * k1[i]);
        chain.rates(&middle, &boils, q, &port, &mut r);
        (0..row.len()).for_each(|i| r[i] -= 2.0 * k1[i]);
        solver.eliminate(&r);
        solver.back_substitute(0.0, &r, &boils, &mut k2);
        (0..row.len()).for_each(|i| row[i] += h * (1.5 * k1[i] + 0.5 * k2[i]));
        chain.settle_vapour(&mut row, &mut boils);
        history.push(Instant { row: row.clone(), boils: boils.clone() });
    }
    history
}

/// Step of inflow into a closed line: exact modal solution of the distributed line, at the far end.
///
/// With `p_xx = (R' + I' d/dt) C' dp/dt` and a unit inflow step at x = 0 the far end is
/// `q t/C + sum_k 2 (-1)^k q/C * response of (s² + (R/I) s + (k pi)²/(I C))`.
fn exact_step_response(line: &Line, fluid: &Fluid, inflow: f64, t: f64) -> f64 {
    let (r, i, c) = (line.resistance_pa_s_m3(fluid), line.inertance_pa_s2_m3(fluid), line.compliance_m3_pa);
    let damping = r / i;
    let mut sum = inflow * t / c;
    for k in 1..400_i32 {
        let omega2 = (f64::from(k) * std::f64::consts::PI).powi(2) / (i * c);
        let half = damping / 2.0;
        let root = (omega2 - half * half).sqrt();
        // Response of the mode to a step: integral of (s + R/I)/(s² + (R/I)s + omega²), a damped sine.
        let decay = (-half * t).exp();
        let a = damping / omega2;
        let response = a + decay * (-a * (root * t).cos() + (1.0 - a * half) / root * (root * t).sin());
        sum += 2.0 * inflow / c * response * if k % 2 == 0 { 1.0 } else { -1.0 };
    }
    sum
}

/// The same for an inflow that rises over `rise`: the mean of the step responses begun during the rise.
fn exact_ramp_response(line: &Line, fluid: &Fluid, inflow: f64, rise: f64, t: f64) -> f64 {
    let count = 200;
    let begun = |i: i32| t - rise * (f64::from(i) + 0.5) / f64::from(count);
    let step = |t: f64| if t > 0.0 { exact_step_response(line, fluid, inflow, t) } else { 0.0 };
    (0..count).map(|i| step(begun(i))).sum::<f64>() / f64::from(count)
}

#[test]
fn step_response_matches_the_exact_line() {
    // A rise of 5 ms keeps the step's content below what 48 segments can carry.
    let (line, fluid) = line(48);
    let chain = Chain::new(&line, &fluid, 0.0, 0.0);
    let (inflow, rise, h, steps) = (1e-9, 5e-3, 5e-6, 4_000);
    let history = run_closed(&chain, |t| inflow * (t / rise).min(1.0), h, steps);
    let scale = exact_ramp_response(&line, &fluid, inflow, rise, h * steps as f64);
    let worst = (1..=100)
        .map(|i| {
            let step = i * steps / 100;
            let exact = exact_ramp_response(&line, &fluid, inflow, rise, h * step as f64);
            (history[step].at().pressure_pa[48] - exact).abs() / scale
        })
        .fold(0.0, f64::max);
    assert!(worst < 0.01, "worst error {worst:.4} of the final pressure");
}

#[test]
fn stopping_a_flow_raises_the_joukowsky_pressure() {
    // A frictionless line with a flat profile: rise rho c dv, c = 1/sqrt(rho C'/A).
    let line = Line { length_m: 10.0, bore_m: 2.0e-3, segments: 400, compliance_m3_pa: 2.0e-14, momentum_factor: 1.0 };
    let fluid = Fluid { viscosity_pa_s: 1e-9, ..Fluid::default() };
    let chain = Chain::new(&line, &fluid, 0.0, 0.0);
    let speed = (line.area_m2() * line.length_m / (fluid.density_kg_m3 * line.compliance_m3_pa)).sqrt();
    let velocity = 0.01;
    let rise = fluid.density_kg_m3 * speed * velocity;
    // Starting a flow into a line at rest is the same wave; smooth the front over 20 segments' travel time.
    let front = 20.0 * line.length_m / 400.0 / speed;
    let inflow = |t: f64| velocity * line.area_m2() * (t / front).min(1.0);
    let h = front / 100.0;
    let steps = (0.5 * line.length_m / speed / h) as usize;
    let history = run_closed(&chain, inflow, h, steps);
    let plateau = history[steps].at().pressure_pa[0];
    assert!((plateau / rise - 1.0).abs() < 0.02, "{plateau} Pa against {rise} Pa");
}

#[test]
fn cavitation_keeps_the_volume_and_the_vapour_pressure() {
    let line = Line { length_m: 1.0, bore_m: 0.8e-3, segments: 1, compliance_m3_pa: 0.0, momentum_factor: 4.0 / 3.0 };
    let chain = Chain::new(&line, &Fluid::default(), 8.0e-15, 2.6e-15);
    let h = 1e-5;
    let pull = 2.5e-8;
    // Withdraw for 0.1 s, return for 0.1 s: the liquid volume comes back exactly.
    let history = run_closed(&chain, |t| if t < 0.1 { -pull } else { pull }, h, 20_000);
    let lowest = history.iter().flat_map(|s| s.at().pressure_pa.to_vec()).fold(f64::MAX, f64::min);
    assert!(lowest >= chain.cavitation_pressure_pa - 1e-6, "never below the vapour pressure: {lowest}");
    assert!(history.iter().any(|s| s.boils[0]), "it does cavitate");
    let stored: Vec<f64> = history
        .iter()
        .map(|s| {
            chain.compliance_m3_pa.iter().zip(s.at().pressure_pa).map(|(c, p)| c * p).sum::<f64>()
                - s.at().vapour_m3.iter().sum::<f64>()
        })
        .collect();
    for (i, volume) in stored.iter().enumerate() {
        let t = i as f64 * h;
        let expected = if t < 0.1 { -pull * t } else { pull * (t - 0.2) };
        assert!((volume - expected).abs() < 1e-16, "at {t} s: {volume} against {expected}");
    }
}
