<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="ja" sourcelanguage="en">
<context>
    <name>Character</name>
    <message>
        <source>Woman</source>
        <translation>女性</translation>
    </message>
    <message>
        <source>Man</source>
        <translation>男性</translation>
    </message>
</context>
<context>
    <name>ColourSwatch</name>
    <message>
        <source>Automatic</source>
        <translation>自動</translation>
    </message>
    <message>
        <source>Sky blue</source>
        <translation>空色</translation>
    </message>
    <message>
        <source>Orange</source>
        <translation>オレンジ</translation>
    </message>
    <message>
        <source>Green</source>
        <translation>緑</translation>
    </message>
    <message>
        <source>Pink</source>
        <translation>ピンク</translation>
    </message>
    <message>
        <source>Yellow</source>
        <translation>黄</translation>
    </message>
    <message>
        <source>Blue</source>
        <translation>青</translation>
    </message>
    <message>
        <source>Vermilion</source>
        <translation>朱</translation>
    </message>
    <message>
        <source>Grey</source>
        <translation>灰</translation>
    </message>
    <message>
        <source>Other colour...</source>
        <translation>その他の色...</translation>
    </message>
    <message>
        <source>Colour of the player</source>
        <translation>プレイヤーの色</translation>
    </message>
</context>
<context>
    <name>Event</name>
    <message>
        <source>Breath</source>
        <translation>ブレス</translation>
    </message>
    <message>
        <source>Preparation</source>
        <translation>準備</translation>
    </message>
    <message>
        <source>Cue</source>
        <translation>合図</translation>
    </message>
    <message>
        <source>Expression</source>
        <translation>表情</translation>
    </message>
    <message>
        <source>Sway</source>
        <translation>揺れ</translation>
    </message>
    <message>
        <source>Weight shift</source>
        <translation>重心移動</translation>
    </message>
    <message>
        <source>Bell height</source>
        <translation>ベルの高さ</translation>
    </message>
    <message>
        <source>Instrument lowered</source>
        <translation>楽器を下ろす</translation>
    </message>
    <message>
        <source>Pose</source>
        <translation>ポーズ</translation>
    </message>
    <message>
        <source>Fingering</source>
        <translation>運指</translation>
    </message>
    <message>
        <source>Removal</source>
        <translation>削除</translation>
    </message>
    <message>
        <source>Embouchure</source>
        <translation>アンブシュア</translation>
    </message>
    <message>
        <source>Gesture</source>
        <translation>ジェスチャー</translation>
    </message>
    <message>
        <source>Performed anew</source>
        <translation>演奏し直し</translation>
    </message>
</context>
<context>
    <name>Expression</name>
    <message>
        <source>Neutral</source>
        <translation>ニュートラル</translation>
    </message>
    <message>
        <source>Strained</source>
        <translation>力み</translation>
    </message>
    <message>
        <source>Puffed</source>
        <translation>頬をふくらます</translation>
    </message>
    <message>
        <source>Brows up</source>
        <translation>眉を上げる</translation>
    </message>
    <message>
        <source>Smile</source>
        <translation>微笑み</translation>
    </message>
</context>
<context>
    <name>Fingering</name>
    <message>
        <source>L</source>
        <translation>左</translation>
    </message>
    <message>
        <source>R</source>
        <translation>右</translation>
    </message>
    <message>
        <source>thumb</source>
        <translation>親指</translation>
    </message>
    <message>
        <source>index</source>
        <translation>人差し指</translation>
    </message>
    <message>
        <source>middle</source>
        <translation>中指</translation>
    </message>
    <message>
        <source>ring</source>
        <translation>薬指</translation>
    </message>
    <message>
        <source>little</source>
        <translation>小指</translation>
    </message>
    <message>
        <source>hand</source>
        <translation>手</translation>
    </message>
    <message>
        <source>{hand} {part}</source>
        <translation>{hand}{part}</translation>
    </message>
    <message>
        <source>{cm} cm</source>
        <translation>{cm} cm</translation>
    </message>
