//! Cost of a draw, predicted from its plan.

use ninebit::combiner::general::{BLUE, PlannedPortion};
use ninebit::engine::ShadedPixels;
use ninebit::plan::PlannedDraw;
use ninebit::state::{DotRounding, Filter, LerpRounding, MipFilter, Named, Policies, ShaderOperation, SumRounding};
use ninebit::texture::dot::{DOT_OPERATIONS, REFLECTION_OPERATIONS};
use ninebit::texture::planned::PlannedUnit;
use ninebit::texture::stage::PlannedShaderStage;
use ninebit::trace::Work;

/// Amounts of work by kind, in the order of `Work::ALL`.
pub(super) type Amounts = [u64; Work::ALL.len()];

/// Cost of one fragment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FragmentCost {
    /// Work for every fragment, regardless of tests.
    pub shaded: Amounts,
    /// Additional work for a fragment that passes the tests.
    pub stored: Amounts,
}

/// Cost of a draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cost {
    /// Number of fragments: covered pixels, once for each triangle that covers them.
    pub fragments: u64,
    /// Whether fragments were counted; otherwise their number, and all work, is an upper bound.
    pub exact: bool,
    /// Whether tests decide which fragments are stored; [`total`](Self::total) is then an upper bound.
    pub tested: bool,
    /// Whether texture units drop fragments before they are shaded (TSH-10, KEY-1); all work is then an upper bound.
    pub kills: bool,
    /// Whether the level of detail decides how much texture units read (TEX-9); texels and filter steps are then upper bounds.
    pub lod_decides: bool,
    /// Work of one fragment.
    pub fragment: FragmentCost,
    /// Whether anything is drawn, so that the draw is a pass over the target.
    pub seen: bool,
    /// Number of general stages that run; 0 if nothing is drawn.
    pub stages: u64,
    /// Number of texture units that are read; 0 if nothing is drawn.
    pub units: u64,
    /// Whether its fragments are blended with the target.
    pub blended: bool,
}

impl Cost {
    pub(super) fn from_draw(planned: &PlannedDraw, policies: &Policies, shaded: ShadedPixels) -> Cost {
        let fragment = FragmentCost { shaded: for_each(planned, policies), stored: stored(planned) };
        let seen = planned.folded.invisible.is_none();
        let if_seen = |count: usize| if seen { count as u64 } else { 0 };
        Cost {
            fragments: shaded.pixels,
            exact: shaded.exact,
            tested: planned.alpha_test.is_some()
                || planned.stencil_test.is_some()
                || planned.depth_test.is_some()
                || planned.kills(),
            kills: planned.kills(),
            lod_decides: planned.units.iter().any(PlannedUnit::needs_lod),
            fragment,
            seen,
            stages: if_seen(planned.stages.len()),
            units: if_seen(planned.units.len()),
            blended: seen && planned.blend.is_some(),
        }
    }

