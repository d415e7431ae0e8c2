"""Make README's pictures, the table of run times and the page of measurements again:
python .ci/pictures.py

Needs ``pip install -e '.[bench,desk,plot,report,scan,test]'``, Chromium and chromedriver. Each
picture is what a command of README makes; pages are photographed by a browser without a window.
The benchmark takes a minute, and wants a machine that does nothing else; ``--no-bench`` leaves it
out, ``--no-pictures`` all else.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from datetime import UTC, datetime
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
RUN_TIMES = ROOT / "port" / "docs" / "speed.md"
MEASUREMENTS = ROOT / "port" / "docs" / "measurements.md"
TABLE_START = "<!-- run times: .ci/pictures.py -->"
TABLE_END = "<!-- end of run times -->"
METHODS = {
    "applesoft": "the port, in Applesoft arithmetic",
    "replay": "the same over arrays, bit for bit (`replay`)",
    "elimination": "the listing's elimination in double precision",
    "lapack-fill": "LAPACK, matrices filled and solved",
    "plain": "the closed form in plain C, -O3",
    "plain-fast": "the same, -O3 -march=native -ffast-math: no checks, a few digits less",
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
    block = re.search(r"`crash.toml`:\n\n```toml\n(.*?)^```$", text, re.M | re.S)
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
        page.choose("collision-begin", "solve/1")
        page.run("location.hash = '#collision'")
        until(lambda: page.count("#collision-first td"), "the answer", 60)
        until(lambda: page.run("return document.getElementById('collision-figure').naturalWidth"))
        page.driver.save_screenshot(str(picture))


def write_table(record: dict[str, Any]) -> None:
    """Put what a benchmark measured into the table of run times, with where it was measured."""
    rows = {(row["method"], row["population"]): row for row in record["results"]}
    machine = record["machine"]
    lines = [
        "| method | ns a scene | error, cars | error, heavy B |",
        "|---|---|---|---|",
    ]
    for method, words in METHODS.items():
        casework, heavy = rows[method, "casework"], rows[method, "heavy"]
        nanoseconds = float(f"{casework['seconds'] * 1e9:.2g}")
        errors = f"{casework['percentile_99']:.0e} | {heavy['percentile_99']:.0e}"
        lines.append(f"| {words} | {nanoseconds:,.0f} | {errors} |")
    scenes = rows["closed-form", "casework"]["scenes"]
    where = (
        "Relative error of the final velocities against 50 digits that 99 % of "
        f"{scenes} scenes are below; {machine['processor']}, {machine['instructions']}, "
        f"Python {machine['python']}, numpy {machine['numpy']}, load {machine['load']:.1f}; made "
        "again by `python .ci/pictures.py`."
    )
    text = RUN_TIMES.read_text(encoding="utf-8")
    before, _, rest = text.partition(TABLE_START)
    _, _, after = rest.partition(TABLE_END)
    table = "\n".join([TABLE_START, "", *lines, "", where, "", TABLE_END])
    RUN_TIMES.write_text(before + table + after, encoding="utf-8")


def write_measurements(record: dict[str, Any]) -> None:
    """Write the page of measurements: every method on every population."""
    machine = record["machine"]
    lines = [
        "# Measurements",
        "",
        f"Made by `python .ci/pictures.py` on {datetime.now(UTC):%Y-%m-%d}: one run of `impact88 "
        f"bench --quick` on {machine['processor']}, "
        f"{machine['instructions']}, {machine['cores']} cores, Python {machine['python']}, numpy "
        f"{machine['numpy']}, load {machine['load']:.1f}. Times are of the processor; on a busy "
        "machine they are longer, and ratios hold.",
        "",
        "## Run time against error",
        "",
        "Relative error of the final velocities against 50 digits.",
        "",
        "| scenes | method | scenes per second | median error | 99 % below | largest of these |",
        "|---|---|---|---|---|---|",
    ]
    for row in record["results"]:
        speed = float(f"{row['scenes_per_second']:.2g}")
        errors = (
            f"{row['median']:.1e} | {row['percentile_99']:.1e} | {row['largest']:.1e}"
            if "median" in row
            else "| | the reference"
        )
        lines.append(f"| {row['population']} | {row['name']} | {speed:,.0f} | {errors} |")
    MEASUREMENTS.write_text("\n".join(lines) + "\n", encoding="utf-8")


def make_pictures(folder: Path) -> None:
    """Make README's pictures, but that of the benchmark."""
    scene = scene_file(folder)
    run("figure", "scene", scene, "-o", str(PICTURES / "scene.svg"), folder=folder)
    run("report", scene, "-o", "case.html", folder=folder)
    photograph((folder / "case.html").as_uri(), PICTURES / "report.png")
    shutil.copy(ROOT / "golden" / "scans" / SCAN, folder)
    run("verify", "--brief", "--report", "page.html", SCAN, folder=folder)
    photograph((folder / "page.html").as_uri(), PICTURES / "verify.png")
    photograph_desk(PICTURES / "desk.png")


def measure(folder: Path) -> None:
    """Run the benchmark for its picture, the table of run times and the page of measurements."""
    figure, record = PICTURES / "work-precision.svg", folder / "b.json"
    asked = ("bench", "--quick", "--figure", str(figure))
    run(*asked, "--json", "-o", str(record), folder=folder)
    measured = json.loads(record.read_text(encoding="utf-8"))
    write_table(measured)
    write_measurements(measured)


def main() -> None:
    """Make all of it again."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as name:
        if "--no-pictures" not in sys.argv:
            make_pictures(Path(name))
        if "--no-bench" not in sys.argv:
            measure(Path(name))


if __name__ == "__main__":
    main()
