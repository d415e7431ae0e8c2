"""What runs in a process of the bench: a line of JSON in, a line of JSON out, until the input ends.

The process is given the name of the module it will work with, and warms it up.
The question's ``task`` names a function of `TASKS`, the rest are its arguments. The reply is
``{"answer": ...}``, ``{"problem": text}`` for input that cannot be used, or ``{"fault": text}``.
"""

from __future__ import annotations

import json
import os
import signal
import sys
from importlib import import_module
from typing import Any

TASKS = {
    "bounds": ("collision", "bounds_answer"),
    "case_report": ("collision", "case_report"),
    "judge": ("paper", "judged"),
    "report": ("paper", "report"),
    "reconstruct": ("reconstruction", "answer"),
}
"""Task -> module of this room and function."""


def answer(question: dict[str, Any]) -> dict[str, Any]:
    """The reply to one question."""
    from ..errors import UserError

    arguments = dict(question)
    try:
        module, function = TASKS[arguments.pop("task")]
        return {"answer": getattr(import_module(f"{__package__}.{module}"), function)(**arguments)}
    except UserError as error:
        return {"problem": str(error)}
    except Exception as error:
        if os.environ.get("IMPACT88_DEBUG"):
            raise
        return {"fault": f"{type(error).__name__}: {error}"}


def main() -> None:
    """Answer until the input ends. Control-C is for the parent, which ends this process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    replies = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # nothing else may come between the replies
    import_module(f"{__package__}.{sys.argv[1]}").warm()
    for line in open(0, encoding="utf-8", closefd=False):  # noqa: SIM115
        reply = answer(json.loads(line))
        replies.write(json.dumps(reply) + "\n")
        replies.flush()
