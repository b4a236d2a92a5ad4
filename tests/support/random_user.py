"""A random user of the whole editor, in processes that are killed: what was done by hand is there when the next begins.

``python -m tests.support.random_user FOLDER SEED DEEDS [kill]``: one session. It takes up what the session before left
(unsaved work, else the last file), does random deeds, among them opening hostile files, saving under hostile names,
undoing, importing again, and is killed at a random moment of its last deed; without ``kill`` it ends in order, and the
document is judged. Every value of the project is noted down in ``FOLDER/<n>.log`` when it comes to be, so that
`lost_work` can tell what of it the next session lacks.
"""

from __future__ import annotations

import hashlib
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
import traceback
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any, Final
from unittest.mock import patch

import mido
from PySide6.QtWidgets import QApplication, QDialog, QLineEdit

from app.choreography.model_file import write_model
from app.editor.questions import Answer
from app.editor.settings import Settings
from app.editor.tasks import ThreadTasks
from app.errors import AppError, Message
from app.plan.by_hand.corrections import AddExpression
from app.project import storage
from app.project.autosave import Autosave
from app.project.edit.corrections import with_corrections
from app.project.edit.dance_corrections import pin_state
from app.project.edit.dancers import add_dancer, remove_dancers
from app.project.edit.generation import vary_everyone
from app.project.edit.notes import move
from app.project.edit.piece import set_title
from app.project.edit.players import rename, set_parameters
from app.project.model import Project
from app.project.recovery import Recoverable
from app.project.running_editors import Presence
from app.project.undoable_document import Change
from app.shell.app import Program, make_application
from app.shell.commands.exchange import reimport_from
from tests.fuzz.harness import seeds
from tests.fuzz.harness.mutators import mutated
from tests.fuzz.harness.readers import KINDS
from tests.fuzz.harness.values import TEXTS
from tests.gui.shell.conftest import Answers
from tests.support.dances import model
from tests.support.restless import QUARTET, Complaints, Restless
from tests.support.windows import draw_coarsely
from widgets.viewport.canvas import Canvas

MOST_LOST_S: Final = 5.0
"""Seconds of work that a kill may lose."""
PATIENCE_S: Final = 240.0
"""Seconds to wait, longer than any autosave on a busy machine; a hang is still detected."""
WINDOW_PX: Final = (1280, 800)
FIRST: Final = "duet <b>&amp; {file}.mid"
SHORT_TICKS: Final = 8 * 480
DANCE: Final = "steps.choreography"


def digest(project: Project) -> str:
    """Digest of everything that a project's file contains; for a project that cannot be stored, the reason."""
    try:
        content = storage.encode(project, Path("/nowhere/digest.suisou"))
    except AppError as error:
        return f"cannot be saved: {error}"
    # A whole number of a float is read as one again.
    return hashlib.blake2b(re.sub(rb"(?<=\d)\.0\b", b"", content), digest_size=12).hexdigest()


class Clock:
    """Clock of the editor that only advances between two deeds, so that system noise is not mistaken for work.

    Attributes
    ----------
    now_s : float
    """

    def __init__(self) -> None:
        self.now_s = 0.0

    def monotonic(self) -> float:
        """Replacement for `time.monotonic`."""
        return self.now_s


class Log:
    """Record of events, one per line; written lines survive the death of the process."""

    def __init__(self, stream: IO[str], clock: Clock) -> None:
        self._stream, self._clock = stream, clock

    def note(self, event: str, **what: Any) -> None:
        """Add a line."""
        self._stream.write(json.dumps({"event": event, "clock_s": self._clock.now_s, **what}) + "\n")
        self._stream.flush()


