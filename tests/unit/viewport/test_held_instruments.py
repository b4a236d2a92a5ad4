"""Moving parts of all instruments computed together, compared with the rig's result for each instrument."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from app.performance.bodies import model_of
from app.rig.instrument import node_transforms
from app.rig.model import InstrumentModel
from app.rig.quaternion import rotate, to_matrix
from instrument_maps.load import bundled_maps
from instrument_maps.model import InstrumentMap
from widgets.viewport.held_instruments import Instruments

Kit = tuple[InstrumentModel, InstrumentMap]


def kits() -> list[Kit]:
    """Every bundled instrument, and every linked part again where it needs all of its controls."""
    found: list[Kit] = []
    for instrument in bundled_maps().values():
        found.append((model_of(instrument), instrument))
        links = tuple(msgspec.structs.replace(link, when="all") for link in instrument.links)
        found.append((model_of(instrument), msgspec.structs.replace(instrument, links=links)))
    return found


def test_nodes_of_every_kind_are_where_the_map_moves_them() -> None:
    random, everything = np.random.default_rng(4), kits()
    instruments = Instruments(everything)
    held = np.empty((len(everything), 3, 4))
    turns = random.normal(size=(len(everything), 4))
    held[..., :3] = to_matrix(turns / np.linalg.norm(turns, axis=1, keepdims=True))
    held[..., 3] = random.normal(size=(len(everything), 3))
    worked = []
    for row, (_, instrument) in enumerate(everything):
        names = dict.fromkeys(name for part in instrument.moving_parts for name in part.controls)
        values = {name: float(random.random()) for name in names}
        instruments.work(row, values)
        worked.append(values)
    matrices = instruments.matrices(held)
    for row, (model, instrument) in enumerate(everything):
        controls = {name: np.array([value]) for name, value in worked[row].items()}
        places_m, rotations = node_transforms(model, instrument, controls, 1)
        for node, rest_m in enumerate(model.node_positions_m):
            for off_m in ([0.0, 0.0, 0.0], [0.01, 0.02, -0.03]):
                inside_m = rotate(rotations[0, node], np.array(off_m)) + places_m[0, node]
                requested_m = held[row, :, :3] @ inside_m + held[row, :, 3]
                found_m = matrices[row, node, :, :3] @ (rest_m + off_m) + matrices[row, node, :, 3]
                assert found_m == pytest.approx(requested_m, abs=1e-9), (instrument.id, model.node_names[node])


def test_a_control_that_is_not_named_is_at_rest() -> None:
    everything = kits()[:1]
    instruments = Instruments(everything)
    held = np.eye(3, 4)[None]
    at_rest = instruments.matrices(held)
    instruments.work(0, {control.name: 1.0 for control in everything[0][1].controls})
    assert np.abs(instruments.matrices(held) - at_rest).max() > 1e-3
    instruments.work(0, {})
    assert (instruments.matrices(held) == at_rest).all()


def test_there_may_be_no_one_and_nothing_that_moves() -> None:
    assert Instruments([]).matrices(np.zeros((0, 3, 4))).shape == (0, 0, 3, 4)
    recorder = bundled_maps()["recorder_soprano_C"]
    assert not recorder.moving_parts
    assert (Instruments([(model_of(recorder), recorder)]).matrices(np.eye(3, 4)[None]) == np.eye(3, 4)).all()
