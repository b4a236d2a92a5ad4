"""Texts of the dialogs of characters: id -> English and Japanese."""

from __future__ import annotations

from typing import Final

TEXTS: Final[dict[str, tuple[str, str]]] = {
    "character_dialog.automatic": ("Automatic", "自動"),
    "character_dialog.body": ("Body", "ボディ"),
    "character_dialog.bone": ("Bone", "ボーン"),
    "character_dialog.bone_of_file": ("Bone in file", "ファイルのボーン"),
    "character_dialog.bones_morphs": (
        "{file}\nBones: {bones}, morphs: {morphs}",
        "{file}\nボーン {bones}、モーフ {morphs}",
    ),
    "character_dialog.cancel": ("Cancel", "キャンセル"),
    "character_dialog.character": ("Character: {file}", "キャラクター: {file}"),
    "character_dialog.everything_will_be_played": ("All features are supported.", "すべての機能に対応しています。"),
    "character_dialog.face": ("Face", "顔"),
    "character_dialog.file_has_no_such_bone": (
        "{joint}: bone not found in the file",
        "{joint}: ファイルに該当するボーンがありません",
    ),
    "character_dialog.found": ("found", "検出"),
    "character_dialog.give_it_to": ("Assign to {players}", "{players} に割り当てる"),
    "character_dialog.guess": ("guessed", "推測"),
    "character_dialog.guess_please_look": (
        "{joint}: {bone}, guessed; please check",
        "{joint}: {bone}（推測。確認してください）",
    ),
    "character_dialog.joint": ("Joint", "関節"),
    "character_dialog.joints_of_body": ("Body joints", "体の関節"),
    "character_dialog.keep_character": ("Save Character", "キャラクターを保存"),
    "character_dialog.name": ("Name", "名前"),
    "character_dialog.no_bone": ("No Bone", "ボーンなし"),
    "character_dialog.no_picture_yet": ("No preview", "プレビューなし"),
    "character_dialog.none": ("none", "なし"),
    "character_dialog.redo": ("Redo", "やり直す"),
    "character_dialog.reset_all": ("Reset All", "すべてリセット"),
    "character_dialog.search_bones": ("Search bones", "ボーンを検索"),
    "character_dialog.text": ("{joint}: {bone}", "{joint}: {bone}"),
    "character_dialog.undo": ("Undo", "元に戻す"),
    "character_words.cheeks_do_not_fill_it": (
        "Cheek puffing is not available: no matching morph was found.",
        "頬をふくらませる動きは使えません（該当するモーフがありません）。",
    ),
    "character_words.eyes_do_not_look_around": (
        "Eye direction is not available: no matching bones or morphs were found.",
        "視線は動きません（目のボーンもモーフもありません）。",
    ),
    "character_words.it_cannot_play_yet_choose": (
        "This character cannot play yet. Select bones for: {joints}",
        "このままでは演奏できません。次の関節のボーンを選んでください: {joints}",
    ),
    "character_words.it_does_not_blink_it": (
        "Blinking is not available: no matching morph was found.",
        "まばたきはしません（該当するモーフがありません）。",
    ),
    "character_words.it_has_no_finger_bones": (
        "No finger bones were found. The hands hold the instrument, but the fingers do not move.",
        "指のボーンがありません。手は楽器を持ちますが、指は動きません。",
    ),
    "character_words.lips_do_not_form_embouchure": (
        "Lip shaping for the embouchure is not available: no matching morphs were found.",
        "唇はアンブシュアの形になりません（該当するモーフがありません）。",
    ),
    "character_words.mouth_does_not_open_it": (
        "Mouth opening is not available: no jaw bone or matching morph was found.",
        "口は開きません（顎のボーンもモーフもありません）。",
    ),
    "character_words.these_fingers_do_not_move": ("Fingers that do not move: {fingers}", "動かない指: {fingers}"),
    "characters_dialog.add": ("Add...", "追加..."),
    "characters_dialog.characters": ("Characters", "キャラクター"),
    "characters_dialog.close": ("Close", "閉じる"),
    "characters_dialog.edit": ("Edit...", "編集..."),
    "characters_dialog.remove": ("Remove...", "削除..."),
    "characters_dialog.your_own_characters_from_vrm": (
        (
            "Your characters, imported from VRM, glTF or FBX files. To add one, click Add or drop a file here. Any "
            "player can use them."
        ),
        (
            "VRM、glTF、FBX ファイルから追加した自分のキャラクターです。「追加」をクリックするか、"
            "ファイルをここにドロップすると追加できます。どの奏者にも割り当てられます。"
        ),
    ),
    "face_map_page.add_morph_of_file": ("Add Morph...", "モーフを追加..."),
    "face_map_page.automatic": ("Automatic", "自動"),
    "face_map_page.face": ("Face", "顔"),
    "face_map_page.file_has_no_morphs_face": (
        "The file has no morphs, so the face does not move.",
        "ファイルにモーフがないため、顔は動きません。",
    ),
    "face_map_page.is_made_of": ("{face} ({name}) uses:", "{face}（{name}）に使うモーフ:"),
    "face_map_page.made_of": ("Morphs", "使うモーフ"),
    "face_map_page.nothing_character_does_not_do": (
        "None. The character does not show this expression.",
        "なし。このキャラクターではこの表情は表示されません。",
    ),
    "face_map_page.take_this_morph_out": ("Remove this morph", "このモーフを削除"),
    "joint.chest": ("Chest", "胸"),
    "joint.eye": ("Eye", "目"),
    "joint.foot": ("Foot", "足"),
    "joint.hand": ("Hand", "手"),
    "joint.head": ("Head", "頭"),
    "joint.hips": ("Hips", "腰"),
    "joint.index_finger": ("Index finger", "人差し指"),
    "joint.index_finger_base": ("Index finger, base", "人差し指・付け根"),
    "joint.index_finger_middle": ("Index finger, middle", "人差し指・中"),
    "joint.index_finger_tip": ("Index finger, tip", "人差し指・先"),
    "joint.jaw": ("Jaw", "顎"),
    "joint.l": ("{part} L", "{part} 左"),
    "joint.little_finger": ("Little finger", "小指"),
    "joint.little_finger_base": ("Little finger, base", "小指・付け根"),
    "joint.little_finger_middle": ("Little finger, middle", "小指・中"),
    "joint.little_finger_tip": ("Little finger, tip", "小指・先"),
    "joint.lower_arm": ("Lower arm", "前腕"),
    "joint.lower_leg": ("Lower leg", "すね"),
    "joint.middle_finger": ("Middle finger", "中指"),
    "joint.middle_finger_base": ("Middle finger, base", "中指・付け根"),
    "joint.middle_finger_middle": ("Middle finger, middle", "中指・中"),
    "joint.middle_finger_tip": ("Middle finger, tip", "中指・先"),
    "joint.neck": ("Neck", "首"),
    "joint.r": ("{part} R", "{part} 右"),
    "joint.ring_finger": ("Ring finger", "薬指"),
    "joint.ring_finger_base": ("Ring finger, base", "薬指・付け根"),
    "joint.ring_finger_middle": ("Ring finger, middle", "薬指・中"),
    "joint.ring_finger_tip": ("Ring finger, tip", "薬指・先"),
    "joint.shoulder": ("Shoulder", "肩"),
    "joint.spine": ("Spine", "背骨"),
    "joint.thumb": ("Thumb", "親指"),
    "joint.thumb_base": ("Thumb, base", "親指・付け根"),
    "joint.thumb_middle": ("Thumb, middle", "親指・中"),
    "joint.thumb_tip": ("Thumb, tip", "親指・先"),
    "joint.toes": ("Toes", "つま先"),
    "joint.upper_arm": ("Upper arm", "上腕"),
    "joint.upper_chest": ("Upper chest", "上胸"),
    "joint.upper_leg": ("Upper leg", "太もも"),
}
