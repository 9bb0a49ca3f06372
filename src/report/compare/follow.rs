//! Modes in which the ideal takes every decision of the definition.

use super::draw::{Band, Draw, Method};
use super::meter::{Counts, Meter};
use ninebit::engine::walk;
use ninebit::number::{IDEAL_TRACKS, Ideal, IdealTracks, Pair};
use ninebit::rop::surface;
use ninebit::state::Named;
use ninebit::trace::{Observer, Part, Rule};

/// Errors accumulate, and are split into parts.
pub(super) struct Follow;

/// Each rule starts from the definition's integers.
pub(super) struct PerOp;

impl Method for Follow {
    type Lane = Pair<IdealTracks<IDEAL_TRACKS>>;

    fn draw(draw: &Draw<'_, Self::Lane>, band: &mut Band<'_, Self::Lane>, counts: &mut Counts) {
        follow(draw, band, &mut Meter::<false>(counts));
    }

    fn channel(shown: u8, held: Self::Lane, counts: &mut Counts) -> (f64, Option<[f64; Part::ALL.len()]>) {
        let observed = shown_as(shown, held, &mut Meter::<false>(counts));
        (observed.ideal.real(), Some(observed.ideal.parts()))
    }
}

impl Method for PerOp {
    type Lane = Pair<IdealTracks<1>>;

    fn draw(draw: &Draw<'_, Self::Lane>, band: &mut Band<'_, Self::Lane>, counts: &mut Counts) {
        follow(draw, band, &mut Meter::<true>(counts));
    }

    fn channel(shown: u8, held: Self::Lane, counts: &mut Counts) -> (f64, Option<[f64; Part::ALL.len()]>) {
        (shown_as(shown, held, &mut Meter::<true>(counts)).ideal.real(), None)
    }
}

/// Converts a stored channel to what the picture shows.
fn shown_as<I: Ideal>(shown: u8, held: Pair<I>, observer: &mut impl Observer) -> Pair<I> {
    observer.observe(Rule::Rop5, Pair { fixed: i32::from(shown), ..held })
}

fn follow<I: Ideal>(draw: &Draw<'_, Pair<I>>, band: &mut Band<'_, Pair<I>>, observer: &mut impl Observer) {
    let planned = draw.planned;
    walk::covered(draw.plan, planned, band.rows(), |context, i, j| {
        let at = band.at(i, j);
        let read = surface::read(planned.surface, band.words[at]);
        let destination = std::array::from_fn(|n| Pair { fixed: i32::from(read[n]), ..band.held[at][n] });
        if let Some(stored) = band.shade(context, (i, j), Some(destination), &draw.images.lane, observer) {
            band.hold(at, planned, &stored.channels);
        }
    });
}
