//! The command `ninebit lower`: a program as a function of another language.

use super::*;

use ninebit::plan::PlanOptions;
use ninebit::state::Named as _;
use ninebit_files::output::write_below;
use ninebit_lower::{
    self as lower, Function, Generic, Language, NamedFunction, Options, Setup, Shaders, Sources, Textures,
};
use ninebit_program::{registers, text};
use ninebit_scene::register_words;

use super::scene::chosen_draws;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The scene file, or a pixel program in a file of its own
    #[arg(value_name = "SCENE|PROGRAM", required_unless_present = "generic")]
    source: Option<PathBuf>,
    /// C99, GLSL: one text for every program, which reads the words of the registers of `--profile` while it runs; Verilog: a module for each step of a pixel. With `--whole`, C99, GLSL, WGSL: one text for every draw
    #[arg(long, conflicts_with_all = ["source", "language", "draw", "uniform", "textures", "fragment"])]
    generic: bool,
    /// With `--generic --to c99`: write ninebit_combiners.h and ninebit_combiners.c, or with `--whole` ninebit_pixels.h and ninebit_pixels.c, to this folder; without it, one text of both goes to stdout. With `--whole --to glsl`: write a vertex and a fragment shader for each draw, drawN.vert and drawN.frag, or with `--generic` for every draw, ninebit_pixels.vert and ninebit_pixels.frag
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    #[command(flatten)]
    program: ProgramArguments,
    #[command(flatten)]
    state: StateArguments,
    /// Only this draw, numbered from 0
    #[arg(long, value_name = "N")]
    draw: Option<usize>,
    /// The form
    #[arg(long, value_enum, value_name = "FORM")]
    to: Form,
    /// Functions: constants of the draw are given, so that one text serves every draw that differs in nothing else
    #[arg(long)]
    uniform: bool,
    /// Functions of a scene's draws: what is given of textures
    #[arg(long, value_enum, value_name = "FORM", default_value_t = TextureInput::Registers)]
    textures: TextureInput,
    /// C99, GLSL, WGSL: a scene's draws from the place of a pixel, the constants of its triangle and the memories of textures to the stored words
    #[arg(long, conflicts_with_all = ["uniform", "textures", "fragment"])]
    whole: bool,
    /// Functions of a scene's draws: end with the fragment, before alpha test, blend and store. A program alone always does
    #[arg(long)]
    fragment: bool,
}

/// Forms of programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Form {
    /// The combiner language
    Combiners,
    /// Words of the registers of the scene's chip, as a scene has them
    Registers,
    /// A function of C99 for each draw, integers only
    C99,
    /// A function of GLSL 3.30 and GLSL ES 3.00
    Glsl,
    /// A function of WGSL
    Wgsl,
    /// A combinational module of Verilog-2001
    Verilog,
}

/// What functions are given of textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum TextureInput {
    /// What each unit yields
    Registers,
    /// Fetched words and weights: the filter is part of the function
    Words,
}

impl Form {
    /// Returns the language of its functions, or `None` if the form has no functions.
    fn language(self) -> Option<Language> {
        match self {
            Form::Combiners | Form::Registers => None,
            Form::C99 => Some(Language::C99),
            Form::Glsl => Some(Language::Glsl),
            Form::Wgsl => Some(Language::Wgsl),
            Form::Verilog => Some(Language::Verilog),
        }
    }
}

/// Prints programs in another form.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let Some(path) = &arguments.source else { return generic(arguments) };
    let alone = arguments.program.language(path).is_some();
    let scene = arguments.program.scene(path, &arguments.state, context)?;
    let draws = chosen_draws(&scene, arguments.draw)?;
    if arguments.whole {
        return whole(arguments, path, &scene, &draws, alone);
    }
    if arguments.output.is_some() {
        let help = "leave `--output` out and take the text from stdout, or add `--whole --to glsl`";
        return Err(Failure::usage("`--output` is for texts of several files".to_string(), help));
    }
    let out = match arguments.to.language() {
        Some(language) => functions(arguments, path, language, &scene, &draws, alone)?,
        None => programs(arguments, &scene, &draws, alone),
    };
    Ok(write_text(&out)?)
}

