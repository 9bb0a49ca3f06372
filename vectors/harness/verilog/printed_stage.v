// The same module as general_stage.v, of the steps that `ninebit lower --generic --to verilog` prints: what stands here says which wire goes where.

module general_stage #(
    // An error is planted in the printed text.
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
    // The codes of the output's operation: scales of one and two with a bias or without, of four, of a half.
    reg [2:0] operation;
    always @*
        case ({bias, scale})
            3'b000: operation = 3'd0;
            3'b100: operation = 3'd1;
            3'b001: operation = 3'd2;
            3'b101: operation = 3'd3;
            3'b010: operation = 3'd4;
            default: operation = 3'd6;
        endcase

    wire signed [8:0] fa [0:2];
    wire signed [8:0] fb [0:2];
    wire signed [8:0] fc [0:2];
    wire signed [8:0] fd [0:2];
    wire signed [18:0] wide_ab [0:2];
    wire signed [18:0] wide_cd [0:2];
    wire signed [1:0] takes_cd;
    nb_products products_ab (.is_dot(ab_dot), .a0(fa[2]), .a1(fa[1]), .a2(fa[0]), .b0(fb[2]), .b1(fb[1]), .b2(fb[0]), .sums0(wide_ab[2]), .sums1(wide_ab[1]), .sums2(wide_ab[0]));
    nb_products products_cd (.is_dot(cd_dot), .a0(fc[2]), .a1(fc[1]), .a2(fc[0]), .b0(fd[2]), .b1(fd[1]), .b2(fd[0]), .sums0(wide_cd[2]), .sums1(wide_cd[1]), .sums2(wide_cd[0]));
    nb_takes_cd decides (.by_most(!mux_lsb), .spare0_alpha(spare0_alpha), .result(takes_cd));

    genvar n;
    generate
        for (n = 0; n < 3; n = n + 1) begin : channel
            // A sum has a bit more than its products.
            wire signed [19:0] wide_third;
            wire signed [19:0] longer_ab = wide_ab[n];
            wire signed [19:0] longer_cd = wide_cd[n];
            nb_mapped map_a (.mapping(mapping_a), .x(a[9 * n +: 9]), .result(fa[n]));
            nb_mapped map_b (.mapping(mapping_b), .x(b[9 * n +: 9]), .result(fb[n]));
            nb_mapped map_c (.mapping(mapping_c), .x(c[9 * n +: 9]), .result(fc[n]));
            nb_mapped map_d (.mapping(mapping_d), .x(d[9 * n +: 9]), .result(fd[n]));
            nb_third takes (.mux(mux), .takes_cd(takes_cd), .ab(wide_ab[n]), .cd(wide_cd[n]), .result(wide_third));
            nb_output output_ab (.operation(operation), .sum(longer_ab), .result(ab[9 * n +: 9]));
            nb_output output_cd (.operation(operation), .sum(longer_cd), .result(cd[9 * n +: 9]));
            nb_output output_third (.operation(operation), .sum(wide_third), .result(third[9 * n +: 9]));
        end
    endgenerate
endmodule
