# Read by the scripts beside it, whose first two arguments are VOLGI SOURCE_FOLDER: $volgi, a $scene, an empty folder to
# be in, $logs beside it, and what they say. They end with exit $((failures > 0)).
volgi=$1
scene=$2/data/cornell.glb
logs=$(mktemp -d)
work=$(mktemp -d)
trap 'rm -rf "$logs" "$work"' EXIT
cd "$work" || exit 1
failures=0

fail() {
  failures=$((failures + 1))
  printf '%s\n' "$*"
}

# must COMMAND...: succeeds without a word on stderr; its output goes to $logs/out
must() {
  "$@" > "$logs/out" 2> "$logs/err" || fail "failed: $*: $(< "$logs/err")"
  # Open scenes are warned about; data/ has some.
  ! grep -v 'open, and there is no sky' "$logs/err" || fail "wrote to stderr: $*: $(< "$logs/err")"
}

# refuse CODE CULPRIT ARGUMENT...: volgi ends with CODE, one line on stderr names the culprit, no file is left behind
refuse() {
  local code=$1 culprit=$2 before status lines
  shift 2
  before=$(find . | sort)
  timeout 60 "$volgi" "$@" > "$logs/out" 2> "$logs/err"
  status=$?
  lines=$(wc -l < "$logs/err")
  find . | sort > "$logs/files"
  if ((status == code && lines == 1)) && grep -qF -- "$culprit" "$logs/err" && [[ $before == "$(< "$logs/files")" ]]; then
    return
  fi
  fail "$(printf 'volgi %s\n  exit code %d, expected %d; %d lines on stderr, expected one that names "%s":' \
    "$*" "$status" "$code" "$lines" "$culprit")"
  sed 's/^/  | /' "$logs/err"
  diff <(echo "$before") "$logs/files" | sed 's/^/  files: /'
}
