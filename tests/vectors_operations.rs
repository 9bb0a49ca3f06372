//! Checks that the table of operations has every operation of every unit, that every operation with up to 2^32 inputs has a digest tree,
//! and that operations which the table splits are independent. `vectors/operations.tsv` is the table for readers.
#![allow(clippy::unwrap_used, missing_docs, reason = "a test fails by panicking")]

use crate::operations::OPERATIONS;
use crate::pages;
use crate::repository::at;
use crate::settings::bless;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use ninebit::random::Random;
use ninebit::state::{BlendEquation, BlendFactor, Named, Policies, Profile, TextureFormat};
use ninebit::texture::compressed;
use ninebit_vectors::column::{Column, Kind};
use ninebit_vectors::exhaustive::Exhaustive;
use ninebit_vectors::tree::Tree;
use ninebit_vectors::unit::{Conditions, Unit};
use ninebit_vectors::units;

/// An operation of a unit, as the table has it.
struct Row {
    unit: String,
    operation: String,
    bits: u32,
    trees: Vec<String>,
}

/// Returns all trees under `vectors/digests` by name, which is the path without the extension.
fn trees() -> BTreeMap<String, Exhaustive> {
    let folder = &at("vectors/digests");
    let list = |folder: &Path| -> Vec<PathBuf> {
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect()
    };
    let paths = list(folder).into_iter().flat_map(|path| if path.is_dir() { list(&path) } else { vec![path] });
    let named = paths.map(|path| {
        let name = path.strip_prefix(folder).unwrap().with_extension("");
        (name.to_str().unwrap().to_owned(), Tree::read(&path).unwrap().1)
    });
    named.collect()
}

/// Returns the operations with the names of their trees.
fn table(trees: &BTreeMap<String, Exhaustive>) -> Vec<Row> {
    let named = |name: &&str| match name.strip_suffix('*') {
        Some(folder) => trees.keys().filter(|tree| tree.starts_with(folder)).cloned().collect(),
        None => vec![(*name).to_owned()],
    };
    let row = |(unit, operation, bits, own): &(&str, &str, u32, &[&str])| Row {
        unit: (*unit).to_owned(),
        operation: (*operation).to_owned(),
        bits: *bits,
        trees: own.iter().flat_map(named).collect(),
    };
    OPERATIONS.iter().map(row).collect()
}

#[test]
fn the_file_has_the_table() {
    let mut table = "unit\toperation\tbits\ttrees\n".to_owned();
    for (unit, operation, bits, trees) in OPERATIONS {
        let named = if trees.is_empty() { "none".to_owned() } else { trees.join(", ") };
        table += &format!("{unit}\t{operation}\t{bits}\t{named}\n");
    }
    let path = at("vectors/operations.tsv");
    if bless() {
        pages::write(&path, &table);
    }
    assert_eq!(std::fs::read_to_string(path).unwrap(), table, "BLESS=1 writes it");
}

/// Returns the number of bits of the inputs among these columns, rounded up. Configuration does not count.
fn bits(columns: &[Column]) -> u32 {
    let inputs = columns.iter().filter(|column| column.name.starts_with("in."));
    inputs.map(|column| (column.size() as f64).log2()).sum::<f64>().ceil() as u32
}

#[test]
fn every_operation_of_up_to_32_bits_has_its_tree() {
    let trees = trees();
    let rows = table(&trees);
    let mut named = BTreeSet::new();
    for Row { unit, operation, bits: said, trees: own } in &rows {
        let whole = bits(&units::by_name(unit).unwrap_or_else(|| panic!("no unit {unit}")).inputs());
        assert!(*said <= whole, "{unit}: {operation} has more inputs than the unit");
        if own.is_empty() {
            assert!(*said > 32, "{unit}: {operation} has {said} bits and no tree");
        }
        let most = own.iter().map(|name| {
            assert!(named.insert(name), "{name} stands there twice");
            let sweep = trees.get(name).unwrap_or_else(|| panic!("there is no tree {name}"));
            assert_eq!(sweep.unit().name(), unit, "{name}");
            bits(sweep.part().columns())
        });
        // The number of bits is that of the largest tree, whose configuration is fixed.
        assert!(most.max().is_none_or(|most| most == *said), "{unit}: {operation}");
    }
    let unnamed: Vec<&String> = trees.keys().filter(|name| !named.contains(name)).collect();
    assert!(unnamed.is_empty(), "no operation has {unnamed:?}");
    for unit in units::all() {
        let own: Vec<&Row> = rows.iter().filter(|row| row.unit == unit.name()).collect();
        assert!(!own.is_empty(), "{} has no operation", unit.name());
        let whole = bits(&unit.inputs());
        let above = own.iter().filter(|row| row.trees.is_empty());
        let swept: Vec<&Exhaustive> = own.iter().flat_map(|row| &row.trees).map(|name| &trees[name]).collect();
        assert!(whole > 32 || !swept.is_empty(), "{} has {whole} bits and no tree", unit.name());
        let above: Vec<&Row> = above.copied().collect();
        if swept.is_empty() {
            assert_eq!(above[0].bits, whole, "{}", unit.name());
            continue;
        }
        for (n, column) in unit.inputs().into_iter().enumerate() {
            // Every choice of a unit occurs in a tree. A new operation does not, and fails here.
            if let Kind::Name(names) = column.kind {
                let taken: BTreeSet<i64> = swept.iter().flat_map(|sweep| numbers(&sweep.part().columns()[n])).collect();
                let missing: Vec<&str> =
                    numbers(&column).filter(|n| !taken.contains(n)).map(|n| names[n as usize]).collect();
                let remedy = "make one as docs/vectors.md says below Every row";
                assert!(missing.is_empty(), "{} {}: no tree has {missing:?}: {remedy}", unit.name(), column.name);
            } else if column.name.starts_with("in.") {
                // Every input varies in a tree as well, unless it is one of several channels that are computed alike.
                let varies =
                    swept.iter().any(|sweep| sweep.part().columns()[n].size() > 1 || sweep.part().is_followed(n));
                let channel = [".g", ".b", ".r"].iter().any(|end| column.name.ends_with(end));
                assert!(varies || channel || !above.is_empty(), "{} {}", unit.name(), column.name);
            }
        }
    }
}

