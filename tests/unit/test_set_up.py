"""The set-up of ``./run`` asks at a terminal before installing system packages, and never asks without one."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SCRIPT = """
asks={asks}
source packaging/set-up.sh
dpkg-query() {{ false; }}
id() {{ echo 0; }}
apt-get() {{ echo "apt-get $*" >&2; }}
need_packages some-package
echo done
"""

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="packages of Debian")


def at_terminal(asks: str, typed: bytes) -> str:
    """Run the script at a pseudo-terminal with typed input and return its output."""
    import pty

    child, terminal = pty.fork()
    if child == 0:
        os.chdir(ROOT)
        os.execvp("bash", ["bash", "-c", SCRIPT.format(asks=asks)])
    os.write(terminal, typed)
    shown = b""
    try:
        while data := os.read(terminal, 1000):
            shown += data
    except OSError:
        pass  # Linux ends a terminal without a process in this way.
    os.waitpid(child, 0)
    os.close(terminal)
    return shown.decode()


@pytest.mark.parametrize(
    ("typed", "installs"),
    [
        *((typed, False) for typed in (b"n\n", b"\x04", b"quit\n", "いいえ\n".encode())),
        *((typed, True) for typed in (b"\n", b"y\n", b"YES\n", "はい\n".encode())),
    ],
)
def test_a_person_is_asked(typed: bytes, installs: bool) -> None:
    shown = at_terminal("1", typed)
    assert "Install the Debian packages some-package?" in shown
    assert ("apt-get install" in shown) == installs
    assert "done" in shown


def test_the_checks_do_not_ask() -> None:
    shown = at_terminal("", b"\n")
    assert "?" not in shown
    assert "apt-get install" in shown


def test_the_options_of_the_checks_are_shown_without_a_set_up() -> None:
    """An exported variable has no effect, since it is unset."""
    text = (ROOT / "test").read_text("utf-8")
    shown = subprocess.run([ROOT / "test", "--help"], capture_output=True, text=True, timeout=30, check=True)
    assert shown.stderr == ""
    assert all(f"\n{option}" in shown.stdout for option in ("--quick", "--bench", "--versions", "--fuzz"))
    assert text.index("unset asks") < text.index("source ")


def test_nobody_is_asked_without_a_terminal() -> None:
    found = subprocess.run(
        ["bash", "-c", SCRIPT.format(asks="1")],
        cwd=ROOT,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=30,
        check=True,
    )
    assert "?" not in found.stderr
    assert "apt-get install" in found.stderr
    assert found.stdout == "done\n"
