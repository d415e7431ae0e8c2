"""The desk in a browser: what an engineer sees, and what a foreign page does not get."""

from __future__ import annotations

import re
import threading
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from itertools import pairwise
from pathlib import Path
from typing import Any

import desk_browser
import pytest
from captures import ROOT
from desk_browser import Page, until
from installed import impact88 as command

from impact88.collision.casescene import sample
from impact88.interface.desk import collision as desk_collision
from impact88.program.copies import load_machine, run_machine
from impact88.program.run import run

pytestmark = [
    pytest.mark.long,
    pytest.mark.browser,
    pytest.mark.skipif(bool(desk_browser.missing()), reason=desk_browser.missing()),
]
LEGACY = ROOT / "legacy"
PUBLISHED = ("run1-as-printed.txt", "run2-as-printed.txt", "table3-as-printed.txt")


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    pytest.importorskip("flask", reason="the desk's extra is not installed")
    with desk_browser.desk() as served:
        yield served


@pytest.fixture(scope="module")
def one_browser() -> Iterator[Page]:
    with desk_browser.browser() as started:
        yield started


@pytest.fixture
def page(one_browser: Page, address: str) -> Iterator[Page]:
    one_browser.open(address)
    one_browser.complaints()
    yield one_browser
    assert one_browser.complaints() == []


@pytest.fixture
def collision(page: Page) -> Page:
    page.run("location.hash = '#collision'")
    page.choose("collision-begin", "solve/1")
    until(lambda: "VAX= -13.263" in page.text("collision-screen"), "the first answer")
    return page


# --- collision ---------------------------------------------------------------------------------


@pytest.mark.parametrize("number", [1, 2, 3])
def test_a_published_run_shows_its_printout_and_the_figure(page: Page, number: int) -> None:
    page.run("location.hash = '#collision'")
    page.choose("collision-begin", f"solve/{number}")
    printed = run(sample(number)).page
    until(lambda: page.text("collision-screen") == printed, "the printout")
    results = re.sub(r"[\s*]", "", printed[printed.index("MA=") :])
    published = (LEGACY / PUBLISHED[number - 1]).read_text(encoding="utf-8")
    assert results == re.sub(r"[\s*]", "", published[published.index("MA=") :])
    picture = page.at("collision-figure")
    until(lambda: page.run("return arguments[0].naturalWidth", picture) > 100, "the figure")
    assert "Vehicle A: speed" in picture.get_attribute("alt")


def test_the_answer_stands_first_in_the_units_chosen(collision: Page) -> None:
    collision.run(
        "arguments[0].value = 'us'; arguments[0].dispatchEvent(new Event('change'))",
        collision.at("collision-units"),
    )
    until(lambda: collision.at("collision-asks").is_displayed(), "the question")
    collision.at("collision-reread").click()
    told = desk_collision.answer(dict(sample(1)), "us")["answer"]
    wanted = {one["name"]: one["text"] for row in told for one in row["values"]}
    look = (
        "return Object.fromEntries([...document.querySelectorAll('#collision-first [data-name]')]"
        ".map((one) => [one.dataset.name, one.textContent]))"
    )
    until(lambda: collision.run(look) == wanted, "the answer")
    first = collision.driver.find_element("css selector", "#collision-first tbody tr")
    assert first.is_displayed()
    assert first.text == f"Velocity change ΔV {wanted['DVA']} {wanted['DVB']} mph"


def test_the_screen_holds_what_the_apples_memory_holds(collision: Page) -> None:
    machine = load_machine(sample(1))
    run_machine(machine)
    rows = [bytes(b & 0x7F for b in row).decode() for row in machine.screen_rows()]
    assert collision.text("collision-apple") == "".join(row + "\n" for row in rows)
    assert not collision.at("collision-apple").is_displayed()
    collision.at("collision-tab-printout").click()
    assert collision.at("collision-apple").is_displayed()
    assert not collision.at("collision-first").is_displayed()


def test_tables_have_names_and_headings_their_order(collision: Page) -> None:
    look = """
        return [...document.querySelectorAll('table')].filter((table) => table.rows.length)
          .flatMap((table) => [table.caption?.textContent, ...[...table.querySelectorAll('th')]
          .map((head) => head.textContent.trim())]).filter((text) => !text).length"""
    assert collision.run(look) == 0
    assert collision.count("table caption") > 1
    levels = collision.run(
        "return [...document.querySelectorAll('h1, h2, h3')].filter((one) => one.offsetParent)"
        ".map((one) => Number(one.tagName[1]))"
    )
    assert levels[0] == 1
    assert all(after <= before + 1 for before, after in pairwise(levels))


