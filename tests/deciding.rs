//! Tests the scenes of `vectors/scenes/deciding`. The values of a policy look clearly different in its scene, and no other policy changes
//! the scene.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::repository::at;
use std::path::{Path, PathBuf};

use ninebit::engine::{RenderOptions, render, trace};
use ninebit::limits::Limits;
use ninebit::plan::Plan;
use ninebit::replay::{Options, find, replay};
use ninebit::state::{POLICIES, Policies, Policy, Profile};
use ninebit_files::output::{Compression, encode_png};
use ninebit_scene as scene;
use ninebit_scene::diff::{self, compare};
use ninebit_scene::image::Rgba;
use ninebit_vectors::cases::{self, Level};
use ninebit_vectors::unit::Conditions;
use ninebit_vectors::{Unit, units};

/// Two pictures must differ by at least this many levels of 255, in at least `PIXELS` adjacent pixels.
const LEVELS: u8 = 32;
const PIXELS: u64 = 4096;

fn folder() -> PathBuf {
    at("vectors/scenes/deciding")
}

/// Returns the plan of the scene that decides a policy.
fn scene_of(policy: &Policy) -> Plan {
    let prefix = format!("{}-", policy.rule);
    let named = |path: &Path| path.file_name().unwrap().to_string_lossy().starts_with(&prefix);
    let entries = find(&[folder()]).unwrap();
    let files: Vec<_> = entries.iter().filter(|entry| named(&entry.path)).collect();
    assert_eq!(files.len(), 1, "scenes for {}", policy.rule);
    let loaded = scene::load(&files[0].path, &Limits::default()).unwrap_or_else(|error| panic!("{error}"));
    assert!(loaded.warnings.is_empty(), "{}", loaded.render_warnings(false));
    loaded.plan
}

fn picture(plan: &Plan, rule: &str, value: usize) -> Rgba {
    let mut plan = plan.clone();
    plan.policies = Policies::DEFAULT;
    plan.policies.choose(rule, value);
    let surface = render(&plan, &RenderOptions::default()).surfaces.swap_remove(0);
    Rgba::new(surface.width, surface.rgba8())
}

/// Returns the size of the largest region in which a channel of each pixel differs by `LEVELS` or more.
fn apart(a: &Rgba, b: &Rgba) -> u64 {
    let far = |(a, b): (&[u8; 4], &[u8; 4])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) >= LEVELS);
    let marks = a.pixels().iter().zip(b.pixels()).map(far).map(|far| if far { [255; 4] } else { [0; 4] }).collect();
    let nothing = Rgba::new(a.width(), vec![[0; 4]; a.pixels().len()]);
    let found = compare(&nothing, &Rgba::new(a.width(), marks), &diff::Options::default()).unwrap();
    found.regions.first().map_or(0, |region| region.pixels)
}

#[test]
fn values_of_a_policy_look_different() {
    for policy in POLICIES {
        let plan = scene_of(policy);
        let pictures: Vec<Rgba> = (0..policy.values.len()).map(|value| picture(&plan, policy.rule, value)).collect();
        for (n, a) in pictures.iter().enumerate() {
            for (m, b) in pictures.iter().enumerate().skip(n + 1) {
                let (first, second) = (policy.values[n].0, policy.values[m].0);
                assert!(apart(a, b) >= PIXELS, "{}: {first} and {second}: {}", policy.rule, apart(a, b));
            }
        }
    }
}

/// Numbers of columns and rows of cells, and width and height of a cell in pixels.
const CELLS: [u32; 2] = [8, 3];
const CELL: [u32; 2] = [32, 64];

/// Returns the colour in the middle of each cell.
fn cells(plan: &Plan, rule: &str, value: usize) -> Vec<[u8; 4]> {
    let mut plan = plan.clone();
    plan.policies = Policies::DEFAULT;
    plan.policies.choose(rule, value);
    let middle = |n: u32| (n % CELLS[0] * CELL[0] + CELL[0] / 2, n / CELLS[0] * CELL[1] + CELL[1] / 2);
    (0..CELLS[0] * CELLS[1]).map(|n| trace(&plan, 0, middle(n), None).unwrap().shown).collect()
}

#[test]
fn a_scene_asks_one_question() {
    for policy in POLICIES {
        let plan = scene_of(policy);
        let default = cells(&plan, policy.rule, 0);
        assert!((1..policy.values.len()).all(|value| cells(&plan, policy.rule, value) != default), "{}", policy.rule);
        for other in POLICIES.iter().filter(|other| other.rule != policy.rule) {
            for value in 1..other.values.len() {
                let same = cells(&plan, other.rule, value) == default;
                assert!(same, "{}={} changes the scene of {}", other.rule, other.values[value].0, policy.rule);
            }
        }
    }
}

