"""A result is added with one function, one row and one line, as port/README.md says."""

import shutil
import subprocess
import sys
from pathlib import Path

import impact88

PACKAGE = Path(impact88.__file__).parent
FUNCTION = '''
def momentum_along_x(MA, MB, VAX, VBX):
    """Return the momentum along x after the impact."""
    PX = MA * VAX + MB * VBX
    return (PX,)
'''
ROW = '    ("PX", "P_x", "momentum along x after the impact", IMPULSE),\n'
LINE = '    f["PX"] = g["MA"] * after[0] + g["MB"] * after[3]\n'
CHECK = """
import numpy as np

import impact88
from impact88.mechanics.reference import results
from impact88.comparison.agreement import reference
from impact88.mechanics.translate import header
scene = impact88.sample(1).numbers()
px = impact88.solve(scene, "PX")["PX"]
assert abs(px - float(results(scene)["PX"])) < 1e-9 * abs(px), px
assert abs(px - scene["MA"] * scene["UX"] - scene["MB"] * scene["VX"]) < 1e-9 * abs(px)
assert "PX" in impact88.solve(scene)
assert impact88.prepared("UX", "PX", scene)([scene["UX"]])["PX"] == px
assert impact88.evaluate({"MA": 1, "MB": 2, "VAX": 3, "VBX": 4}, "PX")[0]["PX"] == 11
assert "CLONES void each_momentum_along_x(" in header()
try:
    impact88.solve({}, "PX")
except impact88.UserError as error:
    assert "missing E (coefficient of restitution)" in str(error), error
columns = {name: np.array([value]) for name, value in scene.items()}
assert 0 < reference(columns, ("PX",)).bounds["PX"] < 1e-9
table = {**columns, **impact88.solve(columns, "VAX VAY VBX VBY WAF WBF PX")}
assert impact88.compare(table).passed
assert not impact88.compare({**table, "PX": table["PX"] * 1.001}).passed
known = {name: scene[name] for name in scene if name != "UX"} | {"VAX": float(table["VAX"][0])}
assert "PX" in impact88.reconstruct(known, samples=0)[0].values
print(impact88.accelerated, "PX", impact88.names.RESULTS["PX"].unit)
"""


def insert(path, before, text):
    content = path.read_text(encoding="utf-8")
    assert content.count(before) == 1, (path, before)
    path.write_text(content.replace(before, text + before), encoding="utf-8")


def test_a_result_is_one_function_one_row_and_one_line(tmp_path):
    copy = tmp_path / "impact88"
    ignore = shutil.ignore_patterns("__pycache__", "*.so", "*.pyd")
    shutil.copytree(PACKAGE, copy, ignore=ignore)
    insert(copy / "mechanics" / "formulas.py", "\n# -- energies\n", FUNCTION)
    insert(copy / "names.py", '    ("COND", "κ"', ROW)
    insert(copy / "mechanics" / "reference.py", '    f["VC"] =', LINE)
    environment = {"PYTHONPATH": str(tmp_path), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-c", CHECK]
    run = subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True, text=True)
    assert run.stdout == "None PX mass·length/time\n", run.stderr
