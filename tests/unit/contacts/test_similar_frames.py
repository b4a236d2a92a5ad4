"""Order of frames in which those of a block are similar."""

from __future__ import annotations

import numpy as np
import pytest

from app.contacts.similar_frames import order_by_similarity


@pytest.mark.parametrize("blocks", [1, 2, 3, 7])
def test_poses_that_come_again_are_put_together(blocks: int) -> None:
    """Every frame occurs once, and frames with equal poses are adjacent regardless of their original order."""
    rng = np.random.default_rng(blocks)
    poses_m = rng.normal(size=(blocks, 12))
    which = rng.permutation(np.repeat(np.arange(blocks), 16))
    places_m = (poses_m[which] + rng.normal(size=(len(which), 12)) * 1e-4).astype(np.float32)
    order = order_by_similarity(places_m, 16, 4)
    assert sorted(order.tolist()) == list(range(len(which)))
    if blocks in {1, 2}:
        assert (np.ptp(which[order].reshape(blocks, 16), axis=1) == 0).all()


def test_halves_of_a_block_are_alike_too() -> None:
    places_m = np.tile(np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 0.3], [1.0, 0.3]], dtype=np.float32), (4, 1))
    blocks = places_m[order_by_similarity(places_m, 16, 4)].reshape(4, 4, 2)
    assert (np.ptp(blocks, axis=1) == 0.0).all()


def test_frames_that_are_equal_stay_as_they_are() -> None:
    assert order_by_similarity(np.zeros((16, 3), dtype=np.float32), 16, 4).tolist() == list(range(16))
