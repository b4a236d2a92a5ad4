<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="ja" sourcelanguage="en">
<context>
    <name>BodyDanceRows</name>
    <message>
        <source>Generated</source>
        <translation>自動生成</translation>
    </message>
    <message>
        <source>From File …</source>
        <translation>ファイルから …</translation>
    </message>
    <message>
        <source>How hips, trunk and head move while playing; hands, lips and feet keep their places</source>
        <translation>演奏中の腰、上体、頭の動き。手、唇、足の接触は変わりません</translation>
    </message>
    <message>
        <source>Choreographies</source>
        <translation>振り付け</translation>
    </message>
    <message>
        <source>Choreography</source>
        <translation>振り付け</translation>
    </message>
    <message>
        <source>Body motion</source>
        <translation>体の動き</translation>
    </message>
    <message>
        <source>Another dance for each</source>
        <translation>一人ずつ別の踊りにする</translation>
    </message>
    <message>
        <source>Dance amount</source>
        <translation>踊りの量</translation>
    </message>
    <message>
        <source>How much of the dance: 0 none, 1 as much as a player can do; it takes the place of the sway</source>
        <translation>踊りを加える量。0 は踊りなし、1 は演奏しながらできる最大。その分、自動の揺れは小さくなります</translation>
    </message>
    <message>
        <source>Variation</source>
        <translation>バリエーション</translation>
    </message>
    <message>
        <source>0: a dance of the player&apos;s own; who has the same other number moves in unison, dancers too</source>
        <translation>0 は奏者ごとの踊り。0 以外で同じ数の奏者とダンサーは揃って動きます</translation>
    </message>
</context>
<context>
    <name>DancersSection</name>
    <message>
        <source>Dancers</source>
        <translation>ダンサー</translation>
    </message>
    <message>
        <source>From File …</source>
        <translation>ファイルから …</translation>
    </message>
    <message>
        <source>Learn …</source>
        <translation>学習…</translation>
    </message>
    <message>
        <source>None</source>
        <translation>なし</translation>
    </message>
    <message>
        <source>Dancer</source>
        <translation>ダンサー</translation>
    </message>
    <message>
        <source>Choreographies</source>
        <translation>振り付け</translation>
    </message>
    <message>
        <source>Choreography</source>
        <translation>振り付け</translation>
    </message>
    <message>
        <source>Add a dancer</source>
        <translation>ダンサーを追加</translation>
    </message>
    <message>
        <source>Duplicate: another one dances the same</source>
        <translation>複製：もう 1 人が同じ踊りを踊ります</translation>
    </message>
    <message>
        <source>Remove the selected dancer</source>
        <translation>選択したダンサーを削除</translation>
    </message>
    <message>
        <source>Character</source>
        <translation>キャラクター</translation>
    </message>
    <message>
        <source>Preferred source</source>
        <translation>優先ソース</translation>
    </message>
    <message>
        <source>The capture whose motion is danced where it suits the music about as well</source>
        <translation>音楽に同じくらい合うとき、このキャプチャの動きを優先します</translation>
    </message>
    <message>
        <source>Mirrored</source>
        <translation>左右反転</translation>
    </message>
    <message>
        <source>Left and right exchanged</source>
        <translation>左右を入れ替えます</translation>
    </message>
    <message>
        <source>Show what the choreography has learned</source>
        <translation>振り付けの内容を表示</translation>
    </message>
    <message>
        <source>Another dance to the same music</source>
        <translation>同じ音楽に別の踊りを作ります</translation>
    </message>
    <message>
        <source>m</source>
        <comment>metres</comment>
        <translation>m</translation>
    </message>
    <message>
        <source>Variation</source>
        <translation>バリエーション</translation>
    </message>
    <message>
        <source>Another number is another dance to the same music</source>
        <translation>番号を変えると、同じ音楽に別の踊りになります</translation>
    </message>
    <message>
        <source>Size of motion</source>
        <translation>動きの大きさ</translation>
    </message>
    <message>
        <source>Of trunk and arms: 1 as captured</source>
        <translation>体幹と腕の動き：1 はキャプチャのまま</translation>
    </message>
    <message>
        <source>Weight</source>
        <translation>重さ</translation>
    </message>
    <message>
        <source>From light to heavy: how deep the knees bend; 0 as captured</source>
        <translation>軽い動きから重い動きへ：膝を曲げる深さ。0 はキャプチャのまま</translation>
    </message>
    <message>
        <source>Delay</source>
        <translation>遅れ</translation>
    </message>
    <message>
        <source>beats</source>
        <translation>拍</translation>
    </message>
    <message>
        <source>In a canon: so much later than the music</source>
        <translation>カノン：音楽よりこれだけ遅れて踊ります</translation>
    </message>
    <message>
        <source>X</source>
        <translation>X</translation>
    </message>
    <message>
        <source>To the right as the audience sees it, from the middle</source>
        <translation>客席から見て右方向、中央から</translation>
    </message>
    <message>
        <source>Z</source>
        <translation>Z</translation>
    </message>
    <message>
        <source>Towards the audience, from the middle</source>
        <translation>客席に向かう方向、中央から</translation>
    </message>
    <message>
        <source>Turn</source>
        <translation>向き</translation>
    </message>
    <message>
        <source>0 faces the audience, positive turns to the right as the audience sees it</source>
        <translation>0 は客席向き、正の値は客席から見て右向き</translation>
    </message>
