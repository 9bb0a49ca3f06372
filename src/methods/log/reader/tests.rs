use super::*;
use crate::log::Fault;

fn read(text: &str) -> (Vec<Event>, Reader) {
    let (mut reader, mut events) = (Reader::new(), Vec::new());
    // Parts of three bytes: lines come together from several.
    for part in text.as_bytes().chunks(3) {
        reader.feed(part, &mut |entry| events.push(entry.event));
    }
    reader.finish(&mut |entry| events.push(entry.event));
    (events, reader)
}

fn write(method: u32, word: u32) -> Event {
    Event::Write(Write { class: KELVIN, method, word })
}

#[test]
fn every_form_is_read() {
    let forms: &[(&str, &[Event])] = &[
        ("nv2a_pgraph_method 0: 0x97 -> 0x1b08 NV097_SET_TEXTURE_ADDRESS[0] 0x10303", &[write(0x1b08, 0x10303)]),
        ("4711@1732.000123:nv2a_pgraph_method 0: 0x97 -> 0x17fc NV097_SET_BEGIN_END[0] 0x5", &[write(0x17fc, 5)]),
        (
            "nv2a_pgraph_method 0: 0x97 -> 0x17c4 ?[0] 0x1\nnv2a_pgraph_method_unhandled 0: 0x97 -> 0x17c4 0x1",
            &[write(0x17c4, 1)],
        ),
        ("nv2a_pgraph_method_unhandled (0): 0x97 -> 0x0294 (0x20001)", &[write(0x294, 0x20001)]),
        (
            "nv2a: pgraph method (0): 0x97 -> 0x1550 (0x3f800000)\nnv2a:     unhandled  (0x97 0x00001550)",
            &[write(0x1550, 0x3f80_0000)],
        ),
        (
            "nv2a_pgraph_method_abbrev 0: 0x97 -> 0x1800 NV097_ARRAY_ELEMENT16 * 12",
            &[Event::Dropped { class: KELVIN, method: 0x1800, count: Some(12) }],
        ),
        (
            "nv2a_pgraph_method 0: 0x97 -> 0x1800 <NO_DATA>",
            &[Event::Dropped { class: KELVIN, method: 0x1800, count: Some(1) }],
        ),
        ("nv2a_pgraph_method 0: 0x97 -> 0x0304 0x1", &[write(0x304, 1)]),
        ("nv2a_pgraph_method 0: 0x97 -> NV097_SET_CULL_FACE<0x39c> (V_FRONT <0x404>)", &[write(0x39c, 0x404)]),
        ("nv2a_pgraph_method 0: 0x97 -> NV097_CLEAR_SURFACE<0x1d94> (0xF3? <0xf3>)", &[write(0x1d94, 0xf3)]),
        (
            "nv2a_pgraph_method 0: NV20_KELVIN_PRIMITIVE<0x97> -> NV097_SET_COMBINER_CONTROL<0x1E60> (0x11008 {Count:8, Mux:LSB})",
            &[write(0x1e60, 0x11008)],
        ),
        (
            "nv2a_pgraph_method 0: NV20_KELVIN_PRIMITIVE<0x97> -> NV097_SET_TRANSFORM_CONSTANT[1]<0xB84> (0xC3F00000 => -480.0)",
            &[write(0xb84, 0xc3f0_0000)],
        ),
        (
            "nv2a_pgraph_method 5: 0x44 -> NV044_SET_MONOCHROME_COLOR0<0x310> (1 <0x1>)",
            &[Event::Write(Write { class: 0x44, method: 0x310, word: 1 })],
        ),
        ("nv2a_pgraph_method_unhandled 255: 0xff -> 0xdeadbeef 0x0", &[]),
        ("nv2a_pgraph_flip_stall\nFlip (stall) 12", &[Event::Flip, Event::Flip]),
        (
            "nv2a_pgraph_surface_target       Target: [ZETA  @ 0x03912000] (ln) aa:0\nnv2a_reg_write PFB addr 0x410 size 4 val 0x10000",
            &[],
        ),
        ("pgraph method log from nvtrc\n// Surface dump: frame_draw=3 surface_dump=17", &[Event::SurfaceDump(17)]),
        ("Moving 0x03F97D60 / 0x03FC3558: 0x17FC = 0x00000008", &[write(0x17fc, 8)]),
        ("00123i[GEFORC] execute_command: chid 0x0, subc 0x0, method 0x765, param 0xf3", &[write(0x1d94, 0xf3)]),
        (
            "execute_command: obj 0x12, class 0x0056, method 0xc0, param 0x1",
            &[Event::Write(Write { class: 0x56, method: 0x300, word: 1 })],
        ),
        ("[COMBINER] config=0 1E60=00000101", &[write(0x1e60, 0x101)]),
        ("[COMBINER] config=0 1E40..1E44: 000820D0 00000000", &[write(0x1e40, 0x8_20d0), write(0x1e44, 0)]),
        (
            "[COMBINER] new config=0 draw=17 result=prepared\n  [PB]   subch 0  method 0x1B00  x4      SET_TEXTURE_OFFSET",
            &[],
        ),
        (
            "/* Slot 0: 0x00000000 0x00EC001B 0x0836186C 0x20708800 */",
            &[write(0xb00, 0), write(0xb04, 0x00ec_001b), write(0xb08, 0x0836_186c), write(0xb0c, 0x2070_8800)],
        ),
        (
            "[0x00000000, 0x0020001B, 0x0836106C, 0x2F100FF8]",
            &[write(0xb00, 0), write(0xb04, 0x0020_001b), write(0xb08, 0x0836_106c), write(0xb0c, 0x2f10_0ff8)],
        ),
        ("0x1818 0x3f800000\n0x17fc, 0x0", &[write(0x1818, 0x3f80_0000), write(0x17fc, 0)]),
        (
            "00080300 00000001 00000000\n0x404c1818\n",
            &[write(0x300, 1), write(0x304, 0), Event::Fault(Fault::End(0x13))],
        ),
    ];
    for (text, events) in forms {
        let (read, reader) = read(text);
        assert_eq!(read, *events, "{text}");
        assert_eq!(reader.first_unknown, None, "{text}");
    }
}

#[test]
fn other_lines_are_counted() {
    let (events, reader) =
        read("hello\nnv2a_pgraph_method 0: 0x97 -> NAME (1)\nnv2a_pgraph_method 0: 0x97 -> 0x300 0x1FFFFFFFF\r\n\n");
    assert!(events.is_empty());
    assert_eq!((reader.unknown, reader.first_unknown), (3, Some((1, "hello".to_owned()))));
}

#[test]
fn a_line_is_as_long_as_it_may_be() {
    let long = format!("0x{:0>1$}\n0x1818 0x0\n", "1", LONGEST_LINE);
    let (events, reader) = read(&long);
    assert_eq!((events, reader.unknown), (vec![write(0x1818, 0)], 1));
    assert!(reader.partial.capacity() < 4 * LONGEST_LINE);
}
