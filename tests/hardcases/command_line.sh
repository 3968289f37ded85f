#!/usr/bin/env bash
# Errors of the command line: exactly one line on stderr that names the culprit, the documented exit code, and no file
# left behind, not even a temporary one.
#   command_line.sh VOLGI SOURCE_FOLDER [gl]    gl: the program has the commands that need OpenGL
set -u
gl=${3-}
source "$(dirname "$0")/checks.sh"

echo 'not a scene' > text.glb
head -c 3000 "$scene" > truncated.glb
head -c 10 "$scene" > header.glb
: > empty.glb
echo '{"asset":{"version":"2.0"},"scenes":[{}' > broken.gltf
echo '{"asset":{"version":"1.0"}}' > old.gltf
cat > texture.gltf << 'EOF'
{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
 "images":[{"uri":"brick.png"}],"textures":[{"source":0}],
 "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],
 "meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"material":0}]}],
 "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[0,0,0]},
              {"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"}],
 "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24}],
 "buffers":[{"byteLength":60,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA"}]}
EOF
mkdir folder.exr

commands=(reference)
[[ -n $gl ]] && commands+=(render)
for command in "${commands[@]}"; do
  quick=(-o out.exr --size 8x8)
  [[ $command == reference ]] && quick+=(--spp 2)
  for file in text.glb truncated.glb header.glb empty.glb broken.gltf old.gltf missing.glb; do
    refuse 3 "$file" "$command" "$file" "${quick[@]}"
  done
  refuse 3 brick.png "$command" texture.gltf --strict "${quick[@]}"
  refuse 6 /proc/none "$command" "$scene" -o /proc/none/out.exr --size 8x8
  refuse 6 none/ "$command" "$scene" -o none/out.exr --size 8x8
  refuse 6 text.glb/ "$command" "$scene" -o text.glb/out.exr --size 8x8
  refuse 6 folder.exr "$command" "$scene" -o folder.exr --size 8x8
  refuse 2 out.jpg "$command" "$scene" -o out.jpg --size 8x8
  refuse 2 "--camera 7" "$command" "$scene" "${quick[@]}" --camera 7
  refuse 2 --camera "$command" "$scene" "${quick[@]}" --camera -1
  refuse 2 --nonsense "$command" "$scene" "${quick[@]}" --nonsense
  refuse 2 --eye "$command" "$scene" "${quick[@]}" --eye 1,2 --target 0,0,0
  refuse 2 --target "$command" "$scene" "${quick[@]}" --eye 1,2,3
  refuse 2 --light "$command" "$scene" "${quick[@]}" --light sideways
  refuse 2 --bounces "$command" "$scene" "${quick[@]}" --bounces -1
  for size in 0x8 8 8x 8x8x8 -8x8 8x99999 eightxeight 8X8.5; do
    refuse 2 "$size" "$command" "$scene" -o out.exr "--size=$size"
  done
  refuse 2 SCENE "$command"
done
if [[ -n $gl ]]; then
  refuse 2 --scheme render "$scene" -o out.exr --scheme magic
  refuse 2 --exposure render "$scene" -o out.exr --exposure bright
  refuse 2 --lamp render "$scene" -o out.exr --size 8x8 --lamp 1,2,3
  refuse 2 --sun render "$scene" -o out.exr --size 8x8 --sun up
  refuse 2 --gi render "$scene" -o out.exr --gi magic
  refuse 2 --grid render "$scene" -o out.exr --grid 0
  refuse 2 --grid render "$scene" -o out.exr --grid many
  refuse 2 --directions render "$scene" -o out.exr --directions 9
  refuse 2 --directions render "$scene" -o out.exr --scheme conservative --directions 8
  refuse 2 nonsense=1 render "$scene" -o out.exr --set nonsense=1
  refuse 2 grid.shift=up render "$scene" -o out.exr --set grid.shift=up
  refuse 2 grid.shift=9 render "$scene" -o out.exr --set grid.shift=9
  refuse 2 grid.shift render "$scene" -o out.exr --set grid.shift
  refuse 2 "device 99" render "$scene" -o out.exr --device 99
  VOLGI_DEVICE=98 refuse 2 "device 98" render "$scene" -o out.exr
  VOLGI_DEVICE=98 refuse 2 "device 99" render "$scene" -o out.exr --device 99
  VOLGI_DEVICE=first refuse 2 "VOLGI_DEVICE='first'" render "$scene" -o out.exr
  refuse 2 "benchmark gpu" bench frame -o out.md
  refuse 6 none/ bench gpu --quick -o none/out.md
  refuse 6 none/ render "$scene" -o out.exr --size 8x8 --stats none/stats.json
  for number in 0 -1 65537 many 1.5; do
    refuse 2 --vpls render "$scene" -o out.exr --gi vpl "--vpls=$number"
    refuse 2 --vpls-per-light render "$scene" -o out.exr --gi negative "--vpls-per-light=$number"
  done
  for parameter in vpl.one_of=0 vpl.flux=2 negative.count=0 negative.count=1025 negative.method=3 gather.stride=0 \
    gather.stride=17 gather.contrast=-1 gather.distance=2; do
    refuse 2 "$parameter" render "$scene" -o out.exr --gi negative --set "$parameter"
  done
  refuse 6 text.glb/dump render "$scene" -o out.exr --size 8x8 --gi vpl --dump text.glb/dump
fi
refuse 2 "'magic'" magic
refuse 3 missing.exr compare missing.exr missing.exr
refuse 3 text.glb compare text.glb text.glb

# What vpl and negative dump, the reference gathers again.
if [[ -n $gl ]]; then
  for gi in vpl negative; do
    if ! { "$volgi" render "$scene" -o "$logs/$gi.exr" --size 8x8 --gi "$gi" --vpls 64 --grid 8 --quiet \
      --dump "$logs/$gi" &&
      grep -qF '"kind"' "$logs/$gi/virtual_lights.json" &&
      "$volgi" reference "$scene" -o "$logs/$gi.ref.exr" --size 8x8 --vpls "$logs/$gi/virtual_lights.json"; } \
      > "$logs/out" 2>&1; then
      failures=$((failures + 1))
      printf -- '--gi %s --dump:\n' "$gi"
      sed 's/^/  | /' "$logs/out"
    fi
  done
fi

# Times are a warm frame's, or said to be the cold one's.
if [[ -n $gl ]]; then
  must "$volgi" render "$scene" -o "$logs/frame.exr" --size 8x8 --grid 8 --frames 2 --stats "$logs/warm.json"
  grep -q '^  frame  .*(median of 2; .*; cold ' "$logs/out" || fail "--frames 2: no cold frame apart: $(< "$logs/out")"
  must "$volgi" render "$scene" -o "$logs/frame.exr" --size 8x8 --grid 8 --stats "$logs/cold.json"
  grep -q '^  frame, cold ' "$logs/out" || fail "one frame is not said to be cold: $(< "$logs/out")"
  must python3 - "$logs/warm.json" "$logs/cold.json" << 'EOF'
import json, sys
warm, cold = (json.load(open(path)) for path in sys.argv[1:])
assert warm["warm"] and warm["frames"] == 2 and warm["frame_ms"]["min"] < warm["cold"]["frame_ms"], warm
assert not cold["warm"] and cold["frames"] == 1, cold
assert cold["frame_ms"]["median"] == cold["cold"]["frame_ms"] and cold["passes"] == cold["cold"]["passes"], cold
EOF
fi

((failures == 0)) || printf '%d commands did not fail as they should\n' "$failures"
exit $((failures > 0))
