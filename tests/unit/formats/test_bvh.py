from __future__ import annotations

import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.errors import FileError, Message
from app.formats.bvh.clip import BvhClip
from app.formats.bvh.read import decode_bvh, read_bvh
from app.formats.bvh.write import write_bvh
from tests.support.encoded import encode_bvh
from tests.support.rerigged import together
from tests.unit.formats import scenes


def clip(frames: int = 20, fps: Fraction = Fraction(60)) -> BvhClip:
    """Seven joints in an order in which children do not directly follow their parents."""
    parents = (-1, 0, 0, 1, 2, 1, 4)
    generator = np.random.default_rng(4)
    return BvhClip(
        names=("hips", "spine", "leg", "neck", "knee", "arm", "foot"),
        parents=parents,
        offsets_cm=np.vstack([np.zeros(3), generator.normal(scale=20, size=(6, 3))]),
        end_sites_cm={3: np.array([0.0, 12.0, 0.0]), 5: np.array([9.0, 0, 0]), 6: np.array([0.0, 0.0, 7.5])},
        fps=fps,
        root_translation_cm=generator.normal(scale=50, size=(frames, 3)),
        rotations_xyzw=scenes.rotations(5, frames, 7, 1.5),
    )


DEPTH_FIRST = (0, 1, 3, 5, 2, 4, 6)


@pytest.mark.parametrize("fps", [Fraction(24), Fraction(30000, 1001), Fraction(60), Fraction(37, 2)], ids=str)
def test_a_clip_comes_back(fps: Fraction, tmp_path: Path) -> None:
    given = clip(fps=fps)
    write_bvh(tmp_path / "a.bvh", given)
    found = read_bvh(tmp_path / "a.bvh")
    order = [given.names.index(name) for name in found.names]
    assert tuple(order) == DEPTH_FIRST
    above = [found.names[parent] if parent >= 0 else None for parent in found.parents]
    assert above == [given.names[given.parents[joint]] if joint else None for joint in order]
    assert found.fps == fps
    np.testing.assert_allclose(found.offsets_cm, given.offsets_cm[order], atol=1e-6)
    np.testing.assert_allclose(found.root_translation_cm, given.root_translation_cm, atol=1e-6)
    turned = Rotation.from_quat(found.rotations_xyzw.reshape(-1, 4)).inv() * Rotation.from_quat(
        given.rotations_xyzw[:, order].reshape(-1, 4)
    )
    assert turned.magnitude().max() < 1e-7
    ends = {found.names[joint]: end for joint, end in found.end_sites_cm.items()}
    assert sorted(ends) == ["arm", "foot", "neck"]
    np.testing.assert_allclose(ends["foot"], [0, 0, 7.5])


def test_the_dialect_is_what_every_reader_takes() -> None:
    text = encode_bvh(clip(frames=3, fps=Fraction(30000, 1001))).decode()
    assert re.search(r"ROOT hips\n\{\n\tOFFSET 0\.000000 0\.000000 0\.000000\n\tCHANNELS 6 ", text)
    assert text.count("position") == 3
    assert text.count("CHANNELS 3 Zrotation Xrotation Yrotation") == 6
    assert text.count("End Site") == 3
    frame_time = re.search(r"Frame Time: (\d+\.\d{10,})\n", text)
    assert abs(float(frame_time[1]) - 1001 / 30000) < 1e-15
    rows = text.split(frame_time[0])[1].splitlines()
    assert len(rows) == 3
    assert all(len(row.split(" ")) == 3 + 3 * 7 for row in rows)


def test_rotations_are_z_x_y_by_scipy() -> None:
    given = clip(frames=50)
    rows = encode_bvh(given).decode().split("Frame Time:")[1].splitlines()[1:]
    table = np.array([row.split() for row in rows], dtype=float)
    for column, joint in enumerate(DEPTH_FIRST):
        angles = table[:, 3 + 3 * column : 6 + 3 * column]
        by_scipy = Rotation.from_euler("ZXY", angles, degrees=True)
        assert (by_scipy.inv() * Rotation.from_quat(given.rotations_xyzw[:, joint])).magnitude().max() < 1e-7


def test_other_rotation_orders_are_read() -> None:
    text = encode_bvh(clip(frames=5)).decode()
    other = text.replace("CHANNELS 3 Zrotation Xrotation Yrotation", "CHANNELS 3 Xrotation Yrotation Zrotation")
    found = decode_bvh(other, "x.bvh")
    values = np.array(text.split("Frame Time:")[1].splitlines()[1].split(), dtype=float)[6:9]
    by_scipy = Rotation.from_euler("XYZ", values, degrees=True)
    assert (by_scipy.inv() * Rotation.from_quat(found.rotations_xyzw[0, 1])).magnitude() < 1e-12


