//! The reports of weights and of interpolated numbers to an observer. No value here is used elsewhere.

use super::binary::Binary;
use super::setup::{Triangle, edge_function};
use super::weights::{Linear, Number, Weights, differences};
use crate::trace::{Observer, Operand, Step, float_step, plain};

/// Returns a step that yields a number of WGT-1.
pub(crate) fn number_step(block: &str, rule: &'static str, name: impl Into<String>, value: Binary) -> Step {
    let Binary { mantissa, exponent } = shortest(value);
    Step { exponent: exponent as i32, ..Step::plain(block, rule, name, mantissa) }
}

/// Returns a number of WGT-1 as an operand.
pub(crate) fn number(name: impl Into<String>, value: Binary) -> Operand {
    let Binary { mantissa, exponent } = shortest(value);
    Operand { exponent: exponent as i32, ..plain(name, mantissa) }
}

/// Returns the same number as a whole one if it fits, otherwise with an odd mantissa.
fn shortest(n: Binary) -> Binary {
    if n.mantissa == 0 {
        return Binary::default();
    }
    let zeros = n.mantissa.trailing_zeros().into();
    match n.exponent {
        0.. if n.top() <= 62 => Binary { mantissa: n.steps(0), exponent: 0 },
        exponent if exponent >= 0 => n,
        exponent => {
            let down = (-exponent).min(zeros);
            Binary { mantissa: n.mantissa >> down, exponent: exponent + down }
        }
    }
}

/// Returns the step of an edge function, which is negative outside, or of the side of a line, at a pixel.
fn edge_step(
    block: &str,
    rule: &'static str,
    (prefix, name): (&str, &str),
    [a, b, c]: [i64; 3],
    (x, y): (i64, i64),
) -> Step {
    let inputs = vec![
        plain(format!("d{name}/dx"), a),
        plain(format!("d{name}/dy"), b),
        plain(format!("{name}.origin"), c),
        plain("x", x),
        plain("y", y),
    ];
    Step::plain(block, rule, format!("{prefix}{name}"), edge_function([a, b, c], x, y)).by("edge_function", inputs)
}