</context>
<context>
    <name>ParameterSections</name>
    <message>
        <source>Player</source>
        <translation>プレイヤー</translation>
    </message>
    <message>
        <source>Motion</source>
        <translation>動き</translation>
    </message>
    <message>
        <source>Breath</source>
        <translation>ブレス</translation>
    </message>
    <message>
        <source>Face</source>
        <translation>顔</translation>
    </message>
    <message>
        <source>Part</source>
        <translation>パート</translation>
    </message>
    <message>
        <source>Instrument</source>
        <translation>楽器</translation>
    </message>
    <message>
        <source>Character</source>
        <translation>キャラクター</translation>
    </message>
    <message>
        <source>Posture</source>
        <translation>姿勢</translation>
    </message>
    <message>
        <source>Gives cues</source>
        <translation>合図を出す</translation>
    </message>
    <message>
        <source>Colour</source>
        <translation>色</translation>
    </message>
    <message>
        <source>Standing</source>
        <translation>立奏</translation>
    </message>
    <message>
        <source>Played seated only: {players}</source>
        <translation>座奏のみの楽器です: {players}</translation>
    </message>
    <message>
        <source>Seated</source>
        <translation>座奏</translation>
    </message>
    <message>
        <source>Played standing only: {players}</source>
        <translation>立奏のみの楽器です: {players}</translation>
    </message>
    <message>
        <source>Automatic</source>
        <translation>自動</translation>
    </message>
    <message>
        <source>Yes</source>
        <translation>はい</translation>
    </message>
    <message>
        <source>Never</source>
        <translation>出さない</translation>
    </message>
    <message>
        <source>Circular breathing</source>
        <translation>循環呼吸</translation>
    </message>
    <message>
        <source>No</source>
        <translation>なし</translation>
    </message>
    <message>
        <source>Breathes in through the nose while playing, and never stops the line for a catch breath</source>
        <translation>演奏しながら鼻から息を吸い、息継ぎでフレーズを途切れさせません</translation>
    </message>
    <message>
        <source>Colour of the player in the timeline and on the stage</source>
        <translation>タイムラインとステージでのプレイヤーの色</translation>
    </message>
    <message>
        <source>Another seed for each</source>
        <translation>それぞれに別のシードを割り当てる</translation>
    </message>
    <message>
        <source>beats</source>
        <translation>拍</translation>
    </message>
    <message>
        <source>s</source>
        <comment>seconds</comment>
        <translation>秒</translation>
    </message>
    <message>
        <source>Amplitude</source>
        <translation>動きの大きさ</translation>
    </message>
    <message>
        <source>How much the player moves: 0 still, 0.5 natural, 1 a lot</source>
        <translation>体の動きの量: 0 で静止、0.5 で自然、1 で大きい</translation>
    </message>
    <message>
        <source>Sway</source>
        <translation>揺れ</translation>
    </message>
    <message>
        <source>Swaying with the beat, times the natural amount</source>
        <translation>拍に合わせた揺れ。自然な量に対する倍率</translation>
    </message>
    <message>
        <source>Weight shift</source>
        <translation>重心移動</translation>
    </message>
    <message>
        <source>From foot to foot, times the natural amount</source>
        <translation>足から足への重心移動。自然な量に対する倍率</translation>
    </message>
    <message>
        <source>Bell height</source>
        <translation>ベルの高さ</translation>
    </message>
    <message>
        <source>The bell follows the melody, times the natural amount</source>
        <translation>旋律に合わせたベルの上下。自然な量に対する倍率</translation>
    </message>
    <message>
        <source>Seed</source>
        <translation>シード</translation>
    </message>
    <message>
        <source>Another seed is another performance of the same plan</source>
        <translation>シードを変えると、同じ計画の別の演奏になります</translation>
    </message>
    <message>
        <source>Breathes in rests from</source>
        <translation>息を吸う休符の下限</translation>
    </message>
    <message>
        <source>In a shorter rest the player does not breathe</source>
        <translation>これより短い休符では息を吸いません</translation>
    </message>
    <message>
        <source>On the last beat from</source>
        <translation>最後の拍で吸う下限</translation>
    </message>
    <message>
        <source>In a rest from this length on, the breath takes its last beat; in a shorter one all of it</source>
        <translation>この長さ以上の休符では最後の 1 拍で吸い、短い休符では休符全体で吸います</translation>
    </message>
    <message>
        <source>Prepared from</source>
        <translation>予備動作を付ける下限</translation>
    </message>
    <message>
        <source>In a rest from this length on, the player gets ready, then breathes on the last beat</source>
        <translation>この長さ以上の休符では構え直してから最後の拍で吸います</translation>
    </message>
    <message>
        <source>Air spent first</source>
        <translation>ブレスまでに使う息</translation>
    </message>
    <message>
        <source>Part of the lungs that is used up before the player breathes in a rest too short to prepare in: 0 every such rest, 1 only with empty lungs</source>
        <translation>構え直せない短い休符で吸うまでに使う息の割合。0 ではどの休符でも吸い、1 では息が尽きたときだけ吸います</translation>
    </message>
    <message>
        <source>A full lung lasts</source>
        <translation>一息の長さ</translation>
    </message>
    <message>
        <source>On a usual instrument; longer or shorter on one that takes less or more air. Longer phrases get a catch breath</source>
        <translation>一般的な楽器での長さです。息の消費が少ない楽器では長く、多い楽器では短くなります。これより長いフレーズでは途中で息を継ぎます</translation>
    </message>
    <message>
        <source>Embouchure tension</source>
        <translation>アンブシュアの張り</translation>
    </message>
    <message>
        <source>How tight the lips look, times the natural amount</source>
        <translation>唇の張りの見え方。自然な量に対する倍率</translation>
    </message>
