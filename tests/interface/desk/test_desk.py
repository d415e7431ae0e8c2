"""The desk without a browser: who is answered, what with, and how it starts and ends."""

from __future__ import annotations

import argparse
import base64
import contextlib
import json
import multiprocessing
import os
import re
import select
import signal
import socket
import subprocess
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from http.client import HTTPConnection
from importlib import resources
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit
from urllib.request import url2pathname

import numpy as np
import pytest
from captures import ROOT
from installed import COMMAND
from installed import impact88 as command
from longer import long_but

from impact88.collision import units
from impact88.collision.casescene import Scene, sample
from impact88.collision.scenefile import CASES, case_template, toml_texts
from impact88.errors import UserError
from impact88.interface.commands import options, reconstruct_command
from impact88.interface.commands.cli import main
from impact88.messages import schemas
from impact88.names import CHAPTER, RESULTS, SCENE, VELOCITIES
from impact88.program.copies import load_machine, run_machine
from impact88.program.run import run

pytest.importorskip("flask", reason="the desk's extra is not installed")
pytest.importorskip("waitress", reason="the desk's extra is not installed")

from impact88.interface.desk import (
    app,
    collision,
    formview,
    guard,
    paper,
    reconstruction,
    serving,
    workers,
)

PORT, TOKEN = 8088, "a-token"
OWN = f"http://127.0.0.1:{PORT}"


Own = Callable[..., str]


@pytest.fixture
def own(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Own:
    """``own(*arguments)``: what the command prints in ``tmp_path``, in this process."""

    def printed(*arguments: str) -> str:
        monkeypatch.chdir(tmp_path)
        capsys.readouterr()
        main(list(arguments))
        return capsys.readouterr().out

    return printed


def asked(method: str = "GET", path: str = f"/{TOKEN}/", **headers: str) -> int | None:
    named = {"Host": f"127.0.0.1:{PORT}"}
    named |= {name.replace("_", "-"): value for name, value in headers.items()}
    return guard.refusal(named, method, path, port=PORT, token=TOKEN)


OPENED = {"Sec_Fetch_Mode": "navigate", "Sec_Fetch_Dest": "document"}
"""Headers of a tab that shows a page as a whole."""


# --- who is answered ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("request_", "status"),
    [
        ({}, None),
        ({"Host": f"localhost:{PORT}"}, None),
        ({"Host": "127.0.0.1"}, 403),
        ({"Host": f"127.0.0.1:{PORT + 1}"}, 403),
        ({"Host": f"rebound.example:{PORT}"}, 403),
        ({"Host": ""}, 403),
        ({"path": "/"}, 404),
        ({"path": "/a-toke/"}, 404),
        ({"path": "/a-tokens/"}, 404),
        ({"path": f"/{TOKEN}/static/desk.css"}, None),
        ({"Origin": OWN}, None),
        ({"Origin": f"http://localhost:{PORT}"}, None),
        ({"Origin": f"https://127.0.0.1:{PORT}"}, 403),
        ({"Origin": "http://127.0.0.1"}, 403),
        ({"Origin": "https://elsewhere.example"}, 403),
        ({"Origin": "null"}, 403),
        ({"method": "POST", "Origin": OWN}, None),
        ({"method": "POST"}, 403),
        ({"method": "POST", "Origin": "https://elsewhere.example"}, 403),
        ({"Sec_Fetch_Site": "same-origin"}, None),
        ({"Sec_Fetch_Site": "none"}, None),
        ({"Sec_Fetch_Site": "cross-site"}, 403),
        ({"Sec_Fetch_Site": "same-site"}, 403),
        ({"Sec_Fetch_Site": "cross-site", **OPENED}, None),
        ({"Sec_Fetch_Site": "cross-site", **OPENED, "path": f"/{TOKEN}/signs.svg"}, 403),
        ({"Sec_Fetch_Site": "cross-site", **OPENED, "path": "/other/"}, 404),
        ({"Sec_Fetch_Site": "cross-site", **OPENED, "Sec_Fetch_Dest": "iframe"}, 403),
        ({"Sec_Fetch_Site": "cross-site", **OPENED, "Sec_Fetch_Mode": "no-cors"}, 403),
        ({"Sec_Fetch_Site": "cross-site", **OPENED, "method": "POST", "Origin": "null"}, 403),
    ],
)
def test_only_the_desks_own_page_is_answered(request_: Any, status: int | None) -> None:
    assert asked(**request_) == status


class Client:
    """A page's requests, without a browser."""

    def __init__(self) -> None:
        self.desk = app.Desk()
        self.http = app.application(self.desk, PORT, TOKEN).test_client()

    def get(self, path: str = "", **headers: str) -> Any:
        return self.http.get(f"/{TOKEN}/{path}", base_url=OWN, headers=headers)

    def post(self, path: str, body: Any = None, **headers: str) -> Any:
        data = body if isinstance(body, bytes) else json.dumps(body)
        headers = {"Origin": OWN, **headers}
        return self.http.post(f"/{TOKEN}/{path}", base_url=OWN, data=data, headers=headers)


@pytest.fixture(scope="module")
def client() -> Iterator[Client]:
    made = Client()
    yield made
    made.desk.close()


def test_the_page_names_every_value_and_nothing_from_elsewhere(client: Client) -> None:
    page = client.get().get_data(as_text=True)
    for quantity in SCENE.values():
        assert f'name="{quantity.name}"' in page
        assert quantity.meaning.replace("'", "&#39;") in page
    assert "http:" not in page
    assert "https:" not in page
    assert "//" not in page.replace("<!DOCTYPE", "")


def test_static_files_name_no_other_place() -> None:
    for file in resources.files("impact88.interface.desk").joinpath("static").iterdir():
        text = file.read_text(encoding="utf-8")
        for address in ("http://", "https://", "url(", "@import"):
            assert address not in text.replace("http://www.w3.org/2000/svg", ""), file.name


def test_every_answer_carries_the_headers(client: Client) -> None:
    for answer in (client.get(), client.get("static/desk.js"), client.get("nothing")):
        for name, value in guard.HEADERS.items():
            assert answer.headers[name] == value
        assert "Access-Control-Allow-Origin" not in answer.headers
    assert "default-src 'none'" in guard.HEADERS["Content-Security-Policy"]
    assert "unsafe" not in guard.HEADERS["Content-Security-Policy"]


