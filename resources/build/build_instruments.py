"""Builds the bundled instrument models and writes what follows from their shape into their maps.

    python -m resources.build.build_instruments [trumpet_Bb | trombone_tenor_F_attachment ...]

The module of every family has a table ``INSTRUMENTS``: id -> (what builds the model, what gives its contacts), of an
instrument with keys also what gives the tables of its keys (`instrument_keys.entry`).

The model goes to ``resources/instruments/<id>.glb``. In ``instrument_maps/<id>.toml`` everything below the line
``# --- from the model`` (keys, contacts and collision bodies) is written anew, so that map and model cannot drift
apart; what stands above that line is a musician's and is not touched.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from resources.build.instrument_glb import write
from resources.build.instrument_keys import table, toml
from resources.build.instrument_mesh import Model

ROOT = Path(__file__).parents[2]
MARK = "# --- from the model"
FAMILIES = (
    "bassoon", "clarinet", "contrabassoon", "ewi", "flute", "horn", "oboe", "recorder", "saxophone", "sousaphone",
    "trombone", "trumpet", "tuba", "tuba_rotary",
)  # fmt: skip
INSTRUMENTS: dict[str, tuple[Callable[[], Any], ...]] = {
    name: makers
    for family in FAMILIES
    for name, makers in import_module(f"resources.build.instrument_{family}").INSTRUMENTS.items()
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
    blocks = [("[[contacts]]", _contact(model, contact)) for contact in contacts]
    blocks += [("[[proxy]]", _proxy(model, part.node, body)) for part in model.parts for body in part.shape.proxies]
    return "".join(
        (
            f"{MARK} (written by resources/build/build_instruments.py; change the contacts there) ---\n",
            keys,
            "# Positions and normals are in the frame of the node, which rests at these places of the root frame:\n",
            *(f"#   {name}: {toml(origin)}\n" for name, origin in model.origins.items() if name != "root"),
            *(table(heading, row) for heading, row in blocks),
        )
    )


def _contact(model: Model, contact: dict[str, object]) -> dict[str, object]:
    row: dict[str, object] = {"part": contact["part"], "node": contact["node"]}
    row["position_m"] = np.asarray(contact["point"]) - model.origins[str(contact["node"])]
    row["normal"] = contact["normal"]
    row |= {key: contact[key] for key in ("control", "together") if contact.get(key)}
    return {**row, "grip": contact["grip"]}


def _proxy(model: Model, node: str, body: dict[str, object]) -> dict[str, object]:
    places = {key: np.asarray(body[key]) - model.origins[node] for key in ("a_m", "b_m", "centre_m") if key in body}
    return {"node": node, **body, **places}


if __name__ == "__main__":
    main(sys.argv[1:])
