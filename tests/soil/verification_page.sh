#!/usr/bin/env bash
# The page of verification, docs/verification-soil.md, from what ctest and the tests have written.
#
#   verification_page.sh tests CASES                        regular expression of the tests to run, for ctest -R
#   verification_page.sh page CASES RECORDS JUNIT >PAGE     the page; messages name what is missing, failed or missed
#
# CASES: verification_cases.txt; RECORDS: lines "name figure" of verification_record.hpp; JUNIT: of ctest
# --output-junit. The page has every case of CASES. The last message counts them. Exit status: 0 all tests of the cases ran
# and passed and all figures held; 1 one did not run or failed, or a figure is missing or missed; 2 RECORDS holds an unknown
# name or CASES a wrong line.
set -euo pipefail

case ${1:-} in
  tests)
    awk -F '[ ]*[|][ ]*' '
      !/^(#|=|[ \t]*$)/ {
        gsub(/[ \t]+$/, "", $6); gsub(/[.]/, "[.]", $6)
        if (!seen[$6]++) list = list (list ? "|" : "") $6
      }
      END { print "^(" list ")$" }' "$2"
    ;;
  page)
    awk -v cases="$2" -v records="$3" -v junit="$4" '
      function trim(text) { gsub(/^[ \t]+|[ \t]+$/, "", text); return text }
      function attribute(line, name,   at, rest) {
        at = index(line, " " name "=\"")
        if (!at) return ""
        rest = substr(line, at + length(name) + 3)
        return substr(rest, 1, index(rest, "\"") - 1)
      }
      function say(text) { print "verification: " text >"/dev/stderr" }
      function is_number(text) { return text ~ /^[-+0-9.e]+$/ }
      # Three digits: with two, -35.2 and -34.6 both look like the -35 that they are to hold.
      function show(figure) { return sprintf("%.3g", figure) }
      # A ratio stands alone, all else has its unit.
      function with_unit(text, unit) { return unit == "1" || unit == "" ? text : text " " unit }
      function emit(text) { body = body text "\n" }

      BEGIN {
        while ((status = (getline line <junit)) > 0) {
          if (line !~ /<testcase /) continue
          name = attribute(line, "name")
          result[name] = attribute(line, "status")
          time[name] = attribute(line, "time")
        }
        if (status < 0) say("no results of ctest: " junit)
        while ((getline line <records) > 0) {
          split(line, field, " ")
          name = field[1]
          if (name in measured && !is_number(measured[name])) continue  # once not finite, so it stays
          if (!is_number(field[2])) measured[name] = field[2]
          else if (!(name in measured) || field[2] + 0 > measured[name]) measured[name] = field[2] + 0
        }
        while ((status = (getline line <cases)) > 0) {
          if (line ~ /^(#|[ \t]*$)/) continue
          if (line ~ /^=/) {
            emit("\n## " trim(substr(line, 2)) "\n")
            emit("| case | reference | measured | to hold | | test | time |\n|---|---|---|---|---|---|---|")
            continue
          }
          if (split(line, field, "|") != 6) { say("not six fields: " line); wrong = 1; continue }
          for (i = 1; i <= 6; ++i) field[i] = trim(field[i])
          name = field[1]; test = field[6]; ++count
          known[name] = 1
          state = test in result ? result[test] : "absent"
          figure = name == "" ? "" : (name in measured ? measured[name] : "none")
          if (state == "absent" || state == "notrun" || state == "disabled") {
            verdict = "**did not run**"; ++bad; say(field[2] ": did not run (" test ")")
          } else if (state != "run") {
            verdict = "**failed**"; ++bad; say(field[2] ": failed (" test ")")
          } else if (figure == "none") {
            verdict = "**no figure**"; ++bad; say(field[2] ": its test recorded no figure (" name ")")
          } else if (name != "" && !is_number(figure)) {
            verdict = "**not finite**"; ++bad; say(field[2] ": " figure)
          } else if (name != "" && figure > field[4] + 0) {
            verdict = "**missed**"; ++missed; say(field[2] ": missed, " show(figure) " instead of " field[4] " " field[5])
          } else {
            verdict = "held"; ++held
          }
          shown = name == "" ? (state == "run" ? "yes" : "-") : figure == "none" ? "-" : \
                  with_unit(is_number(figure) ? show(figure) : figure, field[5])
          if (test in time && !(test in counted)) { total += time[test]; counted[test] = 1 }
          emit("| " field[2] " | " field[3] " | " shown " | " with_unit(field[4], field[5]) " | " verdict " | `" test "` | " \
               (test in time ? sprintf("%.0f s", time[test]) : "-") " |")
        }
        if (status < 0) { say("no list of cases: " cases); exit 2 }
        for (name in measured) if (!(name in known)) { say("a figure of an unknown case: " name); wrong = 1 }

        print "# Verification of the soil program\n"
        print "Written by `./run verify-soil`, which runs every test below; do not edit. Errors of records are L2, relative,"
        print "over the whole record, and the worst of all receivers and components; a figure is the worst of its test."
        print "What the figures mean: `docs/accuracy.md`; the cases: `tests/soil/verification_cases.txt`.\n"
        printf "%d cases: %d held, %d missed, %d failed or not run. All tests together: %.0f s.\n", count, held, missed, bad, total
        print "\"missed\": what was to hold does not, although the test passes at a bound of its own; `./run verify-soil` then fails."
        printf "%s", body
        say(sprintf("%d cases: %d held, %d missed, %d failed or not run", count, held, missed, bad))
        exit wrong ? 2 : bad || missed || count == 0 ? 1 : 0
      }'
    ;;
  *)
    echo "usage: $0 tests CASES | page CASES RECORDS JUNIT" >&2
    exit 2
    ;;
esac
