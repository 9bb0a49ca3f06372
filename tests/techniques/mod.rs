//! Measures the lighting techniques under `vectors/scenes/techniques`, and checks that their textures are what the generators make.
//!
//! `BLESS=1 cargo test --test suite techniques::` rewrites the figures; look at the difference before you commit.

mod claims;
mod listings;
mod passes;
mod per_pixel_lighting;

use crate::repository::at;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use ninebit::limits::Limits;
use ninebit_lab::accuracy::measure;
use ninebit_scene as scene;
use rayon::prelude::*;

use crate::bench::Bench;
use crate::scene_files;

fn folder() -> PathBuf {
    at("vectors/scenes/techniques")
}

/// Returns the folders of the families, sorted.
fn families() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path());
    let mut families: Vec<PathBuf> = entries.filter(|path| path.is_dir()).collect();
    families.sort();
    families
}

/// Returns the line of a scene: its name, its errors, its banding and its passes.
fn figures(path: &Path) -> String {
    let loaded = scene::load(path, &Limits::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(loaded.render_warnings(false), "", "{}", path.display());
    let truth = loaded.truth.as_ref().unwrap_or_else(|| panic!("{} has no truth", path.display()));
    let accuracy = measure(&loaded.scene, &loaded.plan, truth).unwrap();
    // The causes add up to the error, provided that everything drawn has a truth.
    if accuracy.without == 0 {
        let sum: f64 = accuracy.causes.iter().map(|cause| cause.errors.bias()).sum();
        assert!((sum - accuracy.errors.bias()).abs() < 1e-3, "{}: {sum}", path.display());
    }
    let name = path.strip_prefix(folder()).unwrap().with_extension("").display().to_string().replace('\\', "/");
    let (e, b, c) = (&accuracy.errors, &accuracy.banding, &accuracy.cost);
    let (rms, max, bias) = (e.rms(), e.max(), e.bias());
    let degrees = accuracy.normals.map_or("-".to_owned(), |normals| format!("{:.2}", normals.degrees.mean()));
    format!(
        "{name}\t{rms:.3}\t{max:.2}\t{bias:.3}\t{degrees}\t{}\t{}\t{}\t{}\t{}\t{:.1}",
        b.levels, b.truth_levels, b.flat_run, c.asked.passes, c.pruned.passes, c.asked.frame_buffer_bytes
    )
}

/// The figures of a scene in `figures.tsv`. Other tests read them in place of measuring again; `techniques_are_as_exact_as_they_were`
/// checks them.
#[derive(Clone, Copy)]
struct Figures {
    rms: f64,
    max: f64,
    bias: f64,
    levels: u32,
    truth_levels: u32,
    /// Numbers of passes as asked for, and after pruning.
    passes: (u32, u32),
}

/// Returns the stored figures of every scene, by folder and name.
fn all_pinned() -> &'static BTreeMap<String, Figures> {
    static PINNED: OnceLock<BTreeMap<String, Figures>> = OnceLock::new();
    PINNED.get_or_init(|| {
        let text = std::fs::read_to_string(folder().join("../../../tests/techniques/figures.tsv")).unwrap();
        let figures = text.lines().skip(1).map(|row| {
            let columns: Vec<&str> = row.split('\t').collect();
            let [rms, max, bias] = [1, 2, 3].map(|column| columns[column].parse().unwrap());
            let [levels, truth_levels, asked, left] = [5, 6, 8, 9].map(|column| columns[column].parse().unwrap());
            (columns[0].to_owned(), Figures { rms, max, bias, levels, truth_levels, passes: (asked, left) })
        });
        figures.collect()
    })
}

/// Returns the stored figures of a scene by its folder and name.
fn pinned(name: &str) -> Figures {
    *all_pinned().get(name).unwrap_or_else(|| panic!("no figures of {name}"))
}

#[test]
fn techniques_are_as_exact_as_they_were() {
    let files = scene_files::below(&folder());
    assert!(files.len() >= 15);
    let mut text =
        "scene\trms\tmax\tbias\tdegrees\tlevels\ttruth levels\tflat run\tpasses\tleft after pruning\tframe-buffer bytes\n".to_owned();
    let lines: Vec<String> = files.par_iter().map(|file| figures(file)).collect();
    lines.iter().for_each(|line| writeln!(text, "{line}").unwrap());
    let pinned = at("tests/techniques/figures.tsv");
    if crate::settings::bless() {
        std::fs::write(&pinned, &text).unwrap();
    }
    let expected = std::fs::read_to_string(&pinned).unwrap_or_default();
    let changed: Vec<&str> = text.lines().filter(|line| !expected.lines().any(|known| known == *line)).collect();
    assert!(text == expected, "{}\nBLESS=1 accepts these figures", changed.join("\n"));
}

#[test]
fn every_scene_has_a_line_in_its_readme() {
    for file in scene_files::below(&folder()) {
        let readme = std::fs::read_to_string(file.parent().unwrap().join("README.md")).unwrap();
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        assert!(readme.contains(&format!("`{name}`")), "{}", file.display());
    }
}

/// The commands in the page of each folder, run in order, generate exactly the stored files.
#[test]
fn textures_are_what_the_generators_make() {
    for family in families() {
        let readme = std::fs::read_to_string(family.join("README.md")).unwrap();
        let bench = Bench::new();
        let mut made = Vec::new();
        for command in readme.lines().filter_map(|line| line.strip_prefix("    ninebit ")) {
            bench.run(command).text();
            let output = command.split(" -o ").nth(1).unwrap_or_else(|| panic!("{command}"));
            let (stored, fresh) = (family.join(output), bench.path(output));
            let [stored, fresh] =
                [stored, fresh].map(|path| std::fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display())));
            assert!(stored == fresh, "{}: ninebit {command}", family.display());
            made.push(output.to_owned());
        }
        for entry in std::fs::read_dir(&family).unwrap() {
            let name = entry.unwrap().file_name().to_string_lossy().into_owned();
            if name.ends_with(".png") || name.ends_with(".dds") {
                assert!(made.contains(&name), "no command of {} makes {name}", family.display());
            }
        }
    }
}
