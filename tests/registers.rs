//! Tests register words: conversion from programs and back, refused values, and printed forms.
#![allow(clippy::float_arithmetic, clippy::unwrap_used, missing_docs, unreachable_pub, reason = "a test binary")]

use ninebit_test_support::random_scene;

use std::path::Path;

use ninebit::limits::Limits;
use ninebit::state::*;
use ninebit_program::registers::{RegisterWords, Word, decode, describe, encode, refusal, stored};
use ninebit_scene as scene;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

#[test]
fn programs_survive_their_words() {
    let mut runner = TestRunner::deterministic();
    let mut programs = [0, 0];
    for _ in 0..400 {
        let scene = random_scene::scene().new_tree(&mut runner).unwrap().current();
        for draw in &scene.draws {
            let words = encode(&draw.combiners, scene.profile);
            assert_eq!(decode(&words).as_ref(), Ok(&draw.combiners));
            // The words as they are written in a scene.
            let text = format!(
                "(version: 1, profile: {}, draws: [(vertices: Window([]), program: {})])",
                scene.profile.name(),
                scene::register_words(&words)
            );
            let loaded = scene::parse(&text, Path::new("words.ron"), &Limits::default());
            let loaded = loaded.unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(loaded.scene.draws[0].combiners, draw.combiners);
            assert_eq!(describe(&words).len(), words.all().count());
            programs[usize::from(scene.profile == Profile::Nv2a)] += 1;
        }
    }
    assert!(programs.iter().all(|count| *count > 100), "{programs:?}");
}

fn code(chip: Profile, final_sum: bool) -> impl Strategy<Value = u32> {
    let codes: Vec<u32> = (0..16)
        .filter(|code| !matches!(code, 6 | 7))
        .filter(|code| chip == Profile::Nv2a || !matches!(code, 10 | 11))
        .filter(|code| final_sum || *code < 14)
        .collect();
    prop::sample::select(codes)
}

/// Packs four bytes into a word, the first in the highest bits.
fn pack([a, b, c, d]: [u32; 4]) -> u32 {
    a << 24 | b << 16 | c << 8 | d
}

/// Returns words that the chip accepts.
fn words(chip: Profile) -> impl Strategy<Value = RegisterWords> {
    let stages = chip.general_stages();
    let input = || {
        let bytes = prop::array::uniform4((code(chip, false), 0..16u32).prop_map(|(code, rest)| rest << 4 | code));
        bytes.prop_map(pack)
    };
    let output = || {
        let registers = code(chip, false).prop_filter("written", |code| !matches!(code, 1..=3));
        let operation = prop::sample::select(vec![0u32, 1, 2, 3, 4, 6]);
        (prop::array::uniform3(registers), 0..8u32, operation, 0..4u32).prop_map(
            move |([cd, ab, sum], flags, operation, blue)| {
                let blue = if chip == Profile::Nv2a { blue } else { 0 };
                cd | ab << 4 | sum << 8 | flags << 12 | operation << 15 | blue << 18
            },
        )
    };
    let sum = prop::array::uniform4((code(chip, true), 0..4u32).prop_map(|(code, rest)| rest << 4 | code));
    let product = prop::array::uniform3((code(chip, false), 0..4u32).prop_map(|(code, rest)| rest << 4 | code));
    (
        prop::collection::vec((input(), input(), output(), output()), stages),
        sum,
        (product, 0..8u32),
        (1..=stages as u32, any::<bool>(), any::<[u32; 2]>(), any::<[bool; 2]>()),
        prop::collection::vec(any::<[u32; 2]>(), stages),
    )
        .prop_map(move |(stages, sum, (product, flags), (count, msb, colors, own), constants)| {
            let mut words = RegisterWords::new(chip);
            // Unused words are 0, as they are when programs are encoded.
            for (n, (alpha, rgb, out_alpha, out_rgb)) in stages.into_iter().enumerate().take(count as usize) {
                words.set(Word::RcInAlpha, n, alpha);
                words.set(Word::RcInRgb, n, rgb);
                words.set(Word::RcOutAlpha, n, out_alpha & 0x3_cfff);
                words.set(Word::RcOutRgb, n, out_rgb);
            }
            if chip == Profile::Nv10 {
                let second = words.get(Word::RcOutRgb, 1);
                words.set(Word::RcOutRgb, 1, second | u32::from(msb) << 27 | count << 28);
            } else {
                let mut config = count | u32::from(msb) << 8;
                for k in 0..2 {
                    let word = [Word::RcConstantColor0, Word::RcConstantColor1][k];
                    let used: Vec<u32> = constants.iter().take(count as usize).map(|pair| pair[k]).collect();
                    let own = own[k] && used.iter().any(|value| *value != used[0]);
                    config |= u32::from(own) << [12, 16][k];
                    for (n, value) in used.into_iter().enumerate().take(if own { 8 } else { 1 }) {
                        words.set(word, n, value);
                    }
                }
                words.set(Word::RcConfig, 0, config);
            }
            words.set(Word::RcFinal0, 0, pack(sum));
            let [e, f, g] = product;
            words.set(Word::RcFinal1, 0, e << 24 | f << 16 | g << 8 | flags << 5);
            (0..2).for_each(|n| words.set(Word::RcColor, n, colors[n]));
            words
        })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, ..ProptestConfig::default() })]

    #[test]
    fn words_survive_their_programs(words in prop_oneof![words(Profile::Nv10), words(Profile::Nv2a)]) {
        let program = decode(&words).unwrap_or_else(|refusals| panic!("{refusals:?}"));
        prop_assert_eq!(encode(&program, words.chip), words);
    }

    /// A word that is accepted keeps all of its bits. One that is refused has a message with its value, and help.
    #[test]
    fn a_word_is_taken_or_refused(n in 0..Word::ALL.len(), index in 0..2usize, value in any::<u32>(), nv2a in any::<bool>()) {
        let chip = if nv2a { Profile::Nv2a } else { Profile::Nv10 };
        let word = Word::ALL[n];
        prop_assume!(index < word.count(chip));
        match refusal(word, index, value, chip) {
            None => prop_assert_eq!(stored(word, index, value, chip), value),
            Some(refusal) => {
                let value = format!("{value:08x}");
                prop_assert!(refusal.message.contains(&value) && !refusal.help.is_empty());
            }
        }
    }
}

