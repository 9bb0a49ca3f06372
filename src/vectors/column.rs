//! Columns of tables of vectors: their names, and how their numbers are written and which numbers they take.

use ninebit::state::Named;

/// How the numbers of a column are written, and how many bits they take in the packed view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// 0 to 2^bits - 1, decimal.
    Unsigned(u32),
    /// A two's complement number of so many bits, decimal.
    Signed(u32),
    /// A signed number of halves, written as a decimal fraction (`12`, `-3.5`). Its bits count halves.
    Halves(u32),
    /// One of these names. Its number is the index in the list.
    Name(&'static [&'static str]),
    /// A word of so many bits, hexadecimal: texels, blocks, or the bits of single-precision floats.
    Hex(u32),
}

impl Kind {
    /// Returns the number of bits in the packed view, at most 64.
    pub fn bits(&self) -> u32 {
        match self {
            Kind::Unsigned(bits) | Kind::Signed(bits) | Kind::Halves(bits) | Kind::Hex(bits) => *bits,
            Kind::Name(names) => usize::BITS - names.len().saturating_sub(1).leading_zeros().min(usize::BITS - 1),
        }
    }

    /// Returns whether the packed bits are two's complement.
    pub fn is_signed(&self) -> bool {
        matches!(self, Kind::Signed(_) | Kind::Halves(_))
    }

    /// Returns the kind as header lines and layouts write it: `u8`, `s9`, `h10`, `x32`, `e:A,B`.
    pub fn code(&self) -> String {
        match self {
            Kind::Unsigned(bits) => format!("u{bits}"),
            Kind::Signed(bits) => format!("s{bits}"),
            Kind::Halves(bits) => format!("h{bits}"),
            Kind::Hex(bits) => format!("x{bits}"),
            Kind::Name(names) => format!("e:{}", names.join(",")),
        }
    }

    /// Returns the least and the greatest number that can be written.
    pub fn range(&self) -> (i64, i64) {
        let bits = self.bits();
        match self {
            Kind::Unsigned(_) | Kind::Hex(_) => (0, if bits >= 63 { i64::MAX } else { (1 << bits) - 1 }),
            Kind::Signed(_) | Kind::Halves(_) if bits >= 64 => (i64::MIN, i64::MAX),
            Kind::Signed(_) | Kind::Halves(_) => (-(1 << (bits - 1)), (1 << (bits - 1)) - 1),
            Kind::Name(names) => (0, names.len() as i64 - 1),
        }
    }

    /// Returns whether a number can be written.
    pub fn holds(&self, value: i64) -> bool {
        let (least, greatest) = self.range();
        (least..=greatest).contains(&value)
    }

    /// Writes a number as text.
    pub fn write(&self, value: i64) -> String {
        match self {
            Kind::Unsigned(_) | Kind::Signed(_) => value.to_string(),
            Kind::Halves(_) if value % 2 == 0 => (value / 2).to_string(),
            Kind::Halves(_) => format!("{}{}.5", if value < 0 { "-" } else { "" }, value.unsigned_abs() / 2),
            Kind::Hex(bits) => format!("{value:0width$x}", width = bits.div_ceil(4) as usize),
            Kind::Name(names) => usize::try_from(value)
                .ok()
                .and_then(|n| names.get(n))
                .map_or_else(|| value.to_string(), |n| (*n).to_owned()),
        }
    }

    /// Reads a number that [`write`](Self::write) has written. Returns `None` for any other text.
    pub fn read(&self, text: &str) -> Option<i64> {
        let value = match self {
            Kind::Unsigned(_) | Kind::Signed(_) => text.parse().ok()?,
            Kind::Halves(_) => match text.strip_suffix(".5") {
                Some("-0") => -1,
                Some(whole) => {
                    let doubled = whole.parse::<i64>().ok()?.checked_mul(2)?;
                    doubled + if whole.starts_with('-') { -1 } else { 1 }
                }
                None => text.parse::<i64>().ok()?.checked_mul(2)?,
            },
            Kind::Hex(_) => i64::from_str_radix(text, 16).ok()?,
            Kind::Name(names) => names.iter().position(|name| *name == text)? as i64,
        };
        (self.holds(value) && self.write(value) == text).then_some(value)
    }
}

