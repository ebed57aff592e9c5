#!/usr/bin/env bash
# Builds a .ptree file by many processes on one machine, with GNU parallel. A run that was
# interrupted goes on where it stopped when it is started again.
set -euo pipefail

if [[ $# -lt 4 ]]; then
  echo "usage: $0 MESH JOB OUT.ptree SHARDS [PROCESSES]" >&2
  exit 2
fi
mesh=$1 job=$2 output=$3 shards=$4 processes=${5:-2}
planetree=${PLANETREE:-planetree}
# Each process takes its share of the processors and of a quarter of the memory.
threads=$(( $(nproc) / processes > 0 ? $(nproc) / processes : 1 ))
memory=$(( $(awk '/^MemTotal/ {print $2}' /proc/meminfo) / 4 / processes ))K
limits=(--threads "$threads" --memory "$memory" --quiet)

run_all() {
  seq 0 $((shards - 1)) | parallel --halt now,fail=1 --jobs "$processes" \
    "$planetree" shard "$1" "$job" {} "${limits[@]}"
}

"$planetree" shard plan "$mesh" -o "$job" --shards "$shards" --quiet
run_all map
run_all reduce
"$planetree" shard merge "$job" -o "$output" --quiet
