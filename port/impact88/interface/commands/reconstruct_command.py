"""The file is flat TOML with the listing's names, like a scene (impact88 scene --help): whatever
is not known is left out, or left empty, and is solved for. The masses MA MB must be known; of the
geometry (GA; with M = 6 DA DB PA PB TA TB IA IB) what the results need: momentum of point masses (M
= 4) needs none, and a result that needs more is left out and names it. Then any of

  before         UX UY WA VX VY WB (x, y, spin), or SA HA SB HB (speed, course)
  after          VAX VAY WAF VBX VBY WBF, or SAF HAF SBF HBF
  coefficients   E, EM and MU or MUP
  changes        DVA DVB; along and across the vehicle DVAF DVAR DVBF DVBR
  directions     PDOFA PDOFB
  at C           VC VS: closing and separation speed along the normal
  energies       KI KF, EL (lost, as in crush; or ELA and ELB, which sum to it), LOSS (percent) or
                 DT (fraction)

Each is a number, exact, or known within limits: "41 +- 2", "0.7 .. 0.9", "normal 41 1.5" (impact88
bounds --help). Equations 13 to 18 always hold. With more known than needed the values with limits
are adjusted (adjustment of observations with conditions, weighted by their tolerances). --full
shows each as measured, as adjusted, and how many tolerances it moved, with three estimates of
uncertainty: first order, random draws, bounds that are attained. NOT FOUND names what the known
values leave open, and what to give; --outputs asks for some names only.

MU is the magnitude entered on line 280; friction opposes the sliding (line 400). Where the
velocities before impact are unknown, both signs are tried and every self-consistent solution is
shown. MUP is the signed P_t/P_n instead. Units: any consistent set; angles in degrees, spins in rad
per unit of time; or values with units, "-25 +- 2 mph", "3091 lb", "3.5 ft", or units = "us" (or
metric, chapter, si) in the file, for bare numbers: results are then in the same units. A yaw
inertia that was not measured is IA = "estimate +- 20%" (impact88 scene --help says from what).
PDOF: where the force comes from, clockwise from the vehicle's front (A faces TA + 180, B faces TB;
TA = "course" is the way A travels). Vehicles locked together have E = 0 and MU = "locked". Point
masses that move along one line need no GA, and nothing acts across it. A GA that has A on the other
side of the contact plane is turned, with a remark.
A vehicle that skids to rest: SAF = "skid 62 ft at 0.7 +- .05" is the speed v = sqrt(2 MU g D).

EM sets the moment at C (Equation 18). RR0 in the results is the fraction of the relative spin that
remains after the contact moment acts, compared with the relative spin the impulse alone would
produce. EM = 0: RR0 = 0 (equal spins). EM = -1: RR0 = 1/3 (not reversed). EM = +1: RR0 = 1 (no
moment). Typical values, fitted to eleven staged collisions (Table 2, Section V; speed changes and
energy lost depend little on EM):

  E     0 to .26, half of them below .075
  EM    near -.5 front to front and front to rear; -.43 to -.91 front to side
  MU    .55 to .91 where the vehicles slide (front to side); .07 or less, nearly direct impacts

examples:
  impact88 reconstruct --template -o after.toml         a file to fill in
  impact88 reconstruct after.toml                       speeds before, delta-V, what they depend on
  impact88 reconstruct after.toml --full                all results with their intervals
  impact88 reconstruct after.toml --set E=.1            a value changed
  impact88 reconstruct after.toml --set VAX="+- 2"      known within 2
  impact88 reconstruct after.toml --set E= --set MU=    both unknown
  impact88 reconstruct after.toml --outputs UX,VY       these only
  impact88 reconstruct after.toml --write-scene found.toml
  impact88 reconstruct after.toml --contact-time .15 --json

exit status: 0 solved, or in part: NOT FOUND names the rest; 1 NO IMPACT that physics allows agrees,
known values contradict one another, or no velocity before the impact was found; 2 bad input, or a
result of --outputs or --write-scene that is not determined
"""

import sys
from math import isclose

from ...casework.reconstruction.answer import Answer, answers
from ...collision.case import OWN_AXES, OWN_NAMES, SOURCE, Case, remark_lines
from ...collision.scenefile import template
from ...collision.uncertain import skid_remarks
from ...errors import UserError, note
from ...files import replacing
from ...mechanics.state import KNOWABLE, QUANTITIES
from ...messages.progress import progress
from ...names import SCENE
from . import options

ARGUMENTS = (
    options.names_option("--outputs", "solve for these only; others may stay unknown"),
    *options.draws(
        20_000, meaning="random draws of values known within limits; 0: neither draws nor bounds"
    ),
    options.flag("--full", "print every result with its intervals, not the answer alone"),
    options.writes("--write-scene", "FILE", "write the impact found as a scene file"),
    *options.SOLUTION,
    options.sample_option("start from the scene of a published run"),
)


def main(args: options.Args) -> int:
    output_names = options.names_given(args.outputs, QUANTITIES, "--outputs") or None
    case = options.known_case(args, KNOWABLE)
    known = options.read_known(case, KNOWABLE)
    settings = (args.samples, args.seed, output_names, args.contact_time)
    remarks = [*remark_lines(case.remarks), *skid_remarks(case.values)]
    with progress(None, "reconstruct") as meter:
        found = options.answers_of(args, lambda: answers(known, *settings, meter.update, remarks))
    if args.write_scene:
        _write_scene(found, args, case)
    full = bool(args.full or output_names or args.contact_time)
    status = options.show_answers(args, found, case.system, full)
    if not (full or args.json) and sys.stderr.isatty():
        note("reconstruct", "--full prints velocities, impulses, energies and their intervals")
    return status


def _write_scene(found: list[Answer], args: options.Args, case: Case) -> None:
    """Write the impact found as a scene: what was known as it was typed, unless it was adjusted."""
    if len(found) > 1:
        raise UserError(f"{len(found)} impacts agree with what is known; expected one")
    solution = found[0].solution
    values = solution.scene()
    adjustable = {
        item.name
        for item in solution.adjusted
        if not isclose(item.adjusted, item.measured, rel_tol=1e-9)
    }
    fixed_names = {n for n in case.given if n in (*SCENE, *OWN_NAMES) and n not in adjustable}
    own_axes = {kind + v for v, axes in OWN_AXES.items() if axes[0] in case.given for kind in "DP"}
    initial = {
        n: value for n, value in values.items() if n not in fixed_names | own_axes and n != "M"
    }
    notes = {n: t for n, t in case.texts.items() if n.removesuffix(SOURCE) in fixed_names}
    title = f"Reconstructed from {options.source_of(args) or '--set'}"
    texts = {**case.about, "title": title, **notes, **case.display_texts(initial)}
    texts.setdefault("M", "4" if values["M"] == 4 else "6")
    with replacing(args.write_scene) as file:
        file.write(template(Case(texts, args.write_scene)))
    print(f"scene written to {args.write_scene}", file=sys.stderr)
