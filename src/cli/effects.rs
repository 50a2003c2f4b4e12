//! `smam effects`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use smam::effects::{Effect, ElementKind, Entry, EntryId, ParameterSpec, catalogue, names};
use smam::nearest::did_you_mean;
use smam::report::{AffectedScene, Scale, effect_svg, greek};
use smam::scene::Scene;
use smam::stock;
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
        for entry in catalogue() {
            say!("{:<20} {:<10} {}", entry.name, entry.element.name(), entry.title);
        }
        say!("\nOne of them: smam effects {}", names()[0]);
        return Ok(ExitCode::SUCCESS);
    };
    let found: Vec<EntryId> = catalogue().filter(|entry| entry.name == *name).collect();
    if found.is_empty() {
        let near = did_you_mean(name, &names());
        return Err(CliError::Usage(format!("{name}: no such effect{near}\n  remedy: `smam effects` lists them")));
    }
    found.iter().for_each(|spec| show(spec));
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out/effects"));
    for (i, spec) in found.into_iter().enumerate() {
        // Two laws may share a name: the second one's picture carries its key.
        let file = if i == 0 { format!("{name}.svg") } else { format!("{name}_{}.svg", spec.parameters[0].key) };
        let path = out.join(file);
        write(&path, &picture(spec)?)?;
        eprintln!("picture: {}", path.display());
    }
    Ok(ExitCode::SUCCESS)
}

fn show(spec: &Entry) {
    say!("{}: {}\n  law     {}\n  source  {}\n  numbers", spec.name, spec.title, spec.equation, spec.source);
    for p in &spec.parameters {
        let default = p.default.map_or("must be given".to_owned(), |d| format!("default {d:e}"));
        say!("    {:<30} {:<10} {:e} to {:e}, {default}", p.key, p.symbol, p.range.min, p.range.max);
    }
    say!("  in a scene\n\n{}", table(spec));
}

/// The table for a scene: the size and whatever else has no default.
fn table(spec: &Entry) -> String {
    let mut text = format!("  [[effect]]\n  name = \"{}\"\n  element = \"{}\"\n", spec.name, spec.element.name());
    if spec.element == ElementKind::Sensor {
        text += "  channel = \"angle_deg\"\n";
    }
    let given = spec.parameters.iter().enumerate().filter(|(i, p)| *i == 0 || p.default.is_none());
    given.for_each(|(_, p)| text += &format!("  {} = {:e}\n", p.key, p.typical));
    text
}

fn picture(spec: EntryId) -> Result<String, CliError> {
    let shown = influences(spec)?;
    let of_each: Vec<Vec<String>> = shown.iter().map(|one| sizes(&spec, one)).collect();
    let is_common = of_each.windows(2).all(|pair| pair[0] == pair[1]);
    let legend = match of_each.first() {
        Some(first) if is_common => first.clone(),
        _ => ["the first size said above each column", "twice that"].map(str::to_owned).to_vec(),
    };
    let own = of_each.iter().map(|sizes| if is_common { String::new() } else { sizes[0].clone() });
    let scenes: Vec<AffectedScene> = shown.iter().zip(own).map(|(one, size)| affected(&spec, one, size)).collect();
    let title = format!("{}: {}", spec.name, spec.title);
    Ok(effect_svg(&title, [&greek(&spec.equation), &symbols(&spec)], &legend, &scenes))
}

/// What the law's symbols are called in a scene: `κ = kappa` only where the two differ.
fn symbols(spec: &Entry) -> String {
    let keys = spec.parameters.iter().map(|p| match greek(&p.symbol) {
        symbol if p.key.split('_').next() == Some(p.symbol.as_str()) => format!("{symbol} is the key {}", p.key),
        symbol => format!("{symbol} = {}", p.key),
    });
    keys.collect::<Vec<_>>().join(",  ")
}

/// The sizes played, in one unit: `G = 1e-16 m³/(s Pa)`.
fn sizes(spec: &Entry, one: &Influence) -> Vec<String> {
    let p = &spec.parameters[0];
    let greatest = one.sizes.iter().fold(0.0_f64, |m, size| m.max(size.abs()));
    let scale = Scale::of(&p.key, one.effect.channel.as_deref(), greatest);
    one.sizes.iter().map(|size| format!("{} = {}", greek(&p.symbol), scale.short(*size))).collect()
}

fn value_of(p: &ParameterSpec, channel: Option<&str>, value: f64) -> String {
    format!("{} = {}", greek(&p.symbol), Scale::of(&p.key, channel, value).short(value))
}

/// On every rig that can have it, else on the first stock scene that can.
fn influences(spec: EntryId) -> Result<Vec<Influence>, CliError> {
    let on = |name: &str| -> Result<Option<Influence>, CliError> { Ok(influence(&Scene::load(name, &[])?, spec)?) };
    let mut shown = Vec::new();
    for name in RIGS {
        shown.extend(on(name)?);
    }
    for name in stock::scenes().filter(|name| !RIGS.contains(name)) {
        if shown.is_empty() {
            shown.extend(on(name)?);
        }
    }
    Ok(shown)
}

fn affected(spec: &Entry, one: &Influence, size: String) -> AffectedScene {
    let on = one.effect.channel.clone().unwrap_or_else(|| one.effect.element.to_string());
    let numbers = std::iter::once(size).chain(other_numbers(&one.effect)).filter(|text| !text.is_empty());
    AffectedScene {
        name: format!("{}, {} in {on}", one.scene, spec.name),
        remark: numbers.collect::<Vec<_>>().join(", "),
        time_s: one.time_s.clone(),
        input: one.input.clone(),
        output: (one.output.column.clone(), one.output.stock.clone()),
        with: one.output.with.clone(),
        pressure: one.pressure.as_ref().map(|p| (p.column.clone(), p.stock.clone(), p.with.clone())),
    }
}

/// The numbers besides the size: `τ = 4 s`.
fn other_numbers(effect: &Effect<f64>) -> impl Iterator<Item = String> {
    let others = effect.entry.parameters.iter().zip(&effect.values).skip(1);
    others.map(|(p, value)| value_of(p, effect.channel.as_deref(), *value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use smam::effects::EffectTable;

    #[test]
    fn every_table_that_is_printed_can_stand_in_a_scene() {
        for spec in catalogue() {
            let text = table(&spec).replace("[[effect]]", "");
            let parsed: EffectTable = toml::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", spec.name));
            let effect = parsed.effect().unwrap_or_else(|e| panic!("{}: {}", spec.name, e.message));
            assert_eq!((effect.entry, effect.values), (spec, spec.typical()), "{}", spec.name);
        }
    }

    #[test]
    fn every_number_of_the_catalogue_has_its_unit_or_needs_none() {
        let plain = ["kappa", "_ratio", "_coefficient", "gain_error", "_power", "decades", "alpha", "inverse_limit"];
        for p in catalogue().flat_map(|spec| &spec.entry().parameters) {
            let needs_none = plain.iter().any(|end| p.key.ends_with(end));
            assert_eq!(Scale::of(&p.key, None, 1.0).symbol.is_empty(), needs_none, "{}", p.key);
        }
    }
}
