#!/usr/bin/env bash
# The page of verification from made-up cases, records and results.
set -euo pipefail
here=$(cd -- "$(dirname -- "$0")" && pwd)
# shellcheck source=tests/run/check.sh
source "$here/check.sh"
page=$here/../soil/verification_page.sh
cd "$scratch"

cat >cases.txt <<'END'
# remark
= First table
lamb | Lamb's problem | Pekeris | 1 | % | Lamb.IsSolved
edge | Boundary | larger model | -35 | dB | Two/Boundary.SendsBack/0
split | Interfaces | none | 1e-10 | 1 | Layers.Split

= Second table
 | Restart | a whole run | bit by bit | | Restart.Goes
twice | The same test again | Pekeris | 2 | % | Lamb.IsSolved
END
cat >junit.xml <<'END'
<?xml version="1.0" encoding="UTF-8"?>
<testsuite name="(empty)" tests="4" failures="0">
	<testcase name="Lamb.IsSolved" classname="Lamb.IsSolved" time="12.4" status="run">
		<system-out>&lt;testcase name="no such" </system-out>
	</testcase>
	<testcase name="Two/Boundary.SendsBack/0" classname="x" time="3.6" status="run"/>
	<testcase name="Layers.Split" classname="x" time="0.01" status="run"/>
	<testcase name="Restart.Goes" classname="x" time="1" status="run"/>
</testsuite>
END
cat >records.txt <<'END'
lamb 0.31
lamb 0.42
lamb 0.4
edge -41.2
edge -35.2
edge -38
split 3.2e-13
twice 0.42
END

# make [SED]: the page, after changes to a copy of records, results or cases.
make() { call "$page" page cases.txt "${1:-records.txt}" "${2:-junit.xml}"; }

call "$page" tests cases.txt
expect "every test is run once" is "$out" '^(Lamb[.]IsSolved|Two/Boundary[.]SendsBack/0|Layers[.]Split|Restart[.]Goes)$'

make
expect "all held succeeds" is "$code" 0
expect "nothing is said but the count" is "$err" "verification: 5 cases: 5 held, 0 missed, 0 failed or not run"
expect "the worst figure counts" has "$out" "| Lamb's problem | Pekeris | 0.42 % | 1 % | held | \`Lamb.IsSolved\` | 12 s |"
expect "the worst figure counts in dB" has "$out" "| Boundary | larger model | -35.2 dB | -35 dB | held |"
expect "a ratio has no unit" has "$out" "| 3.2e-13 | 1e-10 | held |"
expect "a case may have no figure" has "$out" "| Restart | a whole run | yes | bit by bit | held |"
expect "headings" has "$out" "## Second table"
expect "a test with two cases counts once" has "$out" "5 cases: 5 held, 0 missed, 0 failed or not run. All tests together: 17 s."

# What misses its figure is said, stands on the page and fails, although its test passed at a bound of its own.
echo "edge -32.4" | cat records.txt - >worse.txt
make worse.txt
expect "a miss fails" is "$code" 1
expect "a miss is named" has "$err" "Boundary: missed, -32.4 instead of -35 dB"
expect "a miss stands on the page" has "$out" "| -32.4 dB | -35 dB | **missed** |"
expect "a miss is counted on the page" has "$out" "4 held, 1 missed"
expect "a miss is counted in the last line" is "${err##*$'\n'}" "verification: 5 cases: 4 held, 1 missed, 0 failed or not run"

# A test that failed, did not run, was skipped; a figure that is missing.
sed 's|\(Split.*status=\)"run"|\1"fail"|' junit.xml >failed.xml
make records.txt failed.xml
expect "a failure fails" is "$code" 1
expect "a failure is named" has "$err" "Interfaces: failed (Layers.Split)"
expect "a failure stands on the page" has "$out" "**failed**"
grep -v Restart junit.xml >absent.xml
make records.txt absent.xml
expect "what did not run fails" is "$code" 1
expect "what did not run is named" has "$err" "Restart: did not run (Restart.Goes)"
expect "what did not run stands on the page" has "$out" "| - | bit by bit | **did not run** |"
sed 's|\(Split.*status=\)"run"|\1"notrun"|' junit.xml >skipped.xml
make records.txt skipped.xml
expect "what was skipped fails" has "$err" "Interfaces: did not run"
make records.txt no_such.xml
expect "without results nothing ran" has "$err" "Lamb's problem: did not run"
expect "without results it fails" is "$code" 1
grep -v twice records.txt >fewer.txt
make fewer.txt
expect "a missing figure fails" is "$code" 1
expect "a missing figure is named" has "$err" "The same test again: its test recorded no figure (twice)"
{ echo "lamb nan" && cat records.txt; } >nan.txt
make nan.txt
expect "a figure that is not finite fails" is "$code" 1
expect "a figure that is not finite is named" has "$err" "Lamb's problem: nan"

# What belongs to no case.
echo "lambda 1" | cat records.txt - >unknown.txt
make unknown.txt
expect "an unknown name is refused" is "$code" 2
expect "an unknown name is named" has "$err" "a figure of an unknown case: lambda"
echo "half a line | 3" >>cases.txt
make
expect "a wrong line is refused" is "$code" 2
expect "a wrong line is named" has "$err" "not six fields: half a line | 3"

finish