def test_typing_is_answered_and_a_bad_number_is_told_at_its_field(collision: Page) -> None:
    field = collision.at("collision-MU")
    before = collision.text("collision-screen")
    field.send_keys("x")
    problem = collision.at("collision-MU-problem")
    until(lambda: "x is not a unit" in problem.text, "the message")
    assert field.get_attribute("aria-invalid") == "true"
    assert "collision-MU-problem" in field.get_attribute("aria-describedby")
    assert field.get_attribute("value") == "0.911x"
    assert collision.at("collision-UX").get_attribute("value") == "-29.04"
    assert "MU" in collision.text("collision-waiting")
    assert collision.text("collision-screen") == before
    field.send_keys("\b")
    until(lambda: not problem.is_displayed(), "the message's end")
    assert field.get_attribute("aria-invalid") is None
    field.send_keys("\b\b\b5")
    again = run(sample(1).replaced({"MU": "0.5"})).page
    until(lambda: collision.text("collision-screen") == again, "the new answer")


def test_a_range_shows_bounds_around_the_result(collision: Page) -> None:
    assert not collision.at("collision-bounds").is_displayed()
    collision.put("collision-MU", "0.7 .. 0.9")
    rows = until(
        lambda: collision.run(
            "return [...document.querySelectorAll('#collision-bounds-table tbody tr')]"
            ".map((row) => [...row.cells].map((cell) => cell.textContent))"
        ),
        "the bounds",
    )
    bounds = {row[0]: list(map(float, row[2:5])) for row in rows}
    for lower, nominal, upper in bounds.values():
        assert lower <= nominal <= upper
    assert bounds["LOSS"][0] < bounds["LOSS"][2]
    collision.put("collision-MU", ".911")
    until(lambda: not collision.at("collision-bounds").is_displayed(), "the bounds' end")


def test_warnings_stand_in_words(collision: Page) -> None:
    assert not collision.at("collision-warnings").is_displayed()
    collision.put("collision-E", "1.5")
    until(lambda: "E" in collision.at("collision-warnings").text, "the warning")
    told = command("solve", "--help").stdout + collision.at("collision-warnings").text
    assert "outside 0 ... 1" in told


def test_the_scene_saved_is_the_commands_own_and_opens_again(
    collision: Page, tmp_path: Path
) -> None:
    collision.at("collision-save").click()
    saved = collision.saved("scene.toml")
    assert saved == command("scene", "--sample", "1").stdout.encode()
    other = tmp_path / "other.toml"
    other.write_bytes(saved.replace(b"UX = -29.04", b"UX = -31.5"))
    collision.at("collision-file").send_keys(str(other))
    until(lambda: "UX= -31.5 " in collision.text("collision-screen"), "the other scene")
    other.write_bytes(b"UX = ")
    collision.at("collision-file").send_keys(str(other))
    until(lambda: "line 1" in collision.at("collision-trouble").text, "the trouble")
    assert collision.at("collision-UX").get_attribute("value") == "-31.5"


def test_the_form_shows_every_entry_of_its_file(collision: Page, tmp_path: Path) -> None:
    """What another collision is typed over does not carry a case that stands nowhere."""
    path = tmp_path / "old.toml"
    about = 'case = "24-117"\nexaminer = "N. N."\ndate = "2026-01-02"\nLA = 16\nBA = 6\n'
    path.write_text(sample(1).to_toml() + about, encoding="utf-8")
    collision.at("collision-file").send_keys(str(path))
    until(lambda: collision.at("collision-case").get_attribute("value") == "24-117", "the case")
    assert collision.at("collision-examiner").get_attribute("value") == "N. N."
    extra = collision.texts("#collision-extra li code")
    assert {text.strip() for text in extra} == {'LA = "16"', 'BA = "6"'}
    for _ in range(2):
        collision.run("document.querySelector('#collision-extra li button').click()")
    collision.at("collision-case").clear()
    collision.at("collision-save").click()
    saved = collision.saved("scene.toml").decode()
    assert "24-117" not in saved
    assert "LA" not in saved
    assert 'date = "2026-01-02"' in saved


