"""A kind of gesture added by one row and one function: everything that tells kinds apart knows it."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import mido
import msgspec
import pytest

from app.plan.by_hand.corrections import Correction
from app.plan.kinds import BREATH_KINDS, GESTURE_KINDS

ROOT = Path(__file__).parents[2]
ROW = """    Gesturing("stomp", ("Stomps", "足踏み"), "Stomp", "accent", "phrase", True, look="strip"),
"""
FUNCTION = '''def stomps(times: NoteTimes) -> list[GestureEvent]:
    """Stomp with the first note."""
    tick, start_s = int(times.onset_tick[0]), float(times.onset_s[0])
    return [GestureEvent(f"stomp:@{tick}", "stomp", tick, tick + 480, start_s, start_s + 0.5, 0.8, Message("a.b"))]


'''
SEEN = """
import json
from pathlib import Path
from app.cli import main, parser
from app.cli.options import open_project
from app.errors import Message
from app.performance.ensemble import Performance
from app.project.document import Document
from app.project.edit import events as edit
from app.project.storage import load, save
from app.shell.commands.events import ACTIONS
from app.shell.language import ROOMS
from widgets.timeline.model.regions.acting_regions import GROUPS, STRIPS, Names, gesture_region

texts = {id: wording for room in ROOMS for id, wording in room.items()}
project = open_project(parser().parse_args(["inspect", "piece.mid"]))
save(project, "piece.suisou")
player = project.players[0].id
plan = Performance(project).plans[player]
[made] = [event for event in plan.gestures if event.kind == "stomp"]
document = Document(project)
document.apply(Message("edit.set_event_amount"), edit.set_amounts(project, plan, {made.id: 0.3}))
save(document.project, "smaller.suisou")
plans = Performance(load("smaller.suisou")).plans[player]
[smaller] = [event for event in plans.gestures if event.kind == "stomp"]
document.apply(Message("edit.remove_events"), edit.remove(document.project, plan, [made.id]))
save(document.project, "without.suisou")
without = [event for event in Performance(document.project).plans[player].gestures if event.kind == "stomp"]
document.undo(), document.undo()
added = edit.add_gesture(project, player, "stomp", 960, 1440)
save(added.project, "added.suisou")
[*_, own] = [event for event in Performance(load("added.suisou")).plans[player].gestures if event.kind == "stomp"]
bytes = {}
for name in ("piece", "without"):
    assert main(["export", f"{name}.suisou", "--to", name, "--format", "bvh", "--fps", "24"]) == 0
    bytes[name] = next(Path(name).rglob("*.bvh")).read_bytes()
region = gesture_region(player, made, Names(*[str] * 5))
print(json.dumps({
    "amounts": [made.amount, smaller.amount, own.amount],
    "ids": [made.id, smaller.id, own.id],
    "removed": not without,
    "undone": document.project is project,
    "row": [place for place, kinds in enumerate(GROUPS) if "stomp" in kinds] == [len(GROUPS) - 1],
    "strip": "stomp" in STRIPS,
    "signed": region.signed,
    "command": [action.id for action in ACTIONS if action.id == "gesture.stomp"],
    "names": [texts["event.stomp"], texts["action.gesture.stomp"]],
    "moves": bytes["piece"] != bytes["without"],
}))
"""


def put_in(path: Path, before: str, text: str) -> None:
    source = path.read_text(encoding="utf-8")
    assert source.count(before) == 1
    path.write_text(source.replace(before, text + before), encoding="utf-8")


def test_a_kind_is_a_row_and_a_function(tmp_path: Path) -> None:
    shutil.copytree(ROOT / "app", tmp_path / "app")
    for room in ("widgets", "instrument_maps", "metadata", "resources"):
        (tmp_path / room).symlink_to(ROOT / room)
    put_in(tmp_path / "app/plan/kinds.py", "    # Of tables", ROW)
    put_in(tmp_path / "app/plan/player.py", "BY_MUSIC: Final", FUNCTION)
    put_in(tmp_path / "app/plan/player.py", '    "sways": sways,\n', '    "stomps": reading(stomps, times="rhythm"),\n')
    track = mido.MidiTrack([mido.MetaMessage("track_name", name="Trumpet")])
    for pitch in (67, 69, 71, 72, 71, 69, 67, 67):
        track += [mido.Message("note_on", note=pitch, velocity=80), mido.Message("note_off", note=pitch, time=480)]
    mido.MidiFile(tracks=[track], ticks_per_beat=480).save(tmp_path / "piece.mid")
    imports = "from app.errors import Message\nfrom app.plan.music.piece import NoteTimes\n"
    put_in(tmp_path / "app/plan/player.py", "from app.plan.acting import", imports)
    command = [sys.executable, "-c", SEEN]
    done = subprocess.run(command, cwd=tmp_path, env={"PYTHONPATH": str(tmp_path)}, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout.splitlines()[-1]) == {
        "amounts": [0.8, 0.3, 0.5],
        "ids": ["stomp:@0", "stomp:@0", "stomp:own-1"],
        "removed": True,
        "undone": True,
        "row": True,
        "strip": True,
        "signed": True,
        "command": ["gesture.stomp"],
        "names": [["Stomps", "足踏み"], ["Stomp", "足踏み"]],
        "moves": True,
    }


@pytest.mark.parametrize("known", [GESTURE_KINDS, BREATH_KINDS])
def test_files_name_known_kinds_only(known: dict[str, object]) -> None:
    for kind in (*known, "moonwalk", "", 3):
        item = {"correction": "add_gesture", "name": "x", "start_tick": 0, "end_tick": 1, "amount": 1.0, "kind": kind}
        if known is BREATH_KINDS:
            item = {"correction": "set_breath", "note_id": "1:1", "start_offset_tick": -9, "kind": kind}
        if kind in known:
            assert msgspec.convert(item, Correction).kind == kind
            continue
        with pytest.raises(msgspec.ValidationError, match=r"\$\.kind") as refused:
            msgspec.convert(item, Correction)
        if isinstance(kind, str):
            assert str(refused.value) == f"Invalid enum value {kind!r} - at `$.kind`"
