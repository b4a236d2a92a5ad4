"""Texts of the help window, the help buttons and the first steps: id -> English and Japanese."""

from __future__ import annotations

from typing import Final

TEXTS: Final[dict[str, tuple[str, str]]] = {
    "help_window.back": ("Back (Alt+Left)", "戻る (Alt+←)"),
    "help_window.contents": ("Contents", "目次"),
    "help_window.forward": ("Forward (Alt+Right)", "進む (Alt+→)"),
    "help_window.larger": ("Larger text (Ctrl++)", "文字を大きく (Ctrl++)"),
    "help_window.leads_outside": ("Not one of the guides: {path}", "ガイド以外のファイルです: {path}"),
    "help_window.no_hits": ("No matches in the guides.", "ガイド内に一致する箇所がありません。"),
    "help_window.not_opened": ("This kind of link is not opened: {link}", "この種類のリンクは開きません: {link}"),
    "help_window.not_translated": (
        "This guide is only available in English.",
        "このガイドの日本語版はまだありません。英語版を表示しています。",
    ),
    "help_window.search": ("Search guides", "ガイドを検索"),
    "help_window.smaller": ("Smaller text (Ctrl+-)", "文字を小さく (Ctrl+-)"),
    "help_window.title": ("{guide} - Suisou Guides", "{guide} - Suisou ガイド"),
}
