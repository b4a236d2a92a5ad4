"""Small projects for tests, with examples of everything a project can contain."""

from __future__ import annotations

from fractions import Fraction

from msgspec.structs import replace

from app.errors import Message
from app.plan.by_hand.additive_curve import AdditiveCurve, CurveKey, Tangent
from app.plan.by_hand.corrections import (
    AddExpression,
    AddGesture,
    ChangeExpression,
    ChangeGesture,
    PinFingering,
    PlayStyle,
    PoseCorrection,
    RemoveEvent,
    SetBreath,
    SetCue,
    SetEmbouchure,
    Vary,
)
from app.plan.by_hand.mark_corrections import RemoveMark, SetMark
from app.plan.parameters import PlayerParameters
from app.project.casting import ConductorPlace, StagePosition, stage_arc
from app.project.dance_corrections import ForbidState, PinState, UseSegment
from app.project.import_decisions import ImportDecisions, ReadTiming, RowDecision, TrackMark
from app.project.model import CompSpan, PlayerTakes, Project
from app.project.performers import Dancer, Player
from app.project.recording import AudioTrack, BeatPin, Doubt
from app.project.video import VideoTrack
from app.rig.people.wardrobe import OutfitChoice
from app.score.marks import Mark
from app.score.metre_map import Metre
from app.score.model import ControllerCurve, Marker, Note, Part, PercussionHit, Score, UnplayedPart
from app.score.take import Cleaning, ControllerMapping, Take
from app.score.tempo import TempoChange, TempoMap
from metadata.acting import AMOUNTS
from metadata.model import Expression

ANGRY = Expression("angry", "brows down", {"browDownLeft": 0.8, "browDownRight": 0.8}, True, 0.2, 0.3)


def small_project() -> Project:
    """A trumpet and a trombone, four quarters each."""
    parts = tuple(
        Part(
            id=f"{number}.1.1",
            name=name,
            track=number,
            voice=0,
            channel=number,
            program=program,
            instrument=name,
            map_id=map_id,
            notes=tuple(Note(f"{number}:{index + 1}", index * 480, 480, base + index, 80) for index in range(4)),
        )
        for number, name, program, map_id, base in (
            (1, "trumpet", 56, "trumpet_Bb", 60),
            (2, "trombone", 57, "trombone_tenor_F_attachment", 48),
        )
    )
    players = tuple(
        Player(part.id, part.name, part.id, part.map_id, "man_adult", PlayerParameters(amplitude=0.4), place)
        for part, place in zip(parts, stage_arc(2), strict=True)
    )
    return Project(Score("Small piece", 480, TempoMap(480), parts=parts), players)


