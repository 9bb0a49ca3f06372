use super::*;
use crate::vertex::random::Random;
use std::collections::BTreeMap;

/// The words of a log.
struct Log(BTreeMap<u32, u32>);

const IDENTITY: [f32; 16] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];

impl Log {
    /// The words of a pipe that does nothing but multiply by the identity.
    fn new() -> Log {
        let mut log = Log(BTreeMap::new());
        log.floats(0x0680, &IDENTITY);
        log.floats(0x0a20, &[320.0, 240.0, 0.0, 0.0]);
        for method in [0x0328, 0x0314, 0x03b8, 0x02a4, 0x0318, 0x1e70] {
            log.word(method, 0);
        }
        log
    }

    fn word(&mut self, method: u32, word: u32) -> &mut Log {
        self.0.insert(method, word);
        self
    }

    fn floats(&mut self, method: u32, numbers: &[f32]) -> &mut Log {
        for (method, number) in (method..).step_by(4).zip(numbers) {
            self.word(method, number.to_bits());
        }
        self
    }

    fn read(&self) -> FixedFunction {
        FixedFunction::read(Profile::Nv2a, &mut |method| self.0.get(&method).copied())
    }

    /// Runs the pipe, which must lack nothing.
    fn run(&self, inputs: &Attributes) -> Outputs {
        let pipe = self.read();
        assert_eq!((&pipe.missing[..], &pipe.unknown[..]), (&[][..], &[][..]));
        pipe.run(inputs)
    }

    /// Adds the words of lighting by a white material that the lights hold, with identities for both matrices.
    fn lit(&mut self, mask: u32) -> &mut Log {
        self.word(0x0314, 1).word(0x0294, 0).word(0x0298, 0).word(0x03bc, mask).word(0x03a4, 0).word(0x17c4, 0);
        self.floats(0x0480, &IDENTITY).floats(0x0580, &IDENTITY);
        // No specular light.
        self.floats(0x09e0, &[0.0; 6]).floats(0x17e0, &[0.0; 3]);
        for light in [0x1000, 0x1080] {
            self.floats(light + 0x18, &[0.0; 3]).floats(light + 0x28, &[0.0; 3]);
        }
        self.floats(0x0a10, &[0.125, 0.25, 0.0]).floats(0x03a8, &[0.0; 3]).floats(0x03b4, &[0.75])
    }

    /// Adds specular light with the six words of a power.
    fn shining(&mut self, control: u32, powers: [f32; 6]) -> &mut Log {
        self.word(0x03b8, 1).word(0x0294, control).floats(0x09e0, &powers)
    }
}

/// A vertex with different numbers in all attributes.
fn vertex() -> Attributes {
    std::array::from_fn(|n| std::array::from_fn(|k| (n * 4 + k) as f32 / 64.0))
}

fn at(position: [f32; 3], normal: [f32; 3]) -> Attributes {
    let mut vertex = vertex();
    vertex[0] = [position[0], position[1], position[2], 1.0];
    vertex[2] = [normal[0], normal[1], normal[2], 1.0];
    vertex
}

/// The window position of a point in clip space (VTX-5).
fn window(clip: [f32; 4]) -> [f32; 4] {
    unit::window(words(clip), [320.0, 240.0, 0.0])
}

fn near(a: [f32; 4], b: [f32; 4]) {
    assert!((0..4).all(|k| (a[k] - b[k]).abs() < 1e-6), "{a:?} {b:?}");
}

/// The same for numbers of 14 bits.
fn near_words(a: [f32; 4], b: [f32; 4]) {
    assert!((0..4).all(|k| (a[k] - b[k]).abs() < 1e-3), "{a:?} {b:?}");
}

#[test]
fn identity() {
    let mut log = Log::new();
    log.word(0x03b8, 1).word(0x0294, 1 | 1 << 17);
    let inputs = vertex();
    let outputs = log.run(&inputs);
    assert_eq!(log.read().viewport_offset, [320.0, 240.0, 0.0, 0.0]);
    assert_eq!([outputs.position, outputs.diffuse, outputs.specular], [window(inputs[0]), inputs[3], inputs[4]]);
    assert_eq!([outputs.back_diffuse, outputs.back_specular], [inputs[7], inputs[8]]);
    assert_eq!(outputs.coordinates, [inputs[9], inputs[10], inputs[11], inputs[12]]);
    // Without the bit alpha of the secondary colour is 1, and without specular light the colour is black.
    let alpha = log.word(0x0294, 1).run(&inputs).specular;
    assert_eq!(alpha, [inputs[4][0], inputs[4][1], inputs[4][2], 1.0]);
    assert_eq!(log.word(0x03b8, 0).run(&inputs).specular, [0.0, 0.0, 0.0, 1.0]);
}

