//! Reads a pixel program from a file of its own, in any of the languages that scenes support.

use std::path::Path;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use ninebit::limits::Limits;
use ninebit::plan::Plan;
use ninebit::state::{Named, Profile, Scene};
use ninebit_scene::{ProgramLanguage, load_program};

use super::scene::{StateArguments, load, refused_beside};
use super::{Context, Failure};

/// Returns the language that a file's extension implies.
fn language_of(path: &Path) -> Option<ProgramLanguage> {
    match path.extension()?.to_str()? {
        "rc" => Some(ProgramLanguage::Combiners),
        "words" | "psdef" => Some(ProgramLanguage::Registers),
        "psh" | "ps" => Some(ProgramLanguage::PixelShader),
        _ => None,
    }
}

fn languages() -> impl TypedValueParser<Value = ProgramLanguage> {
    let all = ProgramLanguage::ALL.iter().map(|language| PossibleValue::new(language.name()).help(language.about()));
    PossibleValuesParser::new(all).try_map(|name| super::named(&name))
}

/// Arguments for a file that may be a scene or a program.
#[derive(Debug, Args)]
pub(crate) struct ProgramArguments {
    /// The file is a program in this language. Without it `.rc`, `.words`, `.psdef` and `.psh` say so by themselves, and everything else is a scene
    #[arg(long = "from", value_parser = languages(), value_name = "LANGUAGE")]
    language: Option<ProgramLanguage>,
    /// The chip of a program that stands alone: nv10 or nv2a
    #[arg(long, value_name = "PROFILE", default_value = "nv2a", value_parser = super::op::words::profile)]
    pub(crate) profile: Profile,
}

impl ProgramArguments {
    /// Returns the language of a program file, or `None` if the file is a scene.
    pub(crate) fn language(&self, path: &Path) -> Option<ProgramLanguage> {
        self.language.or_else(|| language_of(path))
    }

    /// Reads the program as that of a scene with one draw, whose units all have a texture.
    pub(crate) fn read(
        &self,
        path: &Path,
        language: ProgramLanguage,
        context: Context,
    ) -> Result<(Scene, Plan), Failure> {
        let note = "`--profile nv10` or `nv2a` chooses the chip, `--from` the language";
        let loaded = load_program(path, language, self.profile, &Limits::default());
        loaded.map_err(|error| refused_beside(error, note, context))
    }

    /// Reads the scene, or the program where the file is one.
    pub(crate) fn scene(&self, path: &Path, state: &StateArguments, context: Context) -> Result<Scene, Failure> {
        match self.language(path) {
            Some(language) => Ok(self.read(path, language, context)?.0),
            None => Ok(load(path, state, context)?.0),
        }
    }
}
