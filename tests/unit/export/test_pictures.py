"""PNG frames and contact sheets are written completely or not at all."""

from __future__ import annotations

import contextlib
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from app.errors import FileError
from app.export.pictures import GAP_PX, frames_into, sheet_into, sheet_size, usual_columns

SIZE = (8, 6)


def picture(shade: int, height: int = SIZE[1]) -> np.ndarray:
    return np.full((height, SIZE[0], 4), shade, np.uint8)


def shades(path: Path) -> np.ndarray:
    with Image.open(path) as image:
        return np.asarray(image)[..., 0]


def test_frames_have_their_numbers_in_the_performance(tmp_path: Path) -> None:
    folder = tmp_path / "new" / "frames"
    with frames_into(folder, 99_999, 2) as writer:
        writer.write(picture(10))
        writer.write(picture(20))
        assert list(folder.glob("*.png")) == []
    assert [path.name for path in sorted(folder.iterdir())] == ["frame_100000.png", "frame_99999.png"]
    assert np.unique(shades(folder / "frame_100000.png")) == [20]


def test_stopped_in_the_middle_nothing_has_changed(tmp_path: Path) -> None:
    for opened in (
        frames_into(tmp_path / "a" / "b", 0, 2),
        sheet_into(tmp_path / "s.png", SIZE, 1, [picture(0, 2)] * 2),
    ):
        with contextlib.suppress(KeyboardInterrupt), opened as writer:
            writer.write(picture(10))
            assert list(tmp_path.iterdir()) != []
            raise KeyboardInterrupt
    assert list(tmp_path.iterdir()) == []


def test_frames_are_not_mixed_with_others_and_other_files_stay(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    for shade in (10, 20):
        with frames_into(tmp_path, 5, 1) as writer:
            writer.write(picture(shade))
    with pytest.raises(FileError) as refused, frames_into(tmp_path, 6, 1):
        pass
    assert refused.value.message.id == "picture.other_frames"
    assert {path.name for path in tmp_path.iterdir()} == {"notes.txt", "frame_00005.png"}
    assert np.unique(shades(tmp_path / "frame_00005.png")) == [20]


def test_a_sheet_has_rows_of_pictures_with_what_stands_under_each(tmp_path: Path) -> None:
    path = tmp_path / "sheet.png"
    with sheet_into(path, SIZE, 2, [picture(100 + number, 2) for number in range(3)]) as writer:
        for number in range(3):
            writer.write(picture(10 * number))
    found = shades(path)
    assert found.shape[::-1] == sheet_size(SIZE, 2, 2, 3) == (GAP_PX + 2 * (8 + GAP_PX), GAP_PX + 2 * (8 + GAP_PX))
    for number, (row, column) in enumerate([(0, 0), (0, 1), (1, 0)]):
        top, left = GAP_PX + row * (8 + GAP_PX), GAP_PX + column * (8 + GAP_PX)
        assert np.unique(found[top : top + 6, left : left + 8]) == [10 * number]
        assert np.unique(found[top + 6 : top + 8, left : left + 8]) == [100 + number]


@pytest.mark.parametrize(
    ("count", "every_s", "columns"), [(54, "0.1", 10), (7, "0.1", 7), (9, "1/12", 9), (16, "1/24", 4), (17, "0.3", 5)]
)
def test_a_row_for_each_second_where_it_can_be(count: int, every_s: str, columns: int) -> None:
    assert usual_columns(count, Fraction(every_s)) == columns
