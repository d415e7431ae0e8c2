"""What a replay gives back."""

from collections.abc import Mapping, Sequence

import numpy as np

from ...applesoft.errorcodes import CODES, ApplesoftError
from ...collision.fields import ANGLES, FIELDS, FINAL_SPINS
from ...mechanics import native
from . import compiled, statements
from .realcolumns import Scenes
from .reals import Floats, Packed, Reals, from_floats
from .statements import ZERO_DETERMINANT
from .textcolumns import TEXT, Strings, write
from .unit import Bools, Ints, Unit

OTHER_M = 2
"""The code of a scene whose M is neither 4 nor 6: not replayed."""
TOGETHER = 8192
"""Scenes up to which all fields are written by one call: of so many it is the same to write each by
itself, of twice as many that is an eighth faster, of few it costs a call a field."""
NEITHER = "M IS NEITHER 4 NOR 6"
_KINDS = {code: kind for kind, code in CODES.items()}


class Replay:
    """The results of `replay`, a value for each scene; names as in `impact88.names`.

    A scene that an error ended keeps what it had computed before, as on the machine, and has no
    later value: NaN as a float, 0 as a stored real, "" as a printed field (see `present`).

    Parameters
    ----------
    scenes : Scenes
        The scenes that were replayed.
    six : ndarray of bool
        True where M is 6.
    unit : Unit
        The arithmetic unit, which holds each scene's error.
    values : dict of str to ndarray
        The stored reals by name.

    Attributes
    ----------
    count : int
        The number of scenes.
    code : ndarray of int
        0, or the Applesoft error's code (53, 69, 133), 1 for ZERO DETERMINANT, 2 for an M that is
        neither 4 nor 6 (not replayed).
    line : ndarray of int
        The line of the listing that ended the scene early (1160 for ZERO DETERMINANT), else 0.

    Examples
    --------
    >>> found = impact88.replay({**impact88.sample(1), "MU": [".5", ".911"]})
    >>> found.printed("LOSS").tolist()
    ['44.43', '57.47']
    """

    def __init__(self, scenes: Scenes, six: Bools, unit: Unit, values: dict[str, Floats]) -> None:
        self.count = scenes.size
        self.code: Ints = unit.code()
        self.line: Ints = unit.line()
        self._scenes = scenes
        self._six = six
        self._unit = unit
        self._values = values
        self._fields: dict[str, Strings] = {}

    @property
    def names(self) -> tuple[str, ...]:
        """The results there are."""
        return tuple(self._values)

    @property
    def zero_determinant(self) -> Bools:
        """The scenes the listing ends with ZERO DETERMINANT."""
        return np.asarray(self.code == ZERO_DETERMINANT)

    @property
    def error(self) -> Strings:
        """Each scene's error message, such as "?DIVISION BY ZERO ERROR IN 480"; "" for none (ZERO
        DETERMINANT is a normal end)."""
        messages = np.full(self.count, "", dtype="<U48")
        for i in np.flatnonzero(self.code > ZERO_DETERMINANT).tolist():
            code, line = int(self.code[i]), int(self.line[i])
            other = code == OTHER_M
            messages[i] = NEITHER if other else ApplesoftError(_KINDS[code], line).message
        return messages

    def __len__(self) -> int:
        return self.count

    def __repr__(self) -> str:
        ended = int(np.count_nonzero(self.code > ZERO_DETERMINANT))
        zero = int(np.count_nonzero(self.zero_determinant))
        return (
            f"<Replay of {self.count:,} scenes: {ended:,} ended by an error, {zero:,} by a zero "
            f"determinant; {' '.join(self.names)}>"
        )

    def to_dict(self) -> dict[str, Floats | Strings | Ints]:
        """Every result as floats, and how each scene ended (ERROR, LINE): columns of one length,
        as a DataFrame of any library takes them."""
        ending = np.where(self.zero_determinant, "ZERO DETERMINANT", self.error)
        results = {name: self.floats(name) for name in self.names}
        return {**results, "ERROR": ending, "LINE": self.line}

    def present(self, name: str) -> Bools:
        """The scenes that have the result."""
        return self._reached(name, statements.ASSIGNED)

    def floats(self, name: str) -> Floats:
        """A result, exactly, as float64; NaN where there is none. Raises KeyError for an unknown
        name."""
        return np.where(self.present(name), self._values[name], np.nan)

    def reals(self, name: str) -> Packed:
        """A result as the five bytes stored, one number each: f"{x:010x}" writes them in
        hexadecimal. 0 where there is none."""
        packed = from_floats(self._values[name].copy(), None, True).packed()
        return np.where(self.present(name), packed, np.uint64(0))

    def printed(self, name: str) -> Strings:
        """A field of the printout, of a result or a scene value, character for character: "-8.78",
        "5E-03"; "" where the program did not get as far. MU and MUP both are what line 680 prints;
        KF is printed nowhere. Fields are written when first asked for."""
        name = "MUP" if name == "MU" else name
        self.write_fields([name])
        return self._fields[name]

    def write_fields(self, names: Sequence[str] = tuple(FIELDS)) -> None:
        """Write fields now, by default all, which takes less time than one after another."""
        names = [name for name in names if name not in self._fields]
        if not names:
            return
        columns = self._to_print(names)
        # memory in one piece is paged in twice as fast
        texts = np.empty((len(names), self.count), TEXT)
        if self.count <= TOGETHER:
            write(Reals(np.array([np.broadcast_to(v, self.count) for v in columns]), None), texts)
        else:
            for field, v in zip(texts, columns, strict=True):
                if v.size > 1:
                    write(Reals(v, None), field)
                else:
                    field[...] = write(Reals(v, None))
        for name, field in zip(names, texts, strict=True):
            printed = self._reached(name, statements.PRINTED)
            if not printed.all():
                field[~printed] = ""
            self._fields[name] = field

    def _reached(self, name: str, places: Mapping[str, int]) -> Bools:
        """The scenes in which the program got past a name's place."""
        reached = self._unit.reached(places[name]) & (self.code != OTHER_M)
        return np.asarray(reached & self._six if name in FINAL_SPINS else reached)

    def _to_print(self, names: list[str]) -> list[Floats]:
        """What PRINT gets for fields, extension included; length 1 where all scenes share it."""
        values = {**self._scenes.values, **self._values}
        made = [name for name in names if name == "LOSS" or name in (*statements.FLOORED, *ANGLES)]
        found = {name: np.empty(self.count) for name in made}
        rows = np.arange(self.count)  # left to the arrays
        if made and native.library is not None:
            given = {x: values[x] for name in made for x in compiled.sources(name)}
            varying = frozenset(x for x, v in given.items() if v.size > 1)
            program = compiled.field_program(tuple(made), varying)
            found, odd = compiled.computed(program, given, self.count)
            rows = np.flatnonzero(odd)
        for name in made if rows.size else ():
            columns = [values[x] for x in compiled.sources(name)]
            found[name][rows] = _shown(name, [v[rows] if v.size > 1 else v for v in columns])
        return [found[name] if name in found else values[name] for name in names]


@np.errstate(all="ignore")
def _shown(name: str, columns: list[Floats]) -> Floats:
    """What PRINT gets for a field, by arrays."""
    unit = Unit(columns[0].size)
    return statements.shown(name, *(from_floats(v.copy(), unit, True) for v in columns)).v


def field_names() -> tuple[str, ...]:
    """The fields of the printout, in its order."""
    return tuple(FIELDS)