def test_who_is_refused_gets_not_a_word(client: Client) -> None:
    for answer in (
        client.get(**{"Origin": "https://elsewhere.example"}),
        client.post("collision", {"values": {}}, Origin="https://elsewhere.example"),
        client.http.get("/", base_url=OWN),
        client.http.get(f"/{TOKEN}/", base_url="http://elsewhere.example"),
    ):
        assert answer.status_code in (403, 404)
        assert answer.data == b""


def test_a_body_over_the_limit_is_refused(client: Client) -> None:
    answer = client.post("scene", b" " * (guard.LARGEST_BODY + 1))
    assert answer.status_code == 413
    assert f"{guard.LARGEST_BODY:,}" in answer.json["problem"]
    assert client.post("scene", b" " * 1000).status_code == 200


@pytest.mark.parametrize(
    "body", [b"", b"{", b"[]", b"[" * 100_000, b'{"values": []}', b'{"values": {"E": 1}}']
)
def test_what_is_no_question_gets_a_sentence(client: Client, body: bytes) -> None:
    answer = client.post("collision", body)
    assert answer.status_code == 400
    assert "\n" not in answer.json["problem"]


@pytest.mark.parametrize(
    ("path", "body", "problem"),
    [
        ("collision", {"values": {}, "units": {}}, "'units' is not text"),
        ("collision", {"values": {}, "units": "furlongs"}, "'furlongs' is not a system of units"),
        ("bounds", {"values": {}, "units": ["us"]}, "'units' is not text"),
        ("reconstruct", {"values": {}, "units": 7}, "'units' is not text"),
        ("file/collision", {"values": {}, "title": []}, "'title' is not text"),
        ("file/collision", {"values": {}, "title": "\ud800"}, "is not JSON"),
        ("report", {}, "'papers' is not a list"),
        ("report", {"papers": 3, "words": {}}, "'papers' is not a list"),
        ("report", {"papers": [3], "words": {}}, "'papers' is not a list"),
        ("report", {"papers": [{"name": "a", "data": "?"}], "words": {}}, "is not base 64"),
        ("report", {"papers": [{"name": "a"}], "words": {}}, "is not base 64"),
        ("report", {"papers": [], "words": []}, "'words' is not an object of texts"),
        ("report", {"papers": [], "words": {"case": 5}}, "'words' is not an object of texts"),
    ],
)
def test_json_of_another_form_gets_a_reason(
    client: Client, path: str, body: Any, problem: str
) -> None:
    answer = client.post(path, body)
    assert answer.status_code == 400
    assert problem in answer.json["problem"]


# --- the collision -----------------------------------------------------------------------------


@pytest.mark.parametrize("number", [1, 2, 3])
def test_a_published_run_is_answered_with_the_programs_own_printout(number: int, own: Own) -> None:
    told = collision.answer(dict(sample(number)))
    assert told["problems"] == {}
    assert told["missing"] == told["ranges"] == []
    assert told["oracle"]["printout"] == run(sample(number)).printout
    assert told["page"] == own("run", "--sample", str(number))
    printed = {row["name"]: row["printed"] for row in told["results"]}
    assert all(text in told["page"] for text in printed.values())


def test_the_screen_is_the_emulators_memory() -> None:
    for number in (1, 2, 3):
        told = collision.answer(dict(sample(number)))["screen"]
        apple = load_machine(sample(number))
        run_machine(apple)
        machine = apple.machine
        assert len(told) == 24
        for row, runs in enumerate(told):
            start = 0x400 + row % 8 * 0x80 + row // 8 * 40
            memory = [machine.peek(start + column) for column in range(40)]
            assert [kind for kind, text in runs for _ in text] == ["normal"] * 40
            assert "".join(text for _, text in runs) == "".join(chr(b & 0x7F) for b in memory)
    codes = bytes([0x01, 0x20, 0x41, 0x60, 0xC1, 0xA0])
    runs = [("inverse", "A "), ("flashing", "A "), ("normal", "A ")]
    assert collision.screen_runs(codes) == runs


@pytest.mark.parametrize(
    ("number", "units"), [(1, ""), (1, "us"), (2, "chapter"), (2, "metric"), (3, "si"), (3, "us")]
)
def test_the_answer_is_what_reconstruct_says_of_the_same_impact(
    number: int, units: str, tmp_path: Path, own: Own
) -> None:
    values = dict(sample(number))
    told = collision.answer(values, units)
    head = f'units = "{units}"\n' if units else ""
    known = {name: text for name, text in values.items() if name not in ("MU",)}
    found = {row["name"]: row["value"] for row in told["results"]}
    known["MUP"] = told["oracle"]["results"]["MUP"]["printed"]
    (tmp_path / "known.toml").write_text(head + toml(known), encoding="utf-8")
    theirs = json.loads(own("reconstruct", "--json", "known.toml"))["solutions"][0]["values"]
    shown = {one["name"]: one["text"] for row in told["answer"] for one in row["values"]}
    assert set(shown) >= {"DVA", "DVB", "SAF", "SBF", "LOSS", "PDOFA", "VC"}
    for name, text in shown.items():
        if name not in ("MUP", "MUC", "LOSS"):
            assert float(text) == pytest.approx(theirs[name], rel=6e-4, abs=1e-9), name
        if name in found:
            assert float(text) == pytest.approx(found[name], rel=6e-4, abs=1e-9), name


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    "changes", [dict.fromkeys(("UX", "UY", "WA", "VX", "VY", "WB"), "0"), {"MA": "0"}, {"M": "4"}]
)
def test_what_has_no_value_is_no_fault(changes: dict[str, str]) -> None:
    told = collision.answer({**sample(1), **changes})
    rows = {row["words"]: [one["text"] for one in row["values"]] for row in told["answer"]}
    assert "nan" not in str(rows)
    assert rows["Speed before"]


def test_an_enormous_friction_leaves_the_critical_one_as_it_is() -> None:
    """Pure numbers have no common size below which one of them is rounding."""
    told = collision.answer({**sample(1), "MU": "1E15"})
    texts = {one["name"]: one["text"] for row in told["answer"] for one in row["values"]}
    assert texts["MUC"] == "0.9316"


