#!/usr/bin/python3
"""Figures of data/reference/compare.py for the pictures in data/reference/ref: one bounce judged as if it were all.

Prints "scene light region key value" lines. metrics_test.cpp holds volgi's own figures to them, and to the copy in
compare_figures.txt, made by:  /usr/bin/python3 tests/reference/compare_figures.py > tests/reference/compare_figures.txt
"""
import os
import sys

sys.dont_write_bytecode = True
ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'data', 'reference')
sys.path.insert(0, ROOT)
try:
    import numpy as np
    import compare
except ImportError as error:
    print(error, file=sys.stderr)
    sys.exit(77)


def p95(r, t, mask):
    luma = lambda a: a[mask] @ np.array([0.2126, 0.7152, 0.0722])
    lr, lt = luma(r), luma(t)
    return np.percentile(100 * np.abs(lt - lr) / np.maximum(lr, 0.05 * lr.mean()), 95)


for scene in ('cornell', 'room', 'thin_wall', 'sky_court', 'area_tv', 'metal_box'):
    folder = os.path.join(ROOT, 'ref', scene)
    full, full_noise = compare.load_ref(os.path.join(folder, 'full.exr'))
    direct, direct_noise = compare.load_ref(os.path.join(folder, 'direct.exr'))
    one = compare.read_rgb(os.path.join(folder, 'one.exr')).astype(np.float64)
    regions, _ = compare.regions(folder)
    for light, r, t, d in (('full', full, one, full_noise),
                           ('indirect', full - direct, one - direct, full_noise - direct_noise)):
        for region, mask in regions.items():
            m = compare.metrics(r, t, d, mask)
            if 'ratio' in m:
                m['p95_percent'] = p95(r, t, mask)
            for key, value in m.items():
                if not isinstance(value, list):
                    print(scene, light, region, key, repr(float(value)))
