"""The status line: running work, messages, problems, the last save, frame rate and progress of the motion."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable
from functools import partial

from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QFontMetrics
from PySide6.QtWidgets import QProgressBar, QPushButton, QStatusBar, QWidget

from app.editor.files import Files
from app.editor.recording import NO_DEVICE
from app.editor.session import Session, Severity
from app.editor.tasks import Task, ThreadTasks
from app.errors import Message
from app.shell.notices import NoticeList, severity_colour
from app.shell.task_row import BAR_PX, TaskRow, close_button, show_value
from instrument_maps.library import library
from widgets.common.actions import actions
from widgets.common.clicks import on_click
from widgets.common.controls import Retranslated, named
from widgets.common.icons import icon
from widgets.common.layouts import STRETCH, in_row, panel
from widgets.common.plain import Label, verbatim
from widgets.common.text import message_text, sentence

POLL_MS, AGE_MS = 100, 5000
"""Intervals in milliseconds at which the progress of work and the age of the last save are updated."""
QUIET_S = 0.25
"""Work of fewer seconds is not shown, since it would only flash."""
MOST_TASKS = 3
"""Greatest number of running tasks shown, the oldest first, so that names are not cut off."""
INFORMATION_S = 6.0
"""Seconds for which an information is shown; warnings and errors stay until closed or replaced."""
MOST_NOTICES = 100


class StatusLine(Retranslated, QStatusBar):
    """The window's status line.

    Parameters
    ----------
    tasks : ThreadTasks or None
        Background tasks whose progress is shown; None to show none.
    """

    def __init__(self, session: Session, files: Files, tasks: ThreadTasks | None, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("status")
        self.setSizeGripEnabled(False)
        self._session, self._files, self._tasks = session, files, tasks
        self._seen_s: dict[Task, float] = {}
        self._shown: tuple[Task, ...] = ()
        self._rows: dict[Task, TaskRow] = {}
        self._log: deque[tuple[Message, Severity]] = deque(maxlen=MOST_NOTICES)
        self._frames: deque[float] = deque(maxlen=120)
        self._ready = 1.0
        self._reported_device: tuple[object, ...] = ()

        # Side by side at the left, however much room there is.
        self._work_line = in_row(STRETCH, margins=(4, 0, 0, 0), spacing=10)
        self._work = panel(self._work_line)
        self._notice = _flat("notice", self._unfold)
        self._notice.setMinimumWidth(120)
        self._notice.setStyleSheet("text-align: left; padding: 3px 6px;")
        self._dismiss = close_button(session, "status_line.close_this_notice", self.dismiss, "dismiss_notice")
        for widget in (self._work, self._notice, self._dismiss):
            self.addWidget(widget)
        self._notice.hide()
        self._dismiss.hide()
        self._risk = _flat("unsaved_at_risk", files.save_as)
        self._instruments = _flat("instrument_problems", partial(self._do, "application.instruments"))
        self._device = _flat("midi_device", partial(self._do, "record.devices"))
        self._stream = _flat("stream_state", partial(self._do, "stream.settings"))
        self._problems = self.texted(
            _flat("problems", partial(self._do, "problems.next")), tip="status_line.go_to_next_problem"
        )
        self._saved, self._rate = named(Label(), "saved"), named(Label(), "frame_rate")
        self._motion, self._motion_bar = named(Label(), "motion"), named(QProgressBar(), "motion_ready")
        self._motion_bar.setTextVisible(False)
        self._motion_bar.setFixedWidth(BAR_PX)
        # One step for each pixel: more steps would redraw the whole window at each value.
        self._motion_bar.setRange(0, BAR_PX)
        self._about_piece = (self._saved, self._problems, self._rate, self._motion, self._motion_bar)
        for widget in (self._risk, self._instruments, self._device, self._stream, *self._about_piece):
            self.addPermanentWidget(widget)
        self._details = NoticeList(session, self)
        self._had_piece = False
        self._gone_to = session.problem
        self._fade, self._poll, self._age = QTimer(self), QTimer(self), QTimer(self)
        self._fade.setSingleShot(True)
        self._fade.timeout.connect(self._fade_away)
        self._poll.setInterval(POLL_MS)
        self._poll.timeout.connect(self._look)
        self._age.timeout.connect(self._report_saved)
        self._age.start(AGE_MS)
        self._listen()
        self.texted(self._motion, tip="status_line.motion_progress_tip")
        self.retranslate()

    def _listen(self) -> None:
        session, files = self._session, self._files
        session.noticed.connect(self.report)
        session.problem_changed.connect(self._follow_problem)
        session.performance_changed.connect(self._report_problems)
        session.problems_changed.connect(self._report_problems)
        session.instruments_changed.connect(self._report_instruments)
        session.recording.changed.connect(self._report_device)
        session.streaming.changed.connect(self._report_stream)
        session.theme_changed.connect(self.retranslate)
        session.playing_changed.connect(self._played)
        files.changed.connect(self._report_saved)
        files.opened.connect(self._opened)
        if self._tasks is not None:
            self._tasks.changed.connect(self._tasks_changed)

    def _do(self, action_id: str) -> None:
        actions(self._session)[action_id].trigger()

    # Work

    def _tasks_changed(self) -> None:
        self._look()
        if self._tasks is not None and self._tasks.running and not self._poll.isActive():
            self._poll.start()

    def _look(self) -> None:
        running = self._tasks.running if self._tasks is not None else ()
        now_s = time.monotonic()
        self._seen_s = {task: self._seen_s.get(task, now_s) for task in running}
        seen = [task for task in running if now_s - self._seen_s[task] >= QUIET_S]
        names = [task.name for task in seen]
        shown = tuple(task for number, task in enumerate(seen) if task.name not in names[:number])[:MOST_TASKS]
        if shown != self._shown:
            self._show_tasks(shown)
        for task, row in self._rows.items():
            row.set_share(task.share)
        if not running:
            self._poll.stop()

    def _show_tasks(self, shown: tuple[Task, ...]) -> None:
        self._shown = shown
        for task in [task for task in self._rows if task not in shown]:
            row = self._rows.pop(task)
            self._work_line.removeWidget(row)
            row.hide()
            row.deleteLater()
        for task in shown:
            if task not in self._rows and self._tasks is not None:
                row = TaskRow(self._session, task, partial(self._tasks.cancel, task))
                self._rows[task] = row
                self._work_line.insertWidget(self._work_line.count() - 1, row)
        self._work.setVisible(bool(shown))

    # Notices

    def report(self, message: Message, severity: Severity) -> None:
        """Show a message in the status line for a while, and add it to the log."""
        # Dragging to a place that accepts nothing would repeat the notice at each movement of the mouse.
        if not self._log or self._log[-1] != (message, severity):
            self._log.append((message, severity))
        self._show_notice()
        self._fade.stop()
        if severity is Severity.INFORMATION:
            self._begin_fade()

    def _begin_fade(self) -> None:
        self._fade.start(round(INFORMATION_S * 1000))

    def _fade_away(self) -> None:
        if self._details.isVisible():
            # The list is open, so notices are being read.
            self._begin_fade()
        else:
            self.dismiss()

    def _show_notice(self) -> None:
        message, severity = self._log[-1]
        text = sentence(message, self._session)
        room_px = max(self.width() // 2, 240)
        first = text.splitlines()[0] if text else ""
        shown = QFontMetrics(self._notice.font()).elidedText(first, Qt.TextElideMode.ElideRight, room_px)
        self._notice.setText(verbatim(f" {shown}"))
        self._notice.setIcon(
            icon(severity.value, self._session.tokens, severity_colour(severity, self._session.tokens))
        )
        self._notice.setToolTip(self.tr("status_line.all_notices_tip"))
        self._notice.show()
        self._dismiss.show()

    def dismiss(self) -> None:
        """Hide the message; it remains in the list."""
        self._notice.hide()
        self._dismiss.hide()
        self._details.hide()

    @property
    def notice_text(self) -> str:
        """Return the text of the message on display; empty if there is none."""
        return "" if self._notice.isHidden() else message_text(self._log[-1][0], self._session)

    def _follow_problem(self) -> None:
        """Hide the message about a problem when the problem is solved, or update its text when the problem changes."""
        before, self._gone_to = self._gone_to, self._session.problem
        if before is None or self._notice.isHidden() or self._log[-1] != (before[1].message, Severity.WARNING):
            return
        if self._gone_to is None:
            self.dismiss()
        elif self._gone_to[1].message != before[1].message:
            self.report(self._gone_to[1].message, Severity.WARNING)

    def _forget_device(self, port: str, is_open: bool) -> None:
        """Hide a warning about a MIDI device when the device works, or is no longer the chosen one."""
        if self._notice.isHidden() or self._log[-1][1] is Severity.INFORMATION:
            return
        message = self._log[-1][0]
        if message.id == "record.no_device":
            if port:
                self.dismiss()
            return
        device = message.arguments.get("device", message.arguments.get("port"))
        if message.id in NO_DEVICE or (message.id.startswith("record.") and device is not None):
            # A problem of the whole MIDI system names no device.
            is_wanted = bool(port) and device in (None, port)
            if is_open or not is_wanted:
                self.dismiss()

    def _unfold(self) -> None:
        self._details.open_over(self._notice, tuple(self._log))

    # Right side

    def _opened(self) -> None:
        if self._had_piece:
            # Notices of the previous piece do not apply to this one.
            self.dismiss()
        self._had_piece = self._files.is_open
        self._report_piece()

    def _report_piece(self) -> None:
        for widget in self._about_piece:
            widget.setVisible(self._files.is_open)
        self._report_saved()
        self._report_problems()
        self._report_motion()

    def _report_problems(self) -> None:
        count = problem_count(self._session) if self._files.is_open else 0
        tokens = self._session.tokens
        self._problems.setVisible(self._files.is_open)
        self._problems.setIcon(icon("warning" if count else "check", tokens, tokens.warning if count else tokens.good))
        text = self.tr("status_line.problems").format(count=count) if count else self.tr("status_line.no_problems")
        self._problems.setText(f" {text}")

    def _report_instruments(self) -> None:
        """Report faulty instrument files, again whenever another message has replaced the report, until all are
        corrected.
        """
        wrong = library().problems
        tokens = self._session.tokens
        self._instruments.setVisible(bool(wrong))
        self._instruments.setIcon(icon("error", tokens, tokens.error))
        self._instruments.setText(" " + self.tr("status_line.faulty_instruments").format(count=len(wrong)))
        reported = "\n".join(sentence(problems[0], self._session) for problems in wrong.values())
        self._instruments.setToolTip(reported + "\n\n" + self.tr("status_line.show_instruments"))

    def _report_device(self) -> None:
        """Show the name of the MIDI recording device and whether it is connected; nothing if none is chosen."""
        recording, tokens = self._session.recording, self._session.tokens
        reported = (recording.port, recording.connection, bool(recording.ports), tokens.name)
        if reported == self._reported_device:
            return
        self._reported_device = reported
        self._forget_device(recording.port, recording.connection == "open")
        self._device.setVisible(bool(recording.port or recording.ports))
        text, name, colour = {
            "none": (self.tr("status_line.choose_midi_device"), "record", tokens.text_dim),
            "waiting": (self.tr("status_line.waiting_for"), "record", tokens.text_dim),
            "open": (self.tr("status_line.connected"), "record", tokens.good),
            "lost": (self.tr("status_line.unplugged"), "warning", tokens.warning),
            "refused": (self.tr("status_line.cannot_be_opened"), "error", tokens.error),
        }[recording.connection]
        self._device.setIcon(icon(name, tokens, colour))
        room_px = max(self.width() // 6, 120)
        device = QFontMetrics(self._device.font()).elidedText(recording.port, Qt.TextElideMode.ElideMiddle, room_px)
        self._device.setText(verbatim(" " + text.format(device=device)))
        self._device.setToolTip(self.tr("status_line.midi_devices_tip"))

    def _report_stream(self) -> None:
        """Show the format and rate of the live stream of poses; hide the label while nothing is streamed."""
        streaming, tokens = self._session.streaming, self._session.tokens
        self._stream.setVisible(streaming.state != "off")
        lines = streaming.lines
        ports = f"{lines[0].port}–{lines[-1].port}" if len(lines) > 1 else str(streaming.port)
        text, colour = {
            "off": ("", tokens.text_dim),
            "looking": (self.tr("status_line.looking_for"), tokens.text_dim),
            "sending": (self.tr("status_line.vmc_to_s"), tokens.good),
            "no_receiver": (self.tr("status_line.vmc_no_receiver_at"), tokens.warning),
            "failed": (self.tr("status_line.vmc_cannot_be_reached"), tokens.error),
        }[streaming.state]
        room_px = max(self.width() // 8, 100)
        host = QFontMetrics(self._stream.font()).elidedText(streaming.host, Qt.TextElideMode.ElideMiddle, room_px)
        self._stream.setIcon(icon("stream", tokens, colour))
        self._stream.setText(verbatim(" " + text.format(host=host, ports=ports, rate=streaming.sent_hz)))
        names = {one.id: one.name for one in self._session.project.performers}
        who = [f"{names[line.player_id]}: {line.port}" for line in lines if line.player_id in names]
        self._stream.setToolTip("\n".join([*who, "", self.tr("status_line.stream_tip")]).strip())

    def _report_risk(self) -> None:
        """Show a warning while unsaved work cannot be written to a recovery file."""
        risk, tokens = self._files.risk, self._session.tokens
        self._risk.setVisible(risk is not None)
        if risk is not None:
            self._risk.setIcon(icon("error", tokens, tokens.error))
            self._risk.setText(" " + self.tr("status_line.unsaved_work_at_risk_save"))
            self._risk.setToolTip(sentence(risk, self._session))

    def _report_saved(self) -> None:
        self._report_risk()
        files = self._files
        if not files.is_open:
            self._saved.clear()
            return
        if files.saved_s is None:
            self._saved.setText(
                self.tr("status_line.saved") if files.path and files.is_saved else self.tr("status_line.not_saved_yet")
            )
            return
        passed = max(time.monotonic() - files.saved_s, 0.0)
        if passed < 60.0:
            ago = self.tr("status_line.s_ago").format(count=5 * math.floor(passed / 5.0) or 1)
        elif passed < 3600.0:
            ago = self.tr("status_line.min_ago").format(count=int(passed // 60))
        else:
            ago = self.tr("status_line.h_ago").format(count=int(passed // 3600))
        template = self.tr("status_line.autosaved") if files.autosaved else self.tr("status_line.saved_2")
        self._saved.setText(template.format(ago=ago))

    def painted(self) -> None:
        """Count a picture that the viewport has drawn, for the display of the frame rate."""
        now_s = time.perf_counter()
        self._frames.append(now_s)
        if self._session.playing and len(self._frames) % 20 == 0:
            recent = [at for at in self._frames if now_s - at <= 1.0]
            if len(recent) > 1:
                rate = round((len(recent) - 1) / (recent[-1] - recent[0]))
                self._rate.setText(self.tr("status_line.fps").format(rate=rate))

    def _played(self, playing: bool) -> None:
        self._frames.clear()
        if not playing:
            self._rate.clear()

    def set_ready(self, share: float) -> None:
        """Show the completed share of the generated motion, 0..1."""
        self._ready = share
        self._report_motion()

    def _report_motion(self) -> None:
        busy = self._ready < 1.0 and self._files.is_open
        self._motion_bar.setVisible(busy)
        show_value(self._motion_bar, int(BAR_PX * self._ready))
        self._motion.setVisible(self._files.is_open)
        self._motion.setText(self.tr("status_line.making_motion") if busy else self.tr("status_line.motion_ready"))

    def retranslate(self) -> None:
        """Set all texts in the editor's language, and the icons in the theme's colours."""
        tokens = self._session.tokens
        for label in (self._saved, self._rate, self._motion):
            label.setStyleSheet(f"color: {tokens.text_dim}; padding: 0 4px;")
        if not self._notice.isHidden():
            self._show_notice()
        self._report_instruments()
        self._reported_device = ()
        self._report_device()
        self._report_stream()
        self._report_piece()


def problem_count(session: Session) -> int:
    """Return the number of problems of all players and dancers that have plans."""
    return sum(len(session.problems(one.id)) for one in session.performance.project.performers)


def _flat(name: str, run: Callable[[], object]) -> QPushButton:
    button = named(QPushButton(), name)
    button.setFlat(True)
    button.setStyleSheet("padding: 3px 6px;")
    on_click(button, run)
    return button
