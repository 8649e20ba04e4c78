#!/usr/bin/env bash
# The history of benchmarks, on results as Google Benchmark writes them.
set -euo pipefail
here=$(cd -- "$(dirname -- "$0")" && pwd)
# shellcheck source=tests/run/check.sh
source "$here/check.sh"
history=$here/../../bench/history/history.sh
export BENCH_MACHINE='A, 2 cores' BENCH_COMMIT=abc BENCH_DATE=2026-01-31

# result FRACTION: one kernel with a roofline and one benchmark without.
result() {
  cat >"$scratch/result.json" <<END
{
  "context": {
    "num_cpus": 2
  },
  "benchmarks": [
    {
      "name": "elastic_step/degree4/float/threads:2/real_time",
      "run_type": "iteration",
      "threads": 1,
      "real_time": 2.5000000000000000e+01,
      "time_unit": "ms",
      "bytes_per_dof": 8.3000000000000000e+00,
      "dof_per_second": 4.0000000000000000e+08,
      "roofline_fraction": $1,
      "triad_bytes_per_second": 1.3000000000000000e+10
    },
    {
      "name": "train_superposition/threads:2/real_time",
      "run_type": "iteration",
      "threads": 1,
      "real_time": 1.5000000000000000e+03,
      "time_unit": "ms"
    }
  ]
}
END
}
file=$scratch/soil.csv

result 0.4
call "$history" compare "$scratch/result.json" "$file"
expect "no history, no comparison" is "$code$out" 0
call "$history" append "$scratch/result.json" "$file" 'first, quiet machine'
expect "appended" is "$code" 0
expect "header, then one line per benchmark" is "$(cat "$file")" \
  'date,commit,machine,benchmark,threads,seconds,dof_per_second,bytes_per_dof,roofline_fraction,triad_bytes_per_second,note
2026-01-31,abc,A; 2 cores,elastic_step/degree4/float,2,0.025,4e+08,8.3,0.4,1.3e+10,first; quiet machine
2026-01-31,abc,A; 2 cores,train_superposition,2,1.5,,,,,first; quiet machine'

# The median of the last five, 0.4 0.5 0.5 0.5 0.9 of six entries, is 0.5; another machine's 0.1 does not count.
for fraction in 0.5 0.5 0.4 0.5 0.9; do
  result "$fraction"
  "$history" append "$scratch/result.json" "$file"
done
result 0.1
BENCH_MACHINE=B "$history" append "$scratch/result.json" "$file"
result 0.45
call "$history" compare "$scratch/result.json" "$file"
expect "a loss is visible" has "$out" "0.450      0.500      -10.0 %"
expect "a benchmark without roofline is left out" lacks "$out" train_superposition
BENCH_MACHINE=C call "$history" compare "$scratch/result.json" "$file"
expect "an unknown machine has none" has "$out" "none"

call "$history" append "$scratch/missing.json" "$file"
expect "a missing result is named" has "$err" "missing.json"
expect "and refused" is "$code" 2

finish
