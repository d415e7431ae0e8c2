"""Run the native tests with a library built with the address and undefined sanitizers.

python .ci/sanitized.py PYTHON, which has the project and its tests' needs installed. The package is
copied with that library in place of its own; nothing in the checkout changes.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

PACKAGE = Path("port/impact88").resolve()
COMPILER = os.environ.get("CC", "gcc")
# as pyproject.toml has them, for one instruction set, less optimized
FLAGS = "-shared -fPIC -O1 -g1 -ffp-contract=off -fno-math-errno -fno-trapping-math".split()
SANITIZERS = ["-fsanitize=address,undefined", "-fno-sanitize-recover=undefined"]
TESTS = ["tests/mechanics/test_impact.py"]
SECONDS = 300


def environment(folder: Path) -> dict[str, str]:
    """What a process needs that loads the library: Python itself is not sanitized, and leaks."""
    asked = [COMPILER, "-print-file-name=libasan.so"]
    runtime = subprocess.run(asked, capture_output=True, text=True, check=True).stdout.strip()
    options = {"ASAN_OPTIONS": "detect_leaks=0", "UBSAN_OPTIONS": "print_stacktrace=1"}
    return {**os.environ, **options, "LD_PRELOAD": runtime, "PYTHONPATH": str(folder)}


def main() -> None:
    """Build, copy, run."""
    python = sys.argv[1]
    if not sys.platform.startswith("linux") or shutil.which(COMPILER) is None:
        print("sanitizers: skipped, this is no Linux with gcc")
        return
    with TemporaryDirectory() as name:
        folder = Path(name)
        copy = shutil.copytree(PACKAGE, folder / "impact88")
        for built in copy.glob("_compiled*"):
            built.unlink()
        library = copy / "_compiled.so"
        sources = [str(copy / "mechanics" / "machine.c"), str(copy / "program" / "applesoft.c")]
        command = [COMPILER, *FLAGS, *SANITIZERS, "-o", library, *sources, "-lm"]
        subprocess.run(command, check=True)
        probe = "from impact88 import library; print(library.__file__, library.accelerated)"
        given = {"env": environment(folder), "check": True, "timeout": SECONDS}
        asked = subprocess.run([python, "-c", probe], capture_output=True, text=True, **given)
        where, accelerated = asked.stdout.split(maxsplit=1)
        if not where.startswith(name) or accelerated.strip() == "None":
            sys.exit(f"sanitizers: tests would load {where} ({accelerated.strip()})")
        subprocess.run([python, "-m", "pytest", "-n", "2", *TESTS], **given)
    print("sanitizers: the native tests touch nothing that is not theirs")


if __name__ == "__main__":
    main()
