"""The steps of "Adding things" in port/README.md, done in a copy of the project.

Each thing is added as the page says and used as a user would. Then each step is left out once, and
the test file that the page names fails with a message that says the next step.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import pytest
from captures import ROOT

from impact88.mechanics import native

pytestmark = [pytest.mark.long, pytest.mark.captures]

PAGE = (ROOT / "port" / "README.md").read_text(encoding="utf-8")


class Step(NamedTuple):
    """A text put into a file before the first ``anchor`` in it; a new file where there is none.

    ``message`` is part of what the test says that fails where this step alone is missing, or, of a
    mistake, where it stands in place of the step in the same file. ``test`` is the file of that
    test where it is not the addition's.
    """

    file: str
    text: str
    anchor: str
    message: str
    test: str = ""


class Addition(NamedTuple):
    """A thing to add: its ``heading`` in port/README.md; the ``test`` file named there and which of
    its tests are ``chosen``; the ``steps``; ``mistakes`` in steps; and a ``command`` with part
    of what it ``prints`` and its exit status when all is done. ``page``: a file for the command."""

    heading: str
    test: str
    chosen: str
    steps: tuple[Step, ...]
    mistakes: tuple[Step, ...]
    command: tuple[str, ...]
    prints: str
    status: int = 0
    page: str = ""


PACKAGE = "port/impact88"

RESULT = Addition(
    heading="A result of `solve`",
    test="tests/mechanics/test_accuracy.py",
    chosen="formula_and_a_reference or (any_population and casework)",
    steps=(
        Step(
            f"{PACKAGE}/names.py",
            '    ("PS", "P", "size of the impulse on A", "mass·length/time"),\n',
            '    ("PM", "M", "moment impulse on A"',
            "next step: a row for PS in RESULTS of names.py",
        ),
        Step(
            f"{PACKAGE}/mechanics/closedform/impact.py",
            '        "PS": table.root(Px * Px + Py * Py),\n',
            '        "STATUS": STATUS',
            "next step: 'PS' in what `impact` returns, in mechanics/closedform/impact.py",
        ),
        Step(
            f"{PACKAGE}/mechanics/accuracy/reference.py",
            '        f["PS"] = size\n',
            '        f |= {"DVA": t.inverses[0] * size',
            "next step: 'PS' in what `fifty_digits` returns, in mechanics/accuracy/reference.py",
        ),
    ),
    mistakes=(
        Step(
            f"{PACKAGE}/mechanics/closedform/impact.py",
            '        "PS": table.root(Px * Px - Py * Py),\n',
            '        "STATUS": STATUS',
            "PS is off by",
        ),
    ),
    command=("solve", "--sample", "1", "--outputs", "PS", "--results-only"),
    prints="PS [lb-s]\n2317.5358",
)
UNIT = Addition(
    heading="A unit",
    test="tests/collision/test_units.py",
    chosen="every_unit or every_definition",
    steps=(
        Step(
            f"{PACKAGE}/collision/units.py",
            '    Unit("fur furlong furlongs", _LENGTH, 660 * _FOOT, _US),\n',
            '    Unit("mi mile miles"',
            "next step: a row for fur in UNITS of collision/units.py",
        ),
        Step(
            "tests/collision/test_units.py",
            '    "fur": ("length", 201.168),\n',
            '    "mi": ("length"',
            "in SIZES of tests/collision/test_units.py",
        ),
    ),
    mistakes=(
        Step(
            f"{PACKAGE}/collision/units.py",
            '    Unit("fur furlong furlongs", _LENGTH, 220 * _FOOT, _US),\n',
            '    Unit("mi mile miles"',
            "fur has another size than SIZES says",
        ),
    ),
    command=("run", "--sample", "1", "--set", "DA=0.01 furlongs"),
    prints="DA= 6.6 ",
)
BARS = """\
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from .lines import open_text, writing
from .rows import Named, Put, Reader, Rows, scene_names, shortest


@contextmanager
def read(path: str, form: str, encoding: str | None, results: bool) -> Iterator[Reader]:
    with open_text(path, encoding) as lines:
        header, *records = [line.rstrip("\\n").split("|") for line in lines]
        names = scene_names(header, path, results)
        columns = dict(zip(names, zip(*records, strict=True), strict=True))
        yield Reader(names, [Rows(len(records), columns)], len(records))


