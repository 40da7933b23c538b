#!/bin/sh
# `hydrodip view`: hands the report to the desktop's opener, or prints its path.
. "$(dirname "$0")/common.sh"

mkdir -p 'a job' bin empty
echo '<!DOCTYPE html>' > 'a job/report.html'
cat > bin/xdg-open <<'SH'
#!/bin/sh
printf '%s' "$1" > "$OPENED"
exit "${OPENER_FAILS:-0}"
SH
chmod +x bin/xdg-open
OPENED=$work/opened
export OPENED
path="$work/a job/report.html"

env DISPLAY=:7 PATH="$work/bin:$PATH" "$hydrodip" view 'a job' > text.txt || fail "view: $?"
[ "$(cat "$OPENED" 2> /dev/null)" = "$path" ] || fail "opened '$(cat "$OPENED")', not '$path'"
grep -qF "opened $path" text.txt || fail "says $(cat text.txt)"
rm -f "$OPENED"

env -u DISPLAY -u WAYLAND_DISPLAY PATH="$work/bin:$PATH" "$hydrodip" view 'a job/report.html' > text.txt ||
  fail "view without a screen: $?"
[ ! -e "$OPENED" ] || fail 'opened something without a screen'
grep -qxF "$path" text.txt || fail "does not print the path: $(cat text.txt)"

env DISPLAY=:7 OPENER_FAILS=3 PATH="$work/bin:$PATH" "$hydrodip" view 'a job' > text.txt || fail "no browser: $?"
grep -qxF "$path" text.txt || fail "no browser: does not print the path: $(cat text.txt)"

for wrong in empty nowhere bin/xdg-open; do
  "$hydrodip" view $wrong > out.txt 2> err.txt
  [ $? -eq 2 ] || fail "view $wrong: exit code"
  grep -q "^error: $wrong" err.txt || fail "view $wrong: $(cat err.txt)"
  [ ! -s out.txt ] || fail "view $wrong: something on stdout"
done
"$hydrodip" view > out.txt 2> err.txt && fail 'view without a folder is accepted'
finish
