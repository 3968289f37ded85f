#!/usr/bin/env bash
# Nobody but a technique's own leaf, the registry and pages knows its name: not the frame, nor options, stats, report.
#   technique_names.sh SOURCE_FOLDER
set -u
cd "$1" || exit 2
names='hybrid|\bvpls?\b|\bvals?\b|negative_?light|\blpv|rsm|resample|strided|interleaved|area_?(light|map)|near_?light'
places=(screen/frame apps/report apps/volgi/frame_options.cpp apps/volgi/frame_options.h apps/volgi/frame_stats.cpp
  apps/volgi/frame_stats.h)
for place in "${places[@]}"; do
  [[ -e $place ]] || { echo "no $place: this test looks at nothing"; exit 1; }
done
# Help texts may give an example; registry.cpp is the list.
found=$(grep -rnEi "$names" "${places[@]}" --include='*.cpp' --include='*.h' --include='*.js' --include='*.html' |
  grep -vE '^screen/frame/registry\.cpp:|^[^:]*:[0-9]+: *(//|\*)')
if [[ -n $found ]]; then
  echo "techniques are named outside their leaves:"
  echo "$found"
  exit 1
fi
