"""Whether a map and its model agree: the nodes exist and lie where the map's frames need them."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from pathlib import Path

from instrument_maps.model import ROOT, InstrumentMap
from instrument_maps.validate import Problem


def model_problems(instrument: InstrumentMap, path: Path) -> Iterator[Problem]:
    """Yield what is wrong with the model of a map, as key paths of the map."""
    import pygltflib

    try:
        model = pygltflib.GLTF2.load(str(path)) if path.is_file() else None
    except (OSError, ValueError, KeyError, TypeError, struct.error) as error:
        yield "model", f"'{instrument.model}' cannot be read: {error}"
        return
    if model is None:
        yield "model", f"there is no file '{instrument.model}' beside the map or among the bundled models"
        return
    nodes = {node.name: node for node in model.nodes if node.name}
    if ROOT not in nodes:
        yield "model", f"'{instrument.model}' has no node named '{ROOT}'"
    for index, control in enumerate(instrument.controls):
        node = nodes.get(control.node)
        if node is None:
            yield f"controls[{index}].node", f"'{instrument.model}' has no node named '{control.node}'"
        elif (node.rotation or [0, 0, 0, 1])[3] not in (1, -1) or (node.scale or [1, 1, 1]) != [1, 1, 1] or node.matrix:
            yield f"controls[{index}].node", f"'{control.node}' must rest unturned and unscaled in '{instrument.model}'"
