"""Which law exact values break: true ones break none, and a false one by its own mechanics."""

import json
import math

import numpy as np
import pytest

from impact88.casework.reconstruction.laws import missed_laws
from impact88.casework.reconstruction.unknowns import solve_for
from impact88.collision.casescene import sample
from impact88.collision.units import SYSTEMS
from impact88.errors import UserError
from impact88.interface.commands.cli import main
from impact88.mechanics.closedform.solve import solve
from impact88.names import FINAL_STATE

SCENE = {name: float(text) for name, text in sample(1).items()}
FINAL = ("VAX", "VAY", "WAF", "VBX", "VBY", "WBF")
AFTER = {n: float(v) for n, v in solve(SCENE, (*FINAL, "MUP")).items()}
TRUE = {n: v for n, v in SCENE.items() if n != "MU"} | AFTER
COEFFICIENTS = ("E", "MUP", "EM")


def without(names, values=TRUE):
    return {n: v for n, v in values.items() if n not in names}


def random_scenes(count):
    rng = np.random.default_rng(1988)
    for _ in range(count):
        scene = {**SCENE, "GA": rng.uniform(-180, 180), "TA": rng.uniform(-180, 180)}
        scene |= {n: rng.normal() * 30 for n in ("UX", "UY", "VX", "VY")}
        scene |= {"WA": rng.normal(), "WB": rng.normal(), "E": rng.uniform(), "MU": rng.normal()}
        after = {n: float(v) for n, v in solve(scene, (*FINAL, "MUP")).items()}
        yield without(("MU",), {**scene, **after})


@pytest.mark.parametrize("left_out", [(), COEFFICIENTS, ("WAF", "WBF"), ("UX", "VAX")])
def test_true_values_miss_no_law(left_out):
    for values in random_scenes(50):
        assert missed_laws(without(left_out, values)) == ()


def test_a_false_velocity_misses_momentum_by_its_own_mass_times_its_error():
    rng = np.random.default_rng(7)
    for values in random_scenes(30):
        values = without((*COEFFICIENTS, "WAF", "WBF"), values)
        x, y = rng.normal(size=2)
        values |= {"VAX": values["VAX"] + x, "VAY": values["VAY"] + y}
        c, s = math.cos(math.radians(values["GA"])), math.sin(math.radians(values["GA"]))
        amounts = {law.law: law.amount for law in missed_laws(values)}
        assert amounts == pytest.approx(
            {"n": values["MA"] * abs(x * c + y * s), "t": values["MA"] * abs(y * c - x * s)}
        )


@pytest.mark.parametrize("name", COEFFICIENTS)
def test_a_false_coefficient_is_told_as_given_and_as_the_velocities_have_it(name):
    for values in random_scenes(30):
        false = {**values, name: values[name] + 0.1}
        (law,) = missed_laws(false)
        assert law.law == name
        assert law.given == pytest.approx(values[name] + 0.1)
        assert law.present == pytest.approx(values[name], rel=1e-6, abs=1e-9)


def test_a_false_spin_misses_the_angular_momentum_by_inertia_times_its_error():
    for values in random_scenes(30):
        values = without(COEFFICIENTS, values)
        (law,) = missed_laws({**values, "WBF": values["WBF"] + 0.25})
        assert (law.law, law.amount) == ("angular", pytest.approx(0.25 * values["IB"]))


def test_the_threshold_has_two_sides():
    values = without(COEFFICIENTS)
    assert missed_laws({**values, "WBF": values["WBF"] * (1 + 1e-12)}) == ()
    assert missed_laws({**values, "WBF": values["WBF"] * (1 + 1e-6)})


def test_laws_that_cannot_hold_together_are_named_where_the_others_hold():
    values = without((*COEFFICIENTS, "VAY", "WAF"))
    laws = missed_laws({**values, "VAX": values["VAX"] + 3})
    assert {law.law for law in laws} == {"n", "t"}
    assert not any(law.alone for law in laws)
    assert missed_laws(values) == ()
    # along x, where nothing is unknown, momentum is missed by the mass times the error
    along_x = 3 * values["MA"]
    amounts = {law.law: law.amount for law in laws}
    angle = math.radians(values["GA"])
    assert amounts["n"] == pytest.approx(along_x / abs(math.cos(angle)))
    assert amounts["t"] == pytest.approx(along_x / abs(math.sin(angle)))


def test_the_amount_is_in_the_units_asked_for():
    (law,) = missed_laws({**TRUE, "E": 0.3})
    assert "(E 0.005 where 0.3 is given)" in law.text(SYSTEMS["chapter"])
    assert "ft/s" in law.text(SYSTEMS["chapter"])


def test_the_command_names_the_law_though_much_is_not_determined(capsys):
    values = without((*COEFFICIENTS, "WAF", "WBF"))
    arguments = [f"--set={n}={v!r}" for n, v in {**values, "VAX": values["VAX"] + 3}.items()]
    main(["reconstruct", *arguments, "--samples", "0"])
    out = capsys.readouterr().out
    assert "momentum along n does not balance: the error is 372.8" in " ".join(out.split())
    main(["reconstruct", *[f"--set={n}={v!r}" for n, v in values.items()], "--samples", "0"])
    ends = capsys.readouterr()
    assert "missed" not in ends.out + ends.err


