//! Random changes of binary data and of text, determined by a seed.

use ninebit::random::Random;

/// Numbers at the limits of sizes, integers and floats.
const NUMBERS: [&str; 40] = [
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "3",
    "7",
    "8",
    "9",
    "15",
    "16",
    "17",
    "127",
    "128",
    "255",
    "256",
    "0.5",
    "-0.5",
    "1e-45",
    "9.5e-7",
    "1048576",
    "4095",
    "4096",
    "4097",
    "-4096",
    "65535",
    "65536",
    "16777217",
    "2147483647",
    "2147483648",
    "-2147483648",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "18446744073709551616",
    "1e38",
    "-3.5e38",
    "inf",
    "-inf",
    "NaN",
];

fn below(random: &mut Random, end: usize) -> usize {
    random.below(end.max(1) as u128) as usize
}

/// Returns a random range of at most `most` bytes.
fn part(random: &mut Random, length: usize, most: usize) -> std::ops::Range<usize> {
    let start = below(random, length);
    start..(start + 1 + below(random, most)).min(length)
}

/// Returns the ranges of words, numbers and punctuation in a text, without white space.
fn tokens(bytes: &[u8]) -> Vec<std::ops::Range<usize>> {
    let word = |byte: u8| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.' | b'-' | b'+');
    let (mut all, mut at) = (Vec::new(), 0);
    while at < bytes.len() {
        let start = at;
        at += 1;
        if word(bytes[start]) {
            while at < bytes.len() && word(bytes[at]) {
                at += 1;
            }
        }
        if !bytes[start].is_ascii_whitespace() {
            all.push(start..at);
        }
    }
    all
}

fn replace(data: &mut Vec<u8>, part: std::ops::Range<usize>, with: &[u8]) {
    data.splice(part, with.iter().copied());
}

/// Makes one random change of binary data.
fn bytes(random: &mut Random, data: &mut Vec<u8>, other: &[u8]) {
    if data.is_empty() {
        data.extend_from_slice(&other[..other.len().min(64)]);
        return;
    }
    let length = data.len();
    match below(random, 9) {
        0 => data[below(random, length)] ^= 1 << below(random, 8),
        1 => data[below(random, length)] = random.bits() as u8,
        2 => drop(data.drain(part(random, length, 64))),
        3 => {
            let part = part(random, length, 64);
            let copy = data[part.clone()].to_vec();
            replace(data, part.end..part.end, &copy);
        }
        4 => data.truncate(below(random, length)),
        5 => {
            data.truncate(below(random, length));
            data.extend_from_slice(&other[below(random, other.len())..]);
        }
        6 => {
            let at = below(random, length);
            let value = [0, 1, 0x7f, 0x80, 0xff][below(random, 5)];
            let end = (at + [1, 2, 4, 8][below(random, 4)]).min(length);
            data[at..end].fill(value);
        }
        7 => {
            // Replaces an aligned 32-bit little-endian word, mostly within the header.
            let at = below(random, (length / 4).clamp(1, 40)) * 4;
            let value = [0_u32, 1, 4, 0x7fff_ffff, 0x8000_0000, 0xffff_ffff, 0x1_0000, 4096, 4097][below(random, 9)];
            let end = (at + 4).min(length);
            data[at..end].copy_from_slice(&value.to_le_bytes()[..end - at]);
        }
        _ => {
            let part = part(random, other.len(), 32);
            let at = below(random, length);
            replace(data, at..at, other.get(part).unwrap_or_default());
        }
    }
}

/// Makes one random change of a text.
fn text(random: &mut Random, data: &mut Vec<u8>, other: &[u8]) {
    let tokens = tokens(data);
    if tokens.is_empty() {
        return bytes(random, data, other);
    }
    let any = |random: &mut Random| tokens[below(random, tokens.len())].clone();
    let numbers: Vec<_> = tokens
        .iter()
        .filter(|token| data[token.start].is_ascii_digit() || data[token.start] == b'-' && token.len() > 1)
        .cloned()
        .collect();
    match below(random, 12) {
        0..=4 if !numbers.is_empty() => {
            let number = numbers[below(random, numbers.len())].clone();
            let with = NUMBERS[below(random, NUMBERS.len())];
            replace(data, number, with.as_bytes());
        }
        5 => {
            let (from, to) = (any(random), any(random));
            let copy = data[from].to_vec();
            replace(data, to, &copy);
        }
        6 => {
            let theirs = self::tokens(other);
            if let Some(from) = theirs.get(below(random, theirs.len())) {
                replace(data, any(random), &other[from.clone()]);
            }
        }
        7 => replace(data, any(random), b""),
        8 => {
            // Repeats a range of tokens, which makes lists longer and brackets deeper.
            let first = below(random, tokens.len());
            let last = (first + below(random, 24)).min(tokens.len() - 1);
            let run = data[tokens[first].start..tokens[last].end].to_vec();
            let times = [1, 2, 3, 40, 300][below(random, 5)];
            let at = tokens[last].end;
            replace(data, at..at, &[b" ", &run[..]].concat().repeat(times)[..]);
        }
        9 => {
            let lines: Vec<&[u8]> = data.split_inclusive(|byte| *byte == b'\n').collect();
            let mut lines: Vec<Vec<u8>> = lines.into_iter().map(<[u8]>::to_vec).collect();
            let (from, to) = (below(random, lines.len()), below(random, lines.len()));
            let line = lines[from].clone();
            if random.once_in(2) {
                lines.remove(from);
            }
            lines.insert(to.min(lines.len()), line);
            *data = lines.concat();
        }
        _ => bytes(random, data, other),
    }
}

/// Returns the data with one to four changes. `other` is a file of the same kind, from which parts are taken.
pub fn mutated(random: &mut Random, data: &[u8], other: &[u8]) -> Vec<u8> {
    let mut data = data.to_vec();
    let is_text = std::str::from_utf8(&data).is_ok();
    for _ in 0..1 + below(random, 4) {
        if is_text { text(random, &mut data, other) } else { bytes(random, &mut data, other) }
    }
    // Repeated ranges of tokens must not add up, because a large file that takes long is no error.
    data.truncate(1 << 20);
    data
}
