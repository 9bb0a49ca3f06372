//! Recomputes a trace from its own numbers: every step from its inputs, and every input from the step that yields it.
//!
//! The code is written from `docs/trace-format.md` for the JSON document, and uses nothing of the model.

#[path = "dxt.rs"]
mod dxt;
#[path = "recompute_shader.rs"]
mod shader;
#[path = "recompute_weights.rs"]
mod weights;

use serde_json::Value;
use std::collections::BTreeMap;

/// An exact number: `value * 2^exponent / per_one`. If `per_one` is 0, `value` is the bits of a binary32 number.
#[derive(Clone, Copy, Debug)]
pub struct Number {
    pub value: i128,
    pub per_one: i128,
    pub exponent: i32,
}

impl Number {
    pub fn new(value: i128, per_one: i128) -> Number {
        Number { value, per_one, exponent: 0 }
    }
}

impl PartialEq for Number {
    fn eq(&self, other: &Self) -> bool {
        if self.per_one == 0 || other.per_one == 0 {
            return (self.value, self.per_one) == (other.value, other.per_one);
        }
        if self.exponent != 0 || other.exponent != 0 {
            return weights::Exact::new(*self).is_equal(weights::Exact::new(*other));
        }
        self.value * other.per_one == other.value * self.per_one
    }
}

fn number(v: &Value) -> Number {
    let exponent = v.get("exponent").map_or(0, |exponent| exponent.as_i64().unwrap() as i32);
    Number { exponent, ..Number::new(v["value"].as_i64().unwrap().into(), v["per_one"].as_i64().unwrap().into()) }
}

/// Returns whether a step states this operand itself, so that no earlier step yields it.
fn is_parameter(name: &str) -> bool {
    let parameters = [
        "x",
        "y",
        "size",
        "lod_bias",
        "min_lod",
        "max_lod",
        "levels",
        "write_mask",
        "z_max",
        "limit",
        "tap",
        "Z16",
        "Z16F",
        "Z24S8",
        "Z24S8F",
        "bias",
        "factor",
        "area",
        "lowest",
        "highest",
        "alpha_test.reference",
        "stencil_test.mask",
        "stencil_test.write_mask",
        "r",
        "g",
        "b",
        "a",
    ];
    let slope = name.starts_with("dE") || name.starts_with("dside");
    parameters.contains(&name) || name.starts_with("point.") || is_format(name) || slope || name.ends_with(".origin")
}

/// Recomputes one fragment under the document's `policies`. Returns the final value of each name.
pub fn fragment(draw: &Value, policies: &Value) -> Result<BTreeMap<String, Number>, String> {
    let mut known: BTreeMap<String, Number> = BTreeMap::new();
    for step in draw["steps"].as_array().unwrap() {
        let name = step["name"].as_str().unwrap();
        let operation = step["operation"].as_str().unwrap();
        let mut inputs = Vec::new();
        for input in step["inputs"].as_array().unwrap() {
            let label = input["name"].as_str().unwrap();
            let given = number(input);
            if let Some(made) = known.get(label) {
                if *made != given {
                    return Err(format!("{name}: input {label} is {given:?}, but was computed as {made:?}"));
                }
            } else if label.starts_with("zero.") {
                if given.value != 0 {
                    return Err(format!("{name}: {label} is {given:?}"));
                }
            } else if !is_parameter(label) {
                return Err(format!("{name}: input {label} was never computed"));
            }
            inputs.push((label.to_string(), given));
        }
        let shown = number(step);
        let computed = if ["given", "fetch", "palette", "border_color", "chain"].contains(&operation) {
            shown
        } else {
            apply(operation, &inputs, policies).ok_or_else(|| format!("{name}: unknown operation {operation}"))?
        };
        if computed != shown {
            return Err(format!("{name} = {operation}({inputs:?}): recomputed {computed:?}, shown {shown:?}"));
        }
        known.insert(name.to_string(), computed);
    }
    Ok(known)
}

/// Returns floor(scale n (1/2 + (16 x + 8 - point) / 2 size)), or one less where that is whole, x right of the point and size no power of two.
fn sprite(&[x, point, size, n]: &[i128; 4], scale: i128) -> i128 {
    let d = 16 * x + 8 - point;
    if size == 0 {
        return (scale * n).div_euclid(2);
    }
    let (above, below) = (scale * n * (size + d), 2 * size);
    let tie = above.rem_euclid(below) == 0 && d > 0 && size & (size - 1) != 0;
    above.div_euclid(below) - i128::from(tie)
}

fn plain(value: i128) -> Number {
    Number::new(value, 1)
}

fn byte(value: i128) -> Number {
    Number::new(value, 255)
}

/// Rounds a number to the nearest 255th, halves up: floor(255 n + 1/2).
fn nearest_255(n: Number) -> Number {
    byte((2 * 255 * n.value + n.per_one).div_euclid(2 * n.per_one))
}

