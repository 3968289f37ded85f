#!/usr/bin/env python3
"""docs/demo.md has the tables that `volgi-demo --list` prints. demo_lists.py PROGRAM PAGE [--write]"""
import re
import subprocess
import sys

program, path = sys.argv[1:3]
with open(path, encoding="utf-8") as page:
    text = page.read()
expected = text
for name in ("keys", "commands", "views", "volume-keys", "volume-commands"):
    table = subprocess.run([program, "--list", name], check=True, capture_output=True, text=True).stdout
    block = re.compile(f"<!-- {name} -->.*?<!-- /{name} -->", re.DOTALL)
    if not block.search(expected):
        sys.exit(f"{path}: no place for {name}")
    expected = block.sub(lambda _: f"<!-- {name} -->\n{table}<!-- /{name} -->", expected)
if "--write" in sys.argv[3:]:
    with open(path, "w", encoding="utf-8") as page:
        page.write(expected)
elif text != expected:
    sys.exit(f"{path} is not what the program says; tests/docs/demo_lists.py {program} {path} --write mends it")
