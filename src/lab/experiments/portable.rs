//! Sine, cosine, powers and logarithms for experiments. `libm` gives the same bytes on every platform; the standard library calls the functions of
//! the system.

pub(super) use libm::{cos, exp2, log2, pow, sin};

#[cfg(test)]
mod tests {
    /// Checks that no experiment calls functions that the standard library leaves to the platform.
    #[test]
    fn no_experiment_asks_the_platform() {
        let methods = [
            "sin", "cos", "tan", "sin_cos", "asin", "acos", "atan", "atan2", "powf", "powi", "exp", "exp2", "ln",
            "log2", "log10",
        ];
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments");
        let mut read = 0;
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|end| end != "rs") || path.ends_with("portable.rs") {
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap();
            for method in methods {
                for call in [format!(".{method}("), format!("f64::{method}")] {
                    assert!(!text.contains(&call), "{}: {call}", path.display());
                }
            }
            read += 1;
        }
        assert!(read >= 15, "{read}");
        // The results have the same bits everywhere: those of 0.479425538604203 and of 0.4304672100000001 (because 0.9 is a little more than nine
        // tenths).
        assert_eq!(super::sin(0.5).to_bits(), 4_602_308_182_625_945_072);
        assert_eq!(super::pow(0.9, 8.0).to_bits(), 4_601_426_227_784_110_790);
    }
}
