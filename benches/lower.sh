#!/usr/bin/env bash
# Times the printed C of the first draw of scenes: nanoseconds a pixel of one function on one core, gcc -O2, over 4,096 pixels that are given at random, the median of nine runs.
#
#     benches/lower.sh SCENE...
#
# NINEBIT names the program; without it the release build is made and used. MORE are further options of `ninebit lower`, for example "--textures words".
set -euo pipefail
cd "$(dirname "$0")/.."
if [ -z "${NINEBIT:-}" ]; then
    cargo build --release --locked --quiet
    NINEBIT=target/release/ninebit
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for scene in "$@"; do
    # shellcheck disable=SC2086
    "$NINEBIT" lower "$scene" --to c99 --draw 0 ${MORE:-} > "$work/draw.h"
    cat > "$work/bench.c" << 'END'
#define _POSIX_C_SOURCE 199309L
#include "draw.h"
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
enum { PIXELS = 4096, TURNS = 500, RUNS = 9 };
static struct ninebit_pixel pixels[PIXELS];
static int by_size(const void *a, const void *b) { return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b); }
int main(void)
{
    double times[RUNS];
    uint32_t sum = 0;
    for (int n = 0; n < PIXELS; n++) {
        for (int c = 0; c < 4; c++) {
            pixels[n].primary[c] = rand() & 255, pixels[n].secondary[c] = rand() & 255, pixels[n].fog[c] = rand() & 255;
            for (int u = 0; u < 4; u++) pixels[n].texture[u][c] = rand() & 255, pixels[n].weight[u][c] = rand() & 255;
        }
        for (int u = 0; u < 4; u++)
            for (int k = 0; k < 8; k++) pixels[n].texel[u][k] = (uint32_t)rand() * 2654435761u;
        pixels[n].destination = (uint32_t)rand() * 2654435761u;
    }
    for (int run = 0; run < RUNS; run++) {
        struct timespec from, to;
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &from);
        for (int turn = 0; turn < TURNS; turn++)
            for (int n = 0; n < PIXELS; n++) {
                uint32_t word;
                if (ninebit_draw0(&pixels[n], &word)) sum += word;
            }
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &to);
        times[run] = ((double)(to.tv_sec - from.tv_sec) * 1e9 + (double)(to.tv_nsec - from.tv_nsec)) / ((double)PIXELS * TURNS);
    }
    qsort(times, RUNS, sizeof *times, by_size);
    printf("%.2f ns a pixel (%08x)\n", times[RUNS / 2], sum);
    return 0;
}
END
    cc -std=c99 -O2 -o "$work/bench" "$work/bench.c"
    printf '%s: ' "$scene"
    "$work/bench"
done
