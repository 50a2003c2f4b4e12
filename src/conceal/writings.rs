//! Other words for a drawn law: some ports of a rig say the same in two ways.
//!
//! What adds to a force and what scales one that is there are the same law where the latter's own variable is read as well: a pressure
//! drop over `flow x time` is a resistance over time, a pull over speed a damping over speed.

use super::drawn::{DrawnLaw, Place, Reads};

/// A place that adds, one that scales what stands there already, and the variable over which that stands.
const SAME: [(Place, Place, Reads); 5] = [
    (Place::PressureDrop, Place::Resistance, Reads::Flow),
    (Place::Pull, Place::Damping, Reads::Speed),
    (Place::Pull, Place::Coil, Reads::Elongation),
    (Place::Torque, Place::JointStiffness, Reads::Angle),
    (Place::Torque, Place::JointDamping, Reads::AngularSpeed),
];

/// Where a law may be said to act, and over which variables; never over one twice.
#[derive(Clone, Debug, PartialEq)]
pub struct Writing {
    pub place: Place,
    pub over: Vec<Reads>,
}

impl DrawnLaw {
    /// Every way of writing it, its own first.
    pub fn writings(&self) -> Vec<Writing> {
        let (place, product) = (self.place, self.times.map(|(reads, _)| reads));
        let over: Vec<Reads> = self.reads.into_iter().chain(product).collect();
        let without = |own: Reads| over.iter().copied().filter(|r| *r != own).collect::<Vec<_>>();
        let mut all = vec![Writing { place, over: over.clone() }];
        for (adds, scales, own) in SAME {
            if place == adds && over.contains(&own) {
                all.push(Writing { place: scales, over: over.clone() });
                // What goes in proportion to the variable is gone from what scales.
                let is_in_proportion = product == Some(own);
                all.extend(is_in_proportion.then(|| Writing { place: scales, over: without(own) }));
            } else if place == scales {
                all.push(Writing { place: adds, over: [without(own), vec![own]].concat() });
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conceal::drawn::Remembers;
    use crate::conceal::form::Form;

    fn written(place: Place, reads: Reads, times: Option<Reads>) -> Vec<(Place, Vec<Reads>)> {
        let times = times.map(|reads| (reads, 1.0));
        let law = DrawnLaw {
            place,
            reads: Some(reads),
            scale: 1.0,
            form: Form::Constant,
            remembers: Remembers::Nothing,
            times,
        };
        law.writings().into_iter().map(|w| (w.place, w.over)).collect()
    }

    #[test]
    fn what_adds_and_what_scales_are_one_law_over_the_same_variable() {
        use Reads as R;
        let drop = written(Place::PressureDrop, R::Time, Some(R::Flow));
        assert_eq!(drop[0], (Place::PressureDrop, vec![R::Time, R::Flow]));
        assert_eq!(drop[1..], [(Place::Resistance, vec![R::Time, R::Flow]), (Place::Resistance, vec![R::Time])]);
        assert_eq!(written(Place::Resistance, R::Time, None)[1..], [(Place::PressureDrop, vec![R::Time, R::Flow])]);
        assert_eq!(written(Place::Pull, R::Speed, None)[1..], [(Place::Damping, vec![R::Speed])]);
        // A steady pull, a wall: nothing else says the same.
        for (place, reads) in [(Place::Pull, R::Time), (Place::Wall, R::Elongation), (Place::Area, R::Pressure)] {
            assert_eq!(written(place, reads, None).len(), 1);
        }
    }
}
