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

# A pipe that nobody writes to, wherever a file may be given: it is waited for, and given up at once.
printf 'nothing' > password
for name in pipe pipe.toml pipe.csv pipe.json pipe.obj; do mkfifo $name; done
gives_up() {
  "$hydrodip" "$@" > stdout.txt 2> stderr.txt &
  job=$!
  waited=0
  # shellcheck disable=SC2012
  while kill -0 "$job" 2> /dev/null && ! ls -l "/proc/$job/fd" 2> /dev/null | grep -q 'pipe[a-z.]*$'; do
    sleep 0.02
    waited=$((waited + 1))
    [ "$waited" -lt 500 ] || break
  done
  [ "$waited" -lt 500 ] || fail "$*: does not read the pipe"
  kill -s INT "$job" 2> /dev/null
  waited=0
  while kill -0 "$job" 2> /dev/null && [ "$waited" -lt 500 ]; do
    sleep 0.02
    waited=$((waited + 1))
  done
  kill -s KILL "$job" 2> /dev/null
  wait "$job"
  code=$?
  [ "$code" -eq 130 ] || fail "$*: exit code $code instead of 130: $(cat stderr.txt)"
}
for command in print simulate inspect orient 'plan --dips 2' 'pattern --tile pipe --tile-mm 9'; do
  # shellcheck disable=SC2086
  gives_up $command tetra.obj --config pipe.toml
  # shellcheck disable=SC2086
  gives_up $command tetra.obj --path pipe.csv
  # shellcheck disable=SC2086
  gives_up $command tetra.obj --profile pipe.toml
  # shellcheck disable=SC2086
  gives_up $command tetra.obj --film-state pipe.toml
  # shellcheck disable=SC2086
  gives_up $command pipe.toml
done
gives_up print pipe.obj
write_colored colored.ply
for option in --texture --art --film-image --printer-profile --logo --correction; do
  # shellcheck disable=SC2086
  gives_up print colored.ply $quick $option pipe
done
gives_up nest pipe.toml
gives_up nest --config pipe.toml
gives_up pattern tetra.obj --tile pipe --tile-mm 9
gives_up sweep plan pipe.toml
gives_up profile save shop --config pipe.toml
gives_up profile import pipe.toml shop
gives_up studio --no-browser --password-file pipe
gives_up measure sphere=pipe.csv
gives_up calibrate sphere=pipe.obj
gives_up calibrate kit --config pipe.toml
gives_up calibrate printer --scan pipe
gives_up rig stage status --config pipe.toml
gives_up register board --config pipe.toml
gives_up register --calibrate-camera pipe
finish
