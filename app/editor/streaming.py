"""State of streaming to other programs, shared by dialog, commands, status line and streamer."""

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
"""State of streaming: off, resolving the host name, sending, sending without a receiver's answer, unable to send."""

RATES_HZ: Final = (24, 30, 60, 90)
USUAL_RATE_HZ: Final = 60


@dataclass(frozen=True)
class StreamTarget:
    """A performer whose motion is streamed, and the UDP port to which it is sent."""

    player_id: str
    port: int


class Streaming(State):
    """State of the live stream of poses: settings and success.

    Attributes
    ----------
    on : bool
        Whether streaming is on.
    host : str
        Name or address of the receiving computer.
    broadcast : str
        Broadcast address that the user has confirmed; every computer on the network can receive the stream then.
    port : int
        UDP port of the active player; if all performers are sent, the port of the first.
    everyone : bool
        Whether all performers are sent, each to its own port and at its stage position; otherwise only the active
        player is sent, at the centre of the stage.
    rate_hz : int
        Frames per second while something moves.
    lines : tuple of StreamTarget
        Destination of each performer.
    sent_hz : int
        Number of frames sent of one performer in the last second.
    trouble : Message or None
        Reason why nothing can be sent.
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
        """Return the destination of each performer; those without a port are excluded.

        Parameters
        ----------
        front : sequence of str
            Ids of the selected players, the active one first.
        """
        players = {player.id: player for player in project.players}
        # A musician with several instruments is sent once.
        in_front = [project.musician(players[id]).id if id in players else id for id in front[:1]]
        ids = [performer.id for performer in project.seen] if self.everyone else in_front
        return tuple(
            StreamTarget(id, self.port + place) for place, id in enumerate(ids) if self.port + place <= MOST_PORT
        )
