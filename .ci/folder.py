"""Build a folder that runs without Python or network, and try it: python .ci/folder.py FOLDER.

It is for the system on which it is built (Windows for Windows), and holds the extras that are
installed beside impact88 and PyInstaller in the Python that runs this. Started without arguments,
as by a double click, the program opens the desk.
"""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from urllib.parse import urlsplit
from urllib.request import Request, urlopen

folder = Path(sys.argv[1]).resolve()
here = Path(__file__).resolve().parent
pyinstaller = [sys.executable, "-m", "PyInstaller", "--noconfirm", "--log-level", "ERROR"]
places = ["--distpath", folder, "--workpath", folder / "work", "--specpath", folder / "work"]
# the port finds its BASIC line in the comments of its source
listing = here.parent / "port" / "impact88" / "program" / "listing.py"
source = ["--add-data", f"{listing}{os.pathsep}impact88/program"]
subprocess.run(
    [
        *pyinstaller,
        "--name",
        "impact88",
        "--collect-all",
        "impact88",
        *source,
        *places,
        here / "start.py",
    ],
    check=True,
    cwd=here,  # not the checkout: the installed package is what is packed
)
shutil.rmtree(folder / "work")
program = folder / "impact88" / ("impact88.exe" if os.name == "nt" else "impact88")

bare = {name: os.environ[name] for name in ("SYSTEMROOT", "TEMP") if name in os.environ}
legacy, golden = here.parent / "legacy", here.parent / "golden"


def tried(*arguments: object) -> str:
    """What the program prints, in an environment with no Python and no PATH."""
    command = [program, *map(str, arguments)]
    done = subprocess.run(command, env=bare, cwd=folder, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"folder: {' '.join(map(str, arguments))}: {done.stdout}{done.stderr}")
    return done.stdout


if not tried("selfcheck").rstrip().endswith("PASS"):
    sys.exit("folder: selfcheck does not pass")
for paper in (legacy / "run1-as-printed.txt", golden / "scans" / "clean-001.png"):
    if "IDENTICAL" not in tried("verify", paper):
        sys.exit(f"folder: {paper.name} is not IDENTICAL")

desk = subprocess.Popen(
    [program, "desk", "--no-browser"],
    env=bare,
    cwd=folder,
    stdout=subprocess.PIPE,
    stderr=subprocess.DEVNULL,
    text=True,
)
try:
    assert desk.stdout
    address = desk.stdout.readline().strip()
    own = "{0.scheme}://{0.netloc}".format(urlsplit(address))
    headers = {"Origin": own, "X-Desk-Page": "0" * 16, "Content-Type": "application/octet-stream"}
    page = (legacy / "run1-as-printed.txt").read_bytes()
    question = Request(f"{address}judge?name=page.txt&bench=paper", page, headers)
    with urlopen(address, timeout=60) as answer:
        if b"<title>impact88 desk</title>" not in answer.read():
            sys.exit("folder: the desk's page is another")
    with urlopen(question, timeout=120) as answer:
        if json.load(answer)["objects"][0]["verdict"] != "identical":
            sys.exit("folder: the desk judges the published page otherwise")
finally:
    desk.terminate()
    desk.wait()
size = sum(path.stat().st_size for path in program.parent.rglob("*") if path.is_file())
print(f"folder: {size / 1e6:.0f} MB, without Python or PATH: selfcheck PASS, verify, desk")
