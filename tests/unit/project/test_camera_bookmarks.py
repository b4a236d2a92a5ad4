"""Camera bookmarks: edits, and valid stored values."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from msgspec.structs import replace

from app.errors import FileError, UsageError
from app.project.camera_bookmarks import MOST_CAMERAS, CameraBookmark
from app.project.check import require_sound
from app.project.edit.camera_bookmarks import keep_camera, remove_camera, rename_camera
from app.project.storage import decode, encode
from tests.unit.project.pieces import small_project

PATH = Path("/music/piece.suisou")


def camera(name: str, distance_m: float = 2.0) -> CameraBookmark:
    return CameraBookmark(name, "front", "", (0.0, 1.0, 0.0), 0.25, 0.1, distance_m, 32.0)


def names(*cameras: CameraBookmark) -> list[str]:
    return [one.name for one in cameras]


def test_a_camera_of_the_same_name_takes_the_place_of_the_one_before() -> None:
    project = small_project()
    for one in (camera("Left"), camera("Wide"), camera("Hands"), camera("wide", 5.0)):
        project = keep_camera(project, one)
    assert names(*project.cameras) == ["Left", "wide", "Hands"]
    assert project.cameras[1].distance_m == 5.0
    assert names(*remove_camera(project, "Left").cameras) == ["wide", "Hands"]


def test_names_are_cleaned_and_stay_apart() -> None:
    project = keep_camera(keep_camera(small_project(), camera(" Left\n side ")), camera("Wide"))
    assert names(*project.cameras) == ["Left side", "Wide"]
    assert names(*rename_camera(project, "Wide", "WIDE").cameras) == ["Left side", "WIDE"]
    for name, message in (("left SIDE", "camera.name_taken"), (" \t", "camera.no_name")):
        with pytest.raises(UsageError) as raised:
            rename_camera(project, "Wide", name)
        assert raised.value.message.id == message


def test_more_than_a_menu_can_show_are_refused() -> None:
    project = small_project()
    for number in range(MOST_CAMERAS):
        project = keep_camera(project, camera(f"Camera {number}"))
    require_sound(project)
    with pytest.raises(UsageError):
        require_sound(keep_camera(project, camera("one more")))


def test_a_file_gives_cameras_back_and_has_none_where_there_are_none() -> None:
    project = small_project()
    assert b"cameras" not in encode(project, PATH)
    kept = keep_camera(
        project, replace(camera("左の手"), view="hands", player_id="1.1", shift_m=(0.1 + 0.2, 0.0, -1e-3))
    )
    assert decode(encode(kept, PATH), PATH).cameras == kept.cameras


@pytest.mark.parametrize(
    ("field", "value"),
    [
        *(("distance_m", value) for value in (0.0, -1.0, 1e300, "near")),
        *(("view", "moon"), ("target_m", [0.0, 1e9, 0.0]), ("target_m", [0.0]), ("fov_deg", 0.0)),
        *(("name", ""), ("lens", 50.0)),
    ],
)
def test_a_file_with_an_impossible_camera_is_refused_by_name(field: str, value: Any) -> None:
    raw = json.loads(encode(keep_camera(small_project(), camera("Left")), PATH))
    raw["cameras"][0][field] = value
    with pytest.raises(FileError) as raised:
        decode(json.dumps(raw).encode(), PATH)
    assert "cameras" in str(raised.value.message.arguments["place"])