ARM = """HIERARCHY
ROOT hips
{
OFFSET 1 2 3
CHANNELS %s
JOINT arm
{
OFFSET 10 20 30
CHANNELS %s
JOINT hand
{
OFFSET 5 6 7
CHANNELS %s
End Site
{
OFFSET 1 0 0
}
}
}
}
MOTION
Frames: 2
Frame Time: %s
%s
"""
SIX = "6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"


def test_the_root_has_its_channels_in_any_order() -> None:
    root = "6 Yrotation Zposition Xrotation Xposition Yposition Zrotation"
    values = "11 3 22 1 2 33\n11 6 22 4 5 33"
    found = decode_bvh(ARM % (root, "0", "0", "0.04", values), "a.bvh")
    np.testing.assert_array_equal(found.root_translation_cm, [[1, 2, 3], [4, 5, 6]])
    turn = Rotation.from_euler("YXZ", [11, 22, 33], degrees=True).inv() * Rotation.from_quat(found.rotations_xyzw[1, 0])
    assert turn.magnitude() < 1e-12
    # Without position channels the joint does not move: its offset is ignored as before.
    still = decode_bvh(ARM % ("1 Yposition", "0", "0", "0.04", "7 8"), "a.bvh")
    np.testing.assert_array_equal(still.root_translation_cm, [[0, 7, 0], [0, 8, 0]])


def test_positions_of_joints_take_the_place_of_their_offsets() -> None:
    # The arm's are always the same, the hand's are not.
    arm, hand = "11 21 31 0 0 90", ("5 6 7 0 0 0", "5 6 8 0 0 0")
    values = "\n".join(f"0 0 0 0 0 0 {arm} {one}" for one in hand)
    found = decode_bvh(ARM % (SIX, SIX, SIX, "0.04", values), "a.bvh")
    np.testing.assert_array_equal(found.offsets_cm, [[0, 0, 0], [11, 21, 31], [5, 6, 7]])
    assert list(found.translations_cm) == [2]
    np.testing.assert_array_equal(found.translations_cm[2], [[5, 6, 7], [5, 6, 8]])


def test_a_hinge_has_one_channel() -> None:
    found = decode_bvh(ARM % ("0", "1 Xrotation", "2 Yrotation Xposition", "0.04", "30 40 9\n50 60 9"), "a.bvh")
    for joint, axis, angles in ((1, "X", [[30], [50]]), (2, "Y", [[40], [60]])):
        turns = Rotation.from_quat(found.rotations_xyzw[:, joint]) * Rotation.from_euler(axis, angles, True).inv()
        assert turns.magnitude().max() < 1e-12
    np.testing.assert_array_equal(found.offsets_cm[2], [9, 6, 7])


@pytest.mark.parametrize(
    ("written", "fps"),
    [
        (".03333", Fraction(30)),
        ("0.0333", Fraction(30)),
        ("0.033367", Fraction(30000, 1001)),
        ("0.0333667", Fraction(30000, 1001)),
        ("0.03337", Fraction(30000, 1001)),
        ("0.0083333", Fraction(120)),
        ("0.008333", Fraction(120)),
        ("8.33333e-3", Fraction(120)),
        ("0.016667", Fraction(60)),
        ("0.0166", Fraction(5000, 83)),
        ("0.0417", Fraction(24)),
        ("0.04", Fraction(25)),
        ("0.1", Fraction(10)),
        ("0.03", Fraction(100, 3)),
        (f"{2 / 37:.16f}", Fraction(37, 2)),
    ],
)
def test_a_frame_time_of_few_digits_is_a_usual_rate(written: str, fps: Fraction) -> None:
    for separated in (written, written.replace(".", ",")):
        assert decode_bvh(ARM % ("1 Xrotation", "0", "0", separated, "1 2"), "a.bvh").fps == fps


@pytest.mark.parametrize(
    ("written", "fps"),
    [("33.33", Fraction(30)), ("8.333333", Fraction(120)), ("40", Fraction(25)), ("16.6667", Fraction(60))],
)
def test_a_frame_time_in_milliseconds_is_understood(written: str, fps: Fraction) -> None:
    read = decode_bvh(ARM % ("1 Xrotation", "0", "0", written, "1 2"), "a.bvh")
    assert read.fps == fps
    assert read.rate_guess == Message("motion.milliseconds", {"rate": str(fps), "said": float(written)})
    assert decode_bvh(ARM % ("1 Xrotation", "0", "0", "0.04", "1 2"), "a.bvh").rate_guess is None


