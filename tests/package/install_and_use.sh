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
