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
        <source>Choreographies</source>
        <translation>振り付け</translation>
    </message>
    <message>
        <source>Choreography</source>
        <translation>振り付け</translation>
    </message>
    <message>
        <source>Another dance for each</source>
        <translation>一人ずつ別の踊りにする</translation>
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
        <source>Colour</source>
        <translation>色</translation>
    </message>
    <message>
        <source>Played seated only: {players}</source>
        <translation>座奏のみの楽器です: {players}</translation>
    </message>
    <message>
        <source>Played standing only: {players}</source>
        <translation>立奏のみの楽器です: {players}</translation>
    </message>
    <message>
        <source>Colour of the player in the timeline and on the stage</source>
        <translation>タイムラインとステージでのプレイヤーの色</translation>
    </message>
    <message>
        <source>Another seed for each</source>
        <translation>それぞれに別のシードを割り当てる</translation>
    </message>
</context>
<context>
    <name>Place</name>
    <message>
        <source>m</source>
        <comment>metres</comment>
        <translation>m</translation>
    </message>
    <message>
        <source>To the right as the audience sees it, from the middle</source>
        <translation>中央から、客席から見て右向き</translation>
    </message>
    <message>
        <source>0 faces the audience, positive turns to the right as the audience sees it</source>
        <translation>0 で客席正面、正の値は客席から見て右向き</translation>
    </message>
    <message>
        <source>X</source>
        <translation>X</translation>
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
