//! `smam import`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use smam::recording::{
    AlsoGuess, Guess, GuessedColumn, LoadedRun, OpenScene, Recording, RecordingError, RecordingSet, Role,
    SET_FILE_NAME, Sureness, Wanted, guess_sheet, to_toml,
};
use smam::scene::Scene;
use smam::stock;

use super::CliError;
use super::files::{make_folder, write};
use super::import_also::{also_guesses, fill_in_starts, refuse_folders};
use super::import_files::{Described, describe, files};
use super::words::quoted;

/// Arguments of `smam import`.
#[derive(Args)]
#[command(after_help = "Examples:
  smam import rig/monday --scene muscle_bench      every table in the folder; writes rig/monday/recordings.toml
  smam import sine.txt step.txt --scene my.toml    two files of one kind
  smam import pull.csv --also camera.csv --scene my.toml    a run whose motion a camera wrote, by its own clock")]
pub struct ImportArguments {
    /// Files of one kind (CSV, text, .lvm, .xlsx, .parquet), or their folder
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// The scene whose channels the columns are [default: the stock scene whose channels they are called after]
    #[arg(long)]
    scene: Option<String>,
    /// Sheet of the workbooks [default: the first]
    #[arg(long, value_name = "NAME")]
    sheet: Option<String>,
    /// A further file of each run, in their order: what a camera or a second logger wrote, with a clock of its own
    #[arg(long, value_name = "FILE", num_args = 1..)]
    also: Vec<PathBuf>,
    /// Where to write recordings.toml [default: the files' folder]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Write over a recordings.toml that is there
    #[arg(long)]
    force: bool,
}

/// Runs the command. Exit code 1 when what was written has to be completed before it can be read.
pub fn import(arguments: &ImportArguments) -> Result<ExitCode, CliError> {
    refuse_folders(&arguments.also, &arguments.files)?;
    let files = files(&arguments.files)?;
    let folder = arguments.out.clone().unwrap_or_else(|| folder_of(&files[0].path));
    let written = folder.join(SET_FILE_NAME);
    if written.exists() && !arguments.force {
        return Err(CliError::Usage(format!(
            "{}: is there already\n  remedy: add --force to write over it, or --out DIR to write elsewhere",
            written.display()
        )));
    }
    let sheet = arguments.sheet.as_deref();
    if let Some(name) = sheet.filter(|name| files.iter().all(|file| file.sheet(Some(name)).is_none())) {
        let message = format!("--sheet {name}: none of the files is a workbook");
        return Err(CliError::Usage(format!(
            "{message}\n  remedy: leave --sheet out, or name a file that ends in .xlsx"
        )));
    }
    let (scene, channels) = scene_of_any(arguments.scene.as_deref(), &files, sheet)?;
    let Described { guesses, left_out } = describe(&files, sheet, &channels)?;
    let mut also = also_guesses(&arguments.also, &guesses, &channels)?;
    guesses.iter().chain(also.iter().map(|also| &also.guess)).for_each(say_guess);
    left_out.iter().for_each(|file| eprintln!("left out: {}", file.why));
    make_folder(&folder)?;
    let scene = scene_from(&folder, &scene);
    let text_with = |also: &[AlsoGuess]| {
        to_toml(&guesses, also, OpenScene { name: &scene, channels: &channels }, &|file| called(file, &folder))
    };
    let mut text = text_with(&also);
    fill_in_starts(&mut also, &text, &written);
    text = text_with(&also);
    left_out.iter().for_each(|file| text += &file.comment());
    write(&written, &text)?;
    say!("written: {}", written.display());
    let all = std::iter::once(&guesses[0]).chain(also.first().map(|also| &also.guess));
    let open: Vec<String> = all.clone().flat_map(open_points).collect();
    if !open.is_empty() {
        open.iter().for_each(|point| eprintln!("not complete: {}: {point}", written.display()));
        return Ok(ExitCode::from(1));
    }
    let missing = absent_input(&all.collect::<Vec<_>>(), &channels);
    Ok(match (read_back(&written), missing) {
        (Ok(()), Some(input)) => {
            eprintln!(
                "not complete: no column is like the input {}: its lines stand in {}, to be filled in",
                input.column,
                written.display()
            );
            ExitCode::from(1)
        }
        (Ok(()), None) => {
            say!("next: smam compare {}", quoted(&folder));
            ExitCode::SUCCESS
        }
        (Err(why), _) => {
            eprintln!("not complete: {why}");
            ExitCode::from(1)
        }
    })
}

