#!/bin/sh
# fresh_root.sh ROOTS DEB...: installs the packages in a fresh Debian 12 and removes them again.
# Needs root, mmdebstrap and, the first time, the network; keeps the empty system in ROOTS.
set -eu
roots=$1
shift
say() { printf '== %s\n' "$*"; }
die() { printf 'fresh_root.sh: %s\n' "$*" >&2; exit 1; }

[ "$(id -u)" -eq 0 ] || die 'this needs root: a file system of its own is set up'
mkdir -p "$roots"
roots=$(cd "$roots" && pwd)
if [ ! -e "$roots/bookworm.tar" ]; then
  say 'making an empty Debian 12'
  mmdebstrap --variant=minbase --include=ca-certificates bookworm "$roots/part.tar"
  mv "$roots/part.tar" "$roots/bookworm.tar"
fi
# In a mount namespace of its own, so that nothing stays mounted whatever happens.
[ -n "${FRESH_ROOT_UNSHARED:-}" ] || exec env FRESH_ROOT_UNSHARED=1 unshare -m sh "$0" "$roots" "$@"

root=$(mktemp -d "$roots/root.XXXXXX")
# umount first: nothing outside the root may be removed with it.
trap 'umount "$root/proc" 2>/dev/null; umount "$root/dev" 2>/dev/null; rm -rf --one-file-system "$root"' EXIT
trap 'exit 1' HUP INT TERM
tar -x -C "$root" -f "$roots/bookworm.tar"
mount -t proc proc "$root/proc"
mount -t tmpfs tmpfs "$root/dev"
mknod -m 666 "$root/dev/null" c 1 3
mknod -m 666 "$root/dev/zero" c 1 5
mknod -m 666 "$root/dev/urandom" c 1 9
cp /etc/resolv.conf "$root/etc/resolv.conf" 2>/dev/null || true
cp "$@" "$root/var/tmp"
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
  DEBIAN_FRONTEND=noninteractive http_proxy="${http_proxy:-}" "$@"; }
# What lies in the system, without what apt, dpkg and caches of other packages keep.
files() {
  (cd "$root" && find . -xdev \( -path ./proc -o -path ./dev -o -path ./var/tmp -o -path ./tmp -o -path ./root \
    -o -path ./var/lib/apt -o -path ./var/cache -o -path ./var/lib/dpkg -o -path ./var/log \) -prune -o -print |
    LC_ALL=C sort)
}

say 'getting what the packages depend on'
inside apt-get -qq update
names=$(for deb; do dpkg-deb -f "$deb" Package; done)
# All that they need and a compiler, but not the packages themselves: those come and go alone.
needed=$(inside sh -c 'cd /var/tmp && apt-get install -s --no-install-recommends ./*.deb' |
  sed -n 's/^Inst \([^ ]*\) .*/\1/p' | grep -vxF "$names" || true)
# shellcheck disable=SC2086
inside apt-get -qq -o Dpkg::Use-Pty=0 install -y --no-install-recommends $needed g++ cmake make pkg-config \
  >"$roots/apt.log" 2>&1 || { tail -20 "$roots/apt.log"; die 'apt-get failed'; }
files >"$roots/before"

say "installing $(echo $names)"
inside sh -c 'dpkg -i /var/tmp/*.deb' >"$roots/dpkg.log" 2>&1 || { cat "$roots/dpkg.log"; die 'dpkg -i failed'; }
for name in $names; do
  [ -z "$(inside dpkg --verify "$name" | grep -v ' /usr/share/doc/' || true)" ] || die "$name: files differ"
done

say 'hydrodip --version, sample, print'
inside sh -c 'cd /root && hydrodip --version && hydrodip sample mask -o models >/dev/null &&
  hydrodip print models/mask.obj --film a4 --quality draft --dpi 72 -o out --quiet >out.txt &&
  for file in print.pdf print.png print.tif film.ply report.json report.html; do test -s out/$file; done &&
  head -n 1 out.txt' || die 'hydrodip does not work'

case " $(echo $names) " in
  *' libhydrodip-dev '*)
    say 'find_package(hydrodip), pkg-config'
    cp -r "$(dirname "$0")/../examples" "$root/root/examples"
    inside sh -c 'cd /root && cmake -S examples -B built >/dev/null && cmake --build built -j 2 >/dev/null &&
      built/print_job models/mask.obj job >print_job.txt 2>&1 || { code=$?; cat print_job.txt; exit $code; }
      pkg-config --modversion hydrodip' || die 'the library does not work'
    ;;
esac
case " $(echo $names) " in
  *' python3-hydrodip '*)
    say 'import hydrodip'
    inside python3 -c 'import hydrodip; print("hydrodip", hydrodip.__version__)' || die 'import hydrodip fails'
    ;;
esac

say 'removing them'
rm -rf "$root/root/models" "$root/root/out" "$root/root/examples" "$root/root/built"
# shellcheck disable=SC2086
inside dpkg --purge $names >"$roots/dpkg.log" 2>&1 || { cat "$roots/dpkg.log"; die 'dpkg --purge failed'; }
files >"$roots/after"
diff "$roots/before" "$roots/after" >"$roots/left" || { cat "$roots/left"; die 'something is left behind, or missing'; }
say 'nothing is left behind'
