#!/bin/bash
# A Slurm cluster of one node on the loopback interface, for tests: makes its configuration, starts
# munged, slurmctld and slurmd, submits an array of jobs, waits for it, and stops them by their ids.
#
#   one_node_slurm.sh FOLDER TASKS SCRIPT ARGUMENTS...
#
# FOLDER gets configuration, state and logs. Needs root, which slurmd asks for.
set -u
folder=$(realpath "$1"); tasks=$2; shift 2
host=$(hostname -s)
mkdir -p "$folder"/{state,spool,munge}; chmod 700 "$folder/munge"
started=()
stop() {
  for id in "${started[@]}"; do kill "$id" 2>/dev/null; done
  for id in "${started[@]}"; do for _ in $(seq 100); do kill -0 "$id" 2>/dev/null || break; sleep 0.1; done; done
}
trap stop EXIT
give_up() { echo "one_node_slurm: $1" >&2; tail -n 20 "$folder"/*.log >&2; exit 1; }
wait_for() { for _ in $(seq 150); do eval "$1" && return; sleep 0.2; done; give_up "waited too long for: $1"; }
free_port() { /usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'; }

head -c 1024 /dev/urandom > "$folder/munge/key"; chmod 400 "$folder/munge/key"
chmod 711 "$folder"
mkdir -p "$folder/socket"; chmod 755 "$folder/socket"
munged --foreground --force --key-file="$folder/munge/key" --socket="$folder/socket/munge" \
  --pid-file="$folder/munge/pid" --seed-file="$folder/munge/seed" \
  --log-file="$folder/munge/log" > "$folder/munged.log" 2>&1 &
started+=($!)
wait_for '[ -S "$folder/socket/munge" ]'

cat > "$folder/slurm.conf" <<CONF
ClusterName=rubble
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
AuthType=auth/munge
AuthInfo=socket=$folder/socket/munge
CredType=cred/munge
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=test Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF="$folder/slurm.conf"
slurmctld -D > "$folder/slurmctld.out.log" 2>&1 & started+=($!)
slurmd -D > "$folder/slurmd.out.log" 2>&1 & started+=($!)
wait_for 'sinfo -h -o %t 2>/dev/null | grep -q idle'

job=$(sbatch --parsable --array="1-$tasks" --output="$folder/task_%a.log" "$@") || give_up "sbatch failed"
echo "job $job"
timeout 300 bash -c "while squeue -h -j $job 2>/dev/null | grep -q .; do sleep 0.5; done" || give_up "the job does not end"
scontrol -o show job "$job" | grep -c "JobState=COMPLETED" | grep -qx "$tasks" || give_up "not every task completed"
