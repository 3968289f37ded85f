#!/usr/bin/env python3
"""Two workers make one report, and one of them is killed: the same points. shared_report.py VOLGI SOURCE_FOLDER.

The figures of every point are those of a report that one process has made, to the last digit, and each point is measured
once. Exit code 77 without OpenGL.
"""
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

failures = []


def check(holds, text):
    if not holds:
        failures.append(text)


def points_of(folder):
    lines = [json.loads(line) for line in (folder / "points.jsonl").read_text().splitlines() if line]
    return {p["key"]: p for p in lines}, len(lines)


def holder(claims):
    """The process that a claim on a point names."""
    for claim in claims.glob("*.claim"):
        try:
            return int(claim.read_text().split()[1])
        except (OSError, IndexError):
            continue
    return None


def main():
    volgi, source = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()
    tiny = source / "tests/apps/report/tiny.json"
    with tempfile.TemporaryDirectory() as name:
        alone, shared = Path(name) / "alone", Path(name) / "shared"
        command = [volgi, "report", "--data", str(source / "data"), "--sweep", str(tiny), "--quiet", "-o"]
        result = subprocess.run(command + [str(alone)], capture_output=True, text=True)
        if result.returncode == 4:
            print(f"no OpenGL: {result.stderr}")
            sys.exit(77)
        check(result.returncode == 0 and not result.stderr, f"alone: {result.stderr}")

        first = subprocess.Popen(command + [str(shared)], stderr=subprocess.PIPE, text=True)
        points = shared / "points.jsonl"
        while first.poll() is None and not (points.exists() and points.read_text().count("\n") >= 2):
            time.sleep(0.005)
        second = subprocess.Popen(command + [str(shared)], stderr=subprocess.PIPE, text=True)
        deadline = time.time() + 60
        while holder(shared / "claims") != first.pid and first.poll() is None and time.time() < deadline:
            time.sleep(0.001)
        os.kill(first.pid, signal.SIGKILL)
        check(first.wait() == -signal.SIGKILL, "the first worker had finished before it could be killed")
        _, errors = second.communicate(timeout=240)
        check(second.returncode == 0 and not errors, f"second: {errors}")

        expected, _ = points_of(alone)
        got, lines = points_of(shared)
        check(got.keys() == expected.keys(), f"{len(got)} points, not {len(expected)}")
        check(lines == len(got), f"{lines} lines for {len(got)} points: some were measured twice")
        for key, point in expected.items():
            for figures in ("metrics", "one_bounce_metrics", "error"):
                check(got.get(key, {}).get(figures) == point.get(figures), f"{point['command']}: other {figures}")
        # Pages differ in times, which stand in many places; the order of points does not.
        order = [p["key"] for p in json.loads((shared / "report.json").read_text())["points"]]
        check(order == [p["key"] for p in json.loads((alone / "report.json").read_text())["points"]], "another order")
        check((shared / "index.html").is_file(), "no page")
        check(not list((shared / "claims").glob("*.claim")), "claims are left behind")
    print("\n".join(failures) or f"{len(expected)} points, the same")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
