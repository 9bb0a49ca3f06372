//! The command `ninebit gallery`: a site of scenes, each of which opens in the inspector.

use super::inspect::{Picture, common, first_picture, scene_data};
use super::scene::isolated;
use super::*;
use std::collections::BTreeMap;

use maud::{DOCTYPE, PreEscaped, html};
use ninebit::state::{MipFilter, PolygonModes, ShaderStage, TextureFormat, TextureKind};
use ninebit_files::output::write_below;
use ninebit_files::pending::PendingFolder;
use ninebit_scene::assets::RecordingFolder;
use ninebit_scene::{Heading, load_with};

use crate::page;
use crate::replay::{EntryKind, find};

const STYLE: &str = include_str!("gallery/style.css");
const SCRIPT: &str = include_str!("gallery/gallery.js");

/// The file that the pages of a site share. Where it is, a folder is a gallery.
const SHARED: &str = "inspector.js";

/// Largest width and height of a thumbnail.
const THUMBNAIL: u32 = 256;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Scene files, and folders with everything below them
    #[arg(required = true, value_name = "PLACE")]
    places: Vec<PathBuf>,
    /// The folder of the site; an earlier gallery is replaced
    #[arg(short, long, value_name = "SITE")]
    output: PathBuf,
    /// The title of the site
    #[arg(long, default_value = "Scenes of Ninebit")]
    title: String,
    #[command(flatten)]
    work: WorkArguments,
}

/// A scene of the site.
struct Exhibit {
    /// Folder of the scene in the places that were asked for.
    folder: String,
    /// Name of its page and its picture, without an extension.
    file: String,
    title: String,
    about: String,
    tags: Vec<&'static str>,
    size: (u32, u32),
}

/// Writes the site.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let mut found = find(&arguments.places).map_err(|error| {
        Failure::usage(error.to_string(), "run the command in a folder around both, with paths that differ")
    })?;
    // In the order of the places, which are shown as they were named.
    found.sort_by_key(|entry| arguments.places.iter().position(|place| entry.path.starts_with(place)));
    let site = site(&arguments.output)?;
    let progress = Progress::new("drawing", context.color);
    let count = found.len() as u64;
    let (mut exhibits, mut left_out) = (Vec::new(), Vec::new());
    for (done, entry) in found.into_iter().enumerate() {
        if entry.kind == EntryKind::Scene {
            match isolated(&entry.path, || exhibit(&entry.path, &entry.name, site.path(), arguments.work)) {
                Ok(exhibit) => exhibits.push(exhibit),
                Err(failure) if failure.exit == Exit::Internal || failure.exit == Exit::Output => return Err(failure),
                Err(failure) => left_out.push((entry.path, failure)),
            }
        }
        progress.report(done as u64 + 1, count);
    }
    drop(progress);
    for (path, failure) in &left_out {
        let text = format!("`{}` is left out", shown::path(path));
        terminal::print(Level::Warning, &Report::message(None, &text, "`ninebit check` says why"), context.color);
        // One reason is enough to see what they have in common.
        if left_out.len() == 1 {
            terminal::print(Level::Warning, &failure.report, context.color);
        }
    }
    if exhibits.is_empty() {
        return Err(Failure::usage("there is no scene to show", "name scenes, or folders of scenes"));
    }
    write_below(&site.path().join(SHARED), page::shared(&common()).as_bytes())?;
    write_below(&site.path().join("index.html"), index(&arguments.title, &exhibits).as_bytes())?;
    site.commit()?;
    Ok(())
}

/// Begins the folder.
fn site(place: &Path) -> Result<PendingFolder, Failure> {
    if !place.exists() {
        return Ok(PendingFolder::create(place)?);
    }
    let taken = || {
        let message = format!("`{}` exists, and is no gallery", shown::path(place));
        Failure::usage(message, "name a folder that does not exist, or an earlier gallery, which is replaced")
    };
    if !place.join(SHARED).is_file() {
        return Err(taken());
    }
    PendingFolder::replacing(place)?.ok_or_else(|| {
        let message = format!("`{}` cannot be replaced", shown::path(place));
        Failure::usage(message, "name a folder that does not exist")
    })
}

