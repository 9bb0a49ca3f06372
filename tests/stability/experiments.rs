//! Limits of methods: each threshold is tested from both sides, and the page has the results of the experiments.

use crate::repository::at;
use ninebit_lab::chart::page::{plain, replace_section};
use ninebit_lab::experiments::{self, Experiment, Threshold, experiments};
use std::fs;

/// Experiment, method, a value at which the method works, and a value at which it fails. `None` means that the method does not fail where
/// the experiment expects it to.
const PINNED: [(&str, &str, f64, Option<f64>); 38] = [
    ("squaring", "largest step between neighbouring pixels", 16.0, Some(32.0)),
    ("squaring", "largest error", 8.0, Some(16.0)),
    ("power-table", "32 texels, filtered", 8.0, Some(9.0)),
    ("power-table", "64 texels, filtered", 17.0, Some(18.0)),
    ("power-table", "128 texels, filtered", 34.0, Some(35.0)),
    ("power-table", "256 texels, filtered", 72.0, Some(73.0)),
    ("power-table", "512 texels, filtered", 148.0, Some(149.0)),
    ("power-table", "1024 texels, filtered", 316.0, Some(317.0)),
    ("subtraction", "(ZERO, ONE_MINUS_SRC_COLOR)", 126.0, Some(125.0)),
    ("subtraction", "reverse subtraction", 0.0, None),
    ("order", "additions first", 45.0, None),
    ("order", "subtractions first", 0.76, Some(0.91)),
    ("long-vectors", "dot product of a general stage", 1.7, Some(1.82)),
    ("long-vectors", "passes, additions first", 1.22, Some(1.31)),
    ("light-grazing", "bumps of up to 2 degrees", 3.15, Some(2.93)),
    ("light-grazing", "bumps of up to 10 degrees", 0.25, None),
    ("light-behind", "N . L", 0.01, Some(-0.04)),
    ("light-behind", "N . L times 4 L.z", 13.84, Some(13.0)),
    ("filtered-normals", "N . H", 55.39, Some(58.94)),
    ("filtered-normals", "(N . H)^8", 17.04, Some(18.23)),
    ("filtered-normals", "(N . H)^8, N renormalised", 47.65, Some(50.73)),
    ("minified-normals", "N . H, levels", 12.0, None),
    ("minified-normals", "(N . H)^8, levels", 2.74, Some(2.93)),
    ("minified-normals", "(N . H)^8, level 0 alone", 4.04, Some(4.31)),
    ("cube-resolution", "exponent 8", 32.0, Some(16.0)),
    ("cube-resolution", "exponent 32", 64.0, Some(32.0)),
    ("cube-resolution", "exponent 128", 64.0, Some(32.0)),
    ("half-vectors", "one quad", 0.4, Some(0.44)),
    ("half-vectors", "2 quads", 0.61, Some(0.66)),
    ("half-vectors", "4 quads", 1.03, Some(1.12)),
    ("half-vectors", "16 quads", 4.93, Some(5.26)),
    ("destination-alpha", "sum of equal parts", 8.0, Some(9.0)),
    ("destination-alpha", "product of equal factors", 7.0, Some(8.0)),
    ("emboss", "h(s) - h(s + d)", 1.01, Some(1.1)),
    ("emboss", "h(s - d/2) - h(s + d/2)", 6.27, Some(6.68)),
    ("mirrored-bases", "bases of the mesh, split where it is mirrored", 45.0, None),
    ("mirrored-bases", "binormal taken as N x T", 1.49, Some(1.64)),
    ("mirrored-bases", "one basis for both sides of the seam", 1.7, Some(1.87)),
];

fn find<'a>(experiments: &'a [Experiment], name: &str, method: &str) -> (&'a Experiment, &'a experiments::Method) {
    let experiment =
        experiments.iter().find(|experiment| experiment.name == name).unwrap_or_else(|| panic!("no experiment {name}"));
    let method = experiment.methods.iter().find(|known| known.name == method).unwrap_or_else(|| panic!("no {method}"));
    (experiment, method)
}

pub fn both_sides() {
    let experiments = experiments();
    let methods: usize = experiments.iter().map(|experiment| experiment.methods.len()).sum();
    assert_eq!(PINNED.len(), methods, "every method is pinned");
    for (name, method, works, fails) in PINNED {
        let (experiment, method) = find(&experiments, name, method);
        let error =
            |value: f64| (method.measure)(value).unwrap_or_else(|error| panic!("{}", error.render(false))).error;
        let at = |value: f64| format!("{name}, {}, at {}: {}", method.name, plain(value), error(value));
        assert!(error(works) <= experiment.limit, "{}", at(works));
        match fails {
            Some(value) => assert!(error(value) > experiment.limit, "{}", at(value)),
            None => assert!(error(method.fails) <= experiment.limit, "{}", at(method.fails)),
        }
    }
}

pub fn page() {
    let measured = experiments::page::measure(&|_, _| {}).unwrap_or_else(|error| panic!("{}", error.render(false)));
    for one in &measured {
        assert!(!one.thresholds.contains(&Threshold::Fails), "{}: a method works nowhere", one.experiment.name);
        let fails = one.thresholds.iter().any(|threshold| matches!(threshold, Threshold::Between { .. }));
        assert!(fails, "{}: nothing fails", one.experiment.name);
    }
    let (section, files) = experiments::page::files(&measured).unwrap();
    assert!(!section.contains("{{"), "a place of the template was not filled");
    let page = fs::read_to_string(at("docs/lab/stability.md")).unwrap();
    let made = replace_section(&page, "sweeps", &section).unwrap();
    assert!(made == page, "docs/lab/stability.md is another; `ninebit chart --only stability` makes it");
    for file in files {
        let stored = fs::read(at("docs/lab").join(&file.path)).unwrap_or_default();
        assert!(stored == file.bytes, "docs/lab/{} is another; `ninebit chart --only stability` makes it", file.path);
    }
}
