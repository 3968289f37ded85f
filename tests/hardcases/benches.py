#!/usr/bin/env python3
"""volgi bench against-path-tracing, dong2009, nichols2010 and gpu, tiny: what they measure must hang together.

benches.py VOLGI SOURCE_FOLDER
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

NO_DEVICE, SKIPPED = 4, 77
volgi, source = sys.argv[1], pathlib.Path(sys.argv[2])


def bench(*arguments, code=0):
    run = subprocess.run([volgi, "bench", *arguments, "--data", source / "data"], capture_output=True, text=True)
    if run.returncode == NO_DEVICE and "VOLGI_REQUIRE_GL" not in os.environ:
        print("SKIPPED: no OpenGL:", run.stderr)
        sys.exit(SKIPPED)
    assert run.returncode == code, f"volgi bench {arguments}: exit code {run.returncode}, expected {code}: {run.stderr}"
    return run.stdout if code == 0 else run.stderr


def against_path_tracing(cache):
    quick = ["against-path-tracing", "--scene", "cornell", "--size", "48", "--frames", "1",
             "--reference-spp", "256", "--cache", cache]
    (first,) = json.loads(bench(*quick, "--json"))["against-path-tracing"]
    curve, hybrid = first["path_tracing"], first["hybrid"]
    assert [p["spp"] for p in curve] == [2**k for k in range(len(curve))], curve
    assert all(a["ms"] < b["ms"] for a, b in zip(curve, curve[1:])), curve
    assert curve[-1]["error_percent"] < 0.5 * curve[0]["error_percent"], curve
    # The curve ends where it first is below hybrid, and the time lies between the last two points.
    assert all(p["error_percent"] > hybrid["error_percent"] for p in curve[:-1]), (curve, hybrid)
    assert curve[-1]["error_percent"] <= hybrid["error_percent"], (curve, hybrid)
    assert first["bound"] == "exact" and curve[-2]["ms"] <= first["path_tracing_ms"] <= curve[-1]["ms"], first
    assert abs(first["ratio"] * hybrid["frame_ms"]["median"] / first["path_tracing_ms"] - 1) < 1e-9, first
    assert 1 < hybrid["error_percent"] < 20 and 0.9 < hybrid["energy"] < 1.1, hybrid
    assert 0 < first["reference"]["noise_percent"] < 0.5 * curve[0]["error_percent"], first["reference"]

    (kept,) = pathlib.Path(cache).iterdir()
    written = kept.stat().st_mtime_ns
    table = bench(*quick)
    assert (kept.stat().st_mtime_ns, len(list(pathlib.Path(cache).iterdir()))) == (written, 1), "reference traced again"
    assert f"error {hybrid['error_percent']:6.2f} %" in table and "frames of hybrid" in table, table


def dong2009():
    quick = ["dong2009", "--scene", "cornell", "--size", "48", "--frames", "1", "--curve-vpls"]
    result = json.loads(bench(*quick, "64", "--json"))["dong2009"]
    (times,), (curve,) = result["times"], result["curves"]
    assert times["paper"]["fps"] == 20.4 and times["vpls"] == 1024 and times["vals"] == 30, times
    for name, method in times["methods"].items():
        steps = method["steps_ms"]
        assert all(ms > 0 for ms in steps.values()), (name, steps)
        assert abs(sum(steps.values()) + method["rest_ms"] - method["frame_ms"]) < 1e-6, method
    assert list(times["methods"]) == sorted(times["methods"]) and len(times["methods"]) == 3, times

    assert [p["vals"] for p in curve["points"]] == [2, 4, 8, 15, 30, 60, 64], curve
    assert curve["exact"]["same_lights_percent"] == 0, curve
    last = {name: e["same_lights_percent"] for name, e in curve["points"][-1]["methods"].items()}
    assert len(last) == 3 and all(e < 0.5 * curve["no_visibility"]["same_lights_percent"] for e in last.values()), curve
    assert "one_bounce_percent" not in curve["exact"], "the reference of 192 x 192 says nothing about 48 x 48"
    table = bench(*quick, "4")
    assert "theirs: Cornell Box" in table and "geometry-aware blur" in table and "exact visibility" in table, table


def gpu(page):
    result = json.loads(bench("gpu", "--quick", "--json", "-o", page))["gpu"]
    assert result["device"] and result["gl_version"] and result["timer"] in ("gpu", "wall"), result
    assert result["skipped"] == [], result["skipped"]
    rows = {part: result[part] for part in ("copies", "error", "volume", "passes")}
    assert [len(rows[part]) for part in rows] == [1, 2, 1, 1], rows
    for part in rows.values():
        for row in part:
            assert all(value > 0 for value in row.values() if isinstance(value, (int, float))), row
    assert result["copy_gb_per_s"] == rows["copies"][0]["gb_per_s"], rows["copies"]

    (volume,), (frame,) = rows["volume"], rows["passes"]
    assert volume["grid"] == [16, 16, 16] and volume["converged"], volume
    # Passes are sweeps and what the solver does between them.
    assert volume["propagation_ms"] > 0.3 * volume["passes"] * volume["sweep_ms"], volume
    rate = volume["sweep_bytes"] / volume["sweep_ms"] / 1e6
    assert abs(volume["share_of_copy"] * result["copy_gb_per_s"] / rate - 1) < 1e-9, volume
    assert abs(sum(p["ms"] for p in frame["passes"]) / frame["all_passes_ms"] - 1) < 1e-9, frame
    assert {"propagation/propagate", "screen/base/compose"} <= {p["name"] for p in frame["passes"]}, frame
    hybrid, vpl = rows["error"]
    assert 1 < hybrid["error_percent"] < 20 and 0.9 < hybrid["energy"] < 1.1, hybrid
    assert vpl["error_percent"] > hybrid["error_percent"] and vpl["energy"] < hybrid["energy"], rows["error"]

    text = page.read_text(encoding="utf-8")
    assert [p.name for p in page.parent.iterdir()] == [page.name], "nothing half-written beside the page"
    assert text.startswith(f"# {result['device']}: "), text[:200]
    for part in ("Copying", "Frame time against error", "The volume", "Passes"):
        assert f"\n## {part}\n" in text, part
    assert "## Skipped" not in text and all(f"`{p['name']}`" in text for p in frame["passes"]), text


def gpu_without_time(page):
    """One second is less than a software rasterizer takes: what is left out has its name on the page."""
    result = json.loads(bench("gpu", "--quick", "--json", "--budget", "1", "-o", page))["gpu"]
    text = page.read_text(encoding="utf-8")
    for row in result["skipped"]:
        assert row["estimate_s"] > row["left_s"] >= 0 and f"- {row['part']}: {row['what']}, " in text, row
    if result["software"]:
        assert result["skipped"] and len(result["error"]) == 1, result


def nichols2010():
    result = json.loads(bench("nichols2010", "--quick", "--json"))["nichols2010"]
    three, four = result["chapter_3"], result["chapter_4"]
    rows = three["table_3_1"]["rows"]
    # A coarsest subsplat for each light where nothing is refined, more and more where it is.
    assert rows[0]["subsplats"] == 16**2 * 16**2, rows
    assert all(a["subsplats"] < b["subsplats"] for a, b in zip(rows, rows[1:])), rows
    (costs,) = four["table_4_1"]
    assert costs["gather_ms"]["gather / splat"] < costs["splat_ms"]["gather / splat"], costs
    assert 256 < costs["fragments"] <= 64**2, costs
    (errors,) = four["figure_4_9_and_bounds"]
    eye, light, both = (e["of_mean_percent"] for e in (errors["eye_space"][0]["rms"], errors["light_space"], errors["together"]))
    assert 0 < eye < 2 and eye < light and abs(both - light) < 2, errors
    assert all(row["median_percent"] > 0 for row in four["figure_4_5"]), four["figure_4_5"]


with tempfile.TemporaryDirectory() as folder:
    gpu(pathlib.Path(folder, "gpu.md"))
    gpu_without_time(pathlib.Path(folder, "gpu.md"))
with tempfile.TemporaryDirectory() as cache_folder:
    against_path_tracing(cache_folder)
dong2009()
nichols2010()
assert "no benchmark 'dong2010'" in bench("dong2010", code=2)
assert "atrium_of_nobody" in bench("dong2009", "--scene", "atrium_of_nobody", code=3)