/// With the default value the first row of cells is white and the second is black, as the scenes and their page state.
#[test]
fn rows_name_the_answer() {
    for policy in POLICIES {
        let picture = picture(&scene_of(policy), policy.rule, 0);
        let lit = |y: u32| picture.pixels()[(y * 256) as usize..][..256].iter().all(|pixel| *pixel == [255; 4]);
        let dark = |y: u32| picture.pixels()[(y * 256) as usize..][..256].iter().all(|pixel| pixel[..3] == [0; 3]);
        assert!(
            (0..64).all(lit) && (64..128).all(dark),
            "{}: by the default value the first row of cells is not white, or the second not black: the scene of vectors/scenes/deciding, its README.md and \
             docs/evidence/hardware.md have to follow",
            policy.rule
        );
    }
}

/// Returns the lengths of the runs of white pixels in a row of a picture.
fn bars(picture: &Rgba, y: u32) -> Vec<usize> {
    let row = &picture.pixels()[(y * picture.width()) as usize..][..picture.width() as usize];
    let runs = row.chunk_by(|a, b| a == b).filter(|run| run[0] == [255; 4]);
    runs.map(<[_]>::len).collect()
}

#[test]
fn weights_of_eight_bits_show_as_a_wide_bar() {
    let loaded = scene::load(&folder().join("INT-2-ramp.ron"), &Limits::default()).unwrap();
    let picture = picture(&loaded.plan, "", 0);
    for (rows, width) in [(0..64, 4), (64..128, 8), (128..192, 4)] {
        assert!(rows.clone().all(|y| bars(&picture, y) == [width]), "{rows:?}");
    }
}

/// Scenes of open questions for which there is no policy: the name, the number of bands of 48 rows, and the codes with which the model
/// refuses the draw that the card answers. The first band belongs to the card.
const OPEN: [(&str, u32, &[&str]); 6] = [
    ("DEP-6-slope", 5, &["NB0402"]),
    ("FOG-3-third", 4, &[]),
    ("KEY-1-filter", 4, &["NB0402"]),
    ("SHD-1-filter", 4, &["NB0402"]),
    ("TEX-17-weights", 3, &[]),
    ("TEX-7-border", 3, &["NB0317"]),
];
const BAND: u32 = 48;

/// Returns one band of a picture.
fn band(picture: &Rgba, number: u32) -> Rgba {
    let pixels = picture.width() as usize * BAND as usize;
    let first = number as usize * pixels;
    Rgba::new(picture.width(), picture.pixels()[first..first + pixels].to_vec())
}

#[test]
fn bands_of_open_questions_look_different() {
    for (name, bands, refused) in OPEN {
        let loaded = scene::load(&folder().join(format!("{name}.ron")), &Limits::default()).unwrap();
        assert!(loaded.warnings.is_empty(), "{name}: {}", loaded.render_warnings(false));
        let picture = picture(&loaded.plan, "", 0);
        assert_eq!(picture.height(), bands * BAND, "{name}");
        let all: Vec<Rgba> = (0..bands).map(|number| band(&picture, number)).collect();
        for (n, a) in all.iter().enumerate().skip(1) {
            for (m, b) in all.iter().enumerate().skip(n + 1) {
                assert!(apart(a, b) >= 900, "{name}: bands {} and {}: {}", n + 1, m + 1, apart(a, b));
            }
        }
        // If the model does not refuse the draw, the first band shows its own reading, which is that of the second.
        if refused.is_empty() {
            assert_eq!(all[0].pixels(), all[1].pixels(), "{name}");
        } else {
            assert!(
                all[0].pixels().iter().all(|pixel| *pixel == all[0].pixels()[0]),
                "{name}: somebody draws the card's band"
            );
        }
    }
}

