//! A session: a scene and the requests about it.

use std::path::Path;

use ninebit::diagnostic::{Diagnostic, Severity, Source};
use ninebit::engine::{FRAGMENTS, PixelTrace, PlaneOptions, plane_names, trace};
use ninebit::limits::Limits;
use ninebit::plan::Plan;
use ninebit::shortcut::{self, Shortcuts};
use ninebit::state::{Draw, Named, POLICIES, Policies, Rectangle, Scene};
use ninebit_report::planes::{PlanesError, plane_arrays};
use ninebit_report::trace_value;
use ninebit_scene::assets::Bundle;
use ninebit_scene::image::{ImageLimits, Rgba, decode};
use ninebit_scene::{LoadedScene, SceneError, parse_with, render};
use serde_json::{Value, json};

use crate::{Refused, frame, program, shader, tree};

/// A scene, the files that it names, and the latest picture.
///
/// A request is an object whose `do` names the action; the answer is an object, with a field `error` if the request was refused:
///
/// | `do` | fields | answer |
/// |---|---|---|
/// | `file` | `name`; the file's bytes | nothing; scenes may name the file from now on |
/// | `open` | `text`, `name` | `scene`: its targets, draws and textures; `findings`. A scene with errors leaves the one before in place |
/// | `policies` | `values`: rule to value; perhaps `shortcuts`: names of docs/evidence/shortcuts.md, joined by `+` | nothing; they hold from now on |
/// | `draw` | `target` | `width`, `height`, `digest`, and the picture |
/// | `depth` | `target` | `width`, `height`, the `low`est and `high`est depth, and as picture the words: 24 bits of depth, the lowest byte first, and the stencil |
/// | `heat` | `target`, `against`: `ideal`, `picture`, `rules` (no shortcuts), or an object as `values` | `differing`, `regions`, and the picture |
/// | `picture` | `name`; the file's bytes, PNG or TGA, or `width`, `height` and R, G, B, A of each pixel | `width`, `height`, and the picture; `heat` compares with it |
/// | `trace` | `target`, `pixel` | `trace`: the document of docs/trace-format.md |
/// | `planes` | `target`, `names`, `rectangle` (first column and row, columns, rows) | `width`, `height`, `planes`: of each step `name`, `step`, `kind` (`int32` or `uint32`) and `per_one`; and as picture their values, plane after plane, each the four bytes of a little-endian word |
/// | `plane_names` | `target` | `names` of values, each with its block |
/// | `alternatives` | `target`, `pixel` | `rules`: what the pixel would be under each value of each rule |
/// | `outline` | | `tree`: the values of the scene's text with their places |
/// | `program` | `draw` | `program`: its state, its words, its text |
/// | `lower` | `draw`, `language`: `c99` or `glsl` | `text`: a function of that language that computes the draw's fragment |
/// | `edit` | `draw`, `path`, `value` | `text`: the scene's text with that part of the program changed; `rewritten` if the program was in another language before |
/// | `paste` | `draw`, `language`, `program` | `text`: the scene's text with that program |
///
/// `draw`, `depth`, `heat`, `trace` and `alternatives` take `until`, the index of a draw: their answer is that after this draw instead of the last.
#[derive(Debug, Default)]
pub struct Session {
    files: Bundle,
    text: String,
    loaded: Option<(Scene, Plan)>,
    policies: Policies,
    /// What draws and traces take in place of rules.
    shortcuts: Shortcuts,
    /// The plan up to a draw, kept for requests with the same `until`.
    stepped: Option<(usize, Plan)>,
    second: Option<Rgba>,
    picture: Vec<[u8; 4]>,
}

impl Session {
    /// Answers a request. `file` is the content of the file that came with it.
    pub fn answer(&mut self, request: &[u8], file: Vec<u8>) -> String {
        let answer = serde_json::from_slice(request)
            .map_err(|error| format!("the request is not JSON: {error}"))
            .and_then(|request: Value| self.act(&request, file));
        answer.unwrap_or_else(|refused| json!({ "error": refused })).to_string()
    }

    /// Returns the latest picture: R, G, B, A, row by row from the top.
    pub fn picture(&self) -> &[[u8; 4]] {
        &self.picture
    }

