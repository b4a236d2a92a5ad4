"""The menu: Import Performance and Update Performance."""

from __future__ import annotations

import functools
import traceback
from collections.abc import Callable
from pathlib import Path

import unreal

from suisou_import import assets, checks, run
from suisou_import.performance import Performance, found, read
from suisou_import.problem import Cancelled, Problem, problem, text

SOURCES = "SuisouSource"
_MENU = "LevelEditor.MainMenu"
_SECTION = "Suisou"


def register() -> None:
    """Add the menu to the editor's menu bar, unless there is no window, as when packaging a project."""
    main = unreal.ToolMenus.get().find_menu(_MENU)
    if main is None:
        return
    menu = main.add_sub_menu("Suisou", "", "Suisou", text("title"), "")
    # The menu runs only these two lines, so the name of a piece never becomes code.
    _add(menu, "import", "from suisou_import import menu; menu.import_performance()")
    _add(menu, "update", "from suisou_import import menu; menu.update_performance()")
    unreal.ToolMenus.get().refresh_all_widgets()


def import_performance() -> None:
    """Import exported performances that the project lacks."""
    _guarded(_import_new)


def update_performance() -> None:
    """Update imported performances to the present export."""
    _guarded(_update)


def _import_new() -> None:
    everything = _everything()
    new = [performance for performance in everything if assets.existing(performance.sequence) is None]
    if not new:
        raise problem("nothing_new", names=", ".join(performance.title for performance in everything))
    _bring_in(new, "ask_import", "done_import")


def _update() -> None:
    there = [performance for performance in _everything() if assets.existing(performance.sequence) is not None]
    if not there:
        raise problem("nothing_imported")
    _bring_in(there, "ask_update", "done_update")


def _everything() -> list[Performance]:
    """All readable performances; the others are reported."""
    checks.check_engine()
    project = unreal.Paths.convert_relative_path_to_full(unreal.Paths.project_dir())
    folder = Path(project) / SOURCES
    everything: list[Performance] = []
    problems: list[str] = []
    for path in found(folder):
        try:
            everything.append(read(path))
        except Problem as error:
            problems.append(str(error))
    if not everything:
        raise Problem("\n\n".join(problems)) if problems else problem("nothing_exported", folder=folder)
    if problems:
        _show("\n\n".join([text("others_go_on"), *problems]))
    return everything


def _bring_in(performances: list[Performance], question: str, done: str) -> None:
    for performance in _chosen(performances, question):
        if not _guarded(functools.partial(_bring_in_one, performance, done)):
            return


def _bring_in_one(performance: Performance, done: str) -> None:
    reported = run.bring_in(performance)
    run.show(performance)
    first = text(done, name=performance.title, count=len(performance.assets), folder=performance.content)
    _show("\n".join([first, *([""] if reported else []), *reported]))


def _chosen(performances: list[Performance], question: str) -> list[Performance]:
    """Performances that the user chooses; the only one without a question."""
    if len(performances) == 1:
        return performances
    chosen: list[Performance] = []
    answers = unreal.AppReturnType
    for index, performance in enumerate(performances):
        asked = text(question, name=performance.title)
        answer = unreal.EditorDialog.show_message(text("title"), asked, unreal.AppMsgType.YES_NO_YES_ALL_NO_ALL_CANCEL)
        if answer == answers.YES_ALL:
            return chosen + performances[index:]
        if answer == answers.YES:
            chosen.append(performance)
        elif answer == answers.NO_ALL:
            return chosen
        elif answer != answers.NO:
            raise Cancelled
    return chosen


def _guarded(action: Callable[[], None]) -> bool:
    """Call a function and show problems in a dialog; return False if the user pressed Cancel."""
    try:
        action()
    except Problem as error:
        _show(str(error))
    except Cancelled:
        _show(text("cancelled"))
        return False
    except Exception as error:
        unreal.log_error(traceback.format_exc())
        _show(text("fault", detail=f"{type(error).__name__}: {error}"))
    return True


def _show(message: str) -> None:
    if not hasattr(unreal, "EditorDialog"):
        # The plug-in that provides it is disabled; the message says so.
        unreal.log_error(message)
        return
    unreal.EditorDialog.show_message(text("title"), message, unreal.AppMsgType.OK)


def _add(menu: unreal.ToolMenu, name: str, command: str) -> None:
    entry = unreal.ToolMenuEntry(name=f"Suisou.{name}", type=unreal.MultiBlockType.MENU_ENTRY)
    entry.set_label(text(name))
    entry.set_tool_tip(text(name + "_tip"))
    entry.set_string_command(unreal.ToolMenuStringCommandType.PYTHON, "", command)
    menu.add_menu_entry(_SECTION, entry)
