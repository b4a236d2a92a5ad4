"""Text view in which a guide of the help is read."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Final

from PySide6.QtCore import QPoint, Qt, QUrl, Signal
from PySide6.QtGui import (
    QBrush,
    QColor,
    QImage,
    QResizeEvent,
    QTextBlock,
    QTextBlockFormat,
    QTextCharFormat,
    QTextCursor,
    QTextDocument,
    QTextFormat,
    QTextFrameFormat,
    QTextLength,
    QTextTable,
)
from PySide6.QtWidgets import QFrame, QTextBrowser, QTextEdit

from app.editor.session import Session
from app.shell.help.guides import FEATURES, FOLDER, Guide
from widgets.common.font import FONT_SIZE_PT

SIZES_PT: Final = (8.0, 9.5, 11.0, 12.5, 14.5, 17.0, 20.0)
USUAL_SIZE: Final = SIZES_PT.index(11.0)
assert FONT_SIZE_PT in SIZES_PT
LINE_HEIGHT: Final = 125.0
"""Line height in per cent."""
MARGIN_PX: Final = 22
MARK_OPACITY: Final = 0.3
ABOVE_PX: Final = 6
"""Space in pixels above a heading that is scrolled to the top."""


class GuidePage(QTextBrowser):
    """A text browser for one guide with its pictures.

    Signals
    -------
    followed(QUrl)
        A link of the guide was clicked; its address is unchanged.
    """

    followed = Signal(QUrl)

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.setObjectName("help_page")
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setOpenLinks(False)
        self.anchorClicked.connect(self.followed)
        self.document().setDocumentMargin(MARGIN_PX)
        self._session = session
        self._size = USUAL_SIZE
        self._guide: Guide | None = None
        self._pictures: dict[str, QImage] = {}
        self._apply_size()

    # Guide

    @property
    def guide(self) -> Guide | None:
        """The guide that is displayed; None before the first one."""
        return self._guide

    def show_guide(self, guide: Guide) -> None:
        """Display a guide from its beginning."""
        self._guide = guide
        self._pictures = {}
        self.setExtraSelections([])
        self.document().setMarkdown(guide.markdown, QTextDocument.MarkdownFeature(FEATURES))
        for name in _picture_names(self.document()):
            path = _picture_path(name)
            if path is not None:
                self._pictures[name] = QImage(str(path))
        self._dress()
        self._fit_pictures()
        self.verticalScrollBar().setValue(0)

    def go_to(self, number: int) -> None:
        """Scroll the guide so that the heading of a section, given by its index, is at the top."""
        if self._guide is None:
            return
        block = self.document().findBlockByNumber(self._guide.sections[number].block)
        self._bring_up(block if number else self.document().begin())

    def section_in_sight(self) -> int:
        """Return the index of the section at the top of the view."""
        if self._guide is None:
            return 0
        top = self._block_at_top().blockNumber()
        begun = [number for number, section in enumerate(self._guide.sections) if section.block <= top]
        return begun[-1] if begun else 0

    def mark(self, words: str) -> None:
        """Highlight all places in the guide that match the words of a search."""
        tokens, marked = self._session.tokens, []
        shade = QTextCharFormat()
        ground = QColor(tokens.accent)
        ground.setAlphaF(MARK_OPACITY)
        shade.setBackground(ground)
        for word in words.split():
            cursor = self.document().find(word)
            while not cursor.isNull():
                selection = QTextEdit.ExtraSelection()
                selection.cursor, selection.format = cursor, shade
                marked.append(selection)
                cursor = self.document().find(word, cursor)
        self.setExtraSelections(marked)

    # Appearance

    def zoom(self, steps: int) -> None:
        """Make the font larger or smaller by steps; 0 restores the default size."""
        self._size = min(max(self._size + steps, 0), len(SIZES_PT) - 1) if steps else USUAL_SIZE
        self._keep_place(self._apply_size)

    def apply_theme(self) -> None:
        """Colour the guide by the theme, keeping the scroll position."""
        if self._guide is not None:
            self._keep_place(self._dress)

    def _apply_size(self) -> None:
        font = self.font()
        font.setPointSizeF(SIZES_PT[self._size])
        self.setFont(font)
        self.document().setDefaultFont(font)

    def _dress(self) -> None:
        """Set the line height of the guide's text, and plain styles for tables, code and links."""
        tokens, document = self._session.tokens, self.document()
        cursor = QTextCursor(document)
        cursor.beginEditBlock()
        spaced = QTextBlockFormat()
        spaced.setLineHeight(LINE_HEIGHT, QTextBlockFormat.LineHeightTypes.ProportionalHeight.value)
        code = QTextBlockFormat()
        code.setBackground(QColor(tokens.raised))
        link = QTextCharFormat()
        link.setForeground(QColor(tokens.accent))
        for block in _blocks(document):
            cursor.setPosition(block.position())
            look = block.blockFormat()
            is_code = look.nonBreakableLines() or look.hasProperty(QTextFormat.Property.BlockCodeFence.value)
            cursor.mergeBlockFormat(code if is_code else spaced)
            for start, length, letters in _fragments(block):
                if letters.isAnchor():
                    cursor.setPosition(start)
                    cursor.setPosition(start + length, QTextCursor.MoveMode.KeepAnchor)
                    cursor.mergeCharFormat(link)
        for frame in document.rootFrame().childFrames():
            if isinstance(frame, QTextTable):
                table = frame.format()
                table.setBorder(1)
                table.setBorderCollapse(True)
                table.setBorderStyle(QTextFrameFormat.BorderStyle.BorderStyle_Solid)
                table.setBorderBrush(QBrush(QColor(tokens.line_strong)))
                table.setCellPadding(5)
                table.setWidth(QTextLength(QTextLength.Type.PercentageLength, 100))
                frame.setFormat(table)
        cursor.endEditBlock()

    def _fit_pictures(self) -> None:
        """Shrink pictures that are wider than the page to its width."""
        ratio = self.devicePixelRatioF()
        room = self.viewport().width() - 2 * MARGIN_PX
        for name, picture in self._pictures.items():
            width = min(picture.width(), max(round(room * ratio), 1))
            fitted = (
                picture.scaledToWidth(width, Qt.TransformationMode.SmoothTransformation)
                if width < picture.width()
                else picture.copy()
            )
            fitted.setDevicePixelRatio(ratio)
            self.document().addResource(QTextDocument.ResourceType.ImageResource.value, QUrl(name), fitted)
        if self._pictures:
            self.document().markContentsDirty(0, self.document().characterCount())

    # Position

    def _block_at_top(self) -> QTextBlock:
        return self.cursorForPosition(QPoint(MARGIN_PX, self.fontMetrics().height())).block()

    def _bring_up(self, block: QTextBlock) -> None:
        top = self.document().documentLayout().blockBoundingRect(block).y()
        self.verticalScrollBar().setValue(0 if block.blockNumber() == 0 else round(top) - ABOVE_PX)

    def _keep_place(self, change: Callable[[], None]) -> None:
        block = self._block_at_top()
        change()
        self._bring_up(block)

    # Qt overrides

    def loadResource(self, kind: int, name: QUrl | str) -> object:
        """Return None for every resource, since pictures are added to the document directly and nothing else may be
        loaded.
        """
        return None

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if event.size().width() != event.oldSize().width():
            self._keep_place(self._fit_pictures)


def _fragments(block: QTextBlock) -> Iterator[tuple[int, int, QTextCharFormat]]:
    """Yield the pieces of a block with uniform format: position, length, format."""
    fragments = block.begin()
    while not fragments.atEnd():
        fragment = fragments.fragment()
        yield fragment.position(), fragment.length(), fragment.charFormat()
        fragments += 1


def _blocks(document: QTextDocument) -> Iterator[QTextBlock]:
    block = document.begin()
    while block.isValid():
        yield block
        block = block.next()


def _picture_names(document: QTextDocument) -> set[str]:
    return {
        look.toImageFormat().name()
        for block in _blocks(document)
        for _, _, look in _fragments(block)
        if look.isImageFormat()
    }


def _picture_path(name: str) -> Path | None:
    """Return the path of a picture within the guides' folder; None if it does not exist or lies elsewhere."""
    path = (FOLDER / name).resolve()
    return path if path.is_relative_to(FOLDER.resolve()) and os.path.isfile(path) else None
