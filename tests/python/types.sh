#!/bin/sh
# The stubs are those of the module (stubtest), the package is well typed, users' code too, and
# users' mistakes are found.
# Usage: sh types.sh PYTHON MODULE_PATH SOURCE
python=$1
path=$2
source=$3
"$python" -c 'import mypy' 2>/dev/null || { echo 'no mypy'; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
here=$source/tests/python
fail() { echo "FAILED: $*"; cat "$work/log"; exit 1; }

unset PYTHONPATH
export MYPYPATH="$path" MYPY_CACHE_DIR="$work/cache"
cat >"$work/mypy.ini" <<'INI'
[mypy]
[mypy-meshio.*,matplotlib.*]
ignore_missing_imports = True
INI
run() { "$python" -m mypy --config-file "$work/mypy.ini" --strict "$@" >"$work/log" 2>&1; }

run -p hydrodip || fail 'the package'
run "$here/user_code.py" || fail "users' code"
run "$here/mistakes.py" && fail "users' mistakes"
marked=$(grep -n '# mistake' "$here/mistakes.py" | cut -d: -f1)
found=$(sed -n 's/.*mistakes\.py:\([0-9]*\): error.*/\1/p' "$work/log" | sort -nu)
[ "$marked" = "$found" ] || fail "mistakes on lines $(echo $marked), found on $(echo $found)"
# What every class of pybind11's has of its own.
cat >"$work/pybind11" <<'ALLOWED'
hydrodip\._core\.[A-Z]\w*
hydrodip\._core\.[A-Z]\w*\.__init__
ALLOWED
(cd "$path" && PYTHONDONTWRITEBYTECODE=1 "$python" -m mypy.stubtest --ignore-missing-stub \
  --allowlist "$work/pybind11" --ignore-unused-allowlist --mypy-config-file "$work/mypy.ini" \
  hydrodip._core) >"$work/log" 2>&1 || fail 'stubs and module differ'
echo 'all passed'
