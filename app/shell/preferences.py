"""The preferences dialog, connected to the editor."""

from __future__ import annotations

from functools import partial
from typing import Any

from app.editor.settings import SETTINGS
from app.editor.stored_settings import Setting
from app.editor.translated import tr
from app.shell.action import without_dots
from app.shell.actions import CONTEXTS
from app.shell.editor import Editor
from app.shell.menus import menu_with_keys
from widgets.dialogs.preferences import Choice, PreferencesDialog
from widgets.dialogs.shortcuts import ShortcutRow


def show_preferences(editor: Editor, page: str) -> PreferencesDialog:
    """Open a page of the preferences, whose changes apply immediately.

    Parameters
    ----------
    page : str
        ``"general"`` or ``"shortcuts"``.
    """
    dialog = PreferencesDialog(
        editor.session,
        [_choice(editor, setting) for setting in SETTINGS if setting.label],
        lambda: shortcut_rows(editor),
        editor.table.conflicts,
        menu_with_keys,
        editor.window,
    )
    dialog.shortcut_chosen.connect(editor.table.set_keys)
    dialog.show_page(page)
    dialog.open()
    return dialog


def _choice(editor: Editor, setting: Setting[Any]) -> Choice:
    """Return a preference row for a setting of the session or for the language."""
    session, held = editor.session, setting.held
    if held is None:
        return Choice(
            setting.name, setting.label, setting.options, lambda: editor.settings.language, editor.speak, is_list=True
        )
    return Choice(
        setting.name,
        setting.label,
        setting.options,
        partial(held.get, session),
        partial(held.set, session),
        held.changed(session),
    )


def shortcut_rows(editor: Editor) -> tuple[ShortcutRow, ...]:
    """Return the rows of the list of shortcuts in the editor's language."""
    table = editor.table
    return tuple(
        ShortcutRow(
            id=row.id,
            text=without_dots(row.text),
            place=row.place,
            context=tr(CONTEXTS[row.context]),
            keys=table.keys(row.id),
            default=row.shortcut,
        )
        for row in table.rows.values()
    )
