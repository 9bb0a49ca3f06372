//! Decodes programs from words, and encodes them.

use super::code::{final_byte, final_of, input_byte, output_word, portion_of, refusal};
use super::{Refusal, RegisterWords, Word, layout};
use crate::{Part, Place};
use ninebit::state::{Combiners, FinalCombiner, GeneralStage, MuxSelect, Profile};

/// Decodes the program of the words. The words of stages that are not used are checked, but do not affect the program.
///
/// # Errors
/// A refusal for every word that the chip does not accept.
pub fn decode(words: &RegisterWords) -> Result<Combiners, Vec<Refusal>> {
    let chip = words.chip;
    let refusals: Vec<Refusal> =
        words.all().filter_map(|(word, index, value)| refusal(word, index, value, chip)).collect();
    if !refusals.is_empty() {
        return Err(refusals);
    }
    let color = |index| color_of(words.get(Word::RcColor, index));
    let shared = [color(0), color(1)];
    let (word, index) = layout::config(chip);
    let config = words.get(word, index);
    let (count, msb) = (layout::stages(chip).value_in(config), layout::mux_by_msb(chip).is_set(config));
    let own = layout::OWN_CONSTANTS.map(|field| chip == Profile::Nv2a && field.is_set(config));
    let stages = (0..count as usize).map(|n| {
        let portion = |inputs, outputs, alpha| portion_of(words.get(inputs, n), words.get(outputs, n), alpha);
        let constants = match chip {
            Profile::Nv10 => shared,
            // Without own constants, all stages read those of the first stage.
            Profile::Nv2a => [0, 1].map(|k| {
                let word = [Word::RcConstantColor0, Word::RcConstantColor1][k];
                color_of(words.get(word, if own[k] { n } else { 0 }))
            }),
        };
        GeneralStage {
            rgb: portion(Word::RcInRgb, Word::RcOutRgb, false),
            alpha: portion(Word::RcInAlpha, Word::RcOutAlpha, true),
            constants,
        }
    });
    let (final0, final1) = (words.get(Word::RcFinal0, 0), words.get(Word::RcFinal1, 0));
    let [a, b, c, d] = layout::BYTES.map(|field| final_of(field.value_in(final0), false));
    let [e, f, g, _] = layout::BYTES.map(|field| field.value_in(final1));
    let [e, f] = [e, f].map(|byte| final_of(byte, false));
    Ok(Combiners {
        stages: stages.collect(),
        mux_select: if msb { MuxSelect::Msb } else { MuxSelect::Lsb },
        final_combiner: FinalCombiner {
            inputs: [a, b, c, d, e, f],
            g: final_of(g, true),
            color_sum_clamp: layout::COLOR_SUM_CLAMP.is_set(final1),
            invert_secondary: layout::INVERT_SECONDARY.is_set(final1),
            invert_spare0: layout::INVERT_SPARE0.is_set(final1),
            constants: shared,
        },
    })
}

/// Encodes a program that is legal on the chip. Words that it does not use are 0.
pub fn encode(combiners: &Combiners, chip: Profile) -> RegisterWords {
    let mut words = RegisterWords::new(chip);
    let count = combiners.stages.len().min(chip.general_stages());
    let stages = &combiners.stages[..count];
    for (n, stage) in stages.iter().enumerate() {
        for (portion, inputs, outputs) in
            [(&stage.rgb, Word::RcInRgb, Word::RcOutRgb), (&stage.alpha, Word::RcInAlpha, Word::RcOutAlpha)]
        {
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| input_byte(&portion.inputs[k]));
            words.set(inputs, n, u32::from_be_bytes([a, b, c, d].map(|byte| byte as u8)));
            words.set(outputs, n, output_word(portion));
        }
    }
    let (word, index) = layout::config(chip);
    let mut config = words.get(word, index) | layout::stages(chip).put(count as u32);
    config |= layout::mux_by_msb(chip).put((combiners.mux_select == MuxSelect::Msb).into());
    if chip == Profile::Nv2a {
        for (k, word) in [Word::RcConstantColor0, Word::RcConstantColor1].into_iter().enumerate() {
            let own = stages.windows(2).any(|pair| pair[0].constants[k] != pair[1].constants[k]);
            config |= layout::OWN_CONSTANTS[k].put(own.into());
            for (n, stage) in stages.iter().enumerate().take(if own { count } else { 1 }) {
                words.set(word, n, color_word(stage.constants[k]));
            }
        }
    }
    words.set(word, index, config);
    let state = &combiners.final_combiner;
    for (n, constant) in state.constants.into_iter().enumerate() {
        words.set(Word::RcColor, n, color_word(constant));
    }
    let [a, b, c, d, e, f] = [0, 1, 2, 3, 4, 5].map(|n| final_byte(&state.inputs[n]));
    words.set(Word::RcFinal0, 0, a << 24 | b << 16 | c << 8 | d);
    let flags = layout::COLOR_SUM_CLAMP.put(state.color_sum_clamp.into())
        | layout::INVERT_SECONDARY.put(state.invert_secondary.into())
        | layout::INVERT_SPARE0.put(state.invert_spare0.into());
    words.set(Word::RcFinal1, 0, e << 24 | f << 16 | final_byte(&state.g) << 8 | flags);
    words
}

/// Decodes a constant colour A8R8G8B8 into R, G, B, A.
pub fn color_of(word: u32) -> [u8; 4] {
    let [b, g, r, a] = word.to_le_bytes();
    [r, g, b, a]
}

/// Encodes a constant colour R, G, B, A as A8R8G8B8.
pub fn color_word([r, g, b, a]: [u8; 4]) -> u32 {
    u32::from_le_bytes([b, g, r, a])
}

/// Returns the word and the index that hold a part of a program.
pub(crate) fn word_of(place: Place, chip: Profile) -> (Word, usize) {
    match place {
        Place::Stages | Place::Stage(_) => layout::config(chip),
        Place::StageConstants(stage) => match chip {
            Profile::Nv10 => (Word::RcColor, 0),
            Profile::Nv2a => (Word::RcConstantColor0, stage),
        },
        Place::FinalConstants => (Word::RcColor, 0),
        Place::General { stage, alpha, part: Part::Input(_) | Part::Component(_) } => {
            (if alpha { Word::RcInAlpha } else { Word::RcInRgb }, stage)
        }
        Place::General { stage, alpha, .. } => (if alpha { Word::RcOutAlpha } else { Word::RcOutRgb }, stage),
        Place::FinalInput(n) | Place::FinalComponent(n) => (if n < 4 { Word::RcFinal0 } else { Word::RcFinal1 }, 0),
    }
}
