"""atrium: a court open to the sun, with arcades on two floors. About 66 000 triangles, 98 000 with detail."""
import math
from dataclasses import dataclass

from . import shapes, textures, vec
from .glb import Scene

BAY, BAYS_X, BAYS_Z = 3.0, 4, 6
X, Z = BAY * BAYS_X / 2, BAY * BAYS_Z / 2    # axes of the arcades, from the middle
GALLERY, WALL = 3.5, 0.4
EDGE = 0.3                                   # the floors reach this far into the court from the axes
FLOORS = (0.0, 4.4)                          # finished floor of each storey
CLEAR = 4.0                                  # from floor to ceiling
ROOF_TOP, PARAPET = 8.8, 9.3
COLUMN = 2.6                                 # with its plinth and abacus
ARCH_RADIUS, ARCH_DEPTH = 1.22, 0.46
SUNK = 0.02                                  # how far parts reach into each other: no coplanar faces, no gaps


@dataclass(frozen=True)
class Fineness:
    column: int         # segments around
    curve: int          # steps of a quarter round in a profile
    shaft: int          # rings of the shaft
    baluster: int
    arch: int
    vase: int
    cloth: int


NORMAL = Fineness(column=16, curve=2, shaft=4, baluster=8, arch=16, vase=24, cloth=12)
DETAIL = Fineness(column=18, curve=3, shaft=7, baluster=10, arch=26, vase=32, cloth=16)


def _shell():
    """Floors, outer walls with niches, roof over the galleries: one solid without its underside."""
    x, z = X + GALLERY, Z + GALLERY
    shell = shapes.Blocks(uv=True).fill((-x - WALL, -0.3, -z - WALL), (x + WALL, PARAPET, z + WALL))
    for floor in FLOORS:
        shell.carve((-x, floor, -z), (x, floor + CLEAR, z))
    shell.carve((-x, ROOF_TOP, -z), (x, PARAPET, z))
    shell.carve((EDGE - X, 0.0, EDGE - Z), (X - EDGE, PARAPET, Z - EDGE))
    for i in range(BAYS_Z):
        middle = BAY * (i + 0.5) - Z
        for side in (-1, 1):
            near, far = sorted((side * x, side * (x + 0.2)))
            shell.carve((near, 0.5, middle - 0.6), (far, 2.6, middle + 0.6))

    def material(centre, axis, sign, tag):
        inside = abs(centre[0]) <= x + 0.2 and abs(centre[2]) <= z
        if axis == 1:
            return 'tiles' if sign > 0 and inside else 'plaster'
        if not inside or (abs(centre[0]) < x and abs(centre[2]) < z):
            return 'stone'  # outside, and the edges of the floors
        return 'brick' if centre[1] < CLEAR else 'plaster'

    return shell.parts(material)


def _round(r, y, radius_r, radius_y, start, stop, steps):
    """Part of an ellipse in the profile plane, angles in quarter turns from +r towards +y."""
    angles = [math.pi / 2 * (start + (stop - start) * i / steps) for i in range(steps + 1)]
    return [(r + radius_r * math.cos(a), y + radius_y * math.sin(a)) for a in angles]


def _column(fine):
    runs = [_round(0.25, 0.185, 0.05, 0.065, -1, 1, 2 * fine.curve),
            [(0.25, 0.25), (0.235, 0.25)],
            _round(0.235, 0.29, 0.02, 0.04, -1, 1, 2 * fine.curve)]
    foot, head = 0.33, 2.25
    shaft = []
    for i in range(fine.shaft + 1):
        t = i / fine.shaft
        shaft.append((0.225 - 0.045 * t - 0.01 * t * (1 - t), foot + (head - foot) * t))
    runs += [[(0.235, foot), (0.225, foot)], shaft,
             [(0.18, head), (0.19, head)],
             _round(0.19, head + 0.025, 0.02, 0.025, -1, 1, 2 * fine.curve),
             [(0.19, head + 0.05), (0.185, head + 0.05)],
             _round(0.3, head + 0.05, -0.115, 0.17, 0, 1, 2 * fine.curve),
             [(0.3, head + 0.22), (0.3, COLUMN - 0.12 + SUNK)]]
    mesh = shapes.lathe(runs, fine.column, uv_repeat=(1.5, 1.0))
    mesh.merge(shapes.box((-0.32, 0.0, -0.32), (0.32, 0.12 + SUNK, 0.32), [(1, 0.0)], uv=True))
    return mesh.merge(shapes.box((-0.32, COLUMN - 0.12, -0.32), (0.32, COLUMN, 0.32), uv=True))


