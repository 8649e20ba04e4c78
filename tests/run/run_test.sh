#!/usr/bin/env bash
# ./run in a small tree of its own, with stand-ins for dpkg, apt, cmake, ctest and the programs: nothing is built.
set -euo pipefail
here=$(cd -- "$(dirname -- "$0")" && pwd)
# shellcheck source=tests/run/check.sh
source "$here/check.sh"

# The tree: two programs, one of which has a site.
tree="$scratch/a house"
mkdir -p "$tree/examples/sites" "$scratch/bin" "$scratch/elsewhere"
cp "$here/../../run" "$tree/run"
mkdir -p "$tree/tests/soil" "$tree/docs"
cp "$here/../soil/verification_page.sh" "$tree/tests/soil/"
printf '= Table\nlamb | Lamb | Pekeris | 1 | %% | Lamb.IsSolved\n' >"$tree/tests/soil/verification_cases.txt"
printf '// Tram on a soft site.\n//\n// Run: ./run tram\napp.add_option("--output")\napp.add_option("--site")\n' >"$tree/examples/tram.cpp"
cp "$tree/examples/tram.cpp" "$tree/examples/study.cpp"
printf '// Double pendulum, from positions only.\n' >"$tree/examples/double_pendulum.cpp"
touch "$tree/examples/sites/tram.toml"

# Stand-ins. $scratch/log is what was called; $scratch/fail_* makes a step fail with the code it holds.
stand_in() {
  printf '#!/usr/bin/env bash\nset -eu\nscratch=%q\n' "$scratch" >"$scratch/bin/$1"
  cat >>"$scratch/bin/$1"
  chmod +x "$scratch/bin/$1"
}
stand_in dpkg-query <<'END'
if [[ -e $scratch/missing && $(<"$scratch/missing") == "${!#}" ]]; then exit 1; fi
echo installed
END
stand_in apt-get <<'END'
echo "apt-get $*" >>"$scratch/log"
END
stand_in sudo <<'END'
"$@"
END
stand_in ctest <<'END'
echo "ctest $*" >>"$scratch/log"
[[ $* == *sanitize* && -e $scratch/fail_sanitize ]] && exit 8
if [[ -n ${EASYDYN_VERIFICATION:-} ]]; then
  echo "lamb 0.5" >>"$EASYDYN_VERIFICATION"
  result=run
  [[ -e $scratch/fail_verification ]] && result=fail
  echo "<testcase name=\"Lamb.IsSolved\" time=\"3\" status=\"$result\">" >"${!#}"
  [[ $result == fail ]] && exit 8
fi
echo "100% tests passed, 0 tests failed out of 1"
END
stand_in cmake <<'END'
echo "cmake $*" >>"$scratch/log"
if [[ -e $scratch/fail_cmake ]]; then echo "error: no such thing"; exit "$(<"$scratch/fail_cmake")"; fi
while (($# > 0)); do
  case $1 in
    -B) mkdir -p "$2/bin"; touch "$2/build.ninja"; shift ;;
    --build)
      for program in tram study double_pendulum; do
        cp "$scratch/bin/program" "$2/bin/$program"
      done
      cp "$scratch/bin/soil" "$2/bin/soil"
      shift ;;
  esac
  shift
done
END
stand_in program <<'END'
echo "$(basename "$0") $*" >>"$scratch/log"
pwd >"$scratch/where"
if [[ $* == *--help* ]]; then echo "help of $(basename "$0")"; exit 0; fi
if [[ -e $scratch/fail_program ]]; then exit "$(<"$scratch/fail_program")"; fi
while (($# > 0)); do
  case $1 in
    --output) mkdir -p "$2"; [[ -e $scratch/sweep ]] || touch "$2/surface_loads.h5"; shift ;;
    --output=*) mkdir -p "${1#*=}"; [[ -e $scratch/sweep ]] || touch "${1#*=}/surface_loads.h5" ;;
  esac
  shift
done
END
stand_in soil <<'END'
echo "soil $*" >>"$scratch/log"
if [[ -e $scratch/fail_soil_$1 ]]; then exit "$(<"$scratch/fail_soil_$1")"; fi
if [[ $1 == report ]]; then echo new >"$2/report.html"; fi
END
export PATH="$scratch/bin:$PATH"

run() {
  : >"$scratch/log"
  call "$tree/run" "$@"
  log=$(<"$scratch/log")
}
cd "$tree"

