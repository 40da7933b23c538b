# A Slurm of its own on this machine: munge, a controller and the nodes one and two, of one core each.
# Sourced after common.sh. Ends with exit code 77 where Slurm is not installed or does not start.
PATH=$PATH:/usr/sbin
export PATH
for program in slurmctld slurmd sbatch munged; do
  command -v "$program" > /dev/null || { echo "no $program: skipped"; exit 77; }
done
user=$(id -un)
host=$(hostname -s)
# Ports that this process is likely to have alone.
base=$((20000 + $$ % 20000))

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
stop_slurm() {
  scancel --user="$user" 2> /dev/null
  power_off one
  power_off two
  kill -9 "$(cat "$work/controller.pid" 2> /dev/null)" 2> /dev/null
  kill "$(cat "$work/munge/pid" 2> /dev/null)" 2> /dev/null
}

start_slurm() {
  mkdir state spool-one spool-two munge
  chmod 755 munge .
  head -c 1024 /dev/urandom > munge/key
  chmod 600 munge/key
  # Without the pauses that spare a cluster's controller: jobs begin when they can.
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
SchedulerType=sched/builtin
SchedulerParameters=batch_sched_delay=0,sched_interval=1,sched_min_interval=0
SlurmdTimeout=60
ReturnToService=2
MpiDefault=none
NodeName=one NodeHostname=$host Port=$((base + 1)) CPUs=1 State=UNKNOWN
NodeName=two NodeHostname=$host Port=$((base + 2)) CPUs=1 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
  SLURM_CONF=$work/slurm.conf
  export SLURM_CONF
  munged --force --key-file="$work/munge/key" --socket="$work/munge/socket" --pid-file="$work/munge/pid" \
    --log-file="$work/munge/log" --seed-file="$work/munge/seed" &&
    slurmctld && slurmd -N one && slurmd -N two || { echo 'Slurm does not start here: skipped'; exit 77; }
  for _ in $(seq 150); do
    [ "$(sinfo -h -t idle -o %D 2> /dev/null)" = 2 ] && return
    sleep 0.1
  done
}

# wait_for_queue SECONDS: until no job is left. Slurm lets two minutes pass before it starts a task
# again; here that is not waited for.
wait_for_queue() {
  for _ in $(seq $((5 * $1))); do
    queue=$(squeue -h) && [ -z "$queue" ] && return
    for job in $(squeue -h -t pending -o %A); do scontrol update "JobId=$job" StartTime=now 2> /dev/null; done
    sleep 0.2
  done
  return 1
}
