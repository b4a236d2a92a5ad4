"""The last messages summarised in few lines."""

from __future__ import annotations

from app.capture.message_log import MessageLog, MessageRow


def logged(*messages: tuple[int, ...]) -> tuple[MessageRow, ...]:
    log = MessageLog()
    for message in messages:
        log.add(bytes(message))
    return log.lines


def test_the_newest_is_first() -> None:
    assert logged((0x90, 60, 80), (0x80, 60, 64), (0x91, 62, 1)) == (
        MessageRow("note_on", 2, 62, 1),
        MessageRow("note_off", 1, 60, 64),
        MessageRow("note_on", 1, 60, 80),
    )


def test_a_note_of_no_velocity_ends() -> None:
    assert logged((0x90, 60, 0)) == (MessageRow("note_off", 1, 60, 0),)


def test_what_swells_takes_one_line_between_two_notes() -> None:
    breath = [((0xB0, 2, value), (0xD0, value), (0xE0, 0, value)) for value in range(10, 60)]
    messages = [message for group in breath for message in group]
    assert logged(*messages, (0x90, 60, 80), *messages) == (
        MessageRow("pitch_bend", 1, -1, (59 << 7) - 8192, 50),
        MessageRow("channel_pressure", 1, -1, 59, 50),
        MessageRow("control", 1, 2, 59, 50),
        MessageRow("note_on", 1, 60, 80),
        MessageRow("pitch_bend", 1, -1, (59 << 7) - 8192, 50),
        MessageRow("channel_pressure", 1, -1, 59, 50),
        MessageRow("control", 1, 2, 59, 50),
    )


def test_other_controllers_and_channels_are_other_lines() -> None:
    assert [line.number for line in logged((0xB0, 2, 1), (0xB0, 11, 1), (0xB0, 2, 5))] == [11, 2]
    assert [line.channel for line in logged((0xB0, 2, 1), (0xB3, 2, 1))] == [4, 1]


def test_so_many_are_kept() -> None:
    log = MessageLog(most=3)
    for pitch in range(60, 70):
        log.add(bytes((0x90, pitch, 1)))
    assert [line.number for line in log.lines] == [69, 68, 67]
    log.clear()
    assert log.lines == ()