def test_other_units_convert_the_form_or_read_it_anew(collision: Page) -> None:
    masses = []
    for button in ("stay", "convert", "reread"):
        collision.choose("collision-units", {"reread": "us"}.get(button, "metric"))
        until(lambda: collision.at("collision-asks").is_displayed(), "the question")
        collision.at(f"collision-{button}").click()
        until(lambda: not collision.at("collision-asks").is_displayed(), "the answer")
        masses.append(float(collision.at("collision-MA").get_attribute("value")))
    assert masses[0] == 143.5
    assert masses[1] == pytest.approx(143.5 * 14.593903)
    assert masses[2] == masses[1]


def test_on_a_narrow_page_the_answer_stands_before_the_forms_second_half(collision: Page) -> None:
    size = collision.driver.get_window_size()
    collision.driver.set_window_size(360, 900)
    try:
        tops = [
            collision.at(name).location["y"]
            for name in ("collision-MB", "collision-first", "collision-UX")
        ]
    finally:
        collision.driver.set_window_size(size["width"], size["height"])
    assert tops == sorted(tops)


# --- paper -------------------------------------------------------------------------------------


def words(page: Page) -> list[str]:
    """The verdicts shown for the paper that lies open."""
    return page.texts("#paper-verdict .word")


@pytest.mark.parametrize("name", PUBLISHED)
def test_a_published_run_pasted_is_identical_and_one_digit_changed_is_not(
    page: Page, name: str
) -> None:
    text = (LEGACY / name).read_text(encoding="utf-8")
    page.put("paper-text", text)
    until(lambda: words(page) == ["IDENTICAL"], f"the verdict on {name}")
    assert page.count("#paper-marks mark.contradicted") == 0
    printed = re.search(r"VAY= ([-.\d]+)", text)
    assert printed
    at = printed.end() - 1
    digit = str((int(text[at]) + 4) % 10)
    page.put("paper-text", text[:at] + digit + text[at + 1 :])
    until(lambda: words(page) == ["DIFFERS"], f"the verdict on {name}, changed")
    assert page.texts("#paper-marks mark.contradicted") == [printed[1][:-1] + digit]
    place = page.driver.find_element("css selector", "#paper-printouts .part .to-place")
    line = text[:at].count("\n") + 1
    assert f"line {line}, column" in place.text
    place.click()
    start, stop = page.run(
        "const text = document.activeElement; return [text.selectionStart, text.selectionEnd]"
    )
    assert start <= at < stop


def test_a_page_read_by_a_scanner_has_its_doubts_marked(page: Page) -> None:
    """A page of 36 numbers as an OCR engine read it: three of them not as they were printed."""
    page.put("paper-text", (ROOT / "golden/printouts/ocr-page.txt").read_text(encoding="utf-8"))
    until(lambda: words(page) == ["IDENTICAL AS FAR AS READ"], "the verdict")
    assert "e491" in page.texts("#paper-marks mark.doubtful")
    assert page.count("#paper-marks mark.doubtful b") > 0
    sentences = page.texts("#paper-printouts .part .to-place")
    assert any("VBY" in sentence and "(-8.491)" in sentence for sentence in sentences)


def test_files_dropped_together_are_told_apart_and_hostile_text_stays_text(
    page: Page, tmp_path: Path
) -> None:
    good = tmp_path / "good.txt"
    good.write_bytes((LEGACY / PUBLISHED[0]).read_bytes())
    hostile = tmp_path / "<img src=x onerror=alert(1)>.txt"
    text = (LEGACY / PUBLISHED[2]).read_text(encoding="utf-8").replace("25.994", "26.994")
    # a car's picture is two units of text to the browser and one character to the program
    hostile.write_text(f"<script>document.title = 'taken'</script>🚗\n{text}", encoding="utf-8")
    nothing = tmp_path / "nothing.txt"
    nothing.write_text("<b>no printout</b>", encoding="utf-8")
    page.at("paper-files").send_keys("\n".join(map(str, (good, hostile, nothing))))
    until(lambda: "NOT JUDGED" in page.text("paper-summary"), "the last verdict")
    assert page.count("#paper-list li") == 3
    shown = page.text("paper-list")
    assert "<img src=x onerror=alert(1)>.txt" in shown
    assert re.search(r"good\.txt IDENTICAL(?! AS)", shown)
    assert page.count("#paper img") == page.count("#paper script") == page.count("#paper b b") == 0
    for button in page.driver.find_elements("css selector", ".paper-name"):
        button.click()
        if "<img" in button.text:
            assert page.texts("#paper-marks mark.contradicted") == ["26.994"]
    assert page.driver.title == "Paper · impact88 desk"
    assert page.text("paper-verdict").startswith("NOT JUDGED")


