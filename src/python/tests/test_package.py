"""The package against the program and against itself."""

import json
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

import ninebit

ROOT = Path(__file__).resolve().parents[3]
SCENES = ROOT / "vectors" / "scenes"
STONE = SCENES / "dot3" / "lit-stone.ron"


def program(*arguments, **options):
    return subprocess.run([sys.executable, "-m", "ninebit", *map(str, arguments)], capture_output=True, text=True, **options)


@pytest.fixture(scope="module")
def stone():
    return ninebit.Scene.load(STONE)


def test_a_frame_is_the_programs(stone, tmp_path):
    frame = stone.render()
    assert program("render", STONE, "-o", tmp_path / "a.png", "--raw", tmp_path / "a.raw", "--opaque").returncode == 0
    words = np.fromfile(tmp_path / "a.raw", "<u4").reshape(frame.words.shape)
    assert (frame.words == words).all()
    frame.save(tmp_path / "b.png")
    assert not ninebit.diff(tmp_path / "a.png", tmp_path / "b.png")
    assert frame._repr_png_().startswith(b"\x89PNG")
    scalar = stone.render(engine="scalar", threads=1)
    assert (scalar.words == frame.words).all() and (scalar.color == frame.color).all()


def test_depth_and_stencil_are_arrays():
    scene = ninebit.Scene(
        "(version: 1, profile: Nv2a, targets: [(width: 8, height: 4, depth: Z24S8, clear: (depth: 0.5, stencil: 3))], draws: [])"
    )
    frame = scene.render()
    assert frame.depth.shape == (4, 8) and (frame.depth == frame.depth[0, 0]).all() and abs(int(frame.depth[0, 0]) - (1 << 23)) <= 1 and (frame.stencil == 3).all()
    assert ninebit.Scene.load(STONE).render().depth is None


def test_planes_hold_what_traces_say(stone):
    names = ["stage0.rgb.AB.r", "unit0.weight_u", "texture0.rgb", "stage0.rgb.A", "stored.word", "b0"]
    planes = stone.planes(*names, ideal=True)
    for x, y in [(0, 0), (200, 300), (639, 479), (17, 411)]:
        trace = stone.trace(x, y)
        for name, step, channel in [
            ("stage0.rgb.AB.r", "stage0.rgb.AB.r", ()),
            ("texture0.rgb", "texture0.g", (1,)),
            ("stage0.rgb.A", "stage0.rgb.A.b", (2,)),
            ("stored.word", "stored.word", ()),
            ("b0", "b0", ()),
        ]:
            at = (y, x, *channel)
            said = trace.step(step)
            assert planes[name][at] == said["value"] and planes.present[name][at]
            assert planes.real(name)[at] == said["real"]
            if said["ideal"] is not None:
                assert planes.ideal[name][at] == said["ideal"]
    assert planes["stage0.rgb.AB.r"].dtype == np.int32 and planes["stored.word"].dtype == np.int64
    part = stone.planes("texture0.rgb", rectangle=(10, 20, 30, 40))["texture0.rgb"]
    assert (part == planes["texture0.rgb"][20:60, 10:40]).all()
    assert "stage0.rgb.AB.r" in stone.plane_names()


def test_the_program_writes_planes_for_numpy(stone, tmp_path):
    file = tmp_path / "planes.npz"
    assert program("planes", STONE, "stage0.rgb.AB", "stored.word", "b0", "-o", file, "--ideal").returncode == 0
    planes, written = stone.planes("stage0.rgb.AB", "stored.word", "b0", ideal=True), np.load(file)
    for name in planes:
        assert (written[name] == planes[name]).all() and written[name].dtype == planes[name].dtype
        assert np.array_equal(written[f"{name}.ideal"], planes.ideal[name], equal_nan=True)
    assert written["stage0.rgb.AB.per_one"] == 65025 and (written["b0.exponent"] < 0).any()


