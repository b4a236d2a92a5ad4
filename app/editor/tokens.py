"""Design tokens: the one table of colours and sizes that Qt and vispy are drawn from.

Player colours are Okabe and Ito's (2008, "Color Universal Design"), distinguished by colour-blind eyes, lightened for
the dark surface and darkened for the light one.
"""

from __future__ import annotations

import msgspec


class Tokens(msgspec.Struct, frozen=True):
    """Colours as ``#rrggbb``.

    Attributes
    ----------
    surface, raised, sunken : str
        Panels; what stands out of them (buttons, headers); what lies in them (fields, lanes).
    line, line_strong : str
        Hairlines and bar lines.
    text, text_dim : str
    accent, accent_text : str
        Selection, focus, the playhead; text upon it.
    by_hand : str
        The mark of what the user made.
    warning, error, good : str
    players : tuple of str
    """

    name: str
    surface: str
    raised: str
    sunken: str
    line: str
    line_strong: str
    text: str
    text_dim: str
    accent: str
    accent_text: str
    by_hand: str
    warning: str
    error: str
    good: str
    players: tuple[str, ...]

    def player(self, index: int) -> str:
        """The colour of a project's n-th player."""
        return self.players[index % len(self.players)]


DARK = Tokens(
    name="dark",
    surface="#23252a",
    raised="#2e3138",
    sunken="#1a1c20",
    line="#363a42",
    line_strong="#4d535e",
    text="#e3e5e9",
    text_dim="#9aa1ad",
    accent="#559fea",
    accent_text="#0b1620",
    by_hand="#f2c14e",
    warning="#f0a13c",
    error="#f27a6a",
    good="#57bd84",
    players=("#56b4e9", "#e69f00", "#2fbf93", "#e58bbd", "#f0e442", "#4d8fe0", "#ee7d3b", "#b7bcc6"),
)
LIGHT = Tokens(
    name="light",
    surface="#f4f5f7",
    raised="#ffffff",
    sunken="#e9ebef",
    line="#d3d7de",
    line_strong="#aab1bd",
    text="#1d2127",
    text_dim="#5b6472",
    accent="#1a65b5",
    accent_text="#ffffff",
    by_hand="#8c5a00",
    warning="#9f5300",
    error="#c0392b",
    good="#1b7446",
    players=("#1478b5", "#b37400", "#00805c", "#b0508a", "#8a7f00", "#0a5fa8", "#b84a00", "#5b6472"),
)
THEMES = {tokens.name: tokens for tokens in (DARK, LIGHT)}

LEAST_TEXT_PT = 9
LEAST_TARGET_PX = 24
