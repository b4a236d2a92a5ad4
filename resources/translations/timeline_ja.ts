<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="ja" sourcelanguage="en">
<context>
    <name>ActingLane</name>
    <message>
        <source>Acting</source>
        <translation>演技</translation>
    </message>
    <message>
        <source>Drag to move, up and down for the strength, an edge to resize, a corner for a fade; double-click adds</source>
        <translation>ドラッグで移動、上下で強さ、端で長さ、角でフェードを変更します。ダブルクリックで追加します</translation>
    </message>
    <message>
        <source>Anew</source>
        <translation>やり直し</translation>
    </message>
    <message>
        <source>Pose</source>
        <translation>ポーズ</translation>
    </message>
    <message>
        <source>These bars are performed anew, with other chances; Backspace brings the first performance back</source>
        <translation>この小節は別の偶然で演奏し直されています。Backspace で最初の演奏に戻ります</translation>
    </message>
    <message>
        <source>Another expression</source>
        <translation>別の表情にする</translation>
    </message>
    <message>
        <source>Add an expression here</source>
        <translation>ここに表情を追加</translation>
    </message>
    <message>
        <source>Add a gesture here</source>
        <translation>ここにジェスチャーを追加</translation>
    </message>
    <message>
        <source>Add a cue here</source>
        <translation>ここに合図を追加</translation>
    </message>
</context>
<context>
    <name>Alternates</name>
    <message>
        <source>Choice {rank}</source>
        <translation>第 {rank} 候補</translation>
    </message>
    <message>
        <source>Generated</source>
        <translation>自動に戻す</translation>
    </message>
    <message>
        <source>Back to the generator&apos;s choice</source>
        <translation>自動生成の運指に戻します</translation>
    </message>
</context>
<context>
    <name>BreathLane</name>
    <message>
        <source>Breath</source>
        <translation>ブレス</translation>
    </message>
    <message>
        <source>Drag to move, up and down for the depth, an edge to resize; double-click adds one</source>
        <translation>ドラッグで移動、上下で深さ、端で長さを変更します。ダブルクリックで追加します</translation>
    </message>
    <message>
        <source>depth {depth:.2f}, {seconds:.2f} s</source>
        <translation>深さ {depth:.2f}、{seconds:.2f} 秒</translation>
    </message>
    <message>
        <source>Add a breath here</source>
        <translation>ここにブレスを追加</translation>
    </message>
    <message>
        <source>Prepared</source>
        <translation>予備動作あり</translation>
    </message>
</context>
<context>
    <name>CurvesLane</name>
    <message>
        <source>Curves</source>
        <translation>カーブ</translation>
    </message>
    <message>
        <source>Drag a note&apos;s value up or down; Shift for fine steps</source>
        <translation>音符の値を上下にドラッグします。Shift で細かく動かせます</translation>
    </message>
    <message>
        <source>The curve that is edited or shown in front</source>
        <translation>編集する、または手前に表示するカーブ</translation>
    </message>
    <message>
        <source>Curve</source>
        <translation>カーブ</translation>
    </message>
    <message>
        <source>Lip tension</source>
        <translation>唇の緊張</translation>
    </message>
    <message>
        <source>Effort</source>
        <translation>力み</translation>
    </message>
    <message>
        <source>Air</source>
        <translation>息の量</translation>
    </message>
    <message>
        <source>Breath controller</source>
        <translation>ブレス (CC2)</translation>
    </message>
    <message>
        <source>Bite</source>
        <translation>バイト</translation>
    </message>
    <message>
        <source>Volume</source>
        <translation>ボリューム</translation>
    </message>
    <message>
        <source>Expression</source>
        <translation>エクスプレッション</translation>
    </message>
    <message>
        <source>Aftertouch</source>
        <translation>アフタータッチ</translation>
    </message>
    <message>
        <source>Pitch bend</source>
        <translation>ピッチベンド</translation>
    </message>
