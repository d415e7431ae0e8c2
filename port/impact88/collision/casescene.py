"""The scene of release 0.3, which also reads units and files; it goes with `interface`.

The digits typed matter (90315.8817 and 90315.88170 differ in their last bit), so a scene keeps
text, which an arithmetic reads later. A scene file is flat TOML, keyed by the listing's names;
values keep their raw text, TOML's parsed number is never used."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping

from ..errors import UserError, quoted
from ..messages import notebook
from ..messages.arguments import explains_arguments
from ..names import DEFAULT_M, SCENE, check_names, missing
from ..program import scene as typed
from ..program.scene import SAMPLES as SAMPLES
from ..program.scene import published_data as published_data
from .case import FACING_COURSE, Case, check_mapping, check_value, share_of
from .doubles import double
from .scenefile import case_in, template, toml_texts

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Self

INERTIAS = ("IA", "IB")
"""Line 480 divides by them, of point masses, too: 1 is typed where they are not given."""


class Scene(typed.Scene):
    """The 21 values of a scene by the listing's names, in the table's order, each as typed.

    Parameters
    ----------
    values : mapping of str to str
        Texts by name as in a file: numbers, amounts with units, ranges (whose nominal value is
        used), a percentage of the critical friction, estimates. M defaults to 6.
    title, source : str, optional
        The scene's title, and its name in messages.
    units : str, optional
        The system of bare numbers if no entry names one. The scene's texts are in its base units.

    Attributes
    ----------
    case : Case
        The entries of the scene as written.
    omitted : tuple of str
        Names that are not given, for which 0 is typed, of inertias 1; only `Scene.of` allows any.

    Raises
    ------
    UserError
        For a missing or unknown name, or a text that is not an amount.

    Examples
    --------
    >>> scene = impact88.sample(1).replaced({"MU": ".5"})
    >>> scene["MU"], scene.numbers()["E"]
    ('.5', 0.005)
    """

    __slots__ = ("case", "omitted", "remarks")

    def __init__(
        self,
        values: Mapping[str, str],
        title: str | None = None,
        source: str = "scene",
        units: str | None = None,
    ) -> None:
        check_mapping(values)
        self._take(Case({**values, "title": title} if title else values, source, units))

    @classmethod
    def of(cls, case: Case, may_omit: Collection[str] = ()) -> Self:
        """Return the scene of a case.

        Parameters
        ----------
        case : Case
            The entries of a file, form or mapping.
        may_omit : collection of str, optional
            Names that need not be given: 0 is typed for them, of inertias 1, and ``omitted`` names
            them.

        Returns
        -------
        Scene
            The scene, with ranges at their nominal values.

        Raises
        ------
        UserError
            For a missing or unknown name, or a text that is not an amount.
        """
        scene = cls.__new__(cls)
        scene._take(case, may_omit)
        return scene

    def _take(self, case: Case, may_omit: Collection[str] = ()) -> None:
        """Set the values from the nominal values of ``case``. Raises UserError."""
        nominal_case, source = case.at_nominal(), case.source
        values = dict(nominal_case.values)
        check_names(values, SCENE, "value of a scene", source)
        # a vehicle at rest that faces the way it travels has no heading yet
        absent = [name for name in SCENE if values.get(name, FACING_COURSE) == FACING_COURSE]
        if names := [name for name in absent if name not in may_omit]:
            raise UserError(missing(names), source)
        self.omitted = tuple(absent)
        values |= {name: "1" if name in INERTIAS else "0" for name in absent}
        self.remarks = dict(nominal_case.remarks)
        if (share := share_of(values["MU"])) is not None:
            from ..mechanics.closedform.general import resolve_share  # needed for a share only

            texts = {
                n: check_value(n, text, case.place(n)) for n, text in values.items() if n != "MU"
            }
            values["MU"], self.remarks["MU"] = resolve_share(
                {**texts, "MU": values["MU"]}, share, source
            )
        self._values = {name: check_value(name, values[name], case.place(name)) for name in SCENE}
        self.case, self.title, self.source = case, case.title, source

    @classmethod
    def from_mapping(
        cls, values: Mapping[str, str], source: str = "scene", units: str | None = None
    ) -> Self:
        """Return the scene of texts by name.

        Parameters
        ----------
        values : mapping of str to str
            Texts by the listing's names, as `Scene` takes them.
        source : str, default "scene"
            The scene's name in messages.
        units : str, optional
            The system of bare numbers if no entry names one.

        Returns
        -------
        Scene
            The scene, with ranges at their nominal values.

        Raises
        ------
        UserError
            For a missing or unknown name, or a text that is not an amount.
        """
        return cls.of(Case(values, source, units))

    @classmethod
    def from_toml(cls, path: str, units: str | None = None) -> Self:
        """Return the scene in a TOML file.

        Parameters
        ----------
        path : str
            Path of the file.
        units : str, optional
            The system of bare numbers if the file names none.

        Returns
        -------
        Scene
            The scene, with ranges at their nominal values.

        Raises
        ------
        UserError
            For a file that cannot be read as a scene; the message names file, line or key.
        """
        return cls.of(case_in(path, units))

    @classmethod
    def from_toml_text(cls, text: str, source: str, units: str | None = None) -> Self:
        """Return the scene in a TOML document.

        Parameters
        ----------
        text : str
            The document.
        source : str
            Its name in messages.
        units : str, optional
            The system of bare numbers if the document names none.

        Returns
        -------
        Scene
            The scene, with ranges at their nominal values.

        Raises
        ------
        UserError
            For a text that cannot be read as a scene; the message names line or key.
        """
        if not isinstance(text, str):
            raise UserError(f"{quoted(text)} is not the text of a file")
        return cls.of(Case(toml_texts(text, source), source, units))

    @property
    def given(self) -> dict[str, str]:
        """The values without those omitted."""
        return {name: text for name, text in self._values.items() if name not in self.omitted}

    @property
    def units(self) -> str | None:
        """The system of units of the entries, None without units; values are in its base units."""
        return self.case.units

    @property
    def estimated(self) -> dict[str, str]:
        """The rule behind each estimated value, in words."""
        return self.case.estimated

    def _repr_html_(self) -> str:
        """Return the scene file as HTML for a notebook."""
        return notebook.preformatted_html(self.to_toml())

    def replaced(self, changes: Mapping[str, str]) -> Self:
        """Return this scene with some values changed.

        Parameters
        ----------
        changes : mapping of str to str
            New texts by name, as an edit of the scene's file: amounts, ranges around the present
            value, estimates, or nothing, which takes an entry out. A percentage of the critical
            friction stays that percentage.

        Returns
        -------
        Scene
            The changed scene.

        Raises
        ------
        UserError
            For an unknown name, or a text that is not an amount.
        """
        check_mapping(changes)
        return type(self).of(self.case.replaced(changes))

    def numbers(self) -> dict[str, float]:
        """Return the values as numbers.

        Returns
        -------
        dict of str to float
            All 21 values by name.

        Raises
        ------
        UserError
            For a value past the range of doubles.
        """
        return numbers_of(self)

    def to_toml(self) -> str:
        """Return the scene as a commented TOML file.

        Returns
        -------
        str
            The file's text, with the entries as written.
        """
        return template(self.case)


def numbers_of(scene: Mapping[str, object]) -> dict[str, float]:
    """Return a scene's values, texts or numbers, as doubles by name. Raises UserError if one is
    missing or not a finite number."""
    result = {}
    for name in SCENE:
        text = scene.get(name, DEFAULT_M if name == "M" else None)
        try:
            value = double(text) if isinstance(text, str) else float(text)  # type: ignore[arg-type]
        except (TypeError, ValueError):
            value = math.nan
        if not math.isfinite(value):
            raise UserError(f"{text!r} is not a finite number", name)
        result[name] = value
    return result


@explains_arguments
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
    scene = typed.sample(number)
    return Scene({**scene, "units": "chapter"}, scene.title, scene.source)
