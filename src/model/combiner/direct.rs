//! [`Direct`], the algebra that computes the order of a pixel on the numbers of a lane and reports to an observer.

use super::{mapping, output};
use crate::algebra::{Algebra, Site};
use crate::number::{Factor, Lane, Sum};
use crate::state::{Bias, InputMapping, MuxSelect, Policies, Scale};
use crate::trace::{Observer, Part, Rule, Work};
use std::marker::PhantomData;

/// Computes the values at the given sites; all others are 0.
#[derive(Debug)]
pub struct Direct<'o, L, O> {
    policies: &'o Policies,
    sites: u64,
    observer: &'o mut O,
    lane: PhantomData<L>,
}

impl<'o, L: Lane, O: Observer> Direct<'o, L, O> {
    /// Whether exactly the needed channels are computed, and sums keep their rules.
    const EXACT: bool = O::MEASURES || O::COUNTS;

    /// Creates an algebra that computes under `policies` and reports to `observer`.
    #[inline(always)]
    pub fn new(policies: &'o Policies, observer: &'o mut O) -> Self {
        Direct { policies, sites: u64::MAX, observer, lane: PhantomData }
    }

    /// Creates an algebra for an order that no policy affects.
    #[inline(always)]
    pub fn plain(observer: &'o mut O) -> Self {
        Direct::new(&Policies::DEFAULT, observer)
    }

    /// Restricts the computation to the given set of [`Site`]s.
    #[inline(always)]
    #[must_use]
    pub(crate) fn only(mut self, sites: u64) -> Self {
        self.sites = sites;
        self
    }

    /// Counts work. General stages and the final combiner are counted by operation, blending by channel elsewhere.
    #[inline(always)]
    fn count(&mut self, work: Work, rule: Rule) {
        if rule.part() != Part::Store {
            self.observer.count(work, 1);
        }
    }
}

/// A sum, and the rule that its rounding is attributed to.
#[derive(Clone, Copy, Debug)]
pub struct AttributedSum<S> {
    /// The sum, before rounding.
    pub sum: S,
    rule: Rule,
}

impl<S> AttributedSum<S> {
    /// Creates a sum, which keeps the rule only for observers that measure or count.
    #[inline(always)]
    fn new<O: Observer>(sum: S, rule: Rule) -> AttributedSum<S> {
        AttributedSum { sum, rule: if O::MEASURES || O::COUNTS { rule } else { Rule::Cmb6 } }
    }
}

