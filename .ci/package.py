"""Build what is published from the current folder: python .ci/package.py FOLDER.

The source distribution is unpacked in FOLDER/source, from which the tests can run; a wheel made
from it must be the same, byte for byte, as one made from here.
"""

import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

folder = Path(sys.argv[1]).resolve()
sys.path.insert(0, str(Path(__file__).parent))
import backend  # noqa: E402


def wheel(source: Path, name: str) -> dict[str, bytes]:
    """What is in the wheel made from a folder, by name."""
    pip = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation"]
    subprocess.run([*pip, "--wheel-dir", str(folder / name), str(source)], check=True)
    with zipfile.ZipFile(next((folder / name).glob("*.whl"))) as archive:
        return {one: archive.read(one) for one in archive.namelist()}


packed = folder / backend.build_sdist(str(folder))
with tarfile.open(packed) as archive:
    archive.extractall(folder / "unpacked", filter="data")
source = next((folder / "unpacked").iterdir()).rename(folder / "source")
here, there = wheel(Path(), "from-here"), wheel(source, "from-source")
different = sorted(name for name in here | there if here.get(name) != there.get(name))
if different:
    sys.exit(f"the wheel from the source distribution differs: {' '.join(different)}")
print(f"wheel: {len(here)} files, {sum(map(len, here.values())):,} bytes, the same from both")
