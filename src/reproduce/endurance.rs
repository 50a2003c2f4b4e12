//! Durability (Fig. 4f): 2000 s at 80 % elongation and 0.1 Hz.

use crate::effects::EffectTable;
use crate::parallel;
use crate::recording::figures;
use crate::report::{BLUE, GREEN, ORANGE, PURPLE, Panel, Series, VERMILION};

use super::error::lacking;
use super::rig::{Fast, effect, sine, stock};
use super::search::size_for;
use super::{Chapter, ReproduceError, Row};

const FIGURE: &str = "4f";
const DURATION_S: f64 = 2000.0;
const PERIOD_S: f64 = 10.0;
/// 80 % of 50 mm.
const ELONGATION_MM: f64 = 40.0;
const PAPER_PERCENT: f64 = -2.0;

/// An effect by one number, from none to the most that is plausible.
struct Suspect {
    name: &'static str,
    number: &'static str,
    most: f64,
    unit: &'static str,
    colour: &'static str,
    make: fn(f64) -> EffectTable,
}

const SUSPECTS: [Suspect; 5] = [
    Suspect {
        name: "leak",
        number: "G",
        most: 1e-17,
        unit: "m³/(s Pa)",
        colour: ORANGE,
        make: |g| effect("leak", "line", &[("conductance_m3_s_pa", g)]),
    },
    Suspect {
        name: "thermal_expansion (cooling)",
        number: "volume rate",
        most: -5e-12,
        unit: "m³/s",
        colour: GREEN,
        make: |q| effect("thermal_expansion", "line", &[("volume_rate_m3_s", q)]),
    },
    Suspect {
        name: "viscoelasticity (500 s)",
        number: "E_1",
        most: 20.0,
        unit: "N/m",
        colour: PURPLE,
        make: |e| effect("viscoelasticity", "muscle", &[("stiffness_n_m", e), ("relaxation_time_s", 500.0)]),
    },
    Suspect {
        name: "plastic_set",
        number: "k",
        most: 1e-4,
        unit: "1/s",
        colour: VERMILION,
        make: |k| effect("plastic_set", "muscle", &[("set_rate_1_s", k), ("threshold_m", 0.0)]),
    },
    Suspect {
        name: "mullins_softening",
        number: "d",
        most: 0.5,
        unit: "1",
        colour: "#404040",
        make: |d| effect("mullins_softening", "muscle", &[("softening_ratio", d)]),
    },
];

/// What becomes of the elongation's peaks, in percent of the second one.
struct Endurance {
    fast: Fast,
}

impl Endurance {
    fn new() -> Result<Self, ReproduceError> {
        let reached = |stroke_m: f64| -> Result<f64, ReproduceError> {
            let fast = stock("muscle_bench").driven("plunger_mm", sine(FIGURE, stroke_m, 0.1)?).lasting(30.0).fast()?;
            Ok(figures::greatest(&fast.channel("elongation_mm", &[], &[])?))
        };
        let stroke_m = size_for(ELONGATION_MM, (2e-3, 8e-3), reached)?;
        let stroke_m = stroke_m.ok_or_else(|| lacking(FIGURE, "no stroke elongates the muscle by 80 %"))?;
        let play = stock("muscle_bench")
            .driven("plunger_mm", sine(FIGURE, stroke_m, 0.1)?)
            .with("simulation.output_interval_s", 0.1)
            .lasting(DURATION_S);
        Ok(Self { fast: play.fast()? })
    }

    /// Greatest elongation of each cycle, mm; the first cycle, which starts from rest, left out.
    fn peaks(&self, effects: &[EffectTable]) -> Result<Vec<f64>, ReproduceError> {
        let y = self.fast.channel("elongation_mm", &[], effects)?;
        let per_cycle = (PERIOD_S / 0.1).round() as usize;
        Ok(y.chunks(per_cycle).filter(|c| c.len() == per_cycle).skip(1).map(figures::greatest).collect())
    }

    /// Change of the peak from the second cycle to the last, %.
    fn change_percent(&self, effects: &[EffectTable]) -> Result<f64, ReproduceError> {
        let peaks = self.peaks(effects)?;
        Ok(100.0 * (peaks[peaks.len() - 1] / peaks[0] - 1.0))
    }
}

/// Fig. 4f: the stock rig, then each effect that might bring what was printed.
pub fn chapter() -> Result<Chapter, ReproduceError> {
    let endurance = Endurance::new()?;
    let plain = endurance.peaks(&[])?;
    let mut rows = vec![Row::compared(
        "change of the elongation over 2000 s, stock rig",
        "%",
        PAPER_PERCENT,
        100.0 * (plain[plain.len() - 1] / plain[0] - 1.0),
        0.5,
        "the stock rig has nothing that changes over minutes",
    )];
    let mut series = vec![peaks_line("stock rig", BLUE, &plain)];
    let found: Result<Vec<_>, ReproduceError> =
        parallel::map(&SUSPECTS, |s| suspected(s, &endurance)).into_iter().collect();
    for (suspect, (row, peaks)) in SUSPECTS.iter().zip(found?) {
        rows.push(row);
        if figures::range(&peaks) > 0.01 {
            series.push(peaks_line(suspect.name, suspect.colour, &peaks));
        }
    }
    let panel = Panel {
        title: vec!["Greatest elongation of each cycle".to_owned()],
        x_label: "time (s)".to_owned(),
        y_label: "elongation (mm)".to_owned(),
        series,
        ..Panel::default()
    };
    let text = "200 cycles of the plunger with the stroke that elongates the muscle by 80 %. The paper prints a shrink of \
                2 % and lays it to elastic properties. At a fixed stroke a wall that relaxes pulls less, needs less \
                pressure, and so gets longer: the wrong way. What takes fluid away brings it.";
    Ok(Chapter { text: vec![text.to_owned()], panels: vec![panel], rows })
}

/// The size that brings the printed change, or what the most plausible size does.
fn suspected(s: &Suspect, endurance: &Endurance) -> Result<(Row, Vec<f64>), ReproduceError> {
    let figure = |size: f64| endurance.change_percent(&[(s.make)(size)]);
    let name = format!("with {}", s.name);
    match size_for(PAPER_PERCENT, (0.0, s.most), figure)? {
        Some(size) => {
            let remark = format!("{} = {size:.3e} {}, sought for it; tolerance 0.1 %", s.number, s.unit);
            let row = Row::compared(name, "%", PAPER_PERCENT, figure(size)?, 0.1, remark).tuned();
            Ok((row, endurance.peaks(&[(s.make)(size)])?))
        }
        None => {
            let most = figure(s.most)?;
            let way = if most > 0.0 { "the wrong way" } else { "too little" };
            let remark = format!("an attempt: {} = {:.3e} {}: {way}", s.number, s.most, s.unit);
            let row = Row::about_other_data(name, "%", PAPER_PERCENT, Some(most), remark);
            Ok((row, endurance.peaks(&[(s.make)(s.most)])?))
        }
    }
}

fn peaks_line(label: &str, colour: &'static str, peaks: &[f64]) -> Series {
    let x = (0..peaks.len()).map(|i| PERIOD_S * (i as f64 + 1.5)).collect();
    Series { label: label.to_owned(), colour, x, y: peaks.to_vec() }
}
