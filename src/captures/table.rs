//! The table of frames: `vectors/captures/frames.tsv`.

use ninebit::state::Rectangle;
use ninebit_data::FRAMES;

/// A known difference of a frame, and the rule that is not fully understood.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KnownDifference {
    /// The rule's id.
    pub rule: &'static str,
    /// Number of pixels that differ.
    pub pixels: u64,
}

/// A row of the table of frames.
pub(super) struct Row {
    pub(super) suite: &'static str,
    pub(super) name: &'static str,
    pub(super) text: Vec<Rectangle>,
    pub(super) digest: &'static str,
    pub(super) open: Option<KnownDifference>,
}

/// Returns the rows in order.
pub(super) fn rows() -> impl Iterator<Item = Row> {
    FRAMES.lines().filter(|line| !line.starts_with('#')).filter_map(row)
}

fn row(line: &'static str) -> Option<Row> {
    let mut fields = line.split('\t');
    let (suite, name, text) = (fields.next()?, fields.next()?, fields.next()?);
    let rectangle = |text: &str| {
        let mut numbers = text.split(',').map(|number| number.parse().ok());
        let mut number = || numbers.next()?;
        Some(Rectangle { x: number()?, y: number()?, width: number()?, height: number()? })
    };
    let (text, digest) = (text.split(' ').filter_map(rectangle).collect(), fields.next()?);
    let open = |rest: &'static str| {
        let (rule, pixels) = rest.split_once(' ')?;
        Some(KnownDifference { rule, pixels: pixels.parse().ok()? })
    };
    Some(Row { suite, name, text, digest, open: fields.next().and_then(open) })
}
