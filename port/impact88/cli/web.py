"""impact88 web                        open the pages in the browser
impact88 web --no-browser           print the address only

Printouts, collisions and the 1988 program in a browser, reachable from this computer only and
without a network. The address contains a random token; requests without it are refused. Control-C
ends it. Needs pip install '.[web]' in the checkout."""

from __future__ import annotations

from .options import Args, flag

OPTIONS = (flag("--no-browser", "print the address only"),)


def main(args: Args) -> None:
    """Serve the pages until control-C."""
    from ..web.server import serve

    serve(open_browser=not args.no_browser)
