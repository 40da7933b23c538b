#!/bin/sh
# What sharing out many runs costs: the same drafts by a plain loop over `hydrodip simulate`, two at a
# time, by `sweep run`, by GNU parallel and by a Slurm of two nodes on this machine, in turn.
# throughput.sh HYDRODIP [RUNS [TURNS]]; RUNS 500, TURNS 3.
bench=$(cd "$(dirname "$0")" && pwd)
tests=$bench/../../tests/cli
. "$tests/common.sh"
trap 'rm -rf "$work"' EXIT
ways='loop sweep parallel'
if (. "$tests/slurm_nodes.sh") > /dev/null; then
  . "$tests/slurm_nodes.sh"
  trap 'stop_slurm; rm -rf "$work"' EXIT
  start_slurm
  ways="$ways slurm"
fi
write_sweep 4000 0.2 <<TOML
"material.z_stretch" = { from = 0.5, to = 0.8, count = ${2:-500} }
TOML
# shellcheck disable=SC2086
HYDRODIP=$hydrodip python3 "$bench/throughput.py" "${3:-3}" $ways