fn times(a: Number, b: Number) -> Number {
    Number::new(a.value * b.value, a.per_one * b.per_one)
}

fn add(a: Number, b: Number) -> Number {
    Number::new(a.value * b.per_one + b.value * a.per_one, a.per_one * b.per_one)
}

fn negate(a: Number) -> Number {
    Number::new(-a.value, a.per_one)
}

/// Returns twice the centre of the expand mappings, in steps.
fn centre(policies: &Value) -> i128 {
    if policies["CMB-3"] == "literal" { 255 } else { 256 }
}

/// Returns twice the half of the half-bias mappings, in steps.
fn half(policies: &Value) -> i128 {
    match policies["CMB-4"].as_str() {
        Some("127") => 254,
        Some("127.5") => 255,
        _ => 256,
    }
}

/// Returns the smaller of a number and 1.
fn at_most_one(n: Number) -> Number {
    Number::new(n.value.min(n.per_one), n.per_one)
}

/// Returns A B and (1 - A) C of the final combiner.
fn lerp(a: Number, b: Number, c: Number) -> [Number; 2] {
    let a = at_most_one(a);
    [times(a, b), times(add(byte(255), negate(a)), c)]
}

fn apply(operation: &str, inputs: &[(String, Number)], policies: &Value) -> Option<Number> {
    let n = |k: usize| inputs[k].1;
    let v = |k: usize| inputs[k].1.value;
    let max0 = |k: usize| v(k).max(0);
    let stencil = |new: i128| plain(v(0) & !v(2) | new & v(2));
    Some(match operation {
        // Rasteriser and interpolation.
        "floor_sprite" => Number::new(sprite(&[v(0), v(1), v(2), v(3)], 256), 256),
        "quad_sprite" => Number::new(sprite(&[v(0), v(1), v(2), v(3)], 65536), 65536),
        "stipple_bit" => {
            let (byte, bit) = (v(1).div_euclid(8).rem_euclid(4), 7 - v(1).rem_euclid(8));
            plain(v(0) >> (8 * byte + bit) & 1)
        }
        "edge_function" => plain(v(0) * v(3) + v(1) * v(4) + v(2)),
        "cut_24" | "cut_24_product" | "edge_sum" | "reciprocal" => weights::number(operation, inputs),
        "rest_24" | "number" | "number_product" | "align_24" | "number_sum" => weights::number(operation, inputs),
        "float_difference" => weights::number(operation, inputs),
        "floor_weight" => weights::floor(&[n(0)], 256, 256, 256),
        "signed_weight" => weights::toward_zero(n(0), 256),
        "remainder_weight" => Number::new(256 - v(0) - v(1), 256),
        "interpolate" => byte((v(0) * v(3) + v(1) * v(4) + v(2) * v(5) + 128) >> 8),
        "interpolate_within" => {
            let sum = (v(0) * v(3) + v(1) * v(4) + v(2) * v(5) + 128) >> 8;
            byte(sum.clamp(v(0).min(v(1)).min(v(2)), v(0).max(v(1)).max(v(2))))
        }
        "cover" => byte((v(0) * v(1)).div_euclid(8)),
        "floor_coordinate" => weights::floor(&[n(0)], 256 * v(1), 256, 1 << 24),
        "quad_coordinate" => weights::floor(&[n(0)], 65536 * v(1), 65536, 1 << 61),
        "floor_ratio" => weights::floor(&[n(0), n(1)], 256 * v(2), 256, 1 << 24),
        "quad_ratio" => weights::floor(&[n(0), n(1)], 65536 * v(2), 65536, 1 << 61),
        "floor_factor" | "floor_number" => Number::new(weights::floor(&[n(0)], 4096, 4096, 4096).value.max(0), 4096),
        "fog_linear" | "fog_linear_abs" => weights::fog_line(inputs, operation.ends_with("_abs")),
        "fog_steps" => Number::new(weights::floor(&[n(0)], 4096, 4096, 1 << 40).value - 6144, 4096),
        "fog_exp" | "fog_exp_abs" | "fog_exp2" => byte(fog_table(operation, v(0))),
        "light_word" => plain(light_word(v(0))),
        "light_product" => plain(light_product(v(0), v(1))),
        "light_sum" => plain(light_sum([v(0), v(1), v(2)])),
        "square_f32" => plain((f32::from_bits(v(0) as u32) * f32::from_bits(v(0) as u32)).to_bits().into()),
        "copy_bit_11" if v(0) >> 23 & 255 == 255 => plain(v(0)),
        "copy_bit_11" => plain(v(0) & !(1 << 10) | (v(0) >> 11 & 1) << 10),
        "factor_byte" => byte((v(0) - (v(0) >> 8)) >> 4),
        // Texture units.
        "cube_face" => plain(weights::face(inputs)),
        "floor_face_u" | "floor_face_v" => weights::face_coordinate(inputs, operation.ends_with('u'), 256),
        "quad_face_u" | "quad_face_v" => weights::face_coordinate(inputs, operation.ends_with('u'), 65536),
        "floor_on_plane_u" | "floor_on_plane_v" => weights::on_plane(inputs, operation.ends_with('u'), 256),
        "quad_on_plane_u" | "quad_on_plane_v" => weights::on_plane(inputs, operation.ends_with('u'), 65536),
        "floor_on_face_u" | "floor_on_face_v" => weights::on_face(inputs, operation.ends_with('u'), 256),
        "quad_on_face_u" | "quad_on_face_v" => weights::on_face(inputs, operation.ends_with('u'), 65536),
        "log2_ratio" => Number::new(log2_ratio([v(0), v(1), v(2), v(3), v(4), v(5)]), 256),
        "biased_lod" => Number::new((v(0) + v(1)).max(v(2)).min(v(3)), 256),
        "level_0" => plain(0),
        "nearest_level" => plain(((v(0) + 128) >> 8).min(v(1) - 1)),
        "lower_level" => plain((v(0) >> 8).min(v(1) - 1)),
        "upper_level" => plain(((v(0) >> 8) + 1).min(v(1) - 1)),
        "lod_weight" => Number::new(v(0) & 255, 256),
        "decode_dxt1" | "decode_dxt1_dithered" | "decode_dxt3" | "decode_dxt5" => {
            let words: Vec<i128> = inputs.iter().map(|input| input.1.value).collect();
            plain(dxt::decode(operation, &words))
        }
        "nearest_texel" => plain(v(0) >> 8),
        "linear_texel" => plain((v(0) - 128) >> 8),
        "linear_texel_next" => plain(((v(0) - 128) >> 8) + 1),
        "linear_weight" => Number::new((v(0) - 128) & 255, 256),
        "wrap" => plain(v(0).rem_euclid(v(1))),
        "mirror" => {
            let period = v(0).rem_euclid(2 * v(1));
            plain(period.min(2 * v(1) - 1 - period))
        }
        "clamp" | "clamp_to_edge" => plain(v(0).clamp(0, v(1) - 1)),
        "clamp_to_border" => plain(v(0)),
        "clamp_to_border_texels" => plain(v(0).clamp(-4, v(1) + 3)),
        "expand_texel" => byte(texel(&inputs[1].0, v(0), &inputs[2].0)?),
        "expand_texel_signed" => byte(i128::from(texel(&inputs[1].0, v(0), &inputs[2].0)? as u8 as i8)),
        "mix" => Number::new((v(0) * (256 - v(2)) + v(1) * v(2) + 128) >> 8, n(0).per_one),
        "high_half" => sixteen_bits(v(0) >> 16),
        "low_half" => sixteen_bits(v(0) & 0xffff),
        "high_half_signed" => sixteen_bits(i128::from((v(0) >> 16) as u16 as i16)),
        "low_half_signed" => sixteen_bits(i128::from(v(0) as u16 as i16)),
        "high_byte" => byte(v(0) >> 8),
        "low_byte" => byte(v(0) & 255),
        "high_byte_doubled" => byte(2 * (v(0) >> 8)),
        "double" => byte(2 * v(0)),
        "write" | "copy" => n(0),
        // Texture shader.
        "byte_of_register" => plain(v(0) & 255),
        "byte_of_double" => plain(v(0) >> 1 & 255),
        "nearest_float" => weights::nearest_float(n(0)),
        "is_negative" => plain(i128::from(weights::Exact::new(n(0)).m < 0)),
        "is_not_negative" => plain(i128::from(weights::Exact::new(n(0)).m >= 0)),
        "remap_zero_to_one" | "remap_d3d" | "remap_gl" | "remap_twos_complement" => shader::remap(operation, inputs),
        "remap_half" | "remap_half_signed" | "third_of_unit" | "float_one" => shader::remap(operation, inputs),
        "float_product" | "float_sum" | "float_dot" | "float_double" | "float_reflection" => {
            shader::float(operation, inputs)
        }
        "floor_float" => Number::new(shader::floor_float(inputs), 256),
        "float_face" => plain(shader::face(inputs)),
        "floor_float_face_u" | "floor_float_face_v" => shader::face_coordinate(inputs, operation.ends_with('u')),
        "floor_float_on_plane_u" | "floor_float_on_plane_v" => shader::on_plane(inputs, operation.ends_with('u')),
        "end_of_face_u" | "end_of_face_v" => Number::new(shader::end(inputs, operation.ends_with('u')), 256),
        "dependent_255" => Number::new(256 * v(1) * v(0) / 255, 256),
        "dependent_256" => Number::new(v(1) * v(0), 256),
        "bump_offset" => shader::bump_offset(inputs),
        "floor_moved" => weights::moved(inputs),
        "luminance" => Number::new(shader::luminance(inputs), 4096),
        "convert_yuv_red" => byte((luma(v(0)) + 2 * (409 * v(2)).div_euclid(512) - 223).clamp(0, 255)),
        "convert_yuv_green" => {
            let chroma = (100 * v(1)).div_euclid(512) + (208 * v(2)).div_euclid(512);
            byte((luma(v(0)) - 2 * chroma + 136).clamp(0, 255))
        }
        "convert_yuv_blue" => byte((luma(v(0)) + (129 * v(1)).div_euclid(64) - 277).clamp(0, 255)),
        "luminance_byte" => byte(((v(0) - (v(0) >> 8)) >> 4).min(255)),
        // Combiners.
        "unsigned_identity" => byte(max0(0)),
        "unsigned_invert" => byte(255 - max0(0)),
        "final_invert" => byte((255 - max0(0)).max(0)),
        "expand_normal" => byte(2 * max0(0) - centre(policies)),
        "expand_negate" => byte((centre(policies) - 2 * max0(0)).min(255)),
        "half_bias_normal" => Number::new(2 * max0(0) - half(policies), 510),
        "half_bias_negate" => Number::new(half(policies) - 2 * max0(0), 510),
        "signed_identity" => n(0),
        "signed_negate" => byte((-v(0)).min(255)),
        "product" | "dot_product" => inputs.chunks(2).map(|p| times(p[0].1, p[1].1)).fold(plain(0), add),
        "dot_product_rounded" => inputs.chunks(2).map(|p| nearest_255(times(p[0].1, p[1].1))).fold(plain(0), add),
        "add" => add(n(0), n(1)),
        "add_rounded" => add(nearest_255(n(0)), nearest_255(n(1))),
        "select" => n(usize::from(v(2) != 0)),
        "mux_msb" => plain(i128::from(v(0) >= 128)),
        "mux_bit7" => plain(v(0) >> 7 & 1),
        "mux_lsb" => plain(v(0) & 1),
        "round_255" => nearest_255(n(0)),
        "bias" => byte(v(0) - 128),
        "scale_2" => byte(2 * v(0)),
        "scale_4" => byte(4 * v(0)),
        "scale_half" => byte((v(0) + 1) >> 1),
        "scale_1_round_255" => nearest_255(n(0)),
        "scale_2_round_255" => nearest_255(times(n(0), plain(2))),
        "scale_4_round_255" => nearest_255(times(n(0), plain(4))),
        "scale_half_round_255" => nearest_255(times(n(0), Number::new(1, 2))),
        "bias_scale_1_round_255" => nearest_255(add(n(0), byte(-128))),
        "bias_scale_2_round_255" => nearest_255(times(add(n(0), byte(-128)), plain(2))),
        "saturate_256" => byte(v(0).clamp(-256, 255)),
        "saturate_255" => byte(v(0).clamp(-255, 255)),
        "add_limit_255" => byte((v(0) + v(1)).min(255)),
        "product_round_255" => nearest_255(times(n(0), n(1))),
        "lerp_add" => {
            let [ab, ac] = lerp(n(0), n(1), n(2));
            add(nearest_255(add(ab, ac)), n(3))
        }
        "lerp_add_rounded_twice" => {
            let [ab, ac] = lerp(n(0), n(1), n(2));
            add(add(nearest_255(ab), nearest_255(ac)), n(3))
        }
        "clamp_0_255" => byte(v(0).clamp(0, 255)),
        // Raster operations.
        "never" => plain(0),
        "less" => plain(i128::from(v(0) < v(1))),
        "equal" => plain(i128::from(v(0) == v(1))),
        "less_or_equal" => plain(i128::from(v(0) <= v(1))),
        "greater" => plain(i128::from(v(0) > v(1))),
        "not_equal" => plain(i128::from(v(0) != v(1))),
        "greater_or_equal" => plain(i128::from(v(0) >= v(1))),
        "always" => plain(1),
        "depth" | "w" => {
            let full = v(inputs.len() - 1);
            Number::new(depth(inputs, full).map_or(0, |z| z.floor().clamp(0.0, full as f64) as i128), full)
        }
        "depth_float_16" | "w_float_16" => plain(depth(inputs, 0).map_or(0, |z| float_word(z, 12, 7, 0xffff))),
        "depth_float_24" | "w_float_24" => plain(depth(inputs, 0).map_or(0, |z| float_word(z, 16, 127, 0xff_ffff))),
        "depth_inside" | "w_inside" => plain(depth(inputs, 0).is_some().into()),
        "drop_2_bits" => byte(v(0) >> 2 << 2),
        "depth_word" | "depth_word_of_ratio" => plain(weights::depth_word(inputs)),
        "depth_of_word" => plain(v(0) & 0xff_ffff),
        "all_or_nothing" => byte(255 * v(0)),
        "tap_u" | "tap_v" => {
            let axis = usize::from(operation == "tap_v");
            let (offset, _) = tap([v(1), v(2)], inputs.get(3..).unwrap_or_default());
            Number::new(v(0) + offset[axis], 256)
        }
        "tap_weight" => Number::new(tap([v(0), v(1)], inputs.get(2..).unwrap_or_default()).1, 256),
        "weighted_sum" => {
            let sum: i128 = (0..inputs.len() / 2).map(|k| v(2 * k) * v(2 * k + 1)).sum();
            Number::new((sum + 128) >> 8, n(0).per_one)
        }
        "equals_key" => {
            let half = inputs.len() / 2;
            plain(i128::from((0..half).all(|k| v(k) == v(k + half))))
        }
        "zero_if" if v(1) != 0 => Number { value: 0, ..n(0) },
        "zero_if" => n(0),
        "and" => plain(v(0) & v(1)),
        "stencil_keep" => plain(v(0)),
        "stencil_zero" => stencil(0),
        "stencil_replace" => stencil(v(1)),
        "stencil_increment_saturate" => stencil((v(0) + 1).min(255)),
        "stencil_decrement_saturate" => stencil((v(0) - 1).max(0)),
        "stencil_invert" => stencil(255 - v(0)),
        "stencil_increment" => stencil((v(0) + 1) % 256),
        "stencil_decrement" => stencil((v(0) + 255) % 256),
        "drop_3_bits" => byte(v(0) >> 3 << 3),
        "read_surface" => byte(surface(&inputs[1].0, v(0), &inputs[2].0)?),
        "constant_0" => byte(0),
        "constant_255" => byte(255),
        "constant_65535" => sixteen_bits(0xffff),
        "invert_255" => byte(255 - v(0)),
        "saturate_factor" => byte(v(0).min(255 - v(1))),
        "blend_add" => nearest_255(add(times(n(0), n(2)), times(n(1), n(3)))),
        "blend_subtract" => nearest_255(add(times(n(0), n(2)), negate(times(n(1), n(3))))),
        "blend_reverse_subtract" => nearest_255(add(times(n(1), n(3)), negate(times(n(0), n(2))))),
        "minimum" => byte(v(0).min(v(1))),
        "maximum" => byte(v(0).max(v(1))),
        "signed_add" => byte(v(1) + i128::from(v(0) as u8 as i8)),
        "signed_reverse_subtract" => byte(v(1) - i128::from(v(0) as u8 as i8)),
        "store" => plain(store(inputs)?),
        _ => return None,
    })
}

