#!/bin/sh
# Ctrl-C in the middle of a dip: exit code 130, nothing left behind, nothing replaced.
. "$(dirname "$0")/common.sh"

write_tetrahedron tetra.obj

# Waits until the job has made its output folder, then a little longer.
wait_for_folder() {
  waited=0
  while [ ! -d "$1" ] && [ "$waited" -lt 100 ]; do
    sleep 0.1
    waited=$((waited + 1))
  done
  sleep 0.5
}

for signal in INT TERM; do
  "$hydrodip" simulate tetra.obj --set dip.step_mm=0.001 -o out > stdout.txt 2> stderr.txt &
  job=$!
  wait_for_folder out
  kill -s "$signal" "$job"
  wait "$job"
  code=$?
  [ "$code" -eq 130 ] || fail "SIG$signal: exit code $code instead of 130: $(cat stderr.txt)"
  [ ! -e out ] || fail "SIG$signal: left $(find out)"
  [ ! -s stdout.txt ] || fail "SIG$signal: something on stdout"
  grep -q cancelled stderr.txt || fail "SIG$signal: stderr does not say that it was cancelled"
done
finish
