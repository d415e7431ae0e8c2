"""impact88 web                        open the pages in the browser
impact88 web --no-browser           print the address only
impact88 web --port 8088

Printouts, collisions and the 1988 program in a browser, reachable from this computer only and
without a network. The address contains a random token; requests without it are refused. Control-C
ends it. Needs pip install 'impact88[web]'."""

from __future__ import annotations

from . import options


def declare(parser: options.Parser) -> None:
    """Add the arguments."""
    parser.add_argument(
        "--port",
        type=options.whole_number(0, 65535),
        default=0,
        metavar="N",
        help="port of the address (default: a free one)",
    )
    parser.add_argument("--no-browser", action="store_true", help="print the address only")


def main(args: options.Args) -> None:
    """Serve the pages until control-C."""
    from ..web.server import serve

    serve(args.port, not args.no_browser)
