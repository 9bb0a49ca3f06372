//! [`Trail`], the algebra that records what values depend on and what is known about them, for liveness and for
//! folding.

use super::{Algebra, Site};
use crate::state::{Bias, InputMapping, MuxSelect, Policies, Scale};
use crate::trace::Rule;

/// A value: its node, and its number if that is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Value {
    node: u32,
    /// The number in steps of 1/255, if it is the same in every pixel and under all policies.
    pub known: Option<i16>,
}

/// Records the operands of each value.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trail {
    /// Operands of each node, as a range of `operands`.
    nodes: Vec<(usize, usize)>,
    operands: Vec<u32>,
    /// The sites that were passed since [`take_sites`](Self::take_sites), with their values.
    sites: Vec<(Site, Value)>,
    /// Whether operations without effect, such as adding zero or multiplying by one, return their operand instead of a
    /// new value.
    folds: bool,
    policies: Policies,
}

impl Trail {
    /// Creates a trail in which operations without effect return their operand.
    pub(crate) fn folding() -> Trail {
        Trail { folds: true, ..Trail::default() }
    }

    /// Adds a value that does not come from the text.
    pub(crate) fn input(&mut self, known: Option<i16>) -> Value {
        self.made_of(&[], known)
    }

    /// Takes the sites that the text has passed, with their values. Later sites are collected anew.
    pub(crate) fn take_sites(&mut self) -> Vec<(Site, Value)> {
        std::mem::take(&mut self.sites)
    }

    /// Returns a predicate for whether a value is needed to compute the roots.
    pub(crate) fn needed(&self, roots: &[Value]) -> impl Fn(Value) -> bool + use<> {
        let mut needed = vec![false; self.nodes.len()];
        for root in roots {
            needed[root.node as usize] = true;
        }
        // Operands have lower numbers than the values made of them.
        for node in (0..self.nodes.len()).rev().filter(|node| needed[*node]).collect::<Vec<_>>() {
            self.need(node, &mut needed);
        }
        move |value: Value| needed[value.node as usize]
    }

    fn need(&self, node: usize, needed: &mut [bool]) {
        let (first, end) = self.nodes[node];
        for operand in &self.operands[first..end] {
            if !std::mem::replace(&mut needed[*operand as usize], true) {
                self.need(*operand as usize, needed);
            }
        }
    }

    fn made_of(&mut self, operands: &[Value], known: Option<i16>) -> Value {
        let first = self.operands.len();
        self.operands.extend(operands.iter().map(|value| value.node));
        self.nodes.push((first, self.operands.len()));
        Value { node: self.nodes.len() as u32 - 1, known }
    }

    fn one(&mut self, x: Value, known: impl FnOnce(i16) -> Option<i16>) -> Value {
        let known = x.known.and_then(known);
        if self.folds && known.is_some() && known == x.known { x } else { self.made_of(&[x], known) }
    }

    fn two(&mut self, a: Value, b: Value, known: impl FnOnce(i16, i16) -> i16) -> Value {
        let known = a.known.zip(b.known).map(|(a, b)| known(a, b));
        self.made_of(&[a, b], known)
    }
}

impl Algebra for Trail {
    type Register = Value;
    type Factor = Value;
    type Sum = Value;
    type Choice = Value;

    fn policies(&self) -> &Policies {
        &self.policies
    }
    fn factor(&mut self, site: Site, value: impl FnOnce(&mut Self) -> Value) -> Value {
        self.register(site, value)
    }
    fn sum(&mut self, site: Site, value: impl FnOnce(&mut Self) -> Value) -> Value {
        self.register(site, value)
    }
    fn register(&mut self, site: Site, value: impl FnOnce(&mut Self) -> Value) -> Value {
        let value = value(self);
        self.sites.push((site, value));
        value
    }
    fn byte(&mut self, value: u8) -> Value {
        self.input(Some(value.into()))
    }
    fn map(&mut self, mapping: InputMapping, x: Value) -> Value {
        // Mappings of other numbers may depend on policies.
        self.one(x, |x| match (mapping, x) {
            (InputMapping::UnsignedIdentity | InputMapping::SignedIdentity | InputMapping::SignedNegate, 0) => Some(0),
            (InputMapping::UnsignedInvert, 0) => Some(255),
            _ => None,
        })
    }
    fn plain(&mut self, x: Value) -> Value {
        x
    }
    fn product(&mut self, _rule: Rule, a: Value, b: Value) -> Value {
        match (a.known, b.known) {
            (Some(255), _) if self.folds => b,
            (_, Some(255)) if self.folds => a,
            (Some(0), _) | (_, Some(0)) => self.made_of(&[a, b], Some(0)),
            _ => self.made_of(&[a, b], None),
        }
    }
    fn add(&mut self, _rule: Rule, a: Value, b: Value) -> Value {
        self.plus(a, b)
    }
    fn subtract(&mut self, _rule: Rule, a: Value, b: Value) -> Value {
        self.minus(a, b)
    }
    fn widened(&mut self, _rule: Rule, x: Value) -> Value {
        x
    }
    fn choice(&mut self, _select: MuxSelect, spare0_alpha: Value) -> Value {
        spare0_alpha
    }
    fn select(&mut self, takes_cd: Value, cd: Value, ab: Value) -> Value {
        self.made_of(&[takes_cd, cd, ab], cd.known.filter(|_| cd.known == ab.known))
    }
    fn rounded(&mut self, sum: Value) -> Value {
        sum
    }
    fn rounded_after(&mut self, bias: Bias, scale: Scale, sum: Value) -> Value {
        self.scaled(bias, scale, sum)
    }
    fn scaled(&mut self, bias: Bias, _scale: Scale, x: Value) -> Value {
        self.one(x, |x| (x == 0 && bias == Bias::None).then_some(0))
    }
    fn saturated(&mut self, x: Value) -> Value {
        self.one(x, |x| (0..=255).contains(&x).then_some(x))
    }
    fn written(&mut self, x: Value) -> Value {
        self.made_of(&[x], x.known)
    }
    fn max0(&mut self, x: Value) -> Value {
        self.one(x, |x| Some(x.max(0)))
    }
    fn complement(&mut self, x: Value) -> Value {
        self.one(x, |x| Some(255 - x))
    }
    fn plus(&mut self, a: Value, b: Value) -> Value {
        match (a.known, b.known) {
            (Some(0), _) if self.folds => b,
            (_, Some(0)) if self.folds => a,
            _ => self.two(a, b, |a, b| a + b),
        }
    }
    fn minus(&mut self, a: Value, b: Value) -> Value {
        if self.folds && b.known == Some(0) { a } else { self.two(a, b, |a, b| a - b) }
    }
    fn least(&mut self, a: Value, b: Value) -> Value {
        self.two(a, b, i16::min)
    }
    fn greatest(&mut self, a: Value, b: Value) -> Value {
        match (a.known, b.known) {
            // Only bytes are compared, which are not negative.
            (Some(0), _) if self.folds => b,
            (_, Some(0)) if self.folds => a,
            _ => self.two(a, b, i16::max),
        }
    }
    fn clamped(&mut self, x: Value) -> Value {
        // Folding looks for bytes.
        if self.folds && x.known.is_none() { x } else { self.one(x, |x| Some(x.clamp(0, 255))) }
    }
    fn truncated(&mut self, bits: u32, x: Value) -> Value {
        self.one(x, |x| Some(x >> bits << bits))
    }
    fn signed_byte(&mut self, x: Value) -> Value {
        self.one(x, |x| Some(if x >= 128 { x - 256 } else { x }))
    }
}