def _arch(fine):
    """One bay along +X from its column's axis, from the column's head into the floor above."""
    mesh = shapes.Mesh()
    bottom, top, depth = COLUMN - SUNK, CLEAR + SUNK, ARCH_DEPTH / 2
    middle = BAY / 2
    turns = [math.pi * i / fine.arch for i in range(fine.arch + 1)]
    curve = [(middle - ARCH_RADIUS * math.cos(a), bottom + ARCH_RADIUS * math.sin(a)) for a in turns]
    line = [(0.0, bottom)] + curve + [(BAY, bottom)]
    for (x0, y0), (x1, y1) in zip(line, line[1:]):
        outline = [(x0, y0), (x1, y1), (x1, top), (x0, top)]
        uvs = [(x, -y) for x, y in outline]
        mesh.face([(x, y, depth) for x, y in outline], uvs)
        mesh.face([(x, y, -depth) for x, y in outline[::-1]], uvs[::-1])
    for i in range(fine.arch):
        ends = []
        for k in (i, i + 1):
            normal = (math.cos(turns[k]), -math.sin(turns[k]), 0.0)
            ends.append((curve[k], normal, ARCH_RADIUS * turns[k]))
        (p, n, u), (q, m, v) = ends
        mesh.face([(*p, -depth), (*q, -depth), (*q, depth), (*p, depth)],
                  [(u, -depth), (v, -depth), (v, depth), (u, depth)], [n, m, m, n])
    return mesh


def _balustrade(fine):
    """One bay along +X between two plinths: kerb, balusters, rail."""
    kerb, rail = 0.17, 0.88
    profile = [(0.055, kerb - SUNK), (0.03, kerb + 0.1), (0.064, kerb + 0.27), (0.03, kerb + 0.54),
               (0.032, kerb + 0.62), (0.055, rail + SUNK)]
    baluster = shapes.lathe([profile], fine.baluster, uv_repeat=(0.3, 1.0))
    mesh = shapes.Mesh()
    inset = 0.3
    mesh.merge(shapes.box((inset, 0.0, -0.12), (BAY - inset, kerb, 0.12), [(1, 0.0)], uv=True))
    mesh.merge(shapes.box((inset - 0.1, rail, -0.1), (BAY - inset + 0.1, rail + 0.09, 0.1), uv=True))
    count = 11
    for i in range(count):
        x = inset + (BAY - 2 * inset) * (i + 0.5) / count
        mesh.merge(baluster, move=(x, 0.0, 0.0))
    return mesh


def _vase(fine):
    outside = [(0.16, 0.0), (0.17, 0.05), (0.1, 0.12), (0.2, 0.25), (0.29, 0.42), (0.31, 0.58), (0.26, 0.74),
               (0.19, 0.84), (0.17, 0.9), (0.21, 0.97), (0.25, 1.0)]
    inside = [(0.22, 1.0), (0.19, 0.97), (0.15, 0.9), (0.17, 0.84), (0.23, 0.74), (0.27, 0.58), (0.0, 0.45)]
    return shapes.lathe([outside, [outside[-1], inside[0]], inside], fine.vase)


def _fountain(fine):
    basin = [[(1.9, 0.0), (1.9, 0.5)], [(1.9, 0.5), (1.6, 0.5)], [(1.6, 0.5), (1.6, 0.15)], [(1.6, 0.15), (0.0, 0.15)]]
    stem = [(0.35, 0.15 - SUNK), (0.32, 0.4), (0.16, 0.6), (0.14, 1.0), (0.2, 1.2), (0.55, 1.38), (0.85, 1.6)]
    bowl = [(0.8, 1.6), (0.55, 1.45), (0.25, 1.38), (0.0, 1.36)]
    return shapes.lathe(basin + [stem, [stem[-1], bowl[0]], bowl], 2 * fine.vase)


def _banner(fine):
    """A hanging cloth in the plane of X and Y, its upper edge at y = 0; it waves along Z."""
    width, drop, columns, rows = 1.3, 3.0, fine.cloth, 2 * fine.cloth
    mesh = shapes.Mesh()

    def wave(u, v):
        return 0.09 * v * math.sin(2 * math.pi * (1.5 * u + 0.4 * v))

    for j in range(rows + 1):
        for i in range(columns + 1):
            u, v = i / columns, j / rows
            du = (wave(u + 1e-4, v) - wave(u - 1e-4, v)) / 2e-4 / width
            dv = (wave(u, v + 1e-4) - wave(u, v - 1e-4)) / 2e-4 / -drop
            mesh.positions.append(((u - 0.5) * width, -v * drop, wave(u, v)))
            mesh.normals.append(vec.normalize((-du, -dv, 1.0)))
            mesh.uvs.append((u, v))
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            c = a + columns + 1
            mesh.triangles += [(a, c, c + 1), (a, c + 1, a + 1)]
    return mesh


