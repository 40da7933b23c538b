#!/bin/sh
# Film on a sphere lies on the sphere; it covers about the cap that was dipped, 2 pi r h.
. "$(dirname "$0")/example.sh"

run
holds '/^attached/ { ok = $2 > 100 && $6 < 0.01 } END { exit !ok }' "film is off the sphere"
holds '/^on the sphere/ { cap = 2 * 3.14159265 * 30 * 15; ok = $4 > 0.85 * cap && $4 < 1.001 * cap }
       END { exit !ok }' "the area is not that of the cap"
# On the whole, film is stretched.
holds '/^on the sphere/ { ok = $4 > $10 } END { exit !ok }' "the film has shrunk"
holds '/^area ratio/ { d = $3 - $8; ok = d * d < 1e-10 } END { exit !ok }' \
  "the arrays say other than the coverage"
