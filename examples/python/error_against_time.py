#!/usr/bin/env python3
"""Error against time of a few techniques, as a plot: error_against_time.py [SCENE] [OUT.svg]

    PYTHONPATH=build/release/python examples/python/error_against_time.py data/cornell.glb out/error_against_time.svg

Each point is one picture; its error is the RMSE of indirect light in percent of the reference's mean. Times are wall clock of
a whole call, so they only compare with one another. `volgi report` does all of this thoroughly.
"""
import math
import sys
import time

import volgi

scene_file = sys.argv[1] if len(sys.argv) > 1 else "data/cornell.glb"
out = sys.argv[2] if len(sys.argv) > 2 else "error_against_time.svg"

# %% A scene, seen small, and what is right.
scene = volgi.load(scene_file, size=(64, 64))
reference = volgi.reference(scene, spp=256, light="indirect")

# %% What is compared: names, and the options that `volgi render` would have.
settings = [(f"volume, {n} cells", dict(gi="volume", grid=n)) for n in (8, 16, 32)]
settings += [(f"hybrid, {n} lights", dict(gi="hybrid", grid=16, vpls=n)) for n in (64, 256, 1024)]

points = []
for name, options in settings:
    volgi.render(scene, light="indirect", **options)  # shaders are compiled once
    start = time.perf_counter()
    picture = volgi.render(scene, light="indirect", **options)
    seconds = time.perf_counter() - start
    figures = volgi.compare(reference["color"], picture["color"], noise=reference["noise"])
    points.append((name, 1000 * seconds, figures.get("rmse_pct_denoised", figures["rmse_pct"]), figures["ratio"]))
    print(f"{name:20} {points[-1][1]:8.1f} ms  {points[-1][2]:6.2f} %  energy {points[-1][3]:.3f}")

# %% A plot of both axes' logarithms, without any library.
WIDTH, HEIGHT, MARGIN = 640, 420, 60


def scale(values, length):
    low, high = math.log10(min(values)) - 0.1, math.log10(max(values)) + 0.1
    return lambda v: (math.log10(v) - low) / (high - low) * length


x = scale([p[1] for p in points], WIDTH - 2 * MARGIN)
y = scale([p[2] for p in points], HEIGHT - 2 * MARGIN)
marks = []
for name, ms, error, _ in points:
    left, top = MARGIN + x(ms), HEIGHT - MARGIN - y(error)
    color = "#0072b2" if name.startswith("volume") else "#d55e00"
    marks.append(f'<circle cx="{left:.1f}" cy="{top:.1f}" r="5" fill="{color}"/>'
                 f'<text x="{left + 8:.1f}" y="{top + 4:.1f}">{name}: {ms:.0f} ms, {error:.1f} %</text>')
frame = f"M{MARGIN} {MARGIN}V{HEIGHT - MARGIN}H{WIDTH - MARGIN}"
with open(out, "w", encoding="utf-8") as file:
    file.write(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="11">'
               f'<rect width="100%" height="100%" fill="#fff"/><path d="{frame}" fill="none" stroke="#000"/>'
               f'<text x="{WIDTH / 2}" y="{HEIGHT - 20}" text-anchor="middle">time (logarithmic)</text>'
               f'<text x="20" y="{HEIGHT / 2}" transform="rotate(-90 20 {HEIGHT / 2})" text-anchor="middle">error (logarithmic)</text>'
               + "".join(marks) + "</svg>\n")
print("wrote", out)
