"""Replays the packaged captures of a real Apple II Plus and the published runs on this machine,
compares every result of solve with the frozen vectors' digits, and prints what was checked, counts,
hashes and versions: the record of an installation qualification.

examples:
  impact88 selfcheck
  impact88 selfcheck --json -o qualification.json

exit status: 0 everything came out as captured; 1 something did not
"""

import sys

from ...conformance.qualification.selfcheck import Check, checks, record
from . import options

ARGUMENTS = (options.flag("--json", "print the record as one JSON object"), options.OUTPUT)


def main(args: options.Args) -> int:
    results: list[Check] = []
    for check in checks():
        results.append(check)
        if not args.json:
            print(_line(check), flush=True)
        elif sys.stderr.isatty():
            print(f"{check.name}: {'pass' if check.passed else 'FAIL'}", file=sys.stderr)
    qualification = record(results)
    if args.json:
        options.print_json("selfcheck", qualification, indent=2)
    else:
        print()
        for group in ("versions", "hashes"):
            for name, text in qualification[group].items():
                print(f"{name + (' SHA-256' if group == 'hashes' else ''):<17} {text}")
        print(f"{'time':<17} {qualification['seconds']} s")
        print(f"{'result':<17} {'PASS' if qualification['passed'] else 'FAIL'}")
    return int(not qualification["passed"])


def _line(check: Check) -> str:
    verdict = "pass" if check.passed else "FAIL"
    line = f"{verdict}  {check.name:<12} {check.right:>6} of {check.total:>6} {check.compared}"
    if not check.passed:
        line += f"\n      first wrong: {check.first_wrong or 'nothing to compare'}"
    return line
