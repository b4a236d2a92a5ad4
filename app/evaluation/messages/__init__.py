"""Every message about evaluations: id -> templates in English and Japanese."""

from __future__ import annotations

from typing import Final

from app.evaluation.messages import conclusions, make, page, results

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    **conclusions.WORDINGS,
    **make.WORDINGS,
    **page.WORDINGS,
    **results.WORDINGS,
}