fn fog_table(operation: &str, q: i128) -> i128 {
    if operation == "fog_exp" && q >= 0 {
        return 255;
    }
    let n = q.abs();
    if n >= 2048 {
        return 0;
    }
    let entry = |i: i128| {
        let i = i as f64;
        let exponent = if operation == "fog_exp2" { -i * i / 128.0 } else { -i / 4.0 };
        (255.0 * exponent.exp2() + 0.5).floor() as i128
    };
    (entry(n >> 6) * (64 - (n & 63)) + entry((n >> 6) + 1) * (n & 63) + 32) >> 6
}

const LIGHT_NAN: i128 = 0x7fff_fc00;

/// Splits a word of the light unit into sign, 14-bit mantissa and exponent field.
fn light_parts(word: i128) -> (i128, i128, i128) {
    let mantissa = if word >> 23 & 255 == 0 { 0 } else { word >> 10 & 0x1fff | 0x2000 };
    (if word >> 31 & 1 == 1 { -1 } else { 1 }, mantissa, word >> 23 & 255)
}

fn light_word(pattern: i128) -> i128 {
    match pattern >> 23 & 255 {
        0 => 0,
        255 if pattern & 0x7f_ffff != 0 => LIGHT_NAN,
        _ if pattern >> 10 & 255 == 255 => pattern >> 10 << 10,
        _ => (pattern + 0x200) >> 10 << 10,
    }
}

