"""Exports into an Unreal project."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "unreal.not_found": (
        "{file} was not found; choose the .uproject file or its folder",
        "{file} が見つかりません。.uproject ファイルか、それがあるフォルダーを選んでください",
    ),
    "unreal.no_project": (
        "{file} is not an Unreal project; choose the .uproject file or its folder",
        ("{file} は Unreal プロジェクトではありません。.uproject ファイルか、それがあるフォルダーを選んでください"),
    ),
    "unreal.several": (
        "{file} contains several Unreal projects ({names}); choose one of the .uproject files",
        ("{file} には Unreal プロジェクトが複数あります（{names}）。いずれかの .uproject ファイルを選んでください"),
    ),
    "unreal.not_a_project": (
        "{file} cannot be read as an Unreal project: {detail}",
        "{file} を Unreal プロジェクトとして読み込めません: {detail}",
    ),
    "unreal.too_old": (
        "{file} is for Unreal Engine {version}; version {least} or newer is required",
        "{file} は Unreal Engine {version} のプロジェクトです。バージョン {least} 以降が必要です",
    ),
    "unreal.read_only": (
        "{file} is write-protected; nothing was written; allow writing to the project folder and export again",
        (
            "{file} は書き込み禁止です。何も書き出していません。"
            "プロジェクトのフォルダーへの書き込みを許可してから、もう一度書き出してください"
        ),
    ),
    "unreal.locked": (
        ("{file} is write-protected, probably by version control; nothing was written; check it out and export again"),
        (
            "{file} は書き込み禁止です（バージョン管理でチェックアウトされていないようです）。"
            "何も書き出していません。チェックアウトしてから、もう一度書き出してください"
        ),
    ),
    "unreal.manifest": (
        (
            "{file} is damaged ({detail}), so the owner of each file is unknown; nothing was written; move its "
            "folder away and export again"
        ),
        (
            "{file} が壊れており（{detail}）、どのファイルが Suisou のものか判定できません。"
            "何も書き出していません。そのフォルダーを別の場所に移してから、もう一度書き出してください"
        ),
    ),
    "unreal.in_the_way": (
        (
            "{file} was not created by Suisou and would be replaced; nothing was written; move or rename it and "
            "export again"
        ),
        (
            "{file} は Suisou が作成したものではなく、上書きされてしまいます。何も書き出していません。"
            "移動するか名前を変えてから、もう一度書き出してください"
        ),
    ),
    "unreal.changed": (
        (
            "{file} was changed after it was exported; nothing was written; move it away to keep it, or delete it, "
            "and export again"
        ),
        (
            "{file} は書き出した後に変更されています。何も書き出していません。残すなら別の場所に移し、"
            "不要なら削除してから、もう一度書き出してください"
        ),
    ),
    "unreal.kept": (
        "{file} is no longer needed but was changed after export, so it was kept",
        "{file} は不要になりましたが、書き出した後に変更されているため、残しました",
    ),
    "unreal.plugin_foreign": (
        "{file} is another plug-in of the same name; nothing was written; move it away and export again",
        ("{file} は同名の別のプラグインです。何も書き出していません。別の場所に移してから、もう一度書き出してください"),
    ),
    "unreal.file_wrong": (
        (
            "{file} was not written correctly ({what}: {found} instead of {requested}); nothing was changed in the "
            "project; please report this problem"
        ),
        (
            "{file} が正しく書き出されませんでした（{what}: {requested} ではなく {found}）。"
            "プロジェクトは変更していません。この問題を報告してください"
        ),
    ),
    "unreal.done": (
        "files written to the Unreal project {project}: {count}",
        "Unreal プロジェクト {project} に書き出したファイル: {count} 個",
    ),
    "unreal.formats": (
        "--format applies to exports to a folder; Unreal projects always get the formats that Unreal imports",
        ("--format はフォルダーへの書き出し用です。Unreal プロジェクトには、常に Unreal が読み込む形式で書き出します"),
    ),
    "unreal.stage": (
        "--stage applies to exports to a folder; in an Unreal project the sequence places everyone",
        "--stage はフォルダーへの書き出し用です。Unreal プロジェクトでは、シーケンスが全員を配置します",
    ),
    "unreal.keys": (
        "--keys applies to exports to a folder; Unreal projects always get a key on every frame",
        "--keys はフォルダーへの書き出し用です。Unreal プロジェクトには、常に全フレームにキーを書き出します",
    ),
    "tree.busy": (
        "another export to {file} is in progress; wait until it finishes and export again",
        "{file} への別の書き出しが進行中です。終わってから、もう一度書き出してください",
    ),
    "tree.leads_outside": (
        (
            "{file} is a link to {target}, outside the destination folder; nothing was written; replace the link "
            "with a folder and export again"
        ),
        (
            "{file} は書き出し先の外にある {target} へのリンクです。何も書き出していません。"
            "リンクをフォルダーに置き換えてから、もう一度書き出してください"
        ),
    ),
    "tree.not_restored": (
        (
            "{file} could not be restored to its state before the export: {reason}; close the program that is "
            "using it and export again"
        ),
        (
            "{file} を書き出し前の状態に戻せませんでした: {reason}。"
            "このファイルを使用しているプログラムを閉じてから、もう一度書き出してください"
        ),
    ),
    "tree.refused": (
        (
            "{file} cannot be replaced: {reason}; nothing was changed; close the program that is using it and "
            "export again"
        ),
        (
            "{file} を置き換えられません: {reason}。何も変更していません。"
            "このファイルを使用しているプログラムを閉じてから、もう一度書き出してください"
        ),
    ),
}
