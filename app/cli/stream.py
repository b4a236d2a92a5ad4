"""``suisou stream``: sends the motion of a piece to another program by the VMC protocol, without a window."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

from app.cli.commands import add_pitch_options
from app.cli.options import (
    add_ignored_option,
    add_players_option,
    add_source_options,
    bounded_number,
    frame_rate,
    open_project,
    seconds,
)
from app.cli.progress import Progress, find_holds
from app.cli.speech import said, sentence
from app.cli.status import report_left_out
from app.cli.summary import look_at
from app.cli.terminal import say
from app.errors import UsageError
from app.project.frame_rate import USUAL_RATE
from app.project.parameters import select_players
from app.project.performers import Dancer, Player
from app.stream.faces import FACE_NAMES
from app.stream.sender import (
    LEAST_PORT,
    LOOPBACK,
    MOST_PORT,
    Sender,
    SendOutcome,
    checked_port,
    find_address,
    is_loopback,
    reaches_many,
)
from app.stream.vmc import PORT

if TYPE_CHECKING:
    from app.motion.model import Motion
    from app.performance.cast import Performer
    from app.performance.dances import Dancing
    from app.performance.ensemble import Performance
    from app.performance.span import FrameSpan
    from app.project.casting import StagePosition
    from app.stream.vmc import Sent

_REPORT_S: Final = 1.0


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``suisou stream``."""
    add_source_options(command)
    add_players_option(command)
    command.add_argument("--host", type=_host, default=LOOPBACK)
    command.add_argument("--broadcast", action="store_true")
    command.add_argument("--port", type=bounded_number(LEAST_PORT, MOST_PORT, "quantity.port", int), default=PORT)
    command.add_argument("--fps", type=frame_rate, default=USUAL_RATE, metavar="RATE")
    command.add_argument("--faces", choices=FACE_NAMES, default="arkit")
    command.add_argument("--from", dest="from_s", type=seconds, metavar="S")
    add_ignored_option(command)
    command.add_argument("--loop", action="store_true")
    add_pitch_options(command)
    command.set_defaults(run=stream)


def _host(text: str) -> str:
    """Return the typed name or address of a computer; refuses an empty one."""
    if not text.strip():
        raise argparse.ArgumentTypeError(said("cli.no_host"))
    return text.strip()


def stream(arguments: argparse.Namespace) -> int:
    """Send the piece in real time, print the excluded players, and return the exit status.

    Raises
    ------
    AppError
        The file cannot be read, or the computer cannot be reached.
    """
    from app.performance.cast import dancings_of, performers_of, require_players
    from app.performance.ensemble import Performance
    from app.performance.span import whole_span

    project = open_project(arguments, if_empty="stream.no_players")
    performance = Performance(project)
    span = whole_span(performance.time_frame, arguments.fps)
    first = _first_frame(span, arguments.from_s)
    performers = project.performers
    asked = [performers[at] for at in select_players(arguments.players, [one.name for one in performers])]
    # A musician selected by one instrument is streamed with all of them.
    chosen = list(dict.fromkeys(project.musician(one) if isinstance(one, Player) else one for one in asked))
    if not chosen:
        raise UsageError("stream.no_players")
    checked_port(arguments.port + len(chosen) - 1)
    address = find_address(arguments.host, arguments.port)
    if not arguments.broadcast and reaches_many(address):
        raise UsageError("stream.broadcast", host=arguments.host)
    players = [one for one in chosen if isinstance(one, Player)]
    dancers = [one for one in chosen if isinstance(one, Dancer)]
    everything = [one for player in players for one in project.played_by(player)]
    find_holds(performance, everything)
    playing, dancing = performers_of(performance, everything), dancings_of(performance, dancers)
    made: dict[str, Performer | Dancing] = {**playing.made, **dancing.made}
    left_out = playing.left_out + dancing.left_out
    if not made:
        require_players(left_out, str(arguments.file), sentence)
    status = report_left_out((one.player.name, sentence(one.reason)) for one in left_out)
    # An excluded player keeps its port number, so that the other players' ports never change.
    ports = {one.id: arguments.port + place for place, one in enumerate(chosen)}
    sent = [one for one in chosen if one.id in made]
    senders = [Sender(address.port(ports[one.id]), arguments.broadcast) for one in sent]
    try:
        alone = len(chosen) == 1
        cast = [
            _Streamed(performance, one, made[one.id], _beside(performance, one, playing.made), span, arguments, alone)
            for one in sent
        ]
        warnings = [line for streamed in cast for line in streamed.warnings]
        say(*look_at(warnings, sum(streamed.ignored for streamed in cast))[1:], stream=sys.stderr)
        for one, sender in zip(sent, senders, strict=True):
            say(f"{one.name}: {arguments.host}:{sender.address.at[1]}")
        if not is_loopback(arguments.host):
            say(said("stream.leaves", host=arguments.host), stream=sys.stderr)
        _play(cast, senders, span, first, arguments.loop)
    except KeyboardInterrupt:
        say(said("cli.stream_stopped"))
    finally:
        for sender in senders:
            sender.close()
    return status


