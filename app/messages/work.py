"""Work in the background: what is being done. Registered by name as every module of messages is."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "work.cancelled": ("cancelled: {work}", "中止しました: {work}"),
    "work.open": ("opening…", "開いています…"),
    "work.save": ("saving…", "保存中…"),
    "work.autosave": ("autosaving…", "自動保存中…"),
    "work.recoverable": ("checking for unsaved changes…", "未保存の変更を確認中…"),
    "work.clean_up": ("removing temporary files…", "一時ファイルを削除中…"),
    "work.plan": ("planning {players} players…", "{players} 人の演奏を計画中…"),
    "work.hold": ("fitting instruments to {players} players…", "{players} 人の楽器の持ち方を計算中…"),
    "work.metadata": ("reading your styles and expressions…", "自分のスタイルと表情を読み込み中…"),
    "work.instruments": ("reading your instruments…", "自分の楽器を読み込み中…"),
    "work.load_figures": ("loading characters…", "キャラクターを読み込み中…"),
    "work.compare": ("generating {player} for comparison…", "{player} を比較のため生成中…"),
    "work.learn": ("learning {file}…", "{file} を学習中…"),
    "work.reimport": ("re-importing the file…", "ファイルを再読み込み中…"),
    "work.portraits": ("creating character thumbnails…", "サムネイルを作成中…"),
    "work.choreography": ("loading choreography…", "振り付けを読み込み中…"),
    "work.generated_curve": ("sampling generated motion…", "生成された動きを計算中…"),
    "work.dances": ("generating dances…", "ダンスを生成中…"),
    "work.stream": ("resolving {host}…", "{host} を検索中…"),
    "work.character": ("reading {file}…", "{file} を読み込み中…"),
    "work.character_add": ("adding {name}…", "{name} を追加中…"),
    "work.character_picture": ("creating character thumbnail…", "サムネイルを作成中…"),
    "work.characters": ("reading your characters…", "自分のキャラクターを読み込み中…"),
    "work.export": ("exporting files…", "ファイルを書き出し中…"),
    "work.compare_skeleton": ("comparing skeletons with {file}…", "スケルトンを {file} と比較中…"),
    "work.export_midi": ("exporting MIDI…", "MIDI を書き出し中…"),
    "work.playblast": ("creating video…", "動画を作成中…"),
    "work.evaluation": ("creating evaluation…", "評価を作成中…"),
    "work.synthesise": ("synthesising audio…", "音声を合成中…"),
    "work.read_motion": ("reading {file}…", "{file} を読み込み中…"),
    "work.read_recording": ("reading {file}…", "{file} を読み込み中…"),
    "work.read_video": ("reading {file}…", "{file} を読み込み中…"),
    "work.follow_recording": ("following the recording…", "音源に追従中…"),
    "work.estimate_offset": ("estimating audio offset…", "音源のオフセットを推定中…"),
}
