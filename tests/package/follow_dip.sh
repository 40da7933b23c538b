#!/bin/sh
# Every step once, evenly deep; film that is attached stays so; the last step is the result.
. "$(dirname "$0")/example.sh"

run
holds '/^step/ { if ($2 != n || $4 + 0 != 20) bad = 1
                 if ($5 - n * 0.5 > 1e-9 || n * 0.5 - $5 > 1e-9) bad = 1
                 if ($8 < attached) bad = 1
                 n++; attached = $8; depth = $5 }
       /^in the end/ { if ($4 != depth || $7 != attached || attached == 0) bad = 1; ended = 1 }
       END { exit !(n == 21 && ended && !bad) }' "the steps are not right"
