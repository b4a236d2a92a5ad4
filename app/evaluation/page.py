"""The questionnaire: a single HTML file with clips, questions and both languages that needs no network.

It contains codes only. Titles and all other texts are data that is shown as text and never interpreted as markup.
"""

from __future__ import annotations

import base64
import html
import json
import os
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Any, Final

from app.evaluation.design import Order
from app.evaluation.key import SCALES, STEPS, EvaluationKey
from app.messages import LANGUAGES, WORDINGS

PAGE_FILE: Final = "evaluation.html"
_TEXTS: Final = "evaluate.page_"
_RESOURCES: Final = "evaluation"


def page(key: EvaluationKey, table: Sequence[Order], clips: Path) -> bytes:
    """Return the HTML page of the questionnaire.

    Parameters
    ----------
    key : EvaluationKey
        Key; only codes, aspects, evaluation id and title are written to the page.
    table : sequence of Order
        Order of clips for every viewer.
    clips : path
        Folder with the files ``c01.mp4`` (``c01-c02.mp4`` for pairs as in the key) and ``practice.mp4``.
    """
    data: dict[str, Any] = {
        "evaluation": key.evaluation,
        "piece": key.piece,
        "aspects": key.aspects,
        "scales": SCALES,
        "steps": STEPS,
        "languages": LANGUAGES,
        "texts": {language: _texts(index) for index, language in enumerate(LANGUAGES)},
        "orders": [[[shown.left, shown.right] if shown.right else [shown.left] for shown in order] for order in table],
        "clips": {file.stem: _base64(file) for file in _shown_files(table, clips)},
    }
    folder = files("resources") / _RESOURCES
    template = Template((folder / "page.html").read_text(encoding="utf-8"))
    title, hint = WORDINGS[f"{_TEXTS}title"], WORDINGS[f"{_TEXTS}no_script"]
    filled = template.substitute(
        title=html.escape(title[0]),
        no_script="".join(f"<p>{html.escape(text)}</p>" for text in hint),
        style=(folder / "page.css").read_text(encoding="utf-8"),
        script=(folder / "page.js").read_text(encoding="utf-8"),
        data=_in_markup(data),
    )
    return filled.encode()


def _texts(index: int) -> dict[str, str]:
    return {id.removeprefix(_TEXTS): wording[index] for id, wording in WORDINGS.items() if id.startswith(_TEXTS)}


def _shown_files(table: Sequence[Order], clips: Path) -> list[Path]:
    """List the video files that viewers see; a pair with exchanged sides counts as the same file."""
    names = {"practice"}
    for shown in {shown for order in table for shown in order}:
        turned = f"{shown.right}-{shown.left}"
        there = f"{shown.left}-{shown.right}" if shown.right else shown.left
        names.add(turned if os.path.isfile(clips / f"{turned}.mp4") else there)
    return [clips / f"{name}.mp4" for name in sorted(names)]


def _base64(file: Path) -> str:
    return base64.b64encode(file.read_bytes()).decode("ascii")


def _in_markup(data: dict[str, Any]) -> str:
    """Return JSON that browsers do not interpret as the end of a script or as markup."""
    text = json.dumps(data, ensure_ascii=False, separators=(",", ":"))
    for character in "<>&\u2028\u2029":
        text = text.replace(character, f"\\u{ord(character):04x}")
    return text
