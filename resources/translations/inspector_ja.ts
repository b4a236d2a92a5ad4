<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="ja" sourcelanguage="en">
<context>
    <name>ByHandLine</name>
    <message>
        <source>yours {yours}</source>
        <translation>変更後 {yours}</translation>
    </message>
    <message>
        <source>added by hand</source>
        <translation>手作業で追加</translation>
    </message>
    <message>
        <source>generated {generated} · yours {yours}</source>
        <translation>自動 {generated} → 変更後 {yours}</translation>
    </message>
    <message>
        <source>Back to the generator&apos;s</source>
        <translation>自動生成に戻す</translation>
    </message>
</context>
<context>
    <name>CorrectionList</name>
    <message>
        <source>Lost its place: it does nothing. Select a note and re-attach it, or revert it.</source>
        <translation>対象が見つからず、効いていません。音符を選んで付け直すか、元に戻してください。</translation>
    </message>
    <message>
        <source>with other chances, up to {end}</source>
        <translation>{end} まで、別の偶然で</translation>
    </message>
    <message>
        <source>added by hand: {yours}</source>
        <translation>手作業で追加: {yours}</translation>
    </message>
    <message>
        <source>added by hand</source>
        <translation>手作業で追加</translation>
    </message>
    <message>
        <source>generated {before} ({reason})</source>
        <translation>自動 {before}（{reason}）</translation>
    </message>
    <message>
        <source>yours {now} · {generated}</source>
        <translation>変更後 {now} · {generated}</translation>
    </message>
    <message>
        <source>Revert</source>
        <translation>元に戻す</translation>
    </message>
    <message>
        <source>Back to the generator&apos;s: the selected lines</source>
        <translation>選択した行を自動生成に戻す</translation>
    </message>
    <message>
        <source>Revert all</source>
        <translation>すべて戻す</translation>
    </message>
    <message>
        <source>Back to the generator&apos;s: everything of the selected players</source>
        <translation>選択したプレイヤーの変更をすべて自動生成に戻す</translation>
    </message>
    <message>
        <source>Re-attach to the selected note</source>
        <translation>選択した音符に付け直す</translation>
    </message>
    <message>
        <source>Let the selected line be about the selected note</source>
        <translation>選択した行を、選択した音符に結び付けます</translation>
    </message>
    <message>
        <source>Nothing was changed by hand for the selected players. Pin a fingering, drag a breath or lift a bell: it is listed here and stays when the performance is generated again.</source>
        <translation>選択したプレイヤーに手作業の変更はありません。運指を固定したり、ブレスを動かしたり、ベルを上げたりすると、ここに並び、再生成しても残ります。</translation>
    </message>
</context>
<context>
    <name>EventSection</name>
    <message>
        <source>{count} × {what}</source>
        <translation>{what} × {count}</translation>
    </message>
    <message>
        <source>{seconds} s long</source>
        <translation>長さ {seconds} 秒</translation>
    </message>
    <message>
        <source>the preparatory beat lasts {seconds} s</source>
        <translation>予備拍は {seconds} 秒</translation>
    </message>
    <message>
        <source>The generator: {reason}</source>
        <translation>自動生成: {reason}</translation>
    </message>
    <message>
        <source>Why: {reason}</source>
        <translation>理由: {reason}</translation>
    </message>
    <message>
        <source>Depth</source>
        <translation>深さ</translation>
    </message>
    <message>
        <source>Amount</source>
        <translation>量</translation>
    </message>
    <message>
        <source>Strength</source>
        <translation>強さ</translation>
    </message>
    <message>
        <source>s</source>
        <comment>seconds</comment>
        <translation>秒</translation>
    </message>
    <message>
        <source>Start</source>
        <translation>開始</translation>
    </message>
    <message>
        <source>Bar.beat.ticks</source>
        <translation>小節.拍.ティック</translation>
    </message>
    <message>
        <source>End</source>
        <translation>終了</translation>
    </message>
    <message>
        <source>Entry</source>
        <translation>入り</translation>
    </message>
    <message>
        <source>Start in seconds of the performance</source>
        <translation>演奏時間での開始（秒）</translation>
    </message>
    <message>
        <source>End in seconds of the performance</source>
        <translation>演奏時間での終了（秒）</translation>
    </message>
    <message>
        <source>Preparatory beat</source>
        <translation>予備拍</translation>
    </message>
    <message>
        <source>beats</source>
        <translation>拍</translation>
    </message>
    <message>
        <source>How long before the entry the cue&apos;s beat is</source>
        <translation>入りの何拍前に合図の拍を出すか</translation>
    </message>
    <message>
        <source>Up</source>
        <translation>上</translation>
    </message>
    <message>
        <source>Raised, leaning back, or an elbow outwards</source>
        <translation>上げる・反る・肘を外へ</translation>
    </message>
    <message>
        <source>Left</source>
        <translation>左</translation>
    </message>
    <message>
        <source>Turned to the player&apos;s left</source>
        <translation>プレイヤーの左へ回す</translation>
    </message>
    <message>
        <source>Roll</source>
        <translation>傾き</translation>
    </message>
    <message>
        <source>Leaning to the player&apos;s left</source>
        <translation>プレイヤーの左へ傾ける</translation>
    </message>
    <message>
        <source>Fade in</source>
        <translation>現れる</translation>
    </message>
    <message>
        <source>How long it takes to come</source>
        <translation>現れるまでの時間</translation>
    </message>
    <message>
        <source>Fade out</source>
        <translation>消える</translation>
    </message>
    <message>
        <source>How long it takes to go</source>
        <translation>消えるまでの時間</translation>
    </message>
    <message>
        <source>The face that is shown</source>
        <translation>表示する表情</translation>
    </message>