/// Prints or writes the generic text.
fn generic(arguments: &Arguments) -> Result<(), Failure> {
    let text = Generic { chip: arguments.program.profile, policies: arguments.state.policies()? };
    let c99 = || if arguments.whole { text.whole_c99() } else { text.c99() };
    match (arguments.to, &arguments.output) {
        (Form::C99, Some(folder)) => {
            let Sources { header, source, name } = c99();
            write_below(&folder.join(format!("{name}.h")), header.as_bytes())?;
            Ok(write_below(&folder.join(format!("{name}.c")), source.as_bytes())?)
        }
        (Form::C99, None) => Ok(write_text(&c99().whole())?),
        (Form::Glsl, Some(folder)) if arguments.whole => {
            let Shaders { vertex, fragment } = text.whole_shaders();
            write_below(&folder.join("ninebit_pixels.vert"), vertex.as_bytes())?;
            Ok(write_below(&folder.join("ninebit_pixels.frag"), fragment.as_bytes())?)
        }
        (Form::Glsl, None) if arguments.whole => Ok(write_text(&text.whole_glsl())?),
        (Form::Wgsl, None) if arguments.whole => Ok(write_text(&text.whole_wgsl())?),
        (Form::Verilog, _) if arguments.whole => Err(Failure::usage(
            "there is no generic text of whole pixels of this form".to_string(),
            "take `--to c99`, `--to glsl` or `--to wgsl`, or leave `--whole` or `--generic` out",
        )),
        (Form::Glsl, None) => Ok(write_text(&text.glsl())?),
        (Form::Verilog, None) => Ok(write_text(&text.verilog())?),
        (Form::Glsl | Form::Verilog, Some(_)) => Err(no_files()),
        (Form::Wgsl, Some(_)) if arguments.whole => Err(no_files()),
        _ => Err(Failure::usage(
            "there is no generic text of this form".to_string(),
            "take `--to c99`, `--to glsl` or `--to verilog`; every other form needs a scene or a program",
        )),
    }
}

/// Returns the failure for a text that is one file.
fn no_files() -> Failure {
    Failure::usage(
        "`--output` is for texts of several files".to_string(),
        "this is one text: leave `--output` out and take it from stdout",
    )
}

/// Returns the programs of draws as text or as register words.
fn programs(arguments: &Arguments, scene: &Scene, draws: &[(usize, &Draw)], alone: bool) -> String {
    let mut out = String::new();
    for (number, draw) in draws {
        if !out.is_empty() {
            out.push('\n');
        }
        if !alone {
            // The name may be any text, so it is not written in a comment that it could end.
            out.push_str(&format!("// draw {number} `{}`\n", shown::name(&draw.name)));
        }
        if let Some(program) = &draw.vertex_program {
            let counts = format!("{} instructions, {} slots", program.instructions, program.slots);
            out.push_str(&format!("// its vertices come from a vertex program: {counts}\n"));
        }
        if arguments.to == Form::Combiners {
            out.push_str(&text::print(&draw.combiners));
        } else {
            out.push_str(&register_words(&registers::encode(&draw.combiners, scene.profile)));
            out.push('\n');
        }
    }
    out
}

