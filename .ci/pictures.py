"""Make README's pictures and its table of run times again: python .ci/pictures.py

Needs ``pip install -e '.[bench,desk,plot,report,scan,test]'``, Chromium and chromedriver. Each
picture is what a command of README makes; pages are photographed by a browser without a window.
The benchmark takes some ten seconds, and wants a machine that does nothing else; ``--no-bench``
leaves it out.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
PICTURES = ROOT / "port" / "docs" / "pictures"
COMMAND = str(Path(sys.executable).with_name("impact88"))
BROWSERS = ("chromium", "chromium-browser", "google-chrome")
BROWSER_OPTIONS = ("--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars")
PAGE_SIZE = (1000, 1300)
DESK_SIZE = (1280, 1000)
SCAN = "clean-001.png"
README = ROOT / "README.md"
TABLE_START = "<!-- run times: .ci/pictures.py -->"
TABLE_END = "<!-- end of run times -->"
METHODS = {
    "applesoft": "the port, in Applesoft arithmetic",
    "replay": "the same over arrays, bit for bit (`replay`)",
    "elimination": "the listing's elimination in double precision",
    "lapack-fill": "LAPACK, matrices filled and solved",
    "plain": "the closed form in plain C, -O3",
    "closed-form": "`solve`",
}


def run(*arguments: str, folder: Path) -> None:
    """Run a command of impact88. Status 1 is an adverse result, not a failure."""
    done = subprocess.run([COMMAND, *arguments], cwd=folder, check=False)
    if done.returncode > 1:
        sys.exit(f"impact88 {' '.join(arguments)} ended with status {done.returncode}")


def photograph(address: str, picture: Path, size: tuple[int, int] = PAGE_SIZE) -> None:
    """Save what a browser shows of a page as a PNG."""
    browser = next(filter(shutil.which, BROWSERS), None)
    if browser is None:
        sys.exit("there is no Chromium; expected one of " + ", ".join(BROWSERS))
    window = f"--window-size={size[0]},{size[1]}"
    shot = [f"--screenshot={picture}", "--virtual-time-budget=8000", address]
    subprocess.run([browser, *BROWSER_OPTIONS, window, *shot], check=True, capture_output=True)


def scene_file(folder: Path) -> str:
    """Write README's ``crash.toml``."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    block = re.search(r"^```toml\n(.*?)^```$", text, re.M | re.S)
    assert block is not None
    (folder / "crash.toml").write_text(block[1], encoding="utf-8")
    return "crash.toml"


def photograph_desk(picture: Path) -> None:
    """Save what the desk shows of a published run as a PNG."""
    sys.path.insert(0, str(ROOT / "tests" / "support"))
    from desk_browser import browser, desk, until

    with desk() as address, browser() as page:
        page.driver.set_window_size(*DESK_SIZE)
        page.open(address)
        page.choose("collision-sample", "1")
        page.run("location.hash = '#collision'")
        until(lambda: page.count("#collision-first td"), "the answer", 60)
        until(lambda: page.run("return document.getElementById('collision-figure').naturalWidth"))
        page.driver.save_screenshot(str(picture))


def write_table(record: dict[str, Any]) -> None:
    """Put what a benchmark measured into README's table, with where it was measured."""
    rows = {(row["method"], row["population"]): row for row in record["results"]}
    machine = record["machine"]
    lines = [
        "| method | ns a scene | largest error, cars | largest error, heavy B |",
        "|---|---|---|---|",
    ]
    for method, words in METHODS.items():
        casework, heavy = rows[method, "casework"], rows[method, "heavy"]
        nanoseconds = float(f"{casework['seconds'] * 1e9:.2g}")
        errors = f"{casework['largest']:.0e} | {heavy['largest']:.0e}"
        lines.append(f"| {words} | {nanoseconds:,.0f} | {errors} |")
    where = (
        f"Relative errors of the final velocities against 50 digits; {machine['processor']}, "
        f"{machine['instructions']}, Python {machine['python']}, numpy {machine['numpy']}, load "
        f"{machine['load']:.1f}; made again by `python .ci/pictures.py`."
    )
    text = README.read_text(encoding="utf-8")
    before, _, rest = text.partition(TABLE_START)
    _, _, after = rest.partition(TABLE_END)
    table = "\n".join([TABLE_START, "", *lines, "", where, "", TABLE_END])
    README.write_text(before + table + after, encoding="utf-8")


def main() -> None:
    """Make all pictures."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as name:
        folder = Path(name)
        scene = scene_file(folder)
        run("figure", "scene", scene, "-o", str(PICTURES / "scene.svg"), folder=folder)
        run("report", scene, "-o", "case.html", folder=folder)
        photograph((folder / "case.html").as_uri(), PICTURES / "report.png")
        shutil.copy(ROOT / "golden" / "scans" / SCAN, folder)
        run("verify", "--brief", "--report", "page.html", SCAN, folder=folder)
        photograph((folder / "page.html").as_uri(), PICTURES / "verify.png")
        photograph_desk(PICTURES / "desk.png")
        if "--no-bench" not in sys.argv:
            figure = str(PICTURES / "work-precision.svg")
            record = folder / "bench.json"
            run("bench", "--quick", "--figure", figure, "--json", "-o", str(record), folder=folder)
            write_table(json.loads(record.read_text(encoding="utf-8")))


if __name__ == "__main__":
    main()