/// Reports edge functions of a triangle at a pixel. The names begin with `prefix`.
pub(crate) fn edges<O: Observer>(
    block: &str,
    (rule, prefix): (&'static str, &str),
    triangle: &Triangle,
    pixel: (i64, i64),
    observer: &mut O,
) {
    for (k, edge) in triangle.edge_functions().into_iter().enumerate() {
        let is_behind = triangle.behind[k];
        let rule = if is_behind { "RAS-8" } else { rule };
        let step = edge_step(block, rule, (prefix, &format!("E{k}")), edge, pixel);
        let owns = if triangle.owns[k] { "left or top edge" } else { "right or bottom edge" };
        let on_edge = (matches!(rule, "RAS-3" | "RAS-8") && step.value == 0).then(|| format!("exactly on a {owns}"));
        let turned = is_behind.then(|| format!("negative inside: vertex {k} lies behind the eye"));
        observer.step(step.note(on_edge.or(turned)));
    }
}

/// LIN-1, LIN-2, PNT-1: reports the box of a line or a point, and its sides at a pixel: inside none is negative.
pub(crate) fn stroke<O: Observer>(
    block: &str,
    rule: &'static str,
    figure: &Triangle,
    pixel: (i64, i64),
    observer: &mut O,
) {
    let (columns, rows) = (figure.columns, figure.rows);
    for (name, value) in [("left", columns.0), ("right", columns.1 - 1), ("top", rows.0), ("bottom", rows.1 - 1)] {
        observer.step(Step::plain(block, rule, format!("box.{name}"), value));
    }
    for (k, side) in figure.sides.into_iter().enumerate().filter(|(_, side)| *side != [0; 3]) {
        observer.step(edge_step(block, rule, ("", &format!("side{k}")), side, pixel));
    }
}

/// Reports e, S, R and e R, from edge functions that are reported without `prefix` or with that of `edges`.
pub(crate) fn shares<O: Observer>(
    block: &str,
    (rule, edges, prefix): (&'static str, &str, &str),
    (e, ratios): ([i64; 3], Option<[Binary; 3]>),
    weights: &Weights<Binary>,
    observer: &mut O,
) {
    let step = |name: String, value: Binary| number_step(block, rule, format!("{prefix}{name}"), value);
    let cut = |k: usize, observer: &mut O| {
        let edge = plain(format!("{edges}E{k}"), e[k]);
        let step = step(format!("e{k}"), weights.edges[k]);
        observer.tell(match ratios.filter(|_| k != 1) {
            Some(ratios) => step.by("cut_24_product", vec![edge, number(format!("r{k}"), ratios[k])]),
            None => step.by("cut_24", vec![edge]),
        })
    };
    let edges = [0, 1, 2].map(|k| cut(k, observer));
    let sum = observer.tell(step("S".into(), weights.sum).by("edge_sum", edges.to_vec()));
    let reciprocal = observer.tell(step("R".into(), weights.reciprocal).by("reciprocal", vec![sum]));
    for (k, edge) in edges.into_iter().enumerate() {
        let share = step(format!("b{k}"), weights.shares[k]);
        observer.step(share.by("cut_24_product", vec![edge, reciprocal.clone()]));
    }
}

/// WGT-1: reports all numbers of the weights at a sample. `ideal` holds those of the ideal.
pub(crate) fn weights<O: Observer>(
    block: &str,
    prefix: &str,
    (e, ratios): ([i64; 3], Option<[Binary; 3]>),
    weights: &Weights<Binary>,
    ideal: Option<[f64; 3]>,
    observer: &mut O,
) {
    shares(block, ("WGT-1", prefix, prefix), (e, ratios), weights, observer);
    let d = weights.dominant;
    let others: [usize; 2] = [[1, 2], [0, 2], [0, 1]][d];
    let others = others.map(|k| number(format!("{prefix}b{k}"), weights.b[k])).to_vec();
    let step = number_step(block, "WGT-1", format!("{prefix}b{d}"), weights.b[d]).by("rest_24", others);
    let note = "the largest binary exponent: the rest of the others".to_string();
    observer.step(Step { ideal: ideal.map(|ideal| ideal[d]), ..step.note(note) });
}

/// WGT-1: reports the ratios of w of a triangle in perspective.
pub(crate) fn ratios<O: Observer>(block: &str, triangle: &Triangle, taken: [f32; 3], observer: &mut O) {
    let Some(ratios) = triangle.ratios else { return };
    let w: [Operand; 3] = std::array::from_fn(|k| {
        observer.tell(float_step(block, "INT-6", format!("w{k}"), taken[k], f64::from(taken[k])))
    });
    for k in [0, 2] {
        let step = |name, value| number_step(block, "WGT-1", name, value);
        let reciprocal = step(format!("w{k}.reciprocal"), Binary::new(taken[k]).reciprocal::<false>());
        let reciprocal = observer.tell(reciprocal.by("reciprocal", vec![w[k].clone()]));
        observer.step(step(format!("r{k}"), ratios[k]).by("cut_24_product", vec![w[1].clone(), reciprocal]));
    }
}

/// The places of an interpolated number in a trace.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place<'a> {
    /// The block of the chip.
    pub(crate) block: &'a str,
    /// The rule that the values at the vertices come from.
    pub(crate) rule: &'static str,
    /// Name of the number, under which its values at the vertices are reported.
    pub(crate) name: &'a str,
    /// Prefix of the weights, and of the number away from the pixel.
    pub(crate) prefix: &'a str,
}

/// WGT-1: reports the values of a number at the vertices, its terms and its sum, and returns it as an operand.
pub(crate) fn linear<O: Observer>(place: Place<'_>, f: [f32; 3], b: [Binary; 3], observer: &mut O) -> Operand {
    let Place { block, rule, name, prefix } = place;
    let short = name.rsplit('.').next().unwrap_or(name);
    let own = if prefix.is_empty() { name.to_owned() } else { format!("{prefix}{short}") };
    let corners: [Operand; 3] =
        std::array::from_fn(|k| observer.tell(float_step(block, rule, format!("{name}.f{k}"), f[k], f64::from(f[k]))));
    let [first, third] = differences(f);
    let (value, outer) = (Linear::<Binary>::new(f), [b[0], b[2]]);
    let step = |suffix: &str, value: Binary| number_step(block, "WGT-1", format!("{own}{suffix}"), value);
    if [first, third] == [0.0; 2] {
        return observer.tell(step("", value.at(outer)).by("number", vec![corners[1].clone()]));
    }
    let terms = value.terms(outer);
    let mut products = [(0, first), (1, f[1]), (2, third)].map(|(k, difference)| {
        if k == 1 {
            return corners[1].clone();
        }
        let inputs = vec![corners[k].clone(), corners[1].clone()];
        let distance = float_step(block, "WGT-1", format!("{name}.d{k}"), difference, f64::from(difference));
        let distance = observer.tell(distance.by("float_difference", inputs));
        let product = step(&format!(".p{k}"), terms[k]);
        observer.tell(product.by("number_product", vec![number(format!("{prefix}b{k}"), b[k]), distance]))
    });
    let top = terms.iter().map(|term| term.top()).max().unwrap_or(0);
    let cut = [0, 1, 2].map(|k| {
        let unit = top.max(-1000) - 24;
        let term = Binary { mantissa: terms[k].steps(unit), exponent: unit };
        let term = observer.tell(step(&format!(".t{k}"), term).by("align_24", products.to_vec()));
        products.rotate_left(1);
        term
    });
    observer.tell(step("", value.at(outer)).by("number_sum", cut.to_vec()))
}
