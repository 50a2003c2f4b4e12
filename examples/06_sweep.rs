//! A sweep from code: how stiff the wall and how long the line may be before the bench loses a tenth of its stroke.
//!
//! ```text
//! cargo run --release --example sweep
//! ```

use std::error::Error;

use rayon::prelude::*;
use smam::sweep::{Plan, SweepFile, evaluate};

const SWEEP: &str = r#"
format = 1
name = "wall_and_line"
scene = "muscle_bench"
duration_s = 12.0
set = ["input.plunger_mm.program.frequency_hz=0.25"]

[[vary]]
key = "muscles.tube.material.c1_pa"
from = 0.2e6
to = 0.4e6
count = 3

[[vary]]
key = "hydraulics.line.length_m"
from = 1.0
to = 3.0
count = 3

[[measure]]
name = "stroke_mm"
of = "range(elongation_mm)"
"#;

fn main() -> Result<(), Box<dyn Error>> {
    let plan = Plan::new(toml::from_str::<SweepFile>(SWEEP)?)?;
    // Every point is known by its index: any part of them can be run, in any order, on any machine.
    let rows: Vec<_> = (0..plan.count()).into_par_iter().map(|i| evaluate(&plan, i, plan.point(i))).collect();
    println!("{}", plan.columns().join("\t"));
    for row in &rows {
        let values: Vec<String> = row.values.iter().map(|v| format!("{v:.4e}")).collect();
        println!("{}\t{}\t{:.3}", row.index, values.join("\t"), plan.measured(row, "stroke_mm"));
    }
    Ok(())
}
