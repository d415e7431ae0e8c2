"""The lowest versions that pyproject.toml promises to work with, as pip's requirements."""

import re
import sys
import tomllib
from pathlib import Path

project = tomllib.loads(Path("pyproject.toml").read_text("utf-8"))["project"]
floors = [*project["dependencies"], *project["optional-dependencies"]["test"]]
for floor in floors:
    found = re.fullmatch(r"([\w.-]+)>=([\d.]+)", floor)
    if not found:
        sys.exit(f"pyproject.toml: {floor!r} names no lowest version")
    print(f"{found[1]}=={found[2]}.*" if found[2].count(".") < 2 else f"{found[1]}=={found[2]}")
