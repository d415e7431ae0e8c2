"""impact88: Brach's 1988 planar impact program, digit for digit, and the same mechanics made fast.

A scene is a mapping of the listing's names (`names.SCENE`) to values: texts for functions that
compute as the Apple did, because the digits typed matter, numbers or arrays for those in double
precision. Results have the names of `names.RESULTS`.

The 1988 program
    Scene, sample       a scene as typed, or that of a published run
    run, Run            the program on a scene, as an Apple II Plus prints it
    replay, Replay      the same arithmetic over arrays of scenes, bit for bit
    Applesoft           the Apple II Plus, for any Applesoft program

Old printouts and other programs
    verify, Verification    check a printout against the program's own, explain what differs
    oracle              complete reference results of scenes, to check other programs with
    compare, Comparison, Cause      another program's table compared with the reference

Today's work, in double precision
    solve               final velocities and the rest, over arrays
    prepared, Prepared      the same for many short calls: root finders, samplers
    evaluate            what follows from any quantities that are known of an impact
    Amount              a value, exact or known within limits
    bounds, Bounds      results of a scene known within limits
    solve_for, Solution     Equations 13-18 for any unknowns, over arrays
    reconstruct, Reconstruction     the same with tolerances: what is known is adjusted
    colinear, colinear_inverse, barrier, delta_v    the chapter's other problems

    accelerated         the processor's instructions that `solve` uses, None if it uses numpy only
    names, status       the tables of names and of STATUS's bits
    UserError           raised for input that cannot be used

Each is imported on first use, so that running the 1988 program does not import numpy.
"""

from importlib import import_module

from .version import __version__

TYPE_CHECKING = False
if TYPE_CHECKING:
    from . import names as names
    from . import status as status
    from .apple.emulator.emulator import Applesoft as Applesoft
    from .cases.amounts import Amount as Amount
    from .chapter.barrier import barrier as barrier
    from .chapter.colinear import colinear as colinear
    from .chapter.colinear import colinear_inverse as colinear_inverse
    from .chapter.deltav import delta_v as delta_v
    from .comparison.compare import compare as compare
    from .comparison.oracle import oracle as oracle
    from .comparison.types import Cause as Cause
    from .comparison.types import Comparison as Comparison
    from .errors import UserError as UserError
    from .library import accelerated as accelerated
    from .mechanics.solve import Prepared as Prepared
    from .mechanics.solve import evaluate as evaluate
    from .mechanics.solve import prepared as prepared
    from .mechanics.solve import solve as solve
    from .printouts.findings import Verification as Verification
    from .printouts.sources import verify as verify
    from .program.replay import Replay as Replay
    from .program.replay import replay as replay
    from .program.run import Run as Run
    from .program.run import run as run
    from .program.scene import Scene as Scene
    from .program.scene import sample as sample
    from .reconstruction.answer import Reconstruction as Reconstruction
    from .reconstruction.answer import reconstruct as reconstruct
    from .reconstruction.bounds import Bounds as Bounds
    from .reconstruction.bounds import bounds as bounds
    from .reconstruction.unknowns import Solution as Solution
    from .reconstruction.unknowns import solve_for as solve_for

_LAZY = {
    name: place
    for place, names_there in {
        "": "names status",
        "cases.amounts": "Amount",
        "chapter.barrier": "barrier",
        "chapter.colinear": "colinear colinear_inverse",
        "chapter.deltav": "delta_v",
        "comparison.compare": "compare",
        "comparison.oracle": "oracle",
        "comparison.types": "Cause Comparison",
        "apple.emulator.emulator": "Applesoft",
        "errors": "UserError",
        "library": "accelerated",
        "mechanics.solve": "Prepared evaluate prepared solve",
        "program.run": "Run run",
        "reconstruction.answer": "Reconstruction reconstruct",
        "reconstruction.bounds": "Bounds bounds",
        "reconstruction.unknowns": "Solution solve_for",
        "program.replay": "Replay replay",
        "printouts.findings": "Verification",
        "printouts.sources": "verify",
        "program.scene": "Scene sample",
    }.items()
    for name in names_there.split()
}
"""Public name -> its module, "" for a module of this package. A test compares this table with the
imports above."""

__all__ = [*_LAZY, "__version__"]


if not TYPE_CHECKING:  # a type checker that saw it would accept any name

    def __getattr__(name: str) -> object:
        place = _LAZY.get(name)
        if place is None:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        if not place:
            return import_module(f".{name}", __name__)
        value = getattr(import_module(f".{place}", __name__), name)
        globals()[name] = value  # later lookups are direct
        return value


def __dir__() -> list[str]:
    return sorted(__all__)
