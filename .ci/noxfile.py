"""Checks of a change, `nox -f .ci/noxfile.py`, and of a release, `... -t release`."""

import re
import shutil
import tomllib
from pathlib import Path

import nox

ROOT = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
PYTHONS = [c.rpartition(" ")[2] for c in PROJECT["classifiers"] if ":: Python :: 3." in c]
CORE = ["tests/apple", "tests/program", "tests/mechanics", "tests/cases", "tests/tables"]

nox.options.sessions = ["tests", "lint", "docs"]
nox.options.reuse_existing_virtualenvs = True
nox.options.error_on_missing_interpreters = False


def requirements(*extras: str) -> list[str]:
    """Return what extras of pyproject.toml need."""
    return [line for name in extras for line in PROJECT["optional-dependencies"][name]]


@nox.session
def tests(session: nox.Session) -> None:
    """Run all tests."""
    session.chdir(ROOT)
    session.install("-e", ".[test]")
    session.run("pytest", *session.posargs)


@nox.session
def lint(session: nox.Session) -> None:
    """Check style, types and the order of imports."""
    session.chdir(ROOT)
    session.install("-e", ".", *requirements("test", "lint"))
    session.run("ruff", "check", "port", "tests", ".ci")
    session.run("ruff", "format", "--check", "port", "tests", ".ci")
    session.run("mypy")
    session.run("lint-imports")


@nox.session
def docs(session: nox.Session) -> None:
    """Build the guide and the reference."""
    session.chdir(ROOT)
    session.install("-e", ".[docs]")
    session.run("sphinx-build", "-W", "--keep-going", "--quiet", "port/docs", "build/docs")


@nox.session(tags=["release"], python=PYTHONS)
def pythons(session: nox.Session) -> None:
    """Run the tests on every Python that pyproject.toml promises."""
    session.chdir(ROOT)
    session.install(".[test]")
    session.run("pytest", *session.posargs)


@nox.session(tags=["release"])
def pure(session: nox.Session) -> None:
    """Run the tests of what has a compiled part, installed without a compiler."""
    session.chdir(ROOT)
    shutil.rmtree("build/lib", ignore_errors=True)
    session.install("--no-cache-dir", ".[test]", env={"CC": "false"})
    session.run("python", "-c", "import impact88; assert impact88.accelerated is None")
    session.run("pytest", *CORE)


@nox.session(tags=["release"])
def lowest(session: nox.Session) -> None:
    """Run the tests with the lowest versions that pyproject.toml promises."""
    session.chdir(ROOT)
    lines = [*PROJECT["dependencies"], *requirements("test")]
    pins = [re.sub(r">=([\d.]+)$", r"==\1.*", line) for line in lines]
    session.install(*pins)
    session.install("--no-deps", ".")
    session.run("pytest", *CORE)


@nox.session(tags=["release"])
def sanitized(session: nox.Session) -> None:
    """Run the tests of the compiled part with the address and undefined sanitizers."""
    session.chdir(ROOT)
    flags = "-O1 -g -fsanitize=address,undefined -fno-sanitize-recover=undefined"
    session.install("-e", ".[test]", env={"CFLAGS": flags, "LDFLAGS": flags})
    runtime = session.run("gcc", "-print-file-name=libasan.so", external=True, silent=True)
    options = {"LD_PRELOAD": str(runtime).strip(), "ASAN_OPTIONS": "detect_leaks=0"}
    skipped = ["-k", "not switch_of_the_environment"]  # starts a Python without the runtime
    session.run("pytest", "-n", "0", *skipped, "tests/mechanics", "tests/program", env=options)


@nox.session(tags=["release"])
def web(session: nox.Session) -> None:
    """Drive the web page in headless Chromium."""
    session.chdir(ROOT)
    session.install("-e", ".[test,web,browser]")
    session.run("pytest", "-m", "browser", "tests/web")


@nox.session(tags=["release"])
def wheel(session: nox.Session) -> None:
    """Build the wheel twice, to the same bytes, and try it."""
    session.chdir(ROOT)
    session.install("build")
    wheels = []
    for folder in ("dist/first", "dist/second"):
        shutil.rmtree(folder, ignore_errors=True)
        session.run("python", "-m", "build", "--outdir", folder)
        wheels.extend(Path(folder).glob("*.whl"))
    first, second = (path.read_bytes() for path in wheels)
    if first != second:
        session.error("two builds differ")
    session.install(str(wheels[0]))
    session.run("impact88", "selfcheck")
