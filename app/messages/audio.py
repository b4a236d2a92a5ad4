"""Sound: recordings, synthesiser, offset."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "audio.not_readable": (
        (
            "cannot read audio file {file} ({detail}); choose a WAV, FLAC, OGG, MP3, M4A or video file, or convert "
            "it to one of these"
        ),
        "音源 {file} を読み込めません（{detail}）。WAV、FLAC、OGG、MP3、M4A、動画のいずれかを選ぶか、変換してください",
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
    "audio.too_many_samples": (
        (
            "{file} has {channels} channels at {rate_hz} Hz, far more samples than a file of its size should contain; "
            "export it as stereo at 48000 Hz"
        ),
        (
            "{file} は {channels} チャンネル・{rate_hz} Hz で、ファイルのサイズに対してサンプル数が多すぎます。"
            "48000 Hz のステレオで書き出してください"
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
    "audio.followed": (
        "the beats lie where the recording has them (confidence {percent} %)",
        "拍を音源に合わせました（信頼度 {percent} %）",
    ),
    "audio.followed_but": (
        "the beats lie where the recording has them (confidence {percent} %); check {count:bar|bars} {bars} by ear",
        "拍を音源に合わせました（信頼度 {percent} %）。第 {bars} 小節は耳で確認してください",
    ),
    "audio.not_followed": (
        (
            "the piece was not recognised in the recording (confidence {percent} %): check that it is a recording of "
            "this piece, in this key; nothing was changed"
        ),
        (
            "音源の中に曲が見つかりませんでした（信頼度 {percent} %）。この曲の、同じ調の音源か確認してください。"
            "何も変更していません"
        ),
    ),
    "align.kind": (
        "{file} is neither a project (.suisou) nor a MIDI file (.mid): name one of these with --to",
        "{file} はプロジェクト（.suisou）でも MIDI ファイル（.mid）でもありません。--to にはどちらかを指定してください",
    ),
    "align.onto_itself": (
        "{file} is the piece or the recording itself: write to another file",
        "{file} は入力の曲または音源そのものです。別のファイルに書き出してください",
    ),
    "align.nothing_between": (
        "{file} has {seconds:.1f} s: nothing lies between --from and --until",
        "{file} の長さは {seconds:.1f} 秒です。--from と --until の間に音がありません",
    ),
    "align.no_such_player": (
        "there is no player {player}; there are: {known}",
        "奏者 {player} はいません。いる奏者: {known}",
    ),
    "dynamics.no_curve": (
        "the part has no such curve; take dynamics from a recording, or record a take first",
        "パートにその曲線がありません。先に音源から強弱を取り込むか、テイクを録音してください",
    ),
    "align.bars_missing": (
        (
            "the recording leaves out bars {first} to {last}, which cannot sound in no time: take them out of the "
            "score, or use another recording; nothing was changed"
        ),
        (
            "音源には第 {first}～{last} 小節がありません。楽譜からその小節を取り除くか、別の音源を使ってください。"
            "何も変更していません"
        ),
    ),
    "align.bars_outside": (
        "{count:bar|bars} {bars} {count:is|are} not in the recording: the tempo there is that of the bars beside",
        "第 {bars} 小節は音源にありません。隣の小節のテンポのままです",
    ),
    "align.only_recorded": (
        "what is recorded from {start_s:.1f} s to {end_s:.1f} s is not in the score: a repeat or a cadenza?",
        "音源の {start_s:.1f} 秒から {end_s:.1f} 秒は楽譜にありません（繰り返しまたはカデンツァの可能性があります）",
    ),
    "align.runner_up": (
        "next likeliest place: bar 1 at {start_s:.3f} s of the recording, {later_s:+.2f} s (confidence {percent} %)",
        "次の候補: 第 1 小節が音源の {start_s:.3f} 秒、差は {later_s:+.2f} 秒（信頼度 {percent} %）",
    ),
    "align.doubtful": (
        "{count:bar|bars} {bars}: confidence {percent} %; check by ear",
        "第 {bars} 小節: 信頼度 {percent} %。耳で確認してください",
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


def with_next(wordings: tuple[str, str]) -> tuple[str, str]:
    """The wordings of a place, with the second likeliest one."""
    english, japanese = wordings
    return (
        english.replace(
            "(confidence {percent} %)",
            "(confidence {percent} %; next likeliest place: {next_s:+.2f} s, {next_percent} %)",
        ),
        japanese.replace(
            "（信頼度 {percent} %）", "（信頼度 {percent} %、次の候補: {next_s:+.2f} 秒、{next_percent} %）"
        ),
    )


_PLACES: Final = (
    "audio.followed",
    "audio.followed_but",
    "audio.offset_found",
    "audio.other_tempo",
    "audio.tempo_fitted",
)
WORDINGS.update({f"{id}_with_next": with_next(WORDINGS[id]) for id in _PLACES})