def test_point_masses_along_a_line_need_neither_spins_nor_a_plane(tmp_path: Path, own: Own) -> None:
    """What the program is typed in their place is said, what faces nowhere has no direction."""
    values = {"M": "4", "MA": "94", "MB": "78", "UX": "29", "VX": "0", "UY": "0", "VY": "0"}
    values |= {"E": ".2", "MU": "0"}
    told = collision.answer(values)
    assert told["answer"][0]["values"][0]["value"] == pytest.approx(1.2 * 29 * 78 / (94 + 78))
    said = " ".join(told["remarks"])
    assert "takes 0 for what is not given" in said
    assert "contact plane across the motion" in said
    assert "need TA" in said
    (tmp_path / "line.toml").write_text(toml(values), encoding="utf-8")
    own("report", "line.toml", "-o", "line.html")
    for text in (said, (tmp_path / "line.html").read_text("utf-8")):
        assert "initial spin" not in text


@pytest.mark.parametrize("units", ["", "us"])
def test_the_case_report_is_the_commands_own(
    client: Client, units: str, tmp_path: Path, own: Own
) -> None:
    asked = {"values": dict(sample(1)), "title": "One", "units": units}
    saved = client.post("case-report/collision", asked)
    (tmp_path / "scene.toml").write_bytes(client.post("file/collision", asked).data)
    own("report", "scene.toml", "-o", "case.html")
    assert saved.data == (tmp_path / "case.html").read_bytes()
    known = {"values": {**reconstruction.known_of_sample(1)["values"], "E": "0.1"}, "units": units}
    assert b"reconstructed" in client.post("case-report/reconstruction", known).data
    assert client.post("case-report/nothing", known).status_code == 404
    assert client.post("case-report/collision", {"values": {"E": "1"}}).status_code == 400


@pytest.mark.parametrize(
    ("name", "text", "problem"),
    [
        ("MU", ".911", None),
        ("MU", "much", "MU: 'much' is not an amount"),
        ("MU", ".9 .. .7", "out of order"),
        ("MU", "<script>", "<script>"),
        ("M", "4", None),
        ("M", "5", "expected 6, or 4"),
        ("M", "4 .. 6", "expected 6, or 4"),
        ("DA", "1" * 70, None),
        ("DA", "1" * 71, "more than 70 characters"),
    ],
)
def test_each_value_is_judged_alone(name: str, text: str, problem: str | None) -> None:
    told = collision.answer({**sample(1), name: text, "MA": ""})
    assert told["missing"] == ["MA"]
    if problem is None:
        assert told["problems"] == {}
    else:
        assert list(told["problems"]) == [name]
        assert problem in told["problems"][name]


def test_a_range_goes_to_the_bounds_and_its_middle_to_the_program() -> None:
    told = collision.answer({**sample(1), "MU": "0.7 .. 0.9"})
    assert told["ranges"] == ["MU"]
    assert told["oracle"]["scene"]["MU"] == "0.8"
    assert told["oracle"]["printout"] == run(sample(1).replaced({"MU": "0.8"})).printout
    found = collision.bounds_answer({**sample(1), "MU": "0.7 .. 0.9"})
    assert found["inputs"]["MU"]["limits"] == [0.7, 0.9]
    for bound in found["outputs"].values():
        assert bound["lower"] <= bound["nominal"] <= bound["upper"]
    with pytest.raises(UserError, match="no ranges"):
        collision.bounds_answer(dict(sample(1)))


def test_units_are_the_commands_units(client: Client, tmp_path: Path, own: Own) -> None:
    values = {**sample(1), "UX": "-19.8 mph"}
    mixed = collision.answer(values)
    assert list(mixed["problems"]) == ["units"]
    assert "some values have units" in mixed["problems"]["units"]
    values = {**sample(1), "UX": "-19.8", "VX": "9.9", "VY": "17 +- 1"}
    told = collision.answer(values, "us")
    assert told["problems"] == {}
    assert told["units"]["base"] == "ft, slug, s"
    assert told["units"]["labels"]["length/time"] == "mph"
    assert told["oracle"]["scene"]["UX"] == "-29.04"
    shown = {row["name"]: row["shown"] for row in told["results"]}
    exact = {row["name"]: float(row["exact"]) for row in told["results"]}
    amount, unit = shown["VAX"].split()
    assert unit == "mph"
    assert float(amount) == pytest.approx(exact["VAX"] * 3600 / 5280, rel=1e-5)
    plain = {**values, "VY": "17"}
    saved = client.post("file/collision", {"values": plain, "title": "", "units": "us"})
    (tmp_path / "scene.toml").write_bytes(saved.data)
    printed = own("run", "scene.toml")
    assert printed == collision.answer(plain, "us")["page"]
    assert client.post("scene?name=s", saved.data).json["units"] == "us"
    wrong = collision.answer({**values, "MA": "3 ft"}, "us")
    assert list(wrong["problems"]) == ["MA"]


def test_friction_as_a_share_of_the_critical_one_is_the_commands(tmp_path: Path, own: Own) -> None:
    values = {**sample(1), "MU": "50 %"}
    told = collision.answer(values)
    (tmp_path / "scene.toml").write_text("".join(f'{n} = "{t}"\n' for n, t in values.items()))
    assert told["page"] == own("run", "scene.toml")
    assert "50 % of the critical friction" in told["remarks"][0]


def test_what_was_estimated_is_said_and_outlines_are_kept(client: Client) -> None:
    """Lengths and widths are drawn, and saved again."""
    lines = [f'{n} = "{t}"' for n, t in sample(1).items() if n != "IA"]
    text = "\n".join([*lines, 'IA = "estimate"', "LA = 15", "BA = 6"])
    read = client.post("scene?name=s", text.encode()).json
    assert read["values"]["IA"] == "estimate"
    asked = {"values": {**read["values"], **read["extra"]}, "title": "", "units": ""}
    assert "A drawn as measured, 15 by 6." in client.post("figure", asked).get_data(as_text=True)
    told = client.post("collision", asked).json
    inertia = float(told["oracle"]["scene"]["IA"])
    assert inertia == pytest.approx(143.5 * (15**2 + 6**2) / 12, rel=1e-3)
    assert "is estimated: MA (LA² + BA²)/12" in told["remarks"][0]
    saved = client.post("file/collision", asked).data
    assert b"LA = 15" in saved
    assert b'IA = "estimate"' in saved
    known = client.post("known?name=k", text.encode()).json
    assert known["values"]["IA"] == read["values"]["IA"]