</context>
<context>
    <name>DanceLane</name>
    <message>
        <source>Dance</source>
        <translation>ダンス</translation>
    </message>
    <message>
        <source>What each dancer dances. Click a motion to select it, drag it to another beat, up and down for another one, right-click for more; Backspace returns it to the generator</source>
        <translation>各ダンサーの踊り。動作をクリックで選択、ドラッグで別の拍へ移動、上下キーで別の動作に変更、右クリックでその他の操作、Backspaceで自動生成に戻します</translation>
    </message>
    <message>
        <source>No dancers yet. Add one in the Players panel.</source>
        <translation>ダンサーはまだいません。「プレイヤー」パネルで追加してください。</translation>
    </message>
    <message>
        <source>No beat of the music is known.</source>
        <translation>曲に拍がありません。</translation>
    </message>
    <message>
        <source>Basic motion {number}, {seconds:.2f} s</source>
        <translation>基本動作{number}、{seconds:.2f}秒</translation>
    </message>
    <message>
        <source>From {source}, {start:.2f} s</source>
        <translation>{source}の{start:.2f}秒から</translation>
    </message>
    <message>
        <source>Pinned; Backspace returns it to the generator</source>
        <translation>固定済み。Backspaceで自動生成に戻します</translation>
    </message>
    <message>
        <source>Basic motion {number} is not danced here</source>
        <translation>ここでは基本動作{number}を踊りません</translation>
    </message>
</context>
<context>
    <name>DanceMenu</name>
    <message>
        <source>Pin Basic Motion {number} Here</source>
        <translation>ここで基本動作{number}に固定</translation>
    </message>
    <message>
        <source>Do Not Dance Basic Motion {number} Here</source>
        <translation>ここで基本動作{number}を禁止</translation>
    </message>
    <message>
        <source>Do Not Dance Basic Motion {number} in This Piece</source>
        <translation>この曲で基本動作{number}を禁止</translation>
    </message>
    <message>
        <source>Allow Basic Motion {number} Again</source>
        <translation>基本動作{number}の禁止を解除</translation>
    </message>
    <message>
        <source>Return to Generator</source>
        <translation>自動生成に戻す</translation>
    </message>
    <message>
        <source>Return Whole Dance to Generator</source>
        <translation>踊り全体を自動生成に戻す</translation>
    </message>
    <message>
        <source>Other Basic Motion</source>
        <translation>別の基本動作</translation>
    </message>
    <message>
        <source>Basic Motion {number}</source>
        <translation>基本動作{number}</translation>
    </message>
    <message>
        <source>Other Segment of This Motion</source>
        <translation>この動作の別の区間</translation>
    </message>
    <message>
        <source>{source}, {start:.2f} s</source>
        <translation>{source}、{start:.2f}秒</translation>
    </message>
</context>
<context>
    <name>FingeringLane</name>
    <message>
        <source>Fingering</source>
        <translation>運指</translation>
    </message>
    <message>
        <source>Click a note to see its alternates; type a fingering to pin it</source>
        <translation>音符をクリックすると替え指が出ます。運指を入力すると固定されます</translation>
    </message>
</context>
<context>
    <name>Flags</name>
    <message>
        <source>Bar {bar}</source>
        <translation>小節 {bar}</translation>
    </message>
</context>
<context>
    <name>Lane</name>
    <message>
        <source>Unfold</source>
        <translation>展開する</translation>
    </message>
    <message>
        <source>Fold</source>
        <translation>折りたたむ</translation>
    </message>
</context>
<context>
    <name>MarkEditor</name>
    <message>
        <source>Tempo in quarters per minute; Enter takes it, Escape leaves it</source>
        <translation>テンポ（1 分あたりの四分音符の数）。Enter で確定、Esc で取り消し</translation>
    </message>
    <message>
        <source>Metre, e.g. 6/8; Enter takes it, Escape leaves it</source>
        <translation>拍子（例：6/8）。Enter で確定、Esc で取り消し</translation>
    </message>
</context>
<context>
    <name>PianoRoll</name>
    <message>
        <source>Nobody plays yet: open a MIDI file, or add a player.</source>
        <translation>プレイヤーがまだいません。MIDI ファイルを開くか、プレイヤーを追加してください。</translation>
    </message>
    <message>
        <source>No notes yet: take the pencil and draw, double-click, or paste.</source>
        <translation>音符がまだありません。鉛筆で描くか、ダブルクリック、または貼り付けで入力できます。</translation>
    </message>
    <message>
        <source>{pitch}: click to select all its notes</source>
        <translation>{pitch}：クリックでこの音高の音符をすべて選択</translation>
    </message>
    <message>
        <source>Velocity {velocity}</source>
        <translation>ベロシティ {velocity}</translation>
    </message>
    <message>
        <source>{pitch} · bar {bar}, beat {beat}</source>
        <translation>{pitch} · {bar} 小節 {beat} 拍</translation>
    </message>
    <message>
        <source> · velocity {velocity}</source>
        <translation> · ベロシティ {velocity}</translation>
    </message>
    <message>
        <source>Notes</source>
        <translation>音符</translation>
    </message>
    <message>
        <source>Notes of the player in front; the others behind</source>
        <translation>手前のプレイヤーの音符（ほかのプレイヤーは背面に表示）</translation>
    </message>
