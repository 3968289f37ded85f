#!/usr/bin/python3
"""Every technique, backend and scheme, hashed: a change that is meant to be mechanical leaves the pixels as they are.

frozen_pictures.py VOLGI SOURCE_FOLDER             compares with frozen_pictures.json; 77 (skipped) on another machine
frozen_pictures.py VOLGI SOURCE_FOLDER --write     keeps what VOLGI makes now; a commit that does it says why

Hashes are of the float32 pixels at 64 x 64. They hold for one rasterizer and one set of CPU kernels (FMA rounds
otherwise), which the file names; what must hold everywhere is in the other tests, with tolerances.
"""
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

import OpenImageIO as oiio

NO_DEVICE, SKIPPED = 4, 77
volgi, source = sys.argv[1], pathlib.Path(sys.argv[2])
FILE = pathlib.Path(__file__).with_suffix(".json")
SCENES = {"cornell": "cornell", "emissive": "emissive"}


def cases():
    """name -> arguments of `volgi render`, the scene first."""
    all_cases = {}

    def add(scene, name, *arguments):
        all_cases[f"{scene} {name}"] = [str(source / f"data/{scene}.glb"), *arguments]

    for scene in SCENES:
        for gi in ("none", "vpl", "val"):
            add(scene, gi, "--gi", gi)
        for backend in ("gpu", "cpu"):
            add(scene, f"negative {backend}", "--gi", "negative", "--backend", backend)
            for scheme in ("ordinates", "conservative"):
                for gi in ("volume", "hybrid"):
                    add(scene, f"{gi} {backend} {scheme}", "--gi", gi, "--backend", backend, "--scheme", scheme)
            for scheme in ("gaitatzes2010", "lpv2009"):
                add(scene, f"volume {backend} {scheme}", "--gi", "volume", "--backend", backend, "--scheme", scheme)
    for light in ("direct", "indirect"):
        for gi in ("none", "volume", "vpl", "negative", "val", "hybrid"):
            add("emissive", f"{gi} {light}", "--gi", gi, "--light", light)
    for bounces in ("0", "1", "2"):
        for gi in ("volume", "hybrid"):
            add("emissive", f"{gi} bounces {bounces}", "--gi", gi, "--bounces", bounces)
    for name, value in (("vpl.flux", "1"), ("vpl.one_of", "1"), ("negative.method", "0"), ("negative.method", "1"),
                        ("gather.stride", "1"), ("val.shadow", "0"), ("val.shadow", "1"), ("val.interleave", "1"),
                        ("val.interleave", "8"), ("vpl.near", "0"), ("solver.cg", "0")):
        gi = {"vpl": "vpl", "gather": "vpl", "negative": "negative", "val": "val", "solver": "volume"}[name.split(".")[0]]
        if name == "vpl.near":
            gi = "val"
        add("cornell", f"{gi} {name}={value}", "--gi", gi, "--set", f"{name}={value}")
    add("cornell", "hybrid per light", "--gi", "hybrid", "--vpls-per-light", "200")
    return all_cases


def kernels():
    flags = set(re.search(r"^flags\s*:(.*)$", pathlib.Path("/proc/cpuinfo").read_text(), re.M).group(1).split())
    return [f for f in ("avx2", "fma", "avx512f", "avx512vl", "avx512dq", "avx512bw") if f in flags]


def render(arguments, folder, name):
    out, stats = folder / f"{name}.exr", folder / f"{name}.json"
    run = subprocess.run([volgi, "render", *arguments, "-o", out, "--size", "64x64", "--grid", "16", "--vpls", "256",
                          "--vals", "16", "--quiet", "--stats", stats], capture_output=True, text=True)
    if run.returncode == NO_DEVICE and "VOLGI_REQUIRE_GL" not in os.environ:
        print("SKIPPED: no OpenGL:", run.stderr)
        os._exit(SKIPPED)
    assert run.returncode == 0, f"volgi render {arguments}: exit code {run.returncode}: {run.stderr}"
    return out, json.loads(stats.read_text())["device"]


def pixel_hash(picture):
    return hashlib.sha256(oiio.ImageInput.open(str(picture)).read_image("float").tobytes()).hexdigest()[:24]


def main():
    every = cases()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        with ThreadPoolExecutor(2) as pool:
            results = list(pool.map(lambda k: render(every[k], folder, f"{list(every).index(k)}"), every))
        hashes = {k: pixel_hash(picture) for k, (picture, _) in zip(every, results)}
    made = {"device": results[0][1], "kernels": kernels(), "hashes": hashes}
    if "--write" in sys.argv:
        FILE.write_text(json.dumps(made, indent=1) + "\n")
        return 0
    kept = json.loads(FILE.read_text())
    if (kept["device"], kept["kernels"]) != (made["device"], made["kernels"]):
        print(f"SKIPPED: hashes are of {kept['device']} with {kept['kernels']}, this is {made['device']} with "
              f"{made['kernels']}")
        return SKIPPED
    changed = [k for k in every if kept["hashes"].get(k) != made["hashes"][k]]
    assert set(kept["hashes"]) == set(every), "the list of cases is another: --write"
    print(f"{len(every)} pictures, {len(changed)} changed", *changed, sep="\n  ")
    return 1 if changed else 0


if __name__ == "__main__":
    sys.exit(main())
