<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="ja" sourcelanguage="en">
<context>
    <name>CharacterDialog</name>
    <message>
        <source>Everything will be played.</source>
        <translation>すべて演奏に反映されます。</translation>
    </message>
    <message>
        <source>found</source>
        <translation>検出</translation>
    </message>
    <message>
        <source>a guess</source>
        <translation>推測</translation>
    </message>
    <message>
        <source>none</source>
        <translation>なし</translation>
    </message>
    <message>
        <source>{joint}: {bone}</source>
        <translation>{joint}: {bone}</translation>
    </message>
    <message>
        <source>{joint}: {bone}, a guess; please look</source>
        <translation>{joint}: {bone} (推測です。確認してください)</translation>
    </message>
    <message>
        <source>{joint}: the file has no such bone</source>
        <translation>{joint}: ファイルに該当するボーンがありません</translation>
    </message>
    <message>
        <source>No picture yet</source>
        <translation>まだ表示できません</translation>
    </message>
    <message>
        <source>Character: {file}</source>
        <translation>キャラクター: {file}</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>名前</translation>
    </message>
    <message>
        <source>{file}
Bones: {bones}, morphs: {morphs}</source>
        <translation>{file}
ボーン {bones}、モーフ {morphs}</translation>
    </message>
    <message>
        <source>Body</source>
        <translation>ボディ</translation>
    </message>
    <message>
        <source>Face</source>
        <translation>表情</translation>
    </message>
    <message>
        <source>Joint</source>
        <translation>関節</translation>
    </message>
    <message>
        <source>Bone</source>
        <translation>ボーン</translation>
    </message>
    <message>
        <source>Bone of the file</source>
        <translation>ファイルのボーン</translation>
    </message>
    <message>
        <source>Search bones</source>
        <translation>ボーンを検索</translation>
    </message>
    <message>
        <source>Joints of the body</source>
        <translation>体の関節</translation>
    </message>
    <message>
        <source>No Bone</source>
        <translation>ボーンなし</translation>
    </message>
    <message>
        <source>Automatic</source>
        <translation>自動</translation>
    </message>
    <message>
        <source>Undo</source>
        <translation>元に戻す</translation>
    </message>
    <message>
        <source>Redo</source>
        <translation>やり直す</translation>
    </message>
    <message>
        <source>Reset All</source>
        <translation>すべてリセット</translation>
    </message>
    <message>
        <source>Give it to {players}</source>
        <translation>{players} に割り当てる</translation>
    </message>
    <message>
        <source>Keep Character</source>
        <translation>キャラクターを保存</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>キャンセル</translation>
    </message>
</context>
<context>
    <name>CharacterWords</name>
    <message>
        <source>It cannot play yet. Choose the bones of: {joints}</source>
        <translation>このままでは演奏できません。次のボーンを選んでください: {joints}</translation>
    </message>
    <message>
        <source>It has no finger bones: the hands hold the instrument, the fingers rest.</source>
        <translation>指のボーンがありません。手は楽器を持ちますが、指は動きません。</translation>
    </message>
    <message>
        <source>These fingers do not move: {fingers}</source>
        <translation>動かない指: {fingers}</translation>
    </message>
    <message>
        <source>The eyes do not look around: it has no bones or morphs for them.</source>
        <translation>視線は動きません (目のボーンもモーフもありません)。</translation>
    </message>
    <message>
        <source>The mouth does not open: it has no jaw and no such morph.</source>
        <translation>口は開きません (顎のボーンもモーフもありません)。</translation>
    </message>
    <message>
        <source>The lips do not form an embouchure: it has no such morphs.</source>
        <translation>唇はアンブシュアの形になりません (該当するモーフがありません)。</translation>
    </message>
    <message>
        <source>It does not blink: it has no such morph.</source>
        <translation>まばたきはしません (該当するモーフがありません)。</translation>
    </message>
    <message>
        <source>The cheeks do not fill: it has no such morph.</source>
        <translation>頬はふくらみません (該当するモーフがありません)。</translation>
    </message>
</context>
<context>
    <name>CharactersDialog</name>
    <message>
        <source>Characters</source>
        <translation>キャラクター</translation>
    </message>
    <message>
        <source>Your own characters, from VRM, glTF or FBX files; drop a file here. Every player can become one of them.</source>
        <translation>VRM、glTF、FBX ファイルから追加した自分のキャラクターです。ファイルをここにドロップしても追加できます。どのプレイヤーにも割り当てられます。</translation>
    </message>
    <message>
        <source>Add...</source>
        <translation>追加...</translation>
    </message>
    <message>
        <source>Edit...</source>
        <translation>編集...</translation>
    </message>
    <message>
        <source>Remove...</source>
        <translation>削除...</translation>
    </message>
    <message>
        <source>Close</source>
        <translation>閉じる</translation>
    </message>
</context>
<context>
    <name>ChoreographyDialog</name>
    <message>
        <source>Choreography</source>
        <translation>振り付け</translation>
    </message>
    <message>
        <source>No dancer is selected.</source>
        <translation>ダンサーが選択されていません。</translation>
    </message>
    <message>
        <source>Reading ...</source>
        <translation>読み込み中...</translation>
    </message>
    <message>
        <source>Choreography of {dancer}</source>
        <translation>{dancer} の振り付け</translation>
    </message>
    <message>
        <source>{name} · Basic motions: {motions} · Segments: {segments}, {minutes}:{seconds:02d} min · Sources: {sources}</source>
        <translation>{name} · 基本動作: {motions} · セグメント: {segments}、{minutes}分{seconds:02d}秒 · ソース: {sources}</translation>
    </message>
    <message>
        <source>{dancer} dances {used} of {count} basic motions in this piece.</source>
        <translation>{dancer} はこの曲で {count} 個の基本動作のうち {used} 個を踊ります。</translation>
    </message>
    <message>
        <source>{count}×</source>
        <translation>{count}回</translation>
    </message>
    <message>
        <source>Basic motion {number} is danced again with a probability of {share} %.</source>
        <translation>基本動作{number}が繰り返される確率は {share} % です。</translation>
    </message>
    <message>
        <source>Basic motion {number} is followed by {next} with a probability of {share} %.</source>
        <translation>基本動作{number}の次に{next}が踊られる確率は {share} % です。</translation>
    </message>
    <message>
        <source>{share} % of the strokes during basic motion {number} are: {sound}</source>
        <translation>基本動作{number}の間の打音の {share} %: {sound}</translation>
    </message>
    <message>
        <source>Basic motion {number}</source>
        <translation>基本動作{number}</translation>
    </message>
    <message>
        <source>from {sources}</source>
        <translation>ソース: {sources}</translation>
    </message>
    <message>
        <source>followed by {motions}</source>
        <translation>次の動作: {motions}</translation>
    </message>
    <message>
        <source>danced to {sounds}</source>
        <translation>打楽器: {sounds}</translation>
    </message>
    <message>
        <source>{motion} with {music}</source>
        <translation>{motion} と {music}</translation>
    </message>
    <message>
        <source>No credits are given for these sources.</source>
        <translation>これらのソースには出典の記載がありません。</translation>
    </message>
    <message>
        <source>Basic Motions</source>
        <translation>基本動作</translation>
    </message>
    <message>
        <source>Transitions</source>
        <translation>遷移</translation>
    </message>
    <message>
        <source>Graph</source>
        <translation>グラフ</translation>
    </message>
    <message>
        <source>Percussion</source>
        <translation>打楽器</translation>
    </message>
    <message>
        <source>Credits</source>
        <translation>出典とライセンス</translation>
    </message>
    <message>
        <source>The most typical segment of each basic motion: its start, its accent, its end.</source>
        <translation>各基本動作の最も代表的なセグメントの始まり、アクセント、終わりです。</translation>
    </message>
    <message>
        <source>What follows what, in percent: a row is what is danced, a column what comes next. Basic motions in colour are danced in this piece, so many times.</source>
        <translation>どの動作の次にどの動作が続くか(%)。行が現在の動作、列が次の動作です。色付きの基本動作はこの曲で踊られるもので、下の数字はその回数です。</translation>
    </message>
    <message>
        <source>An arrow for each transition that was learned, the wider the likelier. Point at a basic motion.</source>
        <translation>学習した遷移を矢印で示します。太いほど確率が高くなります。基本動作を指すと、その遷移が強調されます。</translation>
    </message>
    <message>
        <source>Close</source>
        <translation>閉じる</translation>
    </message>
    <message>
        <source>What is struck during each basic motion, in percent of its strokes. This piece has no percussion: sounds with a dot stand for its melody, its bass and its accents.</source>
        <translation>各基本動作の間に鳴る打楽器(打音に占める%)。この曲には打楽器がないため、点の付いた音は旋律、低音、アクセントの代わりです。</translation>
    </message>
    <message>
        <source>What is struck during each basic motion, in percent of its strokes. Sounds with a dot occur in this piece.</source>
        <translation>各基本動作の間に鳴る打楽器(打音に占める%)。点の付いた音はこの曲で使われています。</translation>
    </message>
