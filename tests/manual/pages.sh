# Manual pages: pages.sh HYDRODIP MAN_FOLDER. Every command has one, groff and mandoc find nothing to
# complain of, and each says what --help says.
set -u
hydrodip=$1
man=$2
failures=0
fail() { echo "FAILED: $*"; failures=$((failures + 1)); }

for command in $("$hydrodip" --help | sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p' | sort -u); do
  ls "$man"/man1/hydrodip-"$command"*.1 >/dev/null 2>&1 || fail "no page for hydrodip $command"
done
for page in "$man"/man*/*; do
  if command -v groff >/dev/null; then
    said=$(groff -man -Tutf8 -ww -z "$page" 2>&1)
    [ -z "$said" ] || fail "groff: $said"
  fi
  if command -v mandoc >/dev/null; then
    # A file that names another page cannot know whether that is installed.
    said=$(mandoc -Tlint -Wwarning "$page" 2>&1)
    [ -z "$said" ] || fail "mandoc: $said"
  fi
done
# Every option of a command stands on its page, as man shows it.
if command -v man >/dev/null; then
  for command in print 'rig stage' calibrate; do
    # shellcheck disable=SC2086
    options=$("$hydrodip" $command --help | grep -oE '^ +(-[a-z],)?--[a-z-]+' | grep -oE -- '--[a-z-]+')
    page=$(MANWIDTH=200 man -l "$man/man1/hydrodip-$(echo "$command" | tr ' ' -).1" 2>/dev/null | col -bx)
    for option in $options; do
      case $page in
        *"$option"*) ;;
        *) fail "hydrodip-$command.1 lacks $option" ;;
      esac
    done
    [ "$(echo "$options" | wc -l)" -gt 5 ] || fail "--help of $command could not be read"
  done
  "$hydrodip" params --json | grep -o '"name": "[^"]*"' | cut -d '"' -f 4 > /tmp/names.$$
  page=$(MANWIDTH=200 man -l "$man/man5/hydrodip-parameters.5" 2>/dev/null | col -bx)
  while read -r name; do
    case $page in
      *"$name"*) ;;
      *) fail "hydrodip-parameters.5 lacks $name" ;;
    esac
  done < /tmp/names.$$
  rm -f /tmp/names.$$
fi
# And every option of every command, which the pages are made from, stands in its --help.
for page in "$man"/man1/hydrodip-*.1; do
  command=$(sed -n 's/^\.B hydrodip //p' "$page" | head -n 1 | tr -d '\\')
  # shellcheck disable=SC2086
  help=$("$hydrodip" $command --help)
  options=$(sed -n '/^\.SH OPTIONS/,/^\.SH EXIT/p' "$page" | sed 's/\\f[A-Z]//g; s/\\//g' |
    grep -oE '^(\.B )?(-[a-z], )?--[a-z-]+' | grep -oE -- '--[a-z-]+' | sort -u)
  [ -n "$options" ] || fail "no options in $page"
  for option in $options; do
    case $help in
      *[\ ,]"$option"*) ;;
      *) [ "$option" = --help ] || fail "hydrodip $command --help hides $option" ;;
    esac
  done
done
[ "$failures" -eq 0 ] || exit 1
echo 'all passed'
