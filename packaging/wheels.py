"""Asks pip for a wheel of every package that Suisou needs, for each supported Python and system, and prints a table.

Run it before a release, by the newest Python there is, since pip leaves out what does not run on the Python that asks:
``.venv-newer/bin/python packaging/wheels.py``. It takes some minutes, and keeps no wheel of those that it fetches.
`--python 3.13` asks for one Python only. Exit status 1: a package that pyproject.toml asks for has no wheel somewhere.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

PYPROJECT = Path(__file__).parents[1] / "pyproject.toml"
PYTHONS = ("3.11", "3.12", "3.13", "3.14")
EXTRAS = ("usd", "dask")
GLIBC = 35
"""The second number of the oldest C library of a supported Linux: Ubuntu 22.04 has 2.35."""


@dataclass(frozen=True)
class System:
    """A kind of computer: pip's names for it, and what markers see there."""

    title: str
    platforms: tuple[str, ...]
    markers: dict[str, str]


SYSTEMS = (
    System(
        "Linux",
        (*(f"manylinux_2_{number}_x86_64" for number in range(GLIBC, 4, -1)), "manylinux2014_x86_64"),
        {"sys_platform": "linux", "platform_system": "Linux", "os_name": "posix", "platform_machine": "x86_64"},
    ),
    System(
        "Windows",
        ("win_amd64",),
        {"sys_platform": "win32", "platform_system": "Windows", "os_name": "nt", "platform_machine": "AMD64"},
    ),
    System(
        "macOS Intel",
        ("macosx_15_0_x86_64",),
        {"sys_platform": "darwin", "platform_system": "Darwin", "os_name": "posix", "platform_machine": "x86_64"},
    ),
    System(
        "macOS ARM",
        ("macosx_15_0_arm64",),
        {"sys_platform": "darwin", "platform_system": "Darwin", "os_name": "posix", "platform_machine": "arm64"},
    ),
)


@dataclass
class Answers:
    """Answers of pip for one Python on one system.

    Attributes
    ----------
    versions : dict of str to str
        By normalised name the version of the wheel; empty: there is none.
    asked_by : dict of str to str
        By the same name who asks for the package first.
    """

    versions: dict[str, str] = field(default_factory=dict)
    asked_by: dict[str, str] = field(default_factory=dict)


def answers(direct: Sequence[str], python: str, system: System) -> Answers:
    """Ask for packages, and for what these ask for, until nothing new is asked for."""
    found = Answers()
    waiting = _new(direct, "pyproject.toml", found, python, system, ("", *EXTRAS))
    while waiting:
        installed = _ask(waiting, python, system)
        if installed is None:
            # pip does not say which of them has no wheel.
            installed = [package for one in waiting for package in _ask([one], python, system) or ()]
        waiting = []
        for package in installed:
            metadata = package["metadata"]
            found.versions[canonicalize_name(metadata["name"])] = metadata["version"]
        for package in installed:
            metadata = package["metadata"]
            waiting += _new(metadata.get("requires_dist", ()), metadata["name"], found, python, system, ("",))
    return found


def _new(
    texts: Sequence[str], asking: str, found: Answers, python: str, system: System, extras: Sequence[str]
) -> list[Requirement]:
    """The requirements that hold there and were not asked for before."""
    requirements = []
    environment = {
        **system.markers,
        "python_version": python,
        "python_full_version": f"{python}.0",
        "implementation_name": "cpython",
        "platform_python_implementation": "CPython",
    }
    for requirement in map(Requirement, texts):
        name = canonicalize_name(requirement.name)
        holds = requirement.marker is None or any(
            requirement.marker.evaluate({**environment, "extra": extra}) for extra in extras
        )
        if holds and name not in found.versions:
            found.versions[name], found.asked_by[name] = "", asking
            # pip would evaluate the marker for the computer on which it runs.
            requirement.marker = None
            requirements.append(requirement)
    return requirements


def _ask(requirements: Sequence[Requirement], python: str, system: System) -> list[dict] | None:
    """Return the distributions that pip would install; None if it cannot."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        asked = subprocess.run(
            [
                *(sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--dry-run"),
                *("--ignore-installed", "--no-deps", "--only-binary=:all:", "--report", str(report)),
                *("--target", folder, "--python-version", python, "--implementation", "cp"),
                *(word for platform in system.platforms for word in ("--platform", platform)),
                *map(str, requirements),
            ],
            capture_output=True,
            check=False,
        )
        return json.loads(report.read_text())["install"] if asked.returncode == 0 else None


def main() -> int:
    """Print a table for each Python, and what is missing."""
    parser = argparse.ArgumentParser(description="Ask for wheels of everything that Suisou needs.")
    parser.add_argument("--python", choices=PYTHONS, action="append", help="only this one; may be repeated")
    pythons = parser.parse_args().python or PYTHONS
    project = tomllib.loads(PYPROJECT.read_text(encoding="utf-8"))["project"]
    direct = [*project["dependencies"], *(text for extra in EXTRAS for text in project["optional-dependencies"][extra])]
    missing: list[str] = []
    is_complete = True
    for python in pythons:
        # pip waits for the network most of the time.
        with ThreadPoolExecutor() as pool:
            columns = {
                system.title: found
                for system, found in zip(SYSTEMS, pool.map(partial(answers, direct, python), SYSTEMS), strict=True)
            }
        names = sorted({name for found in columns.values() for name in found.versions})
        width = max(map(len, names)) + 2
        print(f"\nPython {python}".ljust(width + 1) + "".join(title.ljust(14) for title in columns))
        for name in names:
            cells = [found.versions.get(name) for found in columns.values()]
            print(name.ljust(width) + "".join({None: "", "": "NONE"}.get(cell, cell).ljust(14) for cell in cells))
            for (title, found), cell in zip(columns.items(), cells, strict=True):
                if cell == "":
                    missing.append(f"Python {python}, {title}: {name}, asked for by {found.asked_by[name]}")
                    is_complete = is_complete and found.asked_by[name] != "pyproject.toml"
    print("\nWithout a wheel:" if missing else "\nEverything has a wheel.")
    print("".join(f"  {line}\n" for line in missing), end="")
    return 0 if is_complete else 1


if __name__ == "__main__":
    sys.exit(main())
