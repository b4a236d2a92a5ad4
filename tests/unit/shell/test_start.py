"""Modules that the first picture does not need are not loaded for it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[3]
LATER = ("scipy", "vispy.scene", "app.export", "widgets.dialogs")


def test_the_window_comes_up_without_what_is_needed_later(tmp_path: Path) -> None:
    script = """
import sys
from pathlib import Path
from app.shell.app import Program, make_application
from app.editor.settings import Settings
application = make_application()
program = Program(Settings(Path(sys.argv[1])), audible=False)
program.window.show()
application.processEvents()
print(" ".join(sys.modules))
program.end()
"""
    run = subprocess.run(
        [sys.executable, "-c", script, str(tmp_path / "editor.toml")],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    loaded = run.stdout.split()
    assert "widgets.viewport.panel" in loaded
    known = ("widgets.dialogs.texts",)
    assert [
        one for one in loaded if one.startswith(LATER) and one != "widgets.dialogs" and not one.startswith(known)
    ] == []