/// Beginnings of columns of configuration, and the word with which each does nothing.
const NEUTRAL: [(&str, &str); 14] = [
    ("mapping", "UnsignedIdentity"),
    ("scale", "One"),
    ("bias", "None"),
    ("mux_select", "Msb"),
    ("source", "Own"),
    ("selector", "own"),
    ("modifier", "plain"),
    ("mask", "rgba"),
    ("operand", "SourceColor"),
    ("window_clip", "Off"),
    ("mip_filter", "None"),
    ("fail", "Keep"),
    ("depth_fail", "Keep"),
    ("pass", "Keep"),
];

/// The numbers that a column takes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Domain {
    /// Every integer from the first to the second.
    Interval(i64, i64),
    /// These numbers, each a boundary of its own.
    Listed(Vec<i64>),
    /// Every word of so many bits, at most 32.
    Word(u32),
    /// Every word that differs from the first only in bits of the second, the mask. The first has no bits of the mask.
    Bits(u32, u32),
    /// Bits of finite single-precision floats of a magnitude below 2^limit. The first tells whether negative ones are included.
    Float(bool, i32),
}

/// A number of a row: its name, and the values that it takes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name. In tables it begins with `cfg.`, `in.`, `mid.` or `out.`; units that state configures have the names of traces.
    pub name: String,
    /// How its numbers are written.
    pub kind: Kind,
    /// The numbers that it takes; `None` for results.
    pub domain: Option<Domain>,
}

impl Column {
    fn input(name: &str, kind: Kind, domain: Domain) -> Column {
        Column { name: name.to_owned(), kind, domain: Some(domain) }
    }

    /// Returns a column of results, `mid.` or `out.`.
    pub fn result(name: &str, kind: Kind) -> Column {
        Column { name: name.to_owned(), kind, domain: None }
    }

    /// Returns the number of an input that is not given, where one is sensible: switches are off, settings do nothing, every
    /// channel is written, and what a register or colour holds is 0.
    pub fn default(&self) -> Option<i64> {
        let parts: Vec<&str> = self.name.split('.').collect();
        match (parts.as_slice(), self.kind) {
            (["cfg", "writes", _], _) => Some(1),
            (["cfg", ..], Kind::Unsigned(1)) => Some(0),
            // The reading that the model follows.
            (["cfg", "reading"], _) => Some(0),
            (["cfg", name], Kind::Name(words)) => {
                let of = NEUTRAL.iter().filter(|(column, _)| name.starts_with(column));
                of.filter_map(|(_, word)| words.iter().position(|known| known == word)).map(|place| place as i64).next()
            }
            (["in", _, "r" | "g" | "b" | "a"], Kind::Unsigned(_) | Kind::Signed(_)) => Some(0),
            _ => None,
        }
    }

    /// Returns several columns of results of one kind.
    pub fn results<const N: usize>(names: [&str; N], kind: Kind) -> [Column; N] {
        names.map(|name| Column::result(name, kind))
    }

    /// Returns a column of the variants of an enumeration.
    pub fn choice<T: Named>(name: &str) -> Column {
        Column::names(name, T::NAMES)
    }

