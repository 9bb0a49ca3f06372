//! The state that a log leaves, word by word, for logs that draw nothing.
#![allow(clippy::float_arithmetic, reason = "words that are numbers")]

use ninebit::state::{BlendEquation, BlendFactor, CompareFunction, Named, SurfaceFormat};
use ninebit_program::registers::layout::{config, stages};
use ninebit_program::registers::unit::{CUBE, FOG_MODES, FORMAT, FORMATS, LEVELS, SIZES};
use ninebit_program::registers::{Description, RegisterWords, Word as RegisterWord, describe, raster};

use crate::celsius::StateWord;
use crate::class::{self, Family, METHOD_BYTES, Treatment, of_unit};
use crate::draw::raster::POLYGON_MODES;
use crate::state::State;

/// A word of state with its meaning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    /// Number and name of the method.
    pub label: String,
    /// The word.
    pub word: u32,
    /// What it means; empty where the word says no more than itself.
    pub meaning: String,
}

/// Returns the words of state that are known, in the order of their methods. Combiners and what is inert are left out.
pub fn settings(state: &State) -> Vec<Setting> {
    let family = state.family();
    let setting = |number: u32| {
        let word = state.get(number)?;
        let place = family.find(number)?;
        let chip = family.profile();
        let told = matches!(place.method.treatment, Treatment::State | Treatment::Open);
        if !told || RegisterWord::of_method(number, chip).is_some() {
            return None;
        }
        let kelvin = family.kelvin(&place);
        let meaning = kelvin.and_then(|kelvin| match state.state_word(kelvin) {
            StateWord::Word(word) => meaning(kelvin, word),
            _ => None,
        });
        Some(Setting { label: family.label(number), word, meaning: meaning.unwrap_or_default() })
    };
    (0..METHOD_BYTES / 4).filter_map(|n| setting(4 * n)).collect()
}

/// Returns the words of the combiners that are known, a method and its word a line.
pub fn register_words(state: &State) -> String {
    let chip = state.family().profile();
    let of_combiners = (0..METHOD_BYTES / 4).map(|n| 4 * n).filter(|n| RegisterWord::of_method(*n, chip).is_some());
    let known = of_combiners.filter_map(|number| Some((number, state.get(number)?)));
    known.map(|(number, word)| format!("0x{number:04x} 0x{word:08x}\n")).collect()
}

/// Returns what the known words of the combiners mean. If the number of stages is not known, each is described as if it were used.
pub fn combiners(state: &State) -> Vec<Description> {
    let chip = state.family().profile();
    let mut words = RegisterWords::new(chip);
    for (word, index, _) in RegisterWords::new(chip).all() {
        words.set(word, index, state.get(word.method(chip) + 4 * index as u32).unwrap_or(0));
    }
    let (word, index) = config(chip);
    if state.get(word.method(chip) + 4 * index as u32).is_none() {
        words.set(word, index, stages(chip).put(chip.general_stages() as u32));
    }
    describe(&words).into_iter().filter(|described| state.get(described.method).is_some()).collect()
}

/// Returns the meaning of a word by Kelvin's number.
fn meaning(kelvin: u32, word: u32) -> Option<String> {
    let place = Family::Kelvin.find(kelvin)?;
    let name = place.method.name;
    let of_unit_0 = if (of_unit(class::SET_TEXTURE_OFFSET, 0)..of_unit(class::SET_TEXTURE_OFFSET, 4)).contains(&kelvin)
    {
        kelvin & !0xc0
    } else {
        kelvin
    };
    match of_unit_0 {
        class::SET_ALPHA_FUNC | class::SET_DEPTH_FUNC | class::SET_STENCIL_FUNC => {
            named(CompareFunction::ALL, raster::compare_function, word)
        }
        class::SET_BLEND_FUNC_SFACTOR | class::SET_BLEND_FUNC_DFACTOR => {
            named(BlendFactor::ALL, raster::blend_factor, word)
        }
        class::SET_BLEND_EQUATION => named(BlendEquation::ALL, raster::blend_equation, word),
        class::SET_SURFACE_FORMAT => {
            named(SurfaceFormat::ALL, raster::surface_format, raster::SURFACE_COLOR.value_in(word))
        }
        class::SET_FOG_MODE => {
            FOG_MODES.iter().find(|(_, value)| *value == word).map(|(mode, _)| mode.name().to_owned())
        }
        class::SET_FRONT_POLYGON_MODE | class::SET_BACK_POLYGON_MODE => {
            POLYGON_MODES.iter().find(|(_, value)| *value == word).map(|(mode, _)| mode.name().to_owned())
        }
        class::SET_COLOR_MASK => {
            let written = raster::COLOR_MASK.iter().zip("RGBA".chars()).filter(|(field, _)| field.is_set(word));
            Some(written.map(|(_, channel)| channel).collect::<String>())
        }
        class::SET_SURFACE_CLIP_HORIZONTAL | class::SET_SURFACE_CLIP_VERTICAL => {
            Some(format!("{} from {}", word >> 16, word & 0xffff))
        }
        class::SET_SURFACE_PITCH => Some(format!("colours {}, depths {} bytes", word & 0xffff, word >> 16)),
        class::SET_TEXTURE_FORMAT => texture(word),
        class::SET_TEXTURE_IMAGE_RECT => Some(format!("{} x {}", word >> 16, word & 0xffff)),
        class::SET_TEXTURE_CONTROL0 | class::SET_TEXTURE_CONTROL1 | class::SET_TEXTURE_ADDRESS => None,
        class::SET_BLEND_COLOR | class::SET_COLOR_CLEAR_VALUE | class::SET_TEXTURE_BORDER_COLOR => color(word, false),
        class::SET_FOG_COLOR => color(word, true),
        _ if name.ends_with("_ENABLE") && word <= 1 => Some(if word == 1 { "on" } else { "off" }.to_owned()),
        _ if NUMBERS.iter().any(|part| name.contains(part)) => {
            let number = f32::from_bits(word);
            number.is_finite().then(|| format!("{number:?}"))
        }
        _ => None,
    }
}

