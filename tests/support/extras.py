"""The command as it is where only some extras are installed.

What an extra brings is the closure of its requirements, as the installed distributions state them.
A process that has nothing else on its path, beside Python's own library and this package, meets
what a user meets who installed just that.
"""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from tempfile import TemporaryDirectory

from captures import ROOT
from packaging.markers import Marker
from packaging.requirements import Requirement

import impact88

_RUN = "import sys; from impact88.interface.commands.cli import main; sys.exit(main(sys.argv[1:]))"


def required(name: str, extras: frozenset[str] = frozenset()) -> set[str]:
    """Names of the distributions that one needs with some extras, itself among them."""
    needed = {name.lower().replace("_", "-")}
    try:
        lines = distribution(name).requires or []
    except PackageNotFoundError:
        return needed
    for line in lines:
        requirement = Requirement(line)
        marker = requirement.marker or Marker("python_version > '3'")
        if any(marker.evaluate({"extra": extra}) for extra in (*extras, "")):
            needed |= required(requirement.name, frozenset(requirement.extras))
    return needed


def install(folder: Path, *extras: str) -> None:
    """Fill ``folder`` with what ``pip install impact88[EXTRAS]`` brings, as links."""
    for name in required("impact88", frozenset(extras)) - {"impact88"}:
        try:
            installed = distribution(name)
        except PackageNotFoundError:  # a marker's other platform
            continue
        for part in {file.parts[0] for file in installed.files or ()} - {".."}:
            (folder / part).symlink_to(str(installed.locate_file(part)))
    package = folder / "impact88"
    package.mkdir()
    parts = {"legacy": ROOT / "legacy", "golden": ROOT / "golden"}  # as pyproject.toml maps them
    parts |= {part.name: part for part in Path(impact88.__file__).parent.iterdir()}
    for name, part in parts.items():
        (package / name).symlink_to(part)


def run_with(
    extras: tuple[str, ...], *arguments: str, cwd: Path
) -> subprocess.CompletedProcess[str]:
    """Run ``impact88 ARGUMENTS`` where only some extras are installed."""
    with TemporaryDirectory() as place:
        install(Path(place), *extras)
        return subprocess.run(
            [sys.executable, "-S", "-c", _RUN, *arguments],
            cwd=cwd,
            env={**os.environ, "PYTHONPATH": place},
            input="",
            capture_output=True,
            encoding="utf-8",
            timeout=120,
            check=False,
        )