    /// Returns a column of names.
    pub fn names(name: &str, names: &'static [&'static str]) -> Column {
        Column::input(name, Kind::Name(names), Domain::Listed((0..names.len() as i64).collect()))
    }

    /// Returns a column of flags, 0 or 1.
    pub fn flag(name: &str) -> Column {
        Column::input(name, Kind::Unsigned(1), Domain::Interval(0, 1))
    }

    /// Returns a column of bytes, 0 to 255.
    pub fn byte(name: &str) -> Column {
        Column::unsigned(name, 8, 255)
    }

    /// Returns a column of combiner registers, -256 to 255.
    pub fn register(name: &str) -> Column {
        Column::input(name, Kind::Signed(9), Domain::Interval(-256, 255))
    }

    /// Returns a column of factors of a combiner product, -256 to 256.
    pub fn factor(name: &str) -> Column {
        Column::input(name, Kind::Signed(10), Domain::Interval(-256, 256))
    }

    /// Returns a column of integers from 0 to `last`.
    pub fn unsigned(name: &str, bits: u32, last: i64) -> Column {
        Column::input(name, Kind::Unsigned(bits), Domain::Interval(0, last))
    }

    /// Returns a column of integers from `first` to `last`.
    pub fn signed(name: &str, bits: u32, first: i64, last: i64) -> Column {
        Column::input(name, Kind::Signed(bits), Domain::Interval(first, last))
    }

    /// Returns a column of the given numbers.
    pub fn listed(name: &str, kind: Kind, values: &[i64]) -> Column {
        Column::input(name, kind, Domain::Listed(values.to_vec()))
    }

    /// Returns a column of words of so many bits.
    pub fn word(name: &str, bits: u32) -> Column {
        Column::input(name, Kind::Hex(bits), Domain::Word(bits))
    }

    /// Returns a column of the bits of floats.
    pub fn float(name: &str, negative: bool, limit: i32) -> Column {
        Column::input(name, Kind::Hex(32), Domain::Float(negative, limit))
    }

    /// Returns the number of different values that it takes.
    pub fn size(&self) -> u128 {
        match &self.domain {
            None => 1,
            Some(Domain::Interval(first, last)) => (last - first + 1) as u128,
            Some(Domain::Listed(values)) => values.len() as u128,
            Some(Domain::Word(bits)) => 1 << bits,
            Some(Domain::Bits(_, mask)) => 1 << mask.count_ones(),
            Some(Domain::Float(negative, limit)) => (positive_floats(*limit) as u128) << u32::from(*negative),
        }
    }

    /// Returns the number at an index of its domain, which is below [`size`](Self::size).
    pub fn nth(&self, place: u128) -> i64 {
        match &self.domain {
            None => 0,
            Some(Domain::Interval(first, _)) => first + place as i64,
            Some(Domain::Listed(values)) => values.get(place as usize).copied().unwrap_or_default(),
            Some(Domain::Word(_)) => place as i64,
            Some(Domain::Bits(word, mask)) => i64::from(word | spread(place as u32, *mask)),
            Some(Domain::Float(_, limit)) => {
                let (positive, place) = (positive_floats(*limit), place as i64);
                if place < positive { place } else { 0x8000_0000 | (place - positive) }
            }
        }
    }

    /// Returns whether its numbers count up by one.
    pub fn counts(&self) -> bool {
        matches!(self.domain, Some(Domain::Interval(..) | Domain::Word(_)))
    }

    /// Returns the column with only the numbers from `first` to `last`, in its own order, or `None` if one of them is not among its
    /// numbers, if they are in the wrong order, or if they are floats of both signs.
    pub fn narrowed(&self, first: i64, last: i64) -> Option<Column> {
        let domain = match self.domain.as_ref()? {
            Domain::Listed(values) => {
                let [start, end] = [first, last].map(|value| values.iter().position(|known| *known == value));
                Domain::Listed(values.get(start?..=end?).filter(|values| !values.is_empty())?.to_vec())
            }
            Domain::Interval(least, greatest) => {
                Some(Domain::Interval(first, last)).filter(|_| *least <= first && first <= last && last <= *greatest)?
            }
            Domain::Word(bits) => {
                Some(Domain::Interval(first, last)).filter(|_| 0 <= first && first <= last && last < 1 << bits)?
            }
            Domain::Bits(..) => return None,
            Domain::Float(negative, limit) => {
                let sign = if *negative { first & 0x8000_0000 } else { 0 };
                let all = sign..sign + positive_floats(*limit);
                Some(Domain::Interval(first, last))
                    .filter(|_| all.contains(&first) && first <= last && all.contains(&last))?
            }
        };
        Some(Column { domain: Some(domain), ..self.clone() })
    }

    /// Returns the column with only the words that differ from `word` in bits of `mask`, smallest first. Returns `None` if it is not a
    /// column of words, if `word` has a bit of the mask, or if there is another way to write it: an empty mask, or one of the lowest bits
    /// only, is a number or a range.
    pub fn masked(&self, word: i64, mask: i64) -> Option<Column> {
        let Some(Domain::Word(bits)) = self.domain else { return None };
        let fits = |word: i64| u32::try_from(word).ok().filter(|_| word >> bits == 0);
        let (word, mask) = fits(word).zip(fits(mask))?;
        let domain = (word & mask == 0 && mask & mask.wrapping_add(1) != 0).then_some(Domain::Bits(word, mask));
        Some(Column { domain: Some(domain?), ..self.clone() })
    }

    /// Returns the numbers at which something may happen: ends, zero, halves, and their neighbours.
    pub fn boundary(&self) -> Vec<i64> {
        let mut values = match &self.domain {
            None => vec![0],
            Some(Domain::Listed(values)) => values.clone(),
            Some(Domain::Interval(first, last)) => {
                let middle = first + (last - first) / 2;
                let near =
                    [*first, first + 1, -128, -127, -1, 0, 1, middle, middle + 1, 127, 128, 129, last - 1, *last];
                near.into_iter().filter(|n| (first..=last).contains(&n)).collect()
            }
            Some(Domain::Word(bits)) => {
                let all = (1_i64 << bits) - 1;
                let half = 1 << (bits / 2);
                let ends = [0, 1, all - 1, all];
                let middles = [half - 1, half, all >> 1, (all >> 1) + 1];
                [&ends[..], &middles, &[all / 3, all - all / 3, all & 0x0f0f_0f0f]].concat()
            }
            Some(Domain::Bits(word, mask)) => vec![(*word).into(), (*word | *mask).into()],
            Some(Domain::Float(negative, limit)) => floats(*negative, *limit),
        };
        values.sort_unstable();
        values.dedup();
        values
    }
}