</context>
<context>
    <name>ExpressionMaker</name>
    <message>
        <source>{name} (kept)</source>
        <translation>{name}（保存済み）</translation>
    </message>
    <message>
        <source>Comes from your folder: use it in this project to change it.</source>
        <translation>個人フォルダの表情です。編集するにはこのプロジェクトに取り込んでください。</translation>
    </message>
    <message>
        <source>Comes with the program: duplicate it to make your own.</source>
        <translation>付属の表情です。複製すると編集できます。</translation>
    </message>
    <message>
        <source>Delete it from your folder</source>
        <translation>自分のフォルダーから削除します</translation>
    </message>
    <message>
        <source>Brows</source>
        <translation>眉</translation>
    </message>
    <message>
        <source>Eyes</source>
        <translation>目</translation>
    </message>
    <message>
        <source>Jaw</source>
        <translation>顎</translation>
    </message>
    <message>
        <source>Mouth</source>
        <translation>口</translation>
    </message>
    <message>
        <source>Cheeks, nose, tongue</source>
        <translation>頬・鼻・舌</translation>
    </message>
    <message>
        <source>Expressions</source>
        <translation>表情づくり</translation>
    </message>
    <message>
        <source>Make one of your own from it</source>
        <translation>これを元に自分の表情を作る</translation>
    </message>
    <message>
        <source>Remove it from the project</source>
        <translation>プロジェクトから削除</translation>
    </message>
    <message>
        <source>Keep it for other projects</source>
        <translation>他のプロジェクトでも使えるよう保存</translation>
    </message>
    <message>
        <source>Move both sides of the face together</source>
        <translation>顔の左右を一緒に動かす</translation>
    </message>
    <message>
        <source>Show it on the player in front</source>
        <translation>手前のプレイヤーに表示</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>名前</translation>
    </message>
    <message>
        <source>May show while playing</source>
        <translation>演奏中も表示する</translation>
    </message>
    <message>
        <source>What moves the lips must not: they belong to the embouchure</source>
        <translation>唇を動かす表情は演奏中に使えません（唇はアンブシュアのもの）</translation>
    </message>
    <message>
        <source>Fade in</source>
        <translation>現れる</translation>
    </message>
    <message>
        <source>s</source>
        <comment>seconds</comment>
        <translation>秒</translation>
    </message>
    <message>
        <source>Fade out</source>
        <translation>消える</translation>
    </message>
</context>
<context>
    <name>HistoryList</name>
    <message>
        <source>As opened</source>
        <translation>開いた時点</translation>
    </message>
</context>
<context>
    <name>Inspector</name>
    <message>
        <source>Expression: {name}</source>
        <translation>表情: {name}</translation>
    </message>
    <message>
        <source>Pose: {name}</source>
        <translation>ポーズ: {name}</translation>
    </message>
    <message>
        <source>entry {place}, beat {seconds} s</source>
        <translation>入り {place}、予備拍 {seconds} 秒</translation>
    </message>
    <message>
        <source>tension</source>
        <translation>張り</translation>
    </message>
    <message>
        <source>effort</source>
        <translation>力み</translation>
    </message>
    <message>
        <source>air</source>
        <translation>息</translation>
    </message>
    <message>
        <source>Fingering {label}</source>
        <translation>運指 {label}</translation>
    </message>
    <message>
        <source>{what} removed</source>
        <translation>{what}を削除</translation>
    </message>
    <message>
        <source>Embouchure</source>
        <translation>アンブシュア</translation>
    </message>
