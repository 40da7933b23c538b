#!/bin/sh
# All values, in their order; film that follows slopes less has to be stretched more; and the same
# dip alone gives the same film.
. "$(dirname "$0")/example.sh"

run
holds '/^ *0\.[0-9]/ { n++; if ($1 <= value) bad = 1; value = $1 } END { exit !(n == 6 && !bad) }' \
  "the values are not all there in their order"
holds '/^ *0\.[0-9]/ { if (n++ && $2 >= film) bad = 1; film = $2 } END { exit bad }' \
  "with a larger z_stretch the object must take less film along"
grep -qx 'the same as alone: yes' said.txt || fail "dips beside each other differ from a dip alone"
