"""The socket, the address with its token, and the server."""

from __future__ import annotations

import logging
import mimetypes
import secrets
import socket
import sys
from threading import Thread
from typing import Any

from ..errors import library

HOST = "127.0.0.1"
THREADS = 8  # requests answered at a time
MAX_CONNECTIONS = 500  # a browser has six
BACKLOG = 512  # connections that wait to be accepted
SILENCE = 20  # seconds without a byte after which a connection is closed


def serve(open_browser: bool = True) -> None:
    """Serve the web page on this computer until it is interrupted.

    The address, which contains a random token, is printed on standard output.

    Parameters
    ----------
    open_browser : bool, default True
        Open the page in the default browser.

    Raises
    ------
    UserError
        If Flask or waitress is not installed.
    """
    for name in ("flask", "waitress"):
        library(name, "web", "the web page")
    with listening_socket() as listener:
        token = secrets.token_urlsafe(18)
        address = f"http://{HOST}:{listener.getsockname()[1]}/{token}/"
        server = make_server(listener, token)
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


def listening_socket() -> socket.socket:
    """Return a socket that listens on a free port, on this computer only."""
    return socket.create_server((HOST, 0), backlog=BACKLOG)


def make_server(listener: socket.socket, token: str) -> Any:
    """Return the server of a listening socket; ``run`` serves."""
    from waitress.server import create_server

    from .app import application
    from .guard import MAX_BODY

    # Windows lets programs change what a suffix means, and browsers run no script of another type
    mimetypes.add_type("text/javascript", ".js")
    mimetypes.add_type("text/css", ".css")
    logging.getLogger("waitress").setLevel(logging.ERROR)
    return create_server(
        application(listener.getsockname()[1], token),
        sockets=[listener],
        threads=THREADS,
        ident=None,
        max_request_body_size=MAX_BODY,
        connection_limit=MAX_CONNECTIONS,
        backlog=BACKLOG,
        channel_timeout=SILENCE,
    )
