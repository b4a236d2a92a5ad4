"""Parts of this program as processes of their own."""

from __future__ import annotations

import os
import subprocess
import sys
from typing import Any


def own_process(module: str, *arguments: str) -> dict[str, Any]:
    """What `subprocess` needs to run one of our modules: the command, its environment and its process group.

    The child finds the packages that this process finds, wherever it is started, and none that happen to lie in the
    folder where it is: what the user has downloaded is not run. Ctrl-C in the terminal is not sent to it: this process
    ends it.
    """
    options: dict[str, Any] = {
        "args": [sys.executable, "-P", "-m", module, *arguments],
        "env": {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
    }
    if sys.platform == "win32":
        options["creationflags"] = subprocess.CREATE_NO_WINDOW | subprocess.CREATE_NEW_PROCESS_GROUP
    else:
        options["process_group"] = 0
    return options
