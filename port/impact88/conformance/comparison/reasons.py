"""The reasons why a row of a table does not count as agreeing, in words."""

AGREEMENT = ""
DISAGREES = "a result disagrees"
UNREADABLE = "the row could not be read"
NO_RESULT = "the table has no result, and there is none"
REFUSED = "the table has no result for a vector of the class failure, which is allowed"
NO_SCENE = (
    "the table has numbers although a mass or a moment of inertia is not positive; "
    "expected empty cells"
)
NOTHING_HERE = "the table has numbers where the equations have no solution; expected empty cells"
NOTHING_THERE = "the table has no result where there is one"
NO_DIGIT = "rounding, or the digits written, leave no digit to compare"

# of the answers to a kit
PARTIAL = "the table has some of the results and lacks others"
CHANGED = "the inputs differ from the vector's"
REPEATED = "the id occurs more than once"
STRAY = "the kit has no vector with this id"
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