fn numbers(column: &Column) -> impl Iterator<Item = i64> {
    (0..column.size()).map(|place| column.nth(place))
}

fn evaluate(unit: &dyn Unit, inputs: &[i64]) -> Vec<i64> {
    let mut results = vec![0; unit.results().len()];
    unit.evaluate(inputs, &Conditions { profile: Profile::Nv2a, policies: Policies::DEFAULT }, &mut results);
    results
}

/// Trees of nv2a are also valid for nv10. Compressed blocks are excluded, because they have trees of their own.
#[test]
fn both_chips_have_the_same_trees() {
    let mut count = 0;
    for (name, sweep) in trees() {
        let mut random = Random::new(2, &name);
        if sweep.unit().profiles().len() == 1 || sweep.unit().name() == "compressed-block" {
            continue;
        }
        let other = Exhaustive::from_part(sweep.unit(), Profile::Nv10, sweep.part().clone()).unwrap();
        let rows = sweep.size().min(500);
        for _ in 0..3 {
            let start = random.below(u128::from(sweep.size() - rows + 1)) as u64;
            assert_eq!(sweep.digest(start..start + rows), other.digest(start..start + rows), "{name} from {start}");
        }
        count += 1;
    }
    assert!(count > 50);
}

/// A channel with any factors has the same result as red with the constant's red and alpha as factors. Blending is thus one operation of
/// four bytes, and computing a factor is another.
#[test]
fn a_blend_depends_on_its_factors_by_their_values() {
    let unit = units::by_name("blend").unwrap();
    let mut random = Random::new(1, "factors");
    for equation in 0..BlendEquation::ALL.len() as i64 {
        for (source, destination) in (0..BlendFactor::ALL.len() as i64).flat_map(|s| (0..15).map(move |d| (s, d))) {
            for _ in 0..12 {
                let mut row: Vec<i64> = [equation, source, destination].to_vec();
                row.extend((0..12).map(|_| random.below(256) as i64));
                let results = evaluate(unit, &row);
                for channel in 0..4 {
                    let [s, d] = [row[3 + channel], row[7 + channel]];
                    let [fs, fd] = [results[channel], results[4 + channel]];
                    let named = [BlendFactor::ConstantColor as i64, BlendFactor::ConstantAlpha as i64];
                    let plain = [&[equation, named[0], named[1]][..], &[s, 0, 0, 0, d, 0, 0, 0, fs, 0, 0, fd]].concat();
                    assert_eq!(evaluate(unit, &plain)[8], results[8 + channel], "{row:?} channel {channel}");
                }
            }
        }
    }
}

/// Tests every pair of end points of one channel, with each code, at each texel, with several values of the other channels. The other
/// channels have an effect only through the comparison of the end points as 16-bit numbers.
#[test]
fn channels_of_a_block_meet_in_nothing_but_the_comparison() {
    let fields = [(11, 32), (5, 64), (0, 32)];
    for (channel, (shift, levels)) in fields.into_iter().enumerate() {
        let mask = (levels - 1) << shift;
        for (first, second) in (0..levels).flat_map(|a| (0..levels).map(move |b| (a << shift, b << shift))) {
            for code in [0, 0x5555_5555, 0xaaaa_aaaa, 0xffff_ffff_u32] {
                // Other channels that leave the comparison to this channel, or decide it.
                let others = [[0x1234, 0x1234], [0xffff, 0x0000], [0x0000, 0xffff]];
                let word = |[a, b]: [u32; 2]| (second | b & !mask) << 16 | first | a & !mask;
                let four = |[a, b]: [u32; 2]| (first | a & !mask) > (second | b & !mask);
                for (at, dithered) in (0..16).flat_map(|at| [(at, false), (at, true)]) {
                    let texel = |others| {
                        let block = [word(others), code];
                        compressed::decode(TextureFormat::Dxt1, dithered, &block, at % 4, at / 4).bytes[channel]
                    };
                    let plain = others.map(|others| (four(others), texel(others)));
                    for (n, m) in [(0, 1), (0, 2), (1, 2)] {
                        assert!(plain[n].0 != plain[m].0 || plain[n].1 == plain[m].1, "{first:x} {second:x} {code:x}");
                    }
                }
            }
        }
    }
}
