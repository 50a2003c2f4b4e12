//! `smam laws`.

use std::process::ExitCode;

use clap::Args;
use smam::laws::{Address, Carrier, LawTable, PORTS, Port, PortSpec, nearest_port};
use smam::scene::{Scene, SceneError};
use smam::system::observe::{Frame, Observer, SceneGraph};
use smam::system::{Schedule, Simulation, run};

use super::CliError;
use super::interrupt::stop_flag;

/// Arguments of `smam laws`.
#[derive(Args)]
#[command(after_help = "Examples:
  smam laws                        the ports at which a law can act
  smam laws muscle.friction        what may be added or scaled there, the variables, an example
  smam laws --scene muscle_bench   the ports that this scene has
  smam run muscle_bench --law 'muscle.damping adds 0.05*tanh(speed_m_s/2e-3)'")]
pub struct LawsArguments {
    /// Show this port
    port: Option<String>,
    /// The same as the argument without a flag
    #[arg(long = "port", value_name = "PORT", conflicts_with = "port")]
    flag: Option<String>,
    /// List the ports that this scene has, numbered and named
    #[arg(long, value_name = "SCENE", conflicts_with_all = ["port", "flag"])]
    scene: Option<String>,
}

/// Lists the ports, or shows one.
pub fn laws(arguments: &LawsArguments) -> Result<ExitCode, CliError> {
    if let Some(scene) = &arguments.scene {
        return list_of_scene(scene);
    }
    match arguments.port.as_ref().or(arguments.flag.as_ref()) {
        Some(port) => super::print_text(&page(find(port)?))?,
        None => super::print_text(&list())?,
    }
    Ok(ExitCode::SUCCESS)
}

/// The port of a name, numbered or not.
fn find(name: &str) -> Result<&'static PortSpec, CliError> {
    if let Some(spec) = PORTS.iter().find(|spec| spec.name() == name) {
        return Ok(spec);
    }
    if let Ok(address) = Address::parse(name) {
        return Ok(address.port.spec());
    }
    let near = nearest_port(name);
    Err(CliError::Usage(format!("{name}: no such port{near}\n  remedy: `smam laws` lists the ports")))
}

fn units(spec: &PortSpec) -> String {
    if spec.port == Port::Sensor { "SI unit".to_owned() } else { spec.adds.join(", ") }
}

fn list() -> String {
    let row = |name: &str, adds: &str, scales: &str, means: &str| format!("{name:<20} {adds:<9} {scales:<7} {means}\n");
    let rows = PORTS.iter().map(|spec| {
        let scales = if spec.scales { "yes" } else { "-" };
        row(&spec.name(), &units(spec), scales, spec.means)
    });
    let head = row("port", "adds", "scales", "what it is");
    let rest = "\nOne of them: smam laws muscle.friction\nThose of a scene: smam laws --scene muscle_bench\n";
    head + &rows.collect::<String>() + rest
}

/// Everything about one port.
fn page(spec: &PortSpec) -> String {
    let mut text = format!("{}: {}\n", spec.name(), spec.means);
    text += &format!("  adds       an expression in {}\n", in_words(spec));
    if spec.scales {
        text += "  scales     an expression without a unit: 1 leaves the port as it is\n";
    }
    text += &format!("  energy     {}\n", energy(spec));
    text += &format!("  written    {}\n", addresses(spec));
    text += "  variables\n";
    for variable in spec.variables() {
        let own = variable.spec();
        let unit = match own.quantity {
            smam::laws::Quantity::Reading => "SI unit".to_owned(),
            _ if own.ending == "rad_s" => "rad/s".to_owned(),
            _ if own.ending.is_empty() || own.ending == "rad" => own.ending.to_owned(),
            _ => own.quantity.dimension().to_string(),
        };
        text += &format!("    {:<22} {unit:<8} {}\n", own.name(), own.is);
    }
    if !matches!(spec.carrier, Carrier::Alone | Carrier::Sensor) {
        text += "    Another muscle or cable goes by its number: pressure_2_pa, tension_1_n\n";
    }
    text += "  functions  abs, sign, min, max, exp, ln, sqrt, sin, cos, tanh; + - * / ^ and comparisons (1 where true, else 0)\n";
    text + &format!("  in a scene\n\n{}", indented(&spec.example_table().to_toml()))
}

fn in_words(spec: &PortSpec) -> String {
    match spec.adds {
        [] => "the channel's SI unit".to_owned(),
        [one] => (*one).to_owned(),
        [turns, slides, ..] => format!("{turns} (of a sliding joint in {slides})"),
    }
}

