"""The skeleton that files are written on, and an asset it is for."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "skeleton.root_added": (
        ("{file} has several root bones ({bones}); Unreal accepts only one, so the bone {root} was added above them"),
        (
            "{file} にはルートボーンが複数あります（{bones}）。Unreal はルートを 1 つしか受け付けないため、"
            "その上にボーン {root} を追加しました"
        ),
    ),
    "skeleton.armature_left_out": (
        (
            "{file}: {armature}, Blender's armature object, is not a bone in Unreal and is excluded; the root bone "
            "is {root}"
        ),
        (
            "{file}: Blender のアーマチュア {armature} は Unreal ではボーンにならないため、除外します。"
            "ルートボーンは {root} です"
        ),
    ),
    "skeleton.kept_root": (
        "the root bone of {character}'s own skeleton is the hips, so no root bone carries the place or the motion",
        "{character} 自身のスケルトンはルートが腰のため、位置や移動をルートボーンに持たせません",
    ),
    "skeleton.kept_rest_pose": (
        "{character}'s own skeleton keeps its rest pose",
        "{character} 自身のスケルトンはレストポーズを変えません",
    ),
    "skeleton.kept_twist_bones": (
        "{character}'s own skeleton keeps its twist bones and skin weights",
        "{character} 自身のスケルトンはツイストボーンとスキンウェイトを変えません",
    ),
    "skeleton.other_root": (
        "the root bone is {ours}, but the asset's is {theirs}; Unreal will not accept the animation",
        "ルートボーンは {ours} ですが、アセットでは {theirs} です。Unreal はこのアニメーションを受け付けません",
    ),
    "skeleton.other_parent": (
        "the parent of {bone} is {ours}, but {theirs} in the asset",
        "{bone} の親は {ours} ですが、アセットでは {theirs} です",
    ),
    "skeleton.other_unit": (
        "lengths are {factor} times those of the asset: the units differ",
        "長さがアセットの {factor} 倍です。単位が異なります",
    ),
    "skeleton.not_in_asset": (
        (
            "{count} {count:animated bone is|animated bones are} not in the asset, so {count:its|their} motion "
            "would be lost: {bones}"
        ),
        "動くボーン {count} 個がアセットにないため、その動きは失われます: {bones}",
    ),
    "skeleton.additional": (
        "{count} {count:static bone|static bones} {count:is|are} not in the asset: {bones}",
        "動かないボーン {count} 個がアセットにありません: {bones}",
    ),
    "skeleton.requested": (
        (
            "{count} {count:bone|bones} for instruments and IK {count:is|are} not in the asset and must be added "
            "there: {bones}"
        ),
        "楽器と IK のボーン {count} 個がアセットにないため、アセットに追加する必要があります: {bones}",
    ),
    "skeleton.missing": (
        (
            "{count} {count:bone|bones} of the asset {count:is|are} missing from the file and {count:keeps "
            "its|keep their} rest pose: {bones}"
        ),
        "アセットのボーン {count} 個がファイルになく、レストポーズのままです: {bones}",
    ),
    "skeleton.rotation": (
        (
            "{count} {count:bone has|bones have} a different rest rotation from the asset, by up to {most} degrees "
            "({bone})"
        ),
        "{count} 個のボーンのレスト回転がアセットと異なります（最大 {most} 度、{bone}）",
    ),
    "skeleton.position": (
        ("{count} {count:bone has|bones have} a different rest position from the asset, by up to {most} mm ({bone})"),
        "{count} 個のボーンのレスト位置がアセットと異なります（最大 {most} mm、{bone}）",
    ),
    "skeleton.differs": (
        "{file} has a different skeleton from the export skeleton of {player}: {detail}",
        "{file} のスケルトンは、{player} の書き出し用スケルトンと異なります: {detail}",
    ),
}
"""Message id -> English template."""
