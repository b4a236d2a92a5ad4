"""State of streaming to other programs, shared by the dialog, the commands, the status line and the streamer."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal

from app.editor.state import State
from app.errors import Message
from app.project.model import Project
from app.stream.faces import FaceNames
from app.stream.sender import LOOPBACK, MOST_PORT
from app.stream.vmc import PORT

StreamState = Literal["off", "looking", "sending", "no_receiver", "failed"]
"""State of streaming: off, looking the computer up, sending, sending without an answer from the receiver, unable to
send."""

RATES_HZ: Final = (24, 30, 60, 90)
USUAL_RATE_HZ: Final = 60


@dataclass(frozen=True)
class StreamTarget:
    """A player or dancer and the port they are sent to."""

    player_id: str
    port: int


class Streaming(State):
    """State of the streaming.

    Attributes
    ----------
    on : bool
        Whether it is to be streamed.
    host : str
        A computer's name or address.
    broadcast : str
        The host that may be sent to although every computer on the network can receive it: it was confirmed.
    port : int
        Of the active player; of several, the first one's.
    everyone : bool
        Every player and dancer, each to a port of their own, at their places on the stage; else the one in front, in
        the middle.
    rate_hz : int
        Frames in a second while something moves.
    lines : tuple of StreamTarget
        Who is sent where.
    sent_hz : int
        Frames of a performer that were sent in the last second.
    trouble : Message or None
        Why nothing can be sent.
    """

    def __init__(self) -> None:
        super().__init__()
        self.on = False
        self.host = LOOPBACK
        self.broadcast = ""
        self.port = PORT
        self.everyone = False
        self.faces: FaceNames = "arkit"
        self.rate_hz = USUAL_RATE_HZ
        self.state: StreamState = "off"
        self.lines: tuple[StreamTarget, ...] = ()
        self.sent_hz = 0
        self.trouble: Message | None = None

    def planned(self, project: Project, front: Sequence[str]) -> tuple[StreamTarget, ...]:
        """Return which player is sent to which port, or would be; players without a port are excluded.

        Parameters
        ----------
        front : sequence of str
            Ids of the selected players, the active one first.
        """
        players = {player.id: player for player in project.players}
        # A musician who plays several instruments is sent once.
        in_front = [project.musician(players[id]).id if id in players else id for id in front[:1]]
        ids = [performer.id for performer in project.seen] if self.everyone else in_front
        return tuple(
            StreamTarget(id, self.port + place) for place, id in enumerate(ids) if self.port + place <= MOST_PORT
        )
