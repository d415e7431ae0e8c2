"""The wings and rooms of port/impact88: data flows one way, and lower ones never import upper ones.

At the root stand the wings, and the ground that all of them may use: `names`, `status`, `errors`,
`files`, `version` and `messages`. The core is what stands alone.
"""

from __future__ import annotations

import ast
import re
from collections import Counter
from functools import cache
from graphlib import CycleError, TopologicalSorter
from importlib.util import resolve_name
from pathlib import Path

import pytest
from captures import ROOT

import impact88

PACKAGE = ROOT / "port" / "impact88"


def name_of(path: Path) -> str:
    parts = path.relative_to(ROOT / "port").with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


FILES = {name_of(path): path for path in PACKAGE.rglob("*.py")}


def imported(name: str) -> set[str]:
    """The modules of this package that a module imports, at its top or on first use."""
    path = FILES[name]
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            base = resolve_name("." * node.level + (node.module or ""), package)
            for alias in node.names:
                whole = f"{base}.{alias.name}"
                found.add(whole if whole in FILES else base)
        elif isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
    return {module for module in found if module in FILES} - {name}


@cache
def rooms() -> dict[str, set[str]]:
    """The imports of every module: read when a test asks, not when tests are collected."""
    return {name: imported(name) for name in FILES}


def test_no_room_is_both_above_and_below_another() -> None:
    # the package itself holds no more than its version
    graph = {name: modules - {"impact88"} for name, modules in rooms().items()}
    try:
        list(TopologicalSorter(graph).static_order())
    except CycleError as error:
        pytest.fail(" -> ".join(error.args[1]))


def package_of(name: str) -> str:
    """The package that a module is in; a package is in itself."""
    return name if FILES[name].name == "__init__.py" else name.rpartition(".")[0]


def test_no_package_imports_another_that_imports_it() -> None:
    """Imports within functions count: what is imported on first use is needed as well."""
    graph: dict[str, set[str]] = {}
    for name, modules in rooms().items():
        own = package_of(name)
        packages = {package_of(module) for module in modules} - {own, "impact88"}
        if own != "impact88":
            graph.setdefault(own, set()).update(packages)
    try:
        list(TopologicalSorter(graph).static_order())
    except CycleError as error:
        pytest.fail(" -> ".join(error.args[1]))


CORE = ("apple", "collision", "mechanics", "program")
GROUND_BOXES = ("errors", "files", "messages", "names", "status", "version")
BOXES = sorted({name.split(".")[1] for name in FILES if "." in name} - {"__main__"})
WINGS = tuple(box for box in BOXES if box not in GROUND_BOXES)


def box_of(name: str) -> str:
    """The folder or module at the root that a module is in; "" for the package itself."""
    return name.split(".")[1] if "." in name else ""


def wings_imported(box: str) -> set[str]:
    """The wings that a wing, or a box of the ground, imports, on first use too."""
    modules = {module for name, used in rooms().items() if box_of(name) == box for module in used}
    return {box_of(module) for module in modules} & set(WINGS) - {box}


def test_the_wings_are_in_an_order() -> None:
    try:
        list(TopologicalSorter({wing: wings_imported(wing) for wing in WINGS}).static_order())
    except CycleError as error:
        pytest.fail(" -> ".join(error.args[1]))


@pytest.mark.parametrize("wing", WINGS)
def test_a_wing_says_what_it_needs(wing: str) -> None:
    """And what comes in, what goes out, the way through it and who uses it, at its top."""
    path = PACKAGE / wing / "__init__.py"
    says = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    parts = re.split(r"\b(Needs|In|Out|Way|Used by): ", says)
    assert parts[1::2] == ["Needs", "In", "Out", "Way", "Used by"]
    assert set(re.findall(r"`(\w+)`", parts[2])) == wings_imported(wing)
    assert ("Core." in parts[2]) == (wing in CORE)
    way = re.findall("`(.*?)`", re.sub(r"\(.*?\)", "", parts[8]))
    assert {f"impact88.{wing}.{step}" for step in way} <= {*FILES}
    assert len(says.splitlines()) <= 14


def test_the_core_and_the_ground_need_no_other_wing() -> None:
    for wing in CORE:
        assert wings_imported(wing) <= set(CORE), wing
    for box in GROUND_BOXES:
        assert not wings_imported(box), box


def test_tests_stand_in_the_folders_of_the_wings() -> None:
    folders = {path.name for path in (ROOT / "tests").iterdir() if any(path.glob("**/test_*.py"))}
    assert folders <= {*WINGS, "messages", "doors"}


