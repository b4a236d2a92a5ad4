"""``suisou choreography``: arguments for pairs, learning and output."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import mido
import numpy as np
import pytest

from app.choreography.body import ENDS, PARENT_OF, SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.derived_rhythm import derived_rhythm
from app.choreography.model_file import read_model, write_model
from app.choreography.read_motion import read_motion
from app.cli import main, parser
from app.cli.choreography.command import PairFiles
from app.cli.status import BAD_INPUT, BAD_USE, DONE, PARTIAL
from app.formats.bvh.clip import BvhClip
from app.formats.bvh.write import write_bvh
from app.rig import quaternion
from app.score.contents import uncast_score
from app.score.read import read_contents
from tests.support.dances import model
from tests.unit.choreography.test_cuts import arm_swings

pytestmark = pytest.mark.slow


def write_clip(path: Path, clip: MotionClip) -> Path:
    """Write the clip as a BVH file with the segments' names."""
    names = tuple(SEGMENTS)
    written = BvhClip(
        names,
        (-1, *(names.index(parent) for parent in list(PARENT_OF.values())[1:])),
        clip.shape.offsets_m * 100.0,
        {names.index(name): end * 100.0 for name, end in zip(ENDS, clip.shape.ends_m, strict=True)},
        clip.fps,
        clip.hips_m * 100.0,
        clip.rotations,
    )
    write_bvh(path, written)
    return path


def write_silence(path: Path) -> Path:
    """Write a MIDI file without notes."""
    mido.MidiFile(tracks=[mido.MidiTrack([mido.MetaMessage("track_name", name="x", time=480)])]).save(path)
    return path


def write_drums(path: Path, channel: int = 9) -> Path:
    """Write a bass drum at 0.1 s and a snare drum at 0.4 s of every 1.5 s."""
    track = mido.MidiTrack([mido.MetaMessage("set_tempo", tempo=1_000_000)])
    now = 0
    for swing in range(6):
        for key, at_s in ((36, 0.1), (38, 0.4)):
            tick = round(1000 * (1.5 * swing + at_s))
            track.append(mido.Message("note_on", channel=channel, note=key, velocity=100, time=tick - now))
            track.append(mido.Message("note_off", channel=channel, note=key, time=50))
            now = tick + 50
    mido.MidiFile(type=0, ticks_per_beat=1000, tracks=[track]).save(path)
    return path


@pytest.fixture
def swings(tmp_path: Path) -> Path:
    return write_clip(tmp_path / "swings.bvh", arm_swings(60))


@pytest.fixture
def drums(tmp_path: Path) -> Path:
    return write_drums(tmp_path / "drums.mid")


def test_options_belong_to_the_pair_before_them() -> None:
    typed = "choreography learn --pair a.bvh a.mid --fps 60 --states 5 --pair b.bvh b.mid --offset -1.5 --pair c d"
    arguments = parser().parse_args([*typed.split(), "--credits", "c.txt", "--to", "x.choreography"])
    assert arguments.pairs == (
        PairFiles(Path("a.bvh"), Path("a.mid"), fps=Fraction(60)),
        PairFiles(Path("b.bvh"), Path("b.mid"), offset_s=-1.5),
        PairFiles(Path("c"), Path("d"), credits=Path("c.txt")),
    )
    assert (arguments.states, arguments.seed) == (5, 0)


@pytest.mark.parametrize(
    ("typed", "said"),
    [
        ("--to x", "--pair"),
        ("--offset 1 --pair a b --to x", "behind a --pair"),
        ("--pair a b --offset 1 --offset 2 --to x", "twice"),
        ("--pair a b --offset nan --to x", "--offset"),
        ("--pair a b --fps 0 --to x", "--fps"),
        ("--pair a b --states 0 --to x", "--states"),
        ("--pair a --to x", "--pair"),
        ("--pair a b", "--to"),
    ],
)
def test_what_makes_no_sense_is_refused(typed: str, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["choreography", "learn", *typed.split()]) == BAD_USE
    assert said in capsys.readouterr().err


