"""How much a program computes of every scene."""

WEIGHTS = {
    **dict.fromkeys(("RESULT", "RESULT_OR_INFINITE", "BITS"), 0),
    **dict.fromkeys(("AGAINST", "CHOOSE"), 3),
    "SINE_AND_COSINE": 26,
}
"""Passes over the scenes that numpy makes for an operation, where they are not one."""


def passes(program):
    """Of a program's steps, but for what is the same for all scenes and what every result takes."""
    return sum(WEIGHTS.get(name, 1) for name, _ in program.steps[program.once :])
