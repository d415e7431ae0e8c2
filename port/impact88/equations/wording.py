"""Say in words of mechanics what a program with an edited statement does."""

import re
from collections.abc import Mapping
from functools import cache

from ..names import RESULTS, SCENE
from .spelling import (
    NEGATIVE,
    Expression,
    Spelling,
    format_expression,
    operands,
    spellings,
)

Sides = tuple[Expression, ...]

_DIRECTIONS = ("normal", "tangential", "across")  # come before what they belong to
_BODY = re.compile("(?:of|from) [AB]")
_CONDITIONS = ("==", "<", "<=", ">", ">=")
_COLUMNS = {
    "E": "e",
    "MU": "MU",
    "EM": "e_m",
    "DA": "A's arm",
    "DB": "B's arm",
    "GA": "the angle Γ",
    "PA": "A's angle φ",
    "PB": "B's angle φ",
    "TA": "A's heading θ",
    "TB": "B's heading θ",
    "MA": "A's mass",
    "MB": "B's mass",
    "IA": "A's inertia",
    "IB": "B's inertia",
    "UX": "A's initial velocity along x",
    "UY": "A's initial velocity along y",
    "VX": "B's initial velocity along x",
    "VY": "B's initial velocity along y",
    "WA": "A's initial spin",
    "WB": "B's initial spin",
    "VAX": "A's final velocity along x",
    "VAY": "A's final velocity along y",
    "VBX": "B's final velocity along x",
    "VBY": "B's final velocity along y",
    "WAF": "A's final spin",
    "WBF": "B's final spin",
    "Pn": "the normal impulse",
    "Pt": "the tangential impulse",
    "Pm": "the moment",
    "T": "the moment",
    "Px": "the impulse along x",
    "Py": "the impulse along y",
    "c": "the cosine of Γ",
    "s": "the sine of Γ",
    "ia": "A's inertia",
    "ib": "B's inertia",
    "da": "A's arm",
    "db": "B's arm",
    "em": "e_m",
    "mu": "the friction coefficient",
    "ga": "the angle Γ",
    "pa": "A's angle φ",
    "pb": "B's angle φ",
    "ta": "A's heading θ",
    "tb": "B's heading θ",
}
"""Name -> what it is called."""
assert set(SCENE) - {"M"} <= _COLUMNS.keys()


def subject_words(subject: str) -> str:
    """Return a statement's subject as a phrase: "arm, of A, normal" as "the normal arm of A"."""
    head, *rest = subject.split(", ")
    lead = [part for part in rest if part in _DIRECTIONS]
    body = [part for part in rest if _BODY.fullmatch(part)]
    other = [part for part in rest if part not in (*lead, *body)]
    if head.startswith("Equation"):
        return f"the {', '.join(rest)} equation ({head})" if rest else head
    head = head.removeprefix("the ")
    if lead == ["across"]:
        head, lead = f"{head} across (normal with tangential)", []
    words = " ".join([*lead, head, *body])
    words = re.sub(r"\bbefore\b(?! the)", "before the impact", words)
    phrase = " ".join([f"the {words}", *(other if other[:1] != ["the share of e_m"] else [])])
    return phrase if other[:1] != ["the share of e_m"] else "the moment's share (from e_m)"


@cache
def _names(title: str) -> Mapping[str, str]:
    """Return what the names of a spelling are called."""
    names = {}
    for statement in spellings()[title].statements:
        if statement.target and statement.target not in (*SCENE, *RESULTS):
            names[statement.target] = subject_words(statement.subject)
    return names | _COLUMNS


def name_words(node: Expression, spelling: Spelling) -> str:
    """Return what a name is called, with the name behind it, or an expression as it is written."""
    if isinstance(node, str):
        words = _names(spelling.title).get(node, "")
        if node in _COLUMNS and words in (node, "e", "e_m"):
            return words
        return f"{words} ({node})" if words else node
    if isinstance(node, tuple) and node[0] == "**" and isinstance(node[1], str):
        return f"the square of {name_words(node[1], spelling)}"
    match node:
        case ("where", "point", int() as value, str(name)):
            return f"{name_words(name, spelling)}, {value} for point masses,"
    return format_expression(node)


def change_words(correct: Sides, actual: Sides, spelling: Spelling) -> str:
    """Return what was done to a statement's sides."""
    if len(correct) != len(actual):
        return "another rule is followed"
    changes = [pair for pair in zip(correct, actual, strict=True) if pair[0] != pair[1]]
    return " and ".join(_change(a, b, spelling) for a, b in changes) or "nothing is changed"


