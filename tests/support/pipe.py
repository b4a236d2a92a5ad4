"""A made-up instrument that consists only of a map and a model in a folder, like one that a user adds.

A plain tube with six holes (one that may be half closed, one with a ring), a thumb hole with a register key beside it,
three keys for the right little finger, two for the left one, and a pad that follows a hole and a key.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from resources.build.build_instruments import from_model
from resources.build.instrument_glb import write
from resources.build.instrument_mesh import Model, Shape, plate, torus, tube

ID = "pipe"
RADIUS_M, LENGTH_M = 0.0115, 0.56
HOLES_M = {"L1": 0.170, "L2": 0.203, "L3": 0.233, "R1": 0.300, "R2": 0.330, "R3": 0.362}
THUMB_M, REGISTER_M, REST_M = 0.182, 0.165, 0.318
KEYS_M = {"E": (-0.017, 0.386), "F": (-0.017, 0.402), "G": (-0.009, 0.386), "C": (0.010, 0.258), "D": (0.010, 0.271)}
"""Positions in metres of the keys for the little fingers: to the left of the centre, and along the tube."""
KEY_HALF_M, KEY_HEIGHT_M = (0.004, 0.0015, 0.006), 0.0165
FINGERS = {
    "L1": "left.index", "L2": "left.middle", "L3": "left.ring", "R1": "right.index", "R2": "right.middle",
    "R3": "right.ring", "E": "right.little", "F": "right.little", "G": "right.little", "C": "left.little",
    "D": "left.little", "T": "left.thumb", "Reg": "left.thumb",
}  # fmt: skip

HEAD = """schema_version = 1
id = "pipe"
name = { en = "Pipe", ja = "パイプ" }
short_name = "Pipe"
plays = ["recorder"]
transposition_semitones = 0
model = "pipe.glb"
breaks = [75]

fingerings = [
@fingerings@
]

[range]
low = 60
high = 81
easy_low = 62
easy_high = 79

[embouchure]
kind = "fipple"
lips_apart_m = 0.012

[mouthpiece]
position_m = [0.0, 0.0, 0.0]
air_axis = [0.0, 0.0, 1.0]
up_axis = [0.0, 1.0, 0.0]
rim_radius_m = 0.011
rim_outer_radius_m = 0.012

@controls@
[[links]]
node = "vent"
motion = { axis = [1.0, 0.0, 0.0], angle_rad = 0.12, pivot_m = [0.0, 0.012, 0.44] }
controls = ["hole_R3", "key_E"]
when = "any"

[[hands]]
hand = "left"
node = "root"
palm_position_m = [0.075, 0.012, 0.205]
palm_normal = [-0.50262, -0.86451, 0.00000]
finger_direction = [-0.84742, 0.49008, 0.20420]

[[hands]]
hand = "right"
node = "root"
palm_position_m = [-0.075, 0.012, 0.335]
palm_normal = [0.50262, -0.86451, 0.00000]
finger_direction = [0.84742, 0.49008, 0.20420]

[hold]
support_hand = "right"

@carriages@
"""

LINE = ["E R1 R2 R3", "R1 R2 R3", "F R1 R2 R3", "R1 R2", "G R1 R2", "R1", "", "D", "C"]
"""Fingers of the lower joint that are added to the three holes of the upper joint, from the lowest note upwards."""


def fingerings() -> list[tuple[int, str]]:
    """Written pitch and label of every note: two registers and forked fingerings between."""
    upper = ["L1 L2 L3 T"] * 9 + ["L1 L2 T", "L1 T", "L1h T"]
    lower = [*LINE, "", "", ""]
    first = list(zip(upper, lower, strict=True))
    found = [(60 + step, f"{a} {b}") for step, (a, b) in enumerate(first)]
    found += [(72 + step, f"{a} {b} Reg") for step, (a, b) in enumerate(first[:9])]
    found.append((81, "L2 L3 Reg"))
    return [(pitch, " ".join(sorted(label.split())) or "(open)") for pitch, label in found]


def add(folder: Path) -> Path:
    """Write map and model into a folder and return the map's path."""
    model, contacts = _model()
    write(model, folder / f"{ID}.glb")
    text = HEAD
    rows = [f'  {{ written_pitch = {pitch}, rank = 1, label = "{label}" }},' for pitch, label in fingerings()]
    for name, filled in (
        ("fingerings", "\n".join(rows)),
        ("controls", "\n".join(_control(label) for label in FINGERS)),
        ("carriages", "\n".join(_carriages())),
    ):
        text = text.replace(f"@{name}@", filled)
    path = folder / f"{ID}.toml"
    path.write_text(text + from_model(model, contacts), "utf-8")
    return path


def _name(label: str) -> str:
    return f"hole_{label}" if label in HOLES_M or label == "T" else f"key_{label}"


