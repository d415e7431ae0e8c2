"""A case: what a file, a form or a mapping says of one collision, as immutable amounts.

Every command reads its values from a case. It keeps the text of each entry as written, and
`Case.with_` returns the case of the edited file: ``COMMAND FILE --set K=V`` gives what editing that
line of FILE gives."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any

from ..decimals import is_number, to_double, to_text
from ..errors import UserError, quoted
from ..files import display_name, read_text
from ..names import DEFAULT_M, PIVOT, SCENE, did_you_mean, quantity
from .amounts import TOLERANCE, Amount, normalize, read, units_in
from .estimates import SIZES, estimate, is_estimate
from .motion import contact_point, courses, exact_number, plane_across
from .plausibility import implausible
from .scenefile import ABOUT, INPUTS, SOURCE, read_toml, write_toml
from .units import PLAIN, View, is_measured, system_using

COURSE = "course"
LOCKED = "locked"
POINT_DEFAULTS = dict.fromkeys("DA DB PA PB TA TB EM GA E MU WA WB".split(), "0") | {
    "IA": "1",  # line 480 divides by the inertias, of points, too
    "IB": "1",
}
"""Inputs that a scene of point masses need not have, and what is typed in their place."""


@dataclass(frozen=True)
class Case:
    """One collision.

    Made by `Case.load`, `Case.loads` and `Case.of`.

    Parameters
    ----------
    entries : mapping of str to Amount
        Amounts by name, in base units along the listing's axes. A TA or TB that follows a course
        is NaN, with the text "course". M is 6 if it is not given.
    view : View
        Units, axes and headings in which the case is written and its results are shown.
    texts : mapping of str to str
        The digits typed into the 1988 program, by the scene's names: nominal values in base units.
    remarks : tuple of str
        What was assumed, and values that are implausible.
    title, case, examiner, date : str
        Headings of a report.
    written : mapping of str to str
        The entries as written; NAME_source says where a value comes from.
    source : str
        Name of the case in messages.
    sizes : mapping of str to Amount
        LA BA LB BB, in base units.
    derived : tuple of str
        Names of the scene's values that follow from others: estimates, courses, shares, and the
        contact plane across a line.
    omitted : tuple of str
        Names of ``texts`` that are typed though the scene of point masses does not give them.
    places : mapping of str to str
        Places of entries for messages.

    Examples
    --------
    >>> case = Case.loads('units = "us"\\nMA = 3000\\nUX = "30 +- 2"')
    >>> case.entries["UX"].high, case.view.shown("UX", case.entries["UX"].high)
    (46.93333333333333, 32.0)
    >>> case.with_(UX="-25 mph").texts["UX"]
    '-36.666666666666664'
    """

    entries: Mapping[str, Amount]
    view: View = PLAIN
    texts: Mapping[str, str] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    title: str = ""
    case: str = ""
    examiner: str = ""
    date: str = ""
    written: Mapping[str, str] = field(default_factory=dict)
    source: str = "scene"
    sizes: Mapping[str, Amount] = field(default_factory=dict)
    derived: tuple[str, ...] = ()
    omitted: tuple[str, ...] = ()
    places: Mapping[str, str] = field(default_factory=dict, repr=False, compare=False)

    def __post_init__(self) -> None:
        for name, value in vars(self).copy().items():
            if isinstance(value, dict):  # a case does not change
                object.__setattr__(self, name, MappingProxyType(value))

    @classmethod
    def load(cls, path: str, **view: str | None) -> Case:
        """Return the case in a TOML file.

        Parameters
        ----------
        path : str
            The file, ``-`` for standard input.
        **view : str or None
            ``units``, ``axes`` and ``headings`` of a file that names none.

        Raises
        ------
        UserError
            For a file that cannot be read as a case; the message names file, line and entry.
        """
        return cls.loads(read_text(path), display_name(path), **view)

    @classmethod
    def loads(cls, text: str, source: str = "scene", **view: str | None) -> Case:
        """Return the case in the text of a TOML file.

        Parameters
        ----------
        text : str
            The document.
        source : str, default "scene"
            Its name in messages.
        **view : str or None
            See `load`.

        Raises
        ------
        UserError
            See `load`.
        """
        texts, places = read_toml(text, source)
        return cls.of(texts, source, View.of(**view), places)

    @classmethod
    def of(
        cls,
        entries: Mapping[str, Any],
        source: str = "scene",
        view: View = PLAIN,
        places: Mapping[str, str] | None = None,
        is_inferred: bool = False,
    ) -> Case:
        """Return the case of entries by name.

        Parameters
        ----------
        entries : mapping of str to str or float
            As in a file. Empty texts and None stand for nothing.
        source : str, default "scene"
            Name of the case in messages.
        view : View, optional
            The view of entries that name none.
        places : mapping of str to str, optional
            Places of entries for messages.
        is_inferred : bool, default False
            True if units beside other values name the view: a number without is refused.

        Raises
        ------
        UserError
            For an unknown name, a text that is not an amount, units of two systems, a bare number
            among units, and entries that contradict one another.
        """
        entered = {**view.words(), **entries}
        written = {n: text for n, value in entered.items() if (text := entry_text(n, value))}
        places = places or {}
        for name in written:
            if name.removesuffix(SOURCE) not in INPUTS and name not in ABOUT:
                hint = did_you_mean(name, (*INPUTS, *ABOUT))
                fault = f"{quoted(name)} is not an entry of a scene{hint}"
                raise UserError(fault, places.get(name, source))
        given = {"M": DEFAULT_M} | {n: text for n, text in written.items() if n in INPUTS}
        view = View.of(source, **{n: written.get(n) for n in ("units", "axes", "headings")})
        try:
            if not view.units:
                units = system_using(u for n, text in given.items() for u in units_in(n, text))
                view, is_inferred = replace(view, units=units), bool(units)
            amounts, estimates = _read_entries(given, view, is_inferred, places)
            sizes = {n: amounts.pop(n) for pair in SIZES.values() for n in pair if n in amounts}
            amounts, across = plane_across(amounts)
            texts, shares = _nominal_digits(amounts)
        except UserError as error:
            raise error if error.where else UserError(str(error), source) from None
        derived = [n for n, a in amounts.items() if a.share or a.text == COURSE]
        derived += [entry[0] for entry in given.items() if is_estimate(entry)]
        derived += ["GA", "MU"] if across else []
        omitted = tuple(name for name in SCENE if name not in texts)
        if amounts["M"].value != 4 or not {*omitted} <= POINT_DEFAULTS.keys():
            omitted = ()
        texts |= {name: POINT_DEFAULTS[name] for name in omitted}
        return cls(
            amounts,
            view,
            {name: texts[name] for name in SCENE if name in texts},
            (*estimates, *across, *shares, *_implausible(amounts, given, view)),
            written=written,
            source=source,
            sizes=sizes,
            derived=tuple(derived),
            omitted=omitted,
            places=places,
            **{name: written.get(name, "") for name in ("title", "case", "examiner", "date")},
        )

    def with_(
        self, changes: Mapping[str, Any] | None = None, where: str = "", **entries: Any
    ) -> Case:
        """Return the case of the edited file.

        Parameters
        ----------
        changes : mapping of str to str or float, optional
            New entries by name. An empty text removes the entry; one that begins with ``+-`` puts
            a tolerance around the present number.
        where : str, optional
            Place of the changes in messages, such as ``--set``.
        **entries
            More of them.

        Raises
        ------
        UserError
            See `of`.
        """
        texts: dict[str, Any] = dict(self.written)
        changes = {**(changes or {}), **entries}
        for name, value in changes.items():
            if name + SOURCE not in changes:
                texts.pop(name + SOURCE, None)
            if isinstance(value, str) and normalize(value).startswith(TOLERANCE):
                middle = self.written.get(name, "")
                if is_number(middle):  # a unit beside the tolerance is not that of the number
                    middle = f"{middle} {self.view.unit(name)}".rstrip()
                value = f"{middle} {value}"
            texts[name] = value
        places = {**self.places, **dict.fromkeys(changes, where)} if where else self.places
        return Case.of(texts, self.source, places=places)

    @property
    def numbers(self) -> dict[str, float]:
        """The scene's nominal values in base units, for `mechanics.solve`."""
        return _doubles({n: text for n, text in self.texts.items() if n not in self.omitted})

    @property
    def ranges(self) -> tuple[str, ...]:
        """Names of the values known within limits."""
        return tuple(name for name, amount in self.entries.items() if amount.varies)

    @property
    def correlations(self) -> dict[tuple[str, str], float]:
        """Correlations of values known within limits, by pairs of names.

        Raises
        ------
        UserError
            For a text other than ``"UX,VX 0.5; MA,IA 0.9"``.
        """
        pairs: dict[tuple[str, str], float] = {}
        for part in self.written.get("correlations", "").split(";"):
            if not part.strip():
                continue
            try:
                first, second, number = part.replace(",", " ").split()
                pairs[first, second] = float(number)
            except ValueError:
                message = f'correlations: {quoted(part.strip())}; expected such as "UX,VX 0.5"'
                raise UserError(message, self.source) from None
        return pairs

    def place(self, name: str) -> str:
        """Return the place of an entry for messages: file and line, or an option."""
        return self.places.get(name, self.source)

    def toml(self) -> str:
        """Return the case as a commented scene file, entries as written."""
        return write_toml({**self.view.words(), **self.written}, view=self.view)


