//! Values of laws at an instant, and where their variables are read.

use crate::laws::{Carrier, Port, Program};
use crate::scalar::Scalar;
use crate::system::plant::{Instant, Plant, dot};

use super::slopes::Slopes;
use super::{Act, Acts, Instance, PlantLaws, Source};

impl<D: Scalar> PlantLaws<D> {
    /// Evaluates all laws at an instant.
    pub(in crate::system) fn act<const N: usize>(&self, plant: &Plant<D>, now: &Instant<D, N>, acts: &mut Acts<D>) {
        self.act_first(self.laws.len(), plant, now, acts);
    }

    /// Evaluates the first so many laws.
    pub(super) fn act_first<const N: usize>(
        &self,
        count: usize,
        plant: &Plant<D>,
        now: &Instant<D, N>,
        acts: &mut Acts<D>,
    ) {
        // Where a law is alone, its value takes the place of the last one.
        let is_cleared = |i: &&Instance| !i.is_alone || i.law >= count || i.port == Port::Plunger;
        self.instances.iter().filter(is_cleared).for_each(|i| self.clear(i, acts));
        let wanted = || self.instances.iter().filter(|i| i.law < count);
        let is_cable = |i: &&Instance| i.carrier == Carrier::Cable;
        if !plant.cables.is_empty() {
            for (cable, tension) in plant.cables.iter().zip(&mut acts.tension_n) {
                *tension = cable.pull(now).2;
            }
            wanted().filter(is_cable).for_each(|i| self.act_at(i, plant, now, acts));
            if self.on_cables() {
                self.pull_cables(plant, now, acts);
            }
        }
        wanted().filter(|i| !is_cable(i)).for_each(|i| self.act_at(i, plant, now, acts));
    }

    #[inline]
    fn clear(&self, instance: &Instance, acts: &mut Acts<D>) {
        let Some(act) = Self::act_of_mut(instance, acts) else { return };
        *act = Act::neutral();
        if instance.port == Port::Plunger {
            acts.piston_m_s[instance.at] = D::constant(0.0);
        }
    }

    /// What acts where an instance's law does; nothing in the plant where it changes a reading.
    #[inline(always)]
    pub(super) fn act_of_mut<'a>(instance: &Instance, acts: &'a mut Acts<D>) -> Option<&'a mut Act<D>> {
        let (port, at) = (instance.port, instance.at);
        match instance.carrier {
            Carrier::Muscle => Some(acts.muscles[at].at_mut(port)),
            Carrier::Cable => Some(acts.cables[at].at_mut(port)),
            Carrier::Joint => Some(acts.joints[at].at_mut(port)),
            Carrier::Alone | Carrier::Sensor => None,
        }
    }

    #[inline]
    fn act_at<const N: usize>(&self, instance: &Instance, plant: &Plant<D>, now: &Instant<D, N>, acts: &mut Acts<D>) {
        if instance.port == Port::Plunger {
            return self.move_piston(instance, plant, now, acts);
        }
        let value = self.value(instance, plant, now, acts);
        let sense = instance.sense;
        match Self::act_of_mut(instance, acts) {
            Some(act) if instance.is_alone => act.set(sense, value),
            Some(act) => act.join(sense, value),
            None => {}
        }
    }

    /// Value of a law; its registers are kept for the slopes.
    #[inline]
    pub(super) fn value<const N: usize>(
        &self,
        instance: &Instance,
        plant: &Plant<D>,
        now: &Instant<D, N>,
        acts: &mut Acts<D>,
    ) -> D {
        let tension_n = &acts.tension_n;
        let read = |source: &Source| self.read(*source, instance, plant, now, tension_n);
        instance.programs.value.run_first(instance.reads.iter().map(read), &mut acts.registers[instance.registers_at..])
    }

    /// Slopes of a law whose value was evaluated last at the same instant, by [`crate::laws::SLOPES`] and then its states;
    /// `registers` are those of the acts.
    pub(super) fn slopes<'a>(instance: &'a Instance, registers: &'a mut [D]) -> Slopes<'a, D> {
        let program = &instance.programs.value;
        let registers = &mut registers[instance.registers_at..];
        program.run_rest(registers);
        Slopes { program, registers }
    }

    /// Runs a program of a law and reads one of its results.
    #[inline]
    pub(super) fn evaluate<const N: usize>(
        &self,
        program: &Program,
        instance: &Instance,
        plant: &Plant<D>,
        now: &Instant<D, N>,
        acts: &mut Acts<D>,
        output: usize,
    ) -> D {
        self.run(program, instance, plant, now, acts);
        program.output(output, &acts.scratch)
    }

    /// Runs a program of a law's states; its results stand in the scratch registers of the acts.
    #[inline]
    pub(super) fn run<const N: usize>(
        &self,
        program: &Program,
        instance: &Instance,
        plant: &Plant<D>,
        now: &Instant<D, N>,
        acts: &mut Acts<D>,
    ) {
        let tension_n = &acts.tension_n;
        let read = |symbol: &usize| self.read(instance.sources[*symbol], instance, plant, now, tension_n);
        program.run(program.symbols().iter().map(read), &mut acts.scratch);
    }

    /// Value of a symbol at an instant; `tension_n` are those of the cables.
    #[inline(always)]
    pub(super) fn read<const N: usize>(
        &self,
        source: Source,
        instance: &Instance,
        plant: &Plant<D>,
        now: &Instant<D, N>,
        tension_n: &[D],
    ) -> D {
        let at = &now.at;
        match source {
            Source::Elongation(m) => plant.muscles[m].elongation_m::<N>(at.y()),
            Source::Speed(m) => dot::<_, N>(&plant.muscles[m].jacobian, at.w()),
            Source::Pressure(m) => plant.pressure(m, now),
            Source::SyringePressure(m) => at.line(m)[0],
            Source::Flow(m) => at.line(m)[now.state.segments() + 1],
            Source::Input(i) => D::constant(now.input(i)),
            Source::InputSpeed(i) => D::constant(now.inputs[i].slope),
            Source::Drive(i, m) => D::constant(now.input(i) * m),
            Source::DriveSpeed(i, m) => D::constant(now.inputs[i].slope * m),
            Source::FrictionState(m) => at.z(m),
            Source::Stretch(c) => plant.cables[c].stretch_and_rate(now).0,
            Source::Tension(c) => tension_n[c],
            Source::Along(d) => dot::<_, N>(&self.rig.directions[d].direction, at.y()),
            Source::AlongSpeed(d) => dot::<_, N>(&self.rig.directions[d].direction, at.w()),
            Source::Time => D::constant(now.time_s()),
            Source::Parameter(p) => self.values[instance.law][p],
            Source::State(s) => at.law_states()[instance.state_at + s],
            Source::Constant(x) => D::constant(x),
        }
    }
}
