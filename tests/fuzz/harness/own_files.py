"""Good and costly files for `tests.fuzz.harness.own_readers`."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, Final

from tests.fuzz.harness.costly_projects import base

MOST_FREE_TURNS: Final = 2**20
"""Number of frames times joints that is allowed in a BVH file of any size."""


@cache
def keyframes() -> list[bytes]:
    """A second of a trumpeter as an export writes it."""
    return [_motion("0", 3)]


def _joints() -> int:
    return len(_skeleton().names)


def _skeleton() -> Any:
    from app.rig.characters.character_library import character_named

    return character_named(base().players[0].character_id).skeleton


def _motion(value: str, frames: int, one_channel: bool = False) -> bytes:
    """Frames of our own skeleton of one value in every channel."""
    skeleton = _skeleton()
    below: dict[int, list[int]] = {}
    for joint, parent in enumerate(skeleton.parents):
        below.setdefault(parent, []).append(joint)

    def lines(joint: int) -> str:
        place = " ".join(f"{100.0 * value:.4f}" for value in skeleton.offsets_m[joint])
        channels = "1 Yrotation" if one_channel else "3 Zrotation Xrotation Yrotation"
        said = f"CHANNELS {channels}\n" if joint == 0 or not one_channel else ""
        inner = "".join(map(lines, below.get(joint, []))) or "End Site\n{\nOFFSET 0 1 0\n}\n"
        return f"{'JOINT' if joint else 'ROOT'} {skeleton.names[joint]}\n{{\nOFFSET {place}\n{said}{inner}}}\n"

    width = 1 if one_channel else 3 * len(skeleton.names)
    row = " ".join([value] * width) + "\n"
    return ("HIERARCHY\n" + lines(0) + f"MOTION\nFrames: {frames}\nFrame Time: .0166667\n" + row * frames).encode()


def bvh_on_our_skeleton(size: int) -> bytes:
    """Frames of one number for all of our joints."""
    frames = max((size - len(_motion("9", 1, True))) // 2, 1)
    return _motion("9", min(frames, MOST_FREE_TURNS // _joints()), True)


@cache
def evaluation_key() -> list[bytes]:
    """The key of an evaluation of twelve clips."""
    from app.evaluation.key import encoded_key

    return [encoded_key(_key())]


def _key() -> Any:
    from tests.support.viewers import key_of

    return key_of()


@cache
def answers() -> list[bytes]:
    """Return a file with one viewer's answers, some of them left out."""
    from app.evaluation.answers import encode_answers
    from tests.support.viewers import viewers

    (viewer,) = viewers(_key(), 1, presentations=("single", "pair"), skips=0.1)
    return [encode_answers(viewer.answers)]


def answers_at_all_places(size: int) -> bytes:
    """The same answers again and again, each time at another place."""
    head, *rows = answers()[0].decode().splitlines()
    fields = [row.split(",") for row in rows]
    lines = [head]
    for number in range(max((size - len(head)) // (len(rows[0]) + 3), 1)):
        row = list(fields[number % len(fields)])
        row[3] = str(number + 1)
        lines.append(",".join(row))
    return "".join(f"{line}\r\n" for line in lines).encode()


def answers_of_quotes(size: int) -> bytes:
    """A row of quotation marks."""
    head = answers()[0].decode().splitlines()[0]
    return (head + "\r\n" + '"' * size + "\r\n").encode()


def key_of_clips(size: int) -> bytes:
    """The greatest number of clips that fits."""
    import msgspec

    from app.evaluation.key import encoded_key

    key = _key()
    count = min(max((size - 300) // 150, 1), 9000)
    clips = [msgspec.structs.replace(key.clips[0], code=f"c{at:04}", excerpt=at + 1) for at in range(count)]
    return encoded_key(msgspec.structs.replace(key, clips=(*key.clips, *clips)))


def nested(size: int) -> bytes:
    """Brackets within brackets."""
    return b"[" * size


def nested_objects(size: int) -> bytes:
    """Objects within objects."""
    return b'{"a":' * (size // 5)


def digits(size: int) -> bytes:
    """One long number."""
    return b'{"version": ' + b"9" * size + b"}"


def exported() -> list[bytes]:
    """The note of one piece."""
    import msgspec

    from app.cli.batch import BatchOutcome, _Note

    return [msgspec.json.encode({"a.mid": _Note("0" * 32, BatchOutcome(0, players=4, seconds=10.0))})]


def exported_pieces(size: int) -> bytes:
    """Notes of thousands of pieces."""
    one = exported()[0][1:-1]
    return b"{" + b",".join(one.replace(b"a.mid", b"%d.mid" % at) for at in range(max(size // len(one), 1))) + b"}"


def cuts() -> list[bytes]:
    """Two motions in a row, and one."""
    return [b"0.5\n1.0\n1.5\n\n2.0\n2.75\n"]


def cuts_of_lines(size: int) -> bytes:
    """A time on every line."""
    return b"".join(b"%d\n" % at for at in range(size // 6))


def table_of_brackets(size: int) -> bytes:
    """Arrays within arrays."""
    return b"a = " + b"[" * size


def table_of_digits(size: int) -> bytes:
    """One long number."""
    return b"a = " + b"9" * size


def table_of_dots(size: int) -> bytes:
    """A key of thousands of names."""
    return b"a" + b".a" * (size // 2) + b" = 1"


def table_of_tables(size: int) -> bytes:
    """Thousands of tables, each within the one before."""
    return b"".join(b"[[a.b]]\n[a.b.c]\n" for _ in range(size // 16))


def table_of_keys(size: int) -> bytes:
    """A value on every line."""
    return b"".join(b"k%d = 1\n" % at for at in range(size // 10))


_JSON: Final = (nested, nested_objects, digits)
_TABLES: Final = (table_of_brackets, table_of_digits, table_of_dots, table_of_tables, table_of_keys)
COSTLY_OWN: Final[dict[str, tuple[Callable[[int], bytes], ...]]] = {
    "keyframes": (bvh_on_our_skeleton,),
    "evaluation_key": (key_of_clips, *_JSON),
    "answers": (answers_at_all_places, answers_of_quotes),
    "exported": (exported_pieces, *_JSON),
    "cuts": (cuts_of_lines, digits),
    **dict.fromkeys(("project", "autosave", "presence", "clip", "choreography"), _JSON),
    **dict.fromkeys(("instrument_map", "metadata", "expression", "preset", "character_entry", "settings"), _TABLES),
    **dict.fromkeys(("unreal_description", "unreal_manifest", "unreal_project"), _JSON),
}
"""The same as `tests.fuzz.harness.costly_files.COSTLY_FILES`."""