@pytest.mark.parametrize(
    ("written", "fps"),
    [
        *(("24", Fraction(24)), ("25", Fraction(25)), ("30", Fraction(30)), ("29.97", Fraction(30000, 1001))),
        *(("50", Fraction(50)), ("60.0", Fraction(60)), ("100", Fraction(100)), ("120", Fraction(120))),
        ("240", Fraction(240)),
    ],
)
def test_a_rate_in_place_of_the_frame_time_is_understood(written: str, fps: Fraction) -> None:
    read = decode_bvh(ARM % ("1 Xrotation", "0", "0", written, "1 2"), "a.bvh")
    assert read.fps == fps
    assert read.rate_guess == Message("motion.rate_as_time", {"rate": str(fps), "said": float(written)})


DIALECTS = {
    "channels in small letters": lambda text: re.sub("[XYZ](position|rotation)", lambda found: found[0].lower(), text),
    "channels in capitals": lambda text: re.sub("[XYZ](position|rotation)", lambda found: found[0].upper(), text),
    "End site": lambda text: text.replace("End Site", "End site"),
    "EndSite with a name": lambda text: text.replace("End Site", "EndSite tip"),
    "keywords in small letters": lambda text: re.sub("HIERARCHY|ROOT|JOINT|OFFSET|CHANNELS|MOTION", _lower, text),
    "brace on the same line": lambda text: re.sub(r"\n\s*\{", " {", text),
    "braces closed on one line": lambda text: re.sub(r"\}\s*\}", "}}", text),
    "no space after Frames:": lambda text: text.replace("Frames: ", "Frames:").replace("Frame Time: ", "Frame Time:"),
    "space before the colon": lambda text: text.replace("Frames:", "Frames :").replace("Time:", "Time :"),
    "MOTION in a name": lambda text: text.replace("hips", "MOTION_hips"),
    "motion on the line of MOTION": lambda text: text.replace("MOTION\n", "MOTION "),
    "line ends of Windows": lambda text: text.replace("\n", "\r\n"),
    "line ends of old Macs": lambda text: text.replace("\n", "\r"),
    "blank lines": lambda text: text.replace("\n", "\n\n"),
    "decimal commas": lambda text: re.sub(r"(?<=\d)\.(?=\d)", ",", text),
    "commas between the numbers": lambda text: _in_rows(text, ","),
    "commas and blanks between them": lambda text: _in_rows(text, ", "),
    "rows of several lines": lambda text: text[:-400] + text[-400:].replace(" ", "\n"),
}


def _in_rows(text: str, between: str) -> str:
    """Text with a separator inserted between the numbers of each row of the motion."""
    head, rows = re.split(r"(?<=\d\n)(?=[^\n]*\Z|[^:]*\Z)", text, maxsplit=1)
    return head + rows.replace(" ", between)


def _lower(found: re.Match[str]) -> str:
    return found[0].lower()


@pytest.mark.parametrize("name", DIALECTS)
def test_dialects_are_read_as_the_usual_one(name: str) -> None:
    text = encode_bvh(clip(frames=5)).decode()
    other = DIALECTS[name](text)
    assert other != text
    same(decode_bvh(other, "a.bvh"), decode_bvh(text, "a.bvh"))


def same(found: BvhClip, expected: BvhClip) -> None:
    assert [name.removeprefix("MOTION_") for name in found.names] == list(expected.names)
    assert (found.parents, found.fps, found.guesses) == (expected.parents, expected.fps, ())
    np.testing.assert_array_equal(found.offsets_cm, expected.offsets_cm)
    np.testing.assert_array_equal(found.rotations_xyzw, expected.rotations_xyzw)
    np.testing.assert_array_equal(found.root_translation_cm, expected.root_translation_cm)
    assert found.end_sites_cm.keys() == expected.end_sites_cm.keys()


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_a_byte_order_mark_is_no_text(encoding: str, tmp_path: Path) -> None:
    text = encode_bvh(clip(frames=2)).decode()
    (tmp_path / "a.bvh").write_bytes(text.encode(encoding))
    same(read_bvh(tmp_path / "a.bvh"), decode_bvh(text, "a.bvh"))


def test_scales_are_left_out() -> None:
    row = "1 2 3 4 5 6 1 1 1"
    scaled = decode_bvh(ARM % (f"9 {SIX[2:]} Xscale Yscale Zscale", "0", "0", "0.04", f"{row}\n{row}"), "a.bvh")
    plain = decode_bvh(ARM % (SIX, "0", "0", "0.04", f"{row[:11]}\n{row[:11]}"), "a.bvh")
    same(scaled, plain)


