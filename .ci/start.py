"""The entry of the folder that needs no Python: the command, or the desk where nothing is asked."""

import sys
from multiprocessing import freeze_support

freeze_support()

from impact88.interface.commands.cli import main  # noqa: E402

sys.exit(main(sys.argv[1:] or ["desk"]))
