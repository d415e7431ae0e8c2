"""Access control of the desk, and the headers of every answer.

Other pages in the same browser, and other users of the machine, can reach it too. Against them: a
random token that begins every path, the exact Host (a foreign name pointed at 127.0.0.1 fails), the
Origin and the browser's own word on where a request comes from (a foreign page fails even with the
token), and no header that would let one read an answer. A refusal says nothing.
"""

import hmac
from typing import Protocol

LARGEST_BODY = 16_000_000
"""Bytes of the largest request that is taken: a box of printouts for one report."""
TOO_LONG = f"more than {LARGEST_BODY:,} bytes, the limit here"
"""The answer to a request with a larger body."""
REFUSALS = frozenset((403, 404, 405, 413))
"""Statuses after which a connection is closed: who sends one such request may send many."""
MAX_QUESTIONS = 56
"""Questions that may wait for a process at a time; each keeps a thread of the server."""

HEADERS = {
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
        "connect-src 'self'; frame-src blob:; object-src 'none'; base-uri 'none'; "
        "form-action 'none'; frame-ancestors 'none'"
    ),
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "X-Frame-Options": "DENY",
    "Cache-Control": "no-store",
}
"""Sent with every answer: nothing from elsewhere runs in the page, and nothing of it is kept."""


class Headers(Protocol):
    """A request's headers, looked up without regard to case."""

    def get(self, name: str, default: str, /) -> str: ...


def refusal(headers: Headers, method: str, path: str, *, port: int, token: str) -> int | None:
    """The HTTP status a request is refused with; None when it may be answered."""
    hosts = {f"127.0.0.1:{port}", f"localhost:{port}"}
    if headers.get("Host", "") not in hosts:
        return 403
    first = path.lstrip("/").partition("/")[0]
    if not hmac.compare_digest(first.encode(), token.encode()):
        return 404
    origin = headers.get("Origin", "")
    if not origin:
        # browsers name the origin of everything but plain reading
        if method not in ("GET", "HEAD"):
            return 403
    elif origin not in {f"http://{host}" for host in hosts}:
        return 403
    # "none": typed in, or opened by another program
    if headers.get("Sec-Fetch-Site", "none") in ("same-origin", "none"):
        return None
    # the file that leads the browser here (`serving.leading_file`) is another site; a page that
    # a whole tab shows can be read by nobody else
    opens = path == f"/{token}/" and headers.get("Sec-Fetch-Mode", "") == "navigate"
    if method == "GET" and opens and headers.get("Sec-Fetch-Dest", "") == "document":
        return None
    return 403
