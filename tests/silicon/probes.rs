//! Runs every probe of `vectors/silicon` through the model and compares with what a real NV2A showed, row by row.

use crate::table::{self, Row};
use crate::{blend_probes, combiner_probes, raster_probes, sheet, unit_probes, weights};
use rayon::prelude::*;

/// For each row the pixels that the model allows: one, or one for each value of an input that the capture leaves open.
pub type Answers = Vec<Vec<[u8; 4]>>;

/// Returns answers with one pixel for each row.
pub fn single(pixels: Vec<[u8; 4]>) -> Answers {
    pixels.into_iter().map(|pixel| vec![pixel]).collect()
}

/// A file of probes, and the function that answers at most [`sheet::WIDTH`] of its rows.
type Kind = (&'static str, fn(&[Row]) -> Answers);

const KINDS: [Kind; 24] = [
    ("blend-stack-a", blend_probes::stack_a),
    ("blend-stack-b", blend_probes::stack_b),
    ("blend-stack-c", blend_probes::stack_c),
    ("blend-spot", blend_probes::spot),
    ("surface-blend", blend_probes::surface),
    ("destination-alpha", blend_probes::destination_alpha),
    ("signed-texel", blend_probes::signed_texel),
    ("alpha-test", blend_probes::alpha_test),
    ("color-key", blend_probes::color_key),
    ("color-mask", blend_probes::color_mask),
    ("alpha-chain", blend_probes::alpha_chain),
    ("alpha-ramp", raster_probes::alpha_ramp),
    ("triangle-weights", raster_probes::triangle_weights),
    ("combiner-output", combiner_probes::outputs),
    ("combiner-output-alpha", combiner_probes::outputs_alpha),
    ("final-product-sum", combiner_probes::product_sum),
    ("final-sum", combiner_probes::final_sum),
    ("final-ef", combiner_probes::final_ef),
    ("fog-factor", combiner_probes::fog_factor),
    ("fog-lerp", combiner_probes::fog_lerp),
    ("fog-curve", combiner_probes::fog_curve),
    ("vertex-color", combiner_probes::vertex_color),
    ("texel-times-diffuse", combiner_probes::texel_times_diffuse),
    ("unbound-texture", combiner_probes::unbound),
];

/// Files whose rows have the columns of a unit of the conformance vectors, each with that unit.
const UNITS: [(&str, &str); 8] = [
    ("clip", "clip"),
    ("depth-range", "depth-range"),
    ("fog-exceptional", "fog-factor"),
    ("pixel-depth", "pixel-depth"),
    ("shadow-comparison", "shadow-comparison"),
    ("stencil-test", "stencil-test"),
    ("volume-layer", "volume-layer"),
    ("w-buffer", "w-buffer"),
];

/// A file whose rows are compared one by one, here with the oracle.
type Compared = (&'static str, fn(&Row) -> Option<String>);

const COMPARED: [Compared; 1] = [("weights", |row| weights::difference(row, weights::by_oracle))];

/// The result of comparing a row.
enum Outcome {
    /// There is one answer, and it is the captured pixel.
    Exact,
    /// There are several answers, and one of them is the captured pixel.
    Explained,
    /// No answer is the captured pixel.
    Wrong(String),
}

fn judge(file: &str, row: &Row, answers: &[[u8; 4]]) -> Outcome {
    let captured = row.captured();
    // The colours of these rows depend on a picture, so only alpha is compared.
    let first = if file == "color-mask" { 3 } else { 0 };
    let found = answers.iter().any(|answer| answer[first..] == captured[first..]);
    match (found, answers) {
        (true, [_]) => Outcome::Exact,
        (true, _) => Outcome::Explained,
        (false, _) => {
            let shown = &answers[..answers.len().min(4)];
            let rgba = &captured[first..];
            let line = row.line;
            Outcome::Wrong(format!("{file}.tsv:{line}: {}: expected {rgba:?}, got {shown:?}", row.describe()))
        }
    }
}

#[test]
fn every_probe() {
    let mut wrong = Vec::new();
    let mut totals = [0; 3];
    println!("{:<24}{:>8}{:>8}{:>11}", "file", "rows", "exact", "explained");
    for (file, answer) in KINDS {
        let rows = table::read(file);
        let outcomes: Vec<Outcome> = rows
            .par_chunks(sheet::WIDTH)
            .flat_map_iter(|chunk| {
                let answers = answer(chunk);
                assert_eq!(answers.len(), chunk.len(), "{file}");
                chunk.iter().zip(answers).map(|(row, answers)| judge(file, row, &answers)).collect::<Vec<_>>()
            })
            .collect();
        let (mut exact, mut explained) = (0, 0);
        for outcome in outcomes {
            match outcome {
                Outcome::Exact => exact += 1,
                Outcome::Explained => explained += 1,
                Outcome::Wrong(message) => wrong.push(message),
            }
        }
        println!("{file:<24}{:>8}{exact:>8}{explained:>11}", rows.len());
        totals = [totals[0] + rows.len(), totals[1] + exact, totals[2] + explained];
    }
    let of_units = UNITS.map(|(file, unit)| {
        let rows = table::read(file);
        let differ = rows.iter().filter_map(|row| unit_probes::difference(file, unit, row)).collect();
        (file, rows.len(), differ)
    });
    let compared = COMPARED.map(|(file, difference)| {
        let rows = table::read(file);
        (file, rows.len(), rows.par_iter().filter_map(difference).collect())
    });
    let one_by_one: Vec<(&str, usize, Vec<String>)> = of_units.into_iter().chain(compared).collect();
    for (file, rows, differ) in one_by_one {
        let exact = rows - differ.len();
        println!("{file:<24}{rows:>8}{exact:>8}{:>11}", 0);
        totals = [totals[0] + rows, totals[1] + exact, totals[2]];
        wrong.extend(differ);
    }
    println!("{:<24}{:>8}{:>8}{:>11}", "all", totals[0], totals[1], totals[2]);
    for message in wrong.iter().take(20) {
        println!("{message}");
    }
    assert!(wrong.is_empty(), "{} of {} probes differ, the first ones above", wrong.len(), totals[0]);
    assert_eq!(totals[0], 45_501);
}
