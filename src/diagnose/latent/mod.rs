//! Locates a misfit before any law is known: an unknown signal at each port, scored by the likelihood of the
//! recordings.
//!
//! The signal at a port is a random walk with an unknown start. Along the fitted model's runs, linear in small signals
//! ([`crate::system::Linear`]), a Kalman filter gives the likelihood of the recordings with the signal at that port;
//! calibration and free zeros stay free, and the pace of the walk is the most likely one. This gives one comparable
//! number for every port. At the right port the signal is small and slow, and all channels agree on it; at another one
//! it has to be large, to follow every sample, or leaves part of the misfit. This is the balance of all other elements:
//! if it closes, nothing else has to be missing. (Unknown inputs: Willsky and Jones, IEEE TAC 21, 1976; likelihood from
//! innovations: Schweppe, IEEE TIT 11, 1965.)
//!
//! May import `grammar`, `fit` and `case`.

mod likelihood;
mod stretches;

use crate::diagnose::fit::{Fit, Problem, Rows};
use crate::diagnose::grammar::{Place, places};
use crate::laws::Address;
use crate::parallel;
use likelihood::{Likelihood, Walk};
use stretches::condensed;

/// Maximum number of stretches of the longest run, and of all runs together. A signal is constant within a stretch.
const STRETCHES: f64 = 500.0;
const ALL_STRETCHES: f64 = 4000.0;
/// Paces of the walk that are tried, relative to a clearly visible signal over the longest run; then bisected around
/// the best this many times.
const PACES: [f64; 5] = [0.03, 0.3, 3.0, 30.0, 300.0];
const HALVINGS: i32 = 2;

/// Place of a sensor's error. Its signal is in noise standard deviations of the channel.
const SENSOR: &str = "sensor";

/// A place is likely if it falls behind the most likely one by at most this share of the log odds (the model is only
/// linear), by what that one leaves, or by chance.
const SHARE_OF_ODDS: f64 = 0.05;
const CHANCE: f64 = 20.0;

/// A balance closes if no run keeps more than this many standard errors above noise.
const CLOSES_SIGMA: f64 = 3.0;

/// Result for an unknown signal at one place.
#[derive(Clone, Debug)]
pub struct Latent {
    /// Address of the port; without a number on several equal elements: one signal each.
    pub address: String,
    pub element: String,
    /// Twice the log likelihood ratio against no signal.
    pub log_odds: f64,
    /// What is left of each open run, in standard errors of noise.
    pub left_sigma: Vec<f64>,
    /// The same of all runs, in units of chi².
    left: f64,
}

impl Latent {
    /// Whether it leaves no more than noise in any run: the balances of all other elements close.
    pub fn closes(&self) -> bool {
        self.left_sigma.iter().all(|sigma| *sigma < CLOSES_SIGMA)
    }
}

/// Results for an unknown signal at each place, the most likely first; `known` are the rows of the fit. Empty if the
/// model cannot be linearised: it diverges, is not integrated, or has sensors that act on what they show.
pub fn latents(problem: &Problem, fit: &Fit, known: &Rows) -> Vec<Latent> {
    let settings: Vec<_> = problem.runs.iter().map(|run| fit.model.setting(problem.case, run, &fit.x)).collect();
    if problem.runs.iter().zip(&settings).any(|(run, setting)| run.rom.has_sensors(setting)) {
        return Vec::new();
    }
    let places = places(problem.case);
    let (all, single): (Vec<&Place>, Vec<&Place>) = places.iter().partition(|place| place.is_of_several(&places));
    let lasts_s = || problem.runs.iter().map(|run| lasts_s(&run.drive.times_s));
    let longest_s = lasts_s().fold(0.0, f64::max);
    let stretch_s = f64::max(longest_s / STRETCHES, lasts_s().sum::<f64>() / ALL_STRETCHES);
    let Some(runs) = condensed(problem, &settings, known, &single, stretch_s) else { return Vec::new() };
    let none = Likelihood::of(&runs, &Walk { ports: &[], variance_s: 0.0 });
    let one = |(address, ports): &(String, Vec<usize>)| {
        let at = |pace: f64| Likelihood::of(&runs, &Walk { ports, variance_s: pace * pace / longest_s });
        let best = likeliest(&at);
        let element = Address::parse(address).map_or_else(|_| SENSOR.to_owned(), |a| a.element());
        Latent {
            address: address.clone(),
            element,
            log_odds: none.cost - best.cost,
            left_sigma: best.left_sigma,
            left: best.left,
        }
    };
    let of_one = single.iter().enumerate().map(|(i, place)| (place.address.clone(), vec![i]));
    let members = |place: &Place| (0..single.len()).filter(|&i| single[i].port == place.port).collect();
    let of_all = all.iter().map(|place| (place.address.clone(), members(place)));
    let channels = problem.case.channels.iter().zip(single.len()..);
    let on_channels = channels.map(|(channel, i)| (format!("{SENSOR}.{}", channel.column), vec![i]));
    let sets: Vec<(String, Vec<usize>)> = of_one.chain(of_all).chain(on_channels).collect();
    let mut found: Vec<Latent> = parallel::map(&sets, one);
    found.retain(|latent| latent.log_odds.is_finite());
    found.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
    found
}

/// The likely places in the rig, the most likely first; sensors are excluded.
pub fn likely(latents: Vec<Latent>) -> Vec<Latent> {
    let mut likely = latents;
    likely.retain(|latent| latent.element != SENSOR);
    let least = least(&likely);
    likely.retain(|latent| latent.log_odds >= least);
    likely
}

