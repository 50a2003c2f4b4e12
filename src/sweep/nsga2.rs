//! NSGA-II: many goals at once, generation by generation.
//!
//! Deb, Pratap, Agarwal, Meyarivan, IEEE Trans. Evol. Comput. 6 (2002) 182: the best half of parents and children lives on,
//! by rank and by room around them; parents are picked by tournaments of two. Children by simulated binary crossover
//! (index 15, in nine of ten pairs) and polynomial mutation (index 20, one key in each child on average), both within the
//! range. It is asked and told, so that what a generation has shown may come from a journal: after a kill, the same
//! generations are asked for again.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::SweepError;
use super::design::Design;
use super::pareto::{Score, ranks, room};
use super::sampling::{Place, Shares, stream};
use super::spec::{SamplingSpec, VarySpec};

const CROSSOVER_INDEX: f64 = 15.0;
const CROSSOVER_SHARE: f64 = 0.9;
const MUTATION_INDEX: f64 = 20.0;

/// A point as shares of the keys' ranges, and what it is worth.
#[derive(Clone, Debug)]
struct Tried {
    shares: Vec<f64>,
    score: Score,
}

/// An optimisation under way.
#[derive(Clone, Debug)]
pub struct Evolution {
    design: Design,
    first: Shares,
    population: usize,
    generations: u64,
    seed: u32,
    generation: u64,
    parents: Vec<Tried>,
    asked: Vec<Vec<f64>>,
}

impl Evolution {
    /// # Errors
    /// A sampling that is not `nsga2`, ranges that are not clear, a population of less than four.
    pub fn new(sampling: SamplingSpec, vary: &[VarySpec]) -> Result<Self, SweepError> {
        let SamplingSpec::Nsga2 { population, generations, seed } = sampling else {
            let (message, remedy) = ("no optimisation".to_owned(), "take method = \"nsga2\"".to_owned());
            return Err(SweepError::Sampling { message, remedy });
        };
        if population < 4 {
            let message = format!("nsga2: population = {population}");
            return Err(SweepError::Sampling { message, remedy: "take at least 4, better 20 to 100".to_owned() });
        }
        Ok(Self {
            design: Design::new(sampling, vary)?,
            first: Shares::new(sampling, vary)?,
            population: population as usize,
            generations,
            seed,
            generation: 0,
            parents: Vec::new(),
            asked: Vec::new(),
        })
    }

    /// Values of the keys at the points to be tried next; none when all generations are through.
    pub fn ask(&mut self) -> Option<Vec<Vec<f64>>> {
        if self.generation >= self.generations {
            return None;
        }
        self.asked = if self.parents.is_empty() {
            (0..self.population as u64).map(|i| self.first.at(i).iter().map(share).collect()).collect()
        } else {
            self.children()
        };
        let places = |shares: &Vec<f64>| shares.iter().map(|s| Place::Share(*s)).collect::<Vec<_>>();
        Some(self.asked.iter().map(|shares| self.design.values(&places(shares))).collect())
    }

    /// What the points that were asked for are worth, in their order.
    pub fn tell(&mut self, scores: Vec<Score>) {
        let children = std::mem::take(&mut self.asked).into_iter().zip(scores);
        self.parents.extend(children.map(|(shares, score)| Tried { shares, score }));
        let (rank, room) = self.standing();
        let mut order: Vec<usize> = (0..self.parents.len()).collect();
        order.sort_by(|&a, &b| rank[a].cmp(&rank[b]).then(room[b].total_cmp(&room[a])));
        self.parents = order.into_iter().take(self.population).map(|i| self.parents[i].clone()).collect();
        self.generation += 1;
    }

    fn standing(&self) -> (Vec<usize>, Vec<f64>) {
        let scores: Vec<Score> = self.parents.iter().map(|t| t.score.clone()).collect();
        let ranks = ranks(&scores);
        let room = room(&scores, &ranks);
        (ranks, room)
    }

    fn children(&self) -> Vec<Vec<f64>> {
        // Streams far beyond those of the first generation's points.
        let mut random = stream(self.seed, (1 << 40) + self.generation);
        let (rank, room) = self.standing();
        let mut children = Vec::new();
        while children.len() < self.population {
            let mut parent = || {
                let (a, b) = (random.random_range(0..self.parents.len()), random.random_range(0..self.parents.len()));
                let better = rank[b].cmp(&rank[a]).then(room[a].total_cmp(&room[b]));
                &self.parents[if better.is_lt() { b } else { a }].shares
            };
            let (mut one, mut other) = (parent().clone(), parent().clone());
            if random.random_bool(CROSSOVER_SHARE) {
                cross(&mut one, &mut other, &mut random);
            }
            for child in [one, other].iter_mut().take(self.population - children.len()) {
                mutate(child, &mut random);
                children.push(std::mem::take(child));
            }
        }
        children
    }
}

fn share(place: &Place) -> f64 {
    match place {
        Place::Share(share) => *share,
        // Shares of a Latin hypercube are no values of a grid.
        Place::Nth(_) => f64::NAN,
    }
}

/// Simulated binary crossover within 0..1: children as far apart as their parents, mostly.
fn cross(one: &mut [f64], other: &mut [f64], random: &mut ChaCha8Rng) {
    for (a, b) in one.iter_mut().zip(other) {
        let (low, high) = (a.min(*b), a.max(*b));
        if random.random_bool(0.5) || high - low < 1e-14 {
            continue;
        }
        let u: f64 = random.random_range(0.0..1.0);
        // The spread that reaches neither end of the range more often than it reaches the other way.
        let spread = |room: f64| {
            let alpha = 2.0 - (1.0 + 2.0 * room / (high - low)).powf(-(CROSSOVER_INDEX + 1.0));
            let ratio = if u <= 1.0 / alpha { u * alpha } else { 1.0 / (2.0 - u * alpha) };
            ratio.powf(1.0 / (CROSSOVER_INDEX + 1.0))
        };
        let middle = 0.5 * (low + high);
        let near = (middle - 0.5 * spread(low) * (high - low)).clamp(0.0, 1.0);
        let far = (middle + 0.5 * spread(1.0 - high) * (high - low)).clamp(0.0, 1.0);
        (*a, *b) = if random.random_bool(0.5) { (near, far) } else { (far, near) };
    }
}

/// Polynomial mutation within 0..1.
fn mutate(child: &mut [f64], random: &mut ChaCha8Rng) {
    let share = 1.0 / child.len().max(1) as f64;
    for x in child {
        if !random.random_bool(share) {
            continue;
        }
        let u: f64 = random.random_range(0.0..1.0);
        let power = MUTATION_INDEX + 1.0;
        *x += if u < 0.5 {
            (2.0 * u + (1.0 - 2.0 * u) * (1.0 - *x).powf(power)).powf(1.0 / power) - 1.0
        } else {
            1.0 - (2.0 * (1.0 - u) + (2.0 * u - 1.0) * x.powf(power)).powf(1.0 / power)
        };
        *x = x.clamp(0.0, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn children_stay_in_the_range(a in 0.0f64..=1.0, b in 0.0f64..=1.0, seed in any::<u32>()) {
            let (mut one, mut other, mut random) = (vec![a; 3], vec![b; 3], stream(seed, 0));
            cross(&mut one, &mut other, &mut random);
            mutate(&mut one, &mut random);
            prop_assert!(one.iter().chain(&other).all(|x| (0.0..=1.0).contains(x)));
        }
    }
}
