#!/usr/bin/env bash
# The pictures of docs/demo.md and the film of the README, from the repository's root after ./run build:
#   docs/pictures/demo/make_pictures.sh            all of them
#   docs/pictures/demo/make_pictures.sh views      those without a window
# The window's needs Xvfb and ffmpeg, the film ffmpeg.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../../.."
demo=build/release/bin/volgi-demo out=docs/pictures/demo what=${1-all}

view() {  # NAME [OPTION...]
  local name=$1
  shift
  "$demo" data/cornell.glb --headless --size 320x240 --samples 4 "$@" -o "$out/$name.png"
}

views() {
  local name
  for name in picture direct first_bounce higher_bounces emission albedo normals depth voxels coverage lobe lights clusters \
    cluster_maps low_resolution; do
    view "$name" --view "$name"
  done
  view texture --do "texture screen/base/reflective_shadow_map light 0 albedo"
  view light_tree --view light_tree --do "layer 3"
  view negative_lights --gi negative --view negative_lights
  sheet picture direct first_bounce higher_bounces emission albedo normals depth voxels coverage lobe lights clusters \
    cluster_maps negative_lights low_resolution texture light_tree
}

# All of them on one page.
sheet() {
  /usr/bin/python3 - "$out" "$@" << 'PY'
import sys
import numpy
import OpenImageIO as oiio

folder, *names = sys.argv[1:]
pictures = [oiio.ImageBuf(f"{folder}/{name}.png").get_pixels(oiio.UINT8)[:, :, :3] for name in names]
columns, (height, width, _) = 5, pictures[0].shape
rows = -(-len(pictures) // columns)
page = numpy.zeros((rows * height, columns * width, 3), numpy.uint8)
for k, picture in enumerate(pictures):
    y, x = divmod(k, columns)
    page[y * height:(y + 1) * height, x * width:(x + 1) * width] = picture
target = oiio.ImageBuf(oiio.ImageSpec(page.shape[1], page.shape[0], 3, oiio.UINT8))
target.set_pixels(oiio.ROI(), page)
target.write(f"{folder}/sheet.png")
PY
}

film() {
  "$demo" builtin:metaballs --headless --path "$out/tour.json" --frames 81 --fps 8 --size 400x300 --preset fast -o "$out/tour.webp"
}

window() {
  local display picture=$out/window.png events
  events=$(mktemp)
  exec 3< <(Xvfb -displayfd 1 -screen 0 960x600x24 2> /dev/null)
  read -r display <&3
  DISPLAY=:$display "$demo" data/cornell.glb --no-settings --size 960x600 --events "$events" --do "light take 0" \
    --do "reference beside" &
  for _ in {1..60}; do
    grep -q "\"reference\":[1-9]" "$events" && break
    sleep 1
  done
  sleep 8
  ffmpeg -loglevel error -y -f x11grab -video_size 960x600 -i ":$display" -frames:v 1 "$picture"
  kill %1
  pkill -f "Xvfb -displayfd 1" || true
  rm -f "$events"
}

volume() {
  local vdb
  vdb=$(mktemp --suffix=.vdb)
  "${demo%-demo}" export data/cornell.glb -o "$vdb" --grid 48 --quiet
  "$demo" "$vdb" --headless --size 720x640 --do cut --do "move 0,-8,-6" --do "range 0,9" -o docs/pictures/demo/volume.png
  rm "$vdb"
}

case $what in
  all) views && film && window && volume ;;
  views | film | window | volume) "$what" ;;
  *) echo "make_pictures.sh: views, film, window, volume or nothing" >&2 && exit 2 ;;
esac
