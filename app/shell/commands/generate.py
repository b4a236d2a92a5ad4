"""Commands that generate another random variation of the performance. Ordinary generation runs by itself after every
edit.
"""

from __future__ import annotations

from app.editor.edit_names import edit_of_players
from app.editor.session import Session
from app.errors import Message
from app.project.edit import generation
from app.shell.action import Action
from app.shell.commands.command_targets import has_everyone, selected_ticks

LOST = "correction.orphaned"


def vary_everyone(session: Session) -> None:
    """Generate another variation for all players; manual corrections stay."""
    if session.attempt(Message("edit.vary_everyone"), generation.vary_everyone):
        _report(session, tuple(player.id for player in session.project.players))


def vary_players(session: Session) -> None:
    """Generate another variation for the selected players; manual corrections stay."""
    chosen = session.players
    name = edit_of_players(session.project, "edit.vary_players", chosen)
    if session.attempt(name, lambda project: generation.vary_players(project, chosen)):
        _report(session, chosen)


def vary_bars(session: Session) -> None:
    """Generate another variation of the selected bars for the selected players; manual corrections stay."""
    chosen, span = session.players, selected_ticks(session)
    if span is None:
        return
    if session.attempt(
        Message("edit.vary_span"), lambda project: generation.vary_span(project, chosen, span[0], span[1])
    ):
        _report(session, chosen)


def unvary_bars(session: Session) -> None:
    """Return the selected bars of the selected players to the original variation."""
    chosen, span = session.players, selected_ticks(session)
    if span is not None:
        session.attempt(
            Message("edit.unvary_span"), lambda project: generation.unvary_span(project, chosen, span[0], span[1])
        )


def _report(session: Session, player_ids: tuple[str, ...]) -> None:
    """Report the number of corrections that were preserved as soon as the new plans exist."""

    def say() -> None:
        performance, project = session.performance, session.project
        if performance.project is not project:
            return
        if waiting:
            session.performance_changed.disconnect(say)
        known = [player_id for player_id in player_ids if any(player.id == player_id for player in project.players)]
        lost = sum(
            problem.message.id == LOST
            for player_id in known
            for problem in performance.plan(project.player(player_id)).problems
        )
        kept = len(generation.by_hand(project, known)) - lost
        rule = "generate.kept_and_lost" if lost else "generate.kept"
        session.notice(Message(rule, {"kept": kept, "lost": lost} if lost else {"kept": kept}))

    waiting = session.performance.project is not session.project
    if waiting:
        session.performance_changed.connect(say)
    else:
        say()


def _has_players(session: Session) -> bool:
    return bool(session.players)


def _has_bars(session: Session) -> bool:
    return bool(session.players) and (session.selection.span is not None or bool(session.selection.notes))


def _has_varied_bars(session: Session) -> bool:
    # Checked last, because finding the players of selected notes examines the whole score.
    if not _has_bars(session) or not any(generation.variations(session.project, own) for own in session.players):
        return False
    span = selected_ticks(session)
    return span is not None and any(
        generation.variations(session.project, player_id, span[0], span[1]) for player_id in session.players
    )


ACTIONS: tuple[Action, ...] = (
    Action("generate.everyone", vary_everyone, "generate", "Ctrl+Alt+G", enabled=has_everyone),
    Action("generate.players", vary_players, "generate", "Ctrl+Shift+G", enabled=_has_players),
    Action("generate.bars", vary_bars, "generate", "Ctrl+G", enabled=_has_bars),
    Action("generate.bars_back", unvary_bars, "generate", enabled=_has_varied_bars),
)