/// Prints draws as functions of whole pixels, or writes shaders.
fn whole(
    arguments: &Arguments,
    path: &Path,
    scene: &Scene,
    draws: &[(usize, &Draw)],
    alone: bool,
) -> Result<(), Failure> {
    if alone {
        return Err(Failure::usage(
            format!("{} is a program alone, which has no pixels", shown::path(path)),
            "leave `--whole` out, or name a scene",
        ));
    }
    let options = Options { policies: arguments.state.policies()?, ..Options::default() };
    let plan = compiled(scene, PlanOptions { policies: options.policies, prune: true })?;
    let mut made = Vec::new();
    for (number, draw) in draws {
        refuse_unprinted(*number, &plan, arguments.output.is_none())?;
        let function = Function::of_pixel(scene, &plan, *number, &options);
        let setup = Setup::new(&plan, &plan.draws()[*number], &function);
        made.push((*number, shown::name(&draw.name), function, setup));
    }
    let drawn: Vec<_> = made
        .iter()
        .map(|(number, name, function, setup)| lower::Draw {
            name: format!("ninebit_draw{number}"),
            about: format!("draw {number} `{name}`"),
            function,
            setup,
        })
        .collect();
    match (arguments.to, &arguments.output) {
        (Form::Glsl, Some(folder)) => {
            for ((number, ..), draw) in made.iter().zip(&drawn) {
                let Shaders { vertex, fragment } = Shaders::new(draw);
                write_below(&folder.join(format!("draw{number}.vert")), vertex.as_bytes())?;
                write_below(&folder.join(format!("draw{number}.frag")), fragment.as_bytes())?;
            }
            Ok(())
        }
        (_, Some(_)) => Err(Failure::usage(
            "`--output` is for the shaders of GLSL".to_string(),
            "leave `--output` out and take the text from stdout, or take `--to glsl`",
        )),
        (form, None) => {
            let text = form.language().and_then(|language| language.print_whole(&drawn)).ok_or_else(|| {
                Failure::usage(
                    "whole pixels are not printed in this form".to_string(),
                    "take `--to c99`, `--to glsl` or `--to wgsl`",
                )
            })?;
            Ok(write_text(&text)?)
        }
    }
}

fn compiled(scene: &Scene, options: PlanOptions) -> Result<Plan, Failure> {
    Plan::compile(scene, &options).map_err(|errors| {
        let message = errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ");
        Failure::invalid("NB0322", message, "`ninebit check` says where")
    })
}

/// Refuses a draw that is [not printed](lower::unprinted).
fn refuse_unprinted(number: usize, plan: &Plan, is_own: bool) -> Result<(), Failure> {
    let Some(part) = lower::unprinted(&plan.draws()[number], is_own) else { return Ok(()) };
    let [part, help] = part.words();
    let message = format!("the {part} of draw {number} are not printed");
    Err(Failure::invalid("NB0402", message, format!("{help}, or print its `--fragment`")))
}

/// Returns draws, or a program of its own, as functions.
fn functions(
    arguments: &Arguments,
    path: &Path,
    language: Language,
    scene: &Scene,
    draws: &[(usize, &Draw)],
    alone: bool,
) -> Result<String, Failure> {
    let options = Options {
        policies: arguments.state.policies()?,
        uniform: arguments.uniform,
        textures: if arguments.textures == TextureInput::Words { Textures::Words } else { Textures::Registers },
        fragment: arguments.fragment,
    };
    // Nothing is pruned: with `--uniform` other constants may be passed.
    let plan = compiled(scene, PlanOptions { policies: options.policies, prune: false })?;
    if !(alone || arguments.fragment) {
        draws.iter().try_for_each(|(number, _)| refuse_unprinted(*number, &plan, false))?;
    }
    let made = |(number, draw): &(usize, &Draw)| {
        if alone {
            let about = format!("{} on {}", shown::path(path), scene.profile.name());
            let function = Function::of_program(&draw.combiners, &options);
            return ("ninebit_program".to_string(), about, function);
        }
        let about = format!("draw {number} `{}`", shown::name(&draw.name));
        let function = Function::of_draw(scene, draw, &plan.draws()[*number], &options);
        (format!("ninebit_draw{number}"), about, function)
    };
    let made: Vec<(String, String, Function)> = draws.iter().map(made).collect();
    let named =
        made.iter().map(|(name, about, function)| NamedFunction { name: name.clone(), about: about.clone(), function });
    Ok(language.print(&named.collect::<Vec<_>>()))
}
