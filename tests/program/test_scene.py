"""Scenes: the digits as typed, and texts that cannot be typed."""

from __future__ import annotations

import pytest

from impact88.errors import UserError
from impact88.names import SCENE
from impact88.program.scene import Scene, published_data, sample


def test_the_listings_own_data():
    assert published_data() == {name: sample(1)[name] for name in list(SCENE)[:14]} | {"M": "6"}


def test_digits_are_kept_as_typed():
    scene = sample(1).replaced({"UX": "90315.88170", "E": "- 1 2.5", "MU": "1e5"})
    assert (scene["UX"], scene["E"], scene["MU"]) == ("90315.88170", "- 1 2.5", "1e5")
    assert scene.numbers()["E"] == -12.5
    assert list(scene) == list(SCENE)
    assert Scene({n: t for n, t in scene.items() if n != "M"})["M"] == "6"


def test_lines_and_replies():
    lines = sample(2).typed_lines()
    assert lines[0] == "280 E = 0.005:MU = 0.911:EM = -0.715"
    assert lines[-1] == "350 N = 6:M = 4"
    assert sample(2).keyboard() == ["-29.04,0,0", "14.52,25.15,0"]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"UX": "12X"}, "sample 1: UX = '12X' is not a number as typed"),
        ({"UX": ""}, "UX = ''"),
        ({"UX": "25 mph"}, "UX = '25 mph'"),
        ({"UX": "−5"}, "UX = '−5'"),
        ({"UX": 5.0}, "UX = 5.0"),
        ({"MUU": "1"}, "did you mean MU"),
    ],
)
def test_what_is_no_scene(changes, message):
    with pytest.raises(UserError, match=message):
        sample(1).replaced(changes)


def test_missing_values_are_named():
    with pytest.raises(UserError, match=r"scene: missing E \(coefficient of restitution\)"):
        Scene({"UX": "1"})
    with pytest.raises(UserError, match="int is not a mapping"):
        Scene(5)
    with pytest.raises(UserError, match="there is no sample 4"):
        sample(4)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"E": "E5"}, "E = 'E5' is a number to INPUT but not in program line 280"),
        ({"IB": "-"}, "in program line 310"),
        ({"GA": "1." + "0" * 200}, "has 272 characters with these values"),
        ({"VY": "1." + "0" * 240}, "the Apple takes 239"),
    ],
)
def test_what_cannot_be_typed(changes, message):
    with pytest.raises(UserError, match=message):
        sample(1).replaced(changes).check_typed()
    sample(1).replaced({"UX": "E5", "VY": "-"}).check_typed()