/// Truncates m 2^(field - 140) to a word of the light unit.
fn light_truncated(mut m: i128, mut field: i128) -> i128 {
    let sign = if m < 0 { 1 << 31 } else { 0 };
    m = m.abs();
    if m == 0 {
        return 0;
    }
    while m < 0x2000 {
        (m, field) = (m * 2, field - 1);
    }
    while m >= 0x4000 {
        (m, field) = (m / 2, field + 1);
    }
    match field {
        ..=0 => 0,
        255.. => sign | 0x7f7f_fc00,
        _ => sign | field << 23 | (m & 0x1fff) << 10,
    }
}

fn light_product(a: i128, b: i128) -> i128 {
    let ((sa, ma, fa), (sb, mb, fb)) = (light_parts(a), light_parts(b));
    if a == LIGHT_NAN || b == LIGHT_NAN {
        LIGHT_NAN
    } else if ma == 0 || mb == 0 {
        0
    } else if fa == 255 || fb == 255 {
        0x7f80_0000
    } else {
        light_truncated(sa * ma * sb * mb, fa + fb - 140)
    }
}

fn light_sum(terms: [i128; 3]) -> i128 {
    let parts = terms.map(light_parts);
    if terms.contains(&LIGHT_NAN) {
        return LIGHT_NAN;
    }
    if parts.iter().any(|part| part.2 == 255) {
        return 0x7f80_0000;
    }
    let last = parts.iter().map(|part| part.2).max().unwrap() - 5;
    let sum = parts.iter().map(|(sign, m, field)| {
        let up = field - last;
        sign * if up >= 0 { m << up } else { m >> (-up).min(100) }
    });
    light_truncated(sum.sum(), last)
}

