#!/usr/bin/env bash
# volgi as ranks of mpirun: ranks.sh CASE VOLGI SOURCE_DIR
set -euo pipefail
case=$1 volgi=$2 source=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

fail() {
  printf 'ranks.sh %s: %s\n' "$case" "$*" >&2
  exit 1
}
# ranks N COMMAND...: more of them than cores, if need be.
ranks() {
  local count=$1
  shift
  timeout 200 mpirun -q --oversubscribe --bind-to none -n "$count" "$volgi" "$@"
}
same() { cmp -s "$1" "$2" || fail "$1 and $2 differ: $3"; }
# one_line FILE: exactly one line of volgi's on stderr.
one_line() { [[ $(grep -c '^volgi: ' "$1") == 1 ]] || fail "not one line: $(cat "$1")"; }

# Export of one rank and of others: the same bytes.
check_export() {
  local scene=$1 name
  shift
  name=$(basename "$scene" .glb)
  "$volgi" export "$scene" -o one.vdb --quiet "$@"
  for count in $counts; do
    ranks "$count" export "$scene" -o many.vdb --threads 1 --quiet "$@"
    same one.vdb many.vdb "$name $*, $count ranks"
    [[ -z $(compgen -G 'many.*.vdb') ]] || fail "parts are left"
  done
}

same_bytes() {
  counts="2 3 4 8"
  check_export "$source/data/cornell.glb" --grid 64
  check_export "$source/data/room.glb" --grid 64
  counts="2 8"
  check_export "$source/data/cornell.glb" --grid 128
  counts="3"
  check_export "$source/data/cornell.glb" --grid 48 --stage voxels
  check_export "$source/data/thin_wall.glb" --grid 40 --bounces 2 --directions 48
  check_export "$source/data/room.glb" --grid 40 --first-light faces
  check_export "$source/data/cornell.glb" --grid 40 --scheme conservative --bounces 1
  local atrium
  atrium=$(dirname "$(dirname "$volgi")")/data/atrium.glb
  if [[ -f $atrium ]]; then
    counts="4"
    check_export "$atrium" --grid 64
  fi
  # Parts, and their merge later.
  "$volgi" export "$source/data/cornell.glb" -o one.vdb --quiet --grid 32
  ranks 3 export "$source/data/cornell.glb" -o parts.vdb --grid 32 --parts --quiet
  [[ ! -e parts.vdb && -e parts.2.vdb ]] || fail "--parts leaves one file a rank"
  "$volgi" merge parts.2.vdb parts.0.vdb parts.1.vdb -o merged.vdb
  same one.vdb merged.vdb "merged later"
  ranks 2 export "$source/data/cornell.glb" -o two.nvdb --grid 32 --quiet
  "$volgi" export "$source/data/cornell.glb" -o one.nvdb --grid 32 --quiet
  same one.nvdb two.nvdb "NanoVDB"
}

# A picture of ranks is that of one: with the sides that pixels see, with all where lobes of what shines look for them, of
# pictures that are averaged, and where sides are more than the GPU's buffers hold.
check_picture() {
  local count=$1 scene=$2
  shift 2
  "$volgi" render "$scene" -o one.exr --gi volume --backend cpu --size 96x72 --quiet "$@"
  ranks "$count" render "$scene" -o many.exr --gi volume --size 96x72 --threads 1 --quiet "$@"
  same one.exr many.exr "$(basename "$scene") $*, picture of $count ranks"
}
pictures() {
  check_picture 2 "$source/data/cornell.glb" --grid 48 --bounces 3
  check_picture 3 "$source/data/cornell.glb" --grid 40 --first-light faces
  check_picture 4 "$source/data/room.glb" --grid 48 --samples 3 --set grid.jitter=1
  check_picture 3 "$source/data/cornell.glb" --grid 300 --bounces 0 --directions 24
  refuses 2 'one rank' render "$source/data/cornell.glb" -o out.exr --gi hybrid --grid 16
  refuses 2 'animate' render "$source/data/cornell.glb" -o out.exr --gi volume --animate 0:1:2
  refuses 2 'backend gpu' render "$source/data/cornell.glb" -o out.exr --gi volume --backend gpu
}

# refuses CODE WORDS COMMAND...
refuses() {
  local code=$1 words=$2 result=0
  shift 2
  ranks 3 "$@" 2> said || result=$?
  [[ $result == "$code" ]] || fail "exit code $result, not $code: $* $(cat said)"
  one_line said
  grep -q "$words" said || fail "'$words' is not in: $(cat said)"
}

