"""A street of 200 m: houses on both sides with doors that stand back, lamps, sun; made for a sky."""
from . import shapes
from .glb import Scene

LENGTH, HALF_WIDTH, DEPTH, HOUSE = 200.0, 6.0, 9.0, 10.0
HEIGHTS = (9.6, 7.2, 12.0, 8.4, 10.8, 6.0, 11.4)
WALLS = ('plaster', 'brick', 'sand', 'brick', 'plaster')


def _house(blocks, x, side, height, wall):
    """From x on, its front at HALF_WIDTH on that side (1 or -1), with a door and windows that stand back."""
    def at(a, y0, b, y1, in0, in1):
        """A box along the front, from in0 to in1 behind it."""
        z0, z1 = sorted((side * (HALF_WIDTH + in0), side * (HALF_WIDTH + in1)))
        return (x + a, y0, z0), (x + b, y1, z1)

    blocks.fill(*at(0.0, 0.0, HOUSE, height, 0.0, DEPTH), tag=wall)
    blocks.carve(*at(4.2, 0.0, 5.8, 2.6, 0.0, 1.2))
    storey = 0
    while storey * 3.0 + 2.8 < height:
        for a in (1.2, 7.2):
            low = 3.0 * storey + 0.9
            blocks.carve(*at(a, low, a + 1.6, low + 1.5, 0.0, 0.4))
        storey += 1


def street():
    scene = Scene('street', 'A street of 200 m between 38 houses whose doors and windows stand back, two alleys, eight '
                  'lamps; for nested grids. Has a sun; a sky is to be given.', [])
    scene.material('asphalt', (0.2, 0.2, 0.21))
    scene.material('plaster', (0.75, 0.72, 0.66))
    scene.material('brick', (0.5, 0.25, 0.18))
    scene.material('sand', (0.65, 0.55, 0.38))
    edge = HALF_WIDTH + DEPTH
    ground = shapes.Mesh()
    for k in range(20):
        x = -LENGTH / 2 + 10.0 * k
        ground.face([(x, 0.0, -edge), (x, 0.0, edge), (x + 10.0, 0.0, edge), (x + 10.0, 0.0, -edge)])
    scene.add('ground', {'asphalt': ground})
    for side in (1, -1):
        houses = shapes.Blocks(open_planes=[(1, 0.0)])
        for k in range(20):
            if k == (13 if side > 0 else 6):
                continue  # an alley
            height = HEIGHTS[(3 * k + (1 if side > 0 else 4)) % len(HEIGHTS)]
            _house(houses, -LENGTH / 2 + 10.0 * k, side, height, WALLS[(2 * k + side) % len(WALLS)])
        scene.add('houses on the %s' % ('left' if side < 0 else 'right'),
                  houses.parts(lambda c, axis, sign, tag: tag))
    for k in range(8):
        scene.light('point', 60.0, (-LENGTH / 2 + 12.5 + 25.0 * k, 4.5, 4.8 if k % 2 else -4.8))
    scene.light('directional', 3.0, direction=(0.3, -0.8, 0.52))
    scene.camera((-1.5, 1.7, 1.0), (10.0, 2.0, -1.5), 62.0, zfar=300.0)
    return scene
