#!/bin/sh
# A sweep as an array of Slurm's: a controller and two nodes on this machine, one of which is killed
# in the middle. Skipped where Slurm is not installed.
. "$(dirname "$0")/common.sh"
for program in slurmctld slurmd sbatch munged; do
  PATH=$PATH:/usr/sbin command -v "$program" > /dev/null || { echo "no $program: skipped"; exit 77; }
done
PATH=$PATH:/usr/sbin
export PATH

user=$(id -un)
host=$(hostname -s)
mkdir state spool-one spool-two munge
chmod 755 munge .
head -c 1024 /dev/urandom > munge/key
chmod 600 munge/key
munge() {
  munged --force --key-file="$work/munge/key" --socket="$work/munge/socket" --pid-file="$work/munge/pid" \
    --log-file="$work/munge/log" --seed-file="$work/munge/seed"
}
# Ports that this process is likely to have alone.
base=$((20000 + $$ % 20000))
cat > slurm.conf <<CONF
ClusterName=test
SlurmctldHost=$host
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
SlurmUser=$user
SlurmdUser=$user
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool-%n
SlurmctldPidFile=$work/controller.pid
SlurmdPidFile=$work/%n.pid
SlurmctldLogFile=$work/controller.log
SlurmdLogFile=$work/%n.log
SlurmctldPort=$base
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdTimeout=5
ReturnToService=2
MpiDefault=none
NodeName=one NodeHostname=$host Port=$((base + 1)) CPUs=1 State=UNKNOWN
NodeName=two NodeHostname=$host Port=$((base + 2)) CPUs=1 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
SLURM_CONF=$work/slurm.conf
export SLURM_CONF

# All processes of a node, as when its power goes: its daemon and what it started.
children() {
  for child in $(ps -o pid= --ppid "$1"); do
    children "$child"
    echo "$child"
  done
}
power_off() {
  daemon=$(cat "$work/$1.pid" 2> /dev/null) || return 0
  steps=$(for job in $(squeue -h -w "$1" -t running -o %A 2> /dev/null); do
    ps -eo pid=,args= | awk -v step="[$job.batch]" '$2 == "slurmstepd:" && $3 == step {print $1}'; done)
  for process in $daemon $steps; do
    # shellcheck disable=SC2046
    kill -9 $(children "$process") "$process" 2> /dev/null
  done
}
stop_all() {
  scancel --user="$user" 2> /dev/null
  power_off one
  power_off two
  kill "$(cat "$work/controller.pid" 2> /dev/null)" "$(cat "$work/munge/pid" 2> /dev/null)" 2> /dev/null
  sleep 1
  rm -rf "$work"
}
trap stop_all EXIT

munge && slurmctld && slurmd -N one && slurmd -N two || { echo 'Slurm does not start here: skipped'; exit 77; }
for _ in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15; do
  [ "$(sinfo -h -t idle -o %D 2> /dev/null)" = 2 ] && break
  sleep 1
done

write_sweep 4000 0.05 <<'TOML'
"material.z_stretch" = { from = 0.3, to = 0.9, count = 24 }
TOML
HYDRODIP=$hydrodip
export HYDRODIP
"$hydrodip" sweep plan sweep.toml -o s --no-trial --tasks 4 --quiet > /dev/null || fail 'sweep plan'
sbatch s/slurm.sh > said.txt || fail "sbatch: $(cat said.txt)"
until [ "$(ls s/runs 2> /dev/null | wc -l)" -ge 2 ] && [ -n "$(squeue -h -w two -t running)" ]; do
  sleep 0.1
done
power_off two
sleep 2
slurmd -N two
for _ in $(seq 240); do
  [ -z "$(squeue -h)" ] && break
  # Slurm lets two minutes pass before it starts a task again; here that is not waited for.
  for job in $(squeue -h -t pending -o %A); do scontrol update "JobId=$job" StartTime=now 2> /dev/null; done
  sleep 0.5
done
[ -z "$(squeue -h)" ] || fail "the queue did not end: $(squeue)"
grep -qi 'requeu' controller.log || fail 'no task was started again: the node was not hit in the middle'
"$hydrodip" sweep collect s > said.txt || fail 'collect'
grep -q '^24 runs: 24 done, 0 failed, 0 missing' said.txt || fail "$(cat said.txt; cat controller.log)"
[ -z "$(ls s/claims)" ] || fail 'a claim was left'
finish
