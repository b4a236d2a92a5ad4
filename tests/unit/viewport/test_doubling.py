"""A musician with several instruments has one body on the stage, selected for any of the instruments."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import numpy as np
import pytest

from app.performance.bodies import hold_of
from app.project.casting import StagePosition
from app.project.edit import players as edit
from app.project.model import Project
from app.project.performers import Player
from app.rig.grip.grip_pose import GripPose
from instrument_maps.model import InstrumentMap
from tests.support.doubled import flutist
from widgets.viewport import figures
from widgets.viewport.cast import Stage
from widgets.viewport.figures import DrawableFigures, cast_key, load, moved, same_figures
from widgets.viewport.limb_capsules import HELD, LimbCapsules
from widgets.viewport.shapes import crowd_of


def loaded(project: Project) -> DrawableFigures:
    return load(project, None, lambda share: None, lambda: False)


def test_the_body_is_drawn_once_and_both_instruments_have_a_stand() -> None:
    project = flutist()
    found = loaded(project)
    stage = found.stage
    assert [member.has_body for member in stage.members] == [True, False, True]
    flute, piccolo, oboe = stage.members
    assert oboe.stand_m is None
    assert flute.stand_m is not None
    assert piccolo.stand_m is not None
    assert np.linalg.norm((flute.stand_m - piccolo.stand_m)[[0, 2]]) > 0.08
    # A stand ends on the floor: its bone moves (0, -1, 0), the foot of a rod of height one, there.
    for row in (0, 1):
        bone = stage.bones[row, stage.stand_bone].astype(float)
        assert abs((bone[:, :3] @ [0.0, -1.0, 0.0] + bone[:, 3])[1]) < 1e-6
    bodies = [len(found.shapes.characters[member.assets.character.id][-1].shape) for member in (flute, oboe)]
    held = [len(found.shapes.instruments[member.assets.map.id][-1].shape) for member in stage.members]
    assert len(crowd_of(stage, found.shapes).shape) == sum(bodies) + sum(held) + 2 * len(found.shapes.stand.shape)


def test_a_click_on_the_body_finds_the_musician_and_the_shadow_of_the_other_is_its_own() -> None:
    stage: Stage = loaded(flutist()).stage
    stage.shown[:] = True
    capsules = LimbCapsules(stage).capsules()
    assert (capsules[1, :HELD, :, 3] == 0.0).all()
    assert (capsules[0, :HELD, :, 3] > 0.0).all()
    assert (capsules[1, HELD, :, 3] > 0.0).all()


def test_separating_asks_for_another_stage_and_moving_does_not() -> None:
    project = flutist()
    piccolo = project.players[1]
    apart = edit.separate(project, (piccolo.id,))
    assert not same_figures(cast_key(project), cast_key(apart))
    before = loaded(project)
    after = edit.place(project, {piccolo.id: StagePosition(1.0, 1.0, 0.0)})
    assert same_figures(cast_key(project), cast_key(after))
    stage = moved(after, before).stage
    assert [member.has_body for member in stage.members] == [True, False, True]
    assert np.allclose([member.world_from_player[0, 3] for member in stage.members[:2]], 1.0)


def test_figures_whose_instruments_hang_on_nothing_wait_for_no_hold(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = list[str]()

    def noted(player: Player, instrument: InstrumentMap) -> GripPose:
        asked.append(instrument.id)
        return hold_of(player, instrument)

    monkeypatch.setattr(figures, "hold_of", noted)
    project = flutist()
    loaded(project)
    assert not asked
    bassoonist = msgspec.structs.replace(project.players[2], instrument_id="bassoon")
    loaded(replace(project, players=(bassoonist,)))
    assert asked == ["bassoon"]
