"""Kinds of marks (`app.score.marks`) by name, and what is to be said of marks written by hand."""

from __future__ import annotations

from typing import Final

PREFIX: Final = "mark."
WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "mark.slur": ("Slur", "スラー"),
    "mark.non_legato": ("Non legato", "ノン・レガート"),
    "mark.staccato": ("Staccato", "スタッカート"),
    "mark.staccatissimo": ("Staccatissimo", "スタッカーティシモ"),
    "mark.tenuto": ("Tenuto", "テヌート"),
    "mark.accent": ("Accent", "アクセント"),
    "mark.marcato": ("Marcato", "マルカート"),
    "mark.breath": ("Breath mark", "ブレス記号"),
    "mark.caesura": ("Caesura", "カエスーラ"),
    "mark.fermata": ("Fermata", "フェルマータ"),
    "mark.dynamic": ("Dynamic", "強弱記号"),
    "mark.crescendo": ("Crescendo", "クレッシェンド"),
    "mark.diminuendo": ("Diminuendo", "ディミヌエンド"),
    "mark.double_tongue": ("Double tonguing", "ダブルタンギング"),
    "mark.triple_tongue": ("Triple tonguing", "トリプルタンギング"),
    "mark.flutter_tongue": ("Flutter tonguing", "フラッタータンギング"),
    "mark.grace": ("Grace note", "装飾音"),
    "mark.trill": ("Trill", "トリル"),
    "mark.mordent": ("Mordent", "モルデント"),
    "mark.turn": ("Turn", "ターン"),
    "mark.tremolo": ("Tremolo", "トレモロ"),
    "mark.scoop": ("Scoop", "スクープ"),
    "mark.plop": ("Plop", "プロップ"),
    "mark.doit": ("Doit", "ドイト"),
    "mark.fall": ("Fall", "フォール"),
    "mark.glissando": ("Glissando", "グリッサンド"),
    "mark.stopped": ("Stopped", "ゲシュトップ"),
    "mark.open": ("Open", "オープン"),
    "mark.fingering": ("Fingering", "運指記号"),
    "mark.position": ("Slide position", "スライド・ポジション"),
    "mark.holds_up_to": ("{mark} holds up to {place}.", "{mark} は {place} まで有効です。"),
    "mark.holds_to_the_end": (
        "{mark} holds to the end of the piece: no dynamic follows.",
        "{mark} は曲の終わりまで有効です（後に強弱記号がありません）。",
    ),
    "mark.no_notes": ("Select notes first.", "先に音符を選択してください。"),
    "mark.one_note": (
        "Select at least two notes of one player for this mark.",
        "この記号を付けるには、同じ奏者の音符を 2 個以上選択してください。",
    ),
}
