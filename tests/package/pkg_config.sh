#!/bin/sh
# The installed headers compile, and a program links, with what pkg-config says.
# Usage: sh pkg_config.sh PREFIX COMPILER
set -u
prefix=$1
compiler=$2
command -v pkg-config > /dev/null || exit 77
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name hydrodip.pc)")
export PKG_CONFIG_PATH
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
flags=$(pkg-config --cflags hydrodip) || exit 1
libraries=$(pkg-config --libs hydrodip) || exit 1
# Warnings of Eigen's own are not looked for.
flags=$(echo "$flags" | sed 's|-I\([^ ]*eigen3\)|-isystem \1|')

(cd "$prefix/include" && find hydrodip -name '*.h') > "$work/headers"
[ -s "$work/headers" ] || { echo "FAILED: no header is installed"; exit 1; }
# What people begin with, alone (hydrodip.h: in the program below); all others together, in order and backwards, so that one that lacks
# something cannot always find it in those before. (That each stands alone is what ./dev lint sees:
# every source names its own header first.)
grep -v -e '/.*/' -e '^hydrodip/hydrodip.h$' "$work/headers" | while read -r header; do
  printf '#include "%s"\n' "$header" > "$work/$(basename "$header" .h)-alone.cpp"
done
LC_ALL=C sort "$work/headers" | sed 's/.*/#include "&"/' > "$work/in-order.cpp"
LC_ALL=C sort -r "$work/headers" | sed 's/.*/#include "&"/' > "$work/backwards.cpp"
for source in "$work"/*-alone.cpp "$work/in-order.cpp" "$work/backwards.cpp"; do
  # shellcheck disable=SC2086
  "$compiler" -std=c++20 -fsyntax-only -Wall -Wextra -Werror $flags "$source" ||
    { echo "FAILED: $(basename "$source") does not compile"; exit 1; }
done

printf '%s\n' '#include <hydrodip/hydrodip.h>' \
  'int main() { return hydrodip::sample("box").object->triangles.empty() ? 1 : 0; }' \
  > "$work/linked.cpp"
# shellcheck disable=SC2086
"$compiler" -std=c++20 -Wall -Wextra -Werror $flags "$work/linked.cpp" -o "$work/linked" $libraries ||
  { echo "FAILED: a program does not link"; exit 1; }
LD_LIBRARY_PATH=$(pkg-config --variable=libdir hydrodip) "$work/linked" ||
  { echo "FAILED: a linked program does not run"; exit 1; }
echo "all passed"
