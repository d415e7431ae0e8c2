"""A browser on the desk, without a window: the system's Chromium driven through Selenium."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

from installed import COMMAND

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
OPTIONS = (
    "--headless=new",
    "--no-sandbox",  # a container's root has none
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--window-size=1280,900",
)

Found = TypeVar("Found")


def missing() -> str:
    """Why there is no browser to test with; empty where there is one."""
    try:
        import selenium  # noqa: F401
    except ImportError:
        return "selenium is not installed"
    if not any(map(shutil.which, BROWSERS)):
        return "there is no Chromium"
    return "" if shutil.which("chromedriver") else "there is no chromedriver"


def until(look: Callable[[], Found], what: str = "", seconds: float = 15.0) -> Found:
    """What ``look`` returns once it is true; fails after some seconds."""
    ends = time.monotonic() + seconds
    while time.monotonic() < ends:
        found = look()
        if found:
            return found
        time.sleep(0.02)
    raise AssertionError(f"{what or 'it'} never came about: {look()!r}")


@contextmanager
def desk() -> Iterator[str]:
    """A desk of its own; gives its address."""
    process = subprocess.Popen(
        [COMMAND, "desk", "--no-browser"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    try:
        yield process.stdout.readline().strip()
    finally:
        process.terminate()
        process.communicate()


@contextmanager
def browser() -> Iterator[Any]:
    """A browser; files it saves lie in its ``downloads``."""
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service

    with tempfile.TemporaryDirectory() as profile, tempfile.TemporaryDirectory() as downloads:
        options = Options()
        for option in (*OPTIONS, f"--user-data-dir={profile}"):
            options.add_argument(option)
        options.binary_location = next(filter(None, map(shutil.which, BROWSERS)))
        options.add_experimental_option("prefs", {"download.default_directory": downloads})
        driver = webdriver.Chrome(options, Service(shutil.which("chromedriver")))
        try:
            yield Page(driver, Path(downloads))
        finally:
            driver.quit()


class Page:
    """The desk's page in a browser."""

    def __init__(self, driver: Any, downloads: Path) -> None:
        self.driver = driver
        self.downloads = downloads

    def open(self, address: str) -> None:
        """A page of its own: nothing of the last one is left."""
        self.driver.get("about:blank")
        self.driver.get(address)

    def run(self, script: str, *arguments: Any) -> Any:
        """The value of a script."""
        return self.driver.execute_script(script, *arguments)

    def value(self, expression: str) -> Any:
        """The value of an expression."""
        return self.run(f"return {expression}")

    def at(self, name: str) -> Any:
        """The element with an id."""
        return self.driver.find_element("id", name)

    def text(self, name: str) -> str:
        """All text in an element, shown or not."""
        text: str = self.run("return document.getElementById(arguments[0]).textContent", name)
        return text

    def texts(self, selector: str) -> list[str]:
        """The texts of elements, all of one moment."""
        script = "return [...document.querySelectorAll(arguments[0])].map((it) => it.textContent)"
        found: list[str] = self.run(script, selector)
        return found

    def count(self, selector: str) -> int:
        """How many elements there are."""
        return len(self.driver.find_elements("css selector", selector))

    def put(self, name: str, text: str) -> None:
        """Put a text into a field, as pasting does."""
        self.run(
            "const field = document.getElementById(arguments[0]); field.value = arguments[1];"
            "field.dispatchEvent(new Event('input', { bubbles: true }))",
            name,
            text,
        )

    def choose(self, name: str, value: str) -> None:
        """Choose from a list."""
        self.run(
            "const list = document.getElementById(arguments[0]); list.value = arguments[1];"
            "list.dispatchEvent(new Event('change', { bubbles: true }))",
            name,
            value,
        )

    def saved(self, name: str) -> bytes:
        """A file that the page has saved, once it is whole; it is taken away."""
        path = self.downloads / name
        until(lambda: path.exists() and path.stat().st_size, f"the file {name}")
        data = path.read_bytes()
        path.unlink()
        return data

    def complaints(self) -> list[str]:
        """What the browser has complained of since last asked: scripts' errors, what the page's own
        rules forbid, files that are not there. That the desk could not use some input is none."""
        log = self.driver.get_log("browser")
        found = [entry["message"] for entry in log if entry["level"] == "SEVERE"]
        return [message for message in found if "status of 400" not in message]
