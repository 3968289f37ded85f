#!/usr/bin/python3
"""volgi-demo as a person uses it: keys and a mouse on a display of its own (Xvfb), files that are dropped, windows that
come and go; and the program without a window.

    window_test.py VOLGI_DEMO VOLGI X11_HAND SOURCE_FOLDER [CASE...]

Exit code 77 (skipped) where Xvfb or xdotool is missing, or X11_HAND was not built; a failure with VOLGI_REQUIRE_GL.
What the window does is read from its --events: nothing here waits for time to pass, but for what is to happen, for a
minute at most.
    VOLGI_LONG=1          the case Memory plays 2,000 frames
    VOLGI_KEEP=FOLDER     keeps what the cases have written
    CASE Times            prints how fast the window is; not among the others
"""
import json
import math
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
import unittest

from window_driver import (Case, Display, Given, INSIDE, LONGEST_S, Picture, QUICK, read_png, scene, STILL, Window,
                           WindowCase, write_triangle_room)

SKIPPED = 77
ORDER = ("demo", "volgi", "hand", "source")


class Volumes(WindowCase):
    """OpenVDB files instead of scenes."""

    def volume(self):
        file = self.folder / "cornell.vdb"
        subprocess.run([Given.volgi, "export", scene("cornell"), "-o", file, "--grid", "12", "--backend", "cpu", "--quiet"],
                       check=True, timeout=LONGEST_S)
        return file

    def test_keys_mouse_and_drop(self):
        volume = self.volume()
        window = self.window(volume, size="640x480")
        first = window.last()
        self.assertEqual((first["grid"], first["view"], first["channel"]), ("fluence", "sheet", "all"))
        seen = [window.picture()]
        self.assertGreater(seen[0].spread(), 8.0)

        def changed(where, since):
            window.wait("frame", where, since)
            end = time.monotonic() + 10.0
            while window.picture().distance(seen[-1]) <= 0.05:
                self.assertLess(time.monotonic(), end, f"nothing has changed: {window.last()}")
            seen.append(window.picture())

        x, y, z = first["cell"]
        changed(lambda e: e["cell"] == [x + 1, y, z], window.key("Right"))
        changed(lambda e: e["cell"] == [x + 1, y, z + 1], window.key("Prior"))
        changed(lambda e: e["channel"] == "luminance", window.key("c"))
        changed(lambda e: e["orbit"][0] != first["orbit"][0], window.key("d"))
        changed(lambda e: e["grid"] == "radiance" and e["direction"] == [15.0, 0.0], window.key("bracketright"))
        changed(lambda e: e["view"] == "orbit", window.key("5"))
        yaw = window.last()["orbit"][0]
        window.pointer(300, 200)
        window.tool("mousedown", 1)
        mark = window.mark()
        for step in range(40):  # what happens within one slow frame is one event
            window.pointer(300 + 3 * step, 200)
            if window.find("frame", lambda e: e["orbit"][0] != yaw, mark):
                break
            time.sleep(0.05)
        window.tool("mouseup", 1)
        changed(lambda e: e["orbit"][0] != yaw, mark)
        changed(lambda e: e["view"] == "z", window.key("4"))
        window.pointer(320, 200)  # the middle of 12 x 12 cells
        mark = window.mark()
        window.tool("click", 1)
        window.wait("frame", lambda e: e["cell"][:2] in ([5, 5], [6, 5], [5, 6], [6, 6]), mark)
        mark = window.key("p")
        window.wait("frame", lambda e: e["message"].startswith("wrote"), mark)
        self.assertTrue((self.folder / "cornell-001.png").exists())
        other = self.folder / "other.vdb"
        shutil.copy(volume, other)
        mark = window.mark()
        self.assertEqual(window.hand("drop", other).returncode, 0)
        window.wait("frame", lambda e: e["file"] == str(other), mark)
        self.assertEqual(window.quit(), 0)

    def test_headless(self):
        volume = self.volume()
        done = self.demo(volume, "--headless", "-o", "sheet.png", "--size", "400x300")
        self.assertEqual(done.returncode, 0, done.stderr)
        sheet = read_png(self.folder / "sheet.png")
        self.assertEqual((sheet.width, sheet.height), (400, 300))
        self.assertGreater(sheet.spread(), 8.0)
        pictures = [sheet]
        for k, more in enumerate((["--view", "orbit"], ["--do", "grid radiance", "--do", "direction 0,-90"],
                                  ["--do", "grid radiance", "--do", "direction 0,90"], ["--do", "channel red"],
                                  ["--do", "grid normal"], ["--do", "slice z=2"], ["--view", "orbit", "--do", "cut"])):
            done = self.demo(volume, "--headless", "-o", f"{k}.png", "--size", "400x300", *more)
            self.assertEqual(done.returncode, 0, done.stderr)
            pictures.append(read_png(self.folder / f"{k}.png"))
            self.assertGreater(min(pictures[-1].distance(p) for p in pictures[:-1]), 0.2, more)
        for arguments, code, parts in ((["-o", "x.exr"], 2, [".png"]), (["-o", "x.png", "--do", "grid none"], 2, ["fluence"]),
                                       (["-o", "x.png", scene("cornell")], 2, ["alone"]), (["-o", "no/x.png"], 6, ["no/x.png"])):
            done = self.demo(volume, "--headless", *arguments)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assert_one_line(done.stderr, *parts)
        (self.folder / "bad.vdb").write_bytes(b"no volume")
        done = self.demo("bad.vdb", "--headless", "-o", "x.png")
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assert_one_line(done.stderr, "bad.vdb")
        # Without OpenGL, too.
        nothing = {**os.environ, "__EGL_VENDOR_LIBRARY_DIRS": "/nonexistent", "DISPLAY": ""}
        self.assertEqual(self.demo(volume, "--headless", "-o", "x.png", env=nothing).returncode, 0)


