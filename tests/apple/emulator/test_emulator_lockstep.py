"""Port and emulator stop after every line of the listing and agree on every variable's bits."""

from __future__ import annotations

import captures
import pytest
from emulation import first_difference
from hypothesis import given, settings
from hypothesis import strategies as st

from impact88.apple.applesoft.operators import Real
from impact88.files import packaged_text
from impact88.program import arithmetics
from impact88.program.scene import Scene, sample

STEP = max(1, len(captures.scenes()) // 3)
CASES = captures.scenes()[::STEP]


def decimal(low: int, high: int) -> st.SearchStrategy[str]:
    """Numbers as people type them: up to three decimals, sometimes a bare point or an exponent."""
    return st.one_of(
        st.integers(low, high).map(str),
        st.integers(low * 1000, high * 1000).map(lambda n: f"{n / 1000:.3f}"),
        st.integers(low * 10, high * 10).map(lambda n: f"{n}E-1"),
    )


SCENE = st.fixed_dictionaries(
    {
        **{name: decimal(-180, 180) for name in ("GA", "PA", "PB", "TA", "TB")},
        **{name: decimal(-90, 90) for name in ("UX", "UY", "VX", "VY")},
        **{name: decimal(-3, 3) for name in ("WA", "WB")},
        **{name: decimal(0, 400) for name in ("MA", "MB")},
        **{name: decimal(0, 9000) for name in ("IA", "IB")},
        **{name: decimal(0, 9) for name in ("DA", "DB")},
        "E": decimal(0, 1),
        "MU": st.one_of(decimal(-2, 2), st.just("-10")),
        "EM": decimal(-1, 0),
        "M": st.sampled_from(["6", "6", "6", "4"]),
    }
)


@settings(max_examples=2)
@given(SCENE)
def test_random_scene(values):
    assert first_difference(Scene(values)) is None


@pytest.mark.captures
@pytest.mark.parametrize("case", CASES, ids=[case["id"] for case in CASES])
def test_captured_scene(case):
    assert first_difference(Scene(case["scene"])) is None


def test_one_bit_in_the_port_is_caught(monkeypatch):
    """The last mantissa bit of the 60th value that the port stores."""
    count = 60

    def store_with_error(x: Real) -> Real:
        nonlocal count
        e, m, s = x.rounded().number
        if e:
            count -= 1
        return Real((e, m ^ 0x100, s)) if e and not count else Real((e, m, s))

    monkeypatch.setitem(
        arithmetics.ARITHMETICS, "applesoft", arithmetics.APPLESOFT._replace(LET=store_with_error)
    )
    assert first_difference(sample(1)) is not None
    assert count <= 0


@pytest.mark.parametrize(
    ("line", "changed"),
    [
        ("200 PRINT CHR$(140)", "200 PRINT CHR$(141)"),
        ("340 XA = UX + D3 * WA", "340 XA = UX + D3 * WA + 1E-8"),
        ("1080 MX = 1E - 9", "1080 MX = 1.0001E - 9"),
    ],
)
def test_a_changed_listing_is_caught(line, changed):
    text = packaged_text("impact88.legacy", "impact.bas")
    assert line in text
    assert first_difference(sample(1), text.replace(line, changed)) is not None


def test_one_bit_in_the_emulator_is_caught():
    """A memory byte of a variable flipped by a POKE after line 340: its last mantissa bit."""
    text = packaged_text("impact88.legacy", "impact.bas")
    poke = (
        "345 P = PEEK (105) + 256 * PEEK (106) + 6: POKE P, PEEK (P) + 1 - 2 * "
        "(PEEK (P) / 2 - INT (PEEK (P) / 2) > 0)"
    )
    difference = first_difference(sample(1), text + poke + "\n")
    assert difference is not None
    port, emulator = difference
    assert port[1] != emulator[1]
