//! Conceals an effect in a scene, records it, and lets the diagnosis look for it.
//!
//! ```text
//! cargo run --release --example find_a_leak -- [SCENE] [NAME ELEMENT|CHANNEL KEY VALUE] [--keep DIR]
//! ```

use std::error::Error;
use std::path::PathBuf;

use smam::diagnose::{Case, Options, diagnose};
use smam::effects::EffectTable;
use smam::trial::make_specimen;

fn main() -> Result<(), Box<dyn Error>> {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    let keep = words.iter().position(|w| w == "--keep").map(|i| words.drain(i..).nth(1).unwrap_or_default());
    let scene = words.first().map_or("muscle_bench", String::as_str);
    let effect = match &words.get(1..) {
        Some([name, element, key, value]) => (name.as_str(), element.as_str(), key.as_str(), value.parse()?),
        None | Some([]) => ("leak", "line", "conductance_m3_s_pa", 1e-17),
        Some(_) => return Err("an effect needs four words: NAME ELEMENT KEY VALUE (see `smam effects`)".into()),
    };
    let (name, element, key, value): (&str, &str, &str, f64) = effect;
    // An error of a sensor is named by the channel that has it.
    let is_channel = name.starts_with("sensor_");
    let table = EffectTable {
        name: name.to_owned(),
        element: if is_channel { "sensor" } else { element }.to_owned(),
        channel: is_channel.then(|| element.to_owned()),
        parameters: [(key.to_owned(), value)].into_iter().collect(),
    };
    // A size of zero conceals nothing.
    let concealed = if value == 0.0 { None } else { Some(table.effect()?) };
    let folder = keep.map_or_else(|| std::env::temp_dir().join("smam_find_a_leak"), PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    make_specimen(scene, concealed.as_ref(), 1.0, 7, &folder)?;
    let outcome = diagnose(Case::load(&[&folder], None, &[])?, Options { seed: 1 }, &|line| eprintln!("{line}"))?;
    println!("{}", serde_json::to_string_pretty(&outcome.diagnosis)?);
    Ok(())
}
