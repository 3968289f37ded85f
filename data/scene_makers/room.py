"""room704: a furnished room with thick walls, lit only by the sun through two windows. 704 triangles."""
from . import shapes
from .glb import Scene

LOW, HIGH, THICKNESS = (-3.5, 0.0, -2.75), (3.5, 3.2, 2.75), 0.25
WINDOWS = ((-1.9, -0.7), (0.5, 1.7))   # in z, in the wall at +X
SILL, LINTEL = 0.9, 2.3
STEPS, RISE, GOING = 8, 0.2, 0.3
STAIR_FOOT, STAIR_SIDE, LANDING_EDGE, LANDING_BOTTOM = 0.5, -1.55, -1.9, 1.46


def _shell():
    low = tuple(c - THICKNESS for c in LOW)
    high = tuple(c + THICKNESS for c in HIGH)
    shell = shapes.Blocks().fill(low, high).carve(LOW, HIGH)
    for z0, z1 in WINDOWS:
        shell.carve((HIGH[0], SILL, z0), (high[0], LINTEL, z1))

    def material(centre, axis, sign, tag):
        if any(not LOW[i] <= centre[i] <= HIGH[i] for i in range(3)):
            return 'plaster'  # outside, and the reveals of the windows
        if axis == 1:
            return 'floor' if sign > 0 else 'plaster'
        return 'ochre' if axis == 0 and sign > 0 else 'plaster'

    return shell.parts(material)


def _stairs():
    """Solid steps that rise towards -X along the wall at -Z; the landing's edge is a vertex of their side."""
    mesh = shapes.Mesh()
    z0, z1 = LOW[2], STAIR_SIDE
    edge = [round(STAIR_FOOT - GOING * i, 6) for i in range(STEPS)] + [LANDING_EDGE]
    for i in range(STEPS):
        right, left = edge[i], edge[i + 1]
        below, y = round(RISE * i, 6), round(RISE * (i + 1), 6)
        mesh.face([(right, below, z1), (right, below, z0), (right, y, z0), (right, y, z1)])
        mesh.face([(left, y, z1), (right, y, z1), (right, y, z0), (left, y, z0)])
        outline = [(left, 0.0), (right, 0.0)] + ([(right, below)] if i else []) + [(right, y), (left, y)]
        if i + 1 == STEPS:
            foot_left, foot_right, inner, top_right, top_left = [(*p, z1) for p in outline]
            under = (left, LANDING_BOTTOM, z1)
            for corners in ((foot_left, foot_right, inner), (foot_left, inner, under), (under, inner, top_right),
                            (under, top_right, top_left)):
                mesh.face(list(corners))
        else:
            mesh.face([(*p, z1) for p in outline])
    x, y = LANDING_EDGE, LANDING_BOTTOM
    mesh.face([(x, 0.0, z0), (x, 0.0, z1), (x, y, z1), (x, y, z0)])
    return mesh


def _landing():
    top = STEPS * RISE
    slab = shapes.box((LOW[0], LANDING_BOTTOM, LOW[2]), (LANDING_EDGE, top, STAIR_SIDE),
                      [(0, LOW[0]), (0, LANDING_EDGE), (2, LOW[2])])
    for x in (-2.75, -2.0):
        slab.merge(shapes.box((x, top, -1.65), (x + 0.05, 2.45, -1.6), [(1, top), (1, 2.45)]))
    return slab.merge(shapes.box((LOW[0], 2.45, -1.67), (-1.93, 2.53, -1.58), [(0, LOW[0])]))


def _table():
    mesh = shapes.box((-0.9, 0.7, 0.2), (0.5, 0.75, 1.0))
    for x in (-0.85, 0.38):
        for z in (0.25, 0.88):
            mesh.merge(shapes.box((x, 0.0, z), (x + 0.07, 0.7, z + 0.07), [(1, 0.0), (1, 0.7)]))
    return mesh


def _bookcase():
    """Against the wall at -X, three compartments."""
    back, front = LOW[0], -3.15
    case = shapes.Blocks(open_planes=[(0, back), (1, 0.0)]).fill((back, 0.0, -0.6), (front, 1.9, 0.6))
    for y0, y1 in ((0.1, 0.6), (0.65, 1.2), (1.25, 1.85)):
        case.carve((-3.45, y0, -0.55), (front, y1, 0.55))
    return case.mesh()


def room704():
    scene = Scene('room704', 'A furnished room with thick walls, lit only by the sun through two windows: little is '
                  'directly lit; the staircase, the space under its landing and the furniture are not.',
                  [(('shell',), False)])
    scene.material('plaster', (0.75, 0.75, 0.72))
    scene.material('floor', (0.6, 0.5, 0.4))
    scene.material('ochre', (0.8, 0.55, 0.28))
    scene.material('slate', (0.45, 0.52, 0.6))
    scene.material('wood', (0.62, 0.42, 0.27))
    scene.add('shell', _shell())
    scene.add('stairs', {'slate': _stairs()})
    scene.add('landing', {'slate': _landing()})
    bars = shapes.Mesh()
    for z0, z1 in WINDOWS:
        z = (z0 + z1) / 2
        bars.merge(shapes.box((3.58, SILL, z - 0.03), (3.66, LINTEL, z + 0.03), [(1, SILL), (1, LINTEL)]))
    scene.add('window_bars', {'wood': bars})
    beams = shapes.Mesh()
    for x in (-1.75, 0.0, 1.75):
        beams.merge(shapes.box((x - 0.1, 3.0, LOW[2]), (x + 0.1, HIGH[1], HIGH[2]),
                               [(1, HIGH[1]), (2, LOW[2]), (2, HIGH[2])]))
    scene.add('beams', {'wood': beams})
    scene.add('pillar', {'plaster': shapes.box((-2.3, 0.0, 1.2), (-2.0, HIGH[1], 1.5), [(1, 0.0), (1, HIGH[1])])})
    scene.add('table', {'wood': _table()})
    scene.add('bookcase', {'wood': _bookcase()})
    scene.add('crate', {'slate': shapes.turned_box((0.6, 0.5, 0.6), (-2.65, 0.0, -2.05), 0.4)})
    scene.camera((3.0, 1.65, 2.3), (-1.4, 0.95, -1.2), 64.0)
    scene.light('directional', 30.0, direction=(-0.8, -0.75, -0.2))
    return scene
