"""Controls for the players' parameters, made from the declarations of the parameters."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtWidgets import QHBoxLayout

from app.editor.session import Session
from app.plan.parameters import PARAMETERS, Parameter
from widgets.common.combo import Combo
from widgets.common.controls import Caption, Retranslated
from widgets.common.layouts import in_row
from widgets.common.number_slider import NumberSlider

LARGEST = 2**31 - 1
"""Greatest whole number that a control accepts."""


def rows_of(section: str, table: Mapping[str, Parameter] = PARAMETERS) -> list[Parameter]:
    """Return the parameters of a section, in their order from the top."""
    return sorted((one for one in table.values() if one.section == section), key=lambda one: one.row)


class ParameterSlider(Retranslated, NumberSlider):
    """Slider of a numeric parameter; whole numbers are typed."""

    def __init__(self, session: Session, parameter: Parameter, prefix: str = "parameter") -> None:
        low, high = parameter.bounds or (0.0, LARGEST)
        whole = parameter.kind is int
        super().__init__(
            session,
            float(low),
            float(min(high, LARGEST)),
            default=float(parameter.default),
            step=1.0 if whole else parameter.step,
            decimals=0 if whole else parameter.decimals,
            slides=not whole,
            fills=None if whole else (min(low, 0.0), high if parameter.usual is None else parameter.usual),
        )
        self.parameter = parameter
        self.setObjectName(f"{prefix}_{parameter.name}")
        self.texted(self, words=(parameter.label, parameter.unit, parameter.tip))


class ParameterChoice(Combo):
    """Combo box of a parameter with few values; option ids are the values as texts."""

    def __init__(self, parameter: Parameter) -> None:
        super().__init__()
        self.parameter = parameter
        self.values = {str(value): value for value, _ in parameter.choices}
        self.label = Caption(parameter.label, self)
        self.setObjectName(f"parameter_{parameter.name}")

    def line(self) -> QHBoxLayout:
        """Return the row with the label and the combo box."""
        return in_row(self.label, (self, 1), spacing=4)
