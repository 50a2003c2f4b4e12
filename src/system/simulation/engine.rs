//! A step of the engine: what it lends to the fine steps, and what it takes back.

use super::Simulation;
use crate::mechanism::Mechanism;
use crate::system::build::{Built, Displacement};
use crate::system::contact::foreseen;
use crate::system::energy::EnergyBalance;
use crate::system::plant::{InputSpan, Instant, Plant};
use crate::system::state::PlantState;
use crate::system::switching::Watch;

impl Simulation {
    /// One step of the engine, with the fine steps in it; it ends early where a law cannot be followed.
    pub(super) fn engine_step(&mut self, end_s: f64) {
        let h = end_s - self.time_s;
        if h <= 0.0 {
            return;
        }
        let joints = self.known_force.len();
        self.renew_coordinates(h);
        self.stepper.plant_changed();
        self.positions.copy_from_slice(&self.built.state.y()[..joints]);
        let substeps = self.scene.file.simulation.substeps;
        let fine = h / substeps as f64;
        let mut pulling = None;
        for i in 0..substeps {
            let start = self.time_s + fine * i as f64;
            self.built.state.time_s = start;
            self.renew_spans(start, fine);
            self.fine_step(fine, &mut pulling);
            if !self.laws_are_sound() {
                // A coefficient near zero throws the state across its range within a step: the end of the engine's would not show it.
                self.time_s = start + fine;
                return;
            }
        }
        self.spans.iter_mut().zip(&self.inputs).for_each(|(span, input)| span.value = input.value(end_s));
        self.built.state.time_s = end_s;
        self.carry_engine(h);
        self.has_stepped = true;
        self.time_s = end_s;
    }

    fn laws_are_sound(&self) -> bool {
        let Built { plant, state, .. } = &self.built;
        plant.laws.as_ref().is_none_or(|laws| laws.is_sound(plant, state, &self.spans, &mut None))
    }

    /// `pulling`: what pulls at the beginning, if that is known.
    fn fine_step(&mut self, h: f64, pulling: &mut Option<u64>) {
        let Built { plant, state, .. } = &mut self.built;
        let mut now = pulling.unwrap_or_else(|| plant.pulling::<0>(&Instant::of(state, &self.spans, 0.0), &mut None));
        let mut balances = Balances { energy: self.energy.as_mut(), contact_impulse: &mut self.contact_impulse };
        self.stepper.advance(plant, state, &mut self.spans, h, &mut now, &mut balances);
        *pulling = Some(now);
    }

    /// Takes inertia, weights and cable levers from the mechanism's present pose.
    fn renew_coordinates(&mut self, h: f64) {
        let Some(mechanism) = &self.mechanism else { return };
        let joints = self.known_force.len();
        if joints == 0 {
            return;
        }
        let plant = &mut self.built.plant;
        let n = plant.dim();
        mechanism.mass_matrix(&mut self.inertia);
        mechanism.weight(&mut self.weight);
        for i in 0..joints {
            for j in 0..joints {
                plant.coordinates.inertia[i * n + j] = self.inertia[(i, j)];
            }
            let known = if self.touching { 0.0 } else { self.known_force[i] };
            plant.coordinates.force[i] = self.weight[i] + self.loads[i] + known;
        }
        let fine = h / self.scene.file.simulation.substeps as f64;
        let touched = self.touching.then(|| foreseen(&self.known_force, self.built.state.y(), &self.inertia, n, fine));
        plant.coordinates.contact = touched.flatten();
        for (i, route) in self.built.routes.iter().enumerate() {
            if !matches!(route, crate::mechanism::Route::Via(_)) {
                continue;
            }
            let cable = &mut plant.cables[i];
            let length = mechanism.path_length(route, &mut cable.jacobian[..joints]);
            let linear: f64 = cable.jacobian[..joints].iter().zip(self.built.state.y()).map(|(j, y)| j * y).sum();
            let spec = &self.scene.file.cable[i];
            let start_offset = self.built.start_offset_m[i];
            cable.stretch_0_m =
                spec.pretension_n / spec.stiffness_n_m + length - self.built.path_0_m[i] - linear + start_offset;
        }
    }