def test_a_contact_point_in_a_vehicles_own_axes_is_worked_out(client: Client) -> None:
    text = "".join(f'{n} = "{t}"\n' for n, t in sample(1).items() if n not in ("DA", "PA"))
    read = client.post("scene?name=s", (text + "CAF = 3\nCAL = 4\n").encode()).json
    assert read["extra"] == {"CAF": "3", "CAL": "4"}
    asked = {"values": {**read["values"], **read["extra"]}, "title": "", "units": ""}
    scene = client.post("collision", asked).json["oracle"]["scene"]
    assert float(scene["DA"]) == 5
    assert float(scene["PA"]) == pytest.approx(53.13010235)


@pytest.mark.parametrize("number", [1, 2, 3])
def test_a_scene_saved_is_the_commands_own_file(client: Client, number: int, own: Own) -> None:
    scene = client.post(f"solve/{number}").json
    saved = client.post("file/collision", scene)
    assert saved.data == own("scene", "--sample", str(number)).encode()
    assert 'filename="scene.toml"' in saved.headers["Content-Disposition"]
    assert client.post("scene?name=scene.toml", saved.data).json == scene


def test_kinds_of_collision_are_forms_to_fill_in(client: Client) -> None:
    """Those whose command a view answers for, each with the entries of its file."""
    offered = set(re.findall(r'value="template/([^"]+)"', client.get().get_data(as_text=True)))
    assert offered == {n for n, c in CASES.items() if c.command in ("solve", "reconstruct")}
    for name in offered:
        form = client.post(f"template/{name}").json
        assert {**form["values"], "units": "us"} == toml_texts(case_template(name), "")
    assert client.post("template/none").status_code == 404


def test_a_scene_file_with_ranges_is_read_again(client: Client) -> None:
    values = {**sample(1), "MU": "0.7 .. 0.9", "GA": ""}
    title = "box 7, \"the\" \\ '''file''' # 3"
    saved = client.post("file/collision", {"values": values, "title": title})
    again = client.post("scene?name=s", saved.data).json
    assert again == {"values": values, "title": title, "units": ""}


@pytest.mark.parametrize(
    ("data", "problem"),
    [
        (b"MU = 1\nMU = 2", "s.toml, line 2: MU is given twice"),
        (b"QQ = 1", "s.toml: 'QQ' is not a name used here"),
        (b"#" + b" " * 1_000_000, "s.toml: is larger than 1,000,000 bytes"),
        (b"\xff\xfe\x00", "s.toml"),
    ],
)
def test_an_unusable_scene_file_is_named(client: Client, data: bytes, problem: str) -> None:
    answer = client.post("scene?name=s.toml", data)
    assert answer.status_code == 400
    assert answer.json["problem"].startswith(problem)


def test_the_figure_is_the_commands_own(client: Client, tmp_path: Path, own: Own) -> None:
    path = tmp_path / "scene.svg"
    own("figure", "scene", "--sample", "3", "-o", str(path))
    drawn = client.post("figure", client.post("solve/3").json)
    _, _, element = path.read_text(encoding="utf-8").partition("?>\n")
    assert drawn.get_data(as_text=True) == element


def check_schema(name: str, whole: Any) -> None:
    jsonschema = pytest.importorskip("jsonschema")
    assert whole["schema"] == f"impact88/{name}/{schemas.NUMBERS[name]}"
    jsonschema.validate(json.loads(json.dumps(whole)), json.loads(schemas.text(name)))


@pytest.mark.usefixtures("brief_search")
def test_what_the_page_is_answered_follows_the_published_schemas() -> None:
    ranged = {**sample(1), "MU": "0.7 .. 0.9"}
    known = reconstruction.known_of_sample(1)["values"]
    check_schema("oracle", collision.answer(ranged)["oracle"])
    check_schema("bounds", collision.bounds_answer(ranged, draws=100))
    check_schema("reconstruct", reconstruction.answer(known, draws=100)["object"])
    check_schema(
        "reconstruct", reconstruction.answer({**known, "VAX": "-13 +- 1"}, draws=100)["object"]
    )


# --- the reconstruction -------------------------------------------------------------------------


def toml(values: Mapping[str, str]) -> str:
    return "".join(f'{name} = "{text}"\n' for name, text in values.items())


@pytest.mark.usefixtures("brief_search")
@pytest.mark.parametrize(
    "changes", long_but([{}, {"VAX": "-13.26 +- 0.5", "UY": "0", "VBY": "20 +- 1"}])
)
def test_a_reconstruction_is_the_commands_own(
    changes: dict[str, str], tmp_path: Path, own: Own
) -> None:
    known = {**reconstruction.known_of_sample(1)["values"], "E": "0.3", **changes}
    (tmp_path / "known.toml").write_text(toml(known), encoding="utf-8")
    told = reconstruction.answer(known, draws=100)
    assert told["problems"] == {}
    printed = own("reconstruct", "--full", "known.toml", "--samples", "100").rstrip("\n")
    assert [one["printed"] for one in told["solutions"]] == [printed]
    theirs = json.loads(own("reconstruct", "--json", "known.toml", "--samples", "100"))
    assert json.loads(json.dumps(told["object"])) == theirs
    assert bool(told["solutions"][0]["adjusted"]) == bool(changes)


def test_rounding_is_nowhere_shown_as_a_number() -> None:
    """Spins that were 0, a sum of squares of values that agree, in tables, text and scene."""
    known = reconstruction.known_of_sample(1)["values"]
    answer = reconstruction.answer({**known, "VAX": f"{known['VAX']} +- 1", "UY": "0"}, draws=0)
    (solution,) = answer["solutions"]
    assert {solution["scene"][name] for name in ("UY", "WA", "WB")} == {"0"}
    (evidence,) = [text for label, text, _ in solution["lines"] if label == "EVIDENCE"]
    assert "sum of squared adjustments, in standard deviations, 0 where about 1" in evidence
    assert [row["moved"] for row in solution["adjusted"]] == ["0.00"]
    assert not re.search(r"\de-1\d", solution["printed"])


def test_what_a_collision_gave_is_reconstructed_to_the_collision() -> None:
    known = reconstruction.known_of_sample(3)["values"]
    (solution,) = reconstruction.answer(known)["solutions"]
    for name in VELOCITIES:
        assert float(solution["scene"][name]) == pytest.approx(float(sample(3)[name]), abs=1e-9)
    solved = [row["name"] for row in solution["rows"] if row["solved"]]
    assert sorted(solved) == sorted(VELOCITIES)
    assert solution["scene"]["MA"] == sample(3)["MA"]


