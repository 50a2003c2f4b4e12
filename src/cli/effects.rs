//! `smam effects`.

use std::process::ExitCode;

use clap::Args;
use smam::effects::{CATALOGUE, EffectSpec};

use super::CliError;

/// Arguments of `smam effects`.
#[derive(Args)]
pub struct EffectsArguments {
    /// Show the law and the numbers of this effect
    name: Option<String>,
}

/// Lists the catalogue, or shows one effect.
pub fn effects(arguments: &EffectsArguments) -> Result<ExitCode, CliError> {
    let Some(name) = &arguments.name else {
        for spec in CATALOGUE {
            println!("{:<20} {:<10} {}", spec.name, spec.element.name(), spec.title);
        }
        println!("\nOne of them: smam effects {}", CATALOGUE[0].name);
        return Ok(ExitCode::SUCCESS);
    };
    let found: Vec<&EffectSpec> = CATALOGUE.iter().filter(|s| s.name == name).collect();
    if found.is_empty() {
        return Err(CliError::Usage(format!("{name}: no such effect\n  remedy: `smam effects` lists them")));
    }
    found.into_iter().for_each(show);
    Ok(ExitCode::SUCCESS)
}

fn show(spec: &EffectSpec) {
    println!("{}: {}\n  law     {}\n  source  {}\n  numbers", spec.name, spec.title, spec.law, spec.source);
    for p in spec.parameters {
        let default = p.default.map_or("must be given".to_owned(), |d| format!("default {d:e}"));
        println!("    {:<30} {:<10} {:e} to {:e}, {default}", p.key, p.symbol, p.range.min, p.range.max);
    }
    let channel = if spec.element.name() == "sensor" { "\n  channel = \"angle_deg\"" } else { "" };
    let size = spec.parameters[0];
    println!(
        "  in a scene\n\n  [[effect]]\n  name = \"{}\"\n  element = \"{}\"{channel}\n  {} = {:e}\n",
        spec.name,
        spec.element.name(),
        size.key,
        size.typical
    );
}
