"""Time of judging the depth of hands, compared with the reference by groups on the same frames."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

import pytest

from app.contacts.depths import HandDepths
from tests.support.grouped_depths import GroupedDepths
from tests.unit.contacts.test_depths import played

SECONDS = 30.0


def cpu_s(work: Callable[[], object]) -> float:
    spent = []
    for _ in range(2):
        began_s = time.thread_time()
        work()
        spent.append(time.thread_time() - began_s)
    return min(spent)


@pytest.mark.bench
@pytest.mark.parametrize("instrument_id", ["trumpet_Bb", "sax_tenor_Bb"])
def test_depths_are_judged_faster_than_by_groups(instrument_id: str) -> None:
    scene = played(0, (0.0, 0.0, 0.0), SECONDS, instrument_id)
    ours_s = theirs_s = 0.0
    for skin in scene.hands:
        judge, slow = HandDepths(skin, scene.instrument.proxy), GroupedDepths(skin, scene.instrument.proxy)
        ours_s += cpu_s(lambda judge=judge: judge.depths_m(scene.world[:, judge.joints, :3], scene.morphs, scene.nodes))
        theirs_s += cpu_s(lambda slow=slow: slow.depths_m(scene.world, scene.morphs, scene.nodes))
    print(
        f"\n{instrument_id}: {len(scene.world)} frames judged in {ours_s:.2f} s of CPU; by groups {theirs_s:.2f} s, "
        f"{theirs_s / ours_s:.1f} times as long",
        file=sys.stderr,
    )
    assert theirs_s / ours_s >= 2.0
