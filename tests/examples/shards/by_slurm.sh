#!/usr/bin/env bash
# Submits a sharded build and waits for its last job. Compares the file with that of `build`.
set -euo pipefail
planetree=$1 submit=$2 folder=$3
export PLANETREE=$planetree MEMORY=300M CPUS=1 LOGS=$folder
rm -rf "$folder"
mkdir -p "$folder"
"$planetree" generate --triangles 400K --seed 3 "$folder/mesh.ply" --quiet
"$planetree" build "$folder/mesh.ply" -o "$folder/whole.ptree" --quiet
last=$("$submit" "$folder/mesh.ply" "$folder/job" "$folder/sharded.ptree" 3)
for ((i = 0; i < 600; ++i)); do
  squeue --noheader --job "$last" 2> /dev/null | grep -q . || break
  sleep 0.1
done
cat "$folder"/*.log
cmp "$folder/whole.ptree" "$folder/sharded.ptree"
