//! Writes scenes: state becomes the text and the files of a scene that draws the same pictures.
//!
//! Programs are those of the combiners, and vertices those that the vertex side has made; what they were made of is not in the state. Equal parts
//! of several draws get a name, and equal images are one texture. Textures and palettes that no draw reads are left out.

mod combiner;
mod draw;
mod error;
mod files;
mod node;
mod target;
mod texture;
mod unit;
mod vertices;
mod words;

use std::collections::HashMap;
use std::sync::Arc;

use draw::Parts;
use files::{Files, UniqueNames};
use ninebit::limits::Limits;
use ninebit::state::*;
use ninebit_program::registers;
use node::{Fields, Node, commented, commented_list};
use texture::{Palettes, Textures};

pub use error::Unwritable;
pub use words::register_words;

/// A scene as files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneFiles {
    /// The text of the scene.
    pub text: String,
    /// The files that the text names, and their contents: `textures/grass.bin`.
    pub files: Vec<(String, Vec<u8>)>,
}

/// How a scene is written.
#[derive(Clone, Debug, Default)]
pub struct WriteOptions {
    /// Lines of a comment at the head of the text.
    pub head: Vec<String>,
    /// For each draw the lines of a comment above it. Draws behind the last have none.
    pub comments: Vec<Vec<String>>,
    /// The folder, beside the text, around the files that it names, so that several scenes can stand side by side. Empty: none.
    pub folder: String,
    /// Whether programs are written as register words.
    pub register_words: bool,
    /// Limits that the text has to meet.
    pub limits: Limits,
}

/// Writes a scene. Reading it again gives the same pictures, if the scene is valid; otherwise the reader says what is wrong.
///
/// # Errors
/// An index leads nowhere, a number is not one that scenes have, or the text would exceed its limit.
pub fn scene(scene: &Scene, options: &WriteOptions) -> Result<SceneFiles, Unwritable> {
    let whole = |reason: String| Unwritable { place: "the scene".to_owned(), reason };
    if scene.targets.is_empty() {
        return Err(whole("it has no render target".to_owned()));
    }
    let mut files = Files::new(&options.folder);
    let (mut target_names, mut texture_names) = (UniqueNames::default(), UniqueNames::default());
    let targets: Vec<String> = scene.targets.iter().map(|target| target_names.unique(&target.name)).collect();
    let palettes = Palettes::collect(scene, &mut UniqueNames::default());
    let mut textures = Textures::collect(scene, &mut texture_names);
    let target_list = write_targets(scene, &targets, &mut textures, &mut texture_names)?;
    let (names, draws) = write_draws(scene, &targets, (&textures, &palettes), options, &mut files)?;
    let texture_table = textures.table(scene, &targets, &palettes, &mut files)?;
    let palette_table = palettes.table(scene);
    let mut fields = Fields::new("").tall();
    fields.put("version", Node::whole(1));
    fields.put("profile", Node::word(scene.profile.name()));
    fields.put_some("names", names);
    fields.put("targets", target_list);
    fields.put_some("palettes", palette_table);
    fields.put_some("textures", texture_table);
    fields.put("draws", draws);
    let mut text: String = options.head.iter().map(|line| commented(line) + "\n").collect();
    Node::from(fields).write(&mut text, 0, 0);
    text.push('\n');
    let (bytes, most) = (text.len() as u64, options.limits.scene_bytes);
    if bytes > most {
        return Err(whole(format!("its text has {bytes} bytes; a scene has at most {most}")));
    }
    Ok(SceneFiles { text, files: files.into_list() })
}

/// Returns the list of targets. The images that they begin as become textures.
fn write_targets(
    scene: &Scene,
    names: &[String],
    textures: &mut Textures,
    texture_names: &mut UniqueNames,
) -> Result<Node, Unwritable> {
    let target = |(target, name): (&Target, &String)| {
        let reason = |reason| Unwritable { place: format!("target `{name}`"), reason };
        let mut add = |words: &Option<Arc<[u32]>>, format| {
            let words = words.as_ref();
            let name = words.map(|words| textures.add_contents((target, format), words, scene.profile, texture_names));
            name.transpose().map_err(reason)
        };
        // Of formats of 8 to 32 bits that a surface may have, those of which every bit counts.
        let colors = match target.format.bytes() {
            1 => TextureFormat::I8,
            2 => TextureFormat::R5G6B5,
            _ => TextureFormat::A8R8G8B8,
        };
        let depths = target.depth.map_or(TextureFormat::Z16, |depth| depth.format.texture_format());
        let contents = [add(&target.contents, colors)?, add(&target.depth_contents, depths)?];
        Ok(Node::from(target::target(target, name, contents.each_ref().map(Option::as_deref))))
    };
    Ok(Node::list(scene.targets.iter().zip(names).map(target).collect::<Result<Vec<_>, _>>()?))
}

