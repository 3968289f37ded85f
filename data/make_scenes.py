#!/usr/bin/env python3
"""Writes the scenes that tests, references and figures use, as glTF 2.0 binary files, and scenes.json about them.

The same bytes come out everywhere. Without --scene everything is made, in data/; the build makes the large scenes
into its own folder. Only Python's standard library is needed."""
import argparse
import json
import re
import sys
from pathlib import Path

from scene_makers import check, glb, manifest
from scene_makers.catalogue import SCENES

HERE = Path(__file__).resolve().parent


def scene_bytes(name, albedo=None):
    entry = SCENES[name]
    made = entry.make() if albedo is None else entry.make(albedo=albedo)
    return made if isinstance(made, bytes) else made.to_bytes()


def file_name(name, albedo=None):
    return name + ('' if albedo is None else '_%03d' % round(100 * albedo)) + '.glb'


def manifest_text(contents):
    """contents: {scene name: file's bytes} of all scenes."""
    entries = [manifest.describe(name, SCENES[name], glb.Loaded(data)) for name, data in contents.items()]
    text = json.dumps(entries, indent=1)
    one_line = re.compile(r'\[\s+([^][{}"]*?)\s+\]')  # vectors
    return one_line.sub(lambda m: '[' + re.sub(r'\s+', ' ', m.group(1)) + ']', text) + '\n'


def write(path, data):
    """Leaves a file alone that is already right, so that nothing is rebuilt after it."""
    if not path.exists() or path.read_bytes() != data:
        path.write_bytes(data)


def make(names, out, albedo):
    out.mkdir(parents=True, exist_ok=True)
    contents = {name: scene_bytes(name, albedo) for name in names}
    for name, data in contents.items():
        write(out / file_name(name, albedo), data)
        print('%s: %d bytes' % (out / file_name(name, albedo), len(data)))
    if list(contents) == list(SCENES):
        write(out / 'scenes.json', manifest_text(contents).encode('ascii'))


def run_check(names):
    """Prints every problem; the number of them."""
    contents, count = {}, 0
    for name in names:
        contents[name] = scene_bytes(name)
        try:
            found = check.problems(glb.Loaded(contents[name]), SCENES[name].triangles,
                                   given=SCENES[name].cycles is not None)
        except (ValueError, KeyError, IndexError, StopIteration) as error:
            found = ['cannot be read back: %r' % error]
        committed = HERE / file_name(name)
        if SCENES[name].committed and (not committed.exists() or committed.read_bytes() != contents[name]):
            found.append('%s is not what this script makes; run it without arguments' % committed)
        for text in found:
            print('%s: %s' % (name, text))
        count += len(found)
    if list(contents) == list(SCENES):
        text, path = manifest_text(contents), HERE / 'scenes.json'
        if not path.exists() or path.read_text() != text:
            print('%s does not describe these scenes; run this script without arguments' % path)
            count += 1
    print('%d scenes checked, %d problems' % (len(contents), count))
    return count


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                     epilog='example: make_scenes.py --scene furnace --albedo 0.8 --out /tmp')
    parser.add_argument('--out', type=Path, default=HERE, metavar='DIR', help='folder to write to (default: data)')
    parser.add_argument('--scene', nargs='+', metavar='NAME', choices=list(SCENES), help='only these (default: all)')
    parser.add_argument('--detail', action='store_true', help='the finer form of the scenes that have one (atrium)')
    parser.add_argument('--albedo', type=float, metavar='RHO', help='of closed_box (default 0.7) or furnace (default '
                        '0.5), 0 to 0.999; the file is named after it in percent')
    parser.add_argument('--list', action='store_true', help='names and triangle counts, nothing is written')
    parser.add_argument('--check', action='store_true', help='check geometry and committed files, nothing is written')
    chosen = parser.parse_args()
    if chosen.albedo is not None:
        if not 0 <= chosen.albedo <= 0.999:
            parser.error('--albedo %g is not between 0 and 0.999' % chosen.albedo)
        fixed = [name for name in chosen.scene or SCENES if SCENES[name].albedo is None]
        if fixed:
            parser.error('--albedo goes with --scene closed_box or furnace; %s has its own' % fixed[0])
    if chosen.detail:
        if not chosen.scene:
            parser.error('--detail needs --scene')
        coarse = [name for name in chosen.scene if name + '_detail' not in SCENES]
        if coarse:
            parser.error('%s has no detailed form' % coarse[0])
        chosen.scene = [name + '_detail' for name in chosen.scene]
    return chosen


def main():
    chosen = arguments()
    names = list(dict.fromkeys(chosen.scene or SCENES))
    if chosen.list:
        for name in names:
            count = sum(len(p['triangles']) for p in glb.Loaded(scene_bytes(name, chosen.albedo)).parts)
            print('%-14s %6d triangles%s' % (name, count, '' if SCENES[name].committed else ', made by the build'))
    elif chosen.check:
        return 1 if run_check(names) else 0
    else:
        make(names, chosen.out, chosen.albedo)
    return 0


if __name__ == '__main__':
    sys.exit(main())
