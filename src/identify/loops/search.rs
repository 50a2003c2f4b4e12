//! Four ways to the least F.

use serde::{Deserialize, Serialize};

use super::super::levenberg_marquardt::{Bounds, LmOptions, LmResult, minimise_with_jacobian};
use super::cma::{CmaOptions, cma};
use super::coarse::decimated;
use super::form::ParameterSpec;
use super::problem::Problem;
use super::swarm::{SwarmOptions, least, swarm};

/// How parameters are searched.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// Particle swarm, as in the paper.
    Pso,
    /// Covariance matrix adaptation.
    Cma,
    /// Levenberg-Marquardt with an exact Jacobian from the middle of the bounds and from drawn places.
    Lm,
    /// The same from the middle and from the best of a few places spread over the box, their gains solved for.
    #[default]
    Hybrid,
}

impl std::str::FromStr for Method {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "pso" => Ok(Self::Pso),
            "cma" => Ok(Self::Cma),
            "lm" => Ok(Self::Lm),
            "hybrid" => Ok(Self::Hybrid),
            _ => Err(format!("no method `{text}`; known: pso, cma, lm, hybrid")),
        }
    }
}

/// What to do, and how long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchOptions {
    pub method: Method,
    pub seed: u64,
    /// Descents (beside the one from the middle), or repetitions of a swarm; the best one counts.
    pub starts: usize,
    pub swarm: SwarmOptions,
    pub cma: CmaOptions,
}

impl Default for SearchOptions {
    fn default() -> Self {
        Self { method: Method::Hybrid, seed: 1, starts: 3, swarm: SwarmOptions::default(), cma: CmaOptions::default() }
    }
}

/// Where a search ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The free parameters.
    pub parameters: Vec<f64>,
    pub mean_square_mm2: f64,
    pub evaluations: usize,
}

/// Places of the hybrid's look around, at least; a power of two, as the sequence likes it.
const LOOKS: usize = 32;
/// At most so many on a part of the samples, where they cost little: as many as the box has corners, for with many parameters most places
/// are no model.
const MOST_COARSE_LOOKS: usize = 128;
/// As far as the sequence goes.
const MOST_LOOKS: usize = 1 << 16;
/// Far below what noise decides; each further step costs a Jacobian.
const DESCENT: LmOptions = LmOptions { max_iterations: 60, relative_decrease: 1e-7, difference: 1e-6 };
/// Enough to tell which of several ends is the lowest.
const COARSE: LmOptions = LmOptions { relative_decrease: 1e-6, ..DESCENT };

/// The free parameters of least F; `None` if no place within the bounds gives a model.
pub fn search(problem: &Problem<'_>, options: &SearchOptions) -> Option<Found> {
    let runs = (0..options.starts.max(1) as u64).map(|start| options.seed.wrapping_add(start));
    match options.method {
        Method::Pso => best(runs.map(|seed| by_swarm(problem, options.swarm, seed))),
        Method::Cma => best(runs.map(|seed| by_cma(problem, options.cma, seed))),
        Method::Lm => {
            let middle = from_unit(problem, &vec![0.5; problem.free().len()]);
            let drawn = (1..options.starts.clamp(1, MOST_LOOKS)).map(|i| look(problem, i, options.seed));
            best(
                std::iter::once(middle)
                    .chain(drawn)
                    .map(|place| descend(problem, &problem.with_best_gains(&place)?, DESCENT)),
            )
        }
        Method::Hybrid => hybrid(problem, options),
    }
}

/// The best of several, with the evaluations of all.
fn best(found: impl Iterator<Item = Option<Found>>) -> Option<Found> {
    let all: Vec<Found> = found.flatten().collect();
    let evaluations = all.iter().map(|f| f.evaluations).sum();
    let best = all.into_iter().min_by(|a, b| a.mean_square_mm2.total_cmp(&b.mean_square_mm2))?;
    Some(Found { evaluations, ..best }).filter(|f| f.mean_square_mm2.is_finite())
}

/// Looks around with the gains solved for, and descends from the best places and from the middle; of a long loop all that on a part
/// of its samples, and then to the end on all of them.
fn hybrid(problem: &Problem<'_>, options: &SearchOptions) -> Option<Found> {
    let starts = options.starts.max(1);
    let Some(runs) = decimated(problem.runs) else {
        let ends = descend_all(problem, LOOKS, starts, options.seed, DESCENT);
        return best(ends.into_iter().map(Some));
    };
    let coarse = problem.on(&runs);
    let looks = 2usize.saturating_pow(problem.free().len() as u32).clamp(LOOKS, MOST_COARSE_LOOKS);
    let ends = descend_all(&coarse, looks, starts, options.seed, COARSE);
    let least = ends.first()?.mean_square_mm2;
    let evaluations: usize = ends.iter().map(|f| f.evaluations).sum();
    let mut tried: Vec<Vec<f64>> = Vec::new();
    for end in ends.into_iter().filter(|f| f.mean_square_mm2 <= AS_GOOD * least) {
        if !tried.iter().any(|place| is_near(problem, place, &end.parameters)) {
            tried.push(end.parameters);
        }
    }
    let found = best(tried.iter().map(|place| descend(problem, place, DESCENT)))?;
    // Those on a part of the samples count as that part.
    let coarsely = (evaluations * coarse.counted()).div_ceil(problem.counted());
    Some(Found { evaluations: found.evaluations + coarsely, ..found })
}

/// Ends of descents that are gone on with: those whose F is no more than this many times the least.
const AS_GOOD: f64 = 1.3;
/// Share of each parameter's range within which two ends are one.
const ONE_PLACE: f64 = 0.02;

