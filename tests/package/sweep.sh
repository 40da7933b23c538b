#!/bin/sh
# All values, in their order; with a rest shape that is higher itself, film on slopes is stretched
# less, so that the object takes more of it along; and the same dip alone gives the same film.
. "$(dirname "$0")/example.sh"

run
holds '/^ *0\.[0-9]/ { n++; if ($1 <= value) bad = 1; value = $1 } END { exit !(n == 6 && !bad) }' \
  "the values are not all there in their order"
holds '/^ *0\.[0-9]/ { if (n++ && ($2 <= film || $3 >= ratio)) bad = 1; film = $2; ratio = $3 } END { exit bad }' \
  "with a larger z_stretch the object must take more film along"
grep -qx 'the same as alone: yes' said.txt || fail "dips beside each other differ from a dip alone"
