"""Messages about requests on the command line or in a dialog."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "batch.no_pieces": (
        "there is no piece in {folder}: no .mid, .midi or .suisou file",
        "{folder} に曲がありません（.mid、.midi、.suisou ファイルがありません）",
    ),
    "batch.unreal": (
        "the pieces of a folder go into a folder: use --to",
        "フォルダーの曲はフォルダーに書き出します。--to を指定してください",
    ),
    "batch.bad_notes": (
        "{file} is damaged ({detail}): it was set aside as {aside}, and every piece is exported again",
        "{file} が壊れているため（{detail}）、{aside} に退避し、すべての曲を書き出し直します",
    ),
    "dask.missing": (
        "--scheduler needs the package distributed, which is not installed: pip install distributed",
        "--scheduler には distributed パッケージが必要です: pip install distributed",
    ),
    "dask.unreachable": (
        "no Dask scheduler answers at {address}: {reason}",
        "{address} の Dask スケジューラーに接続できません: {reason}",
    ),
    "dask.no_workers": (
        "the Dask scheduler at {address} has no workers; start some with: dask worker {address}",
        "{address} の Dask スケジューラーにワーカーがありません。次のコマンドで起動してください: dask worker {address}",
    ),
    "dask.silent_workers": (
        "the workers of the Dask scheduler at {address} do not answer; restart them",
        "{address} の Dask スケジューラーのワーカーが応答しません。再起動してください",
    ),
    "dask.no_program": (
        "the Dask worker {worker} has no Suisou, or another version; install this one there and restart the worker",
        "Dask ワーカー {worker} に Suisou がないか、版が違います。同じ版をインストールし、ワーカーを再起動してください",
    ),
    "dask.other_program": (
        "the Dask worker {worker} has another Suisou ({version}; here {own}); install the same one and restart it",
        "Dask ワーカー {worker} の Suisou が異なります（{version}、こちらは {own}）。同じものを入れてください",
    ),
    "dask.other_files": (
        "the Dask worker {worker} does not have the same files of your own ({kinds}); copy these folders to it",
        "Dask ワーカー {worker} のユーザーファイル（{kinds}）が異なります。フォルダーをコピーしてください",
    ),
    "dask.one_piece": (
        "--scheduler is for a folder of pieces",
        "--scheduler は曲のフォルダーに使います",
    ),
    "set.syntax": (
        "--set {text}: expected PLAYER.parameter=value",
        "--set {text}: 「奏者.パラメーター=値」の形で指定してください",
    ),
    "set.player_unknown": (
        "--set: player {player!r} was not found; choose one of: {possible}",
        "--set: 奏者 {player!r} が見つかりません。指定できるもの: {possible}",
    ),
    "set.parameter_unknown": (
        "--set: parameter {parameter!r} does not exist; choose one of: {possible}",
        "--set: パラメーター {parameter!r} はありません。指定できるもの: {possible}",
    ),
    "set.posture_impossible": (
        "--set: {player} plays {instrument}, which cannot be played {value}; choose one of: {possible}",
        "--set: {player} の楽器 {instrument} は {value} では演奏できません。指定できるもの: {possible}",
    ),
    "set.value_invalid": (
        "--set: {parameter} cannot be {value!r}; choose one of: {possible}",
        "--set: {parameter} に {value!r} は指定できません。指定できる値: {possible}",
    ),
    "player.unknown": (
        "player {player!r} was not found; choose one of: {possible}",
        "奏者 {player!r} が見つかりません。指定できるもの: {possible}",
    ),
    "bars.no_bar": (
        "bar {number} does not exist; the piece has bars {lowest} to {highest}",
        "{number} 小節はありません。この曲の小節は {lowest} から {highest} までです",
    ),
    "bars.order": (
        "the first bar ({first}) is after the last bar ({last})",
        "最初の小節（{first}）が最後の小節（{last}）より後にあります",
    ),
    "export.no_players": (
        "{file}: there are no players to export; 'suisou inspect' shows why each part is not played",
        "{file}: 書き出す奏者がいません。演奏されない理由は 'suisou inspect' で確認できます",
    ),
    "stage.formats": (
        "--stage requires a format that can hold several players: one of {possible}",
        "--stage には、複数の奏者を収められる形式（{possible}）が必要です",
    ),
    "keys.formats": (
        "--keys reduced requires a format that can leave out frames: one of {possible}",
        "--keys reduced には、フレームを省ける形式（{possible}）が必要です",
    ),
    "player.left_out": ("{player} is excluded: {reason}", "{player} は除外されました: {reason}"),
    "player.fault": (
        "{player} cannot be displayed because of an internal error: {detail}",
        "{player} は内部エラーのため表示できません: {detail}",
    ),
    "player.not_seen": (
        "players that cannot be displayed: {players}; see the problem list for reasons",
        "表示できない奏者: {players}。理由は問題の一覧で確認できます",
    ),
    "player.all_left_out": (
        "{file}: no player can be displayed: {reasons}",
        "{file}: 表示できる奏者がいません: {reasons}",
    ),
    "export.too_long": (
        ("{file}: {frames} frames exceed the maximum of {most} per export; select bars with --from-bar and --to-bar"),
        (
            "{file}: {frames} フレームは一度に書き出せる {most} を超えています。--from-bar と --to-bar "
            "で小節を絞ってください"
        ),
    ),
    "judged.sparsely": (
        (
            "contacts were checked at {rate:g} frames/s only: {players} {players:player|players} for {minutes:g} "
            "{minutes:minute|minutes} are much motion; --all-contacts checks them at the full rate"
        ),
        (
            "奏者 {players} 人、{minutes:g} 分のモーションは多いため、接触は {rate:g} フレーム/秒だけで調べました。"
            "--all-contacts を付けると、通常のレートで調べます"
        ),
    ),
    "judged.some": (
        (
            "contacts were checked only of the first {judged} of {players} players, up to {last}, at {rate:g} "
            "frames/s: {players} {players:player|players} for {minutes:g} {minutes:minute|minutes} are much motion; "
            "--all-contacts checks them all"
        ),
        (
            "奏者 {players} 人、{minutes:g} 分のモーションは多いため、接触は最初の {judged} 人（{last} まで）だけを "
            "{rate:g} フレーム/秒で調べました。--all-contacts を付けると、全員を調べます"
        ),
    ),
    "judged.not": (
        (
            "contacts were not checked: {players} {players:player|players} for {minutes:g} "
            "{minutes:minute|minutes} are much motion; --all-contacts checks them all the same"
        ),
        (
            "接触は調べませんでした: 奏者 {players} 人、{minutes:g} 分のモーションは多いためです。"
            "--all-contacts を付けると調べます"
        ),
    ),
    "piece.too_long": (
        (
            "the piece would last {hours:g} hours, with {quarters} quarter notes and {bars} bars; the maximum is "
            "{most_hours} hours, {most_quarters} quarter notes and {most_bars} bars; shorten the piece"
        ),
        (
            "曲の長さが {hours:g} 時間（四分音符 {quarters} 個、{bars} 小節）になります。上限は {most_hours} 時間、"
            "四分音符 {most_quarters} 個、{most_bars} 小節です。曲を短くしてください"
        ),
    ),
    "open.audio_alone": (
        "{file} is an audio or video file; open its project, MIDI file or score first, then drop it again",
        "{file} は音源または動画です。先に曲を開いてから、もう一度ドロップしてください",
    ),
    "program.fault": (
        "an internal error occurred: {detail}; your work was saved; please report this with the file {log}",
        ("内部エラーが発生しました: {detail}。作業内容は保存されています。ファイル {log} を添えて報告してください"),
    ),
    "work.stopped": ("cancelled; nothing was written", "中止しました。何も書き込んでいません"),
}
