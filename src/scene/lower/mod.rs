//! Lowers the fields of a scene to checked state; each part of the scene has a file.

mod api_program;
mod attribute;
mod color;
mod combiner;
mod draw;
mod fog;
mod geometry;
mod input;
mod matrix;
mod mesh;
mod names;
mod palette;
mod pixel_shader;
mod point;
mod program;
mod program_file;
mod program_text;
mod raster;
mod register_words;
mod shader;
mod target;
mod texgen;
mod texture;
mod texture_environment;
mod texture_levels;
mod texture_source;
mod texture_stages;
mod truth;
mod unit;
mod unit_texture;
mod vertex;
mod vertex_file;
mod vertex_program;

use ninebit::place::Span;
use std::sync::Arc;

use super::diagnostic::Diagnostic;
use super::fields as source;
use super::notation::trim;
use super::raw::{Entries, Numbers, Raw, Tuple};
use super::reader::{Reader, too_many};
use super::wording::shorten;
use crate::truth::Truth;
pub(super) use geometry::moved_back;
use ninebit::diagnostic::File;
use ninebit::engine::{self, EmptyDraw};
use ninebit::plan::{Invisible, Plan, PlanOptions};
use ninebit::state::*;
use ninebit_program::{finding, warning};
pub use program::ProgramLanguage;
pub(super) use program_file::program_file;
pub(super) use target::depth_word;

/// Places of a draw in the scene's text, for errors that are found later.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DrawSpans {
    /// The draw's name, or the start of the draw.
    pub draw: Span,
    /// Places of its vertices.
    pub vertices: VertexSpans,
    /// Places of its texture units; empty for units that are not bound.
    pub(crate) units: [Span; ninebit::state::TEXTURE_UNITS],
}

/// Places of vertices.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum VertexSpans {
    /// A place for each vertex.
    Each(Vec<Span>),
    /// One place for all vertices, such as the mesh that makes them.
    All(Span),
}

impl Default for VertexSpans {
    fn default() -> Self {
        VertexSpans::Each(Vec::new())
    }
}

impl DrawSpans {
    /// Returns the place of a vertex, or that of the draw if there is no such vertex.
    pub fn vertex(&self, index: usize) -> Span {
        match &self.vertices {
            VertexSpans::Each(spans) => spans.get(index).cloned().unwrap_or_else(|| self.draw.clone()),
            VertexSpans::All(span) => span.clone(),
        }
    }
}

/// A whole scene that has been lowered.
pub(super) struct LoweredScene {
    pub(super) scene: Scene,
    pub(super) plan: Plan,
    pub(super) truth: Option<Truth>,
    /// Places of the draws, in their order.
    pub(super) spans: Vec<DrawSpans>,
}

/// Reads the text that a scene shares with others. Returns `None` after recording what is wrong.
pub(super) fn shared_text<'a>(reader: &mut Reader<'a>, named: &Raw<'a, String>) -> Option<Arc<File>> {
    program_text::text_file(reader, named, reader.limits.program_file())
}

