"""Theme of Qt: the palette and the style sheet, both from the design tokens."""

from __future__ import annotations

import atexit
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from functools import cache
from importlib.resources import files
from pathlib import Path
from string import Template

import msgspec
from PySide6.QtGui import QColor, QPalette
from PySide6.QtWidgets import QApplication, QStyleFactory

from app.editor.design_tokens import LEAST_TARGET_PX, SPLITTER_PX, Tokens
from app.formats.temporary_folders import scratch_folder
from widgets.common.icons import source

FAINT = 0.6
"""Opacity of the dim text of disabled controls."""


def apply_theme(application: QApplication, tokens: Tokens) -> None:
    """Apply palette and style sheet to the application, unless they are applied already, since Qt polishes every widget
    again.
    """
    rules = style_sheet(tokens)
    if application.styleSheet() == rules:
        return
    if not application.styleSheet():
        application.setStyle(QStyleFactory.create("Fusion"))
    # Removing the rules first makes Qt four times as fast as replacing them.
    application.setStyleSheet("")
    application.setPalette(palette(tokens))
    application.setStyleSheet(rules)


@contextmanager
def unstyled(application: QApplication) -> Iterator[None]:
    """Remove the style sheet while widgets are built and restore it afterwards, since Qt polishes a styled widget again
    whenever its parent changes.
    """
    rules = application.styleSheet()
    application.setStyleSheet("")
    try:
        yield
    finally:
        application.setStyleSheet(rules)


def palette(tokens: Tokens) -> QPalette:
    """Return the palette for widgets without a rule in the style sheet."""
    role, group = QPalette.ColorRole, QPalette.ColorGroup
    result = QPalette()
    for colour_role, colour in (
        (role.Window, tokens.surface),
        (role.WindowText, tokens.text),
        (role.Base, tokens.sunken),
        (role.AlternateBase, tokens.surface),
        (role.ToolTipBase, tokens.raised),
        (role.ToolTipText, tokens.text),
        (role.PlaceholderText, tokens.text_dim),
        (role.Text, tokens.text),
        (role.Button, tokens.raised),
        (role.ButtonText, tokens.text),
        (role.BrightText, tokens.error),
        (role.Light, tokens.line_strong),
        (role.Midlight, tokens.line),
        (role.Mid, tokens.line),
        (role.Dark, tokens.sunken),
        (role.Shadow, tokens.sunken),
        (role.Highlight, tokens.accent),
        (role.HighlightedText, tokens.accent_text),
        (role.Link, tokens.accent),
        (role.LinkVisited, tokens.accent),
        (role.Accent, tokens.accent),
    ):
        result.setColor(colour_role, QColor(colour))
    for colour_role in (role.WindowText, role.Text, role.ButtonText, role.HighlightedText):
        result.setColor(group.Disabled, colour_role, QColor(faint(tokens)))
    result.setColor(group.Disabled, role.Highlight, QColor(tokens.line))
    return result


@cache
def _folder() -> Path:
    kept = ExitStack()
    atexit.register(kept.close)
    return kept.enter_context(scratch_folder())


@cache
def _marks(tokens: Tokens) -> dict[str, str]:
    """Return the paths of icon files drawn in the theme's colours, by the name used in the style sheet, which can only
    name files.
    """
    drawings = {
        "mark_up": ("chevron_up", tokens.text_dim),
        "mark_down": ("chevron_down", tokens.text_dim),
        "mark_down_faint": ("chevron_down", faint(tokens)),
        "mark_check": ("check", tokens.accent_text),
        "mark_dot": ("by_hand", tokens.accent_text),
        "grip_level": ("grip_level", tokens.text_dim),
        "grip_upright": ("grip_upright", tokens.text_dim),
    }
    paths = {}
    for mark, (name, colour) in drawings.items():
        path = _folder() / f"{name}_{tokens.name}_{colour[1:]}.svg"
        path.write_bytes(source(name, colour))
        paths[mark] = path.as_posix()
    return paths


def faint(tokens: Tokens) -> str:
    """Return the colour of disabled controls, which is between dim text and the surface."""
    text, ground = QColor(tokens.text_dim), QColor(tokens.surface)
    mixed = QColor.fromRgbF(
        FAINT * text.redF() + (1.0 - FAINT) * ground.redF(),
        FAINT * text.greenF() + (1.0 - FAINT) * ground.greenF(),
        FAINT * text.blueF() + (1.0 - FAINT) * ground.blueF(),
    )
    return mixed.name()


def style_sheet(tokens: Tokens) -> str:
    """Return Qt's style sheet, filled with the theme's colours, from ``resources/theme.qss``, which makes the Fusion
    style flatter.
    """
    rules = Template((files("resources") / "theme.qss").read_text(encoding="utf-8"))
    sizes = {
        "target_px": LEAST_TARGET_PX,
        "field_px": LEAST_TARGET_PX - 6,
        "tool_px": LEAST_TARGET_PX - 8,
        "splitter_px": SPLITTER_PX,
    }
    return rules.substitute(msgspec.structs.asdict(tokens), faint=faint(tokens), **sizes, **_marks(tokens))
