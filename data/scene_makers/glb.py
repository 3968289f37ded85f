"""glTF 2.0 binary files: a writer for the scenes made here, and an independent reader for the self-check."""
import json
import math
import struct

from . import vec

EXTENSIONS = ('KHR_lights_punctual', 'KHR_materials_emissive_strength', 'KHR_materials_specular',
              'KHR_texture_transform')
COMPONENTS = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3, 'VEC4': 4}
FORMATS = {5126: 'f', 5125: 'I', 5123: 'H'}


def _rounded(values):
    return [round(v, 9) + 0.0 for v in values]


class Scene:
    """Collects materials, meshes, nodes, lights and a camera; to_bytes() is the file. Metres, +Y up, linear colours."""

    def __init__(self, name, purpose, closed=()):
        """closed: groups of node names that together bound a volume: (names, inward) with inward True for rooms."""
        self.name = name
        extras = {'purpose': purpose}
        if closed:
            extras['closed'] = [{'nodes': list(names), 'inward': inward} for names, inward in closed]
        self.extras = extras
        self.nodes, self.meshes, self.materials, self.lights, self.cameras = [], [], [], [], []
        self.accessors, self.views, self.images = [], [], []
        self.blob = bytearray()
        self.material_index = {}

    def _view(self, data, target=None):
        view = {'buffer': 0, 'byteOffset': len(self.blob), 'byteLength': len(data)}
        if target:
            view['target'] = target
        self.blob += data + bytes(-len(data) % 4)
        self.views.append(view)
        return len(self.views) - 1

    def _vectors(self, rows, kind, bounds=False):
        data = struct.pack('<%df' % (len(rows) * COMPONENTS[kind]), *(c + 0.0 for row in rows for c in row))
        accessor = {'bufferView': self._view(data, 34962), 'componentType': 5126, 'count': len(rows), 'type': kind}
        if bounds:
            stored = struct.unpack('<%df' % (3 * len(rows)), data)
            accessor['min'] = [min(stored[i::3]) for i in range(3)]
            accessor['max'] = [max(stored[i::3]) for i in range(3)]
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def _indices(self, triangles, vertex_count):
        code = 5123 if vertex_count < 65535 else 5125
        flat = [i for triangle in triangles for i in triangle]
        data = struct.pack('<%d%s' % (len(flat), FORMATS[code]), *flat)
        self.accessors.append(
            {'bufferView': self._view(data, 34963), 'componentType': code, 'count': len(flat), 'type': 'SCALAR'})
        return len(self.accessors) - 1

    def image(self, name, png):
        """Embeds a PNG; returns the texture to give to material()."""
        self.images.append({'name': name, 'mimeType': 'image/png', 'bufferView': self._view(png)})
        return len(self.images) - 1

    def material(self, name, albedo, radiance=None, texture=None, uv_scale=None, uv_offset=None,
                 emissive_texture=None):
        """albedo: linear RGB; radiance: emitted RGB [W m^-2 sr^-1], one-sided; uv_scale: KHR_texture_transform."""
        # glTF's defaults are a metal, and on what is none a specular lobe of 4 %: these surfaces are Lambertian.
        pbr = {'baseColorFactor': _rounded(albedo) + [1.0], 'metallicFactor': 0.0, 'roughnessFactor': 1.0}
        extensions = {'KHR_materials_specular': {'specularFactor': 0.0}}
        material = {'name': name, 'pbrMetallicRoughness': pbr, 'extensions': extensions}
        if texture is not None:
            pbr['baseColorTexture'] = use = {'index': texture}
            if uv_scale or uv_offset:
                use['extensions'] = {'KHR_texture_transform': {
                    **({'offset': _rounded(uv_offset)} if uv_offset else {}),
                    **({'scale': _rounded(uv_scale)} if uv_scale else {})}}
        if radiance:
            strength = max(radiance)
            material['emissiveFactor'] = _rounded(c / strength for c in radiance)
            if emissive_texture is not None:
                material['emissiveTexture'] = {'index': emissive_texture}
            extensions['KHR_materials_emissive_strength'] = {'emissiveStrength': strength}
        self.material_index[name] = len(self.materials)
        self.materials.append(material)
        return name

    def mesh(self, name, parts):
        """parts: {material name: shapes.Mesh}, one primitive each. Returns what node() takes."""
        primitives = []
        for material, mesh in parts.items():
            attributes = {'POSITION': self._vectors(mesh.positions, 'VEC3', bounds=True),
                          'NORMAL': self._vectors(mesh.normals, 'VEC3')}
            if mesh.uvs:
                attributes['TEXCOORD_0'] = self._vectors(mesh.uvs, 'VEC2')
            primitives.append({'attributes': attributes, 'indices': self._indices(mesh.triangles, len(mesh.positions)),
                               'material': self.material_index[material], 'mode': 4})
        self.meshes.append({'name': name, 'primitives': primitives})
        return len(self.meshes) - 1

    def node(self, name, mesh, translation=None, rotation=None, scale=None):
        node = {'name': name, 'mesh': mesh}
        if translation:
            node['translation'] = _rounded(translation)
        if rotation:
            node['rotation'] = _rounded(rotation)
        if scale:
            node['scale'] = _rounded(scale)
        self.nodes.append(node)

    def add(self, name, parts, **placement):
        self.node(name, self.mesh(name, parts), **placement)

    def camera(self, eye, target, yfov_deg, zfar=50.0, aspect=1.0):
        self.cameras.append({'name': 'camera', 'type': 'perspective', 'perspective': {
            'aspectRatio': round(aspect, 9), 'yfov': round(math.radians(yfov_deg), 9), 'znear': 0.05, 'zfar': zfar}})
        self.nodes.append({'name': 'camera', 'camera': 0, 'translation': _rounded(eye),
                           'rotation': _rounded(vec.looking_along(vec.sub(target, eye)))})

    def light(self, kind, intensity, position=None, direction=None, cone_deg=None, colour=(1.0, 1.0, 1.0)):
        """kind: point or spot [W/sr], directional [W/m²]; cone_deg: half angles (inner, outer) of a spot."""
        light = {'name': 'light%d' % len(self.lights), 'type': kind, 'color': list(colour), 'intensity': intensity}
        if cone_deg:
            light['spot'] = {'innerConeAngle': round(math.radians(cone_deg[0]), 9),
                             'outerConeAngle': round(math.radians(cone_deg[1]), 9)}
        node = {'name': light['name'], 'extensions': {'KHR_lights_punctual': {'light': len(self.lights)}}}
        if position:
            node['translation'] = _rounded(position)
        if direction:
            node['rotation'] = _rounded(vec.looking_along(direction))
        self.lights.append(light)
        self.nodes.append(node)

    def to_bytes(self):
        document = {'asset': {'version': '2.0', 'generator': 'volgi data/make_scenes.py'}, 'scene': 0,
                    'scenes': [{'name': self.name, 'nodes': list(range(len(self.nodes))), 'extras': self.extras}],
                    'nodes': self.nodes, 'meshes': self.meshes, 'materials': self.materials}
        if self.images:
            document['images'] = self.images
            document['samplers'] = [{'magFilter': 9729, 'minFilter': 9987, 'wrapS': 10497, 'wrapT': 10497}]
            document['textures'] = [{'source': i, 'sampler': 0} for i in range(len(self.images))]
        document.update(accessors=self.accessors, bufferViews=self.views, cameras=self.cameras)
        if self.lights:
            document['extensions'] = {'KHR_lights_punctual': {'lights': self.lights}}
        document['buffers'] = [{'byteLength': len(self.blob)}]
        text = json.dumps(document, separators=(',', ':'))
        used = [e for e in EXTENSIONS if '"%s"' % e in text]
        if used:
            text = json.dumps({'asset': document.pop('asset'), 'extensionsUsed': used, **document},
                              separators=(',', ':'))
        head = text.encode('ascii')
        head += b' ' * (-len(head) % 4)
        blob = bytes(self.blob)
        return (struct.pack('<4sII', b'glTF', 2, 28 + len(head) + len(blob)) + struct.pack('<I4s', len(head), b'JSON') +
                head + struct.pack('<I4s', len(blob), b'BIN\0') + blob)