    fn renew_spans(&mut self, start_s: f64, h: f64) {
        for (span, input) in self.spans.iter_mut().zip(&self.inputs) {
            let value = span.value;
            *span = InputSpan { value, slope: (input.value(start_s + h) - value) / h };
        }
        let Some(model) = self.scene.file.muscles.as_ref().and_then(|m| m.displacement.as_ref()) else { return };
        for (&Displacement { plunger, input, .. }, state) in self.built.displacements.iter().zip(&mut self.hysteresis) {
            let from_mm = self.spans[plunger].value * 1e3;
            let to_mm = from_mm + self.spans[plunger].slope * h * 1e3;
            let before = model.output(from_mm, state);
            model.advance(state, from_mm, to_mm, h);
            let after = model.output(to_mm, state);
            self.spans[input] = InputSpan { value: before * 1e-3, slope: (after - before) * 1e-3 / h };
        }
    }

    /// Lets the engine follow, and takes back what contacts changed.
    fn carry_engine(&mut self, h: f64) {
        let Some(mechanism) = &mut self.mechanism else { return };
        let joints = self.known_force.len();
        let Built { plant, state, .. } = &mut self.built;
        for i in 0..joints {
            self.target[i] = (state.y()[i] - self.positions[i]) / h;
        }
        if let Some(contact) = &plant.coordinates.contact {
            let mean = std::mem::take(&mut self.contact_impulse) / h;
            self.known_force.iter_mut().zip(&contact.direction).for_each(|(f, n)| *f = n * mean);
        }
        mechanism.advance(h, &self.target, &mut self.known_force);
        if joints == 0 {
            return;
        }
        self.touching = touches_a_link(mechanism, self.scene.file.mechanism.as_ref().map_or(0, |m| m.body.len()));
        mechanism.positions(&mut self.positions);
        if let Some(laws) = &plant.laws {
            let by: Vec<f64> = self.positions[..joints].iter().zip(state.y()).map(|(to, from)| to - from).collect();
            laws.joints_moved(plant, state, &self.spans, &by);
        }
        let (y, w) = state.y_and_w_mut();
        for ((y, w), &position) in y.iter_mut().zip(w).zip(&self.positions[..joints]) {
            *w += (position - *y) / h;
            *y = position;
        }
        if let Some(balance) = &mut self.energy {
            balance.engine_changed(plant, state, &self.spans, 0.0);
        }
    }
}

/// What is summed up over the fine steps.
struct Balances<'a> {
    energy: Option<&'a mut EnergyBalance>,
    contact_impulse: &'a mut f64,
}

impl Watch<f64> for Balances<'_> {
    fn begin(&mut self, plant: &Plant<f64>, state: &PlantState<f64>, inputs: &[InputSpan]) {
        if let Some(balance) = &mut self.energy {
            balance.before(plant, state, inputs);
        }
    }

    fn end(&mut self, plant: &Plant<f64>, state: &PlantState<f64>, inputs: &[InputSpan], h: f64) {
        if let Some(contact) = &plant.coordinates.contact {
            *self.contact_impulse += h * contact.push(state.y(), state.w());
        }
        if let Some(balance) = &mut self.energy {
            balance.after(plant, state, inputs, h);
        }
    }
}

/// Whether any of the last step's contacts has a link on one side (and not two free bodies).
fn touches_a_link(mechanism: &Mechanism, bodies: usize) -> bool {
    if bodies == 0 {
        return false;
    }
    let links = mechanism.link_names().len() - bodies;
    mechanism.contacts().iter().any(|c| c.force_n > 0.0 && (c.link_a < links || c.link_b < links))
}
