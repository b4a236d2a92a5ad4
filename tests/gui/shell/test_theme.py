"""The theme's texts are readable, and its graphics visible."""

from __future__ import annotations

import pytest
from PySide6.QtGui import QColor

from app.editor.design_tokens import THEMES, Tokens
from app.shell.theme import faint, palette

READABLE, VISIBLE = 4.5, 3.0
"""Least contrast ratios of text and of graphics: WCAG 2.2, success criteria 1.4.3 and 1.4.11."""


def luminance(colour: str) -> float:
    """Relative luminance as WCAG defines it."""

    def linear(share: float) -> float:
        return share / 12.92 if share <= 0.04045 else ((share + 0.055) / 1.055) ** 2.4

    red, green, blue = (linear(int(colour[place : place + 2], 16) / 255) for place in (1, 3, 5))
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def contrast(one: str, other: str) -> float:
    lower, higher = sorted((luminance(one), luminance(other)))
    return (higher + 0.05) / (lower + 0.05)


def over(colour: str, opacity: float, ground: str) -> str:
    """A colour upon another."""
    pairs = ((int(colour[place : place + 2], 16), int(ground[place : place + 2], 16)) for place in (1, 3, 5))
    return "#" + "".join(f"{round(opacity * above + (1 - opacity) * below):02x}" for above, below in pairs)


def test_the_oracle() -> None:
    # Pairs whose contrast is published: black on white, and the grey that just passes.
    assert contrast("#000000", "#ffffff") == pytest.approx(21.0)
    assert contrast("#767676", "#ffffff") == pytest.approx(4.54, abs=0.005)


@pytest.mark.parametrize("tokens", THEMES.values(), ids=THEMES)
@pytest.mark.parametrize("ground", ["surface", "raised", "sunken"])
def test_texts_can_be_read(tokens: Tokens, ground: str) -> None:
    below = getattr(tokens, ground)
    for name in ("text", "text_dim", "accent", "by_hand", "warning", "error", "good"):
        assert contrast(getattr(tokens, name), below) >= READABLE, name


@pytest.mark.parametrize("tokens", THEMES.values(), ids=THEMES)
def test_texts_upon_what_is_chosen_can_be_read(tokens: Tokens) -> None:
    assert contrast(tokens.accent_text, tokens.accent) >= READABLE
    # Hovered rows and buttons; rows of the players' list; the fill of a slider, quiet and hovered.
    for ground in (
        tokens.line,
        over(tokens.accent, 0.28, tokens.surface),
        over(tokens.accent, 0.30, tokens.sunken),
        over(tokens.accent, 0.42, tokens.raised),
    ):
        assert contrast(tokens.text, ground) >= READABLE, ground


@pytest.mark.parametrize("tokens", THEMES.values(), ids=THEMES)
def test_what_is_drawn_is_seen(tokens: Tokens) -> None:
    for ground in (tokens.surface, tokens.raised, tokens.sunken):
        for colour in tokens.players:
            assert contrast(colour, ground) >= VISIBLE, (colour, ground)
    # Edges of check boxes, and disabled controls that must stay visible.
    assert contrast(tokens.text_dim, tokens.sunken) >= VISIBLE
    assert contrast(faint(tokens), tokens.surface) >= 2.0


@pytest.mark.parametrize("tokens", THEMES.values(), ids=THEMES)
def test_players_are_distinguished(tokens: Tokens) -> None:
    assert len(set(tokens.players)) == len(tokens.players)
    assert palette(tokens).windowText().color() == QColor(tokens.text)