fn sixteen_bits(value: i128) -> Number {
    Number::new(value, 65535)
}

/// Returns floor(128 log2 n) - 4096 for the larger squared distance n.
fn log2_ratio(uv: [i128; 6]) -> i128 {
    let [u0, v0, u1, v1, u2, v2] = uv.map(|c| c.clamp(-(1 << 60), 1 << 60));
    let n = ((u1 - u0).pow(2) + (v1 - v0).pow(2)).max((u2 - u0).pow(2) + (v2 - v0).pow(2)) as u128;
    if n == 0 {
        return -32768;
    }
    let exponent = n.ilog2();
    // Squares the mantissa seven times. It is 1.0 to 2.0 with 60 fraction bits.
    let mut mantissa = if exponent > 60 { n >> (exponent - 60) } else { n << (60 - exponent) };
    let mut log = i128::from(exponent);
    for _ in 0..7 {
        mantissa = (mantissa * mantissa) >> 60;
        log *= 2;
        if mantissa >> 61 != 0 {
            mantissa >>= 1;
            log += 1;
        }
    }
    log - 4096
}

/// Returns the first term of a conversion from YUV.
fn luma(y: i128) -> i128 {
    (149 * y).div_euclid(128)
}

fn channel(letter: &str) -> Option<usize> {
    ["r", "g", "b", "a"].iter().position(|l| *l == letter)
}

