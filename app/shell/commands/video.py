"""Commands of the reference video: its display and its start time."""

from __future__ import annotations

from app.editor.session import Session
from app.editor.video_state import Placement
from app.errors import Message
from app.project.edit.piece import set_video
from app.shell.action import Action
from app.shell.editor import Editor, EditorAction


def remove_video(session: Session) -> None:
    """Remove the reference video from the project, as one undoable step."""
    session.attempt(Message("edit.remove_video"), lambda project: set_video(project, None))


def _has_video(session: Session) -> bool:
    return session.project.video is not None


def _can_estimate(editor: Editor) -> bool:
    session = editor.session
    return session.video.ratio > 0.0 and session.project.score.end_tick > 0


def _placement(placement: Placement) -> Action:
    return Action(
        f"video.{placement}",
        lambda session, on: session.video.set(placement=placement),
        "view/video",
        enabled=_has_video,
        checked=lambda session: _has_video(session) and session.video.placement == placement,
    )


ACTIONS: tuple[Action | EditorAction, ...] = (
    _placement("beside"),
    _placement("behind"),
    _placement("hidden"),
    EditorAction(
        "video.estimate_offset",
        lambda editor: editor.video.estimate(),
        "view/video",
        enabled=_can_estimate,
        icon="offset",
    ),
    Action("video.remove", remove_video, "view/video", enabled=_has_video, icon="remove"),
)
