"""A plan for the compiled machine: `plan.Plan` hands numpy one operation at a time; here the same
operations become a program of `impact88.native`, one pass over the scenes."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping

from ..native.formulas import Expression
from ..native.program import Program
from . import degrees, sinetable


class _Circle(ctypes.Structure):
    """What `degrees.sine_and_cosine` works with."""

    _fields_ = (
        ("turn", ctypes.c_void_p),
        *((name, ctypes.c_double) for name in "per_step step shift s0 s1 s2 c1 c2".split()),
        ("steps", ctypes.c_int64),
    )


_CIRCLE = _Circle(
    degrees.table().ctypes.data,
    1 / sinetable.STEP,
    sinetable.STEP,
    sinetable.INTEGER_IN_LOW_BITS,
    *sinetable.POLYNOMIALS,
    sinetable.STEPS,
)
CIRCLE = ctypes.addressof(_CIRCLE)
"""Where the machine finds it."""


def fused(results: Mapping[str, Expression]) -> Program:
    """The program that computes ``results``: no negative zero, and NaN for what is not finite;
    COND alone may be infinite."""
    # the sum of STATUS's bits becomes a whole number as it is written
    shown = {name: e.operands[0] if e.operation == "bits" else e for name, e in results.items()}
    endings = ["BITS" if shown[name] is not e else "RESULT" for name, e in results.items()]
    for number, name in enumerate(results):
        if name == "COND":
            endings[number] = "RESULT_OR_INFINITE"
    return Program(shown, endings)
