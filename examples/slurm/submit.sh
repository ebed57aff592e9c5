#!/usr/bin/env bash
# Submits a sharded build to Slurm: four jobs, each of which begins when all of the one before has
# succeeded. MESH, JOB and OUT.ptree are on a file system that all nodes share. Options for sbatch,
# such as a partition, are taken from the variables SBATCH_PARTITION and so on. Prints the number of
# the last job. To go on after a failure, submit the same again: steps that are done do nothing.
set -euo pipefail

if [[ $# -ne 4 ]]; then
  echo "usage: $0 MESH JOB OUT.ptree SHARDS" >&2
  exit 2
fi
mesh=$(realpath "$1") job=$(realpath -m "$2") output=$(realpath -m "$3") last=$(($4 - 1))
step=$(dirname "$(realpath "${BASH_SOURCE[0]}")")/step.sh
common=(--parsable --kill-on-invalid-dep=yes --cpus-per-task="${CPUS:-2}" --mem="${MEMORY:-4G}"
        --output="${LOGS:-.}/planetree-%x-%a.log")

plan=$(sbatch "${common[@]}" --job-name=plan "$step" plan "$mesh" -o "$job" --shards "$4")
map=$(sbatch "${common[@]}" --job-name=map --array="0-$last" --dependency="afterok:$plan" \
  "$step" map "$job")
reduce=$(sbatch "${common[@]}" --job-name=reduce --array="0-$last" --dependency="afterok:$map" \
  "$step" reduce "$job")
sbatch "${common[@]}" --job-name=merge --dependency="afterok:$reduce" \
  "$step" merge "$job" -o "$output"
