"""Stored grips: bundled ones are up to date, and invalid files are refused."""

from __future__ import annotations

from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from app.formats.cache import CACHE_VARIABLE
from app.rig.characters.character_library import bundled_characters, character_named
from app.rig.grip.finger_stations import asked_together
from app.rig.grip.fitting import grip_files
from app.rig.grip.fitting.grip_files import bundled_path, digest_of, hold_for, read_hold, write_hold
from app.rig.grip.grip_pose import GripPose, Lips
from app.rig.grip.lips import fit_lips
from app.rig.instrument import load_instrument
from app.rig.people.bundled_people import bundled_people, bundled_person, finished_character, not_cast_for
from app.rig.people.person import originals
from instrument_maps.load import bundled_maps, model_path
from metadata.load import load_body

PAIRS = [(character, instrument) for character in bundled_characters() for instrument in bundled_maps()]
MADE = [
    (character, instrument)
    for character in [*originals(), *bundled_people()]
    for instrument in bundled_maps()
    if character not in bundled_characters() and bundled_path(character, instrument).is_file()
]
"""Pairs of character and instrument for the bodies that are made from another one."""


def inputs(character_id: str, instrument_id: str) -> tuple[Any, ...]:
    instrument = bundled_maps()[instrument_id]
    model = load_instrument(model_path(instrument), instrument)
    is_person = character_id in bundled_people()
    character = character_named(character_id) if is_person else finished_character(character_id, character_named)
    return character, model, instrument, load_body()


def lips_of(character_id: str, instrument_id: str) -> Lips:
    character, _, instrument, body = inputs(character_id, instrument_id)
    return fit_lips(character, instrument, body)


def same(first: Any, second: Any) -> bool:
    if isinstance(first, np.ndarray):
        return bool(np.array_equal(first, second))
    if is_dataclass(first):
        return all(same(getattr(first, field.name), getattr(second, field.name)) for field in fields(first))
    if isinstance(first, tuple):
        return len(first) == len(second) and all(map(same, first, second))
    if isinstance(first, dict):
        return first.keys() == second.keys() and all(same(first[key], second[key]) for key in first)
    return bool(first == second)


@pytest.fixture(scope="module")
def shipped() -> tuple[str, GripPose]:
    digest = digest_of(*inputs(*PAIRS[0]))
    hold = read_hold(bundled_path(*PAIRS[0]), digest, lips_of(*PAIRS[0]))
    assert hold is not None
    return digest, hold


def test_what_everyone_is_cast_for_is_shipped() -> None:
    for id in bundled_people():
        cast = set(bundled_maps()) - not_cast_for(id)
        own = [name for name in cast if bundled_path(id, name).is_file()]
        held = [name for name in cast if bundled_path(bundled_person(id).original, name).is_file()]
        assert cast == {*own, *held}, id
    assert MADE


@pytest.mark.parametrize("pair", PAIRS + MADE, ids="-".join)
def test_the_shipped_hold_is_up_to_date(pair: tuple[str, str]) -> None:
    assert read_hold(bundled_path(*pair), digest_of(*inputs(*pair)), lips_of(*pair)) is not None, (
        "run python -m resources.build.build_holds"
    )


