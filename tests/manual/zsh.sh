# Completion in a real zsh, in a terminal of its own (zpty): zsh.sh COMPLETION
set -u
command -v zsh >/dev/null || { echo 'zsh is not installed'; exit 77; }
completion=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
mkdir -p config/hydrodip/profiles
touch part.stl config/hydrodip/profiles/our-film.toml
export XDG_CONFIG_HOME="$work/config"
mkdir functions
cp "$completion" functions/_hydrodip
cat > ask.zsh <<'ZSH'
zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell 'PS1="> "; fpath=('$PWD'/functions $fpath); autoload -Uz compinit; compinit -u -d '$PWD'/dump'
zpty -w shell 'hydrodip() { printf "GOT"; printf " <%s>" "$@"; printf "\n"; }; setopt no_auto_menu'
zpty -w shell "$(printf '%s\t' "$@")"
typeset text= line=
repeat 400; do
  if zpty -r -t shell line; then text+=$line; else sleep 0.05; fi
  [[ $text == *'GOT <'*$'\n'* ]] && break
done
zpty -d shell
print -r -- "$text"
ZSH
failures=0
# becomes EXPECTED TYPED...: Tab after each piece.
becomes() {
  expected=$1
  shift
  got=$(zsh -f ask.zsh "$@" 2>&1)
  case $got in
    *"GOT $expected"*) return ;;
  esac
  echo "FAILED: '$*': expected '$expected' in: $got"
  failures=$((failures + 1))
}
becomes '<inspect> <part.stl> <--film=letter>' 'hydrodip insp' 'part.s' '--film=lett'
becomes '<rig> <stage> <find>' 'hydrodip rig sta' 'fin'
becomes '<simulate> <part.stl> <--set> <dip.method=single-step>' 'hydrodip simul' 'part.s' '--set dip.meth' 'sing'
becomes '<profile> <show> <our-film>' 'hydrodip profile sho' 'ou'
becomes '<print> <part.stl> <--profile=our-film>' 'hydrodip prin' 'part.s' '--profile=ou'
[ "$failures" -eq 0 ] || exit 1
echo 'all passed'
