#!/bin/sh
# preview.glb of jobs of every kind, in Khronos' glTF validator and, where there is one, Blender.
# Usage: sh glb.sh HYDRODIP NODE NODE_MODULES [BLENDER]
here=$(cd "$(dirname "$0")" && pwd)
node=$2
modules=$3
blender=${4:-}
. "$here/../cli/common.sh"

"$hydrodip" sample sphere > /dev/null || fail 'sample sphere'
write_colored colored.ply
write_tetrahedron tetra.obj
# shellcheck disable=SC2086
{
  "$hydrodip" print sphere.obj --size 30 --depth 6 $quick -o textured > /dev/null || fail textured
  "$hydrodip" print sphere.obj --size 30 $quick -o torn > /dev/null || fail torn
  "$hydrodip" print colored.ply $quick -o colored > /dev/null || fail colored
  "$hydrodip" simulate tetra.obj $quick_simulate -o plain > /dev/null || fail plain
}
NODE_PATH=$modules "$node" "$here/validate_glb.cjs" */preview.glb || fail 'errors or warnings'
if [ -n "$blender" ]; then
  "$blender" -b --factory-startup -noaudio --python-exit-code 1 -P "$here/blender_import.py" -- \
    textured/preview.glb > blender.txt 2>&1 || fail "blender: $(cat blender.txt)"
fi
finish
