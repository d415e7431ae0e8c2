"""A value of the scene may be known only within limits. In the file, as text, or with --range:

  0.7 .. 0.9             between two values, none preferred
  0.8 +- 0.1             the same by middle and half width; also 143.5 +- 5%
  +- 0.1, +- 5%          the same around the file's value (--set, --range)
  uniform 0.7 0.9        the same as 0.7 .. 0.9
  triangular 0.7 0.75 0.9          lower limit, most likely value, upper limit
  normal 0.8 0.05                  mean and standard deviation
  normal 0.8 0.05 within 0.7 .. 1  the same, cut off at limits

In a file: MU = "0.7 .. 0.9". Correlated values, in the file: correlations = "UX,VX 0.5; MA,IA 0.9"
(the correlation of a Gaussian copula); they shape the draws, not the bounds.

The bounds are the extremes over all inputs within their limits (a normal without limits: --sigmas
standard deviations), searched for at the corners, on faces and inside. Each bound is reached by
actual inputs (in --json), so the true range is at least this wide; it is not proven to be no wider.
The output gives the fraction of draws with each warning; meanings: impact88.status. Units are those
of the scene; angles are in degrees.

CX and CY move the contact point along x and y, in both vehicles at once: --range CX="+- 1". (DA PA
DB PB varied separately would give A and B different contact points.)

--reconstruct goes from final to initial velocities: the file (or --range) gives VAX VAY VBX VBY WAF
WBF and MUP, the signed P_t/P_n; if it gives none, those of the scene's forward solution are taken.

examples:
  impact88 bounds --sample 1 --range MU="0.7 .. 1" --range UX="+- 10%"
  impact88 bounds crash.toml --outputs DVA,DVB,LOSS --samples 1000000 --seed 7
  impact88 bounds --sample 3 --reconstruct --range VBY="normal 41.5 1.5"
  impact88 bounds ranges.toml --correlation UX,VX=0.8 --json
"""

from . import options

ARGUMENTS = (
    *options.EXPLORED,
    options.names_option("--outputs", "the results wanted"),
    options.JSON,
    options.OUTPUT,
)


def main(args: options.Args) -> None:
    from ...casework.uncertainty.boundstable import as_json, table

    result = options.explore(args, args.outputs)
    options.show(args, "bounds", lambda: as_json(result), lambda: [table(result)])
