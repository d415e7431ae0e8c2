"""A case: what a file, a published run, a form or a mapping says of a collision, resolved once.

Every door (a command, the desk, a table's scene, a function for Python) takes a case and asks it
for what it needs. A case keeps each entry's text as it was written, and is not changed:
`Case.replaced` makes the case of the edited file, and nothing else makes another one. So
``COMMAND FILE --set K=V`` is ``COMMAND FILE'`` where the line was edited, for every command and
every kind of value.
"""

from __future__ import annotations

import math
from collections import namedtuple
from collections.abc import Mapping
from contextlib import suppress
from types import MappingProxyType

from ..errors import BEYOND_DOUBLES, UserError, quoted
from ..names import DEFAULT_M, NO_AMOUNTS, quantity
from .doubles import BARE, double, is_number

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Self

VALUE_LIMIT = 70
"""The longest value: three of them and their commas fit the 239 characters INPUT keeps."""
OWN_AXES = {"A": ("CAF", "CAL"), "B": ("CBF", "CBL")}
"""The contact point in each vehicle's own axes, in place of DA PA and DB PB."""
OWN_NAMES = ("CAF", "CAL", "CBF", "CBL", "LA", "BA", "LB", "BB")
"""What a file may have in place of values of a scene, to estimate them, or to draw by."""
SOURCE = "_source"
"""The end of an entry that says where a value comes from: UX_source = "event data recorder"."""
RANGES = ("..", "+-", "±", "+/-", "uniform", "triangular", "normal")
"""What marks a value known within limits."""
ESTIMATE = "estimate"
"""What stands for a yaw inertia that is not known (`collision.estimates`)."""
TOLERANCES = ("+-", "±", "+/-")
"""What begins a tolerance around the value that stands there already."""
ABOUT = ("title", "case", "correlations", "units", "axes", "headings")
"""Entries that say something of the whole file."""
_SIZES = frozenset(("LA", "BA", "LB", "BB"))
_MOVES = ("CX", "CY")


class Entry(namedtuple("Entry", "name text kind unit base source")):
    """One value of a case: its ``text`` as written; the ``kind``: value, range, tolerance, share
    (of the critical friction) or estimate; the ``unit`` it is written in, its system's for a bare
    number, "" where there is none; ``base``: the text in base units and the listing's axes;
    ``source``: where it comes from, in the file's words."""

    __slots__ = ()


