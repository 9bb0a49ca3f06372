// The RGB portion of a general combiner stage, written from docs/rules (CMB-2 to CMB-10, NUM-2, NUM-3).
//
// Vectors hold red, green and blue, red in the top bits; a channel is a register of 9 bits in two's complement, 255 for one. The order of
// the mappings and of the scales is that of the exported layout, general-stage.svh. Combinational; plain Verilog-2001.

module general_stage #(
    // Added to twice the sum before it is divided by 510: 255 rounds to nearest. 253 plants an error of one step.
    parameter ROUNDING = 255
) (
    input [2:0] mapping_a, mapping_b, mapping_c, mapping_d,
    input [1:0] scale,
    input bias,
    input mux,
    input mux_lsb,
    input ab_dot, cd_dot,
    input [26:0] a, b, c, d,
    input signed [8:0] spare0_alpha,
    output [26:0] ab, cd, third
);
    // CMB-2 to CMB-5: a register becomes a factor, -256 to 255.
    function signed [9:0] factor(input [2:0] mapping, input signed [8:0] x);
        reg signed [9:0] unsigned_x, value;
        begin
            unsigned_x = x < 0 ? 0 : x;
            case (mapping)
                3'd0: value = unsigned_x;
                3'd1: value = 255 - unsigned_x;
                3'd2: value = 2 * unsigned_x - 256;
                3'd3: value = unsigned_x == 0 ? 255 : 256 - 2 * unsigned_x;
                3'd4: value = unsigned_x - 128;
                3'd5: value = 128 - unsigned_x;
                3'd6: value = x;
                default: value = x == -256 ? 255 : -x;
            endcase
            factor = value;
        end
    endfunction

    // NUM-2, CMB-9, NUM-3: a sum in 1/65025 becomes a register. Scale and bias are arguments, so that assignments see them change.
    function [8:0] result(input signed [21:0] sum, input [1:0] by, input biased);
        reg [22:0] positive;
        reg signed [15:0] value;
        begin
            // 255 * 2048 more, so that the division is one of unsigned numbers and rounds down.
            positive = 2 * (sum + 22'sd522240) + ROUNDING;
            value = $signed({4'b0, positive / 23'd510}) - 2048;
            if (biased) value = value - 128;
            case (by)
                2'd0: value = value;
                2'd1: value = value * 2;
                2'd2: value = value * 4;
                default: value = (value + 1) >>> 1;
            endcase
            if (value > 255) value = 255;
            if (value < -256) value = -256;
            result = value[8:0];
        end
    endfunction

    // CMB-10.
    wire takes_cd = mux_lsb ? spare0_alpha[0] : spare0_alpha >= 128;

    wire signed [21:0] products_ab [0:2];
    wire signed [21:0] products_cd [0:2];
    wire signed [21:0] dot_ab = products_ab[0] + products_ab[1] + products_ab[2];
    wire signed [21:0] dot_cd = products_cd[0] + products_cd[1] + products_cd[2];

    genvar n;
    generate
        for (n = 0; n < 3; n = n + 1) begin : channel
            assign products_ab[n] = factor(mapping_a, a[9 * n +: 9]) * factor(mapping_b, b[9 * n +: 9]);
            assign products_cd[n] = factor(mapping_c, c[9 * n +: 9]) * factor(mapping_d, d[9 * n +: 9]);
            wire signed [21:0] wide_ab = ab_dot ? dot_ab : products_ab[n];
            wire signed [21:0] wide_cd = cd_dot ? dot_cd : products_cd[n];
            // CMB-7: one rounding, after the sum.
            wire signed [21:0] wide_third = mux ? (takes_cd ? wide_cd : wide_ab) : wide_ab + wide_cd;
            assign ab[9 * n +: 9] = result(wide_ab, scale, bias);
            assign cd[9 * n +: 9] = result(wide_cd, scale, bias);
            assign third[9 * n +: 9] = result(wide_third, scale, bias);
        end
    endgenerate
endmodule
