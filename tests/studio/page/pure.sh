# Usage: pure.sh TEST.ts NODE_MODULES ESBUILD NODE
set -eu
NODE_PATH=$2 "$3" "$1" --bundle --platform=node --format=esm --log-level=warning | "$4" --input-type=module