#[test]
fn rows_multiply_columns() {
    let mut log = Log::new();
    log.floats(0x0680, &[2.0, 0.0, 0.0, 5.0]).floats(0x06b0, &[0.0, 0.0, 1.0, 0.0]);
    assert_eq!(log.run(&at([1.0, 2.0, 3.0], [0.0; 3])).position, window([7.0, 2.0, 3.0, 3.0]));
}

/// Words are asked for only if what is enabled needs them.
#[test]
fn missing_words_are_named() {
    let words = |from: u32, count: u32| (0..count).map(move |n| from + 4 * n);
    let of = |change: fn(&mut Log) -> &mut Log| {
        let mut log = Log::new();
        change(&mut log);
        log.read().missing
    };
    assert_eq!(FixedFunction::read(Profile::Nv2a, &mut |_| None).missing, {
        let mut all: Vec<u32> = vec![0x02a4, 0x0314, 0x0318, 0x0328, 0x03b8];
        all.extend(words(0x03c0, 16).chain(words(0x0420, 4)).chain(words(0x0680, 16)).chain(words(0x0a20, 4)));
        all
    });
    assert_eq!(of(|log| log.word(0x02a4, 1).word(0x02a0, 6)), Vec::<u32>::new());
    assert_eq!(of(|log| log.word(0x02a4, 1)), [0x02a0]);
    let planar: Vec<u32> = words(0x0480, 16).chain(words(0x09d0, 4)).collect();
    assert_eq!(of(|log| log.word(0x02a4, 1).word(0x02a0, 2)), planar);
    let spot: Vec<u32> = [0x03a4]
        .into_iter()
        .chain(words(0x0480, 16))
        .chain(words(0x0580, 16))
        .chain(words(0x1100, 9))
        .chain(words(0x1124, 1))
        .chain(words(0x1140, 7))
        .chain(words(0x115c, 6))
        .collect();
    let lit = of(|log| {
        let all: Vec<u32> = log.lit(3 << 4).0.keys().copied().collect();
        for method in all.into_iter().filter(|method| (0x0480..0x0680).contains(method) || *method == 0x03a4) {
            log.0.remove(&method);
        }
        log
    });
    assert_eq!(lit, spot);
    // A stage without a program asks for nothing; one that reflects needs the eye and the normal.
    let reflecting: Vec<u32> = [0x03a4]
        .into_iter()
        .chain(words(0x0480, 16))
        .chain(words(0x0580, 16))
        .chain([0x09cc])
        .chain(words(0x0a50, 3))
        .collect();
    let reflected = of(|log| {
        log.word(0x1e70, 1 << 10).word(0x0428, 0);
        (0..4).fold(log, |log, k| log.word(0x03e0 + 4 * k, if k < 3 { 0x8512 } else { 0 }))
    });
    assert_eq!(reflected, reflecting);
}

#[test]
fn unknown_words_are_named() {
    let mut log = Log::new();
    log.word(0x0328, 7).word(0x02a4, 1).word(0x02a0, 4).word(0x1e70, 1).word(0x0420, 0);
    for (k, mode) in [0, 0, 0x2402, 0x8511].into_iter().enumerate() {
        log.word(0x03c0 + 4 * k as u32, mode);
    }
    let pipe = log.read();
    assert_eq!(
        (pipe.unknown, pipe.missing),
        (vec![(0x0328, 7), (0x03c8, 0x2402), (0x03cc, 0x8511), (0x02a0, 4)], vec![])
    );
}

