//! Tests `ninebit op`: worked examples, tables, and arguments that are refused.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::bench;

use bench::Bench;
use serde_json::Value;

/// Returns one result of `ninebit op` with these arguments.
fn result(arguments: &str, name: &str) -> Value {
    let text = Bench::new().run(&format!("op {arguments} --format json")).text();
    let document: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(document["format"], "ninebit-op-1");
    assert!(document["steps"].as_array().is_some_and(|steps| !steps.is_empty()), "{text}");
    document["results"][name].clone()
}

const PRODUCT: &str = "combiner --a tex0 --b primary --in tex0=100 --in primary=200";
const SUM: &str = "combiner --a tex0 --b primary --c tex0 --d primary --in tex0=100 --in primary=200";

/// Numbers may be written in hexadecimal notation.
#[test]
fn hexadecimal_numbers() {
    for arguments in ["tex0=0x64 --in primary=0xC8", "tex0=0X64,0x64,100,0 --in primary=200"] {
        assert_eq!(result(&format!("combiner --a tex0 --b primary --in {arguments}"), "spare0.r"), 78, "{arguments}");
    }
    assert_eq!(result("combiner --a tex0:signed --b zero:invert --in tex0=-0x40", "spare0.r"), -64);
    let plain = result("filter --texels 10,200 --weights 51", "mix");
    assert_eq!(result("filter --texels 0xa,0xc8 --weights 0x33", "mix"), plain);
    for wrong in ["0x", "0x-1", "-0x-1", "0xg", "0x10000000000000000"] {
        Bench::new().run(&format!("op combiner --a tex0 --in tex0={wrong}")).failed(2, "whole numbers");
    }
}

/// What an open rule would change is said of stages, programs and units that follow one; others say nothing.
#[test]
fn open_rules_that_would_change_a_result_are_named() {
    let bench = Bench::new();
    let text = bench.run(&format!("op {SUM}")).text();
    let said = "Of the undecided rules CMB-7 would change this result.\n  CMB-7=each       spare0.r 156  spare0.g 156  spare0.b 156\n";
    assert!(text.ends_with(said), "{text}");
    let text = bench.run(&format!("op {SUM} --policy CMB-7=each")).text();
    assert!(text.ends_with("  CMB-7=once       spare0.r 157  spare0.g 157  spare0.b 157\n"), "{text}");
    assert!(bench.run(&format!("op {PRODUCT}")).text().ends_with("No undecided rule would change this result.\n"));
    bench.write("sum.rc", "!!RC1.0\n{\n rgb {\n  spare0 = sum();\n  discard = tex0 * col0;\n  discard = tex0 * col0;\n }\n}\nout.rgb = spare0;\n");
    let text = bench.run("op program sum.rc --in tex0=100 --in primary=200").text();
    assert!(
        text.contains("Of the undecided rules CMB-7 would change this result.\n  CMB-7=each       fragment.r 156"),
        "{text}"
    );
    let document = bench.run("op unit sum --in a=100 --in b=200 --in c=100 --in d=200 --format json").text();
    let document: Value = serde_json::from_str(&document).unwrap();
    assert_eq!(document["alternatives"][0]["policy"], "CMB-7=each");
    assert_eq!(document["alternatives"][0]["results"]["out.sum"], 156);
    let text = bench.run("op unit alpha-test --in function=Less --in reference=3 --in alpha=2").text();
    assert!(!text.contains("undecided"), "no rule of the alpha test is open: {text}");
}

/// A table of a pack is a table of cases: what is no input is passed over, but no misspelt name is.
#[test]
fn rows_of_packs_are_cases() {
    let bench = Bench::new();
    let table = crate::repository::at("vectors/packs/nv2a/general-stage.tsv");
    let table = table.to_str().unwrap();
    let text = bench.run(&format!("op unit general-stage --inputs {table}")).text();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split('\t').collect();
    let mut rows = 0;
    for line in lines {
        rows += 1;
        let fields: Vec<&str> = line.split('\t').collect();
        for (name, value) in names.iter().zip(&fields) {
            if let Some(own) = name.strip_prefix("result.") {
                let told = names.iter().position(|name| *name == own).unwrap();
                assert_eq!(fields[told], *value, "{own}: {line}");
            }
        }
    }
    assert!(rows >= 100 && names.contains(&"result.out.ab.r"), "{rows} rows, {names:?}");
    bench.run(&format!("op unit sum --inputs {table}")).failed(3, "is of unit general-stage, not sum");
    let other = bench.run(&format!("op unit general-stage --profile nv10 --inputs {table}"));
    other.failed(3, "is of profile Nv2a, not Nv10\n  help: `--profile` chooses the chip");
    bench.write("misspelt.tsv", "in.a\tin.b\tout.abc\n1\t2\t3\n");
    bench.run("op unit product --inputs misspelt.tsv").failed(3, "there is no input `out.abc`");
}