</context>
<context>
    <name>CutPanel</name>
    <message>
        <source>{time} s, {acceleration} rad/s²</source>
        <translation>{time} 秒、{acceleration} rad/s²</translation>
    </message>
    <message>
        <source>Segments: {n}, found</source>
        <translation>セグメント: {n}（検出）</translation>
    </message>
    <message>
        <source>Segments: {n}, set by hand</source>
        <translation>セグメント: {n}（手動）</translation>
    </message>
    <message>
        <source>Cuts of the motion</source>
        <translation>動きの区切り</translation>
    </message>
    <message>
        <source>Undo (Ctrl+Z)</source>
        <translation>元に戻す (Ctrl+Z)</translation>
    </message>
    <message>
        <source>Redo (Ctrl+Shift+Z)</source>
        <translation>やり直す (Ctrl+Shift+Z)</translation>
    </message>
    <message>
        <source>Whole motion (F)</source>
        <translation>動き全体を表示 (F)</translation>
    </message>
    <message>
        <source>Snap</source>
        <translation>スナップ</translation>
    </message>
    <message>
        <source>Cuts stop at minima, accents at maxima; not while Alt is held</source>
        <translation>区切りは極小、アクセントは極大に吸着します（Alt を押している間は吸着しません）</translation>
    </message>
    <message>
        <source>Reset to Automatic</source>
        <translation>自動に戻す</translation>
    </message>
    <message>
        <source>Angular acceleration (rad/s²) over the time of the motion (s). Blue: cuts; orange: accents; green: percussion of the music. Drag a line to move it, double-click to cut, Delete deletes. Ctrl+wheel zooms.</source>
        <translation>動きの時刻（秒）に対する角加速度（rad/s²）。青: 区切り、オレンジ: アクセント、緑: 音楽の打楽器。線をドラッグで移動、ダブルクリックで区切りを追加、Delete で削除、Ctrl+ホイールで拡大縮小します。</translation>
    </message>
</context>
<context>
    <name>ExportDialog</name>
    <message>
        <source>Files written to {folder}: {count}</source>
        <translation>{folder} に書き出したファイル: {count}</translation>
    </message>
    <message>
        <source>Files written into the project {name}: {count}
In Unreal choose Suisou &gt; Import Performance; if it was imported before, Update Performance.</source>
        <translation>プロジェクト {name} に書き出したファイル: {count}
Unreal で「Suisou &gt; 演奏をインポート」を選んでください。インポート済みの場合は「演奏を更新」を選びます。</translation>
    </message>
    <message>
        <source>If Unreal has the project open, start it again: the menu is new.</source>
        <translation>Unreal でこのプロジェクトを開いている場合は、再起動するとメニューが表示されます。</translation>
    </message>
    <message>
        <source>Tick at least one player.</source>
        <translation>プレイヤーを 1 人以上選んでください。</translation>
    </message>
    <message>
        <source>Tick at least one kind of file.</source>
        <translation>ファイル形式を 1 つ以上選んでください。</translation>
    </message>
    <message>
        <source>version not told</source>
        <translation>バージョン不明</translation>
    </message>
    <message>
        <source>{name} (Unreal Engine {engine})</source>
        <translation>{name} (Unreal Engine {engine})</translation>
    </message>
    <message>
        <source>Files that will be written: {count}</source>
        <translation>書き出すファイル: {count}</translation>
    </message>
    <message>
        <source>Of these, {count} will be replaced: {names}</source>
        <translation>うち {count} 個は上書きされます: {names}</translation>
    </message>
    <message>
        <source>No longer needed, {count} will be removed: {names}</source>
        <translation>不要になったファイル {count} 個を削除します: {names}</translation>
    </message>
    <message>
        <source>Export</source>
        <translation>書き出し</translation>
    </message>
    <message>
        <source>Players</source>
        <translation>プレイヤー</translation>
    </message>
    <message>
        <source>Performers</source>
        <translation>出演者</translation>
    </message>
    <message>
        <source>Into</source>
        <translation>書き出し先</translation>
    </message>
    <message>
        <source>Files</source>
        <translation>ファイル</translation>
    </message>
    <message>
        <source>Bone names in BVH</source>
        <translation>BVH のボーン名</translation>
    </message>
    <message>
        <source>Skeleton</source>
        <translation>スケルトン</translation>
    </message>
    <message>
        <source>Range</source>
        <translation>範囲</translation>
    </message>
    <message>
        <source>Pre-roll</source>
        <translation>プリロール</translation>
    </message>
    <message>
        <source>Frames per second</source>
        <translation>フレームレート</translation>
    </message>
    <message>
        <source>All or none</source>
        <translation>すべて選択/解除</translation>
    </message>
    <message>
        <source>Those of the skeleton</source>
        <translation>スケルトンのまま</translation>
    </message>
    <message>
        <source> beats</source>
        <translation> 拍</translation>
    </message>
    <message>
        <source>Show in folder</source>
        <translation>フォルダーで表示</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>キャンセル</translation>
    </message>
    <message>
        <source>Close</source>
        <translation>閉じる</translation>
    </message>
</context>
<context>
    <name>FaceMapPage</name>
    <message>
        <source>{face} ({name}) is made of:</source>
        <translation>{face} ({name}) を作るモーフ:</translation>
    </message>
    <message>
        <source>Take this morph out</source>
        <translation>このモーフを外す</translation>
    </message>
    <message>
        <source>Face</source>
        <translation>表情</translation>
    </message>
    <message>
        <source>Made of</source>
        <translation>使うモーフ</translation>
    </message>
    <message>
        <source>Nothing: the character does not do this.</source>
        <translation>なし (このキャラクターはこの表情をしません)。</translation>
    </message>
    <message>
        <source>The file has no morphs: the face stays as it is.</source>
        <translation>ファイルにモーフがありません。表情は変わりません。</translation>
    </message>
    <message>
        <source>Add a morph of the file...</source>
        <translation>ファイルのモーフを追加...</translation>
    </message>
    <message>
        <source>Automatic</source>
        <translation>自動</translation>
    </message>
</context>
<context>
    <name>FormatChooser</name>
    <message>
        <source>FBX (characters and instruments)</source>
        <translation>FBX（キャラクターと楽器）</translation>
    </message>
    <message>
        <source>BVH (body motion)</source>
        <translation>BVH（体の動き）</translation>
    </message>
    <message>
        <source>GLB (characters and instruments)</source>
        <translation>GLB（キャラクターと楽器）</translation>
    </message>
    <message>
        <source>USD (the package usd-core is missing)</source>
        <translation>USD（パッケージ usd-core がありません）</translation>
    </message>
    <message>
        <source>USD (characters and instruments)</source>
        <translation>USD（キャラクターと楽器）</translation>
    </message>
    <message>
        <source>Sound (WAV)</source>
        <translation>音声（WAV）</translation>
    </message>
