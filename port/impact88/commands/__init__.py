"""The commands, a module each: ``ARGUMENTS`` declares what it takes, ``main`` does it, and the
module's docstring is the end of its help."""

COMMANDS = {
    "verify": "check an old printout digit for digit, explain what differs",
    "scene": "print a scene file to fill in, or a published run's",
    "run": "run the 1988 program on its own data or on a scene",
    "solve": "solve a table of scenes, in double precision or as the Apple",
    "bounds": "bounds, quantiles and drivers from ranges of the inputs",
    "reconstruct": "solve the equations for any unknowns, with tolerances",
    "figure": "draw a scene, its bounds or a figure of the chapter",
    "report": "a page for the case file: answer, drawing, inputs, method",
    "oracle": "answer scenes with all that is known of them",
    "compare": "say where another program's results differ, and why",
    "selfcheck": "replay captures of a real Apple II Plus: pass or fail",
    "witness": "let your own Apple II Plus ROM judge this project",
    "basic": "the ] prompt with the listing, or any Applesoft program",
    "desk": "a page in the browser, served by this machine to itself",
    "colinear": "the direct colinear impact, Equations 1 to 12",
    "barrier": "the impact of one vehicle on a rigid barrier",
    "delta-v": "velocity changes from speeds, masses, energy loss: Equation 19",
    "staged": "eleven staged collisions: Tables 1 and 2 recomputed and fitted",
    "example": "Section VII's reconstruction, step by step",
    "schema": "the forms of what --json prints, and the conventions",
    "bench": "run time against error of every method, on this machine",
    "completion": "a script that completes options in bash, zsh or tcsh",
}
"""Command -> one line of help."""

CHAPTER = ("colinear", "barrier", "delta-v", "staged", "example")
"""What follows ``impact88 chapter``; version 0.3 takes these words alone, too."""
CHAPTER_MEANING = "colinear, barrier, delta-v, staged or example: its other problems"

GROUPS = {
    "printouts": ("verify",),
    "collisions": ("scene", "run", "solve", "bounds", "reconstruct", "figure", "report"),
    "programs": ("oracle", "compare", "selfcheck", "witness"),
    "the Apple": ("basic",),
    "the page": ("desk",),
    "the chapter": ("chapter",),
    "": ("schema", "bench", "completion"),
}
"""The first page of the help; the last group stands below a line."""


def module_of(command: str) -> str:
    """The name of a command's module."""
    return f"{__name__}.{command.replace('-', '_')}_command"
