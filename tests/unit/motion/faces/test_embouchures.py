"""Every kind of embouchure on both bodies: place of the instrument on the skin, and distance between the lips."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache

import msgspec
import numpy as np
import pytest

from app.arrays import BoolArray, FloatArray
from app.motion.model import Motion
from app.plan.generate import MonophonicPart
from app.plan.model import PlayerPlan
from app.plan.parameters import PlayerParameters
from app.rig import quaternion
from app.rig.characters.character_library import bundled_characters, character_named
from app.rig.grip.fitting.grip_files import hold_for
from app.rig.grip.lips import fit_lips, lip_places
from app.rig.model import Character, Landmark
from app.rig.skeleton import forward
from app.rig.skinning import mesh_named, patch
from app.score.metre_map import Metre
from instrument_maps.hold import Carriage
from instrument_maps.load import bundled_maps
from instrument_maps.model import InstrumentMap
from instrument_maps.wind import Embouchure
from metadata.load import load_body
from tests.support.deformed import deform
from tests.support.models import bundled_instrument
from tests.support.performed import perform
from tests.support.plan import PlainClock, line_of, make_plans, piece_of, time_frame

KINDS = {
    # Kind, the object between the lips, and the downward angle of the instrument.
    "cup": ("cup", 0.0, 8.0),
    "clarinet": ("single_reed", 0.013, 38.0),
    "saxophone": ("single_reed", 0.012, 10.0),
    "oboe": ("double_reed", 0.002, 42.0),
    "bassoon": ("double_reed", 0.0025, 0.0),
    "flute": ("air_jet", 0.0, 0.0),
    "recorder": ("fipple", 0.013, 45.0),
}
FPS = Fraction(60)
BODY = load_body()
LIPS_M = 0.002
"""Greatest distance in metres between lips and mouthpiece."""


@dataclass(frozen=True)
class Played:
    character: Character
    instrument: InstrumentMap
    plan: PlayerPlan
    motion: Motion

    @property
    def times_s(self) -> FloatArray:
        return self.motion.first_frame_s + np.arange(self.motion.frames) / float(FPS)

    def spans(self, *spans: tuple[float, float]) -> BoolArray:
        inside = np.zeros(self.motion.frames, dtype=bool)
        for start_s, end_s in spans:
            inside |= (self.times_s >= start_s) & (self.times_s <= end_s)
        return inside

    @property
    def breathing(self) -> BoolArray:
        return self.spans(*((event.start_s - 0.01, event.end_s + 0.01) for event in self.plan.breaths))

    @property
    def sounding(self) -> BoolArray:
        return self.spans(*((event.start_s, event.end_s - 0.01) for event in self.plan.fingerings)) & ~self.breathing

    def skin_m(self, place: Landmark) -> FloatArray:
        """Mean position (F, 3) of the landmark's vertices in the instrument's frame, by linear blend skinning."""
        transforms = forward(self.character.skeleton, self.motion.rotations, self.motion.hips_m)
        part = patch(self.character, mesh_named(self.character, place.mesh), place.vertices)
        world_m = deform(part, transforms, self.motion.morphs).mean(axis=1)
        turn = quaternion.conjugate(self.motion.instrument_rotation.astype(np.float64))
        return quaternion.rotate(turn, world_m - self.motion.instrument_position_m)


def instrument_of(name: str) -> InstrumentMap:
    kind, apart_m, pitch_deg = KINDS[name]
    trumpet = bundled_maps()["trumpet_Bb"]
    carriage = Carriage((pitch_deg - 6.0, pitch_deg, pitch_deg + 6.0), (-5.0, 0.0, 5.0), (-5.0, 0.0, 5.0))
    return msgspec.structs.replace(
        trumpet,
        embouchure=Embouchure(kind, apart_m),
        hold=msgspec.structs.replace(trumpet.hold, standing=carriage, seated=carriage),
    )


@cache
def played(name: str, character_id: str) -> Played:
    """Low and high, soft and loud notes, rests with breaths, catch breaths, and a long rest."""
    character, trumpet, instrument = character_named(character_id), bundled_maps()["trumpet_Bb"], instrument_of(name)
    rows, tick = [], 0
    for index in range(40):
        length = (480, 240, 960)[index % 3]
        rows.append((tick, length, 54 + (index * 7) % 30, 30 + (index * 13) % 90))
        tick += length + (240 if index % 7 == 6 else 0) + (7680 if index == 20 else 0)
    line, clock = MonophonicPart("p", line_of(*rows), instrument, PlayerParameters(amplitude=0.8)), PlainClock()
    plan = make_plans(piece_of(clock, (Metre(0, 4, 4),)), (line,), time_frame((line,), clock))["p"]
    hold = hold_for(character, bundled_instrument(trumpet), trumpet, BODY)
    hold = replace(hold, lips=fit_lips(character, instrument, BODY))
    motion = perform(plan, line.parameters, instrument, character, hold, BODY, felt_beats=((0, 480),), fps=FPS)
    return Played(character, instrument, plan, motion)


CASES = [(name, character_id) for name in KINDS for character_id in bundled_characters()]


@pytest.mark.parametrize(("name", "character_id"), CASES)
def test_the_mouthpiece_is_at_the_lips_while_notes_sound(name: str, character_id: str) -> None:
    case = played(name, character_id)
    places = lip_places(case.character, case.instrument, BODY)
    assert case.sounding.sum() > 600
    gaps_m = np.linalg.norm(case.skin_m(places.contact), axis=1)
    assert gaps_m[case.sounding].max() < LIPS_M


@pytest.mark.parametrize(("name", "character_id"), CASES)
def test_the_lips_close_around_what_is_between_them_and_open_for_the_air(name: str, character_id: str) -> None:
    case = played(name, character_id)
    kind, apart_m, _ = KINDS[name]
    opening_m = BODY.embouchure[kind].opening_m
    if apart_m + opening_m == 0.0:
        return
    places = lip_places(case.character, case.instrument, BODY)
    height_m = case.skin_m(places.upper)[:, 1] - case.skin_m(places.lower)[:, 1]
    # The instrument turns a little against the head.
    assert np.abs(height_m[case.sounding] - apart_m - opening_m).max() < 1.2e-3
    at_the_lips = ~case.spans(
        *((gesture.start_s, gesture.end_s) for gesture in case.plan.gestures if gesture.kind == "lower_instrument")
    )
    # In a cue the instrument turns against the head.
    assert height_m[at_the_lips].min() > apart_m - 2e-3
    assert height_m[case.breathing & at_the_lips].max() > apart_m + opening_m + 1.5e-3


@pytest.mark.parametrize(("name", "character_id"), CASES)
def test_through_a_breath_it_stays_on_one_lip(name: str, character_id: str) -> None:
    case = played(name, character_id)
    offset_m = case.skin_m(lip_places(case.character, case.instrument, BODY).carrier)
    place_m = np.median(offset_m[case.sounding], axis=0)
    full = case.spans(*((event.start_s, event.end_s) for event in case.plan.breaths if event.kind == "breath"))
    lowered = case.spans(
        *((gesture.start_s, gesture.end_s) for gesture in case.plan.gestures if gesture.kind == "lower_instrument")
    )
    gaps_m = np.linalg.norm(offset_m - place_m, axis=1)[full & ~lowered]
    assert len(gaps_m) > 30
    assert gaps_m.max() < LIPS_M


@pytest.mark.parametrize(("name", "character_id"), [case for case in CASES if KINDS[case[0]][1] > 0.0])
def test_no_skin_is_deep_in_what_is_between_the_lips(name: str, character_id: str) -> None:
    # A bar as high as the lips are apart, with an oval section: 15 mm wide, a double reed 7 mm.
    case = played(name, character_id)
    kind, apart_m, _ = KINDS[name]
    half_m = 0.0035 if kind == "double_reed" else 0.0075
    mesh = mesh_named(case.character, case.character.landmarks["lips.contact"].mesh)
    outside = [place for place, material in enumerate(mesh.materials) if material.name in ("skin", "lips", "lip_edge")]
    own = np.unique(mesh.triangles[np.isin(mesh.triangle_materials, outside)])
    seam_m = mesh.positions_m[case.character.landmarks["lips.contact"].vertices].mean(axis=0)
    own = own[np.linalg.norm(mesh.positions_m[own] - seam_m, axis=1) < 0.035]
    frames = np.flatnonzero(case.sounding)[::60]
    transforms = forward(case.character.skeleton, case.motion.rotations[frames], case.motion.hips_m[frames])
    morphs = {morph: values[frames] for morph, values in case.motion.morphs.items()}
    world_m = (
        deform(patch(case.character, mesh, own), transforms, morphs) - case.motion.instrument_position_m[frames, None]
    )
    turn = quaternion.conjugate(case.motion.instrument_rotation[frames].astype(np.float64))
    x, y, z = np.moveaxis(quaternion.rotate(turn[:, None], world_m), -1, 0)
    section_m = 0.5 * apart_m * np.sqrt(np.maximum(1.0 - np.square(x / half_m), 0.0))
    depth_m = np.where((z > -0.003) & (z < 0.01), section_m - np.abs(y), 0.0)
    assert len(frames) > 10
    assert depth_m.max() < 0.003


@pytest.mark.parametrize(("name", "character_id"), [case for case in CASES if KINDS[case[0]][1] > 0.0])
def test_the_upper_lip_lies_on_the_mouthpiece_and_does_not_bulge(name: str, character_id: str) -> None:
    case = played(name, character_id)
    edge = lip_places(case.character, case.instrument, BODY).upper
    ahead_m = 0.0
    for morph in mesh_named(case.character, edge.mesh).morphs:
        if morph.name in case.motion.morphs:
            own = np.isin(morph.vertices, edge.vertices)
            weight = float(case.motion.morphs[morph.name][case.sounding].mean())
            ahead_m += weight * float(morph.deltas_m[own, 2].sum()) / len(edge.vertices)
    assert ahead_m < 0.006


@pytest.mark.parametrize(("name", "character_id"), CASES)
def test_no_lip_and_no_jaw_jumps(name: str, character_id: str) -> None:
    case = played(name, character_id)
    for morph, values in case.motion.morphs.items():
        if not morph.startswith("eye"):
            assert np.abs(np.diff(values)).max() * float(FPS) < 16.0, morph


@pytest.mark.parametrize("character_id", bundled_characters())
def test_kinds_look_different(character_id: str) -> None:
    means = {
        name: {morph: float(np.mean(values)) for morph, values in played(name, character_id).motion.morphs.items()}
        for name in KINDS
    }
    assert means["clarinet"]["mouthRollLower"] > 0.2 > means["cup"].get("mouthRollLower", 0.0)
    assert means["oboe"]["mouthRollUpper"] > means["flute"].get("mouthRollUpper", 0.0)
    assert means["clarinet"]["jawOpen"] > means["oboe"]["jawOpen"]
