#!/usr/bin/env bash
# History of benchmarks: one line per entry and benchmark in bench/history/NAME.csv, and how far a run is from it.
#
#   history.sh compare RESULT.json HISTORY.csv          roofline_fraction against the median of the last entries
#   history.sh append RESULT.json HISTORY.csv [NOTE]    adds the run to the history
#
# RESULT.json is what a program of bench/ writes with --benchmark_out. Entries are compared with those of the same kind
# of machine (model of the processor, number of cores) and the same number of threads. BENCH_MACHINE,
# BENCH_COMMIT and BENCH_DATE replace what the machine says.
set -euo pipefail

entries=5  # of which the median is taken
columns=date,commit,machine,benchmark,threads,seconds,dof_per_second,bytes_per_dof,roofline_fraction,triad_bytes_per_second,note

usage() {
  echo "usage: history.sh compare|append RESULT.json HISTORY.csv [NOTE]" >&2
  exit 2
}

machine() {
  local model
  model=$(sed -n 's/^model name[[:space:]]*: //p' /proc/cpuinfo 2>/dev/null | head -n 1)
  echo "${model:-$(uname -m)}, $(nproc) cores"
}

# Lines benchmark,threads,seconds,dof_per_second,bytes_per_dof,roofline_fraction,triad_bytes_per_second of a result.
read_result() {
  awk '
    function value(   v) { v = $0; sub(/^[^:]*: */, "", v); sub(/,? *$/, "", v); gsub(/"/, "", v); return v }
    function flush(   scale) {
      if (name == "" || kind == "aggregate") { delete v; name = kind = ""; return }
      threads = name ~ /threads:/ ? name : ""
      sub(/^.*threads:/, "", threads); sub(/\/.*$/, "", threads)
      sub(/\/threads:.*$/, "", name); sub(/\/real_time$/, "", name)
      scale = v["time_unit"] == "ns" ? 1e-9 : v["time_unit"] == "us" ? 1e-6 : v["time_unit"] == "ms" ? 1e-3 : 1
      printf "%s,%s,%.6g,%s,%s,%s,%s\n", name, threads, v["real_time"] * scale, short(v["dof_per_second"]),
        short(v["bytes_per_dof"]), short(v["roofline_fraction"]), short(v["triad_bytes_per_second"])
      delete v; name = kind = ""
    }
    function short(x) { return x == "" ? "" : sprintf("%.6g", x) }
    /"benchmarks":/ { inside = 1; next }
    !inside { next }
    /^ *"name":/ { name = value() }
    /^ *"run_type":/ { kind = value() }
    /^ *"[a-z_]*":/ { key = $0; sub(/^ *"/, "", key); sub(/".*/, "", key); v[key] = value() }
    /^ *}/ { flush() }' "$1"
}

compare() {
  local result=$1 history=$2
  [[ -e $history ]] || return 0
  read_result "$result" | awk -F, -v machine="$(machine_name)" -v entries="$entries" -v history="$history" '
    BEGIN {
      while ((getline line < history) > 0) {
        split(line, c, ",")
        if (c[3] != machine || c[9] == "") continue
        key = c[4] "," c[5]
        seen[key, ++count[key]] = c[9]
      }
    }
    function median(key,   n, first, i, j, t, x) {
      n = 0
      first = count[key] - entries + 1
      for (i = first < 1 ? 1 : first; i <= count[key]; ++i) x[++n] = seen[key, i] + 0
      for (i = 1; i <= n; ++i) for (j = i + 1; j <= n; ++j) if (x[j] < x[i]) { t = x[i]; x[i] = x[j]; x[j] = t }
      return n % 2 ? x[(n + 1) / 2] : (x[n / 2] + x[n / 2 + 1]) / 2
    }
    $6 != "" {
      key = $1 "," $2
      if (!printed++) printf "%-34s %7s %18s %10s %11s\n", "benchmark", "threads", "roofline_fraction", "history", "difference"
      if (!count[key]) { printf "%-34s %7s %18.3f %10s %11s\n", $1, $2, $6, "none", ""; next }
      m = median(key)
      printf "%-34s %7s %18.3f %10.3f %+10.1f %%\n", $1, $2, $6, m, 100 * ($6 / m - 1)
    }'
}

append() {
  local result=$1 history=$2 note=${3:-} lines commit
  lines=$(read_result "$result")
  if [[ -z $lines ]]; then
    echo "history.sh: $result holds no benchmark" >&2
    exit 1
  fi
  commit=${BENCH_COMMIT:-$(git -C "$(dirname -- "${BASH_SOURCE[0]}")" describe --always --dirty 2>/dev/null || echo unknown)}
  [[ -e $history ]] || echo "$columns" >"$history"
  while IFS= read -r line; do
    echo "${BENCH_DATE:-$(date -u +%Y-%m-%d)},$commit,$(machine_name),$line,${note//,/;}"
  done <<<"$lines" >>"$history"
}

# Without the commas that separate columns.
machine_name() {
  local name=${BENCH_MACHINE:-$(machine)}
  echo "${name//,/;}"
}

(($# >= 3)) || usage
if [[ ! -e $2 ]]; then
  echo "history.sh: no file $2" >&2
  exit 2
fi
case $1 in
  compare) compare "$2" "$3" ;;
  append) append "$2" "$3" "${4:-}" ;;
  *) usage ;;
esac
