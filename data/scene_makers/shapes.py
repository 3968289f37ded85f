"""Triangle meshes: flat quads, unions of axis-aligned blocks, surfaces of revolution. Front faces counter-clockwise."""
import math

from . import vec


class Mesh:
    def __init__(self):
        self.positions, self.normals, self.uvs, self.triangles = [], [], [], []

    def face(self, corners, uvs=None, normals=None):
        """A planar convex polygon, counter-clockwise seen from its front; normals default to the plane's."""
        first = len(self.positions)
        if normals is None:
            n = vec.normalize(vec.cross(vec.sub(corners[1], corners[0]), vec.sub(corners[-1], corners[0])))
            normals = [n] * len(corners)
        self.positions += corners
        self.normals += normals
        if uvs:
            self.uvs += uvs
        self.triangles += [(first, first + i, first + i + 1) for i in range(1, len(corners) - 1)]

    def merge(self, other, turn=None, move=(0.0, 0.0, 0.0)):
        """Adds a copy of `other`, turned by a quaternion, then moved."""
        first = len(self.positions)
        place = (lambda p: vec.add(vec.rotate(turn, p), move)) if turn else (lambda p: vec.add(p, move))
        self.positions += [place(p) for p in other.positions]
        self.normals += [vec.rotate(turn, n) for n in other.normals] if turn else other.normals
        self.uvs += other.uvs
        self.triangles += [(a + first, b + first, c + first) for a, b, c in other.triangles]
        return self


def metric_uv(axis, p):
    """Texture coordinates in metres on a plane across `axis`: upright on walls, v growing downwards as in glTF."""
    return ((p[2], -p[1]), (p[0], p[2]), (p[0], -p[1]))[axis]


class Blocks:
    """Union and difference of axis-aligned boxes. Its surface has no overlaps, no T-junctions and no gaps, because all
    boxes share one grid of cuts. As a room (inward) the boxes are the air and the surface is seen from inside."""

    def __init__(self, inward=False, open_planes=(), uv=False):
        """open_planes: (axis, coordinate) of planes whose faces are left out, where the blocks stand on something."""
        self.inward, self.open_planes, self.uv = inward, set(open_planes), uv
        self.boxes = []
        self.cuts = [set(), set(), set()]

    def fill(self, low, high, tag=''):
        self.boxes.append((low, high, tag))
        for axis in range(3):
            self.cuts[axis] |= {low[axis], high[axis]}
        return self

    def carve(self, low, high):
        return self.fill(low, high, None)

    def cut(self, axis, *values):
        """More grid lines, so that the surface meets the vertices of a neighbour."""
        self.cuts[axis] |= set(values)
        return self

    def _cells(self, grid):
        cells = {}
        index = [{v: i for i, v in enumerate(line)} for line in grid]
        for low, high, tag in self.boxes:
            spans = [range(index[a][low[a]], index[a][high[a]]) for a in range(3)]
            for i in spans[0]:
                for j in spans[1]:
                    for k in spans[2]:
                        cells[i, j, k] = tag
        return {c: tag for c, tag in cells.items() if tag is not None}

    def faces(self):
        """Yields (corners, axis, sign of the front's normal, tag) in a fixed order."""
        grid = [sorted(c) for c in self.cuts]
        cells = self._cells(grid)
        for cell in sorted(cells):
            for axis in range(3):
                for sign in (-1, 1):
                    beside = list(cell)
                    beside[axis] += sign
                    at = grid[axis][cell[axis] + (sign > 0)]
                    if tuple(beside) in cells or (axis, at) in self.open_planes:
                        continue
                    b, c = (axis + 1) % 3, (axis + 2) % 3
                    corners = []
                    for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        p = [0.0] * 3
                        p[axis], p[b], p[c] = at, grid[b][cell[b] + u], grid[c][cell[c] + v]
                        corners.append(tuple(p))
                    front = -sign if self.inward else sign
                    yield (corners if front > 0 else corners[::-1]), axis, front, cells[cell]

    def parts(self, material=None):
        """{material: Mesh}; material(centre, axis, sign, tag) chooses it, by default the tag is its name."""
        parts = {}
        for corners, axis, sign, tag in self.faces():
            centre = tuple((corners[0][i] + corners[2][i]) / 2 for i in range(3))
            mesh = parts.setdefault(material(centre, axis, sign, tag) if material else tag, Mesh())
            normal = tuple(float(sign) if i == axis else 0.0 for i in range(3))
            mesh.face(corners, [metric_uv(axis, p) for p in corners] if self.uv else None, [normal] * 4)
        return parts

    def mesh(self):
        return self.parts(lambda *_: '').get('', Mesh())


def box(low, high, open_planes=(), uv=False):
    return Blocks(open_planes=open_planes, uv=uv).fill(low, high).mesh()


def turned_box(size, centre, angle_rad):
    """A box without its bottom, standing on y = centre[1], turned about the vertical."""
    x, z = size[0] / 2, size[2] / 2
    return Mesh().merge(box((-x, 0.0, -z), (x, size[1], z), [(1, 0.0)]), vec.about_y(angle_rad), centre)


def _run_normals(run):
    """Outward normals (in r, y) along a smooth run of a profile; y grows where the outside is at larger r."""
    steps = []
    for (r0, y0), (r1, y1) in zip(run, run[1:]):
        d = math.hypot(r1 - r0, y1 - y0)
        steps.append(((y1 - y0) / d, (r0 - r1) / d))
    normals = []
    for i in range(len(run)):
        near = steps[max(i - 1, 0):i + 1]
        n = (sum(s[0] for s in near), sum(s[1] for s in near))
        if run[i][0] == 0 and abs(n[1]) > abs(n[0]):
            n = (0.0, n[1])  # the pole of a dome, not the tip of a spire
        d = math.hypot(*n)
        normals.append((n[0] / d, n[1] / d))
    return normals


def lathe(runs, segments, uv_repeat=None, phase=0.0):
    """Revolves a profile about +Y. runs: polylines of (radius, y), each smooth within itself, creases between them;
    going up along one, the outside is on the side of larger radii. uv_repeat: (around, per metre along)."""
    mesh = Mesh()
    turns = [((math.cos(a), math.sin(a))) for a in (phase + 2 * math.pi * i / segments for i in range(segments))]
    turns.append(turns[0])
    along = 0.0
    for run in runs:
        first, width = len(mesh.positions), segments + 1
        for i, ((r, y), (nr, ny)) in enumerate(zip(run, _run_normals(run))):
            along += math.hypot(r - run[i - 1][0], y - run[i - 1][1]) if i else 0.0
            for k, (c, s) in enumerate(turns):
                mesh.positions.append((r * c, y, r * s))
                mesh.normals.append((nr * c, ny, nr * s))
                if uv_repeat:
                    mesh.uvs.append((uv_repeat[0] * (1 - k / segments), -along * uv_repeat[1]))
        for i in range(len(run) - 1):
            for k in range(segments):
                a, b = first + i * width + k, first + (i + 1) * width + k
                if run[i + 1][0] > 0:
                    mesh.triangles.append((a, b, b + 1))
                if run[i][0] > 0:
                    mesh.triangles.append((a, b + 1, a + 1))
    return mesh


def sphere(radius, centre, segments=24, rings=12):
    angles = [math.pi * (i / rings - 0.5) for i in range(rings + 1)]
    run = [(radius * math.cos(a), radius * math.sin(a)) for a in angles]
    run[0], run[-1] = (0.0, -radius), (0.0, radius)
    return Mesh().merge(lathe([run], segments), move=centre)
