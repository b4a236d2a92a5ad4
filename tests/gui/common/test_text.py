"""Messages in the editor contain the displayed names of notes and pitches."""

from __future__ import annotations

import re
from string import Formatter

import pytest

from app.editor.session import Session
from app.errors import Argument, Message
from app.messages import LANGUAGES, PITCHES, WORDINGS, text
from app.messages import TEXTS as TEXTS_BY_ID
from app.project.edit.notes import move
from app.score.model import Note
from app.shell.language import TEXTS
from tests.gui.conftest import planned_quartet
from tests.gui.japanese import speaking
from widgets.common.text import message_text

OUTSIDE = {"low": 54, "high": 82, "played_pitch": 54}


@pytest.fixture
def note(session: Session) -> Note:
    """A note of the first selected player that is not on the first beat."""
    assert session.player is not None
    notes = session.project.part(session.player).notes
    score = session.project.score
    return next(
        item for item in notes if item.onset_tick == score.metre_map.tick_of_bar(2) + 2 * score.ticks_per_quarter
    )


def test_a_note_is_reported_by_pitch_and_place(session: Session, note: Note) -> None:
    reported = message_text(Message("breath.inside_note", {"note": note.id}), session)
    assert "the sounding note F4 (2.2.000);" in reported, reported
    assert note.id not in reported


def test_pitches_are_named_as_the_user_prefers(session: Session, note: Note) -> None:
    message = Message("fingering.out_of_range", {"note": note.id, **OUTSIDE})
    assert "F4 (2.2.000) is outside this instrument's range (F♯3 to B♭5)" in message_text(message, session)
    session.pitch_display.set(middle_c_octave=3)
    assert "F3 (2.2.000) is outside this instrument's range (F♯2 to B♭4)" in message_text(message, session)
    session.pitch_display.set(middle_c_octave=4, written=True)
    # A trumpet in B flat reads a whole tone above what sounds.
    assert "G4 (2.2.000) is outside this instrument's range (A♭3 to C6)" in message_text(message, session)


def test_without_a_score_notes_keep_their_ids_and_pitches_are_named(note: Note) -> None:
    reported = text(Message("fingering.out_of_range", {"note": note.id, **OUTSIDE}))
    assert reported.startswith(f"note {note.id} is outside this instrument's range (F♯3 to B♭5)")


def test_a_note_of_another_player_is_found(session: Session) -> None:
    other = session.project.players[-1]
    note = session.project.part(other).notes[0]
    message = Message("note.overlaps", {"note": note.id, "other": "99:1", "overlap_ms": 5})
    reported = message_text(message, session)
    assert "(1." in reported
    # A deleted note is reported by the known data.
    assert "overlaps 99:1 by" in reported
    assert message_text(message, session, other.id) == reported


def test_both_notes_that_are_left_out_for_a_breath_are_reported_by_place(session: Session, note: Note) -> None:
    left_out = {"first_note": note.id, "after_note": note.id, "phrase_s": 20.0, "air_s": 18.0, "lung_s": 9.0}
    reported = message_text(Message("breath.catch_dropped_two", left_out), session)
    assert reported.count("(2.2.000)") == 2
    assert note.id not in reported


def test_an_edited_part_is_read_anew(session: Session, note: Note) -> None:
    assert session.player is not None
    message = Message("breath.inside_note", {"note": note.id})
    message_text(message, session)
    session.attempt(Message("edit.move_notes", {"count": 1, "of": ""}), lambda project: move(project, (note.id,), 0, 2))
    assert "note G4 (2.2.000)" in message_text(message, session)


def test_an_anchor_is_a_note_an_event_or_a_name(session: Session, note: Note) -> None:
    def reported(anchor: str) -> str:
        return message_text(Message("correction.orphaned", {"kind": "set_breath", "anchor": anchor}), session)

    assert reported(note.id).startswith("correction (breath) for F4 (2.2.000)")
    assert reported(f"breath:{note.id}").startswith("correction (breath) for Breath F4 (2.2.000)")
    assert reported("lower_instrument:@960").startswith("correction (breath) for Instrument lowered 1.2")
    assert reported("99:1").startswith("correction (breath) for a deleted note: no matching note")
    assert reported("added-3").startswith("correction (breath) for added-3")


