"""Texts of the dialogs of MIDI devices, latency and the live stream: id -> English and Japanese."""

from __future__ import annotations

from typing import Final

TEXTS: Final[dict[str, tuple[str, str]]] = {
    "latency_dialog.blow_short_note_on_every": (
        "Play a short note on each click: {count} of {all}",
        "クリックごとに短く吹いてください: {count}/{all}",
    ),
    "latency_dialog.blow_short_note_on_every_click_what_is": (
        (
            "Play a short note on each click. The result is the combined delay of audio output and device. It "
            "includes your own timing, as most players are slightly early or late. You can also type a known value."
        ),
        (
            "クリックごとに短く吹いてください。オーディオ出力とデバイスを合わせた遅れを測定します。"
            "多くの人は少し早めか遅めに吹くため、演奏の癖も含まれます。正しい値が分かっている場合は入力できます。"
        ),
    ),
    "latency_dialog.close": ("Close", "閉じる"),
    "latency_dialog.comes_ms_late_of_hits": (
        "{device}: latency {count} ms ({used} of {all} hits used, deviation ±{spread} ms).",
        "{device} のレイテンシーは {count} ms です（{all} 回のうち {used} 回を使用、ばらつき ±{spread} ms）。",
    ),
    "latency_dialog.device_has_gone_or_take": (
        "Measurement stopped because the device was disconnected or recording started.",
        "デバイスが切断されたか録音が始まったため、測定を中止しました。",
    ),
    "latency_dialog.hits_differ_by_ms_too": (
        ("The hits deviate by ±{spread} ms, which is too much for a result. Try again with shorter, harder notes."),
        "ばらつきが ±{spread} ms と大きく、測定できません。もっと短くはっきりと吹いて、もう一度試してください。",
    ),
    "latency_dialog.it_is_taken_off_from": (
        "This latency will be compensated from now on.",
        "今後の録音でこのレイテンシーを補正します。",
    ),
    "latency_dialog.latency": ("Latency", "レイテンシー"),
    "latency_dialog.listen_and_play_along_first": (
        "Listen and play along. The first {count} clicks do not count.",
        "クリックに合わせて吹いてください。最初の {count} 回は数えません。",
    ),
    "latency_dialog.ms": ("ms", "ms"),
    "latency_dialog.ms_are_taken_off_now": (
        "{device}: {count} ms compensation is active.",
        "{device}: 現在 {count} ms を補正しています。",
    ),
    "latency_dialog.no_device_is_connected_choose": (
        "No device is connected. Select one in Record > MIDI Devices, or type a value.",
        "デバイスが接続されていません。「録音 > MIDI デバイス」で選ぶか、値を入力してください。",
    ),
    "latency_dialog.only_of_clicks_were_hit": (
        "Only {count} of {all} clicks were matched; at least {least} are required. Try again.",
        "{all} 回のうち {count} 回しか合いませんでした（{least} 回以上必要です）。もう一度試してください。",
    ),
    "latency_dialog.start": ("Start", "開始"),
    "latency_dialog.stop": ("Stop", "停止"),
    "latency_dialog.taken_off_time_of_everything": (
        "Compensation applied to all input from this device",
        "このデバイスからの入力すべてに適用する補正値",
    ),
    "latency_dialog.there_is_no_audio_device": (
        (
            "No audio output device was found. Play when the light flashes, and measure again once a device is "
            "connected."
        ),
        (
            "オーディオ出力デバイスが見つかりません。ライトの点滅に合わせて吹いてください。"
            "デバイスを接続したら測定し直してください。"
        ),
    ),
    "latency_dialog.use": ("Apply", "適用"),
    "midi_devices_dialog.any": ("Any", "すべて"),
    "midi_devices_dialog.bite": ("Bite", "バイト"),
    "midi_devices_dialog.blow_now_soft_loud_and": (
        "Blow now: soft, loud, soft. {count} s",
        "吹いてください: 弱く、強く、弱く。あと {count} 秒",
    ),
    "midi_devices_dialog.breath": ("Breath", "ブレス"),
    "midi_devices_dialog.cancel": ("Cancel", "キャンセル"),
    "midi_devices_dialog.cannot_be_opened": ("cannot open", "開けません"),
    "midi_devices_dialog.channel": ("Channel", "チャンネル"),
    "midi_devices_dialog.chosen_device": ("Selected device", "選択中のデバイス"),
    "midi_devices_dialog.click_device_that_you_play": ("Select your device.", "使用するデバイスを選んでください。"),
    "midi_devices_dialog.close": ("Close", "閉じる"),
    "midi_devices_dialog.connect_wind_controller_by_usb": (
        ("Connect a wind controller by USB or a MIDI interface and switch it on. It then appears here automatically."),
        (
            "ウインドコントローラーを USB か MIDI インターフェースで接続し、電源を入れてください。"
            "自動的にここに表示されます。"
        ),
    ),
    "midi_devices_dialog.connected": ("connected", "接続済み"),
    "midi_devices_dialog.device": ("Device", "デバイス"),
    "midi_devices_dialog.devices": ("Devices", "デバイス"),
    "midi_devices_dialog.finds_with_what_breath_and": (
        "Detects which MIDI messages carry breath and bite ({count} s each). Esc to cancel.",
        "ブレスとバイトを送る MIDI メッセージを検出します（各 {count} 秒）。Esc で取り消します。",
    ),
    "midi_devices_dialog.found_breath_bite_channel": (
        "Detected: breath {source}, bite {bite}, channel {number}.",
        "検出結果: ブレス {source}、バイト {bite}、チャンネル {number}。",
    ),
    "midi_devices_dialog.found_breath_channel_no_bite": (
        "Detected: breath {source}, channel {number}. No bite was received.",
        "検出結果: ブレス {source}、チャンネル {number}。バイトは受信していません。",
    ),
    "midi_devices_dialog.kind": ("Kind", "種類"),
    "midi_devices_dialog.latency": ("Latency", "レイテンシー"),
    "midi_devices_dialog.learn_by_blowing": ("Detect Breath and Bite", "ブレスとバイトを検出"),
    "midi_devices_dialog.measure": ("Measure...", "測定..."),
    "midi_devices_dialog.midi_devices": ("MIDI Devices", "MIDI デバイス"),
    "midi_devices_dialog.ms": ("{count} ms", "{count} ms"),
    "midi_devices_dialog.no_breath_came_in_blow": (
        "No breath was received. Blow harder, or enable breath output on the device, and try again.",
        ("ブレスを受信しませんでした。もっと強く吹くか、デバイスのブレス送信を有効にして、もう一度試してください。"),
    ),
    "midi_devices_dialog.no_device": ("No device", "デバイスなし"),
    "midi_devices_dialog.nothing_came_in_from_device": (
        "Nothing was received from the device. Check that it is switched on.",
        "デバイスから何も受信しませんでした。電源が入っているか確認してください。",
    ),
    "midi_devices_dialog.now_blow_evenly_bite_and": (
        "Blow evenly, then bite and release several times. {count} s",
        "一定に吹きながら、リードを噛んで緩める動作を何度か繰り返してください。あと {count} 秒",
    ),
    "midi_devices_dialog.short_tone_on_audio_device": (
        "Plays a short tone on the audio output device",
        "オーディオ出力デバイスで短い音を再生",
    ),
    "midi_devices_dialog.state": ("State", "状態"),
    "midi_devices_dialog.test_beep": ("Test Beep", "テスト音"),
    "midi_devices_dialog.there_is_no_audio_device": (
        "No audio output device was found. Connect one and try again.",
        "オーディオ出力デバイスが見つかりません。接続してもう一度試してください。",
    ),
    "midi_devices_dialog.unplugged": ("disconnected", "切断"),
    "midi_devices_dialog.volume_of_transport_is_0": (
        "The volume in the transport bar is 0.",
        "トランスポートの音量が 0 です。",
    ),
    "midi_devices_dialog.waiting_for_it": ("waiting…", "待機中…"),
    "midi_devices_dialog.what_comes_in": ("Input monitor", "入力モニター"),
    "midi_devices_dialog.you_should_hear_short_tone": ("You should hear a short tone.", "短い音が聞こえれば正常です。"),
    "midi_monitor.begins_velocity": ("{pitch} on, velocity {value}", "{pitch} オン、ベロシティ {value}"),
    "midi_monitor.bite": ("Bite", "バイト"),
    "midi_monitor.breath": ("Breath", "ブレス"),
    "midi_monitor.channel": ("Channel {number}", "チャンネル {number}"),
    "midi_monitor.channel_2": ("{text}   (channel {number})", "{text}（チャンネル {number}）"),
    "midi_monitor.ends": ("{pitch} off", "{pitch} オフ"),
    "midi_monitor.last_messages": ("Recent messages", "最近のメッセージ"),
    "midi_monitor.nothing_has_come_in_yet": ("No messages received.", "メッセージを受信していません。"),
    "midi_monitor.plays_on_channel_but_only": (
        "Receiving on channel {number}, but only channel {requested} is enabled.",
        "チャンネル {number} で受信していますが、有効なのはチャンネル {requested} だけです。",
    ),
    "midi_monitor.pressure_on": ("Key pressure {pitch}: {value}", "{pitch} のキープレッシャー: {value}"),
    "midi_monitor.program": ("Program {value}", "プログラム {value}"),
    "midi_source.aftertouch": ("Aftertouch", "アフタータッチ"),
    "midi_source.cc_11_expression": ("CC 11 (expression)", "CC 11（エクスプレッション）"),
    "midi_source.cc_1_modulation": ("CC 1 (modulation)", "CC 1（モジュレーション）"),
    "midi_source.cc_2_breath": ("CC 2 (breath)", "CC 2（ブレス）"),
    "midi_source.cc_7_volume": ("CC 7 (volume)", "CC 7（ボリューム）"),
    "midi_source.nothing": ("None", "なし"),
    "midi_source.pitch_bend": ("Pitch bend", "ピッチベンド"),
    "stream_dialog.arkit_jawopen": ("ARKit: jawOpen", "ARKit: jawOpen"),
    "stream_dialog.arkit_with_capitals_jawopen_perfect": (
        "ARKit, capitalised: JawOpen (Perfect Sync)",
        "ARKit、頭文字が大文字: JawOpen（パーフェクトシンク）",
    ),
    "stream_dialog.close": ("Close", "閉じる"),
    "stream_dialog.computer": ("Destination computer", "送信先のコンピューター"),
    "stream_dialog.everyone_on_stage_each_on": (
        "All performers, each on a separate port",
        "全出演者（1 人ずつ別のポート、ステージ上の位置のまま）",
    ),
    "stream_dialog.frames_per_second": ("Frames per second", "フレームレート"),
    "stream_dialog.live_stream": ("Live Stream", "モーション送信"),
    "stream_dialog.looking_for": ("Resolving {host}…", "{host} を検索中…"),
    "stream_dialog.names_of_face": ("Blendshape naming", "ブレンドシェイプの命名"),
    "stream_dialog.no_receiver_there_yet_start": (
        "No receiver found at the destination. Start receiving in the other program, on the same port.",
        "送信先に受信側が見つかりません。受信側のプログラムで、同じポートの受信を開始してください。",
    ),
    "stream_dialog.not_sent": ("{name}: not sent. {reason}", "{name}: 送信していません。{reason}"),
    "stream_dialog.nothing_is_sent": ("Not streaming.", "送信していません。"),
    "stream_dialog.performer": ("Performer", "出演者"),
    "stream_dialog.performers": ("Performers", "出演者"),
    "stream_dialog.port": ("Port", "ポート"),
    "stream_dialog.selected_player_in_middle": ("Selected player, at centre stage", "選択した奏者（ステージの中央）"),
    "stream_dialog.send_anyway": ("Send Anyway", "それでも送信"),
    "stream_dialog.sending_frames_per_second_fewer": (
        "Sending {count} frames per second; fewer when nothing moves.",
        "毎秒 {count} フレームを送信しています（動きがないときは少なくなります）。",
    ),
    "stream_dialog.sends_performers_poses_faces_and": (
        (
            "Sends the poses, faces and instruments of the performers through the VMC protocol during playback, "
            "scrubbing and recording. Unreal (VMC4UE), VSeeFace, Warudo and Blender add-ons can receive it. Each "
            "port carries one character."
        ),
        (
            "再生・スクラブ・録音中に、出演者のポーズ、表情、楽器を VMC プロトコルで送信します。Unreal（VMC4UE）、"
            "VSeeFace、Warudo、Blender のアドオンなどで受信できます。1 つのポートで 1 キャラクターです。"
        ),
    ),
    "stream_dialog.start_streaming": ("Start Streaming", "送信を開始"),
    "stream_dialog.stop_streaming": ("Stop Streaming", "送信を停止"),
    "stream_dialog.this_computer": ("This Computer", "このコンピューター"),
    "stream_dialog.vrm_presets_blink_l_joy": ("VRM presets: A, Blink_L, Joy", "VRM プリセット: A、Blink_L、Joy"),
    "stream_dialog.what_is_sent_leaves_this": (
        (
            "The stream leaves this computer and can be read by anyone on the network. Allow this port in the "
            "firewall of the receiving computer."
        ),
        (
            "送信内容はこのコンピューターの外に送信され、ネットワーク上の誰でも読み取れます。"
            "受信側のコンピューターのファイアウォールで、このポートを許可してください。"
        ),
    ),
}
