"""Draws the pictures of the editor into docs/ with ``suisou edit --screenshot``; needs Pillow and a display.

Run from the repository: ``python resources/build/build_pictures.py``; without a screen, under
``xvfb-run -a -s "-screen 0 3840x2160x24"``.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).parents[2]
TARGET = ROOT / "docs"
PIECE = ROOT / "resources" / "examples" / "quartet.mid"


@dataclass(frozen=True)
class Picture:
    """A picture of the editor for a guide: its file name, and how the window is shown.

    Attributes
    ----------
    options : tuple of str
        Of ``suisou edit``.
    crop : (int, int, int, int) or None
        Left, top, right and bottom of the part that is kept.
    """

    name: str
    options: tuple[str, ...]
    crop: tuple[int, int, int, int] | None = None


TIMELINE = ("--time", "26.4", "--size", "3200x1700")
TIMELINE_BOX = (308, 905, 1908, 1672)
PICTURES = (
    Picture("editor", ("--time", "26.4", "--view", "ensemble")),
    Picture("editor_ja", ("--time", "26.4", "--view", "hands", "--language", "ja", "--theme", "light")),
    Picture("timeline", TIMELINE, TIMELINE_BOX),
    Picture("timeline_ja", (*TIMELINE, "--language", "ja"), TIMELINE_BOX),
)


def draw(picture: Picture, folder: Path) -> Image.Image:
    """Draw a picture of the editor's window and crop it."""
    file = folder / f"{picture.name}.png"
    command = [sys.executable, "-m", "app", "edit", str(PIECE), "--screenshot", str(file), *picture.options]
    subprocess.run(command, cwd=ROOT, check=True)
    image = Image.open(file).convert("RGB")
    return image.crop(picture.crop) if picture.crop is not None else image


def main() -> None:
    """Draw and write. Fewer colours would be smaller, but brass and surfaces lose theirs."""
    TARGET.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        for picture in PICTURES:
            image = draw(picture, Path(folder))
            path = TARGET / f"{picture.name}.png"
            image.save(path, optimize=True)
            print(f"{path.relative_to(ROOT)}: {image.width} x {image.height}, {path.stat().st_size // 1024} KB")


if __name__ == "__main__":
    main()
