//! Where links and free bodies touch.

use rapier3d_f64::geometry::{Collider, ColliderHandle, ContactPair};

use super::geometry::Contact;
use super::model::Mechanism;

impl Mechanism {
    /// All touching points after the last step, with their normal forces averaged over it.
    pub fn contacts(&self) -> Vec<Contact> {
        let mut found = Vec::new();
        for pair in self.world.0.contact_pairs() {
            self.add_pair(pair, &mut found);
        }
        found
    }

    fn add_pair(&self, pair: &ContactPair, found: &mut Vec<Contact>) {
        let (Some(a), Some(b)) = (self.collider(pair.collider1), self.collider(pair.collider2)) else {
            return;
        };
        for manifold in pair.manifolds() {
            for point in &manifold.points {
                let impulse = point.data.impulse;
                if impulse <= 0.0 && point.dist > 0.0 {
                    continue;
                }
                let local = match manifold.subshape_pos1() {
                    Some(pose) => *pose * point.local_p1,
                    None => point.local_p1,
                };
                found.push(Contact {
                    link_a: a.user_data as usize,
                    link_b: b.user_data as usize,
                    point_m: (*a.position() * local).to_array(),
                    normal: manifold.data.normal.to_array(),
                    penetration_m: -point.dist,
                    force_n: if self.last_step_s > 0.0 { impulse / self.last_step_s } else { 0.0 },
                });
            }
        }
    }

    fn collider(&self, handle: ColliderHandle) -> Option<&Collider> {
        self.world.0.colliders.get(handle)
    }
}
