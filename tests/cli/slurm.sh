#!/bin/sh
# A calibration's grid and a sweep as arrays of Slurm's: a controller and two nodes on this machine, one
# of which is killed in the middle of the sweep. Skipped where Slurm is not installed.
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh"
. "$here/slurm_nodes.sh"
trap 'stop_slurm; rm -rf "$work"' EXIT
start_slurm

# The grid, half of it on each node.
calibrate="$hydrodip calibrate scans/sphere-scan.obj --film 110x110 --set film.elements=1000 --set dip.step_mm=2
  --z-stretch 0.55,0.75 --ratio 30 --poisson 0.1 --quiet"
"$hydrodip" calibrate synth sphere --film 110x110 --set film.elements=1000 --set dip.step_mm=2 -o scans --quiet \
  > /dev/null || fail 'calibrate synth'
sbatch --array=1-2 --output=/dev/null --wrap "cd '$work' && $(echo $calibrate) \
  --shard \$SLURM_ARRAY_TASK_ID/2 -o shard-\$SLURM_ARRAY_TASK_ID" > said.txt || fail "sbatch: $(cat said.txt)"

# Tasks of half a second and more, so that one is hit in its middle.
write_sweep 2000 0.05 <<'TOML'
"material.z_stretch" = { from = 0.5, to = 0.8, count = 16 }
TOML
HYDRODIP=$hydrodip
export HYDRODIP
"$hydrodip" sweep plan sweep.toml -o s --no-trial --tasks 4 --quiet > /dev/null || fail 'sweep plan'
sbatch s/slurm.sh > said.txt || fail "sbatch: $(cat said.txt)"
until [ "$(ls s/runs 2> /dev/null | wc -l)" -ge 2 ] && [ -n "$(squeue -h -w two -t running)" ]; do
  sleep 0.05
done
power_off two
# As whoever watches over the machines says; the controller itself would take a minute to notice.
scontrol update NodeName=two State=DOWN Reason=power || fail 'scontrol'
wait_for_queue 120 || fail "the queue did not end: $(squeue)"
grep -qi 'requeu' controller.log || fail 'no task was started again: the node was not hit in the middle'
"$hydrodip" sweep collect s > said.txt || fail 'collect'
grep -q '^16 runs: 16 done, 0 failed, 0 missing' said.txt || fail "$(cat said.txt; cat controller.log)"
[ -z "$(ls s/claims)" ] || fail 'a claim was left'

# What the nodes found gives the bytes that this machine finds alone.
# shellcheck disable=SC2086
{
  $calibrate -o alone > /dev/null || fail 'calibrate'
  $calibrate --merge shard-1 --merge shard-2 -o merged > /dev/null || fail 'calibrate --merge'
}
for file in profile.toml error-surface.csv error-surface.png; do
  cmp "alone/$file" "merged/$file" || fail "$file is another one"
done
finish