/// Columns that are not given have a default where one is sensible; `--columns` lists them.
#[test]
fn columns_have_defaults() {
    let bench = Bench::new();
    let short = "op unit general-stage --in mapping_a=SignedIdentity --in a.r=-100 --in b.r=255";
    let text = bench.run(short).text();
    assert!(text.contains("out.ab.r -100") && text.contains("out.cd.r 0"), "{text}");
    let listed = bench.run("op unit general-stage --columns").text();
    for line in [
        "SignedNegate [default: UnsignedIdentity]",
        "  cfg.ab_dot      a whole number from 0 to 1 [default: 0]",
        "yields mid.A.r,",
    ] {
        assert!(listed.contains(line), "{line}: {listed}");
    }
    let document: Value = serde_json::from_str(&bench.run("op unit product --columns --format json").text()).unwrap();
    assert_eq!((&document["columns"][0]["name"], &document["columns"][0]["default"]), (&"in.a".into(), &Value::Null));
    bench.run("op unit product --in a=1").failed(2, "`in.b` is not given\n  help: write `--in b=VALUE`");
    let written = bench.run("op unit write-mask --in format=A8R8G8B8 --in stored=0 --in word=12345678").text();
    assert!(written.contains("12345678"), "every channel is written: {written}");
}

/// `op unit` takes the inputs of vector tables. An input that its column does not allow, or a unit that the chip lacks, is refused by name.
#[test]
fn units() {
    let stencil = "unit stencil-test --in function=greater --in fail=Keep --in depth_fail=Invert --in pass=Increment --in reference=0x80 \
                   --in mask=255 --in in.stored=127";
    let whole = format!("op {stencil} --in write_mask=15 --in depth_passes=1");
    let text = Bench::new().run(&whole).text();
    assert_eq!(text, "stencil-test, profile Nv2a\n  result: mid.operation Increment  out.passes 1  out.stored 112\n");
    let json: Value = serde_json::from_str(&Bench::new().run(&format!("{whole} --format json")).text()).unwrap();
    assert_eq!((&json["operation"], &json["results"]["out.stored"]), (&"stencil-test".into(), &112.into()));
    let failed = |arguments: &str, says: &str| Bench::new().run(&format!("op {arguments}")).failed(2, says);
    failed(stencil, "`in.write_mask` is not given");
    failed(&format!("{stencil} --in write_mask=256"), "write a whole number from 0 to 255");
    failed(&format!("{stencil} --in function=Sometimes"), "one of Never, Less");
    failed(&format!("{stencil} --in light=1"), "has no input `light`");
    failed("unit volume-layer --profile nv10 --in mode=Wrap", "Nv10 has no unit `volume-layer`");
    failed("unit level", "there is no such unit");
    let beyond = "unit depth-word --profile nv10 --in format=Z16F --in mantissa=1 --in exponent=0";
    failed(beyond, "does not take these inputs together");
    let word = "unit depth-word --in format=Z16F --in mantissa=3 --in exponent=-1";
    assert_eq!(Bench::new().run(&format!("op {word}")).text(), "depth-word, profile Nv2a\n  result: out.word 007800\n");
    let bench = Bench::new();
    bench.write("rows.tsv", "format\tmantissa\texponent\nZ16\t5\t-1\nZ24S8F\t3\t-1\n");
    let text = bench.run("op unit depth-word --inputs rows.tsv").text();
    assert_eq!(text, "format\tmantissa\texponent\tresult.out.word\nZ16\t5\t-1\t000002\nZ24S8F\t3\t-1\t7f8000\n");
    bench.write("broken.tsv", "format\tmantissa\texponent\nZ17\t5\t-1\n");
    bench.run("op unit depth-word --inputs broken.tsv").failed(3, "`Z17` is not one of Z16, Z24S8");
}

