"""Writes the tables of docs/licences.md from the installed packages and resources/licences.toml, which also has those
that other Pythons need.

Run from the repository, in the environment of the tests: ``python -m resources.build.build_licences``.
"""

from __future__ import annotations

from pathlib import Path

from app.shell.licences import Package, ThirdPartyWork, data, described, distributions, package_of

TARGET = Path(__file__).parents[2] / "docs" / "licences.md"
BEGIN = "<!-- The tables are written by resources/build/build_licences.py. -->\n"


def main() -> None:
    """Replace what stands below the mark."""
    above = TARGET.read_text(encoding="utf-8").partition(BEGIN)[0]
    here = {name: package_of(found) for name, found in distributions().items()}
    packages = [package for _, package in sorted(({package.name: package for package in described()} | here).items())]
    parts = [(package.name, part) for package in packages for part in package.parts]
    tables = [
        _table("## Python packages", "package", [_row(package) for package in packages]),
        _table("## In their wheels", "in", [f"| {name} {_row(part)}" for name, part in parts], "work | "),
        _table("## Suisou's own files", "what", [_row(part) for part in data()]),
    ]
    TARGET.write_text(above + BEGIN + "\n" + "\n\n".join(tables) + "\n", encoding="utf-8")


def _row(work: Package | ThirdPartyWork) -> str:
    return f"| {work.name} | {work.licence} | {work.source} |"


def _table(title: str, first: str, rows: list[str], second: str = "") -> str:
    columns = f"| {first} | {second}licence | source |"
    return "\n".join([title, "", columns, "|---" * (columns.count("|") - 1) + "|", *rows])


if __name__ == "__main__":
    main()
