//! Checks that the model's combiners, run on the recipes' placements, give the results of the tables.

use super::*;
use crate::cases::{self, Level};
use crate::{Conditions, Contents, Writer, units};
use ninebit::combiner::registers::Registers;
use ninebit::state::{Policies, Register};

/// Returns the channels of a pixel as the model draws it.
fn pixel(placement: &Placement, combiners: &Combiners) -> [i32; 4] {
    let mut file = Registers::<i32>::new();
    for (name, bytes) in &placement.sources {
        let register = match *name {
            "texture0" => Register::Texture0,
            "texture1" => Register::Texture1,
            "texture2" => Register::Texture2,
            "texture3" => Register::Texture3,
            "primary" => Register::PrimaryColor,
            "secondary" => Register::SecondaryColor,
            other => panic!("no register takes {other}"),
        };
        file.load(register, std::array::from_fn(|n| bytes[n].into()));
    }
    let fog = placement.state.iter().find_map(|line| line.strip_prefix("fog_color "));
    if let Some(byte) = fog.and_then(|rest| rest.split(' ').next()) {
        file.load(Register::Fog, [byte.parse().unwrap(), byte.parse().unwrap(), byte.parse().unwrap(), 0]);
    }
    combiners.run(file, &Policies::DEFAULT).map(i32::from)
}

/// Returns the results that the reads of all draws add up to.
fn observed(placement: &Placement) -> Vec<(String, i64)> {
    let mut sums: Vec<(String, i64)> = Vec::new();
    for draw in &placement.draws {
        let pixel = pixel(placement, draw.combiners.as_ref().unwrap());
        for read in &draw.reads {
            let value = read.weight * i64::from(pixel[read.channel]);
            match sums.iter_mut().find(|(column, _)| *column == read.column) {
                Some((_, sum)) => *sum += value,
                None => sums.push((read.column.clone(), value)),
            }
        }
    }
    sums
}

#[test]
fn the_model_answers_what_recipes_ask() {
    for profile in [Profile::Nv10, Profile::Nv2a] {
        for unit in units::all().into_iter().filter(|unit| unit.profiles().contains(&profile)) {
            let writer = Writer::new(Contents { unit, profile, level: Level::L0, seed: 1 });
            let mut asked = 0;
            cases::visit(unit, profile, Level::L0, 1, |inputs, origin| {
                if recipes(unit.name()).is_empty() {
                    return;
                }
                let mut results = vec![0; writer.results().len()];
                unit.evaluate(inputs, &Conditions { profile, policies: Policies::DEFAULT }, &mut results);
                let row = Row { inputs: inputs.to_vec(), results, origin, alternatives: Vec::new() };
                let case = Case { inputs: writer.inputs(), results: writer.results(), row: &row, profile };
                for placement in recipes(unit.name()).iter().filter_map(|recipe| recipe(&case)) {
                    if placement.path != Path::Combiners {
                        continue;
                    }
                    asked += 1;
                    assert!(placement.draws.iter().all(|draw| {
                        draw.combiners.as_ref().is_some_and(|c| c.stages.len() <= profile.general_stages())
                    }));
                    for (name, value) in observed(&placement) {
                        let column = writer.results().iter().position(|column| column.name == name).unwrap();
                        let kind = &writer.results()[column].kind;
                        assert_eq!(kind.read(&value.to_string()), Some(row.results[column]), "{name} of {row:?}");
                    }
                }
            });
            let combiners = ["product", "sum", "scale-bias", "input-mapping", "mux"];
            let nv2a = ["dot-product", "general-stage", "alpha-portion", "two-stages", "final-combiner"];
            let wanted = combiners.contains(&unit.name()) || profile == Profile::Nv2a && nv2a.contains(&unit.name());
            assert_eq!(asked > 20, wanted, "{}: {asked} rows", unit.name());
        }
    }
}

/// Recipes look columns up by name, and an unknown name would read as 0.
#[test]
fn recipes_name_columns_that_exist() {
    let sources = concat!(include_str!("stages.rs"), include_str!("environment.rs"), include_str!("fixed.rs"));
    let sources = [sources, include_str!("buffers.rs")].concat();
    let mut known: Vec<String> = Vec::new();
    for unit in units::all().into_iter().filter(|unit| !recipes(unit.name()).is_empty()) {
        known.extend(unit.inputs().into_iter().chain(unit.results()).map(|column| column.name));
    }
    for name in sources.split('"').filter(|text| ["in.", "out.", "cfg."].iter().any(|p| text.starts_with(p))) {
        let name = name.split(">>").next().unwrap();
        if !name.contains(['{', ' ']) {
            assert!(known.iter().any(|column| column == name), "{name}");
        }
    }
}