/// Reads and checks a whole scene. `family` is the text of its family's file, if it names one. Returns `None` if there are errors; the reader
/// has them.
pub(super) fn scene<'a>(reader: &mut Reader<'a>, text: &'a str, family: Option<&'a str>) -> Option<LoweredScene> {
    if trim(text).is_empty() {
        return reader.refuse(
            Diagnostic::error("NB0101", 0..0, "the scene is empty")
                .help("a scene starts with `(version: 1, profile: Nv2a, draws: [...])`"),
        );
    }
    let raw = reader.check::<source::Scene<'a>>(text)?;
    let file = reader.read(&raw)?;
    let opening = reader.span(&raw).start;
    let opening = opening..opening + 1;
    if !version(reader, &file, opening.clone()) {
        return None;
    }
    let profile = file.profile(reader);
    reader.profile = profile.and_then(|raw| reader.name(&raw)).unwrap_or(Profile::Nv2a);
    if let Some(raw) = &file.family {
        // The file has been read already; this finds a field that is not a text.
        reader.read(raw);
    }
    let shared = family.and_then(|text| reader.check::<source::Family<'a>>(text)).and_then(|raw| reader.read(&raw));
    let shared = shared.unwrap_or_default();
    names::read(reader, &file.names, &shared.names);
    target::targets(reader, &file.targets.or(shared.targets));
    texture::textures(reader, &file);
    target::contents(reader);
    let described = file.truth.is_some() || shared.truth.is_some();
    let draws = draw::draws(reader, &file.draws, described);
    let truth = truth::truth(reader, &file.truth, &shared.truth, &draws);
    // Nothing needs named meshes and vertex lists beside the plan.
    names::warn_unused(reader);
    let textures = std::mem::take(&mut reader.textures);
    textures.warn_unused(reader);
    if reader.errors > 0 {
        return None;
    }
    let (draws, spans): (Vec<_>, Vec<_>) = draws.into_iter().map(|drawn| (drawn.draw, drawn.spans)).unzip();
    let scene = Scene {
        profile: reader.profile,
        targets: std::mem::take(&mut reader.targets.list),
        textures: textures.list,
        palettes: textures.palettes.list,
        draws,
    };
    let plan = plan(reader, &scene, &spans)?;
    warn_unseen(reader, &plan, &spans);
    warn_unread(reader, &scene, &spans);
    Some(LoweredScene { scene, plan, truth, spans })
}

/// Warns of draws that store nothing.
fn warn_unseen(reader: &mut Reader<'_>, plan: &Plan, spans: &[DrawSpans]) {
    for ((planned, spans), unseen) in plan.draws().iter().zip(spans).zip(engine::unseen(plan)) {
        // A pass that adds light adds none where a lamp lies on the other side; another scene of its family may differ.
        let adds_nothing = planned.folded.invisible == Some(Invisible::AddsZero);
        if let Some(EmptyDraw { reason, help }) = unseen.filter(|_| !adds_nothing) {
            let message = format!("draw `{}` stores no pixel: {reason}", shorten(&planned.name));
            reader.push(warning("NB0919", spans.draw.clone(), message, "nothing of it is seen", help));
        }
    }
}

/// Warns of targets behind the first that are drawn into and shown by no texture of a draw.
fn warn_unread(reader: &mut Reader<'_>, scene: &Scene, spans: &[DrawSpans]) {
    let units = scene.draws.iter().flat_map(|draw| draw.textures.iter().flatten());
    let shown: Vec<usize> = units.filter_map(|unit| scene.textures[unit.texture].image.target()).collect();
    for (index, target) in scene.targets.iter().enumerate().skip(1).filter(|(index, _)| !shown.contains(index)) {
        let Some(at) = scene.draws.iter().position(|draw| draw.target == index) else { continue };
        let name = shorten(&target.name);
        let message = format!("target \"{name}\" is drawn into, and no draw reads it");
        let help = format!("a texture `Target(\"{name}\")` shows it to a draw; `ninebit render --target` writes it");
        reader.push(warning("NB0920", spans[at].draw.clone(), message, "draws into it", help));
    }
}

/// Returns whether this program reads the scene's version of the format.
fn version<'a>(reader: &mut Reader<'a>, file: &source::Scene<'a>, opening: Span) -> bool {
    let Some(raw) = &file.version else {
        let message = "this scene has no `version`";
        reader.push(finding("NB0202", opening, message, "`version` is missing", "add `version: 1`"));
        return false;
    };
    let version = reader.read(raw);
    if let Some(version) = version
        && version != 1
    {
        let message = format!("version {version} of the scene format is not known");
        reader.push(finding("NB0214", reader.span(raw), message, "not known", "this program reads version 1"));
    }
    version == Some(1)
}

/// Plans the scene. Only the plan finds positions and coordinates outside the rasteriser's domain.
fn plan(reader: &mut Reader<'_>, scene: &Scene, spans: &[DrawSpans]) -> Option<Plan> {
    let errors = match Plan::compile_within(scene, &PlanOptions::default(), reader.limits) {
        Ok(plan) => return Some(plan),
        Err(errors) => errors,
    };
    for error in errors {
        let span = error.draw.and_then(|draw| spans.get(draw)).map(|draw| match (error.vertex, error.unit) {
            (Some(vertex), _) => draw.vertex(vertex),
            (None, Some(unit)) if !draw.units[unit].is_empty() => draw.units[unit].clone(),
            (None, _) => draw.draw.clone(),
        });
        let label = match (error.vertex, error.draw.and_then(|draw| scene.draws.get(draw))) {
            (Some(vertex), Some(draw)) => format!("vertex {vertex} of `{}`", shorten(&draw.name)),
            _ if error.unit.is_some() => "this unit".to_owned(),
            _ => "this draw".to_owned(),
        };
        reader.push(error.diagnostic(span).label(label));
    }
    None
}