#[test]
fn products_and_sums() {
    assert_eq!(result(PRODUCT, "spare0.r"), 78);
    assert_eq!(result(&format!("{PRODUCT} --scale 2"), "spare0.g"), 156);
    assert_eq!(result(&format!("{PRODUCT} --scale 2 --policy CMB-9=after"), "spare0.g"), 157);
    assert_eq!(result(SUM, "spare0.b"), 157);
    assert_eq!(result(&format!("{SUM} --policy CMB-7=each"), "spare0.b"), 156);
    // With other destinations the products are kept apart, but their values do not change.
    let apart = format!("{SUM} --ab spare1 --cd tex1 --sum discard");
    assert_eq!((result(&apart, "spare1.r"), result(&apart, "texture1.r")), (78.into(), 78.into()));
    assert_eq!(result(&format!("{PRODUCT} --portion alpha"), "spare0.a"), 78);
    assert_eq!(result(&format!("{PRODUCT} --bias"), "spare0.r"), 78 - 128);
    assert_eq!(result(&format!("{PRODUCT} --scale half"), "spare0.r"), 39);
}

#[test]
fn dot_products() {
    let dot = "combiner --a tex0 --b primary --dot --in tex0=100 --in primary=200";
    assert_eq!(result(dot, "spare0.r"), 235);
    assert_eq!(result(&format!("{dot} --policy CMB-8=each"), "spare0.r"), 234);
    let blue = format!("{dot} --blue-to-alpha --profile nv2a");
    assert_eq!((result(&blue, "spare0.b"), result(&blue, "spare0.a")), (235.into(), 235.into()));
    let two = "combiner --a tex0 --b primary --c primary --d primary --ab-dot --cd-dot --in tex0=100 --in primary=10";
    assert_eq!((result(two, "spare0.r"), result(two, "spare1.r")), (12.into(), 1.into()));
}

#[test]
fn mappings_and_signed_contents() {
    let expand = |value: i32| {
        result(&format!("combiner --a tex0:expand --b zero:invert --in tex0={value}"), "spare0.r").as_i64()
    };
    assert_eq!([expand(0), expand(128), expand(255), expand(-256)], [Some(-256), Some(0), Some(254), Some(-256)]);
    let literal = "combiner --a tex0:EXPAND_NORMAL_NV --b zero:invert --in tex0=128 --policy CMB-3=literal";
    assert_eq!(result(literal, "spare0.r"), 1);
    assert_eq!(result("combiner --a spare1:negate --b zero:invert --in spare1=-256", "spare0.r"), 255);
    assert_eq!(result("combiner --a spare1.a:signed --b const0 --in spare1.a=-256 --const0 255,0,1", "spare0.b"), -1);
}

#[test]
fn the_mux_takes_what_spare0_says() {
    let mux = |alpha: i32, more: &str| {
        let arguments = format!("combiner --a tex0 --b zero:invert --c tex1 --d zero:invert --mux {more}");
        result(&format!("{arguments} --in tex0=1 --in tex1=2 --in spare0.a={alpha}"), "spare0.r").as_i64()
    };
    assert_eq!([mux(127, ""), mux(128, ""), mux(-1, "")], [Some(1), Some(2), Some(1)]);
    assert_eq!([mux(-1, "--policy CMB-10=bit7"), mux(3, "--mux-select lsb")], [Some(2), Some(2)]);
}