</context>
<context>
    <name>PlayersPanel</name>
    <message>
        <source>{chosen} of {count} selected</source>
        <translation>{count} 人中 {chosen} 人を選択</translation>
    </message>
    <message>
        <source>Players: {count}</source>
        <translation>プレイヤー {count} 人</translation>
    </message>
    <message>
        <source>Add a player</source>
        <translation>プレイヤーを追加</translation>
    </message>
    <message>
        <source>Remove the selected players</source>
        <translation>選択したプレイヤーを削除</translation>
    </message>
    <message>
        <source>Nobody plays yet. Add a player with ＋, or drag a MIDI file onto the window.</source>
        <translation>まだ誰もいません。＋ でプレイヤーを追加するか、MIDI ファイルをウィンドウにドラッグしてください。</translation>
    </message>
    <message>
        <source>Variety</source>
        <translation>ばらつき</translation>
    </message>
    <message>
        <source>{instrument}, played by {name}</source>
        <translation>{instrument} ({name}が持ち替え)</translation>
    </message>
    <message>
        <source>selected players</source>
        <translation>選択したプレイヤー</translation>
    </message>
    <message>
        <source>all players</source>
        <translation>全員</translation>
    </message>
    <message>
        <source>Duplicate: somebody else plays the same, from a copy of the part</source>
        <translation>複製: 同じ内容のパートを吹く人を増やす</translation>
    </message>
    <message>
        <source>Spread</source>
        <translation>ばらつきの幅</translation>
    </message>
    <message>
        <source>How far apart the players become: 0 all the same, 1 as different as is sensible</source>
        <translation>プレイヤー同士の違い: 0 で全員同じ、1 で無理のない最大</translation>
    </message>
    <message>
        <source>Randomise</source>
        <translation>ランダム化</translation>
    </message>
    <message>
        <source>Amplitude, sway, weight shift, bell height, lungs, embouchure and seed by chance, around their average</source>
        <translation>動きの大きさ、揺れ、重心移動、ベルの高さ、肺活量、アンブシュア、シードを、今の平均を中心にランダムに決めます</translation>
    </message>
    <message>
        <source>Reset</source>
        <translation>リセット</translation>
    </message>
    <message>
        <source>Return all parameters of the selected players to what they were cast with</source>
        <translation>選択したプレイヤーの全パラメータを配役時の値に戻します</translation>
    </message>
