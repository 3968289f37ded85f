"""arena: an open oval of stone tiers under the sun, with a colonnade on top. About 10 000 triangles."""
import math

from . import shapes
from .glb import Scene

SEGMENTS, STRETCH = 96, 1.25     # round, then stretched along X by its node's scale
FIELD, TIERS, TREAD, RISER, PODIUM = 15.0, 12, 0.9, 0.45, 1.5
CONCOURSE, OUTER, GROUND = FIELD + TREAD * TIERS, 30.0, 36.0
TOP = PODIUM + RISER * TIERS
ROOF = TOP + 4.6
COLUMNS, COLUMN_CIRCLE = 36, 28.5


def _around(*runs):
    """Profiles run from the outside over the top to the middle, so that their fronts face the sky."""
    return shapes.lathe([list(run) for run in runs], SEGMENTS)


def _tiers(first, last):
    runs = []
    for i in reversed(range(first, last)):
        r, y = FIELD + TREAD * i, PODIUM + RISER * i
        runs.append([(r + TREAD, y + RISER), (r + TREAD, y)])
        runs.append([(r + TREAD, y), (r, y)])
    return runs


def _column():
    shaft = [(0.42, 0.35), (0.4, 2.2), (0.34, 4.1)]
    capital = [(0.34, 4.1), (0.62, ROOF - TOP + 0.05)]  # ends inside the roof
    return shapes.lathe([[(0.6, 0.0), (0.6, 0.35)], [(0.6, 0.35), (0.42, 0.35)], shaft, capital], 10)


def _on_oval(angle, radius):
    return (STRETCH * radius * math.cos(angle), radius * math.sin(angle))


def arena():
    scene = Scene('arena', 'An open arena in low sun: tiers, a colonnade, long shadows that only bounces fill.',
                  [(('roof',), False)])
    scene.material('stone', (0.72, 0.68, 0.62))
    scene.material('seats', (0.7, 0.42, 0.34))
    scene.material('sand', (0.7, 0.6, 0.45))
    scene.material('marble', (0.78, 0.77, 0.74))
    stands = [[(OUTER, 0.0), (OUTER, TOP)], [(OUTER, TOP), (CONCOURSE, TOP)]]
    podium = [[(FIELD, PODIUM), (FIELD, 0.0)]]
    oval = (STRETCH, 1.0, 1.0)
    scene.add('ground', {'sand': _around([(GROUND, 0.0), (OUTER, 0.0)])}, scale=oval)
    scene.add('stands', {'stone': _around(*stands, *_tiers(6, TIERS), *podium), 'seats': _around(*_tiers(0, 6))},
              scale=oval)
    scene.add('field', {'sand': _around([(FIELD, 0.0), (7.5, 0.0), (0.0, 0.0)])}, scale=oval)
    scene.add('roof', {'stone': _around([(27.4, ROOF), (29.6, ROOF)], [(29.6, ROOF), (29.6, ROOF + 0.8)],
                                        [(29.6, ROOF + 0.8), (27.4, ROOF + 0.8)], [(27.4, ROOF + 0.8), (27.4, ROOF)])},
              scale=oval)
    column = scene.mesh('column', {'marble': _column()})
    for i in range(COLUMNS):
        x, z = _on_oval(2 * math.pi * (i + 0.5) / COLUMNS, COLUMN_CIRCLE)
        scene.node('column%02d' % i, column, translation=(x, TOP, z))
    obelisk = shapes.turned_box((2.0, 1.2, 2.0), (0.0, 0.0, 0.0), 0.3)
    obelisk.merge(shapes.lathe([[(0.7, 1.2), (0.35, 7.0)], [(0.35, 7.0), (0.0, 7.8)]], 16))
    scene.add('obelisk', {'marble': obelisk})
    crate = scene.mesh('crate', {'seats': shapes.turned_box((1.6, 1.2, 1.0), (0.0, 0.0, 0.0), 0.0)})
    for i, (x, z, turn) in enumerate(((6.0, 5.0, 0.2), (9.5, -4.0, 0.9), (-6.0, 3.5, 1.3), (3.0, -8.0, 2.0))):
        scene.node('crate%d' % i, crate, translation=(x, 0.0, z), rotation=shapes.vec.about_y(turn))
    scene.camera((-23.8, 6.8, 11.0), (14.0, 2.6, -5.0), 50.0, zfar=200.0)
    scene.light('directional', 25.0, direction=(-0.62, -0.5, 0.3), colour=(1.0, 0.92, 0.8))
    return scene