class RandomAnswers(Answers):
    """Answers questions randomly; file dialogs return files in the user's folder."""

    def __init__(self, chance: random.Random, folder: Path, log: Log) -> None:
        super().__init__()
        self.chance = chance
        self.folder = folder
        self.log = log

    def open_file(self, title: str, folder: str, filters: str) -> Path | None:
        """Choose an existing file of any kind."""
        return None if self.chance.random() < 0.2 else self.chance.choice(sorted(self.folder.iterdir()))

    def save_file(self, title: str, proposal: str, filters: str, suffixes: Sequence[str]) -> Path | None:
        """Choose an existing file or an unusual new name."""
        self.path = None if self.chance.random() < 0.1 else self.folder / file_name(self.chance)
        path = super().save_file(title, proposal, filters, suffixes)
        self.log.note("named", path=str(path or ""))
        return path

    def unsaved(self, name: str) -> Answer:
        """Usually save, otherwise discard."""
        answer: Answer = self.chance.choice(("save", "save", "discard", "cancel"))
        if answer == "discard":
            self.log.note("discarded")
        return answer


def dancing(project: Project, name: str, number: int, folder: Path) -> Project:
    """Add a dancer, whose choreography exists for every second one; or pin a basic motion of an existing dancer, or
    remove one.
    """
    if number >= len(project.dancers):
        return add_dancer(project, folder / ("gone.choreography" if number % 2 else DANCE), name)[0]
    dancer = project.dancers[number]
    return remove_dancers(project, [dancer.id]) if number == 2 else pin_state(project, dancer.id, 480 * number, number)


def file_name(chance: random.Random) -> str:
    """Random valid file name without a suffix, possibly hostile."""
    text = chance.choice((*TEXTS, *["work"] * 10))
    plain = text.replace("/", "").replace("\0", "").encode()[:180].decode("utf-8", "ignore")
    return plain if plain not in ("", ".", "..") else "work"


class RandomUser(Restless):
    """A restless user who also opens, saves, names, undoes and imports.

    Parameters
    ----------
    program : Program
    seed : int
    folder : Path
        The user's files.
    """

    def __init__(self, program: Program, seed: int, folder: Path) -> None:
        super().__init__(program, seed)
        self.folder = folder

    def step(self) -> None:
        """Do one thing; one in four concerns files, or is an edit that clicks rarely cause."""
        if self.random.random() < 0.25:
            deeds = (self.open, self.save, self.take_back, self.name, self.again, self.edit)
            self.random.choices(deeds, (3, 3, 3, 4, 2, 7))[0]()
            QApplication.processEvents()
            self.look_away()
        else:
            super().step()

    def edit(self) -> None:
        """Change something in the project."""
        project, chance = self.session.project, self.random
        if not project.players:
            return
        player, text = chance.choice(project.players), chance.choice(TEXTS)
        notes = [note for part in project.score.parts for note in part.notes]
        note = chance.choice(notes) if notes else None
        edits: list[Callable[[Project], Project]] = [
            lambda project: set_title(project, text),
            lambda project: rename(project, player.id, text),
            lambda project: set_parameters(project, [player.id], amplitude=chance.choice((0.1, 0.5, 1.9))),
            lambda project: with_corrections(
                project, player.id, [AddExpression(f"x{chance.randrange(9)}", "strained", 0, 960)]
            ),
            lambda project: vary_everyone(project),
            lambda project: dancing(project, text, chance.randrange(5), self.folder),
        ]
        if note is not None:
            edits.append(
                lambda project: move(project, [note.id], chance.choice((-480, 0, 1, 9600)), chance.choice((-1, 1)))
            )
        place = chance.randrange(len(edits))
        self.deeds.append(f"edit {place} {text[:20]!r}")
        self.session.attempt(Message("edit.move_notes", {"count": 1, "of": ""}), edits[place])

    def open(self) -> None:
        """Open a valid or hostile file."""
        path = self.random.choice(sorted(path for path in self.folder.iterdir() if path.is_file()))
        self.deeds.append(f"open {path.name}")
        self.busy(lambda: self.program.editor.files.open(path, ask=self.random.random() < 0.3))

    def save(self) -> None:
        """Save, or save under another name."""
        files = self.program.editor.files
        if files.is_open:
            self.deeds.append("save")
            (files.save if self.random.random() < 0.6 else files.save_as)()

    def take_back(self) -> None:
        """Undo some steps and redo some of them."""
        document = self.session.document
        back, forth = self.random.randint(0, 6), self.random.randint(0, 6)
        self.deeds.append(f"undo {back} redo {forth}")
        for _ in range(back):
            document.undo()
            QApplication.processEvents()
        for _ in range(forth):
            document.redo()
            QApplication.processEvents()

    def name(self) -> None:
        """Enter a hostile text in a field."""
        fields = [
            field
            for window in QApplication.topLevelWidgets()
            if window.isVisible()
            for field in window.findChildren(QLineEdit)
            if field.isVisible() and field.isEnabled() and not field.isReadOnly() and self._is_harmless(field)
        ]
        if not fields:
            return
        field, text = self.random.choice(fields), self.random.choice(TEXTS)
        self.deeds.append(f"type {text[:20]!r} into {field.objectName()}")
        field.setFocus()
        field.setText(text)
        self.busy(lambda: field.editingFinished.emit())

    def again(self) -> None:
        """Import a MIDI file into the open piece."""
        path = self.random.choice(sorted(self.folder.glob("*.mid")))
        self.deeds.append(f"import again {path.name}")
        if self.program.editor.files.is_open:
            reimport_from(self.program.editor, path)

    def look_away(self) -> None:
        """Accept or reject open dialogs."""
        super().look_away()
        for widget in QApplication.topLevelWidgets():
            if isinstance(widget, QDialog) and widget.isVisible() and widget.objectName() == "reimport_midi":
                self.deeds.append("agree")
                widget.accept() if self.random.random() < 0.7 else widget.reject()