/// The recordings of a folder; or of one file, described by what it looks like. What is not sure is said.
pub fn recordings(path: &Path, named: Option<&str>) -> Result<RecordingSet, CliError> {
    if !path.is_file() || path.extension().is_some_and(|e| e == "toml") {
        return Ok(RecordingSet::load(path)?);
    }
    let (scene, channels) = scene(named, path, None)?;
    let found = guess_sheet(path, None, &channels)?;
    let sayings = found.said.iter().map(|said| (said.sureness, said.what.clone()));
    let named = found
        .columns
        .iter()
        .filter_map(|c| c.channel.as_ref().map(|(w, s)| (*s, format!("\"{}\" is {}", c.name, w.column))));
    for (sureness, what) in sayings.chain(named).filter(|(sureness, _)| *sureness != Sureness::Sure) {
        eprintln!("note: {}: {} ({})", path.display(), what, sureness.word());
    }
    let folder = folder_of(path);
    if let Some(input) = absent_input(&[&found], &channels) {
        return Err(CliError::Usage(format!(
            "{}: no column is like the input {} of the scene {scene} (found: {})\n  remedy: name the column so; or run `smam import` on \
             the file and fill in what it could not know",
            path.display(),
            input.column,
            found.columns.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(", ")
        )));
    }
    if let [first, ..] = open_points(&found).as_slice() {
        return Err(CliError::Usage(format!(
            "{}: {first}\n  remedy: run `smam import` on the file and fill in what it could not know",
            path.display()
        )));
    }
    let scene = scene_from(&folder, &scene);
    let text = to_toml(&[found], &[], OpenScene { name: &scene, channels: &channels }, &|file| called(file, &folder));
    Ok(RecordingSet::parse(&text, &folder.join(SET_FILE_NAME))?)
}

/// Columns whose numbers cannot be read before a user says how: each with what has to be filled in.
fn open_points(found: &Guess) -> Vec<String> {
    let point = |column: &GuessedColumn| {
        let (wanted, _) = column.channel.as_ref()?;
        Some(format!(
            "fill in scale of {}: {}, for the column \"{}\"",
            wanted.column,
            column.open_point()?,
            column.name
        ))
    };
    found.columns.iter().filter_map(point).collect()
}

/// An input of the scene that no column was found for.
fn absent_input<'a>(found: &[&Guess], channels: &'a [Wanted]) -> Option<&'a Wanted> {
    let columns = found.iter().flat_map(|guess| &guess.columns);
    let is_found = |w: &Wanted| columns.clone().any(|c| c.channel.as_ref().is_some_and(|(f, _)| f == w));
    channels.iter().find(|w| w.role == Role::Input && !is_found(w))
}

fn folder_of(file: &Path) -> PathBuf {
    file.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned()
}

/// How recordings.toml calls a file: by its name where it lies beside, else by its whole path.
fn called(file: &Path, folder: &Path) -> String {
    let name = file.file_name().map(|name| name.to_string_lossy().into_owned());
    match name {
        Some(name) if folder_of(file) == folder => name,
        _ => file.canonicalize().unwrap_or_else(|_| file.to_owned()).display().to_string(),
    }
}

/// How a `recordings.toml` in a folder calls a scene: a path from there, or a stock name.
fn scene_from(folder: &Path, name: &str) -> String {
    let given = Path::new(name);
    let whole = given.canonicalize().ok().filter(|path| given.is_relative() && path.is_file());
    let (Some(scene), Ok(folder)) = (whole, folder.canonicalize()) else { return name.to_owned() };
    let same = scene.components().zip(folder.components()).take_while(|(a, b)| a == b).count();
    let up = folder.components().skip(same).map(|_| "..".into());
    let down = scene.components().skip(same).map(|c| c.as_os_str().to_string_lossy().into_owned());
    up.chain(down).collect::<Vec<String>>().join("/")
}

