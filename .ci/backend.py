"""setuptools, with the generated headers of the compiled part printed first."""

import os
import subprocess
import sys
from pathlib import Path

os.environ.setdefault("SOURCE_DATE_EPOCH", "567993600")  # equal bytes from equal files
os.umask(0o022)

from setuptools.build_meta import *  # noqa: E402, F403
from setuptools.command.bdist_wheel import bdist_wheel  # noqa: E402
from setuptools.command.egg_info import manifest_maker  # noqa: E402

HEADERS = {
    "port/impact88/mechanics/formulas.h": "impact88.mechanics.translate",
    "port/impact88/program/listing.h": "impact88.program.generate",
}  # generated header: the module that prints it, with Python's own library alone

manifest_maker.template = ".ci/manifest"  # the top level has no MANIFEST.in
platform_tag = bdist_wheel.get_tag
# plain C that calls nothing of Python's: one file serves every Python of a platform
bdist_wheel.get_tag = lambda command: ("py3", "none", platform_tag(command)[2])


def _with_headers(build):
    """Return a build hook that prints the headers first."""

    def build_with_headers(*arguments, **settings):
        for header, module in HEADERS.items():
            command = [sys.executable, "-Bm", module]
            environment = {**os.environ, "PYTHONPATH": "port"}
            Path(header).write_bytes(subprocess.check_output(command, env=environment))
        return build(*arguments, **settings)

    return build_with_headers


build_wheel = _with_headers(build_wheel)  # noqa: F405
build_editable = _with_headers(build_editable)  # noqa: F405
