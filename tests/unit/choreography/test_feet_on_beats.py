"""Feet that touch the floor a moment before they stand are planted from their touch on, and touch it on beats."""

from __future__ import annotations

import numpy as np

from app.choreography.accent_grid import grid_of
from app.choreography.contacts import foot_contacts
from app.choreography.feet_on_beats import feet_on_beats, from_touches
from app.choreography.foot_plants import FootPlant
from app.choreography.footfalls import touch_leads
from tests.support.dances import beaten, stepping

FPS = 60.0
PLACE_M = (0.0, 0.0, 0.0)


def test_stands_begin_on_beats_where_their_feet_touch_the_floor_earlier() -> None:
    """Joins of motions begin stands up to 0.1 s after the feet touch the floor."""
    clip = stepping(16)
    contacts = foot_contacts(clip)
    late = contacts.copy()
    for by in range(1, 5):
        late[by:] &= contacts[:-by]
    late[0] = True
    feet = feet_on_beats(clip, late, np.zeros((len(clip), 3)), -0.1, grid_of(beaten(18)), 0.3)
    starts = np.array([stand.start for stand in feet.falls.standing])
    landed = starts > 0
    assert landed.sum() >= 12
    assert np.abs(touch_leads(feet.clip, feet.falls.standing)[landed]).max() <= 1.0
    off_s = starts[landed] / FPS - 0.1
    assert np.abs(off_s - 0.5 * np.rint(off_s / 0.5)).max() <= 1.5 / FPS


def test_a_stand_begins_earlier_by_at_most_half_of_its_step() -> None:
    standing = (FootPlant(0, 0, 20, PLACE_M), FootPlant(1, 22, 60, PLACE_M), FootPlant(0, 26, 60, PLACE_M))
    begun, rest = from_touches(standing, np.array([0.0, 5.0, 5.0]))
    assert [(stand.foot, stand.start, stand.stop) for stand in begun] == [(0, 0, 20), (1, 17, 60), (0, 23, 60)]
    assert rest.tolist() == [0.0, 0.0, 2.0]
