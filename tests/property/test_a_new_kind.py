"""A kind of gesture or breath added by one row and one function is known to all code that distinguishes kinds."""

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
ROW = """    GestureRow("stomp", ("Stomps", "足踏み"), "Stomp", "accent", "phrase", True, look="strip"),
"""
FUNCTION = '''def stomps(times: NoteTimes) -> list[GestureEvent]:
    """Stomp with the first note."""
    tick, start_s = int(times.onset_tick[0]), float(times.onset_s[0])
    return [GestureEvent(f"stomp:@{tick}", "stomp", tick, tick + 480, start_s, start_s + 0.5, 0.8, Message("a.b"))]


'''
BREATH_ROW = """    BreathRow("sniff", ("Sniff", "鼻で吸う")),
"""
BREATH_IMPORT = "from app.plan.breath.breaths_in_rests import breath_at\n"
SNIFFS = """    sniffed = notes[4].onset_tick
    seconds = [piece.clock.seconds(float(tick)) for tick in (sniffed - 480, sniffed)]
    generated += (breath_at(f"sniff:{notes[4].id}", piece, *seconds, Message("a.b")),)
"""
SEEN = """
import json
from pathlib import Path
from app.cli import main, parser
from app.cli.options import open_project
from app.errors import Message
from app.performance.ensemble import Performance
from app.project.undoable_document import Document
from app.project.edit import breaths_and_cues
from app.project.edit import events as edit
from app.project.storage import load, save
from app.shell.commands.events import ACTIONS
from app.shell.language import TEXTS as texts
from widgets.timeline.model.regions.acting_regions import GROUPS, STRIPS, Names, gesture_region

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

SNIFFED = """
import json
from pathlib import Path
from app.cli import main, parser
from app.cli.options import open_project
from app.errors import Message
from app.performance.ensemble import Performance
from app.project.undoable_document import Document
from app.project.edit import breaths_and_cues
from app.project.edit import events as edit
from app.project.storage import load, save
from app.shell.language import TEXTS as texts

project = open_project(parser().parse_args(["inspect", "piece.mid"]))
player = project.players[0].id
def sniffs(project):
    return [event for event in Performance(project).plans[player].breaths if event.kind == "sniff"]
def kept(project, name):
    save(project, name)
    return load(name)
plan = Performance(project).plans[player]
[made] = sniffs(kept(project, "piece.suisou"))
document = Document(project)
document.apply(Message("edit.set_event_amount"), edit.set_amounts(project, plan, {made.id: 0.3}))
[shallow] = sniffs(kept(document.project, "shallow.suisou"))
moved = edit.move(project, plan, [made.id], 480)
[other] = sniffs(kept(moved.project, "moved.suisou"))
document.apply(Message("edit.remove_events"), edit.remove(document.project, plan, [made.id]))
without = sniffs(kept(document.project, "without.suisou"))
document.undo(), document.undo()
added = breaths_and_cues.add_breath(project, plan, 480, "sniff")
own = [event.id for event in sniffs(kept(added.project, "added.suisou"))]
files = {}
for name in ("piece", "without"):
    assert main(["export", f"{name}.suisou", "--to", name, "--format", "bvh", "--fps", "24"]) == 0
    files[name] = next(Path(name).rglob("*.bvh")).read_bytes()
print(json.dumps({
    "depths": [made.depth > 0.3, shallow.depth],
    "ids": [made.id, *moved.event_ids, other.id],
    "own": own,
    "removed": not without,
    "undone": document.project is project,
    "name": texts["event.sniff"],
    "moves": files["piece"] != files["without"],
}))
"""


def put_in(path: Path, before: str, text: str) -> None:
    source = path.read_text(encoding="utf-8")
    assert source.count(before) == 1
    path.write_text(source.replace(before, text + before), encoding="utf-8")


@pytest.fixture(scope="module")
def grown(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The program with an additional kind of gesture and an additional kind of breath."""
    root = tmp_path_factory.mktemp("grown")
    shutil.copytree(ROOT / "app", root / "app")
    for room in ("widgets", "instrument_maps", "metadata", "resources"):
        (root / room).symlink_to(ROOT / room)
    put_in(root / "app/plan/kinds.py", "    # Gestures from tables", ROW)
    put_in(root / "app/plan/player.py", "BY_MUSIC: Final", FUNCTION)
    put_in(root / "app/plan/player.py", '    "sways": sways,\n', '    "stomps": reading(stomps, times="rhythm"),\n')
    imports = "from app.errors import Message\nfrom app.plan.music.piece import NoteTimes\n"
    put_in(root / "app/plan/player.py", "from app.plan.acting import", imports)
    put_in(root / "app/plan/kinds.py", '    BreathRow("within"', BREATH_ROW)
    put_in(root / "app/plan/breath/breaths.py", "    placed = {", SNIFFS)
    put_in(root / "app/plan/breath/breaths.py", "from app.plan.breath.breaths_in_rests import", BREATH_IMPORT)
    track = mido.MidiTrack([mido.MetaMessage("track_name", name="Trumpet")])
    for pitch, rest in ((67, 0), (69, 0), (71, 0), (72, 0), (71, 960), (69, 0), (67, 0), (67, 0)):
        track += [
            mido.Message("note_on", note=pitch, velocity=80, time=rest),
            mido.Message("note_off", note=pitch, time=480),
        ]
    mido.MidiFile(tracks=[track], ticks_per_beat=480).save(root / "piece.mid")
    return root


def seen(root: Path, script: str) -> dict[str, object]:
    """JSON printed by a script in a copy of the program."""
    command = [sys.executable, "-c", script]
    done = subprocess.run(command, cwd=root, env={"PYTHONPATH": str(root)}, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    found: dict[str, object] = json.loads(done.stdout.splitlines()[-1])
    return found


def test_a_kind_of_gesture_is_a_row_and_a_function(grown: Path) -> None:
    assert seen(grown, SEEN) == {
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


def test_a_kind_of_breath_is_a_row_and_a_function(grown: Path) -> None:
    assert seen(grown, SNIFFED) == {
        "depths": [True, 0.3],
        "ids": ["sniff:1:5", "sniff:1:6", "sniff:1:6"],
        "own": ["sniff:1:2", "sniff:1:5"],
        "removed": True,
        "undone": True,
        "name": ["Sniff", "鼻で吸う"],
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
