"""Nothing is outside the package, and nothing of it is left out of a wheel."""

from __future__ import annotations

import re
import shutil
import subprocess
import tomllib
from fnmatch import fnmatch
from importlib import import_module
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest
from captures import ROOT

import impact88

TOP_LEVEL = {"pyproject.toml", "legacy", "port", "tests", "golden", "README.md"}
"""All that the top level holds, besides dot files."""


@pytest.fixture(scope="module")
def project() -> dict[str, Any]:
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


FOR_TESTS = {
    "scans",
    "corners",
    "published",
    "ocr-page.txt",
    "reference-cases.json",
    "scans.jsonl.gz",
}
"""What of golden/ no installation needs: selfcheck and oracle read the rest."""


def ignored(name: str) -> bool:
    """Whether .gitignore leaves this name out (its patterns here are plain names and globs)."""
    patterns = (ROOT / ".gitignore").read_text(encoding="utf-8").split()
    return any(fnmatch(name, pattern.rstrip("/")) for pattern in patterns)


def kept(folder: Path) -> list[Path]:
    """The files under a folder that are not ignored, relative to it."""
    paths = [path.relative_to(folder) for path in folder.rglob("*") if path.is_file()]
    return [path for path in paths if not any(map(ignored, path.parts))]


def test_the_top_level_holds_nothing_else() -> None:
    there = {path.name for path in ROOT.iterdir() if not path.name.startswith(".")}
    assert {name for name in there if not ignored(name)} == TOP_LEVEL


def test_every_package_folder_is_listed(project: dict[str, Any]) -> None:
    setuptools = project["tool"]["setuptools"]
    modules = [
        path for path in kept(ROOT / "port") if path.suffix == ".py" and path.parts[0] != "docs"
    ]
    folders = {".".join(path.parent.parts) for path in modules}
    elsewhere = {name: folder for name, folder in setuptools["package-dir"].items() if name}
    listed = set(setuptools["packages"])
    for name in sorted(listed - folders - set(elsewhere)):
        pytest.fail(f"next step: port/{name.replace('.', '/')}/__init__.py, or not to list {name}")
    for name in sorted(folders - listed):
        pytest.fail(f"next step: {name!r} in the list `packages` of pyproject.toml")
    assert listed == folders | set(elsewhere)
    for folder in [ROOT / "port" / f.replace(".", "/") for f in folders]:
        assert (folder / "__init__.py").is_file(), f"next step: {folder / '__init__.py'}"
    for folder in elsewhere.values():
        assert (ROOT / folder / "__init__.py").is_file()


@pytest.mark.parametrize(
    "package", ["impact88", "impact88.web", "impact88.legacy", "impact88.golden"]
)
def test_every_data_file_matches_a_pattern_of_package_data(
    project: dict[str, Any], package: str
) -> None:
    setuptools = project["tool"]["setuptools"]
    folder = setuptools["package-dir"].get(package, "port/" + package.replace(".", "/"))
    patterns = setuptools["package-data"][package]
    within = [other for other in setuptools["package-data"] if other.startswith(f"{package}.")]
    others = {tuple(other.removeprefix(f"{package}.").split(".")) for other in within}
    data = [
        path
        for path in kept(ROOT / folder)
        if path.suffix != ".py" and not any(path.parts[: len(it)] == it for it in others)
    ]
    assert data
    # setuptools' * stays within a folder, as glob's does and fnmatch's does not
    missed = [
        path
        for path in data
        if not any(
            len(path.parts) == len(Path(pattern).parts) and path.match(pattern)
            for pattern in patterns
        )
    ]
    if package == "impact88":
        missed = [path for path in missed if path.suffix not in (".c", ".h")]
    if package == "impact88.golden":
        # the wheel has an archive of them, made when it is built
        assert "programs.zip" in patterns
        missed = [path for path in missed if path.parts[0] != "programs"]
        for_tests = [path for path in data if FOR_TESTS & set(path.parts)]
        assert set(for_tests) <= set(missed)
        missed = [path for path in missed if path not in for_tests]
    assert not missed


@pytest.mark.parametrize(
    ("package", "name"),
    [
        ("impact88.legacy", "impact.bas"),
        ("impact88.legacy", "ERRATA.md"),
        ("impact88.golden", "scenes.jsonl.gz"),
        ("impact88.golden", "arithmetic/add.tsv.gz"),
        ("impact88.web", "templates/layout.html"),
        ("impact88.report", "templates/case.html"),
    ],
)
def test_data_is_found_as_a_resource_of_the_package(package: str, name: str) -> None:
    assert files(package).joinpath(name).is_file()


def test_the_version_is_in_one_place(project: dict[str, Any]) -> None:
    assert "version" in project["project"]["dynamic"]
    place = project["tool"]["setuptools"]["dynamic"]["version"]["attr"]
    assert place == "impact88.version.__version__"
    assert re.fullmatch(r"\d+\.\d+\.\d+(\.dev\d+)?", impact88.__version__)
    assert version("impact88") == impact88.__version__


def test_classifiers_begin_with_the_lowest_python(project: dict[str, Any]) -> None:
    said = re.findall(r"Python :: (3\.\d+)", "\n".join(project["project"]["classifiers"]))
    assert f">={said[0]}" == project["project"]["requires-python"]


@pytest.mark.parametrize("name", sorted(impact88._LAZY))
def test_every_public_name_is_there_whatever_was_imported_before(name: str) -> None:
    """Also where a module has its function's name: importing it must not hide the function."""
    place, _, inner = impact88._LAZY[name].partition(":")
    module = import_module(f"impact88.{place or name}")
    public = getattr(impact88, name)
    assert public is (getattr(module, inner or name) if place else module)


def test_the_commit_is_named_where_it_is_known(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A distribution holds it, a checkout is asked, and any other copy does not know."""
    from impact88 import version as module

    folder = tmp_path / "port" / "impact88"
    folder.mkdir(parents=True)
    monkeypatch.setattr(module, "__file__", str(folder / "version.py"))
    assert module.commit() is None
    assert module.full_version() == impact88.__version__
    git = ["git", "-C", str(tmp_path), "-c", "user.name=a", "-c", "user.email=a@example.org"]
    if shutil.which("git"):
        subprocess.run([*git, "init", "-q"], check=True)
        (tmp_path / "file").write_text("1", "utf-8")
        subprocess.run([*git, "add", "file"], check=True)
        subprocess.run([*git, "commit", "-q", "-m", "first"], check=True)
        head = subprocess.check_output([*git, "rev-parse", "HEAD"], text=True).strip()
        assert module.commit() == head[:12]
        (tmp_path / "file").write_text("2", "utf-8")
        assert module.commit() == f"{head[:12]}-dirty"
    (folder / "commit.txt").write_text("0123456789ab\n", "ascii")
    assert module.full_version() == f"{impact88.__version__} (commit 0123456789ab)"
