//! Pixel programs as JSON: their state, register words and text; edits of their parts.

use std::fmt::Display;

use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::*;
use ninebit_lower::{Function, Language, Options, Textures};
use ninebit_program::registers::{describe, encode};
use ninebit_program::text::print;
use ninebit_scene::outline::{Content, Node, outline};
use serde_json::{Value, json};

use crate::Refused;

/// Returns a draw's program as JSON.
pub(crate) fn value(scene: &Scene, draw: &Draw) -> Value {
    let Combiners { stages, mux_select, final_combiner: last } = &draw.combiners;
    let portion = |portion: &Portion| {
        json!({
            "inputs": portion.inputs.iter().map(input).collect::<Vec<_>>(),
            "ab_output": portion.ab_output.destination(), "cd_output": portion.cd_output.destination(),
            "sum_output": portion.sum_output.destination(),
            "ab_dot_product": portion.ab_dot_product, "cd_dot_product": portion.cd_dot_product, "mux": portion.mux,
            "scale": portion.scale.name(), "bias": portion.bias.name(),
            "ab_blue_to_alpha": portion.ab_blue_to_alpha, "cd_blue_to_alpha": portion.cd_blue_to_alpha,
        })
    };
    let stage = |GeneralStage { rgb, alpha, constants }: &GeneralStage| json!({ "rgb": portion(rgb), "alpha": portion(alpha), "constants": constants });
    let words = describe(&encode(&draw.combiners, scene.profile)).into_iter().map(|word| {
        let (method, value) = (format!("{:04x}", word.method), format!("{:08x}", word.value));
        json!({ "method": method, "name": word.name, "value": value, "meaning": word.meaning })
    });
    json!({
        "stages": stages.iter().map(stage).collect::<Value>(),
        "mux_select": mux_select.name(),
        "final": {
            "inputs": last.inputs.iter().chain([&last.g]).map(final_input).collect::<Vec<_>>(),
            "color_sum_clamp": last.color_sum_clamp, "invert_spare0": last.invert_spare0, "invert_secondary": last.invert_secondary,
            "constants": last.constants,
        },
        "words": words.collect::<Value>(),
        "text": print(&draw.combiners),
        "origin": ninebit_report::origins(&draw.program_origin),
        "choices": {
            "destination": Register::ALL.iter().map(|register| register.destination()).collect::<Vec<_>>(),
            "register": Register::NAMES, "final_register": FinalRegister::NAMES, "component": Component::NAMES,
            "mapping": InputMapping::NAMES, "scale": Scale::NAMES, "bias": Bias::NAMES, "mux_select": MuxSelect::NAMES,
        },
    })
}

fn input(input: &CombinerInput) -> Value {
    json!({ "register": input.register.name(), "component": input.component.name(), "mapping": input.mapping.name() })
}

fn final_input(input: &FinalInput) -> Value {
    json!({ "register": input.register.name(), "component": input.component.name(), "invert": input.invert })
}

/// Returns a function of another language that computes the fragment of a draw, as `ninebit lower --fragment` prints it.
pub(crate) fn lowered(scene: &Scene, number: usize, policies: Policies, language: &str) -> Result<String, Refused> {
    let language = match language {
        "c99" => Language::C99,
        "glsl" => Language::Glsl,
        other => return Err(format!("`{other}` is no language of functions")),
    };
    let plan = Plan::compile(scene, &PlanOptions { policies, prune: false });
    let plan = plan.map_err(|errors| errors.into_iter().map(|error| error.message).collect::<String>())?;
    let options = Options { policies, uniform: false, textures: Textures::Registers, fragment: true };
    let draw = &scene.draws[number];
    let function = Function::of_draw(scene, draw, &plan.draws()[number], &options);
    let about = format!("draw {number} `{}`", ninebit::shown::name(&draw.name));
    Ok(language.print(&[ninebit_lower::NamedFunction {
        name: format!("ninebit_draw{number}"),
        about,
        function: &function,
    }]))
}

/// Returns the draw's program in the combiner language with one part changed. `path` is as in [`value`].
pub(crate) fn changed(draw: &Draw, path: &Value, value: &Value) -> Result<String, Refused> {
    let mut combiners = draw.combiners.clone();
    let path: Vec<String> = path.as_array().into_iter().flatten().map(word).collect();
    let path: Vec<&str> = path.iter().map(String::as_str).collect();
    set(&mut combiners, &path, value)?;
    Ok(written(&combiners))
}

/// Returns combiners as scenes write them.
pub(crate) fn written(combiners: &Combiners) -> String {
    format!("CombinerText({})", quoted(&print(combiners)))
}

fn word(part: &Value) -> String {
    part.as_str().map_or_else(|| part.to_string(), str::to_owned)
}

