"""The local web page: who is answered, and what the forms give."""

from __future__ import annotations

import http.client
import io
import re
import socket
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from html import unescape
from threading import Thread
from typing import Any

import pytest
from drawnscenes import SIDE, case_of

import impact88
from impact88.cases import TEMPLATES, Case, template
from impact88.report.answers import ask

pytest.importorskip("flask")
pytest.importorskip("waitress")
from impact88.web import guard, questions
from impact88.web.app import application
from impact88.web.server import listening_socket, make_server

TOKEN = "token-of-the-tests"
ORIGIN = "http://127.0.0.1:1234"
HOSTILE = (
    {"MA": "1e999999999"},
    {"MA": "9" * 100_000},
    {"UX": "\x00\x1b[2J"},
    {"more": "= 3"},
    {"more": "nonsense"},
    {"more": "XX = 3\nMA = [1, 2]"},
    {"kind": "../../etc/passwd", "units": "furlongs"},
    {"axes": "sae" * 1000},
    {"headings": "compass", "TA": "nan"},
    {"M": "5"},
    {"MU": "999 %"},
    {"E": "0.3 .. 0.1 .. 0.2"},
    {"SAF": "skid -3 ft at 0.7"},
    {"\ud800": "x", "correlations": "UX,VX 7; ;;"},
)


class Client:
    """A browser on the page itself."""

    def __init__(self) -> None:
        self._client = application(1234, TOKEN).test_client()

    def get(self, path: str) -> Any:
        """Return a page."""
        return self._client.get(f"/{TOKEN}/{path}", base_url=ORIGIN)

    def post(self, path: str, *, scripts: bool = True, **form: object) -> Any:
        """Return the answer to a form: with scripts, the part of the page that htmx gets."""
        headers = {"Origin": ORIGIN} | ({"HX-Request": "true"} if scripts else {})
        return self._client.post(f"/{TOKEN}/{path}", base_url=ORIGIN, data=form, headers=headers)


@pytest.fixture(scope="module")
def client() -> Client:
    """Return a client."""
    return Client()


@pytest.fixture(scope="module")
def port() -> Iterator[int]:
    """Serve on a free port."""
    with listening_socket() as listener:
        number = listener.getsockname()[1]
        server = make_server(listener, TOKEN)
        Thread(target=server.run, daemon=True).start()
        yield number
        server.close()


