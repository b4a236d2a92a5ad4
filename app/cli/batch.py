"""Export of many pieces, each by a process of its own, so that an error in one does not stop the others.

Finished pieces are listed in ``exported.json`` in the output folder, so that the next run continues after an
interrupted one.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor, as_completed
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

import msgspec

from app.child import core_count, own_process
from app.cli.batch_inputs import own_digests, piece_digest
from app.cli.progress import Progress
from app.cli.speech import said
from app.cli.status import BAD_INPUT, DONE, PARTIAL, STOPPED
from app.cli.summary import columns, heads
from app.cli.terminal import say, warn
from app.cli.widths import on_left, width
from app.encoding import shown
from app.errors import FileError, UsageError
from app.export.file_names import REPORT
from app.formats.atomic import atomic_write
from app.formats.files import cannot_write, open_file, read_file
from app.formats.json_data import decode_json
from app.project.storage import SUFFIX
from app.score.suffixes import MUSIC

NOTES: Final = "exported.json"
_STOP_S: Final = 10.0
"""Time in seconds for a stopped process to remove its unfinished files."""
_MOST_BYTES: Final = 64 * 2**20
_START: Final = 4096
"""Number of bytes at the beginning of a file in which a score's root element is sought."""
_DASK_VARIABLES: Final = ("MALLOC_TRIM_THRESHOLD_",)
"""Environment variables set by Dask for its workers that slow an export down by seconds, by returning memory."""


class BatchOutcome(msgspec.Struct, frozen=True):
    """Result of one piece of a batch.

    Attributes
    ----------
    status : int
        Exit status of the export.
    reason : str
        Error or warning; empty if there is none.
    players, excluded, warnings : int
        Numbers of players written, of players left out, and of warnings.
    seconds : float
        Length of the motion in seconds.
    incomplete : str
        Description of the missing part of a damaged file that was exported as far as possible; empty otherwise.
    """

    status: int
    reason: str = ""
    players: int = 0
    excluded: int = 0
    warnings: int = 0
    seconds: float = 0.0
    incomplete: str = ""

    @property
    def done(self) -> bool:
        """Return whether files were written."""
        return self.status in (DONE, PARTIAL)

    @property
    def whole(self) -> bool:
        """Return whether every player of a complete file was exported."""
        return self.status == DONE and not self.incomplete


class _Note(msgspec.Struct, frozen=True):
    """Record of one exported piece in ``exported.json``: digest of its inputs, and its result."""

    digest: str
    outcome: BatchOutcome


class _Reported(msgspec.Struct):
    """Those fields of an export's ``report.json`` that a batch run reads for its summary."""

    players: list[msgspec.Raw]
    left_out: list[msgspec.Raw]
    dancers: list[msgspec.Raw]
    warnings: list[msgspec.Raw]
    incomplete: list[str]
    frames: int
    fps: float


def export_folder(arguments: argparse.Namespace) -> int:
    """Export every piece in a folder and its subfolders, print a table, and return the exit status.

    Parameters
    ----------
    arguments : Namespace
        Arguments of the command ``export``, with ``given``, the command line.

    Raises
    ------
    FileError
        There are no pieces, or the list of finished pieces cannot be read or written.
    UsageError
        An option does not fit a folder, or Dask or its scheduler is not available.
    """
    if arguments.to is None:
        raise UsageError("batch.unreal")
    source, target = arguments.file.absolute(), arguments.to.absolute()
    pieces = folders_of(source)
    if not pieces:
        raise FileError("batch.no_pieces", folder=str(arguments.file))
    target.mkdir(parents=True, exist_ok=True)
    notes = _read_notes(target / NOTES)
    own = own_digests()
    digests = {piece: piece_digest(source / piece, arguments, own) for piece in pieces}
    known = {
        piece: notes[piece].outcome
        for piece, folder in pieces.items()
        if piece in notes and notes[piece].digest == digests[piece] and os.path.exists(target / folder / REPORT)
    }
    results = _Results(target / NOTES, digests, notes, known)
    outcomes = results.outcomes
    progress, stopped = Progress(sys.stderr), False
    futures: dict[Future[BatchOutcome], str] = {}
    with _executor(arguments.scheduler, arguments.jobs) as executor:
        for piece, folder in pieces.items():
            if piece not in known:
                paths = str(source / piece), str(target / folder)
                futures[executor.submit(export_piece, arguments.given, *paths)] = piece
        try:
            for done, future in enumerate(as_completed(futures), 1):
                results.add(futures[future], future)
                progress(done / len(futures), futures[future])
        except KeyboardInterrupt:
            stopped = True
            for future in futures:
                future.cancel()
            _Children.end()
        finally:
            progress.clear()
    for future, piece in futures.items():
        # A piece may have finished before it could be stopped.
        if stopped and piece not in outcomes and future.done() and not future.cancelled():
            results.add(piece, future)
    say(*_table(pieces, outcomes, known, stopped))
    if stopped:
        return STOPPED
    if not any(outcome.done for outcome in outcomes.values()):
        return BAD_INPUT
    return DONE if all(outcome.whole for outcome in outcomes.values()) else PARTIAL