</context>
<context>
    <name>HitChart</name>
    <message>
        <source>How late every hit came</source>
        <translation>各クリックに対する吹き始めの遅れ</translation>
    </message>
    <message>
        <source>{count} ms</source>
        <translation>{count} ms</translation>
    </message>
</context>
<context>
    <name>ImportDialog</name>
    <message>
        <source>Import MIDI</source>
        <translation>MIDI の読み込み</translation>
    </message>
    <message>
        <source>{title} · {minutes}:{seconds:02d} · ♩= {tempo:g} · {metre}</source>
        <translation>{title} · {minutes}:{seconds:02d} · ♩= {tempo:g} · {metre}</translation>
    </message>
    <message>
        <source>Play</source>
        <translation>演奏</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>名前</translation>
    </message>
    <message>
        <source>Notes</source>
        <translation>音符</translation>
    </message>
    <message>
        <source>Number, range</source>
        <translation>音数・音域</translation>
    </message>
    <message>
        <source>Notes together</source>
        <translation>重なる音</translation>
    </message>
    <message>
        <source>Instrument</source>
        <translation>楽器</translation>
    </message>
    <message>
        <source>Pitches</source>
        <translation>音高</translation>
    </message>
    <message>
        <source>Character</source>
        <translation>キャラクター</translation>
    </message>
    <message>
        <source>Merge into one part</source>
        <translation>1 つのパートにまとめる</translation>
    </message>
    <message>
        <source>Make one part of the selected tracks</source>
        <translation>選択したトラックを 1 つのパートにします</translation>
    </message>
    <message>
        <source>Take apart</source>
        <translation>分ける</translation>
    </message>
    <message>
        <source>Make a part of each merged track again</source>
        <translation>まとめたトラックをそれぞれのパートに戻します</translation>
    </message>
    <message>
        <source>Add a dancer</source>
        <translation>ダンサーを追加</translation>
    </message>
    <message>
        <source>A dancer who moves to the percussion comes onto the stage in front of the players</source>
        <translation>打楽器に合わせて踊るダンサーを、プレイヤーの前のステージに追加します</translation>
    </message>
    <message>
        <source>Import</source>
        <translation>読み込む</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>キャンセル</translation>
    </message>
    <message>
        <source>Finding out who plays what ...</source>
        <translation>誰が何を演奏するかを調べています...</translation>
    </message>
    <message>
        <source>Notes: {count}
{low} to {high}</source>
        <translation>{count} 音
{low} ～ {high}</translation>
    </message>
    <message>
        <source>Share among players</source>
        <translation>複数人で分担</translation>
    </message>
    <message>
        <source>One player</source>
        <translation>1 人で演奏</translation>
    </message>
    <message>
        <source>Automatic: another player for notes that go on sounding together; overlaps of one player are slurs</source>
        <translation>自動: 重なって鳴り続ける音があれば別のプレイヤーに分けます。一人の音の短い重なりはスラーと見なします</translation>
    </message>
    <message>
        <source>Automatic: {name}</source>
        <translation>自動: {name}</translation>
    </message>
    <message>
        <source>Percussion, for dancers</source>
        <translation>打楽器(ダンサー用)</translation>
    </message>
    <message>
        <source>Choose an instrument</source>
        <translation>楽器を選んでください</translation>
    </message>
    <message>
        <source>Sounding</source>
        <translation>実音</translation>
    </message>
    <message>
        <source>Written</source>
        <translation>記譜音</translation>
    </message>
    <message>
        <source>Which pitches the file has of an instrument whose part is not written as it sounds</source>
        <translation>移調楽器のパートが、ファイルに実音と記譜音のどちらで入っているか</translation>
    </message>
    <message>
        <source>Automatic</source>
        <translation>自動</translation>
    </message>
    <message>
        <source>A percussion track: no player plays it, but dancers dance to it. It is kept for them, ticked or not</source>
        <translation>打楽器のトラックです。プレイヤーは演奏しませんが、ダンサーがこれに合わせて踊ります。チェックの有無にかかわらず、ダンサーのために残されます</translation>
    </message>
    <message>
        <source>Choose an instrument for {name}</source>
        <translation>{name} の楽器を選んでください</translation>
    </message>
    <message>
        <source>Players: {count}</source>
        <translation>プレイヤー: {count} 人</translation>
    </message>
    <message>
        <source>Nobody plays: tick a track, or import an empty stage</source>
        <translation>演奏するプレイヤーがいません。トラックを選ぶか、空のステージとして読み込みます</translation>
    </message>
    <message>
        <source>{name} is not played: {reason}; dancers dance to it</source>
        <translation>{name} は演奏されません: {reason}。ダンサーがこれに合わせて踊ります</translation>
    </message>
    <message>
        <source>{name} is not played: {reason}</source>
        <translation>{name} は演奏されません: {reason}</translation>
    </message>
    <message>
        <source>What the reader noticed</source>
        <translation>読み込み時の注意</translation>
    </message>
</context>
<context>
    <name>InstrumentsDialog</name>
    <message>
        <source>Your own version: {file}</source>
        <translation>自分のバージョン：{file}</translation>
    </message>
    <message>
        <source>Bundled</source>
        <translation>付属</translation>
    </message>
    <message>
        <source>Files of your own that are wrong; what was good before stays in use:</source>
        <translation>ご自身の楽器ファイルに誤りがあります（直前の正しい内容が引き続き使われます）:</translation>
    </message>
    <message>
        <source>and {count} more</source>
        <translation>ほか {count} 件</translation>
    </message>
    <message>
        <source>sounds {low} to {high}</source>
        <translation>実音 {low}～{high}</translation>
    </message>
    <message>
        <source>written {low} to {high} ({semitones} semitones)</source>
        <translation>記譜 {low}～{high}（{semitones} 半音）</translation>
    </message>
    <message>
        <source>cup mouthpiece</source>
        <translation>カップマウスピース</translation>
    </message>
    <message>
        <source>single reed</source>
        <translation>シングルリード</translation>
    </message>
    <message>
        <source>double reed</source>
        <translation>ダブルリード</translation>
    </message>
    <message>
        <source>lip plate</source>
        <translation>リッププレート</translation>
    </message>
    <message>
        <source>beak</source>
        <translation>歌口（リコーダー型）</translation>
    </message>
    <message>
        <source>treble clef</source>
        <translation>ト音記号</translation>
    </message>
    <message>
        <source>bass clef</source>
        <translation>ヘ音記号</translation>
    </message>
    <message>
        <source>alto clef</source>
        <translation>アルト記号</translation>
    </message>
    <message>
        <source>tenor clef</source>
        <translation>テノール記号</translation>
    </message>
    <message>
        <source>standing</source>
        <translation>立奏</translation>
    </message>
    <message>
        <source>seated</source>
        <translation>座奏</translation>
    </message>
    <message>
        <source>a breath lasts {soft} to {loud} s</source>
        <translation>一息 {soft}～{loud} 秒</translation>
    </message>
    <message>
        <source>model {file}</source>
        <translation>モデル {file}</translation>
    </message>
    <message>
        <source>Every fingering that is right for this note is there already.</source>
        <translation>この音に使える運指はすべて登録されています。</translation>
    </message>
    <message>
        <source>Instruments</source>
        <translation>楽器</translation>
    </message>
    <message>
        <source>Higher Choice</source>
        <translation>優先順位を上げる</translation>
    </message>
    <message>
        <source>Lower Choice</source>
        <translation>優先順位を下げる</translation>
    </message>
    <message>
        <source>Add Alternate</source>
        <translation>替え指を追加</translation>
    </message>
    <message>
        <source>Remove</source>
        <translation>削除</translation>
    </message>
    <message>
        <source>Revert This Note</source>
        <translation>この音を元に戻す</translation>
    </message>
    <message>
        <source>Revert All Notes</source>
        <translation>すべての音を元に戻す</translation>
    </message>
    <message>
        <source>Undo</source>
        <translation>元に戻す</translation>
    </message>
    <message>
        <source>Redo</source>
        <translation>やり直す</translation>
    </message>
    <message>
        <source>Show My Folder</source>
        <translation>自分のフォルダを開く</translation>
    </message>
    <message>
        <source>Save as My Own</source>
        <translation>自分用に保存</translation>
    </message>
    <message>
        <source>Close</source>
        <translation>閉じる</translation>
    </message>
    <message>
        <source>Written</source>
        <translation>記譜音</translation>
    </message>
    <message>
        <source>Sounds</source>
        <translation>実音</translation>
    </message>
    <message>
        <source>Choice</source>
        <translation>順位</translation>
    </message>
    <message>
        <source>Fingering</source>
        <translation>運指</translation>
    </message>
    <message>
        <source>Cents</source>
        <translation>セント</translation>
    </message>
    <message>
        <source>For</source>
        <translation>用途</translation>
    </message>
    <message>
        <source>Click keys to change the fingering, or type it in the table.</source>
        <translation>キーをクリックするか、表に入力して運指を変更します。</translation>
    </message>
    <message>
        <source>Instruments with fingerings that are not saved: {count}.</source>
        <translation>{count} 個の楽器の運指が保存されていません。</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>保存</translation>
    </message>
    <message>
        <source>Discard</source>
        <translation>破棄</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>キャンセル</translation>
    </message>