# Session


class SessionRun:
    """Editor of one session.

    Parameters
    ----------
    folder : Path
        Of all sessions: ``files``, ``recovery``, ``settings``, logs.
    seed, deeds : int
    """

    def __init__(self, folder: Path, seed: int, deeds: int) -> None:
        self.chance = random.Random(seed)
        self.folder, self.deeds = folder, deeds
        self.clock = Clock()
        self.application = make_application()
        self.complaints = Complaints()
        self.complaints.install()
        number = len(list(folder.glob("*.log")))
        self.log = Log((folder / f"{number}.log").open("a", encoding="utf-8"), self.clock)
        settings = Settings(folder / "settings" / "editor.toml")
        if not settings.language:
            settings.language = "en"
        answers = RandomAnswers(self.chance, folder / "files", self.log)
        autosave = Autosave(Presence(folder / "recovery"))
        patch("app.editor.files.time", self.clock).start()
        patch.object(Canvas, "on_draw", draw_coarsely).start()
        self.program = Program(settings, questions=answers, autosave=autosave, audible=False)
        assert isinstance(self.program.tasks, ThreadTasks)
        self.tasks = self.program.tasks
        self.tasks.unexpected.connect(self.complaints.take)
        self.files, self.session = self.program.editor.files, self.program.session
        self.session.changed.connect(self._changed)
        self.program.window.resize(*WINDOW_PX)
        self.program.window.show()
        self.user = RandomUser(self.program, seed, folder / "files")

    def _changed(self, change: Change) -> None:
        self.log.note("project", digest=digest(change.after), opened=change.opened)

    def run(self, is_killed: bool) -> None:
        """Run the whole session."""
        self._take_up()
        for number in range(self.deeds):
            if is_killed and number == self.deeds - 1:
                self._be_killed()
            before = len(self.user.deeds)
            self.user.step()
            self.log.note("deed", deeds=self.user.deeds[before:], path=str(self.files.path or ""))
            self._tell_complaints()
            self._pass_time()
        if is_killed:
            while True:
                self.user.step()
        self.user.judge(self.folder)
        self._tell_complaints()
        self.program.end()
        self.files.end()
        self.log.note("end")

    def _be_killed(self) -> None:
        """Kill the process at a random moment, preferably while a file is being written."""
        begin = self.chance.choice((self.files.write_soon, self.files.save, self.files.save_as, lambda: None))
        most_s = self.chance.choice((0.02, 0.1, 0.6))
        if self.files.is_open:
            begin()
        threading.Timer(self.chance.uniform(0.0, most_s), os.kill, (os.getpid(), signal.SIGKILL)).start()

    def _pass_time(self) -> None:
        """Advance the editor's clock and do the work that is due."""
        self.clock.now_s += self.chance.uniform(0.1, 0.8)
        self.files.tick()
        self._wait(lambda: all(task.name.id != "work.autosave" for task in self.tasks.running), "an autosave")

    def _take_up(self) -> None:
        """Restore the work of the previous session."""
        found: list[tuple[Recoverable, ...]] = []
        self.files.find_recoverable(found.append)
        self._wait(lambda: bool(found), "what is recoverable")
        offers = found[0]
        self.log.note("offers", digests=[digest(storage.load(offer.autosave)) for offer in offers])
        if offers:
            self.files.recover(offers[0])
            for other in offers[1:]:
                self.files.discard(other)
        else:
            recent = [Path(path) for path in self.program.editor.settings.recent]
            projects = [path for path in recent if path.suffix == storage.SUFFIX and path.is_file()]
            self.files.open(projects[0] if projects else self.folder / "files" / FIRST, ask=False)
        self._wait(lambda: self.files.is_open, "something to open")

    def _wait(self, ready: Callable[[], bool], what: str) -> None:
        end_s = time.monotonic() + PATIENCE_S
        while not ready():
            if time.monotonic() > end_s:
                raise TimeoutError(what)
            self.application.processEvents()
            time.sleep(0.005)

    def _tell_complaints(self) -> None:
        for complaint in self.complaints.found:
            self.log.note("complaint", text=complaint, deeds=self.user.deeds[-6:])
        self.complaints.found.clear()


