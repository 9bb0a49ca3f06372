#!/usr/bin/env python3
"""Compares what ninebit-record has recorded with what the batches say, and the constants of gl.c and gl.h with the system's OpenGL headers.

    python3 check_calls.py PACK RECORDED UNIT|SCENE

At every draw the state of the combiners that the calls have built is compared with the state that the lines of the batch describe; of a scene
all of the state, and every vertex. Exit status: 0 all draws are as the batches say, 1 some are not.
"""

import re
import struct
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
        else:
            describe(state, words, value)


def describe(state, words, value):
    """Puts what a line says of the combiners into their state. Whether it says anything of them."""
    if words[0] == "combiners":
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
    else:
        return False
    return True


class Combiners:
    """The state of the combiners that calls build."""

    def __init__(self, constants):
        self.state, self.inputs, self.constants = empty(constants), {}, constants

    def call(self, name, words):
        state, inputs, constants = self.state, self.inputs, self.constants
        stage0, color0 = constants["COMBINER0_NV"], constants["CONSTANT_COLOR0_NV"]
        whole = lambda numbers: tuple(round(float(number)) for number in numbers)
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


def called(path, constants):
    """State and rows of every draw, as the calls have built them."""
    combiners, quads = Combiners(constants), 0
    for line in path.read_text().splitlines():
        name, *words = line.split(" ")
        if name == "Vertex2f":
            quads += 1
        elif name == "ReadPixels":
            yield combiners.state, quads / 4
            quads = 0
        else:
            combiners.call(name, words)


def comparable(state):
    """What counts of a state: portions of stages that run, constants that are not 0."""
    runs = lambda key: key[0] is None or key[0] < state["stages"]
    constants = {key: color for key, color in state["constants"].items() if any(color) and runs(key)}
    portions = {key: portion for key, portion in state["portions"].items() if runs(key)}
    return state["stages"], portions, constants, state["fog"], dict(state["final"]), state["clamp"]


# What a draw of a scene does not say.
PLAIN = {
    "units": {},
    "shader": {},
    "environment": None,
    "mask": (1, 1, 1, 1),
    "scissor": None,
    "alpha_test": None,
    "blend": None,
    "depth": None,
    "offset": None,
    "stencil_test": None,
    "fog": None,
    "color_sum": False,
    "depth_clamp": False,
}


def single(number):
    """A number as binary32."""
    return struct.unpack("<f", struct.pack("<f", float(number)))[0]


def described_scene(pack, name, constants):
    """Every clear and draw of a scene, as its lines describe them: state, combiners, vertices."""
    value = lambda word: int(word) if word.isdigit() else constants[word]
    place = pack / "scenes" / name
    raw = place.with_name(f"{name}.scene.raw").read_bytes()
    lines = [line.split(" ") for line in place.with_name(f"{name}.scene.txt").read_text().splitlines()]
    needs = {words[1] for words in lines if words[0] == "needs"}
    width, height = next((int(words[1]), int(words[2])) for words in lines if words[0] == "size")
    textures, state, combiners, drawn = {}, None, None, None
    for words in lines:
        numbers = words[1:]
        if words[0] in ("texture", "cube", "depths"):
            # Textures get their names in the order in which they are made.
            target = "TEXTURE_CUBE_MAP" if words[0] == "cube" else "TEXTURE_2D"
            textures[int(numbers[0])] = (constants[target], len(textures) + 1)
        elif words[0] == "clear":
            yield "clear", tuple(map(int, numbers))
        elif words[0] == "clear_depth":
            yield "clear_depth", (int(numbers[0]), int(numbers[1]))
        elif words[0] == "draw":
            state = {key: dict(plain) if isinstance(plain, dict) else plain for key, plain in PLAIN.items()}
            combiners = empty(constants)
        elif words[0] == "unit":
            state["units"][int(numbers[0])] = [*textures[int(numbers[1])], *map(value, numbers[2:]), None, None]
        elif words[0] == "anisotropy":
            state["units"][int(numbers[0])][5] = int(numbers[1])
        elif words[0] == "compare":
            state["units"][int(numbers[0])][6] = value(numbers[1])
        elif words[0] == "shader":
            words_of_it = [single(word) if re.match("-?[0-9]", word) else value(word) for word in numbers[2:]]
            state["shader"][int(numbers[0]), value(numbers[1])] = tuple(words_of_it)
        elif words[0] == "env":
            state["environment"] = (int(numbers[0]), value(numbers[1]), value(numbers[2]))
        elif words[0] in ("mask", "scissor"):
            state[words[0]] = tuple(map(int, numbers))
        elif words[0] in ("alpha_test", "blend", "depth", "stencil_test"):
            state[words[0]] = tuple(map(value, numbers))
        elif words[0] == "offset":
            state["offset"] = tuple(map(single, numbers))
        elif words[0] == "fog_range":
            state["fog"] = (constants["LINEAR"], *map(single, numbers))
        elif words[0] == "fog_density":
            state["fog"] = (value(numbers[0]), single(numbers[1]))
        elif words[0] in ("color_sum", "depth_clamp"):
            state[words[0]] = True
        elif words[0] == "vertices":
            first, count = int(numbers[2]), int(numbers[1])
            vertices = [vertex_of(raw[at : at + 92], (width, height), needs) for at in range(first, first + 92 * count, 92)]
            yield "draw", (state, comparable(combiners), vertices)
        elif state is not None and words[0] != "end":
            assert describe(combiners, words, value), words


