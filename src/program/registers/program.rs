//! Whole programs from words, and back.

use super::code::{final_byte, final_of, input_byte, output_word, portion_of, refusal};
use super::{Refusal, RegisterWords, Word};
use crate::{Part, Place};
use ninebit::state::{Combiners, FinalCombiner, GeneralStage, MuxSelect, Profile};

/// The program that the words are. Words of stages that are not used are checked and have no part in it.
///
/// # Errors
/// Every word that the chip does not take.
pub fn decode(words: &RegisterWords) -> Result<Combiners, Vec<Refusal>> {
    let chip = words.chip;
    let refusals: Vec<Refusal> =
        words.all().filter_map(|(word, index, value)| refusal(word, index, value, chip)).collect();
    if !refusals.is_empty() {
        return Err(refusals);
    }
    let color = |index| color_of(words.get(Word::RcColor, index));
    let shared = [color(0), color(1)];
    let (count, msb, own) = match chip {
        Profile::Nv10 => {
            let word = words.get(Word::RcOutRgb, 1);
            (word >> 28 & 3, word >> 27 & 1 == 1, [false; 2])
        }
        Profile::Nv2a => {
            let word = words.get(Word::RcConfig, 0);
            (word & 15, word >> 8 & 1 == 1, [12, 16].map(|bit| word >> bit & 1 == 1))
        }
    };
    let stages = (0..count as usize).map(|n| {
        let portion = |inputs, outputs, alpha| portion_of(words.get(inputs, n), words.get(outputs, n), alpha);
        let constants = match chip {
            Profile::Nv10 => shared,
            // Without own constants all stages read those of the first.
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
    let [a, b, c, d] = [24, 16, 8, 0].map(|shift| final_of(final0 >> shift, false));
    let [e, f] = [24, 16].map(|shift| final_of(final1 >> shift, false));
    Ok(Combiners {
        stages: stages.collect(),
        mux_select: if msb { MuxSelect::Msb } else { MuxSelect::Lsb },
        final_combiner: FinalCombiner {
            inputs: [a, b, c, d, e, f],
            g: final_of(final1 >> 8, true),
            color_sum_clamp: final1 >> 7 & 1 == 1,
            invert_secondary: final1 >> 6 & 1 == 1,
            invert_spare0: final1 >> 5 & 1 == 1,
            constants: shared,
        },
    })
}

/// The words of a program that is legal on the chip. What is not used is 0.
pub fn encode(combiners: &Combiners, chip: Profile) -> RegisterWords {
    let mut words = RegisterWords::new(chip);
    let count = combiners.stages.len().min(chip.general_stages());
    let stages = &combiners.stages[..count];
    for (n, stage) in stages.iter().enumerate() {
        for (portion, inputs, outputs) in
            [(&stage.rgb, Word::RcInRgb, Word::RcOutRgb), (&stage.alpha, Word::RcInAlpha, Word::RcOutAlpha)]
        {
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| input_byte(&portion.inputs[k]));
            words.set(inputs, n, a << 24 | b << 16 | c << 8 | d);
            words.set(outputs, n, output_word(portion));
        }
    }
    let msb = u32::from(combiners.mux_select == MuxSelect::Msb);
    match chip {
        Profile::Nv10 => {
            let second = words.get(Word::RcOutRgb, 1);
            words.set(Word::RcOutRgb, 1, second | msb << 27 | (count as u32) << 28);
        }
        Profile::Nv2a => {
            let mut config = count as u32 | msb << 8;
            for (k, word) in [Word::RcConstantColor0, Word::RcConstantColor1].into_iter().enumerate() {
                let own = stages.windows(2).any(|pair| pair[0].constants[k] != pair[1].constants[k]);
                config |= u32::from(own) << [12, 16][k];
                for (n, stage) in stages.iter().enumerate().take(if own { count } else { 1 }) {
                    words.set(word, n, color_word(stage.constants[k]));
                }
            }
            words.set(Word::RcConfig, 0, config);
        }
    }
    let state = &combiners.final_combiner;
    for (n, constant) in state.constants.into_iter().enumerate() {
        words.set(Word::RcColor, n, color_word(constant));
    }
    let [a, b, c, d, e, f] = [0, 1, 2, 3, 4, 5].map(|n| final_byte(&state.inputs[n]));
    words.set(Word::RcFinal0, 0, a << 24 | b << 16 | c << 8 | d);
    let flags = u32::from(state.color_sum_clamp) << 7
        | u32::from(state.invert_secondary) << 6
        | u32::from(state.invert_spare0) << 5;
    words.set(Word::RcFinal1, 0, e << 24 | f << 16 | final_byte(&state.g) << 8 | flags);
    words
}

/// R, G, B, A of a constant: A8R8G8B8.
fn color_of(word: u32) -> [u8; 4] {
    let [b, g, r, a] = word.to_le_bytes();
    [r, g, b, a]
}

fn color_word([r, g, b, a]: [u8; 4]) -> u32 {
    u32::from_le_bytes([b, g, r, a])
}

/// The word that holds a part of a program.
pub fn word_of(place: Place, chip: Profile) -> (Word, usize) {
    match place {
        Place::Stages | Place::Stage(_) => match chip {
            Profile::Nv10 => (Word::RcOutRgb, 1),
            Profile::Nv2a => (Word::RcConfig, 0),
        },
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