#[test]
fn one_directional_light() {
    let mut log = Log::new();
    log.lit(1).floats(0x1000, &[0.0625, 0.0, 0.0, 0.5, 1.0, 0.25]).floats(0x1034, &[0.0, 0.0, 1.0]);
    let lit = log.run(&at([0.0; 3], [0.0, 0.6, 0.8]));
    near_words(lit.diffuse, [0.125 + 0.0625 + 0.4, 0.25 + 0.8, 0.2, 0.75]);
    assert_eq!(lit.specular, [0.0, 0.0, 0.0, 1.0]);
    // From behind only the ambient light arrives.
    near_words(log.run(&at([0.0; 3], [0.0, 0.6, -0.8])).diffuse, [0.1875, 0.25, 0.0, 0.75]);
    // Normals have any length unless they are normalised.
    near_words(log.run(&at([0.0; 3], [0.0, 0.0, 2.0])).diffuse, [1.1875, 2.25, 0.5, 0.75]);
    near_words(log.word(0x03a4, 1).run(&at([0.0; 3], [0.0, 0.0, 2.0])).diffuse, [0.6875, 1.25, 0.25, 0.75]);
}

/// Sources of the material: emission, ambient and diffuse from the primary colour.
#[test]
fn colors_of_the_vertex() {
    let mut log = Log::new();
    log.lit(1).floats(0x1000, &[0.5, 0.5, 0.5, 1.0, 1.0, 1.0]).floats(0x1034, &[0.0, 0.0, 1.0]);
    log.floats(0x03a8, &[0.25; 3]);
    let inputs = at([0.0; 3], [0.0, 0.0, 1.0]);
    let [r, g, b, a] = inputs[3];
    log.word(0x0298, 1 << 2);
    let ambient = |c: f32, scene: f32| c * 0.25 + scene + 0.5 * c + 1.0;
    near_words(log.run(&inputs).diffuse, [ambient(r, 0.125), ambient(g, 0.25), ambient(b, 0.0), 0.75]);
    log.word(0x0298, 1 << 4);
    let diffuse = |c: f32, scene: f32| scene + 0.5 + c;
    near_words(log.run(&inputs).diffuse, [diffuse(r, 0.125), diffuse(g, 0.25), diffuse(b, 0.0), a]);
    log.word(0x0298, 1).floats(0x03a8, &[1.0; 3]);
    let emission = |c: f32, scene: f32| scene + c + 1.5;
    near_words(log.run(&inputs).diffuse, [emission(r, 0.125), emission(g, 0.25), emission(b, 0.0), 0.75]);
    assert_eq!(log.word(0x0298, 3).read().unknown, [(0x0298, 3)]);
}

#[test]
fn one_point_light() {
    let mut log = Log::new();
    log.lit(2 << 2).floats(0x1080, &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
    log.floats(0x10a4, &[3.0]).floats(0x10dc, &[0.0, 0.0, 5.0]).floats(0x10e8, &[1.0, 0.5, 0.5]);
    let inputs = at([0.0, 0.0, 2.0], [0.0, 0.0, 1.0]);
    // 1 + 3 / 2 + 9 / 2 = 7.
    near_words(log.run(&inputs).diffuse, [0.125 + 1.0 / 7.0, 0.25 + 1.0 / 7.0, 1.0 / 7.0, 0.75]);
    near_words(log.floats(0x10a4, &[2.9]).run(&inputs).diffuse, [0.125, 0.25, 0.0, 0.75]);
}

/// A cone with cosines 0.8 inside and 0.6 outside, whose share is linear or bent between them.
#[test]
fn spotlight() {
    let mut log = Log::new();
    log.lit(3).floats(0x1000, &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0]).floats(0x1024, &[100.0]);
    log.floats(0x105c, &[0.0, 0.0, 1.0]).floats(0x1068, &[1.0, 0.0, 0.0]);
    log.floats(0x1040, &[0.0, 0.0, 1.0]).floats(0x104c, &[0.0, 0.0, 5.0, -3.0]);
    let share = |cosine: f32| {
        let sine = (1.0 - cosine * cosine).sqrt();
        // The light is at the distance 1 and at this angle off the axis; the normal points to it.
        let inputs = at([-sine, 0.0, 1.0 - cosine], [sine, 0.0, cosine]);
        log.run(&inputs).diffuse[2]
    };
    for (cosine, expected) in [(1.0, 1.0), (0.9, 1.0), (0.75, 0.75), (0.7, 0.5), (0.65, 0.25), (0.55, 0.0)] {
        assert!((share(cosine) - expected).abs() < 1e-3, "{cosine} {}", share(cosine));
    }
    log.floats(0x1040, &[0.0, -0.494_592, 1.494_592]);
    let inputs = at([-0.714_142_8, 0.0, 0.3], [0.714_142_8, 0.0, 0.7]);
    assert!((log.run(&inputs).diffuse[2] - 0.5 / (1.494_592 - 0.247_296)).abs() < 1e-3);
}

