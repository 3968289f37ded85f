#!/usr/bin/env python3
"""What the machine does to the programs: killed, out of disk, out of memory, without a device, interrupted, without a
home or /tmp, with a clock that jumps. Each case ends with the documented exit code and whole files, or fails here.

faults.py VOLGI SOURCE_FOLDER PRELOAD [--demo VOLGI_DEMO] [--kills N] [--allocations N] [CASE...]

PRELOAD is the library of faults/preload.cpp. N kills at random moments of each of five commands (4: what the suite has
time for), and one at every write that these make. Cases that need what this machine does not have are skipped by name.
"""
import argparse
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

parser = argparse.ArgumentParser()
parser.add_argument("volgi")
parser.add_argument("source", type=pathlib.Path)
parser.add_argument("preload")
parser.add_argument("--demo")
parser.add_argument("--kills", type=int, default=4)
parser.add_argument("--allocations", type=int, default=12)
parser.add_argument("cases", nargs="*")
asked = parser.parse_intermixed_args()

SCENE = asked.source / "data/cornell.glb"
SMALL = ["--size", "16x16", "--grid", "8", "--vpls", "32", "--vals", "4", "--set", "val.map=32", "--set", "shadow.spot=64"]
random = random.Random(21)
failures, skipped = [], []


def fail(what):
    failures.append(what)
    print("FAILED", what, flush=True)


def skip(what):
    skipped.append(what)
    print("SKIPPED", what, flush=True)


def check(holds, what):
    if not holds:
        fail(what)


class Preloading(dict):
    """An environment with faults of faults/preload.cpp."""

    def __init__(self, **faults):
        super().__init__(os.environ, LD_PRELOAD=asked.preload, **{"VOLGI_FAULT_" + k: str(v) for k, v in faults.items()})


def run(program, *arguments, **options):
    options = {"capture_output": True, "text": True, "errors": "replace", "timeout": 120, **options}
    return subprocess.run([str(a) for a in (program, *arguments)], **options)


def volgi(*arguments, **options):
    return run(asked.volgi, *arguments, **options)


def must(result):
    if result.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, result.args))}: exit code {result.returncode}: {result.stderr}")
    return result


def refused(result, code, *words):
    """Ends with `code` and one line that has the words."""
    said = result.stderr
    check(result.returncode == code and said.count("\n") == 1 and all(w in said for w in words),
          f"{' '.join(map(str, result.args))}: exit code {result.returncode} instead of {code}, or not one line with "
          f"{words}: {said!r}")


def sanitized():
    return "libasan" in run("ldd", asked.volgi).stdout


def has_gl():
    return volgi("render", SCENE, "-o", "probe.exr", "--size", "8x8", "--gi", "none", "--quiet").returncode == 0


def mounted(folder, kind="tmpfs", options="size=64k"):
    """Whether a file system could be mounted there."""
    folder.mkdir(exist_ok=True)
    return run("mount", "-t", kind, "-o", options, kind, folder).returncode == 0


def commands_that_write():
    """(name, command line, the file that it leaves)"""
    demo = [asked.demo, SCENE, "--headless", "--no-settings", "--size", "16x16", "--gi", "none", "-o", "ignored.png"]
    return [
        ("export", [asked.volgi, "export", SCENE, "--grid", "12", "--quiet", "-o", "out.vdb"], "out.vdb"),
        ("export NanoVDB", [asked.volgi, "export", SCENE, "--grid", "12", "--quiet", "-o", "out.nvdb"], "out.nvdb"),
        ("reference", [asked.volgi, "reference", SCENE, "--size", "32x32", "--spp", "2", "--quiet", "-o", "ref.exr"], "ref.exr"),
    ] + ([
        ("render", [asked.volgi, "render", SCENE, *SMALL, "--quiet", "-o", "out.exr"], "out.exr"),
        ("report", [asked.volgi, "report", "--page-only", "--quiet", "-o", "report"], "report/index.html"),
    ] if GL else []) + ([
        ("demo settings", [*demo, "--do", "settings save settings.json"], "settings.json"),
    ] if GL and asked.demo else [])


def report_command():
    """Of twelve points that take moments."""
    pathlib.Path("sweep.json").write_text(json.dumps({
        "scenes": [], "size": "16x16", "frames": 1, "references": "--spp 2", "lights": ["indirect"],
        "techniques": [
            {"name": "path tracer", "command": "reference", "options": "--seed 2", "vary": {"--spp": list(range(2, 12))}},
            {"name": "none", "options": "--gi none"}]}))
    return [asked.volgi, "report", SCENE, "--sweep", "sweep.json", "--data", asked.source / "data", "--quiet", "-o", "report"]


