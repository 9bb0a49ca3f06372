/* Tests two functions, the output of a combiner portion against units/scale-bias.tsv, and the input mappings against
 * units/input-mapping.tsv. Put your own in their place.
 *
 *     cc -std=c89 -pedantic -Wall -Wextra -Werror -o example example.c && ./example pack/units/scale-bias.tsv
 *
 * With -DPLANT the constant of the rounding, and that of half a byte, is one step off, and rows must fail.
 */
#include "ninebit_vectors.h"

#ifdef PLANT
#define HALF 126
#define HALF_BYTE 127
#else
#define HALF 127
#define HALF_BYTE 128
#endif

/* Rows that are shown. */
#define SHOWN 5

/* A times B, both in steps of 1/255, rounded to the nearest step, biased, scaled, saturated. */
static long output(long a, long b, const char *bias, const char *scale)
{
    /* The offset makes the dividend positive: integer division then rounds down. */
    long v = (a * b + HALF + 255L * 1024) / 255 - 1024;
    if (strcmp(bias, "NegativeHalf") == 0) v -= 128;
    if (strcmp(scale, "Two") == 0) v *= 2;
    if (strcmp(scale, "Four") == 0) v *= 4;
    if (strcmp(scale, "Half") == 0) v = (v + 1 + 1024) / 2 - 512;
    return v < -256 ? -256 : v > 255 ? 255 : v;
}

/* A register as a factor. */
static long factor(long x, const char *mapping)
{
    long u = x < 0 ? 0 : x;
    if (strcmp(mapping, "UnsignedIdentity") == 0) return u;
    if (strcmp(mapping, "UnsignedInvert") == 0) return 255 - u;
    if (strcmp(mapping, "ExpandNormal") == 0) return 2 * u - 256;
    if (strcmp(mapping, "ExpandNegate") == 0) return u == 0 ? 255 : 256 - 2 * u;
    if (strcmp(mapping, "HalfBiasNormal") == 0) return u - HALF_BYTE;
    if (strcmp(mapping, "HalfBiasNegate") == 0) return HALF_BYTE - u;
    if (strcmp(mapping, "SignedIdentity") == 0) return x;
    return x == -256 ? 255 : -x;
}

/* What the function under test yields for the current row, times two. */
static long found_halves(ninebit_table *table, int x, int y, int first, int second)
{
    if (strcmp(table->unit, "input-mapping") == 0) return 2 * factor(ninebit_number(table, x), ninebit_text(table, first));
    return 2 * output(ninebit_number(table, x), ninebit_number(table, y), ninebit_text(table, first), ninebit_text(table, second));
}

int main(int count, char **arguments)
{
    static ninebit_table table;
    FILE *file = count == 2 ? fopen(arguments[1], "r") : NULL;
    long rows = 0, failed = 0;
    int mapping, x, y, first, second, result;
    if (!file) {
        fprintf(stderr, count == 2 ? "%s cannot be opened\n" : "usage: example units/scale-bias.tsv\n", arguments[count - 1]);
        return 2;
    }
    if (!ninebit_open(&table, file)) {
        fprintf(stderr, "%s, %s\n", arguments[1], table.error);
        return 2;
    }
    mapping = strcmp(table.unit, "input-mapping") == 0;
    x = ninebit_column(&table, mapping ? "in.x" : "in.a");
    y = ninebit_column(&table, mapping ? "in.x" : "in.b");
    first = ninebit_column(&table, mapping ? "cfg.mapping" : "cfg.bias");
    second = ninebit_column(&table, mapping ? "cfg.mapping" : "cfg.scale");
    result = ninebit_column(&table, mapping ? "out.factor" : "out.value");
    if (x < 0 || y < 0 || first < 0 || second < 0 || result < 0) {
        fprintf(stderr, "%s: this is the table of %s, not of scale-bias or input-mapping\n", arguments[1], table.unit);
        return 2;
    }
    while (ninebit_next(&table)) {
        /* out.factor is of type h. Asked in halves, it needs no care for whether it is whole. */
        long found = found_halves(&table, x, y, first, second);
        rows++;
        if (found != ninebit_halves(&table, result) && failed++ < SHOWN) {
            printf("found %ld for ", found / 2);
            ninebit_print(&table, stdout);
        }
    }
    fclose(file);
    if (table.error[0]) {
        fprintf(stderr, "%s, %s\n", arguments[1], table.error);
        return 2;
    }
    printf("%s: %ld of %ld rows failed\n", table.unit, failed, rows);
    return rows == 0 ? 2 : failed != 0;
}
