#!/usr/bin/env python3
"""The report's page in a real browser: page_test.py VOLGI SOURCE_FOLDER.

Makes a tiny report, follows points back to the commands that made them, opens the page in headless Chromium by
WebDriver, wide and as narrow as a phone, light and dark, and runs selftest.js there, which uses the page as a reader
would. Exit code 77 (skipped) without a browser, 1 where VOLGI_REQUIRE_GL says that nothing may be skipped.
"""
import base64
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from html.parser import HTMLParser
from pathlib import Path

failures = []


def check(holds, text):
    if not holds:
        failures.append(text)


def driver():
    found = shutil.which("chromedriver")
    if found is None:
        print("no chromedriver (Debian: chromium-driver): the page was not opened")
        sys.exit(1 if os.environ.get("VOLGI_REQUIRE_GL") else 77)
    return found


class Driver:
    """chromedriver on a port that it chooses: the few commands of WebDriver that are needed."""

    def __enter__(self):
        self.process = subprocess.Popen([driver(), "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        for line in self.process.stdout:
            match = re.search(r"started successfully on port (\d+)", line)
            if match:
                self.base = f"http://127.0.0.1:{match.group(1)}"
                return self
        raise RuntimeError("chromedriver did not start")

    def __exit__(self, *ignored):
        self.process.terminate()
        self.process.wait()

    def ask(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.base + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=120) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(json.load(error)["value"]["message"]) from error


class Browser:
    """A window of one width and colour scheme."""

    def __init__(self, connection, width, dark):
        arguments = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
                     "--hide-scrollbars", f"--blink-settings=preferredColorScheme={0 if dark else 1}"]
        metrics = {"width": width, "height": 900, "pixelRatio": 1, "touch": False}
        capabilities = {"goog:chromeOptions": {"args": arguments, "mobileEmulation": {"deviceMetrics": metrics}},
                        "goog:loggingPrefs": {"browser": "ALL"}, "timeouts": {"script": 60000}}
        self.connection = connection
        session = connection.ask("POST", "/session", {"capabilities": {"alwaysMatch": capabilities}})
        self.path = "/session/" + session["sessionId"]

    def __enter__(self):
        return self

    def __exit__(self, *ignored):
        self.connection.ask("DELETE", self.path)

    def post(self, command, **body):
        return self.connection.ask("POST", f"{self.path}/{command}", body)

    def run(self, script):
        return self.post("execute/async", script=script, args=[])

    def element(self, css):
        return self.post("element", using="css selector", value=css)

    def point_at(self, x, y):
        move = {"type": "pointerMove", "duration": 0, "x": round(x), "y": round(y)}
        self.post("actions", actions=[{"type": "pointer", "id": "mouse", "actions": [move]}])

    def press(self, *keys):
        strokes = [{"type": kind, "value": key} for key in keys for kind in ("keyDown", "keyUp")]
        self.post("actions", actions=[{"type": "key", "id": "keys", "actions": strokes}])

    def console(self):
        return [entry["message"] for entry in self.post("se/log", type="browser")]

    def picture(self, path):
        path.write_bytes(base64.b64decode(self.connection.ask("GET", self.path + "/screenshot")))


def commands_reproduce(volgi, folder, points):
    """The commands that a point names give its figures to the last digit."""
    for technique in ("hybrid", "path tracer"):
        point = next(p for p in points if p["technique"] == technique)
        for command in ("command", "compare"):
            words = [volgi, *shlex.split(point[command])[1:], "--json" if command == "compare" else "--quiet"]
            run = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=True)
        again = json.loads(run.stdout)[0]
        stored = {key: value for key, value in point["metrics"].items() if key != "rmse_pct_scaled"}
        check(stored == {key: again.get(key) for key in stored}, f"{point['command']} gives {again}, not {stored}")


