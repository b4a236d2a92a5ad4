"""The search for how instruments are held, which may take minutes: it shows how far it is, and Ctrl-C ends it."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from app.cli import main
from app.cli.status import STOPPED
from app.performance import bodies, ensemble
from tests.unit.cli.test_main import QUARTET


class Terminal(io.StringIO):
    """Keeps what is written to it."""

    def isatty(self) -> bool:
        return True


TROMBONE = "trombone_tenor_F_attachment"


@pytest.mark.parametrize(
    ("command", "first"),
    [
        pytest.param(["export", str(QUARTET), "--to", "out", "--player", "Trombone 2"], TROMBONE, id="export"),
        pytest.param(["stream", str(QUARTET), "--player", "Trombone 2"], TROMBONE, id="stream"),
        # What a body cannot reach is judged of all players.
        pytest.param(["inspect", str(QUARTET)], "trumpet_Bb", id="inspect"),
    ],
)
def test_the_search_shows_progress_and_ends_at_ctrl_c(
    command: list[str], first: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    searched: list[str] = []

    def stopped(character: Any, model: Any, instrument: Any, body: Any, reported: Callable[[float], None]) -> None:
        searched.append(instrument.id)
        reported(0.5)
        raise KeyboardInterrupt

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(bodies, "hold_for", stopped)
    monkeypatch.setattr(bodies, "_HOLDS", bodies.IdentityCache(8))
    monkeypatch.setattr(ensemble, "is_held", lambda player, instrument: False)
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    assert main(command) == STOPPED
    # Of one player no other's hold is searched.
    assert searched == [first]
    assert "0 %  how the instruments are held" in terminal.getvalue()
    assert list(tmp_path.iterdir()) == []
