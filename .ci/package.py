"""Build what is published from the current folder: python .ci/package.py FOLDER.

The source distribution is unpacked in FOLDER/source, from which the tests can run. A wheel built
again later and with another mask of modes, and one built from the source distribution
must be the same bytes.
"""

import os
import subprocess
import sys
import tarfile
import time
from pathlib import Path

folder = Path(sys.argv[1]).resolve()
sys.path.insert(0, str(Path(__file__).parent))
import backend  # noqa: E402


def wheel(source: Path, name: str) -> Path:
    """The wheel built from a folder."""
    pip = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation"]
    subprocess.run([*pip, "--wheel-dir", str(folder / name), str(source)], check=True)
    return next((folder / name).glob("*.whl"))


packed = folder / backend.build_sdist(str(folder))
with tarfile.open(packed) as archive:
    archive.extractall(folder / "unpacked", filter="data")
source = next((folder / "unpacked").iterdir()).rename(folder / "source")
first = wheel(Path(), "from-here")
time.sleep(2.1)  # a zip file's times have steps of two seconds
os.umask(0o077)
for other in (wheel(Path(), "again"), wheel(source, "from-source")):
    if other.read_bytes() != first.read_bytes():
        sys.exit(f"{other.parent.name}: another wheel than {first.parent.name}; expected one")
print(f"wheel: {first.stat().st_size:,} bytes, the same again and from the source distribution")
