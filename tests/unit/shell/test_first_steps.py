"""The tour's progress: actions that complete each stop, and the effect of its buttons."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QRect, QSize

from app.plan.by_hand.corrections import PinFingering, SetBreath
from app.shell.first_steps.bubble import place_beside
from app.shell.first_steps.progress import STOPS, TourFacts, TourProgress, facts_of
from app.shell.first_steps.tour import TARGETS
from tests.gui.conftest import quartet_project

PIN = PinFingering(note_id="n", label="13")
START = TourFacts(
    breath_ticks=frozenset((("a", 100), ("a", 900))), amplitudes={"a": 0.5}, fingerings=frozenset((("a", PIN),))
)
WORK = {
    "play": replace(START, is_playing=True),
    "fingering": replace(START, fingerings=START.fingerings | {("a", PinFingering(note_id="m", label="2"))}),
    "breath": replace(START, breaths=frozenset((("a", 60),))),
    "amplitude": replace(START, amplitudes={"a": 0.6}),
    "export": replace(START, is_exporting=True),
}


def test_every_stop_has_a_target() -> None:
    assert list(STOPS) == list(TARGETS) == ["play", "fingering", "breath", "amplitude", "export"]


def test_each_stop_is_done_by_its_own_work_alone() -> None:
    for number, stop in enumerate(STOPS):
        tour = TourProgress(START, number)
        assert tour.stop == stop
        for work, facts in WORK.items():
            assert tour.observe(facts).is_done == (work == stop), (stop, work)


def test_a_breath_that_is_deeper_or_new_has_not_moved() -> None:
    tour = TourProgress(START, list(STOPS).index("breath"))
    assert not tour.observe(replace(START, breaths=frozenset((("a", 100),)))).is_done
    project = quartet_project()
    player = project.players[0]
    note = project.part(player).notes[3]
    for added, expected in ((True, False), (False, True)):
        breath = SetBreath(note_id=note.id, start_offset_tick=-480, added=added)
        facts = facts_of(replace(project, corrections={player.id: (breath,)}), {}, is_playing=False, is_exporting=False)
        assert facts.breaths == ({(player.id, note.onset_tick - 480)} if expected else frozenset())


def test_plans_that_come_late_are_no_work() -> None:
    tour = TourProgress(replace(START, breath_ticks=frozenset()), list(STOPS).index("breath"))
    tour = tour.observe(START)
    assert not tour.is_done
    assert not tour.observe(replace(START, breaths=frozenset((("a", 900),)))).is_done
    assert tour.observe(WORK["breath"]).is_done


def test_what_is_undone_was_done_and_what_was_done_before_does_not_count() -> None:
    tour = TourProgress(START, 1).observe(WORK["fingering"])
    assert tour.is_done
    assert tour.observe(START).is_done
    again = TourProgress(WORK["fingering"], 1)
    assert not again.observe(WORK["fingering"]).is_done
    assert not again.observe(START).is_done


@given(st.lists(st.sampled_from(("next", "back", *WORK)), max_size=30))
def test_the_tour_stays_within_its_stops(steps: list[str]) -> None:
    tour, at = TourProgress(START), 0
    done: set[str] = set()
    for step in steps:
        if step in WORK:
            if tour.stop == step:
                done.add(step)
            tour = tour.observe(WORK[step])
        else:
            tour = tour.next(START) if step == "next" else tour.back(START)
            at = min(max(at + (1 if step == "next" else -1), 0), len(STOPS))
        assert tour.number == at
        assert tour.stop == (list(STOPS)[at] if at < len(STOPS) else "")
        assert tour.done == done
        assert tour.is_last == (tour.stop == "export")


BOX = st.builds(QRect, st.integers(0, 900), st.integers(0, 500), st.integers(10, 900), st.integers(10, 500))


@given(BOX, st.integers(50, 400), st.integers(50, 300))
def test_the_bubble_is_in_sight_and_covers_the_control_only_where_nothing_else_is_left(
    target: QRect, width: int, height: int
) -> None:
    room = QRect(0, 0, 1000, 600)
    target = target.intersected(room)
    bubble = QRect(place_beside(target, target, QSize(width, height), room), QSize(width, height))
    assert room.contains(bubble)
    fits = any(
        (
            target.bottom() + 1 + 10 + height <= 600,
            target.top() - 10 - height >= 0,
            target.right() + 1 + 10 + width <= 1000,
            target.left() - 10 - width >= 0,
        )
    )
    assert bubble.intersects(target) != fits