fn energy(spec: &PortSpec) -> &'static str {
    match (spec.carrier, spec.dissipates) {
        (Carrier::Sensor, _) => "none: a sensor only shows",
        (Carrier::Alone, _) => "none is counted: what stands alone follows its recorded input",
        (_, true) => {
            "the port takes energy; `smam run --energy` warns of a law that brings in more than the element loses"
        }
        (_, false) => "`smam run --energy` shows what the law brings in or takes",
    }
}

fn addresses(spec: &PortSpec) -> String {
    let name = spec.name();
    match (spec.carrier, name.split_once('.')) {
        (Carrier::Sensor, _) => "sensor.angle_deg: the name of an output".to_owned(),
        (Carrier::Joint, Some((_, term))) => {
            format!("{name} for the joints that the scene moves, joint(NAME).{term} for one")
        }
        (Carrier::Alone, _) => format!("{name}: a scene has one"),
        (_, Some((element, term))) => format!("{name} for all, {element}_2.{term} for the second"),
        (_, None) => format!("{name} for all, {name}_2 for the second"),
    }
}

fn indented(text: &str) -> String {
    text.lines().map(|line| format!("  {line}\n")).collect()
}

fn list_of_scene(name: &str) -> Result<ExitCode, CliError> {
    let scene = Scene::load(name, &[])?;
    let mut joints = Joints::default();
    // A run without an instant shows what the scene consists of.
    run(&mut Simulation::new(scene.clone())?, &Schedule::at(Vec::new()), stop_flag(), &mut joints)?;
    for spec in &PORTS {
        let all = candidates(spec, &scene, &joints.0);
        let here: Vec<String> = all.into_iter().filter(|port| has(&scene, port)).collect();
        if !here.is_empty() {
            say!("{:<20} {}", spec.name(), here.join(", "));
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Names of a scene's joints.
#[derive(Default)]
struct Joints(Vec<String>);

impl Observer for Joints {
    type Error = CliError;

    fn begin(&mut self, graph: &SceneGraph) -> Result<(), CliError> {
        self.0 = graph.joints.iter().map(|joint| joint.name.clone()).collect();
        Ok(())
    }

    fn frame(&mut self, _: &Frame) -> Result<(), CliError> {
        Ok(())
    }
}

/// Addresses that a port can have in a scene.
fn candidates(spec: &PortSpec, scene: &Scene, joints: &[String]) -> Vec<String> {
    let numbered = |count: usize| {
        let address = |number: usize| Address { port: spec.port, number: Some(number), of: None }.to_string();
        (0..count).map(address).collect()
    };
    let of = |name: &String| Address { port: spec.port, number: None, of: Some(name.clone()) }.to_string();
    match spec.carrier {
        Carrier::Muscle => numbered(scene.file.muscle.len()),
        Carrier::Cable => numbered(scene.file.cable.len()),
        Carrier::Joint => joints.iter().map(of).collect(),
        Carrier::Alone => vec![spec.name()],
        Carrier::Sensor => scene.file.output.iter().map(|o| of(&o.channel)).collect(),
    }
}

/// Whether a law that does nothing can act there.
fn has(scene: &Scene, port: &str) -> bool {
    let law = LawTable {
        name: "smam_laws_asks".to_owned(),
        port: port.to_owned(),
        adds: Some("0".to_owned()),
        ..LawTable::default()
    };
    let with = || -> Result<Scene, SceneError> {
        let mut file = scene.file.clone();
        file.law.push(law);
        Scene::from_file(file, &scene.path)
    };
    with().is_ok_and(|scene| Simulation::new(scene).is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;
    use smam::laws::Acts;

    #[test]
    fn every_port_has_its_page_and_its_line() {
        let lines = list();
        for spec in &PORTS {
            let text = page(spec);
            assert!(lines.contains(&format!("{} ", spec.name())), "{}", spec.name());
            assert!(text.contains("[[law]]") && text.contains("variables"), "{text}");
            let acts = if spec.example.0 == Acts::Adds { "adds = " } else { "scales = " };
            assert!(text.contains(acts), "{text}");
        }
    }

    #[test]
    fn a_port_is_found_with_or_without_its_number() {
        for name in ["muscle.friction", "muscle_2.friction"] {
            assert!(find(name).is_ok_and(|spec| spec.port == Port::Friction), "{name}");
        }
        let message = find("muscle.frction").err().map_or_else(String::new, |e| e.to_string());
        assert!(message.contains("did you mean \"muscle.friction\"?"), "{message}");
    }
}