def test_a_program_reads_no_rounding(capsys):
    values = without((*COEFFICIENTS, "WAF", "WBF"))
    false = {**values, "VAX": values["VAX"] + 3}
    arguments = [f"--set={n}={v!r}" for n, v in false.items()]
    main(["reconstruct", *arguments, "--samples", "0", "--json"])
    (solution,) = json.loads(capsys.readouterr().out)["solutions"]
    numbers = {n: v for n, v in solution["values"].items() if v}
    assert [n for n, v in numbers.items() if abs(v) < 1e-13] == []
    assert {row["name"]: row["adjusted"] for row in solution["adjusted"]}["UY"] == 0
    assert solution["evidence"]["laws_missed"][0].startswith(
        "momentum along n does not balance: the error is"
    )


def kinetic_energy(v, late):
    names = FINAL if late else ("UX", "UY", "WA", "VX", "VY", "WB")
    ax, ay, wa, bx, by, wb = (v[n] for n in names)
    a = v["MA"] * (ax * ax + ay * ay) + v["IA"] * wa * wa
    return (a + v["MB"] * (bx * bx + by * by) + v["IB"] * wb * wb) / 2


MADE_OF_VELOCITIES = {
    "SA": lambda v: math.hypot(v["UX"], v["UY"]),
    "SBF": lambda v: math.hypot(v["VBX"], v["VBY"]),
    "DVA": lambda v: math.hypot(v["VAX"] - v["UX"], v["VAY"] - v["UY"]),
    "DVBF": lambda v: (
        (v["VBX"] - v["VX"]) * math.cos(math.radians(v["TB"]))
        + (v["VBY"] - v["VY"]) * math.sin(math.radians(v["TB"]))
    ),
    "KI": lambda v: kinetic_energy(v, late=False),
    "EL": lambda v: kinetic_energy(v, late=False) - kinetic_energy(v, late=True),
}


@pytest.mark.parametrize("name", MADE_OF_VELOCITIES)
def test_a_value_that_velocities_make_is_missed_by_its_own_error(name):
    for values in random_scenes(20):
        amount = MADE_OF_VELOCITIES[name](values)
        assert missed_laws({**values, name: amount}) == ()
        (law,) = missed_laws({**values, name: amount + 1.0})
        assert (law.law, law.amount) == (name, pytest.approx(1.0, rel=1e-6))
        assert law.present == pytest.approx(amount, rel=1e-9)
        assert name in law.text(SYSTEMS["us"])
        if "A" in name:  # two laws determine what is not known
            unknown = without(("UX", "VAX"), values)
            (law,) = missed_laws({**unknown, name: amount + 1.0})
            assert (law.law, law.amount) == (name, pytest.approx(1.0, rel=1e-6))
            # momentum alone leaves it open: nothing follows
            unknown = without(("UX", "VAX", "E", "MUP", "EM"), values)
            assert missed_laws({**unknown, name: amount + 1.0}) == ()


def test_point_masses_are_tested_along_one_line():
    """B at rest is struck along x: its velocity and e are those of the chapter's Equation 4."""
    u, e, ma, mb = 30.0, 0.1, 100.0, 80.0
    impulse = (1 + e) * u / (1 / ma + 1 / mb)
    known = {"M": 4.0, "MA": ma, "MB": mb, "GA": 180.0, "UX": u, "UY": 0.0, "VX": 0.0, "VY": 0.0}
    known |= dict.fromkeys(("DA", "DB", "PA", "PB", "TA", "TB"), 0.0) | {"IA": 1.0, "IB": 1.0}
    known |= {"VAX": u - impulse / ma, "VAY": 0.0, "VBX": impulse / mb, "VBY": 0.0, "E": e}
    assert missed_laws({**known, "MUP": 0.0}) == ()
    (law,) = missed_laws({**known, "E": 0.2})
    assert (law.law, law.present) == ("E", pytest.approx(e))
    laws = {law.law: law for law in missed_laws({**known, "VBX": known["VBX"] + 1})}
    assert laws["n"].amount == pytest.approx(mb)
    assert laws["E"].present == pytest.approx(e + 1 / u)
    (law,) = missed_laws({**known, "EL": 0.5 * (1 - e * e) * u * u / (1 / ma + 1 / mb) + 100})
    assert (law.law, law.amount) == ("EL", pytest.approx(100))


def test_where_nothing_is_unknown_the_laws_missed_are_told():
    """All twelve velocities and the coefficients: one velocity off is told by its laws."""
    scene = {n: float(text) for n, text in sample(1).items()}
    after = {n: float(v) for n, v in solve(scene, (*FINAL_STATE, "MUP")).items()}
    known = {**{n: v for n, v in scene.items() if n != "MU"}, **after}
    with pytest.raises(UserError, match="nothing is unknown; leave out"):
        solve_for(known)
    with pytest.raises(
        UserError, match=r"nothing is unknown, and .* momentum along n does not balance"
    ):
        solve_for({**known, "VAX": known["VAX"] + 1})


@pytest.mark.parametrize(("speed", "names"), [(38.6667, ["EL"]), (30.0, ["EL", "n"])])
def test_what_rounding_leaves_of_a_law_is_not_named_beside_a_large_error(speed, names):
    """A standing car is struck by momentum at 38.6667: four digits leave 1e-6 of it."""
    known = {"M": 4.0, "MA": 3000.0, "MB": 4000.0, "GA": 180.0, "UX": speed, "UY": 0.0}
    known |= {"VX": 0.0, "VY": 0.0, "VAX": 12.0, "VAY": 0.0, "VBX": 20.0, "VBY": 0.0, "EL": 2e5}
    assert [law.law for law in missed_laws(known)] == names
