"""Access control: which requests are answered, and the headers of every answer.

Other users of the computer, and other pages in the same browser, can reach the port too. A request
has to name this host exactly, begin its path with the random token, and, unless it only reads,
come from a page of this origin."""

from __future__ import annotations

import hmac
from collections.abc import Mapping

MAX_BODY = 16_000_000  # bytes of a request: some dozens of scanned pages
_COMMON = (
    "default-src 'none'; img-src 'self' data:; base-uri 'none'; frame-ancestors 'none'; "
    "form-action 'self'; "
)
PAGE_POLICY = f"{_COMMON}script-src 'self'; style-src 'self'; connect-src 'self'"
"""Policy of a page: nothing from elsewhere runs in it."""
HEADERS = {
    "X-Content-Type-Options": "nosniff",
    # no-referrer would make browsers send "Origin: null" with a form
    "Referrer-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cache-Control": "no-store",
}
"""Other headers of every answer: nothing is kept."""
REPORT_POLICY = f"{_COMMON}style-src 'unsafe-inline'"
"""Policy of a report, whose one style sheet is in the page; it runs no scripts."""


def refusal(
    headers: Mapping[str, str], method: str, path: str, port: int, token: str
) -> int | None:
    """Return the status with which a request is refused, None if it is answered.

    Parameters
    ----------
    headers : mapping of str to str
        The request's headers.
    method, path : str
        Its first line.
    port : int
        The port of this server.
    token : str
        The first part of every path.
    """
    host = f"127.0.0.1:{port}"
    if headers.get("Host") != host:
        return 403
    first = path.lstrip("/").partition("/")[0]
    if not hmac.compare_digest(first.encode("utf-8", "replace"), token.encode()):
        return 404
    own = f"http://{host}"
    return None if headers.get("Origin", own if method in ("GET", "HEAD") else "") == own else 403