</context>
<context>
    <name>Joint</name>
    <message>
        <source>{part} L</source>
        <translation>{part} 左</translation>
    </message>
    <message>
        <source>{part} R</source>
        <translation>{part} 右</translation>
    </message>
    <message>
        <source>Hips</source>
        <translation>腰</translation>
    </message>
    <message>
        <source>Spine</source>
        <translation>背骨</translation>
    </message>
    <message>
        <source>Chest</source>
        <translation>胸</translation>
    </message>
    <message>
        <source>Upper chest</source>
        <translation>上胸</translation>
    </message>
    <message>
        <source>Neck</source>
        <translation>首</translation>
    </message>
    <message>
        <source>Head</source>
        <translation>頭</translation>
    </message>
    <message>
        <source>Jaw</source>
        <translation>顎</translation>
    </message>
    <message>
        <source>Eye</source>
        <translation>目</translation>
    </message>
    <message>
        <source>Shoulder</source>
        <translation>肩</translation>
    </message>
    <message>
        <source>Upper arm</source>
        <translation>上腕</translation>
    </message>
    <message>
        <source>Lower arm</source>
        <translation>前腕</translation>
    </message>
    <message>
        <source>Hand</source>
        <translation>手</translation>
    </message>
    <message>
        <source>Upper leg</source>
        <translation>太もも</translation>
    </message>
    <message>
        <source>Lower leg</source>
        <translation>すね</translation>
    </message>
    <message>
        <source>Foot</source>
        <translation>足</translation>
    </message>
    <message>
        <source>Toes</source>
        <translation>つま先</translation>
    </message>
    <message>
        <source>Thumb</source>
        <translation>親指</translation>
    </message>
    <message>
        <source>Index finger</source>
        <translation>人差し指</translation>
    </message>
    <message>
        <source>Middle finger</source>
        <translation>中指</translation>
    </message>
    <message>
        <source>Ring finger</source>
        <translation>薬指</translation>
    </message>
    <message>
        <source>Little finger</source>
        <translation>小指</translation>
    </message>
    <message>
        <source>Thumb, base</source>
        <translation>親指・付け根</translation>
    </message>
    <message>
        <source>Thumb, middle</source>
        <translation>親指・中</translation>
    </message>
    <message>
        <source>Thumb, tip</source>
        <translation>親指・先</translation>
    </message>
    <message>
        <source>Index finger, base</source>
        <translation>人差し指・付け根</translation>
    </message>
    <message>
        <source>Index finger, middle</source>
        <translation>人差し指・中</translation>
    </message>
    <message>
        <source>Index finger, tip</source>
        <translation>人差し指・先</translation>
    </message>
    <message>
        <source>Middle finger, base</source>
        <translation>中指・付け根</translation>
    </message>
    <message>
        <source>Middle finger, middle</source>
        <translation>中指・中</translation>
    </message>
    <message>
        <source>Middle finger, tip</source>
        <translation>中指・先</translation>
    </message>
    <message>
        <source>Ring finger, base</source>
        <translation>薬指・付け根</translation>
    </message>
    <message>
        <source>Ring finger, middle</source>
        <translation>薬指・中</translation>
    </message>
    <message>
        <source>Ring finger, tip</source>
        <translation>薬指・先</translation>
    </message>
    <message>
        <source>Little finger, base</source>
        <translation>小指・付け根</translation>
    </message>
    <message>
        <source>Little finger, middle</source>
        <translation>小指・中</translation>
    </message>
    <message>
        <source>Little finger, tip</source>
        <translation>小指・先</translation>
    </message>
</context>
<context>
    <name>LatencyDialog</name>
    <message>
        <source>The device has gone, or a take is recorded: measuring was ended.</source>
        <translation>機器が外れたか録音が始まったため、測定を終了しました。</translation>
    </message>
    <message>
        <source>Stop</source>
        <translation>停止</translation>
    </message>
    <message>
        <source>Start</source>
        <translation>開始</translation>
    </message>
    <message>
        <source>There is no audio device: blow when the light flashes. Measure again when there is one.</source>
        <translation>オーディオデバイスがありません。ライトの点滅に合わせて吹いてください。機器を接続したら測定し直してください。</translation>
    </message>
    <message>
        <source>Listen, and play along: the first {count} do not count.</source>
        <translation>クリックを聴きながら吹き始めてください。最初の {count} 回は数えません。</translation>
    </message>
    <message>
        <source>Blow a short note on every click: {count} of {all}</source>
        <translation>クリックごとに短く吹いてください: {count}/{all}</translation>
    </message>
    <message>
        <source>No device is connected: choose one in Record &gt; Devices, or type a number.</source>
        <translation>機器が接続されていません。録音 &gt; 機器で選ぶか、数値を入力してください。</translation>
    </message>
    <message>
        <source>{device}: {count} ms are taken off now.</source>
        <translation>{device}: 現在 {count} ms を差し引いています。</translation>
    </message>
    <message>
        <source>Only {count} of {all} clicks were hit ({least} are needed). Try again.</source>
        <translation>{all} 回のうち {count} 回しか合いませんでした({least} 回必要です)。もう一度試してください。</translation>
    </message>
    <message>
        <source>The hits differ by ±{spread} ms, too much to tell. Try again, shorter and harder.</source>
        <translation>ばらつきが ±{spread} ms と大きく、測定できません。もっと短くはっきりと吹いて、もう一度試してください。</translation>
    </message>
    <message>
        <source>{device} comes {count} ms late; {used} of {all} hits counted, they differ by ±{spread} ms.</source>
        <translation>{device} の遅れは {count} ms です({all} 回のうち {used} 回を使用、ばらつき ±{spread} ms)。</translation>
    </message>
    <message>
        <source>It is taken off from now on.</source>
        <translation>これからの録音で差し引かれます。</translation>
    </message>
    <message>
        <source>Latency</source>
        <translation>レイテンシー</translation>
    </message>
    <message>
        <source>Blow a short note on every click. What is found is how late the sound and the device come together; it also contains your own anticipation, as most people blow a little early or late. What you know better you can type.</source>
        <translation>クリックごとに短く吹いてください。測定されるのは音の出力と機器を合わせた遅れです。人は少し早めか遅めに吹くものなので、ご自身の癖も含まれます。正しい値がわかっている場合は入力できます。</translation>
    </message>
    <message>
        <source>ms</source>
        <translation>ms</translation>
    </message>
    <message>
        <source>Taken off the time of everything that this device sends</source>
        <translation>この機器から届くすべての時刻から差し引きます</translation>
    </message>
    <message>
        <source>Use</source>
        <translation>使用</translation>
    </message>
    <message>
        <source>Close</source>
        <translation>閉じる</translation>
    </message>