/// Parts of the names of methods whose words are binary32.
const NUMBERS: [&str; 24] = [
    "MATRIX",
    "PLANE",
    "FOG_PARAMS",
    "VIEWPORT_OFFSET",
    "VIEWPORT_SCALE",
    "SPECULAR_PARAMS",
    "POINT_PARAMS",
    "EYE_",
    "LIGHT_AMBIENT",
    "LIGHT_DIFFUSE",
    "LIGHT_SPECULAR",
    "LIGHT_LOCAL",
    "LIGHT_INFINITE",
    "LIGHT_SPOT",
    "MATERIAL_EMISSION",
    "MATERIAL_ALPHA",
    "SCENE_AMBIENT",
    "CLIP_MIN",
    "CLIP_MAX",
    "SCALE_FACTOR",
    "OFFSET_BIAS",
    "BUMP_ENV_MAT",
    "BUMP_ENV_SCALE",
    "BUMP_ENV_OFFSET",
];

fn named<T: Copy + Named>(all: &'static [T], value: impl Fn(T) -> u32, word: u32) -> Option<String> {
    all.iter().find(|choice| value(**choice) == word).map(|choice| choice.name().to_owned())
}

fn texture(word: u32) -> Option<String> {
    let (_, format, linear) = FORMATS.iter().find(|(code, ..)| *code == FORMAT.value_in(word))?;
    let kind = if CUBE.is_set(word) { "cube of " } else { "" };
    let size = if *linear {
        "in rows".to_owned()
    } else {
        let [width, height, _] = SIZES.map(|field| 1_u32 << field.value_in(word).min(12));
        format!("{width} x {height}, {} levels", LEVELS.value_in(word))
    };
    Some(format!("{kind}{}, {size}", format.name()))
}

/// Returns a colour word as R, G, B, A; `red_first` says that red is the lowest byte.
fn color(word: u32, red_first: bool) -> Option<String> {
    let [a, b, c, alpha] = word.to_le_bytes();
    let [r, g, b] = if red_first { [a, b, c] } else { [c, b, a] };
    Some(format!("R {r} G {g} B {b} A {alpha}"))
}

impl std::fmt::Display for Setting {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let line = format!("{:<44} {:08x}  {}", self.label, self.word, self.meaning);
        f.write_str(line.trim_end())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::class::{CELSIUS, KELVIN};

    fn lines_of(class: u32, words: &[(u32, u32)]) -> Vec<String> {
        let mut state = State::default();
        words.iter().for_each(|(method, word)| state.assume(class, *method, *word));
        settings(&state).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn words_have_their_meanings() {
        let words = [
            (class::SET_BLEND_ENABLE, 1),
            (class::SET_BLEND_FUNC_SFACTOR, 0x302),
            (class::SET_COLOR_MASK, 0x0001_0001),
            (0x694, 0x3f00_0000),
            (class::SET_TEXTURE_FORMAT + 64, 0x0441_0629),
            (0x260, 0x1234),
        ];
        let expected = [
            "0x0304 SET_BLEND_ENABLE                      00000001  on",
            "0x0344 SET_BLEND_FUNC_SFACTOR                00000302  SourceAlpha",
            "0x0358 SET_COLOR_MASK                        00010001  RB",
            "0x0694 SET_COMPOSITE_MATRIX[5]               3f000000  0.5",
            "0x1b44 SET_TEXTURE_FORMAT[1]                 04410629  A8R8G8B8, 16 x 16, 1 levels",
        ];
        assert_eq!(lines_of(KELVIN, &words), expected);
        let own = lines_of(CELSIUS, &[(0x224, 0x0441_0000 | 6 << 7 | 1 << 12), (0x680, 0x3f80_0000)]);
        assert_eq!(own[0], "0x0224 TEX_FORMAT[1]                         04411300  A8R8G8B8, 2 x 16, 1 levels");
        assert_eq!(own[1], "0x0680 FOG_COEFF[0]                          3f800000  1.0");
    }

    #[test]
    fn words_of_combiners_are_for_their_own_reader() {
        let mut state = State::default();
        state.assume(KELVIN, 0xac0, 7);
        state.assume(KELVIN, class::SET_BLEND_ENABLE, 7);
        assert_eq!(register_words(&state), "0x0ac0 0x00000007\n");
        let described = combiners(&state);
        assert_eq!((described.len(), described[0].method), (1, 0xac0));
        assert!(described[0].meaning.contains("D = "), "{}", described[0].meaning);
    }
}