#[test]
fn highlights() {
    let mut log = Log::new();
    log.lit(1).shining(1, [-0.5, -2.0, 2.5, -0.5, -2.0, 2.5]);
    log.floats(0x1000, &[0.0; 6]).floats(0x1018, &[1.0, 0.5, 0.0]);
    log.floats(0x1028, &[0.0, 0.6, 0.8]).floats(0x1034, &[0.0, 0.0, 1.0]);
    let inputs = at([0.0, 0.0, -2.0], [0.0, 0.0, 1.0]);
    // Far light, far eye: x = 0.8 gives 0.3 / 0.9.
    let lit = log.run(&inputs);
    near_words(lit.specular, [1.0 / 3.0, 1.0 / 6.0, 0.0, 1.0]);
    near_words(lit.diffuse, [0.125, 0.25, 0.0, 0.75]);
    // An eye at the origin looks straight down: h = (0, 0, 2), x = 1, f = 0.5 / 0.5.
    log.word(0x0294, 1 | 1 << 16).floats(0x0a50, &[0.0; 3]);
    near_words(log.run(&inputs).specular, [1.0, 0.5, 0.0, 1.0]);
    // Together with the primary colour, the secondary is the vertex's.
    log.word(0x0294, 1 << 16 | 1 << 17);
    let lit = log.run(&inputs);
    near_words(lit.diffuse, [1.125, 0.75, 0.0, 0.75]);
    assert_eq!(lit.specular, inputs[4]);
    // A point light and a far eye use the eye's direction: h = (0, 0, 1) + (0.6, 0, 0.8), x = 1.8^2 / 3.6 = 0.9.
    log.word(0x0294, 1).word(0x03bc, 2).floats(0x17e0, &[0.6, 0.0, 0.8]);
    log.floats(0x1024, &[9.0]).floats(0x105c, &[0.0, 0.0, 5.0]).floats(0x1068, &[1.0, 0.0, 0.0]);
    near_words(log.run(&inputs).specular, [0.4 / 0.7, 0.2 / 0.7, 0.0, 1.0]);
}

#[test]
fn both_sides() {
    let mut log = Log::new();
    log.lit(1).floats(0x1000, &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0]).floats(0x1034, &[0.0, 0.0, 1.0]);
    log.word(0x17c4, 1).floats(0x17a0, &[0.5, 0.0, 0.0]).floats(0x17ac, &[0.25, 0.0, 0.0, 0.0]);
    log.floats(0x0c00, &[0.0, 0.0, 0.0, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0]).floats(0x1e28, &[0.0; 6]);
    let away = log.run(&at([0.0; 3], [0.0, 0.6, -0.8]));
    near_words(away.diffuse, [0.125, 0.25, 0.0, 0.75]);
    near_words(away.back_diffuse, [0.5, 0.4, 0.8, 0.25]);
}

/// The numbers of TSH-11's example.
#[test]
fn sphere_reflection_and_normal_maps() {
    let mut log = Log::new();
    log.word(0x1e70, 1 | 1 << 5 | 1 << 10 | 1 << 15).word(0x09cc, 0).word(0x03a4, 0);
    log.floats(0x0480, &IDENTITY).floats(0x0580, &IDENTITY).floats(0x0a50, &[0.0; 3]);
    for (set, modes) in
        [[0x2402, 0x2402, 0, 0], [0x8512, 0x8512, 0x8512, 0], [0x8511, 0x8511, 0x8511, 0], [0x2400, 0x2401, 0, 0]]
            .into_iter()
            .enumerate()
    {
        log.word(0x0420 + 4 * set as u32, 0);
        for (component, mode) in modes.into_iter().enumerate() {
            log.word(0x03c0 + 16 * set as u32 + 4 * component as u32, mode);
        }
    }
    log.floats(0x0840 + 3 * 64, &[1.0, 2.0, 3.0, 4.0]).floats(0x0850 + 3 * 64, &[0.0, 1.0, 0.0, 0.5]);
    let inputs = at([0.0, 3.0, -4.0], [0.0, 0.0, 1.0]);
    let made = log.run(&inputs).coordinates;
    let m = 2.0 * (0.36_f32 + 1.8 * 1.8).sqrt();
    near(made[0], [0.5, 0.6 / m + 0.5, inputs[9][2], inputs[9][3]]);
    near(made[1], [0.0, 0.6, 0.8, inputs[10][3]]);
    near(made[2], [0.0, 0.0, 1.0, inputs[11][3]]);
    near(made[3], [-2.0, 3.5, inputs[12][2], inputs[12][3]]);
    // A viewer far away looks straight down, and so does an eye right above.
    near(log.word(0x09cc, 1).run(&inputs).coordinates[1], [0.0, 0.0, 1.0, inputs[10][3]]);
    log.word(0x09cc, 0).floats(0x0a50, &[0.0, 3.0, 0.0]);
    near(log.run(&inputs).coordinates[1], [0.0, 0.0, 1.0, inputs[10][3]]);
    log.word(0x0424, 1).floats(0x0700, &IDENTITY).floats(0x0700, &[0.0, 0.0, 2.0, 0.0]);
    near(log.run(&inputs).coordinates[1], [2.0, 0.0, 1.0, inputs[10][3]]);
}