def status(port: int, method: str, path: str, **headers: str) -> int:
    """Return the status of one request to the server."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    connection.request(method, path, headers={k.replace("_", "-"): v for k, v in headers.items()})
    answer = connection.getresponse().status
    connection.close()
    return answer


def test_a_request_without_the_token_is_not_found(port: int) -> None:
    assert status(port, "GET", f"/{TOKEN}/") == 200
    for path in ("/", "/x/", f"/{TOKEN[:-1]}/", f"/{TOKEN}x/", "/static/htmx.min.js"):
        assert status(port, "GET", path) == 404


def test_a_foreign_host_or_origin_is_refused(port: int) -> None:
    path, own = f"/{TOKEN}/", f"http://127.0.0.1:{port}"
    assert status(port, "GET", path, Origin=own) == 200
    for host in (
        "example.com",
        f"localhost:{port}",
        f"example.com:{port}",
        "127.0.0.1",
        f"127.0.0.1:{port + 1}",
    ):
        assert status(port, "GET", path, Host=host) == 403
    for origin in ("http://example.com", "null", f"https://127.0.0.1:{port}", own + "0"):
        assert status(port, "GET", path, Origin=origin) == 403
        assert status(port, "POST", path + "verify", Origin=origin) == 403


def test_a_post_without_an_origin_is_refused(port: int) -> None:
    path = f"/{TOKEN}/verify"
    assert status(port, "POST", path) == 403
    assert status(port, "POST", path, Origin=f"http://127.0.0.1:{port}") == 422


def test_a_large_body_is_refused_at_once(port: int) -> None:
    """The answer comes before the body is sent."""
    head = f"POST /{TOKEN}/verify HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: {ORIGIN}\r\n"
    started = time.monotonic()
    with socket.create_connection(("127.0.0.1", port), timeout=10) as connection:
        connection.sendall(f"{head}Content-Length: 50000000\r\n\r\n".encode())
        assert b" 413 " in connection.recv(100)
    assert time.monotonic() - started < 1


def test_many_connections_are_answered(port: int) -> None:
    def ask_often(_: int) -> int:
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=30)
        count = 0
        for _ in range(5):
            connection.request("GET", f"/{TOKEN}/static/web.css")
            count += len(connection.getresponse().read()) > 100
        return count

    with ThreadPoolExecutor(60) as pool:
        assert sum(pool.map(ask_often, range(60))) == 300


def test_every_answer_has_the_policy(client: Client) -> None:
    for path in ("", "collision", "1988", "none", "static/htmx.min.js"):
        headers = client.get(path).headers
        assert headers["Content-Security-Policy"] == guard.PAGE_POLICY
        assert headers["Referrer-Policy"] == "same-origin"
        assert headers["Cache-Control"] == "no-store"
    assert "unsafe" not in guard.PAGE_POLICY


def test_pages_hold_no_scripts_or_styles(client: Client) -> None:
    for path in ("", "collision", "1988"):
        page = client.get(path).text
        assert re.findall(r"<script[^>]*>(.*?)</script>", page) == [""]
        assert not re.search(r"\sstyle=|<style|\son\w+=", page)


def test_numbers_are_the_answers_own_texts(client: Client) -> None:
    answer = ask(case_of())
    page = client.post("answer", **SIDE).text
    rows = re.findall(r'<tr><td class="l"><b>(\w+)</b></td><td class="n">([^<]*)</td>', page)
    assert rows == [(number.name, number.text) for number in answer.found.values()]
    assert "<svg " in page


def test_a_browser_without_scripts_gets_whole_pages(client: Client) -> None:
    page = client.post("answer", scripts=False, **SIDE).text
    assert page.startswith("<!doctype html>")
    assert "size of A&#39;s velocity change" in page


def test_a_file_is_opened_and_saved(client: Client) -> None:
    case = case_of("sae", title="Saved", MA_source="registration", LA="5", BA="2")
    file = (io.BytesIO(case.toml().encode()), "crash.toml")
    page = client.post("fields", file=file).text
    assert '<option value="sae" selected>' in page
    form = dict(re.findall(r'<input name="(\w+)" value="([^"]*)"', page))
    form |= dict(
        re.findall(r'<option value="(?!planar)(\w+)" selected', page) and [("axes", "sae")]
    )
    entries = re.search(r"<textarea[^>]*>(.*?)</textarea>", page, re.DOTALL)[1]
    file_answer = client.post("scene", **form | {"units": "metric", "more": unescape(entries)})
    assert "attachment" in file_answer.headers["Content-Disposition"]
    assert Case.loads(file_answer.text).written == {"M": "6"} | case.written


@pytest.mark.parametrize("kind", TEMPLATES)
def test_a_template_is_opened_as_its_kind(client: Client, kind: str) -> None:
    file = (io.BytesIO(template(kind, "metric").encode()), "crash.toml")
    assert (
        f'<input type="hidden" name="was" value="{kind}">' in client.post("fields", file=file).text
    )


def test_another_kind_keeps_what_was_typed(client: Client) -> None:
    form = {"was": "planar", "kind": "rear-end", "units": "metric", "MA": "1400", "M": "6"}
    page = client.post("fields", **form, EM="1", DA="2").text
    values = dict(re.findall(r'<input name="(\w+)" value="([^"]*)"', page))
    assert (values["MA"], values["M"], values["HA"]) == ("1400", "4", "0")
    assert "DA = 2" in page  # it has no field here
    assert "km/h" in page


def test_reports_have_a_policy_of_their_own(client: Client) -> None:
    page = impact88.run(impact88.sample(1)).page
    answers = (
        client.post("report", **SIDE, title="Case A"),
        client.post("verification", text=page, examiner="J. Doe"),
    )
    for answer in answers:
        assert answer.status_code == 200
        assert answer.headers["Content-Security-Policy"] == guard.REPORT_POLICY
        assert "script-src" not in guard.REPORT_POLICY
    assert "Case A" in answers[0].text
    assert "IDENTICAL" in answers[1].text


def test_a_printout_is_verified(client: Client) -> None:
    page = impact88.run(impact88.sample(1)).page.replace("-13.263", "-13.268")
    text = client.post("verify", text=page).text
    file = client.post("verify", file=(io.BytesIO(page.encode()), "paper.txt")).text
    for answer in (text, file):
        assert re.search(r'<mark class="differs"[^>]*>-13.268</mark>', answer)
    assert "paper.txt" in file


def test_the_1988_page_is_the_programs(client: Client) -> None:
    scene = impact88.sample(1)
    form = client.get("1988").text
    inputs = dict(re.findall(r'<input name="(\w+)" value="([^"]*)"', form))
    answer = client.post("printed", **inputs).text
    page = re.search(r"<pre[^>]*>(.*?)</pre>", answer, re.DOTALL)[1]
    assert page == impact88.run(scene).page


@pytest.mark.parametrize("number", range(len(HOSTILE)))
def test_hostile_forms_are_answered_in_one_line(client: Client, number: int) -> None:
    form = {name.encode("utf-8", "replace").decode(): t for name, t in HOSTILE[number].items()}
    for path in ("answer", "scene", "fields", "printed", "report"):
        answer = client.post(path, **form)
        assert answer.status_code in (200, 422), answer.text
        assert "Traceback" not in answer.text


def test_a_file_that_is_none_is_named(client: Client) -> None:
    answer = client.post("fields", file=(io.BytesIO(b"\x89PNG\r\n\x1a\n"), "<b>.toml"))
    assert answer.status_code == 422
    assert "&lt;b&gt;.toml" in answer.text
    assert client.post("verify").status_code == 422


def test_a_question_has_a_time_limit() -> None:
    assert questions.answer_in_time(lambda: 3, seconds=5) == 3
    with pytest.raises(impact88.UserError, match=r"longer than 0\.05 s"):
        questions.answer_in_time(lambda: time.sleep(0.3), seconds=0.05)
    with pytest.raises(ZeroDivisionError):
        questions.answer_in_time(lambda: 1 // 0)