</context>
<context>
    <name>InspectorPanel</name>
    <message>
        <source>These bars are performed anew, with other chances. Ctrl+G on the selected bars chooses again; Backspace brings the first performance back.</source>
        <translation>この小節は別の偶然で演奏し直されています。小節を選択して Ctrl+G でもう一度選び直し、Backspace で最初の演奏に戻します。</translation>
    </message>
    <message>
        <source>Problems ({count})</source>
        <translation>問題 ({count})</translation>
    </message>
    <message>
        <source>Problems</source>
        <translation>問題</translation>
    </message>
    <message>
        <source>By hand ({count})</source>
        <translation>手作業 ({count})</translation>
    </message>
    <message>
        <source>By hand</source>
        <translation>手作業</translation>
    </message>
    <message>
        <source>History</source>
        <translation>履歴</translation>
    </message>
    <message>
        <source>Click a note in the timeline to see and change its fingering, or a breath, a cue, a gesture or an expression to see why it is there.</source>
        <translation>タイムラインで音符をクリックすると運指を確認・変更できます。ブレス、合図、ジェスチャー、表情をクリックすると、そこにある理由が分かります。</translation>
    </message>
</context>
<context>
    <name>NoteSection</name>
    <message>
        <source>Note</source>
        <translation>音符</translation>
    </message>
    <message>
        <source>{count} notes</source>
        <translation>音符 {count} 個</translation>
    </message>
    <message>
        <source>Why: {reason}</source>
        <translation>理由: {reason}</translation>
    </message>
    <message>
        <source>The generator: {reason}</source>
        <translation>自動生成: {reason}</translation>
    </message>
    <message>
        <source>first choice</source>
        <translation>第 1 候補</translation>
    </message>
    <message>
        <source>choice no. {rank}</source>
        <translation>第 {rank} 候補</translation>
    </message>
    <message>
        <source>{cents} cents when simply blown</source>
        <translation>普通に吹くと {cents} セント</translation>
    </message>
    <message>
        <source>what the generator chose</source>
        <translation>自動生成の選択</translation>
    </message>
    <message>
        <source>Pitch</source>
        <translation>音高</translation>
    </message>
    <message>
        <source>A name or a MIDI number; several notes move together</source>
        <translation>音名または MIDI 番号。複数の音符は一緒に動きます</translation>
    </message>
    <message>
        <source>Bar</source>
        <translation>小節</translation>
    </message>
    <message>
        <source>Bar.beat.ticks; several notes move together</source>
        <translation>小節.拍.ティック。複数の音符は一緒に動きます</translation>
    </message>
    <message>
        <source>Length</source>
        <translation>長さ</translation>
    </message>
    <message>
        <source>beats</source>
        <translation>拍</translation>
    </message>
    <message>
        <source>In beats of the metre</source>
        <translation>拍子の拍を単位とします</translation>
    </message>
    <message>
        <source>Velocity</source>
        <translation>ベロシティ</translation>
    </message>
    <message>
        <source>How hard the note is struck, 1 to 127</source>
        <translation>音の強さ、1〜127</translation>
    </message>
    <message>
        <source>Tension</source>
        <translation>張り</translation>
    </message>
    <message>
        <source>Lips: 0 relaxed for the low register, 1 drawn tight</source>
        <translation>唇: 0 で低音域の緩み、1 で強い張り</translation>
    </message>
    <message>
        <source>Effort</source>
        <translation>力み</translation>
    </message>
    <message>
        <source>How much the face works: height, loudness, length</source>
        <translation>顔の力の入り方（高さ・大きさ・長さ）</translation>
    </message>
    <message>
        <source>Air</source>
        <translation>息</translation>
    </message>
    <message>
        <source>How much air flows</source>
        <translation>息の量</translation>
    </message>
    <message>
        <source>Fingering</source>
        <translation>運指</translation>
    </message>
    <message>
        <source>Embouchure</source>
        <translation>アンブシュア</translation>
    </message>
    <message>
        <source>Fingering diagram</source>
        <translation>運指図</translation>
    </message>
</context>
<context>
    <name>ProblemList</name>
    <message>
        <source>And {count} more: choose players or a kind above.</source>
        <translation>ほかに {count} 件あります。上でプレイヤーか種類を選んでください。</translation>
    </message>
    <message>
        <source>No problems: everything can be played as it is planned.</source>
        <translation>問題はありません。すべて計画どおりに演奏できます。</translation>
    </message>
    <message>
        <source>None of these. Choose other players or kinds above.</source>
        <translation>該当する問題はありません。上でプレイヤーや種類を変えてください。</translation>
    </message>
    <message>
        <source>Whose problems</source>
        <translation>誰の問題を表示するか</translation>
    </message>
    <message>
        <source>Problems of which kind</source>
        <translation>どの種類の問題を表示するか</translation>
    </message>
    <message>
        <source>All players</source>
        <translation>全プレイヤー</translation>
    </message>
    <message>
        <source>Selected players</source>
        <translation>選択したプレイヤー</translation>
    </message>
    <message>
        <source>Fingerings</source>
        <translation>運指</translation>
    </message>
    <message>
        <source>Breaths</source>
        <translation>ブレス</translation>
    </message>
    <message>
        <source>Notes</source>
        <translation>音符</translation>
    </message>
    <message>
        <source>Corrections</source>
        <translation>手作業の変更</translation>
    </message>
    <message>
        <source>Contacts</source>
        <translation>接触</translation>
    </message>
    <message>
        <source>Dances</source>
        <translation>ダンス</translation>
    </message>
    <message>
        <source>Instruments and characters</source>
        <translation>楽器とキャラクター</translation>
    </message>
    <message>
        <source>All kinds</source>
        <translation>すべての種類</translation>
    </message>