@contextmanager
def write(path: str, form: str, delimiter: str, headings: Sequence[str]) -> Iterator[Put]:
    with writing(path) as file:
        file.write("|".join(headings) + "\\n")

        def put(columns: Named) -> None:
            texts = [shortest(cells) if hasattr(cells, "dtype") else cells for _, cells in columns]
            file.writelines("|".join(row) + "\\n" for row in zip(*texts, strict=True))

        yield put
"""
BARS_ROW = Step(
    f"{PACKAGE}/tables/formats.py",
    """\
    Format(
        name="bars",
        endings=(".bars",),
        module="barstable",
        summary="columns between vertical bars",
        noun="a table between bars",
        is_text=True,
    ),
""",
    '    Format(\n        name="npz"',
    "next step: its row in ROWS of tables/formats.py",
)
FORMAT = Addition(
    heading="A format of tables",
    test="tests/tables/test_tables.py",
    chosen="registered or (same_bits and bars)",
    steps=(
        Step(
            f"{PACKAGE}/tables/barstable.py", BARS, "", "next step: tables/barstable.py with read"
        ),
        BARS_ROW,
    ),
    mistakes=(
        Step(
            f"{PACKAGE}/tables/barstable.py",
            BARS.replace("def write(", "def write_bars("),
            "",
            "next step: write(path, form, delimiter, headings) in tables/barstable.py",
        ),
        BARS_ROW._replace(
            text=BARS_ROW.text.replace('(".bars",)', '(".txt",)'),
            message=".txt is bars's ending, too",
        ),
    ),
    command=("solve", "--sample", "1", "--to", "bars", "--outputs", "VAX", "--results-only"),
    prints="VAX [ft/s]\n-13.26",
)
COMMAND = Addition(
    heading="A command",
    test="tests/interface/commands/test_commands.py",
    chosen="registered or help_lists or mentioned or hello",
    steps=(
        Step(
            f"{PACKAGE}/interface/commands/hello_command.py",
            """\
\"\"\"It greets whoever is named.\"\"\"

from . import options

ARGUMENTS = (options.value("name", "NAME", "whom to greet"),)


def main(args: options.Args) -> None:
    print(f"HELLO {args.name}")
""",
            "",
            "next step: interface/commands/hello_command.py with ARGUMENTS and main",
        ),
        Step(
            f"{PACKAGE}/interface/commands/__init__.py",
            '    Command("hello", _OTHER, "greet somebody"),\n',
            '    Command("schema", ',
            "next step: its row in ROWS of interface/commands/__init__.py",
        ),
        Step(
            "port/docs/guide/apple.md",
            "```console\n$ impact88 hello Brach\nHELLO Brach\n```\n\n",
            "`impact88 basic` is the",
            "next step: an example in a chapter of port/docs/guide/",
        ),
        Step(
            "README.md",
            "| greetings | `impact88 hello` |\n",
            "| the Apple at its `]` prompt |",
            "next step: hello in README.md's table of commands",
            "tests/doors/test_readme.py",
        ),
    ),
    mistakes=(
        Step(
            f"{PACKAGE}/interface/commands/hello_command.py",
            '"""It greets."""\n\nARGUMENTS = ()\n',
            "",
            "next step: main in interface/commands/hello_command.py",
        ),
        Step(
            "port/docs/guide/apple.md",
            "```console\n$ impact88 hello Brach\nGOOD MORNING\n```\n\n",
            "`impact88 basic` is the",
            "HELLO Brach",
            "tests/doors/test_readme.py",
        ),
    ),
    command=("hello", "Brach"),
    prints="HELLO Brach\n",
)
STORED = '10 DIM A(1): STORE A: PRINT "STORED"\n'
STORE = Step(
    f"{PACKAGE}/apple/emulator/inputoutput.py",
    """\
    def store_(self) -> None:
        \"\"\"STORE: an array, to a tape that is not there.\"\"\"
        self.variable(self.sp - 4)