#[test]
fn final_combiner() {
    let lerp = "final --a primary --b secondary --c tex0 --d tex1 \
                --in primary=100 --in secondary=200 --in tex0=37 --in tex1=10";
    assert_eq!(result(lerp, "fragment.r"), 111);
    assert_eq!(result(&format!("{lerp} --policy FIN-2=twice"), "fragment.r"), 110);
    assert_eq!(result(lerp, "fragment.a"), Value::Null);
    let sum = "final --d sum --in spare0=200 --in secondary=100 --g spare0.b:invert";
    assert_eq!((result(sum, "fragment.r"), result(sum, "fragment.a")), (255.into(), 55.into()));
    let product = "final --a ef --b zero:invert --e tex0 --f tex1 --in tex0=100 --in tex1=200";
    assert_eq!(result(product, "fragment.g"), 78);
    // The final combiner reads a negative register as 0.
    assert_eq!(result("final --d tex0:invert --in tex0=-100", "fragment.b"), 255);
    // The sum 200 + 100 is not clamped, so a quarter of it is 75.
    let open = "final --a const0 --b sum --in spare0=200 --in secondary=100 --const0 64 --no-color-sum-clamp";
    assert_eq!(result(open, "fragment.r"), 75);
}

#[test]
fn blend() {
    let over = "blend --source-factor sa --destination-factor 1-sa";
    assert_eq!(result(&format!("{over} --source 200,200,200,128 --destination 50"), "blend.r"), 125);
    let cut = format!("{over} --source 203,0,0,128 --stored 0x6000 --surface r5g6b5");
    assert_eq!((result(&cut, "blend.r"), result(&cut, "field.r")), (148.into(), 18.into()));
    assert_eq!(result(&cut, "stored.word"), 18 << 11);
    // The surface stores 99 as 12 in five bits, which a blend reads as 96.
    let bytes = format!("{over} --source 203,0,0,128 --destination 99,0,0 --surface r5g6b5");
    assert_eq!(result(&bytes, "blend.r"), 148);
    let signed = "blend --equation signed_add --source 200 --destination 127 --profile nv2a";
    assert_eq!(result(signed, "blend.r"), 71);
    let constant = "blend --source-factor GL_CONSTANT_COLOR --constant 128 --source 255 --destination 0";
    assert_eq!(result(constant, "blend.g"), 128);
}

#[test]
fn filter_and_address() {
    assert_eq!(result("filter --texels 10,200 --weights 51", "mix"), 48);
    assert_eq!(result("filter --texels 10,200,10,200 --at 179,128", "mix"), 48);
    assert_eq!(result("filter --texels -3,-1 --weights 128 --signed", "mix"), -2);
    assert_eq!(result("filter --texels -3,-1 --weights 128 --signed", "register"), -4);
    let texel = |mode: &str, index: i32| {
        result(&format!("address --mode {mode} --index {index} --size 8 --profile nv2a"), "texel")
    };
    assert_eq!(texel("wrap", -1), 7);
    assert_eq!([texel("mirror", 8), texel("mirror", 9), texel("mirror", -1)], [7, 6, 0].map(Value::from));
    assert_eq!([texel("clamp_to_edge", -5), texel("GL_REPEAT", 9)], [0, 1].map(Value::from));
    assert_eq!([texel("clamp_to_border", 8), texel("clamp_to_border", 7)], [Value::from("border"), 7.into()]);
}

#[test]
fn text_is_a_trace() {
    let text = Bench::new().run(&format!("op {SUM} --policy CMB-7=each")).text();
    let squeezed = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for part in [
        "combiner, profile Nv10 policy CMB-7=each:",
        "given primary.r 200 0.784314",
        "stage0.rgb.AB.r 100 * 200 20000 0.307574 0.307574 CMB-6",
        "spare0.b write(stage0.rgb.sum.b.output 156) 156",
        "result: spare0.r 156 spare0.g 156 spare0.b 156",
    ] {
        assert!(squeezed.contains(part), "`{part}` is not in {text}");
    }
    let idle = Bench::new().run("op combiner --a tex0 --ab discard").text();
    assert!(idle.contains("nothing is written"), "{idle}");
}

