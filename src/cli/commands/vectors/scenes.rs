//! Scenes beside the tables of a pack: draws for a card, and the pictures that tell its answers.
//!
//! ```text
//! PACK/scenes/scenes.txt              `scene NAME` a line; those that the program cannot draw behind `#`, with the reason; `root DIGEST` where no pack
//!                                     is beside the scenes
//! PACK/scenes/NAME.scene.txt, .raw    draws (vectors/harness/gl/README.md)
//! PACK/scenes/NAME.png                the picture by the model's default policies
//! PACK/scenes/NAME@RULE=VALUE.png     the picture by another value, where it differs
//! RESULTS/NAME.png, NAME.surface      what the card drew: a picture, or the surface as a console stored it
//! ```

use super::super::scene::refused;
use super::*;

use ninebit::engine::render;
use ninebit::plan::PlanOptions;
use ninebit::state::POLICIES;
use ninebit_files::output::write_below;
use ninebit_files::read::{self, Kind, ReadError};
use ninebit_methods::console::surface;
use ninebit_scene::image::load;
use ninebit_vectors::gpu::scene;

use crate::replay::find;

/// The list of scenes.
const LIST: &str = "scenes.txt";
/// Folder of scenes in a pack.
const FOLDER: &str = "scenes";

/// Writes the scenes of files and folders into a pack. Returns what is told of each.
pub(super) fn export(pack: &Path, places: &[PathBuf], profile: Profile) -> Result<String, Failure> {
    let found = find(places).map_err(|error| Failure::usage(error.to_string(), "name scenes or folders of scenes"))?;
    let place = pack.join(FOLDER);
    let (mut list, mut told) = (List::new(pack), String::new());
    for path in found.iter().map(|entry| &entry.path) {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let loaded = ninebit_scene::load(path, &Limits::default()).map_err(refused)?;
        let written = of_profile(loaded.scene, loaded.plan, profile).and_then(|(scene, plan)| {
            let assemblies: Vec<_> = plan.draws().iter().map(|draw| &draw.assembly).collect();
            scene::scene(&name, &scene, &assemblies).map(|files| (files, plan))
        });
        match written {
            Ok((files, plan)) => {
                let alternatives = list.add(&name, &plan)?;
                write_below(&place.join(format!("{name}.scene.txt")), files.text.as_bytes())?;
                write_below(&place.join(format!("{name}.scene.raw")), &files.raw)?;
                let _ = writeln!(told, "{name:<24}{alternatives:>9} other readings, as a scene");
            }
            Err(reason) => {
                list.leave_out(&name, &reason);
                let _ = writeln!(told, "{name:<24} left out: {reason}");
            }
        }
    }
    list.write()?;
    Ok(told)
}

/// Returns a scene as one of a chip, or the reason why the chip does not have it.
pub(in super::super) fn of_profile(mut scene: Scene, plan: Plan, profile: Profile) -> Result<(Scene, Plan), String> {
    if scene.profile == profile {
        return Ok((scene, plan));
    }
    if profile == Profile::Nv10 {
        return Err("a scene of nv2a".to_owned());
    }
    // A later chip draws the scenes of an earlier one.
    scene.profile = profile;
    match Plan::compile(&scene, &PlanOptions::default()) {
        Ok(plan) => Ok((scene, plan)),
        Err(errors) => Err(errors.first().map_or_else(String::new, |error| error.message.clone())),
    }
}

/// The list of scenes in the making, beside which their pictures are written.
pub(in super::super) struct List {
    place: PathBuf,
    names: Vec<String>,
    lines: String,
}

impl List {
    /// Begins the list of a pack.
    pub(in super::super) fn new(pack: &Path) -> List {
        List { place: pack.join(FOLDER), names: Vec::new(), lines: String::new() }
    }

    /// Adds the digest that answers name.
    pub(in super::super) fn root(&mut self, root: &str) {
        let _ = writeln!(self.lines, "root {root}");
    }

    /// Adds a scene, and writes the picture of the defaults and those of other values that differ. Returns the number of the latter.
    pub(in super::super) fn add(&mut self, name: &str, plan: &Plan) -> Result<usize, Failure> {
        if self.names.iter().any(|other| other == name) {
            let message = format!("two scenes would be called `{}`", shown::name(name));
            return Err(Failure::usage(message, "name one of them, or call one otherwise"));
        }
        self.names.push(name.to_owned());
        let _ = writeln!(self.lines, "scene {name}");
        pictures(&self.place, name, plan)
    }

    /// Adds a scene that cannot be drawn.
    pub(in super::super) fn leave_out(&mut self, name: &str, reason: &str) {
        let _ = writeln!(self.lines, "# {name}: {reason}");
    }

    /// Writes the list.
    pub(in super::super) fn write(&self) -> Result<(), Failure> {
        Ok(write_below(&self.place.join(LIST), self.lines.as_bytes())?)
    }
}

