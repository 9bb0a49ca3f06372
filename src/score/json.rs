//! The score as a document for programs.

use ninebit::shortcut::Shortcuts;
use serde_json::{Value, json};

use crate::explain::{Class, Counts};
use crate::run::{Run, Total};

/// Returns the document of all runs.
pub fn document(runs: &[Run]) -> Value {
    json!({
        "format": "ninebit-score-1",
        "version": env!("CARGO_PKG_VERSION"),
        "runs": runs.iter().map(run).collect::<Vec<_>>(),
    })
}

fn run(run: &Run) -> Value {
    let suites = run.suites().into_iter().map(|(name, of)| (name.to_owned(), total(&of)));
    let causes = run.causes.as_ref().map(|causes| {
        let cause = |cause: &crate::causes::Cause| {
            json!({
                "shortcuts": names(cause.variant),
                "rules": cause.variant.iter().flat_map(|s| s.reading().rules).collect::<Vec<_>>(),
                "pixels": cause.pixels,
                "yielded_pixels": cause.chance.hits,
                "expected_by_chance": cause.chance.expected,
            })
        };
        json!({
            "wrong_pixels": causes.wrong,
            "explained_pixels": causes.explained(),
            "pixels_beyond_the_rules": causes.open,
            "causes": causes.causes.iter().map(cause).collect::<Vec<_>>(),
        })
    });
    let frame = |frame: &crate::explain::FrameScore| {
        json!({
            "suite": frame.suite,
            "frame": frame.name,
            "class": class(frame.class),
            "pixels": counts(&frame.counts),
            "explained_pixels": frame.explanation.as_ref().map(|_| frame.explained()),
            "causes": frame.attributed.iter().map(|(number, pixels)| json!([number, pixels])).collect::<Vec<_>>(),
        })
    };
    json!({
        "name": run.name,
        "total": total(&run.total()),
        "suites": Value::Object(suites.collect()),
        "causes": causes,
        "foreign": run.foreign,
        "frames": run.frames.iter().map(frame).collect::<Vec<_>>(),
    })
}

fn names(variant: Shortcuts) -> Vec<&'static str> {
    variant.iter().map(ninebit::state::Named::name).collect()
}

fn class(class: Class) -> &'static str {
    match class {
        Class::Exact => "exact",
        Class::OffByOne => "off by one",
        Class::Wrong => "wrong",
        Class::Missing => "missing",
        Class::Unreadable => "unreadable",
    }
}

fn counts(of: &Counts) -> Value {
    json!({ "compared": of.compared, "wrong": of.wrong, "wrong_by_one": of.by_one, "wrong_by_more_than_eight": of.far })
}

fn total(of: &Total) -> Value {
    json!({
        "frames": of.frames,
        "exact": of.exact,
        "off_by_one": of.off_by_one,
        "wrong": of.wrong,
        "missing": of.missing,
        "unreadable": of.unreadable,
        "pixels": counts(&of.pixels),
    })
}
