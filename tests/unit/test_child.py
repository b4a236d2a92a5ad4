"""Child processes of the program run the program's own code."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from pathlib import Path

import pytest

from app.child import MessageChannel, own_process


def test_what_lies_where_it_is_started_is_not_run(tmp_path: Path) -> None:
    for name in ("json", "ufbx", "app"):
        (tmp_path / f"{name}.py").write_text("import os; os._exit(77)")
    options = own_process("app.formats.fbx.foreign_child")
    done = subprocess.run(cwd=tmp_path, input=b"", stdout=subprocess.PIPE, check=False, **options)
    assert (done.returncode, done.stdout) == (3, b"Empty file")


@pytest.mark.skipif(sys.platform == "win32", reason="process groups of POSIX")
def test_ctrl_c_in_the_terminal_is_not_sent_to_them() -> None:
    """A terminal sends it to every process of the foreground group."""
    with subprocess.Popen(
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, **own_process("app.audio.render_process")
    ) as child:
        assert os.getpgid(child.pid) == child.pid != os.getpgid(0)


def test_sending_into_a_channel_closed_meanwhile_says_that_the_other_side_has_ended() -> None:
    """Another thread closes the channel of a process that it ends, as after Ctrl-C."""
    channel: MessageChannel[str] = MessageChannel(str, io.BytesIO(), io.BytesIO())
    channel.hang_up()
    with pytest.raises(BrokenPipeError):
        channel.send("next")
