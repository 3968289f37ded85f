#!/usr/bin/env bash
# doxygen.sh OUT [HEADERS]: the library's reference in OUT/html, from the repository's headers or, given a prefix's
# include/volgi, from those that are installed. Exit code 1 where Doxygen warns.
set -euo pipefail
source=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." && pwd)
out=$(mkdir -p "$1" && cd "$1" && pwd)
headers=${2-}
version=$(sed -n 's/^project(volgi VERSION \([0-9.]*\) .*/\1/p' "$source/CMakeLists.txt")
if [[ -n $headers ]]; then
  input=$headers
else
  input=$(printf '%s ' "$source"/{core,reference,voxel,propagation,screen,shaders})
fi
cd "${headers:-$source}"
{
  cat "$source/docs/Doxyfile"
  printf 'INPUT = %s\nRECURSIVE = YES\nOUTPUT_DIRECTORY = %s\nPROJECT_NUMBER = %s\nSTRIP_FROM_PATH = %s\n' \
    "$input" "$out" "$version" "$PWD"
} | doxygen -
