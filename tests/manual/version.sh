# The version: from tags, from what `git archive` writes, and without either.
# version.sh SOURCE CMAKE
set -u
source=$1
cmake=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
command -v git >/dev/null || { echo 'git is not installed'; exit 77; }
export GIT_CONFIG_GLOBAL=/dev/null GIT_AUTHOR_NAME=a GIT_AUTHOR_EMAIL=a@localhost \
  GIT_COMMITTER_NAME=a GIT_COMMITTER_EMAIL=a@localhost \
  GIT_AUTHOR_DATE='2001-02-03T04:05:06Z' GIT_COMMITTER_DATE='2001-02-03T04:05:06Z'
unset SOURCE_DATE_EPOCH

cat > "$work/say.cmake" <<'CMAKE'
include(${SOURCE_FOLDER}/cmake/version.cmake)
message("${HYDRODIP_NUMBER}|${HYDRODIP_VERSION_TEXT}|${HYDRODIP_DATE}")
CMAKE
# says EXPECTED FOLDER: hexadecimal digits of commits count as 'C'.
says() {
  got=$("$cmake" -D "SOURCE_FOLDER=$2" -P "$work/say.cmake" 2>&1 | sed 's/[0-9a-f]\{7\})/C)/')
  [ "$got" = "$1" ] && return
  echo "FAILED: expected '$1', got '$got'"
  failures=$((failures + 1))
}
mkdir -p "$work/tree/cmake"
cd "$work/tree" || exit 1
cp "$source/cmake/version.cmake" cmake
cp "$source/.git_archival.txt" "$source/.gitattributes" .
usual=$(sed -n 's/^set(HYDRODIP_NUMBER \([0-9.]*\)).*/\1/p' cmake/version.cmake)
says "$usual|$usual|2026-01-01" .           # files of a tree that never saw git
git init -q . && git add . && git commit -qm one
says "$usual|$usual (C)|2001-02-03" .       # before the first tag
git tag -a -m release v7.8.9
says '7.8.9|7.8.9|2001-02-03' .
git archive --prefix=tagged/ HEAD | tar -x -C "$work"
says '7.8.9|7.8.9|2001-02-03' "$work/tagged"
echo more > more && git add more && git commit -qm two
says '7.8.9|7.8.9 (1 commits later, C)|2001-02-03' .
git archive --prefix=later/ HEAD | tar -x -C "$work"
says '7.8.9|7.8.9 (1 commits later, C)|2001-02-03' "$work/later"
# What is written by hand says the same.
grep -qx "version: $usual" "$source/CITATION.cff" || {
  echo "FAILED: CITATION.cff does not say version: $usual"
  failures=$((failures + 1))
}
# Unpacked within somebody else's repository it still says its own version.
cp -r "$work/tagged" inner
says '7.8.9|7.8.9|2001-02-03' "$work/tree/inner"
[ "$failures" -eq 0 ] || exit 1
echo 'all passed'
