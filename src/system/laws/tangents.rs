//! Stages of the laws' states in an implicit step, and levers as laws make them.

use crate::laws::Port;
use crate::scalar::Scalar;
use crate::system::plant::{Plant, add_scaled, dot};

use super::slopes::StateTangent;
use super::{Acts, PlantLaws};

/// Tangents of laws, frozen for both stages.
#[derive(Clone, Debug)]
pub(in crate::system) struct LawTangents<D> {
    pub states: Vec<StateTangent<D>>,
    /// Of each cable its levers on all coordinates, under laws.
    pub levers: Vec<Vec<D>>,
    /// Where the extra travels of the cables begin among the states.
    travel_at: Option<usize>,
}

impl<D: Scalar> LawTangents<D> {
    /// Room for them.
    pub fn new(laws: &PlantLaws<D>, plant: &Plant<D>) -> Self {
        let levers = plant.cables.iter().map(|c| c.jacobian.iter().map(|&j| D::constant(j)).collect());
        Self { states: vec![StateTangent::none(); laws.states], levers: levers.collect(), travel_at: laws.travel_at }
    }

    /// Whether some law remembers anything.
    #[inline]
    pub fn remember(&self) -> bool {
        !self.states.is_empty()
    }

    /// Takes the levers as the laws make them.
    pub fn levers_at(&mut self, laws: &PlantLaws<D>, plant: &Plant<D>, acts: &Acts<D>) {
        for ((levers, cable), own) in self.levers.iter_mut().zip(&plant.cables).zip(&acts.cables) {
            for (i, lever) in levers.iter_mut().enumerate() {
                *lever = cable.lever_under(own.at(Port::Lever), i, laws.joints);
            }
        }
    }

    fn of_muscle(&self, muscle: usize) -> impl Iterator<Item = &StateTangent<D>> {
        self.states.iter().filter(move |s| s.muscle == Some(muscle))
    }

    /// What a muscle's stiffness gains through the states that its laws have, N/m.
    pub fn stiffness_through(&self, muscle: usize) -> D {
        self.of_muscle(muscle).map(|s| s.pull * s.damper * s.by_elongation).sum()
    }

    /// The same of its damping, N s/m.
    pub fn damping_through(&self, muscle: usize) -> D {
        self.of_muscle(muscle).map(|s| s.pull * s.damper * s.by_speed).sum()
    }

    /// What the states' own rates do to the muscles' pulls within the step. Kept apart: a stock scene has none.
    #[cold]
    #[inline(never)]
    pub fn push_states(&self, plant: &Plant<D>, g: f64, r: &[D], forces: &mut [D]) {
        for (state, &r) in self.states.iter().zip(r) {
            if let Some(muscle) = state.muscle {
                add_scaled::<_, 0>(forces, &plant.muscles[muscle].jacobian, -(state.pull * state.damper * r * g));
            }
        }
    }

    /// Stages of the states; `moving` are those of coordinates and speeds.
    #[cold]
    #[inline(never)]
    pub fn stages(&self, plant: &Plant<D>, g: f64, r: &[D], moving: &[D], stages: &mut [D]) {
        let (y, w) = moving.split_at(moving.len() / 2);
        for ((stage, state), &r) in stages.iter_mut().zip(&self.states).zip(r) {
            let through = state.muscle.map_or(D::constant(0.0), |m| {
                let jacobian = &plant.muscles[m].jacobian;
                state.by_elongation * dot::<_, 0>(jacobian, y) + state.by_speed * dot::<_, 0>(jacobian, w)
            });
            *stage = (r + through) * state.damper;
        }
        // A cable's extra travel goes with the joints.
        let Some(at) = self.travel_at else { return };
        for (i, (levers, cable)) in self.levers.iter().zip(&plant.cables).enumerate() {
            let further = levers.iter().zip(&cable.jacobian).zip(w);
            stages[at + i] += further.map(|((&under, &own), &w)| (under - own) * w).sum::<D>() * g;
        }
    }
}