/// The draw for the card stands behind `// ? ` in its scene. The model refuses it only because of the rule in question.
#[test]
fn open_questions_are_refused_by_name() {
    for (name, _, refused) in OPEN {
        let text = std::fs::read_to_string(folder().join(format!("{name}.ron"))).unwrap();
        assert_eq!(text.matches("// ? ").count(), usize::from(!refused.is_empty()), "{name}");
        let path = Path::new("question.ron");
        let asked = scene::parse(&text.replace("// ? ", ""), path, &Limits::default());
        let rule = name.rsplit_once('-').unwrap().0;
        match asked {
            Ok(loaded) => assert!(refused.is_empty() && loaded.warnings.is_empty(), "{name}"),
            Err(error) => {
                for finding in &error.diagnostics {
                    assert!(refused.contains(&finding.code), "{name}: {error}");
                    assert_eq!(finding.rule, Some(rule), "{name}: {error}");
                }
                assert!(!refused.is_empty(), "{name}: {error}");
            }
        }
    }
}

/// Returns the latest chip that has a unit.
fn chip(unit: &dyn Unit) -> Profile {
    *unit.profiles().last().unwrap()
}

/// Returns the results of a row of a unit, or `None` if the inputs do not go together.
fn row(unit: &dyn Unit, inputs: &[i64]) -> Option<Vec<i64>> {
    let mut results = vec![0; unit.results().len()];
    let conditions = Conditions { profile: chip(unit), policies: Policies::DEFAULT };
    unit.evaluate(inputs, &conditions, &mut results);
    unit.accepts(inputs, conditions.profile).then_some(results)
}

/// A deciding scene, its picture, and the unit with rows of its readings.
struct Question {
    plan: Plan,
    picture: Rgba,
    unit: &'static dyn Unit,
}

impl Question {
    fn new(scene: &str, unit: &str) -> Question {
        let plan = scene::load(&folder().join(format!("{scene}.ron")), &Limits::default()).unwrap().plan;
        Question { picture: picture(&plan, "", 0), plan, unit: units::by_name(unit).unwrap() }
    }

    /// Returns the results of a row in a reading, or `None` if the unit does not accept it.
    fn answer(&self, reading: usize, inputs: &[i64]) -> Option<Vec<i64>> {
        row(self.unit, &[&[reading as i64], inputs].concat())
    }

    /// Returns a pixel of the band of a reading; the first band is the card's.
    fn pixel(&self, reading: usize, column: u32, y: u32) -> [u8; 4] {
        band(&self.picture, reading as u32 + 1).pixels()[(y * self.picture.width() + column) as usize]
    }

    /// Returns a step of the first draw that covers a pixel of the band of a reading.
    fn step(&self, reading: usize, (column, y): (u32, u32), name: &str) -> i64 {
        let pixel = (column, (reading as u32 + 1) * BAND + y);
        let draws = trace(&self.plan, 0, pixel, None).unwrap().draws;
        let step = draws.iter().flat_map(|draw| &draw.steps).find(|step| step.name == name);
        step.unwrap_or_else(|| panic!("{}: no {name} at {pixel:?}", self.unit.name())).value
    }

    /// Returns the weights of the linear filter in a column, which all bands share.
    fn weights(&self, column: u32) -> [i64; 2] {
        ["unit0.weight_u", "unit0.weight_v"].map(|name| self.step(0, (column, 24), name))
    }

    /// Checks that no two readings have the same answer in all of these columns.
    fn readings_differ<T: PartialEq>(&self, answers: &[Vec<T>]) {
        for (n, answer) in answers.iter().enumerate() {
            assert!(answers[n + 1..].iter().all(|other| other != answer), "{}", self.unit.name());
        }
    }
}

fn bits(n: f32) -> i64 {
    n.to_bits().into()
}

#[test]
fn rows_of_filtered_shadows_are_the_bands() {
    let question = Question::new("SHD-1-filter", "filtered-shadow");
    let mut answers = vec![Vec::new(); question.unit.readings().len()];
    for column in 0..256 {
        let [u, v] = question.weights(column);
        let less = 1;
        for (reading, answers) in answers.iter_mut().enumerate() {
            let inputs = [less, bits(24_576.0), 0x4000, 0xc000, 0x4000, 0xc000, u, v];
            let value = question.answer(reading, &inputs).unwrap()[2];
            let shown = question.pixel(reading, column, 24);
            assert_eq!(shown[..3], [value as u8; 3], "{} at column {column}", question.unit.readings()[reading]);
            answers.push(value);
        }
    }
    question.readings_differ(&answers);
}