impl<L: Lane, O: Observer> Algebra for Direct<'_, L, O> {
    type Register = L;
    type Factor = L::Mapped;
    type Sum = AttributedSum<L::Full>;
    type Choice = bool;

    #[inline(always)]
    fn policies(&self) -> &Policies {
        self.policies
    }
    #[inline(always)]
    fn factor(&mut self, site: Site, value: impl FnOnce(&mut Self) -> L::Mapped) -> L::Mapped {
        if self.sites & site.0 == 0 { L::ZERO.factor() } else { value(self) }
    }
    #[inline(always)]
    fn sum(&mut self, site: Site, value: impl FnOnce(&mut Self) -> Self::Sum) -> Self::Sum {
        if self.sites & site.0 == 0 { AttributedSum::new::<O>(L::ZERO.widened(), Rule::Cmb6) } else { value(self) }
    }
    #[inline(always)]
    fn register(&mut self, site: Site, value: impl FnOnce(&mut Self) -> L) -> L {
        if self.sites & site.0 == 0 { L::ZERO } else { value(self) }
    }

    // Observers that measure or count see needed channels only. Otherwise the other channels are computed too, which
    // costs less than checking each. These are loops because closures passed to `from_fn` are not always inlined.
    #[inline(always)]
    fn factors<const N: usize>(&mut self, first: Site, mapping: InputMapping, x: [L; N]) -> [L::Mapped; N] {
        if !Self::EXACT {
            let zero = [L::ZERO.factor(); N];
            return if self.sites & first.channels(N) == 0 { zero } else { mapping::map(x, mapping, self.policies) };
        }
        std::array::from_fn(|c| self.factor(first.channel(c), |a| a.map(mapping, x[c])))
    }
    #[inline(always)]
    fn sums<const N: usize>(
        &mut self,
        first: Site,
        mut value: impl FnMut(&mut Self, usize) -> Self::Sum,
    ) -> [Self::Sum; N] {
        let mut all = [AttributedSum::new::<O>(L::ZERO.widened(), Rule::Cmb6); N];
        if Self::EXACT || self.sites & first.channels(N) != 0 {
            for c in 0..N {
                if !Self::EXACT || self.sites & first.channel(c).0 != 0 {
                    all[c] = value(self, c);
                }
            }
        }
        all
    }
    #[inline(always)]
    fn registers<const N: usize>(&mut self, first: Site, mut value: impl FnMut(&mut Self, usize) -> L) -> [L; N] {
        let mut all = [L::ZERO; N];
        if Self::EXACT || self.sites & first.channels(N) != 0 {
            for c in 0..N {
                if !Self::EXACT || self.sites & first.channel(c).0 != 0 {
                    all[c] = value(self, c);
                }
            }
        }
        all
    }

    #[inline(always)]
    fn byte(&mut self, value: u8) -> L {
        L::byte(value)
    }
    #[inline(always)]
    fn map(&mut self, mapping: InputMapping, x: L) -> L::Mapped {
        self.observer.observe_factor::<L>(mapping::rule(mapping), mapping::map_one(x, mapping, self.policies))
    }
    #[inline(always)]
    fn plain(&mut self, x: L) -> L::Mapped {
        x.factor()
    }
    #[inline(always)]
    fn product(&mut self, rule: Rule, a: L::Mapped, b: L::Mapped) -> Self::Sum {
        self.count(Work::Products, rule);
        AttributedSum::new::<O>(a.product(b), rule)
    }
    #[inline(always)]
    fn add(&mut self, rule: Rule, a: Self::Sum, b: Self::Sum) -> Self::Sum {
        AttributedSum::new::<O>(a.sum + b.sum, rule)
    }
    #[inline(always)]
    fn subtract(&mut self, rule: Rule, a: Self::Sum, b: Self::Sum) -> Self::Sum {
        AttributedSum::new::<O>(a.sum - b.sum, rule)
    }
    #[inline(always)]
    fn widened(&mut self, rule: Rule, x: L) -> Self::Sum {
        AttributedSum::new::<O>(x.widened(), rule)
    }
    #[inline(always)]
    fn choice(&mut self, select: MuxSelect, spare0_alpha: L) -> bool {
        output::mux_takes_cd(spare0_alpha, select, self.policies)
    }
    #[inline(always)]
    fn select(&mut self, takes_cd: bool, cd: Self::Sum, ab: Self::Sum) -> Self::Sum {
        if takes_cd { cd } else { ab }
    }
    #[inline(always)]
    fn rounded(&mut self, sum: Self::Sum) -> L {
        self.count(Work::Roundings, sum.rule);
        self.observer.observe(sum.rule, sum.sum.rounded())
    }
    #[inline(always)]
    fn rounded_after(&mut self, bias: Bias, scale: Scale, sum: Self::Sum) -> L {
        self.count(Work::Roundings, sum.rule);
        self.observer.observe(Rule::Cmb9, output::rounded_after::<L>(sum.sum, bias, scale))
    }
    #[inline(always)]
    fn scaled(&mut self, bias: Bias, scale: Scale, x: L) -> L {
        self.observer.observe(Rule::Cmb9, output::scaled(output::biased(x, bias), scale))
    }
    #[inline(always)]
    fn saturated(&mut self, x: L) -> L {
        self.observer.observe(Rule::Num3, x.saturated(self.policies.register_floor))
    }
    #[inline(always)]
    fn max0(&mut self, x: L) -> L {
        x.max0()
    }
    #[inline(always)]
    fn complement(&mut self, x: L) -> L {
        L::ONE - x
    }
    #[inline(always)]
    fn plus(&mut self, a: L, b: L) -> L {
        a + b
    }
    #[inline(always)]
    fn minus(&mut self, a: L, b: L) -> L {
        a - b
    }
    #[inline(always)]
    fn least(&mut self, a: L, b: L) -> L {
        a.least(b)
    }
    #[inline(always)]
    fn greatest(&mut self, a: L, b: L) -> L {
        a.greatest(b)
    }
    #[inline(always)]
    fn clamped(&mut self, x: L) -> L {
        x.clamped()
    }
    #[inline(always)]
    fn truncated(&mut self, bits: u32, x: L) -> L {
        self.observer.observe(Rule::Rop5, x.truncated(bits))
    }
    #[inline(always)]
    fn signed_byte(&mut self, x: L) -> L {
        x.signed_byte()
    }
    #[inline(always)]
    fn yielded(&mut self, rule: Rule, x: L) -> L {
        self.observer.observe(rule, x)
    }
}
