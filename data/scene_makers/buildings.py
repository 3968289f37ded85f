"""Scenes of many rooms, lamps or steps: light that passes doors, comes from everywhere, or falls on open tiers."""
import math

from . import shapes, vec
from .glb import Scene

ROOM, WALL, SLAB, HEIGHT = 2.5, 0.15, 0.25, 2.5
DOOR_WIDTH, DOOR_HEIGHT, LEAF, LAP, AJAR = 0.9, 2.0, 0.04, 0.02, 0.15
COLUMNS, ROWS = 3, 2


def _at(corner, *offset):
    """Without what sums of decimals leave behind: blocks share their cuts by value."""
    return tuple(round(c + o, 6) for c, o in zip(corner, offset))


def _room_low(column, row, storey):
    return _at((0.0, 0.0, 0.0), column * (ROOM + WALL), storey * (HEIGHT + SLAB), row * (ROOM + WALL))


def _air(column, row, storey):
    low = _room_low(column, row, storey)
    return low, _at(low, ROOM, HEIGHT, ROOM)


# Doorways: the room on the side of smaller coordinates, the axis they are passed along, and where they begin across it.
_DOORS = (((0, 0, 0), 0, 1.4), ((1, 0, 0), 2, 0.2), ((1, 1, 0), 0, 1.2), ((0, 1, 0), 0, 0.3),
          ((0, 0, 1), 0, 0.3), ((1, 0, 1), 2, 1.4), ((1, 1, 1), 0, 0.4))


def _doorway(room, axis, begin):
    """Low and high corner of the hole in the wall."""
    low, high = _air(*room)
    across = 2 - axis
    hole_low, hole_high = list(low), list(low)
    hole_low[axis], hole_high[axis] = high[axis], high[axis] + WALL
    hole_low[across], hole_high[across] = low[across] + begin, low[across] + begin + DOOR_WIDTH
    hole_high[1] = low[1] + DOOR_HEIGHT
    return _at(hole_low, 0, 0, 0), _at(hole_high, 0, 0, 0)


def _leaf(room, axis, begin):
    """A door on the far face of its wall, hinged at the far end of its hole and opened until the gap at its edge is
    AJAR wide. It laps over the hole, so that nothing shines through at the hinge."""
    low, high = _doorway(room, axis, begin)
    across = 2 - axis
    hinge, closed_low, closed_high = [0.0] * 3, [0.0] * 3, [0.0] * 3
    hinge[axis], hinge[1], hinge[across] = high[axis] + LEAF / 2, low[1], high[across] + LAP
    closed_low[axis], closed_high[axis] = -LEAF / 2, LEAF / 2
    closed_low[across], closed_high[1] = -DOOR_WIDTH - LAP, DOOR_HEIGHT + LAP
    angle = math.asin(AJAR / (DOOR_WIDTH + LAP)) * (1.0 if axis == 2 else -1.0)
    leaf = shapes.box(tuple(closed_low), tuple(closed_high), [(1, 0.0)])
    return shapes.Mesh().merge(leaf, vec.about_y(angle), tuple(hinge))


def house():
    scene = Scene('house', 'Twelve rooms on two storeys, doors ajar by 15 cm. The sun comes through one window, a lamp '
                  'hangs upstairs; the room that is seen gets their light through two doors.', [(('walls',), False)])
    scene.material('plaster', (0.85, 0.85, 0.82))
    scene.material('boards', (0.7, 0.62, 0.52))
    scene.material('wood', (0.62, 0.42, 0.27))
    scene.material('blue', (0.35, 0.45, 0.7))
    last = _air(COLUMNS - 1, ROWS - 1, 1)[1]
    walls = shapes.Blocks().fill((-WALL, -SLAB, -WALL), _at(last, WALL, SLAB, WALL))
    for storey in range(2):
        for column in range(COLUMNS):
            for row in range(ROWS):
                walls.carve(*_air(column, row, storey))
    for door in _DOORS:
        walls.carve(*_doorway(*door))
    walls.carve((0.7, 0.8, -WALL), (1.8, 2.0, 0.0))  # the window, of room (0, 0, 0)
    hall = _room_low(1, 0, 0)
    walls.carve(_at(hall, 1.2, HEIGHT, 0.2), _at(hall, 2.2, HEIGHT + SLAB, 1.2))  # to the hall upstairs

    def material(centre, axis, sign, tag):
        if axis == 1:
            return 'boards' if sign > 0 else 'plaster'
        return 'blue' if axis == 0 and sign > 0 and centre[0] > 2 * ROOM and centre[2] > ROOM else 'plaster'

    scene.add('walls', walls.parts(material))
    leaves = shapes.Mesh()
    for door in _DOORS:
        leaves.merge(_leaf(*door))
    scene.add('doors', {'wood': leaves})
    seen = _room_low(1, 1, 0)
    scene.add('cupboard', {'wood': shapes.turned_box((0.5, 1.1, 0.7), (seen[0] + 0.6, 0.0, seen[2] + 1.9), 0.3)})
    scene.add('table', {'wood': shapes.turned_box((0.8, 0.7, 0.8), (seen[0] + 1.7, 0.0, seen[2] + 1.6), 0.5)})
    lamp = _room_low(0, 0, 1)
    scene.camera((seen[0] + 2.3, 1.5, seen[2] + 2.35), (seen[0] + 0.9, 0.95, seen[2] + 0.3), 75.0)
    scene.light('directional', 60.0, direction=(0.35, -0.6, 0.75))
    scene.light('point', 25.0, (lamp[0] + 1.25, lamp[1] + 2.0, 1.25))
    return scene


