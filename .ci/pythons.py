"""The other Pythons on this machine that pyproject.toml promises to work with, one path a line.

Of each 3.N but the one that runs this, the newest that was released: among what PATH names
python3.N, and what pyenv has installed.
"""

import os
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

WHO = "import sys; print(*sys.version_info[:4]); print(sys.executable)"


def candidates(lowest: int) -> Iterator[Path]:
    """Whatever is called python3.N, and may be that."""
    root = Path(os.environ.get("PYENV_ROOT") or Path.home() / ".pyenv")
    folders = [Path(name) for name in os.get_exec_path()]
    for folder in [*folders, *sorted(root.glob("versions/*/bin"))]:
        for path in folder.glob("python3.*"):
            minor = path.name.removeprefix("python3.")
            if minor.isdecimal() and lowest <= int(minor) != sys.version_info.minor:
                yield path


def identity(path: Path) -> tuple[tuple[int, ...], str] | None:
    """Version and full path of a released Python; None for anything else, such as the name that
    pyenv keeps of a version that is not chosen."""
    try:
        asked = subprocess.run(
            [path, "-I", "-c", WHO], capture_output=True, text=True, check=True, timeout=30
        )
        numbers, executable = asked.stdout.splitlines()
    except (OSError, subprocess.SubprocessError, ValueError):
        return None
    *version, level = numbers.split()
    return (tuple(map(int, version)), executable) if level == "final" else None


def newest(lowest: int) -> list[str]:
    """The newest of each, oldest first."""
    known = filter(None, map(identity, candidates(lowest)))
    return list({version[:2]: path for version, path in sorted(known)}.values())


if __name__ == "__main__":
    project = tomllib.loads(Path("pyproject.toml").read_text("utf-8"))["project"]
    floor = re.fullmatch(r">=3\.(\d+)", project["requires-python"])
    if not floor:
        sys.exit("pyproject.toml: requires-python names no lowest version")
    for path in newest(int(floor[1])):
        print(path)