impl From<Column> for Vec<Column> {
    fn from(column: Column) -> Vec<Column> {
        vec![column]
    }
}

/// Spreads the lowest bits of a number to the positions of a mask's bits.
fn spread(number: u32, mask: u32) -> u32 {
    let (mut mask, mut number, mut word) = (mask, number, 0);
    while mask != 0 && number != 0 {
        let place = mask & mask.wrapping_neg();
        word |= if number & 1 != 0 { place } else { 0 };
        (mask, number) = (mask & !place, number >> 1);
    }
    word
}

/// Returns the number of floats below 2^limit, including 0.
fn positive_floats(limit: i32) -> i64 {
    i64::from(127 + limit) << 23
}

/// Returns bits of notable floats of a magnitude below 2^limit.
fn floats(negative: bool, limit: i32) -> Vec<i64> {
    let mut bits: Vec<u32> = vec![0, 1, 0x007f_ffff, 0x0080_0000];
    for exponent in [-24, -14, -9, -8, -4, -1, 0, 1, 4, 8, 10] {
        let power = ((exponent + 127) as u32) << 23;
        bits.extend([power - 1, power, power + 1, power | 0x0040_0000]);
    }
    // k / 255, and the middle between two of them.
    for k in [1_u32, 2, 64, 127, 128, 254] {
        bits.extend([halfway(2 * k), halfway(2 * k + 1)]);
    }
    bits.retain(|b| (*b >> 23) as i32 - 127 < limit);
    if negative {
        bits.extend(bits.clone().into_iter().map(|b| b | 0x8000_0000));
    }
    bits.into_iter().map(i64::from).collect()
}