@pytest.mark.usefixtures("brief_search")
@pytest.mark.parametrize(
    ("name", "text", "problem"),
    [
        ("VAX", "-13.2", None),
        ("VAX", "-13.2 +- .1", None),
        ("VAX", "-13.2 +- x", "is not an amount"),
        ("SA", "29", None),
        ("QQ", "1", "not a name used here"),
    ],
)
def test_each_known_value_is_judged_alone(name: str, text: str, problem: str | None) -> None:
    known = reconstruction.known_of_sample(3)["values"]
    told = reconstruction.answer({**known, name: text}, draws=100)
    assert list(told["problems"]) == ([name] if problem else [])
    assert (problem or "") in told["problems"].get(name, "")
    assert bool(told["solutions"]) == (problem is None)


@pytest.mark.parametrize("to", ["us", "chapter", "metric", "si"])
def test_a_form_in_other_units_is_the_same_collision(client: Client, to: str) -> None:
    values = {**collision.sample_scene(1)["values"], "UX": "-29.04 +- 2", "LA": "16", "BA": "6"}
    asked_for = {"values": values, "units": "chapter", "to": to}
    told = client.post("convert", asked_for).json["values"]
    before, after = (
        collision.answer(texts, units)["oracle"]["results"]
        for texts, units in ((values, "chapter"), (told, to))
    )
    assert after["LOSS"]["double"] == pytest.approx(before["LOSS"]["double"], rel=1e-12)
    assert told["UX"].startswith("-29.04 +- 2 ft/s")


@pytest.mark.usefixtures("brief_search")
def test_a_reconstruction_answers_in_its_units(tmp_path: Path, own: Own) -> None:
    known = {**reconstruction.known_of_sample(3)["values"], "VAX": "-5.1 +- 1"}
    told = reconstruction.answer(known, "us", draws=100)
    (tmp_path / "known.toml").write_text('units = "us"\n' + toml(known), encoding="utf-8")
    printed = own("reconstruct", "--full", "known.toml", "--samples", "100")
    assert [one["printed"] for one in told["solutions"]] == [printed.rstrip("\n")]
    rows = {row["name"]: row for row in told["solutions"][0]["rows"]}
    assert rows["UX"]["unit"] == "mph"
    deviation = re.search(r"^VX +(\S+) ", printed[printed.index("first order") :], re.M)
    assert deviation
    assert rows["VX"]["columns"]["sd"] == deviation[1]


@pytest.mark.parametrize("units", ["us", "metric", "si", "chapter"])
def test_what_was_reconstructed_opens_as_a_collision_in_its_units(units: str) -> None:
    known = reconstruction.known_of_sample(3)["values"]
    (solution,) = reconstruction.answer(known, units)["solutions"]
    rows = collision.answer(solution["scene"], units)["results"]
    found = {row["name"]: row["value"] for row in rows}
    for name in ("VAX", "VAY", "VBX", "VBY", "WAF", "WBF"):
        assert found[name] == pytest.approx(float(known[name]), rel=1e-8)


def test_what_is_known_is_saved_as_the_commands_file(
    client: Client, tmp_path: Path, own: Own
) -> None:
    known = {**client.post("reconstruct/1").json["values"], "VAX": "-13.26 +- 0.5", "UY": "0"}
    saved = client.post("file/reconstruction", {"values": known})
    assert saved.status_code == 200
    read = client.post("known?name=k.toml", saved.data).json
    assert {name: text for name, text in read.pop("values").items() if text} == known
    assert read == {"title": "", "units": ""}
    (tmp_path / "known.toml").write_bytes(saved.data)
    printed = own("reconstruct", "--full", "known.toml")
    assert printed.rstrip("\n") == reconstruction.answer(known)["solutions"][0]["printed"]
    template = own("reconstruct", "--template")
    assert (
        client.post("file/reconstruction", {"values": {"M": "6"}}).get_data(as_text=True)
        == template
    )
    refused = client.post("known?name=k.toml", b"QQ = 1")
    assert refused.json["problem"].startswith("k.toml: 'QQ' is not a name used here")


@pytest.mark.parametrize("changes", [{"MA": "-3000"}, {"E": "-2"}, {"MU": "-10", "UX": "1E38"}])
def test_every_answer_is_json_that_a_browser_reads(client: Client, changes: dict[str, str]) -> None:
    def refuse(constant: str) -> None:
        pytest.fail(f"{constant} is not JSON")

    answer = client.post("collision", {"values": {**sample(1), **changes}, "units": ""})
    assert json.loads(answer.get_data(), parse_constant=refuse)["answer"]


def test_why_there_is_no_solution_is_told() -> None:
    known = reconstruction.known_of_sample(3)["values"]
    told = reconstruction.answer({name: text for name, text in known.items() if name != "E"})
    assert told["solutions"] == []
    assert "is determined by what is known; give WA" in told["waiting"]


# --- the paper ----------------------------------------------------------------------------------

RUN1 = resources.files("impact88.legacy").joinpath("run1-as-printed.txt").read_bytes()


def coded(data: bytes) -> str:
    return base64.b64encode(data).decode()


@pytest.mark.parametrize(
    "data",
    long_but(
        [RUN1, RUN1.replace(b"3.449", b"3.549"), RUN1[:300], b"nothing", b"%PDF-1.4", b""],
        kept=(0, 2, 3, 4, 5),
    ),
)
def test_a_paper_is_judged_as_the_command_judges_it(data: bytes, tmp_path: Path, own: Own) -> None:
    (tmp_path / "page.txt").write_bytes(data)
    told = paper.judge("page.txt", data)
    objects = [json.loads(line) for line in own("verify", "--json", "page.txt").splitlines()]
    assert json.loads(json.dumps(told["objects"])) == objects
    assert told["problem"] == objects[0].get("error")
    for whole in told["objects"]:
        check_schema("verify", whole)
    shown = own("verify", "page.txt")
    for words in told["printouts"]:
        assert f": {words['title']}\n" in shown
        lines = [*words["summary"], *(line for part in words["parts"] for line in part["items"])]
        for line in lines:
            # where to look is told with the explanations, and there only of what they change
            assert line.strip() in shown or line in words["parts"][0]["items"]


