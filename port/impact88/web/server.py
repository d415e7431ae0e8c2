"""The socket, the address with its token, and the server."""

from __future__ import annotations

import logging
import mimetypes
import secrets
import socket
import sys
from threading import Timer
from typing import Any

from ..errors import UserError, library
from .guard import MAX_BODY

HOST = "127.0.0.1"
THREADS = 8  # requests answered at a time
MAX_CONNECTIONS = 500  # a browser has six
BACKLOG = 512  # connections that wait to be accepted
SILENCE = 20  # seconds without a byte after which a connection is closed
MAX_HEADER = 32_768  # bytes; a browser sends a thousand
BROWSER_DELAY = 0.3  # seconds until the server listens


def serve(port: int = 0, open_browser: bool = True) -> None:
    """Serve the web page on this computer until it is interrupted.

    The address, which contains a random token, is printed on standard output.

    Parameters
    ----------
    port : int, default 0
        The port; 0 takes a free one.
    open_browser : bool, default True
        Open the page in the default browser.

    Raises
    ------
    UserError
        If Flask or waitress is not installed, or the port is not available.
    """
    library("flask", "web", "the web page")
    library("waitress", "web", "the web page")
    with listening_socket(port) as listener:
        number: int = listener.getsockname()[1]
        token = secrets.token_urlsafe(18)
        # programs' arguments are visible to other users: the browser gets an address for one use
        entry = secrets.token_urlsafe(18)
        server = make_server(listener, number, token, entry if open_browser else "")
        print(f"http://{HOST}:{number}/{token}/", flush=True)
        print("This address works on this computer only. Ctrl-C ends it.", file=sys.stderr)
        if open_browser:
            import webbrowser

            timer = Timer(BROWSER_DELAY, webbrowser.open, [f"http://{HOST}:{number}/{entry}"])
            timer.daemon = True
            timer.start()
        try:
            server.run()
        finally:
            server.close()


def listening_socket(port: int) -> socket.socket:
    """Return a socket that listens on this computer only. Raises UserError."""
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    if sys.platform != "win32":  # there it would let another program take the port over
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((HOST, port))
        listener.listen(BACKLOG)
    except (OSError, OverflowError) as error:
        listener.close()
        reason = getattr(error, "strerror", None) or error
        message = f"port {port} is not available: {reason}; expected another, or 0 for a free one"
        raise UserError(message, "--port") from None
    return listener


def make_server(listener: socket.socket, port: int, token: str, entry: str = "") -> Any:
    """Return the server of a listening socket; ``run`` serves."""
    from waitress.server import create_server

    from .app import application

    # Windows lets programs change what a suffix means, and browsers run no script of another type
    mimetypes.add_type("text/javascript", ".js")
    mimetypes.add_type("text/css", ".css")
    logging.getLogger("waitress").setLevel(logging.ERROR)
    return create_server(
        application(port, token, entry),
        sockets=[listener],
        threads=THREADS,
        ident=None,
        max_request_body_size=MAX_BODY,
        max_request_header_size=MAX_HEADER,
        inbuf_overflow=2 * MAX_BODY,  # requests stay in memory
        outbuf_overflow=8 * MAX_BODY,
        connection_limit=MAX_CONNECTIONS,
        backlog=BACKLOG,
        channel_timeout=SILENCE,
        cleanup_interval=5,
        asyncore_use_poll=sys.platform != "win32",
        clear_untrusted_proxy_headers=True,
    )