</context>
<context>
    <name>LearnDialog</name>
    <message>
        <source>Add Motion and Music</source>
        <translation>動きと音楽を追加</translation>
    </message>
    <message>
        <source>Add motion files and the MIDI files that they were danced to, or drop them here.</source>
        <translation>動きのファイルと、その踊りに使った MIDI ファイルを追加するか、ここにドロップしてください。</translation>
    </message>
    <message>
        <source>Pair {n}: choose its motion.</source>
        <translation>組 {n}: 動きを選んでください。</translation>
    </message>
    <message>
        <source>Pair {n}: choose its music.</source>
        <translation>組 {n}: 音楽を選んでください。</translation>
    </message>
    <message>
        <source>Pair {n}: {error}</source>
        <translation>組 {n}: {error}</translation>
    </message>
    <message>
        <source>Reading the files …</source>
        <translation>ファイルを読み込み中…</translation>
    </message>
    <message>
        <source>Choose where to save the choreography.</source>
        <translation>振り付けの保存先を選んでください。</translation>
    </message>
    <message>
        <source>Save Choreography</source>
        <translation>振り付けを保存</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>キャンセル</translation>
    </message>
    <message>
        <source>Close</source>
        <translation>閉じる</translation>
    </message>
    <message>
        <source>Neither motion nor MIDI: {files}</source>
        <translation>動きでも MIDI でもないファイル: {files}</translation>
    </message>
    <message>
        <source>This file is there and will be replaced.</source>
        <translation>このファイルは既にあり、上書きされます。</translation>
    </message>
    <message>
        <source>Add a Dancer with It</source>
        <translation>これを踊るダンサーを追加</translation>
    </message>
    <message>
        <source>Use for {dancer}</source>
        <translation>{dancer} に使う</translation>
    </message>
    <message>
        <source>Learn Choreography</source>
        <translation>振り付けを学習</translation>
    </message>
    <message>
        <source>Motion</source>
        <translation>動き</translation>
    </message>
    <message>
        <source>Music</source>
        <translation>音楽</translation>
    </message>
    <message>
        <source>Seconds</source>
        <translation>秒</translation>
    </message>
    <message>
        <source>Segments</source>
        <translation>セグメント</translation>
    </message>
    <message>
        <source>States</source>
        <translation>状態</translation>
    </message>
    <message>
        <source>Offset s</source>
        <translation>オフセット（秒）</translation>
    </message>
    <message>
        <source>Confidence</source>
        <translation>確信度</translation>
    </message>
    <message>
        <source>Pairs of motion and music</source>
        <translation>動きと音楽の組</translation>
    </message>
    <message>
        <source>Add...</source>
        <translation>追加...</translation>
    </message>
    <message>
        <source>Remove</source>
        <translation>削除</translation>
    </message>
    <message>
        <source>Seed</source>
        <translation>シード</translation>
    </message>
    <message>
        <source>Save to</source>
        <translation>保存先</translation>
    </message>
    <message>
        <source>Automatic</source>
        <translation>自動</translation>
    </message>
    <message>
        <source>Number of basic motions; automatic: as many as are needed for those of one kind to look alike</source>
        <translation>基本動作の数。自動では、同じ種類の動きが似て見えるのに必要な数になります</translation>
    </message>
    <message>
        <source>Of the classification: the same pairs and seed give the same choreography</source>
        <translation>分類のシード。同じ組と同じシードからは同じ振り付けができます</translation>
    </message>
    <message>
        <source>Choose...</source>
        <translation>選択...</translation>
    </message>
    <message>
        <source>Learn</source>
        <translation>学習</translation>
    </message>
</context>
<context>
    <name>MidiDevicesDialog</name>
    <message>
        <source>There is no audio device: connect one and try again.</source>
        <translation>オーディオデバイスがありません。接続してもう一度試してください。</translation>
    </message>
    <message>
        <source>The volume of the transport is 0.</source>
        <translation>トランスポートの音量が 0 です。</translation>
    </message>
    <message>
        <source>You should hear a short tone.</source>
        <translation>短い音が聞こえるはずです。</translation>
    </message>
    <message>
        <source>No breath came in. Blow harder, or turn breath sending on in the device, and try again.</source>
        <translation>ブレスが届きませんでした。もっと強く吹くか、機器のブレス送信を有効にして、もう一度試してください。</translation>
    </message>
    <message>
        <source>Nothing came in from the device. Is it switched on?</source>
        <translation>機器から何も届きませんでした。電源は入っていますか?</translation>
    </message>
    <message>
        <source>Found: breath {source}, bite {bite}, channel {number}.</source>
        <translation>検出しました: ブレスは {source}、バイトは {bite}、チャンネル {number}。</translation>
    </message>
    <message>
        <source>Found: breath {source}, channel {number}. No bite came in.</source>
        <translation>検出しました: ブレスは {source}、チャンネル {number}。バイトは届きませんでした。</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>キャンセル</translation>
    </message>
    <message>
        <source>Learn by Blowing</source>
        <translation>吹いて検出</translation>
    </message>
    <message>
        <source>Blow now: soft, loud and soft again. {count} s</source>
        <translation>弱く、強く、また弱く吹いてください。あと {count} 秒</translation>
    </message>
    <message>
        <source>Now blow evenly, bite and let go, several times. {count} s</source>
        <translation>一定に吹きながら、リードを噛んで緩める動作を何度か繰り返してください。あと {count} 秒</translation>
    </message>
    <message>
        <source>{count} ms</source>
        <translation>{count} ms</translation>
    </message>
    <message>
        <source>No device</source>
        <translation>機器なし</translation>
    </message>
    <message>
        <source>waiting for it</source>
        <translation>接続待ち</translation>
    </message>
    <message>
        <source>connected</source>
        <translation>接続中</translation>
    </message>
    <message>
        <source>unplugged</source>
        <translation>取り外し</translation>
    </message>
    <message>
        <source>cannot be opened</source>
        <translation>開けません</translation>
    </message>
    <message>
        <source>Connect a wind controller by USB, or by a MIDI interface, and switch it on: it appears here by itself.</source>
        <translation>ウインドコントローラーを USB か MIDI インターフェースで接続し、電源を入れてください。自動的にここに表示されます。</translation>
    </message>
    <message>
        <source>Click the device that you play.</source>
        <translation>演奏する機器をクリックしてください。</translation>
    </message>
    <message>
        <source>Any</source>
        <translation>すべて</translation>
    </message>
    <message>
        <source>MIDI Devices</source>
        <translation>MIDI機器</translation>
    </message>
    <message>
        <source>Device</source>
        <translation>機器</translation>
    </message>
    <message>
        <source>State</source>
        <translation>状態</translation>
    </message>
    <message>
        <source>Devices</source>
        <translation>機器</translation>
    </message>
    <message>
        <source>The chosen device</source>
        <translation>選択中の機器</translation>
    </message>
    <message>
        <source>What comes in</source>
        <translation>入力モニター</translation>
    </message>
    <message>
        <source>Kind</source>
        <translation>種類</translation>
    </message>
    <message>
        <source>Channel</source>
        <translation>チャンネル</translation>
    </message>
    <message>
        <source>Breath</source>
        <translation>ブレス</translation>
    </message>
    <message>
        <source>Bite</source>
        <translation>バイト</translation>
    </message>
    <message>
        <source>Latency</source>
        <translation>レイテンシー</translation>
    </message>
    <message>
        <source>Measure...</source>
        <translation>測定...</translation>
    </message>
    <message>
        <source>Finds with what breath and bite are sent, from {count} s each. Escape cancels.</source>
        <translation>それぞれ {count} 秒で、ブレスとバイトが何で送られるかを調べます。Escで取り消します。</translation>
    </message>
    <message>
        <source>Test Beep</source>
        <translation>テスト音</translation>
    </message>
    <message>
        <source>A short tone on the audio device</source>
        <translation>オーディオデバイスで短い音を鳴らします</translation>
    </message>
    <message>
        <source>Close</source>
        <translation>閉じる</translation>
    </message>
