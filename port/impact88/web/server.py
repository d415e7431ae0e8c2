"""The socket, the address with its token, and the server."""

from __future__ import annotations

import logging
import mimetypes
import secrets
import socket
import sys
from threading import Thread
from typing import Any

from ..errors import UserError, library
from .guard import MAX_BODY

HOST = "127.0.0.1"
THREADS = 8  # requests answered at a time
MAX_CONNECTIONS = 500  # a browser has six
BACKLOG = 512  # connections that wait to be accepted
SILENCE = 20  # seconds without a byte after which a connection is closed


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
    for name in ("flask", "waitress"):
        library(name, "web", "the web page")
    with listening_socket(port) as listener:
        number: int = listener.getsockname()[1]
        token = secrets.token_urlsafe(18)
        address = f"http://{HOST}:{number}/{token}/"
        server = make_server(listener, number, token)
        print(address, flush=True)
        print("This address works on this computer only. Ctrl-C ends it.", file=sys.stderr)
        if open_browser:
            import webbrowser

            # the socket accepts connections already
            Thread(target=webbrowser.open, args=[address], daemon=True).start()
        try:
            server.run()
        finally:
            server.close()


def listening_socket(port: int) -> socket.socket:
    """Return a socket that listens on this computer only. Raises UserError."""
    try:
        return socket.create_server((HOST, port), backlog=BACKLOG)
    except (OSError, OverflowError) as error:
        message = f"port {port} is not available: {error}; expected another, or 0 for a free one"
        raise UserError(message, "--port") from None


def make_server(listener: socket.socket, port: int, token: str) -> Any:
    """Return the server of a listening socket; ``run`` serves."""
    from waitress.server import create_server

    from .app import application

    # Windows lets programs change what a suffix means, and browsers run no script of another type
    mimetypes.add_type("text/javascript", ".js")
    mimetypes.add_type("text/css", ".css")
    logging.getLogger("waitress").setLevel(logging.ERROR)
    return create_server(
        application(port, token),
        sockets=[listener],
        threads=THREADS,
        ident=None,
        max_request_body_size=MAX_BODY,
        connection_limit=MAX_CONNECTIONS,
        backlog=BACKLOG,
        channel_timeout=SILENCE,
    )
