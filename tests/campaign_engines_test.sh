#!/bin/bash
# A campaign by 1, 2 and 4 workers, by GNU parallel and by a Slurm of one node,
# started here by hand as it would be without systemd, gives the same bytes:
#   tests/campaign_engines_test.sh HINDSIGHT
# What cannot be tried here is skipped with a message.
set -euo pipefail

hindsight=$(realpath "$1")
work=$(mktemp -d)
daemons=()
finish() {
  for pid in "${daemons[@]}"; do kill "$pid" 2>/dev/null || true; done
  wait
  # What the daemons write last may come behind their end.
  rm -rf "$work" || { sleep 2 && rm -rf "$work"; }
}
trap finish EXIT
cd "$work"

fail() {
  echo "campaign_engines_test.sh: $*" >&2
  exit 1
}

mkdir recordings
for seed in 1 2 3 4 5 6; do
  "$hindsight" simulate short_drive --duration=60 --seed=$seed --quiet \
    --out=recordings/drive$seed
done

# Everything that is told, but times and memory: the table without its last two
# columns, the CSVs of the results.
contents() {
  sed 's/,[^,]*,[^,]*$//' "$1/campaign.csv"
  (cd "$1/items" && find . -name '*.csv' | sort | xargs sha256sum)
}

campaign() { "$hindsight" campaign "$@" --progress=none; }
list=('recordings/*' --methods=ekf,rts)

campaign "${list[@]}" --out=w1 --workers=1
contents w1 >expected
compare() {
  contents "$1" | diff expected - >&2 || fail "$2: other bytes than one worker"
  echo "campaign_engines_test.sh: $2: the bytes of one worker"
}
for workers in 2 4; do
  campaign "${list[@]}" --out=w$workers --workers=$workers
  compare w$workers "$workers workers"
done

if command -v parallel >/dev/null; then
  seq 4 | parallel -j4 --will-cite "$hindsight" campaign "'recordings/*'" \
    --methods=ekf,rts --out=parallel --workers=1 --progress=none '#' {}
  compare parallel "GNU parallel"
else
  echo "campaign_engines_test.sh: GNU parallel is skipped: not installed"
fi

slurm_is_possible() {
  local program
  for program in munged slurmctld slurmd sbatch squeue; do
    PATH=$PATH:/usr/sbin command -v $program >/dev/null ||
      { echo "$program is not installed"; return 1; }
  done
  [[ $(id -u) == 0 ]] || { echo "its daemons need root"; return 1; }
}

# A controller and one node under $work/slurm, told to clients by SLURM_CONF.
start_slurm() {
  export PATH=$PATH:/usr/sbin
  local folder=$work/slurm cores
  cores=$(nproc)
  mkdir -p "$folder"/{munge,state,spool}
  chmod 700 "$folder/munge"
  chmod 755 "$work" "$folder"
  dd if=/dev/urandom of="$folder/munge/key" bs=128 count=1 status=none
  chmod 600 "$folder/munge/key"
  munged --foreground --force --key-file="$folder/munge/key" \
    --socket="$folder/munge/socket" --pid-file="$folder/munge/pid" \
    --log-file="$folder/munge/log" --seed-file="$folder/munge/seed" &
  daemons+=($!)
  cat >"$folder/slurm.conf" <<END
ClusterName=here
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
CryptoType=crypto/munge
SlurmctldPort=16817
SlurmdPort=16818
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
JobAcctGatherType=jobacct_gather/none
ReturnToService=2
NodeName=$(hostname -s) NodeAddr=127.0.0.1 CPUs=$cores State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
  export SLURM_CONF=$folder/slurm.conf
  local i
  for ((i = 0; i < 50; ++i)); do
    [[ -S $folder/munge/socket ]] && break
    sleep 0.2
  done
  slurmctld -D -f "$SLURM_CONF" &
  daemons+=($!)
  slurmd -D -f "$SLURM_CONF" -N "$(hostname -s)" &
  daemons+=($!)
  for ((i = 0; i < 60; ++i)); do
    sinfo -h -o %T 2>/dev/null | grep -qE '^(idle|mixed)' && return 0
    sleep 1
  done
  tail -n 20 "$folder"/*.log "$folder/munge/log" >&2
  return 1
}

if ! why=$(slurm_is_possible); then
  echo "campaign_engines_test.sh: Slurm is skipped: $why"
elif ! start_slurm 2>slurm.err; then
  tail -n 40 slurm.err
  echo "campaign_engines_test.sh: Slurm is skipped: its daemons do not start here"
else
  campaign "${list[@]}" --out=slurm_out --engine=slurm --workers=2
  compare slurm_out "Slurm"
  # A job that is gone before its work is done, and the same call again.
  campaign "${list[@]}" --out=again --engine=slurm --workers=1 &
  caller=$!
  until ls again/items/*/item.json >/dev/null 2>&1; do sleep 0.1; done
  scancel "$(cat again/slurm/job)"
  wait $caller || true
  campaign "${list[@]}" --out=again --engine=slurm --workers=2
  compare again "Slurm, after scancel"
fi
