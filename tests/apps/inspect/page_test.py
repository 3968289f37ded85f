#!/usr/bin/env python3
"""The page of `volgi inspect --html` in a real browser: page_test.py VOLGI SOURCE_FOLDER [FOLDER_FOR_PICTURES].

Exports a small volume, writes its page, opens it in headless Chromium by WebDriver, wide and as narrow as a phone, light
and dark, and uses it with real keys and a real pointer. Exit codes as those of ../report/page_test.py.
"""
import json
import math
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "report"))
from page_test import Browser, Driver, Page, check, driver, failures  # noqa: E402

RIGHT, PAGE_UP = "\ue014", "\ue00e"  # as WebDriver names the keys

SHOWN = """
const text = (id) => document.getElementById(id).textContent;
const pixels = (canvas) => {
  const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
  let sum = 0;
  const colours = new Set();
  for (let i = 0; i < data.length; i += 4) {
    sum = (sum * 31 + data[i] + 7 * data[i + 1] + 13 * data[i + 2]) % 1000003;
    if (i % 40 === 0) colours.add((data[i] << 16) + (data[i + 1] << 8) + data[i + 2]);
  }
  return [sum, colours.size];
};
setTimeout(() => arguments[arguments.length - 1]({
  slices: [...document.querySelectorAll('.slices canvas')].map(pixels),
  captions: [...document.querySelectorAll('.slices figcaption')].map((c) => c.textContent),
  readout: text('readout'), about: text('about'), histogram: text('histogram-text'),
  bars: pixels(document.getElementById('histogram')), orbit: pixels(document.getElementById('orbit')),
  drawn: Number(document.getElementById('orbit').dataset.drawn), width: document.documentElement.scrollWidth,
  grids: [...document.querySelector('[name=grid]').options].map((o) => o.value),
  direction: !document.querySelector('.direction').hidden,
  back: getComputedStyle(document.body).backgroundColor }), 80);
"""


