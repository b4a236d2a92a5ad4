"""Builds the bundled instrument models and writes what follows from their shape into their maps.

    python -m resources.build.build_instruments [trumpet_Bb | trombone_tenor_F_attachment ...]

Every module of `FAMILIES` has a table ``INSTRUMENTS``: id -> (what builds the model, what gives its contacts), of an
instrument with keys also what gives the tables of its keys (`instrument_keys.entry`).

The model goes to ``resources/instruments/<id>.glb``. In ``instrument_maps/<id>.toml`` everything below the line
``# --- from the model`` (keys, contacts and collision bodies) is written anew, so that map and model cannot drift
apart; what stands above that line is a musician's and is not touched.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from resources.build import (
    instrument_bassoon,
    instrument_clarinet,
    instrument_contrabassoon,
    instrument_ewi,
    instrument_flute,
    instrument_horn,
    instrument_oboe,
    instrument_recorder,
    instrument_saxophone,
    instrument_sousaphone,
    instrument_trombone,
    instrument_trumpet,
    instrument_tuba,
    instrument_tuba_rotary,
)
from resources.build.instrument_glb import write
from resources.build.instrument_mesh import Model

ROOT = Path(__file__).parents[2]
MARK = "# --- from the model"
FAMILIES = (
    instrument_bassoon,
    instrument_clarinet,
    instrument_contrabassoon,
    instrument_ewi,
    instrument_flute,
    instrument_horn,
    instrument_oboe,
    instrument_recorder,
    instrument_saxophone,
    instrument_sousaphone,
    instrument_trombone,
    instrument_trumpet,
    instrument_tuba,
    instrument_tuba_rotary,
)
INSTRUMENTS: dict[str, tuple[Callable[[], Any], ...]] = {
    name: makers for family in FAMILIES for name, makers in family.INSTRUMENTS.items()
}


def main(names: list[str]) -> None:
    """Build the named instruments, all of them without names."""
    for name in names or list(INSTRUMENTS):
        build, contacts, *keys = INSTRUMENTS[name]
        table = ROOT / "instrument_maps" / f"{name}.toml"
        head = table.read_text("utf-8").partition(MARK)[0]
        if f'model = "{name}.glb"' not in head:
            continue  # the model of the map it extends, with all that follows from it
        model = build()
        path = ROOT / "resources" / "instruments" / f"{name}.glb"
        write(model, path)
        table.write_text(head + from_model(model, contacts(), "".join(tables() for tables in keys)), "utf-8")
        triangles = sum(len(part.shape.faces) for part in model.parts)
        print(f"{name}: {triangles} triangles, {path.stat().st_size / 1e6:.2f} MB")


def from_model(model: Model, contacts: list[dict[str, object]], keys: str = "") -> str:
    """The tables of keys, contacts and collision bodies as TOML."""
    lines = [
        f"{MARK} (written by resources/build/build_instruments.py; change the contacts there) ---",
        *keys.splitlines(),
        "# Positions and normals are in the frame of the node, which rests at these places of the root frame:",
        *(f"#   {name}: {_vector(origin)}" for name, origin in model.origins.items() if name != "root"),
    ]
    for contact in contacts:
        point = np.asarray(contact["point"]) - model.origins[str(contact["node"])]
        lines += ["", "[[contacts]]", f'part = "{contact["part"]}"', f'node = "{contact["node"]}"']
        lines += [f"position_m = {_vector(point)}", f"normal = {_vector(np.asarray(contact['normal']))}"]
        if contact["control"]:
            lines.append(f'control = "{contact["control"]}"')
        if contact.get("together"):
            lines.append("together = [" + ", ".join(f'"{name}"' for name in contact["together"]) + "]")
        if contact.get("when", "always") != "always":
            lines.append(f'when = "{contact["when"]}"')
        lines.append(f'grip = "{contact["grip"]}"')
    for part in model.parts:
        for proxy in part.shape.proxies:
            lines += ["", "[[proxy]]", f'node = "{part.node}"']
            for key, value in proxy.items():
                if key in ("a_m", "b_m", "centre_m"):
                    value = np.asarray(value) - model.origins[part.node]
                if isinstance(value, str):
                    lines.append(f'{key} = "{value}"')
                elif isinstance(value, np.ndarray):
                    lines.append(f"{key} = {_vector(value)}")
                else:
                    lines.append(f"{key} = {_number(float(value))}")
    return "\n".join(lines) + "\n"


def _vector(values: np.ndarray) -> str:
    return "[" + ", ".join(_number(float(value)) for value in values) + "]"


def _number(value: float) -> str:
    text = f"{value:.5f}".rstrip("0")
    text = text if not text.endswith(".") else f"{text}0"
    return "0.0" if text == "-0.0" else text


if __name__ == "__main__":
    main(sys.argv[1:])
