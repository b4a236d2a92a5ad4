<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="ja" sourcelanguage="en">
<context>
    <name>ActingLane</name>
    <message>
        <location filename="../../widgets/timeline/lanes/acting.py" line="74"/>
        <source>Acting</source>
        <translation>演技</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/acting.py" line="76"/>
        <source>Drag to move, up and down for the strength, an edge to resize, a corner for a fade; double-click adds</source>
        <translation>ドラッグで移動、上下で強さ、端で長さ、角でフェードを変更します。ダブルクリックで追加します</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/acting.py" line="87"/>
        <source>Pose</source>
        <translation>ポーズ</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/acting.py" line="322"/>
        <source>Another expression</source>
        <translation>別の表情にする</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/acting.py" line="324"/>
        <source>Add an expression here</source>
        <translation>ここに表情を追加</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/acting.py" line="326"/>
        <source>Add a gesture here</source>
        <translation>ここにジェスチャーを追加</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/acting.py" line="330"/>
        <source>Add a cue here</source>
        <translation>ここに合図を追加</translation>
    </message>
</context>
<context>
    <name>Alternates</name>
    <message>
        <location filename="../../widgets/timeline/lanes/alternates.py" line="47"/>
        <source>trill</source>
        <translation>トリル</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/alternates.py" line="48"/>
        <source>fast</source>
        <translation>速い音形</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/alternates.py" line="49"/>
        <source>raised</source>
        <translation>高め</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/alternates.py" line="50"/>
        <source>alternate</source>
        <translation>替え指</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/alternates.py" line="76"/>
        <source>Choice {rank}</source>
        <translation>第 {rank} 候補</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/alternates.py" line="80"/>
        <source>Generated</source>
        <translation>自動に戻す</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/alternates.py" line="85"/>
        <source>Back to the generator&apos;s choice</source>
        <translation>自動生成の運指に戻します</translation>
    </message>
</context>
<context>
    <name>BreathLane</name>
    <message>
        <location filename="../../widgets/timeline/lanes/breath.py" line="44"/>
        <source>Breath</source>
        <translation>ブレス</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/breath.py" line="46"/>
        <source>Drag to move, up and down for the depth, an edge to resize; double-click adds one</source>
        <translation>ドラッグで移動、上下で深さ、端で長さを変更します。ダブルクリックで追加します</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/breath.py" line="101"/>
        <source>depth {depth:.2f}, {seconds:.2f} s</source>
        <translation>深さ {depth:.2f}、{seconds:.2f} 秒</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/breath.py" line="120"/>
        <source>Add a breath here</source>
        <translation>ここにブレスを追加</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/breath.py" line="129"/>
        <source>Prepared</source>
        <translation>予備動作あり</translation>
    </message>
</context>
<context>
    <name>CurvesLane</name>
    <message>
        <location filename="../../widgets/timeline/lanes/curves.py" line="177"/>
        <source>Curves</source>
        <translation>カーブ</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/curves.py" line="178"/>
        <source>Drag a note&apos;s value up or down; Shift for fine steps</source>
        <translation>音符の値を上下にドラッグします。Shift で細かく動かせます</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/curves.py" line="179"/>
        <source>The curve that is edited or shown in front</source>
        <translation>編集する、または手前に表示するカーブ</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/curves.py" line="180"/>
        <source>Curve</source>
        <translation>カーブ</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/curves.py" line="186"/>
        <source>Lip tension</source>
        <translation>唇の緊張</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/curves.py" line="187"/>
        <source>Effort</source>
        <translation>力み</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/curves.py" line="188"/>
        <source>Air</source>
        <translation>息の量</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/curves.py" line="189"/>
        <source>Breath controller</source>
        <translation>ブレス (CC2)</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/curves.py" line="190"/>
        <source>Volume</source>
        <translation>ボリューム</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/curves.py" line="191"/>
        <source>Expression</source>
        <translation>エクスプレッション</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/curves.py" line="192"/>
        <source>Aftertouch</source>
        <translation>アフタータッチ</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/curves.py" line="193"/>
        <source>Pitch bend</source>
        <translation>ピッチベンド</translation>
    </message>
</context>
<context>
    <name>FingeringLane</name>
    <message>
        <location filename="../../widgets/timeline/lanes/fingering.py" line="199"/>
        <source>Fingering</source>
        <translation>運指</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/fingering.py" line="200"/>
        <source>Click a note to see its alternates; type a fingering to pin it</source>
        <translation>音符をクリックすると替え指が出ます。運指を入力すると固定されます</translation>
    </message>