def test_a_pair_is_learned(swings: Path, drums: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "swings.txt").write_text("Danced by no one, public domain\n", encoding="utf-8")
    target = tmp_path / "swings.choreography"
    command = ["choreography", "learn", "--pair", str(swings), str(drums), "--offset", "1", "--states", "4"]
    assert main([*command, "--to", str(target)]) == DONE
    printed = capsys.readouterr()
    assert printed.err == ""
    assert printed.out.splitlines() == [
        f"{target}: 4 basic motions from 10 segments, 8.5 s (511 frames)",
        "",
        "motion          music  seconds  segments  states  offset s  confidence",
        "swings.bvh  drums.mid      8.5        10       4      1.00       given",
        "",
        "There are too few motions that are no copies of one another (at least 20 are needed) to test whether the "
        "music predicts them.",
        "",
        "body:",
        "  swings.bvh: T-pose: hip line 0°, shoulder line 0° off level; spine 0° off upright; knees 0°, elbows 0°, "
        "toes 0° off ahead",
        "",
        "to look at:",
        "  swings.bvh: nothing in the file shows which way these point, so their mean in the motion was taken: head, "
        "leftUpperArm, leftUpperLeg, leftHand, rightUpperArm, rightUpperLeg, rightHand",
    ]
    model = read_model(target)
    assert (model.name, model.sources[0].credits) == ("swings", "Danced by no one, public domain")
    # Bass and snare drum in turn, as setting off and arriving.
    emission = model.emission[:, [36 - 35, 38 - 35]]
    assert emission.argmax(axis=1).tolist() == [0, 1, 0, 1]
    # The file of the motion is the motion again, but for how trunk, hands and feet usually are.
    read, danced = (clip.world().rotations[:, 1:] for clip in (model.clips[0], arm_swings(60)))
    turns = [quaternion.multiply(one, quaternion.conjugate(one[:1])) for one in (read, danced)]
    assert np.abs(np.einsum("fsi,fsi->fs", *turns)).min() > 1.0 - 1e-6
    assert np.abs(np.einsum("fsi,fsi->fs", read, danced)).min() > np.cos(np.radians(0.5 * 12.0))


