#!/usr/bin/env python3
"""Measures the printed C of W1's draw as an evaluator: nanoseconds a pixel on one core, and how far its words are from ninebit's.

    benches/peers/c_text.py NINEBIT SCENE ROUNDS WORK

The function has the filter inside: it takes interpolated bytes, fetched texels and weights. Those of 64 x 64 pixels of the frame itself are read off
their traces. Prints one evaluator of the file that `ninebit chart --evaluators FILE` reads.
"""
import json
import struct
import subprocess
import sys
from pathlib import Path

ninebit, scene, rounds, work = sys.argv[1], sys.argv[2], int(sys.argv[3]), Path(sys.argv[4])
SIDE, LEFT, TOP = 64, 288, 208

PROGRAM = r"""
#define _POSIX_C_SOURCE 199309L
#include "draw.h"
#include <stdio.h>
#include <time.h>
/* Timed are so many that all they bring stays near the core. */
enum { PIXELS = %d, TIMED = 64, TURNS = 50000, ROUNDS = %d };
static struct ninebit_pixel pixels[PIXELS];
static uint32_t words[PIXELS], read[PIXELS][11];
int main(int count, char **names)
{
    FILE *file = fopen(names[1], "rb");
    if (count != 2 || !file || fread(read, sizeof read, 1, file) != 1) return 1;
    for (int n = 0; n < PIXELS; n++) {
        for (int c = 0; c < 3; c++) pixels[n].primary[c] = (int32_t)read[n][c];
        for (int c = 0; c < 2; c++) pixels[n].weight[0][c] = (int32_t)read[n][3 + c];
        for (int k = 0; k < 4; k++) pixels[n].texel[0][k] = read[n][5 + k];
        pixels[n].destination = read[n][9];
    }
    for (int round = 0; round < ROUNDS; round++) {
        struct timespec from, to;
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &from);
        for (int turn = 0; turn < TURNS; turn++) {
            for (int n = 0; n < TIMED; n++) ninebit_draw0(&pixels[n], &words[n]);
            __asm__ volatile("" ::: "memory");
        }
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &to);
        printf("%%f\n", ((double)(to.tv_sec - from.tv_sec) * 1e9 + (double)(to.tv_nsec - from.tv_nsec)) / ((double)TIMED * TURNS));
    }
    for (int n = 0; n < PIXELS; n++) ninebit_draw0(&pixels[n], &words[n]);
    double squares = 0, largest = 0;
    for (int n = 0; n < PIXELS; n++)
        for (int c = 0; c < 24; c += 8) {
            double off = (double)((int)(words[n] >> c & 255) - (int)(read[n][10] >> c & 255));
            squares += off * off;
            if (off * off > largest * largest) largest = off < 0 ? -off : off;
        }
    printf("errors %%f %%f\n", squares / (3.0 * PIXELS), largest);
    return 0;
}
"""


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def row(pixel):
    """Primary colour, weights, texels, what the surface held, what it holds then."""
    steps = {step["name"]: step["value"] for step in pixel["draws"][0]["steps"]}
    names = ["primary.r", "primary.g", "primary.b", "unit0.weight_u", "unit0.weight_v"]
    names += [f"unit0.texel{x}{y}.word" for y in (0, 1) for x in (0, 1)] + ["surface.word", "stored.word"]
    return struct.pack("<11I", *(int(steps[name]) for name in names))


(work / "draw.h").write_text(run(ninebit, "lower", scene, "--to", "c99", "--draw", "0", "--textures", "words"))
document = json.loads(run(ninebit, "trace", scene, "--rectangle", f"{LEFT},{TOP},{SIDE},{SIDE}", "--format", "json"))
pixels = document["pixels"]
(work / "pixels").write_bytes(b"".join(map(row, pixels)))
(work / "text.c").write_text(PROGRAM % (len(pixels), rounds))
run("gcc", "-std=c99", "-O2", "-o", str(work / "text"), str(work / "text.c"))
*times, errors = run(str(work / "text"), str(work / "pixels")).splitlines()
times = sorted(map(float, times))
mean, largest = map(float, errors.split()[1:])


def at(share):
    return times[int((len(times) - 1) * share + 0.5)]


print(json.dumps({
    "name": "printed C",
    "surface": "one unit, one stage",
    "yields": "the stored word from interpolated bytes and fetched texels: W1 of the benches by `ninebit lower --to c99`, gcc -O2",
    "error": mean**0.5,
    "largest": largest,
    "time": {"median": at(0.5), "lower": at(0.25), "upper": at(0.75)},
}, indent=2))