</context>
<context>
    <name>FingeringTag</name>
    <message>
        <source>alternate</source>
        <translation>替え指</translation>
    </message>
    <message>
        <source>trill</source>
        <translation>トリル</translation>
    </message>
    <message>
        <source>fast</source>
        <translation>速い音形</translation>
    </message>
    <message>
        <source>chromatic</source>
        <translation>半音階</translation>
    </message>
    <message>
        <source>attack</source>
        <translation>発音</translation>
    </message>
    <message>
        <source>held</source>
        <translation>押さえたまま</translation>
    </message>
    <message>
        <source>rare</source>
        <translation>まれ</translation>
    </message>
    <message>
        <source>forked</source>
        <translation>フォーク</translation>
    </message>
    <message>
        <source>raised</source>
        <translation>高め</translation>
    </message>
    <message>
        <source>forte</source>
        <translation>フォルテ</translation>
    </message>
    <message>
        <source>piano</source>
        <translation>ピアノ</translation>
    </message>
    <message>
        <source>obsolete</source>
        <translation>廃止</translation>
    </message>
</context>
<context>
    <name>Language</name>
    <message>
        <source>en</source>
        <translation>ja</translation>
    </message>
</context>
<context>
    <name>Morph</name>
    <message>
        <source>L</source>
        <comment>left side</comment>
        <translation>左</translation>
    </message>
    <message>
        <source>R</source>
        <comment>right side</comment>
        <translation>右</translation>
    </message>
    <message>
        <source>Brow down</source>
        <translation>眉を下げる</translation>
    </message>
    <message>
        <source>Inner brows up</source>
        <translation>眉頭を上げる</translation>
    </message>
    <message>
        <source>Outer brow up</source>
        <translation>眉尻を上げる</translation>
    </message>
    <message>
        <source>Cheeks puffed</source>
        <translation>頬をふくらます</translation>
    </message>
    <message>
        <source>Cheek raised</source>
        <translation>頬を上げる</translation>
    </message>
    <message>
        <source>Eye closed</source>
        <translation>目を閉じる</translation>
    </message>
    <message>
        <source>Looks down</source>
        <translation>下を見る</translation>
    </message>
    <message>
        <source>Looks in</source>
        <translation>内側を見る</translation>
    </message>
    <message>
        <source>Looks out</source>
        <translation>外側を見る</translation>
    </message>
    <message>
        <source>Looks up</source>
        <translation>上を見る</translation>
    </message>
    <message>
        <source>Eye narrowed</source>
        <translation>目を細める</translation>
    </message>
    <message>
        <source>Eye wide</source>
        <translation>目を見開く</translation>
    </message>
    <message>
        <source>Jaw forward</source>
        <translation>顎を前へ</translation>
    </message>
    <message>
        <source>Jaw to the left</source>
        <translation>顎を左へ</translation>
    </message>
    <message>
        <source>Jaw open</source>
        <translation>顎を開く</translation>
    </message>
    <message>
        <source>Jaw to the right</source>
        <translation>顎を右へ</translation>
    </message>
    <message>
        <source>Lips closed</source>
        <translation>唇を閉じる</translation>
    </message>
    <message>
        <source>Dimple</source>
        <translation>えくぼ</translation>
    </message>
    <message>
        <source>Corner down</source>
        <translation>口角を下げる</translation>
    </message>
    <message>
        <source>Funnel</source>
        <translation>口を丸める</translation>
    </message>
    <message>
        <source>Mouth to the left</source>
        <translation>口を左へ</translation>
    </message>
    <message>
        <source>Lower lip down</source>
        <translation>下唇を下げる</translation>
    </message>
    <message>
        <source>Lips pressed</source>
        <translation>唇を結ぶ</translation>
    </message>
    <message>
        <source>Pucker</source>
        <translation>口をすぼめる</translation>
    </message>
    <message>
        <source>Mouth to the right</source>
        <translation>口を右へ</translation>
    </message>
    <message>
        <source>Lower lip rolled in</source>
        <translation>下唇を巻き込む</translation>
    </message>
    <message>
        <source>Upper lip rolled in</source>
        <translation>上唇を巻き込む</translation>
    </message>
    <message>
        <source>Lower lip pushed up</source>
        <translation>下唇を押し上げる</translation>
    </message>
    <message>
        <source>Upper lip pushed up</source>
        <translation>上唇を押し上げる</translation>
    </message>
    <message>
        <source>Smile</source>
        <translation>口角を上げる</translation>
    </message>
    <message>
        <source>Corner stretched</source>
        <translation>口角を横に引く</translation>
    </message>
    <message>
        <source>Upper lip up</source>
        <translation>上唇を上げる</translation>
    </message>
    <message>
        <source>Nose wrinkled</source>
        <translation>鼻にしわ</translation>
    </message>
    <message>
        <source>Tongue out</source>
        <translation>舌を出す</translation>
    </message>
