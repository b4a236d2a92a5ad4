"""Sound: recordings, synthesiser, offset."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "audio.not_readable": (
        (
            "cannot read audio file {file} ({detail}); choose a WAV, FLAC, OGG or MP3 file, or convert it to one "
            "of these"
        ),
        "音源 {file} を読み込めません（{detail}）。WAV、FLAC、OGG、MP3 のいずれかを選ぶか、変換してください",
    ),
    "audio.unusable": (
        ("{file} has {channels} channels at {rate_hz} Hz, which is not supported; export it as stereo at 48000 Hz"),
        (
            "{file} は {channels} チャンネル・{rate_hz} Hz で、音源として使えません。48000 Hz "
            "のステレオで書き出してください"
        ),
    ),
    "audio.empty": (
        "{file} contains no audio; choose another file",
        "{file} には音が入っていません。別の音源を選んでください",
    ),
    "audio.too_dense": (
        (
            "{file} contains more than {minutes} minutes of silence, far more audio than a file of its size should "
            "contain; trim it to the piece"
        ),
        (
            "{file} には {minutes} 分を超える無音が入っており、ファイルのサイズに対して長すぎます。"
            "曲の長さに切り詰めてください"
        ),
    ),
    "audio.too_long": (
        "{file} is longer than {most_hours} hours; trim it to the piece",
        "{file} は {most_hours} 時間を超えています。曲の長さに切り詰めてください",
    ),
    "audio.breaks_off": (
        "{file} ends unexpectedly after {seconds} s: the file is damaged or incomplete; copy it again",
        "{file} は {seconds} 秒で途切れています。ファイルが壊れているか不完全です。コピーし直してください",
    ),
    "audio.no_device": (
        "no audio output device: playback is silent; connect a device and play again",
        "オーディオ出力デバイスがないため、無音で再生します。デバイスを接続して再生し直してください",
    ),
    "audio.nothing_to_compare": (
        "the offset cannot be estimated because the audio file or the score is silent",
        "音源または楽譜が無音のため、オフセットを推定できません",
    ),
    "audio.not_recognised": (
        (
            "the piece was not recognised in the audio file (confidence {percent} %); nothing was changed; drag "
            "the waveform or type the offset"
        ),
        (
            "音源の中に曲が見つかりませんでした（信頼度 {percent} %）。何も変更していません。波形をドラッグするか、"
            "オフセットを入力してください"
        ),
    ),
    "audio.offset_found": (
        "audio offset: {offset_s:.3f} s (confidence {percent} %)",
        "音源のオフセット: {offset_s:.3f} 秒（信頼度 {percent} %）",
    ),
    "audio.other_tempo": (
        (
            "audio offset: {offset_s:.3f} s (confidence {percent} %); the tempo differs by {tempo_percent:+.1f} %: "
            "choose Play > Audio > Fit Tempo to Audio"
        ),
        (
            "音源のオフセット: {offset_s:.3f} 秒（信頼度 {percent} %）。テンポが {tempo_percent:+.1f} % "
            "異なります。「再生 > 音源 > テンポを音源に合わせる」を選んでください"
        ),
    ),
    "audio.tempo_fitted": (
        (
            "audio offset: {offset_s:.3f} s (confidence {percent} %); the tempo of the score was changed by "
            "{tempo_percent:+.1f} %"
        ),
        (
            "音源のオフセット: {offset_s:.3f} 秒（信頼度 {percent} %）。楽譜のテンポを {tempo_percent:+.1f} % "
            "変更しました"
        ),
    ),
}