</context>
<context>
    <name>PianoRoll</name>
    <message>
        <location filename="../../widgets/timeline/roll.py" line="145"/>
        <source>Nobody plays yet: open a MIDI file, or add a player.</source>
        <translation>奏者がまだいません。MIDI ファイルを開くか、奏者を追加してください。</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/roll.py" line="148"/>
        <source>No notes yet: take the pencil and draw, double-click, or paste.</source>
        <translation>音符がまだありません。鉛筆で描くか、ダブルクリック、または貼り付けで入力できます。</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/roll.py" line="232"/>
        <source>{pitch}: click to select all its notes</source>
        <translation>{pitch}：クリックでこの音高の音符をすべて選択</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/roll.py" line="421"/>
        <source>Velocity {velocity}</source>
        <translation>ベロシティ {velocity}</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/roll.py" line="435"/>
        <source>{pitch} · bar {bar}, beat {beat}</source>
        <translation>{pitch} · {bar} 小節 {beat} 拍</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/roll.py" line="438"/>
        <source> · velocity {velocity}</source>
        <translation> · ベロシティ {velocity}</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/roll.py" line="477"/>
        <source>Notes</source>
        <translation>音符</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/roll.py" line="478"/>
        <source>Notes of the player in front; the others behind</source>
        <translation>手前の奏者の音符（ほかの奏者は背面に表示）</translation>
    </message>
</context>
<context>
    <name>ProblemsLane</name>
    <message>
        <location filename="../../widgets/timeline/lanes/problems.py" line="123"/>
        <source>Problems</source>
        <translation>問題</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/problems.py" line="124"/>
        <source>What the player in front cannot do as it stands; F8 goes to the next</source>
        <translation>手前の奏者がこのままではできないこと。F8 で次へ進みます</translation>
    </message>
</context>
<context>
    <name>QuantisePopover</name>
    <message>
        <location filename="../../widgets/timeline/quantise.py" line="92"/>
        <source>Grid</source>
        <translation>グリッド</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/quantise.py" line="93"/>
        <source>Strength</source>
        <translation>強さ</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/quantise.py" line="94"/>
        <source>Beginnings</source>
        <translation>音の頭</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/quantise.py" line="95"/>
        <source>Ends</source>
        <translation>音の終わり</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/quantise.py" line="96"/>
        <source>Quantise</source>
        <translation>クオンタイズ</translation>
    </message>
</context>
<context>
    <name>RegionLane</name>
    <message>
        <location filename="../../widgets/timeline/lanes/regions.py" line="365"/>
        <source>How much</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/regions.py" line="441"/>
        <source>deleted by hand</source>
        <translation>手作業で削除</translation>
    </message>
</context>
<context>
    <name>Ruler</name>
    <message>
        <location filename="../../widgets/timeline/ruler.py" line="147"/>
        <source>Bars</source>
        <translation>小節</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/ruler.py" line="148"/>
        <source>Seconds</source>
        <translation>秒</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/ruler.py" line="149"/>
        <source>Frames</source>
        <translation>フレーム</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/ruler.py" line="153"/>
        <source>What the ruler counts</source>
        <translation>ルーラーの単位</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/ruler.py" line="320"/>
        <source>Tempo in quarters per minute; Enter takes it, Escape leaves it</source>
        <translation>テンポ（1 分あたりの四分音符の数）。Enter で確定、Esc で取り消し</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/ruler.py" line="322"/>
        <source>Metre, e.g. 6/8; Enter takes it, Escape leaves it</source>
        <translation>拍子（例：6/8）。Enter で確定、Esc で取り消し</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/ruler.py" line="368"/>
        <source>Change Tempo</source>
        <translation>テンポを変更</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/ruler.py" line="368"/>
        <source>Change Metre</source>
        <translation>拍子を変更</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/ruler.py" line="370"/>
        <source>Remove Tempo</source>
        <translation>テンポを削除</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/ruler.py" line="370"/>
        <source>Remove Metre</source>
        <translation>拍子を削除</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/ruler.py" line="377"/>
        <source>Add Tempo Here</source>
        <translation>ここにテンポを追加</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/ruler.py" line="378"/>
        <source>Add Metre at This Bar</source>
        <translation>この小節に拍子を追加</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/ruler.py" line="380"/>
        <source>Select This Bar</source>
        <translation>この小節を選択</translation>
    </message>
