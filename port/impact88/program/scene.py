"""A scene: the listing's 21 values, each as typed.

The digits typed matter (90315.8817 and 90315.88170 differ in their last bit), so a scene keeps
texts, which an arithmetic reads when the program's line is reached.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any, Self

from ..apple.applesoft.console import MAX_INPUT
from ..decimals import is_number, to_double
from ..errors import UserError
from ..files import packaged_text
from ..names import DEFAULT_M, SCENE, VELOCITIES, check_names, missing

LISTING = "impact.bas"
DATA_LINES = (280, 290, 310)
"""Lines of the listing that set values."""
REPLY_LINES = (210, 230)
"""Lines of the listing that ask for values."""
M_LINE = 350  # the line of the listing that sets M


class Scene(Mapping[str, str]):
    """The 21 values of a scene by the listing's names, in the table's order, each as typed.

    Parameters
    ----------
    values : mapping of str to str
        Decimal texts by name (`impact88.names.SCENE`); M defaults to 6.
    title : str, optional
        The scene's title.
    source : str, default "scene"
        The scene's name in messages.

    Raises
    ------
    UserError
        For a missing or unknown name, or a text that INPUT does not read as one number.

    Examples
    --------
    >>> scene = impact88.sample(1).replaced({"MU": ".5"})
    >>> scene["MU"], scene.numbers()["E"]
    ('.5', 0.005)
    """

    __slots__ = ("_values", "source", "title")

    title: str | None
    source: str

    def __init__(
        self, values: Mapping[str, str], title: str | None = None, source: str = "scene"
    ) -> None:
        self._values: dict[str, str] = complete(values, source)
        self.title = title
        self.source = source
        for name, text in self._values.items():
            check_number(name, text, source)

    def __getitem__(self, name: str) -> str:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        return f"Scene({self._values!r})"

    def replaced(self, changes: Mapping[str, str]) -> Self:
        """Return this scene with some values changed.

        Parameters
        ----------
        changes : mapping of str to str
            New texts by name.

        Returns
        -------
        Scene
            The changed scene.

        Raises
        ------
        UserError
            For an unknown name, or a text that is not a number.
        """
        return type(self)({**self, **changes}, self.title, self.source)

    def keyboard(self) -> list[str]:
        """Return the replies to the INPUTs of lines 210 and 230.

        Returns
        -------
        list of str
            Two replies, three numbers each.
        """
        return [",".join(self[n] for n in names) for names in (VELOCITIES[:3], VELOCITIES[3:])]

    def typed_lines(self) -> list[str]:
        """Return the program lines to retype for this scene.

        Returns
        -------
        list of str
            Lines 280, 290 and 310, and 350 unless M is 6.
        """
        lines = [
            f"{line} "
            + ":".join(f"{q.name} = {self[q.name]}" for q in SCENE.values() if q.line == line)
            for line in DATA_LINES
        ]
        if self["M"] != DEFAULT_M:
            lines.append(f"{M_LINE} N = {DEFAULT_M}:M = {self['M']}")
        return lines

    def numbers(self) -> dict[str, float]:
        """Return the values as numbers.

        Returns
        -------
        dict of str to float
            All 21 values by name, infinite beyond the range of doubles.
        """
        return {name: to_double(text) for name, text in self.items()}

    def check_typed(self) -> None:
        """Check that the values can be typed into program lines and mean the same there.

        Raises
        ------
        UserError
            For a value that INPUT and a program line would read differently (in a line ``E`` is the
            variable, and ``-`` alone is not a number), and for a line of more than 239 characters.
        """
        for value in SCENE.values():
            text = self[value.name]
            if value.line not in REPLY_LINES and not re.match(r"[ +-]*[0-9.]", text):
                raise UserError(
                    f"{value.name} = {text!r} is a number to INPUT but not in program line "
                    f"{value.line}; expected one that begins with a digit or a point",
                    self.source,
                )
        for line in (*self.typed_lines(), *self.keyboard()):
            if len(line) > MAX_INPUT:
                raise UserError(
                    f"the line {line:.30}... has {len(line)} characters with these values; the "
                    f"Apple takes {MAX_INPUT}",
                    self.source,
                )


def complete(values: Mapping[str, Any], source: str | None = None) -> dict[str, Any]:
    """Return the values of a scene in the table's order, M = 6 where it is not given. Raises
    UserError for missing and unknown names."""
    if not isinstance(values, Mapping):
        raise UserError(f"{type(values).__name__} is not a mapping of names to texts", source)
    check_names(values, SCENE, "value of a scene", source)
    if absent := [name for name in SCENE if name not in values and name != "M"]:
        raise UserError(missing(absent), source)
    return {name: values.get(name, DEFAULT_M) for name in SCENE}


def check_number(name: str, text: object, source: str) -> None:
    """Raise UserError unless INPUT reads the whole of a text as one number."""
    if not (isinstance(text, str) and text.isascii() and is_number(text)):
        raise UserError(
            f"{name} = {text!r:.60} is not a number as typed; expected a text such as '1.5' "
            f"({SCENE[name].meaning})",
            source,
        )


def published_data() -> dict[str, str]:
    """Return the values in lines 280, 290, 310 and 350 of the published listing."""
    listing = packaged_text("impact88.legacy", LISTING)
    data = dict(re.findall(r"(?m)(?:^\d+ |:)([A-Z]+) = (-?[0-9.]+)(?=:|$)", listing))
    return {name: data[name] for name in SCENE if name in data}


_APPENDIX = "UX=-29.04 UY=0 WA=0 VX=14.52 VY=25.15 WB=0"
_SAMPLES = {
    1: ("Appendix, first sample run", _APPENDIX),
    2: ("Appendix, second sample run: point masses", f"{_APPENDIX} M=4 DA=0 DB=0"),
    3: (
        "Table 3: hypothetical collision for example calculations",
        "UX=-36.667 UY=0 WA=0 VX=0 VY=58.667 WB=0 E=.25 MU=.89 EM=-.9 DA=4.5 DB=4 "
        "GA=0 PA=0 PB=-40 TA=0 TB=90 MA=96 MB=145 IA=1970 IB=3770",
    ),
}
"""The published runs: title, and the values typed in addition to the listing's data."""

SAMPLES = tuple(_SAMPLES)


def sample(number: int) -> Scene:
    """Return the scene of a published run.

    Parameters
    ----------
    number : {1, 2, 3}
        The run.

    Returns
    -------
    Scene
        Its 21 values in ft, slug and s, each as in the listing or the printout.

    Raises
    ------
    UserError
        For any other number.

    Examples
    --------
    >>> impact88.sample(2)["M"]
    '4'
    """
    if number not in SAMPLES:
        raise UserError(f"there is no sample {number!r}; expected {', '.join(map(str, SAMPLES))}")
    title, entries = _SAMPLES[number]
    values = published_data() | dict(entry.split("=") for entry in entries.split())
    return Scene(values, title, f"sample {number}")
