#!/usr/bin/env python3
"""docs/results/hard-cases.md, from what the tests have measured (tests/support/hard_case.h).

page.py write FOLDER DEVICE   JSON lines of the tests → docs/results/hard-cases.json, and the page from it
page.py update FOLDER         the same of some tests alone: theirs replace those that they had
page.py check                 fails where the page is not that of the JSON, or a row of docs/hard-cases.md is on neither list
"""
import json
import pathlib
import re
import sys

DOCS = pathlib.Path(__file__).resolve().parents[2] / "docs"
FIGURES, PAGE, TABLE = DOCS / "results/hard-cases.json", DOCS / "results/hard-cases.md", DOCS / "hard-cases.md"

HEAD = """# Hard cases: what was measured

Written by the tests: `./run hardcases` measures every figure anew and writes this page. Every test compares its own limit and
figure with it, the figure to a tenth of the limit (`tests/support/hard_case.h`), and the test `docs.hard_cases` the page with the
figures. What the rows are is in [hard-cases.md](../hard-cases.md). Device: {device}.

"GPU" and "CPU" say where the volume is computed; recipes without a volume are the same on both. Figures are deviations from what is
right: 0 is right. A limit in bold is wider than what is asked for, the last column says why.
"""
# Rows of yes and no: what holds them, as far as there is a test.
WITHOUT = {
    "reciprocity": "limits 1e-6, in the tests of propagation",
    "void": "limits 1e-5, in the tests of propagation",
    "sign": "every mean and every error of a test fails where a pixel is negative or no number",
    "cold": "the same bytes",
    "degenerate": "the same picture, or a clear error",
    "hostile": "refused; also under [fuzzing](fuzzing.md)",
    "repeat": "the same bytes; for every recipe, and with passes that wait for one another: `All/Recipes.PassesDoNotRace/*`",
}
# Rows, or parts of them, that are asked for and have no test of their own yet.
MISSING = {
    "scale with its factors between": "1e-3 and 1e3 stand for all of 1e-3 … 1e3",
    "shift": "recipes without a grid have none to shift",
    "white": "`lpv`, which does not keep power: its figures would say nothing of white surfaces",
}


def rows_of_table():
    """(id, tests) in the table's order."""
    cases = TABLE.read_text().split("\n## Cases\n")[1].split("\n## ")[0]
    rows = {}
    for line in cases.splitlines():
        cells = [c.strip() for c in line.strip("|").split("|")]
        if line.startswith("| ") and len(cells) >= 4 and cells[0] not in ("id", "---"):
            rows.setdefault(cells[0], []).append(cells[3])
    return rows


def number(value):
    return "0" if value == 0 else f"{value:.3g}" if value >= 1e-3 else f"{value:.1e}"


def page_of(figures):
    lines = [HEAD.format(device=figures["device"])]
    missed = [f for f in figures["figures"] if f["limit"] > f.get("asked", f["limit"])]
    lines.append(f"{len(figures['figures'])} figures, {len(missed)} with a wider limit than is asked for.\n")
    by_row = {}
    for f in figures["figures"]:
        by_row.setdefault(f["row"], []).append(f)
    for row, tests in rows_of_table().items():
        lines.append(f"## {row}\n")
        if row not in by_row:
            lines.append(f"{WITHOUT[row]}: {', '.join(tests)}\n")
            continue
        lines += ["| case | volume | measured | limit | asked | test | cause |", "| --- | --- | --- | --- | --- | --- | --- |"]
        for f in by_row[row]:
            asked = f.get("asked", f["limit"])
            limit = number(f["limit"]) if f["limit"] <= asked else f"**{number(f['limit'])}**"
            unit = "" if f["unit"] == "%" else " " + f["unit"]
            percent = " %" if f["unit"] == "%" else ""
            lines.append(f"| {f['what']} | {f['on']} | {number(f['measured'])}{percent}{unit} | {limit} | {number(asked)} | `{f['test']}` | "
                         f"{f.get('cause', '')} |")
        lines.append("")
    lines += ["## No test yet\n", "| row | what |", "| --- | --- |"]
    lines += [f"| {row} | {what} |" for row, what in MISSING.items()]
    return "\n".join(lines) + "\n"


def measured_in(folder):
    found = {}
    for file in sorted(pathlib.Path(folder).glob("*.jsonl"), key=lambda f: f.stat().st_mtime_ns):
        for line in file.read_text().splitlines():
            f = json.loads(line)
            key = (f["row"], f["what"], f["on"])
            if key in found and found[key]["test"] != f["test"]:
                sys.exit(f"two tests have the figure {key}: {found[key]['test']} and {f['test']}")
            found[key] = f
    return found


def update(folder):
    new = measured_in(folder)
    old = json.loads(FIGURES.read_text())
    again = {(f["test"], f["on"]) for f in new.values()}
    kept = {(f["row"], f["what"], f["on"]): f for f in old["figures"] if (f["test"], f["on"]) not in again}
    write(kept | new, old["device"])


def write(found, device):
    figures = {"device": device, "figures": [found[key] for key in sorted(found)]}
    text = "{\n \"device\": " + json.dumps(device) + ",\n \"figures\": [\n"
    text += ",\n".join("  " + json.dumps(f, ensure_ascii=False, sort_keys=True) for f in figures["figures"]) + "\n ]\n}\n"
    FIGURES.write_text(text)
    PAGE.write_text(page_of(figures))
    print(f"{len(found)} figures on {PAGE}")


def check():
    figures = json.loads(FIGURES.read_text())
    faults = []
    if PAGE.read_text() != page_of(figures):
        faults.append(f"{PAGE} is not what {FIGURES} says; ./run hardcases writes both")
    rows = rows_of_table()
    with_figures = {f["row"] for f in figures["figures"]}
    faults += [f"row {row}: no figure and no words in {__file__}" for row in rows if row not in with_figures and row not in WITHOUT]
    faults += [f"row {row} is in no table of {TABLE}" for row in with_figures if row not in rows]
    faults += [f"row {f['row']}, {f['what']}: above its limit" for f in figures["figures"] if f["measured"] > f["limit"]]
    words = set(re.findall(r"\w+", "\n".join(p.read_text() for p in (DOCS.parent / "tests").rglob("*_test.cpp"))))
    faults += [f"there is no test {f['test']}" for f in figures["figures"] if f["test"].split(".")[1].split("/")[0] not in words]
    print("\n".join(faults) or f"{len(figures['figures'])} figures, page and table agree")
    return 1 if faults else 0


if __name__ == "__main__":
    if sys.argv[1:2] == ["write"] and len(sys.argv) == 4:
        write(measured_in(sys.argv[2]), sys.argv[3])
    elif sys.argv[1:2] == ["update"] and len(sys.argv) == 3:
        update(sys.argv[2])
    elif sys.argv[1:] == ["check"]:
        sys.exit(check())
    else:
        sys.exit(__doc__)