# From outside


@dataclass
class Journey:
    """Result of a number of sessions.

    Attributes
    ----------
    deeds, kills : int
    faults : list of str
        Complaints, and work that was lost.
    """

    deeds: int = 0
    kills: int = 0
    faults: list[str] = field(default_factory=list)


def prepare(folder: Path, seed: int) -> None:
    """Write the user's files: valid ones, and hostile ones of every kind that can be opened."""
    chance = random.Random(seed)
    files = folder / "files"
    files.mkdir(parents=True)
    shutil.copy(QUARTET, files / "quartet.mid")
    _write_short_piece(files / FIRST)
    shutil.copy(seeds.DATA / "projects" / "version_7.suisou", files / "work.suisou")
    write_model(files / DANCE, model())
    for kind, suffix in (("midi", ".mid"), ("project", ".suisou"), ("audio", ".flac")):
        spec = KINDS[kind]
        good = spec.seeds()
        for number in range(6):
            (files / f"hostile {number}{suffix}").write_bytes(mutated(good, chance, spec.structured))
        for name, make in seeds.hostile(kind).items():
            (files / f"found {name.replace('/', ' ')}{suffix}").write_bytes(make())


def travel(folder: Path, seed: int, deeds: int, kills: int) -> Journey:
    """Run sessions one after another, all but the last killed."""
    prepare(folder, seed)
    journey = Journey()
    environment = {
        **os.environ,
        **{name: str(folder / name) for name in ("XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_STATE_HOME")},
    }
    left: list[dict[str, Any]] = []
    for number in range(kills + 1):
        killed = number < kills
        in_files = _digests_of_files(left)
        arguments = [str(folder), str(seed * 1000 + number), str(max(deeds // (kills + 1), 1)), *["kill"] * killed]
        with (folder / f"{number}.err").open("w") as errors:
            ended = subprocess.run(
                [sys.executable, "-X", "faulthandler", "-m", "tests.support.random_user", *arguments],
                cwd=seeds.ROOT,
                env=environment,
                stderr=errors,
                check=False,
                timeout=900,
            )
        events = read_log(folder / f"{number}.log")
        done = [event for event in events if event["event"] == "deed"]
        journey.kills += killed
        journey.deeds += len(done)
        for event in events:
            if event["event"] == "complaint":
                journey.faults.append(f"session {number}: {event['text']}\nafter {event['deeds']}")
            elif event["event"] == "offers" and (lost := lost_work(left, [*event["digests"], *in_files])):
                journey.faults.append(f"session {number}: {lost}")
        if ended.returncode != (-signal.SIGKILL if killed else 0):
            said = (folder / f"{number}.err").read_text(errors="replace")[-3000:]
            journey.faults.append(f"session {number} ended with {ended.returncode}: {said}\nafter {done[-3:]}")
        left = events
    return journey


def _write_short_piece(path: Path) -> None:
    """Write the beginning of a duet, short because its motion is computed after every edit."""
    whole = mido.MidiFile(seeds.DATA / "midi" / "ensemble" / "trumpet_duet_bach_minuet.mid")
    for track in whole.tracks:
        tick = 0
        for place, message in enumerate(track):
            tick += message.time
            if tick > SHORT_TICKS:
                del track[place:]
                break
    whole.save(path)


def read_log(path: Path) -> list[dict[str, Any]]:
    """Events of a session's log; the last line may be incomplete."""
    found = []
    for line in path.read_text(encoding="utf-8").splitlines() if path.exists() else ():
        try:
            found.append(json.loads(line))
        except ValueError:
            break
    return found


def _digests_of_files(events: list[dict[str, Any]]) -> list[str]:
    """Digests of the files that a session had open last, or named for a save that may have finished when it
    was killed.
    """
    opened = next((event["path"] for event in reversed(events) if event["event"] == "deed"), "")
    paths = [Path(path) for path in {opened, *(event["path"] for event in events if event["event"] == "named")} if path]
    found = []
    for path in paths:
        try:
            found.append(digest(storage.load(path)))
        except AppError as error:
            found.append(str(error))
    return found


def lost_work(events: Sequence[dict[str, Any]], found: Sequence[str]) -> str:
    """Describe the lost work of a killed session; empty if only the last seconds are lost.

    Parameters
    ----------
    events : sequence of dict
        The session's log.
    found : sequence of str
        Digests of what there is after the kill: unsaved work that is offered, the project's file.
    """
    end_s = float(events[-1]["clock_s"]) if events else 0.0
    states: list[tuple[float, str]] = []
    discarded = False
    for event in events:
        if event["event"] == "project":
            if event["opened"]:
                states = []
            states.append((float(event["clock_s"]), str(event["digest"])))
            discarded = False
        elif event["event"] == "discarded":
            discarded = True
    # A session without edits, or with discarded ones, has nothing to lose.
    if discarded or len(states) < 2:
        return ""
    late = [place for place in range(1, len(states)) if states[place][0] >= end_s - MOST_LOST_S]
    least = late[0] - 1 if late else len(states) - 1
    allowed = {state for _, state in states[least:]}
    if least == 0 or allowed & set(found):
        return ""
    age_s = end_s - states[least][0]
    known = [place for place, (_, state) in enumerate(states) if state in found]
    newest = f"the newest is {len(states) - 1 - known[-1]} changes older" if known else "nothing of it is there"
    return f"work {age_s:.1f} s before the kill is lost: {newest}"


if __name__ == "__main__":
    try:
        SessionRun(Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])).run("kill" in sys.argv[4:])
    except Exception:  # noqa: BLE001 - printed, and the session fails
        # The hook of the complaints would keep it to itself.
        traceback.print_exc()
        sys.exit(1)