</context>
<context>
    <name>TimelinePanel</name>
    <message>
        <location filename="../../widgets/timeline/panel.py" line="168"/>
        <source>Lanes</source>
        <translation>レーン</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/panel.py" line="169"/>
        <source>Which lanes are shown, and in which order</source>
        <translation>表示するレーンと並び順</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/panel.py" line="171"/>
        <source>Zoom out (Ctrl+wheel)</source>
        <translation>縮小（Ctrl+ホイール）</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/panel.py" line="172"/>
        <source>Zoom in (Ctrl+wheel)</source>
        <translation>拡大（Ctrl+ホイール）</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/panel.py" line="173"/>
        <source>Show the whole piece (double-click the ruler)</source>
        <translation>曲全体を表示（ルーラーをダブルクリック）</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/panel.py" line="273"/>
        <source>Unfold All</source>
        <translation>すべて展開</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/panel.py" line="274"/>
        <source>Fold All</source>
        <translation>すべて折りたたむ</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/panel.py" line="288"/>
        <source>Move Up</source>
        <translation>上へ移動</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/panel.py" line="291"/>
        <source>Move Down</source>
        <translation>下へ移動</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/panel.py" line="295"/>
        <source>Unfold</source>
        <translation>展開</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/panel.py" line="295"/>
        <source>Fold</source>
        <translation>折りたたむ</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/panel.py" line="297"/>
        <source>Hide</source>
        <translation>隠す</translation>
    </message>
</context>
<context>
    <name>ToolBar</name>
    <message>
        <location filename="../../widgets/timeline/tool_bar.py" line="95"/>
        <source>Select: click, drag a frame, drag notes and their ends</source>
        <translation>選択：クリック、枠で囲む、音符や端をドラッグ</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/tool_bar.py" line="96"/>
        <source>Draw: drag out a new note</source>
        <translation>描画：ドラッグで新しい音符を入力</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/tool_bar.py" line="97"/>
        <source>Erase: drag over notes</source>
        <translation>消去：音符の上をドラッグ</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/tool_bar.py" line="98"/>
        <source>Split: click where the note shall be cut</source>
        <translation>分割：音符の切りたい位置をクリック</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/tool_bar.py" line="106"/>
        <source>Others as Ghosts</source>
        <translation>ほかの奏者を薄く表示</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/tool_bar.py" line="107"/>
        <source>All Players</source>
        <translation>全奏者</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/tool_bar.py" line="108"/>
        <source>Only This Player</source>
        <translation>この奏者のみ</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/tool_bar.py" line="112"/>
        <source>How the other players&apos; notes are seen</source>
        <translation>ほかの奏者の音符の見せ方</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/tool_bar.py" line="113"/>
        <source>The player in front</source>
        <translation>手前の奏者</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/tool_bar.py" line="134"/>
        <source>Selected notes: {count}</source>
        <translation>選択中の音符：{count}</translation>
    </message>
</context>
<context>
    <name>WaveformLane</name>
    <message>
        <location filename="../../widgets/timeline/lanes/waveform.py" line="95"/>
        <source>Recording</source>
        <translation>録音</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/waveform.py" line="96"/>
        <source>Drag to move it against the score, with Shift finely; double-click types</source>
        <translation>ドラッグで楽譜に対してずらします（Shift で細かく）。ダブルクリックで数値を入力します</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/waveform.py" line="175"/>
        <source>Offset in seconds</source>
        <translation>オフセット（秒）</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/waveform.py" line="101"/>
        <source>Drop a recording here. Until then the synthesiser plays the score.</source>
        <translation>ここに録音をドロップしてください。それまではシンセサイザーが楽譜を鳴らします。</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/waveform.py" line="110"/>
        <source>offset {offset} s · the recording is not read yet</source>
        <translation>オフセット {offset} 秒 · 録音を読み込み中</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/waveform.py" line="112"/>
        <source>offset {offset} s</source>
        <translation>オフセット {offset} 秒</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/waveform.py" line="113"/>
        <source>offset {offset} s (estimated, {confidence:.2f})</source>
        <translation>オフセット {offset} 秒（推定、信頼度 {confidence:.2f}）</translation>
    </message>
    <message>
        <location filename="../../widgets/timeline/lanes/waveform.py" line="186"/>
        <source>Type the offset...</source>
        <translation>オフセットを入力...</translation>
    </message>
</context>
</TS>