# The list.
run
expect "alone, it succeeds" is "$code" 0
expect "the list has the title of a program" has "$out" "Tram on a soft site."
expect "the list has every program" has "$out" "double_pendulum    Double pendulum, from positions only."
expect "the list has the commands" has "$out" "  bench [NAME]"
expect "listing builds nothing" is "$log" ""
alone=$out
run help
expect "help is the list" is "$out" "$alone"

# Unknown names.
run trm
expect "an unknown name is refused" is "$code" 2
expect "the nearest program is named" has "$err" 'no program "trm"; did you mean tram?'
run bnech
expect "the nearest command is named" has "$err" "did you mean bench?"
run ../run
expect "a path is no name" is "$code" 2
run bench kernle
expect "an unknown benchmark is refused" is "$code" 2
expect "nothing is built for an unknown name" is "$log" ""

# The tram, from the repository root.
run tram --speed 40
expect "the three steps succeed" is "$code" 0
expect "only the needed targets are built" has "$log" "--target tram soil_program"
expect "step 1 gets the site and the options" has "$log" "tram --site examples/sites/tram.toml --output results/tram --speed 40"
expect "impulse responses, beside the site file" has "$log" "soil mobility examples/sites/tram.toml \
--loads results/tram/surface_loads.h5 --method elements --crossover 15 --output examples/sites/tram.mobility.h5"
expect "the first time, it says what they are for" has "$err" "once for this site (expected time below"
expect "superposition" has "$log" "soil predict examples/sites/tram.mobility.h5 results/tram/surface_loads.h5 \
--site examples/sites/tram.toml --output results/tram"
expect "the report" has "$log" "soil report results/tram"
expect "the report is named last" is "$(tail -n 1 <<<"$out")" "$tree/results/tram/report.html"
expect "the build is quiet" lacks "$out$err" "cmake"
expect "apt is left alone when nothing is missing" lacks "$log" "apt-get"

# Again, from elsewhere: configured once, absolute paths.
cd "$scratch/elsewhere"
run tram
expect "it is configured once" lacks "$log" "cmake -S"
expect "from elsewhere, results stay in the repository" has "$log" "tram --site $tree/examples/sites/tram.toml --output $tree/results/tram"
expect "from elsewhere, the report is named" is "$(tail -n 1 <<<"$out")" "$tree/results/tram/report.html"
expect "from elsewhere, nothing is left here" is "$(ls -A)" ""

# Options for the ground; the program does not get them.
run tram --verify --speed 40
expect "--verify goes to the ground" has "$log" "--output $tree/results/tram --verify"
expect "the program gets the others" has "$log" "tram --site $tree/examples/sites/tram.toml --output $tree/results/tram --speed 40"
run tram --speed 40 --direct --verify
expect "--direct runs the finite elements under all loads" has "$log" "soil run $tree/examples/sites/tram.toml \
$tree/results/tram/surface_loads.h5 --output $tree/results/tram --snapshot-step 0.01 --correct-time --verify"
expect "--direct needs no impulse responses" lacks "$log" "soil mobility"
run tram --layered
expect "--layered predicts from the site file" has "$log" "soil predict $tree/examples/sites/tram.toml"
expect "--layered keeps nothing" lacks "$log" "soil mobility"
for other in --verify --direct; do
  run tram "$other" --layered
  expect "--layered has nothing to $other" is "$code" 2
  expect "and nothing runs" is "$log" ""
done
touch "$tree/examples/sites/tram.mobility.h5"
run tram
expect "with responses there, no long run is announced" lacks "$err" "once for this site"
rm "$tree/examples/sites/tram.mobility.h5"
run study --direct
expect "a program without a site gets all options" has "$log" "--direct"

# An output folder of the user's.
run tram --output mine
expect "--output DIR reaches step 1 as given" has "$log" "tram --site $tree/examples/sites/tram.toml --output mine"
expect "--output DIR reaches step 2" has "$log" "mine/surface_loads.h5 --site $tree/examples/sites/tram.toml --output mine"
expect "--output DIR reaches step 3" has "$log" "soil report mine"
expect "the report is there" is "$out" "$scratch/elsewhere/mine/report.html"
cp "$tree/examples/sites/tram.toml" "$scratch/elsewhere/other.toml"
run tram --output mine --site other.toml
expect "another site reaches step 1 once" has "$log" "tram --output mine --site other.toml"
expect "another site reaches step 2" has "$log" "soil mobility other.toml --loads mine/surface_loads.h5"
rm "$scratch/elsewhere/other.toml"
run tram --output=other
expect "--output=DIR is understood" is "$out" "$scratch/elsewhere/other/report.html"
cd "$tree"