def test_a_shipped_hold_that_is_out_of_date_is_logged(
    tmp_path: Path, shipped: tuple[str, GripPose], monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """It is fitted anew, which takes everyone a minute."""
    digest, hold = shipped
    fits: list[str] = []

    def fitted(*given: Any) -> GripPose:
        fits.append(given[2].id)
        return hold

    monkeypatch.setattr(grip_files, "bundled_path", lambda character, instrument: tmp_path / "shipped.json")
    monkeypatch.setattr(grip_files, "cache_folder", lambda kind: tmp_path / "cache")
    monkeypatch.setattr("app.rig.grip.fitting.fit.fit_hold", fitted)
    write_hold(tmp_path / "shipped.json", "older", hold)
    hold_for(*inputs(*PAIRS[0]))
    assert fits == [PAIRS[0][1]]
    assert ["shipped.json" in record.getMessage() for record in caplog.records] == [True]
    write_hold(tmp_path / "shipped.json", digest, hold)
    hold_for(*inputs(*PAIRS[0]))
    assert (len(fits), len(caplog.records)) == (1, 1)


def test_a_hold_comes_back_to_the_bit(tmp_path: Path, shipped: tuple[str, GripPose]) -> None:
    digest, hold = shipped
    write_hold(tmp_path / "hold.json", digest, hold)
    assert same(hold, read_hold(tmp_path / "hold.json", digest, hold.lips))


def test_a_damaged_or_foreign_file_is_none(tmp_path: Path, shipped: tuple[str, GripPose]) -> None:
    digest, hold = shipped
    path = tmp_path / "hold.json"
    assert read_hold(path, digest, hold.lips) is None
    write_hold(path, digest, hold)
    assert read_hold(path, "another", hold.lips) is None
    whole = path.read_bytes()
    for damaged in (b"", whole[: len(whole) // 2], whole.replace(b"[", b"{", 1), b"\xff" + whole, b"[]"):
        path.write_bytes(damaged)
        assert read_hold(path, digest, hold.lips) is None


def test_the_digest_knows_what_the_hands_touch() -> None:
    character, model, instrument, body = inputs(*PAIRS[0])
    digest = digest_of(character, model, instrument, body)
    contact = msgspec.structs.replace(instrument.contacts[0], position_m=(0.0, 0.001, 0.0))
    moved = msgspec.structs.replace(instrument, contacts=(contact, *instrument.contacts[1:]))
    assert digest_of(character, model, moved, body) != digest
    renamed = msgspec.structs.replace(instrument, short_name="other", fingerings=())
    assert digest_of(character, model, renamed, body) == digest
    # The face's shapes are calculated again each time.
    faces = {kind: msgspec.structs.replace(face, tight={}) for kind, face in body.embouchure.items()}
    assert digest_of(character, model, instrument, msgspec.structs.replace(body, embouchure=faces)) == digest
    between = msgspec.structs.replace(instrument.embouchure, lips_apart_m=0.014)
    assert digest_of(character, model, msgspec.structs.replace(instrument, embouchure=between), body) != digest
    lowered = msgspec.structs.replace(instrument.hold.lowered_seated, pitch_down_deg=80.0)
    resting = msgspec.structs.replace(instrument.hold, lowered_seated=lowered)
    assert digest_of(character, model, msgspec.structs.replace(instrument, hold=resting), body) == digest
    carriage = msgspec.structs.replace(instrument.hold.standing, pitch_down_deg=(0.0, 20.0, 25.0))
    carried = msgspec.structs.replace(instrument.hold, standing=carriage)
    assert digest_of(character, model, msgspec.structs.replace(instrument, hold=carried), body) != digest


def test_the_digest_has_hands_and_lips_and_nothing_of_looks() -> None:
    character, model, instrument, body = inputs("woman_adult", "flute")
    digest = digest_of(character, model, instrument, body)
    skin = next(mesh for mesh in character.meshes if mesh.name == "body")
    touched = {
        name: np.concatenate([mark.vertices for key, mark in character.landmarks.items() if key.startswith(name)])
        for name in ("left.hand", "right.hand", "lips.")
    }

    def with_skin(vertices: Any, shift_m: float) -> Any:
        positions = skin.positions_m.copy()
        positions[vertices] += np.float32(shift_m)
        changed = replace(skin, positions_m=positions, morphs=())
        others = tuple(mesh for mesh in character.meshes if mesh.name not in ("body", "hair", "eyes", "brows"))
        return replace(character, meshes=(changed, *others))

    everything = np.arange(len(skin.positions_m))
    looks = np.setdiff1d(everything, np.concatenate(list(touched.values())))
    assert len(looks) > 2000
    assert digest_of(with_skin(looks, 0.001), model, instrument, body) == digest
    for vertices in touched.values():
        assert digest_of(with_skin(vertices[:1], 0.001), model, instrument, body) != digest
    offsets = character.skeleton.offsets_m.copy()
    for name, other in (("leftEye", False), ("leftLowerLeg", False), ("leftIndexDistal", True), ("chest", True)):
        moved = offsets.copy()
        moved[character.skeleton.index(name)] += 0.001
        skeleton = replace(character.skeleton, offsets_m=moved)
        changed = digest_of(replace(character, skeleton=skeleton), model, instrument, body) != digest
        assert changed is other, name


def test_the_digest_knows_what_fingerings_ask_of_two_fingers_at_once() -> None:
    character, model, instrument, body = inputs("man_adult", "clarinet_Bb")
    digest = digest_of(character, model, instrument, body)
    first = tuple(one for one in instrument.fingerings if one.written_pitch != 60)
    fewer = msgspec.structs.replace(instrument, fingerings=first)
    assert asked_together(fewer) == asked_together(instrument)
    assert digest_of(character, model, fewer, body) == digest
    none = msgspec.structs.replace(instrument, fingerings=())
    assert digest_of(character, model, none, body) != digest


def test_a_new_pair_is_fitted_once(
    tmp_path: Path, shipped: tuple[str, GripPose], monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []

    def fit(*given: Any) -> GripPose:
        asked.append(given)
        return shipped[1]

    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))
    monkeypatch.setattr("app.rig.grip.fitting.fit.fit_hold", fit)
    monkeypatch.setattr(grip_files, "bundled_path", lambda *pair: tmp_path / "none.json")
    given = inputs(*PAIRS[0])
    assert same(hold_for(*given), shipped[1])
    assert same(hold_for(*given), shipped[1])
    assert len(asked) == 1


def test_a_cache_that_cannot_be_written_does_not_matter(
    tmp_path: Path, shipped: tuple[str, GripPose], monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_bytes(b"")
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "file"))
    monkeypatch.setattr("app.rig.grip.fitting.fit.fit_hold", lambda *given: shipped[1])
    monkeypatch.setattr(grip_files, "bundled_path", lambda *pair: tmp_path / "none.json")
    assert same(hold_for(*inputs(*PAIRS[0])), shipped[1])
