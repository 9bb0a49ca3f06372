//! `ninebit chart`: everything is written from measurements, and again after it was deleted.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use crate::bench::Bench;

/// A square of one colour whose truth is another: off by two steps of red.
const SCENE: &str = "(version: 1, profile: Nv10, targets: [(width: 16, height: 16)], truth: (hemisphere: (sky: (51, 51, 51), ground: (51, 51, 51))), \
    draws: [(vertices: Matrix(matrix: Identity, mesh: Grid(columns: 1, rows: 1), diffuse: (RED, 51, 51)))])";

fn scenes() -> Bench {
    let bench = Bench::new();
    fs::create_dir_all(bench.path("techniques/flat")).unwrap();
    fs::create_dir_all(bench.path("techniques/other")).unwrap();
    bench.write("techniques/flat/README.md", "# Flat surfaces\n");
    bench.write("techniques/flat/tone-4.ron", SCENE.replace("RED", "55"));
    bench.write("techniques/flat/tone-16.ron", SCENE.replace("RED", "67"));
    bench.write("techniques/other/tone.ron", SCENE.replace("RED", "53"));
    bench
}

fn files(folder: &Path) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() {
            found.extend(files(&path).into_iter().map(|below| format!("{name}/{below}")));
        } else {
            found.insert(name);
        }
    }
    found
}

#[test]
fn deleting_the_folder_and_charting_restores_every_file() {
    let bench = scenes();
    let run = || bench.run("chart techniques --quick --out out").data();
    assert!(run().is_empty());
    let first = files(&bench.path("out"));
    for name in ["speed-accuracy.md", "stability.md", "speed-accuracy/techniques.csv", "speed-accuracy/figures.json"] {
        assert!(first.contains(name), "{name}: {first:?}");
    }
    for name in [
        "speed-accuracy",
        "flat-1-chip",
        "flat-1-here",
        "flat-1-pictures",
        "evaluators",
        "cost-pixels",
        "cost-draws",
        "cost-triangles",
        "cost-stages",
    ] {
        for format in ["svg", "png"] {
            assert!(first.contains(&format!("speed-accuracy/{name}.{format}")), "{name}: {first:?}");
        }
    }
    let page = fs::read_to_string(bench.path("out/speed-accuracy.md")).unwrap();
    assert!(!page.contains("{{"), "{page}");
    assert!(page.contains("### Flat surfaces\n") && page.contains("| tone 16 | "), "{page}");
    // Two squares of a family have the same truth, that of the other family stands alone.
    assert!(page.contains("\n| tone 4, tone 16 | tone 4 (2.31 steps) | none | none | tone 4 ("), "{page}");
    // The error is that of red alone: 2, 4 and 16 steps, over the root of three.
    for technique in ["| tone | 1.15 | 2 |", "| tone 4 | 2.31 | 4 |", "| tone 16 | 9.24 | 16 |"] {
        assert!(page.contains(technique), "{technique}: {page}");
    }
    // A light that stands alone has no chart.
    assert!(!first.iter().any(|name| name.contains("other-1")), "{first:?}");
    for picture in page.split("](speed-accuracy/").skip(1).map(|rest| rest.split(')').next().unwrap()) {
        assert!(first.contains(&format!("speed-accuracy/{picture}")), "{picture}");
    }
    let document: serde_json::Value =
        serde_json::from_slice(&fs::read(bench.path("out/speed-accuracy/figures.json")).unwrap()).unwrap();
    assert_eq!(document["format"], "ninebit-chart-2");
    assert_eq!(document["techniques"][1]["parameter"], 16);
    assert_eq!(document["techniques"][2]["cost"]["as_asked"]["per_final_pixel"]["frame_buffer_bytes"], 4.0);
    for evaluator in document["evaluators"].as_array().unwrap() {
        // Only the real numbers differ from the stored bytes.
        let real = evaluator["name"].as_str().unwrap().starts_with("float");
        assert_eq!(evaluator["error"].as_f64().unwrap() > 0.0, real, "{evaluator}");
    }
    fs::remove_dir_all(bench.path("out")).unwrap();
    run();
    assert_eq!(files(&bench.path("out")), first);
}