class _Results:
    """Results of a batch, stored in ``exported.json`` after each piece."""

    def __init__(
        self, file: Path, digests: Mapping[str, str], notes: dict[str, _Note], known: Mapping[str, BatchOutcome]
    ) -> None:
        self._file, self._digests, self._notes = file, digests, notes
        self.outcomes = dict(known)

    def add(self, piece: str, future: Future[BatchOutcome]) -> None:
        """Store the result of a piece of the batch, and report it."""
        outcome = self.outcomes[piece] = _outcome(future)
        if outcome.done:
            self._notes[piece] = _Note(self._digests[piece], outcome)
            _write_notes(self._file, self._notes)


def folders_of(source: Path) -> dict[str, str]:
    """Return the pieces in a folder and its subfolders with the output folder of each; both are relative paths with
    slashes."""
    found = sorted(
        path.relative_to(source)
        for path in source.rglob("*")
        if path.suffix.casefold() in (SUFFIX, *MUSIC)
        and os.path.isfile(path)
        and not _hidden(path.relative_to(source))
        and _is_music(path)
    )
    alike = Counter(path.with_suffix("") for path in found)
    folders = [path if alike[path.with_suffix("")] > 1 else path.with_suffix("") for path in found]
    return {path.as_posix(): folder.as_posix() for path, folder in zip(found, folders, strict=True)}


def _is_music(path: Path) -> bool:
    """Return whether a file is music; an ``.xml`` file is, if its beginning is that of a score."""
    if path.suffix.casefold() != ".xml":
        return True
    try:
        with open_file(path) as stream:
            return b"<score-" in stream.read(_START).replace(b"\0", b"")
    except (FileError, OSError):
        # Exporting the file reports why it cannot be read.
        return True


def _hidden(path: Path) -> bool:
    return any(part.startswith(".") for part in path.parts)


def export_piece(given: Sequence[str], piece: str, folder: str) -> BatchOutcome:
    """Export a piece in a process of its own.

    Parameters
    ----------
    given : sequence of str
        Command line of the whole batch.
    piece, folder : str
        File of the piece, and its output folder.
    """
    command = own_process("app", *given, "--piece", piece, "--to", folder, "--jobs", "1")
    for variable in _DASK_VARIABLES:
        command["env"].pop(variable, None)
    with _Children.started(command) as child:
        _, printed = child.communicate()
    lines = [line for line in printed.decode("utf-8", "replace").splitlines() if line.strip()]
    if child.returncode not in (DONE, PARTIAL):
        reason = lines[-1].removeprefix("suisou: ") if lines else said("batch.ended", status=child.returncode)
        return BatchOutcome(child.returncode or BAD_INPUT, reason)
    file = Path(folder) / REPORT
    report = decode_json(read_file(file, _MOST_BYTES), _Reported, str(file))
    return BatchOutcome(
        status=child.returncode,
        players=len(report.players) + len(report.dancers),
        excluded=len(report.left_out),
        warnings=len(report.warnings),
        seconds=report.frames / report.fps,
        incomplete=report.incomplete[0] if report.incomplete else "",
    )