</context>
<context>
    <name>TakeSection</name>
    <message>
        <source>Take</source>
        <translation>テイク</translation>
    </message>
    <message>
        <source>{seconds:.1f} s, {count:,} events</source>
        <translation>{seconds:.1f} 秒、イベント {count:,} 個</translation>
    </message>
    <message>
        <source>{count} quarters</source>
        <translation>四分音符 {count} 個分</translation>
    </message>
    <message>
        <source>ghost notes: {count}</source>
        <translation>ゴーストノート {count}</translation>
    </message>
    <message>
        <source>unheard: {count}</source>
        <translation>聞こえない音 {count}</translation>
    </message>
    <message>
        <source>late fingers: {count}</source>
        <translation>指の遅れ {count}</translation>
    </message>
    <message>
        <source>struck twice: {count}</source>
        <translation>二度打ち {count}</translation>
    </message>
    <message>
        <source>Notes: {count}; nothing is left out.</source>
        <translation>音符 {count} 個。除かれた音はありません。</translation>
    </message>
    <message>
        <source>Notes: {count}. Left out: {faults}.</source>
        <translation>音符 {count} 個。除かれた音: {faults}。</translation>
    </message>
    <message>
        <source>, </source>
        <comment>between what is left out</comment>
        <translation>、</translation>
    </message>
    <message>
        <source>Name of the take</source>
        <translation>テイクの名前</translation>
    </message>
    <message>
        <source>Colour of the take</source>
        <translation>テイクの色</translation>
    </message>
    <message>
        <source>Cleaning</source>
        <translation>クリーニング</translation>
    </message>
    <message>
        <source>ms</source>
        <comment>milliseconds</comment>
        <translation>ms</translation>
    </message>
    <message>
        <source>Ghost notes shorter than</source>
        <translation>ゴーストノートの長さの上限</translation>
    </message>
    <message>
        <source>Soft notes shorter than this are left out, and short ones between two of a legato. 0: none</source>
        <translation>これより短い弱い音と、レガートの 2 音の間に挟まった短い音を除きます。0: 除きません</translation>
    </message>
    <message>
        <source>and softer than</source>
        <translation>強さの上限</translation>
    </message>
    <message>
        <source>Soft: the breath stays below this; without breath the velocity</source>
        <translation>ブレスがこの値に届かない音を弱い音とします。ブレスがなければベロシティで判断します</translation>
    </message>
    <message>
        <source>Doubled notes within</source>
        <translation>二度打ちとみなす間隔</translation>
    </message>
    <message>
        <source>The same note struck again within this time is one note. 0: never</source>
        <translation>この時間内に同じ高さの音が再び鳴ったら 1 つの音にまとめます。0: まとめません</translation>
    </message>
    <message>
        <source>Legato overlap at most</source>
        <translation>レガートの重なりの上限</translation>
    </message>
    <message>
        <source>A note that sounds longer into the next is cut there</source>
        <translation>次の音にこれより長く重なる音は切りつめます</translation>
    </message>
    <message>
        <source>Quantise</source>
        <translation>クオンタイズ</translation>
    </message>
    <message>
        <source>How far notes are drawn to the grid</source>
        <translation>音符をグリッドに寄せる強さ</translation>
    </message>
    <message>
        <source>Draw to the score</source>
        <translation>楽譜に合わせる</translation>
    </message>
    <message>
        <source>How far notes are drawn to those of the part from before the first take, by pitch and time</source>
        <translation>最初のテイクより前のパートの音符に、高さと時間で対応させて寄せる強さ</translation>
    </message>
    <message>
        <source>Grid of the quantising</source>
        <translation>クオンタイズのグリッド</translation>
    </message>
    <message>
        <source>As Usual</source>
        <translation>標準に戻す</translation>
    </message>
    <message>
        <source>Clean this take as every take is cleaned at first</source>
        <translation>このテイクのクリーニングを最初の設定に戻します</translation>
    </message>
    <message>
        <source>Find the Beats</source>
        <translation>拍を検出</translation>
    </message>
    <message>
        <source>For a take without a click: the piece gets the tempo it was played in. Nobody else may have notes</source>
        <translation>クリックなしで録音したテイク用です。演奏されたテンポを曲のテンポにします。ほかのパートに音符がないときだけ使えます</translation>
    </message>
</context>
</TS>
