"""A local web interface opens in your browser, reachable from this computer only; nothing leaves
it, and nothing is kept when it ends. Paper: printouts judged as by impact88 verify, with the text
to correct beside the scan. Collision: a scene as a form, answered while you type. Reconstruction:
what is known, ticked. Control-C ends it. The address contains a random token; requests without it
are refused.

Needs pip install 'impact88[desk]'.

examples:
  impact88 desk                     open the page
  impact88 desk --no-browser        only print its address
  impact88 desk --port 8088         at a port of your choice
"""

import sys

from . import options

ARGUMENTS = (
    options.count("--port", 0, 65535, "the port (default: any free port)", default=0),
    options.flag("--no-browser", "print the address and open no browser"),
)


def main(args: options.Args) -> None:
    from ..desk.serving import serve

    def announce(address: str) -> None:
        print(address, flush=True)
        print("Control-C ends the desk", file=sys.stderr, flush=True)

    serve(args.port, not args.no_browser, announce)