class Case:
    """What is said of a collision, see the module.

    Parameters
    ----------
    texts
        The entries by name, as written: values, ``title``, ``case``, ``units``, ``axes``,
        ``headings``, ``correlations``, and NAME_source.
    source
        What messages call the file.
    units, axes, headings
        What holds where the texts do not say (``--units``, ``--axes``, ``--headings``).
    single
        Take the middle of each value known within limits.

    Attributes
    ----------
    values : dict
        By name, in base units and in the listing's axes, texts of numbers, of limits or of shares
        of the critical friction; inertias estimated, the contact point as DA PA DB PB (CAF CAL CBF
        CBL where they are known within limits), M = 6 where it is not given.
    system : System
        The units and directions that values are shown in.
    estimated : dict
        How each estimate was found.
    outlines : dict
        LA BA LB BB, in base units.
    remarks : dict
        By name, how entries were understood, and what of them is hardly meant.

    Raises
    ------
    UserError
        For a text that is not an amount, a unit of something else, bare numbers among amounts with
        units where no system is named, and half of what belongs together.
    """

    def __init__(
        self,
        texts: Mapping[str, str],
        source: str = "scene",
        units: str | None = None,
        axes: str | None = None,
        headings: str | None = None,
        single: bool = False,
    ) -> None:
        from .units import convention_named, in_listing_axes, system_of

        check_mapping(texts)
        if not isinstance(source, str):
            raise UserError(f"source is {quoted(source)}; expected what messages call the scene")
        for name, text in texts.items():
            if not isinstance(text, str):
                raise UserError(f"{name} is {text!r}; expected the number's text", source)
        self.texts: Mapping[str, str] = MappingProxyType(dict(texts))
        self.source, self.is_single = source, single
        self._options = (units, axes, headings)
        self._places: dict[str, str] = {}
        given = {n: t for n, t in texts.items() if t.strip() and not n.endswith(SOURCE)}
        self.sources = {n.removesuffix(SOURCE): t for n, t in texts.items() if n.endswith(SOURCE)}
        for name in self.sources:
            if name not in texts:
                raise UserError(f"{name}{SOURCE} is given, and {name} is not", source)
        self.given: Mapping[str, str] = MappingProxyType(given)
        self.title, self.case = given.get("title"), given.get("case")
        self.correlations = given.get("correlations", "")
        axes, headings = given.get("axes", axes), given.get("headings", headings)
        convention = convention_named(axes, headings, source)
        amounts = {n: t for n, t in given.items() if n not in ABOUT or n == "units"}
        based, self.units = in_base_units(amounts, source, units)
        self.system = system_of(self.units)
        if convention:
            self.system = self.system._replace(convention=convention)
        if convention:
            based = in_listing_axes(based, self.system, source)
        self._based: Mapping[str, str] = MappingProxyType(dict(based))
        self.estimated: dict[str, str] = {}
        self.outlines: dict[str, float] = {}
        self.remarks: dict[str, str] = {}
        self.values = {**based, "M": based.get("M", DEFAULT_M)}
        self._resolve()

    def _resolve(self) -> None:
        """Take middles, estimate inertias, and place the contact point."""
        values, source = self.values, self.source
        uncertain = [name for name, text in values.items() if is_range(text)]
        if self.units or uncertain:
            from .units import nominal, remarks

            self.remarks |= remarks(self.given, self.units)
        for name in uncertain if self.is_single else ():
            values[name] = nominal(name, values[name], source)
            self.remarks[name] = f"{name} = {self.given[name]}: its middle is used"
        if not _SIZES.isdisjoint(values) or any(
            values.get(name, "").startswith(ESTIMATE) for name in ("IA", "IB")
        ):
            from .estimates import with_estimates
            from .units import nominal

            values, self.estimated, self.outlines = with_estimates(values, source, self.units)
            for name, rule in self.estimated.items():
                self.remarks[name] = f"{name} = {values[name]} is estimated: {rule}"
            for name in self.estimated if self.is_single else ():
                values[name] = nominal(name, values[name], source)
        self.values = _with_contact_point(values, source)
        self._remark()

    def _remark(self) -> None:
        """Add remarks on what is hardly meant."""
        from . import plausibility

        numbers: dict[str, float] = {}
        for name, text in self.values.items():
            if is_number(text):
                numbers[name] = double(text)
            elif is_range(text) and not self.is_single:
                from .units import nominal

                with suppress(ValueError):  # whoever reads the entry says what is wrong
                    numbers[name] = double(nominal(name, text, self.source))
        found = plausibility.remarks(numbers, self.given, self.system, self.outlines)
        for name, text in found.items():
            known = self.remarks.get(name)
            self.remarks[name] = f"{known}; {text}" if known else text

    def __repr__(self) -> str:
        return f"Case({dict(self.texts)!r}, {self.source!r})"

    @property
    def entries(self) -> dict[str, Entry]:
        """The values, each with its text, kind, unit, base-unit value and source note."""
        return {
            name: Entry(
                name,
                text,
                kind_of(name, text),
                self._unit(name, text),
                self._based[name],
                self.sources.get(name, ""),
            )
            for name, text in self.given.items()
            if name not in ABOUT
        }

    def _unit(self, name: str, text: str) -> str:
        from .units import units_in

        written = [unit for unit, _ in units_in(name, text)]
        try:
            return written[0] if written else self.system.unit(name)
        except KeyError:
            return ""

    def replaced(self, changes: Mapping[str, str], where: str | None = None) -> Self:
        """Return the case of the edited file.

        Parameters
        ----------
        changes
            Name -> text as a file may have it; an empty text takes the entry out; one that begins
            with ``+-`` is around the value that stands there.
        where
            What messages call the changes, such as ``--set``.
        """
        from .units import middle_of, units_in

        texts, typed = dict(self.texts), {}
        for name, text in changes.items():
            if isinstance(text, str) and text.strip().startswith(TOLERANCES):
                before = self.given.get(name) or ("0" if name in _MOVES else "")
                middle = middle_of(name, before, self.system, self.source) if before else ""
                if middle and units_in(name, text) and not units_in(name, middle):
                    middle += f" {self.system.unit(name)}"
                text = f"{middle} {text.strip()}".strip()
            typed[name] = text
            texts.pop(name + SOURCE, None)
            if isinstance(text, str) and not text.strip():
                texts.pop(name, None)
            else:
                texts[name] = text
        place = where or self.source
        amounts = {n: t for n, t in typed.items() if n not in ABOUT and not n.endswith(SOURCE)}
        for name, text in amounts.items():
            if not isinstance(text, str):
                raise UserError(f"{name} is {text!r}; expected the number's text", place)
        in_base_units(amounts, place, texts.get("units") or self.units)
        return self._edited(texts, {**self._places, **dict.fromkeys(typed, place)})

    def _edited(
        self, texts: Mapping[str, str], places: Mapping[str, str], single: bool | None = None
    ) -> Self:
        """Return the case of other texts; ``places``: what messages call what was changed."""
        units, axes, headings = self._options
        single = self.is_single if single is None else single
        case = type(self)(texts, self.source, units, axes, headings, single)
        case._places = dict(places)
        return case

    def place(self, name: str) -> str:
        """Return what messages call the place where a value was given: the file, or an option."""
        return self._places.get(name, self.source)

    def noted(self, notes: Mapping[str, str]) -> Self:
        """Return this case with notes on where values come from."""
        texts = {**self.texts, **{name + SOURCE: text for name, text in notes.items()}}
        return self._edited(texts, self._places)

    def shown_in(
        self, units: str | None, axes: str | None = None, headings: str | None = None
    ) -> Self:
        """Return this case with its numbers rewritten in another system, other directions; what is
        None stays. Raises UserError."""
        if not (units or axes or headings):
            return self
        asked = {"units": units, "axes": axes, "headings": headings}
        about = {name: text for name, text in asked.items() if text}
        there = type(self)({**self.about, **about}, self.source)
        based = {name: text for name, text in self._based.items() if is_number(text)}
        return type(self)({**self.texts, **there.written(based), **about}, self.source)

    def single(self) -> Self:
        """Return this case with the middle of each value known within limits."""
        if self.is_single:
            return self
        return self._edited(self.texts, self._places, single=True)

    def written(self, values: Mapping[str, float | str]) -> dict[str, str]:
        """Return texts as this case would have them for values in base units and the listing's
        axes: bare numbers of its system, in its directions."""
        from .units import shown_text

        texts = {n: v if isinstance(v, str) else repr(v).upper() for n, v in values.items()}
        return {name: shown_text(name, text, self.system) for name, text in texts.items()}

    @property
    def named_units(self) -> str | None:
        """The system that the file or an option names; None where it only follows from units."""
        return self.units if "units" in self.given or self._options[0] else None

    @property
    def about(self) -> dict[str, str]:
        """The entries on the whole file, options included, as a file has them."""
        _, axes, headings = self._options
        options = {"units": self.named_units, "axes": axes, "headings": headings}
        texts = {name: self.given.get(name) or options.get(name) or "" for name in ABOUT}
        return {name: text for name, text in texts.items() if text}


