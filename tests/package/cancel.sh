#!/bin/sh
# Cancelled in the middle, it ends and leaves nothing.
. "$(dirname "$0")/example.sh"

run left
grep -qx 'half of the first dip is done' said.txt || fail "it was not in the middle"
grep -qx 'cancelled; nothing was written' said.txt || fail "it was not cancelled"
[ ! -e left ] || fail "something is left"
