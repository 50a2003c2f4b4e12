//! `smam model`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Subcommand};
use smam::mechanism::{Forceps, MechanismError, NotchGeometry, NotchedTube, notched_tube_meshes, notched_tube_urdf};

use smam::files::write_whole_bytes;

use super::CliError;
use super::files::refuse_dash;

/// Arguments of `smam model`.
#[derive(Args)]
#[command(after_help = "Examples:
  smam model notched-tube --notches 12 --cut-depth-m 1.2e-3 --output my_tube.urdf")]
pub struct ModelArguments {
    #[command(subcommand)]
    kind: Kind,
}

#[derive(Subcommand)]
enum Kind {
    /// A tube with cutouts on one side, each a hinge, with forceps at its tip: the bending segment of the catheter
    NotchedTube(TubeArguments),
}

#[derive(Args)]
struct TubeArguments {
    /// Number of notches
    #[arg(long, default_value_t = NotchedTube::STOCK.notches)]
    notches: usize,
    /// Outer diameter of the tube, m
    #[arg(long, default_value_t = 2.0 * NotchedTube::STOCK.notch.outer_radius_m)]
    outer_diameter_m: f64,
    /// Wall thickness of the tube, m
    #[arg(long, default_value_t = 0.3e-3)]
    wall_m: f64,
    /// Depth of the cuts, m
    #[arg(long, default_value_t = NotchedTube::STOCK.notch.cut_depth_m)]
    cut_depth_m: f64,
    /// Opening of a notch along the tube, m
    #[arg(long, default_value_t = NotchedTube::STOCK.notch.notch_height_m)]
    notch_height_m: f64,
    /// Uncut tube between two notches, m
    #[arg(long, default_value_t = NotchedTube::STOCK.bridge_m)]
    bridge_m: f64,
    /// Density of the tube, kg/m³
    #[arg(long, default_value_t = NotchedTube::STOCK.density_kg_m3)]
    density_kg_m3: f64,
    /// Young's modulus of the tube, Pa; only for the stiffness that is printed
    #[arg(long, default_value_t = 0.5e9)]
    youngs_modulus_pa: f64,
    /// Leave the forceps away
    #[arg(long)]
    no_forceps: bool,
    /// Write the URDF here, with meshes of the tube beside it, instead of on the standard output
    #[arg(long, value_name = "URDF")]
    output: Option<PathBuf>,
}

/// Generates the model; the numbers that the scene file needs go to stderr.
pub fn model(arguments: &ModelArguments) -> Result<ExitCode, CliError> {
    let Kind::NotchedTube(a) = &arguments.kind;
    let modulus_pa = a.youngs_modulus_pa;
    if !(modulus_pa > 0.0 && modulus_pa.is_finite()) {
        let remedy = "give it in Pa, for example 0.5e9";
        return Err(CliError::Usage(format!("--youngs-modulus-pa {modulus_pa}: must be > 0\n  remedy: {remedy}")));
    }
    let notch = NotchGeometry {
        outer_radius_m: a.outer_diameter_m / 2.0,
        inner_radius_m: a.outer_diameter_m / 2.0 - a.wall_m,
        cut_depth_m: a.cut_depth_m,
        notch_height_m: a.notch_height_m,
    };
    let tube = NotchedTube {
        notch,
        notches: a.notches,
        bridge_m: a.bridge_m,
        density_kg_m3: a.density_kg_m3,
        forceps: (!a.no_forceps).then_some(Forceps::STOCK),
        ..NotchedTube::STOCK
    };
    match &a.output {
        Some(path) => {
            refuse_dash("--output", path, "leave --output out: the URDF then goes to the standard output")?;
            write_with_meshes(&tube, path)?;
        }
        None => super::print_text(&notched_tube_urdf(&tube, None).map_err(of_option)?)?,
    }
    eprintln!("for the scene file, per notch:");
    eprintln!("  stiffness_n_m_rad = {:.6e}", notch.stiffness_n_m_rad(a.youngs_modulus_pa));
    eprintln!("  lever_m = {:.6e}", notch.lever_m());
    eprintln!("  closes at {:.4} rad", notch.closing_angle_rad());
    Ok(ExitCode::SUCCESS)
}

/// The URDF and, beside it, the meshes that it draws the tube with.
fn write_with_meshes(tube: &NotchedTube, path: &Path) -> Result<(), CliError> {
    let name = path.file_stem().map_or_else(|| "tube".to_owned(), |n| n.to_string_lossy().into_owned());
    let meshes =
        notched_tube_meshes(tube, &name).map_err(of_option)?.map(|(file, bytes)| (path.with_file_name(file), bytes));
    let urdf = (path.to_owned(), notched_tube_urdf(tube, Some(&name)).map_err(of_option)?.into_bytes());
    for (file, bytes) in std::iter::once(urdf).chain(meshes) {
        write_whole_bytes(&file, &bytes).map_err(|source| CliError::Write { file: file.clone(), source })?;
        eprintln!("written: {}", file.display());
    }
    Ok(())
}

/// An error of the tube, told by the option that the number came from.
fn of_option(error: MechanismError) -> CliError {
    match error {
        MechanismError::Spec { name, problem, remedy, .. } => {
            let option = match name.as_str() {
                "outer_radius_m" => "outer-diameter-m".to_owned(),
                "inner_radius_m" => "wall-m".to_owned(),
                other => other.replace('_', "-"),
            };
            CliError::Usage(format!("--{option}: {problem}\n  remedy: {remedy}"))
        }
        other => other.into(),
    }
}
