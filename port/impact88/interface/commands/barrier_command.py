"""Vehicle A against a rigid barrier that does not move. The file (flat TOML) or --set give what is
known of the vehicle: DA PA TA MA IA, the barrier's GA (angle of its surface from the y axis), and
of UX UY WA (before), VAX VAY WAF (after), E, EM and MU all but at most three; what is left out is
solved for. As everywhere A is on the +n side, n = (cos GA, sin GA): with GA = 0 it drives towards
-x, and TA = 0 then means that it faces the barrier. M = 4 makes it a point mass.

MU is the number of line 280: friction opposes the sliding (line 400); MU = "85 %" is a share of the
friction that just ends it. MUP is the signed P_t/P_n. Units: any consistent set; angles in degrees,
spins in rad per unit of time. PDOF: where the force comes from, clockwise from the vehicle's front.

examples:
  impact88 chapter barrier --set MA=143.5 --set IA=3728 --set DA=7.59 \\
      --set PA=-19.8 --set TA=0 --set GA=-30 --set E=.005 --set MU=.4 \\
      --set EM=-.715 --set UX=-29.04 --set UY=0 --set WA=0
  impact88 chapter barrier --template -o car.toml    a file to fill in
  impact88 chapter barrier car.toml --contact-time .1
  impact88 chapter barrier --units us --set DA=4.14 --set PA=29 --set TA=0 \\
      --set GA=74.6 --set MA=3574.2 --set IA=2336.3 --set E=0 --set EM=1 \\
      --set MU='85.18 %' --set UX=-39.95 --set UY=0 --set WA=0     IIHS test CF11002
  impact88 chapter barrier rebound.toml --set UX= --set UY= --set WA= --json

exit status: 0 solved, or in part; 1 NO IMPACT that physics allows agrees,
or known values contradict one another; 2 bad input
"""

from ...casework.chapter.barrier import BARRIER, BARRIER_AFTER
from ...casework.reconstruction.answer import answers
from ...collision.uncertain import fixed_value
from . import options

KNOWABLE = (
    "E",
    "MU",
    "MUP",
    "EM",
    "DA",
    "GA",
    "PA",
    "TA",
    "MA",
    "IA",
    "M",
    "UX",
    "UY",
    "WA",
    "VAX",
    "VAY",
    "WAF",
)

ARGUMENTS = (*options.SOLUTION, options.sample_option("vehicle A of a published run"))


def main(args: options.Args) -> int:
    values, units = options.known_within_limits(args, KNOWABLE, single=True)
    barrier = BARRIER if "UX" in values else BARRIER | BARRIER_AFTER
    known = values | {n: fixed_value(value) for n, value in barrier.items()}
    found = options.answers_of(args, lambda: answers(known, 0, contact_time=args.contact_time))
    return options.show_answers(args, found, units)
