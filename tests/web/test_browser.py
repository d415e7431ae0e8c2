"""The local web page in headless Chromium: by keyboard alone, at two widths."""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable, Iterator
from threading import Thread
from typing import Any

import pytest
from drawnscenes import SIDE

import impact88

pytest.importorskip("flask")
pytest.importorskip("waitress")
webdriver = pytest.importorskip("selenium.webdriver")
from impact88.web.server import listening_socket, make_server  # noqa: E402

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(not shutil.which("chromedriver"), reason="there is no chromedriver"),
]
TOKEN = "token-of-the-tests"
TAB = "\ue004"
ENTER = "\ue007"
OPTIONS = ("--headless=new", "--no-sandbox", "--disable-gpu")


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    """Serve on a free port."""
    with listening_socket() as listener:
        number = listener.getsockname()[1]
        server = make_server(listener, TOKEN)
        Thread(target=server.run, daemon=True).start()
        yield f"http://127.0.0.1:{number}/{TOKEN}/"
        server.close()


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Start a browser."""
    options = webdriver.ChromeOptions()
    for option in OPTIONS:
        options.add_argument(option)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    service = webdriver.ChromeService(shutil.which("chromedriver"))
    driver = webdriver.Chrome(options=options, service=service)
    yield driver
    driver.quit()


def set_width(browser: Any, width: int) -> None:
    """Set the width of the page."""
    size = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)


def wait_for(condition: Callable[[], Any], seconds: float = 20.0) -> Any:
    """Return the first true value of a condition."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        if value := condition():
            return value
        time.sleep(0.05)
    raise AssertionError("nothing happened")


def press(browser: Any, keys: str) -> None:
    """Press keys, whatever has the focus."""
    webdriver.ActionChains(browser).send_keys(keys).perform()


def focus(browser: Any, condition: str) -> None:
    """Press Tab until the element with the focus fulfills a condition in JavaScript."""
    for _ in range(80):
        press(browser, TAB)
        if browser.execute_script(f"const e = document.activeElement; return {condition}"):
            return
    raise AssertionError(f"no Tab leads to {condition}")


def html_of(browser: Any, place: str) -> str:
    """Return the content of an element."""
    return browser.execute_script(f"return document.getElementById('{place}').innerHTML")


@pytest.mark.parametrize("width", [390, 1400])
def test_a_collision_is_computed_by_keyboard_alone(browser: Any, address: str, width: int) -> None:
    set_width(browser, width)
    browser.get(address)
    focus(browser, "e.textContent == 'Collision'")
    press(browser, ENTER)
    wait_for(lambda: browser.current_url.endswith("/collision"))
    names = [
        name
        for name in browser.execute_script(
            "return [...document.querySelectorAll('#fields input:not([type])')].map(e => e.name)"
        )
        if name in SIDE
    ]
    for name in names:
        focus(browser, f"e.name == '{name}'")
        press(browser, SIDE[name])
    press(browser, ENTER)
    wait_for(lambda: "<svg" in html_of(browser, "answer"))
    assert "size of A's velocity change" in html_of(browser, "answer")
    assert browser.execute_script("return document.documentElement.scrollWidth") <= width


@pytest.mark.parametrize("width", [390, 1400])
def test_a_printout_is_verified_by_keyboard_alone(browser: Any, address: str, width: int) -> None:
    set_width(browser, width)
    browser.get(address)
    focus(browser, "e.id == 'text'")
    page = impact88.run(impact88.sample(1)).page.replace("-13.263", "-13.268")
    press(browser, page)
    focus(browser, "e.textContent == 'Verify'")
    press(browser, ENTER)
    wait_for(lambda: "<mark" in html_of(browser, "verdict"))
    assert browser.execute_script("return document.documentElement.scrollWidth") <= width


def test_another_kind_changes_the_fields_and_nothing_breaks_the_policy(
    browser: Any, address: str
) -> None:
    browser.get(f"{address}collision")
    focus(browser, "e.name == 'kind'")
    press(browser, "Rear")
    wait_for(lambda: 'value="rear-end" selected' in html_of(browser, "fields"))
    problems = [entry["message"] for entry in browser.get_log("browser")]
    assert [p for p in problems if "Content Security Policy" in p or "Uncaught" in p] == []