def kind_of(name: str, text: str) -> str:
    """Return what kind of entry a text is: value, range, tolerance, share or estimate."""
    words = text.strip()
    if words.startswith(ESTIMATE):
        return ESTIMATE
    if name in ("MU", "MUP") and "%" in words and is_share_text(words):
        return "share"
    if any(mark in words for mark in TOLERANCES):
        return "tolerance"
    return "range" if is_range(words) else "value"


def case_of(values: object) -> Case | None:
    """Return the case that a scene was made of, whose values are in base units already; None for
    any other mapping."""
    case = getattr(values, "case", None)
    return case if isinstance(case, Case) else None


def is_share_text(text: str) -> bool:
    """Return whether a friction is a share of the critical one: "85 %", "80 .. 90 %", but not
    ".8 +- 5 %", whose percentage is its tolerance."""
    head = text
    for mark in TOLERANCES:
        head = head.partition(mark)[0]
    return "%" in head


def is_share(text: object) -> bool:
    """Whether MU is a share of the critical friction, such as ``85 %``."""
    return isinstance(text, str) and text.endswith("%") and not is_range(text)


def is_range(text: str) -> bool:
    """Return whether a text is a value known within limits, estimates excepted."""
    return any(mark in text for mark in RANGES) and not text.startswith(ESTIMATE)


