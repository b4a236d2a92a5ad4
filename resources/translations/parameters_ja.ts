<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="ja" sourcelanguage="en">
    <context>
        <name>Parameter</name>
        <message>
            <source>Amplitude</source>
            <translation>動きの大きさ</translation>
        </message>
        <message>
            <source>How much the player moves: 0 still, 0.5 natural, 1 a lot</source>
            <translation>体の動きの量: 0 で静止、0.5 で自然、1 で大きい</translation>
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
            <source>beats</source>
            <translation>拍</translation>
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
            <source>A full lung lasts</source>
            <translation>一息の長さ</translation>
        </message>
        <message>
            <source>On a usual instrument; longer or shorter on one that takes less or more air. Longer phrases get a catch breath</source>
            <translation>一般的な楽器での長さです。息の消費が少ない楽器では長く、多い楽器では短くなります。これより長いフレーズでは途中で息を継ぎます</translation>
        </message>
        <message>
            <source>s</source>
            <translation>秒</translation>
        </message>
        <message>
            <source>Embouchure tension</source>
            <translation>アンブシュアの張り</translation>
        </message>
        <message>
            <source>How tight the lips look, times the natural amount</source>
            <translation>唇の張りの見え方。自然な量に対する倍率</translation>
        </message>
        <message>
            <source>×</source>
            <translation>×</translation>
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
            <source>Posture</source>
            <translation>姿勢</translation>
        </message>
        <message>
            <source>Standing</source>
            <translation>立奏</translation>
        </message>
        <message>
            <source>Seated</source>
            <translation>座奏</translation>
        </message>
        <message>
            <source>Gives cues</source>
            <translation>合図を出す</translation>
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
            <source>Seed</source>
            <translation>シード</translation>
        </message>
        <message>
            <source>Another seed is another performance of the same plan</source>
            <translation>シードを変えると、同じ計画の別の演奏になります</translation>
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
            <source>Circular breathing</source>
            <translation>循環呼吸</translation>
        </message>
        <message>
            <source>Breathes in through the nose while playing, and never stops the line for a catch breath</source>
            <translation>演奏しながら鼻から息を吸い、息継ぎでフレーズを途切れさせません</translation>
        </message>
        <message>
            <source>No</source>
            <translation>なし</translation>
        </message>
        <message>
            <source>Body motion</source>
            <translation>体の動き</translation>
        </message>
        <message>
            <source>How hips, trunk and head move while playing; hands, lips and feet keep their places</source>
            <translation>演奏中の腰、上体、頭の動き。手、唇、足の接触は変わりません</translation>
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
            <source>0: a dance of the player's own; who has the same other number moves in unison, dancers too</source>
            <translation>0 は奏者ごとの踊り。0 以外で同じ数の奏者とダンサーは揃って動きます</translation>
        </message>
        <message>
            <source>Another number is another dance to the same music</source>
            <translation>番号を変えると、同じ音楽に別の踊りになります</translation>
        </message>
        <message>
            <source>Delay</source>
            <translation>遅れ</translation>
        </message>
        <message>
            <source>In a canon: so much later than the music</source>
            <translation>カノン：音楽よりこれだけ遅れて踊ります</translation>
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
    </context>
</TS>
