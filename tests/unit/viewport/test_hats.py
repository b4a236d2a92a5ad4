"""The stage draws no hat where it would go through an instrument of the musician."""

from __future__ import annotations

from dataclasses import replace

import msgspec

from app.project.model import Project
from app.rig.people.wardrobe import OutfitChoice
from tests.support.doubled import flutist
from widgets.viewport.figures import cast_key, load, same_figures


def with_instruments(*instruments: str) -> Project:
    """A musician of two instruments, and another player of the same body, in marching uniforms."""
    project, worn = flutist(), OutfitChoice("marching")
    players = tuple(
        msgspec.structs.replace(player, instrument_id=instrument, character_id="woman_adult", outfit=worn)
        for player, instrument in zip(project.players, instruments, strict=True)
    )
    return replace(project, players=players)


def test_the_body_wears_the_hat_only_if_no_instrument_of_the_musician_is_in_the_way() -> None:
    before, after = (
        with_instruments("flute", "trumpet_Bb", "flute"),
        with_instruments("flute", "sousaphone_BBb", "flute"),
    )
    assert not same_figures(cast_key(before), cast_key(after))
    worn = [
        [any(mesh.name == "shako" for mesh in one.assets.character.meshes) for one in found.stage.members]
        for found in (load(project, None, lambda share: None, lambda: False) for project in (before, after))
    ]
    assert worn == [[True, True, True], [False, False, True]]