class Views(WindowCase):
    KEYS = {"1": "picture", "2": "direct", "3": "first_bounce", "4": "higher_bounces", "5": "emission", "6": "albedo",
            "7": "normals", "8": "depth", "9": "voxels", "0": "coverage", "shift+1": "lobe", "shift+2": "lights",
            "shift+3": "clusters", "shift+4": "cluster_maps", "shift+6": "low_resolution", "shift+7": "texture",
            "shift+8": "light_tree"}

    def shown(self, window, key, view, *others):
        """Opens a view; it is neither blank nor like another one."""
        window.key_for_frame(key, lambda e: e["view"] == view)
        end = time.monotonic() + 10.0
        while True:
            picture = window.picture()
            distances = [picture.distance(other) for other in others]
            if picture.spread() > 8.0 and min(distances, default=9.0) > 1.0:
                return picture
            self.assertLess(time.monotonic(), end, f"{view}: spread {picture.spread()}, from the others {distances}")

    def test_every_view_opens_by_its_key(self):
        window = self.window(scene("cornell"), "--do", "emission 0 0.1,0.3,0.2")
        window.key_for_frame("6")
        seen = []
        for key, view in self.KEYS.items():
            with self.subTest(view=view):
                seen.append(self.shown(window, key, view, *seen))
        self.assertEqual(window.quit(), 0)

    def test_negative_lights(self):
        window = self.window(scene("cornell"), "--gi", "negative")
        self.shown(window, "shift+5", "negative_lights", window.picture())
        self.assertEqual(window.quit(), 0)

    def test_a_view_that_the_recipe_lacks_shows_something(self):
        window = self.window(scene("cornell"), "--gi", "none")
        for key, view in (("9", "voxels"), ("shift+2", "lights"), ("shift+5", "negative_lights")):
            window.key_for_frame(key, lambda e: e["view"] == view)
        self.assertGreater(window.picture().spread(), 8.0)
        self.assertEqual(window.quit(), 0)

    def test_layers_and_textures(self):
        window = self.window(scene("cornell"), "--view", "cluster_maps")
        seen = [window.picture()]
        for key in ("bracketright", "bracketright", "bracketleft", "bracketleft"):
            window.key(key)
            window.wait_for(f"{key}: the cluster looks the same", lambda: window.picture().distance(seen[-1]) > 0.1)
            seen.append(window.picture())
        self.assertEqual(seen[0].distance(seen[4]), 0.0)
        self.assertGreater(seen[0].distance(seen[2]), 0.1)
        self.assertIsNone(window.find("error"))
        window.command_for_frame("texture gbuffer")
        self.assertEqual(window.quit(), 0)


def stages_of(recipe):
    """As the program names them when it is asked for one that there is not."""
    command = [Given.volgi, "render", scene("cornell"), "-o", "never.exr", "--size", "8x8", "--gi", recipe, "--without",
               "nonsense"]
    text = subprocess.run(command, stderr=subprocess.PIPE, text=True).stderr
    return re.search(r"it has (.*)", text)[1].split(", ")


class Stages(WindowCase):
    def toggled(self, window, stage):
        """Off and on again."""
        before = window.undisturbed()
        line = f"stage {stage} toggle"
        mark = window.command(line)
        window.wait_for(f"{line}: neither another picture nor a message", lambda: window.find(
            "error", None, mark) or (window.find("frame", None, mark) and window.undisturbed().distance(before) > 0.0))
        refused = window.find("error", None, mark)
        if refused:
            self.assertNotIn("no command", refused["text"])
            self.assertEqual(window.undisturbed().distance(before), 0.0, f"{line} was refused: {refused}")
            return
        window.command_for_frame(line)
        window.wait_for(f"{line} twice: not the picture that was there before: {window.events[-3:]}",
                        lambda: window.undisturbed().distance(before) < 0.05)

    def of_recipes(self, recipes, *light):
        window = self.window(scene("cornell"), *light, "--exposure", "1", "--do", INSIDE)
        for recipe in recipes:
            window.command_for_frame(f"recipe {recipe}", lambda e: e["recipe"] == recipe)
            for stage in stages_of(recipe):
                with self.subTest(recipe=recipe, stage=stage):
                    self.toggled(window, stage)
        self.assertEqual(window.quit(), 0)

    def test_hybrid_and_volume(self):
        self.of_recipes(["hybrid", "volume"], "--sky", "0.5,0.7,0.9")

    def test_one_bounce(self):
        self.of_recipes(["val", "negative", "vpl", "none"], "--sky", "0.5,0.7,0.9")

    def test_lpv(self):
        self.of_recipes(["lpv"])

    def test_key_goes_through_all_recipes(self):
        window = self.window(scene("cornell"))
        first = window.last()["recipe"]
        seen = []
        while first not in seen:
            now = window.last()["recipe"]
            seen.append(window.key_for_frame("g", lambda e: e["recipe"] != now)["recipe"])
            self.assertLess(len(seen), 20)
        self.assertGreaterEqual(len(set(seen)), 7)
        window.key_for_frame("shift+g", lambda e: e["recipe"] == seen[-2])
        self.assertEqual(window.quit(), 0)