/// Writes the page and the picture of a scene.
fn exhibit(path: &Path, name: &str, site: &Path, work: WorkArguments) -> Result<Exhibit, Failure> {
    let gathered = RecordingFolder::default();
    let loaded = load_with(path, &Limits::default(), &gathered).map_err(scene::refused)?;
    loaded.affordable(work.pixels).map_err(scene::refused)?;
    let picture =
        first_picture(&loaded.plan).ok_or_else(|| Failure::usage("the scene has no target", "give it one"))?;
    let file = name.replace('/', "-");
    let (folder, own) = name.rsplit_once('/').unwrap_or(("", name));
    let Heading { title, about } = Heading::new(&loaded.source.text, own);
    let (tags, size) = (tags(&loaded.scene), (picture.0, picture.1));
    let thumbnail = thumbnail(&picture);
    let png = encode_png(thumbnail.0, thumbnail.1, &thumbnail.2, Compression::Small)?;
    write_below(&site.join("pictures").join(format!("{file}.png")), &png)?;
    let own = path.file_name().map_or_else(|| name.to_owned(), |name| shown::path(Path::new(name)));
    let data = scene_data(&own, loaded, gathered, None)?;
    let text = page::page_beside(&title, &data, &format!("../{SHARED}"));
    write_below(&site.join("scenes").join(format!("{file}.html")), text.as_bytes())?;
    Ok(Exhibit { folder: folder.to_owned(), file, title, about, tags, size })
}

/// Returns the units of the chip and the techniques that a scene uses, as filters name them.
fn tags(scene: &Scene) -> Vec<&'static str> {
    let textures = || scene.textures.iter();
    let units = || scene.draws.iter().flat_map(|draw| draw.textures.iter().flatten());
    let any = |test: fn(&Draw) -> bool| scene.draws.iter().any(test);
    let shades = |draw: &Draw| {
        let conventional = |unit: usize| ShaderStage::conventional(unit, draw.textures[unit].is_some());
        (0..draw.texture_shader.len()).any(|unit| draw.texture_shader[unit] != conventional(unit))
    };
    let products =
        |draw: &Draw| draw.combiners.stages.iter().any(|stage| stage.rgb.ab_dot_product || stage.rgb.cd_dot_product);
    let compressed = [TextureFormat::Dxt1, TextureFormat::Dxt3, TextureFormat::Dxt5];
    let all = [
        ("nv10", scene.profile == Profile::Nv10),
        ("nv2a", scene.profile == Profile::Nv2a),
        ("lines and points", any(|draw| !draw.topology.has_faces() || draw.polygon_modes != PolygonModes::FILL)),
        ("stipple", any(|draw| draw.polygon_stipple.is_some())),
        ("dot product", any(products)),
        ("several stages", any(|draw| draw.combiners.stages.len() > 2)),
        ("several draws", scene.draws.len() > 1),
        ("texture shader", any(shades)),
        ("vertex program", any(|draw| draw.vertex_program.is_some())),
        ("cube map", textures().any(|texture| texture.kind == TextureKind::Cube)),
        ("volume", textures().any(|texture| texture.kind == TextureKind::ThreeDimensional)),
        ("compressed texture", textures().any(|texture| compressed.contains(&texture.format))),
        ("palette", textures().any(|texture| texture.format == TextureFormat::P8)),
        ("texture from a target", textures().any(|texture| texture.image.target().is_some())),
        ("mip levels", units().any(|unit| unit.mip_filter != MipFilter::None)),
        ("anisotropy", units().any(|unit| unit.anisotropy > 1)),
        ("shadow comparison", units().any(|unit| unit.shadow.is_some())),
        ("signed texture", units().any(|unit| unit.signed != [false; 4])),
        ("colour key", units().any(|unit| unit.color_key.is_some())),
        ("fog", any(|draw| draw.fog.function.is_some())),
        ("blend", any(|draw| draw.blend.is_some())),
        ("alpha test", any(|draw| draw.alpha_test.is_some())),
        ("depth test", any(|draw| draw.depth_test.is_some())),
        ("stencil test", any(|draw| draw.stencil_test.is_some())),
    ];
    all.into_iter().filter(|(_, used)| *used).map(|(name, _)| name).collect()
}