def test_the_report_is_the_commands_own(page: Page, tmp_path: Path) -> None:
    paths = [tmp_path / name for name in ("one.txt", "two.txt")]
    text = (LEGACY / PUBLISHED[0]).read_text(encoding="utf-8")
    paths[0].write_text(text, encoding="utf-8")
    paths[1].write_text(text.replace("3.449", "3.549"), encoding="utf-8")
    names = [path.name for path in paths]
    options = ("--report", "theirs.html", "--date", "1988-05-17")
    assert command("verify", "--brief", *names, *options, cwd=tmp_path).returncode == 1
    page.at("paper-files").send_keys("\n".join(map(str, paths)))
    until(lambda: "1 DIFFERS" in page.text("paper-summary"), "the verdicts")
    page.driver.find_element("css selector", ".report summary").click()
    page.put("paper-date", "1988-05-17")
    page.at("paper-report").click()
    assert page.saved("report.html") == (tmp_path / "theirs.html").read_bytes()


def test_a_scan_lies_beside_the_text(page: Page, tmp_path: Path) -> None:
    scan = tmp_path / "scan.png"
    pixel = "89504e470d0a1a0a0000000d4948445200000001000000010806000000 1f15c489".replace(" ", "")
    rest = "0000000d49444154789c6360606060000000050001a5f645400000000049454e44ae426082"
    scan.write_bytes(bytes.fromhex(pixel + rest))
    page.at("paper-scan-file").send_keys(str(scan))
    picture = until(
        lambda: page.driver.find_elements("css selector", "#paper-scan-frame img"), "the scan"
    )[0]
    until(lambda: page.run("return arguments[0].naturalWidth", picture) == 1, "its pixel")
    page.at("paper-scan-away").click()
    assert not page.at("paper-scan").is_displayed()


def test_the_cells_of_a_scan_are_outlined_and_what_is_corrected_is_tried_on_the_picture(
    page: Page,
) -> None:
    pytest.importorskip("PIL", reason="the scan extra is not installed")
    page.at("paper-files").send_keys(str(ROOT / "golden" / "scans" / "clean-002.png"))
    until(lambda: "1 DIFFERS" in page.text("paper-summary"), "the verdict", 60)
    outlined = "return document.querySelectorAll('#paper-scan-frame .cell' + arguments[0]).length"
    until(lambda: page.run(outlined, ".differs") == 1, "the cell that differs")
    assert page.run(outlined, ".holds") > 150
    assert page.run(outlined, ".differs path") == 1
    page.run("document.querySelector('.cell.differs').dispatchEvent(new MouseEvent('click'))")
    chosen = page.run(
        "const t = document.getElementById('paper-text');"
        "return [t.value, t.selectionStart, t.selectionEnd]"
    )
    text, start, end = chosen
    assert (end - start, text[start]) == (1, "9")
    page.run(
        "const t = document.getElementById('paper-text');"
        "t.setRangeText('2'); t.dispatchEvent(new Event('input'))"
    )
    until(lambda: page.run("return document.getElementById('paper-text').value") == text, "it", 60)
    assert "1 DIFFERS" in page.text("paper-summary")


# --- reconstruction -----------------------------------------------------------------------------


def test_what_is_unticked_is_solved_for_with_its_uncertainty(page: Page) -> None:
    page.run("location.hash = '#reconstruction'")
    page.choose("reconstruction-begin", "reconstruct/3")
    solved = page.at("reconstruction-UX-answer")
    until(lambda: solved.text == "solved: -36.667", "the initial velocity")
    tick = page.at("reconstruction-E-known")
    assert tick.is_selected()
    tick.click()
    until(lambda: "is known; give WA" in page.text("reconstruction-waiting"), "the reason")
    page.put("reconstruction-UY", "0")
    assert page.at("reconstruction-UY-known").is_selected()
    until(lambda: page.text("reconstruction-E-answer") == "solved: 0.25", "the coefficient")
    page.put("reconstruction-VBY-tolerance", "2")
    until(lambda: "sd" in page.text("reconstruction-VY-answer"), "the uncertainty")
    # by the page itself: the answer may be drawn anew between look and click
    page.run("document.querySelector('#reconstruction-answer .over button').click()")
    until(lambda: "VAX= -7.46 " in page.text("collision-screen"), "the collision")