#[test]
fn rows_of_filtered_keys_are_the_bands() {
    let question = Question::new("KEY-1-filter", "filtered-key");
    let blend = units::by_name("blend").unwrap();
    let mut answers = vec![Vec::new(); question.unit.readings().len()];
    for column in 0..256 {
        let [u, v] = question.weights(column);
        let (alpha, key, white) = (0, 0xffff_00ff, 0xffff_ffff);
        for (reading, answers) in answers.iter_mut().enumerate() {
            // The scene's key has the alpha 255.
            let texel = question.answer(reading, &[alpha, key, key, white, key, white, u, v]).unwrap();
            // Add, SourceAlpha, OneMinusSourceAlpha; over green, without a constant.
            let blended = row(blend, &[&[0, 4, 5], &texel[..], &[0, 128, 0, 255, 0, 0, 0, 0]].concat()).unwrap();
            let shown = question.pixel(reading, column, 24).map(i64::from);
            assert_eq!(shown[..3], blended[8..11], "{} at column {column}", question.unit.readings()[reading]);
            answers.push(texel);
        }
    }
    question.readings_differ(&answers);
}

#[test]
fn rows_of_slopes_of_w_buffers_are_the_bands() {
    let question = Question::new("DEP-6-slope", "w-buffer-slope");
    let corners = [[0, 0], [256, 0], [256, 48], [0, 48]];
    let split = units::by_name("primitive-split").unwrap();
    let readings = question.unit.readings();
    let mut answers = vec![Vec::new(); readings.len()];
    for column in 0..256 {
        for (reading, answers) in answers.iter_mut().enumerate() {
            let top = (reading as i64 + 1) * i64::from(BAND);
            let covered = (0..2).find_map(|triangle| {
                // Quads, the first vertex provokes, four vertices.
                let order = row(split, &[3, 0, 4, triangle]).unwrap();
                let corners = [0, 1, 2].map(|n| corners[order[n] as usize]);
                let along = |near: f32, far: f32| corners.map(|[x, _]| bits(if x == 0 { near } else { far }));
                let positions = corners.map(|[x, y]| [16 * x, 16 * (top + y)]).concat();
                let inputs = [
                    &positions[..],
                    &[i64::from(column), top + 24],
                    &along(0.0, 8000.0),
                    &along(1000.0, 16_000.0),
                    &[bits(32.0)],
                ];
                question.answer(reading, &inputs.concat())
            });
            let word = covered.unwrap()[0];
            // A plane at w = 3000 turns white what lies before it. The band of the last reading is drawn by hand.
            let white = question.pixel(reading, column, 24) == [255; 4];
            assert_eq!(white, word < 3000, "{} at column {column}: {word}", readings[reading]);
            if reading + 1 < readings.len() {
                assert_eq!(question.step(reading, (column, 24), "stored.z"), word, "{}: {column}", readings[reading]);
            }
            answers.push(word);
        }
    }
    question.readings_differ(&answers);
}

/// e is made at the vertices and linear between them, so the row with the same e stands for a column.
#[test]
fn rows_of_third_parameters_of_fog_are_the_bands() {
    let question = Question::new("FOG-3-third", "fog-third");
    let readings = question.unit.readings();
    let mut answers = vec![Vec::new(); readings.len()];
    for column in 0..256 {
        let d = (f64::from(column) + 0.5) / 128.0;
        for (reading, answers) in answers.iter_mut().enumerate() {
            // `Square`: x + x^2 = 3 d, which is d itself at both vertices.
            let x = if readings[reading] == "Square" { ((1.0 + 12.0 * d).sqrt() - 1.0) / 2.0 } else { d };
            let byte = question.answer(reading, &[bits(-0.05), bits(-0.05), bits(x as f32)]).unwrap()[0];
            // The coordinate, the products and the sum have 14 bits: e may be a step off, and a step is 0.7 at most.
            let shown = question.pixel(reading, column, 24)[0];
            assert!((i64::from(shown) - byte).abs() <= 1, "{} at column {column}: {byte}", readings[reading]);
            answers.push(byte);
        }
    }
    question.readings_differ(&answers);
}

#[test]
fn rows_of_weights_of_taps_are_the_bands() {
    let question = Question::new("TEX-17-weights", "tap-weights");
    let mut answers = vec![Vec::new(); question.unit.readings().len()];
    for column in 0..160 {
        // The first band has the taps: every third texel is white.
        let step = |name: &str| {
            let draws = trace(&question.plan, 0, (column, 24), None).unwrap().draws;
            draws.iter().flat_map(|draw| &draw.steps).find(|step| step.name == name).unwrap().value
        };
        let white = i64::from(column >= 80);
        let taps = [0, 1, 2, 3].map(|tap| {
            let texel = step(&format!("unit0.tap{tap}.u")).div_euclid(256);
            if texel.rem_euclid(3) == white { 255 } else { 0 }
        });
        let length = (step("unit0.quad1.u") - step("unit0.quad0.u")).abs();
        for (reading, answers) in answers.iter_mut().enumerate() {
            let value = question.answer(reading, &[&[length][..], &taps].concat()).unwrap()[1];
            let shown = question.pixel(reading, column, 24);
            assert_eq!(shown[..3], [value as u8; 3], "{} at column {column}", question.unit.readings()[reading]);
            answers.push(value);
        }
    }
    question.readings_differ(&answers);
}