@pytest.mark.usefixtures("japanese")
def test_in_japanese_no_english_word_is_left(session: Session, note: Note) -> None:
    reported = message_text(Message("breath.inside_note", {"note": note.id}), session)
    assert "F4 (2.2.000)" in reported
    for message in (
        Message("cue.start", {"leader_reason": "melody", "beat_s": 0.5}),
        Message("gesture.weight_shift", {"side": "left"}),
        Message("correction.orphaned", {"kind": "change_gesture", "anchor": f"sway:{note.id}"}),
        Message("pose.beyond_reach", {"target": "head", "angle": "roll", "asked_deg": 80.0, "most_deg": 30.0}),
    ):
        reported = message_text(message, session)
        assert not any("a" <= letter <= "z" for letter in reported), reported


@pytest.mark.usefixtures("japanese")
@pytest.mark.parametrize(
    ("id", "arguments", "reported"),
    [
        ("score.not_wind", {"instrument": "Double Bass"}, "コントラバスは管楽器ではありません"),
        ("score.percussion", {"instrument": "和太鼓"}, "和太鼓は打楽器です"),
        ("score.no_map", {"instrument": "Serpent"}, "セルパンの楽器マップがありません"),
        (
            "score.substituted",
            {"part": "Cor.", "instrument": "Soprano Cornet", "map": "cornet_Bb"},
            "ソプラノコルネットの",
        ),
        ("midi.name_says_other", {"part": "Bass", "said": "Tuba", "played": "Trombone"}, "トロンボーン"),
        (
            "character.hold_failed",
            {"character": "x", "instrument": "trumpet_Bb", "detail": "x"},
            "トランペット（B♭管）を",
        ),
    ],
)
def test_in_japanese_an_instrument_has_its_japanese_name(id: str, arguments: dict[str, str], reported: str) -> None:
    assert reported in message_text(Message(id, arguments))


def test_pitches_of_messages_are_their_fields() -> None:
    for id, names in PITCHES.items():
        assert all("{" + name + "}" in WORDINGS[id][0] for name in names), id


def test_an_instrument_is_reported_by_its_name() -> None:
    reported = message_text(Message("score.chosen_by_range", {"part": "Sopran", "map": "trumpet_Bb"}))
    assert "Trumpet in B♭" in reported
    assert "trumpet_Bb" not in reported


@pytest.mark.parametrize("work", sorted(id for id in WORDINGS if id.startswith("work.") and id != "work.cancelled"))
def test_cancelled_work_is_named(session: Session, work: str) -> None:
    arguments: dict[str, Argument] = dict.fromkeys(
        field for _, field, _, _ in Formatter().parse(WORDINGS[work][0]) if field
    )
    arguments |= {name: 4 if name == "players" else "Lutkin" for name in arguments}
    cancelled = message_text(Message("work.cancelled", {**arguments, "work": work}), session)
    assert cancelled == "cancelled: " + WORDINGS[work][0].rstrip("…").format(**arguments)


def test_no_reason_of_a_plan_holds_the_id_of_a_text(session: Session) -> None:
    ids = re.compile(r"\b[a-z_]+\.[a-z_]+\b")
    reasons: dict[str, tuple[Message, str]] = {}
    for plan in map(planned_quartet().plan, session.project.players):
        said = [event.reason for event in plan.fingerings] + [event.reason for event in plan.breaths]
        said += [event.reason for event in plan.cues] + [event.reason for event in plan.gestures]
        reasons |= {reason.id: (reason, plan.player_id) for reason in said}
    # Texts of breaths in rests contain a reason of their own.
    assert any("why" in reason.arguments for reason, _ in reasons.values())
    for code in LANGUAGES:
        with speaking(code):
            for reason, player_id in reasons.values():
                worded = message_text(reason, session, player_id)
                assert not set(ids.findall(worded)) & TEXTS.keys(), worded


@pytest.mark.parametrize("code", LANGUAGES)
@pytest.mark.parametrize("argument", sorted(TEXTS_BY_ID))
def test_a_text_that_a_message_names_is_worded(argument: str, code: str) -> None:
    """The window formats every kind of argument like the command line."""
    english = {id: {field for _, field, _, _ in Formatter().parse(said[0]) if field} for id, said in WORDINGS.items()}
    id = next(id for id, fields in english.items() if argument in fields)
    message = Message(id, {**dict.fromkeys(english[id], 1.0), argument: "work.stopped"})
    with speaking(code):
        assert text(Message("work.stopped"), code) in message_text(message)