</context>
<context>
    <name>MidiMonitor</name>
    <message>
        <source>Plays on channel {number}, but only channel {wanted} is listened to.</source>
        <translation>チャンネル {number} で届いていますが、チャンネル {wanted} だけを受信しています。</translation>
    </message>
    <message>
        <source>Channel {number}</source>
        <translation>チャンネル {number}</translation>
    </message>
    <message>
        <source>Nothing has come in yet.</source>
        <translation>まだ何も届いていません。</translation>
    </message>
    <message>
        <source>{pitch} begins, velocity {value}</source>
        <translation>{pitch} オン、ベロシティ {value}</translation>
    </message>
    <message>
        <source>{pitch} ends</source>
        <translation>{pitch} オフ</translation>
    </message>
    <message>
        <source>Pressure on {pitch}: {value}</source>
        <translation>{pitch} のキープレッシャー: {value}</translation>
    </message>
    <message>
        <source>Program {value}</source>
        <translation>プログラム {value}</translation>
    </message>
    <message>
        <source>{text}   (channel {number})</source>
        <translation>{text}   (チャンネル {number})</translation>
    </message>
    <message>
        <source>Breath</source>
        <translation>ブレス</translation>
    </message>
    <message>
        <source>Bite</source>
        <translation>バイト</translation>
    </message>
    <message>
        <source>The last messages</source>
        <translation>最近のメッセージ</translation>
    </message>
</context>
<context>
    <name>MidiSource</name>
    <message>
        <source>Nothing</source>
        <translation>なし</translation>
    </message>
    <message>
        <source>CC 1 (modulation)</source>
        <translation>CC 1(モジュレーション)</translation>
    </message>
    <message>
        <source>CC 2 (breath)</source>
        <translation>CC 2(ブレス)</translation>
    </message>
    <message>
        <source>CC 7 (volume)</source>
        <translation>CC 7(ボリューム)</translation>
    </message>
    <message>
        <source>CC 11 (expression)</source>
        <translation>CC 11(エクスプレッション)</translation>
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
    <name>MotionModel</name>
    <message>
        <source>Segments: {count}, {seconds:.2f} s on average</source>
        <translation>セグメント: {count}、平均{seconds:.2f}秒</translation>
    </message>
    <message>
        <source>Sources: {count} of {all}</source>
        <translation>ソース: {all} 個中 {count} 個</translation>
    </message>
    <message>
        <source>danced {count}×</source>
        <translation>{count}回</translation>
    </message>
    <message>
        <source>not danced</source>
        <translation>使用なし</translation>
    </message>
    <message>
        <source>Basic motion {number}</source>
        <translation>基本動作{number}</translation>
    </message>
</context>
<context>
    <name>PairForm</name>
    <message>
        <source>Reading the files …</source>
        <translation>ファイルを読み込み中…</translation>
    </message>
    <message>
        <source>A pair is a motion and the MIDI file that it was danced to.</source>
        <translation>組は、動きと、その踊りに使った MIDI ファイルからなります。</translation>
    </message>
    <message>
        <source>Offset found with confidence {confidence}.</source>
        <translation>オフセットを検出しました（確信度 {confidence}）。</translation>
    </message>
    <message>
        <source>Offset found with confidence {confidence}: another one fits nearly as well. If the music begins elsewhere, type where.</source>
        <translation>オフセットを検出しました（確信度 {confidence}）。ほぼ同じくらい合う別の位置があります。音楽の開始位置が違う場合は入力してください。</translation>
    </message>
    <message>
        <source>To check: {notes}</source>
        <translation>要確認: {notes}</translation>
    </message>
    <message>
        <source>No credits: say where the motion is from and on what terms.</source>
        <translation>クレジットがありません。動きの出典と利用条件を記してください。</translation>
    </message>
    <message>
        <source>Motion files</source>
        <translation>動きのファイル</translation>
    </message>
    <message>
        <source>MIDI files</source>
        <translation>MIDI ファイル</translation>
    </message>
    <message>
        <source>Text files</source>
        <translation>テキストファイル</translation>
    </message>
    <message>
        <source>Motion</source>
        <translation>動き</translation>
    </message>
    <message>
        <source>Music</source>
        <translation>音楽</translation>
    </message>
    <message>
        <source>Credits</source>
        <translation>クレジット</translation>
    </message>
    <message>
        <source>Offset</source>
        <translation>オフセット</translation>
    </message>
    <message>
        <source>Frame rate</source>
        <translation>フレームレート</translation>
    </message>
    <message>
        <source>Choose...</source>
        <translation>選択...</translation>
    </message>
    <message>
        <source>BVH, FBX or GLB</source>
        <translation>BVH、FBX、GLB</translation>
    </message>
    <message>
        <source>MIDI with percussion</source>
        <translation>打楽器を含む MIDI</translation>
    </message>
    <message>
        <source>The .txt file beside the motion</source>
        <translation>動きと同じ名前の .txt があればそれ</translation>
    </message>
    <message>
        <source>Automatic</source>
        <translation>自動</translation>
    </message>
    <message>
        <source>Time of the motion at which the music begins</source>
        <translation>音楽が始まる、動きの中の時刻</translation>
    </message>
    <message>
        <source> s</source>
        <comment>seconds</comment>
        <translation> 秒</translation>
    </message>
    <message>
        <source>As in the file</source>
        <translation>ファイルの値</translation>
    </message>
    <message>
        <source>The true frame rate of the motion, where its file says a wrong one</source>
        <translation>ファイルの値が誤っている場合の、動きの正しいフレームレート</translation>
    </message>
    <message>
        <source> frames/s</source>
        <translation> フレーム/秒</translation>
    </message>
</context>
<context>
    <name>PieceSettingsDialog</name>
    <message>
        <source>Frame rate: type a number from {low} to {high}, such as 24, 29.97 or 30000/1001.</source>
        <translation>フレームレート：{low} から {high} までの数を入力してください（例：24、29.97、30000/1001）。</translation>
    </message>
    <message>
        <source>Seed: type a whole number from {low} to {high}.</source>
        <translation>シード：{low} から {high} までの整数を入力してください。</translation>
    </message>
    <message>
        <source>Automatic, by metre and tempo</source>
        <translation>自動（拍子とテンポから）</translation>
    </message>
    <message>
        <source>Sixteenth</source>
        <translation>16分音符</translation>
    </message>
    <message>
        <source>Eighth</source>
        <translation>8分音符</translation>
    </message>
    <message>
        <source>Dotted eighth</source>
        <translation>付点8分音符</translation>
    </message>
    <message>
        <source>Quarter</source>
        <translation>4分音符</translation>
    </message>
    <message>
        <source>Dotted quarter</source>
        <translation>付点4分音符</translation>
    </message>
    <message>
        <source>Half</source>
        <translation>2分音符</translation>
    </message>
    <message>
        <source>Dotted half</source>
        <translation>付点2分音符</translation>
    </message>
    <message>
        <source>Whole</source>
        <translation>全音符</translation>
    </message>
    <message>
        <source>{count} quarters</source>
        <translation>4分音符 × {count}</translation>
    </message>
    <message>
        <source>Piece Settings</source>
        <translation>曲の設定</translation>
    </message>
    <message>
        <source>Title</source>
        <translation>タイトル</translation>
    </message>
    <message>
        <source>Names the piece in a MIDI file and in Unreal</source>
        <translation>MIDIファイルとUnrealで使われる曲名</translation>
    </message>
    <message>
        <source>Frame rate</source>
        <translation>フレームレート</translation>
    </message>
    <message>
        <source>Of the ruler and of steps by a frame; exports start from it</source>
        <translation>ルーラーとコマ送りに使われ、書き出しの初期値になります</translation>
    </message>
    <message>
        <source>Pre-roll</source>
        <translation>プリロール</translation>
    </message>
    <message>
        <source>Felt beats before the first note, at least one second</source>
        <translation>最初の音符までの拍数（少なくとも1秒）</translation>
    </message>
    <message>
        <source>Felt beat</source>
        <translation>拍の単位</translation>
    </message>
    <message>
        <source>Breaths, cues, sway and the pre-roll count in it</source>
        <translation>ブレス、合図、体の揺れ、プリロールの単位</translation>
    </message>
    <message>
        <source>Seed</source>
        <translation>シード</translation>
    </message>
    <message>
        <source>Another seed is another performance: other sways and glances</source>
        <translation>シードを変えると、体の揺れや視線の違う演奏になります</translation>
    </message>
    <message>
        <source> beats</source>
        <translation> 拍</translation>
    </message>
    <message>
        <source>Randomise</source>
        <translation>ランダム</translation>
    </message>
    <message>
        <source>OK</source>
        <translation>OK</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>キャンセル</translation>
    </message>
    <message>
        <source>Reset to Defaults</source>
        <translation>初期値に戻す</translation>
    </message>
    <message>
        <source>All but the title as in a new piece</source>
        <translation>タイトル以外を新しい曲の初期値に戻します</translation>
    </message>
