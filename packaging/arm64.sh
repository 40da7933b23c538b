#!/bin/sh
# arm64.sh ROOTS [FOLDER...]: builds the program, the library, packages and the tests of some folders
# for arm64, in a Debian 12 of its own that has Debian's cross compiler and its arm64 libraries, and
# runs the tests by qemu-user. Needs root, mmdebstrap and, the first time, the network.
set -eu
roots=$1
shift
[ $# -gt 0 ] || set -- base image object film elastic transfer sheet
say() { printf '== %s\n' "$*"; }
[ "$(id -u)" -eq 0 ] || { echo 'arm64.sh: this needs root: a file system of its own is set up' >&2; exit 1; }
[ -n "${ARM64_UNSHARED:-}" ] || exec env ARM64_UNSHARED=1 unshare -m sh "$0" "$roots" "$@"

source=$(cd "$(dirname "$0")/.." && pwd)
mkdir -p "$roots"
root=$(cd "$roots" && pwd)/arm64
tools='ca-certificates cmake ninja-build pkg-config g++ g++-aarch64-linux-gnu dpkg-dev file git gzip qemu-user-static esbuild
  libeigen3-dev libcli11-dev libtomlplusplus-dev nlohmann-json3-dev'
libraries='libc6-dev libstdc++-12-dev libembree-dev libtbb-dev zlib1g-dev libssl-dev libpng-dev libtiff-dev libjpeg-dev
  libwebp-dev libgif-dev libhpdf-dev liblcms2-dev libzip-dev libdraco-dev libmeshoptimizer-dev librsvg2-dev libxml2-dev libfmt-dev
  libfontconfig-dev libsqlite3-dev libapriltag-dev libcminpack-dev libcpp-httplib-dev libgtest-dev'
if [ ! -e "$root/ready" ]; then
  say 'making a Debian 12 that cross-compiles'
  rm -rf --one-file-system "$root"
  # shellcheck disable=SC2086
  mmdebstrap --variant=apt --architectures=amd64,arm64 \
    --include="$(echo $tools) $(printf '%s:arm64 ' $libraries)" bookworm "$root"
  touch "$root/ready"
fi
mkdir -p "$root$source" "$root/proc"
mount --bind "$source" "$root$source"
mount -t proc proc "$root/proc"
[ -e "$root/dev/null" ] || mknod -m 666 "$root/dev/null" c 1 3
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp LC_ALL=C.UTF-8 \
  sh -c 'cd "$1" && shift && exec "$@"' sh "$source" "$@"; }

say 'building for arm64'
inside git config --global --add safe.directory "$source"
inside cmake --preset arm64 --log-level=WARNING
targets=$(printf 'test_%s ' "$@")
# shellcheck disable=SC2086
inside cmake --build --preset arm64 --parallel "$(nproc)" --target hydrodip hydrodip_library hydrodip_share $targets
for folder; do
  say "the tests of $folder, by qemu-user"
  # What the sanitizers leave out takes too long here as well; and the emulator itself keeps half a
  # megabyte of every thread that ends.
  inside qemu-aarch64-static "build/arm64/tests/test_$folder" --gtest_brief=1 \
    --gtest_filter='-*Slow*:*/mask*:*.Mask*:*NewThreadsLeaveNoMemoryBehind'
done
say 'the program, by qemu-user'
inside sh -ec 'rm -rf build/arm64/try && qemu-aarch64-static build/arm64/hydrodip sample sphere -o build/arm64/try --quiet
  qemu-aarch64-static build/arm64/hydrodip print build/arm64/try/sphere.obj --quality draft --dpi 60 -o build/arm64/try/out --quiet
  file build/arm64/hydrodip'
say 'packing'
inside sh -ec 'cd build/arm64 && rm -rf debs && cpack --config CPackConfig.cmake >cpack.log || { cat cpack.log; exit 1; }
  for deb in debs/*.deb; do dpkg-deb -f "$deb" Package Architecture Multi-Arch Depends; done'