/// Returns the letters of a format and their numbers of bits, from the top down. What is written into unused bits follows: `Z` or `O`.
fn fields(format: &str) -> Option<Vec<(char, u32)>> {
    let format = format.strip_suffix(['Z', 'O']).unwrap_or(format);
    let starts: Vec<usize> = format.match_indices(char::is_uppercase).map(|(at, _)| at).collect();
    if starts.first() != Some(&0) {
        return None;
    }
    let ends = starts.iter().copied().skip(1).chain([format.len()]);
    let one = |(start, end): (&usize, usize)| {
        Some((format[*start..].chars().next()?, format.get(start + 1..end)?.parse().ok()?))
    };
    starts.iter().zip(ends).map(one).collect()
}

fn is_format(name: &str) -> bool {
    ["YUY2", "UYVY"].contains(&name)
        || fields(name).is_some_and(|fields| [8, 16, 32].contains(&fields.iter().map(|(_, bits)| bits).sum::<u32>()))
}

/// Returns a channel of a texel, which the name of the format describes.
fn texel(format: &str, word: i128, letter: &str) -> Option<i128> {
    let c = channel(letter)?;
    match format {
        "YUY2" | "UYVY" => return Some([word >> 16 & 255, word >> 8 & 255, word & 255, 255][c]),
        "G8B8" => return Some([word & 255, word >> 8, word & 255, word >> 8][c]),
        "R8B8" => return Some([word >> 8, word & 255, word & 255, word >> 8][c]),
        _ => {}
    }
    // Luminance and intensity stand for several channels. One that is not stored is 255.
    let named = [["R", "L", "I"], ["G", "L", "I"], ["B", "L", "I"], ["A", "A", "I"]][c];
    let mut low = 0;
    for (name, bits) in fields(format)?.into_iter().rev() {
        let v = word >> low & ((1 << bits) - 1);
        low += bits;
        if named.iter().any(|one| one.starts_with(name)) {
            return match bits {
                1 => Some(255 * v),
                4 => Some(17 * v),
                5 => Some(v << 3 | v >> 2),
                6 => Some(v << 2 | v >> 4),
                8 => Some(v),
                _ => None,
            };
        }
    }
    Some(255)
}

fn surface(format: &str, word: i128, letter: &str) -> Option<i128> {
    let c = channel(letter)?;
    let argb = [word >> 16 & 255, word >> 8 & 255, word & 255, word >> 24 & 255];
    let seven = argb[3] & 127;
    Some(match format {
        "A8R8G8B8" => argb[c],
        "X8R8G8B8Z" | "X8R8G8B8O" => [argb[0], argb[1], argb[2], 255][c],
        "X1A7R8G8B8Z" | "X1A7R8G8B8O" => [argb[0], argb[1], argb[2], seven << 1 | seven >> 6][c],
        "R5G6B5" => [word >> 11 << 3, (word >> 5 & 63) << 2, (word & 31) << 3, 255][c],
        "X1R5G5B5Z" | "X1R5G5B5O" => [(word >> 10 & 31) << 3, (word >> 5 & 31) << 3, (word & 31) << 3, 255][c],
        _ => return None,
    })
}

