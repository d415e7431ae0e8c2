"""Help that fits the terminal: paragraphs are filled, lines that begin with a blank stand as they
are unless they are too long."""

import argparse
import re
import textwrap
from collections.abc import Iterable
from itertools import groupby

from . import CHAPTER, CHAPTER_MEANING, COMMANDS, GROUPS

MIN_WIDTH = 40  # columns; below, words stand alone
MAX_WIDTH = 100  # columns; above, lines are too long to read


class Formatter(argparse.HelpFormatter):
    """argparse's help as wide as the terminal. The width is asked for only when help is printed:
    argparse makes a formatter for every argument."""

    def __init__(self, prog: str) -> None:
        super().__init__(prog, width=80)

    def format_help(self) -> str:
        """Return the whole help."""
        self._width = width = terminal_width()
        # argparse leaves a group of options on one line
        return "\n".join(
            part for line in super().format_help().split("\n") for part in _hanging(line, width)
        )

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        return wrap_text(text, width)


def terminal_width() -> int:
    """Columns of the terminal, 80 when unknown."""
    from shutil import get_terminal_size

    return min(max(get_terminal_size((80, 24)).columns, MIN_WIDTH), MAX_WIDTH)


def wrap_text(text: str, width: int) -> str:
    """Return a docstring wrapped to a number of columns."""
    lines: list[str] = []
    lines_of_text = text.strip("\n").splitlines()
    for is_paragraph, block in groupby(lines_of_text, lambda line: bool(line[:1].strip())):
        if is_paragraph:
            lines += textwrap.wrap(" ".join(block), width, break_on_hyphens=False)
        else:
            lines += [part for line in block for part in _hanging(line, width)]
    return "\n".join(lines)


def _hanging(line: str, width: int) -> list[str]:
    """Return a line, or wrap it below the last of its columns that leaves room."""
    if len(line) <= width:
        return [line]
    if re.match(r" *impact88 (?!.*\S  )", line):  # a command alone stays one for the shell
        *first_parts, last = _wrap(line, width - 2, 6)
        return [*(f"{part} \\" for part in first_parts), last]
    columns = [m.end() for m in re.finditer(r"\S {2,}", line[: width * 3 // 4])]
    return _wrap(line, width, columns[-1] if columns else len(line) - len(line.lstrip()) + 4)


def _wrap(line: str, width: int, indent: int) -> list[str]:
    return textwrap.wrap(
        line, width, subsequent_indent=" " * indent, break_on_hyphens=False, break_long_words=False
    )


def overview() -> str:
    """Return the first page: every command in its group."""
    groups = "\n\n".join(f"{group}\n{_command_lines(GROUPS[group])}" for group in GROUPS)
    text = (
        "usage: impact88 COMMAND [options]\n\nR. M. Brach's 1988 program for the planar impact of "
        "two vehicles, digit for digit, and the same mechanics for today's work.\n\n"
        f"{groups}\n\nimpact88 help COMMAND lists a command's options."
    )
    status = "exit status: 0 done, 1 adverse result, 2 unusable input, 3 internal error"
    width = terminal_width()
    return f"{wrap_text(text, width)}\n{wrap_text(status, width)}"


def chapter_overview() -> str:
    """Return the page of ``impact88 chapter``: its problems."""
    text = f"usage: impact88 chapter PROBLEM [options]\n\n{_command_lines(CHAPTER)}\n\n"
    return wrap_text(f"{text}impact88 help chapter PROBLEM lists its options.", terminal_width())


def _command_lines(names: Iterable[str]) -> str:
    return "\n".join(f"  {name:<13}{COMMANDS.get(name, CHAPTER_MEANING)}" for name in names)