# --- the page as a whole -----------------------------------------------------------------------


def test_every_field_has_a_label_and_every_view_is_reached_by_keys(page: Page) -> None:
    unlabelled = page.run(
        "return [...document.querySelectorAll('input, textarea, select')]"
        ".filter((field) => !field.labels.length && !field.getAttribute('aria-label'))"
        ".map((field) => field.id)"
    )
    assert unlabelled == []
    page.run("document.querySelector('nav a[href=\"#collision\"]').focus()")
    page.driver.switch_to.active_element.send_keys("\ue007")
    until(lambda: page.at("collision").is_displayed(), "the view")
    assert page.driver.title == "Collision · impact88 desk"
    assert page.run("return document.activeElement.id") == "main"


@pytest.mark.parametrize("width", [320, 390, 1280])
def test_nothing_is_wider_than_the_window(collision: Page, width: int) -> None:
    driver = collision.driver
    size = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 500}
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    try:
        for view in ("paper", "collision", "reconstruction"):
            collision.run("location.hash = arguments[0]", f"#{view}")
            until(lambda view=view: collision.at(view).is_displayed(), view)
            assert collision.run("return document.documentElement.scrollWidth") <= width
    finally:
        driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, format: str, *arguments: Any) -> None:
        pass


def test_a_page_from_elsewhere_gets_nothing(
    one_browser: Page, address: str, tmp_path: Path
) -> None:
    (tmp_path / "index.html").write_text("<!DOCTYPE html><title>elsewhere</title>")
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(tmp_path)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        one_browser.open(f"http://127.0.0.1:{server.server_port}/")
        ask = """
            const [address, options, done] = [arguments[0], arguments[1], arguments[2]];
            fetch(address, options).then(
              (answer) => answer.text().then((text) => done([answer.status, text])),
              (error) => done(['refused', String(error)]));
        """
        for path, options in (
            ("", {}),
            ("", {"mode": "no-cors"}),
            ("static/desk.js", {}),
            ("collision", {"method": "POST", "body": '{"values": {}}'}),
            ("collision", {"method": "POST", "body": "{}", "mode": "no-cors"}),
        ):
            told = one_browser.driver.execute_async_script(ask, address + path, options)
            assert told[0] == "refused" or told == [0, ""], (path, options, told)
        framed = one_browser.driver.execute_async_script(
            "const frame = document.createElement('iframe'); frame.src = arguments[0];"
            "frame.onload = () => { let text = ''; try { text = frame.contentDocument.body"
            ".textContent } catch { text = '' } arguments[1](text) }; document.body.append(frame)",
            address,
        )
        assert framed == ""
    finally:
        server.shutdown()
        server.server_close()
        one_browser.open("about:blank")
        one_browser.complaints()


def test_a_kind_of_collision_says_what_is_to_be_filled_in(page: Page) -> None:
    page.run("location.hash = '#reconstruction'")
    page.choose("reconstruction-begin", "template/rear-end")
    until(lambda: page.text("reconstruction-waiting") == "Still to fill in: MA MB E SA.", "it")
    assert page.at("reconstruction-SA").is_displayed()
    assert "E is .1 to .4" in page.text("reconstruction-hint")
    for name, text in {"MA": "3000", "MB": "2500", "SA": "30"}.items():
        page.put(f"reconstruction-{name}", text)
    until(lambda: "give E, SAF or SBF" in page.text("reconstruction-answer"), "what would do")
    page.put("reconstruction-E", ".2")
    until(lambda: "16.4 mph" in page.text("reconstruction-answer"), "the answer")
    assert not page.at("reconstruction-waiting").is_displayed()
    page.at("reconstruction-report").click()
    assert b"known.toml" in page.saved("case.html")
    until(lambda: "names the file known.toml" in page.text("reconstruction-hint"), "the offer")
