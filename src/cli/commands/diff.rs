//! The command `ninebit diff`: how two pictures differ, and traces of a pixel side by side.

mod report;

use super::*;

use ninebit::engine::{self, FRAGMENTS, PixelTrace};
use ninebit_scene::diff::{self, Difference, Options};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The first picture, PNG or TGA, or depths that `render --depth` wrote as PNG: R is then the upper byte, G the lower
    #[arg(value_name = "A.png")]
    a: PathBuf,
    /// The second picture; differences are B - A
    #[arg(value_name = "B.png")]
    b: PathBuf,
    /// Compare red, green and blue only: screenshots often have no alpha, which counts as 255
    #[arg(long)]
    ignore_alpha: bool,
    /// The most regions to list, the largest ones
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = up_to::<MAXIMUM_REGIONS>)]
    regions: usize,
    /// The scene that the pictures show: compare both with its frame, trace the first pixel of each listed region
    #[arg(long, value_name = "SCENE")]
    scene: Option<PathBuf>,
    /// Which render target of the scene [default: the scene's first]
    #[arg(long, value_name = "NAME", requires = "scene")]
    target: Option<String>,
    #[command(flatten)]
    state: StateArguments,
    #[command(flatten)]
    work: WorkArguments,
    /// How to print the result
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = Format::Text)]
    format: Format,
    /// Draw the difference: amplified where the pictures differ, a dark grey A where they do not
    #[arg(short, long, value_name = "DIFF.png", value_parser = picture::output("png"))]
    output: Option<Destination>,
}

/// Maximum of `--regions`.
const MAXIMUM_REGIONS: usize = 1000;

/// Content of the report.
struct Findings<'a> {
    arguments: &'a Arguments,
    difference: Difference,
    scene: Option<SceneFindings<'a>>,
    /// Path of the difference picture, and its amplification.
    picture: Option<(String, u8)>,
}

/// Findings about the scene.
struct SceneFindings<'a> {
    path: &'a Path,
    plan: Plan,
    target: String,
    /// Numbers of pixels in which A and B differ from the scene's frame.
    different: [u64; 2],
    /// Traces of the first pixel of each listed region.
    traces: Vec<PixelTrace>,
}

/// Compares two pictures.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    if arguments.scene.is_none() && !arguments.state.is_empty() {
        return Err(Failure::usage(
            "`--policy` and `--set` have no effect without a scene",
            "name the scene with `--scene SCENE`",
        ));
    }
    let destination = arguments.output.as_ref();
    picture::beside_report(destination)?;
    let limits = ImageLimits::default();
    let ((a, of_depths), (b, other)) =
        (image::load_words(&arguments.a, &limits)?, image::load_words(&arguments.b, &limits)?);
    if of_depths != other {
        let help = "compare two pictures, or two depth buffers that `ninebit render --depth` wrote as PNG";
        return Err(Failure::invalid("NB0521", "one file has colours, the other words of 16 bits".to_owned(), help));
    }
    let options = Options { ignore_alpha: arguments.ignore_alpha, regions: arguments.regions };
    let difference = diff::compare(&a, &b, &options).map_err(|_| different_sizes(arguments, &a, &b))?;
    let scene = arguments.scene.as_deref();
    let scene =
        scene.map(|path| scene_findings(path, arguments, [&a, &b], of_depths, &difference, context)).transpose()?;
    let picture = destination.map(|destination| draw(destination, arguments, &a, &b)).transpose()?;
    let findings = Findings { arguments, difference, scene, picture };
    arguments.format.print(|| report::text(&findings), || format!("{:#}", report::json(&findings)))?;
    if findings.difference.different == 0 { Ok(()) } else { Err(Failure::difference()) }
}

/// Renders the scene, compares both pictures with its frame, and traces the first pixels of the regions.
fn scene_findings<'a>(
    path: &'a Path,
    arguments: &Arguments,
    pictures: [&Rgba; 2],
    of_depths: bool,
    difference: &Difference,
    context: Context,
) -> Result<SceneFindings<'a>, Failure> {
    let (scene, plan) = load_to_draw(path, &arguments.state, arguments.work, context)?;
    let target = chosen_target(&scene, arguments.target.as_deref())?;
    let name = scene.targets[target].name.clone();
    let (width, height) = (scene.targets[target].width, scene.targets[target].height);
    let other_size = || {
        let (columns, rows, path) = (difference.width, difference.height, shown::path(path));
        let message = format!("target `{name}` of `{path}` is {width} x {height}, the pictures are {columns} x {rows}");
        Failure::invalid("NB0522", message, "choose the target that they show with `--target`, or change its size")
    };
    if (width, height) != (difference.width, difference.height) {
        return Err(other_size());
    }
    let mut frames = engine::render(&plan, &RenderOptions { threads: 0, ..RenderOptions::default() });
    let surface = frames.surfaces.swap_remove(target);
    let pixels = match scene.targets[target].depth {
        _ if !of_depths => surface.rgba8(),
        Some(depth) => picture::upper_depths(&surface, depth.format).into_iter().map(image::pixel_of_word).collect(),
        None => {
            let help = "leave out `--scene`, or choose a target that has one with `--target`";
            return Err(Failure::invalid("NB0522", format!("target `{name}` has no depth buffer"), help));
        }
    };
    let frame = Rgba::new(width, pixels);
    let mut different = [0; 2];
    for (count, picture) in different.iter_mut().zip(pictures) {
        *count = diff::count(picture, &frame, arguments.ignore_alpha).map_err(|_| other_size())?;
    }
    // The pixels are inside the target, which has the pictures' size.
    let fragments = (FRAGMENTS / difference.regions.len().max(1) as u64).max(1);
    let trace = |first| engine::trace_last(&plan, target, first, None, fragments).ok();
    let traces = difference.regions.iter().filter_map(|region| trace(region.first)).collect();
    Ok(SceneFindings { path, plan, target: name, different, traces })
}

/// Writes the difference picture. Returns its path and amplification.
fn draw(destination: &Destination, arguments: &Arguments, a: &Rgba, b: &Rgba) -> Result<(String, u8), Failure> {
    let drawn = diff::highlight(a, b, arguments.ignore_alpha).map_err(|_| different_sizes(arguments, a, b))?;
    let picture = &drawn.picture;
    destination.write(&encode_png(picture.width(), picture.height(), picture.pixels(), Compression::Fast)?)?;
    Ok((destination.path().map_or(String::new(), shown::lossless), drawn.scale))
}

fn different_sizes(arguments: &Arguments, a: &Rgba, b: &Rgba) -> Failure {
    let of =
        |path: &Path, picture: &Rgba| format!("`{}` is {} x {}", shown::path(path), picture.width(), picture.height());
    let message = format!("the pictures differ in size: {}, {}", of(&arguments.a, a), of(&arguments.b, b));
    Failure::invalid("NB0521", message, "compare pictures of one size: take the screenshot unscaled, or crop it")
}
