#!/usr/bin/env bash
# volgi compare --diff: a map for one picture, a folder of maps for several, and nothing overwritten by another's.
#   compare_maps.sh VOLGI SOURCE_FOLDER
set -eu
volgi=$1
scene=$2/data/cornell.glb
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
mkdir other
"$volgi" reference "$scene" -o ref.exr --size 32x32 --spp 8 --quiet
"$volgi" reference "$scene" -o a.exr --size 32x32 --spp 2 --seed 2 --quiet
"$volgi" reference "$scene" -o b.exr --size 32x32 --spp 2 --seed 3 --quiet
cp b.exr other/a.exr

fail() {
  echo "$1"
  exit 1
}

# Signature, then width and height of a PNG: 32 pixels become 256, and the colour bar adds 32 rows.
head_of() { od -An -tx1 -N24 "$1" | tr -d ' \n'; }
is_map() { [[ $(head_of "$1") == 89504e470d0a1a0a0000000d494844520000010000000120 ]] || fail "$1 is no map of 256x288"; }

"$volgi" compare ref.exr a.exr --diff one.png > /dev/null
is_map one.png
"$volgi" compare ref.exr a.exr b.exr --diff maps > table.txt
is_map maps/a.png
is_map maps/b.png
cmp -s maps/a.png one.png || fail "the same picture has another map among several"
cmp -s maps/a.png maps/b.png && fail "two pictures have the same map"
grep -q 'a.exr$' table.txt && grep -q 'b.exr$' table.txt || fail "the table lacks a picture"

code=0
"$volgi" compare ref.exr a.exr other/a.exr --diff same 2> error.txt || code=$?
((code == 2)) || fail "two pictures of one name: exit code $code instead of 2"
[[ ! -e same ]] || fail "a folder was made for maps that cannot be"
grep -q 'called a' error.txt || fail "the message does not name the picture: $(< error.txt)"
echo "maps hold"
