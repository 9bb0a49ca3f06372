//! A scene, and what is asked of it.

use std::path::Path;

use ninebit::diagnostic::{Diagnostic, Severity, Source};
use ninebit::engine::trace;
use ninebit::limits::Limits;
use ninebit::plan::Plan;
use ninebit::state::{Draw, Named, POLICIES, Policies, Scene};
use ninebit_report::trace_value;
use ninebit_scene::assets::Bundle;
use ninebit_scene::image::{ImageLimits, Rgba, decode};
use ninebit_scene::{Loaded, SceneError, parse_with, render};
use serde_json::{Value, json};

use crate::{frame, program, tree};

/// A scene, the files that it names, and the latest picture.
///
/// A request is an object whose `do` names what is wanted; the answer is an object, with `error` if it could not be done:
///
/// | `do` | fields | answer |
/// |---|---|---|
/// | `file` | `name`; the file's bytes | nothing; scenes may name the file from now on |
/// | `open` | `text`, `name` | `scene`: its targets, draws and textures; `findings`. A scene with errors leaves the one before in place |
/// | `policies` | `values`: rule to value | nothing; they hold from now on |
/// | `draw` | `target`, `until` (a draw, or null) | `width`, `height`, `digest`, and the picture |
/// | `heat` | `target`, `against`: `ideal`, `picture`, or an object as `values` | `differing`, `regions`, and the picture |
/// | `picture` | `name`; the file's bytes, PNG or TGA | `width`, `height`; `heat` compares with it |
/// | `trace` | `target`, `pixel` | `trace`: the document of docs/trace-format.md |
/// | `alternatives` | `target`, `pixel` | `rules`: what the pixel would be under each value of each rule |
/// | `outline` | | `tree`: the values of the scene's text with their places |
/// | `program` | `draw` | `program`: its state, its words, its text |
/// | `edit` | `draw`, `path`, `value` | `text`: the scene's text with that part of the program changed |
/// | `paste` | `draw`, `language`, `program` | `text`: the scene's text with that program |
#[derive(Debug, Default)]
pub struct Session {
    files: Bundle,
    text: String,
    loaded: Option<(Scene, Plan)>,
    policies: Policies,
    second: Option<Rgba>,
    picture: Vec<[u8; 4]>,
}

/// What a request needs and does not say, or what it says and is not so.
pub(crate) type Refused = String;

impl Session {
    /// Answers a request; `file` is what came with it.
    pub fn answer(&mut self, request: &[u8], file: Vec<u8>) -> String {
        let answer = serde_json::from_slice(request)
            .map_err(|error| format!("the request is not JSON: {error}"))
            .and_then(|request: Value| self.act(&request, file));
        answer.unwrap_or_else(|refused| json!({ "error": refused })).to_string()
    }

    /// The latest picture: R, G, B, A, row by row from the top.
    pub fn picture(&self) -> &[[u8; 4]] {
        &self.picture
    }

    fn act(&mut self, request: &Value, file: Vec<u8>) -> Result<Value, Refused> {
        let text = |field: &str| request[field].as_str().ok_or_else(|| format!("`{field}` is not a text"));
        let number = |field: &str| {
            let number = request[field].as_u64().and_then(|n| usize::try_from(n).ok());
            number.ok_or_else(|| format!("`{field}` is not a number"))
        };
        match text("do")? {
            "file" => {
                self.files.files.insert(text("name")?.to_owned(), file);
                Ok(json!({}))
            }
            "open" => Ok(self.open(text("text")?, text("name")?)),
            "policies" => {
                self.policies = policies(&request["values"])?;
                if let Some((_, plan)) = &mut self.loaded {
                    plan.policies = self.policies;
                }
                Ok(json!({}))
            }
            "picture" => {
                let read = decode(&file, Path::new(text("name")?), &ImageLimits::default());
                let picture = read.map_err(|error| format!("{}: {error}; {}", error.code(), error.help()))?;
                let size = json!({ "width": picture.width, "height": picture.height });
                self.second = Some(picture);
                Ok(size)
            }
            "outline" => Ok(json!({ "tree": tree::value(&self.text) })),
            "draw" => {
                let target = self.target(number("target")?)?;
                let (answer, picture) = frame::draw(self.loaded()?, target, number("until").ok())?;
                self.picture = picture;
                Ok(answer)
            }
            "heat" => {
                let target = self.target(number("target")?)?;
                let (loaded, against) = (self.loaded()?, &request["against"]);
                let (answer, picture) = match against.as_str() {
                    Some("ideal") => frame::against_ideal(&loaded.1, target),
                    Some(_) => frame::against_picture(&loaded.1, target, self.second.as_ref())?,
                    None => frame::against_policies(&loaded.1, target, policies(against)?)?,
                };
                self.picture = picture;
                Ok(answer)
            }
            "trace" => {
                let (target, pixel) = (self.target(number("target")?)?, pixel(request)?);
                let plan = &self.loaded()?.1;
                let trace = trace(plan, target, pixel, None).map_err(|error| error.to_string())?;
                Ok(json!({ "trace": trace_value(plan, &trace) }))
            }
            "alternatives" => {
                let (target, pixel) = (self.target(number("target")?)?, pixel(request)?);
                alternatives(&self.loaded()?.1, target, pixel)
            }
            "program" => {
                let (scene, _) = self.loaded()?;
                Ok(json!({ "program": program::value(scene, drawn(scene, number("draw")?)?) }))
            }
            "edit" => {
                let (scene, _) = self.loaded()?;
                let number = number("draw")?;
                let changed = program::changed(drawn(scene, number)?, &request["path"], &request["value"])?;
                Ok(json!({ "text": program::replaced(&self.text, number, &changed)? }))
            }
            "paste" => {
                let written = program::pasted(text("language")?, text("program")?)?;
                Ok(json!({ "text": program::replaced(&self.text, number("draw")?, &written)? }))
            }
            other => Err(format!("`{other}` is nothing that can be asked for")),
        }
    }

