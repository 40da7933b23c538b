# Completion in a real fish: fish.sh COMPLETION
set -u
command -v fish >/dev/null || { echo 'fish is not installed'; exit 77; }
completion=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
export HOME="$work" XDG_CONFIG_HOME="$work/config" XDG_DATA_HOME="$work/data"
mkdir -p config/hydrodip/profiles
touch part.stl config/hydrodip/profiles/our-film.toml
failures=0
# offers EXPECTED LINE: the candidates' words, without what is said of them, on one line.
offers() {
  got=$(fish --no-config -c "source '$completion'; complete -C '$2'" | cut -f 1 | LC_ALL=C sort | tr '\n' ' ')
  [ "$got" = "$1 " ] && return
  echo "FAILED: '$2': expected '$1', got '$got'"
  failures=$((failures + 1))
}
offers 'inspect' 'hydrodip insp'
offers 'guide jig sheet stage' 'hydrodip rig '
offers 'find' 'hydrodip rig stage f'
offers 'letter' 'hydrodip print part.stl --film l'
offers '--film-image --film-state' 'hydrodip simulate part.stl --film-'
offers 'material.tear_stretch=' 'hydrodip print part.stl --set material.te'
offers 'part.stl' 'hydrodip print par'
offers 'mask' 'hydrodip sample ma'
offers 'dip.method=full' 'hydrodip print part.stl --set dip.method=f'
offers 'our-film' 'hydrodip profile show '
offers 'our-film' 'hydrodip print part.stl --profile ou'
[ "$failures" -eq 0 ] || exit 1
echo 'all passed'
