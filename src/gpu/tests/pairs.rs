//! Runs the operations on pairs of words that printed WGSL has, and compares them with integers of 64 bits. Without an adapter the test is ignored.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use libtest_mimic::{Arguments, Failed, Trial};
use ninebit::random::Random;
use ninebit_gpu::{Gpu, adapters};
use ninebit_lower::Language;

/// Operands: two pairs, and a distance.
type Row = [i64; 3];

/// A call in WGSL, what it yields, and whether it is asked for that row.
type Case = (&'static str, fn(Row) -> i64, fn(Row) -> bool);

const CASES: [Case; 11] = [
    ("ninebit_add(a, b)", |[a, b, _]| a.wrapping_add(b), |_| true),
    ("ninebit_subtract(a, b)", |[a, b, _]| a.wrapping_sub(b), |_| true),
    ("ninebit_multiply(a, b)", |[a, b, _]| a.wrapping_mul(b), |_| true),
    ("ninebit_times(i32(a.x), i32(b.x))", |[a, b, _]| i64::from(a as i32) * i64::from(b as i32), |_| true),
    ("ninebit_scaled(i32(a.x), i32(b.x & 0xffffu))", |[a, b, _]| i64::from(a as i32) * (b & 0xffff), |_| true),
    ("ninebit_wide(ninebit_bits(a))", |[a, ..]| bits(a), |_| true),
    ("ninebit_wide(ninebit_length(i32(a.x)))", |[a, ..]| bits(a & 0xffff_ffff), |_| true),
    ("ninebit_raise(a, by)", |[a, _, by]| a << by, |_| true),
    ("ninebit_lower(a, by)", |[a, _, by]| a >> by, |_| true),
    ("ninebit_divide(a, b)", |[a, b, _]| a / b, |[a, b, _]| a >= 0 && b > 0),
    (
        "ninebit_wide(ninebit_quotient(a, b))",
        |[a, b, _]| a / b,
        |[a, b, _]| a >= 0 && b > 0 && b < 1 << 58 && a / b < 1 << 31,
    ),
];

fn bits(a: i64) -> i64 {
    (64 - a.leading_zeros()).into()
}

fn main() {
    let arguments = Arguments::from_args();
    let is_missing = adapters().is_empty();
    let trial = Trial::test("pairs_are_integers_of_64_bits", pairs).with_ignored_flag(is_missing);
    libtest_mimic::run(&arguments, vec![trial]).exit();
}

/// Returns a number of any length, next to a power of two more often.
fn number(random: &mut Random) -> i64 {
    let length = random.below(64) as u32;
    let power = 1_i64 << length.min(62);
    let n = match random.below(4) {
        0 => power.wrapping_add(random.below(5) as i64 - 2),
        _ => (random.below(1 << 64) as u64 >> (63 - length)) as i64,
    };
    if random.below(8) == 0 { n.wrapping_neg() } else { n }
}

fn pairs() -> Result<(), Failed> {
    let mut random = Random::seeded(7);
    let mut rows = Vec::new();
    while rows.len() < 1 << 15 {
        let (a, mut b) = (number(&mut random), number(&mut random));
        if random.below(2) == 0 && a > 0 {
            // A quotient that fits into 32 bits, near a whole number.
            let bits = random.below(31);
            let quotient = 1 + random.below(1 << bits) as i64;
            b = (a / quotient).wrapping_add(random.below(3) as i64 - 1);
        }
        rows.push([a, b, random.below(64) as i64]);
    }
    let given: Vec<u32> = rows.iter().flat_map(|row| row.iter().flat_map(|n| [*n as u32, (*n >> 32) as u32])).collect();
    let count = CASES.len();
    let mut text = Language::Wgsl.print_whole(&[]).unwrap();
    text += "@group(0) @binding(0) var<storage, read> given: array<vec2<u32>>;\n\
             @group(0) @binding(1) var<storage, read_write> found: array<vec2<u32>>;\n\
             fn ninebit_texel(unit: i32, at: i32) -> u32 { return 0u; }\n\
             @compute @workgroup_size(64)\nfn main(@builtin(global_invocation_id) id: vec3<u32>) {\n    \
             let a = given[3u * id.x];\n    let b = given[3u * id.x + 1u];\n    let by = i32(given[3u * id.x + 2u].x);\n";
    for (n, (call, ..)) in CASES.iter().enumerate() {
        text += &format!("    found[{count}u * id.x + {n}u] = {call};\n");
    }
    let found = Gpu::open(std::env::var("NINEBIT_GPU_ADAPTER").ok().as_deref())
        .and_then(|gpu| gpu.run(&(text + "}\n"), &given, 2 * count * rows.len(), rows.len() as u32 / 64))
        .map_err(|failure| failure.text())?;
    let mut asked = 0;
    for (row, found) in rows.iter().zip(found.chunks(2 * count)) {
        for ((call, wanted, is_asked), found) in CASES.iter().zip(found.as_chunks::<2>().0) {
            if is_asked(*row) {
                asked += 1;
                let found = i64::from(found[0]) | i64::from(found[1]) << 32;
                assert_eq!(found, wanted(*row), "{call} for {row:x?}");
            }
        }
    }
    println!("{asked} operations");
    Ok(())
}
