"""scenes.json: what tests and people want to know of each scene, read back from the files themselves."""
import math

from . import png, vec


def albedo_range(loaded):
    """Least and largest linear albedo of any channel that a triangle can show."""
    texture_colours, low, high = {}, 1.0, 0.0
    for part in loaded.parts:
        pbr = part['material']['pbrMetallicRoughness']
        shown = [(1.0, 1.0, 1.0)]
        if 'baseColorTexture' in pbr:
            texture = pbr['baseColorTexture']['index']
            if texture not in texture_colours:
                image = loaded.document['images'][loaded.document['textures'][texture]['source']]
                texture_colours[texture] = png.colours(loaded.view(image['bufferView']))
            shown = texture_colours[texture]
        values = [f * c for rgb in shown for f, c in zip(pbr['baseColorFactor'], rgb)]
        low, high = min(low, *values), max(high, *values)
    return {'min': round(low, 4), 'max': round(high, 4)}


def _light(light, node):
    entry = {'type': light['type'], 'intensity': light['intensity'], 'color': light['color']}
    if light['type'] != 'directional':
        entry['position'] = node.get('translation', [0.0, 0.0, 0.0])
    if light['type'] != 'point':
        entry['direction'] = _tidy(vec.rotate(node.get('rotation', (0, 0, 0, 1)), (0.0, 0.0, -1.0)))
    if 'spot' in light:
        entry['inner_cone_rad'] = light['spot']['innerConeAngle']
        entry['outer_cone_rad'] = light['spot']['outerConeAngle']
    return entry


def _tidy(values):
    return [round(v, 7) + 0.0 for v in values]


def _emitters(loaded):
    """Emissive materials: radiance (before a texture) and the area that emits."""
    found = {}
    for part in loaded.parts:
        material = part['material']
        if 'emissiveFactor' not in material:
            continue
        strength = material.get('extensions', {}).get('KHR_materials_emissive_strength', {}).get('emissiveStrength', 1)
        entry = found.setdefault(material['name'], {
            'material': material['name'], 'radiance': _tidy(c * strength for c in material['emissiveFactor']),
            'textured': 'emissiveTexture' in material, 'area_m2': 0.0})
        p = part['positions']
        for a, b, c in part['triangles']:
            entry['area_m2'] += vec.length(vec.cross(vec.sub(p[b], p[a]), vec.sub(p[c], p[a]))) / 2
    for entry in found.values():
        entry['area_m2'] = round(entry['area_m2'], 6)
    return list(found.values())


def describe(name, entry, loaded):
    perspective, node = loaded.camera()
    eye = node['translation']
    forward = vec.rotate(node['rotation'], (0.0, 0.0, -1.0))
    points = [p for part in loaded.parts for p in part['positions']]
    scene = loaded.document['scenes'][0]
    folder = 'data' if entry.committed else 'build/release/data'
    reference = 'data/references/%s.exr' % name
    described = {
        'name': name,
        'file': '%s/%s.glb' % (folder, name),
        'committed': entry.committed,
        'purpose': scene['extras']['purpose'],
        'triangles': sum(len(part['triangles']) for part in loaded.parts),
        'bounds': {'min': _tidy(min(p[i] for p in points) for i in range(3)),
                   'max': _tidy(max(p[i] for p in points) for i in range(3))},
        'lights': [_light(*pair) for pair in loaded.lights()],
        'emitters': _emitters(loaded),
        'camera': {'eye': _tidy(eye), 'target': _tidy(vec.add(eye, forward)),
                   'yfov_deg': round(math.degrees(perspective['yfov']), 6),
                   'znear': perspective['znear'], 'zfar': perspective['zfar']},
        'albedo': albedo_range(loaded),
        'reference': reference,
        'command': 'volgi reference %s/%s.glb -o %s --size 192x192 --spp %d' % (folder, name, reference, entry.spp),
    }
    if entry.one_bounce_spp:
        path = 'data/references/one_bounce/%s.exr' % name
        described['one_bounce'] = {
            'reference': path,
            'command': 'volgi reference %s -o %s --size 192x192 --spp %d --bounces 1' % (
                described['file'], path, entry.one_bounce_spp)}
    if entry.cycles:
        described['cycles'] = entry.cycles
    return described
