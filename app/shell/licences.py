"""The licences of all packages and data that the program is installed with.

Licences are read from the packages' metadata; information missing there is in `resources/licences.toml`.
"""

from __future__ import annotations

from email.message import Message
from fnmatch import filter as matching
from functools import cache
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from importlib.resources import files
from pathlib import Path
from typing import Final

import msgspec
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from app.formats.toml import read_toml, shaped

PROGRAM: Final = "suisou"
_EXTRAS: Final = ("", "usd")
_LONGEST: Final = 80
"""A statement with more characters than this is the licence's text and not its name."""
_SOURCES: Final = ("source", "source code", "repository", "homepage", "home")


class ThirdPartyWork(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A third party's work within a package or among the program's data, with its licence.

    Attributes
    ----------
    name, licence, source : str
        Name of the work, its licence as an SPDX expression, and the web address of its source.
    files : tuple of str
        Patterns of the work's files; empty if it is linked into the package's own modules.
    """

    name: str
    licence: str
    source: str
    files: tuple[str, ...] = ()


class Package(msgspec.Struct, frozen=True):
    """A Python package that is installed with the program, for the list of licences; its licence is empty if
    unknown.
    """

    name: str
    version: str
    licence: str
    source: str
    parts: tuple[ThirdPartyWork, ...] = ()


class _Fact(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Licence of a package, or its source, as listed in `resources/licences.toml` because the package's metadata lacks
    it.
    """

    licence: str = ""
    source: str = ""
    parts: tuple[ThirdPartyWork, ...] = ()


class _Facts(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    packages: dict[str, _Fact]
    data: tuple[ThirdPartyWork, ...]


@cache
def _facts() -> _Facts:
    path = Path(str(files("resources"))) / "licences.toml"
    return shaped(read_toml(path), _Facts, path.name)


def data() -> tuple[ThirdPartyWork, ...]:
    """Return the works of third parties among the program's own files, for the list of licences."""
    return _facts().data


def installed() -> tuple[Package, ...]:
    """Return every package that the program depends on, directly or indirectly, with its parts on this system.

    Raises
    ------
    importlib.metadata.PackageNotFoundError
        If the program itself is not installed as a package.
    """
    return tuple(_present(found) for _, found in sorted(distributions().items()))


def distributions() -> dict[str, Distribution]:
    """Return the installed distributions that the program depends on, directly or indirectly, by normalised name."""
    found: dict[str, Distribution] = {}
    waiting = [distribution(PROGRAM)]
    while waiting:
        for text in waiting.pop().requires or ():
            requirement = Requirement(text)
            name = canonicalize_name(requirement.name)
            requested = requirement.marker is None or any(requirement.marker.evaluate({"extra": e}) for e in _EXTRAS)
            if not requested or name in found:
                continue
            try:
                found[name] = distribution(name)
            except PackageNotFoundError:
                continue  # an optional package that is not installed
            waiting.append(found[name])
    return found


def described() -> tuple[Package, ...]:
    """Return the packages described completely in `resources/licences.toml`: those needed by only some versions of
    Python.
    """
    return tuple(
        Package(name, "", fact.licence, fact.source, fact.parts)
        for name, fact in sorted(_facts().packages.items())
        if fact.licence and fact.source
    )


def package_of(found: Distribution) -> Package:
    """Return an installed package's information with its parts on any system."""
    metadata: Message = found.metadata  # type: ignore[assignment]
    fact = _facts().packages.get(canonicalize_name(metadata["Name"]), _Fact())
    return Package(
        metadata["Name"],
        found.version,
        fact.licence or _licence(metadata),
        fact.source or _source(metadata),
        fact.parts,
    )


def _present(found: Distribution) -> Package:
    package, names = package_of(found), [str(file) for file in found.files or ()]
    here = [part for part in package.parts if not part.files or any(matching(names, p) for p in part.files)]
    return msgspec.structs.replace(package, parts=tuple(here))


def _licence(metadata: Message) -> str:
    """Return the licence named in a package's metadata, as an SPDX expression if there is one."""
    stated = str(metadata.get("License-Expression") or metadata.get("License") or "").strip()
    if stated and "\n" not in stated and len(stated) <= _LONGEST:
        return stated
    classes = [str(value).split(" :: ") for value in metadata.get_all("Classifier", ())]
    return ", ".join(parts[-1] for parts in classes if parts[0] == "License" and len(parts) > 2)


def _source(metadata: Message) -> str:
    """Return the web address of a package's source code or home page, from the package's metadata."""
    addresses = {}
    for entry in metadata.get_all("Project-URL", ()):
        label, _, address = str(entry).partition(",")
        addresses[label.strip().lower()] = address.strip()
    known = [addresses[label] for label in _SOURCES if label in addresses]
    return next(iter(known), str(metadata.get("Home-page") or f"https://pypi.org/project/{metadata['Name']}"))