#[test]
fn rows_of_filtered_borders_are_the_bands() {
    let question = Question::new("TEX-7-border", "border-filter");
    let mut answers = vec![Vec::new(); question.unit.readings().len()];
    for column in 0..256 {
        // From -1 to 2 in a texture of two texels, at the middle of the pixel.
        let u = -512 + 6 * i64::from(column) + 3;
        // The band of `Border` has the border as three texels beyond either edge.
        assert_eq!(question.step(0, (column, 24), "unit0.u") - 768, u);
        assert_eq!(question.step(1, (column, 24), "unit0.u"), u);
        for (reading, answers) in answers.iter_mut().enumerate() {
            let shown = question.pixel(reading, column, 24);
            for (channel, border) in [255, 0, 0].into_iter().enumerate() {
                let value = question.answer(reading, &[u, 128, 255, border]).unwrap()[1];
                assert_eq!(i64::from(shown[channel]), value, "{} at {column}", question.unit.readings()[reading]);
                answers.push(value);
            }
        }
    }
    question.readings_differ(&answers);
}

/// Every open question has a unit on the chip of its scene, and between any two readings, dozens of rows of the table decide.
#[test]
fn tables_tell_readings_apart() {
    let asking: Vec<_> = units::all().into_iter().filter(|unit| !unit.readings().is_empty()).collect();
    assert_eq!(asking.len(), OPEN.len());
    for unit in asking {
        let prefix = format!("{}-", unit.rules()[0]);
        let (name, bands, _) = OPEN.iter().find(|(name, ..)| name.starts_with(&prefix)).unwrap();
        let readings = unit.readings().len();
        assert_eq!(readings, *bands as usize - 1, "{name}");
        let plan = scene::load(&folder().join(format!("{name}.ron")), &Limits::default()).unwrap().plan;
        assert!(unit.profiles().contains(&plan.profile), "{name}");
        let mut apart = vec![0; readings * readings];
        cases::visit(unit, chip(unit), Level::L0, 1, |inputs, _| {
            let mut inputs = inputs.to_vec();
            let answers = (0..readings as i64).map(|reading| {
                inputs[0] = reading;
                row(unit, &inputs).unwrap()
            });
            let answers: Vec<_> = answers.collect();
            for n in 0..readings * readings {
                apart[n] += u32::from(answers[n / readings] != answers[n % readings]);
            }
        });
        let least = (0..apart.len()).filter(|n| n / readings != n % readings).map(|n| apart[n]).min().unwrap();
        assert!(least >= 50, "{}: {apart:?}", unit.name());
    }
}

/// As `docs/evidence/hardware.md` states, a replay of a captured picture names the policy that reproduces it.
#[test]
fn a_capture_is_recognised() {
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("scene.ron");
    std::fs::copy(folder().join("CMB-4-half-bias.ron"), &file).unwrap();
    let plan = scene::load(&file, &Limits::default()).unwrap().plan;
    let allowance = r#"(picture: "captured.png", pixels: 0, difference: 0, reason: "a card")"#;
    let expectation =
        format!(r#"(version: 1, target: "frame", width: 256, height: 192, sha256: "", allowance: {allowance})"#);
    std::fs::write(place.path().join("scene.expect.ron"), expectation).unwrap();
    for (value, says) in [(0, None), (1, Some("CMB-4=127 draws")), (2, Some("CMB-4=127.5 draws"))] {
        let captured = picture(&plan, "CMB-4", value);
        let png = encode_png(captured.width(), captured.height(), captured.pixels(), Compression::Fast).unwrap();
        std::fs::write(place.path().join("captured.png"), png).unwrap();
        let replayed = replay(&find(std::slice::from_ref(&file)).unwrap(), &Options::default(), &|_| {});
        let message = replayed[0].message();
        assert!(says.map_or(message.is_empty(), |says| message.contains(says)), "{value}: {message}");
    }
}
