"""impact88: Brach's 1988 planar impact program, digit for digit, and the same mechanics made fast.

The public functions are imported on first use, so that running the 1988 program does not pay for
numpy. Nor does it for ``typing``: the modules it needs import that for the type checker alone.
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

__version__ = "0.1.0"

_LAZY = {
    "Applesoft": "emulator.emulator",
    "Scene": "scene",
    "sample": "scene",
    "run": "program.run",
    "verify": "casework.verify",
    "verify_file": "casework.verify",
    "read_printouts": "casework.printout",
    "solve_for": "reconstruction.unknowns",
    "colinear": "chapter.colinear",
    "colinear_inverse": "chapter.colinear",
    "barrier": "chapter.barrier",
    "delta_v": "chapter.deltav",
    "solve": "closedform.solve",
    "bounds": "uncertainty.bounds",
    "scene_svg": "figures.sceneview",
    "replay": "replay",
}
"""Public name -> the module that holds it."""

_ROOMS = ("names", "status")
"""Public modules, imported on first use too: ``impact88.names.SCENE``."""


class _Package(ModuleType):
    """This package: a public name stays the function when the module of that name is imported.

    Python would bind ``impact88.run`` to the module ``run`` once anything imports it.
    """

    def __setattr__(self, name: str, value: Any) -> None:
        if not (name in _LAZY and isinstance(value, ModuleType)):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package


def __getattr__(name: str) -> Any:
    if name in _LAZY:
        return getattr(import_module(f".{_LAZY[name]}", __name__), name)
    if name in _ROOMS:
        return import_module(f".{name}", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), *_LAZY, *_ROOMS])