/// Returns a picture that is no larger than a thumbnail: means of squares of pixels.
fn thumbnail((width, height, pixels): &Picture) -> Picture {
    let by = width.max(height).div_ceil(THUMBNAIL);
    let (columns, rows) = ((width / by).max(1), (height / by).max(1));
    let mean = |column: u32, row: u32| {
        let (mut sum, mut count) = ([0_u32; 3], 0);
        for y in row * by..((row + 1) * by).min(*height) {
            for x in column * by..((column + 1) * by).min(*width) {
                let pixel = pixels[y as usize * *width as usize + x as usize];
                (0..3).for_each(|n| sum[n] += u32::from(pixel[n]));
                count += 1;
            }
        }
        let [r, g, b] = sum.map(|sum| ((sum + count / 2) / count) as u8);
        [r, g, b, 255]
    };
    (
        columns,
        rows,
        (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row))).map(|(c, r)| mean(c, r)).collect(),
    )
}

/// Returns the number of bytes of the folder around all folders, with the slash after it.
fn common_folder(folders: &[&str]) -> usize {
    let Some(first) = folders.first() else { return 0 };
    let mut ends = first.match_indices('/').map(|(at, _)| at + 1).rev();
    ends.find(|end| folders.iter().all(|folder| folder.starts_with(&first[..*end]))).unwrap_or(0)
}

/// Returns the page of all scenes.
fn index(title: &str, exhibits: &[Exhibit]) -> String {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    exhibits.iter().flat_map(|exhibit| &exhibit.tags).for_each(|tag| *counts.entry(tag).or_default() += 1);
    let mut folders: Vec<(&str, Vec<&Exhibit>)> = Vec::new();
    for exhibit in exhibits {
        match folders.iter_mut().find(|(folder, _)| *folder == exhibit.folder) {
            Some((_, of)) => of.push(exhibit),
            None => folders.push((&exhibit.folder, vec![exhibit])),
        }
    }
    let around = common_folder(&folders.iter().map(|(folder, _)| *folder).collect::<Vec<_>>());
    let policy = format!(
        "default-src 'none'; img-src 'self' file: data:; script-src {}; style-src {}; base-uri 'none'; form-action 'none'",
        page::source_hash(SCRIPT),
        page::source_hash(STYLE)
    );
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            (page::head(&policy, title, STYLE))
            body {
                header {
                    h1 { (title) }
                    p { "Pictures as a graphics chip of 1999 computes them, bit for bit. Each opens in the inspector, which shows every integer of a pixel and lets you change the scene." }
                    div.filters role="group" aria-label="Show scenes with" {
                        input #search type="search" placeholder="Search" aria-label="Search titles and texts";
                        @for (tag, count) in &counts { button.tag aria-pressed="false" data-tag=(tag) { (tag) " " small { (count) } } }
                    }
                    p #count role="status" { (exhibits.len()) " scenes" }
                }
                main {
                    @for (folder, exhibits) in &folders {
                        section {
                            h2 { (folder.get(around..).filter(|name| !name.is_empty()).unwrap_or("scenes")) }
                            ul.scenes {
                                @for exhibit in exhibits {
                                    li data-tags=(exhibit.tags.join("|")) {
                                        a href={ "scenes/" (exhibit.file) ".html" } {
                                            img src={ "pictures/" (exhibit.file) ".png" } alt="" loading="lazy" width="128" height="128";
                                            strong { (exhibit.title) }
                                        }
                                        p { (exhibit.about) }
                                        p.tags { (exhibit.size.0) " × " (exhibit.size.1) @for tag in &exhibit.tags { " · " (tag) } }
                                    }
                                }
                            }
                        }
                    }
                }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    page.into_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_around() {
        assert_eq!(common_folder(&["a/b/c", "a/b/d"]), 4);
        assert_eq!((common_folder(&["a/b"]), common_folder(&["a", "b/c"]), common_folder(&[])), (2, 0, 0));
    }

    #[test]
    fn thumbnails_are_means() {
        let grey = |n: u8| [n, n, n, 255];
        assert_eq!(thumbnail(&(2, 1, vec![grey(1), grey(2)])), (2, 1, vec![grey(1), grey(2)]));
        let (width, height, pixels) =
            thumbnail(&(512, 2, [vec![grey(10), grey(20)], vec![grey(0); 510], vec![grey(30); 512]].concat()));
        assert_eq!((width, height, pixels[0], pixels[1]), (256, 1, grey(23), grey(15)));
    }
}