@pytest.mark.parametrize(
    ("name", "base"),
    [
        ("box 7/page 1.txt", "page 1.txt"),
        ("C:\\case\\page.txt", "page.txt"),
        ("../../etc/passwd", "passwd"),
        ("<b>.txt", "<b>.txt"),
        ("-", "pasted.txt"),
        ("..", "pasted.txt"),
        ("", "pasted.txt"),
        ("a\x1b[2Jb.txt", "a[2Jb.txt"),
        ("n" * 300, "n" * 200),
    ],
)
def test_a_papers_name_is_a_name_and_nothing_else(name: str, base: str) -> None:
    assert paper.base_name(name) == base


def test_what_is_no_file_is_refused_before_it_is_read() -> None:
    with pytest.raises(UserError, match="is larger than"):
        paper.judge("page.txt", b" " * (paper.LARGEST_FILE + 1))
    with pytest.raises(UserError, match="nothing to report"):
        paper.report([], {})
    with pytest.raises(UserError, match=r"^case: has more than 200"):
        paper.report([{"name": "x", "data": coded(RUN1)}], {"case": "x" * 201})


@pytest.mark.long
def test_a_scan_is_read_itself() -> None:
    pytest.importorskip("PIL", reason="the scan extra is not installed")
    scan = ROOT / "golden/scans/clean-001.png"
    told = paper.judge(scan.name, scan.read_bytes())
    assert [words["title"] for words in told["printouts"]] == ["IDENTICAL"]
    assert "VAX=" in told["text"]
    for check in told["objects"][0]["fields"]:
        assert told["text"][check["start"] : check["stop"]] == check["printed"]


@pytest.mark.long
def test_half_a_megabyte_of_one_letter_is_no_printout() -> None:
    assert "no printout" in paper.judge("page.txt", b"x" * 500_000)["problem"]


# --- processes ---------------------------------------------------------------------------------


def wait_until(holds: Any) -> None:
    deadline = time.monotonic() + 90.0
    while time.monotonic() < deadline:
        if holds():
            return
        time.sleep(0.02)
    raise AssertionError("never came about")


def in_thread(work: Any) -> tuple[threading.Thread, list[Any]]:
    outcome: list[Any] = []

    def caught() -> None:
        try:
            outcome.append(work())
        except Exception as error:
            outcome.append(error)

    thread = threading.Thread(target=caught, daemon=True)
    thread.start()
    return thread, outcome


def wait_for(*threads: threading.Thread) -> None:
    for thread in threads:
        thread.join(90.0)
        assert not thread.is_alive()


def is_gone(process: int) -> bool:
    multiprocessing.active_children()  # takes leave of those that have ended
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return True
    return False


@pytest.fixture(scope="module")
def asking() -> Iterator[workers.Bench]:
    bench = workers.Bench("deskwork")
    yield bench
    bench.close()


RANGED = {"values": {**sample(1), "MU": "0.7 .. 0.9"}}


def ask_endlessly(bench: workers.Bench, folder: Path) -> tuple[threading.Thread, list[Any], int]:
    """The thread that asks in a page's first turn, what it is told in the end, and the process that
    is kept busy."""
    begun = folder / "begun"
    thread, outcome = in_thread(lambda: bench.ask(folder.name, 1, "endless", begun=str(begun)))
    wait_until(begun.exists)
    return thread, outcome, int(begun.read_text())


def test_a_newer_question_ends_the_older_and_another_page_waits(
    asking: workers.Bench, tmp_path: Path
) -> None:
    page = tmp_path.name
    first, first_outcome, process = ask_endlessly(asking, tmp_path)
    other, other_outcome = in_thread(lambda: asking.ask("other", 1, "repeated", text="other"))
    newer, newer_outcome = in_thread(lambda: asking.ask(page, 2, "repeated", text="newer"))
    wait_for(first, other, newer)
    assert [type(outcome) for outcome in first_outcome] == [workers.SupersededError]
    wait_until(partial(is_gone, process))
    assert (newer_outcome, other_outcome) == (["newer"], ["other"])
    with pytest.raises(workers.BrokenError, match="AttributeError"):
        asking.ask(page, 3, "nothing_of_the_sort")


def test_stopping_ends_what_a_page_waits_for_and_no_other_pages(
    asking: workers.Bench, tmp_path: Path
) -> None:
    thread, outcome, process = ask_endlessly(asking, tmp_path)
    asking.stop("other", 7)
    assert not is_gone(process)
    asking.stop(tmp_path.name, 2)
    wait_for(thread)
    assert [type(one) for one in outcome] == [workers.SupersededError]
    wait_until(partial(is_gone, process))


def test_what_arrives_after_its_stop_or_a_newer_question_is_superseded(
    asking: workers.Bench, tmp_path: Path
) -> None:
    page = tmp_path.name
    asking.stop(page, 2)
    with pytest.raises(workers.SupersededError):
        asking.ask(page, 1, "repeated", text="stopped")
    assert asking.ask(page, 3, "repeated", text="after the stop") == "after the stop"
    with pytest.raises(workers.SupersededError):
        asking.ask(page, 2, "repeated", text="overtaken")
    # and a Stop that is late ends nothing that was asked since
    begun = tmp_path / "begun"
    thread, outcome = in_thread(lambda: asking.ask(page, 5, "endless", begun=str(begun)))
    wait_until(begun.exists)
    asking.stop(page, 4)
    assert thread.is_alive()
    assert not is_gone(int(begun.read_text()))
    asking.stop(page, 6)
    wait_for(thread)
    assert [type(one) for one in outcome] == [workers.SupersededError]


def test_pages_that_count_no_turns_are_stopped_too(asking: workers.Bench, tmp_path: Path) -> None:
    begun = tmp_path / "begun"
    thread, outcome = in_thread(lambda: asking.ask("uncounted", 0, "endless", begun=str(begun)))
    wait_until(begun.exists)
    asking.stop("uncounted", 0)
    wait_for(thread)
    assert [type(one) for one in outcome] == [workers.SupersededError]
    assert asking.ask("uncounted", 0, "repeated", text="next") == "next"


def test_turns_of_a_thousand_pages_are_remembered(asking: workers.Bench) -> None:
    asking.stop("the oldest", 2)
    for number in range(workers.PAGES_REMEMBERED - 1):
        asking.stop(f"page {number}", 1)
    with pytest.raises(workers.SupersededError):
        asking.ask("the oldest", 1, "repeated", text="stopped")
    asking.stop("page of one more", 1)
    assert asking.ask("page 0", 0, "repeated", text="forgotten") == "forgotten"


