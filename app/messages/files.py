"""Files that cannot be read or written."""

from __future__ import annotations

from typing import Final

from app.messages.audio import with_next

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "file.cannot_open": (
        "{file} is neither a command nor a project, MIDI file or score ({kinds}); 'suisou --help' lists the commands",
        "{file} はコマンドでも、プロジェクト、MIDI、楽譜のファイル（{kinds}）でもありません。"
        "コマンドは 'suisou --help' で確認できます",
    ),
    "file.other_computer": (
        (
            "{file} is on another computer ({host}) and was not opened: a file should not make this one sign in there; "
            "agree to it in the editor's question, choose the file yourself, or copy it next to the project"
        ),
        (
            "{file} は別のコンピューター（{host}）にあるため、開いていません。ファイルの指示だけで接続しないためです。"
            "エディターの確認で許可するか、自分でファイルを選択するか、プロジェクトの隣にコピーしてください"
        ),
    ),
    "file.cannot_read": ("{file} cannot be read: {reason}", "{file} を読み込めません: {reason}"),
    "file.cannot_write": ("{file} cannot be written: {reason}", "{file} に書き込めません: {reason}"),
    "file.not_regular": (
        "{file} is a folder, pipe or device; choose a file",
        "{file} はフォルダー、パイプまたはデバイスです。ファイルを選んでください",
    ),
    "file.too_large": (
        "{file} is too large ({size_mb} MB; the maximum is {most_mb} MB); choose a smaller file",
        "{file} は大きすぎます（{size_mb} MB、上限 {most_mb} MB）。もっと小さいファイルを選んでください",
    ),
    "json.invalid": ("{file} is damaged: {detail}", "{file} は壊れています: {detail}"),
    "settings.value": (
        "{file}: {place}: {detail}; the default value is used",
        "{file}: {place}: {detail}。既定値を使用します",
    ),
    "settings.set_aside": (
        ("{file} cannot be used, so settings changed now are lost when Suisou closes; correct the file or remove it"),
        (
            "{file} を使用できないため、変更した設定は Suisou を終了すると失われます。"
            "ファイルを修正するか削除してください"
        ),
    ),
    "export.done": ("files written to {folder}: {count}", "{folder} に書き出したファイル: {count} 個"),
    "video.done": ("video saved: {file}", "動画を保存しました: {file}"),
    "video.failed": ("the video {file} cannot be written: {detail}", "動画 {file} を書き出せません: {detail}"),
    "video.not_readable": (
        "cannot read video file {file} ({detail}); convert it to MP4 (H.264)",
        "動画 {file} を読み込めません（{detail}）。MP4（H.264）に変換してください",
    ),
    "video.transport_stream": (
        "{file} is an MPEG transport stream (.ts, .mts), which cannot be read; convert it to MP4 (H.264)",
        "{file} は MPEG トランスポートストリーム（.ts、.mts）のため読み込めません。MP4（H.264）に変換してください",
    ),
    "video.sound_times": (
        (
            "{file}: the time stamps of its sound are damaged, and much of it would be lost; convert it to WAV with "
            "another program"
        ),
        ("{file} は音声のタイムスタンプが壊れており、多くの部分が失われます。別のプログラムで WAV に変換してください"),
    ),
    "video.too_costly": (
        (
            "reading {file} takes more memory or time than a file of its size should need: it may be damaged; "
            "convert it to MP4 (H.264) or WAV with another program"
        ),
        (
            "{file} の読み込みには、ファイルのサイズに対して多すぎるメモリーまたは時間がかかります。"
            "壊れている可能性があります。ほかのソフトウェアで MP4（H.264）または WAV に変換してください"
        ),
    ),
    "video.reader_ended": (
        (
            "the reader of {file} ended unexpectedly (status {status}): the file may be damaged; convert it to MP4 "
            "(H.264) or WAV with another program"
        ),
        (
            "{file} を読み込むプログラムが異常終了しました（状態 {status}）。ファイルが壊れている可能性があります。"
            "ほかのソフトウェアで MP4（H.264）または WAV に変換してください"
        ),
    ),
    "video.no_pictures": (
        "{file} has no video, only audio; choose a video file",
        "{file} には映像がなく、音声だけです。動画ファイルを選んでください",
    ),
    "video.not_recognised": (
        (
            "the piece was not recognised in the sound of the video (confidence {percent} %); nothing was changed; "
            "type the offset of the video"
        ),
        (
            "ビデオの音声から曲を認識できませんでした（信頼度 {percent} %）。変更していません。"
            "ビデオのオフセットを入力してください"
        ),
    ),
    "video.offset_found": (
        "the video begins at {offset_s:.3f} s (confidence {percent} %)",
        "ビデオの開始位置: {offset_s:.3f} 秒（信頼度 {percent} %）",
    ),
    "video.no_sound": (
        "{file} has no audio; choose a video with audio, or set its offset by hand",
        "{file} には音声がありません。音声付きの動画を選ぶか、オフセットを手動で設定してください",
    ),
}
WORDINGS["video.offset_found_with_next"] = with_next(WORDINGS["video.offset_found"])
