#!/usr/bin/env bash
# onetbb.sh FOLDER: the system's own version of oneTBB, built with -fsanitize=thread and installed into FOLDER. Without it
# ThreadSanitizer sees neither how tasks are handed from thread to thread nor that their waiters wait, and every task is a
# race. The source is Debian's (apt-get source, in a list of its own: nothing of the system is changed).
set -euo pipefail
folder=$(readlink -m "$1")
version=$(dpkg-query -W -f '${source:Version}' libtbb-dev)
[[ ! -e $folder/$version ]] || exit 0
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/lists/partial" "$work/cache/archives/partial"
cat > "$work/debian.sources" << EOF
Types: deb-src
URIs: http://deb.debian.org/debian
Suites: $(. /etc/os-release && echo "$VERSION_CODENAME")
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg
EOF
options=(-q -o "Dir::Etc::sourcelist=$work/debian.sources" -o Dir::Etc::sourceparts=- -o "Dir::State::lists=$work/lists"
  -o "Dir::Cache=$work/cache" -o APT::Sandbox::User=root)
apt-get "${options[@]}" update > "$work/apt.log" 2>&1 &&
  (cd "$work" && apt-get "${options[@]}" source "onetbb=$version" >> apt.log 2>&1) || {
  cat "$work/apt.log" >&2
  exit 1
}
cmake -S "$work"/onetbb-*/ -B "$work/build" -G Ninja --log-level=NOTICE -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTBB_SANITIZE=thread \
  -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF -DCMAKE_INSTALL_PREFIX="$folder" -DCMAKE_CXX_FLAGS=-Wno-tsan
cmake --build "$work/build" --parallel "$(nproc)" > "$work/build.log" 2>&1 || {
  cat "$work/build.log" >&2
  exit 1
}
cmake --install "$work/build" > /dev/null
touch "$folder/$version"
