"""The socket, the address with its token, and how the desk starts and ends."""

import logging
import mimetypes
import os
import secrets
import socket
import sys
import tempfile
import threading
import webbrowser
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from ...errors import UserError
from .guard import LARGEST_BODY, MAX_QUESTIONS

HOST = "127.0.0.1"
THREADS = MAX_QUESTIONS + 8
"""Requests answered at a time: those that wait for a process, and some that need none."""
LARGEST_HEADER = 32_768
"""Bytes of the largest header that is taken; a browser sends a thousand."""
CONNECTIONS = 256
"""Connections kept, where a browser has six: fewer than the 512 sockets that `select` takes on
Windows. More wait until some have been silent for long enough."""
SILENCE = 10
"""Seconds without a byte after which a connection that has no request is closed."""

LEADING_PAGE = """<!doctype html>
<meta charset="utf-8">
<meta name="referrer" content="no-referrer">
<meta http-equiv="refresh" content="0; url={address}">
<title>impact88 desk</title>
<p><a href="{address}">impact88 desk</a></p>
"""


def listening(port: int) -> socket.socket:
    """A socket that listens on this machine only; port 0 takes a free one. Raises UserError."""
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    if sys.platform != "win32":  # there it would let another program take the port over
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((HOST, port))
        listener.listen(64)
    except OSError as error:
        listener.close()
        raise UserError(
            f"port {port} is not available: {error.strerror or error}; expected another, "
            "or 0 for any that is free",
            "--port",
        ) from None
    return listener


def serve(port: int, browser: bool, announce: Callable[[str], object]) -> None:
    """Serve the desk until it is interrupted. ``announce`` receives its address once it listens.

    Raises UserError where Flask or waitress is missing or the port is not available.
    """
    packages = {"flask": "Flask", "waitress": "waitress"}
    if missing := ", ".join(packages[module] for module in packages if find_spec(module) is None):
        raise UserError(
            f"the desk needs {missing}, which is not installed; pip install 'impact88[desk]'"
        )
    with listening(port) as listener:
        number: int = listener.getsockname()[1]
        token = secrets.token_urlsafe(18)
        address = f"http://{HOST}:{number}/{token}/"
        announce(address)
        with ExitStack() as stack:
            if browser:
                file = stack.enter_context(leading_file(address))
                # the connection is queued by the socket, so the browser starts while we import
                threading.Thread(target=webbrowser.open, args=(file,), daemon=True).start()
            _run(listener, number, token)


@contextmanager
def leading_file(address: str) -> Iterator[str]:
    """Yield the URL of a file, readable by its owner only, that leads a browser to ``address``.

    A browser's arguments stand in the list of processes, which every user of a machine can read: an
    address with its token does not belong there.
    """
    handle, path = tempfile.mkstemp(prefix="impact88-desk-", suffix=".html")  # mode 0600
    try:
        with open(handle, "w", encoding="utf-8") as file:
            file.write(LEADING_PAGE.format(address=address))
        yield Path(path).as_uri()
    finally:
        with suppress(OSError):
            os.unlink(path)


def _run(listener: socket.socket, port: int, token: str) -> None:
    from waitress.server import create_server  # type: ignore[import-untyped]

    from .app import Desk, application
    from .connections import Channel

    # Windows lets any program change what a suffix means, and a browser runs no script that is
    # said to be plain text
    mimetypes.add_type("text/javascript", ".js")
    mimetypes.add_type("text/css", ".css")
    # a browser that goes away, or asks much at once, is no news to who started the desk
    logging.getLogger("waitress").setLevel(logging.ERROR)
    desk = Desk()
    server: Any = create_server(
        application(desk, port, token),
        sockets=[listener],
        threads=THREADS,
        ident=None,
        max_request_body_size=LARGEST_BODY,
        max_request_header_size=LARGEST_HEADER,
        connection_limit=CONNECTIONS,
        channel_timeout=SILENCE,
        cleanup_interval=1,
        clear_untrusted_proxy_headers=True,
    )
    server.channel_class = Channel
    try:
        server.run()
    finally:
        desk.close()
        server.close()