def _change(correct: Expression, actual: Expression, spelling: Spelling) -> str:
    """Return what turns one expression into another, said of the smallest part that differs."""
    here = _named_change(correct, actual, spelling)
    if here:
        return here
    is_same = isinstance(correct, tuple) and isinstance(actual, tuple) and correct[0] == actual[0]
    if is_same and len(correct) == len(actual):
        parts = zip(operands(correct), operands(actual), strict=True)
        changed = [(a, b) for a, b in parts if a != b]
        if len(changed) == 1:
            return _change(*changed[0], spelling)
        if len(changed) == 2 and changed[0] == changed[1][::-1]:
            one, other = (name_words(x, spelling) for x in changed[0])
            return f"{one} and {other} are exchanged"
    what = "the condition " if isinstance(correct, tuple) and correct[0] in _CONDITIONS else ""
    return f"{what}{format_expression(actual)} stands for {format_expression(correct)}"


def _named_change(correct: Expression, actual: Expression, spelling: Spelling) -> str:
    """Return a change that has a name of its own, "" where it has none."""
    # not split: the first of these names that fits is taken, in this order
    # not split: one table, a line a name; of two that fit the first is meant

    def words(node: Expression) -> str:
        return name_words(node, spelling)

    def term(node: Expression) -> str:
        has_name = words(node) != format_expression(node)
        return words(node) if has_name or isinstance(node, str) else f"the term {words(node)}"

    match correct, actual:
        case (int() | float(), (operation, inner)) if operation == NEGATIVE and inner == correct:
            return "the sign is wrong"
        case (_, (operation, inner)) if operation == NEGATIVE and inner == correct:
            return f"{term(correct)} has the wrong sign"
        case ((operation, int() | float() as inner), _) if (operation, inner) == (NEGATIVE, actual):
            return "the sign is wrong"
        case ((operation, inner), _) if operation == NEGATIVE and inner == actual:
            return f"{term(inner)} has the wrong sign"
        case (("+", a, b), ("-", c, d)) | (("-", a, b), ("+", c, d)) if (a, b) == (c, d):
            return f"{term(b)} has the wrong sign"
        case (("+" | "-", a, b), _) if actual in (a, b) and isinstance(a, int | float):
            return f"{format_expression(actual)} stands for {format_expression(correct)}"
        case (("+" | "-", a, b), _) if actual == a:
            return f"{words(b)} is left out"
        case (("+" | "-", a, b), _) if actual in (b, (NEGATIVE, b)):
            return f"{words(a)} is left out"
        case (("*", a, b), _) if actual in (a, b):
            return f"the factor {words(b if actual == a else a)} is left out"
        case (("/", a, b), _) if actual == a:
            return f"{words(a)} is not divided by {words(b)}"
        case (("/", a, b), _) if actual == ("/", b, a):
            return f"{words(correct)} is inverted"
        case (("/", a, b), _) if actual == ("*", a, b):
            return f"{words(a)} is multiplied by {words(b)}, not divided by it"
        case (("*", a, b), _) if actual == ("/", a, b):
            return f"{words(a)} is divided by {words(b)}, not multiplied by it"
        case (("**", a, 2), _) if actual == a:
            return f"{words(a)} is not squared"
        case (("**", a, 2), _) if actual == ("*", 2, a):
            return f"{words(a)} is doubled, not squared"
        case (_, ("*", 2, a)) if a == correct:
            return f"{words(correct)} is doubled"
        case (_, ("/", a, 2)) if a == correct:
            return f"{words(correct)} is halved"
        case (_, ("**", a, 2)) if a == correct:
            return f"{words(correct)} is squared"
        case (_, ("/", 1, a)) if a == correct:
            return f"{words(correct)} is inverted"
        case (_, ("abs", a)) if a == correct:
            return f"{words(correct)} loses its sign"
        case (_, ("single", a)) if a == correct:
            return f"{words(correct)} is rounded to single precision"
        case (_, ("degrees", a)) if a == correct:
            return f"{words(correct)} is in degrees"
        case (("sin", a), ("cos", b)) if a == b:
            return f"the cosine of {words(a)} stands for the sine"
        case (("cos", a), ("sin", b)) if a == b:
            return f"the sine of {words(a)} stands for the cosine"
        case (("where", "point" as p, a, b), ("where", q, x, y)) if (p, a, b) == (q, y, x):
            return "what point masses (M = 4) and all others have is exchanged"
        case (("where", p, a, b), ("where", q, x, y)) if (p, a, b) == (q, y, x):
            return f"the two cases of {words(p)} are exchanged"
        case (("where", p, a, b), _) if actual in (a, b):
            holds = "always" if actual == a else "never"
            return f"the case of {words(p)} is {holds} taken ({format_expression(actual)})"
        case (str(), str()):
            return f"{words(actual)} stands for {words(correct)}"
        case ("point", 0 | False):
            return "point masses (M = 4) are not told from bodies"
        case ("point", True):
            return "all bodies are taken for point masses"
        case (str(), 0):
            return f"{words(correct)} is left out"
    return ""