    fn act(&mut self, request: &Value, file: Vec<u8>) -> Result<Value, Refused> {
        let text = |field| text(request, field);
        let number = |field| number(request, field);
        match text("do")? {
            "file" => {
                self.files.files.insert(text("name")?.to_owned(), file);
                Ok(json!({}))
            }
            "open" => Ok(self.open(text("text")?, text("name")?)),
            "policies" => {
                let chosen = shortcuts(&request["shortcuts"])?;
                (self.policies, self.shortcuts) = (policies(&request["values"])?, chosen);
                let (loaded, stepped) = (self.loaded.iter_mut(), self.stepped.iter_mut());
                for plan in loaded.map(|(_, plan)| plan).chain(stepped.map(|(_, plan)| plan)) {
                    plan.policies = self.policies;
                }
                Ok(json!({}))
            }
            "picture" => self.receive(request, &file),
            "outline" => Ok(json!({ "tree": tree::value(&self.text) })),
            what @ ("draw" | "depth") => {
                let target = self.target(number("target")?)?;
                let shortcuts = self.shortcuts;
                let plan = self.plan(number("until").ok())?;
                let (answer, picture) = frame::draw(plan, shortcuts, target, what == "depth")?;
                self.picture = picture;
                Ok(answer)
            }
            "heat" => self.compare(request),
            "trace" => {
                let (target, pixel) = (self.target(number("target")?)?, pixel(request)?);
                let shortcuts = self.shortcuts;
                let plan = self.plan(number("until").ok())?;
                Ok(json!({ "trace": trace_value(plan, &traced(plan, shortcuts, target, pixel)?) }))
            }
            "planes" => {
                let target = self.target(number("target")?)?;
                let (answer, words) = planes(self.plan(number("until").ok())?, target, request)?;
                self.picture = words;
                Ok(answer)
            }
            "plane_names" => {
                let target = self.target(number("target")?)?;
                let options = PlaneOptions { target, threads: 1, ..PlaneOptions::default() };
                let names =
                    plane_names(self.plan(number("until").ok())?, &options).map_err(|error| error.to_string())?;
                Ok(json!({ "names": names }))
            }
            "alternatives" => {
                let (target, pixel) = (self.target(number("target")?)?, pixel(request)?);
                let shortcuts = self.shortcuts;
                alternatives(self.plan(number("until").ok())?, shortcuts, target, pixel)
            }
            "program" => {
                let (scene, _) = self.loaded()?;
                Ok(json!({ "program": program::value(scene, drawn(scene, number("draw")?)?) }))
            }
            "lower" => {
                let (scene, _) = self.loaded()?;
                drawn(scene, number("draw")?)?;
                Ok(json!({ "text": program::lowered(scene, number("draw")?, self.policies, text("language")?)? }))
            }
            "edit" => self.edit(request),
            "paste" => {
                let written = program::pasted(text("language")?, text("program")?)?;
                Ok(json!({ "text": program::replaced(&self.text, number("draw")?, "program", &written)? }))
            }
            other => Err(format!("`{other}` is nothing that can be asked for")),
        }
    }

    /// Decodes a picture to compare with.
    fn receive(&mut self, request: &Value, file: &[u8]) -> Result<Value, Refused> {
        let picture = match (number(request, "width"), number(request, "height")) {
            (Ok(width), Ok(height)) => raw(file, width, height)?,
            _ => decode(file, Path::new(text(request, "name")?), &ImageLimits::default())
                .map_err(|error| format!("{}: {error}; {}", error.code(), error.help()))?,
        };
        let size = json!({ "width": picture.width(), "height": picture.height() });
        self.picture = picture.pixels().to_vec();
        self.second = Some(picture);
        Ok(size)
    }

    /// Compares the picture with that of another reading or renderer, with float64, or with the picture that was received.
    fn compare(&mut self, request: &Value) -> Result<Value, Refused> {
        let (target, against) = (self.target(number(request, "target")?)?, &request["against"]);
        self.step(number(request, "until").ok())?;
        let plan = self.plan_until(number(request, "until").ok())?;
        if against.as_str() == Some("ideal") && !self.shortcuts.is_empty() {
            return Err("float64 is compared with the chip's rules, without shortcuts".to_owned());
        }
        let this = || frame::picture(plan, self.shortcuts, target);
        let (answer, picture) = match against.as_str() {
            Some("ideal") => frame::against_ideal(plan, target),
            Some("rules") => frame::between(&this(), &frame::picture(plan, Shortcuts::NONE, target), false)?,
            Some(_) => frame::against_picture(&this(), self.second.as_ref())?,
            None => {
                let other = plan.clone().under(policies(against)?);
                frame::between(&this(), &frame::picture(&other, self.shortcuts, target), false)?
            }
        };
        self.picture = picture;
        Ok(answer)
    }

    /// Changes a program in the scene's text.
    fn edit(&self, request: &Value) -> Result<Value, Refused> {
        let (scene, _) = self.loaded()?;
        let number = number(request, "draw")?;
        let draw = drawn(scene, number)?;
        let start = if draw.program_origin.is_empty() { self.text.clone() } else { self.rewritten(scene, number)? };
        let changed = program::changed(draw, &request["path"], &request["value"])?;
        let text = program::replaced(&start, number, "program", &changed)?;
        Ok(json!({ "text": text, "rewritten": !draw.program_origin.is_empty() }))
    }

