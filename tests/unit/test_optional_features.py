"""Each feature in `app.optional_features`, with the folders of the same name, can be removed."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from app.optional_features import FEATURES
from tests.unit.test_imports import modules

ROOT = Path(__file__).parents[2]
QUARTET = ROOT / "resources" / "examples" / "quartet.mid"

LEFT_OUT = """
import importlib.abc, sys
from app import optional_features
left_out, statements = sys.argv[1], sys.argv[2]
class Gone(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if left_out in name.split("."):
            raise ModuleNotFoundError(name)
sys.meta_path.insert(0, Gone())
optional_features.FEATURES = tuple(row for row in optional_features.FEATURES if row.id != left_out)
exec(statements)
"""


def run_without(feature: str, statements: str, cwd: Path) -> str:
    """Text printed by a program without a feature's row and folders."""
    command = [sys.executable, "-c", LEFT_OUT, feature, statements]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "QT_QPA_PLATFORM": "offscreen"}
    done = subprocess.run(command, capture_output=True, text=True, cwd=cwd, env=environment, timeout=300)
    assert done.returncode == 0, done.stderr[-3000:]
    return done.stdout


@pytest.mark.parametrize("feature", [row.id for row in FEATURES])
def test_nothing_but_the_table_names_its_modules(feature: str) -> None:
    own = rf"(?:app|widgets|instrument_maps|metadata|resources)\.(?:\w+\.)*{feature}\b"
    imports = re.compile(rf"^\s*(?:from {own}|import {own}|from [\w.]+ import (?:.*\W)?{feature}\b)", re.MULTILINE)
    found = [
        name
        for name, path in modules().items()
        if {feature, f"build_{feature}"}.isdisjoint(name.split(".")) and imports.search(path.read_text("utf-8"))
    ]
    assert found == []


@pytest.mark.parametrize("feature", [row.id for row in FEATURES])
def test_every_other_module_loads_and_a_player_is_exported_without_it(feature: str, tmp_path: Path) -> None:
    others = [name for name in modules() if name.startswith(("app.", "widgets.")) and feature not in name.split(".")]
    arguments = ["export", str(QUARTET), "--to", "out", "--format", "bvh", "--to-bar", "1", "--player", "Trumpet 1"]
    printed = run_without(
        feature,
        f"import importlib\nfrom app.cli import main\nassert main({arguments}) == 0\n"
        f"for name in {others}: importlib.import_module(name)\n"
        "from app.shell.action_rows import rows\nprint(*(row.id for row in rows()))",
        tmp_path,
    )
    row = next(row for row in FEATURES if row.id == feature)
    assert row.actions_after in printed.splitlines()[-1].split()
    assert list((tmp_path / "out").glob("*.bvh"))