</context>
<context>
    <name>NumberSlider</name>
    <message>
        <source>Type a value</source>
        <translation>値を入力</translation>
    </message>
    <message>
        <source>Copy value</source>
        <translation>値をコピー</translation>
    </message>
    <message>
        <source>Paste value</source>
        <translation>値を貼り付け</translation>
    </message>
    <message>
        <source>Reset</source>
        <translation>初期値に戻す</translation>
    </message>
</context>
<context>
    <name>Percussion</name>
    <message>
        <source>Acoustic Bass Drum</source>
        <translation>アコースティックバスドラム</translation>
    </message>
    <message>
        <source>Bass Drum 1</source>
        <translation>バスドラム1</translation>
    </message>
    <message>
        <source>Side Stick</source>
        <translation>サイドスティック</translation>
    </message>
    <message>
        <source>Acoustic Snare</source>
        <translation>アコースティックスネア</translation>
    </message>
    <message>
        <source>Hand Clap</source>
        <translation>ハンドクラップ</translation>
    </message>
    <message>
        <source>Electric Snare</source>
        <translation>エレクトリックスネア</translation>
    </message>
    <message>
        <source>Low Floor Tom</source>
        <translation>ローフロアタム</translation>
    </message>
    <message>
        <source>Closed Hi-hat</source>
        <translation>クローズハイハット</translation>
    </message>
    <message>
        <source>High Floor Tom</source>
        <translation>ハイフロアタム</translation>
    </message>
    <message>
        <source>Pedal Hi-hat</source>
        <translation>ペダルハイハット</translation>
    </message>
    <message>
        <source>Low Tom</source>
        <translation>ロータム</translation>
    </message>
    <message>
        <source>Open Hi-hat</source>
        <translation>オープンハイハット</translation>
    </message>
    <message>
        <source>Low-Mid Tom</source>
        <translation>ローミッドタム</translation>
    </message>
    <message>
        <source>High-Mid Tom</source>
        <translation>ハイミッドタム</translation>
    </message>
    <message>
        <source>Crash Cymbal 1</source>
        <translation>クラッシュシンバル1</translation>
    </message>
    <message>
        <source>High Tom</source>
        <translation>ハイタム</translation>
    </message>
    <message>
        <source>Ride Cymbal 1</source>
        <translation>ライドシンバル1</translation>
    </message>
    <message>
        <source>Chinese Cymbal</source>
        <translation>チャイナシンバル</translation>
    </message>
    <message>
        <source>Ride Bell</source>
        <translation>ライドベル</translation>
    </message>
    <message>
        <source>Tambourine</source>
        <translation>タンバリン</translation>
    </message>
    <message>
        <source>Splash Cymbal</source>
        <translation>スプラッシュシンバル</translation>
    </message>
    <message>
        <source>Cowbell</source>
        <translation>カウベル</translation>
    </message>
    <message>
        <source>Crash Cymbal 2</source>
        <translation>クラッシュシンバル2</translation>
    </message>
    <message>
        <source>Vibraslap</source>
        <translation>ビブラスラップ</translation>
    </message>
    <message>
        <source>Ride Cymbal 2</source>
        <translation>ライドシンバル2</translation>
    </message>
    <message>
        <source>High Bongo</source>
        <translation>ハイボンゴ</translation>
    </message>
    <message>
        <source>Low Bongo</source>
        <translation>ローボンゴ</translation>
    </message>
    <message>
        <source>Mute High Conga</source>
        <translation>ミュートハイコンガ</translation>
    </message>
    <message>
        <source>Open High Conga</source>
        <translation>オープンハイコンガ</translation>
    </message>
    <message>
        <source>Low Conga</source>
        <translation>ローコンガ</translation>
    </message>
    <message>
        <source>High Timbale</source>
        <translation>ハイティンバレ</translation>
    </message>
    <message>
        <source>Low Timbale</source>
        <translation>ローティンバレ</translation>
    </message>
    <message>
        <source>High Agogo</source>
        <translation>ハイアゴゴ</translation>
    </message>
    <message>
        <source>Low Agogo</source>
        <translation>ローアゴゴ</translation>
    </message>
    <message>
        <source>Cabasa</source>
        <translation>カバサ</translation>
    </message>
    <message>
        <source>Maracas</source>
        <translation>マラカス</translation>
    </message>
    <message>
        <source>Short Whistle</source>
        <translation>ショートホイッスル</translation>
    </message>
    <message>
        <source>Long Whistle</source>
        <translation>ロングホイッスル</translation>
    </message>
    <message>
        <source>Short Guiro</source>
        <translation>ショートギロ</translation>
    </message>
    <message>
        <source>Long Guiro</source>
        <translation>ロングギロ</translation>
    </message>
    <message>
        <source>Claves</source>
        <translation>クラベス</translation>
    </message>
    <message>
        <source>High Wood Block</source>
        <translation>ハイウッドブロック</translation>
    </message>
    <message>
        <source>Low Wood Block</source>
        <translation>ローウッドブロック</translation>
    </message>
    <message>
        <source>Mute Cuica</source>
        <translation>ミュートクイーカ</translation>
    </message>
    <message>
        <source>Open Cuica</source>
        <translation>オープンクイーカ</translation>
    </message>
    <message>
        <source>Mute Triangle</source>
        <translation>ミュートトライアングル</translation>
    </message>
    <message>
        <source>Open Triangle</source>
        <translation>オープントライアングル</translation>
    </message>