def vertex_of(bytes_of_it, size, needs):
    """What is called for a vertex."""
    x, y, depth, w, *rest = struct.unpack("<4f8B17f", bytes_of_it)
    fog, coordinates = rest[8], [tuple(rest[9 + 4 * unit : 13 + 4 * unit]) for unit in range(4)]
    position = tuple(number * w for number in (2 * x / size[0] - 1, 1 - 2 * y / size[1], 2 * depth - 1, 1))
    return {
        "position": position,
        "color": tuple(rest[:4]),
        "secondary": tuple(rest[4:7]) if "GL_EXT_secondary_color" in needs else None,
        "fog": fog if "GL_EXT_fog_coord" in needs else None,
        "coordinates": coordinates,
    }


def called_scene(path, height, constants):
    """Every clear and draw of a scene, as the calls have built them."""
    # OpenGL's initial state, as far as scenes change it.
    enabled, values, shader, bound, textures, unit = set(), {}, {}, {}, {}, 0
    combiners, vertex, vertices = Combiners(constants), {"coordinates": [None] * 4}, []
    whole = lambda words: tuple(int(word, 16) for word in words)
    numbers = lambda words: tuple(single(word) for word in words)
    is_enabled = lambda name, of=None: (constants[name], of) in enabled
    per_unit = {constants["TEXTURE_2D"], constants["TEXTURE_CUBE_MAP"]}

    def state():
        found = {key: dict(plain) if isinstance(plain, dict) else plain for key, plain in PLAIN.items()}
        for at in range(4):
            for target in sorted(per_unit):
                if (target, at) in enabled:
                    name = bound[at, target]
                    parameter = lambda word: textures[name].get(constants[word])
                    assert parameter("TEXTURE_MIN_FILTER") == parameter("TEXTURE_MAG_FILTER")
                    if parameter("TEXTURE_COMPARE_MODE") is not None:
                        assert parameter("TEXTURE_COMPARE_MODE") == constants["COMPARE_R_TO_TEXTURE"]
                    found["units"][at] = [target, name, *map(parameter, ("TEXTURE_MIN_FILTER", "TEXTURE_WRAP_S", "TEXTURE_WRAP_T"))]
                    taps = parameter("TEXTURE_MAX_ANISOTROPY_EXT")
                    found["units"][at] += [None if taps == 1 else taps, parameter("TEXTURE_COMPARE_FUNC")]
        if is_enabled("TEXTURE_SHADER_NV"):
            found["shader"] = dict(shader)
        mode = values.get(("environment", 0))
        found["environment"] = None if mode == constants["MODULATE"] else (0, constants["TEXTURE_ENV_MODE"], mode)
        found["mask"] = tuple(int(word) for word in values["ColorMask"])
        if is_enabled("SCISSOR_TEST"):
            x, y, width, rows = map(int, values["Scissor"])
            found["scissor"] = (x, height - y - rows, width, rows)
        if is_enabled("ALPHA_TEST"):
            function, reference = values["AlphaFunc"]
            found["alpha_test"] = (int(function, 16), round(255 * float(reference)))
        if is_enabled("BLEND"):
            found["blend"] = whole(values["BlendEquation"] + values["BlendFunc"])
        if is_enabled("DEPTH_TEST"):
            found["depth"] = (int(values["DepthFunc"][0], 16), int(values["DepthMask"][0]))
        if is_enabled("POLYGON_OFFSET_FILL"):
            found["offset"] = numbers(values["PolygonOffset"])
        if is_enabled("STENCIL_TEST"):
            function, reference, mask = values["StencilFunc"]
            found["stencil_test"] = (int(function, 16), int(reference), int(mask, 16), *whole(values["StencilMask"] + values["StencilOp"]))
        if is_enabled("FOG"):
            fog = lambda name: values["fog", constants[name]][0]
            assert fog("FOG_COORDINATE_SOURCE") == constants["FOG_COORDINATE"]
            names = ("FOG_START", "FOG_END") if fog("FOG_MODE") == constants["LINEAR"] else ("FOG_DENSITY",)
            found["fog"] = (fog("FOG_MODE"), *map(fog, names))
        found["color_sum"], found["depth_clamp"] = is_enabled("COLOR_SUM"), is_enabled("DEPTH_CLAMP")
        return found

    for line in path.read_text().splitlines():
        name, *words = line.split(" ")
        combiners.call(name, words)
        if name == "ActiveTexture":
            unit = int(words[0], 16) - constants["TEXTURE0"]
        elif name in ("Enable", "Disable"):
            what = int(words[0], 16)
            (enabled.add if name == "Enable" else enabled.discard)((what, unit if what in per_unit else None))
        elif name == "BindTexture":
            bound[unit, int(words[0], 16)] = int(words[1])
            textures.setdefault(int(words[1]), {})
        elif name == "TexParameteri":
            target, parameter, value = whole(words)
            textures[bound[unit, target]][parameter] = value
        elif name in ("TexEnvi", "TexEnviv", "TexEnvfv"):
            target, parameter = whole(words[:2])
            if target == constants["TEXTURE_SHADER_NV"]:
                got = numbers(words[2:5]) if name == "TexEnvfv" else whole(words[2:])
                shader[unit, parameter] = got
            else:
                values["environment", unit] = int(words[2], 16)
        elif name == "Fogfv":
            values["fog", int(words[0], 16)] = numbers(words[1:])
        elif name == "Clear":
            mask = int(words[0], 16)
            if mask == constants["COLOR_BUFFER_BIT"]:
                yield "clear", tuple(round(255 * float(word)) for word in values["ClearColor"])
            elif mask == constants["DEPTH_BUFFER_BIT"] | constants["STENCIL_BUFFER_BIT"]:
                # Both are written wherever they are not masked.
                assert values["DepthMask"] == ["1"] and values["StencilMask"] == ["ff"]
                yield "clear_depth", (round(16777215 * float(values["ClearDepth"][0])), int(values["ClearStencil"][0]))
        elif name == "Color4ub":
            vertex["color"] = tuple(map(int, words))
        elif name == "SecondaryColor3ub":
            vertex["secondary"] = tuple(map(int, words))
        elif name == "FogCoordf":
            vertex["fog"] = single(words[0])
        elif name == "TexCoord4f":
            vertex["coordinates"][0] = numbers(words)
        elif name == "MultiTexCoord4f":
            vertex["coordinates"][int(words[0], 16) - constants["TEXTURE0"]] = numbers(words[1:])
        elif name == "Vertex4f":
            full = {"secondary": None, "fog": None, **vertex}
            vertices.append({**full, "coordinates": list(vertex["coordinates"]), "position": numbers(words)})
        elif name == "End":
            yield "draw", (state(), comparable(combiners.state), vertices)
            vertices = []
        else:
            values[name] = words