def full_project(folder: str = "/music") -> Project:
    """Project in which every field of every kind of value has another value than its default."""
    small = small_project()
    score = small.score
    curve = ControllerCurve("breath", (0, 240, 480), (0.0, 0.1 + 0.2, 1.0))
    first = Part(
        **{
            **{f: getattr(score.parts[0], f) for f in Part.__struct_fields__},
            "curves": (curve,),
            "transposed_semitones": -2,
            "marks": (
                Mark("slur", "1:1", "1:3"),
                Mark("dynamic", tick=480, text="sfz"),
                Mark("crescendo", "", "", 0, 480),
            ),
            "source": "score",
        }
    )
    full_score = Score(
        title="全部 “everything” \n\t\u2028",
        ticks_per_quarter=480,
        tempo_map=TempoMap(480, (TempoChange(0, 500_000.0), TempoChange(960, 1e6 / 3.0))),
        metres=(Metre(0, 4, 4), Metre(240, 4, 4), Metre(2160, 3, 8)),
        pickup_ticks=240,
        parts=(first, score.parts[1]),
        unplayed=(
            UnplayedPart("../../etc/passwd", Message("score.percussion", {"instrument": "drums"}), 3, 960, ((0, 960),)),
        ),
        warnings=(Message("midi.zero_length_notes", {"track": 1, "count": 2}),),
        markers=(Marker(0, "はじめ"), Marker(960, "A"), Marker(960, "Più mosso"), Marker(9600, "Coda")),
        percussion=(PercussionHit(0, 36, 100), PercussionHit(0, 42, 60), PercussionHit(480, 22, 127)),
    )
    trumpet, trombone = small.players
    dance = (f"{folder}/dances/salsa.choreography", 0.75, 2**62 + 3)
    parameters = PlayerParameters(0.1, 0.6, 1.1, 2.1, 8.5, 0.9, 0.8, 0.7, 0.6, "seated", False, 7, 0.2, True, *dance)
    amounts = {name: number / 10 for number, name in enumerate(AMOUNTS[3:], 4)}
    parameters = replace(parameters, style="jazz", habits="nodder,my own", **amounts)
    corrections = {
        trumpet.id: (
            PinFingering("1:1", "1·3"),
            RemoveEvent("breath:1:1", "1:1"),
            SetBreath("1:2", -120, -10, 0.3),
            SetCue("1:1", 2.0, takers=("x",)),
            SetEmbouchure("1:3", 0.1, None, 0.3),
            ChangeGesture("sway:@0", 1, 2, 0.5),
            AddGesture("mine", "bell_height", 0, 480, 1.5),
            AddGesture("theirs", "named", 480, 960, 0.5, "shrug"),
            ChangeExpression("expression:neutral", "angry", 0, 100, 0.7),
            AddExpression("yours", "angry", 10, 20, 0.4, 0.1, 0.1),
            PoseCorrection("pose", "bell", 480, 960, 5.0, 1.0, -1.0, 120, 60),
            AdditiveCurve(
                "own-1",
                "head.up",
                (
                    CurveKey(-480, 0.0),
                    CurveKey(480, 6.5, "linear"),
                    CurveKey(960, -2.25, "constant", Tangent(120, 1.5), Tangent(60, -3.0)),
                    CurveKey(1440, 1.0),
                ),
                240,
                480,
                0.75,
                False,
                "見上げる",
            ),
            AdditiveCurve("own-2", "face.browInnerUp", (CurveKey(0, 0.5),)),
            Vary("varied-1", 0, 480, 2**62 + 1),
            PlayStyle("own-3", "soloist", 0, 960, 240, 120),
            SetMark("dynamic", start_tick=480, end_tick=960, text="mf"),
            RemoveMark("slur", "1:1", "1:3"),
        ),
        trombone.id: (PinFingering("2:1", "1"),),
    }
    read = {note.id: note for note in first.notes}
    read["1:1"] = Note("1:1", 30, 450, 61, 79)
    read["1:77"] = Note("1:77", 5000, 240, 64, 80)
    return Project(
        score=full_score,
        players=(
            Player(
                "1.1.1",
                "Trompete: 1/2",
                "1.1.1",
                "trumpet_Bb",
                "woman_adult",
                parameters,
                stage_arc(2)[0],
                "#AABBCC",
                outfit=OutfitChoice("elsewhere", "#102030", "#F0f0f0", "#884422"),
            ),
            Player("x", "con", "2.1.1", "not_installed", "nobody", parameters, stage_arc(2)[1], "", True, True),
        ),
        corrections={"1.1.1": corrections["1.1.1"], "x": corrections["2.1.1"]},
        seed=2**63 - 1,
        preroll_beats=3.5,
        section_intensity=0.75,
        conductor=ConductorPlace(-0.5, 1.75),
        felt_beat_quarters=1.5,
        fps=Fraction(30000, 1001),
        audio=AudioTrack(
            f"{folder}/録音.wav", -0.132, 0.94, (BeatPin(480, 0.75), BeatPin(1920, 2.5)), (Doubt(1920, 3840, 0.25),)
        ),
        video=VideoTrack(f"{folder}/練習.mp4", 1.25, 0.8),
        expressions=(ANGRY,),
        source=f"{folder}/piece.mid",
        read_notes={"1.1.1": read},
        read_curves={"1.1.1": (ControllerCurve("breath", (0, 480), (0.5, 1.0)),)},
        read_timing=ReadTiming(TempoMap(480, (TempoChange(0, 450_000.0),)), (Metre(0, 3, 4), Metre(1440, 4, 4)), 0),
        imported=ImportDecisions(
            "cp932",
            (
                RowDecision(
                    (
                        TrackMark(1, 2, 0, "トランペット", "Trumpet", 56, ("trumpet",), "Tp. 1", (1, 2**32 - 1)),
                        TrackMark(2, 9, 1, "", "", None, (), "", ()),
                    ),
                    True,
                    "trumpet_Bb",
                    "Anna",
                    "every",
                    True,
                    "woman_adult",
                ),
                RowDecision((TrackMark(3, 0, 0, "Piano", "", 0, (), "Piano", (5,)),), False),
            ),
        ),
        takes={
            "1.1.1": PlayerTakes(
                takes=(
                    Take(
                        id="take:2",
                        name="二回目",
                        colour="#123456",
                        device="EWI5000 MIDI 1",
                        recorded="2026-11-21T12:00:00+00:00",
                        mapping=ControllerMapping(3, "cc11", "pitch_bend"),
                        cleaning=Cleaning(0.04, 0.2, 0.02, 0.01, 0.5, 1 / 3, 0.25),
                        tempo_map=TempoMap(480, (TempoChange(0, 400_000.0),)),
                        start_us=-500_000,
                        end_us=2_000_000,
                        times_us=(-100_000, 0, 900_000),
                        messages=("b20b40", "923c64", "823c00"),
                    ),
                ),
                comp=(CompSpan(0, 960, "take:2"),),
                before_notes=first.notes,
                before_curves=first.curves,
            )
        },
        dancers=(
            Dancer(
                "dancer:1",
                "踊り手",
                f"{folder}/dances/salsa.choreography",
                "man_adult",
                StagePosition(0.5, 2.0, -0.3),
                2**62 + 1,
                4.5,
                True,
                2,
                0.75,
                0.5,
                0.25,
                "#00ff7f",
                OutfitChoice("elsewhere", accent="#010203"),
            ),
            Dancer("dancer:2", "Dancer 2", "not_bundled", "nobody", StagePosition(-0.5, 2.25, 0.0)),
        ),
        dance_corrections={
            "dancer:1": (PinState(480, 3), ForbidState(0, 1920, 5), UseSegment(960, 17)),
            "dancer:2": (UseSegment(-240, 0),),
        },
    )
