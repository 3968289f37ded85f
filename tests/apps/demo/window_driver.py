"""A display of its own (Xvfb), volgi-demo's window on it, its keys and pointer, what its --events say; and pictures."""
import ctypes
import json
import math
import os
import pathlib
import shutil
import signal
import struct
import subprocess
import tempfile
import time
import unittest
import zlib

LONGEST_S = float(os.environ.get("VOLGI_LONGEST_WAIT_S", 60.0))  # more on a machine that does something else


class Given:
    """The command line."""


def scene(name):
    return Given.source / "data" / f"{name}.glb"


# Pictures in a few hundredths of a second on a software rasterizer.
QUICK = ["--grid", "12", "--set", "vpl.count=128", "--set", "val.count=16", "--set", "val.map=64", "--set",
         "val.exact=2", "--set", "shadow.spot=256", "--set", "shadow.cube=128", "--set", "shadow.sun=256", "--set",
         "sky.parts=16", "--set", "sky.map=64", "--set", "sky.tolerance=0.2", "--set", "negative.count=32"]
# Each picture is rendered once, at its size.
STILL = {"progressive": False, "motion_fps": 0}
# Within the Cornell box, which fills the picture then.
INSIDE = "look 0,1,1.9 0,0.9,-1 60"


# --- pictures -------------------------------------------------------------------------------------------------------


class Picture:
    def __init__(self, width, height, rgb):
        self.width, self.height, self.rgb = width, height, rgb

    def part(self, left, top, right, bottom):
        """By shares of the size."""
        x0, x1 = round(left * self.width), round(right * self.width)
        y0, y1 = round(top * self.height), round(bottom * self.height)
        rows = [self.rgb[3 * (y * self.width + x0):3 * (y * self.width + x1)] for y in range(y0, y1)]
        return Picture(x1 - x0, y1 - y0, b"".join(rows))

    def spread(self):
        """Standard deviation of the bytes."""
        mean = sum(self.rgb) / len(self.rgb)
        return math.sqrt(sum((v - mean) ** 2 for v in self.rgb) / len(self.rgb))

    def distance(self, other):
        """Mean difference of the bytes."""
        assert (self.width, self.height) == (other.width, other.height)
        return sum(abs(a - b) for a, b in zip(self.rgb, other.rgb)) / len(self.rgb)


def read_ppm(data):
    magic, width, height, _ = data.split(None, 4)[:4]
    assert magic == b"P6"
    width, height = int(width), int(height)
    return Picture(width, height, data[-3 * width * height:])


def read_png(path):
    """Of 8 bits a channel, not interlaced."""
    data = pathlib.Path(path).read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", f"{path} is no PNG"
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", data[at + 8:at + 18])
        elif kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += length + 12
    assert depth == 8 and colour in (2, 6)
    channels = 3 if colour == 2 else 4
    raw, stride = zlib.decompress(packed), width * channels
    before, rows = bytearray(stride), []
    for y in range(height):
        kind = raw[y * (stride + 1)]
        row = bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for x in range(stride):
            left = row[x - channels] if x >= channels else 0
            up, corner = before[x], before[x - channels] if x >= channels else 0
            if kind == 1:
                row[x] = row[x] + left & 255
            elif kind == 2:
                row[x] = row[x] + up & 255
            elif kind == 3:
                row[x] = row[x] + (left + up) // 2 & 255
            elif kind == 4:
                a, b, c = abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)
                row[x] = row[x] + (left if a <= b and a <= c else up if b <= c else corner) & 255
        before = row
        rows.append(bytes(row) if channels == 3 else bytes(v for k, v in enumerate(row) if k % 4 != 3))
    return Picture(width, height, b"".join(rows))


# --- scenes ---------------------------------------------------------------------------------------------------------


