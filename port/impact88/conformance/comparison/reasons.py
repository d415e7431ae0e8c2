"""The reasons why a row of a table does not count as agreeing, in words."""

AGREEMENT = ""
DISAGREES = "a number differs"
UNREADABLE = "the row could not be read"
NO_RESULT = "no result on either side: theirs refuses, and so does the mathematics"
REFUSED = "theirs refuses a vector of the class failure, as it may"
NO_SCENE = (
    "theirs gives numbers although a mass or a moment of inertia is not positive; "
    "a program leaves the cells empty"
)
NOTHING_HERE = "theirs gives numbers where the equations have no solution"
NOTHING_THERE = "theirs gives nothing where there is a result"
NO_DIGIT = "a number shares no digit with ours, where rounding or the digits written leave none"

# of the answers to a kit
PARTIAL = "theirs gives some of the results and leaves others out"
CHANGED = "the inputs are not the vector's"
REPEATED = "the id has occurred before"
STRAY = "the id is none of the kit's"
MISSING = "the table has no row with the vector's id"

REASONS = (
    AGREEMENT,
    DISAGREES,
    UNREADABLE,
    NO_RESULT,
    NO_SCENE,
    NOTHING_HERE,
    REFUSED,
    NO_DIGIT,
    NOTHING_THERE,
    PARTIAL,
    CHANGED,
    REPEATED,
    STRAY,
    MISSING,
)
HARMLESS = (NO_RESULT, REFUSED)
"""Reasons that are no fault of the program."""


def describe(reason: str, rows: int, places: str = "") -> str:
    """Return how many rows were refused, are missing or were not compared, and why; ``places``:
    which ones, in brackets."""
    word = "refused" if reason in HARMLESS else "missing" if reason == MISSING else "not compared"
    return f"{rows} row{'s' if rows != 1 else ''} {word}{places}: {reason}"