    fn loaded(&self) -> Result<&(Scene, Plan), Refused> {
        self.loaded.as_ref().ok_or_else(|| "there is no scene".to_owned())
    }

    /// Returns the scene's text with a draw's API program rewritten as combiners and texture shader. Returns an error if the draw is not the same
    /// then: other things that such a program sets, such as generated coordinates, have no other place.
    fn rewritten(&self, scene: &Scene, number: usize) -> Result<String, Refused> {
        let draw = drawn(scene, number)?;
        let mut text = program::replaced(&self.text, number, "program", &program::written(&draw.combiners))?;
        let mut same = self.reads_as(&text, scene, number);
        if !same {
            text = program::replaced(&text, number, "texture_shader", &shader::written(&draw.texture_shader))?;
            same = self.reads_as(&text, scene, number);
        }
        let refused = "this program sets more than combiners and texture shader: change it in the scene's text";
        if same { Ok(text) } else { Err(refused.to_owned()) }
    }

    fn reads_as(&self, text: &str, scene: &Scene, number: usize) -> bool {
        let Ok(loaded) = parse_with(text, Path::new("scene.ron"), &Limits::default(), &self.files) else {
            return false;
        };
        let mut expected = scene.draws.clone();
        expected[number].program_origin.clear();
        loaded.scene.draws == expected
    }

    /// Returns the plan of all draws, or of those up to `until`.
    fn plan(&mut self, until: Option<usize>) -> Result<&Plan, Refused> {
        self.step(until)?;
        self.plan_until(until)
    }

    fn step(&mut self, until: Option<usize>) -> Result<(), Refused> {
        let (scene, _) = self.loaded()?;
        let Some(until) = until.filter(|until| until + 1 < scene.draws.len()) else { return Ok(()) };
        if self.stepped.as_ref().is_none_or(|(at, _)| *at != until) {
            self.stepped = Some((until, frame::stepped(scene, until, self.policies)?));
        }
        Ok(())
    }

    fn plan_until(&self, until: Option<usize>) -> Result<&Plan, Refused> {
        let (_, whole) = self.loaded()?;
        Ok(self.stepped.as_ref().filter(|(at, _)| Some(*at) == until).map_or(whole, |(_, plan)| plan))
    }

    fn target(&self, number: usize) -> Result<usize, Refused> {
        let count = self.loaded()?.1.targets().len();
        if number < count { Ok(number) } else { Err(format!("there is no target {number}; the scene has {count}")) }
    }

    /// Reads a scene. If it has errors, the answer holds them and the previous scene stays.
    fn open(&mut self, text: &str, name: &str) -> Value {
        let limits = Limits::default();
        let loaded = parse_with(text, Path::new(name), &limits, &self.files);
        match loaded.and_then(|loaded| loaded.affordable(limits.shaded_pixels).map(|()| loaded)) {
            Ok(loaded) => {
                let LoadedScene { scene, plan, warnings, source, .. } = loaded;
                let answer = json!({ "scene": described(&scene), "findings": findings(&warnings, &source) });
                self.text = source.text;
                self.loaded = Some((scene, plan.under(self.policies)));
                self.stepped = None;
                answer
            }
            Err(error) => {
                let SceneError { diagnostics, suppressed, source } = &error;
                json!({ "findings": findings(diagnostics, source), "suppressed": suppressed, "rendered": error.render(false) })
            }
        }
    }
}

/// Reads policies from an object that maps rules to values; the others have their defaults.
fn text<'r>(request: &'r Value, field: &str) -> Result<&'r str, Refused> {
    request[field].as_str().ok_or_else(|| format!("`{field}` is not a text"))
}

fn number(request: &Value, field: &str) -> Result<usize, Refused> {
    let number = request[field].as_u64().and_then(|n| usize::try_from(n).ok());
    number.ok_or_else(|| format!("`{field}` is not a number"))
}

fn policies(values: &Value) -> Result<Policies, Refused> {
    let mut policies = Policies::default();
    for (rule, value) in values.as_object().into_iter().flatten() {
        let assignment = format!("{rule}={}", value.as_str().unwrap_or_default());
        policies.set(&assignment).map_err(|error| error.to_string())?;
    }
    Ok(policies)
}

/// Reads the names of shortcuts. There are none by default.
fn shortcuts(names: &Value) -> Result<Shortcuts, Refused> {
    match names.as_str().unwrap_or_default() {
        "" => Ok(Shortcuts::NONE),
        names => Shortcuts::from_names(names).map_err(|name| format!("there is no shortcut `{name:.60}`")),
    }
}

/// Traces a pixel as the rules have it, or a renderer with shortcuts.
fn traced(plan: &Plan, shortcuts: Shortcuts, target: usize, pixel: (u32, u32)) -> Result<PixelTrace, Refused> {
    let traced = match shortcuts.is_empty() {
        true => trace(plan, target, pixel, None),
        false => shortcut::trace(plan, shortcuts, target, pixel, FRAGMENTS),
    };
    traced.map_err(|error| error.to_string())
}