class Page(HTMLParser):
    """What stands in the page before any script has run."""

    def __init__(self):
        super().__init__()
        self.rows, self.circles, self.pictures, self.tables, self.outside = [], 0, 0, 0, []

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.rows += [attributes["data-key"]] if tag == "tr" and "data-key" in attributes else []
        self.circles += tag == "circle"
        self.tables += tag == "table"
        self.pictures += tag == "img" and (attributes.get("src") or "").startswith("data:image/png;base64,")
        for name in ("src", "href"):
            value = attributes.get(name) or ""
            if re.match(r"(https?:)?//", value) or (tag in ("script", "link", "img") and value and not value.startswith("data:")):
                self.outside.append(value)


def without_script(html, points):
    page = Page()
    page.feed(html)
    check(sorted(page.rows) == sorted(p["key"] for p in points), "a table row for every point, without script")
    check(page.circles >= len(points), f"still plots have {page.circles} circles")
    check(page.pictures >= 5, f"only {page.pictures} pictures in the page")
    check(page.tables >= 6, f"only {page.tables} tables in the page")
    check(not page.outside, f"the page asks for {page.outside}")


LEFT = "\ue012"  # the arrow key, as WebDriver names it


def at_a_point(browser, where):
    """Points with a real pointer, then walks with real keys."""
    place = browser.run("""
        const canvas = document.querySelector('.light:not([hidden]) canvas');
        canvas.scrollIntoView({ block: 'center' });
        const box = canvas.getBoundingClientRect(), chart = Chart.getChart(canvas), e = chart.getDatasetMeta(0).data[0];
        arguments[arguments.length - 1]([box.left + e.x, box.top + e.y, chart.data.datasets[0].label]);""")
    browser.point_at(place[0], place[1])
    time.sleep(0.2)
    shown = browser.run("""
        const tip = Chart.getChart(document.querySelector('.light:not([hidden]) canvas')).tooltip;
        arguments[arguments.length - 1](tip.opacity > 0 ? tip.body.flatMap((b) => b.lines).join(' ') : '');""")
    check(place[2] in shown and " ms " in shown, f"{where}: pointing at a point of {place[2]} says '{shown}'")
    said = """arguments[arguments.length - 1](document.querySelector('.light:not([hidden]) .readout').textContent);"""
    browser.run("document.querySelector('.light:not([hidden]) canvas').focus(); arguments[arguments.length - 1](1);")
    first = browser.run(said)
    browser.press(LEFT)
    second = browser.run(said)
    check(" ms " in first and " ms " in second and first != second, f"{where}: the arrow key: '{first}', then '{second}'")


def with_script(page, points, pictures):
    test = (Path(__file__).parent / "selftest.js").read_text()
    with Driver() as connection:
        for dark in (False, True):
            for width in (1280, 390):
                where = f"{width} pixels, {'dark' if dark else 'light'}"
                with Browser(connection, width, dark) as browser:
                    browser.post("url", url=page.as_uri())
                    if pictures:
                        browser.picture(pictures / f"page-{width}-{'dark' if dark else 'light'}.png")
                    result = browser.run(test)
                    for text in result["failed"]:
                        check(False, f"{where}: {text}")
                    at_a_point(browser, where)
                    console = browser.console()
                check(not console, f"{where}: console: {console}")
                check(result["checks"] > 25, f"{where}: only {result['checks']} checks")
                check(result["width"] <= width, f"{where}: the page is {result['width']} pixels wide")
                check(result["dark"] == dark, f"{where}: background {result['background']}")
                check(result["points"] == sum("frame_ms" in p for p in points), f"{where}: {result['points']} points in plots")


def main():
    volgi, source = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()
    pictures = Path(sys.argv[3]) if len(sys.argv) > 3 else None  # a folder for pictures of the page, to look at
    driver()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        subprocess.run([volgi, "report", "-o", name, "--data", str(source / "data"), "--sweep",
                        str(source / "tests/apps/report/tiny.json"), "--quiet"], check=True)
        points = [json.loads(line) for line in (folder / "points.jsonl").read_text().splitlines()]
        commands_reproduce(volgi, folder, points)
        without_script((folder / "index.html").read_text(), points)
        with_script(folder / "index.html", points, pictures)
    print("\n".join(failures) or "the page holds")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
