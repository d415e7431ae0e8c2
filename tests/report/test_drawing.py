"""The scene from above: nothing overlaps, shapes and directions are the scene's."""

from __future__ import annotations

import re
from html import unescape
from itertools import combinations
from xml.etree import ElementTree

import pytest
from drawnscenes import SCENES, Placed, case_of, texts_of

from impact88 import UserError
from impact88.cases import Case
from impact88.report.answers import Answer, ask
from impact88.report.drawing import draw, to_png

SVG = "{http://www.w3.org/2000/svg}"


def drawing(name: str = "side", **changes: str) -> str:
    """Return the drawing of a scene."""
    return draw(ask(case_of(name, **changes)))


def notes(name: str = "side", **changes: str) -> str:
    """Return all words of a scene's drawing."""
    return re.sub(r"(<[^>]*>|\s)+", " ", unescape(drawing(name, **changes)))


def paths(svg: str) -> list[str]:
    """Return heads of arrows, then all lines."""
    return re.findall(r'<path d="([^"]*)"', svg)


@pytest.mark.parametrize("name", SCENES)
def test_no_text_covers_another_or_leaves_the_paper(name: str) -> None:
    svg = drawing(name)
    x, y, width, height = map(float, re.search(r'viewBox="([^"]*)"', svg)[1].split())
    texts = texts_of(svg)
    assert len(texts) >= 10
    assert [(a.text, b.text) for a, b in combinations(texts, 2) if a.overlaps(b)] == []
    page = Placed("page", x, y, x + width, y + height)
    assert [text.text for text in texts if not text.is_within(page)] == []


def test_the_picture_is_well_formed_and_holds_no_styles() -> None:
    svg = drawing("oblique")
    elements = {element.tag.removeprefix(SVG) for element in ElementTree.fromstring(svg).iter()}
    assert elements == {"svg", "title", "marker", "path", "circle", "text"}
    assert "style" not in svg


def test_numbers_are_the_answers_own_texts() -> None:
    answer = ask(case_of())
    texts = [text.text for text in texts_of(draw(answer))]
    assert {answer.found[name].text for name in ("DVA", "DVB", "SAF", "WAF", "WBF")} <= {*texts}


def test_the_same_scene_looks_the_same_in_other_axes() -> None:
    """SAE axes mirror y and angles; the scene seen from above stays, y is shown downwards."""
    names = ("PA", "PB", "GA", "TA", "TB", "UY", "VY", "WA", "WB")
    plain = case_of("oblique")
    mirror_image = {name: f"{-float(plain.written[name]):g}" for name in names}
    shapes = paths(drawing("oblique"))
    assert shapes == paths(drawing("oblique", axes="sae", **mirror_image))
    assert len(shapes) > 15


def test_north_is_up_in_compass_views() -> None:
    """A drives north and B east: along y and x of the listing, along x and y of SAE axes."""
    listing = drawing(UX="0", UY="25", TA="270", GA="270", VX="40", VY="0", TB="0")
    north = {"UX": "25", "UY": "0", "TA": "0", "GA": "180", "VX": "0", "VY": "40", "TB": "90"}
    compass = drawing(PB="40", axes="sae", headings="compass", **north)
    words = [" ".join(svg.split()) for svg in (compass, listing)]
    assert ["North is up." in text for text in words] == [True, False]
    differing = set(paths(listing)) ^ set(paths(compass))
    assert len(differing) <= 8  # by a rounding: dots, contact plane
    assert len(paths(listing)) > 15


@pytest.mark.parametrize(
    ("changes", "hours"),
    [({}, ("12", "12")), ({"PA": "30", "TA": "-30"}, ("11", "12")), ({"VX": "-60"}, ("6", "6"))],
)
def test_each_body_has_the_hour_from_which_it_is_struck(
    changes: dict[str, str], hours: tuple[str, str]
) -> None:
    """A frontal blow comes from 12 o'clock; A turned left by 30 degrees is struck from 11."""
    words = notes("head-on", MU="0", **changes)
    assert f"A is drawn as a car; struck from {hours[0]} o'clock" in words
    assert f"B is drawn as a car; struck from {hours[1]} o'clock" in words


@pytest.mark.parametrize(
    ("mass", "words"),
    [("450", "a motorcycle"), ("451", "a car"), ("2500", "a car"), ("2501", "a light truck")],
)
def test_bodies_are_drawn_by_class_of_weight(mass: str, words: str) -> None:
    assert f"A is drawn as {words}; " in notes("metric", MA=mass, IA="3000", IB="1e4", MB="9000")


def test_a_body_is_a_barrier_from_a_mass_on() -> None:
    for mass in ("1.0001e7 kg", "INF"):
        assert "B is drawn as a barrier" in notes("barrier", MB=mass)
    assert "B is drawn as a truck" in notes("barrier", MB="0.9999e7 kg")


def test_spins_are_drawn_from_a_rate_on_that_can_be_seen() -> None:
    assert "spin before" not in notes(WA="0.012")
    assert "spin before" in notes(WA="0.03")


def test_what_cannot_be_drawn_is_named() -> None:
    scene = dict.fromkeys(("MA", "MB", "UX", "UY", "VX", "VY"), 1.0)
    unknown_plane = Answer("reconstruct", "", {}, case_of("points", GA=""), scene=scene)
    with pytest.raises(UserError, match="no impact that agrees with the values has GA"):
        draw(unknown_plane)


def test_a_title_is_escaped() -> None:
    svg = draw(ask(case_of(title="</title><script>\x1b")))
    assert "<script" not in svg
    assert "\x1b" not in svg
    assert "&lt;script&gt;" in svg


def test_a_png_is_rendered() -> None:
    pytest.importorskip("resvg_py")
    assert to_png(drawing()).startswith(b"\x89PNG")


def test_a_reconstruction_is_drawn_without_a_plane_that_is_not_known() -> None:
    entries = "M=4 MA=1800 MB=1200 HA=0 HB=-90 SAF=50 SBF=30 HBF=-30 TA=course TB=course".split()
    changes = dict(entry.split("=") for entry in entries)
    case = Case.of({**changes, "HAF": "-40", "units": "metric", "title": "Elm Street"})
    texts = [text.text for text in texts_of(draw(ask(case)))]
    assert texts.count("Elm Street") == 1
    assert "contact plane" not in texts
    assert "18250" in texts


@pytest.mark.parametrize(("speed", "is_drawn"), [("-25", False), ("25", True)])
def test_a_scene_that_physics_forbids_is_drawn_with_its_verdict(speed: str, is_drawn: bool) -> None:
    words = notes(UX=speed, VY="0")
    assert ("NO IMPACT: physics forbids what is drawn" in words) is is_drawn
    assert "contact plane" in words
