"""Score of how well a few typed letters fit a name."""

from __future__ import annotations


def fitness(query: str, text: str) -> float | None:
    """Return how well a query fits a text; None: not at all.

    Its letters must all be there in their order. The start of a word and letters that follow one another count more;
    short texts count more than long ones.

    Parameters
    ----------
    query, text : str
        Case does not count; blanks part the query into words that may stand in any order.
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
    # Letters strewn about are chance.
    return total if total >= 0.5 * len(word) else None


def _starts(text: str, index: int) -> bool:
    return index == 0 or not text[index - 1].isalnum()