/// Writes the picture of the defaults, and those of other values that differ. Returns the number of the latter.
fn pictures(place: &Path, name: &str, plan: &Plan) -> Result<usize, Failure> {
    let drawn = |policies: Policies| {
        let surface = render(&plan.clone().under(policies), &RenderOptions::default()).surfaces.swap_remove(0);
        let opaque: Vec<[u8; 4]> = surface.rgba8().into_iter().map(|[r, g, b, _]| [r, g, b, 255]).collect();
        (surface.width, surface.height, opaque)
    };
    let write = |stem: &str, (width, height, pixels): &(u32, u32, Vec<[u8; 4]>)| {
        let png = encode_png(*width, *height, pixels, Compression::Small)?;
        Ok::<(), Failure>(write_below(&place.join(format!("{stem}.png")), &png)?)
    };
    let default = drawn(Policies::DEFAULT);
    write(name, &default)?;
    let mut count = 0;
    for policy in POLICIES {
        for (value, (word, _)) in policy.values.iter().enumerate().skip(1) {
            let mut policies = Policies::DEFAULT;
            policies.choose(policy.rule, value);
            let picture = drawn(policies);
            if picture != default {
                write(&format!("{name}@{}={word}", policy.rule), &picture)?;
                count += 1;
            }
        }
    }
    Ok(count)
}

/// What a card drew of a scene.
#[derive(Clone, Debug)]
pub(super) struct Answer {
    pub(super) scene: String,
    /// What it says: `not asked`, `as expected`, or the readings whose picture it is.
    pub(super) reading: String,
    /// Number of pixels that differ from the default's picture.
    pub(super) differing: usize,
}

/// Returns the lines of a pack's list; none if there is no list.
fn list(pack: &Path) -> String {
    let list = read::bytes(&pack.join(FOLDER).join(LIST), Kind::Regular, ninebit::limits::PAGE);
    list.map_or_else(|_| String::new(), |bytes| String::from_utf8_lossy(&bytes).into_owned())
}

/// Returns the digest that answers to a folder of scenes without tables name.
pub(super) fn root(pack: &Path) -> Option<String> {
    list(pack).lines().find_map(|line| line.strip_prefix("root ").map(str::to_owned))
}

/// Compares the scenes of a pack with what a card drew.
pub(super) fn compare(pack: &Path, results: &Path) -> Result<Vec<Answer>, Failure> {
    let (place, list) = (pack.join(FOLDER), list(pack));
    let names = list.lines().filter_map(|line| line.strip_prefix("scene "));
    names.map(|name| answer(&place, results, name)).collect()
}

/// Returns the picture that a card drew of a scene; `None` if it was not asked.
fn drawn(results: &Path, name: &str) -> Result<Option<Rgba>, Failure> {
    let path = results.join(format!("{name}.png"));
    if path.exists() {
        return Ok(Some(load(&path, &ImageLimits::default())?));
    }
    let path = results.join(format!("{name}.surface"));
    let invalid = |reason: String| {
        let message = format!("`{}` is no surface of a console: {reason}", shown::path(&path));
        Failure::invalid("NB1030", message, "draw the scenes again, and unpack the whole archive")
    };
    match read::bytes(&path, Kind::Regular, ninebit::limits::MEMORY_IMAGE) {
        Ok(bytes) => {
            let surface = surface(&bytes).map_err(invalid)?;
            Ok(Some(Rgba::new(surface.width, surface.rgba8())))
        }
        Err(ReadError::Missing) => Ok(None),
        Err(error) => Err(invalid(error.to_string())),
    }
}

fn answer(place: &Path, results: &Path, name: &str) -> Result<Answer, Failure> {
    let told = |reading: String, differing| Ok(Answer { scene: name.to_owned(), reading, differing });
    let Some(card) = drawn(results, name)? else { return told("not asked".to_owned(), 0) };
    let picture = |path: &Path| load(path, &ImageLimits::default());
    let expected = picture(&place.join(format!("{name}.png")))?;
    let differing = if card.width() == expected.width() && card.pixels().len() == expected.pixels().len() {
        card.pixels().iter().zip(expected.pixels()).filter(|(a, b)| a[..3] != b[..3]).count()
    } else {
        expected.pixels().len()
    };
    if differing == 0 {
        return told("as expected".to_owned(), 0);
    }
    let mut same = Vec::new();
    for policy in POLICIES {
        for (word, _) in policy.values.iter().skip(1) {
            let path = place.join(format!("{name}@{}={word}.png", policy.rule));
            if path.exists()
                && picture(&path)?.pixels().iter().map(|p| &p[..3]).eq(card.pixels().iter().map(|p| &p[..3]))
            {
                same.push(format!("{}={word}", policy.rule));
            }
        }
    }
    told(if same.is_empty() { "as no reading".to_owned() } else { format!("as {}", same.join(", ")) }, differing)
}
