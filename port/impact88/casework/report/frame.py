"""The frame of a page for the case file, and what identifies the work: versions and hashes.

A page is one HTML file without any other, laid out for Letter or A4 when a browser prints it. The
same input gives the same bytes: nothing on it comes from a clock.
"""

import os
import platform
import sys
from collections.abc import Sequence
from functools import lru_cache
from hashlib import sha256
from typing import Any

from ...errors import UserError, library, printable
from ...files import files_of
from ...mechanics import native
from ...version import full_version

PAPERS = {"letter": "8.5in 11in", "a4": "210mm 297mm"}
"""Paper -> its size in CSS."""


def render(
    template: str,
    *,
    title: str,
    case: str = "",
    paper: str = "letter",
    files: Sequence[tuple[str, bytes]] = (),
    **content: Any,
) -> str:
    """Return the page that ``template`` makes of ``content``, in the frame (frame.html). ``title``
    and ``case`` stand on every printed page; ``files``: names and bytes of what was read. Raises
    UserError where jinja2 is not installed."""
    jinja2 = library("jinja2", "report", "a report")
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader(__package__),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
        finalize=_escape_text,
    )
    title, case = printable(title), printable(case)
    running = f"Case {case}" if case else title
    running = running if len(running) <= MOST_RUNNING else running[: MOST_RUNNING - 1] + "…"
    page = environment.get_template(template).render(
        title=title,
        case=case,
        # between quotes in CSS, whatever it holds
        running="".join(c if c.isalnum() or c in " .,-/:" else f"\\{ord(c):06x}" for c in running),
        paper=PAPERS[paper],
        files=[(name, f"{len(data):,}", sha256(data).hexdigest()) for name, data in files],
        versions=versions(),
        **content,
    )
    return f"{page}\n"


MOST_RUNNING = 70  # characters at the foot of a page, beside the page's number


def _escape_text(value: Any) -> Any:
    """Return a user's text with unprintable characters escaped; markup as it is."""
    return printable(value, "\n\t") if type(value) is str else value


def check_page_name(path: str) -> None:
    """Raise UserError where the name of a page to be written promises another format."""
    ending = os.path.splitext(path)[1].lower()
    if ending not in ("", ".html", ".htm"):
        raise UserError(
            f"a report is an HTML page; expected a name that ends in .html (a browser prints it, "
            f"also to PDF), not in {ending}",
            path,
        )


@lru_cache(maxsize=1)
def hashes() -> dict[str, str]:
    """SHA-256 of the restored listing that is packaged, and over all packaged captures of the real
    ROM: of the lines ``hash  path``, sorted by path, as `sha256sum` prints them."""
    from importlib import resources

    listing = resources.files("impact88.legacy").joinpath("impact.bas").read_bytes()
    captures = "".join(f"{digest}  {path}\n" for path, digest in capture_hashes())
    return {
        "listing": sha256(listing).hexdigest(),
        "captures": sha256(captures.encode()).hexdigest(),
    }


def capture_hashes() -> list[tuple[str, str]]:
    """Path in golden/ and SHA-256 of each packaged capture, sorted by path."""
    from importlib import resources

    golden = resources.files("impact88.golden")
    files = [(name, golden.joinpath(name)) for name in ("scenes.jsonl.gz", "fuzz.jsonl.gz")]
    for folder in ("arithmetic", "programs"):
        files += [(f"{folder}/{file.name}", file) for file in files_of(golden, folder)]
    return sorted((path, sha256(file.read_bytes()).hexdigest()) for path, file in files)


def versions() -> dict[str, str]:
    """Versions of this package, of Python and numpy, and the machine."""
    return {
        "impact88": full_version(),
        "python": f"{platform.python_implementation()} {platform.python_version()}",
        # importlib.metadata would import email and socket
        "numpy": getattr(sys.modules.get("numpy"), "__version__", "not installed"),
        "solve": f"compiled, {native.accelerated}" if native.accelerated else "numpy",
        "machine": f"{platform.system()} {platform.release()} {platform.machine()}",
    }