def write_triangle_room(path, light):
    """Two triangles as a floor, with a camera over it; without light where there is to be none."""
    corners = struct.pack("<12f", -1, 0, -1, 1, 0, -1, 1, 0, 1, -1, 0, 1)
    faces = struct.pack("<6H", 0, 2, 1, 0, 3, 2)
    wall = struct.pack("<12f", -1, 0, -1, 1, 0, -1, 1, 2, -1, -1, 2, -1)
    front = struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    chunks, views = b"", []
    for part in (corners, faces, wall, front):
        views.append({"buffer": 0, "byteOffset": len(chunks), "byteLength": len(part)})
        chunks += part + b"\0" * (-len(part) % 4)
    nodes = [{"mesh": 0}, {"camera": 0, "translation": [0, 1, 3]}]
    gltf = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(2 + light))}], "nodes": nodes,
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1},
                                   {"attributes": {"POSITION": 2}, "indices": 3}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, 0, -1], "max": [1, 0, 1]},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
            {"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, 0, -1], "max": [1, 2, -1]},
            {"bufferView": 3, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "bufferViews": views, "buffers": [{"byteLength": len(chunks)}],
    }
    if light:
        gltf["extensionsUsed"] = ["KHR_lights_punctual"]
        gltf["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 5}]}}
        nodes.append({"translation": [0, 1.5, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}})
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    path.write_bytes(struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(chunks)) +
                     struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(chunks), b"BIN\0") +
                     chunks)
    return path


# --- a display, and the window on it --------------------------------------------------------------------------------


def end_with_this():
    """For preexec_fn: nothing stays behind when a time limit ends this program (PR_SET_PDEATHSIG)."""
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)


class Display:
    def __init__(self):
        read, write = os.pipe()
        # -r: a key that a slow machine holds does not repeat.
        self.process = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1024x768x24", "-r",
                                         "-noreset", "-nolisten", "tcp"], pass_fds=[write], stderr=subprocess.DEVNULL,
                                        preexec_fn=end_with_this)
        os.close(write)
        with os.fdopen(read) as answer:
            self.number = answer.readline().strip()
        if not self.number:
            raise RuntimeError("Xvfb does not start")

    def environment(self):
        return {**os.environ, "DISPLAY": f":{self.number}"}

    def close(self):
        self.process.terminate()
        self.process.wait()