</context>
<context>
    <name>PlaceChooser</name>
    <message>
        <source>Choose the .uproject file of your Unreal project.</source>
        <translation>Unreal プロジェクトの .uproject ファイルを選んでください。</translation>
    </message>
    <message>
        <source>Choose a folder.</source>
        <translation>フォルダーを選んでください。</translation>
    </message>
    <message>
        <source>Unreal project</source>
        <translation>Unreal プロジェクト</translation>
    </message>
    <message>
        <source>Folder for the files</source>
        <translation>書き出し先フォルダー</translation>
    </message>
    <message>
        <source>A folder of files</source>
        <translation>フォルダー</translation>
    </message>
    <message>
        <source>An Unreal project</source>
        <translation>Unreal プロジェクト</translation>
    </message>
    <message>
        <source>.uproject file</source>
        <translation>.uproject ファイル</translation>
    </message>
    <message>
        <source>Folder</source>
        <translation>フォルダー</translation>
    </message>
    <message>
        <source>Choose...</source>
        <translation>選択...</translation>
    </message>
</context>
<context>
    <name>PlayblastDialog</name>
    <message>
        <source>The film is written: {file}</source>
        <translation>動画を書き出しました: {file}</translation>
    </message>
    <message>
        <source>Film</source>
        <translation>動画</translation>
    </message>
    <message>
        <source>Films (*.mp4)</source>
        <translation>動画 (*.mp4)</translation>
    </message>
    <message>
        <source>This file is there and will be replaced.</source>
        <translation>既存のファイルを上書きします。</translation>
    </message>
    <message>
        <source>Playblast</source>
        <translation>プレイブラスト</translation>
    </message>
    <message>
        <source>Size</source>
        <translation>サイズ</translation>
    </message>
    <message>
        <source>Frames per second</source>
        <translation>フレームレート</translation>
    </message>
    <message>
        <source>Range</source>
        <translation>範囲</translation>
    </message>
    <message>
        <source>View</source>
        <translation>ビュー</translation>
    </message>
    <message>
        <source>Sound</source>
        <translation>音</translation>
    </message>
    <message>
        <source>File</source>
        <translation>ファイル</translation>
    </message>
    <message>
        <source>With what is heard</source>
        <translation>聞こえる音を入れる</translation>
    </message>
    <message>
        <source>Choose...</source>
        <translation>選択...</translation>
    </message>
    <message>
        <source>Make the film</source>
        <translation>動画を作る</translation>
    </message>
    <message>
        <source>Show in folder</source>
        <translation>フォルダーで表示</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>キャンセル</translation>
    </message>
    <message>
        <source>Close</source>
        <translation>閉じる</translation>
    </message>
    <message>
        <source>Whole piece</source>
        <translation>曲全体</translation>
    </message>
    <message>
        <source>Loop</source>
        <translation>ループ範囲</translation>
    </message>
    <message>
        <source>Selection</source>
        <translation>選択範囲</translation>
    </message>
    <message>
        <source>As the viewport shows it</source>
        <translation>ビューポートのまま</translation>
    </message>
    <message>
        <source>Ensemble</source>
        <translation>全体</translation>
    </message>
    <message>
        <source>Front</source>
        <translation>正面</translation>
    </message>
    <message>
        <source>Side</source>
        <translation>側面</translation>
    </message>
    <message>
        <source>Top</source>
        <translation>上面</translation>
    </message>
    <message>
        <source>Hands</source>
        <translation>手元</translation>
    </message>
    <message>
        <source>Mouth</source>
        <translation>口元</translation>
    </message>
    <message>
        <source>Feet</source>
        <translation>足元</translation>
    </message>
</context>
<context>
    <name>PreferencesDialog</name>
    <message>
        <source>Your own: {maps}</source>
        <translation>自分の楽器：{maps}</translation>
    </message>
    <message>
        <source>Preferences</source>
        <translation>環境設定</translation>
    </message>
    <message>
        <source>General</source>
        <translation>一般</translation>
    </message>
    <message>
        <source>Keyboard Shortcuts</source>
        <translation>キーボードショートカット</translation>
    </message>
    <message>
        <source>Instruments</source>
        <translation>楽器</translation>
    </message>
    <message>
        <source>Show Folder</source>
        <translation>フォルダを開く</translation>
    </message>
    <message>
        <source>Your own instruments: a map (.toml) and a model (.glb) in this folder. They are read again as soon as they change.</source>
        <translation>自分の楽器：このフォルダに置いたマップ（.toml）とモデル（.glb）。変更するとすぐに読み込み直されます。</translation>
    </message>
</context>
<context>
    <name>RangeChooser</name>
    <message>
        <source>The last bar comes before the first one.</source>
        <translation>最後の小節が最初の小節より前にあります。</translation>
    </message>
    <message>
        <source>Whole piece</source>
        <translation>曲全体</translation>
    </message>
    <message>
        <source>Bars</source>
        <translation>小節</translation>
    </message>
    <message>
        <source>Bars of the selection</source>
        <translation>選択範囲の小節</translation>
    </message>
</context>
<context>
    <name>ReimportDialog</name>
    <message>
        <source>Re-import MIDI</source>
        <translation>MIDI の再読み込み</translation>
    </message>
    <message>
        <source>{file} says nothing new.</source>
        <translation>{file} に変更はありません。</translation>
    </message>
    <message>
        <source>What {file} changes. Fingerings, breaths and all else set by hand stay with their notes; notes changed by hand stay as they are where the file has not changed them. Undo takes it all back.</source>
        <translation>{file} による変更内容です。運指や息など手で設定したものは音符に残り、手で変更した音符も、ファイル側で変わっていなければそのまま残ります。元に戻すこともできます。</translation>
    </message>
    <message>
        <source>Part</source>
        <translation>パート</translation>
    </message>
    <message>
        <source>Kept</source>
        <translation>維持</translation>
    </message>
    <message>
        <source>New</source>
        <translation>新規</translation>
    </message>
    <message>
        <source>Gone</source>
        <translation>削除</translation>
    </message>
    <message>
        <source>Changed by hand</source>
        <translation>手動変更</translation>
    </message>
    <message>
        <source>Changed here and in the file: these notes become as the file has them now ({count})</source>
        <translation>ここでもファイルでも変更された音符：ファイルの内容になります（{count}）</translation>
    </message>
    <message>
        <source>These corrections have lost their note. They are kept; the inspector can give them another note:</source>
        <translation>次の修正は対象の音符を失いました。残してあり、インスペクターで別の音符に付け直せます:</translation>
    </message>
    <message>
        <source>Re-import</source>
        <translation>再読み込み</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>キャンセル</translation>
    </message>
    <message>
        <source>erased</source>
        <translation>削除済み</translation>
    </message>
    <message>
        <source>not in the file any more</source>
        <translation>ファイルから消えました</translation>
    </message>
    <message>
        <source>New players: {names}</source>
        <translation>新しいプレイヤー: {names}</translation>
    </message>
    <message>
        <source>Players whose part is gone: {names}</source>
        <translation>パートがなくなったプレイヤー: {names}</translation>
    </message>
    <message>
        <source>Players whose part is gone, kept for what was done by hand: {names}</source>
        <translation>パートはなくなりましたが、手で直したものがあるため残すプレイヤー: {names}</translation>
    </message>
