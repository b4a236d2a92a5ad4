"""Parts of an evaluation: excerpts with playing, sounds of equal loudness, late fingers, keys and requests."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import msgspec
import numpy as np
import pytest

from app.audio.track import RATE_HZ
from app.errors import FileError, UsageError
from app.evaluation.excerpts import choose_excerpts
from app.evaluation.key import VERSION, EvaluationClip, EvaluationKey, encoded_key, read_key, write_key
from app.evaluation.loudness import TARGET_LUFS, equally_loud, loudness_lufs
from app.evaluation.request import EvaluationRequest, aspects_of, variants_of
from app.evaluation.variants import LATE_S, performance_of
from app.performance.cast import performers_of
from app.performance.motion import performance_curves
from tests.unit.viewport.poses import quartet


def test_excerpts_lie_apart_where_something_is_played() -> None:
    project = quartet()
    found = choose_excerpts(project, 3, 8.0)
    assert len(found) == 3
    assert all(one.duration_s == pytest.approx(8.0) for one in found)
    assert all(one.until_s <= other.from_s for one, other in pairwise(found))
    (first,) = choose_excerpts(project, 3, 8.0, (4.0, 14.0))
    assert first.from_s >= 4.0
    assert first.until_s <= 14.0
    (short,) = choose_excerpts(project, 2, 8.0, (5.0, 7.5))
    assert short.duration_s == pytest.approx(2.5)
    assert choose_excerpts(project, 1, 8.0, (-90.0, -80.0)) == ()


def sine(level_db: float, channels: int = 2) -> np.ndarray:
    wave = 10 ** (level_db / 20) * np.sin(2 * np.pi * 997 * np.arange(2 * RATE_HZ) / RATE_HZ)
    return np.stack([wave, wave if channels == 2 else 0 * wave], axis=1).astype(np.float32)


def test_loudness_is_that_of_bs_1770() -> None:
    # A sine of 997 Hz at full scale in one channel reads -3.01 LUFS.
    assert loudness_lufs(sine(0.0, 1)) == pytest.approx(-3.01, abs=0.05)
    assert loudness_lufs(sine(-20.0)) == pytest.approx(-20.0, abs=0.05)


def test_excerpts_are_equally_loud() -> None:
    loud, soft, silent = equally_loud([sine(-3.0), sine(-40.0), np.zeros((RATE_HZ, 2), np.float32)])
    assert loudness_lufs(loud) == pytest.approx(TARGET_LUFS, abs=0.05)
    assert loudness_lufs(soft) == pytest.approx(TARGET_LUFS, abs=0.05)
    assert not silent.any()
    click = np.zeros((RATE_HZ, 2), np.float32)
    click[100] = 0.5
    one, other = equally_loud([click, sine(-3.0)])
    assert np.abs(one).max() == pytest.approx(0.89, abs=0.01)
    assert loudness_lufs(one) == pytest.approx(loudness_lufs(other), abs=0.05)


def test_only_the_fingers_are_late() -> None:
    project = quartet()
    player, fps = project.players[0], Fraction(50)
    made = {}
    for variant in ("generated", "shifted"):
        performance = performance_of(project, variant)
        performer = performers_of(performance, (player,)).made[player.id]
        made[variant] = performance_curves(performance, performer).motion(fps, 150, 400)
    late = round(LATE_S * fps)
    moved = False
    for name, values in made["generated"].controls.items():
        assert np.allclose(made["shifted"].controls[name][late:], values[:-late], atol=1e-5)
        moved = moved or float(np.ptp(values)) > 0.5
    assert moved
    assert np.array_equal(made["generated"].hips_m, made["shifted"].hips_m)
    for name, values in made["generated"].morphs.items():
        assert np.array_equal(values, made["shifted"].morphs[name])
    # The fingers have gone with them: the poses differ where the controls do.
    assert not np.array_equal(made["generated"].rotations, made["shifted"].rotations)


def test_without_acting_the_amplitude_is_none() -> None:
    still = performance_of(quartet(), "still").project
    assert {player.parameters.amplitude for player in still.players} == {0.0}


def test_a_key_is_read_as_it_was_written(tmp_path: Path) -> None:
    clip = EvaluationClip("c01", "film", 1, -0.5, 7.5, "front", "Trumpet 1")
    key = EvaluationKey("suisou-evaluation", VERSION, "a1234567", "組曲", 7, (clip,))
    write_key(key, tmp_path / "key.json")
    assert read_key(tmp_path / "key.json") == key
    path = tmp_path / "other.json"
    path.write_bytes(encoded_key(msgspec.structs.replace(key, version=VERSION + 1)))
    with pytest.raises(FileError, match="newer_key"):
        read_key(path)
    for content in (
        b"{}",
        b"[",
        encoded_key(key).replace(b"film", b"movie"),
        encoded_key(key).replace(b"c01", b"../x"),
    ):
        path.write_bytes(content)
        with pytest.raises(FileError, match="not_a_key"):
            read_key(path)
    path.write_bytes(encoded_key(msgspec.structs.replace(key, clips=(clip, clip))))
    with pytest.raises(FileError, match="not_a_key"):
        read_key(path)


def test_what_there_is_no_video_of_is_not_compared() -> None:
    request = EvaluationRequest("made", "x")
    assert variants_of(request) == ("generated", "still", "shifted")
    assert variants_of(msgspec.structs.replace(request, film="a", variants=("film", "shifted"))) == ("film", "shifted")
    with pytest.raises(UsageError, match="needs_file"):
        variants_of(msgspec.structs.replace(request, variants=("film", "generated")))
    with pytest.raises(UsageError, match="too_few"):
        variants_of(msgspec.structs.replace(request, variants=("still",)))


def test_a_view_lets_judge_what_it_shows() -> None:
    assert aspects_of("ensemble", 4) == ("fingers_arms", "body", "mouth", "ensemble")
    assert "ensemble" not in aspects_of("ensemble", 1)
    assert aspects_of("mouth", 4) == ("mouth",)
    assert "ensemble" not in aspects_of("front", 4)
