//! Laws on an element that stands alone.

use crate::effects::Effect;
use crate::laws::{Acts, Law, Port};
use crate::scalar::Scalar;
use crate::system::laws::{Act, LawSampled};

use super::{StandaloneNumber, stands_alone};

/// The laws of the scene and those among the effects, in this order.
#[derive(Clone, Debug)]
pub(in crate::system) struct AloneLaws<D> {
    laws: Vec<LawSampled<D>>,
}

impl<D: Scalar> AloneLaws<D> {
    /// The laws of a scene with numbers that differ from its own, and those among the effects.
    pub fn new(scene: &[Law], numbers: impl Iterator<Item = (StandaloneNumber, D)>, effects: &[Effect<D>]) -> Self {
        let own = |law: &Law| LawSampled::new(law, law.values().into_iter().map(D::constant).collect());
        let mut laws: Vec<LawSampled<D>> = scene.iter().map(own).collect();
        for (number, value) in numbers {
            if let StandaloneNumber::Law(law, parameter) = number {
                laws[law].set(parameter, value);
            }
        }
        let written = effects.iter().filter_map(|effect| {
            let own = effect.entry.unlisted().filter(|own| stands_alone(&own.law))?;
            Some(LawSampled::new(&own.law, own.values(&effect.values)))
        });
        laws.extend(written);
        Self { laws }
    }

    pub fn is_empty(&self) -> bool {
        self.laws.is_empty()
    }

    /// Name and port of the last.
    pub fn title(&self) -> Option<String> {
        self.laws.last().map(LawSampled::title)
    }

    /// Gives the first parameter of the last law another value.
    pub fn set_last(&mut self, value: D) {
        if let Some(law) = self.laws.last_mut() {
            law.set(0, value);
        }
    }

    /// What stands at a port, with the laws on it.
    pub fn on(&mut self, port: Port, without: D, time_s: f64, reads: &[D]) -> D {
        if self.is_empty() { without } else { self.acting(port, time_s, reads).on(without) }
    }

    /// What laws add to a port and scale it by, and their memory gone on to this time.
    pub fn acting(&mut self, port: Port, time_s: f64, reads: &[D]) -> Act<D> {
        self.join(port, |law| law.at(time_s, reads))
    }

    /// The same with the memory as it is.
    pub fn acting_now(&mut self, port: Port, time_s: f64, reads: &[D]) -> Act<D> {
        self.join(port, |law| law.now(time_s, reads))
    }

    fn join(&mut self, port: Port, value: impl Fn(&mut LawSampled<D>) -> D) -> Act<D> {
        let mut act = Act::neutral();
        for law in self.laws.iter_mut().filter(|law| law.law().address.port == port) {
            let acts: Acts = law.law().acts;
            act.join(acts, value(law));
        }
        act
    }
}
