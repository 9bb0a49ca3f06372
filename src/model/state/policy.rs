//! Policies: rules that no capture and no document decides, with the alternatives as selectable values.

use super::Named;
use super::named;

named! {
    /// NUM-3: the lowest value that a register holds.
    pub enum RegisterFloor {
        /// -256.
        Full,
        /// -255.
        Symmetric,
    }
}
named! {
    /// TSH-6: what makes a byte a coordinate of a dependent read.
    pub enum DependentScale {
        /// v / 255.
        Over255,
        /// v / 256.
        Over256,
    }
}
named! {
    /// CMB-3: what the expand mappings take as their centre.
    pub enum ExpandCentre {
        /// 2 (x - 128).
        Centred,
        /// 2x - 255, the vendor's formula to the letter.
        Literal,
    }
}
named! {
    /// CMB-4: the integer for one half in the half-bias mappings.
    pub enum HalfBiasConstant {
        /// x - 128.
        Half128,
        /// x - 127.
        Half127,
        /// x - 127.5, the half bit kept up to the product.
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
    /// CMB-9: whether the division by 255 precedes bias and scale.
    pub enum OutputRounding {
        /// Rounded to a register step, then biased and scaled.
        BeforeScale,
        /// Biased and scaled at full width, then rounded.
        AfterScale,
    }
}
named! {
    /// CMB-10: what a negative SPARE0.a selects in MSB mode.
    pub enum MuxNegative {
        /// Not set: AB.
        Sign,
        /// Bit 7 of the two's complement value.
        Bit7,
    }
}
named! {
    /// FIN-2: where the final combiner's lerp is rounded.
    pub enum LerpRounding {
        /// Once, after the sum.
        Once,
        /// Each product, before the sum.
        Twice,
    }
}

/// One value for every policy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Policies {
    /// NUM-3.
    pub register_floor: RegisterFloor,
    /// TSH-6.
    pub dependent_scale: DependentScale,
    /// CMB-3.
    pub expand_centre: ExpandCentre,
    /// CMB-4.
    pub half_bias: HalfBiasConstant,
    /// CMB-7.
    pub sum_rounding: SumRounding,
    /// CMB-8.
    pub dot_rounding: DotRounding,
    /// CMB-9.
    pub output_rounding: OutputRounding,
    /// CMB-10.
    pub mux_negative: MuxNegative,
    /// FIN-2.
    pub lerp_rounding: LerpRounding,
}

impl Policies {
    /// What the model takes unless told otherwise.
    pub const DEFAULT: Policies = Policies {
        register_floor: RegisterFloor::Full,
        dependent_scale: DependentScale::Over255,
        expand_centre: ExpandCentre::Centred,
        half_bias: HalfBiasConstant::Half128,
        sum_rounding: SumRounding::Once,
        dot_rounding: DotRounding::Once,
        output_rounding: OutputRounding::BeforeScale,
        mux_negative: MuxNegative::Sign,
        lerp_rounding: LerpRounding::Once,
    };

    /// Applies one assignment such as `CMB-3=literal`.
    ///
    /// # Errors
    /// The text has no `=`, the rule has no alternative, or the value is not one of its alternatives.
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

    /// Sets the policy of `rule` to its value number `index`; unknown rules and indices change nothing.
    pub fn choose(&mut self, rule: &str, index: usize) {
        fn pick<T: Named>(field: &mut T, index: usize) {
            if let Some(value) = T::ALL.get(index) {
                *field = *value;
            }
        }
        match rule {
            "NUM-3" => pick(&mut self.register_floor, index),
            "TSH-6" => pick(&mut self.dependent_scale, index),
            "CMB-3" => pick(&mut self.expand_centre, index),
            "CMB-4" => pick(&mut self.half_bias, index),
            "CMB-7" => pick(&mut self.sum_rounding, index),
            "CMB-8" => pick(&mut self.dot_rounding, index),
            "CMB-9" => pick(&mut self.output_rounding, index),
            "CMB-10" => pick(&mut self.mux_negative, index),
            "FIN-2" => pick(&mut self.lerp_rounding, index),
            _ => {}
        }
    }

    /// Number of the chosen value of `rule`, as in [`Policy::values`].
    pub fn chosen(&self, rule: &str) -> usize {
        fn number<T: Named>(field: T) -> usize {
            T::ALL.iter().position(|v| *v == field).unwrap_or(0)
        }
        match rule {
            "NUM-3" => number(self.register_floor),
            "TSH-6" => number(self.dependent_scale),
            "CMB-3" => number(self.expand_centre),
            "CMB-4" => number(self.half_bias),
            "CMB-7" => number(self.sum_rounding),
            "CMB-8" => number(self.dot_rounding),
            "CMB-9" => number(self.output_rounding),
            "CMB-10" => number(self.mux_negative),
            "FIN-2" => number(self.lerp_rounding),
            _ => 0,
        }
    }
}

impl Default for Policies {
    fn default() -> Self {
        Policies::DEFAULT
    }
}

/// A rule with alternatives.
#[derive(Debug, PartialEq, Eq)]
pub struct Policy {
    /// Rule id.
    pub rule: &'static str,
    /// What is to be decided.
    pub question: &'static str,
    /// Names and meanings; the first is the default.
    pub values: &'static [(&'static str, &'static str)],
}

/// Every policy, in the order of `docs/numerics.md`. Values stand in the order of the enumerations above.
pub const POLICIES: &[Policy] = &[
    Policy {
        rule: "NUM-3",
        question: "lowest value of a register",
        values: &[("256", "saturates at -256"), ("255", "saturates at -255")],
    },
    Policy {
        rule: "TSH-6",
        question: "what makes a byte a coordinate of a dependent read",
        values: &[("255", "v / 255: 255 is 1.0"), ("256", "v / 256: 255 is the last of 256 texels")],
    },
    Policy {
        rule: "CMB-3",
        question: "centre of the expand mappings",
        values: &[("centred", "2 (x - 128): 128 becomes 0"), ("literal", "2x - 255: 127 becomes -1, 128 becomes 1")],
    },
    Policy {
        rule: "CMB-4",
        question: "one half in the half-bias mappings",
        values: &[("128", "x - 128"), ("127", "x - 127"), ("127.5", "x - 127.5, the half bit kept up to the product")],
    },
    Policy {
        rule: "CMB-7",
        question: "rounding of AB + CD",
        values: &[("once", "after the sum"), ("each", "each product before the sum")],
    },
    Policy {
        rule: "CMB-8",
        question: "rounding of a dot product",
        values: &[("once", "after the sum"), ("each", "each product before the sum")],
    },
    Policy {
        rule: "CMB-9",
        question: "division by 255 and output scale",
        values: &[("before", "rounded, then biased and scaled"), ("after", "biased and scaled, then rounded")],
    },
    Policy {
        rule: "CMB-10",
        question: "mux on a negative SPARE0.a in MSB mode",
        values: &[("sign", "negative is not set"), ("bit7", "bit 7 of the two's complement value")],
    },
    Policy {
        rule: "FIN-2",
        question: "rounding of the final combiner's lerp",
        values: &[("once", "after the sum"), ("twice", "each product before the sum")],
    },
];

/// A `--policy` argument that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PolicyError {
    /// No `=`.
    Form(String),
    /// No rule of that id has alternatives.
    Rule(String),
    /// The rule has no such value.
    Value {
        /// The rule.
        policy: &'static Policy,
        /// What was given.
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
