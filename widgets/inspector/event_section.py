"""Section with the selected events: time, amount and reason, which can be edited as numbers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import msgspec
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QGridLayout, QWidget

from app.editor.edit_names import OF_EVENTS, edit_at_events, edit_of_events
from app.editor.selection import EventKey
from app.editor.session import Session
from app.errors import Argument, Message
from app.plan.by_hand.corrections import PoseCorrection
from app.plan.cues.cues import LEAD_BEATS
from app.plan.event_id import EventId
from app.plan.events_by_hand import PoseEvent, StyleEvent
from app.plan.kinds import GESTURE_KINDS
from app.plan.model import CueEvent, ExpressionEvent, GestureEvent, PlayerPlan
from app.project.edit import events as edit
from app.project.edit.corrections import with_corrections
from app.project.edit.events import Placed
from app.project.model import Project
from widgets.common.combo import Combo, Option
from widgets.common.controls import Retranslated, named
from widgets.common.event_names import expression_name, kind_name, style_name
from widgets.common.layouts import in_column
from widgets.common.number_slider import NumberSlider
from widgets.common.plain import Label
from widgets.common.section import Section
from widgets.common.text import message_text
from widgets.inspector.by_hand import ByHandLine
from widgets.inspector.generated_values import Generated
from widgets.inspector.inspected_selection import selected_events
from widgets.inspector.words import amount_field, event_text, event_title

EARLIEST, LATEST = -(2.0**31), 2.0**31
ANGLES = ("up_deg", "left_deg", "roll_deg")
_WORDS: Final = {
    "start_tick": ("event_section.start", "", "event_section.bar_beat_ticks"),
    "end_tick": ("event_section.end", "", "event_section.bar_beat_ticks"),
    "start_s": ("", "event_section.seconds", "event_section.start_in_seconds_of_performance"),
    "end_s": ("", "event_section.seconds", "event_section.end_in_seconds_of_performance"),
    "amount": ("event_section.amount", "", ""),
    "beats": (
        "event_section.preparatory_beat",
        "event_section.beats",
        "event_section.cue_lead_tip",
    ),
    "up_deg": ("event_section.up", "°", "event_section.raised_leaning_back_or_elbow"),
    "left_deg": ("event_section.left", "°", "event_section.turned_to_players_left"),
    "roll_deg": ("event_section.roll", "°", "event_section.leaning_to_players_left"),
    "fade_in_s": ("event_section.fade_in", "event_section.seconds", "event_section.fade_in_tip"),
    "fade_out_s": (
        "event_section.fade_out",
        "event_section.seconds",
        "event_section.fade_out_tip",
    ),
}
"""Text ids of label, unit and tool tip of each number."""


class EventSection(Retranslated, QWidget):
    """Shows and edits the selected events of one kind."""

    def __init__(self, session: Session, generated: Generated, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session, self._generated = session, generated
        self._plan: PlayerPlan | None = None
        self._events: tuple[Placed, ...] = ()
        self._section = Section(session, "inspector_event", self)
        self._numbers: dict[str, NumberSlider] = {}
        self._expression = self.texted(named(Combo(), "event_expression"), tip="event_section.expression_tip")
        self._length, self._why = Label(), Label()
        self._by_hand = named(ByHandLine(session), "event_by_hand")
        self._build()
        self._connect()
        self.retranslate()

    def _number(
        self,
        name: str,
        low: float,
        high: float,
        step: float,
        decimals: int,
        slides: bool,
        fills: tuple[float, float] | None = None,
    ) -> NumberSlider:
        slider = NumberSlider(self._session, low, high, step=step, decimals=decimals, slides=slides, fills=fills)
        slider.setObjectName(f"event_{name}")
        slider.released.connect(self._session.document.end_gesture)
        self._numbers[name] = self.texted(slider, words=_WORDS[name])
        return slider

    def _build(self) -> None:
        grid = QGridLayout()
        grid.setSpacing(4)
        for column, side in enumerate(("start", "end")):
            grid.addWidget(self._number(f"{side}_tick", EARLIEST, LATEST, 30, 0, False), 0, column)
            grid.addWidget(self._number(f"{side}_s", -1e6, 1e6, 0.01, 3, False), 1, column)
        body = self._section.body
        body.addLayout(grid)
        body.addWidget(self._length)
        body.addWidget(self._expression)
        body.addWidget(self._number("amount", 0, 1, 0.05, 2, True))
        body.addWidget(self._number("beats", 0.25, 8, 0.25, 2, True))
        for angle in ANGLES:
            body.addWidget(self._number(angle, -60, 60, 1, 1, True))
        fades = QGridLayout()
        fades.setSpacing(4)
        for column, name in enumerate(("fade_in_s", "fade_out_s")):
            fades.addWidget(self._number(name, 0, 60, 0.05, 2, True, fills=(0.0, 3.0)), 0, column)
        body.addLayout(fades)
        body.addWidget(self._by_hand)
        body.addWidget(self._why)
        self._why.setWordWrap(True)
        self._why.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        in_column(self._section, of=self, margins=0)

    def _connect(self) -> None:
        for side in ("start", "end"):
            ticks, seconds = self._numbers[f"{side}_tick"], self._numbers[f"{side}_s"]
            ticks.show_as_place()
            ticks.changed.connect(lambda value, token, side=side: self._set_side(side, round(value), token))
            seconds.changed.connect(lambda value, token, side=side: self._set_side_s(side, value, token))
        self._numbers["amount"].changed.connect(self._set_amount)
        self._numbers["beats"].changed.connect(self._set_beats)
        for angle in ANGLES:
            self._numbers[angle].changed.connect(lambda value, token, name=angle: self._set_angle(name, value, token))
        for name in ("fade_in_s", "fade_out_s"):
            self._numbers[name].changed.connect(lambda value, token, name=name: self._set_fade(name, value, token))
        self._expression.chosen.connect(self._set_expression)
        self._by_hand.reverted.connect(self._revert)
        self._session.theme_changed.connect(self._apply_theme)
        self._apply_theme()

    # Display

    def show_events(self) -> bool:
        """Show the selected events, and return whether there are any."""
        found = selected_events(self._session)
        self._plan, self._events = found if found is not None else (None, ())
        self.setVisible(bool(self._events))
        if self._plan is None or not self._events:
            return False
        first = self._events[0]
        made = self._generated_event(first)
        player = self._session.project.player(self._plan.player_id)
        title = event_title(first)
        if len(self._events) > 1:
            title = self.tr("event_section.text").format(
                count=len(self._events), what=kind_name(EventId.parse(first.id).kind)
            )
        self._section.header.set_texts(title, player.name)
        self._show_places(first, made)
        self._show_amounts(first, made)
        self._show_reason(first, made)
        return True

    def _show_places(self, first: Placed, made: Placed | None) -> None:
        grid = float(self._session.grid.step_ticks(self._session.project.score.metre_map))
        usual = made if made is not None else first
        for side in ("start", "end"):
            for unit in ("tick", "s"):
                name = f"{side}_{unit}"
                values = [float(getattr(event, name)) for event in self._events]
                default = float(getattr(usual, name))
                slider = self._numbers[name]
                apart = abs(values[0] - default) > 1e-6
                slider.show_value(values[0], mixed=len(set(values)) > 1, default=default, by_hand=apart)
                if unit == "tick":
                    slider.set_step(max(grid, 1.0))
                # The time of an entry belongs to the note; a cue's own time is its preparatory beat.
                slider.setVisible(not isinstance(first, CueEvent) or side == "end")
                slider.setEnabled(not isinstance(first, CueEvent))
        self._numbers["end_tick"].set_texts(
            self.tr("event_section.entry") if isinstance(first, CueEvent) else self.tr("event_section.end"),
            "",
            self.tr("event_section.bar_beat_ticks"),
        )
        length_s = first.end_s - first.start_s
        self._length.setText(
            self.tr("event_section.s_long").format(seconds=f"{length_s:.2f}")
            if not isinstance(first, CueEvent)
            else self.tr("event_section.preparatory_beat_lasts_s").format(seconds=f"{first.beat_s:.2f}")
        )

    def _show_amounts(self, first: Placed, made: Placed | None) -> None:
        field = amount_field(first)
        self._show_number("amount", field, made)
        low = -1.0 if isinstance(first, GestureEvent) and GESTURE_KINDS[first.kind].signed else 0.0
        self._numbers["amount"].set_range(low, 1.0)
        if field is not None:
            self._numbers["amount"].set_texts(self._amount_word(field))
        is_pose, is_face = isinstance(first, PoseEvent), isinstance(first, ExpressionEvent)
        is_style = isinstance(first, StyleEvent)
        for name in ("fade_in_s", "fade_out_s"):
            self._show_number(name, name if is_pose or is_face or is_style else None, made)
        for angle in ANGLES:
            # An elbow rotates about one axis only.
            has = is_pose and (angle == "up_deg" or "elbow" not in getattr(first, "target", ""))
            self._show_number(angle, angle if has else None, made)
        beats = self._numbers["beats"]
        beats.setVisible(isinstance(first, CueEvent))
        if isinstance(first, CueEvent):
            usual = _cue_beats(made, self._session.project) if isinstance(made, CueEvent) else 1.0
            beats.show_value(_cue_beats(first, self._session.project), default=usual)
        self._expression.setVisible(is_face or is_style)
        if is_style:
            names = {event.style for event in self._events if isinstance(event, StyleEvent)}
            known = sorted(self._session.performance.metadata.styles.items, key=style_name)
            self._expression.set_options([Option(name, style_name(name)) for name in dict.fromkeys((*known, *names))])
            self._expression.show_option(names.pop() if len(names) == 1 else None)
        if is_face:
            faces = self._session.performance.expressions
            self._expression.set_options([Option(name, expression_name(name)) for name in faces])
            names = {event.expression for event in self._events if isinstance(event, ExpressionEvent)}
            self._expression.show_option(names.pop() if len(names) == 1 else None)

    def _show_number(self, name: str, field: str | None, made: Placed | None) -> None:
        slider = self._numbers[name]
        slider.setVisible(field is not None)
        if field is None:
            return
        values = [round(float(getattr(event, field)), 4) for event in self._events]
        default = float(getattr(made, field)) if made is not None else values[0] if name not in ANGLES else 0.0
        slider.show_value(
            values[0], mixed=len(set(values)) > 1, default=default, by_hand=abs(values[0] - default) > 5e-4
        )

    def _show_reason(self, first: Placed, made: Placed | None) -> None:
        corrected = [event for event in self._events if event.corrected]
        reason = made if made is not None and first.corrected else first
        template = self.tr("event_section.generator") if reason is not first else self.tr("event_section.why")
        self._why.setText(
            template.format(
                reason=message_text(reason.reason, self._session, self._plan.player_id if self._plan else None)
            )
        )
        if not corrected:
            self._by_hand.hide()
            return
        waits = self._plan is not None and self._generated.plan(self._plan.player_id) is None
        score = self._session.project.score
        # Fingerings are shown with their notes.
        before = None if waits else "" if made is None else event_text(score, made, "")
        self._by_hand.show_values(before, event_text(score, first, ""))

    def _generated_event(self, event: Placed) -> Placed | None:
        """Return the event that the generator makes without the correction of an event; None if there is none."""
        if self._plan is None:
            return None
        player_id = self._plan.player_id
        bare = self._generated.plan(player_id)
        if bare is None:
            return None
        said = edit.corrections_of(self._session.project, player_id, (event.id,))
        ids = [*(item.left_out for item in said if item.left_out is not None), event.id]
        return next(iter(edit.placed_events(bare, ids)), None)

    # Editing

    def _ids(self) -> tuple[str, ...]:
        return tuple(event.id for event in self._events)

    def _edit(
        self,
        name: str,
        change: Callable[[Project, PlayerPlan], Project],
        token: object | None = None,
        **more: Argument,
    ) -> None:
        plan = self._plan
        if plan is None:
            return
        keys = [EventKey(plan.player_id, event.id) for event in self._events]
        if name in OF_EVENTS:
            message = edit_of_events(self._session, name, keys)
        elif name == "edit.give_back":
            message = edit_at_events(self._session, name, keys)
        else:
            message = Message(name, more)
        if not self._session.attempt(message, lambda project: change(project, plan), token):
            self.show_events()

    def _set_side(self, side: str, tick: int, token: object | None) -> None:
        events = self._events

        def changed(project: Project, plan: PlayerPlan) -> Project:
            for event in events:
                by = tick - (event.start_tick if side == "start" else event.end_tick)
                ids = (event.id,)
                if side == "start":
                    project = edit.resize(project, plan, ids, start_ticks=by)
                else:
                    project = edit.resize(project, plan, ids, end_ticks=by)
            return project

        self._edit("edit.resize_events", changed, token)

    def _set_side_s(self, side: str, value: float, token: object | None) -> None:
        self._set_side(side, round(self._session.project.score.tempo_map.ticks(value)), token)

    def _set_amount(self, value: float, token: object | None) -> None:
        amounts = dict.fromkeys(self._ids(), value)
        self._edit("edit.set_event_amounts", lambda project, plan: edit.set_amounts(project, plan, amounts), token)

    def _set_beats(self, value: float, token: object | None) -> None:
        events = [event for event in self._events if isinstance(event, CueEvent)]

        def changed(project: Project, plan: PlayerPlan) -> Project:
            for event in events:
                start = event.end_tick - round(LEAD_BEATS * value * project.metre_map.felt_ticks_at(event.end_tick))
                project = edit.resize(project, plan, (event.id,), start_ticks=start - event.start_tick)
            return project

        self._edit("edit.resize_events", changed, token)

    def _set_angle(self, name: str, value: float, token: object | None) -> None:
        ids = self._ids()

        def changed(project: Project, plan: PlayerPlan) -> Project:
            said = edit.corrections_of(project, plan.player_id, ids)
            poses = [
                msgspec.structs.replace(item, **{name: value}) for item in said if isinstance(item, PoseCorrection)
            ]
            return with_corrections(project, plan.player_id, poses)

        self._edit("edit.set_event_amounts", changed, token)

    def _set_fade(self, name: str, value: float, token: object | None) -> None:
        ids = self._ids()
        self._edit("edit.set_fades", lambda project, plan: edit.set_fades(project, plan, ids, **{name: value}), token)

    def _set_expression(self, name: str) -> None:
        ids = self._ids()
        if any(isinstance(event, StyleEvent) for event in self._events):
            self._edit("edit.set_style", lambda project, plan: edit.set_style(project, plan, ids, name), style=name)
            return
        self._edit("edit.set_expression", lambda project, plan: edit.set_expression(project, plan, ids, name))

    def _revert(self) -> None:
        ids = self._ids()
        self._edit("edit.give_back", lambda project, plan: edit.give_back(project, plan.player_id, ids))

    # Texts

    def _amount_word(self, field: str) -> str:
        return {
            "depth": self.tr("event_section.depth"),
            "amount": self.tr("event_section.amount"),
            "strength": self.tr("event_section.strength"),
        }[field]

    def _apply_theme(self) -> None:
        for label in (self._why, self._length):
            label.setStyleSheet(f"color: {self._session.tokens.text_dim};")

    def retranslate(self) -> None:
        self.show_events()


def _cue_beats(event: CueEvent, project: Project) -> float:
    return round((event.end_tick - event.start_tick) / LEAD_BEATS / project.metre_map.felt_ticks_at(event.end_tick), 2)
