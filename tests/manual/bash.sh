# Completion in a real bash: bash.sh COMPLETION. What Tab would offer is what bash itself says of
# the function that it runs, and once the key is really pressed.
set -u
completion=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
touch part.stl picture.png job.toml notes.txt
mkdir -p folder config/hydrodip/profiles
touch config/hydrodip/profiles/our-film.toml
export XDG_CONFIG_HOME="$work/config"
failures=0

# offered WORDS...: the candidates for the last word, sorted, on one line.
cat > ask.bash <<'BASH'
source "$1"
shift
compopt() { :; } # bash knows it only while it completes
COMP_WORDS=("$@")
COMP_CWORD=$(($# - 1))
_hydrodip
printf '%s\n' "${COMPREPLY[@]}" | LC_ALL=C sort | tr '\n' ' '
BASH
offers() {
  expected=$1
  shift
  got=$(bash ask.bash "$completion" "$@")
  [ "$got" = "$expected " ] && return
  echo "FAILED: '$*': expected '$expected', got '$got'"
  failures=$((failures + 1))
}
offers 'inspect' hydrodip insp
offers 'print' hydrodip pri
offers 'guide jig sheet stage' hydrodip rig ''
offers 'kit' hydrodip calibrate k
offers 'find' hydrodip rig stage f
offers 'mask' hydrodip sample ma
offers 'config folder job.toml part.stl' hydrodip print ''
offers 'config folder job.toml our-film' hydrodip print part.stl --profile ''
offers 'our-film' hydrodip print part.stl --profile o
offers 'show' hydrodip profile sh
offers 'our-film' hydrodip profile show ''
offers 'our-film' hydrodip profile save our
offers 'a3 a4' hydrodip print part.stl --film a
offers 'a3 a4' hydrodip print part.stl --film = a
offers 'letter' hydrodip print part.stl --film l
offers 'auto' hydrodip print part.stl --depth a
offers '' hydrodip print part.stl --dpi 3
offers '--printer-profile --profile --projection' hydrodip print part.stl --pr
offers 'material.tear_stretch=' hydrodip print part.stl --set material.te
offers 'full projection single-step' hydrodip print part.stl --set dip.method = ''
offers 'picture.png' hydrodip simulate part.stl --film-image pi
offers 'folder' hydrodip view f

# The key itself, in a terminal: what was typed is what the program would have got.
typed=$(script -qec 'bash --norc -i' /dev/null 2>/dev/null <<TERMINAL
source '$completion'
hydrodip() { printf 'GOT'; printf ' <%s>' "\$@"; printf '\n'; }
$(printf 'hydrodip insp\tpart.s\t--film lett\t')
exit
TERMINAL
)
case $typed in
  *'GOT <inspect> <part.stl> <--film> <letter>'*) ;;
  *) echo "FAILED: Tab in a terminal: $typed"; failures=$((failures + 1)) ;;
esac
[ "$failures" -eq 0 ] || exit 1
echo 'all passed'
