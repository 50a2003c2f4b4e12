//! Gas in a closed chamber.

use crate::effects::{Effect, Native};
use crate::hydraulics::GasLeak;
use crate::laws::Port;
use crate::scalar::Scalar;
use crate::scene::ChamberSpec;

use super::laws::AloneLaws;

/// A pressure that stays, unless gas leaks out ([`GasLeak`]).
#[derive(Clone, Debug)]
pub(in crate::system) struct Chamber {
    pub spec: ChamberSpec,
}

/// Which number of a chamber.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChamberNumber {
    Start,
}

/// The gas of a chamber along a run.
#[derive(Clone, Debug)]
pub(in crate::system) struct ChamberGas<D> {
    leak: GasLeak<D>,
    ambient_pa: f64,
    /// Absolute pressure of the zero of what is shown, Pa.
    zero_pa: f64,
    /// Absolute, Pa.
    pressure_pa: D,
    time_s: Option<f64>,
}

impl Chamber {
    /// The gas at the start, with numbers that differ from the scene's and the effects on it.
    pub fn begin<D: Scalar>(
        &self,
        numbers: impl Iterator<Item = (ChamberNumber, D)>,
        effects: &[Effect<D>],
    ) -> ChamberGas<D> {
        let scene = D::constant(self.spec.start_pressure_pa);
        let start = numbers.last().map_or(scene, |(ChamberNumber::Start, value)| value);
        let mut leak = GasLeak::none();
        let is_own = |e: &&Effect<D>| !e.element.is_numbered || e.element.index + 1 == self.spec.number;
        for effect in effects.iter().filter(is_own) {
            match effect.entry.native {
                Some(Native::ChamberLeak) => leak.rate_1_s += effect.values[0],
                Some(Native::ChamberGap) => leak.laminar_1_s += effect.values[0],
                Some(Native::ChamberOrifice) => leak.orifice_1_s += effect.values[0],
                _ => {}
            }
        }
        ChamberGas {
            leak,
            ambient_pa: self.spec.ambient_pressure_pa,
            zero_pa: self.spec.zero_pa(),
            pressure_pa: start + self.spec.zero_pa(),
            time_s: None,
        }
    }
}

impl<D: Scalar> ChamberGas<D> {
    /// Pressure at a time, on the scale of the scene, Pa; the first time is that of the start. Laws add to what leaves.
    pub fn pressure_pa(&mut self, time_s: f64, laws: &mut AloneLaws<D>) -> D {
        let from_s = self.time_s.replace(time_s).unwrap_or(time_s);
        if time_s > from_s {
            match laws.is_empty() {
                true => self.pressure_pa = self.leak.advance(self.pressure_pa, self.ambient_pa, time_s - from_s),
                false => self.advance_with(laws, from_s, time_s),
            }
        }
        laws.acting(Port::ChamberOutflow, time_s, &[self.shown_pa()]);
        self.shown_pa()
    }

    /// The pressure as it is, on the scale of the scene, Pa.
    pub fn shown_pa(&self) -> D {
        self.pressure_pa - self.zero_pa
    }

    /// Leaks and laws in turn, of second order (Strang); what laws remember is that of the sample before.
    fn advance_with(&mut self, laws: &mut AloneLaws<D>, from_s: f64, to_s: f64) {
        let h = (to_s - from_s) / STEPS as f64;
        for k in 0..STEPS {
            let now_s = from_s + h * k as f64;
            self.let_out(laws, now_s, 0.5 * h);
            self.pressure_pa = self.leak.advance(self.pressure_pa, self.ambient_pa, h);
            self.let_out(laws, now_s + 0.5 * h, 0.5 * h);
        }
    }

    /// What leaves by laws alone, by the midpoint rule.
    fn let_out(&mut self, laws: &mut AloneLaws<D>, from_s: f64, h: f64) {
        let mut rate_pa_s = |time_s: f64, pressure_pa: D| {
            laws.acting_now(Port::ChamberOutflow, time_s, &[pressure_pa - self.zero_pa]).on(D::constant(0.0))
        };
        let first = rate_pa_s(from_s, self.pressure_pa);
        let middle = rate_pa_s(from_s + 0.5 * h, self.pressure_pa - first * (0.5 * h));
        self.pressure_pa -= middle * h;
    }
}

/// Steps between two samples where laws let gas out.
const STEPS: usize = 4;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::PressureScale;

    fn none() -> AloneLaws<f64> {
        AloneLaws::new(&[], std::iter::empty(), &[])
    }

    fn chamber(reads: PressureScale) -> Chamber {
        Chamber { spec: ChamberSpec { start_pressure_pa: 7e5, reads, ambient_pressure_pa: 1e5, number: 1 } }
    }

    #[test]
    fn a_tight_chamber_keeps_its_pressure_on_either_scale() {
        for reads in [PressureScale::Gauge, PressureScale::Absolute] {
            let mut gas = chamber(reads).begin::<f64>(std::iter::empty(), &[]);
            assert_eq!([gas.pressure_pa(5.0, &mut none()), gas.pressure_pa(500.0, &mut none())], [7e5, 7e5]);
        }
    }

    #[test]
    fn a_leak_takes_the_gauge_pressure_to_zero_and_the_absolute_one_to_the_surroundings() {
        let text = "name = 'leak'\nelement = 'line'\nrate_1_s = 0.1";
        let leak = toml::from_str::<crate::effects::EffectTable>(text).expect("TOML").effect().expect("right");
        for (reads, left_pa) in [(PressureScale::Gauge, 7e5), (PressureScale::Absolute, 6e5)] {
            let mut gas = chamber(reads).begin(std::iter::empty(), std::slice::from_ref(&leak));
            let end_pa = 7e5 - left_pa;
            assert_eq!(gas.pressure_pa(5.0, &mut none()), 7e5);
            let found = gas.pressure_pa(25.0, &mut none()) - end_pa;
            assert!((found / (left_pa * (-2.0f64).exp()) - 1.0).abs() < 1e-6, "{found}");
        }
    }

    #[test]
    fn a_leak_of_another_chamber_leaves_this_one_tight() {
        let pressure_pa = |element: &str| {
            let text = format!("name = 'leak'\nelement = '{element}'\nrate_1_s = 0.1");
            let leak = toml::from_str::<crate::effects::EffectTable>(&text).expect("TOML").effect().expect("right");
            let mut gas = chamber(PressureScale::Gauge).begin(std::iter::empty(), &[leak]);
            gas.pressure_pa(0.0, &mut none());
            gas.pressure_pa(10.0, &mut none())
        };
        assert_eq!(pressure_pa("line_2"), 7e5);
        assert_eq!(pressure_pa("line_1"), pressure_pa("line"));
        assert!(pressure_pa("line") < 3e5);
    }
}