def entry_text(name: str, value: Any) -> str:
    """Return a value as a case keeps it; "" for nothing."""
    if value is None or isinstance(value, str):
        return (value or "").strip()
    try:
        return to_text(float(value))
    except (TypeError, ValueError, OverflowError):
        raise UserError(f"{name} is {quoted(value)}; expected a number or a text") from None


def _read_entries(
    given: Mapping[str, str], view: View, is_inferred: bool, places: Mapping[str, str]
) -> tuple[dict[str, Amount], list[str]]:
    """Return the amounts of entries, estimates last, and remarks on estimates. Raises UserError at
    the place of an entry."""
    amounts: dict[str, Amount] = {}
    remarks = []
    for name, text in sorted(given.items(), key=is_estimate):
        try:
            if is_estimate((name, text)):
                text, remark = estimate(name, text, amounts, view)
                remarks.append(remark)
            amounts[name] = _read_entry(name, text, view)
            is_bare = is_inferred and is_measured(quantity(name).unit) and not units_in(name, text)
            if is_bare and amounts[name].value not in (0, math.inf):
                raise UserError(
                    f"{name} = {text} has no unit, and other values have; add one, or "
                    f'units = "{view.units}" (--units) for numbers without'
                )
        except UserError as error:
            raise UserError(str(error), places.get(name)) from None
    return amounts, remarks


