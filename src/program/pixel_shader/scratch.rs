//! Finds the registers whose values are read later, and those that are free for intermediate values.

use super::{Arithmetic, Bank, PixelShader, ShaderRegister};
use crate::cascade::TEXTURES;
use ninebit::state::{Profile, Register};

/// Returns the register of the combiners for a register of the language; constants have none.
pub(super) fn hardware(register: ShaderRegister) -> Option<Register> {
    Some(match (register.bank, register.index) {
        (Bank::Constant, _) => return None,
        (Bank::Temporary, 0) => Register::Spare0,
        (Bank::Temporary, _) => Register::Spare1,
        (Bank::Color, 0) => Register::PrimaryColor,
        (Bank::Color, _) => Register::SecondaryColor,
        (Bank::Texture, unit) => TEXTURES[usize::from(unit).min(3)],
    })
}

/// A set of registers: bit n stands for register n.
pub(super) type Set = u16;

fn bit(register: Register) -> Set {
    1 << register as usize
}

/// Returns, for each slot, the registers whose values have to be kept when it begins.
pub(super) fn live(program: &PixelShader) -> Vec<Set> {
    // The final combiner reads r0.
    let mut live = bit(Register::Spare0);
    let mut sets = Vec::new();
    for slot in program.slots().rev() {
        live = before(slot, live);
        sets.push(live);
    }
    sets.reverse();
    sets
}

fn before(slot: &[Arithmetic], after: Set) -> Set {
    // A register is overwritten as a whole by one instruction, or by both halves of a pair.
    let mut written = [0; 2];
    for instruction in slot {
        let target = instruction.target.value;
        let register = hardware(target.register).map_or(0, bit);
        for (alpha, set) in [false, true].into_iter().zip(&mut written) {
            *set |= if target.mask.has(alpha) { register } else { 0 };
        }
    }
    let sources = slot.iter().flat_map(|instruction| &instruction.sources);
    let read =
        sources.filter_map(|source| hardware(source.value.register)).fold(0, |set, register| set | bit(register));
    after & !(written[0] & written[1]) | read
}

pub(super) fn contains(set: Set, register: Register) -> bool {
    set & bit(register) != 0
}

/// Returns a register that is neither live nor taken, if there is one.
pub(super) fn free(live: Set, taken: &[Register], profile: Profile) -> Option<Register> {
    let both = [Register::Spare1, Register::Texture1, Register::Texture0, Register::PrimaryColor, Register::Spare0];
    let nv2a = [Register::Texture3, Register::Texture2, Register::SecondaryColor];
    let more: &[Register] = if profile == Profile::Nv2a { &nv2a } else { &[] };
    let mut all = more.iter().chain(&both).copied();
    all.find(|register| !contains(live, *register) && !taken.contains(register))
}
