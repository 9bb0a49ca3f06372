//! Policies: rules that no capture and no document settles, each with a choice of alternatives.

use super::{Named, named};

named! {
    /// NUM-3: the lowest value that a register can hold.
    pub enum RegisterFloor {
        /// The lowest value is -256.
        Full,
        /// The lowest value is -255.
        Symmetric,
    }
}
named! {
    /// TSH-6: how a byte becomes a coordinate of a dependent read.
    pub enum DependentScale {
        /// v / 255.
        Over255,
        /// v / 256.
        Over256,
    }
}
named! {
    /// CMB-3: the centre of the expand mappings.
    pub enum ExpandCentre {
        /// 2 (x - 128).
        Centred,
        /// 2x - 255, the vendor's formula to the letter.
        Literal,
    }
}
named! {
    /// CMB-4: the integer that stands for one half in the half-bias mappings.
    pub enum HalfBiasConstant {
        /// x - 128.
        Half128,
        /// x - 127.
        Half127,
        /// x - 127.5, which keeps the half bit up to the product.
        Half127And5,
    }
}
named! {
    /// CMB-7: where AB + CD is rounded.
    pub enum SumRounding {
        /// Once, after the sum.
        Once,
        /// Each product, before the sum.
        Each,
    }
}
named! {
    /// CMB-8: where a dot product is rounded.
    pub enum DotRounding {
        /// Once, after the sum of three products.
        Once,
        /// Each product, before the sum.
        Each,
    }
}
named! {
    /// CMB-9: whether the division by 255 comes before bias and scale.
    pub enum OutputRounding {
        /// Rounds to a register step, then applies bias and scale.
        BeforeScale,
        /// Applies bias and scale at full width, then rounds.
        AfterScale,
    }
}
named! {
    /// CMB-10: how a negative SPARE0.a steers the mux in MSB mode.
    pub enum MuxNegative {
        /// The bit counts as not set, which selects AB.
        Sign,
        /// The bit is bit 7 of the two's complement value.
        Bit7,
    }
}
named! {
    /// FIN-2: where the final combiner's linear interpolation is rounded.
    pub enum LerpRounding {
        /// Once, after the sum.
        Once,
        /// Each product, before the sum.
        Twice,
    }
}

/// Declares [`Policies`] and [`POLICIES`]. Each entry has a field, its type and default, the rule's id, the question,
/// and the names and meanings of the values in the order of the enumeration.
macro_rules! policies {
    ($($field:ident: $type:ident = $default:ident, $rule:literal, $question:literal, [$($value:expr),+];)+) => {
        /// The chosen value of every policy.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub struct Policies { $(#[doc = concat!($rule, ".")] pub $field: $type),+ }

        impl Policies {
            /// The values that the model uses unless told otherwise.
            pub const DEFAULT: Policies = Policies { $($field: $type::$default),+ };

            /// Sets the policy of `rule` to its value at `index`. Unknown rules and indices change nothing.
            pub fn choose(&mut self, rule: &str, index: usize) {
                match rule {
                    $($rule => self.$field = $type::ALL.get(index).copied().unwrap_or(self.$field),)+
                    _ => {}
                }
            }

            /// Returns the index of the chosen value of `rule` in [`Policy::values`], or 0 if no policy has that rule.
            pub fn chosen(&self, rule: &str) -> usize {
                match rule { $($rule => self.$field as usize,)+ _ => 0 }
            }
        }

        /// All policies, in the order of `docs/rules`. Their values are in the order of the enumerations above.
        pub const POLICIES: &[Policy] =
            &[$(Policy { rule: $rule, question: $question, values: &[$($value),+] }),+];
    };
}
policies! {
    register_floor: RegisterFloor = Full, "NUM-3", "lowest value of a register",
        [("256", "saturates at -256"), ("255", "saturates at -255")];
    dependent_scale: DependentScale = Over255, "TSH-6", "what makes a byte a coordinate of a dependent read",
        [("255", "v / 255: 255 is 1.0"), ("256", "v / 256: 255 is the last of 256 texels")];
    expand_centre: ExpandCentre = Centred, "CMB-3", "centre of the expand mappings",
        [("centred", "2 (x - 128): 128 becomes 0"), ("literal", "2x - 255: 127 becomes -1, 128 becomes 1")];
    half_bias: HalfBiasConstant = Half128, "CMB-4", "one half in the half-bias mappings",
        [("128", "x - 128"), ("127", "x - 127"), ("127.5", "x - 127.5, the half bit kept up to the product")];
    sum_rounding: SumRounding = Once, "CMB-7", "rounding of AB + CD",
        [("once", "after the sum"), ("each", "each product before the sum")];
    dot_rounding: DotRounding = Once, "CMB-8", "rounding of a dot product",
        [("once", "after the sum"), ("each", "each product before the sum")];
    output_rounding: OutputRounding = BeforeScale, "CMB-9", "division by 255 and output scale",
        [("before", "rounded, then biased and scaled"), ("after", "biased and scaled, then rounded")];
    mux_negative: MuxNegative = Sign, "CMB-10", "mux on a negative SPARE0.a in MSB mode",
        [("sign", "negative is not set"), ("bit7", "bit 7 of the two's complement value")];
    lerp_rounding: LerpRounding = Once, "FIN-2", "rounding of the final combiner's lerp",
        [("once", "after the sum"), ("twice", "each product before the sum")];
}