class Window:
    """A running volgi-demo."""

    def __init__(self, display, folder, *arguments, size="320x200", settings=None, panel=False, quick=True):
        self.folder, self.environment = folder, display.environment()
        self.settings = folder / "settings.json"
        if settings is None:
            settings = {"volgi_demo": 1, "picture": STILL}
        if settings:
            self.settings.write_text(json.dumps(settings))
        self.events_path = folder / f"events{len(list(folder.glob('events*')))}.jsonl"
        self.errors = open(self.events_path.with_suffix(".stderr"), "w+")
        command = [Given.demo, *map(str, arguments), "--events", self.events_path, "--settings", self.settings,
                   "--pictures", folder, "--size", size, *(QUICK if quick else [])]
        if not panel:
            command += ["--do", "panel"]
        self.started = time.monotonic()
        self.process = subprocess.Popen(command, env=self.environment, stderr=self.errors, cwd=folder,
                                        preexec_fn=end_with_this)
        self.events, self.unread = [], ""
        self.file = None
        self.wait("first_picture")
        self.handle = self.tool("search", "--onlyvisible", "--name", "^volgi").split()[-1]
        self.tool("windowfocus", "--sync", self.handle)
        if not panel:
            width = int(size.split("x")[0])
            self.wait("frame", lambda e: e["size"][0] == width)

    # Events

    def read(self):
        if self.file is None and self.events_path.exists():
            self.file = open(self.events_path)
        if self.file is None:
            return
        self.unread += self.file.read()
        *lines, self.unread = self.unread.split("\n")
        self.events += [json.loads(line) for line in lines]

    def mark(self):
        """What happens from here on."""
        self.read()
        return len(self.events)

    def find(self, name, where=None, since=0):
        self.read()
        return next((e for e in self.events[since:] if e["event"] == name and (where is None or where(e))), None)

    def wait(self, name, where=None, since=0, longest=LONGEST_S):
        end = time.monotonic() + longest
        while time.monotonic() < end:
            ended = self.process.poll() is not None
            event = self.find(name, where, since)
            if event is not None:
                return event
            if ended:
                break
            time.sleep(0.01)
        raise AssertionError(f"no event '{name}' (exit code {self.process.poll()}); the last ones: "
                             f"{self.events[-4:]}; {self.said()}")

    def wait_for(self, what, condition, longest=LONGEST_S):
        end = time.monotonic() + longest
        while time.monotonic() < end:
            value = condition()
            if value:
                return value
            if self.process.poll() is not None:
                break
            time.sleep(0.02)
        raise AssertionError(f"{what} (exit code {self.process.poll()}); {self.said()}; {self.events[-4:]}")

    def last(self, name="frame"):
        self.read()
        return next(e for e in reversed(self.events) if e["event"] == name)

    def said(self):
        self.errors.flush()
        self.errors.seek(0)
        return self.errors.read()

    # A person

    def tool(self, *arguments):
        return subprocess.run(["xdotool", *map(str, arguments)], env=self.environment, check=True, text=True,
                              stdout=subprocess.PIPE, timeout=LONGEST_S).stdout

    def key(self, *names):
        mark = self.mark()
        self.tool("key", *names)
        return mark

    def key_for_frame(self, name, where=None):
        return self.wait("frame", where, self.key(name))

    def command(self, line):
        """Through the palette. @returns since when."""
        mark = self.key("ctrl+p")
        self.wait("keyboard", lambda e: e["of"] == "text", mark)
        entered = self.mark()
        self.tool("type", "--delay", "1", line)
        self.tool("key", "Return")
        self.wait("keyboard", lambda e: e["of"] != "text", entered)
        return mark

    def command_for_frame(self, line, where=None):
        return self.wait("frame", where, self.command(line))

    def pointer(self, x, y):
        self.tool("mousemove", "--window", self.handle, x, y)

    def orbit(self):
        """Until the camera has moved: what happens within one slow frame is one event."""
        eye = self.last()["eye"]
        self.pointer(60, 50)
        self.tool("mousedown", 1)
        for step in range(1, 200):
            mark = self.mark()
            self.pointer(60 + 3 * step % 60, 50 + step % 20)
            time.sleep(0.05)
            if self.find("frame", lambda e: math.dist(e["eye"], eye) > 0.1, mark):
                break
        self.tool("mouseup", 1)
        assert math.dist(self.last()["eye"], eye) > 0.1, f"the mouse does not turn the camera: {self.last()}"
        self.settle()

    def settle(self):
        """Until there are no more frames."""
        count = -1
        while count != self.last()["frames"]:
            count = self.last()["frames"]
            time.sleep(1.0)

    # A desktop

    def hand(self, *arguments):
        return subprocess.run([Given.hand, self.handle, *map(str, arguments)], env=self.environment,
                              stdout=subprocess.PIPE, timeout=2 * LONGEST_S)

    def picture(self):
        result = self.hand("picture")
        assert result.returncode == 0, "the window shows nothing"
        return read_ppm(result.stdout)

    def undisturbed(self):
        """Where no messages are: right of their longest lines."""
        return self.picture().part(0.74, 0.0, 1.0, 1.0)

    def quit(self):
        """@returns how many OpenGL errors there were."""
        self.key("ctrl+q")
        end = self.wait("end")
        assert self.process.wait(LONGEST_S) == 0
        return end["gl_errors"]

    def close(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self.errors.close()
        if self.file:
            self.file.close()


class Case(unittest.TestCase):
    def setUp(self):
        kept = os.environ.get("VOLGI_KEEP")
        self.folder = pathlib.Path(kept, self.id()) if kept else pathlib.Path(tempfile.mkdtemp(prefix="volgi_window_"))
        self.folder.mkdir(parents=True, exist_ok=True)
        if not kept:
            self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def demo(self, *arguments, **more):
        """Without a window."""
        return subprocess.run([Given.demo, *map(str, arguments)], text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, timeout=300, cwd=self.folder, **more)

    def assert_one_line(self, text, *parts):
        self.assertEqual(len(text.strip().splitlines()), 1, text)
        for part in parts:
            self.assertIn(part, text)


class WindowCase(Case):
    """One display for all windows of a run."""
    display = None

    @classmethod
    def setUpClass(cls):
        if WindowCase.display is None:
            WindowCase.display = Display()

    def window(self, *arguments, **more):
        window = Window(self.display, self.folder, *arguments, **more)
        self.addCleanup(window.close)
        return window