    fn loaded(&self) -> Result<&(Scene, Plan), Refused> {
        self.loaded.as_ref().ok_or_else(|| "there is no scene".to_owned())
    }

    fn target(&self, number: usize) -> Result<usize, Refused> {
        let count = self.loaded()?.1.targets.len();
        if number < count { Ok(number) } else { Err(format!("there is no target {number}; the scene has {count}")) }
    }

    /// Reads a scene. What is wrong with it is the answer; then the one before stays.
    fn open(&mut self, text: &str, name: &str) -> Value {
        match parse_with(text, Path::new(name), &Limits::default(), &self.files) {
            Ok(loaded) => {
                let Loaded { scene, plan, warnings, source, .. } = loaded;
                let answer = json!({ "scene": described(&scene), "findings": findings(&warnings, &source) });
                self.text = source.text;
                self.loaded = Some((scene, Plan { policies: self.policies, ..plan }));
                answer
            }
            Err(error) => {
                let SceneError { diagnostics, suppressed, source } = &error;
                json!({ "findings": findings(diagnostics, source), "suppressed": suppressed, "rendered": error.render(false) })
            }
        }
    }
}

/// The policies of an object, rule to value; the others are the default.
fn policies(values: &Value) -> Result<Policies, Refused> {
    let mut policies = Policies::default();
    for (rule, value) in values.as_object().into_iter().flatten() {
        let assignment = format!("{rule}={}", value.as_str().unwrap_or_default());
        policies.set(&assignment).map_err(|error| error.to_string())?;
    }
    Ok(policies)
}

fn pixel(request: &Value) -> Result<(u32, u32), Refused> {
    let at = |n: usize| request["pixel"][n].as_u64().and_then(|n| u32::try_from(n).ok());
    at(0).zip(at(1)).ok_or_else(|| "`pixel` is not two numbers".to_owned())
}

fn drawn(scene: &Scene, number: usize) -> Result<&Draw, Refused> {
    scene.draws.get(number).ok_or_else(|| format!("there is no draw {number}; the scene has {}", scene.draws.len()))
}

/// Findings as data: place, words, and the excerpt with carets.
fn findings(findings: &[Diagnostic], source: &Source) -> Value {
    let value = |finding: &Diagnostic| {
        let inside = finding.file.as_ref().map_or(source, |file| &file.source);
        let place = finding.span.as_ref().map(|span| inside.position(span.start));
        // Where in the given text: of a finding about another file, where that one is named.
        let span = finding.file.as_ref().map(|file| file.named.clone()).or(finding.span.clone());
        json!({
            "code": finding.code,
            "severity": if finding.severity == Severity::Error { "error" } else { "warning" },
            "message": finding.message,
            "file": inside.name,
            "line": place.map(|place| place.0),
            "column": place.map(|place| place.1),
            "span": span.map(|span| units(&source.text, span)),
            "label": finding.label,
            "rule": finding.rule,
            "notes": finding.notes,
            "help": finding.help,
            "rendered": render(std::slice::from_ref(finding), source, false),
        })
    };
    findings.iter().map(value).collect()
}

/// A place of a text in UTF-16 units, as scripts count.
pub(crate) fn units(text: &str, span: std::ops::Range<usize>) -> [usize; 2] {
    [span.start, span.end].map(|at| {
        let at = ninebit::diagnostic::floor_boundary(text, at);
        text[..at].encode_utf16().count()
    })
}

fn described(scene: &Scene) -> Value {
    let targets = scene.targets.iter().map(|target| {
        let depth = target.depth.map(|depth| depth.format.name());
        json!({ "name": target.name, "width": target.width, "height": target.height, "format": target.format.name(), "depth": depth })
    });
    let draws = scene.draws.iter().enumerate().map(|(number, draw)| {
        json!({ "number": number, "name": draw.name, "target": draw.target, "stages": draw.combiners.stages.len() })
    });
    let textures = scene
        .textures
        .iter()
        .map(|texture| json!({ "name": texture.name, "kind": texture.kind.name(), "format": texture.format.name() }));
    json!({
        "profile": scene.profile.name(),
        "targets": targets.collect::<Vec<_>>(),
        "draws": draws.collect::<Vec<_>>(),
        "textures": textures.collect::<Vec<_>>(),
    })
}

/// The pixel under each value of each rule that has alternatives, the others being as they are.
fn alternatives(plan: &Plan, target: usize, pixel: (u32, u32)) -> Result<Value, Refused> {
    let mut other = plan.clone();
    let mut rules = Vec::new();
    for policy in POLICIES {
        let mut values = Vec::new();
        for (index, (value, meaning)) in policy.values.iter().enumerate() {
            other.policies = plan.policies;
            other.policies.choose(policy.rule, index);
            let found = trace(&other, target, pixel, None).map_err(|error| error.to_string())?;
            values.push(json!({
                "value": value, "meaning": meaning, "chosen": index == plan.policies.chosen(policy.rule),
                "shown": found.shown, "word": format!("{:#010x}", found.word),
            }));
        }
        rules.push(json!({ "rule": policy.rule, "question": policy.question, "values": values }));
    }
    Ok(json!({ "rules": rules }))
}
