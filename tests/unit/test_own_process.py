"""Processes of our own run our own code."""

from __future__ import annotations

import subprocess
from pathlib import Path

from app.own_process import own_process


def test_what_lies_where_it_is_started_is_not_run(tmp_path: Path) -> None:
    for name in ("json", "ufbx", "app"):
        (tmp_path / f"{name}.py").write_text("import os; os._exit(77)")
    command, environment = own_process("app.formats.fbx.foreign_child", str(tmp_path / "none.fbx"))
    done = subprocess.run(command, env=environment, cwd=tmp_path, stdout=subprocess.PIPE, check=False)
    assert done.returncode == 3
    assert b"none.fbx" in done.stdout or b"not found" in done.stdout.lower()
