//! Prints programs as text. Every program has exactly one printed form.

use std::fmt::Write;

use super::words::{final_operand, operand, register, scale};
use ninebit::state::*;

/// Prints a program, legal or not. Reading the text gives the same state, provided that there is a general stage.
pub fn print(combiners: &Combiners) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = program(&mut out, combiners);
    out
}

fn program(out: &mut String, combiners: &Combiners) -> std::fmt::Result {
    let shared = combiners.final_combiner.constants;
    constants(out, "", [[0; 4]; 2], shared)?;
    if combiners.mux_select == MuxSelect::Lsb {
        writeln!(out, "mux_by_least_significant_bit();")?;
    }
    for stage in &combiners.stages {
        general_stage(out, stage, shared)?;
    }
    final_combiner(out, &combiners.final_combiner)
}

/// Prints the constants that differ from those that hold without a statement.
fn constants(out: &mut String, indent: &str, without: [[u8; 4]; 2], constants: [[u8; 4]; 2]) -> std::fmt::Result {
    for n in 0..2 {
        if constants[n] != without[n] {
            let [r, g, b, a] = constants[n];
            writeln!(out, "{indent}const{n} = bytes({r}, {g}, {b}, {a});")?;
        }
    }
    Ok(())
}

fn general_stage(out: &mut String, stage: &GeneralStage, shared: [[u8; 4]; 2]) -> std::fmt::Result {
    writeln!(out, "{{")?;
    constants(out, "    ", shared, stage.constants)?;
    portion(out, "rgb", &stage.rgb, false)?;
    portion(out, "alpha", &stage.alpha, true)?;
    writeln!(out, "}}")
}

fn portion(out: &mut String, name: &str, portion: &Portion, alpha: bool) -> std::fmt::Result {
    let component = if alpha { Component::Alpha } else { Component::Rgb };
    if *portion == Portion::idle(component) {
        return Ok(());
    }
    writeln!(out, "    {name} {{")?;
    let idle = CombinerInput::zero(component);
    let products = [
        (portion.ab_output, portion.ab_dot_product, portion.ab_blue_to_alpha),
        (portion.cd_output, portion.cd_dot_product, portion.cd_blue_to_alpha),
    ];
    let written = [0, 1].map(|n| {
        let inputs = &portion.inputs[2 * n..2 * n + 2];
        products[n] != (Register::Zero, false, false) || inputs.iter().any(|input| *input != idle)
    });
    for (n, (output, dot, blue)) in products.into_iter().enumerate() {
        // The first product is AB, so it is printed whenever CD is.
        if written[n] || written[1] {
            let [a, b] = [0, 1].map(|k| operand(&portion.inputs[2 * n + k], alpha));
            let blue = if blue { ", blue_to_alpha" } else { "" };
            writeln!(out, "        {} = {a} {} {b}{blue};", destination(output), if dot { "." } else { "*" })?;
        }
    }
    if portion.mux || portion.sum_output != Register::Zero {
        let what = if portion.mux { "mux" } else { "sum" };
        writeln!(out, "        {} = {what}();", destination(portion.sum_output))?;
    }
    if portion.bias == Bias::NegativeHalf {
        writeln!(out, "        bias_by_negative_one_half();")?;
    }
    if let Some(scale) = scale(portion.scale) {
        writeln!(out, "        {scale}();")?;
    }
    writeln!(out, "    }}")
}

fn destination(output: Register) -> &'static str {
    if output == Register::Zero { "discard" } else { register(output) }
}

fn final_combiner(out: &mut String, state: &FinalCombiner) -> std::fmt::Result {
    let zero = FinalInput::zero(Component::Rgb);
    let [a, b, c, d, e, f] = &state.inputs;
    if [e, f] != [&zero; 2] {
        writeln!(out, "final_product = {} * {};", final_operand(e, false), final_operand(f, false))?;
    }
    if state.invert_spare0 || state.invert_secondary {
        let side = |name: &str, invert: bool| {
            if invert { format!("unsigned_invert({name})") } else { name.to_owned() }
        };
        writeln!(
            out,
            "color_sum = {} + {};",
            side("spare0", state.invert_spare0),
            side("col1", state.invert_secondary)
        )?;
    }
    if state.color_sum_clamp {
        writeln!(out, "clamp_color_sum();")?;
    }
    writeln!(out, "out.rgb = {};", final_rgb([a, b, c, d]))?;
    writeln!(out, "out.a = {};", final_operand(&state.g, true))
}

/// Returns A B + (1 - A) C + D, without the terms that are zero.
fn final_rgb(inputs: [&FinalInput; 4]) -> String {
    let zero = FinalInput::zero(Component::Rgb);
    let [a, b, c, d] = inputs.map(|input| final_operand(input, false));
    let written = inputs.map(|input| *input != zero);
    let plus = if written[3] { format!(" + {d}") } else { String::new() };
    match written {
        [false, false, false, _] => d,
        [_, _, true, _] => format!("lerp({a}, {b}, {c}){plus}"),
        _ => format!("{a} * {b}{plus}"),
    }
}
