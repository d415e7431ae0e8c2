"""The package's version and, if known, its commit: every record contains both."""

import os

__version__ = "0.3.0"

COMMIT_FILE = "commit.txt"
"""The file next to this module with the commit of a distribution built from a checkout."""


def commit() -> str | None:
    """Return the commit this copy of the package was made from.

    Returns
    -------
    str or None
        The commit's hash: in a distribution, that of the checkout it was built from; in a checkout,
        its own, with ``-dirty`` if files have changed since. None if neither is known.
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
    import subprocess  # needed in a checkout only

    describe = ["git", "-C", root, "describe", "--always", "--exclude=*", "--abbrev=12", "--dirty"]
    try:
        process = subprocess.run(describe, capture_output=True, text=True, timeout=10, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return None
    return process.stdout.strip() or None


def full_version() -> str:
    """Return the version and, if known, the commit, as shown in a record.

    Examples
    --------
    >>> from impact88.version import __version__, full_version
    >>> full_version().startswith(__version__)
    True
    """
    commit_id = commit()
    return f"{__version__} (commit {commit_id})" if commit_id else __version__
