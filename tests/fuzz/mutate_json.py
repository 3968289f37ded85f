#!/usr/bin/env python3
"""Files of JSON like those of a folder, some value of another kind, or some bytes others: for a replay_NAME of any build.

mutate_json.py FOLDER OUT COUNT [SEED]
"""
import copy
import json
import pathlib
import random
import sys

VALUES = [None, True, False, 0, -1, 1, 2**31, 2**63, 2**64, -2**63, 1e308, 1e-320, -0.5, "", "x" * 500, "auto", "\n\x00\u2028", [], {}, [[]],
          [1, 2, 3], {"a": 1}, "NaN", 0.1]
random = random.Random(int(sys.argv[4]) if len(sys.argv) > 4 else 1)
seeds = [f.read_bytes() for f in sorted(pathlib.Path(sys.argv[1]).iterdir())]
out = pathlib.Path(sys.argv[2])


def places(value, place=()):
    yield place
    for key in value if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ():
        yield from places(value[key], place + (key,))


def at(value, place):
    for key in place:
        value = value[key]
    return value


def other_values(root):
    for _ in range(random.randrange(1, 4)):
        found = [p for p in places(root) if p]
        if not found:
            break
        place = random.choice(found)
        parent, kind = at(root, place[:-1]), random.random()
        if kind < 0.6:
            parent[place[-1]] = copy.deepcopy(random.choice(VALUES) if random.random() < 0.7 else at(root, random.choice(found)))
        elif kind < 0.8:
            del parent[place[-1]]
        elif isinstance(parent, dict):
            parent[random.choice(["name", "file", "", str(place[-1]) + "2"])] = copy.deepcopy(random.choice(VALUES))
    return json.dumps(root).encode()


def other_bytes(text):
    text = bytearray(text)
    for _ in range(random.randrange(1, 6)):
        where, kind = random.randrange(len(text) + 1), random.randrange(3)
        if kind == 0:
            text[where:where + 1] = bytes([random.randrange(256)])
        elif kind == 1:
            del text[where:where + random.randrange(1, 20)]
        else:
            text[where:where] = text[random.randrange(len(text) + 1):][:random.randrange(1, 40)]
    return bytes(text)


out.mkdir(parents=True, exist_ok=True)
for k in range(int(sys.argv[3])):
    seed = random.choice(seeds)
    try:
        mutated = other_values(json.loads(seed)) if random.random() < 0.75 else other_bytes(seed)
    except ValueError:
        mutated = other_bytes(seed)
    (out / f"{k:06}").write_bytes(mutated)