class _Children:
    """Processes that are exporting pieces, so that all of them can be stopped."""

    _running: Final[set[subprocess.Popen[bytes]]] = set()

    @classmethod
    @contextmanager
    def started(cls, command: dict[str, Any]) -> Iterator[subprocess.Popen[bytes]]:
        """Start a process, yield it, and let `end` stop it until the block ends."""
        child = subprocess.Popen(stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, **command)
        cls._running.add(child)
        try:
            yield child
        finally:
            cls._running.discard(child)

    @classmethod
    def end(cls) -> None:
        """Stop all processes, which remove their unfinished files."""
        for child in list(cls._running):
            child.terminate()
        end_s = time.monotonic() + _STOP_S
        for child in list(cls._running):
            try:
                child.wait(max(0.0, end_s - time.monotonic()))
            except subprocess.TimeoutExpired:
                child.kill()


@contextmanager
def _executor(scheduler: str | None, jobs: int | None) -> Iterator[Executor]:
    """Yield an executor that runs `export_piece`: on local threads that each wait for a process, or on the workers of a
    Dask scheduler.
    """
    if scheduler is None:
        threads = ThreadPoolExecutor(jobs or core_count())
        try:
            yield threads
        finally:
            threads.shutdown(cancel_futures=True)
        return
    # Imported on demand, since its modules are slow to load.
    from app.cli.cluster import cluster_executor

    with cluster_executor(scheduler) as executor:
        yield executor


def _outcome(future: Future[BatchOutcome]) -> BatchOutcome:
    """Return the result of a piece; a failed result if its process or machine failed."""
    try:
        return future.result()
    except Exception as error:  # noqa: BLE001 - a scheduler's errors have no common base; one piece stops no other
        return BatchOutcome(BAD_INPUT, str(error) or type(error).__name__)


_NOTES: Final[msgspec.json.Decoder[dict[str, _Note]]] = msgspec.json.Decoder(dict[str, _Note])


def _read_notes(file: Path) -> dict[str, _Note]:
    if not os.path.exists(file):
        return {}
    try:
        return decode_json(read_file(file, _MOST_BYTES), _NOTES, str(file), "batch.bad_notes")
    except FileError as error:
        if error.message.id != "batch.bad_notes":
            raise
        aside = file.with_name(f"{file.name}.damaged")
        try:
            file.replace(aside)
        except OSError as refusal:
            raise cannot_write(aside, refusal) from refusal
        warn(said(error.message.id, **{**error.message.arguments, "aside": aside.name}))
        return {}


def _write_notes(file: Path, notes: dict[str, _Note]) -> None:
    with atomic_write(file) as stream:
        stream.write(msgspec.json.format(msgspec.json.encode(notes), indent=1))


def _table(
    pieces: dict[str, str], outcomes: dict[str, BatchOutcome], known: dict[str, BatchOutcome], stopped: bool
) -> list[str]:
    """Return a line of text for each piece, and the number of each kind of result."""
    rows: list[tuple[str, ...]] = [heads("batch.heads")]
    for piece in pieces:
        outcome = outcomes.get(piece)
        if outcome is None or (stopped and not outcome.done):
            rows.append((piece, "", "", "", "", said("batch.not_exported")))
        elif not outcome.done:
            rows.append((piece, "", "", "", "", outcome.reason))
        else:
            numbers = (outcome.players, round(outcome.seconds), outcome.excluded, outcome.warnings)
            result = said("batch.up_to_date" if piece in known else "batch.exported")
            if outcome.incomplete:
                result = said("batch.incomplete", result=result, reason=outcome.incomplete)
            rows.append((piece, *map(str, numbers), result))
    failed = sum(not outcome.done for outcome in outcomes.values())
    done = len(outcomes) - failed
    lines = columns([row[:-1] for row in rows])
    wide = max(map(width, lines))
    table = [f"{on_left(line, wide)}  {shown(row[-1])}" for line, row in zip(lines, rows, strict=True)]
    counts = [said("batch.count", done=done, count=len(pieces))]
    incomplete = sum(bool(outcome.incomplete) for outcome in outcomes.values())
    if incomplete:
        counts.append(said("batch.some_incomplete", count=incomplete))
    if stopped:
        counts.append(said("batch.goes_on"))
    return [*table, "", said("cli.and_then").join(counts)]