def _control(label: str) -> str:
    lines = ["[[controls]]", f'name = "{_name(label)}"', 'role = "pitch"', f'finger = "{FINGERS[label]}"']
    lines += [f'label = "{label}"', "hover_m = 0.010"]
    lines.append(f'kind = "{"hole" if _name(label).startswith("hole") else "key"}"')
    if label == "L1":
        lines.append("half_value = 0.5")
    if label == "R3":
        lines += ['node = "ring_R3"', "motion = { axis = [0.0, -1.0, 0.0], travel_m = 0.0025 }"]
    if label in KEYS_M:
        x, z = KEYS_M[label]
        lines.append(f'node = "key_{label}"')
        pivot = f"pivot_m = [{x}, {KEY_HEIGHT_M}, {z + 0.05}]"
        lines.append(f"motion = {{ axis = [-1.0, 0.0, 0.0], angle_rad = 0.09, {pivot} }}")
    if label == "Reg":
        lines += ['node = "key_Reg"', "motion = { axis = [0.0, 1.0, 0.0], travel_m = 0.003 }"]
    return "\n".join(lines) + "\n"


def _carriages() -> list[str]:
    lines = []
    for posture in ("standing", "seated"):
        lines += [f"[hold.{posture}]", "pitch_down_deg = [35.0, 45.0, 58.0]"]
        lines += ["yaw_left_deg = [-6.0, 0.0, 6.0]", "roll_left_deg = [-5.0, 0.0, 5.0]", ""]
        lines += [f"[hold.lowered_{posture}]", "offset_m = [0.0, -0.22, 0.06]", "pitch_down_deg = 62.0"]
        lines += ["yaw_left_deg = 0.0", "roll_left_deg = 0.0", ""]
    return lines


def _ring(centre: list[float], radius: float) -> Shape:
    """Thin ring that is no obstacle for hands."""
    return replace(torus(centre, [0.0, 1.0, 0.0], radius, 0.0007), proxies=())


def _model() -> tuple[Model, list[dict[str, object]]]:
    model = Model()
    contacts: list[dict[str, object]] = []
    up = np.array([0.0, 1.0, 0.0])

    def touch(part: str, node: str, point: list[float], normal: np.ndarray, *controls: str) -> None:
        control, together = (controls[0], controls[1:]) if controls else (None, ())
        contacts.append(
            {"part": part, "node": node, "point": np.array(point), "normal": normal, "control": control,
             "together": list(together), "grip": "firm"}
        )  # fmt: skip

    model.add("pearwood", tube(np.array([[0, 0, -0.012], [0, 0, LENGTH_M]]), RADIUS_M))
    for label, z in HOLES_M.items():
        model.add("ivory_plastic", _ring([0.0, RADIUS_M, z], 0.0045))
        if label == "R3":
            model.node("ring_R3", [0.0, RADIUS_M + 0.003, z])
            model.add("silver", _ring([0.0, RADIUS_M + 0.003, z], 0.008), node="ring_R3")
        touch(f"{FINGERS[label]}.pad", "root", [0.0, RADIUS_M, z], up, _name(label))
    for label, (x, z) in KEYS_M.items():
        model.node(f"key_{label}", [x, KEY_HEIGHT_M, z])
        half = np.array(KEY_HALF_M)
        model.add("silver", plate([x, KEY_HEIGHT_M - half[1], z], half, [1, 0, 0], [0, 1, 0]), node=f"key_{label}")
        touch(f"{FINGERS[label]}.pad", f"key_{label}", [x, KEY_HEIGHT_M, z], up, _name(label))
    model.node("vent", [0.0, RADIUS_M + 0.004, 0.44])
    model.add("pad", plate([0.0, RADIUS_M + 0.004, 0.44], [0.006, 0.001, 0.006], [1, 0, 0], [0, 1, 0]), node="vent")
    model.node("key_Reg", [0.0, -RADIUS_M - 0.004, REGISTER_M])
    model.add(
        "silver",
        plate([0.0, -RADIUS_M - 0.003, REGISTER_M], [0.005, 0.001, 0.006], [1, 0, 0], [0, 1, 0]),
        node="key_Reg",
    )
    touch("left.thumb.pad", "root", [0.0, -RADIUS_M, THUMB_M], -up, _name("T"))
    touch("left.thumb.pad", "key_Reg", [0.0, -RADIUS_M - 0.004, REGISTER_M], -up, _name("Reg"))
    touch("left.thumb.pad", "root", [0.0, -RADIUS_M, THUMB_M - 0.003], -up, _name("T"), _name("Reg"))
    touch("right.thumb.side", "root", [0.0, -RADIUS_M, REST_M], -up)
    return model, contacts
