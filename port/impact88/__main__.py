"""``python -m impact88`` is the command ``impact88``."""

import sys

from .cli.main import main

if __name__ == "__main__":
    sys.exit(main())
