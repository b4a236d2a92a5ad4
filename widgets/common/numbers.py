"""Reading and writing of numbers in the user's number format."""

from __future__ import annotations

import ast
import math
import operator
import unicodedata
from collections.abc import Callable
from typing import Final

_BINARY: Final[dict[type[ast.operator], Callable[[float, float], float]]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}
_LONGEST = 80
MIXED = "—"
"""Text for several different values."""


def number_from(text: str, unit: str = "") -> float | None:
    """Return the number in a text; None if it is invalid.

    Sums, products and quotients are calculated (``1/3``, ``2 * (4 + 0.5)``); a decimal comma, full-width digits and the
    unit are accepted.
    """
    plain = unicodedata.normalize("NFKC", text).strip().replace("−", "-").replace("×", "*").replace("÷", "/")
    requested_unit = unicodedata.normalize("NFKC", unit).strip()
    if requested_unit and plain.endswith(requested_unit):
        plain = plain[: -len(requested_unit)].rstrip()
    plain = plain.replace(",", ".")
    if not plain or len(plain) > _LONGEST:
        return None
    try:
        value = _worked_out(ast.parse(plain, mode="eval").body)
    except (SyntaxError, ValueError, ZeroDivisionError, OverflowError, MemoryError, RecursionError):
        return None
    return value if math.isfinite(value) else None


def _worked_out(node: ast.expr) -> float:
    if isinstance(node, ast.Constant) and isinstance(node.value, int | float) and not isinstance(node.value, bool):
        return float(node.value)
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.UAdd):
        value = _worked_out(node.operand)
        return -value if isinstance(node.op, ast.USub) else value
    if isinstance(node, ast.BinOp) and type(node.op) in _BINARY:
        return _BINARY[type(node.op)](_worked_out(node.left), _worked_out(node.right))
    raise ValueError("not arithmetic")


def number_text(value: float, decimals: int) -> str:
    """Return a number with some decimals, with a true minus sign and without negative zero."""
    rounded = round(value, decimals) + 0.0
    return f"{rounded:.{decimals}f}".replace("-", "−")