/// Applies the expand mapping to every register value and compares with the formula.
#[test]
fn tables() {
    let bench = Bench::new();
    let lines: Vec<String> = (-256..=255).map(|x| format!("{x}\t{}\t7", x / 2)).collect();
    bench
        .write("in.tsv", format!("\u{feff}# a remark\r\ntex0.r\ttexture0.g\ttex1.a\r\n\r\n{}\r\n", lines.join("\r\n")));
    let command = "op combiner --a tex0:expand_negate --b zero:invert --inputs in.tsv";
    let table = bench.run(command).text();
    let mut rows = table.lines();
    assert_eq!(rows.next(), Some("tex0.r\ttexture0.g\ttex1.a\tresult.spare0.r\tresult.spare0.g\tresult.spare0.b"));
    let expand = |x: i32| (-2 * (x.max(0) - 128)).min(255);
    for (x, row) in (-256..=255).zip(&mut rows) {
        assert_eq!(row, format!("{x}\t{}\t7\t{}\t{}\t255", x / 2, expand(x), expand(x / 2)));
    }
    assert_eq!(rows.next(), None);
    bench.run(&format!("{command} -o out.tsv")).data();
    assert_eq!(std::fs::read_to_string(bench.path("out.tsv")).unwrap(), table);

    bench.write("blend.tsv", "source.r\tsource.g\tsource.b\tsource.a\n1\t2\t3\t4\n255\t254\t253\t0\n");
    let table = bench.run("op blend --destination 9 --inputs blend.tsv").text();
    assert!(table.ends_with("\n255\t254\t253\t0\t255\t254\t253\t0\t16776957\t255\t254\t253\t0\n"), "{table}");
    bench.write("u.tsv", "u\n128\n384\n");
    let table = bench.run("op filter --texels 7,9 --at 0,128 --inputs u.tsv").text();
    assert_eq!(table, "u\tresult.mix\tresult.register\n128\t7\t7\n384\t7\t7\n");
    bench.write("i.tsv", "index\n-1\n8\n");
    let table = bench.run("op address --mode clamp_to_border --size 8 --profile nv2a --inputs i.tsv").text();
    assert_eq!(table, "index\tresult.texel\n-1\tborder\n8\tborder\n");
    bench.write("d.tsv", "x\ty\tz\n2\t-4\t1\n0\t0\t0\n-3\t3\t3\n");
    let table = bench.run("op cube --size 64 --inputs d.tsv").text();
    let lines: Vec<&str> = table.lines().skip(1).collect();
    assert_eq!(lines[0], "2\t-4\t1\tNegativeY\t12288\t6144\t48\t24\t[47,48]\t[23,24]");
    assert_eq!(lines[1], "0\t0\t0\tPositiveX\t0\t0\t0\t0\t[0,0]\t[0,0]");
    assert!(lines[2].starts_with("-3\t3\t3\tNegativeX\t16383\t0\t63\t0"), "{table}");
}

#[test]
fn broken_tables_say_where() {
    let bench = Bench::new();
    let run = |contents: &str| {
        bench.write("in.tsv", contents);
        bench.run("op combiner --a tex0 --inputs in.tsv -o out.tsv")
    };
    run("tex0.r\ttex0.g\n1\tx\n1\n1\t2\n1\t256\n").failed(
        3,
        "error[NB0533]: table `in.tsv`: 3 lines cannot be used\n  line 2: column 2 (`tex0.g`): `x` is not a whole number \
         from -256 to 255\n  line 3: 1 value, the header has 2\n  line 5: column 2 (`tex0.g`): `256` is not",
    );
    run(&format!("tex0.r\n{}", "x\n".repeat(40)))
        .failed(3, "line 17: column 1 (`tex0.r`): `x` is not a whole number from -256 to 255\n  ... and 24 more");
    run("const0.r\n-1\n").failed(3, "from 0 to 255");
    run("tex0.r\ttex9.g\n").failed(3, "error[NB0532]: table `in.tsv`, line 1, column 2: there is no input `tex9.g`");
    run("tex0.r\ttexture0.r\n").failed(3, "is the same input as column 1");
    run("zero.r\n0\n").failed(3, "there is no input `zero.r`");
    run("").failed(3, "error[NB0532]: table `in.tsv` has no header");
    run("tex0.r\n# nothing\n").failed(3, "has a header and no cases");
    bench.write("bytes.tsv", b"tex0.r\n\xff\n");
    bench.run("op combiner --inputs bytes.tsv").failed(3, "error[NB0531]");
    bench.run("op combiner --inputs .").failed(3, "it is not a regular file");
    bench.run("op combiner --inputs none.tsv").failed(4, "error[NB0530]");
    bench.write("in.tsv", "tex0.r\n1\n");
    bench.run("op combiner --inputs in.tsv -o in.tsv").failed(2, "is the input");
    bench.run("op combiner --inputs in.tsv -o none/out.tsv").failed(7, "create its folder first");
    bench.run("op filter --weights 1 --inputs in.tsv").failed(3, "there is no input `tex0.r`");
    bench.write("wu.tsv", "wu\n1\n");
    bench.run("op filter --weights 1 --inputs wu.tsv").failed(3, "has no column `unit0.texel00.r`");
    assert!(!bench.path("out.tsv").exists());
    let large = std::fs::File::create(bench.path("large.tsv")).unwrap();
    large.set_len((64 << 20) + 1).unwrap();
    bench.run("op combiner --inputs large.tsv").failed(5, "error[NB0534]");
}

