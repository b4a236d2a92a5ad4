"""The theme."""

from widgets.common.session import Session


def test_session_opens_with_the_quartet(session: Session) -> None:
    assert len(session.project.players) == 4