class Light(WindowCase):
    SIZE = (320, 200)
    YFOV, EYE = 0.6981317007977318, (0.0390625, 1.0234375, 3.90625)  # of data/cornell.glb, along -Z
    LAMP = (0.0, 1.96875, 0.0)

    def pixel_size_m(self):
        return 2.0 * math.tan(0.5 * self.YFOV) * (self.EYE[2] - self.LAMP[2]) / self.SIZE[1]

    def test_dragged_by_its_mark(self):
        window = self.window(scene("cornell"))
        pixel = self.pixel_size_m()
        x = round(0.5 * self.SIZE[0] + (self.LAMP[0] - self.EYE[0]) / pixel)
        y = round(0.5 * self.SIZE[1] - (self.LAMP[1] - self.EYE[1]) / pixel)
        before = window.undisturbed()
        mark = window.mark()
        window.pointer(x, y)
        window.tool("mousedown", 1)
        start = window.wait("light", None, mark)["at"]
        way = (25, 40)
        mark = window.mark()
        window.pointer(x + way[0], y + way[1])
        window.wait("frame", None, mark)
        window.tool("mouseup", 1)
        expected = (start[0] + way[0] * pixel, start[1] - way[1] * pixel, start[2])
        end = window.wait("light", None, mark)["at"]
        self.assertLess(math.dist(end, expected), pixel, f"{start} -> {end}, not {expected}; {pixel} m a pixel")
        window.wait_for("the picture does not follow the light", lambda: window.undisturbed().distance(before) > 1.0)
        # The mark went along: taken again where it is now, and let go without a move.
        eye = window.last()["eye"]
        mark = window.mark()
        window.pointer(x + way[0], y + way[1])
        window.tool("mousedown", 1)
        window.pointer(x, y)
        window.wait("light", lambda e: math.dist(e["at"], start) < pixel, mark)
        window.tool("mouseup", 1)
        self.assertEqual(window.last()["eye"], eye)
        self.assertEqual(window.quit(), 0)

    def test_taken_added_and_deleted_by_keys(self):
        window = self.window(scene("cornell"))
        window.wait("light", lambda e: e["light"] == 0, window.key("l"))
        dark = window.key_for_frame("Delete")
        self.assertEqual(dark["triangles"], window.last()["triangles"])
        window.command_for_frame("light add point")
        self.assertEqual(window.last("light")["light"], 0)
        window.command_for_frame("light at 0.2,1.5,0.3")
        # Told in the frame that is centred on the scene, 1 m over its floor.
        window.wait("light", lambda e: math.dist(e["at"], (0.2, 0.5, 0.3)) < 0.1)
        window.command_for_frame("light reset")
        self.assertEqual(window.quit(), 0)


class Camera(WindowCase):
    def test_every_way_to_move_it(self):
        window = self.window(scene("cornell"))
        start = window.last()["eye"]
        window.pointer(160, 110)  # the far wall is under it
        mark = window.mark()
        window.tool("click", 4)
        near = window.wait("frame", lambda e: e["eye"][2] < start[2] - 0.1, mark)["eye"]
        mark = window.mark()
        window.tool("click", 5)
        back = window.wait("frame", lambda e: e["eye"][2] > near[2] + 0.1, mark)["eye"]
        self.assertLess(math.dist(back, start), 0.05)
        for key, axis, sign in (("w", 2, -1), ("s", 2, 1), ("d", 0, 1), ("a", 0, -1), ("e", 1, 1), ("q", 1, -1)):
            before = window.last()["eye"]
            window.tool("keydown", key)
            window.wait("frame", lambda e: sign * (e["eye"][axis] - before[axis]) > 0.02)
            window.tool("keyup", key)
            window.settle()
            moved = [b - a for a, b in zip(before, window.last()["eye"])]
            self.assertEqual(max(range(3), key=lambda k: abs(moved[k])), axis, f"{key}: {moved}")
        before = window.last()["eye"]
        window.pointer(100, 120)
        window.tool("mousedown", 2)
        for step in range(1, 100):
            window.pointer(100 + min(step, 60), 120)
            if window.last()["eye"][0] < before[0] - 0.05:  # the scene follows the hand to the right
                break
            time.sleep(0.05)
        window.tool("mouseup", 2)
        window.settle()
        self.assertLess(window.last()["eye"][0], before[0] - 0.05)
        self.assertAlmostEqual(window.last()["eye"][1], before[1], places=3)
        self.assertLess(math.dist(window.key_for_frame("c")["eye"], start), 1e-5)
        mark = window.command("look 0.5,1,3 0,1,0 50")
        window.wait("frame", lambda e: math.dist(e["eye"], (0.5, 0.0, 3.0)) < 1e-3, mark)
        window.key_for_frame("f", lambda e: e["eye"][2] > 3.2)
        self.assertEqual(window.quit(), 0)

    def test_recorded_and_replayed(self):
        window = self.window(scene("cornell"))
        window.key("v")
        window.tool("keydown", "s")
        window.wait("frame", lambda e: e["eye"][2] > 4.3)
        window.tool("keyup", "s")
        end = window.wait("message", lambda e: e["text"].startswith("recorded"), window.key("v"))
        self.assertIn("keys", end["text"])
        window.settle()
        far = window.last()["eye"]
        window.key_for_frame("c", lambda e: e["eye"][2] < 4.0)
        window.key_for_frame("shift+v", lambda e: math.dist(e["eye"], far) < 0.02)
        self.assertEqual(window.quit(), 0)


