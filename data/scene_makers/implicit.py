"""Smooth solids as functions: negative inside, about the distance in metres near the surface. Arithmetic and square
roots only, whose results are the same on every machine.

A shape's value(x, y, z) returns (distance, gradient x, y, z)."""
import math

from . import vec

# Bound on the length of gradients around the surface and outside (measured: 1.8; exact distances have 1). In the middle
# of an ellipsoid they are longer: should a block be left out for that, the mesher finds an edge without a cell.
STEEPEST = 2.0


class Ellipsoid:
    def __init__(self, centre, radii, along=(1.0, 0.0, 0.0), up=(0.0, 1.0, 0.0)):
        """radii: along `along`, along the part of `up` across it, and across both."""
        u = vec.normalize(along)
        v = vec.normalize(vec.sub(up, vec.scale(u, vec.dot(u, up))))
        self.centre, self.axes = centre, (u, v, vec.cross(u, v))
        self.inverse = tuple(1 / r for r in radii)

    def value(self, x, y, z):
        x, y, z = x - self.centre[0], y - self.centre[1], z - self.centre[2]
        (ux, uy, uz), (vx, vy, vz), (wx, wy, wz) = self.axes
        i, j, k = self.inverse
        a, b, c = (ux * x + uy * y + uz * z) * i, (vx * x + vy * y + vz * z) * j, (wx * x + wy * y + wz * z) * k
        size = math.sqrt(a * a + b * b + c * c) + 1e-9  # of p / r
        a, b, c = a * i, b * j, c * k
        slope = math.sqrt(a * a + b * b + c * c) + 1e-9  # of p / r²
        d = size * (size - 1) / slope
        s, t = (2 * size - 1) / (slope * size), d / (slope * slope)
        a, b, c = a * (s - t * i * i), b * (s - t * j * j), c * (s - t * k * k)
        return d, ux * a + vx * b + wx * c, uy * a + vy * b + wy * c, uz * a + vz * b + wz * c


class RoundCone:
    """The hull of two spheres."""

    def __init__(self, a, radius_a, b, radius_b):
        self.a, self.radius_a, self.radius_b = a, radius_a, radius_b
        self.length = vec.length(vec.sub(b, a))
        self.axis = vec.scale(vec.sub(b, a), 1 / self.length)
        self.sine = (radius_a - radius_b) / self.length
        self.cosine = math.sqrt(1 - self.sine * self.sine)

    def value(self, x, y, z):
        x, y, z = x - self.a[0], y - self.a[1], z - self.a[2]
        ax, ay, az = self.axis
        s = x * ax + y * ay + z * az
        x, y, z = x - s * ax, y - s * ay, z - s * az
        q = math.sqrt(x * x + y * y + z * z) + 1e-12
        side = self.cosine * s - self.sine * q  # where the foot on the flank would be
        if 0 < side < self.cosine * self.length:
            d, across, along = self.cosine * q + self.sine * s - self.radius_a, self.cosine, self.sine
        else:
            s, radius = (s, self.radius_a) if side <= 0 else (s - self.length, self.radius_b)
            r = math.sqrt(q * q + s * s) + 1e-12
            d, across, along = r - radius, q / r, s / r
        across /= q
        return d, across * x + along * ax, across * y + along * ay, across * z + along * az


class Widened:
    """`shape`, `factor` times as wide along the unit vector `across`, about a point."""

    def __init__(self, shape, centre, across, factor):
        self.shape, self.centre, self.across, self.less = shape, centre, across, 1 / factor - 1

    def value(self, x, y, z):
        ax, ay, az = self.across
        cx, cy, cz = self.centre
        s = self.less * (ax * (x - cx) + ay * (y - cy) + az * (z - cz))
        d, gx, gy, gz = self.shape.value(x + s * ax, y + s * ay, z + s * az)
        s = self.less * (ax * gx + ay * gy + az * gz)
        return d, gx + s * ax, gy + s * ay, gz + s * az


def _joined(f, g, blend):
    """Least of two values, rounded off where they differ by less than `blend` [m] (quadratic smooth minimum)."""
    if f[0] > g[0]:
        f, g = g, f
    h = (blend - g[0] + f[0]) / blend
    if h <= 0:
        return f
    s = 1 - 0.5 * h
    t = 0.5 * h
    return (f[0] - 0.25 * h * h * blend, s * f[1] + t * g[1], s * f[2] + t * g[2], s * f[3] + t * g[3])


class Hollowed:
    """`shape` without `hollow`, the rim rounded over `blend` [m]."""

    def __init__(self, shape, hollow, blend):
        self.shape, self.hollow, self.blend = shape, hollow, blend

    def value(self, x, y, z):
        f, g = self.shape.value(x, y, z), self.hollow.value(x, y, z)
        d, gx, gy, gz = _joined((-f[0], -f[1], -f[2], -f[3]), g, self.blend)
        return -d, -gx, -gy, -gz


class Relief:
    """Smooth bumps on whatever is around: moves the surface by up to `height` [m], about `period` [m] apart."""
    DIRECTIONS = ((0.36, 0.48, 0.8), (-0.96, 0.36, 0.8), (0.5, 0.64, -0.36))  # of unequal lengths: no rows

    def __init__(self, height, period):
        self.height, self.scale = height, 1 / period

    def value(self, x, y, z):
        f, gx, gy, gz = self.height, 0.0, 0.0, 0.0
        for a, b, c in self.DIRECTIONS:
            t = (a * x + b * y + c * z) * self.scale
            u = t - math.floor(t)
            w = u * (1 - u)
            wave, slope = 32 * w * w - 1, 64 * w * (1 - 2 * u) * self.scale * f
            gx, gy, gz = gx * wave + slope * a, gy * wave + slope * b, gz * wave + slope * c
            f *= wave
        return f, gx, gy, gz


class Union:
    """Shapes joined one after another, each with its own rounding: a list of (shape, blend [m])."""

    def __init__(self, shapes, relief):
        self.shapes, self.relief = shapes, relief

    def value(self, x, y, z):
        joined = self.shapes[0][0].value(x, y, z)
        for shape, blend in self.shapes[1:]:
            joined = _joined(joined, shape.value(x, y, z), blend)
        d, gx, gy, gz = self.relief.value(x, y, z)
        return joined[0] + d, joined[1] + gx, joined[2] + gy, joined[3] + gz

    def near(self, centre, radius):
        """The same function within `radius` of a point, without the shapes that cannot matter there; None where there
        is no surface."""
        if abs(self.value(*centre)[0]) > STEEPEST * radius:
            return None
        values = [shape.value(*centre)[0] for shape, _ in self.shapes]
        # Rounding lowers what later shapes meet: the widest counts, and what it takes off, a quarter, twice.
        limit = min(values) + 2 * STEEPEST * radius + 1.5 * max(blend for _, blend in self.shapes)
        kept = [pair for pair, value in zip(self.shapes, values) if value <= limit]
        return Union(kept, self.relief)
