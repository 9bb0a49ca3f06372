#!/usr/bin/env bash
# Times printed C on the first draw of scenes: nanoseconds a pixel on one core, gcc -O2, over 4,096 pixels that are given at random, the median of nine runs. Once the
# function of the draw, once the generic text, which reads the draw's register words while it runs, and the whole pixel, in a triangle in perspective: at any places, and eight of a row.
#
#     benches/lower.sh SCENE...
#
# NINEBIT names the program; without it the release build is made and used. MORE are further options of `ninebit lower` for the function, for example "--textures words".
set -euo pipefail
cd "$(dirname "$0")/.."
if [ -z "${NINEBIT:-}" ]; then
    cargo build --release --locked --quiet
    NINEBIT=target/release/ninebit
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# `given.h` has the pixels, fills them and says what one comes to.
cat > "$work/bench.c" << 'END'
#define _POSIX_C_SOURCE 199309L
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
enum { PIXELS = 4096, TURNS = 500, RUNS = 9 };
#ifndef STEP
#define STEP 1
#endif
#include "given.h"
static int by_size(const void *a, const void *b) { return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b); }
int main(void)
{
    double times[RUNS];
    uint32_t sum = 0;
    for (int n = 0; n < PIXELS; n++) fill(n);
    for (int run = 0; run < RUNS; run++) {
        struct timespec from, to;
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &from);
        for (int turn = 0; turn < TURNS; turn++)
            for (int n = 0; n < PIXELS; n += STEP) sum += pixel(n);
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &to);
        times[run] = ((double)(to.tv_sec - from.tv_sec) * 1e9 + (double)(to.tv_nsec - from.tv_nsec)) / ((double)PIXELS * TURNS);
    }
    qsort(times, RUNS, sizeof *times, by_size);
    printf("%.2f ns a pixel (%08x)", times[RUNS / 2], sum);
    return 0;
}
END
for scene in "$@"; do
    # shellcheck disable=SC2086
    "$NINEBIT" lower "$scene" --to c99 --draw 0 ${MORE:-} > "$work/draw.h"
    cat > "$work/given.h" << 'END'
#include "draw.h"
static struct ninebit_pixel pixels[PIXELS];
static void fill(int n)
{
    for (int c = 0; c < 4; c++) {
        pixels[n].primary[c] = rand() & 255, pixels[n].secondary[c] = rand() & 255, pixels[n].fog[c] = rand() & 255;
        for (int u = 0; u < 4; u++) pixels[n].texture[u][c] = rand() & 255, pixels[n].weight[u][c] = rand() & 255;
    }
    for (int u = 0; u < 4; u++)
        for (int k = 0; k < 8; k++) pixels[n].texel[u][k] = (uint32_t)rand() * 2654435761u;
    pixels[n].destination = (uint32_t)rand() * 2654435761u;
}
static uint32_t pixel(int n)
{
    uint32_t word;
    return ninebit_draw0(&pixels[n], &word) ? word : 0;
}
END
    cc -std=c99 -O2 -o "$work/bench" "$work/bench.c"
    printf '%s: ' "$scene"
    "$work/bench"
    profile=nv2a
    words=$("$NINEBIT" lower "$scene" --to registers --draw 0)
    if [[ "$words" == *nv10:* ]]; then
        profile=nv10
    fi
    "$NINEBIT" lower --generic --to c99 --profile "$profile" -o "$work"
    {
        printf '#include "ninebit_combiners.h"\nstatic const struct nb_state state = {\n    .surface_format = 8, .color_mask = 0x01010101,\n'
        sed -nE 's/^ *(rc_[a-z0-9_]+): \[(.*)\],$/    .\1 = {\2},/p; s/^ *(rc_[a-z0-9_]+): (0x[0-9a-f]+),$/    .\1 = \2,/p' <<< "$words"
        cat << 'END'
};
static struct nb_inputs pixels[PIXELS];
static void fill(int n)
{
    for (int c = 0; c < 4; c++) {
        pixels[n].primary[c] = rand() & 255, pixels[n].secondary[c] = rand() & 255, pixels[n].fog[c] = rand() & 255;
        for (int u = 0; u < 4; u++) pixels[n].texture[u][c] = rand() & 255;
    }
    pixels[n].destination = (uint32_t)rand() * 2654435761u;
}
static uint32_t pixel(int n) { return nb_pixel(&state, &pixels[n]); }
END
    } > "$work/given.h"
    cc -std=c99 -O2 -o "$work/bench" "$work/bench.c" "$work/ninebit_combiners.c"
    printf '; generic: '
    "$work/bench"
    "$NINEBIT" lower "$scene" --whole --to c99 --draw 0 > "$work/whole.h"
    cat > "$work/given.h" << 'END'
#include "whole.h"
enum { TEXELS = 1 << 22 };
static struct ninebit_triangle triangle;
static uint32_t memory[TEXELS];
static int32_t places[PIXELS][2];
static void fill(int n)
{
    static const int32_t position[3][2] = {{0, 0}, {640 * 16, 0}, {0, 480 * 16}};
    static const uint32_t w[3] = {0x40000000, 0x40000000, 0x3f800000}; /* 2, 2, 1 */
    places[n][0] = rand() % (640 - STEP);
    places[n][1] = rand() % (480 - (places[n][0] + STEP) * 3 / 4);
    if (n > 0) return;
    struct ninebit_vertex vertex[3];
    memset(vertex, 0, sizeof vertex);
    for (int k = 0; k < 3; k++) {
        vertex[k].position[0] = position[k][0], vertex[k].position[1] = position[k][1], vertex[k].w = w[k];
        for (int c = 0; c < 8; c++) vertex[k].color[c / 4][c % 4] = rand() & 255;
        for (int c = 0; c < 16; c++) vertex[k].coordinate[c / 4][c % 4] = c % 4 == 3 ? w[k] : (uint32_t)(rand() & 0x7fffff) | 0x3f000000; /* 1/2 to 1 */
    }
    ninebit_draw0_set_up(vertex, &triangle);
    for (int k = 0; k < TEXELS; k++) memory[k] = (uint32_t)rand() * 2654435761u;
}
static uint32_t pixel(int n)
{
    const uint32_t *const texture[4] = {memory, memory, memory, memory};
    uint32_t words[STEP] = {0}, depths[STEP] = {0}, sum = 0;
    if (STEP == 1) {
        ninebit_draw0(&triangle, texture, places[n][0], places[n][1], words, depths);
    } else {
        ninebit_draw0_row(&triangle, texture, places[n][0], places[n][1], STEP, words, depths);
    }
    for (int k = 0; k < STEP; k++) sum += words[k];
    return sum;
}
END
    cc -std=c99 -O2 -o "$work/bench" "$work/bench.c"
    printf '; whole: '
    "$work/bench"
    cc -std=c99 -O2 -DSTEP=8 -o "$work/bench" "$work/bench.c"
    printf '; rows: '
    "$work/bench"
    printf '\n'
done
