"""Players in thick clothes move as much as their arms have room for."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import pytest

from app.motion.contacts.arms_room import limited_to_arms
from app.performance.cast import performer_of
from app.performance.ensemble import Performance
from app.performance.motion import performance_curves
from app.plan.parameters import PlayerParameters
from app.rig.people.wardrobe import OutfitChoice
from tests.support.live import performance_of
from tests.unit.motion.contacts.test_arms_off_trunk import depth_mm
from tests.unit.motion.contacts.test_nods import in_uniform

MOST_MM = 10.0


def entering(character_id: str, outfit_id: str) -> float:
    """Return the depth in millimetres of the arms of a seated baritone saxophonist at an entry with the largest
    motion."""
    project = performance_of("sax_baritone_Eb", [(960, 480, 50), (1440, 480, 55), (1920, 900, 48)]).project
    (player,) = project.players
    parameters = msgspec.structs.replace(player.parameters, amplitude=1.0, posture="seated")
    dressed = msgspec.structs.replace(
        player, character_id=character_id, outfit=OutfitChoice(outfit_id), parameters=parameters
    )
    performance = Performance(replace(project, players=(dressed,)))
    performer = performer_of(performance, dressed)
    motion = performance_curves(performance, performer).motion(project.fps, 0, 300)
    return depth_mm(performer.dressed, motion)


@pytest.mark.parametrize(
    ("character_id", "outfit_id"),
    [("woman_adult", "jazz_suit"), ("cast_grace", "school_blazer")],
)
def test_arms_stay_out_of_jackets_in_the_largest_cue(character_id: str, outfit_id: str) -> None:
    """Both were 17 to 18 mm inside, since their wrists let elbows go no farther."""
    assert entering(character_id, outfit_id) <= MOST_MM


def test_amplitude_is_limited_only_where_a_wrist_stops_its_elbow() -> None:
    stopped, _ = in_uniform("cast_grace", "sax_baritone_Eb", "seated", "school_blazer")
    free, _ = in_uniform("cast_elena", "sax_baritone_Eb", "seated", "jazz_suit")
    undressed, _ = in_uniform("cast_grace", "sax_baritone_Eb", "seated", "")
    assert 0.5 <= stopped.most_amplitude < 0.8
    assert free.most_amplitude == undressed.most_amplitude == 1.0


def test_the_limited_amplitude_is_the_smaller_one() -> None:
    stopped, _ = in_uniform("cast_grace", "sax_baritone_Eb", "seated", "school_blazer")
    parameters, largest = PlayerParameters(), PlayerParameters(amplitude=1.0)
    assert limited_to_arms(largest, stopped).amplitude == stopped.most_amplitude
    assert limited_to_arms(parameters, stopped) is parameters
