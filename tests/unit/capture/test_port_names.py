"""Names of ports are independent of numbers added by the system, and unique."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.capture.port_names import matching, named

SYSTEMS = ("alsa", "jack", "core", "winmm")


def names(found: list[str], system: str) -> list[str]:
    return [port.name for port in named(found, system)]


def listed(devices: list[tuple[str, int]], system: str) -> list[str]:
    """Devices as listed by a system, each with its current number."""
    return [
        {
            "alsa": f"{name}:{name} MIDI 1 {number}:0",
            "jack": f"a2j:{name} [{number}] (capture): {name} MIDI 1",
            "core": name,
            "winmm": f"{f'{number}- ' if number > 20 else ''}{name} {index}",
        }[system]
        for index, (name, number) in enumerate(devices)
    ]


def test_alsa_numbers_change_and_names_do_not() -> None:
    before = named(["Midi Through:Midi Through Port-0 14:0", "EWI-USB:EWI-USB MIDI 1 20:0"], "alsa")
    after = named(["Midi Through:Midi Through Port-0 14:0", "EWI-USB:EWI-USB MIDI 1 24:0"], "alsa")
    assert [port.name for port in before] == [port.name for port in after] == ["Midi Through Port-0", "EWI-USB MIDI 1"]
    assert before[0].identity == after[0].identity
    assert before[1].identity != after[1].identity, "it went and came back"
    assert names(["Synth:out 130:1"], "alsa") == ["Synth:out"]


def test_windows_numbers_change_and_names_do_not() -> None:
    assert names(["EWI5000 0", "Digital Piano 1"], "winmm") == ["EWI5000", "Digital Piano"]
    assert names(["2- EWI5000 0", "MIDIIN2 (3- Piano) 1"], "winmm") == ["EWI5000", "MIDIIN2 (Piano)"]
    before, after = named(["Piano 0", "EWI5000 1"], "winmm")[1], named(["EWI5000 0"], "winmm")[0]
    assert (before.name, before.identity) == (after.name, after.identity), "the piano was unplugged, not the EWI"


@pytest.mark.parametrize(
    "full",
    [
        "a2j:EWI5000 [20] (capture): EWI5000 MIDI 1",
        "Midi-Bridge:EWI5000:(capture_0) EWI5000 MIDI 1",
        "Midi-Bridge:EWI5000:(capture_0) EWI5000 MIDI 1-57",
        "Midi-Bridge:EWI5000 MIDI 1 (capture)",
    ],
)
def test_a_device_has_the_same_name_over_jack_as_over_alsa(full: str) -> None:
    assert names([full], "jack") == names(["EWI5000:EWI5000 MIDI 1 20:0"], "alsa") == ["EWI5000 MIDI 1"]


@pytest.mark.parametrize(
    ("system", "found"),
    [
        ("alsa", ["EWI-USB:EWI-USB MIDI 1 20:0", "EWI-USB:EWI-USB MIDI 1 24:0"]),
        ("winmm", ["EWI-USB MIDI 1 0", "EWI-USB MIDI 1 1"]),
        ("winmm", ["EWI-USB MIDI 1 0", "2- EWI-USB MIDI 1 1"]),
        ("core", ["EWI-USB MIDI 1", "EWI-USB MIDI 1"]),
    ],
)
def test_two_of_a_kind_are_distinguished(system: str, found: list[str]) -> None:
    ports = named(found, system)
    assert [port.name for port in ports] == ["EWI-USB MIDI 1", "EWI-USB MIDI 1 (2)"]
    assert [port.index for port in ports] == [0, 1]


@pytest.mark.parametrize("system", ["alsa", "jack", "winmm"])
def test_of_two_of_a_kind_the_one_that_stays_keeps_its_name(system: str) -> None:
    known: dict[str, str] = {}

    def seen(*numbers: int) -> list[str]:
        ports = named(listed([("EWI", number) for number in numbers], system), system, known)
        known.update({port.identity: port.name for port in ports})
        return [port.name for port in ports]

    first, second = seen(21, 24)
    assert seen(24) == [second], "the first was unplugged"
    assert seen(24, 28) == [second, first], "and came back elsewhere"
    assert seen(28) == [first]
    assert seen(20, 28) == [second, first]
    assert seen(20, 24, 28) == [second, f"{first} (3)", first]


def test_our_own_ports_are_no_devices() -> None:
    ports = named(["Suisou:in", "Suisou-01:out", "EWI:EWI USB", "Suisou Ensemble:x"], "jack")
    assert [(port.name, port.index) for port in ports] == [("EWI:EWI USB", 2), ("Suisou Ensemble:x", 3)]


def test_a_nameless_port_has_a_name() -> None:
    assert names(["", ""], "core") == ["MIDI", "MIDI (2)"]


@pytest.mark.parametrize(
    ("requested", "found"),
    [
        ("EWI5000 MIDI 1", ["EWI5000 MIDI 1"]),
        ("EWI5000 MIDI 1 (2)", ["EWI5000 MIDI 1 (2)"]),
        ("EWI5000:EWI5000 MIDI 1 20:0", ["EWI5000 MIDI 1", "EWI5000 MIDI 1 (2)"]),
        ("a2j:WARBL [33] (capture): WARBL", ["WARBL"]),
        ("3- WARBL 4", ["WARBL"]),
        ("WARBL (2)", ["WARBL"]),
        ("warbl", ["WARBL"]),
        ("EWI:EWI USB 128:0", ["EWI:EWI USB"]),
        ("EWI", []),
        ("Piano", []),
    ],
)
def test_a_device_is_found_by_what_any_system_calls_it(requested: str, found: list[str]) -> None:
    ports = ["EWI5000 MIDI 1", "EWI5000 MIDI 1 (2)", "WARBL", "Midi Through Port-0", "EWI:EWI USB"]
    assert list(matching(requested, ports)) == found


def test_a_part_of_the_name_is_enough_where_that_is_asked_for() -> None:
    assert matching("ewi", ["Midi Through Port-0", "EWI5000 MIDI 1"], partly=True) == ("EWI5000 MIDI 1",)
    assert matching("MIDI", ["MIDI", "EWI5000 MIDI 1"], partly=True) == ("MIDI",)


KINDS = st.sampled_from(("EWI5000", "WARBL", "Digital Piano", "ウインド"))


@given(
    st.sampled_from(SYSTEMS),
    st.lists(st.lists(st.tuples(KINDS, st.integers(16, 40)), max_size=5, unique_by=lambda device: device[1])),
)
def test_names_are_the_device_s_own_whatever_is_connected(system: str, moments: list[list[tuple[str, int]]]) -> None:
    known: dict[str, str] = {}
    before: dict[str, str] = {}
    for devices in moments:
        ports = named(listed(devices, system), system, known)
        known |= {port.identity: port.name for port in ports}
        assert [port.index for port in ports] == list(range(len(devices)))
        assert len({port.name for port in ports}) == len({port.identity for port in ports}) == len(devices)
        now = {port.identity: port.name for port in ports}
        assert all(now[identity] == name for identity, name in before.items() if identity in now)
        before = now
        for (kind, _), port in zip(devices, ports, strict=True):
            assert port.name.startswith(kind)
            found = matching(listed([(kind, 99)], system)[0], [port.name for port in ports])
            assert found
            assert all(name.startswith(kind) for name in found)