def leftovers():
    return [f for f in pathlib.Path(".").rglob("*.tmp-*")]


# --- cases ----------------------------------------------------------------------------------------------------------


def killed():
    """Old file or new, never half: at random moments, and in place of every write."""
    kills = 0
    if GL:
        must(run(*report_command()))
    for name, command, target in commands_that_write():
        target = pathlib.Path(target)
        start = time.monotonic()
        must(run(*command))
        took_s = time.monotonic() - start
        new, old = target.read_bytes(), b"what was there before"

        def whole(how):
            found = target.read_bytes() if target.exists() else b""
            check(found in (old, new), f"{name} killed {how}: half a file, {len(found)} of {len(new)} bytes")

        for _ in range(asked.kills):
            target.write_bytes(old)
            moment_s = random.uniform(0, took_s)
            process = subprocess.Popen([str(a) for a in command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            try:
                process.wait(moment_s)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
            kills += 1
            whole(f"after {moment_s:.3f} s")
        if sanitized():
            continue
        # What is written is written in few pieces; a long command kills at all of them, the suite at the first and last.
        pieces, step = 0, 1
        while pieces < 400:
            pieces += step
            target.write_bytes(old)
            result = run(*command, env=Preloading(KILL=pieces))
            whole(f"in place of its write {pieces}")
            if result.returncode == 0:
                break
            check(result.returncode == -signal.SIGKILL, f"{name}: exit code {result.returncode} at write {pieces}")
            kills += 1
            if asked.kills < 20 and pieces >= 3:
                step = max(step * 2, 2)
        check(pieces < 400, f"{name}: no end of its writes")
        check(target.read_bytes() == new, f"{name}: another file after kills")
    print(f"  {kills} kills, {len(leftovers())} temporary files left")
    if sanitized():
        skip("kills in place of writes: the sanitizer wants to be loaded first")


def full_disk():
    """Exit code 6, one line, nothing partial: on disks of many sizes, by the limit of files and by a real one."""
    if GL:
        must(run(*report_command()))
    for name, command, target in commands_that_write():
        must(run(*command))
        size = pathlib.Path(target).stat().st_size
        os.remove(target)
        for most in sorted({0, 1, size // 2, size - 1} if asked.kills < 20 else {size * k // 40 for k in range(40)}):
            before = set(pathlib.Path(".").rglob("*"))
            refused(run("sh", "-c", 'trap "" XFSZ; exec "$@"', "sh", "prlimit", f"--fsize={most}", *command), 6)
            check(set(pathlib.Path(".").rglob("*")) == before, f"{name} with files of {most} bytes at most leaves something")
    on_a_full_disk()
    must(volgi("export", SCENE, "--grid", "8", "--quiet", "-o", "out.vdb"))
    with open("/dev/full", "w") as full:
        refused(run(asked.volgi, "inspect", "out.vdb", capture_output=False, stdout=full, stderr=subprocess.PIPE), 6,
                "standard output")


def on_a_full_disk():
    disk, here = pathlib.Path("disk").resolve(), os.getcwd()
    if os.geteuid() != 0 or not mounted(disk, options="size=2m"):
        return skip("a full disk: cannot mount a small one; the limit of files stands for it")
    try:
        if GL:
            shutil.copytree("report", disk / "report", ignore=shutil.ignore_patterns("index.html"))
        os.chdir(disk)
        with open("filler", "wb", buffering=0) as filler:
            try:
                while filler.write(b"x" * 4096) == 4096:
                    pass
            except OSError:
                pass
        before = sorted(pathlib.Path(".").rglob("*"))
        for name, command, target in commands_that_write():
            refused(run(*command), 6)
            check(sorted(pathlib.Path(".").rglob("*")) == before, f"{name} on a full disk leaves something")
    finally:
        os.chdir(here)
        must(run("umount", disk))


def no_memory():
    """Allocations that fail while a scene is read and its volume is computed: exit code 5."""
    if sanitized():
        return skip("failing allocations: the sanitizer has an allocator of its own")
    for command, target in ((["export", SCENE, "--grid", "8", "--quiet", "-o", "small.vdb"], "small.vdb"),
                            (["reference", SCENE, "--size", "8x8", "--spp", "1", "--quiet", "-o", "small.exr"], "small.exr")):
        faults = {"NEW_AFTER": "cornell.glb", "NEW_COUNT": "count.txt"}
        must(volgi(*command, env=Preloading(**faults)))
        count = int(pathlib.Path("count.txt").read_text())
        check(count > 200, f"{command[0]} makes only {count} allocations: are they counted?")
        os.remove(target)
        failed = 0
        for k in range(asked.allocations):
            at = 1 + k * count // asked.allocations
            result = volgi(*command, env=Preloading(NEW=at, NEW_AFTER="cornell.glb"))
            if result.returncode == 0:  # a library that has another way
                continue
            failed += 1
            refused(result, 5, "memory")
            check(not pathlib.Path(target).exists() and not leftovers(), f"{command[0]} leaves a file without memory")
        check(failed > asked.allocations // 2, f"{command[0]}: {failed} of {asked.allocations} allocations failed")
        print(f"  {command[0]}: {failed} of {asked.allocations} runs ended for want of memory, {count} allocations")
    # A limit of the address space, as batch systems set it.
    result = volgi("export", SCENE, "--grid", "256", "--quiet", "-o", "small.vdb", "--memory-limit", "10M")
    refused(result, 5, "--memory-limit")


def broken_shader():
    """A shader that does not compile names file and line."""
    if not (GL and asked.demo):
        return skip("a broken shader: needs OpenGL and volgi-demo")
    shutil.copytree(asked.source / "shaders", "shaders", dirs_exist_ok=True)
    file = pathlib.Path("shaders/screen/base/gbuffer.frag.glsl")
    lines = file.read_text().splitlines()
    at = next(i for i, line in enumerate(lines) if "void main" in line)
    lines.insert(at + 1, "  no_such_function();")
    file.write_text("\n".join(lines) + "\n")
    result = run(asked.demo, SCENE, "--headless", "--no-settings", "--size", "16x16", "--gi", "none", "--shaders", "shaders",
                 "-o", "out.png")
    refused(result, 4, "screen/base/gbuffer.frag.glsl", f"{at + 2}")
    shutil.rmtree("shaders")


def lost_context():
    """OpenGL's context lost at any moment: exit code 4, no picture."""
    if not GL or sanitized():
        return skip("a lost context: needs OpenGL, and no sanitizer before it")
    for moment in (1, 2, 3):
        result = volgi("render", SCENE, *SMALL, "--quiet", "-o", "lost.exr", env=Preloading(LOST=moment))
        refused(result, 4, "context is lost")
        check(not pathlib.Path("lost.exr").exists(), f"a picture of a context lost at look {moment}")


def interrupted_report():
    """SIGINT in a long report keeps what is finished, and the same command goes on from there."""
    if not GL:
        return skip("an interrupted report: needs OpenGL")
    shutil.rmtree("report", ignore_errors=True)
    points = pathlib.Path("report/points.jsonl")
    lines = lambda: points.read_bytes().count(b"\n") if points.exists() else 0
    process = subprocess.Popen([str(a) for a in report_command()], stderr=subprocess.PIPE, text=True)
    while lines() < 1 and process.poll() is None:
        time.sleep(0.005)
    process.send_signal(signal.SIGINT)
    process.communicate()
    kept = points.read_bytes()
    check(process.returncode == -signal.SIGINT, f"an interrupted report: exit code {process.returncode}")
    check(kept.count(b"\n") >= 1 and kept.endswith(b"\n"), f"{kept.count(10)} whole lines are kept")
    for line in kept.splitlines():
        json.loads(line)
    must(volgi("report", "--page-only", "--quiet", "-o", "report"))
    must(run(*report_command()))
    check(points.read_bytes().startswith(kept), "what was measured before is measured again")
    check(lines() > kept.count(b"\n"), "the report was over before it was interrupted")


def read_only_home():
    """Nothing needs a home that can be written."""
    home = pathlib.Path("home").resolve()
    if os.geteuid() != 0:
        home.mkdir()
        home.chmod(0o555)
    elif not mounted(home, options="ro"):
        return skip("a read-only home: cannot mount one")
    environment = {k: v for k, v in os.environ.items() if not k.startswith("XDG_")} | {"HOME": str(home)}
    try:
        must(volgi("export", SCENE, "--grid", "8", "--quiet", "-o", "home.vdb", env=environment))
        if GL:
            must(volgi("render", SCENE, *SMALL, "--quiet", "-o", "home.exr", env=environment))
        if GL and asked.demo:
            demo = [asked.demo, SCENE, "--headless", "--size", "16x16", "--gi", "none", "-o", "home.png"]
            must(run(*demo, env=environment))
            refused(run(*demo, "--do", f"settings save {home}/demo.json", env=environment), 6, "demo.json")
    finally:
        run("umount", home)


def no_tmp():
    """Nothing needs /tmp."""
    if os.geteuid() != 0 or run("unshare", "-m", "true").returncode != 0:
        return skip("no /tmp: cannot take it away")
    without_tmp = ["unshare", "-m", "sh", "-c", 'mount -t tmpfs -o ro,size=4k tmpfs /tmp && exec "$@"', "sh"]
    place = tempfile.mkdtemp(dir="/var/tmp")
    try:
        commands = [["export", SCENE, "--grid", "8", "--quiet", "-o", "tmp.vdb"]]
        if GL:
            commands.append(["render", SCENE, *SMALL, "--quiet", "-o", "tmp.exr"])
        for command in commands:
            must(run(*without_tmp, asked.volgi, *command, cwd=place))
        must(run(*without_tmp, asked.volgi, "inspect", "tmp.vdb", cwd=place))
    finally:
        shutil.rmtree(place)


def jumping_clock():
    """A clock of the day that jumps by months changes neither bytes nor who does what."""
    if sanitized():
        return skip("a clock that jumps: the sanitizer wants to be loaded first")
    jumping = Preloading(CLOCK=1)
    export = ["export", SCENE, "--grid", "8", "--quiet", "-o"]
    must(volgi(*export, "clock.vdb"))
    must(volgi(*export, "jumping.vdb", env=jumping))
    check(pathlib.Path("clock.vdb").read_bytes() == pathlib.Path("jumping.vdb").read_bytes(), "export: other bytes")
    if not GL:
        return
    film = ["render", "builtin:metaballs", "--size", "16x16", "--gi", "none", "--exposure", "0", "--animate", "0:1:4", "--quiet"]
    must(volgi(*film, "-o", "right.png"))
    must(volgi(*film, "-o", "jumping.png", "--share", "shared", env=jumping))
    for k in range(5):
        check(pathlib.Path(f"right.{k:04}.png").read_bytes() == pathlib.Path(f"jumping.{k:04}.png").read_bytes(),
              f"frame {k} is another picture")
    stats = must(volgi("render", SCENE, *SMALL, "--frames", "2", "--stats", "times.json", "-o", "out.exr", env=jumping))
    times = json.loads(pathlib.Path("times.json").read_text())
    check(0 < times["frame_ms"]["median"] < 60e3 and all(0 <= p["gpu_ms"] < 60e3 for p in times["passes"]),
          f"times of a clock that jumps: {times['frame_ms']}")


def any_threads():
    """1, 2 and 64 threads: the same bytes."""
    written = {}
    for threads in (1, 2, 64):
        lines = [(["export", SCENE, "--grid", "12", "--quiet"], "threads.vdb"),
                 (["reference", SCENE, "--size", "24x24", "--spp", "4", "--quiet"], "threads.exr")]
        if GL:
            lines += [(["render", SCENE, *SMALL, "--quiet", "--backend", backend], f"{backend}.exr") for backend in ("cpu", "gpu")]
        for command, out in lines:
            must(volgi(*command, "-o", out, "--threads", threads, env=dict(os.environ, LP_NUM_THREADS=str(min(threads, 16)))))
            written.setdefault(out, set()).add(pathlib.Path(out).read_bytes())
    for out, versions in written.items():
        check(len(versions) == 1, f"{out}: {len(versions)} different files with 1, 2 and 64 threads")


CASES = [killed, full_disk, no_memory, broken_shader, lost_context, interrupted_report, read_only_home, no_tmp,
         jumping_clock, any_threads]
unknown = set(asked.cases) - {case.__name__ for case in CASES}
if unknown:
    parser.error(f"no case {', '.join(sorted(unknown))}")
here = os.getcwd()
for name in ("volgi", "demo", "preload", "source"):
    value = getattr(asked, name)
    if value:
        setattr(asked, name, type(value)(os.path.abspath(value)))
SCENE = asked.source / "data/cornell.glb"
GL = None
for case in CASES:
    if asked.cases and case.__name__ not in asked.cases:
        continue
    start = time.monotonic()
    before = len(failures)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        if GL is None:
            GL = has_gl()
        try:
            case()
        except AssertionError as e:
            fail(f"{case.__name__}: {e}")
        finally:
            os.chdir(here)
    print(f"{case.__name__}: {'right' if len(failures) == before else 'WRONG'} ({time.monotonic() - start:.1f} s)", flush=True)
print(f"{len(failures)} wrong, {len(skipped)} skipped")
sys.exit(1 if failures else 0)
