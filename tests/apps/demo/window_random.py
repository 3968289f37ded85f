#!/usr/bin/python3
"""volgi-demo under random keys, pointer, commands, files and sizes on a display of its own, for MINUTES:

    window_random.py VOLGI_DEMO X11_HAND SOURCE_FOLDER MINUTES [SEED]

Ends with 0 where the program still answers at the end, quits with code 0, and OpenGL has reported no error. Prints what
it was given (a line each thousand inputs, or five minutes) and its memory, so that growth shows. The last inputs are
printed after a failure; the same seed gives the same inputs, as far as times allow.
"""
import collections
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time

from window_driver import Display, Given, Window

KEYS = (*"1234567890gfcbnlrty", "bracketleft", "bracketright", "minus", "equal", "BackSpace", "space", "period", "comma",
        "Delete", "Tab", "F2", "Escape", "F1", "v", "shift+v", "ctrl+z", "ctrl+shift+z", "ctrl+s", "ctrl+r", "ctrl+c",
        "ctrl+shift+c", "shift+g", "Up", "Down", "Left", "Right", "Return", *(f"shift+{k}" for k in range(1, 9)),
        "w", "a", "s", "d", "q", "e", "p", "F5", "F11")
RECIPES = "hybrid volume lpv val negative vpl lattice multires radiosity hierarchical area none".split()
SCENES = "cornell emissive room thin_wall corridor furnace occluder".split()
STAY_QUICK = ("grid 12", "set vpl.count=128", "set val.count=16", "set val.map=64", "set shadow.cube=128", "motion 10")


class Person:
    def __init__(self, window, seed):
        self.window, self.random = window, random.Random(seed)
        self.done, self.recent = collections.Counter(), collections.deque(maxlen=40)

    def key(self):
        name = self.random.choice(KEYS)
        self.window.tool("key", name)
        return name

    def pointer(self):
        x, y = self.random.randrange(320), self.random.randrange(200)
        self.window.pointer(x, y)
        return f"{x},{y}"

    def drag(self):
        button = self.random.choice((1, 1, 2, 3))
        self.pointer()
        self.window.tool("mousedown", button)
        for _ in range(self.random.randrange(1, 6)):
            self.pointer()
            time.sleep(0.02)
        self.window.tool("mouseup", button)
        return str(button)

    def wheel(self):
        button = self.random.choice((4, 5))
        self.window.tool("click", "--repeat", self.random.randrange(1, 5), button)
        return str(button)

    def vector(self, low, high):
        return ",".join(f"{self.random.uniform(low, high):.3g}" for _ in range(3))

    def line(self):
        r = self.random
        return r.choice((
            lambda: "recipe " + r.choice(RECIPES), lambda: f"preset {r.choice(('fast', 'default'))}",
            lambda: f"grid {r.choice((0, 1, 2, 7, 12, 20, 'auto', 100000))}", lambda: "backend " + r.choice(("cpu", "gpu", "auto")),
            lambda: "scheme " + r.choice(("ordinates", "conservative", "gaitatzes2010", "lpv2009", "none")),
            lambda: f"directions {r.choice((8, 24, 48, 9, 'auto'))}", lambda: f"bounces {r.choice((0, 1, 5, 'all', -1))}",
            lambda: "part " + r.choice(("full", "direct", "indirect")), lambda: f"light add {r.choice(('point', 'spot', 'sun'))}",
            lambda: f"light at {self.vector(-1, 2)}", lambda: f"light colour {self.vector(0, 1)}",
            lambda: f"light intensity {r.choice((0, 1e-6, 5, 1e9, 'x'))}", lambda: f"sky {self.vector(0, 1)}", lambda: "sky none",
            lambda: f"sky sun:{r.randrange(-5, 95)},{r.randrange(360)}", lambda: f"look {self.vector(-1, 3)} {self.vector(-1, 1)}",
            lambda: f"yfov {r.choice((0, 1, 40, 120, 179))}", lambda: f"exposure {r.choice((-30, 0, 3, 30, 'auto'))}",
            lambda: f"average {r.choice(('on', 'off', 2))}", lambda: "filter", lambda: f"time {r.uniform(-1, 9):.2f}", lambda: "play",
            lambda: f"reference {r.choice(('beside', 'alone', 'error', 'off'))}", lambda: f"wipe {r.random():.2f}",
            lambda: "append " + str(self.file()), lambda: "open " + str(self.file()), lambda: "open builtin:metaballs",
            lambda: f"set {r.choice(('vpl.count', 'val.count', 'glossy.rays', 'nothing.at_all'))}={r.choice((0, 1, 64, 100, 'x'))}",
            lambda: "reset", lambda: "undo", lambda: "redo", lambda: f"bookmark n{r.randrange(4)}", lambda: "bookmark next",
            lambda: "settings save", lambda: "texture " + r.choice(("albedo", "none")), lambda: "lobe", lambda: "voxels albedo",
            lambda: "".join(chr(r.randrange(33, 127)) for _ in range(r.randrange(1, 30)))))()

    def command(self):
        line = self.line()
        self.window.tool("key", "Escape")
        self.window.tool("key", "ctrl+p")
        time.sleep(0.1)
        self.window.tool("type", "--delay", "1", line)
        self.window.tool("key", "Return")
        return line

    def file(self):
        return Given.source / "data" / f"{self.random.choice(SCENES)}.glb"

    def drop(self):
        file = self.random.choice((self.file(), self.file(), Given.source / "README.md", Given.source / "data/none.glb"))
        self.window.hand("drop", file)
        return file.name

    def size(self):
        width, height = self.random.choice(((320, 200), (64, 48), (200, 320), (400, 300), (1, 1)))
        self.window.tool("windowsize", self.window.handle, width, height)
        return f"{width}x{height}"

    def desktop(self):
        what = self.random.choice(("minimise", "restore", "blur"))
        self.window.hand(what)
        if what != "restore":
            time.sleep(0.2)
            self.window.hand("restore")
            self.take_the_keyboard()
        return what

    def take_the_keyboard(self):
        """X refuses it to windows that are not there yet; without window manager nobody asks again."""
        for _ in range(100):
            try:
                self.window.tool("windowfocus", self.window.handle)
                return
            except subprocess.CalledProcessError:
                time.sleep(0.1)
        raise AssertionError("the window does not come back")

    def act(self):
        what = self.random.choices((self.key, self.pointer, self.drag, self.wheel, self.command, self.drop, self.size, self.desktop),
                                   (40, 10, 12, 6, 24, 2, 3, 3))[0]
        detail = what()
        self.done[what.__name__] += 1
        self.recent.append(f"{what.__name__} {detail}")

    def keep_quick(self):
        """Small pictures again, so that there are many of them."""
        for line in STAY_QUICK:
            self.window.tool("key", "Escape")
            self.window.tool("key", "ctrl+p")
            time.sleep(0.1)
            self.window.tool("type", "--delay", "1", line)
            self.window.tool("key", "Return")
        self.window.tool("windowsize", self.window.handle, 320, 200)


