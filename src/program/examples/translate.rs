//! Translates a combiner program, in the language of NV_parse's register combiners, into the words that a driver writes.
//!
//! `cargo run -p ninebit-program --example translate`

use ninebit::state::{Named, Profile};
use ninebit_program::registers::encode;
use ninebit_program::text;

const LIT: &str = "
!!RC1.0
{
  rgb {
    spare0 = expand(tex0) . expand(col0);
  }
}
out.rgb = unsigned(spare0);
out.a = unsigned_invert(zero);
";

fn main() {
    let program = match text::parse(LIT, Profile::Nv2a) {
        Ok(program) => program,
        Err(findings) => return findings.iter().for_each(|finding| eprintln!("{}", finding.message)),
    };
    let words = encode(&program.combiners, Profile::Nv2a);
    for (word, index, value) in words.all().filter(|(_, _, value)| *value != 0) {
        println!("{:>24}[{index}] = {value:#010x}", word.name());
    }
}

#[cfg(test)]
#[test]
fn runs() {
    assert!(text::parse(LIT, Profile::Nv2a).is_ok());
    main();
}
