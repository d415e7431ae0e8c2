"""What is published works where it is installed: every packaged file, outside the checkout; and in
a browser's Python (Pyodide), where node is and IMPACT88_PYODIDE names a folder with npm's package.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from captures import ROOT

from impact88.interface.commands.cli import main

pytest.importorskip("setuptools", "70.1", reason="older ones build no wheel by themselves")

DOCUMENTS = {".md", ".typed", ".c", ".h"}
"""Kinds of files for people, type checkers and compilers; the program itself need not open them."""

BUILD = "import sys; sys.path.insert(0, '.ci'); import backend; backend.build_wheel(sys.argv[1])"
USE = """
import contextlib, io, json, os, sys
opened = set()
uses = ("open", "ctypes.dlopen")
sys.addaudithook(lambda event, told: opened.add(str(told[0])) if event in uses else None)
import numpy
from impact88 import sample
from impact88.interface.commands import cli
from impact88.interface.desk import app
from impact88.equations import edits
from impact88.printouts.scan.typeface import prototypes
from impact88.messages.schemas import NUMBERS, text
statuses = {}
def run(*arguments):
    with contextlib.redirect_stdout(io.StringIO()) as out:
        statuses[" ".join(arguments)] = cli.main(arguments)
    return out.getvalue()
vectors = run("oracle", "--vectors").splitlines()
run("selfcheck", "-o", "record.txt")
run("schema", "conventions")
for name in NUMBERS:
    run("schema", name)
run("basic")
for name in "listing run1 run2 table3".split():
    run("verify", "--brief", os.path.join(sys.argv[1], "legacy", f"{name}-as-printed.txt"))
run("solve", "--sample", "1")
run("chapter", "staged")
run("oracle", "--kit", "kit", "--vectors", "30")
with open("scene.toml", "w") as file:
    file.write(run("scene", "--sample", "1"))
run("report", "scene.toml", "-o", "report.html")
edits.readings(), edits.variants(), edits._rules()  # what compare looks up
prototypes()  # of a scan
with open(os.path.join(sys.argv[1], "legacy", "run1-as-printed.txt")) as file:
    page = file.read()
with open("altered.txt", "w") as file:
    file.write(page.replace("-13.263", "-18.263"))
run("verify", "altered.txt", "--report", "verified.html")
desk = app.Desk()
client = app.application(desk, 8088, "word").test_client()
pages = ["/word/", *(f"/word/static/{name}" for name in sys.argv[2:])]
own = "http://127.0.0.1:8088"
pages = [client.get(page, base_url=own).status_code for page in pages]
form = {"values": dict(sample(1)), "units": ""}
answer = client.post("/word/collision", json=form, base_url=own, headers={"Origin": own})
pages.append(answer.status_code)
desk.close()
print(json.dumps([cli.__file__, sorted(opened), statuses, len(vectors), pages]))
"""


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder that holds what a wheel of this checkout installs: one that IMPACT88_WHEEL names, or
    one that is built here."""
    folder = tmp_path_factory.mktemp("wheel")
    if built := os.environ.get("IMPACT88_WHEEL"):
        return unpacked(Path(built), folder / "site")
    cruft = shutil.ignore_patterns("__pycache__", "*.egg-info", "build")
    for name in ("port", "legacy", "golden", ".ci"):
        shutil.copytree(ROOT / name, folder / "source" / name, ignore=cruft)
    shutil.copy(ROOT / "README.md", folder / "source")
    project = (ROOT / "pyproject.toml").read_text("utf-8")
    assert '"-O2"' in project  # which takes the compiler five seconds
    (folder / "source" / "pyproject.toml").write_text(project.replace('"-O2"', '"-O0"'), "utf-8")
    subprocess.run(
        [sys.executable, "-c", BUILD, str(folder)],
        cwd=folder / "source",
        env={**os.environ, "SOURCE_DATE_EPOCH": "600000000"},
        capture_output=True,
        check=True,
    )
    return unpacked(next(folder.glob("*.whl")), folder / "site")


def unpacked(wheel: Path, site: Path) -> Path:
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(site)
    return site


@pytest.mark.long
def test_every_packaged_file_is_used(installed: Path, tmp_path: Path) -> None:
    package = installed / "impact88"
    static = sorted(path.name for path in (package / "interface" / "desk" / "static").iterdir())
    done = subprocess.run(
        [sys.executable, "-c", USE, str(package), *static],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(installed)},
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    where, opened, statuses, vectors, pages = json.loads(done.stdout)
    assert Path(where).is_relative_to(installed)
    adverse = ("listing-as", "table3-as", "altered")
    assert {told for name, told in statuses.items() if not any(x in name for x in adverse)} == {0}
    assert vectors == 1000
    data = {path for path in package.rglob("*") if path.is_file() and path.suffix != ".py"}
    data = {path for path in data if "__pycache__" not in path.parts}
    unused = data - {Path(path) for path in opened}
    assert not {path for path in unused if path.suffix not in DOCUMENTS}
    assert set(pages) == {200}


BROWSER = """
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";
const [npm, site] = process.argv.slice(2);
const found = createRequire(npm + "/from.js").resolve("pyodide/pyodide.mjs");
const { loadPyodide } = await import(pathToFileURL(found));
const quiet = () => {};
const pyodide = await loadPyodide({ stdout: quiet, stderr: quiet });
await pyodide.loadPackage("numpy", { messageCallback: quiet, errorCallback: quiet }).catch(quiet);
pyodide.FS.mkdirTree("/site");
pyodide.FS.mount(pyodide.FS.filesystems.NODEFS, { root: site }, "/site");
console.log(pyodide.runPython(`
import contextlib, importlib.util, io, json, sys
sys.path.insert(0, "/site")
from impact88.interface.commands.cli import main
statuses, texts = {}, {}
numpy = ["solve", "verify", "selfcheck"] if importlib.util.find_spec("numpy") else []
asked = {
    "run": ("run", "--sample", "1"),
    "basic": ("basic", "/site/loop.bas"),
    "solve": ("solve", "--sample", "1"),
    "verify": ("verify", "/site/impact88/legacy/run1-as-printed.txt"),
    "selfcheck": ("selfcheck",),
}
for name in ["run", "basic", *numpy]:
    with contextlib.redirect_stdout(io.StringIO()) as out:
        statuses[name] = main(asked[name])
    texts[name] = out.getvalue()
json.dumps([statuses, texts])`));
"""


@pytest.mark.long
def test_in_a_browser(installed: Path, capsys: pytest.CaptureFixture[str]) -> None:
    npm = os.environ.get("IMPACT88_PYODIDE")
    if not npm or not shutil.which("node"):
        pytest.skip("IMPACT88_PYODIDE names no folder with npm's pyodide, or there is no node")
    program = installed / "browser.mjs"
    program.write_text(BROWSER)
    (installed / "loop.bas").write_text('10 FOR I = 1 TO 3 : PRINT I / 3; " "; : NEXT\n')
    done = subprocess.run(
        ["node", str(program), npm, str(installed)], capture_output=True, text=True, timeout=600
    )
    assert done.returncode == 0, done.stderr
    statuses, texts = json.loads(done.stdout)
    assert set(statuses.values()) == {0}
    assert main(["run", "--sample", "1"]) == 0
    assert texts["run"] == capsys.readouterr().out
    assert texts["basic"].split() == [".333333333", ".666666667", "1"]
    if "verify" not in texts:
        pytest.skip("run and basic are right; numpy could not be had for verify and selfcheck")
    assert "IDENTICAL" in texts["verify"]
    assert texts["selfcheck"].rstrip().endswith("PASS")
