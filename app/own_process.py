"""Parts of this program as processes of their own."""

from __future__ import annotations

import os
import sys


def own_process(module: str, *arguments: str) -> tuple[list[str], dict[str, str]]:
    """The command that runs one of our modules, and the environment it runs in.

    The child finds the packages that this process finds, wherever it is started, and none that happen to lie in the
    folder where it is: what a person has downloaded is not run.
    """
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    return [sys.executable, "-P", "-m", module, *arguments], environment
