"""setuptools, so that one commit gives the same bytes whenever and wherever it is built.

setuptools looks for the list of what belongs to a source distribution in MANIFEST.in alone; here it
is .ci/manifest, because the top level holds no such file.
"""

import gzip
import os
import subprocess
import sys
import tarfile
import zipfile
from contextlib import contextmanager
from pathlib import Path

from setuptools import build_meta
from setuptools.build_meta import *  # noqa: F403
from setuptools.command.bdist_wheel import bdist_wheel
from setuptools.command.egg_info import manifest_maker
from setuptools.dist import Distribution

os.umask(0o022)


def epoch():
    """The time of the commit; of an unpacked source distribution, whose files all have it, that."""
    if told := os.environ.get("SOURCE_DATE_EPOCH"):
        return int(told)
    if Path(".git").exists():
        asked = ["git", "log", "-1", "--format=%ct"]
        done = subprocess.run(asked, capture_output=True, text=True, check=False)
        if done.returncode == 0:
            return int(done.stdout)
    return int(Path("pyproject.toml").stat().st_mtime)


COMMIT_FILE = Path("port/impact88/commit.txt")


@contextmanager
def commit_recorded():
    """Within, the package holds the hash of the commit it is built from, where that is known; an
    unpacked source distribution holds it already."""
    commit = os.environ.get("IMPACT88_COMMIT", "")
    if not commit and Path(".git").exists():
        asked = ["git", "describe", "--always", "--exclude=*", "--abbrev=12", "--dirty"]
        done = subprocess.run(asked, capture_output=True, text=True, check=False)
        commit = done.stdout.strip()
    if COMMIT_FILE.exists() or not commit:
        yield
        return
    COMMIT_FILE.write_text(f"{commit}\n", encoding="ascii")
    try:
        yield
    finally:
        COMMIT_FILE.unlink()


HEADERS = {
    "port/impact88/mechanics/formulas.h": "impact88.mechanics.translate",
    "port/impact88/program/listing.h": "impact88.program.generate",
}
"""Generated C header -> the module that prints it, from sources read as text: numpy and other
dependencies are not there when the package is built."""


def print_headers():
    """Write the generated headers; one that has not changed keeps its time."""
    for header, module in HEADERS.items():
        command = [sys.executable, "-m", module]
        environment = {**os.environ, "PYTHONPATH": "port", "PYTHONDONTWRITEBYTECODE": "1"}
        text = subprocess.run(command, env=environment, stdout=subprocess.PIPE, check=True).stdout
        path = Path(header)
        if not path.exists() or path.read_bytes() != text:
            path.write_bytes(text)


PROGRAMS = Path("golden/programs")


@contextmanager
def programs_archived():
    """Within, the files of the captured programs are one archive beside their folder, for the wheel."""
    archive = PROGRAMS.with_suffix(".zip")
    try:
        with zipfile.ZipFile(archive, "w") as packed:
            for file in sorted(PROGRAMS.iterdir()):
                entry = zipfile.ZipInfo(file.name)  # of 1980: the bytes depend on the files alone
                packed.writestr(entry, file.read_bytes(), zipfile.ZIP_DEFLATED, 9)
        yield
    finally:
        archive.unlink(missing_ok=True)


if os.environ.get("IMPACT88_PURE") == "1":  # a wheel for every machine, without the compiled part
    Distribution.has_ext_modules = lambda self: False


_own_tag = bdist_wheel.get_tag


def _tag(command):
    """The compiled part is plain C and calls nothing of Python's: it serves every Python of a
    platform, free-threaded ones, too."""
    return "py3", "none", _own_tag(command)[2]


bdist_wheel.get_tag = _tag


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """A wheel whose entries have the time of the commit and usual modes."""
    os.environ["SOURCE_DATE_EPOCH"] = str(epoch())
    print_headers()
    with commit_recorded(), programs_archived():
        return build_meta.build_wheel(wheel_directory, config_settings, metadata_directory)


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    """An editable install, with the compiled part in the checkout."""
    print_headers()
    return build_meta.build_editable(wheel_directory, config_settings, metadata_directory)


def build_sdist(sdist_directory, config_settings=None):
    """Everything that is in the repository, tests included, so that they run from it."""
    manifest_maker.template = ".ci/manifest"
    with commit_recorded():
        name = build_meta.build_sdist(sdist_directory, config_settings)
    path = Path(sdist_directory, name)
    then = epoch()
    with tarfile.open(path) as built:
        entries = [(entry, built.extractfile(entry)) for entry in built.getmembers()]
        with (
            gzip.GzipFile(path.with_suffix(".part"), "wb", mtime=then) as packed,
            tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as rebuilt,
        ):
            for entry, data in sorted(entries, key=lambda pair: pair[0].name):
                entry.mtime, entry.mode = then, 0o755 if entry.mode & 0o100 else 0o644
                entry.uid = entry.gid = 0
                entry.uname = entry.gname = ""
                entry.pax_headers = {}
                rebuilt.addfile(entry, data)
    path.with_suffix(".part").replace(path)
    return name