</context>
<context>
    <name>ProblemsLane</name>
    <message>
        <source>Problems</source>
        <translation>問題</translation>
    </message>
    <message>
        <source>What the player in front cannot do as it stands; F8 goes to the next</source>
        <translation>手前のプレイヤーがこのままではできないこと。F8 で次へ進みます</translation>
    </message>
</context>
<context>
    <name>QuantisePopover</name>
    <message>
        <source>Grid</source>
        <translation>グリッド</translation>
    </message>
    <message>
        <source>Strength</source>
        <translation>強さ</translation>
    </message>
    <message>
        <source>Beginnings</source>
        <translation>音の頭</translation>
    </message>
    <message>
        <source>Ends</source>
        <translation>音の終わり</translation>
    </message>
    <message>
        <source>Quantise</source>
        <translation>クオンタイズ</translation>
    </message>
</context>
<context>
    <name>RegionLane</name>
    <message>
        <source>How much</source>
        <translation>量</translation>
    </message>
    <message>
        <source>deleted by hand</source>
        <translation>手作業で削除</translation>
    </message>
</context>
<context>
    <name>Ruler</name>
    <message>
        <source>Change Tempo</source>
        <translation>テンポを変更</translation>
    </message>
    <message>
        <source>Change Metre</source>
        <translation>拍子を変更</translation>
    </message>
    <message>
        <source>Remove Tempo</source>
        <translation>テンポを削除</translation>
    </message>
    <message>
        <source>Remove Metre</source>
        <translation>拍子を削除</translation>
    </message>
    <message>
        <source>Add Tempo Here</source>
        <translation>ここにテンポを追加</translation>
    </message>
    <message>
        <source>Add Metre at This Bar</source>
        <translation>この小節に拍子を追加</translation>
    </message>
    <message>
        <source>Felt Beat</source>
        <translation>拍の単位</translation>
    </message>
    <message>
        <source>Select This Bar</source>
        <translation>この小節を選択</translation>
    </message>
</context>
<context>
    <name>TakeHeads</name>
    <message>
        <source>Takes</source>
        <translation>テイク</translation>
    </message>
    <message>
        <source>Before</source>
        <translation>録音前</translation>
    </message>
    <message>
        <source>What was there before the first take. Double-click takes all of it back</source>
        <translation>最初のテイクより前の内容。ダブルクリックですべて元に戻します</translation>
    </message>
    <message>
        <source>{seconds:.1f} s, notes: {count}</source>
        <translation>{seconds:.1f} 秒、音符 {count} 個</translation>
    </message>
    <message>
        <source>Double-click takes all of it</source>
        <translation>ダブルクリックですべて採用します</translation>
    </message>
    <message>
        <source>Name of the take</source>
        <translation>テイクの名前</translation>
    </message>
</context>
<context>
    <name>TakesLane</name>
    <message>
        <source>What was recorded of the player in front. Drag over a row to take that stretch from that take</source>
        <translation>前面のプレイヤーの録音。行の上をドラッグすると、その範囲をそのテイクから採用します</translation>
    </message>
    <message>
        <source>Takes ({count})</source>
        <translation>テイク ({count})</translation>
    </message>
    <message>
        <source>Takes</source>
        <translation>テイク</translation>
    </message>
    <message>
        <source>No player is in front.</source>
        <translation>前面のプレイヤーがいません。</translation>
    </message>
    <message>
        <source>Nothing is recorded of {player} yet. Connect a wind controller, start recording ({keys}) and play: each time through becomes a take here. Then drag over the takes to put the part together.</source>
        <translation>{player}の録音はまだありません。ウィンドコントローラーを接続し、録音を始めて（{keys}）演奏すると、1 回ごとにここにテイクができます。テイクの上をドラッグしてパートを組み立てます。</translation>
    </message>
    <message>
        <source>Record</source>
        <translation>録音</translation>
    </message>
    <message>
        <source>Drag to change where one take ends and the other begins</source>
        <translation>ドラッグしてテイクの切り替わる位置を変えます</translation>
    </message>
    <message>
        <source>{note} is left out: {why}</source>
        <translation>{note} は除かれます: {why}</translation>
    </message>
    <message>
        <source>short and soft, a ghost note</source>
        <translation>短く弱い音（ゴーストノート）</translation>
    </message>
    <message>
        <source>blown too softly to be heard</source>
        <translation>息が弱く聞こえない音</translation>
    </message>
    <message>
        <source>a finger was late, it lies between two notes of a legato</source>
        <translation>指が遅れ、レガートの 2 音の間に鳴った音</translation>
    </message>
    <message>
        <source>the same note twice, a key sprang back</source>
        <translation>キーの跳ね返りによる二度打ち</translation>
    </message>
