#!/usr/bin/env bash
# tests/soil/verification_cases.txt against the sources of the tests: both know the same names and tests, so that a slip is
# found here and not at the end of ./run verify-soil.
set -euo pipefail
here=$(cd -- "$(dirname -- "$0")" && pwd)
# shellcheck source=tests/run/check.sh
source "$here/check.sh"

# problems CASES FOLDER: a line for each name or test that only one side knows. A source records NAME- where the rest of the
# name is put together at run time.
problems() {
  local sources
  mapfile -t sources < <(find "$2" -name '*.cpp')
  awk -v cases="$1" '
    function trim(text) { gsub(/^[ \t]+|[ \t]+$/, "", text); return text }
    function read_source(file, text,   rest, call, part) {
      rest = text
      while (match(rest, /TEST(_F|_P)?\( ?[A-Za-z0-9_]+, [A-Za-z0-9_]+ ?\)/)) {
        split(substr(rest, RSTART, RLENGTH), part, /[(), ]+/)
        place[part[2] "." part[3]] = file
        rest = substr(rest, RSTART + RLENGTH)
      }
      rest = text
      while (match(rest, /record_verification\([^;]*;/)) {
        call = substr(rest, RSTART, RLENGTH)
        rest = substr(rest, RSTART + RLENGTH)
        for (; match(call, /"[^"]*"/); call = substr(call, RSTART + RLENGTH))
          names[file, substr(call, RSTART + 1, RLENGTH - 2)] = 1
      }
    }
    # Whether `file` records `name`, as it is or by its beginning.
    function records(file, name,   known, part) {
      for (known in names) {
        split(known, part, SUBSEP)
        if (part[1] == file && (part[2] == name || part[2] ~ /-$/ && index(name, part[2]) == 1)) {
          used[known] = 1
          return 1
        }
      }
      return 0
    }
    FNR == 1 { if (file != "") read_source(file, text); file = FILENAME; text = "" }
    { sub(/^[ \t]+/, ""); text = text $0 " " }
    END {
      read_source(file, text)
      while ((getline line <cases) > 0) {
        if (line ~ /^(#|=|[ \t]*$)/) continue
        split(line, field, "|")
        name = trim(field[1]); test = trim(field[6])
        if (name != "" && seen[name]++) print name ": two cases"
        sub(/^[^.]*\//, "", test); sub(/\/[^\/]*$/, "", test)  # of a parametrised test
        if (!(test in place)) print test ": no such test"
        else if (name != "" && !records(place[test], name)) print name ": not recorded where " test " is"
      }
      for (known in names) {
        split(known, part, SUBSEP)
        if (!(known in used)) print part[2] ": recorded, but no case"
      }
    }' "${sources[@]}" | sort
}

# --- on made-up tests ------------------------------------------------------------------------------------

mkdir "$scratch/tests"
cat >"$scratch/tests/lamb_test.cpp" <<'END'
TEST(Lamb,
     IsSolved) {
  record_verification("lamb", 100 * worst);
}
TEST_P(Boundary, SendsBack) {
  test::record_verification((GetParam() == 0 ? "half-space-" : "layered-") +
                                std::to_string(f),
                            back);
}
END
echo 'TEST_F(Restart, Goes) {}' >"$scratch/tests/restart_test.cpp"
cat >"$scratch/cases.txt" <<'END'
# remark
= Table
lamb | Lamb's problem | Pekeris | 1 | % | Lamb.IsSolved
half-space-3 | Boundary | layered | -20 | dB | Two/Boundary.SendsBack/0
layered-3 | Boundary | layered | -20 | dB | Two/Boundary.SendsBack/1
 | Restart | a whole run | bit by bit | | Restart.Goes
END
made_up() { problems "$scratch/cases.txt" "$scratch/tests"; }
expect "a list that fits has no problem" is "$(made_up)" ""
echo 'lambda | Lamb | Pekeris | 1 | % | Lamb.IsSolved' >>"$scratch/cases.txt"
echo 'TEST(Waves, Run) { record_verification("speed", worst); }' >"$scratch/tests/waves_test.cpp"
expect "a case and a record without each other" is "$(made_up)" \
  $'lambda: not recorded where Lamb.IsSolved is\nspeed: recorded, but no case'
sed -i -e '$d' -e 's/Restart.Goes/Restart.Stops/' -e 's/^half-space-3/half-3/' "$scratch/cases.txt"
rm "$scratch/tests/waves_test.cpp"
expect "a test and a beginning that are not there" is "$(made_up)" \
  $'Restart.Stops: no such test\nhalf-3: not recorded where Boundary.SendsBack is\nhalf-space-: recorded, but no case'

# --- on those of the project -----------------------------------------------------------------------------

expect "every case is recorded by its test, and every record has a case" is \
  "$(problems "$here/../soil/verification_cases.txt" "$here/..")" ""

finish
