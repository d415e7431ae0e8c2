"""The package's version and, where it is known, the commit it was made from: every record names
both."""

import os

__version__ = "0.3.0.dev0"

COMMIT_FILE = "commit.txt"
"""Written beside this module when a distribution is built from a checkout."""


def commit() -> str | None:
    """Return the commit this copy of the package was made from.

    Returns
    -------
    str or None
        The commit's hash: of a distribution, that of the checkout it was built from; in a checkout,
        its own, with ``-dirty`` where files have been changed since. None where neither is known.
    """
    folder = os.path.dirname(os.path.abspath(__file__))
    try:
        with open(os.path.join(folder, COMMIT_FILE), encoding="ascii") as file:
            return file.read().strip() or None
    except OSError:
        pass
    root = os.path.dirname(os.path.dirname(folder))
    if not os.path.exists(os.path.join(root, ".git")):
        return None
    import subprocess  # a checkout's only

    describe = ["git", "-C", root, "describe", "--always", "--exclude=*", "--abbrev=12", "--dirty"]
    try:
        asked = subprocess.run(describe, capture_output=True, text=True, timeout=10, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return None
    return asked.stdout.strip() or None


def full_version() -> str:
    """Return the version, and the commit where it is known, as a record shows them.

    Examples
    --------
    >>> from impact88.version import __version__, full_version
    >>> full_version().startswith(__version__)
    True
    """
    known = commit()
    return f"{__version__} (commit {known})" if known else __version__
