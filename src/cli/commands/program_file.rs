//! A pixel program in a file of its own, in any of the languages that a scene takes.

use std::path::Path;

use clap::{Args, ValueEnum};
use ninebit::limits::Limits;
use ninebit::plan::Plan;
use ninebit::state::{Named, Profile, Scene};
use ninebit_scene::{ProgramLanguage, load_program};

use super::scene::refused_beside;
use super::{Context, Failure};

/// What a program is written in, as the command line calls it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Language {
    /// The combiner language
    Combiners,
    /// Register words: names or methods with their words
    Registers,
    /// Calls of NV_register_combiners
    CombinerCalls,
    /// Calls or effect states of Direct3D's texture stages
    TextureStages,
    /// Calls of OpenGL's texture environment
    TextureEnvironment,
    /// A Direct3D pixel shader, ps.1.1
    PixelShader,
}

impl Language {
    /// The language of files of that name.
    fn of(path: &Path) -> Option<Language> {
        match path.extension()?.to_str()? {
            "rc" => Some(Language::Combiners),
            "words" | "psdef" => Some(Language::Registers),
            "psh" | "ps" => Some(Language::PixelShader),
            _ => None,
        }
    }
}

impl From<Language> for ProgramLanguage {
    fn from(language: Language) -> Self {
        match language {
            Language::Combiners => ProgramLanguage::Combiners,
            Language::Registers => ProgramLanguage::Registers,
            Language::CombinerCalls => ProgramLanguage::CombinerCalls,
            Language::TextureStages => ProgramLanguage::TextureStages,
            Language::TextureEnvironment => ProgramLanguage::TextureEnvironment,
            Language::PixelShader => ProgramLanguage::PixelShader,
        }
    }
}

/// How a file is read that may be a scene or a program.
#[derive(Debug, Args)]
pub(crate) struct ProgramArguments {
    /// The file is a program in this language. Without it `.rc`, `.words`, `.psdef` and `.psh` say so by themselves, and everything else is a scene
    #[arg(long = "from", value_enum, value_name = "LANGUAGE")]
    language: Option<Language>,
    /// The chip of a program that stands alone: nv10 or nv2a
    #[arg(long, value_name = "PROFILE", default_value = "nv2a", value_parser = super::op::words::profile)]
    profile: Profile,
}

impl ProgramArguments {
    /// The language of a file that is no scene.
    pub(crate) fn language(&self, path: &Path) -> Option<Language> {
        self.language.or_else(|| Language::of(path))
    }

    /// The program as that of the one draw of a scene, whose units all have a texture.
    pub(crate) fn read(&self, path: &Path, language: Language, context: Context) -> Result<(Scene, Plan), Failure> {
        let note = "`--profile nv10` or `nv2a` chooses the chip, `--from` the language";
        let loaded = load_program(path, language.into(), self.profile, &Limits::default());
        loaded.map_err(|error| refused_beside(error, note, context))
    }

    /// The name of the chip.
    pub(crate) fn profile(&self) -> Profile {
        self.profile
    }

    /// Its name.
    pub(crate) fn profile_name(&self) -> &'static str {
        self.profile.name()
    }
}
