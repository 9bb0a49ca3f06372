// Holds general_stage to the rows of units/general-stage.hex, whose layout is units/general-stage.svh:
//
//     iverilog -g2005-sv -I pack/units -P testbench.ROWS=60000 -o stage.vvp testbench.v general_stage.v
//     vvp stage.vvp +units=pack/units
//
// ROWS is the number of lines of general-stage.hex. A row that fails is named by its id and its line in general-stage.tsv, whose rows
// stand in the same order. -P testbench.ROUNDING=253 plants an error, and rows must fail.

module testbench;
    `include "general-stage.svh"
    parameter ROWS = 1;
    parameter ROUNDING = 255;
    localparam SHOWN = 5;

    reg [ROW_BITS-1:0] rows [0:ROWS-1];
    reg [ROW_BITS-1:0] row;
    reg [8*1024-1:0] units, path;
    reg [8*1024-1:0] text, names, fields;
    reg [8*12-1:0] id;
    reg [7:0] first;
    wire [26:0] ab, cd, third;
    integer n, failed, unread, table_file, line, names_length, fields_length;

    general_stage #(.ROUNDING(ROUNDING)) stage (
        .mapping_a(row[CFG_MAPPING_A_HIGH:CFG_MAPPING_A_LOW]),
        .mapping_b(row[CFG_MAPPING_B_HIGH:CFG_MAPPING_B_LOW]),
        .mapping_c(row[CFG_MAPPING_C_HIGH:CFG_MAPPING_C_LOW]),
        .mapping_d(row[CFG_MAPPING_D_HIGH:CFG_MAPPING_D_LOW]),
        .scale(row[CFG_SCALE_HIGH:CFG_SCALE_LOW]),
        .bias(row[CFG_BIAS_LOW]),
        .mux(row[CFG_MUX_LOW]),
        .mux_lsb(row[CFG_MUX_SELECT_LOW]),
        .ab_dot(row[CFG_AB_DOT_LOW]),
        .cd_dot(row[CFG_CD_DOT_LOW]),
        .a({row[IN_A_R_HIGH:IN_A_R_LOW], row[IN_A_G_HIGH:IN_A_G_LOW], row[IN_A_B_HIGH:IN_A_B_LOW]}),
        .b({row[IN_B_R_HIGH:IN_B_R_LOW], row[IN_B_G_HIGH:IN_B_G_LOW], row[IN_B_B_HIGH:IN_B_B_LOW]}),
        .c({row[IN_C_R_HIGH:IN_C_R_LOW], row[IN_C_G_HIGH:IN_C_G_LOW], row[IN_C_B_HIGH:IN_C_B_LOW]}),
        .d({row[IN_D_R_HIGH:IN_D_R_LOW], row[IN_D_G_HIGH:IN_D_G_LOW], row[IN_D_B_HIGH:IN_D_B_LOW]}),
        .spare0_alpha(row[IN_SPARE0_A_HIGH:IN_SPARE0_A_LOW]),
        .ab(ab), .cd(cd), .third(third)
    );

    wire [26:0] expected_ab = {row[OUT_AB_R_HIGH:OUT_AB_R_LOW], row[OUT_AB_G_HIGH:OUT_AB_G_LOW], row[OUT_AB_B_HIGH:OUT_AB_B_LOW]};
    wire [26:0] expected_cd = {row[OUT_CD_R_HIGH:OUT_CD_R_LOW], row[OUT_CD_G_HIGH:OUT_CD_G_LOW], row[OUT_CD_B_HIGH:OUT_CD_B_LOW]};
    wire [26:0] expected_third =
        {row[OUT_THIRD_R_HIGH:OUT_THIRD_R_LOW], row[OUT_THIRD_G_HIGH:OUT_THIRD_G_LOW], row[OUT_THIRD_B_HIGH:OUT_THIRD_B_LOW]};

    // The current row of the table with the names of its columns: configuration, inputs, intermediates, results.
    task show_row;
        integer name_at, field_at, column;
        reg is_shown;
        begin
            name_at = names_length;
            field_at = fields_length;
            is_shown = 1;
            $write("   ");
            for (column = 0; is_shown && name_at > 0 && field_at > 0; column = column + 1) begin
                // Column 0 is the id; after the results come the tags.
                is_shown = column == 0 || names[8 * (name_at - 1) +: 8] != "t";
                if (column > 0 && is_shown) $write(" ");
                while (name_at > 0 && names[8 * (name_at - 1) +: 8] > 10) begin
                    if (column > 0 && is_shown) $write("%c", names[8 * (name_at - 1) +: 8]);
                    name_at = name_at - 1;
                end
                if (column > 0 && is_shown) $write("=");
                while (field_at > 0 && fields[8 * (field_at - 1) +: 8] > 10) begin
                    if (column > 0 && is_shown) $write("%c", fields[8 * (field_at - 1) +: 8]);
                    field_at = field_at - 1;
                end
                // The tabs.
                name_at = name_at - 1;
                field_at = field_at - 1;
            end
            $write("\n");
        end
    endtask

    // Red, green and blue of an output, what was found and what was expected.
    task show(input [8*5-1:0] name, input [26:0] found, input [26:0] expected);
        if (found !== expected)
            $display("    %0s is %0d %0d %0d, expected %0d %0d %0d", name,
                $signed(found[26:18]), $signed(found[17:9]), $signed(found[8:0]),
                $signed(expected[26:18]), $signed(expected[17:9]), $signed(expected[8:0]));
    endtask

    // Takes the next line of the table: its first character, and its first twelve, which are a row's id. Both are 0 at the end of the file.
    task next_line;
        integer count;
        begin
            line = line + 1;
            count = $fgets(text, table_file);
            first = count < 1 ? 0 : text >> 8 * (count - 1);
            id = count < 12 ? 0 : text >> 8 * (count - 12);
            fields = text;
            fields_length = count;
            // A line that is longer than the text comes in several parts.
            while (count > 0 && text[7:0] != 10) count = $fgets(text, table_file);
        end
    endtask

    initial begin
        failed = 0;
        unread = 0;
        line = 0;
        if (!$value$plusargs("units=%s", units)) begin
            $display("name the folder of the tables: +units=pack/units");
            $finish_and_return(2);
        end
        $sformat(path, "%0s/general-stage.tsv", units);
        table_file = $fopen(path, "r");
        if (table_file == 0) begin
            $display("%0s cannot be opened", path);
            $finish_and_return(2);
        end
        // Lines that begin with # come first, then the names of the columns.
        next_line;
        while (first == "#") next_line;
        names = fields;
        names_length = fields_length;
        $sformat(path, "%0s/general-stage.hex", units);
        $readmemh(path, rows);
        for (n = 0; n < ROWS; n = n + 1) begin
            row = rows[n];
            next_line;
            // A word that the file did not have is unknown in every bit.
            if (^row === 1'bx || first == 0) unread = unread + 1;
            #1;
            if ({ab, cd, third} !== {expected_ab, expected_cd, expected_third}) begin
                if (failed < SHOWN) begin
                    $display("general-stage: row %0s (line %0d of general-stage.tsv) fails", id, line);
                    show_row;
                    show("ab", ab, expected_ab);
                    show("cd", cd, expected_cd);
                    show("third", third, expected_third);
                end
                failed = failed + 1;
            end
        end
        $display("general-stage: %0d of %0d rows failed", failed, ROWS);
        if (unread != 0) begin
            $display("%0d rows could not be read", unread);
            $finish_and_return(2);
        end
        $finish_and_return(failed != 0);
    end
endmodule
