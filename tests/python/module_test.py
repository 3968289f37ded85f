#!/usr/bin/env python3
"""The Python module against the commands: module_test.py VOLGI FOLDER_OF_THE_MODULE SOURCE_FOLDER."""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

command, folder, source = sys.argv[1:4]
sys.path.insert(0, folder)
import numpy as np  # noqa: E402
import volgi  # noqa: E402

CORNELL = str(Path(source) / "data/cornell.glb")


def channels(path):
    """R, G, B of an uncompressed look at an EXR, by OpenImageIO."""
    import OpenImageIO as oiio
    image = oiio.ImageInput.open(str(path))
    names = list(image.spec().channelnames)
    pixels = np.asarray(image.read_image(format="float"))
    return pixels[..., [names.index(c) for c in "RGB"]]


def run(*words):
    return subprocess.run([command, *words], check=True, capture_output=True, text=True).stdout


def main():
    with tempfile.TemporaryDirectory() as name:
        out = Path(name)
        scene = volgi.load(CORNELL, size=(48, 32))
        assert scene.name == "cornell" and scene.triangles > 10 and scene.lights == 1, scene.name

        # The command's picture, to the byte.
        for keywords, words in (({"gi": "none"}, ["--gi", "none"]),
                                ({"gi": "auto", "budget": "10%"}, ["--gi", "auto", "--budget", "10%"]),
                                ({"light": "indirect", "grid": 12, "vpls": 64, "set": {"val.map": 64}},
                                 ["--light", "indirect", "--grid", "12", "--vpls", "64", "--set", "val.map=64"])):
            picture = volgi.render(scene, **keywords)
            run("render", CORNELL, "--size", "48x32", *words, "-o", str(out / "a.exr"), "--quiet")
            same = channels(out / "a.exr")
            assert picture["color"].shape == (32, 48, 3)
            assert picture["color"].tobytes() == same.astype(np.float32).tobytes(), words
        assert set(picture["layers"]) == {"punctual_first", "punctual_higher"}, picture["layers"].keys()
        assert np.allclose(sum(picture["layers"].values()), picture["color"], rtol=1e-4, atol=1e-6), "layers sum to the picture"
        chosen = volgi.render(scene, gi="auto", budget="0.001ms")["auto"]
        assert not chosen["reached"] and chosen["chosen"][0] == "--gi", chosen
        assert "punctual_direct" in volgi.render(scene, gi="none")["layers"]

        # Its reference, and its figures.
        reference = volgi.reference(scene, spp=8)
        run("reference", CORNELL, "--size", "48x32", "--spp", "8", "-o", str(out / "r.exr"), "--quiet")
        assert reference["color"].tobytes() == channels(out / "r.exr").astype(np.float32).tobytes()
        assert reference["depth"].shape == (32, 48)
        run("render", CORNELL, "--size", "48x32", "--grid", "12", "-o", str(out / "b.exr"), "--quiet")
        full = volgi.render(scene, grid=12)
        figures = volgi.compare(reference["color"], full["color"], noise=reference["noise"])
        told = json.loads(run("compare", str(out / "r.exr"), str(out / "b.exr"), "--region", "all", "--json"))[0]
        for key in ("ratio", "rmse_pct", "rmse_pct_denoised"):
            assert abs(figures[key] - told[key]) < 1e-6 * abs(told[key]), (key, figures[key], told[key])
        assert volgi.compare(full["color"], full["color"])["max_absolute"] == 0

        # The volume: fluence is sqrt(4 pi) of the first coefficient, in the file as in the array.
        volume = volgi.volume(scene, vdb=str(out / "v.vdb"), grid=8)
        assert np.allclose(volume["fluence"], volume["sh"]["sh_00"] * np.sqrt(4 * np.pi), rtol=1e-5)
        grid = json.loads(run("inspect", str(out / "v.vdb"), "--json"))["grids"][0]
        assert np.allclose(grid["mean"], volume["fluence"].mean(axis=(0, 1, 2)), rtol=1e-4), grid["mean"]

        # Parameters, and what is refused.
        named = {p["name"]: p for p in volgi.parameters()}
        assert named["vpl.count"]["default"] == "1024" and named["vpl.count"]["help"], named["vpl.count"]
        for wrong in (lambda: volgi.render(scene, gi="nothing"), lambda: volgi.load("nowhere.glb"),
                      lambda: volgi.render(scene, gird=3), lambda: volgi.compare(full["color"], full["color"][:4])):
            try:
                wrong()
                raise AssertionError("was taken")
            except volgi.Error as error:
                assert str(error)
    print("the module agrees with the commands")


main()