# Help goes to the program and runs nothing else.
run tram --help
expect "help of the program" has "$out" "help of tram"
expect "with the options for the ground" has "$out" "--layered "
expect "no soil after help" lacks "$log" "soil "
expect "an earlier report survives help" test -e results/tram/report.html

# A sweep of speeds leaves no new loads: no ground, and the earlier report stays.
touch -d '1 hour ago' results/tram/surface_loads.h5
touch "$scratch/sweep"
run tram --speed 30,40
expect "a sweep succeeds" is "$code" 0
expect "a sweep has no soil" lacks "$log" "soil "
expect "a sweep leaves the earlier report" test -e results/tram/report.html
rm "$scratch/sweep"

# Failing steps.
echo 2 >"$scratch/fail_program"
run tram --sped 40
expect "wrong options keep their code" is "$code" 2
expect "wrong options leave the earlier report" test -e results/tram/report.html
echo 1 >"$scratch/fail_program"
run tram
expect "the code of step 1" is "$code" 1
expect "no path after a failure of step 1" is "$out" ""
expect "no soil after a failure of step 1" lacks "$log" "soil "
expect "no stale report after a failure of step 1" test ! -e results/tram/report.html
rm "$scratch/fail_program"
for step in mobility predict report; do
  run tram
  echo 3 >"$scratch/fail_soil_$step"
  run tram
  expect "the code of soil $step" is "$code" 3
  expect "no path after a failure of soil $step" is "$out" ""
  expect "no stale report after a failure of soil $step" is "$(ls -A results/tram)" "surface_loads.h5"
  rm "$scratch/fail_soil_$step"
done
echo 4 >"$scratch/fail_cmake"
run tram
expect "the code of the build" is "$code" 4
expect "the end of the build log is shown" has "$err" "error: no such thing"
expect "nothing runs after a failed build" lacks "$log" "tram --output"
rm "$scratch/fail_cmake"

# Other programs: their own folder, no soil.
run study --fast
expect "a program without a site gets its folder" has "$log" "study --output results/study --fast"
expect "and has no soil" lacks "$log" "soil"
cd "$scratch/elsewhere"
run double_pendulum 3
expect "a program without --output is not given one" is "$(tail -n 1 <<<"$log")" "double_pendulum 3"
expect "it runs in its folder" is "$(<"$scratch/where")" "$tree/results/double_pendulum"
cd "$tree"

# Missing packages.
echo libfmt-dev >"$scratch/missing"
run double_pendulum
expect "the package list is renewed first" has "$log" "apt-get update"
expect "only what is missing is installed" has "$log" "apt-get install -y --no-install-recommends libfmt-dev
cmake"
rm "$scratch/missing"

# Tests: the release build checks indices; the sanitizers have a build and a command of their own.
run test -R Rail
expect "tests succeed" is "$code" 0
expect "options go to ctest" has "$log" "-R Rail"
expect "the closing line is ctest's" is "$(tail -n 1 <<<"$out")" "100% tests passed, 0 tests failed out of 1"
expect "indices are checked" has "$log" "-DEASYDYN_ASSERTIONS=ON"
expect "the suite is that of the release" has "$(tail -n 1 <<<"$log")" "build/test"
run sanitize -R Rail
expect "sanitizers succeed" is "$code" 0
expect "their build is another" has "$(tail -n 1 <<<"$log")" "build/sanitize"
expect "options go to their ctest, too" has "$(tail -n 1 <<<"$log")" "-R Rail"
touch "$scratch/fail_sanitize"
run sanitize
expect "a failure under the sanitizers counts" is "$code" 8

# Verification: the page is written whatever fails.
run verify-soil
expect "verification succeeds" is "$code" 0
expect "only its programs are built" has "$log" "--target soil_verification"
expect "its tests are run" has "$log" "^(Lamb[.]IsSolved)\$"
expect "the page is named" is "$(tail -n 1 <<<"$out")" "docs/verification-soil.md"
expect "the last message counts" is "$(tail -n 1 <<<"$err")" \
  "verification: 1 cases: 1 held, 0 missed, 0 failed or not run"
expect "the page has the figure" has "$(<docs/verification-soil.md)" "| 0.5 % | 1 % | held |"
touch "$scratch/fail_verification"
run verify-soil
expect "a failed case counts" is "$code" 1
expect "and stands on the page" has "$(<docs/verification-soil.md)" "**failed**"

finish
