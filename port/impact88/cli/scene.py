"""impact88 scene -o crash.toml                  a file to fill in
impact88 scene rear-end --units metric        the entries of a kind of collision
impact88 scene --sample 2                     the second sample run as a file
impact88 scene crash.toml --set MU=.5         a file with its entries changed

Kinds of collision:
{kinds}

Axes, sides and signs:

{signs}
A value may have a unit ("-25 mph", "3091 lb", "6 ft 6 in") and a tolerance ("30 +- 2 mph",
"28 .. 32 mph", "normal 30 1.5"). units = "us", "metric", "si" or "chapter" is for those without.
IA = "estimate" estimates a yaw inertia from LA BA (length, width), or for a car from its weight.
CAF CAL (forward, left) may replace DA PA, CBF CBL replace DB PB. UX_source = "event data recorder"
says where a value comes from. axes = "sae" and headings = "compass" change directions."""

from __future__ import annotations

import os

from ..cases.scenefile import SIGNS, TEMPLATES, template
from ..errors import UserError
from .options import CASE, OUTPUT, Args, case_of

__doc__ = (__doc__ or "").format(
    kinds="\n".join(f"  {name:<14}{kind.title}" for name, kind in TEMPLATES.items()), signs=SIGNS
)
OPTIONS = (*CASE, OUTPUT)


def main(args: Args) -> None:
    """Print a scene file."""
    if os.path.isfile(args.output):
        raise UserError("is there already; expected a new file", args.output)
    kind = args.file or "planar"
    if not (args.sample or args.set) and kind.replace("-", "").isalpha():
        print(template(kind, args.units or "us"), end="")
    else:
        print(case_of(args).toml(), end="")