""",
    "    def show_message(self",
    "tape_store.bas has STORE, which is not done; next step: the statement's method",
)
STATEMENT = Addition(
    heading="A statement of the emulator",
    test="tests/apple/emulator/test_emulator.py",
    chosen="statement or tape_store",
    steps=(
        STORE,
        Step(
            "golden/programs/tape_store.bas",
            STORED,
            "",
            "STORE is done, and no captured program has it; next step: a program",
        ),
        Step("golden/programs/tape_store.out", "STORED\n", "", "tape_store.out"),
    ),
    mistakes=(
        STORE._replace(
            text=STORE.text.replace("store_", "tape_"),
            message="tape_ is called by no statement; next step: name the method for its keyword",
        ),
    ),
    command=("basic", "page.txt"),
    prints="STORED\n",
    page=STORED,
)
SAMPLE = (ROOT / "golden" / "printouts" / "run1.txt").read_text(encoding="utf-8")
SHAPE = Step(f"{PACKAGE}/printouts/reading/channel.txt", "\n8 €", " B&S\n9 PGY", "")
LOOK_ALIKE = Addition(
    heading="A look-alike of `verify`",
    test="tests/printouts/test_reading.py",
    chosen="alike",
    steps=(SHAPE,),
    mistakes=(
        SHAPE._replace(text="\n8 €3", message="a 3 read for 8 contradicts the page; next step"),
        SHAPE._replace(text="\n% €", message="% is no row of [numbers]"),
        Step(SHAPE.file, " €", "\n9 4751", "€ has no count"),
    ),
    command=("verify", "--brief", "page.txt"),
    prints="VBY read '€' where the program prints '8' (19.982)",
    status=1,
    page=SAMPLE.replace("VBY= 19.982", "VBY= 19.9€2"),
)
FOLDER = Addition(
    heading="A package folder",
    test="tests/doors/test_package.py",
    chosen="package_folder",
    steps=(
        Step(
            f"{PACKAGE}/weather/__init__.py",
            '"""Rain."""\n',
            "",
            "next step: port/impact88/weather/__init__.py",
        ),
        Step(
            "port/README.md",
            "| `weather/` | rain |\n",
            "| `desk/` |",
            "next step: a row for `weather/` in port/README.md's rooms",
        ),
        Step(
            "pyproject.toml",
            '    "impact88.weather",\n',
            "]\npackage-dir",
            "next step: 'impact88.weather' in the list `packages` of pyproject.toml",
        ),
    ),
    mistakes=(),
    command=("--version",),
    prints="",
)
ADDITIONS = (RESULT, UNIT, FORMAT, COMMAND, STATEMENT, LOOK_ALIKE, FOLDER)
OMISSIONS = [(addition, step) for addition in ADDITIONS for step in addition.steps if step.message]
MISTAKES = [(addition, step) for addition in ADDITIONS for step in addition.mistakes]


class Copy:
    """A copy of the project, in which texts are changed for a while."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self._changes = 0
        for name in ("port", "tests", "golden", "legacy"):
            shutil.copytree(ROOT / name, root / name, ignore=shutil.ignore_patterns("__pycache__"))
        for name in ("README.md", "pyproject.toml", ".gitignore"):
            shutil.copy(ROOT / name, root / name)
        for name in ("golden", "legacy"):  # as pyproject.toml maps them
            (root / PACKAGE / name).symlink_to(root / name)

    def _write(self, path: Path, text: str) -> None:
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
        self._changes += 1  # a time of its own: what was compiled of another text is not used
        os.utime(path, (self._changes, self._changes))

    @contextmanager
    def changed(self, steps: Sequence[Step]) -> Iterator[None]:
        """Do the steps, and undo them at the end."""
        texts: dict[Path, str | None] = {}
        for step in steps:
            path = self.root / step.file
            text = path.read_text(encoding="utf-8") if step.anchor else ""
            texts.setdefault(path, text if step.anchor else None)
            assert step.anchor in text, f"{step.file} has no {step.anchor!r}"
            at = text.index(step.anchor)
            self._write(path, text[:at] + step.text + text[at:])
        try:
            yield
        finally:
            for path, kept in texts.items():
                if kept is not None:
                    self._write(path, kept)
                elif path.name == "__init__.py":
                    shutil.rmtree(path.parent)
                else:
                    path.unlink()

    def python(self, *arguments: str, **options: str) -> subprocess.CompletedProcess[str]:
        """Run Python on the copy, where it finds nothing of the project itself."""
        variables = {name: x for name, x in os.environ.items() if not name.startswith("PYTEST")}
        return subprocess.run(
            [sys.executable, *arguments],
            cwd=self.root,
            env={**variables, "PYTHONPATH": str(self.root / "port"), **options},
            capture_output=True,
            encoding="utf-8",
            timeout=300,
            check=False,
        )

    def test(self, file: str, chosen: str, *options: str) -> subprocess.CompletedProcess[str]:
        """Run some tests of a file."""
        plain = ("-n", "0", "-q", "-p", "no:cacheprovider", "--color=no")
        return self.python("-m", "pytest", *plain, file, "-k", chosen, *options)


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Copy:
    made = Copy(tmp_path_factory.mktemp("copy"))
    where = made.python("-c", "import impact88; print(impact88.__file__)").stdout
    assert where.startswith(str(made.root))
    return made


