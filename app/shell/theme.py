"""How Qt looks: the palette, the style sheet and the font, all from the design tokens."""

from __future__ import annotations

import atexit
import sys
from contextlib import ExitStack
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from PySide6.QtGui import QColor, QFont, QFontDatabase, QPalette
from PySide6.QtWidgets import QApplication, QStyleFactory

from app.editor.tokens import LEAST_TARGET_PX, LEAST_TEXT_PT, Tokens
from app.formats.scratch import scratch_folder
from widgets.common.icons import source

FAINT = 0.6
"""How much of dim text is left in what cannot be used now."""
FONT_SIZE_PT = 9.5
JAPANESE_FAMILIES = (
    "Noto Sans CJK JP",
    "Noto Sans JP",
    "Hiragino Sans",
    "Yu Gothic UI",
    "Meiryo",
    "IPAexGothic",
    "IPAGothic",
    "TakaoPGothic",
    "VL Gothic",
)
"""Where the system's own font lacks Japanese, the first of these that is there: left to chance, a fallback may give
signs their Chinese forms."""


def apply_theme(application: QApplication, tokens: Tokens) -> None:
    """Dress the whole application."""
    if application.style().name().lower() != "fusion":
        application.setStyle(QStyleFactory.create("Fusion"))
    application.setPalette(palette(tokens))
    application.setStyleSheet(style_sheet(tokens, marks(tokens)))


def apply_font(application: QApplication) -> None:
    """The system's font, at least 9 pt, followed by one with Japanese signs."""
    font = QFontDatabase.systemFont(QFontDatabase.SystemFont.GeneralFont)
    known = set(QFontDatabase.families())
    families = [font.family(), *(family for family in JAPANESE_FAMILIES if family in known)]
    if sys.platform.startswith("linux"):
        # Where no desktop names a font, Qt takes a serif or whatever comes first.
        preferred = next((name for name in ("Inter", "Noto Sans", "DejaVu Sans") if name in known), None)
        if preferred and not _desktop_chose(font):
            families[0] = preferred
    font.setFamilies(list(dict.fromkeys(families)))
    font.setPointSizeF(max(FONT_SIZE_PT, float(LEAST_TEXT_PT)))
    font.setStyleHint(QFont.StyleHint.SansSerif)
    application.setFont(font)


def _desktop_chose(font: QFont) -> bool:
    return font.family().lower() not in {"", "sans serif", "sans", "helvetica"}


def palette(tokens: Tokens) -> QPalette:
    """The colours of widgets that the style sheet does not name."""
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


@dataclass(frozen=True)
class Marks:
    """Drawings that a style sheet can only name as files."""

    up: str
    down: str
    down_faint: str
    check: str
    dot: str


@cache
def _folder() -> Path:
    kept = ExitStack()
    atexit.register(kept.close)
    return kept.enter_context(scratch_folder())


@cache
def marks(tokens: Tokens) -> Marks:
    """The drawings in a theme's colours."""
    written = {}
    for name, colour in (
        ("chevron_up", tokens.text_dim),
        ("chevron_down", tokens.text_dim),
        ("chevron_down", faint(tokens)),
        ("check", tokens.accent_text),
        ("by_hand", tokens.accent_text),
    ):
        path = _folder() / f"{name}_{tokens.name}_{colour[1:]}.svg"
        path.write_bytes(source(name, colour))
        written[name, colour] = path.as_posix()
    return Marks(
        up=written["chevron_up", tokens.text_dim],
        down=written["chevron_down", tokens.text_dim],
        down_faint=written["chevron_down", faint(tokens)],
        check=written["check", tokens.accent_text],
        dot=written["by_hand", tokens.accent_text],
    )


def faint(tokens: Tokens) -> str:
    """The colour of what cannot be used now: between dim text and the surface."""
    text, ground = QColor(tokens.text_dim), QColor(tokens.surface)
    mixed = QColor.fromRgbF(
        FAINT * text.redF() + (1.0 - FAINT) * ground.redF(),
        FAINT * text.greenF() + (1.0 - FAINT) * ground.greenF(),
        FAINT * text.blueF() + (1.0 - FAINT) * ground.blueF(),
    )
    return mixed.name()


