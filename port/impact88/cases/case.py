"""A case: what a file, a form or a mapping says of one collision, as immutable amounts.

Every command reads its values from a case. It keeps the text of each entry as written, and
`Case.with_` returns the case of the edited file: ``COMMAND FILE --set K=V`` gives what editing that
line of FILE gives."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from ..decimals import is_number, to_text
from ..errors import UserError, quoted
from ..files import display_name, read_text
from ..names import DEFAULT_M, SCENE, did_you_mean
from .amounts import TOLERANCE, Amount, normalize, read
from .motion import Amounts, Values, contact_point, courses
from .scenefile import ABOUT, INPUTS, SOURCE, read_toml, write_toml
from .units import PLAIN, View
from .vehicles import ESTIMATE, SIZES, estimate, implausible

POINT_DEFAULTS = dict.fromkeys("EM DA DB PA PB TA TB IA IB WA WB".split(), "0") | {
    "IA": "1",  # line 480 divides by the inertias, of points, too
    "IB": "1",
}
"""Inputs that a scene of point masses need not have, and what is typed in their place."""
Texts = Mapping[str, str]


@dataclass(frozen=True)
class Case:
    """One collision.

    Made by `Case.load`, `Case.loads` and `Case.of`.

    Parameters
    ----------
    entries : mapping of str to Amount
        Amounts by name, in base units along the listing's axes. A TA or TB that follows a course
        is NaN. M is 6 if it is not given.
    view : View
        Units, axes and headings in which the case is written and its results are shown.
    texts : mapping of str to str
        The digits typed into the 1988 program, by the scene's names: nominal values in base units.
    numbers : mapping of str to float
        The scene's nominal values in base units, for `mechanics.solve`. Point masses lack what is
        typed in place of their dimensions.
    remarks : tuple of str
        What was assumed, and values that are implausible.
    written : mapping of str to str
        The entries as written; NAME_source says where a value comes from.
    source : str
        Name of the case in messages.
    derived : tuple of str
        Names of the scene's values that follow from others: estimates, courses, and shares.
    places : mapping of str to str
        Places of entries for messages.
    title, case, examiner, date : str
        Headings of a report.

    Examples
    --------
    >>> case = Case.loads('units = "us"\\nMA = 3000\\nUX = "30 +- 2"')
    >>> case.entries["UX"].high, case.view.shown("UX", case.entries["UX"].high)
    (46.93333333333333, 32.0)
    >>> case.with_(UX="-25 mph").texts["UX"]
    '-36.666666666666664'
    """

    entries: Amounts
    view: View
    texts: Texts
    numbers: Values
    remarks: tuple[str, ...]
    written: Texts
    source: str
    derived: tuple[str, ...]
    places: Texts = field(repr=False, compare=False)
    title: str
    case: str
    examiner: str
    date: str

    @classmethod
    def load(cls, path: str, view: View = PLAIN) -> Case:
        """Return the case in a TOML file.

        Parameters
        ----------
        path : str
            The file, ``-`` for standard input.
        view : View, optional
            The view of a file that names none.

        Raises
        ------
        UserError
            For a file that cannot be read as a case; the message names file, line and entry.
        """
        return cls.loads(read_text(path), display_name(path), view)

    @classmethod
    def loads(cls, text: str, source: str = "scene", view: View = PLAIN) -> Case:
        """Return the case in the text of a TOML file.

        Parameters
        ----------
        text : str
            The document.
        source : str, default "scene"
            Its name in messages.
        view : View, optional
            See `load`.

        Raises
        ------
        UserError
            See `load`.
        """
        texts, places = read_toml(text, source)
        return cls.of(texts, source, view, places)

    @classmethod
    def of(
        cls,
        entries: Mapping[str, Any],
        source: str = "scene",
        view: View = PLAIN,
        places: Mapping[str, str] = {},
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

        Raises
        ------
        UserError
            For an unknown name, a text that is not an amount, a unit in a file that names no
            ``units``, and entries that contradict one another.
        """
        texts = {n: entry_text(n, value) for n, value in {**asdict(view), **entries}.items()}
        written = {name: text for name, text in texts.items() if text}
        for name in written:
            if name.removesuffix(SOURCE) not in INPUTS and name not in ABOUT:
                hint = did_you_mean(name, (*INPUTS, *ABOUT))
                raise UserError(
                    f"{quoted(name)} is not an entry of a scene{hint}", places.get(name, source)
                )
        given = {"M": DEFAULT_M} | {n: text for n, text in written.items() if n in INPUTS}
        try:
            view = View.of(**written)
            amounts, remarks = _read_entries(given, view, places)
            values = {n: a.value for n, a in amounts.items() if not math.isnan(a.value)}
            texts, further_remarks = _nominal_digits(amounts, values)
        except UserError as error:
            raise error if error.where else UserError(str(error), source) from None
        numbers = {name: float(text) for name, text in texts.items()}
        if amounts["M"].value == 4:
            texts = POINT_DEFAULTS | texts
        further_remarks += [
            f"{name} = {given[name]}: {words}"
            for name, is_off, words in implausible(values, view, courses(values))
            if is_off
        ]
        return cls(
            amounts,
            view,
            texts,
            numbers,
            (*remarks, *further_remarks),
            written,
            source,
            tuple(
                n
                for n, a in amounts.items()
                if a.share or math.isnan(a.value) or given[n].startswith(ESTIMATE)
            ),
            places,
            **{name: written.get(name, "") for name in ("title", "case", "examiner", "date")},
        )

    def with_(self, where: str = "", /, **changes: Any) -> Case:
        """Return the case of the edited file.

        Parameters
        ----------
        where : str, optional
            Place of the changes in messages, such as ``--set``.
        **changes : str or float
            New entries by name. An empty text removes the entry; one that begins with ``+-`` puts
            a tolerance around the present number.

        Raises
        ------
        UserError
            See `of`.
        """
        texts: dict[str, Any] = dict(self.written)
        for name, value in changes.items():
            if name + SOURCE not in changes:
                texts.pop(name + SOURCE, None)
            if isinstance(value, str) and normalize(value).startswith(TOLERANCE):
                middle = self.written.get(name, "")
                if is_number(middle):  # a unit beside the tolerance is not that of the number
                    middle = f"{middle} {self.view.unit(name)}".rstrip()
                value = f"{middle} {value}"
            texts[name] = value
        places = {**self.places, **dict.fromkeys(changes, where or self.source)}
        return Case.of(texts, self.source, places=places)

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
        text = self.written.get("correlations", "")
        try:
            rows = [part.replace(",", " ").split() for part in text.split(";") if part]
            return {(first, second): float(number) for first, second, number in rows}
        except ValueError:
            raise UserError(
                f'correlations = {quoted(text)}; expected such as "UX,VX 0.5; MA,IA 0.9"',
                self.places.get("correlations", self.source),
            ) from None

    def toml(self) -> str:
        """Return the case as a commented scene file, entries as written."""
        return write_toml(self.written, self.view)


