//! Modes in which the ideal takes every decision of the definition.

use super::draw::{Band, Draw, Method};
use super::meter::{Counts, Meter};
use ninebit::engine::pixel::{DepthStencil, Fragment};
use ninebit::engine::walk;
use ninebit::number::{IDEAL_TRACKS, Ideal, IdealTracks, Paired};
use ninebit::rop::surface;
use ninebit::state::Named;
use ninebit::trace::{Observer, Part, Rule};

/// Errors accumulate, and are split into parts.
pub(super) struct Follow;

/// Each rule starts from the definition's integers.
pub(super) struct PerOp;

impl Method for Follow {
    type Lane = Paired<IdealTracks<IDEAL_TRACKS>>;

    fn draw(draw: &Draw<'_, Self::Lane>, band: &mut Band<'_, Self::Lane>, counts: &mut Counts) {
        follow(draw, band, &mut Meter::<false>(counts));
    }

    fn channel(shown: u8, held: Self::Lane, counts: &mut Counts) -> (f64, Option<[f64; Part::ALL.len()]>) {
        let observed = shown_as(shown, held, &mut Meter::<false>(counts));
        (observed.ideal.real(), Some(observed.ideal.parts()))
    }
}

impl Method for PerOp {
    type Lane = Paired<IdealTracks<1>>;

    fn draw(draw: &Draw<'_, Self::Lane>, band: &mut Band<'_, Self::Lane>, counts: &mut Counts) {
        follow(draw, band, &mut Meter::<true>(counts));
    }

    fn channel(shown: u8, held: Self::Lane, counts: &mut Counts) -> (f64, Option<[f64; Part::ALL.len()]>) {
        (shown_as(shown, held, &mut Meter::<true>(counts)).ideal.real(), None)
    }
}

/// Converts a stored channel to what the picture shows.
fn shown_as<I: Ideal>(shown: u8, held: Paired<I>, observer: &mut impl Observer) -> Paired<I> {
    observer.observe(Rule::Rop5, Paired { fixed: i32::from(shown), ..held })
}

fn follow<I: Ideal>(draw: &Draw<'_, Paired<I>>, band: &mut Band<'_, Paired<I>>, observer: &mut impl Observer) {
    let planned = draw.planned;
    walk::covered(draw.plan, planned, band.rows(), |context, i, j| {
        let at = band.at(i, j);
        let mut depth = DepthStencil::new(band.depth.get(at).copied().unwrap_or(0));
        let fragment =
            Fragment { pixel: (i, j), e: context.triangle.edges(i, j), stored: band.words[at], weights: None };
        let read = surface::read(planned.surface, band.words[at]);
        let destination = std::array::from_fn(|n| Paired { fixed: i32::from(read[n]), ..band.held[at][n] });
        let stored = context.shade(&fragment, &mut depth, Some(destination), &draw.images.lane, observer);
        if let Some(slot) = band.depth.get_mut(at) {
            *slot = depth.word();
        }
        let Some(stored) = stored else { return };
        band.words[at] = stored.word;
        band.states[at].drawn = true;
        for n in (0..4).filter(|n| planned.written >> n & 1 != 0) {
            band.held[at][n] = stored.channels[n];
        }
    });
}
