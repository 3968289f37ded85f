#!/usr/bin/python3
"""FLIP of `volgi compare` against the papers' formulas in NumPy: two-dimensional kernels, in double. And what other
programs write: crops, parts, layers, PNG.

flip_figures.py VOLGI SOURCE_FOLDER
"""
import json
import pathlib
import subprocess
import sys
import tempfile

try:
    import numpy as np
    import OpenImageIO as oiio
except ImportError as missing:
    print("SKIPPED:", missing)
    sys.exit(77)

volgi, source = sys.argv[1], pathlib.Path(sys.argv[2])
PPD = 0.7 * 3840 / 0.7 * np.pi / 180
XYZ = np.array([[10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
                [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
                [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382]])
WHITE = XYZ @ np.ones(3)


def opponent(rgb):
    x, y, z = np.moveaxis((rgb @ XYZ.T) / WHITE, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], -1)


def rgb_of_opponent(c):
    y = (c[..., 0] + 16) / 116
    xyz = np.stack([y + c[..., 1] / 500, y, y - c[..., 2] / 200], -1) * WHITE
    return xyz @ np.linalg.inv(XYZ).T


def hunt_lab(rgb):
    t = (rgb @ XYZ.T) / WHITE
    d = 6 / 29
    f = np.where(t > d**3, np.cbrt(t), t / (3 * d * d) + 4 / 29)
    lightness = 116 * f[..., 1] - 16
    return np.stack([lightness, 0.01 * lightness * 500 * (f[..., 0] - f[..., 1]),
                     0.01 * lightness * 200 * (f[..., 1] - f[..., 2])], -1)


def hyab(a, b):
    d = a - b
    return np.abs(d[..., 0]) + np.hypot(d[..., 1], d[..., 2])


def convolve(plane, kernel):
    """As the papers' code has it: a correlation, the edge of the picture goes on."""
    r = kernel.shape[0] // 2
    padded = np.pad(plane, r, mode="edge")
    out = np.zeros_like(plane)
    for j in range(2 * r + 1):
        for i in range(2 * r + 1):
            out += kernel[j, i] * padded[j:j + plane.shape[0], i:i + plane.shape[1]]
    return out


def csf(a1, b1, a2, b2):
    r = int(np.ceil(3 * np.sqrt(0.04 / (2 * np.pi**2)) * PPD))
    x, y = np.meshgrid(np.arange(-r, r + 1) / PPD, np.arange(-r, r + 1) / PPD)
    z = x * x + y * y
    k = sum(a * np.sqrt(np.pi / b) * np.exp(-np.pi**2 * z / b) for a, b in ((a1, b1), (a2, b2)))
    return k / k.sum()


def features(y):
    deviation = 0.5 * 0.082 * PPD
    r = int(np.ceil(3 * deviation))
    i, j = np.meshgrid(np.arange(-r, r + 1), np.arange(-r, r + 1))
    g = np.exp(-(i * i + j * j) / (2 * deviation**2))
    lengths = []
    for kernel in (-i * g, (i * i / deviation**2 - 1) * g):
        kernel = np.where(kernel < 0, kernel / -kernel[kernel < 0].sum(), kernel / kernel[kernel > 0].sum())
        lengths.append(np.hypot(convolve(y, kernel), convolve(y, kernel.T)))
    return lengths


def ldr(reference, test):
    a, b = opponent(reference), opponent(test)
    kernels = [csf(1, 0.0047, 0, 1e-5), csf(1, 0.0053, 0, 1e-5), csf(34.1, 0.04, 13.5, 0.025)]
    seen = [hunt_lab(np.clip(rgb_of_opponent(np.stack([convolve(p[..., c], kernels[c]) for c in range(3)], -1)), 0, 1))
            for p in (a, b)]
    largest = hyab(hunt_lab(np.array([0., 1, 0])), hunt_lab(np.array([0., 0, 1])))**0.7
    d = hyab(*seen)**0.7
    knee = 0.4 * largest
    color = np.where(d < knee, 0.95 / knee * d, 0.95 + (d - knee) / (largest - knee) * 0.05)
    (edge_a, point_a), (edge_b, point_b) = (features((p[..., 0] + 16) / 116) for p in (a, b))
    feature = (np.maximum(np.abs(edge_a - edge_b), np.abs(point_a - point_b)) / np.sqrt(2))**0.5
    return color**(1 - feature)


def hdr(reference, test):
    k = [0.6 * 0.6 * 2.51, 0.6 * 0.03, 0, 0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14]
    a, b, c = k[0] - 0.85 * k[3], k[1] - 0.85 * k[4], k[2] - 0.85 * k[5]
    end = max(np.roots([a, b, c]).real)
    y = (reference @ XYZ.T)[..., 1]
    start, stop = np.log2(end / y.max()), np.log2(end / np.median(y[y > 0]))
    result = np.zeros(y.shape)
    for ev in np.linspace(start, stop, max(2, int(np.ceil(stop - start)))):
        mapped = []
        for image in (reference, test):
            x = np.maximum(image, 0) * 2**ev
            mapped.append(np.clip((k[0] * x * x + k[1] * x) / (k[3] * x * x + k[4] * x + k[5]), 0, 1))
        result = np.maximum(result, ldr(*mapped))
    return result


def write(path, image, origin=(0, 0), full=None):
    spec = oiio.ImageSpec(image.shape[1], image.shape[0], 3, "float")
    spec.x, spec.y = origin
    if full is not None:
        spec.full_width, spec.full_height = full
    buffer = oiio.ImageBuf(spec)
    buffer.set_pixels(oiio.ROI(origin[0], origin[0] + image.shape[1], origin[1], origin[1] + image.shape[0]),
                      image.astype(np.float32))
    assert buffer.write(str(path)), buffer.geterror()


def write_parts(path, parts):
    """@param parts  name, channel names, values"""
    specs = []
    for name, channels, values in parts:
        spec = oiio.ImageSpec(values.shape[1], values.shape[0], len(channels), "float")
        spec.channelnames = channels
        spec.attribute("oiio:subimagename", name)
        specs.append(spec)
    out = oiio.ImageOutput.create(str(path))
    assert out.open(str(path), tuple(specs)), out.geterror()
    for i, (_, _, values) in enumerate(parts):
        if i > 0:
            assert out.open(str(path), specs[i], "AppendSubimage"), out.geterror()
        assert out.write_image(values.astype(np.float32)), out.geterror()
    out.close()


def compare(a, b):
    run = subprocess.run([volgi, "compare", a, b, "--region", "all", "--json"], capture_output=True, text=True, check=True)
    return json.loads(run.stdout)[0]


random = np.random.default_rng(5)
y, x = np.mgrid[0:56, 0:72]
smooth = np.stack([0.2 + x / 72, 0.1 + y / 56, 0.6 + 0.3 * np.sin(x / 5)], -1)
noisy = smooth * np.exp(0.3 * random.standard_normal(smooth.shape))
bright = smooth.copy()
bright[20:24, 30:34] *= 400
dark = smooth * 0.02
shifted = np.roll(bright, 2, axis=1)

with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    for reference, test in ((smooth, noisy), (bright, shifted), (dark, dark * 1.1), (smooth, smooth), (bright, smooth)):
        write(folder / "a.exr", reference)
        write(folder / "b.exr", test)
        single = [p.astype(np.float32).astype(np.float64) for p in (reference, test)]
        found, expected = compare(folder / "a.exr", folder / "b.exr")["flip"], hdr(*single).mean()
        print(f"HDR {found:.6f} {expected:.6f}")
        assert abs(found - expected) < 1e-4, (found, expected)
    # For a screen: bytes of sRGB.
    for reference, test in ((smooth, noisy), (np.zeros_like(smooth), np.ones_like(smooth)), (smooth, np.roll(smooth, 3, 0))):
        linear = []
        for path, image in ((folder / "a.png", reference), (folder / "b.png", test)):
            encoded = np.clip(image, 0, 1)
            encoded = np.where(encoded <= 0.0031308, 12.92 * encoded, 1.055 * encoded**(1 / 2.4) - 0.055)
            code = np.round(255 * encoded) / 255
            buffer = oiio.ImageBuf(oiio.ImageSpec(image.shape[1], image.shape[0], 3, "uint8"))
            buffer.set_pixels(oiio.ROI(), code.astype(np.float32))
            assert buffer.write(str(path)), buffer.geterror()
            linear.append(np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055)**2.4))
        found, expected = compare(folder / "a.png", folder / "b.png")["flip"], ldr(*linear).mean()
        print(f"LDR {found:.6f} {expected:.6f}")
        assert abs(found - expected) < 1e-4, (found, expected)
    # Crops of one picture agree wherever they lie, and two of one size that lie elsewhere are not alike.
    write(folder / "whole.exr", smooth)
    write(folder / "left.exr", smooth[8:40, 4:44], (4, 8), (72, 56))
    write(folder / "right.exr", smooth[10:42, 20:60], (20, 10), (72, 56))
    for one, other, pixels in (("whole", "left", 32 * 40), ("right", "whole", 32 * 40), ("left", "right", 30 * 24)):
        found = compare(folder / f"{one}.exr", folder / f"{other}.exr")
        assert found["pixels"] == pixels and found["max_absolute"] == 0, (one, other, found)
    write(folder / "moved.exr", smooth[8:40, 4:44], (20, 10), (72, 56))
    assert compare(folder / "left.exr", folder / "moved.exr")["max_absolute"] > 0.1
    write(folder / "far.exr", smooth[:8, :8], (60, 40), (72, 56))
    run = subprocess.run([volgi, "compare", folder / "left.exr", folder / "far.exr"], capture_output=True, text=True)
    assert run.returncode == 3 and "none in common" in run.stderr and "60,40" in run.stderr, run.stderr
    write(folder / "small.exr", smooth[:50])
    run = subprocess.run([volgi, "compare", folder / "whole.exr", folder / "small.exr"], capture_output=True, text=True)
    assert run.returncode == 3 and "72x50" in run.stderr and "72x56" in run.stderr, run.stderr

    # Parts and layers, as Blender and others write them.
    depth = np.ones(smooth.shape[:2] + (1,))
    write_parts(folder / "parts.exr", [("ViewLayer.Depth", ("Z",), depth), ("ViewLayer.Combined", ("R", "G", "B"), smooth)])
    write_parts(folder / "layers.exr", [("", ("View.Combined.R", "View.Combined.G", "View.Combined.B", "View.Depth.Z"),
                                         np.concatenate([smooth, depth], -1))])
    write_parts(folder / "first.exr", [("rgba", ("R", "G", "B"), smooth), ("depth", ("Z",), depth)])
    for name in ("parts", "layers", "first"):
        assert compare(folder / "whole.exr", folder / f"{name}.exr")["max_absolute"] == 0, name
    # A PNG of a picture, for a look.
    run = subprocess.run([volgi, "compare", folder / "whole.exr", folder / "a.png"], capture_output=True, text=True)
    assert run.returncode == 0 and "for a look alone" in run.stderr, run.stderr
