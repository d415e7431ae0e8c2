"""The commands, a module each: ``ARGUMENTS`` declares what it takes, ``main`` does it, and the
module's docstring is the end of its help. One row of `ROWS` registers a command."""

from collections import namedtuple  # typing takes longer to import than a short run


class Command(namedtuple("Command", ("name", "group", "summary"))):
    """A command: its ``name`` on the command line, its ``group`` on the first page of the help, and
    one line of help. Its module is named for it: ``delta-v`` is in ``delta_v_command.py``."""

    __slots__ = ()


_PRINTOUTS = "printouts"
_COLLISIONS = "collisions"
_PROGRAMS = "programs"
_APPLE = "the Apple"
_BROWSER = "browser"
_CHAPTER = "the chapter"  # its commands follow ``impact88 chapter``
_OTHER = "other"

# in the order of the help: the rows of a group stand together
ROWS = (
    Command("verify", _PRINTOUTS, "check an old printout digit for digit, explain what differs"),
    Command("scene", _COLLISIONS, "print a scene file to fill in, or a published run's"),
    Command("run", _COLLISIONS, "run the 1988 program on its own data or on a scene"),
    Command("solve", _COLLISIONS, "solve a table of scenes, in double precision or as the Apple"),
    Command("bounds", _COLLISIONS, "bounds, quantiles and drivers from ranges of the inputs"),
    Command("reconstruct", _COLLISIONS, "solve the equations for any unknowns, with tolerances"),
    Command("figure", _COLLISIONS, "draw a scene or a figure of the chapter"),
    Command("report", _COLLISIONS, "a page for the case file: answer, drawing, inputs, method"),
    Command("oracle", _PROGRAMS, "compute reference answers for scenes"),
    Command("compare", _PROGRAMS, "say where another program's results differ, and why"),
    Command("selfcheck", _PROGRAMS, "replay captures of a real Apple II Plus: pass or fail"),
    Command("witness", _PROGRAMS, "let your own Apple II Plus ROM judge this project"),
    Command("basic", _APPLE, "the ] prompt with the listing, or any Applesoft program"),
    Command("desk", _BROWSER, "a local web interface, reachable from this computer only"),
    Command("colinear", _CHAPTER, "the direct colinear impact, Equations 1 to 12"),
    Command("barrier", _CHAPTER, "the impact of one vehicle on a rigid barrier"),
    Command("delta-v", _CHAPTER, "velocity changes from speeds, masses, energy loss: Equation 19"),
    Command("staged", _CHAPTER, "eleven staged collisions: Tables 1 and 2 recomputed"),
    Command("example", _CHAPTER, "Section VII's reconstruction, step by step"),
    Command("schema", _OTHER, "the forms of what --json prints, and the conventions"),
    Command("bench", _OTHER, "run time against error of every method, on this machine"),
    Command("completion", _OTHER, "a script that completes options in bash, zsh or tcsh"),
)
COMMANDS = {command.name: command.summary for command in ROWS}
"""Command -> one line of help."""
CHAPTER = tuple(command.name for command in ROWS if command.group == _CHAPTER)
"""The words behind ``impact88 chapter``; version 0.3 takes them alone, too."""
CHAPTER_MEANING = f"{', '.join(CHAPTER[:-1])} or {CHAPTER[-1]}: its other problems"


def _group_commands() -> dict[str, tuple[str, ...]]:
    groups: dict[str, tuple[str, ...]] = {}
    for command in ROWS:
        name = "chapter" if command.group == _CHAPTER else command.name
        members = groups.setdefault(command.group, ())
        if name not in members:
            groups[command.group] = (*members, name)
    return groups


GROUPS = _group_commands()
"""Group -> its commands, as the first page of the help shows them."""


def module_of(command: str) -> str:
    """Return the name of a command's module."""
    return f"{__name__}.{command.replace('-', '_')}_command"
