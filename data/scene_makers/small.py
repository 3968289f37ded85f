"""Scenes of a few triangles: variations of the Cornell box, closed boxes with a known answer, hard light paths."""
from pathlib import Path

from . import png, shapes
from .glb import Scene

REFERENCE = Path(__file__).resolve().parent.parent / 'reference' / 'scenes'
CORNELL_EYE, CORNELL_TARGET = (0.0390625, 1.0234375, 3.90625), (0.0390625, 1.0234375, 0.0)


def reference_copy(name):
    """The bytes of data/reference/scenes/<name>.glb, unchanged: its images were rendered from exactly these."""
    return lambda: (REFERENCE / (name + '.glb')).read_bytes()


def wall_of(names):
    """Names an inward box's faces by (axis, sign of the normal that looks into the room)."""
    return lambda centre, axis, sign, tag: names[axis, sign]


def cornell_shell(scene, left=('red', (0.63, 0.065, 0.05)), right=('green', (0.14, 0.45, 0.091))):
    """2 m box, open towards +Z."""
    scene.material('white', (0.75, 0.75, 0.75))
    walls = shapes.Blocks(inward=True, open_planes=[(2, 1.0)]).fill((-1.0, 0.0, -1.0), (1.0, 2.0, 1.0))
    parts = walls.parts(wall_of({(0, 1): 'left', (0, -1): 'right', (1, 1): 'white', (1, -1): 'white',
                                  (2, 1): 'white'}))
    scene.add('white_walls', {'white': parts['white']})
    for side, (name, albedo) in (('left', left), ('right', right)):
        scene.material(name, albedo)
        scene.add(side + '_wall', {name: parts[side]})


def convex_box():
    scene = Scene('convex_box', "The Cornell box's shell and light without its boxes: every point of a wall sees every "
                  'other wall, so that any shadow in the indirect light is an error.')
    cornell_shell(scene)
    scene.camera(CORNELL_EYE, CORNELL_TARGET, 40.0)
    scene.light('spot', 8.0, (0.0, 1.96875, 0.0), (0.0, -1.0, 0.0), (49.5, 50.0))
    return scene


def closed_box(albedo=0.7):
    scene = Scene('closed_box', 'Closed 2 m cube, the same albedo on all walls and on the 0.5 m square emitter '
                  '(radiance 10) in the ceiling plane: wall irradiance is known from radiosity.',
                  [(('walls', 'emitter'), True)])
    scene.material('wall', (albedo,) * 3)
    scene.material('emitter', (albedo,) * 3, radiance=(10.0, 10.0, 10.0))
    cube = shapes.Blocks(inward=True).fill((-1.0, 0.0, -1.0), (1.0, 2.0, 1.0))
    for axis in (0, 2):
        cube.cut(axis, -0.25, 0.25)
    parts = cube.parts(lambda c, axis, sign, tag: 'emitter' if c[1] == 2 and c[0] == c[2] == 0 else 'wall')
    scene.add('walls', {'wall': parts['wall']})
    scene.add('emitter', {'emitter': parts['emitter']})
    scene.camera((0.7, 0.6, 0.9), (-0.25, 1.15, -1.0), 75.0)
    return scene


def furnace(albedo=0.5):
    scene = Scene('furnace', 'Closed 2 m cube whose walls all emit radiance 1: radiance is 1/(1 - albedo) everywhere '
                  'and in every direction.', [(('walls',), True)])
    scene.material('glowing', (albedo,) * 3, radiance=(1.0, 1.0, 1.0))
    cube = shapes.Blocks(inward=True).fill((-1.0, 0.0, -1.0), (1.0, 2.0, 1.0))
    scene.add('walls', cube.parts(lambda *_: 'glowing'))
    scene.camera((0.7, 0.6, 0.9), (-0.25, 1.15, -1.0), 75.0)
    return scene


def occluder():
    scene = Scene('occluder', 'A spot lights nothing but the left wall; a plate floats over the floor, whose shadow '
                  'exists only in the indirect light.', [(('plate',), False)])
    cornell_shell(scene, left=('ochre', (0.8, 0.6, 0.3)), right=('blue', (0.25, 0.35, 0.65)))
    scene.add('plate', {'white': shapes.box((-0.375, 0.328125, -0.375), (0.375, 0.359375, 0.375))})
    scene.camera(CORNELL_EYE, CORNELL_TARGET, 40.0)
    scene.light('spot', 12.0, (0.25, 1.25, 0.0), (-1.0, -0.125, 0.0), (24.0, 25.0))
    return scene