def entry_text(name: str, value: Any) -> str:
    """Return a value as a case keeps it; "" for nothing."""
    if value is None or isinstance(value, str):
        return (value or "").strip()
    try:
        return to_text(float(value))
    except (TypeError, ValueError, OverflowError):
        raise UserError(f"{name} is {quoted(value)}; expected a number or a text") from None


def _read_entries(given: Texts, view: View, places: Texts) -> tuple[dict[str, Amount], list[str]]:
    """Return the amounts of entries, estimates last, and remarks on estimates. Raises UserError at
    the place of an entry."""
    amounts: dict[str, Amount] = {}
    remarks = []
    for name, text in sorted(given.items(), key=lambda entry: entry[1].startswith(ESTIMATE)):
        try:
            if name in ("IA", "IB") and text.startswith(ESTIMATE):
                text, remark = estimate(name, text, amounts, view)
                remarks.append(remark)
            amounts[name] = read(name, text, view)
        except UserError as error:
            raise UserError(str(error), places.get(name)) from None
    return {name: a for name, a in amounts.items() if name not in SIZES}, remarks


def _nominal_digits(entries: Amounts, values: Values) -> tuple[dict[str, str], list[str]]:
    """Return the digits of the scene's nominal values for the 1988 program, and a remark on a share
    of the critical friction. Raises UserError."""
    texts = {name: entries[name].typed for name in values if name in SCENE}
    computed = contact_point(values)
    for name, course in courses(values).items():  # A faces TA + 180, B faces TB
        if name in entries.keys() - values.keys():
            computed[name] = math.remainder(course + 180 * (name == "TA"), 360)
    texts |= {name: to_text(value) for name, value in computed.items()}
    if "MU" not in entries or not entries["MU"].share:
        return texts, []
    from ..mechanics.solve import evaluate  # numpy; for a share only

    del texts["MU"]
    results, _ = evaluate({n: float(text) for n, text in texts.items()}, ["MUC", "gt"])
    critical = float(results.get("MUC", math.nan))
    if not math.isfinite(critical):
        return texts, []
    share = values["MU"] * (-1 if results["gt"] > 0 else 1)  # line 400 turns it again
    texts["MU"] = to_text(share * critical)
    return texts, [
        f"MU = {share * critical:.6g} is {100 * abs(share):g} % of the critical friction "
        f"{abs(critical):.6g}"
    ]