    /// Returns the counts of the draw as a whole: passes, stages, units and blended passes, by name.
    pub fn counts(&self) -> [(&'static str, u64); 4] {
        [
            ("passes", self.seen.into()),
            ("general stages", self.stages),
            ("texture units", self.units),
            ("blended passes", self.blended.into()),
        ]
    }

    /// Returns the work if `stored` fragments pass the tests.
    pub fn with(&self, stored: u64) -> Amounts {
        std::array::from_fn(|n| {
            let of = |count: u64, each: u64| count.saturating_mul(each);
            of(self.fragments, self.fragment.shaded[n]).saturating_add(of(stored, self.fragment.stored[n]))
        })
    }

    /// Returns the work if all fragments pass the tests.
    pub fn total(&self) -> Amounts {
        self.with(self.fragments)
    }
}

fn for_each(planned: &PlannedDraw, policies: &Policies) -> Amounts {
    let mut amounts = Amounts::default();
    let mut add = |work: Work, amount: u64| amounts[work as usize] += amount;
    for unit in &planned.units {
        let (texels, lerps) = unit_cost(unit);
        add(Work::Texels, texels);
        add(Work::Lerps, lerps);
    }
    if let Some(shader) = &planned.shader {
        add(Work::Dots, shader.stages.iter().map(dot_unit).sum());
    }
    for stage in &planned.stages {
        for portion in [&stage.rgb, &stage.alpha] {
            let (products, roundings) = portion_cost(portion, policies);
            add(Work::Products, products);
            add(Work::Roundings, roundings);
        }
    }
    let last = &planned.final_combiner;
    let product = u64::from(last.product.count_ones());
    add(Work::Products, product);
    add(Work::Roundings, product);
    if last.lerps {
        let channels = u64::from((last.live & 7).count_ones());
        add(Work::Products, 2 * channels);
        add(Work::Roundings, channels * if policies.lerp_rounding == LerpRounding::Once { 1 } else { 2 });
    }
    amounts
}

/// Returns the texels and filter steps of a unit; upper bounds if the level of detail decides.
fn unit_cost(unit: &PlannedUnit) -> (u64, u64) {
    let level = |filter: Filter| match filter {
        Filter::Nearest => (1, 0),
        // Two rows and their interpolation, in four channels.
        Filter::Linear => (4, 12),
    };
    let magnified = level(unit.state.mag_filter);
    if !unit.needs_lod() {
        return magnified;
    }
    let (texels, lerps) = level(unit.state.min_filter);
    let minified = match unit.state.mip_filter {
        MipFilter::Linear if unit.levels.len() > 1 => (2 * texels, 2 * lerps + 4),
        _ => (texels, lerps),
    };
    (magnified.0.max(minified.0), magnified.1.max(minified.1))
}

/// Returns the operations of the dot unit for a stage: its own dot product, and a reflection if a texture is sampled in its direction.
fn dot_unit(stage: &PlannedShaderStage) -> u64 {
    let reflects = matches!(
        stage.state.operation,
        ShaderOperation::DotReflectSpecular | ShaderOperation::DotReflectConstantEye { .. }
    );
    let product = if stage.dots { DOT_OPERATIONS } else { 0 };
    product + if reflects && stage.live != 0 { REFLECTION_OPERATIONS } else { 0 }
}

/// Returns the products and roundings of a portion.
fn portion_cost(planned: &PlannedPortion, policies: &Policies) -> (u64, u64) {
    let portion = &planned.portion;
    let dots = [portion.ab_dot_product, portion.cd_dot_product];
    // A dot product is the same in all channels.
    let values = |channels: u8, same: bool| u64::from(if same { channels.min(1) } else { channels.count_ones() as u8 });
    let (mut products, mut roundings) = (0, 0);
    for n in 0..2 {
        let channels = planned.product_channels(n);
        products += values(channels, dots[n]) * if dots[n] { 3 } else { 1 };
        if dots[n] && policies.dot_rounding == DotRounding::Each {
            roundings += 3 * values(channels, true);
        }
        let blue = if planned.blue_to_alpha[n] { BLUE } else { 0 };
        roundings += values(planned.live[n] | blue, dots[n]);
    }
    let third = values(planned.live[2], dots[0] && dots[1]);
    let rounds_each = !portion.mux && policies.sum_rounding == SumRounding::Each;
    (products, roundings + third * if rounds_each { 3 } else { 1 })
}

fn stored(planned: &PlannedDraw) -> Amounts {
    let mut amounts = Amounts::default();
    let bytes = u64::from(planned.surface.bytes());
    if planned.blend.is_some() {
        amounts[Work::Blends as usize] = u64::from(planned.blended.count_ones());
        amounts[Work::BytesRead as usize] = bytes;
    }
    if planned.write_mask != 0 {
        amounts[Work::BytesWritten as usize] = bytes;
    }
    amounts
}
