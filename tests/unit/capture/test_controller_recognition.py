"""The breath controller is recognised from blowing."""

from __future__ import annotations

import math
import random

import pytest

from app.capture.controller_recognition import Learned, breath_value, learned_bite, recognised_controller
from metadata.load import load_controllers
from metadata.model import BreathSource
from tests.support.wind_player import phrase

STATUS: dict[str, tuple[int, ...]] = {
    "cc2": (0xB0, 2),
    "cc7": (0xB0, 7),
    "cc11": (0xB0, 11),
    "channel_pressure": (0xD0,),
}


def blown(source: str, channel: int = 1, loudest: int = 90, count: int = 120) -> list[tuple[int, bytes]]:
    first, *rest = STATUS[source]
    return [
        (index * 20_000_000, bytes([first | channel - 1, *rest, round(loudest * abs(math.sin(index / 20)))]))
        for index in range(count)
    ]


@pytest.mark.parametrize("source", list(STATUS))
@pytest.mark.parametrize("channel", [1, 7, 16])
def test_every_source_on_every_channel(source: BreathSource, channel: int) -> None:
    found = recognised_controller(blown(source, channel))
    assert found == Learned(source, channel)
    values = [breath_value(message, source) for _, message in blown(source, channel)]
    assert max(value for value in values if value is not None) == 90


def test_a_volume_that_is_set_and_notes_are_no_breath() -> None:
    still = [(0, bytes([0xB0, 7, 100])), (1, bytes([0xB0, 7, 127]))]
    switch = [(index, bytes([0xB1, 11, 127 * (index % 2)])) for index in range(200)]
    by_chance = random.Random(1)
    notes = [(index, bytes([0x90, 60, by_chance.randrange(128)])) for index in range(200)]
    bends = [(index, bytes([0xE0, 0, index % 128])) for index in range(400)]
    others = still + switch + notes + bends
    assert recognised_controller(others) is None
    assert recognised_controller([*others, *blown("cc11", 3)]) == Learned("cc11", 3)


def test_of_one_breath_sent_twice_the_trusted_one_is_taken() -> None:
    twice = [event for pair in zip(blown("channel_pressure"), blown("cc7"), strict=True) for event in pair]
    assert recognised_controller(twice, ("cc7", "channel_pressure")) == Learned("cc7", 1)
    assert recognised_controller(twice, ("channel_pressure", "cc7")) == Learned("channel_pressure", 1)
    louder = blown("cc2", loudest=30) + blown("cc11", loudest=120)
    assert recognised_controller(louder, ("cc2", "cc11")) == Learned("cc11", 1)


def test_nothing_blown_is_nothing_learned() -> None:
    assert recognised_controller([]) is None
    assert recognised_controller(blown("cc2", loudest=8)) is None
    assert recognised_controller([(0, b"\xb0\x02\x40")]) is None


@pytest.mark.parametrize("name", load_controllers())
def test_the_synthetic_player_breathes_where_an_ewi_does(name: str) -> None:
    events = [(round(at_s * 1e9), message) for at_s, message in phrase([60, 62, 64, 65], ghosts=2)]
    assert recognised_controller(events, load_controllers()[name].breath) == Learned("cc2", 1)


def bends(channel: int = 1) -> list[tuple[int, bytes]]:
    return [(step, bytes((0xDF + channel, 0, 64 + 8 * (step % 7)))) for step in range(40)]


@pytest.mark.parametrize(
    ("bitten", "blown", "found"),
    [
        (bends(), [], "pitch_bend"),
        ([(step, bytes((0xB0, 1, 9 * (step % 8)))) for step in range(40)], [], "cc1"),
        ([(step, bytes((0xD0, 9 * (step % 8)))) for step in range(40)], [], "channel_pressure"),
        # It moved together with the breath before, so it is the breath sent a second time.
        ([(step, bytes((0xD0, 9 * (step % 8)))) for step in range(40)],
         [(step, bytes((0xD0, 3 * step))) for step in range(40)], None),
        (bends(channel=2), [], None),
        ([(step, bytes((0xE0, 0, 64 + step % 3))) for step in range(40)], [], None),
        ([(step, bytes((0xB0, 7, 9 * (step % 8)))) for step in range(40)], [], None),
        ([], [], None),
    ],
)  # fmt: skip
def test_the_bite_is_what_moves_while_one_bites(
    bitten: list[tuple[int, bytes]], blown: list[tuple[int, bytes]], found: str | None
) -> None:
    assert learned_bite(bitten, blown, Learned("cc2", 1)) == found
