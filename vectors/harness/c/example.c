/* Tests one function, the output of a combiner portion, against units/scale-bias.tsv. Put your own in its place.
 *
 *     cc -std=c89 -pedantic -Wall -Wextra -Werror -o example example.c && ./example pack/units/scale-bias.tsv
 *
 * With -DPLANT the constant of the rounding is one step off, and rows must fail.
 */
#include "ninebit_vectors.h"

#ifdef PLANT
#define HALF 126
#else
#define HALF 127
#endif

/* Rows that are shown. */
#define SHOWN 5

/* The function under test: A times B, both in steps of 1/255, rounded to the nearest step, biased, scaled, saturated. */
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

int main(int count, char **arguments)
{
    static ninebit_table table;
    FILE *file = count == 2 ? fopen(arguments[1], "r") : NULL;
    long rows = 0, failed = 0;
    int a, b, bias, scale, value;
    if (!file) {
        fprintf(stderr, count == 2 ? "%s cannot be opened\n" : "usage: example units/scale-bias.tsv\n", arguments[count - 1]);
        return 2;
    }
    if (!ninebit_open(&table, file)) {
        fprintf(stderr, "%s, %s\n", arguments[1], table.error);
        return 2;
    }
    a = ninebit_column(&table, "in.a");
    b = ninebit_column(&table, "in.b");
    bias = ninebit_column(&table, "cfg.bias");
    scale = ninebit_column(&table, "cfg.scale");
    value = ninebit_column(&table, "out.value");
    if (a < 0 || b < 0 || bias < 0 || scale < 0 || value < 0) {
        fprintf(stderr, "%s: this is the table of %s, not of scale-bias\n", arguments[1], table.unit);
        return 2;
    }
    while (ninebit_next(&table)) {
        long found = output(ninebit_number(&table, a), ninebit_number(&table, b), ninebit_text(&table, bias), ninebit_text(&table, scale));
        rows++;
        if (found != ninebit_number(&table, value) && failed++ < SHOWN) {
            printf("found %ld for ", found);
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
