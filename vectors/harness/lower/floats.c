/* ninebit_combine (floats.h), and with -DCOMPARE a program that counts the rows of a pack that combiners in floats fail, by rule:
 *
 *     cc -std=c99 -DCOMPARE -I vendor -I ../c -o floats floats.c vendor/ninebit_combiners.c -lm && ./floats pack
 *
 * It ends with status 1 if no row tells floats from the chip, which no pack does.
 */
#include "floats.h"

#include <math.h>

/* A number as the integer of the chip: 1.0 is 255. */
static int32_t steps(float value, int32_t lowest)
{
    float scaled = floorf(value * 255.0f + 0.5f);
    if (!(scaled > (float)lowest)) return lowest; /* A number that is none, too. */
    return scaled < 255.0f ? (int32_t)scaled : 255;
}

void ninebit_combine(const struct nb_state *state, const float primary[4], const float secondary[4], const float fog[4],
                     const float texture[4][4], float out[4])
{
    struct nb_inputs inputs = {{0}, {0}, {0}, {{0}}, 0};
    int32_t fragment[4];
    for (int n = 0; n < 4; n++) {
        inputs.primary[n] = steps(primary[n], 0);
        inputs.secondary[n] = steps(secondary[n], 0);
        inputs.fog[n] = steps(fog[n], 0);
        for (int unit = 0; unit < 4; unit++) inputs.texture[unit][n] = steps(texture[unit][n], -256);
    }
    nb_fragment(state, &inputs, fragment);
    for (int n = 0; n < 4; n++) out[n] = (float)fragment[n] / 255.0f;
}

#ifdef COMPARE

#include "ninebit_vectors.h"

/* An input mapping in floats, and the rule that the chip's differs by. */
static float mapped(float x, const char *mapping, const char **rule)
{
    float u = x > 0.0f ? x : 0.0f;
    *rule = strncmp(mapping, "Unsigned", 8) == 0 ? "CMB-2" : strncmp(mapping, "Expand", 6) == 0 ? "CMB-3"
          : strncmp(mapping, "HalfBias", 8) == 0 ? "CMB-4" : "CMB-5";
    if (strcmp(mapping, "UnsignedIdentity") == 0) return u;
    if (strcmp(mapping, "UnsignedInvert") == 0) return 1.0f - (u < 1.0f ? u : 1.0f);
    if (strcmp(mapping, "ExpandNormal") == 0) return 2.0f * u - 1.0f;
    if (strcmp(mapping, "ExpandNegate") == 0) return 1.0f - 2.0f * u;
    if (strcmp(mapping, "HalfBiasNormal") == 0) return u - 0.5f;
    if (strcmp(mapping, "HalfBiasNegate") == 0) return 0.5f - u;
    return strcmp(mapping, "SignedIdentity") == 0 ? x : -x;
}

/* A product, biased and scaled, in floats. */
static float output(float product, const char *bias, const char *scale)
{
    if (strcmp(bias, "NegativeHalf") == 0) product -= 0.5f;
    if (strcmp(scale, "Two") == 0) product *= 2.0f;
    if (strcmp(scale, "Four") == 0) product *= 4.0f;
    return strcmp(scale, "Half") == 0 ? product / 2.0f : product;
}

/* Rows of a rule: how many, and how many floats fail. */
struct count { const char *rule; long rows, failed; };

static struct count counts[] = {{"CMB-2", 0, 0}, {"CMB-3", 0, 0}, {"CMB-4", 0, 0}, {"CMB-5", 0, 0}, {"CMB-8", 0, 0}, {"CMB-9", 0, 0}};

/* Counts a row: a float, limited as a register of floats is, beside the chip's number in halves of a step. */
static void counted(const char *rule, float found, long halves)
{
    float limited = found < -1.0f ? -1.0f : found > 1.0f ? 1.0f : found;
    for (size_t n = 0; n < sizeof counts / sizeof *counts; n++) {
        if (strcmp(counts[n].rule, rule) != 0) continue;
        counts[n].rows++;
        counts[n].failed += 2 * lroundf(limited * 255.0f) != halves;
    }
}

/* The number of a column as a float. */
static float real(ninebit_table *table, const char *column)
{
    return (float)ninebit_number(table, ninebit_column(table, column)) / 255.0f;
}

static void compare(ninebit_table *table)
{
    const char *rule = "CMB-8";
    if (strcmp(table->unit, "input-mapping") == 0) {
        float found = mapped(real(table, "in.x"), ninebit_text(table, ninebit_column(table, "cfg.mapping")), &rule);
        counted(rule, found, ninebit_halves(table, ninebit_column(table, "out.factor")));
    } else if (strcmp(table->unit, "dot-product") == 0) {
        float found = real(table, "in.a.r") * real(table, "in.b.r") + real(table, "in.a.g") * real(table, "in.b.g")
                    + real(table, "in.a.b") * real(table, "in.b.b");
        counted(rule, found, 2 * ninebit_number(table, ninebit_column(table, "out.dot")));
    } else {
        const char *bias = ninebit_text(table, ninebit_column(table, "cfg.bias"));
        const char *scale = ninebit_text(table, ninebit_column(table, "cfg.scale"));
        float found = output(real(table, "in.a") * real(table, "in.b"), bias, scale);
        counted("CMB-9", found, 2 * ninebit_number(table, ninebit_column(table, "out.value")));
    }
}

int main(int count, char **arguments)
{
    static const char *units[] = {"input-mapping", "dot-product", "scale-bias"};
    long failed = 0;
    for (size_t n = 0; n < sizeof units / sizeof *units; n++) {
        static ninebit_table table;
        char path[4096];
        snprintf(path, sizeof path, "%s/units/%s.tsv", count == 2 ? arguments[1] : ".", units[n]);
        FILE *file = fopen(path, "r");
        if (!file || !ninebit_open(&table, file)) {
            fprintf(stderr, "%s: %s; name a pack\n", path, file ? table.error : "cannot be opened");
            return 2;
        }
        while (ninebit_next(&table)) compare(&table);
        fclose(file);
        if (table.error[0]) {
            fprintf(stderr, "%s, %s\n", path, table.error);
            return 2;
        }
    }
    for (size_t n = 0; n < sizeof counts / sizeof *counts; n++) {
        printf("%s: %ld of %ld rows fail in floats\n", counts[n].rule, counts[n].failed, counts[n].rows);
        failed += counts[n].failed;
    }
    return failed == 0;
}

#endif