fn is_near(problem: &Problem<'_>, a: &[f64], b: &[f64]) -> bool {
    let apart = |((spec, a), b): ((&&ParameterSpec, &f64), &f64)| (a - b).abs() / (spec.max - spec.min);
    problem.free().iter().zip(a).zip(b).map(apart).all(|share| share < ONE_PLACE)
}

/// Where descents end from the best of some places and from the middle, lowest first. The first carries the evaluations of the looks.
fn descend_all(problem: &Problem<'_>, looks: usize, starts: usize, seed: u64, until: LmOptions) -> Vec<Found> {
    let count = looks.max(starts.next_power_of_two()).min(MOST_LOOKS);
    let solved = |i: usize| {
        let unit = unit_look(problem, i, seed);
        Some((problem.with_best_gains(&from_unit(problem, &unit))?, unit))
    };
    let (places, units): (Vec<Vec<f64>>, Vec<Vec<f64>>) = (0..count).filter_map(solved).unzip();
    let values = problem.mean_squares(&places);
    let mut order: Vec<usize> = (0..places.len()).filter(|&i| values[i].is_finite()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let chosen = spread(problem, &order, &units, starts);
    // The middle too: in a box with forbidden corners it is often the surest start.
    let middle = problem.with_best_gains(&from_unit(problem, &vec![0.5; problem.free().len()]));
    let places = chosen.into_iter().map(|i| places[i].clone()).chain(middle);
    let mut ends: Vec<Found> = places.filter_map(|place| descend(problem, &place, until)).collect();
    ends.sort_by(|a, b| a.mean_square_mm2.total_cmp(&b.mean_square_mm2));
    ends.iter_mut().take(1).for_each(|f| f.evaluations += 2 * count + 1);
    ends
}

/// Starts differ by this share of the range in a number that is no gain, or more: the lowest places of a look around may all lie in
/// one valley, and the next valley may be the deeper one.
const APART: f64 = 0.25;

/// The lowest places that lie apart; the lowest of the others where too few do.
fn spread(problem: &Problem<'_>, order: &[usize], units: &[Vec<f64>], count: usize) -> Vec<usize> {
    let shapes: Vec<usize> = (0..problem.free().len()).filter(|&d| !problem.free()[d].is_gain).collect();
    let is_apart = |a: usize, b: usize| shapes.iter().any(|&d| (units[a][d] - units[b][d]).abs() >= APART);
    let mut chosen: Vec<usize> = Vec::new();
    for &i in order {
        if chosen.len() < count && chosen.iter().all(|&other| is_apart(i, other)) {
            chosen.push(i);
        }
    }
    let others: Vec<usize> = order.iter().copied().filter(|i| !chosen.contains(i)).collect();
    chosen.extend(others.into_iter().take(count - chosen.len()));
    chosen
}

/// A place of the scrambled Sobol sequence over the box.
fn look(problem: &Problem<'_>, index: usize, seed: u64) -> Vec<f64> {
    from_unit(problem, &unit_look(problem, index, seed))
}

/// The same in the unit box.
fn unit_look(problem: &Problem<'_>, index: usize, seed: u64) -> Vec<f64> {
    let coordinate = |d: usize| f64::from(sobol_burley::sample(index as u32, d as u32, (seed ^ (seed >> 32)) as u32));
    (0..problem.free().len()).map(coordinate).collect()
}

fn by_swarm(problem: &Problem<'_>, options: SwarmOptions, seed: u64) -> Option<Found> {
    let values = |places: &[Vec<f64>]| unit_values(problem, places);
    let (place, value) = swarm(problem.free().len(), &values, options, seed);
    let evaluations = options.particles * (options.iterations + 1);
    Some(Found { parameters: from_unit(problem, &place), mean_square_mm2: value, evaluations })
}

/// From a drawn place: the middle of the box would be the same start each time.
fn by_cma(problem: &Problem<'_>, options: CmaOptions, seed: u64) -> Option<Found> {
    let values = |places: &[Vec<f64>]| unit_values(problem, places);
    let dimension = problem.free().len();
    let drawn: Vec<Vec<f64>> = (0..LOOKS)
        .map(|i| (0..dimension).map(|d| f64::from(sobol_burley::sample(i as u32, d as u32, seed as u32))).collect())
        .collect();
    let start = &drawn[least(&values(&drawn))];
    let (place, value, evaluations) = cma(start, &values, options, seed);
    let evaluations = evaluations + LOOKS;
    Some(Found { parameters: from_unit(problem, &place), mean_square_mm2: value, evaluations })
}

fn unit_values(problem: &Problem<'_>, places: &[Vec<f64>]) -> Vec<f64> {
    let sets: Vec<Vec<f64>> = places.iter().map(|place| from_unit(problem, place)).collect();
    problem.mean_squares(&sets)
}

fn from_unit(problem: &Problem<'_>, place: &[f64]) -> Vec<f64> {
    let value = |(spec, &u): (&&ParameterSpec, &f64)| {
        if spec.is_scale { spec.min * (spec.max / spec.min).powf(u) } else { spec.min + u * (spec.max - spec.min) }
    };
    problem.free().iter().zip(place).map(value).collect()
}

fn descend(problem: &Problem<'_>, start: &[f64], until: LmOptions) -> Option<Found> {
    let bounds: Vec<Bounds> = problem.free().iter().map(|s| Bounds { min: s.min, max: s.max }).collect();
    let (residuals, jacobian) = (|x: &[f64]| problem.residuals(x), |x: &[f64]| problem.jacobian(x));
    let LmResult { parameters, cost, evaluations } =
        minimise_with_jacobian(&residuals, &jacobian, start, &bounds, until)?;
    Some(Found { parameters, mean_square_mm2: cost / problem.counted() as f64, evaluations })
}