/// The scene of the first file that says which it is.
fn scene_of_any(
    named: Option<&str>,
    files: &[super::import_files::Given],
    sheet: Option<&str>,
) -> Result<(String, Vec<Wanted>), CliError> {
    let mut tried = files.iter().map(|file| scene(named, &file.path, file.sheet(sheet)));
    let first = tried.next().unwrap_or_else(|| Err(CliError::Usage("no file is given".to_owned())));
    first.or_else(|why| tried.find_map(Result::ok).ok_or(why))
}

/// The scene's name and its channels.
fn scene(named: Option<&str>, file: &Path, sheet: Option<&str>) -> Result<(String, Vec<Wanted>), CliError> {
    if let Some(name) = named {
        return Ok((name.to_owned(), channels(&Scene::load(name, &[])?)));
    }
    for name in stock::scenes() {
        let channels = channels(&Scene::load(name, &[])?);
        let found = guess_sheet(file, sheet, &channels)?;
        let is_there =
            |wanted: &Wanted| found.columns.iter().any(|c| c.channel == Some((wanted.clone(), Sureness::Sure)));
        let of = |role: Role| channels.iter().filter(move |c| c.role == role);
        if of(Role::Input).all(is_there) && of(Role::Output).any(is_there) {
            return Ok((name.to_owned(), channels));
        }
    }
    Err(CliError::Usage(format!(
        "{}: its columns are called after no stock scene's channels\n  remedy: name the scene: --scene muscle_bench (`smam scenes` lists them)",
        file.display()
    )))
}

fn channels(scene: &Scene) -> Vec<Wanted> {
    let wanted = |column: &String, role| Wanted { column: column.clone(), role };
    let inputs = scene.file.input.iter().map(|i| wanted(&i.channel, Role::Input));
    inputs.chain(scene.file.output.iter().map(|o| wanted(&o.channel, Role::Output))).collect()
}

fn say_guess(guess: &Guess) {
    say!("{}", guess.file.display());
    guess.first_rows.iter().for_each(|row| say!("  | {}", row.join(" | ")));
    guess.said.iter().for_each(|said| say!("  {:<8} {}", said.sureness.word(), said.what));
    for column in &guess.columns {
        let unit = column.unit.map_or(String::new(), |unit| format!(" in {}", unit.name));
        match &column.channel {
            Some((wanted, sureness)) => say!("  {:<8} \"{}\"{unit} is {}", sureness.word(), column.name, wanted.column),
            None => say!("  {:<8} \"{}\"{unit} is no channel of the scene", Sureness::Assumed.word(), column.name),
        }
    }
}

/// Reads what was written, as every command will, and shows the first rows as they are understood.
fn read_back(written: &Path) -> Result<(), RecordingError> {
    let set = RecordingSet::load(written)?;
    for run in &set.runs {
        for (index, LoadedRun { recording, notes }) in set.load_parts(run)?.iter().enumerate() {
            if index == 0 {
                say!("{}: {} rows, read as", run.file, recording.sample_count());
                say_rows(recording, &set);
            }
            notes.iter().for_each(|note| eprintln!("note: {}: {note}", run.file));
        }
    }
    Ok(())
}

fn say_rows(recording: &Recording, set: &RecordingSet) {
    let declared: Vec<&str> =
        set.channels.iter().map(|c| c.column.as_str()).filter(|c| recording.find(c).is_some()).collect();
    let width = |column: &str| column.len().max(12);
    let head: Vec<String> = declared.iter().map(|column| format!("{column:>0$}", width(column))).collect();
    say!("  {:>10} {}", "time_s", head.join(" "));
    for row in 0..recording.sample_count().min(3) {
        let value = |column: &&str| {
            let value = recording.find(column).map_or(f64::NAN, |channel| channel.values[row]);
            format!("{value:>0$.5}", width(column))
        };
        let cells: Vec<String> = declared.iter().map(value).collect();
        say!("  {:>10.4} {}", recording.time_s()[row], cells.join(" "));
    }
}