/// Operations that a chip refuses, with the beginning of the message.
const ILLEGAL: [(&str, &str); 20] = [
    ("combiner --a tex0 --scale 4 --bias", "error[NB0307]: bias NegativeHalf does not go with scale Four"),
    ("combiner --a tex0 --portion alpha --dot", "error[NB0306]: the alpha portion has no dot products"),
    ("combiner --a tex0 --ab spare0 --sum spare0", "error[NB0310]: two results go to Spare0"),
    ("combiner --a tex2", "error[NB0302]: register Texture2 does not exist on Nv10"),
    ("combiner --a tex0 --blue-to-alpha", "error[NB0304]"),
    ("combiner --a fog.a", "error[NB0308]"),
    ("combiner --a secondary.a", "error[NB0309]"),
    ("combiner --a tex0.b", "error[NB0311]: an RGB portion cannot read just blue"),
    ("combiner --a tex0.rgb --portion alpha", "error[NB0311]: an alpha portion has no RGB to read"),
    ("combiner --a tex0 --ab fog", "error[NB0312]"),
    ("final --a tex0:expand", "error[NB0311]: the final combiner has no mapping ExpandNormal"),
    ("final --e sum", "error[NB0313]"),
    ("final --g tex0.rgb", "error[NB0311]: this input cannot read Rgb"),
    ("blend --equation signed_add --source 1 --destination 1", "error[NB0315]"),
    ("blend --surface b8 --source 1 --destination 1", "error[NB0316]"),
    ("blend --surface g8b8 --source 1 --destination 1", "error[NB0314]"),
    ("address --mode wrap --size 6 --index 1", "error[NB0219]"),
    ("address --mode clamp_to_border --size 8 --index 1", "error[NB0317]"),
    ("cube --size 100 --direction 1,0,0", "error[NB0219]"),
    ("cube --size 2048 --direction 1,0,0", "error[NB0321]"),
];

fn refused(bench: &Bench, illegal: &[(&str, &str)]) {
    for (arguments, message) in illegal {
        bench.run(&format!("op {arguments}")).failed(3, message);
    }
}

#[test]
fn what_a_chip_does_not_take_is_refused() {
    refused(&Bench::new(), &ILLEGAL[..10]);
}

#[test]
fn other_illegal_operations() {
    let bench = Bench::new();
    refused(&bench, &ILLEGAL[10..]);
    let text = bench.run("op combiner --a tex2").stderr;
    assert!(text.contains("op combiner --a tex2\n") && text.contains("^^^^ not on this chip"), "{text}");
}

