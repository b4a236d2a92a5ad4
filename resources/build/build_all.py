"""Rebuild the committed generated files, in the order of their dependencies.

    python -m resources.build.build_all [STEP ...] [--characters-python PYTHON] [--assets FOLDER]
                                        [--captures FOLDER] [--soundfont FluidR3_GM.sf2]

Run from the repository, in the environment of the tests. Without steps: all of them. A step that lacks what it needs
is left out and said to be: the characters need a Python with anny and MakeHuman's assets, the choreography its
captures, the soundfont its source (`README.md` says how to get them), the pictures a display or ``xvfb-run``.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from app.messages import LANGUAGES

ROOT = Path(__file__).parents[2]
SCREEN = ("xvfb-run", "-a", "-s", "-screen 0 3840x2160x24")


@dataclass(frozen=True)
class Step:
    """A step of the build: the files that it makes, and the commands for it.

    Attributes
    ----------
    files : tuple of str
        What it writes, as patterns from the repository's root; what else lies in these folders is written by people.
    commands : callable
        From the arguments to the commands that make it, without the Python; an empty answer: something is missing.
    needs : str
        What to say then.
    python : callable
        From the arguments to the Python that runs them.
    seen : bool
        Whether it needs a display.
    """

    name: str
    files: tuple[str, ...]
    commands: Callable[[argparse.Namespace], tuple[tuple[str, ...], ...]]
    needs: str = ""
    python: Callable[[argparse.Namespace], str] = lambda arguments: sys.executable
    seen: bool = False


def _modules(*names: str) -> Callable[[argparse.Namespace], tuple[tuple[str, ...], ...]]:
    return lambda arguments: tuple(("-m", *name.split()) for name in names)


STEPS = (
    Step(
        "characters",
        ("resources/characters/*.glb", "resources/characters/hair/*/*.glb", "resources/characters/skin/*.jpg"),
        lambda arguments: (
            (("resources/build/build_characters.py", "--assets", str(arguments.assets)),)
            if arguments.characters_python is not None and arguments.assets is not None
            else ()
        ),
        "--characters-python: a Python with anny, and --assets: MakeHuman's",
        lambda arguments: str(arguments.characters_python),
    ),
    Step(
        "wardrobe",
        (
            "resources/characters/wardrobe/*.bin",
            "resources/characters/wardrobe/*.glb",
            "resources/characters/wardrobe/*.jpg",
            "resources/characters/wardrobe/*.json",
        ),
        lambda arguments: (
            (("resources/build/build_wardrobe.py", "--assets", str(arguments.assets)),)
            if arguments.characters_python is not None and arguments.assets is not None
            else ()
        ),
        "--characters-python: a Python with anny, and --assets: MakeHuman's",
        lambda arguments: str(arguments.characters_python),
    ),
    Step(
        "bodies",
        ("resources/characters/*.arrays",),
        lambda arguments: (("resources/build/build_bodies.py",),) if arguments.characters_python is not None else (),
        "--characters-python: a Python with anny",
        lambda arguments: str(arguments.characters_python),
    ),
    Step(
        "instruments",
        ("resources/instruments/*.glb", "instrument_maps/*.toml"),
        _modules("resources.build.build_instruments"),
    ),
    Step("holds", ("resources/holds/*.json",), _modules("resources.build.build_holds")),
    Step(
        "examples",
        ("resources/examples/*.mid", "resources/examples/*.musicxml"),
        _modules("resources.build.arrange_example", "resources.build.compose_dance_example"),
    ),
    Step(
        "choreography",
        ("resources/choreographies/*.choreography",),
        lambda arguments: (
            (("-m", "resources.build.build_choreography", str(arguments.captures)),)
            if arguments.captures is not None
            else ()
        ),
        "--captures: a folder with the captures and rhythms",
    ),
    Step(
        "soundfont",
        ("resources/soundfont/*.sf2",),
        lambda arguments: (
            (("-m", "resources.build.build_soundfont", str(arguments.soundfont)),)
            if arguments.soundfont is not None
            else ()
        ),
        "--soundfont: FluidR3_GM.sf2",
    ),
    Step("licences", ("docs/licences.md", "docs/licences_ja.md"), _modules("resources.build.build_licences")),
    Step(
        "pictures",
        ("docs/*.png", "docs/pictures/*.png", "docs/pictures/*.webp"),
        _modules(
            "resources.build.build_pictures",
            "resources.build.build_loops",
            "tests.support.character_pictures docs/pictures en:dark ja:dark",
            *(f"tests.support.recording_pictures {language}" for language in LANGUAGES),
            *(f"tests.support.unreal_pictures docs/pictures {language}" for language in LANGUAGES),
        ),
        "a display, or xvfb-run",
        seen=True,
    ),
)


def main(texts: list[str] | None = None) -> int:
    """Run the named steps; return 1 if a step failed, after which no further one runs."""
    parser = argparse.ArgumentParser(description="Makes the generated files again that are committed.")
    parser.add_argument("steps", nargs="*", metavar="STEP", help=", ".join(step.name for step in STEPS))
    parser.add_argument(
        "--characters-python", type=Path, help="of the environment that resources/build/README.md sets up"
    )
    parser.add_argument("--assets", type=Path, help="a folder with hair, brows, lashes and skins of MakeHuman")
    parser.add_argument("--captures", type=Path, help="a folder with the captures and rhythms of the choreography")
    parser.add_argument("--soundfont", type=Path, help="FluidR3_GM.sf2")
    arguments = parser.parse_args(texts)
    unknown = set(arguments.steps) - {step.name for step in STEPS}
    if unknown:
        parser.error(f"there is no step {', '.join(sorted(unknown))}")
    left_out = []
    for step in STEPS:
        if arguments.steps and step.name not in arguments.steps:
            continue
        before = _display() if step.seen else ()
        commands = step.commands(arguments)
        if not commands or before is None:
            left_out.append(f"{step.name}: needs {step.needs}")
            continue
        for command in commands:
            print(f"{step.name}: {' '.join(command)}", flush=True)
            done = subprocess.run((*before, step.python(arguments), *command), cwd=ROOT, check=False)
            if done.returncode:
                print(f"{step.name}: failed")
                return 1
    print(*(f"left out: {text}" for text in left_out), sep="\n")
    return 0


def _display() -> tuple[str, ...] | None:
    """Command prefix for steps that draw (empty if there is a display); None if no display is available."""
    if os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY") or sys.platform != "linux":
        return ()
    return SCREEN if shutil.which(SCREEN[0]) else None


if __name__ == "__main__":
    sys.exit(main())
