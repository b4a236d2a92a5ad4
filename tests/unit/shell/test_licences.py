"""The licence of every installed package and every resource is known."""

from __future__ import annotations

import re
import sys
from email.message import Message
from fnmatch import fnmatch
from importlib.metadata import Distribution
from pathlib import Path

import pytest

from app.shell.licences import Package, ThirdPartyWork, data, distributions, installed, package_of

ROOT = Path(__file__).parents[3]
LIBRARY = re.compile(r"\.(so|dylib|dll|exe)(\.|$)")
OWN_MODULE = re.compile(r"\.(cpython|cp3|abi3|pypy)[^/]*\.so$")
"""Compiled modules of a package itself, covered by its own licence."""
SPDX_WORD = re.compile(r"[A-Za-z0-9.+-]+")
DOCUMENTS = [(ROOT / "docs" / name).read_text(encoding="utf-8") for name in ("licences.md", "licences_ja.md")]


class Stated(Distribution):
    """A package with some metadata."""

    def __init__(self, **headers: str) -> None:
        self._headers = {"Name": "stated", "Version": "1.0", **headers}

    @property
    def metadata(self) -> Message:  # type: ignore[override]
        message = Message()
        for name, value in self._headers.items():
            message[name.replace("_", "-")] = value
        return message

    def read_text(self, filename: str) -> str | None:
        return None

    def locate_file(self, path: object) -> Path:
        return Path(str(path))


PACKAGES = {package.name: package for package in map(package_of, distributions().values())}


def test_what_is_needed_by_what_is_needed_is_found() -> None:
    assert {"PySide6_Essentials", "shiboken6", "numpy", "imageio-ffmpeg", "cffi", "pycparser"} <= set(PACKAGES)
    assert not {"suisou", "pytest", "ruff"} & set(PACKAGES)


@pytest.mark.parametrize("package", PACKAGES.values(), ids=lambda package: package.name)
def test_every_package_has_a_licence_and_a_source(package: Package) -> None:
    for work in (package, *package.parts):
        assert work.licence, f"{work.name}: no licence is known; resources/licences.toml may say it"  # type: ignore[attr-defined]
        assert re.match("https?://", work.source)  # type: ignore[attr-defined]
        assert all(f"| {work.name} |" in document for document in DOCUMENTS), "run resources/build/build_licences.py"  # type: ignore[attr-defined]


@pytest.mark.parametrize("found", distributions().values(), ids=lambda found: found.metadata["Name"])
def test_every_library_in_a_package_has_a_licence(found: Distribution) -> None:
    patterns = [pattern for part in package_of(found).parts for pattern in part.files]
    names = [str(file) for file in found.files or () if LIBRARY.search(file.name) and not OWN_MODULE.search(str(file))]
    unknown = [name for name in names if not any(fnmatch(name, pattern) for pattern in patterns)]
    assert unknown == [], "whose are they? resources/licences.toml may say it"


def test_what_is_of_another_system_is_not_listed() -> None:
    parts = {part.name for package in installed() for part in package.parts}
    assert {"Qt", "FFmpeg", "libsndfile", "libsoxr"} <= parts
    assert ("Mesa's software OpenGL (Windows)" in parts) == (sys.platform == "win32")


def test_the_program_that_makes_films_is_named() -> None:
    (part,) = PACKAGES["imageio-ffmpeg"].parts
    programs = [file for file in distributions()["imageio-ffmpeg"].files or () if fnmatch(str(file), part.files[0])]
    assert len(programs) == 1
    assert part == ThirdPartyWork("FFmpeg", "GPL-3.0-or-later", "https://ffmpeg.org/download.html", part.files)


def test_every_folder_of_data_has_a_licence() -> None:
    folders = {path.name for path in (ROOT / "resources").iterdir() if path.is_dir()} - {"build", "__pycache__"}
    assert {folder for part in data() for folder in part.files} == folders
    assert all(part.licence and f"| {part.name} |" in DOCUMENTS[0] for part in data())


def test_what_packages_state_is_read() -> None:
    def licence(**headers: str) -> str:
        return package_of(Stated(**headers)).licence

    assert licence() == ""
    assert licence(License_Expression="MIT AND Zlib", License="other") == "MIT AND Zlib"
    assert licence(License="BSD 3-Clause") == "BSD 3-Clause"
    assert licence(License="The MIT licence\nPermission ...", Classifier="License :: OSI Approved :: MIT License") == (
        "MIT License"
    )
    assert licence(Classifier="Topic :: Software Development :: Libraries") == ""
    assert package_of(Stated()).source == "https://pypi.org/project/stated"
    assert package_of(Stated(Project_URL="Source, https://example.org/x")).source == "https://example.org/x"
