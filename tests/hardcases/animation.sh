#!/usr/bin/env bash
# volgi render --animate and scenes called builtin:NAME: a frame is the picture of its time, byte for byte; what fails
# says so in one line and leaves the frames before it whole.
#   animation.sh VOLGI SOURCE_FOLDER
set -u
source "$(dirname "$0")/checks.sh"

"$volgi" render "$scene" -o probe.exr --size 8x8 --gi none --quiet 2> "$logs/err"
case $? in
  0) rm probe.exr ;;
  4) echo "no OpenGL: $(< "$logs/err")" && exit 77 ;;
  *) fail "cannot render: $(< "$logs/err")" ;;
esac

small=(--size 24x24 --grid 8 --vpls 32 --vals 4 --set shadow.spot=64 --set val.map=32)
for backend in gpu cpu; do
  for gi in volume hybrid; do
    options=(builtin:metaballs "${small[@]}" --gi $gi --backend $backend)
    must "$volgi" render "${options[@]}" -o out.exr --animate 1:2:2 --stats stats.json
    times=(1 1.5 2)
    for k in 0 1 2; do
      must "$volgi" render "${options[@]}" -o alone.exr --time "${times[k]}" --quiet
      cmp alone.exr "out.000$k.exr" || fail "--gi $gi --backend $backend: frame $k is not the picture of its time"
    done
    for pass in core/move_scene screen/frame/follow_scene '"frames": 2' '"warm": true' '"cold"' '"animate": "1:2:2"'; do
      grep -qF -- "$pass" stats.json || fail "no $pass in --stats"
    done
    [[ $(echo out.*) == "out.0000.exr out.0001.exr out.0002.exr" ]] || fail "frames: $(echo out.*)"
    rm -- *.exr
  done
done
must "$volgi" render "$scene" "${small[@]}" --gi none --quiet -o 'still_%02d.png' --animate 0:0.1:10
cmp still_00.png still_01.png || fail "a scene without animation moved"
rm still_*.png

# Two workers share the frames, one of them is killed at its second frame: the pictures of one process, and the exposure of
# the first frame for all. A third comes when all is done.
balls=(builtin:metaballs "${small[@]}" --gi hybrid --backend cpu --animate 0:1.5:4 --quiet)
must "$volgi" render "${balls[@]}" -o one.png
must "$volgi" render "${balls[@]}" -o one.exr
for kind in png exr; do
  for worker in 0 1; do
    "$volgi" render "${balls[@]}" -o "two.$kind" --share "share.$kind" 2> "$logs/worker$worker" &
    workers[worker]=$!
    until [[ $worker == 1 || -e share.$kind/frame-0000.done ]] || ! kill -0 "${workers[0]}" 2> "$logs/out"; do sleep 0.01; done
  done
  kill -KILL "${workers[0]}"
  wait "${workers[0]}" 2> "$logs/out"
  wait "${workers[1]}" || fail "the second worker of $kind failed: $(< "$logs/worker1")"
  for k in 0 1 2 3 4 5 6; do
    cmp "one.000$k.$kind" "two.000$k.$kind" || fail "shared frame $k is another picture"
  done
  [[ $(echo "share.$kind"/*.claim) == "share.$kind/*.claim" ]] || fail "claims are left: $(echo "share.$kind"/*.claim)"
  touch -d @0 two.*."$kind"
  must "$volgi" render "${balls[@]}" -o "two.$kind" --share "share.$kind"
  [[ $(find . -name "two.*.$kind" -newermt @1 | wc -l) == 0 ]] || fail "frames that were done are made again"
done
refuse 2 "is of another command" render "${balls[@]}" -o two.png --half --share share.png
refuse 2 --animate render "$scene" -o out.png --share share.png
refuse 2 --share render "${balls[@]}" -o two.png --share share.png --dump lights
rm -r one.* two.* share.*

# A film on an emissive texture: frames are the stills of their times, here and in the reference; it begins again.
must "$volgi" render "$scene" --size 8x4 --gi none --exposure 3 -o film.0000.png --quiet
must "$volgi" render "$scene" --size 6x6 --gi none --exposure -1 -o film.0001.png --quiet
lit="$(dirname "$scene")/emissive.glb"
film=("$lit" "${small[@]}" --gi hybrid --backend cpu --area-video 'film.%04d.png' --area-fps 2 --quiet)
must "$volgi" render "${film[@]}" -o out.exr --animate 0:1:2
for k in 0 1; do
  must "$volgi" render "${film[@]}" -o alone.exr --time "0.$((5 * k))"
  cmp alone.exr "out.000$k.exr" || fail "frame $k of a film is not the picture of its time"
done
cmp -s out.0000.exr out.0001.exr && fail "the film stands still"
cmp out.0000.exr out.0002.exr || fail "the film does not begin again"
for k in 0 1; do
  must "$volgi" reference "$lit" -o "reference$k.exr" --size 16x16 --spp 2 --time "0.$((5 * k))" --area-video 'film.%04d.png' --area-fps 2 --quiet
done
cmp -s reference0.exr reference1.exr && fail "the reference's film stands still"
rm -- *.exr
refuse 2 "no emissive surface" render "$scene" -o out.png --area-video film.0000.png
refuse 2 "there is no such PNG" render "$lit" -o out.png --area-video nothing.%04d.png
rm film.*

# The third frame's name is taken by a folder.
mkdir -p taken.0002.png/inside
"$volgi" render builtin:metaballs "${small[@]}" --gi none --exposure 0 -o taken.png --animate 0:1:4 --quiet 2> "$logs/err"
(($? == 6)) || fail "a frame that cannot be written: exit code is not 6"
[[ $(echo taken.*.png) == "taken.0000.png taken.0001.png taken.0002.png" ]] || fail "frames: $(echo ./*)"
must "$volgi" render builtin:metaballs "${small[@]}" --gi none --exposure 0 -o alone.png --time 0.25 --quiet
cmp alone.png taken.0001.png || fail "the frame before one that failed is not whole"
rm -r taken.* alone.png

for text in 1 0:1 0:1:0 0:1:-2 1:0:25 0:1:many nan:1:25 0:1e9:25 0:1:25:1; do
  refuse 2 "--animate '$text'" render builtin:metaballs -o out.png --animate "$text"
done
refuse 2 --animate render builtin:metaballs -o out.png --animate 0:1:2 --frames 2
refuse 2 --animate render builtin:metaballs -o out.png --animate 0:1:2 --time 1
refuse 6 none/ render builtin:metaballs -o none/out.png --animate 0:1:2
for command in render reference export; do
  out=out.exr
  [[ $command == export ]] && out=out.vdb
  refuse 2 builtin:metaballs "$command" builtin:teapot -o "$out"
done
refuse 2 builtin:metaballs crosscheck builtin:teapot

# Other commands take built-in scenes as well.
must "$volgi" reference builtin:metaballs -o reference.exr --size 16x16 --spp 2 --time 1.5 --quiet
must "$volgi" export builtin:metaballs -o balls.vdb --grid 8 --time 1.5 --quiet
must "$volgi" crosscheck builtin:metaballs --grid 8

((failures == 0)) || printf '%d failures\n' "$failures"
exit $((failures > 0))