class Drop(WindowCase):
    def setUp(self):
        super().setUp()
        self.room = write_triangle_room(self.folder / "a rööm 100%.glb", light=True)

    def test_dropped_files(self):
        window = self.window(scene("cornell"))
        cornell = window.last()["triangles"]
        mark = window.mark()
        self.assertEqual(window.hand("drop", self.room).returncode, 0)
        window.wait("frame", lambda e: e["triangles"] == 4, mark)
        mark = window.mark()
        window.tool("keydown", "shift")
        self.assertEqual(window.hand("drop", scene("cornell")).returncode, 0)
        window.wait("frame", lambda e: e["triangles"] == 4 + cornell, mark)
        window.tool("keyup", "shift")
        # Two at once with Shift, and none is lost.
        mark = window.mark()
        window.tool("keydown", "shift")
        self.assertEqual(window.hand("drop", self.room, self.room).returncode, 0)
        window.wait("frame", lambda e: e["triangles"] == 12 + cornell, mark)
        window.tool("keyup", "shift")
        self.assertEqual(window.quit(), 0)

    def test_outlives_what_something_is_dragged_from(self):
        window = self.window(scene("cornell"))
        self.assertEqual(window.hand("vanish").returncode, 0)
        mark = window.mark()
        self.assertEqual(window.hand("drop", self.room).returncode, 0)
        window.wait("frame", lambda e: e["triangles"] == 4, mark)
        self.assertEqual(window.quit(), 0)

    def test_what_cannot_be_read_leaves_the_old_scene(self):
        window = self.window(scene("cornell"), "--exposure", "1")
        before, triangles = window.undisturbed(), window.last()["triangles"]
        broken, missing = self.folder / "broken.glb", self.folder / "missing.glb"
        broken.write_bytes(scene("cornell").read_bytes()[:3000])
        for file in (broken, missing, self.folder):
            for shift in (False, True):
                mark = window.mark()
                if shift:
                    window.tool("keydown", "shift")
                self.assertEqual(window.hand("drop", file).returncode, 0)
                error = window.wait("error", None, mark)
                if shift:
                    window.tool("keyup", "shift")
                self.assertIn(file.name, error["text"])
        self.assertEqual(window.undisturbed().distance(before), 0.0)
        self.assertEqual(window.key_for_frame("6")["triangles"], triangles)
        self.assertEqual(window.quit(), 0)


