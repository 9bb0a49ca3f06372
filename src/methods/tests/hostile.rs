//! Damaged logs and push buffers become frames whose scenes can be planned, never a panic. `NINEBIT_LOGS` is the number of damaged logs,
//! `NINEBIT_LOGS_SEED` selects others.
#![allow(missing_docs, clippy::unwrap_used, reason = "tests fail by panicking")]

use ninebit::plan::{Plan, PlanOptions};
use ninebit::random::Random;
use ninebit::state::*;
use ninebit_methods::class::Family;
use ninebit_methods::export::{Methods, export, push_buffer, trace};
use ninebit_methods::frame::Frame;
use ninebit_methods::import::{Importer, Options, Sources, import};
use ninebit_methods::memory::Memory;
use ninebit_methods::pushbuffer::follow;
use ninebit_methods::state::State;

fn setting(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).ok().map_or(otherwise, |text| text.parse().unwrap())
}

/// Returns methods of a scene of a chip with a texture, a palette if it has any, depths and stencil, in two draws.
fn methods(profile: Profile) -> Methods {
    let words = (0..16).collect::<Vec<u32>>();
    let palette = Palette { name: "palette".into(), entries: (0..32).map(|n| n * 0x0808_0808).collect() };
    let format = if profile == Profile::Nv10 { TextureFormat::A8R8G8B8 } else { TextureFormat::P8 };
    let texture = Texture::from_words(format, [4, 4], words);
    let target = Target {
        depth: Some(DepthBuffer { format: DepthFormat::Z24S8, clear: 0xff_ffff, clear_stencil: 0 }),
        ..Target::new(16, 16, SurfaceFormat::A8R8G8B8)
    };
    let unit = TextureUnit { palette: (format == TextureFormat::P8).then_some(0), ..TextureUnit::new(0) };
    let first = Draw {
        name: "first".into(),
        depth_test: Some(DepthTest::new(CompareFunction::Less, true)),
        blend: Some(Blend {
            equation: BlendEquation::Add,
            source: BlendFactor::SourceAlpha,
            destination: BlendFactor::One,
        }),
        ..Draw::rectangle(12.0, 12.0).texture(0, unit)
    };
    // The other lines have a bit that the class of nv10 lacks.
    let lines = Lines { rasterization: LineRasterization::Bresenham, ..Lines::default() };
    let second = Draw { name: "second".into(), topology: Topology::LineStrip, lines, ..Draw::rectangle(8.0, 15.0) };
    let scene = Scene {
        profile,
        targets: vec![target],
        textures: vec![texture],
        palettes: if format == TextureFormat::P8 { vec![palette] } else { vec![] },
        draws: vec![first, second],
    };
    let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
    export(&scene, &plan).unwrap()
}

fn damage(random: &mut Random, bytes: &mut Vec<u8>) {
    for _ in 0..1 + random.below(6) {
        if bytes.is_empty() {
            return;
        }
        let at = random.below(bytes.len() as u128) as usize;
        match random.below(6) {
            0 => bytes.truncate(at),
            1 => bytes[at] = random.below(256) as u8,
            2 => bytes[at] = b"0123456789abcdef"[random.below(16) as usize],
            3 => {
                // A part of it again, somewhere else.
                let end = (at + random.below(200) as usize).min(bytes.len());
                let part = bytes[at..end].to_vec();
                let to = random.below(bytes.len() as u128) as usize;
                bytes.splice(to..to, part);
            }
            4 => {
                let end = (at + random.below(400) as usize).min(bytes.len());
                bytes.drain(at..end);
            }
            _ => {
                // A word that a program may send, anywhere.
                let family = if random.below(4) == 0 { Family::Celsius } else { Family::Kelvin };
                let methods = family.methods();
                let method = methods[random.below(methods.len() as u128) as usize].number;
                let word = random.below(1 << 32) as u32 >> random.below(32);
                let class = family.class();
                let line = format!("\nnv2a_pgraph_method 0: 0x{class:x} -> 0x{method:04x} 0x{word:x}\n");
                bytes.splice(at..at, line.bytes());
            }
        }
    }
}

fn check(frame: &Frame) {
    if !frame.scene.targets.is_empty() {
        let plan = Plan::compile(&frame.scene, &PlanOptions::default());
        assert!(plan.is_ok(), "{:?}", plan.unwrap_err());
    }
}

#[test]
fn damaged_logs_do_no_harm() {
    let of_chips = [methods(Profile::Nv2a), methods(Profile::Nv10)];
    let mut random = Random::seeded(setting("NINEBIT_LOGS_SEED", 70));
    let (mut stated, count) = (0, setting("NINEBIT_LOGS", 400));
    let logs = of_chips.each_ref().map(|methods| trace(methods).into_bytes());
    for number in 0..count {
        let chip = usize::from(number % 4 == 3);
        let (mut bytes, methods) = (logs[chip].clone(), &of_chips[chip]);
        damage(&mut random, &mut bytes);
        let memory = Memory::new(methods.memory[..random.below(methods.memory.len() as u128) as usize].to_vec());
        let options = Options { surfaces_in_memory: number % 2 == 0, ..Options::default() };
        let (frames, _) = import(&bytes, State::default(), &memory, options);
        frames.iter().for_each(check);
        stated += frames.iter().map(|frame| frame.scene.draws.len()).sum::<usize>();
    }
    assert!(stated as u64 > count / 2, "{stated} draws of {count} logs");
    for number in 0..count / 4 {
        let methods = &of_chips[usize::from(number % 4 == 3)];
        let mut bytes: Vec<u8> = push_buffer(methods).iter().flat_map(|word| word.to_le_bytes()).collect();
        damage(&mut random, &mut bytes);
        // Words that lead back make a circle, whose end takes seconds.
        let straight = bytes.chunks_exact(4).all(|word| word[0] & 3 == 0 && word[3] >> 5 != 1);
        if !straight {
            continue;
        }
        let memory = Memory::new(bytes);
        let mut each = |frame: Frame| check(&frame);
        let sources = Sources { memory: memory.clone(), ..Sources::default() };
        let mut importer = Importer::new(State::default(), sources, Options::default(), &mut each);
        let _ = follow(&memory, (0, memory.len() as u64), methods.family.class(), &mut |entry| importer.take(&entry));
        importer.finish(None);
    }
}