def _bays():
    """(origin, turn about Y) of each bay, so that its +X runs along the arcade and its +Z into the court."""
    for i in range(BAYS_X):
        yield (BAY * i - X, -Z), 0.0
        yield (X - BAY * i, Z), math.pi
    for i in range(BAYS_Z):
        yield (-X, Z - BAY * i), math.pi / 2
        yield (X, BAY * i - Z), -math.pi / 2


def _materials(scene):
    stone = scene.image('stone', textures.stone())
    # A texture coordinate is a metre; the transform says how many images fit in one.
    scene.material('stone', (1.0, 1.0, 1.0), texture=stone, uv_scale=(0.5, 0.5))
    scene.material('carved', (1.0, 0.98, 0.95), texture=stone, uv_scale=(0.25, 0.25), uv_offset=(0.3, 0.1))
    scene.material('brick', (1.0, 1.0, 1.0), texture=scene.image('brick', textures.brick()), uv_scale=(0.5, 0.5))
    scene.material('tiles', (1.0, 1.0, 1.0), texture=scene.image('tiles', textures.tiles()), uv_scale=(0.4, 0.4))
    scene.material('cloth', (1.0, 1.0, 1.0), texture=scene.image('cloth', textures.cloth()))
    scene.material('plaster', (0.78, 0.75, 0.68))
    scene.material('clay', (0.72, 0.5, 0.4))
    scene.material('marble', (0.8, 0.79, 0.77))


def atrium(detail=False):
    fine = DETAIL if detail else NORMAL
    scene = Scene('atrium_detail' if detail else 'atrium', 'A court open to the sun with arcades, balustrades and '
                  'banners on two floors, textured; the galleries are lit by bounces alone.', [(('shell',), False)])
    _materials(scene)
    scene.add('shell', _shell())
    column = scene.mesh('column', {'carved': _column(fine)})
    arch = scene.mesh('arch', {'stone': _arch(fine)})
    balustrade = scene.mesh('balustrade', {'carved': _balustrade(fine)})
    pier = scene.mesh('corner', {'stone': shapes.box((-0.25, COLUMN - SUNK / 2, -0.25), (0.25, CLEAR + SUNK, 0.25),
                                                     uv=True)})
    for storey, floor in enumerate(FLOORS):
        for n, ((x, z), turn) in enumerate(_bays()):
            place = {'translation': (x, floor, z), 'rotation': vec.about_y(turn)}
            scene.node('column%d_%02d' % (storey, n), column, translation=(x, floor, z))
            scene.node('arch%d_%02d' % (storey, n), arch, **place)
            if storey:
                scene.node('balustrade_%02d' % n, balustrade, **place)
        for n, (x, z) in enumerate(((-X, -Z), (X, -Z), (X, Z), (-X, Z))):
            scene.node('corner%d_%d' % (storey, n), pier, translation=(x, floor, z))
    banner = scene.mesh('banner', {'cloth': _banner(fine)})
    for n, z in enumerate((-6.0, 0.0, 6.0)):
        scene.node('banner_w%d' % n, banner, translation=(-X + 0.45, 4.3, z), rotation=vec.about_y(math.pi / 2))
        scene.node('banner_e%d' % n, banner, translation=(X - 0.45, 4.3, z), rotation=vec.about_y(-math.pi / 2))
    vase = scene.mesh('vase', {'clay': _vase(fine)})
    for n, z in enumerate((-7.5, -1.5, 4.5)):
        scene.node('vase_w%d' % n, vase, translation=(-X - 2.9, 0.0, z))
        scene.node('vase_e%d' % n, vase, translation=(X + 2.9, 0.0, z))
    scene.add('fountain', {'marble': _fountain(fine)})
    scene.camera((-7.9, 1.7, -10.3), (2.6, 2.3, 6.0), 66.0, zfar=100.0)
    scene.light('directional', 25.0, direction=(0.42, -1.0, 0.28), colour=(1.0, 0.94, 0.84))
    return scene