@pytest.mark.parametrize(("said", "guess"), [(4, "motion.rows"), (6, "motion.rows"), (500, "motion.rows")])
def test_rows_are_counted_whatever_the_file_announces(said: int, guess: str) -> None:
    text = encode_bvh(clip(frames=5)).decode()
    found = decode_bvh(text.replace("Frames: 5", f"Frames: {said}"), "a.bvh")
    assert found.guesses == (Message(guess, {"frames": said, "found": 5}),)
    same(replace(found, guesses=()), decode_bvh(text, "a.bvh"))


def test_a_file_that_is_cut_off_is_read_as_far_as_it_goes() -> None:
    text = encode_bvh(clip(frames=5)).decode()
    found = decode_bvh(text.rstrip().rpartition(" ")[0], "a.bvh")
    assert found.guesses == (Message("motion.row_cut", {"frames": 5, "found": 4}),)
    np.testing.assert_array_equal(found.rotations_xyzw, decode_bvh(text, "a.bvh").rotations_xyzw[:4])


def test_of_several_figures_the_first_is_read_or_the_one_asked_for() -> None:
    text = encode_bvh(clip(frames=3)).decode()
    head, motion = text.split("MOTION")
    start, rows = motion.split("\n", 3)[:3], motion.split("\n", 3)[3].replace("1", "2")
    alone = "\n".join([f"{head.replace('hips', 'partner')}MOTION", *start[1:], rows])
    both = together(text, alone)
    found = decode_bvh(both, "a.bvh")
    assert (found.figures, found.figure) == (("hips", "partner"), "hips")
    assert found.figures == ("hips", "partner")
    same(replace(found, guesses=(), figures=()), decode_bvh(text, "a.bvh"))
    for name, expected in (("partner", alone), ("hips", text)):
        same(replace(decode_bvh(both, "a.bvh", name), figures=()), decode_bvh(expected, "b.bvh"))
    with pytest.raises(FileError) as caught:
        decode_bvh(both, "a.bvh", "nobody")
    assert caught.value.message.arguments["figures"] == "hips, partner"


def test_figures_of_one_name_are_numbered() -> None:
    text = encode_bvh(clip(frames=3)).decode()
    second = "\n".join([*text.splitlines()[:-1], text.splitlines()[-1].replace("1", "2"), ""])
    both = together(text, second, text)
    assert decode_bvh(both, "a.bvh").figures == ("hips", "hips (2)", "hips (3)")
    same(replace(decode_bvh(both, "a.bvh", "hips (2)"), figures=()), decode_bvh(second, "b.bvh"))


def test_commas_that_may_be_either_are_named_by_their_line() -> None:
    """Decimal commas cannot be distinguished from separators, so nothing is guessed."""
    text = encode_bvh(clip(frames=5)).decode()
    lines = text.splitlines()
    mixed = "\n".join([*lines[:-2], lines[-2].replace(" ", ",").replace(".", ","), lines[-1]])
    with pytest.raises(FileError) as raised:
        decode_bvh(mixed, "a.bvh")
    assert raised.value.message.id == "bvh.number"
    assert raised.value.message.arguments["line"] == len(lines) - 1


def test_a_file_with_decimal_commas_that_is_cut_off_is_read_as_far_as_it_goes() -> None:
    text = re.sub(r"(?<=\d)\.(?=\d)", ",", encode_bvh(clip(frames=5)).decode())
    found = decode_bvh(text[: text.rindex(" ")], "a.bvh")
    assert len(found.rotations_xyzw) == 4
    assert [guess.id for guess in found.guesses] == ["motion.row_cut"]


def test_a_wrong_row_is_named_by_its_line() -> None:
    text = encode_bvh(clip(frames=5)).decode()
    lines = text.splitlines()
    at = len(lines) - 3
    for change, problem in ((lambda row: row + " 1", "bvh.row"), (lambda row: row.replace("1", "x", 1), "bvh.number")):
        damaged = "\n".join([*lines[:at], change(lines[at]), *lines[at + 1 :]])
        with pytest.raises(FileError) as raised:
            decode_bvh(damaged, "a.bvh")
        assert (raised.value.message.id, raised.value.message.arguments["line"]) == (problem, at + 1)


