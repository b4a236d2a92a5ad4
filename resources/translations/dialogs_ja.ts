<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="ja" sourcelanguage="en">
<context>
    <name>ExportDialog</name>
    <message>
        <source>Files written to {folder}: {count}</source>
        <translation>{folder} に書き出したファイル: {count}</translation>
    </message>
    <message>
        <source>Folder for the files</source>
        <translation>書き出し先フォルダー</translation>
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
        <source>The last bar comes before the first one.</source>
        <translation>最後の小節が最初の小節より前にあります。</translation>
    </message>
    <message>
        <source>Choose a folder.</source>
        <translation>フォルダーを選んでください。</translation>
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
        <source>Export</source>
        <translation>書き出し</translation>
    </message>
    <message>
        <source>Players</source>
        <translation>プレイヤー</translation>
    </message>
    <message>
        <source>Files</source>
        <translation>ファイル</translation>
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
        <source>Folder</source>
        <translation>フォルダー</translation>
    </message>
    <message>
        <source>All or none</source>
        <translation>すべて選択/解除</translation>
    </message>
    <message>
        <source>FBX (characters and instruments)</source>
        <translation>FBX（キャラクターと楽器）</translation>
    </message>
    <message>
        <source>BVH (body motion)</source>
        <translation>BVH（体の動き）</translation>
    </message>
    <message>
        <source> beats</source>
        <translation> 拍</translation>
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
    <message>
        <source>Choose...</source>
        <translation>選択...</translation>
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
        <source>Import</source>
        <translation>読み込む</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>キャンセル</translation>
    </message>
    <message>
        <source>{count} notes
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
        <source>Automatic: {name}</source>
        <translation>自動: {name}</translation>
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
        <source>Players: {count}</source>
        <translation>プレイヤー: {count} 人</translation>
    </message>
    <message>
        <source>Nobody plays: tick a track, or import an empty stage</source>
        <translation>演奏するプレイヤーがいません。トラックを選ぶか、空のステージとして読み込みます</translation>
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
        <source>Fingerings of {count} instruments are not saved.</source>
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
    <message>
        <source>Language</source>
        <translation>言語</translation>
    </message>
    <message>
        <source>Theme</source>
        <translation>テーマ</translation>
    </message>
    <message>
        <source>Pitches</source>
        <translation>音高</translation>
    </message>
    <message>
        <source>Middle C</source>
        <translation>中央ハ</translation>
    </message>
    <message>
        <source>Names of notes</source>
        <translation>音名</translation>
    </message>
    <message>
        <source>Time</source>
        <translation>時間</translation>
    </message>
    <message>
        <source>Dark</source>
        <translation>ダーク</translation>
    </message>
    <message>
        <source>Light</source>
        <translation>ライト</translation>
    </message>
    <message>
        <source>As they sound (concert)</source>
        <translation>実音</translation>
    </message>
    <message>
        <source>As written for the instrument</source>
        <translation>記譜音</translation>
    </message>
    <message>
        <source>Do Re Mi</source>
        <translation>ドレミ</translation>
    </message>
    <message>
        <source>Bars and beats</source>
        <translation>小節と拍</translation>
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
        <source>The system&apos;s</source>
        <translation>システムに合わせる</translation>
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
</TS>