faults() {
  local cornell=$source/data/cornell.glb result
  refuses 3 'no such file' export missing.glb -o out.vdb
  refuses 2 'not in range' export "$cornell" -o out.vdb --grid 0
  refuses 2 'runs as one rank' inspect "$cornell"
  refuses 2 'one rank' export "$cornell" -o out.vdb --scheme lpv2009 --grid 16
  refuses 5 'memory-limit' export "$cornell" -o out.vdb --memory-limit 1K --grid 16
  refuses 6 'folder' export "$cornell" -o missing/out.vdb --grid 16
  # Out of memory on one rank.
  result=0
  timeout 100 mpirun -q --oversubscribe --bind-to none -n 2 "$volgi" export "$cornell" -o out.vdb --grid 128 --threads 1 \
    : -n 1 bash -c "ulimit -v 420000; exec '$volgi' export '$cornell' -o out.vdb --grid 128 --threads 1" 2> said || result=$?
  [[ $result == 5 ]] || fail "out of memory: exit code $result, $(cat said)"
  one_line said
  grep -q 'rank 2.*memory' said || fail "out of memory: $(cat said)"
}

# Waits until the state of a run is at a pass, or the run has ended; pass 0: until it has begun.
reached() {
  local job=$1 pass=$2
  while kill -0 "$job" 2> /dev/null; do
    if ((pass == 0)) && [[ -d kept ]]; then return; fi
    if [[ $(cut -d ' ' -f 1 kept/current 2> /dev/null || true) -ge $pass && -e kept/current ]]; then return; fi
    sleep 0.002
  done
}

# A rank is killed at 20 moments, from the beginning to the last passes; another number of ranks goes on.
checkpoint() {
  local cornell=$source/data/cornell.glb job victim result killed=0
  "$volgi" export "$cornell" -o one.vdb --grid 96 --quiet
  for i in {0..19}; do
    rm -rf kept
    mpirun -q --oversubscribe --bind-to none -n 3 "$volgi" export "$cornell" -o many.vdb --grid 96 --threads 1 \
      --checkpoint kept --quiet 2> said &
    job=$!
    reached $job $((i / 3))
    sleep "0.0$((i % 3 * 3))"
    victim=$(pgrep -P $job | sed -n "$((1 + i % 3))p")
    result=0
    if [[ -n $victim ]]; then kill -9 "$victim" 2> /dev/null || true; fi
    wait $job || result=$?
    [[ $result == 0 || $result == 137 ]] || fail "killed: exit code $result, $(cat said)"
    if [[ $result == 137 ]]; then
      one_line said
      ((++killed))
    fi
    printf 'moment %d: exit code %d, state %s\n' "$i" "$result" "$(cat kept/current 2> /dev/null || echo none)"
    ranks $((1 + i % 4)) export "$cornell" -o many.vdb --grid 96 --threads 1 --checkpoint kept --quiet
    same one.vdb many.vdb "gone on after moment $i"
  done
  ((killed >= 10)) || fail "only $killed runs were killed before their end"
}

bench() {
  ranks 2 bench mpi --largest-grid 32 --frames 2 > said
  for words in 'latency' 'strong scaling' 'weak scaling' 'predicted' 'waiting' 'on paper' '4096 ranks'; do
    grep -q "$words" said || fail "'$words' is not in: $(cat said)"
  done
  ranks 2 bench mpi --largest-grid 32 --frames 2 --json | python3 -c '
import json, sys
r = json.load(sys.stdin)["mpi"]
assert r["ranks"] == 2 and 0 < r["strong"]["efficiency"] < 2 and 0 < r["strong"]["predicted_efficiency"] < 2, r'
}

# 256^3 cells as four ranks, each with a third of what one needs: they are lean, and cut by what they need
# (docs/results/mpi.md).
memory() {
  local cornell=$source/data/cornell.glb need
  "$volgi" export "$cornell" -o out.vdb --grid 256 --bounces 0 --memory-limit 1 2> said || true
  need=$(sed -n 's/.*needs about \([0-9]*\).*/\1/p' said)
  ((need > 100)) || fail "no need is stated: $(cat said)"
  ranks 4 export "$cornell" -o out.vdb --grid 256 --bounces 0 --threads 1 --parts --quiet --memory-limit "$((need / 3))M"
  printf 'one rank needs %d MiB; four run with %d each\n' "$need" "$((need / 3))"
}

"$case"
