"""Triangle meshes of smooth solids by surface nets: one vertex for each sheet of the surface in a cell, one quad across
each edge of the grid that the surface crosses, vertices then spread evenly and put onto the surface."""
import math
from functools import lru_cache

from . import shapes, vec

LEAF = 4          # cells on a side of the blocks whose every corner is evaluated
EVENING_ROUNDS = 4
FINAL_STEPS = 3   # square the distance to the surface each: the last but one leaves none that a float shows
CORNERS = tuple((i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1))
EDGES = tuple((a, b) for a in range(8) for b in (a + 4, a + 2, a + 1) if b < 8 and not a & (b - a))  # along X, Y, Z
FACES = tuple(tuple(c for c in range(8) if c >> axis & 1 == side) for axis in range(3) for side in (0, 1))


def _leaves(solid, low, cell, corner, size):
    """(corner, solid there) of the blocks that the surface may cross, in a fixed order."""
    centre = tuple(o + cell * (c + 0.5 * size) for o, c in zip(low, corner))
    solid = solid.near(centre, cell * (0.8660255 * size + 1))  # and a cell around, where vertices may move
    if solid is None:
        return
    if size == LEAF:
        yield corner, solid
        return
    half = size // 2
    for step in CORNERS:
        yield from _leaves(solid, low, cell, tuple(c + half * s for c, s in zip(corner, step)), half)


@lru_cache(maxsize=None)
def _sheets(inside):
    """Edges (indices) that each sheet of the surface crosses in a cell, of whose corners `inside` has the bits. On a
    face with four crossings the two corners inside are kept apart: both cells at it must choose alike."""
    sheet = {e: e for e, (a, b) in enumerate(EDGES) if (inside >> a & 1) != (inside >> b & 1)}
    for face in FACES:
        crossed = [e for e in sheet if EDGES[e][0] in face and EDGES[e][1] in face]
        for e in crossed:
            for other in crossed:
                if len(crossed) == 2 or any(c in EDGES[other] and inside >> c & 1 for c in EDGES[e]):
                    old, new = sheet[e], sheet[other]
                    sheet = {k: new if v == old else v for k, v in sheet.items()}
    return tuple(tuple(e for e in sheet if sheet[e] == one) for one in sorted(set(sheet.values())))


def _vertices(solid, low, cell, size):
    """[(point near the surface, solid there)], {(cell, edge of it): its vertex} and {corner of the grid: value}."""
    values, vertices, vertex_at = {}, [], {}
    for (x, y, z), local in _leaves(solid, low, cell, (0, 0, 0), size):
        for at in _block(x, y, z, LEAF + 1):
            if at not in values:
                values[at] = local.value(*(o + cell * c for o, c in zip(low, at)))[0]
        for at in _block(x, y, z, LEAF):
            f = [values[at[0] + i, at[1] + j, at[2] + k] for i, j, k in CORNERS]
            for edges in _sheets(sum(1 << c for c in range(8) if f[c] < 0)):
                middle = [0.0, 0.0, 0.0]
                for e in edges:
                    vertex_at[at, e] = len(vertices)
                    a, b = EDGES[e]
                    t = f[a] / (f[a] - f[b])
                    for i in range(3):
                        middle[i] += (CORNERS[a][i] + t * (CORNERS[b][i] - CORNERS[a][i])) / len(edges)
                vertices.append((tuple(o + cell * (c + m) for o, c, m in zip(low, at, middle)), local))
    return vertices, vertex_at, values


def _block(x, y, z, side):
    return ((x + i, y + j, z + k) for i in range(side) for j in range(side) for k in range(side))


def _quads(vertex_at, values):
    """The vertices around each crossed edge of the grid, counter-clockwise seen from outside."""
    rings = []
    for axis in range(3):
        step, b, c = 4 >> axis, 4 >> (axis + 1) % 3, 4 >> (axis + 2) % 3
        rings.append((CORNERS[step], [(CORNERS[o], EDGES.index((o, o + step))) for o in (b + c, c, 0, b)]))
    for at in sorted(values):
        for beyond, ring in rings:
            g = values.get((at[0] + beyond[0], at[1] + beyond[1], at[2] + beyond[2]))
            if g is not None and (values[at] < 0) != (g < 0):
                quad = [vertex_at[(at[0] - i, at[1] - j, at[2] - k), e] for (i, j, k), e in ring]
                yield quad if values[at] < 0 else quad[::-1]


def _onto(solid, p):
    """A Newton step along the gradient: the point there, and the normal before it."""
    f, gx, gy, gz = solid.value(*p)
    squared = gx * gx + gy * gy + gz * gz
    s, t = f / squared, 1 / math.sqrt(squared)
    return (p[0] - s * gx, p[1] - s * gy, p[2] - s * gz), (t * gx, t * gy, t * gz)


def _middle(points, chosen):
    """Not by sum(), whose rounding depends on Python's version."""
    x, y, z = 0.0, 0.0, 0.0
    for i in chosen:
        p = points[i]
        x, y, z = x + p[0], y + p[1], z + p[2]
    return x / len(chosen), y / len(chosen), z / len(chosen)


def _evened(points, solids, quads):
    """Each vertex moves to the middle of its neighbours along the grid, and back onto the surface."""
    around = [set() for _ in points]
    for quad in quads:
        for a, b in zip(quad, quad[1:] + quad[:1]):
            around[a].add(b)
            around[b].add(a)
    around = [sorted(neighbours) for neighbours in around]
    for _ in range(EVENING_ROUNDS):
        middles = [_middle(points, neighbours) for neighbours in around]
        points = [_onto(solid, p)[0] for solid, p in zip(solids, middles)]
    return points


def _split(points, quad):
    """Two triangles, by the shorter diagonal."""
    a, b, c, d = quad
    ac, bd = vec.sub(points[a], points[c]), vec.sub(points[b], points[d])
    return [(a, b, c), (a, c, d)] if vec.dot(ac, ac) <= vec.dot(bd, bd) else [(b, c, d), (b, d, a)]


def mesh(solid, low, high, cell):
    """The surface of `solid` between the corners `low` and `high`, which must lie outside it, in cells of `cell` m."""
    size = LEAF
    while size * cell < max(b - a for a, b in zip(low, high)):
        size *= 2
    vertices, vertex_at, values = _vertices(solid, low, cell, size)
    quads = list(_quads(vertex_at, values))
    solids = [local for _, local in vertices]
    points = _evened([_onto(local, p)[0] for p, local in vertices], solids, quads)
    made = shapes.Mesh()
    for local, p in zip(solids, points):
        for _ in range(FINAL_STEPS):
            p, n = _onto(local, p)
        made.positions.append(p)
        made.normals.append(n)
    made.triangles = [triangle for quad in quads for triangle in _split(made.positions, quad)]
    return made