def check_mapping(values: object) -> None:
    """Raises UserError for what is not a mapping of names, such as the name of a file."""
    if not isinstance(values, Mapping) or not all(isinstance(name, str) for name in values):
        hint = ", such as impact88.Scene.from_toml(...)" if isinstance(values, str) else ""
        raise UserError(f"{quoted(values)}: expected a mapping of names to values{hint}")


def check_value(name: str, text: str, source: str | None) -> str:
    """``text`` if INPUT would take it for a number; ``name`` is any table's. Raises UserError."""
    if not isinstance(text, str):
        raise UserError(f"{name} is {text!r}; expected the number's text", source)
    if not is_number(text):
        raise UserError(
            f"{name} = {text!r} is not a number; expected one such as 1.5 "
            f"({quantity(name).meaning})",
            source,
        )
    if len(text) > VALUE_LIMIT:
        raise UserError(f"{name} has more than {VALUE_LIMIT} characters", source)
    return text


def in_base_units(
    texts: Mapping[str, str], source: str, units: str | None = None
) -> tuple[dict[str, str], str | None]:
    """The texts in base units (`collision.units`), and the system's name; as they are where no
    value, nor the entry ``units``, nor ``units`` names any. Raises UserError."""
    if units is None and all(BARE.issuperset(texts[n]) for n in texts if n not in NO_AMOUNTS):
        return dict(texts), None
    from .units import in_base

    return in_base(texts, source, units)


def _with_contact_point(values: dict[str, str], source: str) -> dict[str, str]:
    """The values with DA PA or DB PB worked out from CAF CAL or CBF CBL, forward and to the left of
    the center of gravity. Within limits they stay, for `collision.geometry.moved`."""
    for vehicle, names in OWN_AXES.items():
        absent = [name for name in names if name not in values]
        if len(absent) == len(names):
            continue
        if absent:
            raise UserError(f"{absent[0]} is missing beside {' '.join(names)}", source)
        both = [name for name in (f"D{vehicle}", f"P{vehicle}") if name in values]
        if both:
            raise UserError(f"{both[0]} and {names[0]} are both given; expected one pair", source)
        if any(is_range(values[name]) for name in names):
            continue
        forward, left = (double(check_value(name, values.pop(name), source)) for name in names)
        distance = math.hypot(forward, left)
        if math.isinf(distance):
            raise UserError(f"{' '.join(names)}: {BEYOND_DOUBLES}", source)
        values[f"D{vehicle}"] = repr(distance).upper()
        values[f"P{vehicle}"] = repr(math.degrees(math.atan2(left, forward))).upper()
    return values
