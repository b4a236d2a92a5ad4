"""Straps in maps have their hooks on the instruments."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from instrument_maps.load import bundled_maps
from instrument_maps.size import scaled
from instrument_maps.validate import problems
from tests.support.models import bundled_instrument

STRAPPED = [id for id, one in bundled_maps().items() if one.hold.supports]


def test_heavy_instruments_hang_on_something() -> None:
    assert {"sax_alto_Eb", "sax_tenor_Bb", "sax_baritone_Eb", "bassoon", "ewi"} <= set(STRAPPED)
    assert bundled_maps()["clarinet_bass_Bb"].endpin is not None
    assert bundled_maps()["contrabassoon"].endpin is not None


@pytest.mark.parametrize("id", STRAPPED)
def test_a_strap_is_hooked_into_the_model(id: str) -> None:
    instrument = bundled_maps()[id]
    corners = np.concatenate(
        [mesh.positions_m[mesh.triangles].reshape(-1, 3) for mesh in bundled_instrument(instrument).meshes]
    )
    middles = corners.reshape(-1, 3, 3).mean(axis=1)
    for support in instrument.hold.supports:
        at_m = np.asarray(support.hook_m)
        near = min(np.linalg.norm(corners - at_m, axis=1).min(), np.linalg.norm(middles - at_m, axis=1).min())
        # The cap of a boot is 98 mm wide and has no vertex in its middle.
        assert near < (0.004 if support.kind == "neck_strap" else 0.032)


def test_a_smaller_instrument_has_its_hook_nearer() -> None:
    instrument = bundled_maps()["sax_alto_Eb"]
    (one,), (small,) = instrument.hold.supports, scaled(instrument, 0.5).hold.supports
    assert small.hook_m == pytest.approx([0.5 * value for value in one.hook_m])


def test_a_hook_far_away_and_no_posture_are_refused() -> None:
    instrument = bundled_maps()["sax_alto_Eb"]
    (support,) = instrument.hold.supports
    bad = msgspec.structs.replace(support, hook_m=(9.0, 0.0, 0.0), postures=())
    hold = msgspec.structs.replace(instrument.hold, supports=(bad,))
    found = {path for path, _ in problems(msgspec.structs.replace(instrument, hold=hold))}
    assert {"hold.supports[0].hook_m", "hold.supports[0].postures"} <= found