#[test]
fn a_wrong_command_line_is_status_2() {
    let bench = Bench::new();
    let wrong = |arguments: &str, message: &str| bench.run(&format!("op {arguments}")).failed(2, message);
    wrong("", "Usage: ninebit op");
    wrong("combiner --a tex9", "there is no register `tex9`; known: zero, const0");
    wrong("combiner --a ef", "there is no register `ef`");
    wrong("combiner --a tex0:sine", "there is no mapping `sine`");
    wrong("combiner --a tex0.q", "there is no component `q`");
    wrong("combiner --ab zero", "`discard` drops the result");
    wrong("combiner --scale 3", "there is no scale `3`");
    wrong("combiner --in tex0", "REGISTER=N");
    wrong("combiner --in tex0=1,2", "one, three or four whole numbers");
    wrong("combiner --in tex0=1.5", "one, three or four whole numbers");
    wrong("combiner --in tex0=256", "write a whole number from -256 to 255");
    wrong("combiner --in tex9=1", "there is no register `tex9`");
    wrong("combiner --in tex0.q=1", "`tex0.q` is not a channel");
    wrong("combiner --in tex0.r=1,2,3", "`tex0.r` is not a channel");
    wrong("combiner --in zero=1", "write a whole number from 0 to 0");
    wrong("combiner --const0 256", "write a whole number from 0 to 255");
    wrong("combiner --policy CMB-3", "RULE=VALUE");
    wrong("combiner -o out.tsv", "--inputs");
    wrong("combiner --inputs in.tsv --format json", "cannot be used with");
    wrong("blend --destination 1", "`fragment.r` is not given\n  help: write `--source R,G,B,A`");
    wrong("blend --source 1", "`destination.r` is not given");
    wrong("blend --source 1 --destination 300", "out of range");
    wrong("blend --source 1 --destination 1 --stored 0x1", "cannot be used with");
    wrong("blend --source 1 --stored 0xzz", "not a word such as 0x6000");
    wrong("blend --source-factor src_beta --source 1 --destination 1", "there is no blend factor `src_beta`");
    wrong("filter --texels 1,2,3 --weights 1", "not two or four whole numbers");
    wrong("filter --texels 1,2 --weights 256", "write a whole number from 0 to 255");
    wrong("filter --texels 1,2", "write `--weights U,V` or `--at U,V`");
    wrong("filter --texels -1,2 --weights 1", "out of range");
    wrong("address --mode wrap --size 8", "`index` is not given");
    wrong("address --mode sideways --size 8 --index 1", "there is no address mode `sideways`");
}