fn set(combiners: &mut Combiners, path: &[&str], value: &Value) -> Result<(), Refused> {
    let last = &mut combiners.final_combiner;
    match path {
        ["mux_select"] => choose(&mut combiners.mux_select, value),
        ["constants", n] => {
            // Constants of the whole program: those of the final combiner and of all stages with the same values.
            let slot = index(n, 2)?;
            let (before, after) = (last.constants[slot], color(value)?);
            last.constants[slot] = after;
            for stage in &mut combiners.stages {
                if stage.constants[slot] == before {
                    stage.constants[slot] = after;
                }
            }
            Ok(())
        }
        ["final", "inputs", n, field] => {
            let input = if *n == "6" { &mut last.g } else { &mut last.inputs[index(n, 6)?] };
            match *field {
                "register" => choose(&mut input.register, value),
                "component" => choose(&mut input.component, value),
                "invert" => switch(&mut input.invert, value),
                other => Err(unknown(other)),
            }
        }
        ["final", "color_sum_clamp"] => switch(&mut last.color_sum_clamp, value),
        ["final", "invert_spare0"] => switch(&mut last.invert_spare0, value),
        ["final", "invert_secondary"] => switch(&mut last.invert_secondary, value),
        ["final", "constants", n] => recolor(&mut last.constants, n, value),
        ["stages", n, rest @ ..] => {
            let number = index(n, combiners.stages.len())?;
            let stage = &mut combiners.stages[number];
            match rest {
                ["constants", n] => recolor(&mut stage.constants, n, value),
                ["rgb", rest @ ..] => set_portion(&mut stage.rgb, rest, value),
                ["alpha", rest @ ..] => set_portion(&mut stage.alpha, rest, value),
                _ => Err(unknown(path.join("."))),
            }
        }
        _ => Err(unknown(path.join("."))),
    }
}

fn set_portion(portion: &mut Portion, path: &[&str], value: &Value) -> Result<(), Refused> {
    match path {
        ["inputs", n, field] => {
            let input = &mut portion.inputs[index(n, 4)?];
            match *field {
                "register" => choose(&mut input.register, value),
                "component" => choose(&mut input.component, value),
                "mapping" => choose(&mut input.mapping, value),
                other => Err(unknown(other)),
            }
        }
        ["ab_output"] => redirect(&mut portion.ab_output, value),
        ["cd_output"] => redirect(&mut portion.cd_output, value),
        ["sum_output"] => redirect(&mut portion.sum_output, value),
        ["ab_dot_product"] => switch(&mut portion.ab_dot_product, value),
        ["cd_dot_product"] => switch(&mut portion.cd_dot_product, value),
        ["mux"] => switch(&mut portion.mux, value),
        ["scale"] => choose(&mut portion.scale, value),
        ["bias"] => choose(&mut portion.bias, value),
        ["ab_blue_to_alpha"] => switch(&mut portion.ab_blue_to_alpha, value),
        ["cd_blue_to_alpha"] => switch(&mut portion.cd_blue_to_alpha, value),
        _ => Err(unknown(path.join("."))),
    }
}

fn unknown(what: impl Display) -> Refused {
    format!("a program has no `{what}`")
}

fn index(text: &str, count: usize) -> Result<usize, Refused> {
    text.parse().ok().filter(|n| *n < count).ok_or_else(|| unknown(text))
}

fn choose<T: Named>(field: &mut T, value: &Value) -> Result<(), Refused> {
    let name = value.as_str().unwrap_or_default();
    *field = T::from_name(name).ok_or_else(|| format!("`{name}` is not one of {}", T::NAMES.join(", ")))?;
    Ok(())
}

fn redirect(field: &mut Register, value: &Value) -> Result<(), Refused> {
    let name = value.as_str().unwrap_or_default();
    *field = Register::from_destination(name).ok_or_else(|| format!("`{name}` is no destination"))?;
    Ok(())
}

fn switch(field: &mut bool, value: &Value) -> Result<(), Refused> {
    *field = value.as_bool().ok_or("neither true nor false")?;
    Ok(())
}

fn recolor(constants: &mut [[u8; 4]; 2], n: &str, value: &Value) -> Result<(), Refused> {
    constants[index(n, 2)?] = color(value)?;
    Ok(())
}

fn color(value: &Value) -> Result<[u8; 4], Refused> {
    let byte = |n: usize| value[n].as_u64().and_then(|n| u8::try_from(n).ok());
    let bytes = [byte(0), byte(1), byte(2), byte(3)];
    let [Some(r), Some(g), Some(b), Some(a)] = bytes else { return Err("a colour is four bytes".to_owned()) };
    Ok([r, g, b, a])
}

/// Returns a pasted program as scenes write it.
pub(crate) fn pasted(language: &str, program: &str) -> Result<String, Refused> {
    let program = program.trim();
    Ok(match language {
        "scene" => program.to_owned(),
        "RegisterWords" => format!("RegisterWords(text: {})", quoted(program)),
        "CombinerText" | "CombinerCalls" => format!("{language}({})", quoted(program)),
        other => return Err(format!("`{other}` is not a language of programs")),
    })
}

/// Returns a text as a raw string, with as many number signs as it needs.
fn quoted(text: &str) -> String {
    let mut signs = String::from("#");
    while text.contains(&format!("\"{signs}")) {
        signs.push('#');
    }
    format!("r{signs}\"\n{}\"{signs}", text.trim_end().to_owned() + "\n")
}

/// Replaces the value of a draw's field in the scene's text. A field that is not there is added.
pub(crate) fn replaced(text: &str, draw: usize, field: &str, value: &str) -> Result<String, Refused> {
    let tree = outline(text);
    let number = draw.to_string();
    let (node, value) = match tree.at(&["draws", &number, field]) {
        Some(node) => (node, value.to_owned()),
        None => match tree.at(&["draws", &number]) {
            Some(node @ Node { content: Content::Group { around: [before, after], .. }, .. }) => {
                (node, format!("{before}{field}: {value}{after}"))
            }
            _ => return Err(format!("this draw's text has no place for `{field}`")),
        },
    };
    let mut changed = text.to_owned();
    changed.replace_range(node.span.clone(), &value);
    Ok(changed)
}
