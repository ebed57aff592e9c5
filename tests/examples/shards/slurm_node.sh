#!/usr/bin/env bash
# Runs a command while a Slurm of one node works, all of it in a temporary folder: munged, slurmctld
# and slurmd. Exits with 77, for "skipped", where Debian's packages slurmctld, slurmd, slurm-client
# and munge are not installed or do not start, or the user is not root.
set -euo pipefail

for program in munged slurmctld slurmd sbatch; do
  PATH=$PATH:/usr/sbin command -v "$program" > /dev/null || { echo "no $program"; exit 77; }
done
[[ $(id -u) == 0 ]] || { echo "not root"; exit 77; }
export PATH=$PATH:/usr/sbin
folder=$(mktemp -d)
chmod 755 "$folder"
stop() {
  for name in slurmd slurmctld munged; do
    if [[ -s $folder/$name.pid ]]; then kill -9 "$(cat "$folder/$name.pid")" 2> /dev/null || true; fi
  done
  rm -rf "$folder"
}
trap stop EXIT

host=$(hostname -s)
port=$((20000 + $$ % 20000))
(umask 077; head -c 128 /dev/urandom > "$folder/key")
mkdir "$folder/state" "$folder/spool"
cat > "$folder/slurm.conf" <<TEXT
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmctldPort=$port
SlurmdPort=$((port + 1))
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
ReturnToService=2
SchedulerParameters=sched_interval=1,sched_min_interval=0,batch_sched_delay=0
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 RealMemory=1024 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
TEXT
export SLURM_CONF=$folder/slurm.conf
munged --force --key-file="$folder/key" --socket="$folder/munge.socket" \
  --pid-file="$folder/munged.pid" --log-file="$folder/munged.log" --seed-file="$folder/seed" ||
  { echo "munged does not start here"; exit 77; }
slurmctld || true
slurmd -N "$host" || true
ready=
for ((i = 0; i < 100; ++i)); do
  if sinfo --noheader --format=%t 2> /dev/null | grep -qE '^(idle|mix|alloc)$'; then
    ready=1
    break
  fi
  sleep 0.1
done
[[ -n $ready ]] || { tail -n 20 "$folder"/*.log; echo "Slurm does not start here"; exit 77; }
status=0
"$@" || status=$?
if [[ $status -ne 0 ]]; then tail -n 20 "$folder"/*.log; fi
exit "$status"
