"""All readers are installed on the build machine; a missing one indicates a lost set-up step."""

from __future__ import annotations

import os

import pytest

from tests.support.readers import QUICK_BVH, QUICK_FBX, SLOW_BVH, SLOW_FBX, installed


@pytest.mark.skipif(os.environ.get("CI") != "true", reason="here the slow readers are optional")
@pytest.mark.parametrize("reader", sorted({*QUICK_FBX, *QUICK_BVH, *SLOW_FBX, *SLOW_BVH}))
def test_every_reader_is_set_up(reader: str) -> None:
    assert installed(reader)