impl Policies {
    /// Applies one assignment, such as `CMB-3=literal`.
    ///
    /// # Errors
    /// Returns an error if the text has no `=`, the rule has no alternatives, or the value is not one of them.
    pub fn set(&mut self, assignment: &str) -> Result<(), PolicyError> {
        let (rule, value) =
            assignment.split_once('=').ok_or_else(|| PolicyError::Form(assignment.chars().take(60).collect()))?;
        let policy = POLICIES
            .iter()
            .find(|p| p.rule.eq_ignore_ascii_case(rule.trim()))
            .ok_or_else(|| PolicyError::Rule(rule.chars().take(60).collect()))?;
        let index = policy
            .values
            .iter()
            .position(|(name, _)| name.eq_ignore_ascii_case(value.trim()))
            .ok_or_else(|| PolicyError::Value { policy, value: value.chars().take(60).collect() })?;
        self.choose(policy.rule, index);
        Ok(())
    }
}

impl Default for Policies {
    fn default() -> Self {
        Policies::DEFAULT
    }
}

/// A rule that has alternatives.
#[derive(Debug, PartialEq, Eq)]
pub struct Policy {
    /// Id of the rule in `docs/rules`.
    pub rule: &'static str,
    /// The question that the alternatives answer.
    pub question: &'static str,
    /// Names and meanings of the values. The first is the default.
    pub values: &'static [(&'static str, &'static str)],
}

/// A `--policy` argument that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PolicyError {
    /// The text has no `=`.
    Form(String),
    /// No rule of that id has alternatives.
    Rule(String),
    /// The rule has no such value.
    Value {
        /// The rule that has alternatives.
        policy: &'static Policy,
        /// The value that was given.
        value: String,
    },
}

impl std::fmt::Display for PolicyError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            PolicyError::Form(text) => write!(f, "`{text}` is not of the form RULE=VALUE, for example CMB-3=literal"),
            PolicyError::Rule(rule) => {
                let known: Vec<_> = POLICIES.iter().map(|p| p.rule).collect();
                write!(f, "rule `{rule}` has no alternatives; rules that have: {}", known.join(", "))
            }
            PolicyError::Value { policy, value } => {
                let known: Vec<_> = policy.values.iter().map(|v| v.0).collect();
                write!(f, "`{value}` is not a value of {}; its values: {}", policy.rule, known.join(", "))
            }
        }
    }
}

impl std::error::Error for PolicyError {}