def test_set_changes_scene_and_family(stone, tmp_path):
    family = SCENES / "techniques" / "dot-product-texture-blending" / "height-field.ron"
    scene = ninebit.Scene.load(family)
    before = scene.render().words
    scene.set("names.vectors.sun", np.array([0.0, 0.0, 1.0]))
    changed = scene.render().words
    assert (before != changed).any()
    assert program("render", family, "--set", "names.vectors.sun=(0, 0, 1)", "-o", tmp_path / "a.png", "--raw", tmp_path / "a.raw").returncode == 0
    assert (np.fromfile(tmp_path / "a.raw", "<u4") == changed.ravel()).all()
    assert (ninebit.Scene.load(family).render().words == before).all()
    with pytest.raises(ninebit.SceneError) as caught:
        scene.set("names.vectors.son.x", 1)
    assert caught.value.code in ("NB0113", "NB0114")
    assert (scene.render().words == changed).all(), "a refused change leaves the scene as it was"
    other = stone.copy().set("draws[0].program.constants[0]", (0, 0, 0, 0))
    assert (other.render().words != stone.render().words).any()


def test_measures_are_the_programs():
    path = SCENES / "techniques" / "dot-product-texture-blending" / "height-field.ron"
    accuracy = ninebit.Scene.load(path).measure()
    document = json.loads(program("measure", path, "--format", "json").stdout)["scenes"][0]
    assert accuracy.errors.rms == document["errors"]["rms"]
    assert list(accuracy.causes) == [cause["cause"] for cause in document["causes"]]
    error = accuracy.error[np.isfinite(accuracy.error)]
    assert np.isclose(np.sqrt(np.mean(error**2)), accuracy.errors.rms, rtol=1e-9)


def test_comparisons_are_the_programs(stone):
    document = json.loads(program("compare", STONE, "--format", "json").stdout)
    comparison = stone.compare()
    assert comparison.channels["r"].rms == document["channels"]["r"]["rms"] and comparison.drawn == document["drawn"]
    finite = comparison.error[:, :, 0][np.isfinite(comparison.error[:, :, 0])]
    assert finite.size == comparison.channels["r"].count


def test_differences_are_exact():
    a = np.zeros((4, 6, 3), np.uint8)
    b = a.copy()
    b[1, 2] = (0, 9, 0)
    difference = ninebit.diff(a, b)
    assert (difference.different, difference.largest, bool(difference)) == (1, 9, True)
    assert difference.error[1, 2].tolist() == [0, 9, 0, 0]
    assert difference.regions == [ninebit.Region(2, 1, 1, 1, 1)] and not ninebit.diff(a, a)


def test_programs_run_on_arrays(stone):
    text = "{ rgb { spare0 = expand(tex0) . expand(col0); } } out.rgb = spare0; out.a = unsigned_invert(zero);"
    random = np.random.default_rng(7)
    texels = random.integers(0, 256, (2, 25, 4))
    colors = random.integers(0, 256, 4)
    found = ninebit.evaluate(text, {"texture0": texels, "primary": colors})
    assert found["fragment"].shape == (2, 25, 4) and found["fragment"].dtype == np.int16
    for at in [(0, 0), (1, 24)]:
        alone = ninebit.evaluate(text, {"texture0": texels[at], "primary": colors})
        assert (alone["fragment"] == found["fragment"][at]).all(), "block lanes are the scalar lane"
    words = {"NV_PRE_ALPHA": 1}
    with pytest.raises(ninebit.SceneError):
        ninebit.evaluate(words, {"texture0": texels})
    with pytest.raises(ninebit.NinebitError, match="holds -256 to 255"):
        ninebit.evaluate(text, {"texture0": np.full((1, 4), 256)})
    with pytest.raises(ninebit.NinebitError, match="last axis"):
        ninebit.evaluate(text, {"texture0": np.zeros((3, 5), int)})


def test_units_compute_what_vectors_hold(tmp_path):
    assert program("vectors", "export", "--unit", "dot-product", "--profile", "nv2a", "-o", tmp_path / "pack").returncode == 0
    table = next((tmp_path / "pack").rglob("dot-product.tsv")).read_text().splitlines()
    rows = [line.split("\t") for line in table if not line.startswith("#")]
    head, rows = rows[0], rows[1:50]
    unit = ninebit.units["dot-product"]
    halves = lambda text: int(2 * float(text)) if "." in text else int(text)
    inputs = {}
    for column in unit.inputs:
        values = [row[head.index(column.name)] for row in rows]
        inputs[column.name] = np.array([column.names.index(v) if column.names else int(v) for v in values])
    found = unit(inputs)
    for column in unit.results:
        if column.names is None:
            assert [int(row[head.index(column.name)]) for row in rows] == found[column.name].tolist()
    with pytest.raises(ninebit.NinebitError, match="has no input"):
        unit({"in.none": 1})
    assert len(ninebit.units) > 50 and "dot-product" in ninebit.units
    with pytest.raises(KeyError):
        ninebit.units["none"]


