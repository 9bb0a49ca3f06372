//! Reads a pixel program from a file of its own, in any of the languages that scenes support.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use ninebit::limits::{FileLimit, LOG, Limits};
use ninebit::plan::Plan;
use ninebit::state::{Named, Profile, Scene};
use ninebit_files::read::{Kind, ReadError, bytes};
use ninebit_methods::import::combiner_words;
use ninebit_scene::assets::{Assets, Folder};
use ninebit_scene::path::PathError;
use ninebit_scene::{ProgramLanguage, load_program_with};

use super::scene::{StateArguments, load, refused_beside};
use super::{Context, Exit, Failure, Report};

/// Returns the language that a file's extension implies.
fn language_of(path: &Path) -> Option<ProgramLanguage> {
    match path.extension()?.to_str()? {
        "rc" => Some(ProgramLanguage::Combiners),
        "words" | "psdef" | "log" => Some(ProgramLanguage::Registers),
        "psh" | "ps" => Some(ProgramLanguage::PixelShader),
        _ => None,
    }
}

/// Files of programs; in place of a log of methods, the register words of the combiners that it leaves set.
#[derive(Debug)]
struct Logs(Profile);

impl Assets for Logs {
    fn resolve(&self, folder: &Path, name: &str) -> Result<PathBuf, PathError> {
        Folder.resolve(folder, name)
    }

    fn bytes(&self, file: &Path, limit: FileLimit) -> Result<Vec<u8>, ReadError> {
        let whole = bytes(file, Kind::Stream, FileLimit { bytes: LARGEST_LOG, ..LOG })?;
        match combiner_words(&whole, self.0) {
            Some(words) => Ok(words.into_bytes()),
            None if whole.len() as u64 > limit.bytes => Err(ReadError::TooLarge(limit)),
            None => Ok(whole),
        }
    }
}

/// Most bytes of a log that is a program. It is in memory whole.
const LARGEST_LOG: u64 = 256 << 20;

fn languages() -> impl TypedValueParser<Value = ProgramLanguage> {
    let all = ProgramLanguage::ALL.iter().map(|language| PossibleValue::new(language.name()).help(language.about()));
    PossibleValuesParser::new(all).try_map(|name| super::named(&name))
}

/// Arguments for a file that may be a scene or a program.
#[derive(Debug, Args)]
pub(crate) struct ProgramArguments {
    /// The file is a program in this language. Without it `.rc`, `.words`, `.log`, `.psdef` and `.psh` say so by themselves, and everything else is a scene
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
        let loaded = load_program_with(path, language, self.profile, &Limits::default(), &Logs(self.profile));
        loaded.map_err(|error| refused_beside(error, note, context))
    }

    /// Reads the scene, or the program where the file is one.
    pub(crate) fn scene(&self, path: &Path, state: &StateArguments, context: Context) -> Result<Scene, Failure> {
        match self.language(path) {
            Some(language) => Ok(self.read(path, language, context)?.0),
            None => match load(path, state, context) {
                Ok((scene, _)) => Ok(scene),
                Err(failure) => Err(read_as_scene(path, failure, context)),
            },
        }
    }
}

/// Says of a refused file whose name does not say that it is a scene how it would be read as a program.
fn read_as_scene(path: &Path, failure: Failure, context: Context) -> Failure {
    match failure.report {
        Report::Scene(error)
            if failure.exit == Exit::Invalid && path.extension().is_none_or(|ending| ending != "ron") =>
        {
            let languages: Vec<&str> = ProgramLanguage::ALL.iter().map(|language| language.name()).collect();
            let note = format!("it was read as a scene; `--from` reads it as a program: {}", languages.join(", "));
            refused_beside(*error, &note, context)
        }
        _ => failure,
    }
}