def same(expected, got):
    """Whether two draws or clears are the same; positions may differ in their last bits, which C rounds as it goes."""
    if expected is None or got is None or expected[0] != "draw" or got[0] != "draw":
        return expected == got
    (*state, vertices), (*called_state, called_vertices) = expected[1], got[1]
    if state != called_state or len(vertices) != len(called_vertices):
        return False
    near = lambda a, b, w: all(abs(n - m) <= 1e-6 * max(1, abs(n), abs(w)) for n, m in zip(a, b))
    return all(
        {**a, "position": None} == {**b, "position": None} and near(a["position"], b["position"], a["position"][3])
        for a, b in zip(vertices, called_vertices)
    )


def check_scene(pack, recorded, name, constants):
    """Compares the calls of a scene with its lines."""
    lines = (pack / "scenes" / f"{name}.scene.txt").read_text().splitlines()
    height = next(int(line.split(" ")[2]) for line in lines if line.startswith("size "))
    wanted = described_scene(pack, name, constants)
    steps = 0
    for steps, (expected, got) in enumerate(zip_longest(wanted, called_scene(recorded, height, constants)), 1):
        if not same(expected, got):
            print(f"{name}: step {steps} is not what the scene says:\n  {str(expected)[:2000]}\n  {str(got)[:2000]}")
            return 1
    print(f"{name}: {steps} clears and draws called as the scene says")
    return 0 if steps > 1 else 1


def main():
    pack, recorded, unit = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]
    constants = registry()
    wrong = wrong_constants(constants)
    if wrong:
        print(f"constants that are not those of OpenGL: {' '.join(wrong)}")
        return 1
    if (pack / "scenes" / f"{unit}.scene.txt").exists():
        return check_scene(pack, recorded, unit, constants)
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
