"""The file is flat TOML with the listing's names, like a scene (impact88 scene --help): whatever
is not known is left out, or left empty, and is solved for. The vehicles and their geometry (DA DB
GA PA PB TA TB MA MB IA IB) must be known; then any of the velocities

  before   UX UY WA   VX VY WB            A, then B; x, y, spin
  after    VAX VAY WAF   VBX VBY WBF

and of the coefficients E, EM and MU. Usual sets of unknowns (Equations 13-18): the six velocities
after; the six before; before of one vehicle with after of the other; three velocities with the
three coefficients; any other set of up to six that the equations determine. One that they do not
is refused with the reason. With fewer unknowns than equations the known values are fitted by least
squares, and the mismatch is told.

MU is the number of line 280: friction opposes the sliding (line 400). Where the velocities before
are unknown, both signs are tried and every solution that agrees with itself is shown. MUP is the
signed P_t/P_n instead. Units: any consistent set; angles in degrees, spins in rad per unit of time.
PDOF: where the force comes from, clockwise from the vehicle's front (A faces TA + 180, B faces TB).

examples:
  impact88 reconstruct --template > after.toml          a file to fill in
  impact88 reconstruct after.toml                       all that the file leaves out
  impact88 reconstruct after.toml --set E=.1            a value changed
  impact88 reconstruct after.toml --set E= --set MU=    two values no longer known
  impact88 reconstruct after.toml --for UX,VY           only these; others may stay unknown
  impact88 reconstruct after.toml --contact-time .15 --json

exit status: 0 solved; 2 bad input, or unknowns that are not determined
"""

from __future__ import annotations

import argparse

from ..errors import UserError
from ..files import called
from ..names import SCENE
from .options import add_solution_arguments, known_values, template

KNOWABLE = (*SCENE, "MUP", "VAX", "VAY", "VBX", "VBY", "WAF", "WBF")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of `impact88 reconstruct`."""
    parser.add_argument(
        "--for",
        dest="wanted",
        metavar="NAMES",
        help="solve for these names only; others may stay unknown",
    )
    add_solution_arguments(parser)


def main(args: argparse.Namespace) -> int:
    """Solve for what is unknown and print every solution."""
    if args.template:
        print(template(KNOWABLE))
        return 0
    if args.file is None and not args.set:
        raise UserError("nothing is known; expected a file, or --set NAME=VALUE")
    known = known_values(args.file, args.set, KNOWABLE)
    wanted = args.wanted.upper().replace(",", " ").split() if args.wanted else None
    from ..reconstruction.solutiontable import show

    show(known, wanted, source_of(args.file), args.contact_time, args.json)
    return 0


def source_of(path: str | None) -> str | None:
    """What errors call the file given."""
    return None if path is None else called(path)