#[test]
fn skinning_with_two_weights() {
    let mut log = Log::new();
    let mut moved = IDENTITY;
    moved[3] = 10.0;
    log.word(0x0328, 1).floats(0x0480, &IDENTITY).floats(0x04c0, &moved);
    let mut inputs = at([1.0, 2.0, 3.0], [0.0; 3]);
    inputs[1] = [0.25, 0.5, 0.0, 1.0];
    // The other weight is 0.75.
    assert_eq!(log.run(&inputs).position, window([8.5, 2.0, 3.0, 1.0]));
    // Both are given, and do not make 1.
    assert_eq!(log.word(0x0328, 2).run(&inputs).position, window([5.75, 1.5, 2.25, 0.75]));
    // Three matrices, of which the last has the rest.
    assert_eq!(log.word(0x0328, 3).floats(0x0500, &moved).run(&inputs).position, window([8.5, 2.0, 3.0, 1.0]));
}

#[test]
fn fog_coordinates() {
    let mut log = Log::new();
    log.word(0x02a4, 1)
        .floats(0x0480, &IDENTITY)
        .floats(0x09d0, &[0.0, 0.0, 1.0, 1.0])
        .floats(0x0a50, &[0.0, 0.0, 1.0]);
    let mut inputs = at([0.0, 3.0, -3.0], [0.0; 3]);
    inputs[4][3] = 1.5;
    inputs[5][0] = 0.625;
    let mut of = |mode: u32| log.word(0x02a0, mode).run(&inputs).fog;
    assert_eq!([of(0), of(1), of(2), of(3), of(6)], [1.0, 4.9999995, -2.0, 2.0, 0.625]);
}

#[test]
fn sizes_of_points() {
    let mut log = Log::new();
    log.word(0x0318, 1).floats(0x0480, &IDENTITY).floats(0x0a50, &[0.0; 3]);
    log.floats(0x0a30, &[0.0, 0.0, 1.0, 16.0]).floats(0x0a48, &[0.0, 2.0]);
    // The factor is just below 1/4.
    assert_eq!(log.run(&at([0.0, 0.0, -4.0], [0.0; 3])).point_size, 5.875);
}

/// Whatever the words are, nothing panics, and numbers that are missing are the same as zeros.
#[test]
fn any_words_are_harmless() {
    let mut random = Random::new(1);
    for _ in 0..2_000 {
        let words: BTreeMap<u32, u32> = (0..0x2000)
            .step_by(4)
            .map(|method| {
                let [word, small] = [random.word(), random.below(8)];
                // Most state is a small number, and a texture generator one of five words.
                let modes = [0x2400, 0x2401, 0x2402, 0x8511, 0x8512, 0, 1, 2];
                let generator = (0x03c0..0x0400).contains(&method);
                (
                    method,
                    if generator {
                        modes[small as usize]
                    } else if method < 0x0440 && word & 3 != 0 {
                        small
                    } else {
                        word
                    },
                )
            })
            .collect();
        let mut log = Log(words);
        let inputs = std::array::from_fn(|_| random.words().map(f32::from_bits));
        let complete = log.read();
        assert_eq!(complete.missing, Vec::<u32>::new());
        complete.run(&inputs);
        let gone = 4 * random.below(0x800);
        log.0.remove(&gone);
        let lacking = log.read();
        log.0.insert(gone, 0);
        if lacking.missing == [gone] {
            assert_eq!(format!("{:?}", lacking.run(&inputs)), format!("{:?}", log.read().run(&inputs)));
        }
    }
}