def test_a_process_killed_while_it_waits_is_started_again(asking: workers.Bench) -> None:
    process = asking.ask("page", 1, "own_process")
    for turn in range(2, 8):
        os.kill(process, signal.SIGKILL)
        if turn % 2:
            wait_until(partial(is_gone, process))
        before, process = process, asking.ask("page", turn, "own_process")
        assert process != before


def test_a_process_killed_while_it_answers_is_told_and_started_again(
    asking: workers.Bench, tmp_path: Path
) -> None:
    thread, outcome, process = ask_endlessly(asking, tmp_path)
    os.kill(process, signal.SIGKILL)
    wait_for(thread)
    assert [type(one) for one in outcome] == [workers.BrokenError]
    assert "ended unexpectedly" in str(outcome[0])
    assert asking.ask(tmp_path.name, 2, "repeated", text="next") == "next"


def test_a_closed_bench_answers_nothing(tmp_path: Path) -> None:
    bench = workers.Bench("deskwork")
    thread, outcome, process = ask_endlessly(bench, tmp_path)
    bench.close()
    wait_for(thread)
    assert is_gone(process)
    with pytest.raises(workers.SupersededError):
        bench.ask("page", 1, "repeated", text="late")
    assert [type(one) for one in outcome] == [workers.SupersededError]


def test_too_many_questions_are_refused(asking: workers.Bench, tmp_path: Path) -> None:
    thread, _, _ = ask_endlessly(asking, tmp_path)
    waiting = [
        in_thread(lambda page=f"waiting {number}": asking.ask(page, 1, "repeated", text=""))
        for number in range(guard.MAX_QUESTIONS - 1)
    ]

    def refused() -> bool:  # once all of them are there
        try:
            asking.stop("one more", 3)
            asking.ask("one more", 2, "repeated", text="")
        except workers.SupersededError:
            return False
        except UserError as error:
            return "questions wait" in str(error)
        raise AssertionError

    wait_until(refused)
    asking.stop(tmp_path.name, 2)
    wait_for(thread, *(one for one, _ in waiting))
    assert [outcome for _, outcome in waiting] == [[""]] * len(waiting)
    assert asking.ask("one more", 4, "repeated", text="room") == "room"


def test_what_takes_too_long_is_ended_and_told(tmp_path: Path) -> None:
    bench = workers.Bench("deskwork", seconds=0.01)
    with pytest.raises(UserError, match="not answered within"):
        bench.ask("page", 1, "endless", begun=str(tmp_path / "begun"))
    bench.close()


# --- the command -------------------------------------------------------------------------------


