#!/usr/bin/env bash
# One step of a sharded build, in a job or a job array of Slurm. A task of an array works on the
# shard of its number. Slurm says how many processors and how much memory the task has.
set -euo pipefail

planetree=${PLANETREE:-planetree}
limits=(--threads "${SLURM_CPUS_PER_TASK:-1}" --quiet)
if [[ -n ${SLURM_MEM_PER_NODE:-} && $SLURM_MEM_PER_NODE -gt 0 ]]; then
  limits+=(--memory "${SLURM_MEM_PER_NODE}M")
fi
case $1 in
  map | reduce) exec "$planetree" shard "$1" "$2" "$SLURM_ARRAY_TASK_ID" "${limits[@]}" ;;
  *) exec "$planetree" shard "$@" "${limits[@]}" ;;
esac