def _read_entry(name: str, text: str, view: View) -> Amount:
    """Return the amount of an entry that is no estimate. Raises UserError."""
    if name in ("TA", "TB") and text == COURSE:
        return Amount.exactly(math.nan, COURSE)
    if name in ("MU", "MUP") and text.lower() == LOCKED:
        return Amount.exactly(PIVOT, to_text(PIVOT))
    return read(name, text, view)


def _nominal_digits(entries: Mapping[str, Amount]) -> tuple[dict[str, str], list[str]]:
    """Return the digits of the scene's nominal values for the 1988 program, and a remark on a share
    of the critical friction. Raises UserError."""
    nominal = contact_point({n: replace(a, kind="exact") for n, a in entries.items()})
    for vehicle, course in courses(nominal).items():
        heading = f"T{vehicle}"
        if heading in nominal and nominal[heading].text == COURSE:  # A faces TA + 180, B faces TB
            nominal[heading] = exact_number(math.remainder(course + 180 * (vehicle == "A"), 360))
    known = {n: a for n, a in nominal.items() if not (a.share or math.isnan(a.value))}
    texts = {name: known[name].typed for name in SCENE if name in known}
    if "MU" not in nominal or not nominal["MU"].share:
        return texts, []
    from ..mechanics.solve import evaluate  # numpy; for a share only

    values, _ = evaluate(_doubles(texts), ["MUC", "gt"])
    critical = float(values.get("MUC", math.nan))
    if not math.isfinite(critical):
        return texts, []
    share = nominal["MU"].value * (-1 if values["gt"] > 0 else 1)  # line 400 turns it again
    texts["MU"] = to_text(share * critical)
    percent = f"{100 * abs(share):g} % of the critical friction {abs(critical):.6g}"
    return texts, [f"MU = {share * critical:.6g} is {percent}"]


def _implausible(entries: Mapping[str, Amount], given: Mapping[str, str], view: View) -> list[str]:
    """Return remarks on implausible values."""
    values = {n: amount.value for n, amount in entries.items() if not math.isnan(amount.value)}
    remarks = implausible(values, view, courses(entries))
    return [f"{name} = {given[name]}: {words}" for name, is_off, words in remarks if is_off]


def _doubles(texts: Mapping[str, str]) -> dict[str, float]:
    """Return typed values as doubles; the mass of a barrier, which cannot be typed, is infinite."""
    return {n: math.inf if text == "INF" else to_double(text) for n, text in texts.items()}