def office():
    scene = Scene('office', 'A closed office of partitions under 24 small panels, with six lamps on the desks.',
                  [(('shell',), True)])
    scene.material('plaster', (0.8, 0.8, 0.78))
    scene.material('carpet', (0.3, 0.33, 0.38))
    scene.material('fabric', (0.45, 0.5, 0.42))
    scene.material('desk', (0.6, 0.52, 0.42))
    scene.material('panel', (0.6, 0.6, 0.6), radiance=(14.0, 13.5, 12.0))
    scene.material('bulb', (0.5, 0.5, 0.5), radiance=(60.0, 42.0, 22.0))
    shell = shapes.Blocks(inward=True).fill((0.0, 0.0, 0.0), (12.0, 2.7, 8.0))
    scene.add('shell', shell.parts(lambda c, axis, sign, tag: 'carpet' if axis == 1 and sign > 0 else 'plaster'))
    panels = shapes.Mesh()
    for column in range(6):
        for row in range(4):
            x, z = 1.0 + 2.0 * column, 1.0 + 2.0 * row
            panels.merge(shapes.box((x - 0.15, 2.62, z - 0.15), (x + 0.15, 2.66, z + 0.15)))
    scene.add('panels', {'panel': panels})
    partitions, desks, bulbs = shapes.Mesh(), shapes.Mesh(), shapes.Mesh()
    for column in range(3):
        x = 2.0 + 4.0 * column
        partitions.merge(shapes.box((x - 0.03, 0.0, 1.2), (x + 0.03, 1.4, 6.8), [(1, 0.0)]))
        for row in range(2):
            z = 2.4 + 3.0 * row
            desks.merge(shapes.box((x + 0.1, 0.7, z - 0.7), (x + 0.9, 0.74, z + 0.7)))
            for leg in (-0.65, 0.6):
                desks.merge(shapes.box((x + 0.15, 0.0, z + leg), (x + 0.85, 0.7, z + leg + 0.05),
                                       [(1, 0.0), (1, 0.7)]))
            bulbs.merge(shapes.sphere(0.05, (x + 0.35, 1.05, z - 0.4), 12, 6))
    scene.add('partitions', {'fabric': partitions})
    scene.add('desks', {'desk': desks})
    scene.add('bulbs', {'bulb': bulbs})
    scene.camera((11.6, 1.7, 7.6), (5.0, 0.9, 3.2), 62.0)
    return scene


def steps():
    scene = Scene('steps', 'An open theatre of stone tiers, 0.4 m each and 30 m across, under a low sun.')
    scene.material('stone', (0.7, 0.66, 0.58))
    scene.material('sand', (0.55, 0.45, 0.32))
    scene.material('wood', (0.5, 0.32, 0.2))
    rise, going, inner, count = 0.4, 0.7, 5.0, 12
    profile = []
    for i in range(count):
        radius = inner + going * i
        profile.append([(radius, rise * i), (radius, rise * (i + 1))])
        profile.append([(radius, rise * (i + 1)), (radius + going, rise * (i + 1))])
    scene.add('tiers', {'stone': _half_turn(profile, 48)})
    ground = shapes.Mesh()
    ground.face([(-15.0, 0.0, 8.0), (15.0, 0.0, 8.0), (15.0, 0.0, -15.0), (-15.0, 0.0, -15.0)])
    scene.add('ground', {'sand': ground})
    stage = shapes.Blocks(open_planes=[(1, 0.0)]).fill((-6.0, 0.0, 4.0), (6.0, 3.5, 4.4))
    for x in (-4.0, -0.6, 2.8):
        stage.carve((x, 0.0, 4.0), (x + 1.2, 2.4, 4.4))
    scene.add('wall', {'stone': stage.mesh()})
    scene.add('platform', {'wood': shapes.box((-3.0, 0.0, 0.5), (3.0, 0.5, 3.0), [(1, 0.0)])})
    scene.camera((7.5, 5.2, -6.6), (-2.0, 0.6, 1.0), 55.0, zfar=100.0)
    scene.light('directional', 20.0, direction=(0.75, -0.5, 0.35))
    return scene


def _half_turn(runs, segments):
    """Revolves a profile of (radius, y), each run a flat step, about +Y through the half of -Z; seen from the axis."""
    mesh = shapes.Mesh()
    for (r0, y0), (r1, y1) in runs:
        for i in range(segments):
            a, b = (math.pi * (1.0 + k / segments) for k in (i, i + 1))
            low = [(r0 * math.cos(t), y0, r0 * math.sin(t)) for t in (a, b)]
            high = [(r1 * math.cos(t), y1, r1 * math.sin(t)) for t in (a, b)]
            mesh.face([low[1], low[0], high[0], high[1]])
    return mesh
