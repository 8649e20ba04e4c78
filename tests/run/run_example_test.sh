#!/usr/bin/env bash
# The runner of the examples on a stand-in program.
set -euo pipefail
here=$(cd -- "$(dirname -- "$0")" && pwd)
# shellcheck source=tests/run/check.sh
source "$here/check.sh"

cat >"$scratch/pendulum" <<'END'
#!/usr/bin/env bash
if [[ $1 == --fail ]]; then echo "no such luck" >&2; exit 1; fi
echo "Pendulum, options: $*"
echo "  period   1.2340 s"
echo "energy error 3.1e-12, angle -0.5 rad"
END
chmod +x "$scratch/pendulum"

example() {
  printf '%s\n' "$@" >"$scratch/pendulum.cpp"
  call "$here/../examples/run_example.sh" "$scratch/pendulum" "$scratch/pendulum.cpp" "$scratch/folder"
}

example '// Run: ./run pendulum --short   (a remark)' '// Prints: Pendulum, options: --short' '// Prints: period 1.2340 s'
expect "equal lines, other spaces" is "$code" 0
example '// Run:  build/release/bin/pendulum' '// Prints: period 1.2341 s'
expect "one unit of the last digit" is "$code" 0
example '// Run: ./run pendulum' '// Prints: period 1.2342 s'
expect "two units of the last digit" is "$code" 1
expect "the line is named" has "$out" "not printed: period 1.2342 s"
example '// Run: ./run pendulum' '// Prints: energy error ..., angle -0.5 rad'
expect "any word" is "$code" 0
example '// Run: ./run pendulum' '// Prints: energy error 3.2e-12, angle -0.6 rad'
expect "numbers beside signs" is "$code" 0
example '// Run: ./run pendulum' '// Prints: energy error ..., angle 0.5 rad'
expect "the sign" is "$code" 1
example '// Run: ./run pendulum' '// Prints: energy error ..., angle -0.5 rad' '// Prints: period 1.2340 s'
expect "the order" is "$code" 1
example '// Run: ./run pendulum' '// Prints: period 1.2340'
expect "a word too few" is "$code" 1
example '// Run: ./run pendulum --fail'
expect "the exit code" is "$code" 1
expect "the message is shown" has "$out" "no such luck"
example '// Run: ./run pendulum --a' '// Prints: Pendulum, options: --a' \
  '// Run: ./run pendulum --b' '// Prints: Pendulum, options: --a'
expect "every Run line has its own Prints lines" is "$code" 1
example '// Run: ./run pendul'
expect "another program" has "$out" "does not run pendulum"
example '// nothing'
expect "no Run line" is "$code" 1

finish
