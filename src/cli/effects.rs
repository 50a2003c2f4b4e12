//! `smam effects`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use smam::effects::{CATALOGUE, Effect, EffectSpec};
use smam::recording::did_you_mean;
use smam::report::{AffectedScene, effect_svg};
use smam::scene::{STOCK_SCENES, Scene};
use smam::system::{Influence, influence};

use super::CliError;
use super::files::write;

/// Arguments of `smam effects`.
#[derive(Args)]
#[command(after_help = "Examples:
  smam effects                    the catalogue
  smam effects trapped_air        its law, its numbers, and pictures of what it does, in out/effects/")]
pub struct EffectsArguments {
    /// Show the law and the numbers of this effect, and draw what it does to the stock scenes
    name: Option<String>,
    /// Where to write the picture NAME.svg [default: out/effects]
    #[arg(long, value_name = "DIR", requires = "name")]
    out: Option<PathBuf>,
}

/// The rigs on which effects are shown; an effect that none of them can have is shown on the first scene that can.
const RIGS: [&str; 3] = ["muscle_bench", "antagonistic_pulley", "bending_catheter"];

/// Lists the catalogue, or shows one effect and draws it.
pub fn effects(arguments: &EffectsArguments) -> Result<ExitCode, CliError> {
    let Some(name) = &arguments.name else {
        for spec in CATALOGUE {
            say!("{:<20} {:<10} {}", spec.name, spec.element.name(), spec.title);
        }
        say!("\nOne of them: smam effects {}", CATALOGUE[0].name);
        return Ok(ExitCode::SUCCESS);
    };
    let found: Vec<&'static EffectSpec> = CATALOGUE.iter().filter(|s| s.name == name).collect();
    if found.is_empty() {
        let known: Vec<&str> = CATALOGUE.iter().map(|s| s.name).collect();
        let near = did_you_mean(name, &known);
        return Err(CliError::Usage(format!("{name}: no such effect{near}\n  remedy: `smam effects` lists them")));
    }
    found.iter().for_each(|spec| show(spec));
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out/effects"));
    for (i, spec) in found.iter().enumerate() {
        // Two laws may share a name: the second one's picture carries its key.
        let file = if i == 0 { format!("{name}.svg") } else { format!("{name}_{}.svg", spec.parameters[0].key) };
        let path = out.join(file);
        write(&path, &picture(spec)?)?;
        eprintln!("picture: {}", path.display());
    }
    Ok(ExitCode::SUCCESS)
}

fn show(spec: &EffectSpec) {
    say!("{}: {}\n  law     {}\n  source  {}\n  numbers", spec.name, spec.title, spec.law, spec.source);
    for p in spec.parameters {
        let default = p.default.map_or("must be given".to_owned(), |d| format!("default {d:e}"));
        say!("    {:<30} {:<10} {:e} to {:e}, {default}", p.key, p.symbol, p.range.min, p.range.max);
    }
    let channel = if spec.element.name() == "sensor" { "\n  channel = \"angle_deg\"" } else { "" };
    let size = spec.parameters[0];
    say!(
        "  in a scene\n\n  [[effect]]\n  name = \"{}\"\n  element = \"{}\"{channel}\n  {} = {:e}\n",
        spec.name,
        spec.element.name(),
        size.key,
        size.typical
    );
}

fn picture(spec: &'static EffectSpec) -> Result<String, CliError> {
    let shown = influences(spec)?;
    let size = &spec.parameters[0];
    let sizes: Vec<String> = shown.first().map_or_else(Vec::new, |first| {
        first.with.iter().map(|(value, _)| format!("{} = {}", size.key, number(*value))).collect()
    });
    let scenes: Vec<AffectedScene> = shown.into_iter().map(|one| affected(spec, one)).collect();
    let symbols = spec.parameters.iter().map(|p| format!("{} = {}", p.symbol, p.key)).collect::<Vec<_>>().join(",  ");
    Ok(effect_svg(&format!("{}: {}", spec.name, spec.title), [spec.law, &symbols], &sizes, &scenes))
}

/// On every rig that can have it, else on the first stock scene that can.
fn influences(spec: &'static EffectSpec) -> Result<Vec<Influence>, CliError> {
    let on = |name: &str| -> Result<Option<Influence>, CliError> { Ok(influence(&Scene::load(name, &[])?, spec)?) };
    let mut shown = Vec::new();
    for name in RIGS {
        shown.extend(on(name)?);
    }
    for name in STOCK_SCENES.iter().filter(|name| !RIGS.contains(name)) {
        if shown.is_empty() {
            shown.extend(on(name)?);
        }
    }
    Ok(shown)
}

fn affected(spec: &EffectSpec, one: Influence) -> AffectedScene {
    let on = one.effect.channel.clone().unwrap_or_else(|| one.effect.element.to_string());
    AffectedScene {
        name: format!("{}, {} in {on}", one.scene, spec.name),
        remark: other_numbers(&one.effect),
        time_s: one.time_s,
        input: one.input,
        output: one.output,
        with: one.with.into_iter().map(|(_, values)| values).collect(),
    }
}

/// The numbers besides the size: `relaxation_time_s = 4e0`.
fn other_numbers(effect: &Effect<f64>) -> String {
    let others = effect.spec().parameters.iter().zip(&effect.values).skip(1);
    others.map(|(p, value)| format!("{} = {}", p.key, number(*value))).collect::<Vec<_>>().join(", ")
}

/// As short as it is exact: `0.06`, `2e-16`.
fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e5).contains(&value.abs()) { format!("{value}") } else { format!("{value:e}") }
}