def resident_mib(window):
    return int(re.search(r"VmRSS:\s*(\d+) kB", pathlib.Path(f"/proc/{window.process.pid}/status").read_text())[1]) / 1024.0


def clean(folder):
    for file in folder.iterdir():
        if file.suffix in (".png", ".exr", ".sh", ".txt"):
            file.unlink()


def quit_slowly(window):
    """What was asked for before is answered first. @returns how many OpenGL errors there were."""
    end = time.monotonic() + 600.0
    while window.process.poll() is None and time.monotonic() < end:
        try:
            window.tool("key", "Escape", "ctrl+q")
        except subprocess.CalledProcessError:
            pass  # it has gone
        time.sleep(5.0)
    assert window.process.poll() == 0, f"it does not end, or with exit code {window.process.poll()}"
    return window.wait("end")["gl_errors"]


def run(folder, minutes, seed):
    window = Window(Display(), folder, Given.source / "data/cornell.glb")
    person = Person(window, seed)
    end, next_line, next_time = time.monotonic() + 60.0 * minutes, 0, 0.0
    try:
        while time.monotonic() < end:
            person.act()
            if window.process.poll() is not None:
                raise AssertionError(f"it ended with exit code {window.process.returncode}")
            count = sum(person.done.values())
            if count % 100 == 0:
                person.keep_quick()
                clean(folder)
            if count >= next_line or time.monotonic() >= next_time:
                window.read()
                frames = next((e["frames"] for e in reversed(window.events) if e["event"] == "frame"), 0)
                del window.events[:-200]
                print(f"{count} inputs, {frames} frames, {resident_mib(window):.0f} MiB", flush=True)
                next_line, next_time = count + 1000, time.monotonic() + 300.0
        errors = quit_slowly(window)
        print(f"seed {seed}, {minutes} minutes, {dict(person.done)}, OpenGL errors: {errors}")
        return 1 if errors else 0
    except BaseException:
        print("the last inputs:", *person.recent, sep="\n  ")
        time.sleep(2.0)  # until it has ended, if it does
        print("exit code:", window.process.poll())
        print(window.said()[-4000:])
        raise
    finally:
        window.close()


def main():
    if len(sys.argv) not in (5, 6):
        sys.exit(__doc__)
    Given.demo, Given.hand, Given.source = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3]).resolve()
    folder = pathlib.Path(tempfile.mkdtemp(prefix="volgi_random_"))
    try:
        sys.exit(run(folder, float(sys.argv[4]), int(sys.argv[5]) if len(sys.argv) == 6 else 21))
    finally:
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main()