def test_scenes_are_made_of_data():
    random = np.random.default_rng(3)
    texels = random.integers(0, 256, (16, 16, 3), np.uint8)
    words = random.integers(0, 65536, (16, 16)).astype(np.uint16)

    def scene(texture):
        return ninebit.Scene({
            "profile": "Nv2a",
            "targets": [{"width": 16, "height": 16}],
            "textures": {"Texture": texture},
            "draws": [{
                "vertices": {"Window": {"position": np.array([(0, 0), (32, 0), (0, 32)]), "t0": np.array([(0, 0), (2, 0), (0, 2)])}},
                "textures": [{"texture": "Texture", "min_filter": "Nearest", "mag_filter": "Nearest"}],
                "program": {"CombinerText": ("out.rgb = tex0; out.a = unsigned_invert(zero);",)},
            }],
        })

    assert (scene(texels).render().color[:, :, :3] == texels).all()
    red = scene({"format": "R5G6B5", "source": words}).render().color[:, :, 0]
    assert (red >> 3 == words >> 11).all()
    with pytest.raises(ninebit.SceneError) as caught:
        ninebit.Scene({"profile": "Nv3a", "draws": []})
    assert caught.value.code == "NB0204"


def test_errors_say_code_place_and_help(stone):
    with pytest.raises(ninebit.SceneError) as caught:
        ninebit.Scene("(version: 1,\n profil: Nv2a, draw: [])")
    error = caught.value
    assert error.code == "NB0201" and error.place.endswith("scene.ron:2:2") and len(error.findings) == 2
    assert "did you mean `profile`" in str(error) and error.status == 3
    with pytest.raises(ninebit.SceneError) as caught:
        ninebit.Scene.load("nowhere.ron")
    assert (caught.value.code, caught.value.status) == ("NB0111", 4)
    with pytest.raises(ninebit.NinebitError) as caught:
        stone.planes("unit0.wight_u")
    assert caught.value.code == "NB1401" and "unit0.weight_u" in caught.value.help
    for call in [
        lambda: stone.trace(640, 0),
        lambda: stone.render(engine="none"),
        lambda: stone.render(policies={"CMB-3": "none"}),
        lambda: stone.render(threads=100_000),
        lambda: stone.planes("b0", rectangle=(639, 0, 2, 1)),
        lambda: stone.compare("none"),
        lambda: stone.measure(),
        lambda: ninebit.units["dot-product"](profile="nv40"),
    ]:
        with pytest.raises(ninebit.NinebitError) as caught:
            call()
        assert caught.value.help, str(caught.value)
    with pytest.raises(TypeError):
        ninebit.Scene({"profile": object()})


def test_the_lock_is_released():
    scene = ninebit.Scene.load(SCENES / "dot3" / "ceiling.ron")
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    scene.planes("stored.word", "texture0.rgb", threads=1)
    seen = counted[0]
    done.set()
    thread.join()
    assert seen > 1000


def test_the_program_runs():
    assert program("--version").stdout.strip() == f"ninebit {ninebit.__version__}"
    failed = program("render", "nowhere.ron", "-o", "a.png")
    assert failed.returncode == 4 and "NB0111" in failed.stderr


def test_the_page_runs(tmp_path, monkeypatch):
    """The code of docs/python.md, in the order of the page."""
    page, blocks, inside = (ROOT / "docs" / "python.md").read_text().splitlines(), [], False
    for line in page:
        if line.startswith("```"):
            inside = line == "```python"
        elif inside:
            blocks.append(line)
    code = "\n".join(blocks).replace('"vectors/', f'"{ROOT.as_posix()}/vectors/')
    monkeypatch.chdir(tmp_path)
    exec(compile(code, "docs/python.md", "exec"), {})
    assert (tmp_path / "frame.png").exists()


def test_the_notebook_runs(tmp_path):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    notebook = ROOT / "docs" / "notebooks" / "bump-map-error.py"
    assert len(notebook.read_text().splitlines()) <= 60
    picture = tmp_path / "chart.png"
    environment = {"MPLBACKEND": "Agg", "PATH": "", "MPLCONFIGDIR": str(tmp_path)}
    subprocess.run([sys.executable, str(notebook), str(picture)], cwd=ROOT, check=True, env=environment)
    assert picture.read_bytes().startswith(b"\x89PNG")
