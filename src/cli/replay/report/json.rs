//! Report as JSON.

use serde_json::{Value, json};

use crate::replay::{Cause, Comparison, Difference, Origin, Outcome, Problem, SceneReplay, Summary};
use ninebit::shown;
use ninebit_scene::diff::{Bucket, CHANNELS, Histogram};

/// Returns the report as a JSON document; `docs/ci.md` describes it.
pub fn json(all: &[SceneReplay]) -> String {
    let summary = Summary::from_replays(all);
    let document = json!({
        "format": "ninebit-replay-1",
        "version": env!("CARGO_PKG_VERSION"),
        "summary": {
            "scenes": summary.scenes, "match": summary.matching, "differs": summary.differing, "failed": summary.failed,
            "blessed": summary.blessed, "skipped": summary.skipped,
        },
        "scenes": all.iter().map(scene).collect::<Vec<_>>(),
    });
    format!("{}\n", shown::json(&format!("{document:#}")))
}

fn scene(one: &SceneReplay) -> Value {
    let (difference, problem) = match &one.outcome {
        Outcome::Differs(difference) => (Some(self::difference(difference)), None),
        Outcome::Failed(problem) => (None, Some(self::problem(problem))),
        _ => (None, None),
    };
    json!({
        "name": one.name,
        "path": shown::lossless(&one.path),
        "status": one.status(),
        "message": one.message(),
        "difference": difference,
        "problem": problem,
        "unwritten": one.unwritten.iter().map(self::problem).collect::<Vec<_>>(),
    })
}

fn problem(problem: &Problem) -> Value {
    json!({
        "code": problem.code, "exit": problem.exit_code(), "message": problem.message, "text": problem.text,
        "line": problem.place.map(|(line, _)| line), "column": problem.place.map(|(_, column)| column),
    })
}

fn difference(difference: &Difference) -> Value {
    let cause = difference.cause.map(|cause| match cause {
        Cause::Policy { rule, value, meaning } => json!({ "policy": rule, "value": value, "meaning": meaning }),
        Cause::Engine => json!({ "engine": "scalar" }),
    });
    json!({
        "target": difference.target,
        "expected": difference.expected,
        "drawn": difference.drawn,
        "cause": cause,
        "remarks": difference.remarks,
        "pixels": difference.known.as_ref().map(known_difference),
    })
}

/// Returns the histograms of channels with their names.
pub(crate) fn histograms<'h>(channels: impl IntoIterator<Item = (&'static str, &'h Histogram)>) -> Value {
    let channel = |(name, histogram): (&str, &Histogram)| {
        let bucket = |b: &Bucket| json!({ "from": b.from, "to": b.to, "pixels": b.pixels });
        let buckets: Vec<Value> = histogram.buckets().iter().map(bucket).collect();
        json!({ "channel": name, "pixels": histogram.different(), "largest": histogram.largest(), "histogram": buckets })
    };
    channels.into_iter().map(channel).collect()
}

fn known_difference(known: &Comparison) -> Value {
    let difference = &known.difference;
    let first = &known.first;
    json!({
        "picture": match &known.origin {
            Origin::File(path) => Some(shown::lossless(path)),
            Origin::Cause => None,
        },
        "pixels": difference.pixels(),
        "different": difference.different,
        "largest": difference.largest(),
        "channels": histograms(CHANNELS.into_iter().zip(&difference.channels)),
        "first": { "x": first.x, "y": first.y, "expected": first.expected, "drawn": first.drawn },
        "trace": known.traces.as_ref().map(|traces| &traces.drawn),
        "expected_trace": known.traces.as_ref().and_then(|traces| traces.expected.as_ref()),
    })
}