@pytest.fixture
def started() -> Iterator[tuple[subprocess.Popen[str], str]]:
    process = subprocess.Popen(
        [COMMAND, "desk", "--no-browser"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # a shell's background job ignores control-C, and what it starts does too
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    assert process.stdout is not None
    yield process, process.stdout.readline().strip()
    process.kill()
    process.communicate()


def test_it_prints_its_address_serves_only_there_and_ends_with_control_c(started: Any) -> None:
    process, address = started
    parts = urlsplit(address)
    assert (parts.scheme, parts.hostname) == ("http", "127.0.0.1")
    assert len(parts.path.strip("/")) >= 20
    connection = HTTPConnection("127.0.0.1", parts.port, timeout=100)
    connection.request("GET", parts.path)
    answer = connection.getresponse()
    assert answer.status == 200
    assert b"<title>impact88 desk</title>" in answer.read()
    assert not answer.headers.get("Server")
    connection.request("GET", "/")
    assert (refused := connection.getresponse()).status == 404
    assert refused.read() == b""
    connection.close()
    # every address of 127.0.0.0/8 is this machine; the desk has but one
    with pytest.raises(OSError, match=r"refused|timed out|reachable"):
        socket.create_connection(("127.0.0.2", parts.port or 0), timeout=2)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=100)
    assert process.returncode == 0
    assert out == ""
    assert err == "Control-C ends the desk\n"


@pytest.mark.long
def test_half_open_connections_stall_nobody(started: Any) -> None:
    """300 that send part of a header and wait: another is answered, once the silent are closed."""
    parts = urlsplit(started[1])
    waiting = []
    try:
        for _ in range(300):
            one = socket.create_connection(("127.0.0.1", parts.port or 0), timeout=100)
            one.sendall(b"GET / HTTP/1.1\r\nHost: ")
            waiting.append(one)
        connection = HTTPConnection("127.0.0.1", parts.port, timeout=100)
        connection.request("GET", parts.path)
        assert connection.getresponse().status == 200
        connection.close()
        with contextlib.suppress(ConnectionResetError):
            assert waiting[0].recv(1) == b""
    finally:
        for one in waiting:
            one.close()


def test_connections_that_were_refused_keep_nobody_out(started: Any) -> None:
    """More connections than may wait, each answered once: a new one is answered all the same."""
    parts = urlsplit(started[1])
    refused = []
    try:
        for _ in range(70):
            connection = HTTPConnection("127.0.0.1", parts.port, timeout=100)
            connection.request("GET", "/")
            assert connection.getresponse().read() == b""
            refused.append(connection)
        for _ in range(3):
            own = HTTPConnection("127.0.0.1", parts.port, timeout=100)
            own.request("GET", parts.path)
            assert own.getresponse().status == 200
            own.close()
    finally:
        for connection in refused:
            connection.close()


def test_a_refusal_ends_its_connection(started: Any) -> None:
    """What is sent behind it is not served."""
    parts = urlsplit(started[1])
    request = f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{parts.port}\r\n\r\n".encode()
    with socket.create_connection(("127.0.0.1", parts.port or 0), timeout=20) as one:
        one.sendall(request * 100)
        answer = b""
        while part := one.recv(1 << 16):
            answer += part
    assert answer.count(b"HTTP/1.1 404") == 1
    assert b"Connection: close" in answer


def test_a_body_that_is_too_long_is_answered_before_the_connection_goes(started: Any) -> None:
    parts = urlsplit(started[1])
    size = guard.LARGEST_BODY + 1
    connection = HTTPConnection("127.0.0.1", parts.port, timeout=20)
    headers = {"Origin": f"http://127.0.0.1:{parts.port}"}
    connection.request("POST", f"{parts.path}judge", b" " * size, headers)
    answer = connection.getresponse()
    assert answer.status == 413
    assert f"{guard.LARGEST_BODY:,}" in json.loads(answer.read())["problem"]
    connection.close()


def test_stop_is_answered_while_many_pages_wait(started: Any) -> None:
    parts = urlsplit(started[1])
    origin = f"http://127.0.0.1:{parts.port}"

    def post(path: str, page: str, turn: int, body: Any = None) -> HTTPConnection:
        connection = HTTPConnection("127.0.0.1", parts.port, timeout=100)
        headers = {"Origin": origin, "X-Desk-Page": page, "X-Desk-Turn": str(turn)}
        connection.request("POST", parts.path + path, json.dumps(body), headers)
        return connection

    question = {**RANGED, "units": ""}
    waiting = [post("bounds", f"page {number}", 1, question) for number in range(20)]
    last, stop = waiting[-1], post("stop/bounds", "page 19", 2)
    assert stop.getresponse().status == 200
    assert last.getresponse().status == 409
    # one process answers in turn: were the stop answered in turn, too, all others were before it
    still = [one for one in waiting[:-1] if not select.select([one.sock], [], [], 0)[0]]
    assert still
    for connection in (*waiting, stop):
        connection.close()


def test_the_browsers_arguments_hold_no_token(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Whoever lists processes sees the arguments; the file they name is its owner's."""
    opened: list[str] = []
    content: list[str] = []

    def served(*_: Any) -> None:
        wait_until(lambda: bool(opened))
        path = Path(url2pathname(urlsplit(opened[0]).path))
        assert path.stat().st_mode & 0o777 == 0o600
        content.append(path.read_text("utf-8"))

    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(serving.webbrowser, "open", opened.append)
    monkeypatch.setattr(serving, "_run", served)
    announced: list[str] = []
    serving.serve(0, True, announced.append)
    token = urlsplit(announced[0]).path.strip("/")
    assert token not in opened[0]
    assert announced[0] in content[0]
    assert not list(tmp_path.iterdir())


def test_a_port_that_is_taken_is_said_in_one_line() -> None:
    with serving.listening(0) as taken:
        port = taken.getsockname()[1]
        done = command("desk", "--no-browser", "--port", str(port))
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.startswith(f"impact88 desk: --port: port {port} is not available")
    assert done.stderr.count("\n") == 1
    assert command("desk", "--port", "65536").returncode == 2


def test_without_the_extra_one_line_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(serving, "find_spec", lambda name: None)
    with pytest.raises(UserError, match=r"pip install 'impact88\[desk\]'") as caught:
        serving.serve(0, False, lambda address: pytest.fail("it must not start"))
    assert "Flask, waitress" in str(caught.value)


def test_a_scene_of_the_form_is_the_scene_of_its_texts() -> None:
    told = collision.answer(dict(sample(1)))
    assert Scene(told["oracle"]["scene"]) == sample(1)


def test_directions_are_said_as_people_say_them() -> None:
    """Against turning a vector of that course into the words by its components."""
    system = units.system_of("chapter")
    sae = system._replace(convention=units.Convention("sae", ""))
    compass = system._replace(convention=units.Convention("", "compass"))
    for course in range(-180, 181, 7):
        x, y = np.cos(np.radians(course)), np.sin(np.radians(course))
        words = formview.spoken_direction("HAF", float(course), system)
        assert ("left" in words) == (y > 0.01 and "of x" in words)
        if "of x" in words:
            mirror = formview.spoken_direction("HAF", float(course), sae)
            assert ("left" in mirror) == ("right" in words)
        heading = (90 - course) % 360
        point = formview.spoken_direction("HA", float(heading), compass)
        assert ("north" in point) == (y > np.sin(np.radians(22.5)))
        assert ("west" in point) == (x < -np.sin(np.radians(22.5)))
    assert formview.spoken_direction("HB", 180.0, system) == "against x"
    assert formview.spoken_direction("PDOFA", -30.0, system) == "11 o'clock"
    assert formview.spoken_direction("SA", -30.0, system) == ""


def test_as_many_draws_as_the_command_takes() -> None:
    parser = argparse.ArgumentParser()
    options.declare(parser, reconstruct_command.ARGUMENTS)
    assert parser.get_default("samples") == reconstruction.DRAWS


@pytest.mark.long
def test_a_reconstruction_begins_with_the_evidence_and_velocity_changes(client: Client) -> None:
    """What is asked first stands first: can it all be true, then ΔV and the force's direction."""
    values = {**reconstruction.known_of_sample(1)["values"], "UX": "-29 +- 1", "VAX": "-13 +- 1"}
    answer = client.post("reconstruct", {"values": values, "units": ""}).get_json()
    best = answer["solutions"][0]
    assert [row["name"] for row in best["first"]][:4] == ["DVA", "DVB", "PDOFA", "PDOFB"]
    verdict = answer["object"]["solutions"][0]["evidence"]["text"]
    assert ["EVIDENCE", verdict, False] in best["lines"]
    table = answer["tables"]
    assert 0 < table.index("the measurements agree") < table.index("What follows")
    values |= {"VAX": "-13 +- 0.01", "UX": "-10 +- 0.01"}
    worse = client.post("reconstruct", {"values": values, "units": ""}).get_json()
    verdict = worse["object"]["solutions"][0]["evidence"]["text"]
    assert ["EVIDENCE", verdict, True] in worse["solutions"][0]["lines"]
    assert '<dt class="problem">EVIDENCE' in worse["tables"]
    assert not any(verdict in line for line in worse["solutions"][0]["warnings"])
    assert any("are widened" in line for line in worse["solutions"][0]["warnings"])
    broken = {**values, "UX": "-29", "VAX": "-13", "E": "1.3"}
    broken = client.post("reconstruct", {"values": broken, "units": ""}).get_json()
    assert broken["tables"].index("IMPOSSIBLE") < broken["tables"].index("What follows")


def test_every_input_has_a_field_and_every_field_is_a_quantity() -> None:
    groups = {**app.GROUPS, **app.KNOWN_GROUPS, **app.MORE_GROUPS}
    fields = " ".join(groups.values()).split()
    unknown = [name for name in fields if name not in {**SCENE, **RESULTS, **CHAPTER}]
    assert not unknown, f"next step: a row for {unknown} in names.py"
    missing = {*SCENE} - {*" ".join(app.GROUPS.values()).split()}
    assert not missing, f"next step: {missing} in a part of GROUPS of interface/desk/app.py"
