//! What changes a scene on the command line: `--set` and `--law`.

use clap::Args;
use smam::scene::Override;

use super::CliError;

/// Changes of the scene that a command loads.
#[derive(Args)]
pub struct Changes {
    /// Change a key of the scene, or a calibrated parameter; may be given several times
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Add a law of your own: 'PORT adds EXPRESSION' or 'PORT scales EXPRESSION' (see `smam laws`); may be given several times
    #[arg(long, value_name = "LAW")]
    law: Vec<String>,
}

impl Changes {
    /// Laws first: --set can change what they brought.
    pub fn overrides(&self) -> Result<Vec<Override>, CliError> {
        let mut overrides = laws(&self.law)?;
        for text in &self.set {
            overrides.push(Override::parse(text)?);
        }
        Ok(overrides)
    }
}

/// The laws of --law; they are called law_1, law_2 and so on.
pub fn laws(texts: &[String]) -> Result<Vec<Override>, CliError> {
    let named = texts.iter().enumerate().map(|(i, text)| Override::law(text, &format!("law_{}", i + 1)));
    Ok(named.collect::<Result<_, _>>()?)
}