/// Tests all values of the fields that decide whether a word is accepted.
#[test]
fn codes_are_taken_as_the_chips_do() {
    for chip in [Profile::Nv10, Profile::Nv2a] {
        let lacks = |code: u32| matches!(code, 6 | 7) || chip == Profile::Nv10 && matches!(code, 10 | 11);
        for code in 0..16 {
            for shift in [0, 8, 16, 24] {
                let value = code << shift;
                let taken = |word| refusal(word, 0, value, chip).is_none();
                assert_eq!(taken(Word::RcInRgb), !lacks(code) && code < 14);
                assert_eq!(taken(Word::RcInAlpha), !lacks(code) && code < 14);
                assert_eq!(taken(Word::RcFinal0), !lacks(code));
                if shift > 0 {
                    assert_eq!(taken(Word::RcFinal1), !lacks(code) && code < 14);
                }
            }
            for shift in [0, 4, 8] {
                let taken = |word| refusal(word, 0, code << shift, chip).is_none();
                let wanted = !lacks(code) && !matches!(code, 1..=3) && code < 14;
                assert_eq!([taken(Word::RcOutAlpha), taken(Word::RcOutRgb)], [wanted; 2], "{code:x}");
            }
        }
        for operation in 0..8 {
            let found = refusal(Word::RcOutRgb, 0, operation << 15, chip).map(|refusal| refusal.code);
            assert_eq!(found, matches!(operation, 5 | 7).then_some("NB0362"));
        }
        for bit in 0..32 {
            let refused = |word, index| refusal(word, index, 1 << bit, chip).is_some_and(|r| r.code == "NB0361");
            assert_eq!(refused(Word::RcOutAlpha, 0), matches!(bit, 12 | 13 | 18..));
            let beyond = if chip == Profile::Nv10 { 18 } else { 20 };
            assert_eq!(refused(Word::RcOutRgb, 0), bit >= beyond);
        }
    }
    let count = |word, index, value, chip| refusal(word, index, value, chip).map(|refusal| refusal.code);
    for stages in 0..4u32 {
        let found = count(Word::RcOutRgb, 1, stages << 28, Profile::Nv10);
        assert_eq!(found, matches!(stages, 0 | 3).then_some("NB0363"));
    }
    for stages in 0..16u32 {
        let found = count(Word::RcConfig, 0, stages, Profile::Nv2a);
        assert_eq!(found, (!(1..=8).contains(&stages)).then_some("NB0363"));
    }
}

#[test]
fn stages_without_own_constants_read_those_of_the_first() {
    let mut words = RegisterWords::new(Profile::Nv2a);
    words.set(Word::RcConfig, 0, 0x1_0102);
    words.set(Word::RcConstantColor0, 0, 0x0102_0304);
    words.set(Word::RcConstantColor0, 1, 0x0506_0708);
    words.set(Word::RcConstantColor1, 0, 0x1112_1314);
    words.set(Word::RcConstantColor1, 1, 0x1516_1718);
    words.set(Word::RcFinal1, 0, 0x1c80);
    let program = decode(&words).unwrap();
    assert_eq!(program.mux_select, MuxSelect::Msb);
    assert_eq!(program.stages[0].constants, [[2, 3, 4, 1], [0x12, 0x13, 0x14, 0x11]]);
    assert_eq!(program.stages[1].constants, [[2, 3, 4, 1], [0x16, 0x17, 0x18, 0x15]]);
}
