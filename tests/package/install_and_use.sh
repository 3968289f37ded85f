#!/usr/bin/env bash
# install_and_use.sh CMAKE COMPILER SOURCE_DIR BINARY_DIR CONFIG: installs the build, moves the prefix elsewhere, and builds
# and runs consumer/ against it in a folder of its own.
set -euo pipefail
cmake=$1 compiler=$2 source=$3 binary=$4 config=$5

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp -r "$source/tests/package/consumer" "$work/consumer"
"$cmake" --install "$binary" --config "$config" --prefix "$work/staged" > "$work/install.log" || {
  cat "$work/install.log"
  exit 1
}
mv "$work/staged" "$work/prefix"  # a package that remembers where it was installed fails from here on

# As whole paths: a tree at /volgi is not meant by .../include/volgi.
paths=$(printf '%s\n' "$source" "$binary" "$work/staged" | sed 's/[][\.*^$+?(){}|]/\\&/g' | paste -sd'|')
if grep -rIlE "(^|[^[:alnum:]_./}-])($paths)(/|[^[:alnum:]_.-]|$)" "$work/prefix"; then
  echo "the files above name the source tree, the build tree or the first prefix"
  exit 1
fi

"$cmake" -S "$work/consumer" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE="$config" -DCMAKE_CXX_COMPILER="$compiler" \
  -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF -DCMAKE_CXX_FLAGS="-Wall -Wextra -Werror"
"$cmake" --build "$work/build"
"$work/build/consumer"
if [[ -x $work/prefix/bin/volgi ]]; then
  "$work/prefix/bin/volgi" --help > /dev/null
fi

# The examples know the prefix alone, too.
"$cmake" -S "$source/examples/volume_only" -B "$work/volume_only" -G Ninja -DCMAKE_BUILD_TYPE="$config" \
  -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF \
  -DCMAKE_CXX_FLAGS="-Wall -Wextra -Werror" > "$work/example.log" || { cat "$work/example.log"; exit 1; }
"$cmake" --build "$work/volume_only"
"$work/volume_only/volume_only" "$work/box.vdb"
# In a box of area A and mean albedo r a lamp of power P leaves the radiosity r P / (A (1 - r)) in the mean, four times
# that is the fluence: red 31, green 25 W/m2, but for where walls of one colour see the lamp more than others.
"$work/prefix/bin/volgi" inspect "$work/box.vdb" --json | python3 -c '
import json, sys
grid = json.load(sys.stdin)["grids"][0]
for mean, r in zip(grid["mean"], (0.6, (4 * 0.7 + 0.1 + 0.6) / 6)):
    expected = 4 * r * (4 * 3.14159 * 10) / (24 * (1 - r))
    assert abs(mean / expected - 1) < 0.15, (mean, expected)
assert grid["active_cells"] == 24**3, grid["active_cells"]'
[[ -d $work/prefix/include/volgi/screen ]] || exit 0  # a package without OpenGL
"$cmake" -S "$source/examples/minimal" -B "$work/minimal" -G Ninja -DCMAKE_BUILD_TYPE="$config" \
  -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF \
  -DCMAKE_CXX_FLAGS="-Wall -Wextra -Werror" > "$work/example.log" || { cat "$work/example.log"; exit 1; }
"$cmake" --build "$work/minimal"
lines=$(wc -l < "$source/examples/minimal/main.cpp")
((lines < 80)) || { echo "examples/minimal has $lines lines: it is to stay under 80"; exit 1; }
# Albedo 1/2, 4 pi 10 W, 24 m2: 5.24 W/m2 of reflected light arrive in the mean, 0.83 W/m2/sr leave. Two bands of
# spherical harmonics have 0.83 of that on this floor (tests/screen/library/volume_light_test.cpp): 0.69.
"$work/minimal/minimal" | tee "$work/minimal.txt"
awk '{ exit !($6 > 0.64 && $6 < 0.74) }' "$work/minimal.txt"
