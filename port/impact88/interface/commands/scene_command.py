"""Axes, sides and signs:

{signs}
A value may have a unit ("-25 mph", "3,091 lb", "6 ft 6 in", "2000 slug ft2"), and the file units =
"us", "metric", "si" or "chapter" for those that have none. It may be known within limits ("-31 ..
-29 mph", "30 mph +- 5 %"); what takes one value takes the middle, with a note. UX_source = "..."
says where a value comes from, title and case what it belongs to. CAF CAL (forward and to the left
of A's center of gravity) may stand for DA PA, CBF CBL for DB PB; within limits, bounds and report
follow them, and reconstruct asks for limits on DA PA. IA = "estimate" has the yaw
inertia estimated: from the vehicle's length and width where LA BA are given (LB BB for IB), else
for a car from its weight. Beside a known inertia LA BA are the outline that figures draw.

Kinds of collision (CASE): intersection, rear-end, head-on, barrier, planar, crush.

examples:
  impact88 scene -o mine.toml       a template to fill in
  impact88 scene --units us         the same, in mph, lb and ft
  impact88 scene --template intersection -o crash.toml    the case's own entries
  impact88 scene --sample 2         the scene of the Appendix's second sample run
"""

from ...collision.casescene import sample
from ...collision.scenefile import CASES, SIGNS, case_template, template
from ...collision.units import system_named
from ...errors import UserError
from . import options

__doc__ = (__doc__ or "").format(signs=SIGNS)

ARGUMENTS = (
    options.value(
        "case", "CASE", "the kind of collision: see above", choices=tuple(CASES), nargs="?"
    ),
    options.SAMPLE,
    options.flag("--template", "a file with what CASE needs, and no more; without CASE, the kinds"),
    options.UNITS,
    options.OUTPUT,
)


def main(args: options.Args) -> None:
    system = system_named(args.units, "--units").name if args.units else None
    if args.case and args.sample:
        raise UserError(f"{args.case} and --sample are both given; expected one of them")
    if args.case:
        print(case_template(args.case, system), end="")
        return
    if args.template:
        print("\n".join(f"{name:<14}{case.title}" for name, case in CASES.items()))
        return
    case = sample(args.sample).case.shown_in(system) if args.sample else None
    print(template(case, system), end="")