def named(item: object) -> str:
    """A name for a test: the addition's heading, the step's file."""
    if isinstance(item, Addition):
        return item.heading.replace(" ", "-").replace("`", "")
    assert isinstance(item, Step)
    return item.file.replace("/", "-")


@pytest.mark.parametrize("addition", ADDITIONS, ids=named)
def test_what_is_added_as_the_page_says_works(addition: Addition, copy: Copy) -> None:
    with copy.changed(addition.steps):
        (copy.root / "page.txt").write_text(addition.page, encoding="utf-8")
        done = copy.python("-m", "impact88", *addition.command)
        assert done.returncode == addition.status, done.stderr
        assert addition.prints in done.stdout
        for file in {addition.test, *(step.test for step in addition.steps)} - {""}:
            passed = copy.test(file, addition.chosen)
            assert passed.returncode == 0, passed.stdout


@pytest.mark.parametrize(("addition", "left_out"), OMISSIONS, ids=named)
def test_a_step_left_out_is_the_next_step(addition: Addition, left_out: Step, copy: Copy) -> None:
    with copy.changed([step for step in addition.steps if step is not left_out]):
        failed = copy.test(left_out.test or addition.test, addition.chosen)
    assert failed.returncode not in (0, 5), failed.stdout
    assert left_out.message in failed.stdout


@pytest.mark.parametrize(("addition", "mistake"), MISTAKES, ids=named)
def test_a_mistake_in_a_step_is_named(addition: Addition, mistake: Step, copy: Copy) -> None:
    steps = [mistake if step.file == mistake.file else step for step in addition.steps]
    with copy.changed(steps):
        failed = copy.test(mistake.test or addition.test, addition.chosen)
    assert failed.returncode not in (0, 5), failed.stdout
    assert mistake.message in failed.stdout


@pytest.mark.skipif(native.library is None, reason="built without a C compiler")
def test_loops_of_older_formulas_are_made_anew_as_the_test_says(copy: Copy) -> None:
    """Each failure says the next step, until only the library is left to build."""
    test = "tests/mechanics/test_native.py"
    loops = copy.root / PACKAGE / "mechanics/native/loops.h"
    kept = loops.read_text(encoding="utf-8")
    programs = f"{PACKAGE}/mechanics/closedform/impactprograms.py"
    try:
        with copy.changed(RESULT.steps):
            generator = "python -m impact88.mechanics.loops"
            assert f"next step: {generator}" in copy.test(test, "say").stdout
            assert copy.python(*generator.split()[1:]).returncode == 0
            assert "TO_PS" not in kept
            said = re.search(
                r'next step: (FORMULAS = "\w+") in (\S+)', copy.test(test, "say").stdout
            )
            assert said
            assert programs.endswith(said[2])
            with copy.changed([Step(programs, f"{said[1]}\n", "\nALL = ", "")]):
                assert "next step: pip install -e ." in copy.test(test, "say").stdout
    finally:
        loops.write_text(kept, encoding="utf-8")


@pytest.mark.parametrize("addition", ADDITIONS, ids=named)
def test_the_page_names_the_test_and_every_file(addition: Addition) -> None:
    section = re.search(rf"\*\*{re.escape(addition.heading)}\*\*(.*?)(?=\n\*\*|\n## )", PAGE, re.S)
    assert section, addition.heading
    for file in {addition.test, *(step.test for step in addition.steps)} - {""}:
        assert f"`{file}`" in section[1]