/// Whether a place is among them, and far behind another one.
pub fn is_behind(latents: &[Latent], address: &str) -> bool {
    latents.iter().any(|latent| latent.address == address && latent.log_odds < least(latents))
}

fn least(latents: &[Latent]) -> f64 {
    latents.first().map_or(0.0, |best| best.log_odds - f64::max(SHARE_OF_ODDS * best.log_odds, best.left) - CHANCE)
}

/// The likelihood at its maximum over the pace: smooth over the logarithm, with one peak.
fn likeliest(at: &dyn Fn(f64) -> Likelihood) -> Likelihood {
    let tried = |pace: f64| (pace, at(pace));
    let mut best = tried(PACES[0]);
    let mut consider = |other: (f64, Likelihood)| {
        if other.1.cost < best.1.cost {
            best = other;
        }
        best.0
    };
    let mut pace = PACES[1..].iter().fold(PACES[0], |_, &pace| consider(tried(pace)));
    for halving in 1..=HALVINGS {
        let step = (PACES[1] / PACES[0]).powf(0.5_f64.powi(halving));
        let [below, above] = [pace / step, pace * step].map(tried);
        consider(below);
        pace = consider(above);
    }
    best.1
}

fn lasts_s(times_s: &[f64]) -> f64 {
    times_s.first().zip(times_s.last()).map_or(0.0, |(start, end)| end - start)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::case::{Case, Noise, RunSet, made};
    use crate::diagnose::fit::{Model, Sides};
    use crate::scene::Override;

    /// Results for a case simulated with changed parameters, without calibration to absorb them.
    fn of(scene: &str, set: &[(&str, &str)], (inputs, outputs): (&[&str], &[&str]), sd: &[f64]) -> Vec<Latent> {
        let set: Vec<Override> =
            set.iter().map(|(key, value)| Override::parse(&format!("{key}={value}")).expect("one")).collect();
        let mut case: Case = made::recorded(scene, &set, inputs, outputs);
        case.parameters.clear();
        let noise: Vec<Noise> = sd.iter().map(|sd| Noise::white(*sd)).collect();
        let problem = Problem { case: &case, runs: case.subset(RunSet::All), noise: &noise };
        let model = Model::baseline();
        let x = problem.start(&model, None);
        let known = problem.rows(&model, &x, 0..x.len(), Sides::Both).expect("it does not diverge");
        let covariance = nalgebra::DMatrix::zeros(x.len(), x.len());
        latents(
            &problem,
            &Fit { model, x, cost: known.residual.norm_squared(), covariance, on_bound: Vec::new() },
            &known,
        )
    }

    /// A bench that is stiffer, or whose syringe gives more, than the scene says, with elongation and pressure recorded.
    fn bench(key: &str, value: &str) -> Vec<Latent> {
        let recorded: (&[&str], &[&str]) = (&["plunger_mm"], &["elongation_mm", "pressure_kpa"]);
        of("muscle_bench", &[(key, value)], recorded, &[0.01, 1.0])
    }

    fn place<'a>(latents: &'a [Latent], address: &str) -> &'a Latent {
        latents.iter().find(|latent| latent.address == address).expect("a place of the scene")
    }

    /// A stiffer muscle is located in the muscle and not in the fluid; a softer syringe the other way round. Places
    /// that sensors cannot distinguish score alike.
    #[test]
    fn balances_of_a_bench_tell_muscle_from_fluid() {
        let stiffer = bench("muscles.tube.material.c1_pa", "2.7e5");
        assert!(stiffer[0].element == "muscle" && place(&stiffer, "muscle.wall").closes(), "{stiffer:?}");
        let [wall, flow] = ["muscle.wall", "line.outflow"].map(|at| place(&stiffer, at));
        assert!(!flow.closes() && flow.log_odds < wall.log_odds - 1000.0, "{wall:?} {flow:?}");
        let softer = bench("hydraulics.upstream_compliance_m3_pa", "9e-15");
        let [syringe, line, wall] =
            ["syringe.compliance", "line.compliance", "muscle.wall"].map(|at| place(&softer, at));
        assert!(
            syringe.closes() && !wall.closes() && wall.log_odds < syringe.log_odds - 1000.0,
            "{syringe:?} {wall:?}"
        );
        assert!(is_behind(&softer, "muscle.wall") && !is_behind(&softer, "line.compliance"), "{line:?}");
        assert!(likely(softer).iter().all(|latent| latent.element != "muscle"));
    }

    /// With one sensor, only the required pace distinguishes muscle and fluid: all balances close.
    #[test]
    fn one_sensor_leaves_no_balance_open() {
        let recorded: (&[&str], &[&str]) = (&["plunger_mm"], &["elongation_mm"]);
        let found = of("muscle_bench", &[("muscles.tube.material.c1_pa", "2.7e5")], recorded, &[0.01]);
        assert!(["muscle.wall", "line.outflow", "plunger"].iter().all(|at| place(&found, at).closes()), "{found:?}");
    }

    /// A sensor is a place of its own, and none in the rig.
    #[test]
    fn sensors_are_no_place_in_the_rig() {
        let found = bench("muscles.tube.material.c1_pa", "2.7e5");
        assert!(!place(&found, "sensor.pressure_kpa").closes());
        assert!(likely(found).iter().all(|latent| latent.element != SENSOR));
        assert!(likely(Vec::new()).is_empty() && !is_behind(&[], "muscle.wall"));
    }
}
