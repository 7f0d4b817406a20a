#!/bin/bash
# What a long recording costs: the whole command, from text to text, on one core.
#   tests/benchmarks/day.sh [HINDSIGHT [HOURS...]]
# simulates data/scenarios/day.yaml for each number of hours (1 and 2) and runs
# ekf, rts and batch on it; "10hz" among HOURS is 2 h with ten nodes a second, and
# "week" seven days. Everything is made in a temporary folder of $TMPDIR and
# removed: a day needs 5 GB of disk there, a week 32.
set -euo pipefail
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
hindsight=$(realpath "${1:-$source/build/release/hindsight}")
shift || true
hours=("$@")
[ ${#hours[@]} -gt 0 ] || hours=(1 2)

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
printf '%-6s %9s %12s %9s\n' hours 'CPU [s]' 'CPU [s/h]' 'peak [MB]'
for h in "${hours[@]}"; do
  scenario=$source/data/scenarios/day.yaml
  n=$h
  if [ "$h" = 10hz ]; then
    sed 's/^    rate: 1 Hz/    rate: 10 Hz/' "$scenario" > "$folder/day_10hz.yaml"
    scenario=$folder/day_10hz.yaml
    n=2
  elif [ "$h" = week ]; then
    n=168
    sed "s/duration: 24 h, seed/duration: $n h, seed/" "$scenario" \
      > "$folder/week.yaml"
    scenario=$folder/week.yaml
  fi
  seconds=$(awk "BEGIN {print 3600 * $n}")
  "$hindsight" simulate "$scenario" --duration="$seconds" --force \
    --out="$folder/in" > /dev/null
  # A doubtful result, 3, is a result.
  taskset -c 0 /usr/bin/time -q -f '%U %S %M' -o "$folder/time" \
    "$hindsight" run "$folder/in/config.yaml" --methods=ekf,rts,batch --force \
    --out="$folder/out" --progress=none > /dev/null || [ $? -eq 3 ]
  awk -v h="$h" -v n="$n" '{printf "%-6s %9.2f %12.3f %9.0f\n",
      h, $1 + $2, ($1 + $2) / n, $3 / 1024}' "$folder/time"
done
