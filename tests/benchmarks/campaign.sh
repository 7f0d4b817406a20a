#!/bin/bash
# What a campaign costs beside the processes of its items:
#   tests/benchmarks/campaign.sh HINDSIGHT [ITEMS]     (10000)
# by ITEMS items that fail at once (each a configuration of its own, whose inputs
# are missing), done one after the other: the time of all, less that from the
# start to the end of each process, which campaign.csv tells. Prints
# milliseconds an item; ends with 1 from 20 on.
set -euo pipefail

hindsight=$(realpath "$1")
count=${2:-10000}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$hindsight" simulate short_drive --duration=30 --quiet --out=one

mkdir items
for ((i = 0; i < count; ++i)); do
  sed "s/^folder:.*/folder: gone$i/" one/config.yaml >items/$i.yaml
done

seconds() { date +%s.%N; }
milliseconds() {  # since BEGIN, an item of COUNT
  awk -v a="$1" -v b="$(seconds)" -v n="$2" 'BEGIN { print 1000 * (b - a) / n }'
}

begin=$(seconds)
"$hindsight" campaign 'items/*.yaml' --methods=ekf --out=out --workers=1 \
  --quiet --progress=none || true
all=$(milliseconds "$begin" "$count")
begin=$(seconds)
"$hindsight" campaign --out=out --workers=1 --quiet --progress=none || true
again=$(milliseconds "$begin" "$count")

alone=$(awk -F, 'NR > 1 { sum += $(NF - 1) } END { print 1000 * sum / (NR - 1) }' \
  out/campaign.csv)
ended=$(find out/items -name item.json | wc -l)
awk -v ended="$ended" -v count="$count" -v all="$all" -v alone="$alone" \
  -v again="$again" 'BEGIN {
    printf "%d of %d items: %.2f ms each, of which its process %.2f, beside it %.2f;", \
      ended, count, all, alone, all - alone
    printf " again, with nothing to do, %.3f\n", again
    exit !(all - alone < 20 && ended == count)
  }'
