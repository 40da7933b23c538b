#!/bin/sh
# release_check.sh DEV [STEP...]: everything that has to hold before a release, or some of it, one step
# after the other; goes on after a failure and says at the end what failed.
set -u
dev=$1
shift
[ $# -gt 0 ] || set -- clean test lint clang portable sanitize tsan fuzz commands package arm64 mutate

step() {
  case $1 in
    clean) [ -z "$(git status --porcelain)" ] || { echo 'the tree has changes that are not committed'; return 1; } ;;
    fuzz) FUZZ_SECONDS=${FUZZ_SECONDS:-600} "$dev" fuzz ;;
    commands) "$dev" docs commands ;;
    *) "$dev" "$1" ;;
  esac
}

mkdir -p build/release-check
failed=
for name in "$@"; do
  printf '== %s\n' "$name"
  started=$(date +%s)
  if step "$name" >"build/release-check/$name.log" 2>&1; then
    printf '   passed (%s s)\n' $(($(date +%s) - started))
  else
    printf '   FAILED (%s s): build/release-check/%s.log ends\n' $(($(date +%s) - started)) "$name"
    tail -n 15 "build/release-check/$name.log"
    failed="$failed $name"
  fi
done
[ -z "$failed" ] || { printf 'not ready for a release:%s\n' "$failed"; exit 1; }
echo 'all of it passed; docs/release.md has what is left to do by hand'
