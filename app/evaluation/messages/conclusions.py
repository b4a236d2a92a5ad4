"""The results of an evaluation in words: what tables are called, and what may and may not be concluded."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "results.title": ("Evaluation of {piece}", "「{piece}」の評価"),
    "results.scores": ("Scores", "評点"),
    "results.scores_note": (
        "Answers from 1 (worst) to 5 (best). Every viewer counts once, with the mean of his or her answers; mean, "
        "median, "
        "standard deviation and the 95 % interval (Student's t) are over viewers.",
        "回答は 1（最低）〜 5（最高）。参加者ごとに回答を平均し、その値の平均・中央値・標準偏差・95 % 信頼区間"
        "（スチューデントの t）を求めています。",
    ),
    "results.contrasts": ("Comparisons", "比較"),
    "results.contrasts_note": (
        "First minus second, paired by viewer: in pairs of clips seen side by side, else of the same excerpt. "
        "Wilcoxon's "
        "signed-rank test, two-sided; corrected by Holm for the comparisons of the same question. Effect: "
        "rank-biserial "
        "correlation, -1 to 1.",
        "同じ参加者の「前者 − 後者」（ペアでは並べて見た 2 本、単独では同じ箇所どうし）。ウィルコクソンの符号付順"
        "位検定"
        "（両側）、補正は同じ質問の中の比較についてホルム法。効果量は順位双列相関（-1 〜 1）。",
    ),
    "results.agreements": ("Agreement of viewers", "参加者間の一致度"),
    "results.agreements_note": (
        "Krippendorff's alpha for ordinal answers: 1 all agree, 0 as by chance; 0.8 is reliable, below 0.667 is not.",
        "クリッペンドルフの α（順序尺度）: 1 は完全な一致、0 は偶然と同程度。0.8 以上で信頼でき、0.667 未満では"
        "信頼できません。",
    ),
    "results.measures": ("Measures without viewers", "参加者によらない測定値"),
    "results.measures_note": (
        "Lag: action seen minus note heard; ITU-R BT.1359-1: detected beyond -125 and +45 ms, not accepted beyond "
        "-185 "
        "and +90 ms. Head: RMS speed, 0.3 to 15 Hz. Shoulders and mouth: how far they move at breaths / between. "
        "Contact: "
        "notes with every fingertip within 1 mm of its place.",
        "遅れ: 動作が見える時刻 − 音が鳴る時刻。ITU-R BT.1359-1 では -125 ms・+45 ms を超えると気づかれ、-185 ms・"
        "+90 ms "
        "を超えると許容されません。頭: 速さの実効値（0.3〜15 Hz）。肩と口元: 息継ぎ中／その間の動きの幅。接触: すべ"
        "ての指先が"
        "所定の位置から 1 mm 以内にある音の割合。",
    ),
    "results.may": ("What may be concluded", "結論できること"),
    "results.may_not": ("What may not be concluded", "結論できないこと"),
    "results.variant": ("variant", "バリエーション"),
    "results.presentation": ("shown", "提示"),
    "results.aspect": ("aspect", "観点"),
    "results.scale": ("scale", "尺度"),
    "results.viewers_head": ("viewers", "参加者"),
    "results.answers_head": ("answers", "回答"),
    "results.not_judged_head": ("cannot judge", "判断不能"),
    "results.mean": ("mean", "平均"),
    "results.median": ("median", "中央値"),
    "results.deviation": ("SD", "標準偏差"),
    "results.interval": ("95 % interval", "95 % 信頼区間"),
    "results.compared": ("compared", "比較"),
    "results.difference": ("difference", "差"),
    "results.p": ("p", "p"),
    "results.corrected": ("corrected p", "補正後の p"),
    "results.effect": ("effect", "効果量"),
    "results.clips": ("clips", "クリップ"),
    "results.alpha": ("alpha", "α"),
    "results.player": ("player", "奏者"),
    "results.lag": ("lag ms", "遅れ ms"),
    "results.detected": ("detected %", "気づかれる %"),
    "results.unaccepted": ("not accepted %", "許容外 %"),
    "results.head": ("head mm/s", "頭 mm/s"),
    "results.shoulders": ("shoulders mm", "肩 mm"),
    "results.mouth_opens": ("mouth %", "口元 %"),
    "results.contact": ("contact %", "接触 %"),
    "results.variant_film": ("film", "実演の映像"),
    "results.variant_generated": ("generated", "生成"),
    "results.variant_still": ("amplitude 0", "動きの大きさ 0"),
    "results.variant_shifted": ("fingers 200 ms late", "指が 200 ms 遅れ"),
    "results.variant_keyframes": ("keyframes", "キーフレーム"),
    "results.presentation_single": ("single", "単独"),
    "results.presentation_pair": ("pair", "ペア"),
    "results.aspect_fingers_arms": ("fingers and arms", "指と腕"),
    "results.aspect_body": ("body", "体"),
    "results.aspect_mouth": ("mouth", "口元"),
    "results.aspect_ensemble": ("ensemble", "アンサンブル"),
    "results.scale_naturalness": ("naturalness", "自然さ"),
    "results.scale_synchrony": ("synchrony", "音との同期"),
    "results.answered": (
        '{viewers} {viewers:viewer|viewers}, {answers} {answers:answer|answers}; "cannot judge": {not_judged}.',
        "参加者 {viewers} 名、回答 {answers} 件、「判断できない」{not_judged} 件。",
    ),
    "results.better": (
        '{presentation}: "{variant}" was judged better than "{beside}" in {count} of {total} '
        "{total:question|questions}, by up to {most:.2f} steps on average (* in the comparisons).",
        "{presentation}: 「{variant}」は「{beside}」より、質問 {total} 個中 {count} 個で高く評価されました"
        "（平均で最大 {most:.2f} 段階、比較の表の *）。",
    ),
    "results.none_better": (
        "No variant was shown to be judged better than another.",
        "どのバリエーションについても、他より高く評価されたとは示されませんでした。",
    ),
    "results.control_noticed": (
        "Control ({presentation}): fingers that are 200 ms late were judged less in time than ours "
        "({difference:+.2f}, "
        "one-sided {p}, viewers: {viewers}). Viewers notice 200 ms, so their answers about the timing of fingers "
        "count; "
        "lags below 200 ms are not tested by that.",
        "対照（{presentation}）: 200 ms 遅れた指は、生成したものより同期が低く評価されました（{difference:+.2f}、"
        "片側 {p}、"
        "参加者 {viewers} 名）。参加者は 200 ms に気づいているので、指のタイミングについての回答は有効です。200 "
        "ms 未満の"
        "遅れはこれでは確かめられません。",
    ),
    "results.control_unclear": (
        "Control ({presentation}): fingers that are 200 ms late were judged less in time than ours "
        "({difference:+.2f}), "
        "but not significantly (one-sided {p}, viewers: {viewers}). It is not shown that viewers notice 200 ms: "
        "do not "
        "conclude from good scores that fingers are in time.",
        "対照（{presentation}）: 200 ms 遅れた指は、生成したものより同期が低く評価されましたが（{difference:+.2f}）、"
        "有意ではありません（片側 {p}、参加者 {viewers} 名）。参加者が 200 ms に気づくとは示されていないため、評点"
        "が高くても"
        "指が音に合っているとは結論できません。",
    ),
    "results.control_unnoticed": (
        "Control ({presentation}): fingers that are 200 ms late were not judged less in time than ours "
        "({difference:+.2f}, one-sided {p}, viewers: {viewers}). These viewers did not notice 200 ms: their "
        "answers about "
        "the timing of fingers say nothing.",
        "対照（{presentation}）: 200 ms 遅れた指の同期は、生成したものより低く評価されませんでした（"
        "{difference:+.2f}、"
        "片側 {p}、参加者 {viewers} 名）。参加者は 200 ms に気づいていないため、指のタイミングについての回答からは"
        "何も"
        "言えません。",
    ),
    "results.control_unjudged": (
        "Control ({presentation}): no one judged the synchrony of both ours and the late fingers. It is not known "
        "whether "
        "viewers notice 200 ms.",
        "対照（{presentation}）: 生成したものと遅れた指の両方の同期を評価した参加者がいません。200 ms に気づくかど"
        "うかは"
        "わかりません。",
    ),
    "results.no_control": (
        "Without the control (fingers 200 ms late), or without questions about its synchrony, it is not known "
        "what lag "
        "these viewers notice.",
        "対照（指を 200 ms 遅らせたもの）またはその同期の質問がないため、参加者がどの程度の遅れに気づくかはわかり"
        "ません。",
    ),
    "results.one_viewer": (
        "One viewer: means are this viewer's opinion. There are no intervals and no tests; ask more viewers.",
        "参加者が 1 名のため、平均はその人の意見です。信頼区間も検定もありません。参加者を増やしてください。",
    ),
    "results.too_few": (
        "Too few viewers for any difference: all {viewers} of one opinion give only {p} after correction for "
        "{comparisons} {comparisons:comparison|comparisons}. Ask at least {least}.",
        "参加者が少なすぎて、どんな差も示せません。{viewers} 名全員が一致しても、比較 {comparisons} 件の補正後は "
        "{p} です。"
        "少なくとも {least} 名に依頼してください。",
    ),
    "results.few": (
        "With {viewers} viewers only large differences show; ITU-R BT.500 asks for at least 15.",
        "参加者 {viewers} 名では大きな差しか示せません。ITU-R BT.500 は 15 名以上を求めています。",
    ),
    "results.not_equal": (
        "Comparisons that are not significant: {count} of {total}. They do not show that two variants are equal: the "
        "interval of each difference says how large it may be.",
        "有意でない比較は {total} 件中 {count} 件です。これは 2 つのバリエーションが同等であることを示しません。差"
        "がどこまで"
        "大きく"
        "なりうるかは、差の信頼区間を見てください。",
    ),
    "results.film_open": (
        "Questions in which no difference was shown between real players and ours: {count}. That is not equality: "
        "ours "
        "may be worse by up to {worse:.2f} steps ({presentation}, {aspect}, {scale}).",
        "実演と生成の差が示されなかった質問は {count} 個です。同等という意味ではなく、生成が最大 {worse:.2f} 段階"
        "低い可能性が"
        "あります（{presentation}・{aspect}・{scale}）。",
    ),
    "results.intervals": (
        "Whether two intervals of means overlap decides nothing, because the same viewers judged both: look at the "
        "comparisons. An interval without width means only that all viewers' means are the same.",
        "同じ参加者が両方を評価しているため、平均の信頼区間が重なるかどうかでは差を判断できません。比較の表を見て"
        "ください。"
        "幅のない区間は、全員の平均が同じことを示すだけです。",
    ),
    "results.uncorrected": (
        "The correction covers the comparisons within one question. There are {questions} questions: where nothing "
        "differs, about 1 in 20 still shows a difference by chance.",
        "補正は 1 つの質問の中の比較についてのものです。質問は {questions} 個あり、差が全くなくても約 20 個に 1 個"
        "では"
        "偶然に差が出ます。",
    ),
    "results.disagree": (
        "Viewers agree little (alpha below 0.667) about {count} of {total} questions: a mean may hide opposite "
        "opinions, "
        "and small differences of means say little about a single viewer.",
        "質問 {total} 個中 {count} 個で参加者の一致度が低く（α が 0.667 未満）、平均の裏に反対の意見が隠れている可"
        "能性が"
        "あります。平均の小さな差は、個々の参加者については多くを語りません。",
    ),
    "results.later": (
        "{presentation}: answers in the second half of a session are {difference:+.2f} steps different (95 % "
        "interval "
        "{low:.2f} to {high:.2f}). Orders are balanced, so all variants are affected alike, but absolute scores "
        "are not "
        "exact.",
        "{presentation}: 後半の回答は前半と {difference:+.2f} 段階違います（95 % 信頼区間 {low:.2f} 〜 "
        "{high:.2f}）。順序は"
        "均等に割り付けられているのでバリエーション間の比較には同じように影響しますが、評点そのものは正確ではあり"
        "ません。",
    ),
    "results.order_open": (
        "{presentation}: no effect of the order was shown; with few viewers that does not exclude one.",
        "{presentation}: 順序の影響は示されませんでしたが、参加者が少ない場合は影響がないとは言えません。",
    ),
    "results.not_pooled": (
        "Pairs are judged in sight of the other clip, which makes differences larger; clips on their own are "
        "nearer to "
        "what an audience sees. The two are not averaged, and a score in one says nothing about the other.",
        "ペアは並べて見るため差が大きく出ます。単独の提示のほうが実際の鑑賞に近い条件です。両者は平均していませ"
        "ん。一方の"
        "評点から他方については言えません。",
    ),
    "results.incomplete": (
        "Viewers with fewer answers than others: {count} ({ids}). Their means rest on fewer clips.",
        "他より回答の少ない参加者: {count} 名（{ids}）。その平均は少ないクリップによるものです。",
    ),
    "results.unvaried": (
        "Viewers who gave the same answer to everything: {count} ({ids}). They are counted, but tell nothing about "
        "differences.",
        "すべてに同じ回答をした参加者: {count} 名（{ids}）。集計に含めていますが、差については何も示しません。",
    ),
    "results.scope": (
        "All of it is about these excerpts, views and viewers. Another piece, camera or audience may judge "
        "differently.",
        "以上はこの抜粋・視点・参加者についてのものです。曲やカメラ、観客が違えば、評価も違う可能性があります。",
    ),
    "results.plot": ("Means with 95 % intervals over viewers", "平均と 95 % 信頼区間（参加者間）"),
}
