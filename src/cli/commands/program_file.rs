//! A pixel program in a file of its own, in any of the languages that a scene takes: read by the scene front end, as the program of a draw.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use ninebit::limits::Limits;
use ninebit::plan::Plan;
use ninebit::shown;
use ninebit::state::{Named, Profile, Scene};
use ninebit_files::read::{self, Kind};
use ninebit_program::pixel_shader::{self, TextureOperation};

use super::{Context, Failure, Template};

/// What a program is written in.
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
    /// What a scene calls it.
    fn variant(self) -> &'static str {
        match self {
            Language::Combiners => "CombinerText",
            Language::Registers => "RegisterWords",
            Language::CombinerCalls => "CombinerCalls",
            Language::TextureStages => "TextureStages",
            Language::TextureEnvironment => "TextureEnvironment",
            Language::PixelShader => "PixelShader",
        }
    }

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
        let name = path.file_name().and_then(|name| name.to_str()).ok_or_else(|| {
            let help = "give the program's file a name in UTF-8";
            Failure::usage(format!("`{}` cannot be named in a scene", shown::path(path)), help)
        })?;
        let units = self.profile.texture_units();
        let mut cubes = vec![false; units];
        if language == Language::PixelShader {
            // What is wrong with the file is the front end's to say.
            let bytes = read::bytes(path, Kind::Regular, Limits::default().program_file()).unwrap_or_default();
            let textures = pixel_shader::parse(&String::from_utf8_lossy(&bytes)).map(|parsed| parsed.program.textures);
            for texture in textures.into_iter().flatten() {
                use TextureOperation::{Texm3x3spec, Texm3x3tex, Texm3x3vspec};
                if let Some(cube) = cubes.get_mut(usize::from(texture.unit.value)) {
                    *cube = matches!(texture.operation, Texm3x3tex | Texm3x3spec | Texm3x3vspec);
                }
            }
        }
        let solid = "Solid(width: 1, height: 1, color: (255, 255, 255))";
        let faces: String = ["positive_x", "negative_x", "positive_y", "negative_y", "positive_z", "negative_z"]
            .iter()
            .map(|face| format!("{face}: {solid}, "))
            .collect();
        let bound: Vec<&str> = cubes.iter().map(|cube| if *cube { "\"cube\"" } else { "\"plane\"" }).collect();
        let template = Template {
            scene: format!("    textures: {{ \"plane\": (source: {solid}), \"cube\": (source: Faces({faces})) }},\n"),
            draw: format!(
                "        textures: [{}],\n        program: {}(file: {name:?}),\n",
                bound.join(", "),
                language.variant()
            ),
            note: Some("`--profile nv10` or `nv2a` chooses the chip, `--from` the language"),
            folder: path.parent().map_or_else(PathBuf::new, Path::to_path_buf),
            ..Template::default()
        };
        template.read(self.profile, context)
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
