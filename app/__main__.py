"""``python -m app``, and the installed command ``suisou``."""

from __future__ import annotations

import sys


def main() -> int:
    """Run the command line with the process's arguments and return its exit status."""
    # Imported here so that whatever starts this module decides first what to load.
    from app.cli import main as run

    return run(sys.argv[1:])


if __name__ == "__main__":
    sys.exit(main())