class Desktop(WindowCase):
    """What a window has to live with."""

    def test_resized(self):
        window = self.window(scene("cornell"))
        for width, height in ((1, 1), (200, 1), (1, 150), (333, 217), (320, 200)):
            mark = window.mark()
            window.tool("windowsize", window.handle, width, height)
            window.wait("frame", lambda e: e["size"] == [width, height], mark)
        window.wait_for("the picture is blank", lambda: window.picture().spread() > 8.0)
        mark = window.key("Tab")  # panels take half of a small window
        window.wait("frame", lambda e: e["size"] == [160, 200], mark)
        for width, height in ((1, 1), (320, 200)):
            mark = window.mark()
            window.tool("windowsize", window.handle, width, height)
            window.wait("frame", lambda e: e["size"] == [max(1, width - width // 2), height], mark)
        self.assertEqual(window.quit(), 0)

    def test_minimised_and_restored(self):
        window = self.window("builtin:metaballs", "--do", "play on")
        window.wait("frame", lambda e: e["time"] > 0.0)
        window.hand("minimise")
        window.settle()  # an animation, and no frames
        mark = window.mark()
        window.hand("restore")
        window.wait("frame", None, mark)
        window.wait_for("the picture is blank", lambda: window.picture().spread() > 8.0)
        window.tool("windowfocus", "--sync", window.handle)
        self.assertEqual(window.quit(), 0)

    def test_goes_on_without_the_keyboard(self):
        window = self.window("builtin:metaballs", "--do", "play on")
        window.tool("keydown", "w")  # is held when the keyboard goes, and must not fly on for ever
        window.wait("frame", lambda e: math.dist(e["eye"], window.events[-1].get("eye", e["eye"])) >= 0.0)
        window.hand("blur")
        now = window.last()["frames"]
        window.wait("frame", lambda e: e["frames"] > now + 5)
        window.tool("keyup", "w")
        one = window.last()
        later = window.wait("frame", lambda e: e["frames"] > one["frames"] + 3)
        self.assertEqual(one["eye"], later["eye"])
        window.tool("windowfocus", "--sync", window.handle)
        window.key_for_frame("6", lambda e: e["view"] == "albedo")
        self.assertEqual(window.quit(), 0)

    def test_fullscreen_and_back(self):
        window = self.window(scene("cornell"), "--gi", "none")
        window.key_for_frame("F11", lambda e: e["size"] == [1024, 768])
        window.key_for_frame("F11", lambda e: e["size"] == [320, 200])
        self.assertEqual(window.quit(), 0)


class Screenshots(WindowCase):
    SIZE = "160x100"
    PERCENT = 0.1  # relative RMSE

    def shot(self, window):
        """Key P, and the command beside the picture: it makes the same one."""
        mark = window.key("p")
        text = window.wait("message", lambda e: e["text"].startswith("wrote "), mark)["text"]
        name = pathlib.Path(re.match(r"wrote (.*)\.png, \.exr and \.txt", text)[1])
        png = read_png(name.with_suffix(".png"))
        self.assertGreater(png.spread(), 8.0)
        command = shlex.split(name.with_suffix(".txt").read_text())
        self.assertEqual(command[:2], ["volgi", "render"])
        again = name.with_name(name.name + "-again")
        for ending in (".exr", ".png"):
            command[command.index("-o") + 1] = str(again) + ending
            done = subprocess.run([Given.volgi, *command[1:], "--quiet"], text=True, stderr=subprocess.PIPE,
                                  cwd=self.folder, timeout=300)
            self.assertEqual(done.returncode, 0, done.stderr)
        figures = json.loads(subprocess.run(
            [Given.volgi, "compare", f"{name}.exr", f"{again}.exr", "--region", "all", "--json"], text=True, check=True,
            stdout=subprocess.PIPE).stdout)[0]
        self.assertLess(figures["rmse_pct"], self.PERCENT, f"{command}: {figures}")
        self.assertLess(read_png(f"{again}.png").distance(png), 0.5, command)
        return command

    def test_cornell(self):
        window = self.window(scene("cornell"), size=self.SIZE)
        first = self.shot(window)
        self.assertIn("--camera", first)
        window.orbit()
        turned = self.shot(window)
        self.assertIn("--eye", turned)
        window.command_for_frame("set vpl.count=64")
        self.assertIn("vpl.count=64", self.shot(window))
        window.command_for_frame("bounces 2")
        self.shot(window)
        window.key("l")
        window.command_for_frame("light move 0.3,-0.4,0.2")
        self.assertIn("--lights", self.shot(window))
        window.command_for_frame("sky sun:35,120")
        self.shot(window)
        self.assertEqual(window.quit(), 0)

    def test_average(self):
        settings = {"volgi_demo": 1, "picture": {"progressive": True, "most_samples": 4, "motion_fps": 1000}}
        window = self.window(scene("cornell"), size=self.SIZE, settings=settings)
        window.wait("frame", lambda e: e["samples"] == 4 and e["size"] == [160, 100])
        command = self.shot(window)
        self.assertEqual(command[command.index("--samples") + 1], "4")
        # What moves has fewer pixels; what is written has not.
        window.orbit()
        window.wait("frame", lambda e: e["samples"] == 4, window.mark() - 1)
        command = self.shot(window)
        self.assertEqual(command[command.index("--size") + 1], self.SIZE)
        self.assertEqual(command[command.index("--samples") + 1], "4")
        self.assertEqual(window.quit(), 0)

    def test_animation(self):
        window = self.window("builtin:metaballs", "--time", "0.7", size=self.SIZE)
        self.assertIn("0.7", self.shot(window))
        window.command_for_frame("time 1.3")
        self.shot(window)
        self.assertEqual(window.quit(), 0)

    def test_a_film_on_a_screen(self):
        for k, exposure in enumerate(("3", "-1")):
            subprocess.run([Given.volgi, "render", scene("cornell"), "--size", "8x4", "--gi", "none", "--exposure",
                            exposure, "-o", f"film.{k:04}.png", "--quiet"], check=True, cwd=self.folder, timeout=300)
        window = self.window(scene("emissive"), "--area-video", self.folder / "film.%04d.png", "--area-fps", "2",
                             "--exposure", "1", size=self.SIZE)  # automatic exposure would still be on its way
        shown = []
        for t in ("0", "0.5", "1"):
            window.command_for_frame(f"time {t}")
            command = self.shot(window)
            self.assertIn("--area-video", command)
            shown.append(read_png(command[command.index("-o") + 1].replace(".exr", ".png")))
        self.assertGreater(shown[0].distance(shown[1]), 1.0)  # the film plays,
        self.assertLess(shown[0].distance(shown[2]), 0.5)     # and begins again
        window.command("play on")
        window.wait("frame", None, window.mark())
        self.assertEqual(window.quit(), 0)

    def test_a_scene_without_light(self):
        window = self.window(write_triangle_room(self.folder / "dark room.glb", light=False), size=self.SIZE)
        window.wait("message", lambda e: "no light" in e["text"])
        self.shot(window)
        window.orbit()
        self.shot(window)
        self.assertEqual(window.quit(), 0)


class SettingsFile(WindowCase):
    def test_comes_back(self):
        before = {"volgi_demo": 1, "picture": {**STILL, "of_the_future": 7}, "new": {"thing": [1, 2]}}
        window = self.window(scene("cornell"), settings=before, quick=False, panel=True)
        window.key_for_frame("7", lambda e: e["view"] == "normals")
        window.key_for_frame("g", lambda e: e["recipe"] == "volume")
        window.command_for_frame("grid 10")
        window.command_for_frame("directions 24")
        window.command_for_frame("set grid.shift=0.25")
        window.command_for_frame("bounces 3")
        window.command_for_frame("exposure -1.5")
        window.command("filter off")
        window.command("panel Light")
        window.wait("message", lambda e: "kept" in e["text"], window.key("b"))
        self.assertEqual(window.quit(), 0)
        first = json.loads(window.settings.read_text())
        self.assertEqual(first["new"], before["new"])
        self.assertEqual(first["picture"]["of_the_future"], 7)
        self.assertEqual(first["picture"]["view"], "normals")
        self.assertEqual(first["technique"]["recipe"], "volume")
        self.assertEqual(first["technique"]["volume"]["grid"], 10)
        self.assertEqual(first["technique"]["parameters"], {"grid.shift": "0.25"})
        self.assertEqual(first["technique"]["bounces"], 3)
        self.assertEqual(first["picture"]["exposure_ev"], -1.5)
        self.assertFalse(first["picture"]["post_filter"])
        self.assertTrue(first["panels"]["Light"])
        self.assertEqual(first["recent_files"], [str(scene("cornell"))])
        self.assertEqual(list(first["bookmarks"][str(scene("cornell"))]), ["view 1"])

        window = self.window(scene("cornell"), settings={}, quick=False, panel=True)
        frame = window.last()
        self.assertEqual((frame["view"], frame["recipe"]), ("normals", "volume"))
        self.assertIn("of_the_future", window.said())
        self.assertEqual(window.quit(), 0)
        self.assertEqual(json.loads(window.settings.read_text()), first)

    def test_undo_keeps_what_is_no_step(self):
        window = self.window(scene("cornell"))
        window.command_for_frame("set vpl.count=64")
        window.wait("message", lambda e: "kept" in e["text"], window.key("b"))
        window.wait("message", lambda e: e["text"] == "undone: vpl.count", window.key("ctrl+z"))
        window.wait("message", lambda e: e["text"] == "view 1", window.key("n"))
        window.wait("message", lambda e: e["text"] == "done again: vpl.count", window.key("ctrl+shift+z"))
        self.assertEqual(window.quit(), 0)
        kept = json.loads(window.settings.read_text())
        self.assertEqual(len(kept["bookmarks"]), 1)
        self.assertEqual(kept["technique"]["parameters"]["vpl.count"], "64")

    def test_broken_ones_are_refused(self):
        file = self.folder / "broken.json"
        for text, culprit in (("{", "broken.json"), ('{"volgi_demo": 1, "picture": {"view": 7}}', "picture.view"),
                              ('{"volgi_demo": 1, "picture": {"view": "inside out"}}', "picture.view"),
                              ('{"volgi_demo": 99}', "broken.json"),
                              ('{"volgi_demo": 1, "technique": {"recipe": "magic"}}', "technique.recipe")):
            file.write_text(text)
            done = self.demo(scene("cornell"), "--settings", file, env=self.display.environment())
            self.assertEqual(done.returncode, 3, f"{text}: {done.stderr}")
            self.assert_one_line(done.stderr, "broken.json", culprit)
            self.assertEqual(file.read_text(), text)


class Keyboard(WindowCase):
    def lines(self):
        """A harmless line for each command; the last ends the program."""
        folder, cornell = self.folder, scene("cornell")
        return [f"open {cornell}", "reload", f"append {self.room}", f"open {cornell}", "recipe volume", "recipe next",
                "recipe previous", "recipe hybrid", "stage sources/sky toggle", "recipe hybrid", "set vpl.count=64",
                "reset vpl.count", "reset", "preset fast", "grid 6", "scheme conservative", "sh-order 2",
                "scheme ordinates", "directions 24", "iterations auto", "bounces 3", "bounces all", "part indirect",
                "part full", "backend cpu", "shaders", "undo", "redo", "view albedo", "texture gbuffer", "layer 0",
                "layer +1", "channel r", "channel rgb", "range 0,2", "range auto", "log on", "log off",
                "voxels coverage", "lobe 0,1,0", "view picture", "exposure -1", "expose 0.5", "exposure auto",
                "filter off", "average 4", "average off", "reference beside", "wipe 0.3", "reference off", "motion off",
                "frame", "camera 0", "camera next", "look 0,1,3.5 0,1,0 50", "yfov 60", "orbit 10,-5", "bookmark door",
                "bookmark next", "bookmark go door", "bookmark delete door", "record", "record", "replay", "replay",
                f"path save {folder}/path.json", f"path load {folder}/path.json", "light next", "light take 0",
                "light add spot", "light intensity 3", "light colour 1,2,3", "light towards 0,-1,0", "light delete",
                "light reset", f"lights save {folder}/lights.json", "emission 0 0.1,0.1,0.1", "light reset",
                "sky 0.2,0.2,0.3", "sky-rotate 30", "sky none", "open builtin:metaballs", "time 0.5", "time +0.1",
                "play on", "play off", "times on", "times off", f"times save {folder}/times.csv",
                f"screenshot {folder}/shot", "copy camera", "copy command", f"settings save {folder}/kept.json",
                f"settings load {folder}/kept.json", "settings save", "panel", "panel Camera", "panel", "keyboard",
                "help", "help", "palette", "recipe none", "fullscreen", "fullscreen", "quit"]

    def setUp(self):
        super().setUp()
        self.room = write_triangle_room(self.folder / "room.glb", light=True)

    def test_every_command_by_its_line(self):
        known = re.findall(r"^\| `([a-z-]+)", self.demo("--list", "commands").stdout, re.MULTILINE)
        self.assertGreater(len(known), 40)
        lines = self.lines()
        self.assertEqual(sorted(set(known)), sorted({line.split()[0] for line in lines}), "a command without a line")
        window = self.window(scene("cornell"), size="160x100")
        for line in lines[:-1]:
            mark = window.command(line)
            if line.startswith(("open", "append", "reload")):
                window.wait("frame", None, mark)
            error = window.find("error", None, mark)
            self.assertIsNone(error, f"{line}: {error}")
        for name in ("path.json", "lights.json", "times.csv", "shot.png", "shot.exr", "shot.txt", "kept.json"):
            self.assertTrue((self.folder / name).exists(), name)
        window.key("ctrl+p")
        window.tool("type", "--delay", "1", "quit")
        window.tool("key", "Return")
        self.assertEqual(window.wait("end")["gl_errors"], 0)
        self.assertEqual(window.process.wait(LONGEST_S), 0)

    def test_what_is_no_command_is_said(self):
        window = self.window(scene("cornell"))
        for line, culprit in (("frobnicate 7", "frobnicate"), ("set vpl.count=many", "vpl.count"),
                              ("view inside-out", "inside-out"), ("stage nothing off", "nothing"),
                              ("open /nowhere/at/all.glb", "all.glb"), ("grid 0", "grid"), ("camera 9", "camera"),
                              ("light delete", "light"), ("play", "nothing moves")):
            mark = window.command(line)
            self.assertIn(culprit, window.wait("error", None, mark)["text"])
        window.key_for_frame("6", lambda e: e["view"] == "albedo")
        self.assertEqual(window.quit(), 0)

    def test_palette_takes_all_letters(self):
        """Those that are typed while it opens too: none of them is a key's command. Frames are slow here."""
        settings = {"volgi_demo": 1, "picture": {"progressive": True, "most_samples": 100000, "motion_fps": 0}}
        window = self.window(scene("cornell"), size="480x300", settings=settings, quick=False)
        mark = window.mark()
        window.tool("key", "ctrl+p", "v", "i", "e", "w", "space", "a", "l", "b", "e", "d", "o", "Return")
        window.wait("frame", lambda e: e["view"] == "albedo", mark)
        self.assertIsNone(window.find("message", None, mark))
        self.assertIsNone(window.find("error", None, mark))
        self.assertEqual(window.quit(), 0)

    def test_panels_by_keys(self):
        sections = ("Scene", "View", "Technique", "Light", "Camera", "Picture", "Reference", "Times")
        settings = {"volgi_demo": 1, "picture": STILL,
                    "panels": {name: name == "Picture" for name in sections}}
        window = self.window(scene("cornell"), size="640x400", settings=settings, panel=True)
        window.wait("keyboard", lambda e: e["of"] == "panels", window.key("F2"))

        def panels():
            return window.picture().part(0.5, 0.0, 1.0, 1.0)

        # Six headings down, the exposure, the box "smooth edges while moving".
        for _ in range(sections.index("Picture") + 2):
            before = panels()
            window.key("Down")
            window.wait_for("the arrow does not move the mark", lambda: panels().distance(before) > 0.0)
        before = panels()
        window.key("space")
        window.wait_for("Space does not switch the box", lambda: panels().distance(before) > 0.0)
        mark = window.key("Escape")
        window.wait("keyboard", lambda e: e["of"] == "picture", mark)
        window.key_for_frame("6", lambda e: e["view"] == "albedo")
        self.assertEqual(window.quit(), 0)
        self.assertFalse(json.loads(window.settings.read_text())["picture"]["post_filter"])


class Shaders(WindowCase):
    def test_written_while_the_window_is_open(self):
        shaders = self.folder / "shaders"
        shutil.copytree(Given.source / "shaders", shaders)
        window = self.window(scene("cornell"), "--exposure", "1", "--shaders", shaders)
        before = window.undisturbed()
        file = shaders / "screen/base/direct.frag.glsl"
        right = file.read_text()
        mark = window.mark()
        file.write_text(right.replace("void main()", "oh void main()"))
        self.assertIn("direct.frag.glsl", window.wait("error", None, mark)["text"])
        self.assertEqual(window.undisturbed().distance(before), 0.0)
        mark = window.mark()
        file.write_text(right)
        window.wait("frame", None, mark)
        self.assertIsNone(window.find("error", None, mark))
        mark = window.mark()
        black = shaders / "screen/base/compose.frag.glsl"
        black.write_text(black.read_text().replace("void main() {", "void main() { if (gl_FragCoord.x > 0.0) discard;"))
        window.wait("frame", None, mark)
        window.wait_for("another shader makes the same picture", lambda: window.undisturbed().distance(before) > 1.0)
        self.assertEqual(window.quit(), 0)


class Memory(WindowCase):
    def resident_mib(self, window):
        status = pathlib.Path(f"/proc/{window.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s*(\d+) kB", status)[1]) / 1024.0

    def test_flat_while_an_animation_plays(self):
        frames = 2000 if os.environ.get("VOLGI_LONG") else 300
        window = self.window("builtin:metaballs", "--do", "play on", size="64x48")
        first = window.last()["frames"]
        window.wait("frame", lambda e: e["frames"] >= first + 100, longest=300)
        early = self.resident_mib(window)
        window.wait("frame", lambda e: e["frames"] >= first + frames, longest=3000)
        late = self.resident_mib(window)
        print(f"resident after 100 frames {early:.1f} MiB, after {frames} {late:.1f} MiB")
        self.assertLess(late - early, 8.0)
        self.assertEqual(window.quit(), 0)


class Displays(WindowCase):
    def test_none(self):
        environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
        done = self.demo(scene("cornell"), "--no-settings", env=environment)
        self.assertEqual(done.returncode, 4)
        self.assert_one_line(done.stderr, "--headless")

    def test_one_that_goes_away(self):
        for arguments in ([scene("cornell")], ["builtin:metaballs", "--do", "play on"]):
            display = Display()
            window = Window(display, self.folder, *arguments)
            self.addCleanup(window.close)
            display.process.send_signal(signal.SIGKILL)
            display.process.wait()
            self.assertEqual(window.process.wait(LONGEST_S), 4, window.said())
            self.assert_one_line(window.said(), "display", "--headless")


class Headless(Case):
    PATH = {"volgi_camera_path": 1, "keys": [
        {"time_s": 0.0, "position": [0.0, 1.0, 3.9], "orientation": [0, 0, 0, 1], "yfov_rad": 0.7},
        {"time_s": 0.2, "position": [0.3, 1.1, 3.5], "orientation": [0, 0, 0, 1], "yfov_rad": 0.7}]}
    SMALL = ["--headless", "--size", "96x64", *QUICK]

    def setUp(self):
        super().setUp()
        self.path = self.folder / "path.json"
        self.path.write_text(json.dumps(self.PATH))

    def made(self, *arguments):
        done = self.demo(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_every_view(self):
        for view in [*Views.KEYS.values(), "negative_lights"]:
            with self.subTest(view=view):
                of_view = {"negative_lights": ["--gi", "negative"], "emission": ["--do", "emission 0 0.1,0.3,0.2"]}
                self.made(scene("cornell"), *self.SMALL, "--view", view, "-o", f"{view}.png", *of_view.get(view, []))
                picture = read_png(self.folder / f"{view}.png")
                self.assertEqual((picture.width, picture.height), (96, 64))
                self.assertGreater(picture.spread(), 8.0)

    def test_path(self):
        self.made(scene("cornell"), *self.SMALL, "--path", self.path, "--frames", "3", "--fps", "10", "-o",
                  "tour.%04d.png")
        pictures = [read_png(self.folder / f"tour.{k:04}.png") for k in range(3)]
        self.assertFalse((self.folder / "tour.0003.png").exists())
        for a, b in zip(pictures, pictures[1:]):
            self.assertGreater(a.spread(), 8.0)
            self.assertGreater(a.distance(b), 0.5)

    @unittest.skipUnless(shutil.which("ffmpeg"), "no ffmpeg")
    def test_film(self):
        self.made(scene("cornell"), *self.SMALL, "--path", self.path, "--frames", "3", "--fps", "10", "-o", "tour.webp")
        film = (self.folder / "tour.webp").read_bytes()
        self.assertEqual((film[:4], film[8:12]), (b"RIFF", b"WEBP"))
        self.assertEqual(film.count(b"ANMF"), 3)
        self.assertEqual([p.name for p in self.folder.iterdir() if "unfinished" in p.name], [])

    def test_benchmark(self):
        self.made(scene("cornell"), *self.SMALL, "--benchmark", self.path, "--frames", "3", "-o", "bench")
        names = sorted(p.name for p in (self.folder / "bench").iterdir())
        self.assertEqual(names, ["benchmark.json", "frame.0000.png", "frame.0001.png", "frame.0002.png",
                                 "settings.json", "times.csv"])
        summary = json.loads((self.folder / "bench/benchmark.json").read_text())
        self.assertEqual(summary["frames"], 3)
        self.assertGreater(summary["median_ms"], 0.0)
        rows = [row.split(",") for row in (self.folder / "bench/times.csv").read_text().splitlines()]
        self.assertEqual(rows[0], ["frame", "pass", "gpu_ms", "cpu_ms"])
        self.assertEqual([row[0] for row in rows if row[1] == "frame"], ["0", "1", "2"])
        self.assertIn("screen/base/gbuffer", {row[1] for row in rows})
        json.loads((self.folder / "bench/settings.json").read_text())

    def test_refusals(self):
        broken = self.folder / "broken.json"
        broken.write_text("{}")
        for code, part, *arguments in (
                (2, "-o", scene("cornell"), *self.SMALL),
                (2, "--size", scene("cornell"), "--headless", "--size", "wide", "-o", "x.png"),
                (2, "inside-out", scene("cornell"), *self.SMALL, "--view", "inside-out", "-o", "x.png"),
                (2, ".png", scene("cornell"), *self.SMALL, "-o", "x.jpg"),
                (2, "frobnicate", scene("cornell"), *self.SMALL, "--do", "frobnicate", "-o", "x.png"),
                (2, "vpl.count", scene("cornell"), *self.SMALL, "--do", "set vpl.count=0", "-o", "x.png"),
                (2, "vpl.counts", scene("cornell"), *self.SMALL, "--set", "vpl.counts=7", "-o", "x.png"),
                (3, "missing.glb", "missing.glb", *self.SMALL, "-o", "x.png"),
                (3, "broken.json", scene("cornell"), *self.SMALL, "--path", broken, "-o", "x.%04d.png"),
                (5, "--memory-limit", scene("cornell"), *self.SMALL, "--memory-limit", "10K", "-o", "x.png"),
                (6, "nowhere", scene("cornell"), *self.SMALL, "-o", "/nowhere/x.png")):
            with self.subTest(arguments=arguments):
                done = self.demo(*arguments)
                self.assertEqual(done.returncode, code, done.stderr)
                self.assert_one_line(done.stderr, part)
                self.assertEqual(list(self.folder.glob("x.*")), [])


class Times(WindowCase):
    """Prints figures; holds none. Not among the tests of ctest."""

    def frames_a_second(self, window, seconds=8.0):
        start = window.mark()
        eyes = 0
        end = time.monotonic() + seconds
        window.pointer(200, 180)
        window.tool("mousedown", 1)
        while time.monotonic() < end:
            eyes += 1
            window.pointer(200 + eyes % 100, 180 + eyes % 7)
            time.sleep(0.02)
        window.tool("mouseup", 1)
        window.read()
        at = [e["s"] for e in window.events[start:] if e["event"] == "frame"]
        return (len(at) - 1) / (at[-1] - at[0])

    def averaging(self, window, frames=12):
        start = window.wait("frame", None, window.mark())
        end = window.wait("frame", lambda e: e["frames"] >= start["frames"] + frames, longest=600)
        return (end["frames"] - start["frames"]) / (end["s"] - start["s"])

    def test_print(self):
        for name in ("cornell", "room"):
            window = self.window(scene(name), "--gi", "hybrid", size="640x360", quick=False)
            print(f"{name}: first picture after {window.find('first_picture')['s']:.2f} s")
            for motion in ("off", "12"):
                window.command(f"motion {motion}")
                print(f"{name}: orbiting, hybrid, 640x360, motion {motion}: {self.frames_a_second(window):.2f} fps")
            window.command("average 100000")
            off, on = [], []
            for _ in range(3):  # in turn, as other programs come and go
                off.append(self.averaging(window))
                mark = window.command("reference beside")
                window.wait("frame", lambda e: e["reference"] > 0, mark, 200)
                on.append(self.averaging(window))
                window.command("reference off")
            print(f"{name}: averaging {off} fps, {on} with the reference: ratio {sum(on) / sum(off):.2f}")
            window.quit()


def main():
    for name, value in zip(ORDER, sys.argv[1:]):
        setattr(Given, name, pathlib.Path(value).resolve() if value else None)
    cases = sys.argv[1 + len(ORDER):]
    needs_display = cases != ["Headless"]
    missing = [tool for tool in ("Xvfb", "xdotool") if not shutil.which(tool)]
    if not Given.hand or not Given.hand.exists():
        missing.append("x11_hand (libx11-dev was not there when this was built)")
    if needs_display and missing:
        print("missing: " + ", ".join(missing))
        sys.exit(1 if os.environ.get("VOLGI_REQUIRE_GL") else SKIPPED)
    if not cases:
        cases = [c.__name__ for c in (Volumes, Views, Stages, Light, Camera, Drop, Desktop, Screenshots, SettingsFile,
                                      Keyboard, Shaders, Memory, Displays, Headless)]
    try:
        program = unittest.main(argv=[sys.argv[0], "-v", *cases], exit=False)
    finally:
        if WindowCase.display:
            WindowCase.display.close()
    sys.exit(0 if program.result.wasSuccessful() else 1)


if __name__ == "__main__":
    main()
