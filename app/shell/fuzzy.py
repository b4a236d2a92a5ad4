"""Fuzzy matching of a few typed letters with names."""

from __future__ import annotations


def fitness(query: str, text: str) -> float | None:
    """Return a score of how well a query fits a text (higher is better); None if it does not fit.

    All letters of the query must occur in their order. Starts of words and adjacent letters score more, and short texts
    score more than long ones.

    Parameters
    ----------
    query, text : str
        Case is ignored; spaces separate words that may occur in any order.
    """
    text = text.casefold()
    total = 0.0
    for word in query.casefold().split():
        found = _word(word, text)
        if found is None:
            return None
        total += found
    return total - 0.01 * len(text)


def _word(word: str, text: str) -> float | None:
    at = text.find(word)
    if at >= 0:
        best = 2.0 * len(word)
        while at >= 0:
            if _starts(text, at):
                return 3.0 * len(word) + (1.0 if at == 0 else 0.0)
            at = text.find(word, at + 1)
        return best
    total, place = 0.0, -1
    for letter in word:
        following = place + 1
        starts = [index for index in range(following, len(text)) if text[index] == letter and _starts(text, index)]
        if starts:
            at, value = starts[0], 2.5
        elif place >= 0 and text.startswith(letter, following):
            at, value = following, 1.0
        else:
            at, value = text.find(letter, following), 0.1
            if at < 0:
                return None
        total, place = total + value, at
    # Scattered letters match by chance.
    return total if total >= 0.5 * len(word) else None


def _starts(text: str, index: int) -> bool:
    return index == 0 or not text[index - 1].isalnum()
