# The page and what it takes from the report's viewer, by TypeScript's strictest rules.
# Usage: types.sh SOURCE_TREE NODE_MODULES
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/src/studio" "$work/src/report"
cp -r "$1/src/studio/page" "$work/src/studio/page"
cp -r "$1/src/report/viewer" "$work/src/report/viewer"
ln -s "$2" "$work/node_modules"
"$2/.bin/tsc" -p "$work/src/studio/page"