</context>
<context>
    <name>Pitch</name>
    <message>
        <source>Do Re Mi Fa So La Ti</source>
        <translation>ド レ ミ ファ ソ ラ シ</translation>
    </message>
</context>
<context>
    <name>Pose</name>
    <message>
        <source>Bell</source>
        <translation>ベル</translation>
    </message>
    <message>
        <source>Head</source>
        <translation>頭</translation>
    </message>
    <message>
        <source>Left elbow</source>
        <translation>左ひじ</translation>
    </message>
    <message>
        <source>Right elbow</source>
        <translation>右ひじ</translation>
    </message>
    <message>
        <source>Torso</source>
        <translation>胴</translation>
    </message>
</context>
<context>
    <name>Told</name>
    <message>
        <source>{pitch} (bar {bar}, beat {beat})</source>
        <translation>{pitch}（{bar} 小節 {beat} 拍）</translation>
    </message>
    <message>
        <source>a note that is gone</source>
        <translation>なくなった音符</translation>
    </message>
    <message>
        <source>{side} thumb</source>
        <translation>{side}手の親指</translation>
    </message>
    <message>
        <source>{side} index finger</source>
        <translation>{side}手の人差し指</translation>
    </message>
    <message>
        <source>{side} middle finger</source>
        <translation>{side}手の中指</translation>
    </message>
    <message>
        <source>{side} ring finger</source>
        <translation>{side}手の薬指</translation>
    </message>
    <message>
        <source>{side} little finger</source>
        <translation>{side}手の小指</translation>
    </message>
    <message>
        <source>{side} palm</source>
        <translation>{side}の手のひら</translation>
    </message>
    <message>
        <source>web of the {side} thumb</source>
        <translation>{side}手の親指の付け根</translation>
    </message>
    <message>
        <source>valve {number}</source>
        <translation>{number}番ピストン</translation>
    </message>
    <message>
        <source>the slide of valve {number}</source>
        <translation>{number}番抜差管</translation>
    </message>
    <message>
        <source>the slide</source>
        <translation>スライド</translation>
    </message>
    <message>
        <source>the trigger</source>
        <translation>レバー</translation>
    </message>
    <message>
        <source>left</source>
        <translation>左</translation>
    </message>
    <message>
        <source>right</source>
        <translation>右</translation>
    </message>
    <message>
        <source>up and down</source>
        <translation>上下</translation>
    </message>
    <message>
        <source>to the side</source>
        <translation>左右</translation>
    </message>
    <message>
        <source>leaning</source>
        <translation>傾き</translation>
    </message>
    <message>
        <source>chosen as leader</source>
        <translation>リーダー指定</translation>
    </message>
    <message>
        <source>leads the melody</source>
        <translation>旋律を担当するセクションの首席</translation>
    </message>
</context>
</TS>
