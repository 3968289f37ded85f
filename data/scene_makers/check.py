"""The self-check: are the scenes whole, well-formed and those that the committed files hold?"""
from collections import defaultdict

from . import vec

UNIT_TOLERANCE = 1e-5
AGREEMENT = 0.5          # least cosine between a triangle's plane and the normals at its corners
MIN_HEIGHT_M = 1e-5      # of a triangle that is not degenerate
COPLANAR_M = 1e-4        # planes nearer than this are one, so are overlaps smaller than this


def problems(loaded, limits, given):
    """Sentences about what is wrong with a scene; empty when it is sound. A scene that was given to us, with images
    rendered from it, may have faces that lie in each other where nothing sees them."""
    checks = (_indices, _normals, _materials, _closed) + (() if given else (_overlaps,))
    found = [text for check in checks for text in check(loaded)]
    count = sum(len(part['triangles']) for part in loaded.parts)
    if not limits[0] <= count <= limits[1]:
        found.append('%d triangles, stated are %d to %d' % (count, *limits))
    loaded.camera()
    return found


def _indices(loaded):
    for part in loaded.parts:
        n = len(part['positions'])
        if len(part['normals']) != n or (part['uvs'] is not None and len(part['uvs']) != n):
            yield '%s: attributes of different lengths' % part['node']
        if any(i >= n for triangle in part['triangles'] for i in triangle):
            yield '%s: an index beyond its %d vertices' % (part['node'], n)


def _normals(loaded):
    for part in loaded.parts:
        p, normals = part['positions'], part['normals']
        if any(abs(vec.length(n) - 1) > UNIT_TOLERANCE for n in part['raw_normals']):
            yield '%s: a normal is not of unit length' % part['node']
        for triangle in part['triangles']:
            a, b, c = (p[i] for i in triangle)
            plane = vec.cross(vec.sub(b, a), vec.sub(c, a))
            size = vec.length(plane)
            longest = max(vec.length(vec.sub(q, r)) for q, r in ((a, b), (b, c), (c, a)))
            if size < MIN_HEIGHT_M * longest:
                yield '%s: a triangle without area' % part['node']
                break
            if any(vec.dot(plane, normals[i]) < AGREEMENT * size for i in triangle):
                yield '%s: a normal disagrees with the winding' % part['node']
                break


def _materials(loaded):
    for material in loaded.document['materials']:
        if material['pbrMetallicRoughness'].get('metallicFactor') != 0.0:
            yield '%s: metallicFactor is not 0, its diffuse albedo is not its colour' % material['name']
        specular = material.get('extensions', {}).get('KHR_materials_specular', {})
        if specular.get('specularFactor') != 0:
            yield '%s: specularFactor is not 0, it is not Lambertian' % material['name']
    for part in loaded.parts:
        pbr = part['material']['pbrMetallicRoughness']
        if part['uvs'] is None and ('baseColorTexture' in pbr or 'emissiveTexture' in part['material']):
            yield '%s: textured without texture coordinates' % part['node']


def _closed(loaded):
    """Each edge of a closed surface is run through exactly once in each direction, and it encloses a volume."""
    for group in loaded.document['scenes'][0].get('extras', {}).get('closed', []):
        edges, volume = defaultdict(int), 0.0
        for part in loaded.parts:
            if part['node'] not in group['nodes']:
                continue
            p = part['positions']
            welded = [tuple(round(c * 1e5) for c in q) for q in p]
            for a, b, c in part['triangles']:
                volume += vec.dot(p[a], vec.cross(p[b], p[c])) / 6
                for pair in ((a, b), (b, c), (c, a)):
                    edges[welded[pair[0]], welded[pair[1]]] += 1
        if any(n != 1 or edges.get((b, a)) != 1 for (a, b), n in list(edges.items())) or not edges:
            yield '%s: not watertight' % ' + '.join(group['nodes'])
        elif (volume < 0) != group['inward']:
            yield '%s: turned inside out' % ' + '.join(group['nodes'])


def _separated(s, t):
    """True if two triangles of a plane overlap by less than COPLANAR_M (separating axes: the six edges)."""
    for one in (s, t):
        for i in range(3):
            (x0, y0), (x1, y1) = one[i], one[(i + 1) % 3]
            d = ((x1 - x0) ** 2 + (y1 - y0) ** 2) ** 0.5
            nx, ny = (y1 - y0) / d, (x0 - x1) / d
            u = [nx * x + ny * y for x, y in s]
            v = [nx * x + ny * y for x, y in t]
            if max(u) <= min(v) + COPLANAR_M or max(v) <= min(u) + COPLANAR_M:
                return True
    return False


def _by_plane(loaded):
    planes = defaultdict(list)
    for part in loaded.parts:
        p = part['positions']
        for triangle in part['triangles']:
            a, b, c = (p[i] for i in triangle)
            n = vec.normalize(vec.cross(vec.sub(b, a), vec.sub(c, a)))
            axis = max(range(3), key=lambda i: abs(n[i]))
            if n[axis] < 0:
                n = vec.scale(n, -1)
            key = tuple(round(c * 1e3) for c in n) + (round(vec.dot(n, a) / COPLANAR_M),)
            flat = [tuple(q[i] for i in range(3) if i != axis) for q in (a, b, c)]
            planes[key].append((min(q[0] for q in flat), max(q[0] for q in flat), flat, part['node']))
    return planes


def _overlaps(loaded):
    """Faces that lie in each other show one or the other by chance."""
    told = set()
    for triangles in _by_plane(loaded).values():
        triangles.sort(key=lambda t: t[:2])
        active = []
        for left, right, flat, node in triangles:
            active = [t for t in active if t[1] > left + COPLANAR_M]
            for other in active:
                pair = tuple(sorted((node, other[3])))
                if pair not in told and not _separated(flat, other[2]):
                    told.add(pair)
                    yield '%s and %s: faces lie in each other' % pair
            active.append((left, right, flat, node))