fn pixel(request: &Value) -> Result<(u32, u32), Refused> {
    let at = |n: usize| request["pixel"][n].as_u64().and_then(|n| u32::try_from(n).ok());
    at(0).zip(at(1)).ok_or_else(|| "`pixel` is not two numbers".to_owned())
}

/// Returns the description of planes, and their values.
fn planes(plan: &Plan, target: usize, request: &Value) -> Result<(Value, Vec<[u8; 4]>), Refused> {
    let names = request["names"].as_array().into_iter().flatten();
    let names: Option<Vec<String>> = names.map(|name| name.as_str().map(str::to_owned)).collect();
    let names = names.filter(|names| !names.is_empty()).ok_or("`names` is not a list of texts")?;
    let number = |n: usize| request["rectangle"][n].as_u64().and_then(|n| u32::try_from(n).ok());
    let rectangle = match request.get("rectangle") {
        None | Some(Value::Null) => None,
        Some(_) => {
            let [x, y, width, height] = [0, 1, 2, 3].map(number);
            let all =
                x.zip(y).zip(width.zip(height)).map(|((x, y), (width, height))| Rectangle { x, y, width, height });
            Some(all.ok_or("`rectangle` is not four numbers")?)
        }
    };
    let options = PlaneOptions { target, rectangle, threads: 1, ..PlaneOptions::default() };
    let found = plane_arrays(plan, &names, &options).map_err(|error| match &error {
        PlanesError::Unknown { .. } => format!("{} {error}; {}", PlanesError::UNKNOWN, error.help()),
        PlanesError::Place(_) => error.to_string(),
    })?;
    let (mut words, mut described) = (Vec::new(), Vec::new());
    for array in &found.arrays {
        for (step, plane) in array.steps.iter().zip(&array.planes) {
            let signed = plane.values.iter().all(|value| i32::try_from(*value).is_ok());
            if !signed && plane.values.iter().any(|value| u32::try_from(*value).is_err()) {
                return Err(format!("`{step}` has values of more than 32 bits"));
            }
            words.extend(plane.values.iter().map(|value| (*value as u32).to_le_bytes()));
            let per_one: Vec<i64> = plane.units.iter().map(|unit| unit.per_one).collect();
            let kind = if signed { "int32" } else { "uint32" };
            described.push(json!({ "name": array.name, "step": step, "kind": kind, "per_one": per_one.first() }));
        }
    }
    Ok((json!({ "width": found.rectangle.width, "height": found.rectangle.height, "planes": described }), words))
}

/// Returns the picture of R, G, B, A, row by row from the top.
fn raw(bytes: &[u8], width: usize, height: usize) -> Result<Rgba, Refused> {
    let (pixels, rest) = bytes.as_chunks();
    let fits = width > 0 && height > 0 && width.checked_mul(height) == Some(pixels.len()) && rest.is_empty();
    let columns = u32::try_from(width).ok().filter(|_| fits).ok_or("the bytes are not width times height pixels")?;
    Ok(Rgba::new(columns, pixels.to_vec()))
}

fn drawn(scene: &Scene, number: usize) -> Result<&Draw, Refused> {
    scene.draws.get(number).ok_or_else(|| format!("there is no draw {number}; the scene has {}", scene.draws.len()))
}

/// Returns findings as JSON: place, texts, and the rendered excerpt.
fn findings(findings: &[Diagnostic], source: &Source) -> Value {
    let value = |finding: &Diagnostic| {
        let inside = finding.file.as_ref().map_or(source, |file| &file.source);
        let place = finding.span.as_ref().map(|span| inside.position(span.start));
        // Span in the given text; for a finding about another file, the place where that file is named.
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

/// Converts a span of a text to UTF-16 units, as scripts count.
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

/// Returns the pixel under each value of each rule with alternatives; the other rules keep their values.
fn alternatives(plan: &Plan, shortcuts: Shortcuts, target: usize, pixel: (u32, u32)) -> Result<Value, Refused> {
    let mut other = plan.clone();
    let mut rules = Vec::new();
    for policy in POLICIES {
        let mut values = Vec::new();
        for (index, (value, meaning)) in policy.values.iter().enumerate() {
            other.policies = plan.policies;
            other.policies.choose(policy.rule, index);
            let found = traced(&other, shortcuts, target, pixel)?;
            values.push(json!({
                "value": value, "meaning": meaning, "chosen": index == plan.policies.chosen(policy.rule),
                "shown": found.shown, "word": format!("{:#010x}", found.word),
            }));
        }
        rules.push(json!({ "rule": policy.rule, "question": policy.question, "values": values }));
    }
    Ok(json!({ "rules": rules }))
}