</context>
<context>
    <name>ShortcutsPage</name>
    <message>
        <source>Search actions or keys</source>
        <translation>操作やキーを検索</translation>
    </message>
    <message>
        <source>Action</source>
        <translation>操作</translation>
    </message>
    <message>
        <source>Menu</source>
        <translation>メニュー</translation>
    </message>
    <message>
        <source>Keys</source>
        <translation>キー</translation>
    </message>
    <message>
        <source>Works</source>
        <translation>有効な場所</translation>
    </message>
    <message>
        <source>New keys</source>
        <translation>新しいキー</translation>
    </message>
    <message>
        <source>Assign</source>
        <translation>割り当てる</translation>
    </message>
    <message>
        <source>Remove Keys</source>
        <translation>キーを外す</translation>
    </message>
    <message>
        <source>Default</source>
        <translation>既定に戻す</translation>
    </message>
    <message>
        <source>All Back to Default</source>
        <translation>すべて既定に戻す</translation>
    </message>
    <message>
        <source>Opens the menu {menu}. Choose other keys.</source>
        <translation>「{menu}」メニューを開くキーです。別のキーを選んでください。</translation>
    </message>
    <message>
        <source>Used by: {names}. Assigning takes it away there.</source>
        <translation>使用中: {names}。割り当てると、そちらから外れます。</translation>
    </message>
</context>
<context>
    <name>SkeletonChooser</name>
    <message>
        <source>The skeletons are being compared.</source>
        <translation>スケルトンを比較しています。</translation>
    </message>
    <message>
        <source>There is no file of this name to compare with.</source>
        <translation>比較する相手のファイルが見つかりません。</translation>
    </message>
    <message>
        <source>The asset has another skeleton: its animation would be lost or spoilt.</source>
        <translation>アセットのスケルトンが異なります。アニメーションが失われるか、崩れます。</translation>
    </message>
    <message>
        <source>Comparing...</source>
        <translation>比較しています…</translation>
    </message>
    <message>
        <source>✓ Every bone is as in the asset.</source>
        <translation>✓ すべてのボーンがアセットと一致します。</translation>
    </message>
    <message>
        <source>With an FBX of the mannequin exported from Unreal, its rest rotations are taken. Without one the axes are the usual ones: use Unreal&apos;s IK retargeter.</source>
        <translation>Unreal から書き出したマネキンの FBX を指定すると、そのレスト回転を使います。指定しない場合は一般的な軸になるため、Unreal の IK リターゲッタを使ってください。</translation>
    </message>
    <message>
        <source>and {count} more</source>
        <translation>ほか {count} 件</translation>
    </message>
    <message>
        <source>File of the asset</source>
        <translation>アセットのファイル</translation>
    </message>
    <message>
        <source>Characters</source>
        <translation>キャラクター</translation>
    </message>
    <message>
        <source>Of the character&apos;s own file</source>
        <translation>キャラクターのファイルのまま</translation>
    </message>
    <message>
        <source>Unreal Engine 5 mannequin</source>
        <translation>Unreal Engine 5 マネキン</translation>
    </message>
    <message>
        <source>Suisou (VRM 1.0)</source>
        <translation>Suisou（VRM 1.0）</translation>
    </message>
    <message>
        <source>FBX of the asset to compare with (optional)</source>
        <translation>比較するアセットの FBX（任意）</translation>
    </message>
    <message>
        <source>Choose...</source>
        <translation>選択...</translation>
    </message>
</context>
<context>
    <name>StreamDialog</name>
    <message>
        <source>Stop Streaming</source>
        <translation>配信を停止</translation>
    </message>
    <message>
        <source>Start Streaming</source>
        <translation>配信を開始</translation>
    </message>
    <message>
        <source>{name}: not sent. {reason}</source>
        <translation>{name}: 送信していません。{reason}</translation>
    </message>
    <message>
        <source>Live Stream</source>
        <translation>ライブ配信</translation>
    </message>
    <message>
        <source>Computer</source>
        <translation>送信先のコンピューター</translation>
    </message>
    <message>
        <source>Port</source>
        <translation>ポート</translation>
    </message>
    <message>
        <source>Names of the face</source>
        <translation>表情の名前</translation>
    </message>
    <message>
        <source>Frames per second</source>
        <translation>フレームレート (fps)</translation>
    </message>
    <message>
        <source>This Computer</source>
        <translation>このコンピューター</translation>
    </message>
    <message>
        <source>What is sent leaves this computer, and anyone on the network can read it. Let the other computer&apos;s firewall through for this port.</source>
        <translation>送信内容はこのコンピューターの外に出て、ネットワーク上の誰でも読み取れます。受信側のコンピューターのファイアウォールで、このポートを許可してください。</translation>
    </message>
    <message>
        <source>The selected player, in the middle</source>
        <translation>選択中のプレイヤー (舞台の中央に)</translation>
    </message>
    <message>
        <source>ARKit: jawOpen</source>
        <translation>ARKit: jawOpen</translation>
    </message>
    <message>
        <source>ARKit with capitals: JawOpen (perfect sync)</source>
        <translation>ARKit、頭文字が大文字: JawOpen (パーフェクトシンク)</translation>
    </message>
    <message>
        <source>VRM presets: A, Blink_L, Joy</source>
        <translation>VRM プリセット: A、Blink_L、Joy</translation>
    </message>
    <message>
        <source>Sends the performers&apos; poses, faces and instruments by the VMC protocol, while you play, scrub or record. Unreal (VMC4UE), VSeeFace, Warudo and add-ons for Blender receive it; one character for each port.</source>
        <translation>再生・スクラブ・録音のあいだ、出演者のポーズ、表情、楽器を VMC プロトコルで送信します。Unreal (VMC4UE)、VSeeFace、Warudo、Blender のアドオンなどで受信できます。1 つのポートで 1 キャラクターです。</translation>
    </message>
    <message>
        <source>Performers</source>
        <translation>出演者</translation>
    </message>
    <message>
        <source>Everyone on the stage, each on a port of their own</source>
        <translation>舞台上の全員 (1 人ずつ別のポート、舞台上の位置のまま)</translation>
    </message>
    <message>
        <source>Performer</source>
        <translation>出演者</translation>
    </message>
    <message>
        <source>Close</source>
        <translation>閉じる</translation>
    </message>
    <message>
        <source>Send Anyway</source>
        <translation>それでも送信</translation>
    </message>
    <message>
        <source>Looking for {host}...</source>
        <translation>{host} を探しています...</translation>
    </message>
    <message>
        <source>Nobody listens there yet: start receiving in the other program, on the same port.</source>
        <translation>まだ受信されていません。受信側のソフトで、同じポートの受信を開始してください。</translation>
    </message>
    <message>
        <source>Sending {count} frames per second; fewer while nothing moves.</source>
        <translation>毎秒 {count} フレームを送信しています (動きがないときは少なくなります)。</translation>
    </message>
    <message>
        <source>Nothing is sent.</source>
        <translation>送信していません。</translation>
    </message>
</context>
</TS>
