#!/usr/bin/env bash
# volgi export and volgi inspect: files that are the same every time and that OpenVDB's own vdb_print opens, figures and
# pictures of them, and errors of one line with the documented exit code and nothing left behind.
#   export_inspect.sh VOLGI SOURCE_FOLDER
set -u
source "$(dirname "$0")/checks.sh"

# says PATTERN...: the last output has each of these
says() {
  local pattern
  for pattern in "$@"; do
    grep -qE -- "$pattern" "$logs/out" || fail "no '$pattern' in: $(head -c 2000 "$logs/out")"
  done
}

# The same bytes, whatever the threads.
must "$volgi" export "$scene" -o a.vdb --grid 16 --threads 1
says 'wrote a.vdb: 9 grids'
must "$volgi" export "$scene" -o b.vdb --grid 16 --quiet
[[ ! -s $logs/out ]] || fail '--quiet is not'
cmp -s a.vdb b.vdb || fail 'two exports of a scene differ'
must "$volgi" export "$scene" -o voxels.vdb --grid 16 --stage voxels
says 'wrote voxels.vdb: 4 grids'
must "$volgi" export "$scene" -o order2.vdb --grid 12 --scheme conservative --sh-order 2 --iterations 8
says 'wrote order2.vdb: 14 grids'

must "$volgi" export "$scene" -o a.nvdb --grid 16
says 'wrote a.nvdb: 9 grids'
[[ $(head -c 4 a.nvdb) == Nano ]] || fail 'a.nvdb is no NanoVDB file'

must "$volgi" inspect a.vdb
says '^occupancy \[1\]' '^emission \[W m\^-2\]' '^fluence \[W m\^-2\]' '^sh_1m1 \[W m\^-2 sr\^-1\]' 'scheme +ordinates' \
  'world box +-1,0,-1 ... 1,2,1 m' '16 x 16 x 16 cells of 0.125 m'
"$volgi" inspect a.vdb > /dev/full 2> full.txt
code=$?
((code == 6)) && grep -q 'standard output' full.txt || fail "a full disk under inspect: exit code $code"
must "$volgi" inspect a.vdb --diagnose
says '^fluence: OK, [0-9]+ active cells' '^OK$'
must "$volgi" inspect a.vdb --grid occupancy --histogram 4
says 'deviation' '^ +[0-9.]+ +[0-9]+ #*$'
must "$volgi" inspect a.vdb --grid albedo --json
says '"name": "albedo"' '"unit": "1"' '"active_share"' '"maximum"' '"cell_size_m"'
must "$volgi" inspect a.vdb --grid albedo --slice z=3 -o slice.png
must "$volgi" inspect a.vdb --grid sh_10 --sheet -o sheet.png
must "$volgi" inspect a.vdb --grid normal --sheet --at 4,0,15 -o at.png
for picture in slice.png sheet.png at.png; do
  [[ $(head -c 4 "$picture" | tail -c 3) == PNG ]] || fail "$picture is no picture"
done

if command -v vdb_print > /dev/null; then
  must vdb_print -l a.vdb
  for grid in occupancy albedo normal emission fluence sh_00 sh_1m1 sh_10 sh_11; do says "^Name: $grid\$"; done
  says '^backend: cpu' '^scene: cornell' 'Dimensions of active voxels: +16 x 16 x 16'
  must vdb_print -m a.vdb
  says '^occupancy +float' '^normal +vec3s' 'class: fog volume' 'vector_type: covariant normalize' 'unit: W m\^-2 sr\^-1' \
    'is_saved_as_half_float: false' '\[-0.938, 0.0625, -0.938, 1\]'
  must bash -c 'vdb_tool -read a.vdb -print 2>&1'
  says 'name = "fluence", type = "vec3s"' 'name = "occupancy", type = "float".*dim = \[16, 16, 16\]'
else
  echo 'SKIPPED: vdb_print is not installed (openvdb-tools), so that only volgi itself has read the files'
fi

echo 'not a volume' > text.vdb
: > empty.vdb
head -c 3000 a.vdb > cut.vdb
cp a.vdb changed.vdb
printf 'X' | dd of=changed.vdb bs=1 seek=20000 conv=notrunc status=none
for file in text.vdb empty.vdb cut.vdb changed.vdb missing.vdb .; do refuse 3 "$file" inspect "$file"; done
refuse 3 empty "inspect" empty.vdb --json
refuse 2 'occupancy, albedo' inspect a.vdb --grid nothing
refuse 2 'choose it with --grid' inspect a.vdb --sheet -o out.png
refuse 2 'from z = 0 to z = 15' inspect a.vdb --grid albedo --slice z=16 -o out.png
refuse 2 'from x = 0 to x = 15' inspect a.vdb --grid albedo --slice x=-1 -o out.png
refuse 2 'from y = 0 to y = 15' inspect a.vdb --grid albedo --sheet --at 3,99,3 -o out.png
for slice in w=3 z z= z=one z=1,2 zz=1 = =3; do
  refuse 2 --slice inspect a.vdb --grid albedo --slice="$slice" -o out.png
done
for at in 1,2 1,2,3,4 1,2,x ,,; do refuse 2 --at inspect a.vdb --grid albedo --sheet --at "$at" -o out.png; done
refuse 2 '-o' inspect a.vdb --grid albedo --slice z=3
refuse 2 '-o' inspect a.vdb --grid albedo -o out.png
refuse 2 out.jpg inspect a.vdb --grid albedo --sheet -o out.jpg
refuse 2 --sheet inspect a.vdb --grid albedo --sheet --slice z=3 -o out.png
refuse 2 --at inspect a.vdb --grid albedo --slice z=3 --at 1,2,3 -o out.png
refuse 6 none/ inspect a.vdb --grid albedo --sheet -o none/out.png
refuse 2 FILE inspect

refuse 3 missing.glb export missing.glb -o out.vdb
refuse 3 text.vdb export text.vdb -o out.vdb
refuse 6 none/ export "$scene" -o none/out.vdb
refuse 6 text.vdb/ export "$scene" -o text.vdb/out.vdb
refuse 2 out.png export "$scene" -o out.png
refuse 2 --output export "$scene"
refuse 2 --grid export "$scene" -o out.vdb --grid 0
refuse 2 --scheme export "$scene" -o out.vdb --scheme magic
refuse 2 --sh-order export "$scene" -o out.vdb --sh-order 2
refuse 2 --directions export "$scene" -o out.vdb --scheme conservative --directions 24
refuse 2 --stage export "$scene" -o out.vdb --stage all
refuse 2 --backend export "$scene" -o out.vdb --backend gpu
refuse 2 --time export "$scene" -o out.vdb --time soon
refuse 2 --time export "$scene" -o out.vdb --time inf
refuse 5 --memory-limit export "$scene" -o out.vdb --memory-limit 1K
# A disk that is full after 8 KiB: neither half a file nor a temporary one.
(
  failures=0
  ulimit -f 8
  trap '' XFSZ
  refuse 6 out.vdb export "$scene" -o out.vdb --grid 16
  ((failures == 0))
) || failures=$((failures + 1))

((failures == 0)) || printf '%d checks failed\n' "$failures"
exit $((failures > 0))