#[test]
fn a_page_alone_keeps_what_is_not_its_own() {
    let bench = scenes();
    fs::create_dir(bench.path("out")).unwrap();
    bench.write("out/stability.md", "# Mine\n\n<!-- sweeps -->\nold\n<!-- /sweeps -->\n\nafter\n");
    bench.run("chart --only stability --out out").data();
    let page = fs::read_to_string(bench.path("out/stability.md")).unwrap();
    assert!(page.starts_with("# Mine\n\n<!-- sweeps -->\n## Where methods fail\n"), "{page}");
    assert!(page.ends_with("<!-- /sweeps -->\n\nafter\n") && !page.contains("\nold\n"), "{page}");
    assert!(!bench.path("out/speed-accuracy.md").exists());
}

#[test]
fn what_cannot_be_charted_is_refused_and_nothing_is_written() {
    let bench = scenes();
    bench.run("chart nowhere --quick --out out").failed(4, "`nowhere` cannot be read");
    bench.write("techniques/other/broken.ron", "(version: 1");
    bench.run("chart techniques --quick --out out").failed(3, "broken.ron");
    fs::create_dir(bench.path("plain")).unwrap();
    bench.write("plain/a.ron", "(version: 1, profile: Nv10)");
    bench.run("chart plain --quick --out out").failed(3, "NB0396");
    bench.run("chart --only everything").failed(2, "--only");
    assert!(!bench.path("out").exists());
}

/// The cells of a line, by RFC 4180 as `pandas.read_csv` reads it.
fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut cell, mut quoted) = (Vec::new(), String::new(), false);
    let mut letters = line.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '"' if quoted && letters.peek() == Some(&'"') => {
                letters.next();
                cell.push('"');
            }
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(std::mem::take(&mut cell)),
            other => cell.push(other),
        }
    }
    assert!(!quoted, "{line}");
    cells.push(cell);
    cells
}

/// A table as pandas has it: columns by name, what is empty missing. Columns of numbers hold nothing else.
fn data_frame(text: &str) -> BTreeMap<String, Vec<Option<String>>> {
    let mut lines = text.lines().map(cells);
    let heading = lines.next().unwrap();
    let mut frame: BTreeMap<String, Vec<Option<String>>> = BTreeMap::new();
    for name in &heading {
        assert!(name.bytes().all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'_'), "{name}");
        assert!(frame.insert(name.clone(), Vec::new()).is_none(), "{name} stands twice");
    }
    for row in lines {
        assert_eq!(row.len(), heading.len(), "{row:?}");
        for (name, cell) in heading.iter().zip(row) {
            frame.get_mut(name).unwrap().push(Some(cell).filter(|cell| !cell.is_empty()));
        }
    }
    for (name, column) in frame.iter().filter(|(name, _)| !["family", "technique", "truth"].contains(&name.as_str())) {
        for cell in column.iter().flatten() {
            assert!(cell.parse::<f64>().is_ok_and(f64::is_finite), "{name}: {cell}");
        }
    }
    frame
}

#[test]
fn the_table_is_what_pandas_reads_and_what_the_page_describes() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let frame = data_frame(&fs::read_to_string(docs.join("speed-accuracy/techniques.csv")).unwrap());
    let page = fs::read_to_string(docs.join("speed-accuracy.md")).unwrap();
    let described: BTreeSet<&str> =
        page.lines().filter_map(|line| line.strip_prefix("| `")?.split_once("` |")).map(|(name, _)| name).collect();
    assert_eq!(frame.keys().map(String::as_str).collect::<BTreeSet<_>>(), described);
    // Whole numbers are written as such: pandas makes integers of them.
    for name in ["asked_passes", "pruned_passes", "levels", "asked_most_stages"] {
        assert!(frame[name].iter().all(|cell| cell.as_ref().is_some_and(|n| n.parse::<u32>().is_ok())), "{name}");
    }
    // The charts follow from it: of each truth the most exact way.
    let rows = frame["rms"].len();
    assert!(rows > 90 && frame["truth"].iter().all(Option::is_some));
    let of = |name: &str, row: usize| frame[name][row].clone().unwrap_or_default();
    let best = |truth: &str| {
        let ways = (0..rows).filter(|row| of("truth", *row) == truth);
        ways.min_by(|a, b| of("rms", *a).parse::<f64>().unwrap().total_cmp(&of("rms", *b).parse().unwrap())).unwrap()
    };
    for (truth, technique) in [
        ("diffuse", "world-space-diffuse"),
        ("normalisation", "smooth-cube-16-table"),
        ("hemisphere", "hemisphere-exact"),
    ] {
        assert_eq!(of("technique", best(truth)), technique);
    }
    // Twelve passes are asked for, five are left, three do.
    let height = |name: &str, parameter: &str| {
        (0..rows).find(|row| of("technique", *row) == name && of("parameter", *row) == parameter).unwrap()
    };
    let passes = [("height", "12"), ("height", "5"), ("height", "3")]
        .map(|(name, parameter)| height(name, parameter))
        .map(|row| (of("asked_passes", row), of("pruned_passes", row)));
    assert_eq!(passes, [("12", "5"), ("5", "5"), ("3", "3")].map(|(a, b)| (a.to_owned(), b.to_owned())));
}