def style_sheet(t: Tokens, marks: Marks) -> str:
    """Rules for what Fusion draws too loudly: flat, quiet, one accent."""
    hover, off = t.line, faint(t)
    return f"""
/* What Qt makes itself (tips, file dialogs) shows text as it is written, as `widgets.common.plain` does. */
QLabel, QToolTip {{ qproperty-textFormat: PlainText; }}
* {{ outline: none; }}
QToolTip {{ background: {t.raised}; color: {t.text}; border: 1px solid {t.line_strong}; padding: 3px 5px; }}
QMainWindow, QDialog {{ background: {t.surface}; }}
QMainWindow::separator {{ background: {t.sunken}; width: 4px; height: 4px; }}
QMainWindow::separator:hover {{ background: {t.accent}; }}
QMenuBar {{ background: {t.surface}; border-bottom: 1px solid {t.line}; padding: 2px 4px; }}
QMenuBar::item {{ background: transparent; padding: 5px 9px; border-radius: 4px; }}
QMenuBar::item:selected {{ background: {t.line}; }}
QMenu {{ background: {t.raised}; color: {t.text}; border: 1px solid {t.line_strong}; padding: 4px; }}
QMenu::item {{ padding: 5px 26px 5px 10px; border-radius: 3px; min-height: 16px; }}
QMenu::item:selected {{ background: {t.accent}; color: {t.accent_text}; }}
QMenu::item:disabled {{ color: {off}; background: transparent; }}
QMenu::separator {{ height: 1px; background: {t.line}; margin: 4px 6px; }}
QMenu::icon {{ margin-left: 3px; padding: 3px; border: 1px solid transparent; border-radius: 4px; }}
QMenu::icon:checked {{ background: {t.sunken}; border-color: {t.accent}; }}
QMenu::indicator {{ width: 14px; height: 14px; margin-left: 6px; }}
QToolBar {{ background: {t.surface}; border: none; border-bottom: 1px solid {t.line}; spacing: 2px; padding: 2px; }}
QStatusBar {{ background: {t.surface}; border-top: 1px solid {t.line}; }}
QStatusBar::item {{ border: none; }}
QDockWidget {{ color: {t.text_dim}; titlebar-close-icon: none; titlebar-normal-icon: none; }}
QDockWidget > QWidget {{ border: none; }}
QTabBar {{ qproperty-drawBase: 0; }}
QTabBar::tab {{ background: transparent; color: {t.text_dim}; padding: 5px 12px; border: none;
  border-bottom: 2px solid transparent; min-height: 16px; }}
QTabBar::tab:selected {{ color: {t.text}; border-bottom: 2px solid {t.accent}; }}
QTabBar::tab:hover {{ color: {t.text}; }}
QTabBar::tab:focus {{ background: {t.line}; }}
QTabWidget::pane {{ border: none; border-top: 1px solid {t.line}; }}
QToolButton {{ background: transparent; border: 1px solid transparent; border-radius: 4px; padding: 3px; }}
QToolButton:hover {{ background: {hover}; }}
QToolButton:pressed {{ background: {t.sunken}; }}
QToolButton:checked {{ background: {t.sunken}; border-color: {t.line_strong}; color: {t.accent}; }}
QToolButton:focus {{ border-color: {t.accent}; }}
QToolButton::menu-indicator {{ width: 0; height: 0; image: none; }}
QToolButton[popupMode="1"] {{ padding-right: 15px; }}
QToolButton::menu-button {{ border: none; width: 14px; }}
QToolButton::menu-button:hover {{ background: {t.line}; }}
QToolButton::menu-arrow {{ image: url("{marks.down}"); width: 12px; height: 12px; }}
QPushButton {{ background: {t.raised}; color: {t.text}; border: 1px solid {t.line_strong}; border-radius: 4px;
  padding: 4px 12px; min-height: {LEAST_TARGET_PX - 8}px; }}
QPushButton:hover {{ border-color: {t.text_dim}; }}
QPushButton:pressed {{ background: {t.sunken}; }}
QPushButton:checked {{ background: {t.sunken}; border-color: {t.accent}; }}
QPushButton:disabled {{ color: {off}; border-color: {t.line}; background: {t.surface}; }}
QPushButton:focus {{ border-color: {t.accent}; }}
QPushButton:default {{ background: {t.accent}; color: {t.accent_text}; border-color: {t.accent}; }}
QPushButton:default:focus {{ border-color: {t.text}; }}
QPushButton:default:disabled {{ color: {off}; border-color: {t.line}; background: {t.surface}; }}
QPushButton:flat {{ background: transparent; border-color: transparent; }}
QPushButton:flat:hover {{ background: {hover}; }}
QPushButton:flat:focus {{ border-color: {t.accent}; }}
QLineEdit, QPlainTextEdit, QTextEdit, QAbstractSpinBox {{ background: {t.sunken}; color: {t.text};
  border: 1px solid {t.line}; border-radius: 4px; padding: 2px 6px; selection-background-color: {t.accent};
  selection-color: {t.accent_text}; }}
QLineEdit, QAbstractSpinBox {{ min-height: {LEAST_TARGET_PX - 6}px; }}
QLineEdit:hover, QAbstractSpinBox:hover {{ border-color: {t.line_strong}; }}
QLineEdit:focus, QPlainTextEdit:focus, QTextEdit:focus, QAbstractSpinBox:focus {{ border-color: {t.accent}; }}
QLineEdit:disabled, QAbstractSpinBox:disabled {{ color: {off}; background: {t.surface}; }}
QAbstractSpinBox {{ padding-right: 20px; }}
QAbstractSpinBox QLineEdit {{ background: transparent; border: none; padding: 0 0 0 4px; min-height: 0; }}
QAbstractSpinBox::up-button, QAbstractSpinBox::down-button {{ subcontrol-origin: border; width: 18px; border: none;
  background: transparent; }}
QAbstractSpinBox::up-button {{ subcontrol-position: top right; }}
QAbstractSpinBox::down-button {{ subcontrol-position: bottom right; }}
QAbstractSpinBox::up-button:hover, QAbstractSpinBox::down-button:hover {{ background: {hover}; }}
QAbstractSpinBox::up-arrow {{ image: url("{marks.up}"); width: 10px; height: 10px; }}
QAbstractSpinBox::down-arrow {{ image: url("{marks.down}"); width: 10px; height: 10px; }}
QAbstractItemView QLineEdit {{ padding: 0 3px; min-height: 0; }}
QComboBox {{ background: {t.raised}; color: {t.text}; border: 1px solid {t.line}; border-radius: 4px;
  padding: 2px 6px 2px 8px; min-height: {LEAST_TARGET_PX - 6}px; }}
QComboBox:hover {{ border-color: {t.line_strong}; }}
QComboBox:focus {{ border-color: {t.accent}; }}
QComboBox:disabled {{ color: {off}; background: {t.surface}; border-color: {t.line}; }}
QComboBox::drop-down {{ border: none; width: 20px; }}
QComboBox::down-arrow {{ image: url("{marks.down}"); width: 14px; height: 14px; }}
QComboBox::down-arrow:disabled {{ image: url("{marks.down_faint}"); }}
QComboBox QAbstractItemView {{ background: {t.raised}; border: 1px solid {t.line_strong};
  selection-background-color: {t.accent}; selection-color: {t.accent_text}; padding: 3px; }}
QAbstractItemView {{ background: {t.sunken}; alternate-background-color: {t.surface}; border: 1px solid {t.line};
  selection-background-color: {t.accent}; selection-color: {t.accent_text}; }}
QHeaderView::section {{ background: {t.surface}; color: {t.text_dim}; border: none; border-bottom: 1px solid {t.line};
  padding: 4px 8px; }}
QTableCornerButton::section {{ background: {t.surface}; border: none; border-bottom: 1px solid {t.line}; }}
QTreeView::item, QListView::item, QTableView::item {{ min-height: {LEAST_TARGET_PX}px; }}
QScrollArea, QScrollArea > QWidget > QWidget {{ background: transparent; border: none; }}
QScrollBar:vertical {{ background: transparent; width: 12px; margin: 0; }}
QScrollBar:horizontal {{ background: transparent; height: 12px; margin: 0; }}
QScrollBar::handle {{ background: {t.line_strong}; border-radius: 4px; margin: 2px; }}
QScrollBar::handle:vertical {{ min-height: 28px; }}
QScrollBar::handle:horizontal {{ min-width: 28px; }}
QScrollBar::handle:hover {{ background: {t.text_dim}; }}
QScrollBar::add-line, QScrollBar::sub-line {{ width: 0; height: 0; }}
QScrollBar::add-page, QScrollBar::sub-page {{ background: transparent; }}
QProgressBar {{ background: {t.sunken}; color: transparent; border: none; border-radius: 3px; max-height: 6px;
  min-height: 6px; }}
QProgressBar::chunk {{ background: {t.accent}; border-radius: 3px; }}
QSplitter::handle {{ background: {t.line}; }}
QSplitter::handle:hover {{ background: {t.accent}; }}
QGroupBox {{ border: 1px solid {t.line}; border-radius: 5px; margin-top: 9px; padding-top: 7px; }}
QGroupBox::title {{ subcontrol-origin: margin; left: 8px; padding: 0 4px; color: {t.text_dim}; }}
QCheckBox, QRadioButton {{ min-height: {LEAST_TARGET_PX}px; spacing: 7px; }}
QCheckBox::indicator, QRadioButton::indicator, QAbstractItemView::indicator {{ width: 14px; height: 14px;
  background: {t.sunken}; border: 1px solid {t.text_dim}; border-radius: 3px; }}
QRadioButton::indicator {{ border-radius: 8px; }}
QCheckBox::indicator:hover, QRadioButton::indicator:hover {{ border-color: {t.text}; }}
QCheckBox:disabled, QRadioButton:disabled {{ color: {off}; }}
QCheckBox::indicator:focus, QRadioButton::indicator:focus {{ border-color: {t.accent}; }}
QCheckBox:focus, QRadioButton:focus {{ color: {t.accent}; }}
QCheckBox::indicator:checked, QAbstractItemView::indicator:checked {{ background: {t.accent}; border-color: {t.accent};
  image: url("{marks.check}"); }}
QRadioButton::indicator:checked {{ background: {t.accent}; border-color: {t.accent}; image: url("{marks.dot}"); }}
QCheckBox::indicator:disabled, QRadioButton::indicator:disabled {{ background: {t.surface}; border-color: {t.line}; }}
QDialogButtonBox {{ dialogbuttonbox-buttons-have-icons: 0; }}
"""