/// Returns the values that several draws share, and the list of draws.
fn write_draws(
    scene: &Scene,
    targets: &[String],
    tables: (&Textures, &Palettes),
    options: &WriteOptions,
    files: &mut Files,
) -> Result<(Fields, Node), Unwritable> {
    let mut draw_names = UniqueNames::default();
    let names: Vec<String> = scene.draws.iter().map(|draw| draw_names.unique(&draw.name)).collect();
    let refused = |index: usize, reason: String| Unwritable { place: format!("draw `{}`", names[index]), reason };
    let (mut vertices, mut programs, mut blends) =
        (SharedText::default(), SharedText::default(), SharedText::default());
    let mut parts = Vec::with_capacity(scene.draws.len());
    for (index, draw) in scene.draws.iter().enumerate() {
        let name = &names[index];
        let target = scene.targets.get(draw.target);
        let target = target.ok_or_else(|| refused(index, format!("it goes into target {}", draw.target)))?;
        if let Some(clear) = draw::clear(draw, target) {
            parts.push(Part::Clear(clear));
            continue;
        }
        let list = vertices::list(draw, scene.profile, files).map_err(|reason| refused(index, reason))?;
        parts.push(Part::Draw {
            target,
            vertices: vertices.add(name, list),
            program: program(draw, scene.profile, options).map(|program| programs.add(name, program)),
            blend: draw::blend(draw).map(|blend| blends.add(name, blend)),
        });
    }
    let mut list = Vec::with_capacity(scene.draws.len());
    for (index, (draw, part)) in scene.draws.iter().zip(parts).enumerate() {
        let mut fields = Fields::new("");
        if names[index] != format!("draw {index}") {
            fields.put("name", Node::text(&names[index]));
        }
        if draw.target != 0 {
            fields.put("target", Node::text(&targets[draw.target]));
        }
        match part {
            Part::Clear(clear) => fields.put("clear", clear),
            Part::Draw { target, vertices: number, program, blend } => {
                let source = vertices::source(draw, target, vertices.get(number));
                let parts = source.map(|vertices| Parts {
                    vertices,
                    program: program.map(|program| programs.get(program)),
                    blend: blend.map(|blend| blends.get(blend)),
                });
                let written = parts.and_then(|parts| draw::state(&mut fields, (draw, target, scene), parts, tables));
                written.map_err(|reason| refused(index, reason))?;
            }
        }
        list.push((options.comments.get(index).cloned().unwrap_or_default(), fields.into()));
    }
    let mut shared = Fields::new("");
    shared.put_some("vertices", vertices.into_table());
    shared.put_some("programs", programs.into_table());
    shared.put_some("blends", blends.into_table());
    Ok((shared, commented_list(list)))
}

/// A draw that is about to be written. Numbers are those of shared values.
enum Part<'s> {
    Clear(Fields),
    Draw { target: &'s Target, vertices: usize, program: Option<usize>, blend: Option<usize> },
}

/// Returns the program of a draw; `None` for the one that a draw has if it names none.
fn program(draw: &Draw, profile: Profile, options: &WriteOptions) -> Option<Node> {
    let program = combiner::program(&draw.combiners)?;
    Some(if options.register_words {
        Node::word(register_words(&registers::encode(&draw.combiners, profile)))
    } else {
        program
    })
}

/// Values of one kind, of which those that occur more than once get a name.
#[derive(Default)]
struct SharedText {
    /// The numbers of values by their texts.
    numbers: HashMap<String, usize>,
    values: Vec<SharedValue>,
    names: UniqueNames,
}

struct SharedValue {
    name: String,
    value: Node,
    uses: usize,
}

impl SharedText {
    /// Adds a value, whose name is that of a draw. Returns its number.
    fn add(&mut self, draw: &str, value: Node) -> usize {
        let number = *self.numbers.entry(value.flat()).or_insert(self.values.len());
        if number == self.values.len() {
            self.values.push(SharedValue { name: self.names.unique(draw), value, uses: 0 });
        }
        self.values[number].uses += 1;
        number
    }

    /// Returns what stands in a draw: the value, or its name.
    fn get(&self, number: usize) -> Node {
        let SharedValue { name, value, uses } = &self.values[number];
        if *uses > 1 { Node::text(name) } else { value.clone() }
    }

    /// Returns the table of those with names.
    fn into_table(self) -> Fields {
        let mut table = Fields::table();
        for SharedValue { name, value, .. } in self.values.into_iter().filter(|value| value.uses > 1) {
            table.entry(&name, value);
        }
        table
    }
}