def corridor():
    scene = Scene('corridor', 'A closed corridor in the shape of an L with a point light at one end and the camera at '
                  'the other: all light but that beside the corner arrives after bounces.', [(('shell',), True)])
    scene.material('plaster', (0.75, 0.75, 0.75))
    scene.material('floor', (0.6, 0.55, 0.5))
    scene.material('ochre', (0.8, 0.6, 0.3))
    scene.material('blue', (0.35, 0.45, 0.7))
    shell = shapes.Blocks(inward=True)
    shell.fill((0.0, 0.0, 0.0), (6.0, 2.5, 1.5)).fill((0.0, 0.0, 0.0), (1.5, 2.5, 6.0))

    def material(centre, axis, sign, tag):
        if axis == 1:
            return 'floor' if sign > 0 else 'plaster'
        if centre[0] == 0 and centre[2] < 1.5:
            return 'ochre'  # the wall at the corner that faces the light
        return 'blue' if axis == 0 and 1.5 <= centre[0] < 6 else 'plaster'

    scene.add('shell', shell.parts(material))
    scene.add('crate', {'plaster': shapes.turned_box((0.5, 0.6, 0.5), (0.45, 0.0, 3.2), 0.3)})
    scene.camera((0.95, 1.5, 5.7), (0.7, 1.15, 0.0), 60.0)
    scene.light('point', 12.0, (5.25, 1.75, 0.75))
    return scene


def _panel_pixel(x, y):
    if x in (0, 31) or y in (0, 15):
        return (0.02, 0.02, 0.02)
    return ((1.0, 0.25, 0.1), (1.0, 0.8, 0.3), (0.15, 0.7, 1.0))[min((x - 1) // 10, 2)]


def emissive():
    scene = Scene('emissive', 'A closed room lit by its emissive surfaces alone: a textured panel, a warm sphere and a '
                  'blue box.', [(('room',), True), (('warm_sphere',), False), (('blue_lamp',), False)])
    scene.material('plaster', (0.75, 0.75, 0.75))
    scene.material('floor', (0.6, 0.55, 0.5))
    scene.material('rose', (0.75, 0.4, 0.35))
    screen = scene.image('screen', png.encode(32, 16, _panel_pixel))
    scene.material('screen', (0.2, 0.2, 0.2), radiance=(6.0, 6.0, 6.0), emissive_texture=screen)
    scene.material('warm', (0.5, 0.5, 0.5), radiance=(16.0, 10.0, 4.0))
    scene.material('blue', (0.5, 0.5, 0.5), radiance=(2.0, 5.0, 12.0))

    room = shapes.Blocks(inward=True).fill((-2.0, 0.0, -2.0), (2.0, 2.6, 2.0))
    scene.add('room', room.parts(wall_of({(0, 1): 'rose', (0, -1): 'plaster', (1, 1): 'floor', (1, -1): 'plaster',
                                           (2, 1): 'plaster', (2, -1): 'plaster'})))
    frame = shapes.box((-1.3, 1.1, -2.0), (0.1, 1.8, -1.92), [(2, -2.0), (2, -1.92)])
    front = shapes.Mesh()
    front.face([(-1.3, 1.1, -1.92), (0.1, 1.1, -1.92), (0.1, 1.8, -1.92), (-1.3, 1.8, -1.92)],
               [(0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0)])
    scene.add('panel', {'plaster': frame, 'screen': front})
    scene.add('warm_sphere', {'warm': shapes.sphere(0.12, (1.1, 1.75, -0.9), 24, 12)})
    scene.add('pedestal', {'plaster': shapes.turned_box((0.4, 0.8, 0.4), (-1.05, 0.0, -0.5), 0.5)})
    scene.add('blue_lamp', {'blue': shapes.Mesh().merge(shapes.box((-0.08, 0.0, -0.08), (0.08, 0.16, 0.08)),
                                                        move=(-1.05, 0.85, -0.5))})
    scene.add('tall_box', {'plaster': shapes.turned_box((0.6, 1.3, 0.6), (1.0, 0.0, -1.1), 0.35)})
    scene.add('ball', {'plaster': shapes.sphere(0.35, (-0.1, 0.35, -0.6), 32, 16)})
    scene.camera((0.5, 1.45, 1.85), (-0.15, 1.0, -1.2), 70.0)
    return scene
