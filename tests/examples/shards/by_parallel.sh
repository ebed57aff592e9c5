#!/usr/bin/env bash
# Builds by processes of GNU parallel, and once more after the half of the results was removed.
# Compares the file with that of `build`. Exits with 77, for "skipped", without GNU parallel.
set -euo pipefail
planetree=$1 script=$2 folder=$3
command -v parallel > /dev/null || { echo "no parallel"; exit 77; }
export PLANETREE=$planetree
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"
"$planetree" generate --triangles 400K --seed 4 mesh.ply --quiet
"$planetree" build mesh.ply -o whole.ptree --quiet
"$script" mesh.ply job sharded.ptree 5
cmp whole.ptree sharded.ptree
rm sharded.ptree job/map-1 job/reduce-*
"$script" mesh.ply job sharded.ptree 5 3
cmp whole.ptree sharded.ptree
