#!/bin/bash
# Holds README.md and the pages to what they cite:
#   tests/documentation_test.sh [ROOT]      prints each fault, exits 1
#   tests/documentation_test.sh --self-test shows that faults are found
# Links lead to a file and a heading that are there; files, types and functions
# of the project exist by the names they are cited by; fences are closed and the
# rows of a table have its columns; README.md is short and links every page.
set -uo pipefail

kLongestReadme=250

pages() {
  find README.md data/README.md docs -name '*.md' 2>/dev/null | sort
}

# The text of a page without its fenced blocks.
prose() {
  awk '/^ *```/ {fenced = !fenced; next} !fenced' "$1"
}

# The anchors that a page's headings make, as GitHub names them.
anchors() {
  prose "$1" | sed -nE 's/^#+ +(.*)$/\1/p' | tr '[:upper:]' '[:lower:]' |
    sed -E 's/[^a-z0-9 _-]//g; s/ /-/g'
}

check_links() {
  local page=$1 target path anchor file
  while IFS= read -r target; do
    case $target in *://*) continue ;; esac
    path=${target%%#*}
    anchor=""
    [[ $target == *#* ]] && anchor=${target#*#}
    file=$page
    [[ -n $path ]] && file=$(dirname "$page")/$path
    if [[ ! -e $file ]]; then
      echo "$page: link to $target, which is not there"
    elif [[ -n $anchor ]] && ! anchors "$file" | grep -qxF -- "$anchor"; then
      echo "$page: link to $target, which has no such heading"
    fi
  done < <(prose "$page" | grep -oE '\]\([^) ]+\)' | sed -E 's/^..(.*).$/\1/')
}

# A path with $ or NAME stands for several files.
check_paths() {
  local page=$1 path
  local top='src|factors|problems|tests|data|docs|cmake|\.ci'
  local files='CMakeLists\.txt|CMakePresets\.json|setup\.sh|CHANGELOG\.md'
  while IFS= read -r path; do
    case $path in *'$'* | *NAME*) continue ;; esac
    path=${path%%[.,]}
    compgen -G "$path" >/dev/null || echo "$page: cites $path, which is not there"
  done < <(sed -E 's/\]\([^)]*\)/]/g' "$page" |
    grep -oP "(?<![\w./-])(($top)/[\w.*/\$-]+|$files)" | sort -u)
}

# `Name` and `Name::Member` in backticks; `names` holds every word of the code.
check_names() {
  local page=$1 names=$2 name
  while IFS= read -r name; do
    grep -qxF -- "$name" "$names" ||
      echo "$page: cites $name, which is not in the code"
  done < <(prose "$page" |
    grep -oP '(?<=`)([A-Z][a-z]|k[A-Z])[A-Za-z]*(::[A-Za-z_]+)*(?=`)' |
    sed 's/::/\n/g' | sort -u)
}

check_form() {
  awk -v page="$1" '
    /^ *```/ {fenced = !fenced}
    fenced || !/^\|/ {columns = 0; next}
    {
      row = $0
      gsub(/\\\|/, "", row)
      n = gsub(/\|/, "", row)
      if (columns == 0) columns = n
      if (n != columns) {
        print page ":" NR ": " n - 1 " columns in a table of " columns - 1
      }
    }
    END {if (fenced) print page ": a fence is not closed"}' "$1"
}

faults() {
  local names page lines
  names=$(mktemp)
  grep -rhoE '[A-Za-z_][A-Za-z0-9_]*' src factors problems tests 2>/dev/null |
    sort -u >"$names"
  while IFS= read -r page; do
    check_links "$page"
    check_paths "$page"
    check_names "$page" "$names"
    check_form "$page"
    [[ $page == docs/* ]] && ! grep -qF "]($page" README.md &&
      echo "README.md: no link to $page"
  done < <(pages)
  rm -f "$names"
  lines=$(wc -l <README.md)
  ((lines <= kLongestReadme)) ||
    echo "README.md: $lines lines; expected at most $kLongestReadme"
}

check() {
  cd "$1" || exit 2
  local found
  found=$(faults)
  [[ -z $found ]] && return 0
  echo "$found"
  return 1
}

expect() {  # ok|fault, a page's text
  local want=$1 tree got=ok
  tree=$(mktemp -d)
  mkdir -p "$tree/docs" "$tree/src/io"
  echo '[page](docs/page.md)' >"$tree/README.md"
  echo 'void ReadFile();' >"$tree/src/io/file.h"
  printf '# A page\n\n## What `it` says\n\n%b\n' "$2" >"$tree/docs/page.md"
  (check "$tree") >/dev/null || got=fault
  rm -rf "$tree"
  if [[ $got != "$want" ]]; then
    echo "self-test: '$2': $got, expected $want"
    failures=$((failures + 1))
  fi
}

self_test() {
  failures=0
  expect ok '[a](page.md), [b](#what-it-says), [c](https://example.org/x)'
  expect ok 'in `src/io/file.h`, `src/io/*.h`, data/NAME.yaml, `ReadFile`.'
  expect ok '```\n[a](nowhere.md) | b\n```'
  expect ok '| a | b |\n|---|---|\n| 1 | a \\\\| b |'
  expect fault '[a](nowhere.md)'
  expect fault '[a](#nowhere)'
  expect fault 'in `src/io/nowhere.h`.'
  expect fault '```\nrun data/nowhere.yaml\n```'
  expect fault '`ReadNothing`'
  expect fault '| a | b |\n|---|---|\n| 1 |'
  expect fault '```\nopen'
  ((failures == 0))
}

if [[ ${1:-} == --self-test ]]; then
  self_test
else
  check "${1:-.}"
fi
