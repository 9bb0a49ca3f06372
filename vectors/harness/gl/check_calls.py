#!/usr/bin/env python3
"""Compares what ninebit-record has recorded with what the batches say, and the constants of gl.c and gl.h with the system's OpenGL headers.

    python3 check_calls.py PACK RECORDED UNIT

At every draw the state of the combiners that the calls have built is compared with the state that the lines of the batch describe. Exit
status: 0 all draws are as the batches say, 1 some are not.
"""

import re
import sys
from itertools import zip_longest
from pathlib import Path

HERE = Path(__file__).resolve().parent
HEADERS = [Path("/usr/include/GL/gl.h"), Path("/usr/include/GL/glext.h")]
VARIABLES = [f"VARIABLE_{name}_NV" for name in "ABCDEFG"]


def registry():
    """Constants of the system's headers, by their names without GL_."""
    constants = {}
    for header in HEADERS:
        text = header.read_text(encoding="utf-8", errors="replace")
        constants.update((name, int(value, 0)) for name, value in re.findall(r"#define\s+GL_(\w+)\s+(0x[0-9A-Fa-f]+|\d+)\s", text))
    return constants


def wrong_constants(constants):
    """Constants of the program that are not those of the headers."""
    own = re.findall(r'\{ "(\w+)", (0x[0-9A-Fa-f]+|\d+) \}', (HERE / "gl.c").read_text())
    own += re.findall(r"#define GL_(\w+) (0x[0-9A-Fa-f]+|\d+)$", (HERE / "gl.h").read_text(), re.M)
    return [name for name, value in own if constants.get(name) != int(value, 0)]


def empty(constants):
    """The combiners before a batch: nothing is read, nothing is written."""
    final = {constants[name]: (0, constants["UNSIGNED_IDENTITY_NV"], constants["RGB"]) for name in VARIABLES[:6]}
    final[constants["VARIABLE_G_NV"]] = (0, constants["UNSIGNED_IDENTITY_NV"], constants["ALPHA"])
    return {"stages": 0, "portions": {}, "constants": {}, "fog": (0, 0, 0), "final": final, "clamp": None}


def described(pack, unit, constants):
    """State and rows of every draw, as the batches describe them."""
    value = lambda word: int(word) if word.isdigit() else constants[word]
    shared, state, rows, reading = None, None, 0, False
    for line in (pack / "units" / f"{unit}.gpu.txt").read_text().splitlines():
        words = line.split(" ")
        if words[0] == "batch":
            # Where there are combiners, what asks the texture environment is not drawn.
            rows, shared = int(words[1]), empty(constants) if words[2] == "combiners" else None
            state, reading = shared, False
        elif shared is None:
            continue
        elif words[0] == "draw":
            if reading:
                yield state, rows
            # What a draw sets stays until the next one sets it again; the final combiner begins anew.
            state, reading = shared, True
            state["final"] = empty(constants)["final"]
        elif words[0] == "end":
            yield state, rows
        elif words[0] == "combiners":
            state["stages"] = int(words[1])
        elif words[0] == "portion":
            numbers = [value(word) for word in words[1:]]
            state["portions"][numbers[0], numbers[1]] = tuple(numbers[2:])
        elif words[0] == "stage_constant":
            state["constants"][int(words[1]), int(words[2])] = tuple(map(int, words[3:]))
        elif words[0] == "constant":
            state["constants"][None, int(words[1])] = tuple(map(int, words[2:]))
        elif words[0] == "fog_color":
            state["fog"] = tuple(map(int, words[1:]))
        elif words[0] == "final":
            state["final"][value(words[1])] = tuple(value(word) for word in words[2:])
        elif words[0] == "color_sum_clamp":
            state["clamp"] = int(words[1])


def called(path, constants):
    """State and rows of every draw, as the calls have built them."""
    state, inputs, quads = empty(constants), {}, 0
    stage0, color0 = constants["COMBINER0_NV"], constants["CONSTANT_COLOR0_NV"]
    whole = lambda numbers: tuple(round(float(number)) for number in numbers)
    for line in path.read_text().splitlines():
        name, *words = line.split(" ")
        if name in ("CombinerInput", "CombinerOutput", "FinalCombinerInput"):
            # Flags are decimal, which 0 and 1 are in either base.
            numbers = [int(word, 16) for word in words]
        if name == "CombinerInput":
            inputs[numbers[0], numbers[1], numbers[2]] = tuple(numbers[3:])
        elif name == "CombinerOutput":
            key = (numbers[0] - stage0, numbers[1])
            if numbers[2:5] == [constants["DISCARD_NV"]] * 3:
                state["portions"].pop(key, None)
            else:
                read = [inputs[numbers[0], numbers[1], constants[variable]] for variable in VARIABLES[:4]]
                state["portions"][key] = tuple(number for triple in read for number in triple) + tuple(numbers[2:])
        elif name == "FinalCombinerInput":
            state["final"][numbers[0]] = tuple(numbers[1:])
        elif name == "CombinerStageParameterfv":
            state["constants"][int(words[0], 16) - stage0, int(words[1], 16) - color0] = whole(words[2:])
        elif name == "CombinerParameterfv":
            state["constants"][None, int(words[0], 16) - color0] = whole(words[1:])
        elif name == "Fogfv" and int(words[0], 16) == constants["FOG_COLOR"]:
            state["fog"] = tuple(round(255 * float(number)) for number in words[1:4])
        elif name == "CombinerParameteri" and int(words[0], 16) == constants["NUM_GENERAL_COMBINERS_NV"]:
            state["stages"] = int(words[1])
        elif name == "CombinerParameteri" and int(words[0], 16) == constants["COLOR_SUM_CLAMP_NV"]:
            state["clamp"] = int(words[1])
        elif name == "Vertex2f":
            quads += 1
        elif name == "ReadPixels":
            yield state, quads / 4
            quads = 0


def comparable(state):
    """What counts of a state: portions of stages that run, constants that are not 0."""
    runs = lambda key: key[0] is None or key[0] < state["stages"]
    constants = {key: color for key, color in state["constants"].items() if any(color) and runs(key)}
    portions = {key: portion for key, portion in state["portions"].items() if runs(key)}
    return state["stages"], portions, constants, state["fog"], dict(state["final"]), state["clamp"]


def main():
    pack, recorded, unit = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]
    constants = registry()
    wrong = wrong_constants(constants)
    if wrong:
        print(f"constants that are not those of OpenGL: {' '.join(wrong)}")
        return 1
    wanted = ((comparable(state), rows) for state, rows in described(pack, unit, constants))
    found = ((comparable(state), quads) for state, quads in called(recorded, constants))
    draws = 0
    for draws, (expected, got) in enumerate(zip_longest(wanted, found, fillvalue=(None, None)), 1):
        # Whole pictures are one rectangle.
        if expected[0] != got[0] or got[1] not in (1, expected[1]):
            print(f"draw {draws} is not what the batch says:\n  {expected}\n  {got}")
            return 1
    print(f"{unit}: {draws} draws called as the batches say")
    return 0 if draws else 1


if __name__ == "__main__":
    sys.exit(main())