/// The worked examples of `docs/rules` that consist of one operation.
#[test]
fn examples_of_the_handbook() {
    let number = |command: &str, name: &str| result(command, name).as_i64().unwrap_or_else(|| panic!("{command}"));
    let map = |mapping: &str, value: i32, more: &str| {
        number(&format!("combiner --a tex0:{mapping} --b zero:invert --in tex0={value} {more}"), "spare0.r")
    };
    // NUM-2, CMB-6.
    let product = |value: i32| {
        number(&format!("combiner --a tex0:signed --b primary --in tex0={value} --in primary=200"), "spare0.r")
    };
    assert_eq!((product(100), product(-100)), (78, -78));
    // NUM-3.
    let sum = |value: i32, more: &str| {
        let command = "combiner --a tex0:signed --b zero:invert --c tex0:signed --d zero:invert";
        number(&format!("{command} --in tex0={value} {more}"), "spare0.r")
    };
    assert_eq!((sum(150, ""), sum(-150, ""), sum(-150, "--policy NUM-3=255")), (255, -256, -255));
    // TEX-6, TEX-18.
    assert_eq!(number("filter --texels 10,200 --weights 51", "mix"), 48);
    let signed = |byte: i32| number(&format!("filter --texels {byte},{byte} --weights 0 --signed"), "register");
    assert_eq!((signed(127), signed(-128)), (254, -256));
    // CMB-1.
    let exchange = "combiner --a spare0 --b zero:invert --c spare1 --d zero:invert --ab spare1 --cd spare0 --sum discard \
                    --in spare0=10 --in spare1=20";
    assert_eq!((number(exchange, "spare0.r"), number(exchange, "spare1.r")), (20, 10));
    // CMB-2 to CMB-5.
    assert_eq!(
        [map("identity", 37, ""), map("invert", 37, ""), map("identity", -5, ""), map("invert", -5, "")],
        [37, 218, 0, 255]
    );
    assert_eq!([0, 128, 255].map(|v| map("expand", v, "")), [-256, 0, 254]);
    assert_eq!([0, 128, 255].map(|v| map("expand_negate", v, "")), [255, 0, -254]);
    assert_eq!([0, 128, 200].map(|v| map("half_bias", v, "")), [-128, 0, 72]);
    let half = "combiner --a tex0:half_bias --b primary --in tex0=200 --in primary=100 --policy CMB-4=127.5";
    assert_eq!(number(half, "spare0.r"), 28);
    assert_eq!([-256, 255].map(|v| map("negate", v, "")), [255, -255]);
    // CMB-7 to CMB-11.
    assert_eq!((number(SUM, "spare0.r"), number(&format!("{SUM} --policy CMB-7=each"), "spare0.r")), (157, 156));
    let dot = "combiner --a tex0 --b primary --dot --in tex0=100 --in primary=200";
    assert_eq!((number(dot, "spare0.r"), number(&format!("{dot} --policy CMB-8=each"), "spare0.r")), (235, 234));
    let twice = format!("{PRODUCT} --scale 2");
    assert_eq!((number(&twice, "spare0.r"), number(&format!("{twice} --policy CMB-9=after"), "spare0.r")), (156, 157));
    assert_eq!(map("signed", -1, "--scale half"), 0);
    let mux = |alpha: i32, more: &str| {
        let command = "combiner --a tex0 --b zero:invert --c tex1 --d zero:invert --mux --in tex0=1 --in tex1=2";
        number(&format!("{command} --in spare0.a={alpha} {more}"), "spare0.r")
    };
    assert_eq!((mux(0x82, ""), mux(0x82, "--mux-select lsb")), (2, 1));
    assert_eq!((mux(-1, ""), mux(-1, "--policy CMB-10=bit7"), mux(-1, "--mux-select lsb")), (1, 2, 2));
    let blue = "combiner --a tex0 --b zero:invert --blue-to-alpha --profile nv2a --in tex0=10,20,50";
    assert_eq!(["r", "g", "b", "a"].map(|c| number(blue, &format!("spare0.{c}"))), [10, 20, 50, 50]);
    // FIN-1 to FIN-5.
    let special = |more: &str| number(&format!("final --no-color-sum-clamp {more}"), "fragment.r");
    assert_eq!(special("--d sum:invert --in spare0=200 --in secondary=100"), 0);
    assert_eq!(special("--a sum --b zero:invert --in spare0=200 --in secondary=100"), 255);
    let lerp = "--a primary --b const0 --c tex0 --d tex1 --in primary=100 --const0 200 --in tex0=37 --in tex1=10";
    assert_eq!((special(lerp), special(&format!("{lerp} --policy FIN-2=twice"))), (111, 110));
    // A quarter of 455, of 310 and of the clamped 255.
    let quarter = "--a const0 --b sum --const0 64 --in spare0=200 --in secondary=255";
    assert_eq!((special(quarter), special(&format!("{quarter} --invert-spare0"))), (114, 78));
    assert_eq!(number(&format!("final {quarter}"), "fragment.r"), 64);
    assert_eq!(special("--d ef --e tex0 --f tex1 --in tex0=127 --in tex1=127"), 63);
    let above = "final --no-color-sum-clamp --a zero:invert --b sum --d sum --in spare0=200 --in secondary=100";
    assert_eq!(number(above, "fragment.r"), 255);
    assert!(Bench::new().run(&format!("op {above}")).text().contains("FIN-5"));
    // ROP-2 to ROP-5.
    let over = "blend --source-factor sa --destination-factor 1-sa";
    assert_eq!(number(&format!("{over} --source 200,200,200,128 --destination 51"), "blend.r"), 126);
    let byte = |equation: &str| {
        number(&format!("blend --equation {equation} --source 200 --destination 127 --profile nv2a"), "blend.r")
    };
    assert_eq!((byte("signed_add"), byte("signed_reverse_subtract")), (71, 183));
    let saturate = "blend --source-factor source_alpha_saturate --destination-factor zero --source 255,255,255,100 --destination 0,0,0,200";
    assert_eq!((number(saturate, "blend.r"), number(saturate, "blend.a")), (55, 100));
    let cut = format!("{over} --source 203,0,0,128 --stored 0x6000 --surface r5g6b5");
    assert_eq!((number(&cut, "blend.r"), number(&cut, "field.r")), (148, 18));
    // TEX-7.
    let texel = |mode: &str, index: i32| number(&format!("address --mode {mode} --index {index} --size 8"), "texel");
    assert_eq!((texel("wrap", -1), texel("clamp_to_edge", 9)), (7, 7));
    assert_eq!([8, 9, -1].map(|index| texel("mirror", index)), [7, 6, 0]);
}
