"""Access control: which requests are answered, and the headers of every answer.

Other users of the computer, and other pages in the same browser, can reach the port too. A request
has to name this host exactly and, unless it only reads, to come from a page of this origin. Every
page's path begins with the random token: others are not found."""

from __future__ import annotations

from flask import Request

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


def is_foreign(request: Request, port: int) -> bool:
    """Return True if a request is not one of this origin.

    Parameters
    ----------
    request : flask.Request
        The request.
    port : int
        The port of this server.
    """
    own = f"http://127.0.0.1:{port}"
    origin = request.headers.get("Origin", own if request.method in ("GET", "HEAD") else "")
    return origin != own or f"http://{request.headers.get('Host')}" != own
