//! Reads the order of a pixel as lines of code: each operation of [`Algebra`] adds what the chip computes, with its rule and the name that traces
//! use.

use ninebit::algebra::{Algebra, Site};
use ninebit::combiner::registers::channel_name;
use ninebit::combiner::{mapping, output};
use ninebit::number::{Factor as _, Integer as _, Register as _, Sum as _};
use ninebit::state::*;
use ninebit::trace::Rule;

use crate::code::Code;
use crate::number::{Factor, Number, Sum, widened};
use crate::truth::Truth;

/// The part of the order that is being read. The places in the text have another meaning in each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Block {
    /// A general stage.
    Stage(usize),
    /// The final combiner.
    Final,
    /// The raster operations.
    Raster,
    /// A single rule.
    Piece,
}

/// The reader that writes lines of code.
#[derive(Debug)]
pub(crate) struct Listing<'a> {
    code: &'a Code,
    policies: Policies,
    block: Block,
    /// How often each place of the final combiner has been passed.
    passed: [usize; 16],
    /// Places of registers, in the order in which they have been passed.
    sites: Vec<Site>,
}

impl<'a> Listing<'a> {
    pub(crate) fn new(code: &'a Code, policies: Policies) -> Listing<'a> {
        Listing { code, policies, block: Block::Final, passed: [0; 16], sites: Vec::new() }
    }

    /// Sets the part that is read from now on.
    pub(crate) fn enter(&mut self, block: Block) {
        self.block = block;
    }

    /// Returns the places of registers that have been passed since the last call.
    pub(crate) fn take_sites(&mut self) -> Vec<Site> {
        std::mem::take(&mut self.sites)
    }

    fn named(&mut self, Site(bits): Site, value: Number<'a>) {
        let at = bits.trailing_zeros() as usize;
        let channel = channel_name(at % 4);
        let name = match self.block {
            Block::Raster | Block::Piece => None,
            Block::Stage(_) if at >= 40 => None,
            Block::Stage(stage) => {
                let portion = if at % 4 == 3 { "alpha" } else { "rgb" };
                let (what, end) = match at / 4 {
                    n @ 0..4 => (["A", "B", "C", "D"][n], ""),
                    n @ 4..7 => (["AB", "CD", "sum"][n - 4], ""),
                    n => (["AB", "CD", "sum"][n - 7], "_output"),
                };
                Some(format!("stage{stage}_{portion}_{what}_{channel}{end}"))
            }
            Block::Final => {
                // E and F stand at the place of their product, A to C at that of the lerp, and D at that of the fragment.
                let nth = self.passed[at % 16];
                self.passed[at % 16] += 1;
                let names: &[&str] = match at / 4 {
                    0 => &["final_sum"],
                    1 => &["final_E", "final_F", "final_EF"],
                    2 if at % 4 == 3 => &["fragment"],
                    2 => &["final_D", "fragment"],
                    _ => &["final_A", "final_B", "final_C", "final_lerp"],
                };
                names.get(nth).map(|name| format!("{name}_{channel}"))
            }
        };
        if let Some(name) = name {
            self.code.name(value.operand(), || name);
        }
    }

    fn by(&self, rule: Rule) {
        self.code.by(rule.name());
    }

    /// Maps a register by CMB-3 and CMB-4, with the alternatives of the policies.
    fn mapped(&self, mapping: InputMapping, x: Number<'a>) -> Factor<'a> {
        let less = |number: i64| (x.max0() - Number::Constant(number)).factor();
        match mapping {
            InputMapping::UnsignedIdentity => mapping::unsigned_identity(x).factor(),
            InputMapping::UnsignedInvert => mapping::unsigned_invert(x).factor(),
            InputMapping::SignedIdentity => x.factor(),
            InputMapping::SignedNegate => negated(x.factor()),
            InputMapping::ExpandNormal => match self.policies.expand_centre {
                ExpandCentre::Centred => mapping::expand_normal(x),
                ExpandCentre::Literal => (x.max0().multiplied(Number::Constant(2)) - Number::Constant(255)).factor(),
            },
            InputMapping::HalfBiasNormal => match self.policies.half_bias {
                HalfBiasConstant::Half128 => less(128),
                HalfBiasConstant::Half127 => less(127),
                HalfBiasConstant::Half127And5 => {
                    Factor { value: x.max0().multiplied(Number::Constant(2)) - Number::Constant(255), halves: true }
                }
            },
            InputMapping::ExpandNegate => negated(self.mapped(InputMapping::ExpandNormal, x)),
            InputMapping::HalfBiasNegate => negated(self.mapped(InputMapping::HalfBiasNormal, x)),
        }
    }
}

/// Returns the negation, at most 1.0.
fn negated(factor: Factor<'_>) -> Factor<'_> {
    let most = if factor.halves { 510 } else { 255 };
    let value = (Number::Constant(0) - factor.value).least(Number::Constant(most));
    Factor { value, ..factor }
}

impl<'a> Algebra for Listing<'a> {
    type Register = Number<'a>;
    type Factor = Factor<'a>;
    type Sum = Sum<'a>;
    type Choice = Truth<'a>;

    fn policies(&self) -> &Policies {
        &self.policies
    }
    fn factor(&mut self, site: Site, value: impl FnOnce(&mut Self) -> Factor<'a>) -> Factor<'a> {
        let factor = value(self);
        self.named(site, factor.value);
        factor
    }
    fn sum(&mut self, site: Site, value: impl FnOnce(&mut Self) -> Sum<'a>) -> Sum<'a> {
        let sum = value(self);
        self.named(site, sum.value);
        sum
    }
    fn register(&mut self, site: Site, value: impl FnOnce(&mut Self) -> Number<'a>) -> Number<'a> {
        let register = value(self);
        self.sites.push(site);
        self.named(site, register);
        register
    }
    fn byte(&mut self, value: u8) -> Number<'a> {
        Number::Constant(value.into())
    }
    fn map(&mut self, mapping: InputMapping, x: Number<'a>) -> Factor<'a> {
        self.by(mapping::rule(mapping));
        self.mapped(mapping, x)
    }
    fn plain(&mut self, x: Number<'a>) -> Factor<'a> {
        x.factor()
    }
    fn product(&mut self, rule: Rule, a: Factor<'a>, b: Factor<'a>) -> Sum<'a> {
        self.by(rule);
        a.product(b)
    }
    fn add(&mut self, rule: Rule, a: Sum<'a>, b: Sum<'a>) -> Sum<'a> {
        self.by(rule);
        a + b
    }
    fn subtract(&mut self, rule: Rule, a: Sum<'a>, b: Sum<'a>) -> Sum<'a> {
        self.by(rule);
        a - b
    }
    fn widened(&mut self, rule: Rule, x: Number<'a>) -> Sum<'a> {
        self.by(rule);
        widened(x)
    }
    fn choice(&mut self, select: MuxSelect, spare0_alpha: Number<'a>) -> Truth<'a> {
        self.code.by("CMB-10");
        output::takes_cd(spare0_alpha, select, self.policies.mux_negative)
    }
    fn select(&mut self, takes_cd: Truth<'a>, cd: Sum<'a>, ab: Sum<'a>) -> Sum<'a> {
        self.code.by("CMB-10");
        let [cd, ab] = cd.alike(ab);
        Sum { value: cd.value.or(takes_cd, ab.value), halvings: cd.halvings }
    }
    fn rounded(&mut self, sum: Sum<'a>) -> Number<'a> {
        self.code.by("NUM-2");
        sum.rounded()
    }
    fn rounded_after(&mut self, bias: Bias, scale: Scale, sum: Sum<'a>) -> Number<'a> {
        self.by(Rule::Cmb9);
        let biased = match bias {
            Bias::None => sum,
            Bias::NegativeHalf => sum - widened(Number::HALF),
        };
        let times = |by: i64| Sum { value: biased.value.multiplied(Number::Constant(by)), ..biased };
        match scale {
            Scale::One => biased.rounded(),
            Scale::Two => times(2).rounded(),
            Scale::Four => times(4).rounded(),
            Scale::Half => biased.rounded_to(2),
        }
    }
    fn scaled(&mut self, bias: Bias, scale: Scale, x: Number<'a>) -> Number<'a> {
        self.by(Rule::Cmb9);
        output::scaled(output::biased(x, bias), scale)
    }
    fn saturated(&mut self, x: Number<'a>) -> Number<'a> {
        self.by(Rule::Num3);
        x.saturated(self.policies.register_floor)
    }
    fn max0(&mut self, x: Number<'a>) -> Number<'a> {
        self.code.by("FIN-1");
        x.max0()
    }
    fn complement(&mut self, x: Number<'a>) -> Number<'a> {
        self.code.by(if self.block == Block::Raster { "ROP-4" } else { "FIN-1" });
        Number::ONE - x
    }
    fn plus(&mut self, a: Number<'a>, b: Number<'a>) -> Number<'a> {
        a + b
    }
    fn minus(&mut self, a: Number<'a>, b: Number<'a>) -> Number<'a> {
        a - b
    }
    fn least(&mut self, a: Number<'a>, b: Number<'a>) -> Number<'a> {
        a.least(b)
    }
    fn greatest(&mut self, a: Number<'a>, b: Number<'a>) -> Number<'a> {
        a.greatest(b)
    }
    fn clamped(&mut self, x: Number<'a>) -> Number<'a> {
        self.code.by(if self.block == Block::Raster { "ROP-2" } else { "FIN-2" });
        x.limited(0, 255)
    }
    fn truncated(&mut self, bits: u32, x: Number<'a>) -> Number<'a> {
        self.by(Rule::Rop5);
        x.low_bits(255 >> bits << bits)
    }
    fn signed_byte(&mut self, x: Number<'a>) -> Number<'a> {
        self.code.by("ROP-3");
        x.signed(8)
    }
}
