# What the examples' checks share. Usage of every check: sh NAME.sh PREFIX /path/to/NAME
# Runs the example in a temporary folder; its output is in said.txt.
set -u
prefix=$1
example=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

fail() {
  echo "FAILED: $*"
  cat said.txt
  exit 1
}

# run ARGUMENT...
run() {
  "$example" "$@" > said.txt || fail "exit code $?"
}

# holds CONDITION MESSAGE: an awk program over the output; it exits with 0 if the condition holds.
holds() {
  awk "$1" said.txt || fail "$2"
}
