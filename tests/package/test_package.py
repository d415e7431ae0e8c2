"""The wheel holds every package and data file; the top level holds nothing else."""

from __future__ import annotations

import re
import subprocess
import tomllib
from importlib import import_module
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest
from captures import ROOT

import impact88

TOP_LEVEL = {"pyproject.toml", "legacy", "port", "tests", "golden", "README.md"}
FOR_TESTS = {
    "scans",
    "scans.jsonl.gz",
    "corners",
    "published",
    "ocr-page.txt",
    "reference-cases.json",
}
"""Parts of golden/ that only tests read."""


@pytest.fixture(scope="module")
def project() -> dict[str, Any]:
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def committed(folder: str) -> list[Path]:
    """Return the files of a folder that git does not ignore, relative to the folder."""
    command = ["git", "-C", str(ROOT), "ls-files", "-co", "--exclude-standard", folder]
    listing = subprocess.run(command, capture_output=True, text=True, check=False)
    if listing.returncode:
        pytest.skip("this is no checkout")
    paths = [ROOT / line for line in listing.stdout.splitlines()]
    return [path.relative_to(ROOT / folder) for path in paths if path.exists()]


def test_the_top_level_holds_nothing_else() -> None:
    names = {path.parts[0] for path in committed(".")}
    assert {name for name in names if not name.startswith(".")} == TOP_LEVEL


def test_every_package_is_listed(project: dict[str, Any]) -> None:
    modules = [path for path in committed("port/impact88") if path.suffix == ".py"]
    folders = {".".join(("impact88", *path.parent.parts)) for path in modules}
    listed = set(project["tool"]["setuptools"]["packages"])
    assert listed == folders | {"impact88.legacy", "impact88.golden"}


def test_every_data_file_is_packaged(project: dict[str, Any]) -> None:
    setuptools = project["tool"]["setuptools"]
    for package in setuptools["packages"]:
        folder = setuptools["package-dir"].get(package, "port/" + package.replace(".", "/"))
        patterns = setuptools["package-data"].get(package, [])
        covered = {path for pattern in patterns for path in (ROOT / folder).glob(pattern)}
        for path in committed(folder):
            inside = not any(
                (ROOT / folder / part / "__init__.py").exists()
                for part in path.parents
                if part != Path()
            )
            source = path.suffix in (".py", ".c", ".h") or FOR_TESTS & set(path.parts)
            assert source or not inside or ROOT / folder / path in covered, f"{package}: {path}"


@pytest.mark.parametrize(
    ("package", "name"),
    [
        ("impact88.legacy", "impact.bas"),
        ("impact88.golden", "scenes.jsonl.gz"),
        ("impact88.web", "templates/layout.html"),
        ("impact88.report", "templates/case.html"),
    ],
)
def test_data_is_a_resource_of_the_package(package: str, name: str) -> None:
    assert files(package).joinpath(name).is_file()


def test_the_version_is_in_one_place(project: dict[str, Any]) -> None:
    place = project["tool"]["setuptools"]["dynamic"]["version"]["attr"]
    assert place == "impact88.version.__version__"
    assert version("impact88") == impact88.__version__


def test_classifiers_begin_with_the_lowest_python(project: dict[str, Any]) -> None:
    versions = re.findall(r"Python :: (3\.\d+)", "\n".join(project["project"]["classifiers"]))
    assert f">={versions[0]}" == project["project"]["requires-python"]


@pytest.mark.parametrize("name", sorted(impact88._LAZY))
def test_importing_a_module_hides_no_public_name(name: str) -> None:
    place, _, inner = impact88._LAZY[name].partition(":")
    module = import_module(f"impact88.{place or name}")
    public = getattr(impact88, name)
    assert public is (getattr(module, inner or name) if place else module)
