//! Checks that any bytes as a log of methods, and as a push buffer in memory, become frames whose scenes can be planned, never a panic.
#![no_main]

use libfuzzer_sys::fuzz_target;
use ninebit::plan::{Plan, PlanOptions};
use ninebit_methods::class::{CELSIUS, KELVIN};
use ninebit_methods::import::{Importer, Options, Sources, import};
use ninebit_methods::memory::Memory;
use ninebit_methods::pushbuffer::follow;
use ninebit_methods::state::State;

fuzz_target!(|bytes: &[u8]| {
    let memory = Memory::new(bytes.to_vec());
    let options = Options { surfaces_in_memory: bytes.len().is_multiple_of(2), ..Options::default() };
    let (frames, _) = import(bytes, State::default(), &memory, options);
    let mut each = |frame: ninebit_methods::frame::Frame| {
        if !frame.scene.targets.is_empty() {
            assert!(Plan::compile(&frame.scene, &PlanOptions::default()).is_ok());
        }
    };
    frames.into_iter().for_each(&mut each);
    // A circle ends after as many words as a minute of a program sends, which is too long here: half of the input is followed as far as it is straight.
    if !bytes.chunks_exact(4).any(|word| matches!(word[0] & 3, 1 | 2) || word[3] >> 5 == 1) {
        let sources = Sources { memory: memory.clone(), ..Sources::default() };
        let mut importer = Importer::new(State::default(), sources, Options::default(), &mut each);
        let class = if bytes.len() % 8 < 4 { KELVIN } else { CELSIUS };
        let _ = follow(&memory, (0, (bytes.len() / 4 * 4) as u64), class, &mut |entry| importer.take(&entry));
        importer.finish(None);
    }
});
