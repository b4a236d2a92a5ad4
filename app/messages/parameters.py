"""Texts of performers' parameters: labels, tips, units and choices."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "parameter.amplitude": ("Amplitude", "動きの大きさ"),
    "parameter.amplitude_tip": (
        "Amount of body motion: 0 still, 0.5 natural, 1 strong",
        "体の動きの量: 0 で静止、0.5 で自然、1 で大きい",
    ),
    "parameter.breath_min_beats": ("Breathe in rests from", "ブレスする休符の下限"),
    "parameter.breath_min_beats_tip": (
        "In shorter rests the player does not breathe, unless they last 0.75 s or more",
        "これより短い休符ではブレスしません（0.75 秒以上続く休符を除く）",
    ),
    "unit.beats": ("beats", "拍"),
    "parameter.breath_last_beat_beats": ("Breathe on last beat from", "最後の拍で吸う下限"),
    "parameter.breath_last_beat_beats_tip": (
        ("In rests of at least this length the breath takes the last beat; in shorter rests it takes the whole rest"),
        "この長さ以上の休符では最後の 1 拍で吸い、短い休符では休符全体で吸います",
    ),
    "parameter.breath_prepare_beats": ("Prepare breath from", "準備動作を付ける下限"),
    "parameter.breath_prepare_beats_tip": (
        "In rests of at least this length the player prepares, then breathes on the last beat",
        "この長さ以上の休符では準備動作をしてから最後の拍で吸います",
    ),
    "parameter.lung_s": ("Breath capacity", "一息の長さ"),
    "parameter.lung_s_tip": (
        (
            "For an average instrument; longer on instruments that use less air, shorter on those that use more. "
            "Longer phrases get a catch breath."
        ),
        (
            "平均的な楽器での長さです。息の消費が少ない楽器では長く、多い楽器では短くなります。"
            "これより長いフレーズでは途中で息継ぎをします。"
        ),
    ),
    "unit.seconds": ("s", "秒"),
    "parameter.embouchure_tension": ("Lip tension", "唇の緊張"),
    "parameter.embouchure_tension_tip": (
        "Visible lip tension: multiplier, 1 = natural",
        "唇の緊張の見え方（倍率、1 で自然）",
    ),
    "unit.times": ("×", "×"),
    "parameter.sway": ("Sway", "揺れ"),
    "parameter.sway_tip": ("Sway with the beat: multiplier, 1 = natural", "拍に合わせた揺れ（倍率、1 で自然）"),
    "parameter.weight_shift": ("Weight shift", "重心移動"),
    "parameter.weight_shift_tip": (
        "Weight shift from foot to foot: multiplier, 1 = natural",
        "足から足への重心移動（倍率、1 で自然）",
    ),
    "parameter.bell_height": ("Bell height", "ベルの高さ"),
    "parameter.bell_height_tip": (
        "Bell movement following the melody: multiplier, 1 = natural",
        "旋律に合わせたベルの上下（倍率、1 で自然）",
    ),
    "parameter.posture": ("Posture", "姿勢"),
    "choice.standing": ("Standing", "立奏"),
    "choice.seated": ("Seated", "座奏"),
    "parameter.cue_leader": ("Give cues", "合図を出す"),
    "choice.automatic": ("Automatic", "自動"),
    "choice.yes": ("Yes", "あり"),
    "choice.never": ("Never", "なし"),
    "parameter.seed": ("Seed", "シード"),
    "parameter.seed_tip": (
        "Each seed gives a different performance of the same plan",
        "シードごとに、同じ計画で別の演奏になります",
    ),
    "parameter.breath_need": ("Air used before breath", "ブレスまでに使う息"),
    "parameter.breath_need_tip": (
        (
            "How much is played before a breath in a rest shorter than 1.5 s: 0 breathes in every rest, 1 only when "
            "out of air. 0.35 is usual: 0.75 s of rest after 1 s of playing; 0.5 s after 2.5 s or 20 % of the air; "
            "0.3 s after about 4 s or 40 % of the air."
        ),
        (
            "1.5 秒未満の休符で吸うまでにどれだけ吹くか。0 ではどの休符でも吸い、1 では息が尽きたときだけ吸います。"
            "標準は 0.35: 0.75 秒の休符では 1 秒、0.5 秒では 2.5 秒または息の 20 %、0.3 秒では約 4 秒または息の 40 %。"
        ),
    ),
    "parameter.circular_breathing": ("Circular breathing", "循環呼吸"),
    "parameter.circular_breathing_tip": (
        "Inhales through the nose while playing, so phrases are not interrupted by catch breaths",
        "演奏しながら鼻から吸い、フレーズを息継ぎで途切れさせません",
    ),
    "choice.no": ("No", "なし"),
    "parameter.choreography": ("Body motion", "体の動き"),
    "parameter.choreography_tip": (
        "How hips, torso and head move while playing. Hands, lips and feet keep their contacts.",
        "演奏中の腰、上体、頭の動き。手、唇、足の接触は保たれます。",
    ),
    "parameter.dance_amount": ("Dance amount", "ダンスの量"),
    "parameter.dance_amount_tip": (
        "Amount of dance: 0 none, 1 the most that is playable. It replaces the automatic sway.",
        "ダンスの量。0 でなし、1 で演奏できる最大。自動の揺れに置き換わります。",
    ),
    "parameter.dance_variation": ("Variation", "バリエーション"),
    "parameter.dance_variation_tip": (
        "0: individual dance. Players and dancers with the same other number move in unison.",
        "0 は奏者ごとの個別のダンス。0 以外で番号が同じ奏者とダンサーは揃って動きます。",
    ),
    "parameter.style": (
        "Style",
        "演奏スタイル",
    ),
    "parameter.style_tip": (
        "What kind of player this is: factors for all amounts below and those of Motion",
        "どんな奏者か。下の各量と「動き」の量に掛ける係数",
    ),
    "parameter.habits": (
        "Habits",
        "癖",
    ),
    "parameter.habits_tip": (
        "What this player does more, or less, than others of the same style",
        "同じスタイルの他の奏者より多い（少ない）動き",
    ),
    "parameter.phrase_motion": (
        "Phrase motion",
        "フレーズの動き",
    ),
    "parameter.phrase_motion_tip": (
        "Torso and head moving with phrases, bars and accents: multiplier, 1 = as the style",
        "フレーズ・小節・アクセントに合わせた上体と頭の動き（倍率、1 でスタイルどおり）",
    ),
    "parameter.stillness": (
        "Stillness",
        "静止",
    ),
    "parameter.stillness_tip": (
        "How often torso and head keep still for a bar: multiplier, 1 = as the style",
        "上体と頭が小節の間静止する頻度（倍率、1 でスタイルどおり）",
    ),
    "parameter.footwork": (
        "Footwork",
        "足の動き",
    ),
    "parameter.footwork_tip": (
        "Lifted heels and steps to the other foot: multiplier, 1 = as the style",
        "かかとの上げ下げと踏み替え（倍率、1 でスタイルどおり）",
    ),
    "parameter.toe_taps": (
        "Toe taps",
        "足拍子",
    ),
    "parameter.toe_taps_tip": (
        "How often a foot taps with the beat: multiplier, 1 = as the style",
        "足で拍を取る頻度（倍率、1 でスタイルどおり）",
    ),
    "parameter.breath_motion": (
        "Visible breath",
        "息の見え方",
    ),
    "parameter.breath_motion_tip": (
        "How much chest, belly and shoulders show the air: multiplier, 1 = as the style",
        "胸・腹・肩に表れる息の量（倍率、1 でスタイルどおり）",
    ),
    "parameter.cue_size": (
        "Cue size",
        "合図の大きさ",
    ),
    "parameter.cue_size_tip": (
        "Size of nods and bell at an entry: multiplier, 1 = as the style",
        "入りの合図でのうなずきとベルの大きさ（倍率、1 でスタイルどおり）",
    ),
    "parameter.face_intensity": (
        "Face intensity",
        "表情の強さ",
    ),
    "parameter.face_intensity_tip": (
        "Brows, lids, cheeks and nostrils: multiplier, 1 = as the style",
        "眉・まぶた・頬・鼻翼の動き（倍率、1 でスタイルどおり）",
    ),
    "parameter.lip_motion": (
        "Lip motion",
        "唇の動き",
    ),
    "parameter.lip_motion_tip": (
        "What the lips do within held notes: multiplier, 1 = as the style",
        "伸ばす音の間の唇の動き（倍率、1 でスタイルどおり）",
    ),
    "parameter.gaze": (
        "Gaze",
        "視線の動き",
    ),
    "parameter.gaze_tip": (
        "How much the eyes leave the music: multiplier, 1 = as the style",
        "視線が譜面を離れる量（倍率、1 でスタイルどおり）",
    ),
    "parameter.blinks": (
        "Blinks",
        "まばたき",
    ),
    "parameter.blinks_tip": (
        "How often the lids close: multiplier, 1 = as the style",
        "まばたきの頻度（倍率、1 でスタイルどおり）",
    ),
    "parameter.gestures": (
        "Gestures",
        "ジェスチャー",
    ),
    "parameter.gestures_tip": (
        "Gestures before, between and after playing: multiplier, 1 = as the style",
        "演奏の前後や合間のジェスチャー（倍率、1 でスタイルどおり）",
    ),
    "dancer_parameter.seed": ("Variation", "バリエーション"),
    "dancer_parameter.seed_tip": (
        "Each number gives a different dance to the same music",
        "番号ごとに、同じ曲で別のダンスになります",
    ),
    "parameter.layers_off": ("Layers off", "オフのレイヤー"),
    "parameter.layers_off_tip": (
        "Layers that are not shown, whatever their amounts",
        "量にかかわらず表示しないレイヤー",
    ),
    "dancer_parameter.delay_beats": ("Delay", "遅れ"),
    "dancer_parameter.delay_beats_tip": ("Delay after the music, for dancing in canon", "曲からの遅れ（カノン用）"),
    "dancer_parameter.source": ("Preferred source", "優先ソース"),
    "dancer_parameter.source_tip": (
        "Motion capture to prefer where several fit the music about equally well",
        "曲に同程度合う動きが複数あるときに優先するキャプチャ",
    ),
    "dancer_parameter.size": ("Motion size", "動きの大きさ"),
    "dancer_parameter.size_tip": (
        "Size of torso and arm motion. 1 = as captured",
        "上体と腕の動きの大きさ。1 でキャプチャのまま",
    ),
    "dancer_parameter.weight": ("Weight", "重さ"),
    "dancer_parameter.weight_tip": (
        "Light to heavy: how deep the knees bend. 0 = as captured",
        "軽い動きから重い動きまで（膝を曲げる深さ）。0 でキャプチャのまま",
    ),
}