GOOD = clip()
CONTRADICTIONS = {
    "no joint": replace(GOOD, names=(), parents=()),
    "a second root": replace(GOOD, parents=(-1, 0, -1, 1, 2, 1, 4)),
    "a parent after its child": replace(GOOD, parents=(-1, 0, 4, 1, 2, 1, 4)),
    "a name twice": replace(GOOD, names=("hips", "spine", "leg", "neck", "knee", "arm", "hips")),
    "a name with a blank": replace(GOOD, names=("hips", "spine", "left leg", "neck", "knee", "arm", "foot")),
    "a leaf without an end": replace(GOOD, end_sites_cm={3: np.zeros(3)}),
    "offsets of other joints": replace(GOOD, offsets_cm=np.zeros((3, 3))),
    "a moving joint": replace(GOOD, translations_cm={1: np.zeros((20, 3))}),
    "no frame": replace(GOOD, rotations_xyzw=np.zeros((0, 7, 4)), root_translation_cm=np.zeros((0, 3))),
    "other frames": replace(GOOD, root_translation_cm=np.zeros((3, 3))),
    "a place without end": replace(GOOD, root_translation_cm=np.full((20, 3), np.inf)),
    "a rotation that is none": replace(GOOD, rotations_xyzw=np.full((20, 7, 4), np.nan)),
}


@pytest.mark.parametrize("name", CONTRADICTIONS)
def test_a_contradiction_is_refused(name: str) -> None:
    with pytest.raises(ValueError, match=r"."):
        encode_bvh(CONTRADICTIONS[name])


TEXT = encode_bvh(clip(frames=2)).decode()


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "bvh.truncated"),
        ("something else", "bvh.syntax"),
        ("HIERARCHY", "bvh.truncated"),
        (TEXT.split("MOTION")[0].rstrip()[:-1], "bvh.truncated"),
        (TEXT.replace("ROOT", "JOINT"), "bvh.syntax"),
        (TEXT.replace("OFFSET 0.000000 0.000000 0.000000", "OFFSET 0 zero 0", 1), "bvh.syntax"),
        (TEXT.replace("CHANNELS 3", "CHANNELS 4", 1), "bvh.syntax"),
        (TEXT.replace("CHANNELS 3 Zrotation", "CHANNELS 3 Xrotation", 1), "bvh.unsupported"),
        (TEXT.replace("CHANNELS 3 Zrotation", "CHANNELS 3 Wrotation", 1), "bvh.unsupported"),
        (TEXT.replace("CHANNELS 3 Z", "CHANNELS 4 Xposition Z", 1), "bvh.row"),
        (TEXT.replace("MOTION", "MOTION\nMOTION"), "bvh.no_frames"),
        (TEXT.replace("Frames: 2", "Frames: two"), "bvh.frames"),
        (TEXT[: TEXT.index("Frame Time:") + 30], "bvh.truncated"),
        (TEXT.replace("Frames: 2", "Frames: -2"), "bvh.frames"),
        (TEXT.replace("Frames: 2", "Frames: 0"), "bvh.frames"),
        (re.sub("Frame Time: .*", "Frame Time: -0.5", TEXT), "bvh.frame_time"),
        (re.sub("Frame Time: .*", "Frame Time: 0", TEXT), "bvh.frame_time"),
        (re.sub("Frame Time: .*", "Frame Time: nan", TEXT), "bvh.frame_time"),
        (re.sub("Frame Time: .*", "Frame Time: 1e300", TEXT), "bvh.frame_time"),
        (TEXT.replace("\t{", "\t{ {", 1), "bvh.syntax"),
        (TEXT.replace("\t\t}\n", "", 1), "bvh.brace"),
        ("HIERARCHY\n" + "JOINT a\n{\n" * 5, "bvh.syntax"),
        ("HIERARCHY\nROOT a\n{\n" + "JOINT a\n{\n" * 5000, "bvh.unsupported"),
    ],
)
def test_damage_is_named(text: str, problem: str) -> None:
    with pytest.raises(FileError) as raised:
        decode_bvh(text, "bad.bvh")
    assert raised.value.message.id == problem
    assert raised.value.message.arguments["file"] == "bad.bvh"


@pytest.mark.parametrize(("head", "id"), [("Frames:", "bvh.frames"), ("Frame Time:", "bvh.frame_time")])
def test_a_wrong_head_of_the_motion_is_named_with_its_line(head: str, id: str) -> None:
    text = re.sub(f"{head}.*", f"{head} 1,2,3", TEXT)
    with pytest.raises(FileError) as raised:
        decode_bvh(text, "bad.bvh")
    line = next(at for at, one in enumerate(text.splitlines(), start=1) if one.startswith(head))
    assert raised.value.message == Message(id, {"file": "bad.bvh", "line": line, "found": "1,2,3"})
