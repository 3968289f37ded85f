#!/usr/bin/env python3
"""--gi auto of the programs: automatic.py VOLGI SOURCE_DIR [VOLGI_DEMO].

Says what it chose and why in two lines and in --stats; what it chose makes the same picture when it is asked for by hand;
bad budgets are one line and exit code 2; times of this device, where there are any, are gone by.
"""
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

failures = []


def check(holds, text):
    if not holds:
        failures.append(text)


def main():
    volgi, source = sys.argv[1], Path(sys.argv[2])
    demo = sys.argv[3] if len(sys.argv) > 3 else None
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        clean = {**os.environ, "XDG_DATA_HOME": str(work / "data"), "XDG_CONFIG_HOME": str(work / "config")}

        def run(*command):
            return subprocess.run([str(c) for c in command], capture_output=True, text=True, env=clean, timeout=120)

        scene = source / "data/cornell.glb"
        small = ["--size", "48x48", "--light", "indirect"]

        for words in (["abc"], ["-3%"], ["0ms"], ["0%"], ["50"], [], ["3%", "--quality", "fine"], ["3%", "--light", "direct"]):
            asked = ["--gi", "auto"] + ([f"--budget={words[0]}"] if words else []) + words[1:]
            done = run(volgi, "render", scene, "-o", work / "no.exr", *asked)
            check(done.returncode == 2 and len(done.stderr.splitlines()) == 1, f"{words}: {done.returncode}: {done.stderr}")
            check(not (work / "no.exr").exists(), f"{words}: a picture")
        done = run(volgi, "render", scene, "-o", work / "no.exr", "--budget", "50ms")
        check(done.returncode == 2 and "--gi auto" in done.stderr, f"--budget alone: {done.stderr}")

        done = run(volgi, "render", scene, "-o", work / "a.exr", *small, "--gi", "auto", "--budget", "7%", "--explain",
                   "--stats", work / "a.json")
        check(done.returncode == 0, f"auto: {done.stderr}")
        said = [line for line in done.stdout.splitlines() if line.startswith("auto: ")]
        stats = json.loads((work / "a.json").read_text())["auto"]
        chosen = stats["chosen"]
        check(len(said) == 2 and " ".join(chosen) in said[0] and "7 %" in said[0], f"auto says {said}")
        check("volgi calibrate" in said[1], f"auto does not say whose times: {said[1:]}")
        check(stats["reached"] and not stats["calibrated"], f"stats: {stats}")
        rejected = [line for line in done.stdout.splitlines() if re.search(r" ms +\S+ %  \w", line)]
        check(len(rejected) == len(stats["settings"]) - 1, f"--explain: {len(rejected)} of {len(stats['settings'])}")
        by_hand = run(volgi, "render", scene, "-o", work / "b.exr", *small, *chosen)
        check(by_hand.returncode == 0, by_hand.stderr)
        check((work / "a.exr").read_bytes() == (work / "b.exr").read_bytes(), f"{chosen} by hand is another picture")

        done = run(volgi, "render", scene, "-o", work / "c.exr", "--size", "16x16", "--gi", "auto", "--budget", "0.001ms")
        check(done.returncode == 0 and "nothing keeps 0.001 ms; nearest" in done.stdout, f"out of reach: {done.stdout}{done.stderr}")

        # A device that takes ten times as long has to do with less.
        device = json.loads((work / "a.json").read_text())["device"]
        front = json.loads((source / "data/report/front.json").read_text())
        cornell = next(s for s in front["scenes"] if s["name"] == "cornell")
        times = [{"scene": "cornell", "setting": s["name"], "ms": 10 * p["ms"], "large_ms": p["large_ms"] and 10 * p["large_ms"]}
                 for s, p in zip(front["settings"], cornell["points"]) if p["ms"]]
        file = work / "data/volgi/times" / (re.sub(r"[^A-Za-z0-9]", "-", device) + ".json")
        file.parent.mkdir(parents=True)
        file.write_text(json.dumps({"volgi_times": 1, "device": device, "machine": "m", "date": "then", "times": times}))
        done = run(volgi, "render", scene, "-o", work / "d.exr", *small, "--gi", "auto", "--budget", "7%", "--stats", work / "d.json")
        slow = json.loads((work / "d.json").read_text())["auto"]
        check("measured on this device, then" in done.stdout and slow["calibrated"], f"calibrated: {done.stdout}")
        for before, after in zip(stats["settings"], slow["settings"]):
            ratio = after["ms"] / before["ms"]
            check(9.9 < ratio < 10.1, f"{after['options']}: {ratio} times as long")
        file.write_text("{")
        done = run(volgi, "render", scene, "-o", work / "e.exr", *small, "--gi", "auto", "--budget", "7%")
        check(done.returncode == 3 and len(done.stderr.splitlines()) == 1, f"bad times: {done.stderr}")
        file.unlink()

        if demo:
            done = run(demo, scene, "--headless", "--no-settings", "--size", "48x48", "-o", work / "f.png", "--gi", "auto",
                       "--budget", "100ms")
            said = [line for line in done.stdout.splitlines() if line.startswith("auto: ")]
            check(done.returncode == 0 and len(said) == 2 and (work / "f.png").exists(), f"demo: {done.stdout}{done.stderr}")
            done = run(demo, scene, "--headless", "--no-settings", "-o", work / "g.png", "--gi", "auto", "--budget", "x")
            check(done.returncode == 2 and len(done.stderr.splitlines()) == 1, f"demo: {done.stderr}")
    print("\n".join(failures) or "auto holds")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
