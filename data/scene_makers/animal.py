"""A rabbit with smooth fur, as one closed surface: floating in a box, and at a quarter of the triangles in the Cornell
box."""
from . import shapes, small, surface, vec
from .glb import Scene
from .implicit import Ellipsoid, Hollowed, Relief, RoundCone, Union, Widened

# The Stanford bunny of Cochran and Steele 2007 has 69 451 triangles; a closed surface has an even number, and this one
# has 69 452. The cell's size sets the number, about as its inverse square.
BUNNY_CELL = 0.0105215
SMALL_CELL = 0.0212      # 16 988 triangles
TURN_RAD = -0.6          # so that it looks past the camera
LOW, HIGH = (-0.7, -0.05, -0.5), (0.75, 1.3, 0.5)
SMALL_LOW = (-0.7, -0.05, -0.505)  # where cells of this size follow the crease between thigh and foot best


def _ear(side):
    root, tip = (0.28, 0.76, 0.09 * side), (0.03, 1.14, 0.19 * side)
    along = vec.sub(tip, root)
    front = (0.8, 0.5, 0.35 * side)  # where the hollow faces
    flap = Widened(RoundCone(root, 0.040, tip, 0.046), root, vec.normalize(vec.cross(along, front)), 1.75)
    middle = vec.add(vec.scale(vec.add(root, tip), 0.5), vec.scale(front, 0.064))
    return Hollowed(flap, Ellipsoid(middle, (0.18, 0.04, 0.04), along, front), 0.05)


def rabbit():
    """Crouching, about 1.2 m from tail to nose, looking along +X, its feet near y = 0."""
    parts = [(Ellipsoid((-0.10, 0.34, 0.0), (0.38, 0.28, 0.25)), 0.0),
             (Ellipsoid((-0.26, 0.31, 0.0), (0.25, 0.27, 0.27)), 0.10),
             (Ellipsoid((0.20, 0.33, 0.0), (0.19, 0.25, 0.19)), 0.10),
             (RoundCone((0.17, 0.44, 0.0), 0.16, (0.33, 0.63, 0.0), 0.11), 0.08),
             (Ellipsoid((0.38, 0.68, 0.0), (0.19, 0.14, 0.135), (1.0, -0.3, 0.0)), 0.05),
             (Ellipsoid((0.53, 0.625, 0.0), (0.085, 0.07, 0.08), (1.0, -0.3, 0.0)), 0.05),
             (RoundCone((-0.50, 0.33, 0.0), 0.10, (-0.55, 0.38, 0.0), 0.085), 0.03)]
    for side in (-1, 1):
        parts += [(Ellipsoid((0.45, 0.61, 0.065 * side), (0.09, 0.075, 0.06)), 0.04),
                  (Ellipsoid((0.455, 0.715, 0.105 * side), (0.036, 0.034, 0.03)), 0.012),
                  (_ear(side), 0.06),
                  (Ellipsoid((-0.19, 0.25, 0.20 * side), (0.22, 0.2, 0.11), (1.0, -0.25, 0.0)), 0.06),
                  (RoundCone((-0.20, 0.06, 0.24 * side), 0.06, (0.09, 0.045, 0.27 * side), 0.05), 0.05),
                  (RoundCone((0.24, 0.30, 0.10 * side), 0.085, (0.31, 0.07, 0.11 * side), 0.05), 0.04),
                  (RoundCone((0.31, 0.05, 0.11 * side), 0.048, (0.40, 0.042, 0.12 * side), 0.042), 0.03)]
    return Union(parts, Relief(0.0015, 0.1))


def bunny():
    scene = Scene('bunny', 'An animal of 69452 triangles floats in a box, open to the camera, of two triangles a wall; '
                  'a spot lights it, the floor, the back and a wall: its underside, its back and its shadows are lit '
                  'by bounces alone.',
                  [(('animal',), False)])
    scene.material('white', (0.75, 0.75, 0.75))
    scene.material('red', (0.7, 0.12, 0.08))
    scene.material('blue', (0.12, 0.25, 0.65))
    walls = shapes.Blocks(inward=True, open_planes=[(2, 1.0)]).fill((-1.375, 0.0, -1.0), (1.375, 2.0, 1.0))
    parts = walls.parts(small.wall_of({(0, 1): 'red', (0, -1): 'blue', (1, 1): 'white', (1, -1): 'white',
                                       (2, 1): 'white'}))
    scene.add('walls', parts)
    mesh = surface.mesh(rabbit(), LOW, HIGH, BUNNY_CELL)
    scene.add('animal', {'white': mesh}, translation=(0.0625, 0.3125, 0.0), rotation=vec.about_y(TURN_RAD),
              scale=(1.125,) * 3)
    scene.camera((0.0, 1.0, 3.9), (0.0, 1.0, 0.0), 40.0, aspect=4 / 3)
    scene.light('spot', 8.0, (0.9375, 1.9375, 0.75), (-1.0, -1.25, -0.875), (37.0, 38.0))
    return scene


def animal17k():
    scene = Scene('animal17k', 'An animal of 16988 triangles stands in the Cornell box, a millimetre over the '
                  'floor.', [(('animal',), False)])
    small.cornell_shell(scene)
    mesh = surface.mesh(rabbit(), SMALL_LOW, HIGH, SMALL_CELL)
    lift = 0.001 - min(p[1] for p in mesh.positions)
    scene.add('animal', {'white': mesh}, translation=(0.0, lift, 0.0), rotation=vec.about_y(TURN_RAD))
    scene.camera(small.CORNELL_EYE, small.CORNELL_TARGET, 40.0)
    scene.light('spot', 8.0, (0.0, 1.96875, 0.0), (0.0, -1.0, 0.0), (49.5, 50.0))
    return scene
