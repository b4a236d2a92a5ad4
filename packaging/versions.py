"""Print requirements for the oldest or the newest allowed versions of the libraries that change most under us.

``python packaging/versions.py oldest``: read from ``pyproject.toml``, for the running Python; used by
``./test --versions``.
"""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

from packaging.requirements import Requirement

LIBRARIES = ("pyside6-essentials", "numpy", "scipy", "vispy", "pyqtgraph")


def requirements(end: str, dependencies: list[str]) -> list[str]:
    """Return one requirement per library.

    Parameters
    ----------
    end : str
        ``"oldest"``: the lower bound itself; ``"newest"``: the bounds as they are.
    dependencies : list of str
        As ``project.dependencies`` has them.

    Raises
    ------
    ValueError
        A library is missing, or has no lower bound.
    """
    found: dict[str, str] = {}
    for requirement in map(Requirement, dependencies):
        name = requirement.name.lower().replace("_", "-")
        if name not in LIBRARIES or (requirement.marker is not None and not requirement.marker.evaluate()):
            continue
        least = [bound.version for bound in requirement.specifier if bound.operator in (">=", "==")]
        if len(least) != 1:
            raise ValueError(f"{requirement} has no lower bound")
        found[name] = f"{name}=={least[0]}" if end == "oldest" else f"{name}{requirement.specifier}"
    if set(found) != set(LIBRARIES):
        raise ValueError(f"not in pyproject.toml: {sorted(set(LIBRARIES) - set(found))}")
    return [found[name] for name in LIBRARIES]


if __name__ == "__main__":
    project = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    sys.stdout.write("\n".join(requirements(sys.argv[1], project["dependencies"])) + "\n")