def numbers(text):
    return [float(n) for n in re.findall(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?", text)]


def choose(browser, name, value):
    browser.run(f"""
        const field = document.querySelector('[name={name}]');
        field.value = {json.dumps(value)};
        for (const kind of ['input', 'change']) field.dispatchEvent(new Event(kind, {{ bubbles: true }}));
        arguments[arguments.length - 1](1);""")
    return browser.run(SHOWN)


def focus(browser, selector):
    browser.run(f"document.querySelector('{selector}').focus(); arguments[arguments.length - 1](1);")


def value_of(shown):
    """Of the readout: what stands between the place and the unit."""
    return numbers(shown["readout"].split(" m: ")[1])[:3]


def figures_agree(browser, grids, where):
    """The page counts and averages what `volgi inspect --json` does; of colours the page has the luminance."""
    for grid in grids:
        if len(grid["mean"]) != 1:
            continue
        shown = choose(browser, "grid", grid["name"])
        count, _, low, high, mean = numbers(shown["histogram"])[:5]
        check(count == grid["active_cells"], f"{where}: {grid['name']}: {count} cells")
        for got, stored in ((low, grid["minimum"][0]), (high, grid["maximum"][0]), (mean, grid["mean"][0])):
            check(math.isclose(got, stored, rel_tol=2e-3, abs_tol=1e-9), f"{where}: {grid['name']}: {got}, not {stored}")


def keys_and_pointer(browser, where):
    before = browser.run(SHOWN)
    focus(browser, ".slices figure:nth-child(3) canvas")
    browser.press(RIGHT)
    right = browser.run(SHOWN)
    old, new = numbers(before["readout"]), numbers(right["readout"])
    check(new[0] == old[0] + 1 and new[1:3] == old[1:3], f"{where}: the arrow key: {before['readout']}, {right['readout']}")
    browser.press(PAGE_UP)
    check(numbers(browser.run(SHOWN)["readout"])[2] == old[2] + 1, f"{where}: Page Up goes to the next slice")
    place = browser.run("""
        const canvas = document.querySelector('.slices figure:nth-child(3) canvas');
        canvas.scrollIntoView({ block: 'center' });
        const box = canvas.getBoundingClientRect();
        canvas.dispatchEvent(new PointerEvent('pointerdown', { bubbles: true, buttons: 1, clientX: box.left + 2, clientY: box.bottom - 2 }));
        arguments[arguments.length - 1](document.getElementById('readout').textContent);""")
    check(numbers(place)[:2] == [0, 0], f"{where}: the lower left corner is {place}")
    focus(browser, "#orbit")
    still = browser.run(SHOWN)
    browser.press(RIGHT, RIGHT)
    turned = browser.run(SHOWN)
    check(turned["orbit"][0] != still["orbit"][0], f"{where}: an arrow key turns the cells")
    browser.press("+")
    nearer = browser.run(SHOWN)
    check(nearer["orbit"][0] != turned["orbit"][0], f"{where}: + comes nearer")
    for what, events in (("a drag", "['pointermove', { buttons: 1, movementX: 40, movementY: 10 }]"), ("the wheel", "['wheel', { deltaY: 1 }]")):
        browser.run(f"""
            const [kind, more] = {events};
            const Kind = kind === 'wheel' ? WheelEvent : PointerEvent;
            document.getElementById('orbit').dispatchEvent(new Kind(kind, {{ bubbles: true, cancelable: true, ...more }}));
            arguments[arguments.length - 1](1);""")
        after = browser.run(SHOWN)
        check(after["orbit"][0] != nearer["orbit"][0], f"{where}: {what} in space")
        nearer = after


def sliders(browser, where):
    """One for each slice: it goes to its slice, by a value and by a key."""
    for axis, name in enumerate("xyz"):
        before = browser.run(SHOWN)
        moved = choose(browser, name, "2")
        check(numbers(moved["readout"])[axis] == 2, f"{where}: slider {name}: {moved['readout']}")
        check(moved["slices"][axis] != before["slices"][axis], f"{where}: slider {name} shows another slice")
        focus(browser, f"[name={name}]")
        browser.press(RIGHT)
        check(numbers(browser.run(SHOWN)["readout"])[axis] == 3, f"{where}: the arrow key on slider {name}")


def channels_and_directions(browser, where):
    fluence = choose(browser, "grid", "fluence")
    sh = choose(browser, "grid", "sh_00")
    for a, b in zip(value_of(fluence), value_of(sh)):  # the same cell: fluence is sqrt(4 pi) sh_00
        check(math.isclose(a, b * math.sqrt(4 * math.pi), rel_tol=2e-3), f"{where}: fluence {a}, sh_00 {b}")
    radiance = choose(browser, "grid", "radiance")
    check(radiance["direction"] and not fluence["direction"], f"{where}: only radiance has a direction")
    down = choose(browser, "height", "-90")
    up = choose(browser, "height", "90")
    # Of two bands, opposite directions sum to twice the mean over all: 2 fluence / 4 pi, where neither is cut at 0.
    for a, b, f in zip(value_of(down), value_of(up), value_of(fluence)):
        if min(a, b) > 0:
            check(math.isclose(a + b, f / (2 * math.pi), rel_tol=5e-3), f"{where}: {a} + {b} is not {f} / 2 pi")
    check(down["slices"] != up["slices"], f"{where}: the direction changes the picture")
    choose(browser, "grid", "fluence")
    red = choose(browser, "channel", "red")
    grey = choose(browser, "map", "grey")
    check(red["slices"] != grey["slices"], f"{where}: the colour map changes the picture")
    narrow = choose(browser, "high", str(numbers(red["histogram"])[4]))
    check(narrow["slices"] != grey["slices"] and narrow["bars"] != grey["bars"], f"{where}: the range changes both")
    check(choose(browser, "low", str(numbers(red["histogram"])[4] * 0.9))["drawn"] < narrow["drawn"], f"{where}: fewer cells above")


def use(browser, page, grids, where, width, dark):
    browser.post("url", url=page.as_uri())
    first = browser.run(SHOWN)
    check(first["grids"] == [g["name"] for g in grids if g["mean"]] + ["radiance"], f"{where}: grids {first['grids']}")
    check(len(first["slices"]) == 3 and all(colours > 5 for _, colours in first["slices"]), f"{where}: slices {first['slices']}")
    check("fluence" in browser.run("arguments[arguments.length - 1](document.querySelector('[name=grid]').value);"), f"{where}: first grid")
    check(first["drawn"] > 100 and first["orbit"][1] > 5, f"{where}: {first['drawn']} cells in space")
    check(first["bars"][1] > 1 and "cells" in first["histogram"], f"{where}: histogram {first['histogram']}")
    check(first["width"] <= width, f"{where}: {first['width']} pixels wide")
    check((numbers(first["back"])[0] < 100) == dark, f"{where}: background {first['back']}")
    figures_agree(browser, grids, where)
    keys_and_pointer(browser, where)
    sliders(browser, where)
    channels_and_directions(browser, where)
    console = [text for text in browser.console() if "willReadFrequently" not in text]  # of this test's own look at pixels
    check(not console, f"{where}: console: {console}")


def main():
    volgi, source = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()
    pictures = Path(sys.argv[3]) if len(sys.argv) > 3 else None
    driver()
    with tempfile.TemporaryDirectory() as name:
        vdb, html = Path(name) / "cornell.vdb", Path(name) / "cornell.html"
        subprocess.run([volgi, "export", str(source / "data/cornell.glb"), "-o", str(vdb), "--grid", "12", "--backend", "cpu", "--quiet"], check=True)
        subprocess.run([volgi, "inspect", str(vdb), "--html", "-o", str(html)], check=True)
        grids = json.loads(subprocess.run([volgi, "inspect", str(vdb), "--json"], check=True, capture_output=True, text=True).stdout)["grids"]
        page = Page()
        page.feed(html.read_text())
        check(not page.outside, f"the page asks for {page.outside}")
        with Driver() as connection:
            for dark in (False, True):
                for width in (1280, 390):
                    where = f"{width} pixels, {'dark' if dark else 'light'}"
                    with Browser(connection, width, dark) as browser:
                        use(browser, html, grids, where, width, dark)
                        if pictures:
                            time.sleep(0.2)
                            browser.picture(pictures / f"volume-{width}-{'dark' if dark else 'light'}.png")
    print("\n".join(failures) or "the page holds")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
