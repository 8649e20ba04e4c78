#!/usr/bin/env bash
# run_example.sh PROGRAM SOURCE FOLDER: runs the `// Run:` lines of an example and compares what it prints.
#
#   // Run: ./run double_pendulum --duration 2
#   // Prints: period  1.234 s
#
# The words after the program's name are its options, up to a remark in parentheses; it runs in FOLDER, which
# starts empty. Every `// Prints:` line must be printed by the `// Run:` line above it, in this order; other lines
# may stand between. Words must be equal, but numbers may differ by one unit of their last printed digit, and `...`
# stands for any word.
set -euo pipefail
program=$1 source=$2 folder=$3
name=$(basename -- "$program")
rm -rf -- "$folder"
mkdir -p -- "$folder"
cd -- "$folder"

# compare EXPECTED_FILE PRINTED_FILE
compare() {
  awk '
    function is_number(word) { return word ~ /^[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?$/ }
    # One unit of the last printed digit: 1.23e-4 -> 1e-6.
    function last_digit(word,   at, exponent, decimals) {
      at = match(word, /[eE]/)
      exponent = at ? substr(word, at + 1) + 0 : 0
      if (at) word = substr(word, 1, at - 1)
      at = index(word, ".")
      decimals = at ? length(word) - at : 0
      return 10 ^ (exponent - decimals)
    }
    function same_word(a, b) {
      if (a == b || a == "...") return 1
      if (!is_number(a) || !is_number(b)) return 0
      return (a - b) ^ 2 <= (1.001 * last_digit(a)) ^ 2
    }
    function same_line(a, b,   n, i, wa, wb) {
      gsub(/[][,;:()=]/, " & ", a)  # signs are words of their own, so that the number before a comma is one
      gsub(/[][,;:()=]/, " & ", b)
      n = split(a, wa)
      if (split(b, wb) != n) return 0
      for (i = 1; i <= n; ++i) if (!same_word(wa[i], wb[i])) return 0
      return 1
    }
    { sub(/^[ \t]+/, ""); sub(/[ \t\r]+$/, "") }
    FNR == NR { expected[++wanted] = $0; next }
    found < wanted && same_line(expected[found + 1], $0) { ++found }
    END {
      if (found == wanted) exit 0
      print "not printed: " expected[found + 1]
      exit 1
    }' "$1" "$2"
}

check() {
  local status=0
  echo "$name ${options[*]}"
  "$program" "${options[@]}" >printed.txt 2>messages.txt || status=$?
  if ((status != 0)); then
    cat printed.txt messages.txt
    echo "exit code $status"
    exit 1
  fi
  if [[ -s expected.txt ]] && ! compare expected.txt printed.txt; then
    echo "--- printed:"
    cat printed.txt
    exit 1
  fi
}

runs=0
options=()
while IFS= read -r line; do
  case $line in
    '// Run:'*)
      if ((runs > 0)); then check; fi
      line=${line#// Run:}
      read -r -a words <<<"${line%% (*}"
      while ((${#words[@]} > 0)) && [[ $(basename -- "${words[0]}") != "$name" ]]; do words=("${words[@]:1}"); done
      if ((${#words[@]} == 0)); then
        echo "$source: this line does not run $name: $line"
        exit 1
      fi
      options=("${words[@]:1}")
      runs=$((runs + 1))
      : >expected.txt
      ;;
    '// Prints:'*) echo "${line#// Prints:}" >>expected.txt ;;
  esac
done <"$source"
if ((runs == 0)); then
  echo "$source: no // Run: line"
  exit 1
fi
check