/// Returns the word that is stored. The inputs are the format, the old word, the mask of written bits, then the channels that are written.
fn store(inputs: &[(String, Number)]) -> Option<i128> {
    let mut rgba = [0; 4];
    for (name, value) in &inputs[3..] {
        rgba[channel(name.rsplit('.').next()?)?] = value.value;
    }
    let [r, g, b, a] = rgba;
    let rgb = r << 16 | g << 8 | b;
    let word = match inputs[0].0.as_str() {
        "A8R8G8B8" => a << 24 | rgb,
        "X8R8G8B8Z" => rgb,
        "X8R8G8B8O" => 255 << 24 | rgb,
        "X1A7R8G8B8Z" => (a >> 1) << 24 | rgb,
        "X1A7R8G8B8O" => (128 | a >> 1) << 24 | rgb,
        "R5G6B5" => r >> 3 << 11 | g >> 2 << 5 | b >> 3,
        "X1R5G5B5Z" => r >> 3 << 10 | g >> 3 << 5 | b >> 3,
        "X1R5G5B5O" => 1 << 15 | r >> 3 << 10 | g >> 3 << 5 | b >> 3,
        "B8" => b,
        "G8B8" => g << 8 | b,
        _ => return None,
    };
    let (old, mask) = (inputs[1].1.value, inputs[2].1.value);
    Some(old & !mask | word & mask)
}

/// Returns the number that an operand stands for. Operands in binary32 are given as their bits.
#[allow(clippy::float_arithmetic, reason = "an independent way to the same numbers")]
fn real(n: Number) -> f64 {
    if n.per_one == 0 { f32::from_bits(n.value as u32).into() } else { n.value as f64 / n.per_one as f64 }
}

#[allow(clippy::float_arithmetic, reason = "an independent way to the same numbers")]
fn cut(n: f64, step: f64) -> f64 {
    (n / step).trunc() * step
}

/// Returns the exponent of the first bit.
fn power(n: f64) -> i32 {
    (n.abs().to_bits() >> 52) as i32 - 1023
}

#[allow(clippy::float_arithmetic, reason = "an independent way to the same numbers")]
fn two(power: i32) -> f64 {
    2.0_f64.powi(power)
}

fn first_24(n: f64) -> f64 {
    if n == 0.0 { 0.0 } else { cut(n, two(power(n) - 23)) }
}

/// DEP-1: returns S, the sum of the truncated edge functions, in steps that depend on the largest of `e`, the edge functions before
/// truncation.
#[allow(clippy::float_arithmetic, reason = "an independent way to the same numbers")]
fn depth_sum(edges: [f64; 3], e: [f64; 3]) -> f64 {
    let most = e.into_iter().filter(|e| *e != 0.0).map(|e| power(e.abs())).max().unwrap();
    edges.into_iter().map(|e| cut(e, two(most - 28))).sum()
}

/// DEP-1: returns R by two steps of Newton's method. The reciprocal of a power of two is exact.
#[allow(clippy::float_arithmetic, reason = "an independent way to the same numbers")]
fn depth_reciprocal(sum: f64) -> f64 {
    let top = power(sum);
    let whole = (sum / two(top - 30)) as i128;
    let middle = 2 * (whole >> 23) + 1;
    let first = (65536 + middle) / (2 * middle);
    let second = (((1 << 22) - first * (whole >> 16)) * first + 4096) >> 13;
    let third = (second * (((1 << 46) - second * whole) >> 15)) >> 16;
    if whole == 1 << 30 { 1.0 / sum } else { third as f64 * two(-29 - top) }
}

