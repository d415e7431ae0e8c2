"""The command line: one module for each command, imported only when it is called."""

COMMANDS = {
    "verify": "check an old printout digit for digit, and explain what differs",
    "run": "run the 1988 program and print its page",
    "solve": "answer a collision (FILE.toml), or solve each row of a table",
    "report": "write a page (.html) or a drawing (.svg, .png) for the case file",
    "scene": "write a file to fill in, or a published run's",
    "oracle": "compute reference answers, to check other programs with",
    "compare": "say where another program's results differ, and why",
    "selfcheck": "replay what a real Apple II Plus did: pass or fail",
    "basic": "the ] prompt of an Apple II Plus, or any Applesoft program",
    "web": "the same in a browser, reachable from this computer only",
    "chapter": "the chapter's other problems: colinear, delta-v, staged, example",
    "bench": "measure run time against error on this computer",
}
"""One line of help for each command, in the order of the overview. `impact88.cli.NAME` has the
command's help as its docstring, its ``OPTIONS``, and its function ``main``, which returns whether
the result is adverse, or another exit status."""

GONE = {
    "bounds": "impact88 solve FILE.toml, which gives intervals where the file has tolerances",
    "reconstruct": "impact88 solve FILE.toml, which solves for what the file leaves open",
    "figure": "impact88 report FILE.toml -o drawing.svg",
    "desk": "impact88 web",
    "witness": "a checkout: IMPACT88_ROM=FILE pytest tests/comparison/test_rom.py",
    "schema": "the guide's page on JSON forms",
    "completion": "impact88 help, which lists the commands",
    "colinear": "impact88 chapter colinear",
    "barrier": "impact88 scene barrier -o FILE.toml, filled in, and impact88 solve",
    "delta-v": "impact88 chapter delta-v",
    "staged": "impact88 chapter staged",
    "example": "impact88 chapter example",
}
"""Commands of earlier releases, and what to use instead."""