</context>
<context>
    <name>TimelinePanel</name>
    <message>
        <source>Lanes</source>
        <translation>レーン</translation>
    </message>
    <message>
        <source>Which lanes are shown, and in which order</source>
        <translation>表示するレーンと並び順</translation>
    </message>
    <message>
        <source>Zoom out (Ctrl+wheel)</source>
        <translation>縮小（Ctrl+ホイール）</translation>
    </message>
    <message>
        <source>Zoom in (Ctrl+wheel)</source>
        <translation>拡大（Ctrl+ホイール）</translation>
    </message>
    <message>
        <source>Show the whole piece (double-click the ruler)</source>
        <translation>曲全体を表示（ルーラーをダブルクリック）</translation>
    </message>
    <message>
        <source>Unfold All</source>
        <translation>すべて展開</translation>
    </message>
    <message>
        <source>Fold All</source>
        <translation>すべて折りたたむ</translation>
    </message>
    <message>
        <source>Move Up</source>
        <translation>上へ移動</translation>
    </message>
    <message>
        <source>Move Down</source>
        <translation>下へ移動</translation>
    </message>
    <message>
        <source>Unfold</source>
        <translation>展開</translation>
    </message>
    <message>
        <source>Fold</source>
        <translation>折りたたむ</translation>
    </message>
    <message>
        <source>Hide</source>
        <translation>隠す</translation>
    </message>
</context>
<context>
    <name>ToolBar</name>
    <message>
        <source>Select: click, drag a frame, drag notes and their ends</source>
        <translation>選択：クリック、枠で囲む、音符や端をドラッグ</translation>
    </message>
    <message>
        <source>Draw: drag out a new note</source>
        <translation>描画：ドラッグで新しい音符を入力</translation>
    </message>
    <message>
        <source>Erase: drag over notes</source>
        <translation>消去：音符の上をドラッグ</translation>
    </message>
    <message>
        <source>Split: click where the note shall be cut</source>
        <translation>分割：音符の切りたい位置をクリック</translation>
    </message>
    <message>
        <source>Others as Ghosts</source>
        <translation>ほかのプレイヤーを薄く表示</translation>
    </message>
    <message>
        <source>All Players</source>
        <translation>全プレイヤー</translation>
    </message>
    <message>
        <source>Only This Player</source>
        <translation>このプレイヤーのみ</translation>
    </message>
    <message>
        <source>How the other players&apos; notes are seen</source>
        <translation>ほかのプレイヤーの音符の見せ方</translation>
    </message>
    <message>
        <source>The player in front</source>
        <translation>手前のプレイヤー</translation>
    </message>
    <message>
        <source>Selected notes: {count}</source>
        <translation>選択中の音符：{count}</translation>
    </message>
</context>
<context>
    <name>UnitButton</name>
    <message>
        <source>Bars</source>
        <translation>小節</translation>
    </message>
    <message>
        <source>Seconds</source>
        <translation>秒</translation>
    </message>
    <message>
        <source>Frames</source>
        <translation>フレーム</translation>
    </message>
    <message>
        <source>What the ruler counts</source>
        <translation>ルーラーの単位</translation>
    </message>
</context>
<context>
    <name>WaveformLane</name>
    <message>
        <source>Recording</source>
        <translation>録音</translation>
    </message>
    <message>
        <source>Drag to move it against the score, with Shift finely; double-click types</source>
        <translation>ドラッグで楽譜に対してずらします（Shift で細かく）。ダブルクリックで数値を入力します</translation>
    </message>
    <message>
        <source>Offset in seconds</source>
        <translation>オフセット（秒）</translation>
    </message>
    <message>
        <source>Drop a recording here. Until then the synthesiser plays the score.</source>
        <translation>ここに録音をドロップしてください。それまではシンセサイザーが楽譜を鳴らします。</translation>
    </message>
    <message>
        <source>offset {offset} s · the recording is not read yet</source>
        <translation>オフセット {offset} 秒 · 録音を読み込み中</translation>
    </message>
    <message>
        <source>offset {offset} s</source>
        <translation>オフセット {offset} 秒</translation>
    </message>
    <message>
        <source>offset {offset} s (estimated, {confidence:.2f})</source>
        <translation>オフセット {offset} 秒（推定、信頼度 {confidence:.2f}）</translation>
    </message>
    <message>
        <source>Type the offset...</source>
        <translation>オフセットを入力...</translation>
    </message>
</context>
</TS>