/// Recomputes the depth of DEP-1, DEP-4 and DEP-5 in doubles, which represent all of its numbers exactly. Returns `None` for `depth_inside`
/// if the depth lies outside a range that does not clamp.
#[allow(clippy::float_arithmetic, reason = "an independent way to the same numbers")]
fn depth(inputs: &[(String, Number)], largest: i128) -> Option<f64> {
    let number = |name: &str| inputs.iter().find(|(given, _)| given == name).map(|(_, n)| real(*n));
    let three = |name: &dyn Fn(usize) -> String| [0, 1, 2].map(|k| number(&name(k)).unwrap());
    let of_w = number("vertex0.w").is_some();
    let z = three(&|k| format!("vertex{k}.{}", if of_w { "w" } else { "z" }));
    let mut e = three(&|k| format!("E{k}"));
    let mut edges = e.map(first_24);
    if of_w {
        // RAS-8: the sign of w of the second vertex is that of all of them inside, and leaves the weights as they are.
        edges = [0, 1, 2].map(|k| first_24(edges[k] * first_24(z[1] / z[k])) * z[1].signum());
        e = edges;
    }
    let most = e.into_iter().filter(|e| *e > 0.0).map(power).max().unwrap();
    let reciprocal = depth_reciprocal(depth_sum(edges, e));
    let nearest = [1, 0, 2].into_iter().find(|k| e[*k] > 0.0 && power(e[*k]) == most).unwrap();
    let reference = if of_w { 1 } else { nearest };
    let mut weights = edges.map(|edge| first_24(edge * reciprocal));
    if of_w {
        let class = weights.map(|weight| if weight > 0.0 { power(weight) } else { i32::MIN });
        let dominant = match class {
            [a, b, c] if a >= b && a > c => 0,
            [a, b, c] if c > b && c >= a || a == b && b == c => 2,
            _ => 1,
        };
        let others = [weights[(dominant + 1) % 3], weights[(dominant + 2) % 3]];
        let rest = 1.0 - others[0] - others[1];
        // If the others leave almost 1, the difference in doubles rounds to 1, so it is corrected to the number below.
        weights[dominant] = if rest == 1.0 && others != [0.0; 2] { 1.0 - two(-24) } else { first_24(rest) };
    }
    let terms = [0, 1, 2].map(|k| {
        let weight = weights[k];
        if k == reference { z[k] } else { weight * f64::from((z[k] - z[reference]) as f32) }
    });
    let largest_term = terms.into_iter().filter(|term| *term != 0.0).map(power).max();
    let mut depth = largest_term.map_or(0.0, |top| terms.into_iter().map(|term| cut(term, two(top - 28))).sum());
    if let (Some(bias), Some(factor), Some(area)) = (number("bias"), number("factor"), number("area")) {
        let along = |axis: &str| -> f64 {
            let steps = three(&|k| format!("dE{k}/d{axis}"));
            (0..3).map(|k| steps[k] * z[k]).sum::<f64>().abs() / area
        };
        let slope = match z.into_iter().filter(|z| *z != 0.0).map(power).max() {
            Some(top) => cut(along("x").max(along("y")), two(top - 28)),
            None => 0.0,
        };
        depth += bias + factor * slope;
    }
    if let (Some(lowest), Some(highest)) = (number("lowest"), number("highest")) {
        let asked = !inputs.iter().any(|(name, _)| name == "z_max") && largest == 0;
        if asked && !(lowest..=highest).contains(&depth) {
            return None;
        }
        depth = depth.clamp(lowest, highest);
    }
    Some(depth)
}

/// DEP-3: returns the word of a float with `kept` bits of fraction.
#[allow(clippy::float_arithmetic, reason = "an independent way to the same numbers")]
fn float_word(z: f64, kept: i32, bias: i32, largest: i128) -> i128 {
    if z <= 0.0 {
        return 0;
    }
    let power = (z.to_bits() >> 52) as i32 - 1023;
    let fraction = ((z / 2.0_f64.powi(power) - 1.0) * 2.0_f64.powi(kept)) as i128;
    match power + bias {
        ..=0 => 0,
        field if field > if kept == 12 { 15 } else { 254 } => largest,
        field => i128::from(field) * (1 << kept) + fraction,
    }
}

/// TEX-17: returns the offset of a tap from the pixel's coordinates in 1/256 texel, and its weight. `quad` has u and v of the quad's three
/// pixels; if it is empty, there is one tap.
fn tap([limit, number]: [i128; 2], quad: &[(String, Number)]) -> ([i128; 2], i128) {
    let c = |k: usize| quad.get(k).map_or(0, |input| input.1.value);
    let limited = |n: i128| n.clamp(-1 << 29, 1 << 29);
    let axes = [2, 4].map(|k| [limited(c(k) - c(0)), limited(c(k + 1) - c(1))]);
    let length = |[u, v]: [i128; 2]| ((u * u + v * v) as u128).isqrt() as i128;
    let lengths = axes.map(length);
    let longer = usize::from(lengths[1] > lengths[0]);
    let (axis, long, short) = (axes[longer], lengths[longer], lengths[1 - longer]);
    let width = short.max((long + limit - 1) / limit).max(65536);
    if long <= width {
        return ([0; 2], 256);
    }
    let pairs = (long + 2 * width - 1) / (2 * width);
    let (pair, sign) = (number / 2, 1 - 2 * (number % 2));
    let reach = if pairs == 1 { long - width } else { (2 * pair + 1) * width };
    let inner = ((512 * width / long + 1) / 2).min(128 / (pairs - 1).max(1));
    let weight = if pair == pairs - 1 { 128 - (pairs - 1) * inner } else { inner };
    (axis.map(|n| sign * (n * reach / (2 * long) / 256)), weight)
}
