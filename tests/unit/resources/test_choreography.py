"""The bundled choreography equals what the current reader makes of its captures, and contains no damage."""

from __future__ import annotations

import numpy as np
import pytest

from app.choreography.body_speeds import part_speeds
from app.choreography.damage import FASTEST_HIPS_RAD_S, FASTEST_RAD_S, damage
from app.choreography.model import ChoreographyModel
from app.choreography.model_file import read_model
from resources.build.build_choreography import PAIRS, TARGET, learned
from tests.support.dance_measures import SHARED


@pytest.fixture(scope="module")
def bundled() -> ChoreographyModel:
    return read_model(TARGET)


def test_no_motion_of_it_is_damaged(bundled: ChoreographyModel) -> None:
    assert [source.motion_name for source in bundled.sources] == list(PAIRS)
    for number, clip in enumerate(bundled.clips):
        found, speeds = damage(clip), part_speeds(clip)
        for one in bundled.segments:
            if one.clip == number:
                assert not any(place.start < one.end and one.start < place.stop for place in found)
                assert speeds[one.start : one.end, 0].max() < FASTEST_HIPS_RAD_S
                assert speeds[one.start : one.end, 1:-1].max() < FASTEST_RAD_S


@pytest.mark.slow
@pytest.mark.skipif(not SHARED.exists(), reason="no captures")
def test_it_is_what_the_reader_makes_of_its_captures(bundled: ChoreographyModel) -> None:
    again = learned(SHARED)
    assert again.segments == bundled.segments
    assert [source.offset_s for source in again.sources] == [source.offset_s for source in bundled.sources]
    for one, other in zip(again.clips, bundled.clips, strict=True):
        assert one.hips_m == pytest.approx(other.hips_m, abs=1e-4)
        assert one.rotations == pytest.approx(other.rotations, abs=1e-4)
        assert one.shape.offsets_m == pytest.approx(other.shape.offsets_m, abs=1e-6)
    for name in ("transition", "emission", "initial"):
        assert np.asarray(getattr(again, name)) == pytest.approx(getattr(bundled, name), abs=1e-6)