/// Returns the float just below n / 510, for n from 1 to 510, without float arithmetic.
fn halfway(n: u32) -> u32 {
    let quotient = (u64::from(n) << 40) / 510;
    let extra = 64 - 24 - quotient.leading_zeros();
    let (mantissa, exponent) = (quotient >> extra, extra as i32 - 40);
    ((exponent + 150) as u32) << 23 | (mantissa as u32 & 0x007f_ffff)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_they_are_written() {
        for kind in [Kind::Unsigned(8), Kind::Signed(9), Kind::Halves(10), Kind::Hex(12), Kind::Name(&["A", "B", "C"])]
        {
            for value in -600..600 {
                assert_eq!(
                    kind.holds(value).then_some(value),
                    kind.read(&kind.write(value)).filter(|_| kind.holds(value))
                );
            }
            for text in ["", "-", "00", "+1", "-0", "1.0", "D", "fffff", "-0.5.5", "99999999999999999999"] {
                assert!(kind.read(text).is_none_or(|value| kind.write(value) == text), "{kind:?} {text}");
            }
        }
        assert_eq!([1, 2, 3, 4, 5].map(|n| Kind::Name(&["A", "B", "C", "D", "E"][..n]).bits()), [1, 1, 2, 2, 3]);
    }

    #[test]
    #[allow(clippy::float_arithmetic, reason = "the statement that integers are held to")]
    fn halfway_floats_lie_just_below() {
        for n in 1..=510_u32 {
            let (float, exact) = (f64::from(f32::from_bits(halfway(n))), f64::from(n) / 510.0);
            assert!(float <= exact && exact - float < exact * 2.0_f64.powi(-22), "{n}: {float} {exact}");
        }
    }

    #[test]
    fn narrowed_columns_have_what_lies_between() {
        let all = |column: &Column| (0..column.size()).map(|place| column.nth(place)).collect::<Vec<i64>>();
        let listed = Column::listed("in.size", Kind::Unsigned(9), &[4, 1, 64, 100]);
        for (column, first, last, expected) in [
            (Column::register("in.a"), -3, 1, vec![-3, -2, -1, 0, 1]),
            (Column::word("in.word", 32), 0xffff_fffe, 0xffff_ffff, vec![0xffff_fffe, 0xffff_ffff]),
            (Column::float("in.x", true, 4), 0x8000_0000, 0x8000_0001, vec![0x8000_0000, 0x8000_0001]),
            (listed.clone(), 1, 100, vec![1, 64, 100]),
            (listed.clone(), 4, 4, vec![4]),
        ] {
            let narrowed = column.narrowed(first, last).expect("numbers of the column");
            assert_eq!(all(&narrowed), expected, "{column:?}");
            assert_eq!((narrowed.name, narrowed.kind), (column.name, column.kind));
        }
        for (column, first, last) in [
            (Column::register("in.a"), -257, 0),
            (Column::register("in.a"), 0, 256),
            (Column::register("in.a"), 1, 0),
            (Column::word("in.word", 16), 0, 0x1_0000),
            (Column::float("in.x", true, 4), 0, 0x8000_0000),
            (Column::float("in.x", false, 4), 0x8000_0000, 0x8000_0001),
            (Column::float("in.x", true, 4), 0, 0x4180_0000),
            (listed.clone(), 4, 2),
            (listed.clone(), 64, 1),
            (Column::result("out.a", Kind::Unsigned(8)), 0, 0),
        ] {
            assert_eq!(column.narrowed(first, last), None, "{column:?} {first} {last}");
        }
    }

    #[test]
    fn boundaries_lie_inside() {
        let columns =
            [Column::byte("in.a"), Column::register("in.b"), Column::word("in.c", 16), Column::float("in.d", true, 4)];
        for column in columns {
            assert!(column.boundary().iter().all(|value| column.kind.holds(*value)), "{column:?}");
            assert!(column.boundary().len() > 5);
        }
    }
}
