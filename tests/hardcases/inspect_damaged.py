#!/usr/bin/env python3
"""volgi inspect on damaged files: an answer and a documented exit code, never a crash. 200 mutations; 2000 with VOLGI_LONG.

inspect_damaged.py VOLGI SOURCE_FOLDER
"""
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

volgi, source = sys.argv[1], pathlib.Path(sys.argv[2])
mutations = 2000 if "VOLGI_LONG" in os.environ else 200


def run(*arguments):
    return subprocess.run([str(a) for a in arguments], capture_output=True, text=True, errors="replace", timeout=120)


def damaged(good, random):
    bad = bytearray(good)
    kind = random.randrange(3)
    if kind == 0:
        for _ in range(random.randrange(1, 9)):
            bad[random.randrange(len(bad))] = random.randrange(256)
    elif kind == 1:
        at = random.randrange(len(bad) - 8)
        bad[at:at + 8] = random.randbytes(8)
    else:
        del bad[random.randrange(len(bad)):]
    return bytes(bad)


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    made = run(volgi, "export", source / "data/cornell.glb", "-o", folder / "ours.vdb", "--grid", "8", "--quiet")
    assert made.returncode == 0, made.stderr
    files = [folder / "ours.vdb"]
    if shutil.which("vdb_tool"):
        made = run("vdb_tool", "-sphere", "dim=24", "-write", folder / "sphere.vdb")
        assert made.returncode == 0, made.stderr
        files.append(folder / "sphere.vdb")
    random = random.Random(4)
    codes = {}
    for good in files:
        assert run(volgi, "inspect", good).returncode == 0
        content = good.read_bytes()
        for i in range(mutations):
            (folder / "bad.vdb").write_bytes(damaged(content, random))
            result = run(volgi, "inspect", folder / "bad.vdb", "--json")
            codes[result.returncode] = codes.get(result.returncode, 0) + 1
            assert result.returncode in (0, 3, 5), (good, i, result.returncode, result.stderr)
            if result.returncode != 0:
                assert "bad.vdb" in result.stderr and result.stderr.count("\n") == 1, result.stderr
    print(f"{len(files)} files, exit codes {codes}")