def test_a_motion_is_cut_at_given_times(
    swings: Path, drums: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cuts = tmp_path / "cuts.txt"
    cuts.write_text("0.5\n1.25\n2.0\n\n4.0\n5.0\n", encoding="utf-8")
    command = ["choreography", "learn", "--pair", str(swings), str(drums), "--offset", "1", "--cuts", str(cuts)]
    assert main([*command, "--to", str(tmp_path / "a")]) == DONE
    model = read_model(tmp_path / "a.choreography")
    assert [(one.start, one.end) for one in model.segments] == [(30, 75), (75, 120), (240, 300)]
    assert model.sources[0].cuts_given
    cuts.write_text("0.5\nlater\n", encoding="utf-8")
    assert main([*command, "--to", str(tmp_path / "b")]) == BAD_INPUT
    assert "cuts.txt, line 2: 'later' is not a time" in capsys.readouterr().err
    cuts.write_text("0.5\n100\n", encoding="utf-8")
    assert main([*command, "--to", str(tmp_path / "b")]) == BAD_USE
    assert "swings.bvh cannot be cut" in capsys.readouterr().err


def test_what_was_guessed_of_a_motion_is_said(
    swings: Path, drums: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["choreography", "learn", "--pair", str(swings), str(drums), "--fps", "90", "--to", str(tmp_path / "a")]
    assert main(command) == DONE
    assert "to look at:\n  swings.bvh: 90 frames/s (the file states 60), nothing in the file" in capsys.readouterr().out


def test_an_offset_is_a_time_of_the_file(drums: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    clip = arm_swings(60)
    rotations = clip.rotations.copy()
    # A rest pose with another facing precedes the motion for a frame and is excluded.
    rotations[0, 0] = quaternion.from_axis_angle((0.0, 1.0, 0.0), 1.5)
    motion = write_clip(tmp_path / "jump.bvh", replace(clip, rotations=rotations))
    command = ["choreography", "learn", "--pair", str(motion), str(drums), "--offset", "1", "--states", "4"]
    assert main([*command, "--to", str(tmp_path / "a.choreography")]) == DONE
    printed = capsys.readouterr().out
    assert "10       4      1.00       given" in printed
    assert "unsure" not in printed
    assert "1 frame of rest pose" in printed
    assert read_model(tmp_path / "a.choreography").sources[0].offset_s == pytest.approx(1.0 - 1.0 / 60.0)


def test_an_offset_that_is_not_certain_is_marked(
    swings: Path, drums: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["choreography", "learn", "--pair", str(swings), str(drums), "--to", str(tmp_path / "a")]) == DONE
    printed = capsys.readouterr()
    # Five even swings fit an even rhythm at several offsets.
    assert "*" in printed.out.splitlines()[3]
    assert "(* unsure, see below)" in printed.out
    unsure = next(line for line in printed.err.splitlines() if "unsure where the music begins" in line)
    assert unsure.startswith("suisou: swings.bvh: ")
    assert "sure from 0.30" in unsure
    assert "--offset" in unsure
    assert "swings.bvh: no credits" in printed.err
    assert (tmp_path / "a.choreography").exists()


def test_a_piece_without_percussion_is_learned_as_it_is_danced_to(
    swings: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    tune = write_drums(tmp_path / "tune.mid", channel=0)
    typed = ["choreography", "learn", "--pair", str(swings), str(tune), "--offset", "0", "--to", str(tmp_path / "a")]
    assert main(typed) == DONE
    assert "tune.mid has no percussion: melody" in capsys.readouterr().out
    heard = derived_rhythm(uncast_score(read_contents(tune)))
    sounds = [one for segment in read_model(tmp_path / "a.choreography").segments for one in segment.sounds]
    assert len(sounds) > 10
    assert sounds == heard.symbols[: len(sounds)].tolist()


def test_what_cannot_be_learned_from_is_named(
    swings: Path, drums: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target = tmp_path / "x.choreography"
    silent = write_silence(tmp_path / "silent.mid")
    other = tmp_path / "dance.mp4"
    other.write_bytes(b"")
    for motion, music, options, status, said in [
        (swings, silent, [], BAD_INPUT, "silent.mid has no notes"),
        (other, drums, [], BAD_INPUT, "dance.mp4 is not a supported motion file"),
        (tmp_path / "none.bvh", drums, [], BAD_INPUT, "none.bvh cannot be read"),
        (swings, drums, ["--credits", str(tmp_path / "none.txt")], BAD_INPUT, "none.txt cannot be read"),
        (swings, drums, ["--states", "11"], BAD_USE, "11 basic motions"),
        (swings, drums, ["--offset", "1000"], BAD_USE, "nothing of drums.mid"),
    ]:
        command = ["choreography", "learn", "--pair", str(motion), str(music), *options]
        assert main([*command, "--to", str(target)]) == status
        assert said in capsys.readouterr().err
    assert not target.exists()


def test_a_bad_pair_is_left_out_and_named_and_the_others_are_learned(
    swings: Path, drums: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """One unreadable pair, one whose music is at another time, and one valid pair."""
    target, missing = tmp_path / "x.choreography", tmp_path / "none.bvh"
    later = write_clip(tmp_path / "later.bvh", arm_swings(60))
    command = ["choreography", "learn", "--pair", str(missing), str(drums)]
    command += ["--pair", str(swings), str(drums), "--offset", "1"]
    command += ["--pair", str(later), str(drums), "--offset", "1000"]
    assert main([*command, "--to", str(target)]) == PARTIAL
    printed = capsys.readouterr()
    assert "none.bvh was left out; the other pairs were learned." in printed.err
    assert "later.bvh was left out; the other pairs were learned. nothing of drums.mid" in printed.err
    assert [source.motion_name for source in read_model(target).sources] == ["swings.bvh"]
    target.unlink()
    assert main(["choreography", "learn", *command[2:5], *command[8:], "--to", str(target)]) == BAD_INPUT
    printed = capsys.readouterr()
    assert "later.bvh cannot be learned from: nothing of drums.mid" in printed.err
    assert "none.bvh cannot be read" in printed.err
    assert not target.exists()


# ----------------------------------------------------------------------------------------------------------- generate


@pytest.fixture
def steps(tmp_path: Path) -> Path:
    write_model(tmp_path / "steps.choreography", model())
    return tmp_path / "steps.choreography"


def test_a_dance_is_written_and_reported(
    steps: Path, drums: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert (
        main(["choreography", "generate", str(steps), str(drums), "--to", str(tmp_path / "out"), "--fps", "30"]) == DONE
    )
    clip = read_motion(tmp_path / "out.bvh").clip
    assert clip.fps == 30
    assert clip.length_s > 8.5
    head, row = capsys.readouterr().out.splitlines()
    assert head.split()[:2] == ["file", "seconds"]
    assert "out.bvh" in row


def test_several_dancers_have_a_file_each(
    steps: Path, drums: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    typed = ["choreography", "generate", str(steps), str(drums), "--dancers", "2", "--formation", "mirror"]
    assert main([*typed, "--to", str(tmp_path / "out.bvh")]) == DONE
    one, other = (read_motion(tmp_path / f"out_{number}.bvh").clip for number in (1, 2))
    assert one.hips_m * (-1.0, 1.0, 1.0) == pytest.approx(other.hips_m, abs=2e-4)
    assert len(capsys.readouterr().out.splitlines()) == 3


def test_a_piece_without_percussion_is_danced_by_its_melody(
    steps: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    tune = write_drums(tmp_path / "tune.mid", channel=0)
    assert main(["choreography", "generate", str(steps), str(tune), "--to", str(tmp_path / "out.bvh")]) == DONE
    assert "no percussion" in capsys.readouterr().out


def test_what_cannot_be_generated_is_said(
    steps: Path, drums: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    typed = ["choreography", "generate", str(steps), str(drums), "--to", str(tmp_path / "out.bvh")]
    assert main([*typed, "--prefer", "x.bvh"]) == BAD_USE
    assert "one.bvh, other.bvh" in capsys.readouterr().err
    assert main([*typed, "--formation", "ring"]) == BAD_USE
    assert "unison, canon, mirror, individual" in capsys.readouterr().err
    assert main(["choreography", "generate", str(drums), str(drums), "--to", str(tmp_path / "out.bvh")]) == BAD_INPUT
    assert "drums.mid" in capsys.readouterr().err
    assert not (tmp_path / "out.bvh").exists()
