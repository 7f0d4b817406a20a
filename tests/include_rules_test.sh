#!/bin/bash
# Holds the sources to the order in which folders may include each other, and
# folders that have one to their public header:
#   tests/include_rules_test.sh [ROOT]      prints each violation, exits 1
#   tests/include_rules_test.sh --self-test shows that violations are found
set -uo pipefail

# What each folder may include besides itself.
declare -A allowed=(
  [base]=""
  [geometry]="base"
  [earth]="base geometry"
  [linear]="base"
  [state]="base geometry earth"
  [imu]="base geometry earth state"
  [measurements]="base geometry earth state imu"
  [timeline]="base geometry earth state imu measurements"
  [filters]="base geometry earth linear state imu measurements timeline"
  [factors]="base geometry earth state imu measurements timeline"
  [dataset]="base geometry earth state imu measurements timeline"
  [simulation]="base geometry earth state imu measurements timeline dataset"
  [evaluation]="base geometry earth state imu measurements timeline dataset"
  [io/read]="base geometry earth state imu measurements timeline dataset"
  [io/write]="base geometry earth state imu measurements timeline dataset
    simulation evaluation io/read"
  [io/config]="base geometry earth state imu measurements timeline dataset
    simulation io/read io/write"
  [receiver_errors]="base geometry earth linear state imu measurements timeline
    filters"
  [attitude]="base geometry earth linear state imu measurements timeline
    filters"
  [alignment]="base geometry earth state imu measurements timeline dataset
    filters attitude"
  [problems]="base geometry earth linear state imu measurements timeline dataset
    filters receiver_errors attitude alignment factors evaluation"
  [app]="base geometry earth linear state imu measurements timeline dataset
    filters receiver_errors attitude alignment factors simulation evaluation io/read
    io/write io/config problems"
)

# Folders with one public header: all that other folders include of them.
declare -A face=(
  [receiver_errors]="receiver_errors/receiver_errors.h"
)

# Constructs that belong to some folders only: pattern | folders.
reserved=(
  'ceres::Problem\b|problems'
  '[<"]gflags/|app'
  '[<"](fstream|zlib\.h)[>"]|io'
  '[<"](sys/mman|fcntl)\.h[>"]|base io'
  '\bstd::(basic_)?[io]?fstream\b|io'
  '\bFILE ?\*|io'
  '\b(std::)?f(re)?open *\(|io'
  '\bgz(d)?open *\(|io'
)

# folder_of path NAME: path relative to the root or to src -> name of the
# folder, into the variable NAME.
folder_of() {
  local path=${1#src/}
  local -n name=$2
  name=${path%%/*}
  if [[ $name == io ]]; then
    path=${path#io/}
    name=io/${path%%/*}
  fi
}

# Lines of all sources that match a pattern, as FILE:LINE:TEXT.
matches() {
  find src factors problems -type f \( -name '*.h' -o -name '*.cc' \) -print0 |
    sort -z | xargs -0 -r grep -HnE "$1"
}

check() {
  local root=$1 violations=0 folders="${!allowed[*]}" file folder line text
  cd "$root" || exit 2
  while IFS= read -r file; do
    folder_of "$file" folder
    if [[ -z ${allowed[$folder]+known} ]]; then
      echo "$file: folder '$folder' has no include rule"
      violations=$((violations + 1))
    fi
  done < <(find src factors problems -type f \( -name '*.h' -o -name '*.cc' \) |
    sort)
  while IFS=: read -r file line text; do
    folder_of "$file" folder
    [[ -n ${allowed[$folder]+known} ]] || continue
    [[ $text =~ \"(([^\"]*)/[^\"]*)\" ]] || continue
    local target header=${BASH_REMATCH[1]}
    folder_of "${BASH_REMATCH[2]}" target
    [[ " $folders " == *" $target "* ]] || continue
    [[ $target == "$folder" ]] && continue
    if [[ -n ${face[$target]:-} && $header != "${face[$target]}" ]]; then
      echo "$file:$line: of $target only ${face[$target]} may be included"
      violations=$((violations + 1))
    fi
    [[ " ${allowed[$folder]//$'\n'/ } " == *" $target "* ]] && continue
    echo "$file:$line: $folder may not include $target"
    violations=$((violations + 1))
  done < <(matches '^ *# *include *"')
  for rule in "${reserved[@]}"; do
    local pattern=${rule%|*} owner=${rule##*|}
    while IFS=: read -r file line text; do
      folder_of "$file" folder
      [[ " $owner " == *" ${folder%%/*} "* ]] && continue
      [[ $text =~ ^\ *// ]] && continue
      echo "$file:$line: only $owner may use: $text"
      violations=$((violations + 1))
    done < <(matches "$pattern")
  done
  ((violations == 0))
}

expect() {  # ok|violation, file, content
  local want=$1 tree
  tree=$(mktemp -d)
  mkdir -p "$tree/src" "$tree/factors" "$tree/problems"
  mkdir -p "$tree/$(dirname "$2")"
  printf '%s\n' "$3" >"$tree/$2"
  local got=ok
  (check "$tree") >/dev/null || got=violation
  rm -rf "$tree"
  if [[ $got != "$want" ]]; then
    echo "self-test: $2 with '$3': $got, expected $want"
    failures=$((failures + 1))
  fi
}

self_test() {
  failures=0
  expect ok src/state/a.h '#include "earth/wgs84.h"'
  expect ok src/state/a.h '#include "state/state.h"'
  expect ok src/io/read/a.cc '#include <fstream>'
  expect ok src/base/a.cc '#include <sys/mman.h>'
  expect ok src/app/a.cc '#include <gflags/gflags.h>'
  expect ok src/filters/a.cc '#include "linear/arrow_least_squares.h"'
  expect ok problems/a.cc 'ceres::Problem problem;'
  expect ok problems/a.cc '#include "receiver_errors/receiver_errors.h"'
  expect ok src/receiver_errors/a.cc '#include "receiver_errors/error_tuning.h"'
  expect ok factors/a.cc '// A ceres::Problem owns the factor.'
  expect violation src/earth/a.h '#include "state/state.h"'
  expect violation src/linear/a.h '#include "geometry/so3.h"'
  expect violation src/filters/a.cc '#include "factors/imu_factor.h"'
  expect violation src/measurements/a.h '#include "timeline/timeline.h"'
  expect violation src/timeline/a.h '#include "filters/kalman.h"'
  expect violation factors/a.cc '#include "filters/tape.h"'
  expect violation src/evaluation/a.cc '#include "io/read/csv.h"'
  expect violation src/io/read/a.cc '#include "io/config/config.h"'
  expect violation src/dataset/a.cc '#include "simulation/simulate.h"'
  expect violation problems/a.cc '#include "receiver_errors/error_tuning.h"'
  expect violation factors/a.cc 'ceres::Problem problem;'
  expect violation problems/a.cc '#include <gflags/gflags.h>'
  expect violation src/filters/a.cc '#include <fstream>'
  expect violation src/imu/a.cc '#include <fcntl.h>'
  expect violation src/app/a.cc 'std::ofstream out(path);'
  expect violation src/app/a.cc 'FILE* file = std::fopen(path, "r");'
  expect violation src/unknown/a.cc 'int x;'
  ((failures == 0))
}

if [[ ${1:-} == --self-test ]]; then
  self_test
else
  check "${1:-.}"
fi
