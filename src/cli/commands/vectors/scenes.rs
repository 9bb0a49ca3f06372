//! Scenes beside the tables of a pack: draws for a card, and the pictures that tell its answers.
//!
//! ```text
//! PACK/scenes/scenes.txt              `scene NAME` a line; those that the program cannot draw behind `#`, with the reason
//! PACK/scenes/NAME.scene.txt, .raw    draws (vectors/harness/gl/README.md)
//! PACK/scenes/NAME.png                the picture by the model's default policies
//! PACK/scenes/NAME@RULE=VALUE.png     the picture by another value, where it differs
//! RESULTS/NAME.png                    what the card drew
//! ```

use super::super::scene::refused;
use super::*;

use ninebit::engine::render;
use ninebit::plan::PlanOptions;
use ninebit::state::POLICIES;
use ninebit_files::output::write_below;
use ninebit_files::read::{self, Kind};
use ninebit_scene::image::{ImageLimits, load};
use ninebit_vectors::gpu::scene;

use crate::replay::find;

/// The list of scenes.
const LIST: &str = "scenes.txt";
/// Folder of scenes in a pack.
const FOLDER: &str = "scenes";

/// Writes the scenes of a folder into a pack. Returns what is told of each.
pub(super) fn export(pack: &Path, folder: &Path, profile: Profile) -> Result<String, Failure> {
    let found =
        find(&[folder.to_owned()]).map_err(|error| Failure::usage(error.to_string(), "name a folder of scenes"))?;
    let place = pack.join(FOLDER);
    let (mut list, mut told) = (String::new(), String::new());
    for path in found.iter().map(|entry| &entry.path) {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let mut loaded = ninebit_scene::load(path, &Limits::default()).map_err(refused)?.scene;
        // A later chip draws the scenes of an earlier one.
        let other = loaded.profile != profile;
        if profile == Profile::Nv2a {
            loaded.profile = profile;
        }
        let plan = Plan::compile(&loaded, &PlanOptions::default());
        let written = match plan {
            _ if other && profile == Profile::Nv10 => Err("a scene of nv2a".to_owned()),
            Err(errors) => Err(errors.first().map_or_else(String::new, |error| error.message.clone())),
            Ok(plan) => {
                let assemblies: Vec<_> = plan.draws().iter().map(|draw| &draw.assembly).collect();
                scene::scene(&name, &loaded, &assemblies).map(|files| (files, plan))
            }
        };
        match written {
            Ok((files, plan)) => {
                write_below(&place.join(format!("{name}.scene.txt")), files.text.as_bytes())?;
                write_below(&place.join(format!("{name}.scene.raw")), &files.raw)?;
                let alternatives = pictures(&place, &name, &plan)?;
                let _ = writeln!(list, "scene {name}");
                let _ = writeln!(told, "{name:<24}{alternatives:>9} other readings, as a scene");
            }
            Err(reason) => {
                let _ = writeln!(list, "# {name}: {reason}");
                let _ = writeln!(told, "{name:<24} left out: {reason}");
            }
        }
    }
    write_below(&place.join(LIST), list.as_bytes())?;
    Ok(told)
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

/// Compares the scenes of a pack with what a card drew.
pub(super) fn compare(pack: &Path, results: &Path) -> Result<Vec<Answer>, Failure> {
    let place = pack.join(FOLDER);
    let Ok(list) = read::bytes(&place.join(LIST), Kind::Regular, ninebit::limits::PAGE) else { return Ok(Vec::new()) };
    let list = String::from_utf8_lossy(&list).into_owned();
    let names = list.lines().filter_map(|line| line.strip_prefix("scene "));
    names.map(|name| answer(&place, results, name)).collect()
}

fn answer(place: &Path, results: &Path, name: &str) -> Result<Answer, Failure> {
    let told = |reading: String, differing| Ok(Answer { scene: name.to_owned(), reading, differing });
    let found = results.join(format!("{name}.png"));
    if !found.exists() {
        return told("not asked".to_owned(), 0);
    }
    let picture = |path: &Path| load(path, &ImageLimits::default());
    let (card, expected) = (picture(&found)?, picture(&place.join(format!("{name}.png")))?);
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