/// A text of an SVG: what it says, and its box.
type Label = (String, [f64; 4]);

/// The texts of an SVG that stand level.
fn labels(svg: &str) -> Vec<Label> {
    let mut found = Vec::new();
    for element in svg.split("<text ").skip(1) {
        let (attributes, rest) = element.split_once('>').unwrap();
        let text = rest.split_once("</text>").unwrap().0;
        let text = text.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&").replace("&quot;", "\"");
        let attribute = |name: &str| {
            let start = attributes.find(&format!("{name}=\""))? + name.len() + 2;
            attributes[start..].split('"').next()
        };
        if attribute("transform").is_some() || text.contains('<') && text.contains("tspan") {
            continue;
        }
        let number = |name: &str| {
            attribute(name).and_then(|n| n.parse::<f64>().ok()).unwrap_or_else(|| panic!("{name}: {attributes}"))
        };
        let size = number("font-size");
        let width = ninebit_lab::chart::labels::text_width(&text, size);
        let left = match attribute("text-anchor") {
            Some("middle") => number("x") - width / 2.0,
            Some("end") => number("x") - width,
            _ => number("x"),
        };
        found.push((text, [left, number("y") - 0.75 * size, width, 0.9 * size]));
    }
    found
}

/// Of every chart of the documents, computed from the boxes of its texts.
#[test]
fn no_label_of_a_chart_covers_another() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let (mut charts, mut covered) = (0, Vec::new());
    for folder in ["speed-accuracy", "stability"] {
        for name in files(&docs.join(folder)).iter().filter(|name| name.ends_with(".svg")) {
            let labels = labels(&fs::read_to_string(docs.join(folder).join(name)).unwrap());
            assert!(labels.len() > 3, "{name}");
            charts += 1;
            for (n, (text, [x, y, width, height])) in labels.iter().enumerate() {
                for (other, [ox, oy, other_width, other_height]) in &labels[n + 1..] {
                    let across = (x + width).min(ox + other_width) - x.max(*ox);
                    let down = (y + height).min(oy + other_height) - y.max(*oy);
                    if across > 0.5 && down > 0.5 {
                        covered.push(format!("{folder}/{name}: `{text}` and `{other}` share {across:.1} x {down:.1}"));
                    }
                }
            }
        }
    }
    assert!(charts > 30, "{charts}");
    assert!(covered.is_empty(), "{}", covered.join("\n"));
}

#[test]
fn evaluators_of_a_file_stand_beside_those_of_the_program() {
    let bench = scenes();
    let row = |name: &str| {
        format!(
            r#"{{"name": "{name}", "surface": "one unit, one stage", "yields": "other bytes", "error": 1.5, "largest": 9, "time": {{"median": 4, "lower": 3, "upper": 5}}}}"#
        )
    };
    let file = format!(r#"{{"format": "ninebit-evaluators-1", "evaluators": [{}]}}"#, row("peer"));
    bench.write("others.json", &file);
    bench.run("chart techniques --quick --only speed --evaluators others.json --out out").data();
    let page = fs::read_to_string(bench.path("out/speed-accuracy.md")).unwrap();
    assert!(page.contains("| peer | one unit, one stage | 4 (3 to 5) | 1.50 | 9 | other bytes |"), "{page}");
    let chart = fs::read_to_string(bench.path("out/speed-accuracy/evaluators.svg")).unwrap();
    assert!(chart.contains(">peer</text>"), "{chart}");
    bench.write("broken.json", file.replace("\"upper\": 5", "\"upper\": 1"));
    bench.run("chart techniques --evaluators broken.json --out no").failed(3, "NB0537");
    bench.run("chart techniques --evaluators absent.json --out no").failed(4, "NB0536");
    assert!(!bench.path("no").exists());
}
