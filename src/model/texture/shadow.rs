//! SHD-1: depth textures, which a unit compares with a reference instead of returning their texels.

use super::coordinates::SampleCoordinates;
use super::fetch::Texel;
use super::planned::PlannedUnit;
use super::report::Report;
use crate::number::Lane;
use crate::raster::binary::Binary;
use crate::raster::depth::word;
use crate::raster::ideal;
use crate::state::{DepthFormat, ShadowComparison, ShadowReference, depth_of};
use crate::trace::{Decision, Observer};

/// Returns whether a reference, which is a word of the unit's format, passes the comparison with a texel.
#[inline]
pub(crate) fn passes(shadow: ShadowComparison, reference: u32, texel: &Texel) -> bool {
    shadow.function.passes(reference, depth_of(texel.word))
}

/// SHD-1: returns 255 in every channel if the reference passes the comparison with the texel, and 0 otherwise.
#[inline]
pub fn compare<L: Lane, O: Observer>(
    unit: &PlannedUnit,
    shadow: ShadowComparison,
    texel: &Texel,
    place: &impl SampleCoordinates,
    observer: &mut O,
) -> [L; 4] {
    let format = unit.format.depth().unwrap_or(DepthFormat::Z16);
    let reference = match shadow.reference {
        ShadowReference::R => place.reference(),
        ShadowReference::Zero => Binary::default(),
    };
    let reference = word(format, reference);
    let stored = depth_of(texel.word);
    let fixed = passes(shadow, reference, texel);
    let real = || match shadow.reference {
        ShadowReference::R => {
            let reference = ideal::in_words(format, place.real_r());
            shadow.function.passes(reference, f64::from(stored))
        }
        ShadowReference::Zero => fixed,
    };
    let passes = if L::DECIDES { real() } else { fixed };
    observer.decided(Decision::Shadow, i64::from(passes), || i64::from(real()));
    let result = if passes { L::ONE } else { L::ZERO };
    if O::ON {
        let report = Report { unit, prefix: "" };
        if shadow.reference == ShadowReference::R {
            place.describe_reference(&report, format, reference, observer);
        }
        report.shadow(shadow, (format, reference), (stored, passes), result, observer);
    }
    [result; 4]
}
