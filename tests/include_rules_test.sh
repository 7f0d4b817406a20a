#!/bin/bash
# Holds the sources to the order in which folders may include each other:
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
  [filters]="base geometry earth linear state imu measurements"
  [factors]="base geometry earth state imu measurements"
  [dataset]="base geometry earth state imu measurements"
  [simulation]="base geometry earth state imu measurements dataset"
  [evaluation]="base geometry earth state imu measurements dataset"
  [io]="base geometry earth state imu measurements dataset simulation evaluation"
  [alignment]="base geometry earth state imu measurements dataset filters"
  [problems]="base geometry earth linear state imu measurements dataset filters
    alignment factors evaluation"
  [app]="base geometry earth linear state imu measurements dataset filters
    alignment factors simulation evaluation io problems"
)

# Constructs that belong to some folders only: pattern | folders.
reserved=(
  'ceres::Problem\b|problems'
  '[<"]gflags/|app'
  '[<"](fstream|sys/mman\.h|fcntl\.h|zlib\.h)[>"]|io'
  '\bstd::(basic_)?[io]?fstream\b|io'
  '\bFILE ?\*|io'
  '\b(std::)?f(re)?open *\(|io'
  '\bgz(d)?open *\(|io'
)

folder_of() {  # path relative to the root -> name of the folder
  local path=${1#src/}
  echo "${path%%/*}"
}

check() {
  local root=$1 violations=0 folders="${!allowed[*]}"
  cd "$root" || exit 2
  while IFS= read -r file; do
    local folder
    folder=$(folder_of "$file")
    if [[ -z ${allowed[$folder]+known} ]]; then
      echo "$file: folder '$folder' has no include rule"
      violations=$((violations + 1))
      continue
    fi
    while IFS=: read -r line text; do
      [[ $text =~ \"([^/\"]*)/ ]] || continue
      local target=${BASH_REMATCH[1]}
      [[ " $folders " == *" $target "* ]] || continue
      [[ $target == "$folder" ]] && continue
      [[ " ${allowed[$folder]//$'\n'/ } " == *" $target "* ]] && continue
      echo "$file:$line: $folder may not include $target"
      violations=$((violations + 1))
    done < <(grep -nE '^ *# *include *"' "$file")
    for rule in "${reserved[@]}"; do
      local pattern=${rule%|*} owner=${rule##*|}
      [[ $folder == "$owner" ]] && continue
      while IFS=: read -r line text; do
        echo "$file:$line: only $owner may use: $text"
        violations=$((violations + 1))
      done < <(grep -nE "$pattern" "$file" | grep -vE '^[0-9]+: *//')
    done
  done < <(find src factors problems -type f \( -name '*.h' -o -name '*.cc' \) |
    sort)
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
  expect ok src/io/a.cc '#include <fstream>'
  expect ok src/app/a.cc '#include <gflags/gflags.h>'
  expect ok src/filters/a.cc '#include "linear/arrow_system.h"'
  expect ok problems/a.cc 'ceres::Problem problem;'
  expect ok factors/a.cc '// A ceres::Problem owns the factor.'
  expect violation src/earth/a.h '#include "state/state.h"'
  expect violation src/linear/a.h '#include "geometry/so3.h"'
  expect violation src/filters/a.cc '#include "factors/imu_factor.h"'
  expect violation factors/a.cc '#include "filters/tape.h"'
  expect violation src/evaluation/a.cc '#include "io/csv.h"'
  expect violation src/dataset/a.cc '#include "simulation/simulate.h"'
  expect violation factors/a.cc 'ceres::Problem problem;'
  expect violation problems/a.cc '#include <gflags/gflags.h>'
  expect violation src/filters/a.cc '#include <fstream>'
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