</context>
<context>
    <name>PresetSection</name>
    <message>
        <source>Presets</source>
        <translation>プリセット</translation>
    </message>
    <message>
        <source>No presets yet</source>
        <translation>プリセットはまだありません</translation>
    </message>
    <message>
        <source>Name for a new preset</source>
        <translation>新しいプリセットの名前</translation>
    </message>
    <message>
        <source>Apply to the selected players</source>
        <translation>選択したプレイヤーに適用</translation>
    </message>
    <message>
        <source>Save the parameters of the player in front; the same name replaces</source>
        <translation>手前のプレイヤーのパラメータを保存（同じ名前は上書き）</translation>
    </message>
    <message>
        <source>Delete this preset from your folder</source>
        <translation>このプリセットをフォルダから削除</translation>
    </message>
</context>
<context>
    <name>StageSection</name>
    <message>
        <source>Stage</source>
        <translation>ステージ</translation>
    </message>
    <message>
        <source>Snap to 0.1 m and 5° (Alt: the other way round)</source>
        <translation>0.1 m と 5° にスナップ（Alt で一時的に反転）</translation>
    </message>
    <message>
        <source>Automatic arc: everyone in order, open to the audience</source>
        <translation>自動配置: 全員を順番に、客席に開いた弧に並べる</translation>
    </message>
    <message>
        <source>Stage from above</source>
        <translation>上から見たステージ</translation>
    </message>
    <message>
        <source>m</source>
        <comment>metres</comment>
        <translation>m</translation>
    </message>
    <message>
        <source>X</source>
        <translation>X</translation>
    </message>
    <message>
        <source>To the right as the audience sees it, from the middle</source>
        <translation>中央から、客席から見て右向き</translation>
    </message>
    <message>
        <source>Z</source>
        <translation>Z</translation>
    </message>
    <message>
        <source>Towards the audience, from the middle</source>
        <translation>中央から客席向き</translation>
    </message>
    <message>
        <source>Turn</source>
        <translation>向き</translation>
    </message>
    <message>
        <source>0 faces the audience, positive turns to the right as the audience sees it</source>
        <translation>0 で客席正面、正の値は客席から見て右向き</translation>
    </message>
</context>
<context>
    <name>StageView</name>
    <message>
        <source>▾ Audience</source>
        <translation>▾ 客席</translation>
    </message>
    <message>
        <source>grid {step} m</source>
        <translation>方眼 {step} m</translation>
    </message>
</context>
<context>
    <name>_RowDelegate</name>
    <message>
        <source>Cannot be seen</source>
        <translation>表示できません</translation>
    </message>
    <message>
        <source>Mute: not heard, but still seen and exported</source>
        <translation>ミュート: 音は出ませんが、画面と書き出しには残ります</translation>
    </message>
    <message>
        <source>Solo: only these are heard</source>
        <translation>ソロ: このプレイヤーだけが聞こえます</translation>
    </message>
    <message>
        <source>Is recorded, whoever is in front. Click: whoever is in front then</source>
        <translation>常にこのプレイヤーを録音します。クリックすると手前のプレイヤーの録音に戻ります</translation>
    </message>
    <message>
        <source>Record this player, whoever is in front</source>
        <translation>常にこのプレイヤーを録音する</translation>
    </message>
    <message>
        <source>Gives the entries</source>
        <translation>アインザッツを出す</translation>
    </message>
    <message>
        <source>Problems: {count}</source>
        <translation>問題: {count}</translation>
    </message>
</context>
</TS>