MAX_BOXES = 17  # folders and modules at the root: what a reader takes in at a glance


def test_the_root_is_a_table_of_contents() -> None:
    """A package is found from the question, and none has the name of a public function."""
    assert len(BOXES) <= MAX_BOXES, BOXES
    public = {name for name in impact88.__all__ if callable(getattr(impact88, name))}
    packages = {name.rpartition(".")[2] for name in FILES if FILES[name].name == "__init__.py"}
    assert not packages & public


MACHINE = ("impact88.apple.applesoft", "impact88.apple.emulator")
LOADER = ("impact88.apple.emulator.programfile", "impact88.errors")
"""It reads what a user hands over, and what it tells the user is what all errors are."""


def test_applesoft_knows_nothing_of_collisions() -> None:
    outside = {
        (name, module)
        for name, modules in rooms().items()
        if name.startswith(MACHINE)
        for module in modules
        if not module.startswith(MACHINE) and (name, module) != LOADER
    }
    assert not outside


def test_only_commands_import_commands() -> None:
    upper = ("impact88.interface.commands.", "impact88.interface.commands.cli")
    below = {
        (name, module)
        for name, modules in rooms().items()
        if not name.startswith((*upper, "impact88.interface.commands", "impact88.__main__"))
        for module in modules
        if module.startswith(upper)
    }
    assert not below


SHARE = "impact88.program.scene", "impact88.mechanics.closedform.general"
"""An MU of "85 %" is no typed digit: it is computed first, as over arrays."""


@pytest.mark.parametrize(
    "name", ["impact88.program.listing", "impact88.program.run", "impact88.program.scene"]
)
def test_faithful_path_imports_no_third_party(name: str) -> None:
    """Nothing but Python's own library lies between a typed digit and a printed one."""
    seen, waiting = set(), {name}
    while waiting:
        module = waiting.pop()
        seen.add(module)
        waiting |= {other for other in rooms()[module] if (module, other) != SHARE} - seen
        text = FILES[module].read_text(encoding="utf-8")
        assert not {"numpy", "matplotlib", "mpmath", "scipy"} & {
            (node.names[0].name if isinstance(node, ast.Import) else node.module or "").split(".")[
                0
            ]
            for node in ast.walk(ast.parse(text))
            if isinstance(node, ast.Import | ast.ImportFrom)
        }, module


def needed(name: str) -> set[str]:
    """A module and all that it imports, and they in turn, on first use too."""
    seen, waiting = set(), {name}
    while waiting:
        module = waiting.pop()
        seen.add(module)
        waiting |= rooms()[module] - seen
    return seen


GROUND = {
    "impact88.names",
    "impact88.errors",
    "impact88.collision.fields",
    "impact88.collision.doubles",
}
"""Tables of names and fields, decimal text to double, and the error users are shown."""
FAITHFUL = {"impact88.program.listing", "impact88.program.arithmetics"}


def test_the_faithful_path_needs_no_other_room() -> None:
    """Whatever else this project grows, what prints the 1988 digits stands alone."""
    for name in sorted(FILES):
        if name in FAITHFUL or name.startswith("impact88.apple.applesoft"):
            own = {n for n in needed(name) if n.startswith("impact88.apple.applesoft")}
            assert needed(name) <= own | FAITHFUL | GROUND, name


def test_no_module_name_is_used_twice() -> None:
    """A traceback, a test and a search name a module by its last part."""
    names = Counter(
        name.rpartition(".")[2] for name, path in FILES.items() if path.stem != "__init__"
    )
    assert not [name for name, uses in names.items() if uses > 1]


def test_long_functions_and_those_of_many_arguments_say_why() -> None:
    """More than 60 lines below the docstring, or 7 arguments: a comment says why not fewer."""
    silent = []
    for name, path in FILES.items():
        text = path.read_text(encoding="utf-8")
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.FunctionDef):
                arguments = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
                is_short = len([one for one in arguments if one.arg != "self"]) <= 7
                docstring_end = node.body[0].end_lineno if ast.get_docstring(node) else node.lineno
                is_short &= (node.end_lineno or 0) - (docstring_end or 0) <= 60
                source = "\n".join(text.split("\n")[node.lineno - 1 : node.end_lineno])
                if not is_short and not re.search("# .*(not split|arguments).*: ", source):
                    silent.append(f"{name}.{node.name}")
    assert not silent