def _beside(performance: Performance, one: Player | Dancer, made: Mapping[str, Performer]) -> tuple[Performer, ...]:
    """Return those other instruments of a streamed musician, besides that of the player ``one``, whose figures could be
    made.
    """
    if not isinstance(one, Player):
        return ()
    return tuple(
        made[other.id] for other in performance.project.played_by(one) if other is not one and other.id in made
    )


def _first_frame(span: FrameSpan, from_s: float | None) -> int:
    """Return the index of the first frame. Raises UsageError if the piece has no frame at that time."""
    if from_s is None:
        return 0
    first = round((from_s - span.first_frame_s) * float(span.fps))
    if not 0 <= first < span.count:
        raise UsageError("stream.from", time_s=from_s, first_s=span.first_frame_s, end_s=round(span.end_s, 3))
    return first


class _Streamed:
    """A player or dancer that is streamed, with the motion and the encoder of the messages."""

    def __init__(
        self,
        performance: Performance,
        performer: Player | Dancer,
        made: Performer | Dancing,
        beside: tuple[Performer, ...],
        span: FrameSpan,
        arguments: argparse.Namespace,
        alone: bool,
    ) -> None:
        from app.performance.cast import Performer
        from app.performance.motion import player_motion
        from app.performance.performance_problems import judged_problems, reported_lines
        from app.stream.vmc import IN_THE_MIDDLE, Sent

        progress = Progress(sys.stderr)
        self.warnings: list[str] = []
        self.ignored = 0
        try:
            if isinstance(made, Performer):
                self._motion: Motion = player_motion(
                    performance, made, span, progress=lambda share: progress(share, performer.name)
                )
            else:
                progress(0.0, performer.name)
                self._motion = made.motion(span.fps, span.first, span.count)
            self._beside = [player_motion(performance, one, span) for one in beside]
            played = [(made, self._motion)] if isinstance(made, Performer) else []
            for one, motion in [*played, *zip(beside, self._beside, strict=True)]:
                found = judged_problems(performance, one, motion)
                lines, left = reported_lines(performance, one.player, found, sentence, arguments.ignored)
                self.ignored += left
                self.warnings += [f"{one.player.name}: {line}" for line in lines]
        finally:
            progress.clear()
        instrument = performer.instrument_id if isinstance(performer, Player) else None
        self._sent: Sent = Sent(
            made.character, instrument, arguments.faces, tuple(one.player.instrument_id for one in beside)
        )
        self._stage: StagePosition = IN_THE_MIDDLE if alone else performer.stage

    def datagrams(self, frame: int, time_s: float) -> list[bytes]:
        from app.performance.chunks import Pose

        beside = [Pose.of(motion, frame) for motion in self._beside]
        return self._sent.datagrams(Pose.of(self._motion, frame), time_s, self._stage, beside)


def _play(cast: list[_Streamed], senders: list[Sender], span: FrameSpan, first: int, loop: bool) -> None:
    """Send every frame of a range at its time, from frame ``first`` and again from the start if ``loop``; late frames
    are dropped.
    """
    fps, frames = float(span.fps), span.count
    began_s = time.perf_counter()
    sounding_s, inaudible, sent = began_s, False, 0
    step = 0
    while loop or first + step < frames:
        wait_s = began_s + step / fps - time.perf_counter()
        if wait_s > 0:
            time.sleep(wait_s)
        now_s = time.perf_counter()
        frame = (first + step) % frames
        for streamed, sender in zip(cast, senders, strict=True):
            inaudible = sender.send(streamed.datagrams(frame, now_s - began_s)) is SendOutcome.NO_RECEIVER or inaudible
        sent += 1
        if now_s - sounding_s >= _REPORT_S:
            if inaudible and sys.stderr.isatty():
                say(said("stream.no_receiver"), stream=sys.stderr)
            sounding_s, inaudible = now_s, False
        step = max(step + 1, int((time.perf_counter() - began_s) * fps))
    say(said("stream.sent", frames=sent, seconds=time.perf_counter() - began_s))
