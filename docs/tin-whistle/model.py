"""Makes the model of the tin whistle: a tube with a mouthpiece, six holes on top and nothing that moves.

    PYTHONPATH=. python docs/tin-whistle/model.py          (from the repository)

Any program that writes glTF binaries does as well; the root frame is what matters (see docs/add-an-instrument.md).
The measures are those of a common brass whistle in D: 300 mm long, 12 mm wide, holes of 4 to 7 mm.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from resources.build.build_instruments import from_model
from resources.build.instrument_glb import write
from resources.build.instrument_mesh import Model, plate, torus, tube

FOLDER = Path(__file__).parent
RADIUS_M, LENGTH_M = 0.0062, 0.300
HOLES_M = {"L1": 0.126, "L2": 0.147, "L3": 0.168, "R1": 0.194, "R2": 0.215, "R3": 0.238}
"""Along the tube from where the lips close around the beak."""
HOLE_RADII_M = {"L1": 0.0030, "L2": 0.0034, "L3": 0.0030, "R1": 0.0035, "R2": 0.0038, "R3": 0.0026}
FINGERS = {"1": "index", "2": "middle", "3": "ring"}
THUMBS_M = {"left": 0.147, "right": 0.205}


def whistle() -> tuple[Model, list[dict[str, object]]]:
    """The model and what touches it."""
    model, up = Model(), np.array([0.0, 1.0, 0.0])
    model.add("lacquered_brass", tube(np.array([[0.0, 0.0, 0.030], [0.0, 0.0, LENGTH_M]]), RADIUS_M))
    model.add("dark_plastic", tube(np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.045]]), RADIUS_M + 0.0012))
    # The beak goes a little way behind the lips; the window where the sound begins lies on top.
    model.add("dark_plastic", plate([0.0, 0.0, -0.006], [0.0075, 0.0048, 0.008], [1, 0, 0], [0, 1, 0]))
    model.add("dark_plastic", plate([0.0, RADIUS_M + 0.001, 0.034], [0.004, 0.0008, 0.004], [1, 0, 0], [0, 1, 0]))
    contacts: list[dict[str, object]] = []

    def touch(part: str, z_m: float, normal: np.ndarray, control: str | None) -> None:
        point = np.array([0.0, 0.0, z_m]) + RADIUS_M * normal
        contacts.append(
            {"part": part, "node": "root", "point": point, "normal": normal, "control": control, "grip": "firm"}
        )

    for label, z_m in HOLES_M.items():
        model.add("dark_plastic", torus([0.0, RADIUS_M, z_m], up, HOLE_RADII_M[label], 0.0004))
        hand = "left" if label.startswith("L") else "right"
        touch(f"{hand}.{FINGERS[label[1]]}.pad", z_m, up, f"hole_{label}")
    for hand, z_m in THUMBS_M.items():
        touch(f"{hand}.thumb.pad", z_m, -up, None)
    return model, contacts


def main(folder: Path = FOLDER) -> None:
    """Write the model, and below the mark in the map what follows from it."""
    model, contacts = whistle()
    write(model, folder / "tin_whistle_D.glb")
    table = folder / "tin_whistle_D.toml"
    head = table.read_text("utf-8").partition("# --- from the model")[0]
    table.write_text(head + from_model(model, contacts), "utf-8")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