class Loaded:
    """A .glb read back: document, and `parts`, one per primitive of a node, in world space (nodes here are flat)."""

    def __init__(self, data):
        magic, version, total = struct.unpack_from('<4sII', data)
        if magic != b'glTF' or version != 2 or total != len(data):
            raise ValueError('not a glTF 2.0 binary file of the stated length')
        size, kind = struct.unpack_from('<I4s', data, 12)
        if kind != b'JSON':
            raise ValueError('the first chunk is not JSON')
        self.document = json.loads(data[20:20 + size])
        length, kind = struct.unpack_from('<I4s', data, 20 + size)
        if kind != b'BIN\0' or 28 + size + length != len(data):
            raise ValueError('the second chunk is not a buffer that fills the file')
        self.blob = data[28 + size:]
        self.rows = {}
        self.parts = [part for node in self._nodes() if 'mesh' in node for part in self._parts(node)]

    def _nodes(self):
        nodes = self.document['nodes']
        if any('children' in n or 'matrix' in n for n in nodes):
            raise ValueError('nodes with children or matrices are not made here')
        return [nodes[i] for i in self.document['scenes'][self.document['scene']]['nodes']]

    def view(self, index):
        view = self.document['bufferViews'][index]
        start = view.get('byteOffset', 0)
        if start + view['byteLength'] > len(self.blob):
            raise ValueError('bufferView %d leaves the buffer' % index)
        return self.blob[start:start + view['byteLength']]

    def accessor(self, index):
        if index not in self.rows:
            accessor = self.document['accessors'][index]
            n = COMPONENTS[accessor['type']]
            flat = struct.unpack_from('<%d%s' % (n * accessor['count'], FORMATS[accessor['componentType']]),
                                      self.view(accessor['bufferView']), accessor.get('byteOffset', 0))
            self.rows[index] = [flat[i:i + n] for i in range(0, len(flat), n)] if n > 1 else list(flat)
        return self.rows[index]

    def _parts(self, node):
        t, q = node.get('translation', (0, 0, 0)), node.get('rotation')
        s = node.get('scale', (1, 1, 1))
        inverse = tuple(1 / c for c in s)
        turn = (lambda v: vec.rotate(q, v)) if q else (lambda v: v)
        for primitive in self.document['meshes'][node['mesh']]['primitives']:
            positions = self.accessor(primitive['attributes']['POSITION'])
            normals = self.accessor(primitive['attributes']['NORMAL'])
            if 'rotation' in node or 'translation' in node or 'scale' in node:
                positions = [vec.add(t, turn((p[0] * s[0], p[1] * s[1], p[2] * s[2]))) for p in positions]
                normals = [vec.normalize(turn((n[0] * inverse[0], n[1] * inverse[1], n[2] * inverse[2])))
                           for n in normals]
            flat = self.accessor(primitive['indices'])
            yield {'node': node['name'], 'positions': positions, 'normals': normals,
                   'raw_normals': self.accessor(primitive['attributes']['NORMAL']),
                   'uvs': self.accessor(primitive['attributes']['TEXCOORD_0'])
                   if 'TEXCOORD_0' in primitive['attributes'] else None,
                   'triangles': list(zip(flat[0::3], flat[1::3], flat[2::3])),
                   'material': self.document['materials'][primitive['material']]}

    def lights(self):
        """(light, node) in file order."""
        found = self.document.get('extensions', {}).get('KHR_lights_punctual', {}).get('lights', [])
        return [(found[n['extensions']['KHR_lights_punctual']['light']], n) for n in self._nodes()
                if 'KHR_lights_punctual' in n.get('extensions', {})]

    def camera(self):
        node = next(n for n in self._nodes() if 'camera' in n)
        return self.document['cameras'][node['camera']]['perspective'], node
