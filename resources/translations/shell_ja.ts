<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="ja" sourcelanguage="en">
<context>
    <name>AboutDialog</name>
    <message>
        <source>About Suisou</source>
        <translation>Suisou について</translation>
    </message>
    <message>
        <source>Licences...</source>
        <translation>ライセンス...</translation>
    </message>
    <message>
        <source>The performance of a wind ensemble, from its MIDI, for animation.</source>
        <translation>MIDI から管楽アンサンブルの演奏を作る、アニメーション制作のための道具です。</translation>
    </message>
    <message>
        <source>Version {version}, under the Apache License 2.0.</source>
        <translation>バージョン {version}（Apache License 2.0）</translation>
    </message>
    <message>
        <source>Settings: {path}</source>
        <translation>設定: {path}</translation>
    </message>
    <message>
        <source>Faults are noted in: {path}</source>
        <translation>不具合の記録: {path}</translation>
    </message>
</context>
<context>
    <name>Action</name>
    <message>
        <source>Search Commands...</source>
        <translation>コマンドを検索...</translation>
    </message>
    <message>
        <source>Full-Screen Viewport</source>
        <translation>ビューポートを全画面表示</translation>
    </message>
    <message>
        <source>Players</source>
        <translation>プレイヤー</translation>
    </message>
    <message>
        <source>Inspector</source>
        <translation>インスペクター</translation>
    </message>
    <message>
        <source>Timeline</source>
        <translation>タイムライン</translation>
    </message>
    <message>
        <source>Reset Layout</source>
        <translation>レイアウトを初期化</translation>
    </message>
    <message>
        <source>Concert Pitch</source>
        <translation>実音</translation>
    </message>
    <message>
        <source>Written Pitch</source>
        <translation>記譜音</translation>
    </message>
    <message>
        <source>Middle C Is C4</source>
        <translation>中央ハを C4 とする</translation>
    </message>
    <message>
        <source>Middle C Is C3</source>
        <translation>中央ハを C3 とする</translation>
    </message>
    <message>
        <source>Letters (C D E)</source>
        <translation>英語音名（C D E）</translation>
    </message>
    <message>
        <source>Syllables (Do Re Mi)</source>
        <translation>ドレミ</translation>
    </message>
    <message>
        <source>Dark Theme</source>
        <translation>ダークテーマ</translation>
    </message>
    <message>
        <source>Light Theme</source>
        <translation>ライトテーマ</translation>
    </message>
    <message>
        <source>Instruments...</source>
        <translation>楽器...</translation>
    </message>
    <message>
        <source>Preferences...</source>
        <translation>環境設定...</translation>
    </message>
    <message>
        <source>Keyboard Shortcuts...</source>
        <translation>キーボードショートカット...</translation>
    </message>
    <message>
        <source>About Suisou</source>
        <translation>Suisou について</translation>
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
        <source>Delete</source>
        <translation>削除</translation>
    </message>
    <message>
        <source>Back to the Generator&apos;s</source>
        <translation>自動生成に戻す</translation>
    </message>
    <message>
        <source>Revert All Corrections of the Player</source>
        <translation>プレイヤーの修正をすべて取り消す</translation>
    </message>
    <message>
        <source>Add a Breath</source>
        <translation>ブレスを追加</translation>
    </message>
    <message>
        <source>Prepare the Breath, or Not</source>
        <translation>ブレスの準備動作を切り替え</translation>
    </message>
    <message>
        <source>Add a Cue</source>
        <translation>合図を追加</translation>
    </message>
    <message>
        <source>Add a Gesture...</source>
        <translation>ジェスチャーを追加...</translation>
    </message>
    <message>
        <source>Add an Expression...</source>
        <translation>表情を追加...</translation>
    </message>
    <message>
        <source>Sway</source>
        <translation>揺れ</translation>
    </message>
    <message>
        <source>Weight Shift</source>
        <translation>重心移動</translation>
    </message>
    <message>
        <source>Bell Height</source>
        <translation>ベルの高さ</translation>
    </message>
    <message>
        <source>Lower the Instrument</source>
        <translation>楽器を下ろす</translation>
    </message>
    <message>
        <source>New Piece</source>
        <translation>新規</translation>
    </message>
    <message>
        <source>Open...</source>
        <translation>開く...</translation>
    </message>
    <message>
        <source>Open the Example Quartet</source>
        <translation>サンプルの四重奏を開く</translation>
    </message>
    <message>
        <source>Open the Example with a Dancer</source>
        <translation>ダンサーのいるサンプルを開く</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>保存</translation>
    </message>
    <message>
        <source>Save As...</source>
        <translation>名前を付けて保存...</translation>
    </message>
    <message>
        <source>Import MIDI...</source>
        <translation>MIDI を読み込む...</translation>
    </message>
    <message>
        <source>Add Recording...</source>
        <translation>録音を追加...</translation>
    </message>
    <message>
        <source>Piece Settings...</source>
        <translation>曲の設定...</translation>
    </message>
    <message>
        <source>Close Project</source>
        <translation>プロジェクトを閉じる</translation>
    </message>
    <message>
        <source>Quit</source>
        <translation>終了</translation>
    </message>
    <message>
        <source>Next Alternate Fingering</source>
        <translation>次の替え指</translation>
    </message>
    <message>
        <source>Fingering 0</source>
        <translation>運指 0</translation>
    </message>
    <message>
        <source>Fingering 1</source>
        <translation>運指 1</translation>
    </message>
    <message>
        <source>Fingering 2</source>
        <translation>運指 2</translation>
    </message>
    <message>
        <source>Fingering 3</source>
        <translation>運指 3</translation>
    </message>
    <message>
        <source>Fingering 4</source>
        <translation>運指 4</translation>
    </message>
    <message>
        <source>Fingering 5</source>
        <translation>運指 5</translation>
    </message>
    <message>
        <source>Fingering 6</source>
        <translation>運指 6</translation>
    </message>
    <message>
        <source>Fingering 7</source>
        <translation>運指 7</translation>
    </message>
    <message>
        <source>Fingering T (Thumb or Trigger)</source>
        <translation>運指 T（親指・トリガー）</translation>
    </message>
    <message>
        <source>Cut</source>
        <translation>切り取り</translation>
    </message>
    <message>
        <source>Copy</source>
        <translation>コピー</translation>
    </message>
    <message>
        <source>Paste at Playhead</source>
        <translation>再生位置に貼り付け</translation>
    </message>
    <message>
        <source>Duplicate</source>
        <translation>複製</translation>
    </message>
    <message>
        <source>Select All Notes</source>
        <translation>すべての音符を選択</translation>
    </message>
    <message>
        <source>Select Nothing</source>
        <translation>選択を解除</translation>
    </message>
    <message>
        <source>Select Same Pitch</source>
        <translation>同じ音高を選択</translation>
    </message>
    <message>
        <source>Select Notes of the Bar</source>
        <translation>小節内の音符を選択</translation>
    </message>
    <message>
        <source>Select Notes of the Range</source>
        <translation>範囲内の音符を選択</translation>
    </message>
    <message>
        <source>Select</source>
        <translation>選択</translation>
    </message>
    <message>
        <source>Draw</source>
        <translation>描く</translation>
    </message>
    <message>
        <source>Erase</source>
        <translation>消す</translation>
    </message>
    <message>
        <source>Split</source>
        <translation>分割</translation>
    </message>
    <message>
        <source>Split at Playhead</source>
        <translation>再生位置で分割</translation>
    </message>
    <message>
        <source>Join</source>
        <translation>結合</translation>
    </message>
    <message>
        <source>Quantise...</source>
        <translation>クオンタイズ...</translation>
    </message>
    <message>
        <source>Semitone Up</source>
        <translation>半音上げる</translation>
    </message>
    <message>
        <source>Semitone Down</source>
        <translation>半音下げる</translation>
    </message>
    <message>
        <source>Octave Up</source>
        <translation>1 オクターブ上げる</translation>
    </message>
    <message>
        <source>Octave Down</source>
        <translation>1 オクターブ下げる</translation>
    </message>
    <message>
        <source>Earlier by the Grid</source>
        <translation>グリッド分だけ前へ</translation>
    </message>
    <message>
        <source>Later by the Grid</source>
        <translation>グリッド分だけ後へ</translation>
    </message>
    <message>
        <source>Earlier by a Frame</source>
        <translation>1 フレーム前へ</translation>
    </message>
    <message>
        <source>Later by a Frame</source>
        <translation>1 フレーム後へ</translation>
    </message>
    <message>
        <source>Louder</source>
        <translation>強く</translation>
    </message>
    <message>
        <source>Softer</source>
        <translation>弱く</translation>
    </message>
    <message>
        <source>Play or Stop Here</source>
        <translation>再生/ここで停止</translation>
    </message>
    <message>
        <source>Play from Start of Bar</source>
        <translation>小節の頭から再生</translation>
    </message>
    <message>
        <source>Stop</source>
        <translation>停止</translation>
    </message>
    <message>
        <source>Loop the Selection</source>
        <translation>選択範囲をループ</translation>
    </message>
    <message>
        <source>To Start</source>
        <translation>先頭へ</translation>
    </message>
    <message>
        <source>To End</source>
        <translation>末尾へ</translation>
    </message>
    <message>
        <source>Previous Frame</source>
        <translation>前のフレーム</translation>
    </message>
    <message>
        <source>Next Frame</source>
        <translation>次のフレーム</translation>
    </message>
    <message>
        <source>Previous Note</source>
        <translation>前の音符</translation>
    </message>
    <message>
        <source>Next Note</source>
        <translation>次の音符</translation>
    </message>
    <message>
        <source>Previous Bar</source>
        <translation>前の小節</translation>
    </message>
    <message>
        <source>Next Bar</source>
        <translation>次の小節</translation>
    </message>
    <message>
        <source>Recording</source>
        <translation>録音</translation>
    </message>
    <message>
        <source>Synthesiser</source>
        <translation>シンセサイザー</translation>
    </message>
    <message>
        <source>Recording and Synthesiser</source>
        <translation>録音とシンセサイザー</translation>
    </message>
    <message>
        <source>Metronome</source>
        <translation>メトロノーム</translation>
    </message>
    <message>
        <source>Hear the Playhead Being Moved</source>
        <translation>スクラブ音を鳴らす</translation>
    </message>
    <message>
        <source>Follow the Playhead</source>
        <translation>再生位置を追従</translation>
    </message>
    <message>
        <source>Estimate the Recording&apos;s Offset</source>
        <translation>録音のオフセットを推定</translation>
    </message>
    <message>
        <source>Fit the Tempo to the Recording</source>
        <translation>テンポを録音に合わせる</translation>
    </message>
    <message>
        <source>Remove the Recording</source>
        <translation>録音を外す</translation>
    </message>
    <message>
        <source>Dancer</source>
        <translation>ダンサー</translation>
    </message>
    <message>
        <source>Rename dancer</source>
        <translation>ダンサーの名前を変更</translation>
    </message>
    <message>
        <source>Duplicate dancer</source>
        <translation>ダンサーを複製</translation>
    </message>
    <message>
        <source>Remove dancer</source>
        <translation>ダンサーを削除</translation>
    </message>
    <message>
        <source>Show Choreography...</source>
        <translation>振り付けを表示...</translation>
    </message>
    <message>
        <source>Learn Choreography...</source>
        <translation>振り付けを学習...</translation>
    </message>
    <message>
        <source>Add player</source>
        <translation>プレイヤーを追加</translation>
    </message>
    <message>
        <source>Add dancer</source>
        <translation>ダンサーを追加</translation>
    </message>
    <message>
        <source>Rename player</source>
        <translation>プレイヤーの名前を変更</translation>
    </message>
    <message>
        <source>Duplicate players</source>
        <translation>プレイヤーを複製</translation>
    </message>
    <message>
        <source>One person plays these in turn</source>
        <translation>一人で持ち替えて演奏</translation>
    </message>
    <message>
        <source>Separate into players of their own</source>
        <translation>別々のプレイヤーに分ける</translation>
    </message>
    <message>
        <source>Remove players</source>
        <translation>プレイヤーを削除</translation>
    </message>
    <message>
        <source>Mute players</source>
        <translation>プレイヤーをミュート</translation>
    </message>
    <message>
        <source>Solo players</source>
        <translation>プレイヤーをソロ</translation>
    </message>
    <message>
        <source>Hear everyone</source>
        <translation>全員を鳴らす</translation>
    </message>
    <message>
        <source>Next player in front</source>
        <translation>次のプレイヤーを手前に</translation>
    </message>
    <message>
        <source>Previous player in front</source>
        <translation>前のプレイヤーを手前に</translation>
    </message>
    <message>
        <source>Sit down or stand up</source>
        <translation>座る/立つ</translation>
    </message>
    <message>
        <source>Randomise the ensemble</source>
        <translation>アンサンブルをランダム化</translation>
    </message>
    <message>
        <source>Automatic arc</source>
        <translation>自動で弧に並べる</translation>
    </message>
    <message>
        <source>Select all players</source>
        <translation>全プレイヤーを選択</translation>
    </message>
    <message>
        <source>Reset the players&apos; parameters</source>
        <translation>プレイヤーのパラメーターを初期化</translation>
    </message>
    <message>
        <source>Next Problem</source>
        <translation>次の問題</translation>
    </message>
    <message>
        <source>Previous Problem</source>
        <translation>前の問題</translation>
    </message>
    <message>
        <source>Zoom Timeline In</source>
        <translation>タイムラインを拡大</translation>
    </message>
    <message>
        <source>Zoom Timeline Out</source>
        <translation>タイムラインを縮小</translation>
    </message>
    <message>
        <source>Show the Whole Piece</source>
        <translation>曲全体を表示</translation>
    </message>
    <message>
        <source>Zoom to Selection</source>
        <translation>選択範囲に合わせる</translation>
    </message>
    <message>
        <source>Others as Ghosts</source>
        <translation>他パートを薄く表示</translation>
    </message>
    <message>
        <source>All Players&apos; Notes</source>
        <translation>全プレイヤーの音符</translation>
    </message>
    <message>
        <source>Only the Notes of the Player in Front</source>
        <translation>手前のプレイヤーの音符のみ</translation>
    </message>
    <message>
        <source>Ruler in Bars</source>
        <translation>ルーラー: 小節</translation>
    </message>
    <message>
        <source>Ruler in Seconds</source>
        <translation>ルーラー: 秒</translation>
    </message>
    <message>
        <source>Ruler in Frames</source>
        <translation>ルーラー: フレーム</translation>
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
    <message>
        <source>Frame Selected Players</source>
        <translation>選択したプレイヤーを画面に収める</translation>
    </message>
    <message>
        <source>Frame Ensemble</source>
        <translation>全員を画面に収める</translation>
    </message>
    <message>
        <source>Players&apos; Names</source>
        <translation>プレイヤー名</translation>
    </message>
    <message>
        <source>Skeleton</source>
        <translation>スケルトン</translation>
    </message>
    <message>
        <source>Contact Points</source>
        <translation>接触点</translation>
    </message>
    <message>
        <source>Wireframe</source>
        <translation>ワイヤーフレーム</translation>
    </message>
    <message>
        <source>Pose by Hand</source>
        <translation>手でポーズを付ける</translation>
    </message>
    <message>
        <source>Read the MIDI File Again...</source>
        <translation>MIDI ファイルを読み直す...</translation>
    </message>
    <message>
        <source>Take In a Newer MIDI File...</source>
        <translation>新しい MIDI ファイルを取り込む...</translation>
    </message>
    <message>
        <source>Export MIDI...</source>
        <translation>MIDI を書き出す...</translation>
    </message>
    <message>
        <source>Export Players...</source>
        <translation>プレイヤーを書き出す...</translation>
    </message>
    <message>
        <source>Playblast...</source>
        <translation>プレイブラスト...</translation>
    </message>
    <message>
        <source>Another Performance by Everyone</source>
        <translation>全員の演奏を作り直す</translation>
    </message>
    <message>
        <source>Another Performance by the Selected Players</source>
        <translation>選択したプレイヤーの演奏を作り直す</translation>
    </message>
    <message>
        <source>Another Performance of the Selected Bars</source>
        <translation>選択した小節の演奏を作り直す</translation>
    </message>
    <message>
        <source>Selected Bars as at First</source>
        <translation>選択した小節を最初の演奏に戻す</translation>
    </message>
    <message>
        <source>Record</source>
        <translation>録音</translation>
    </message>
    <message>
        <source>Always Record This Player</source>
        <translation>常にこの奏者を録音</translation>
    </message>
    <message>
        <source>Punch In and Out</source>
        <translation>パンチイン／アウト</translation>
    </message>
    <message>
        <source>No Count-in</source>
        <translation>カウントインなし</translation>
    </message>
    <message>
        <source>Count In One Bar</source>
        <translation>1小節カウントイン</translation>
    </message>
    <message>
        <source>Count In Two Bars</source>
        <translation>2小節カウントイン</translation>
    </message>
    <message>
        <source>Devices...</source>
        <translation>機器...</translation>
    </message>
    <message>
        <source>Measure Latency...</source>
        <translation>レイテンシーの測定...</translation>
    </message>
    <message>
        <source>Listen to Take</source>
        <translation>テイクを試聴</translation>
    </message>
    <message>
        <source>Listen to Take Alone</source>
        <translation>テイクだけを試聴</translation>
    </message>
    <message>
        <source>Use the Whole Take</source>
        <translation>テイク全体を採用</translation>
    </message>
    <message>
        <source>Selected Span from the Take Above</source>
        <translation>選択範囲を 1 つ上のテイクから採用</translation>
    </message>
    <message>
        <source>Selected Span from the Take Below</source>
        <translation>選択範囲を 1 つ下のテイクから採用</translation>
    </message>
    <message>
        <source>Back to What Was Before the Takes</source>
        <translation>テイク前の内容に戻す</translation>
    </message>
    <message>
        <source>Rename Take</source>
        <translation>テイクの名前を変更</translation>
    </message>
    <message>
        <source>Move Take Up</source>
        <translation>テイクを上へ移動</translation>
    </message>
    <message>
        <source>Move Take Down</source>
        <translation>テイクを下へ移動</translation>
    </message>
    <message>
        <source>Clean Take as Usual</source>
        <translation>テイクのクリーニングを標準に戻す</translation>
    </message>
    <message>
        <source>Find the Beats of the Take</source>
        <translation>テイクの拍を検出</translation>
    </message>
    <message>
        <source>Delete Take</source>
        <translation>テイクを削除</translation>
    </message>
    <message>
        <source>Stream Live (VMC)</source>
        <translation>ライブ配信 (VMC)</translation>
    </message>
    <message>
        <source>Live Stream Settings...</source>
        <translation>ライブ配信の設定...</translation>
    </message>
    <message>
        <source>Add Character...</source>
        <translation>キャラクターを追加...</translation>
    </message>
    <message>
        <source>Characters...</source>
        <translation>キャラクター...</translation>
    </message>
    <message>
        <source>Felt Beat from Metre and Tempo</source>
        <translation>拍の単位：拍子とテンポから自動</translation>
    </message>
    <message>
        <source>Felt Beat: Eighth</source>
        <translation>拍の単位：8分音符</translation>
    </message>
    <message>
        <source>Felt Beat: Quarter</source>
        <translation>拍の単位：4分音符</translation>
    </message>
    <message>
        <source>Felt Beat: Dotted Quarter</source>
        <translation>拍の単位：付点4分音符</translation>
    </message>
    <message>
        <source>Felt Beat: Half</source>
        <translation>拍の単位：2分音符</translation>
    </message>
    <message>
        <source>Felt Beat: Dotted Half</source>
        <translation>拍の単位：付点2分音符</translation>
    </message>
</context>
<context>
    <name>ActionTable</name>
    <message>
        <source>{action}: {step}</source>
        <translation>{action}: {step}</translation>
    </message>
</context>
<context>
    <name>Banner</name>
    <message>
        <source>Not now</source>
        <translation>後で</translation>
    </message>
</context>
<context>
    <name>Context</name>
    <message>
        <source>everywhere</source>
        <translation>どこでも</translation>
    </message>
    <message>
        <source>in the timeline</source>
        <translation>タイムライン内</translation>
    </message>
    <message>
        <source>in the viewport</source>
        <translation>ビューポート内</translation>
    </message>
    <message>
        <source>in the players</source>
        <translation>プレイヤー内</translation>
    </message>
    <message>
        <source>in the dancers</source>
        <translation>ダンサー内</translation>
    </message>
    <message>
        <source>in the inspector</source>
        <translation>インスペクター内</translation>
    </message>
</context>
<context>
    <name>Dock</name>
    <message>
        <source>Float or dock this panel</source>
        <translation>パネルを切り離す/戻す</translation>
    </message>
    <message>
        <source>Close this panel; View › Panels brings it back</source>
        <translation>パネルを閉じる（「表示 › パネル」で再表示）</translation>
    </message>
</context>
<context>
    <name>Files</name>
    <message>
        <source>Projects and MIDI files</source>
        <translation>プロジェクトと MIDI ファイル</translation>
    </message>
    <message>
        <source>All files</source>
        <translation>すべてのファイル</translation>
    </message>
    <message>
        <source>Open</source>
        <translation>開く</translation>
    </message>
    <message>
        <source>MIDI files</source>
        <translation>MIDI ファイル</translation>
    </message>
    <message>
        <source>Import MIDI</source>
        <translation>MIDI を読み込む</translation>
    </message>
    <message>
        <source>Sound files</source>
        <translation>音声ファイル</translation>
    </message>
    <message>
        <source>Add recording</source>
        <translation>録音を追加</translation>
    </message>
    <message>
        <source>Untitled</source>
        <translation>名称未設定</translation>
    </message>
    <message>
        <source>Save project</source>
        <translation>プロジェクトを保存</translation>
    </message>
    <message>
        <source>Suisou project (*{suffix})</source>
        <translation>Suisou プロジェクト (*{suffix})</translation>
    </message>
    <message>
        <source>Re-import MIDI</source>
        <translation>MIDI を再読み込み</translation>
    </message>
    <message>
        <source>Export MIDI</source>
        <translation>MIDI の書き出し</translation>
    </message>
    <message>
        <source>Characters</source>
        <translation>キャラクター</translation>
    </message>
    <message>
        <source>Add Character</source>
        <translation>キャラクターを追加</translation>
    </message>
</context>
<context>
    <name>LicencesDialog</name>
    <message>
        <source>Licences</source>
        <translation>ライセンス</translation>
    </message>
    <message>
        <source>Suisou is under the Apache License 2.0. The packages below were installed with it, each under its own licence.</source>
        <translation>Suisou のライセンスは Apache License 2.0 です。以下のパッケージは Suisou とともにインストールされたもので、それぞれ独自のライセンスに従います。</translation>
    </message>
    <message>
        <source>Qt, PySide6, soxr and libsndfile are under the LGPL: libraries in files of their own, which you may replace with your own builds.</source>
        <translation>Qt、PySide6、soxr、libsndfile は LGPL です。独立したファイルのライブラリで、自分でビルドしたものに置き換えることができます。</translation>
    </message>
    <message>
        <source>FFmpeg is under the GPL: a separate program, started as a process of its own to write films.</source>
        <translation>FFmpeg は GPL です。独立したプログラムで、動画の書き出し時に別プロセスとして起動されます。</translation>
    </message>
    <message>
        <source>Work</source>
        <translation>名称</translation>
    </message>
    <message>
        <source>Version</source>
        <translation>バージョン</translation>
    </message>
    <message>
        <source>Licence</source>
        <translation>ライセンス</translation>
    </message>
    <message>
        <source>Source</source>
        <translation>入手先</translation>
    </message>
    <message>
        <source>Suisou&apos;s own files</source>
        <translation>Suisou 自身のファイル</translation>
    </message>
</context>
<context>
    <name>Menu</name>
    <message>
        <source>&amp;File</source>
        <translation>ファイル(&amp;F)</translation>
    </message>
    <message>
        <source>&amp;Edit</source>
        <translation>編集(&amp;E)</translation>
    </message>
    <message>
        <source>&amp;View</source>
        <translation>表示(&amp;V)</translation>
    </message>
    <message>
        <source>&amp;Play</source>
        <translation>再生(&amp;P)</translation>
    </message>
    <message>
        <source>Re&amp;cord</source>
        <translation>録音(&amp;C)</translation>
    </message>
    <message>
        <source>Count-in</source>
        <translation>カウントイン</translation>
    </message>
    <message>
        <source>&amp;Generate</source>
        <translation>生成(&amp;G)</translation>
    </message>
    <message>
        <source>E&amp;xport</source>
        <translation>書き出し(&amp;X)</translation>
    </message>
    <message>
        <source>&amp;Help</source>
        <translation>ヘルプ(&amp;H)</translation>
    </message>
    <message>
        <source>Notes</source>
        <translation>音符</translation>
    </message>
    <message>
        <source>Fingering</source>
        <translation>運指</translation>
    </message>
    <message>
        <source>Breaths and Acting</source>
        <translation>ブレスと演技</translation>
    </message>
    <message>
        <source>Felt Beat</source>
        <translation>拍の単位</translation>
    </message>
    <message>
        <source>Add a Gesture</source>
        <translation>ジェスチャーを追加</translation>
    </message>
    <message>
        <source>Select</source>
        <translation>選択</translation>
    </message>
    <message>
        <source>Tool</source>
        <translation>ツール</translation>
    </message>
    <message>
        <source>Players</source>
        <translation>プレイヤー</translation>
    </message>
    <message>
        <source>Takes</source>
        <translation>テイク</translation>
    </message>
    <message>
        <source>Go</source>
        <translation>移動</translation>
    </message>
    <message>
        <source>Recording</source>
        <translation>録音</translation>
    </message>
    <message>
        <source>Sound</source>
        <translation>音</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>速度</translation>
    </message>
    <message>
        <source>Viewport</source>
        <translation>ビューポート</translation>
    </message>
    <message>
        <source>Panels</source>
        <translation>パネル</translation>
    </message>
    <message>
        <source>Theme</source>
        <translation>テーマ</translation>
    </message>
    <message>
        <source>Language</source>
        <translation>言語</translation>
    </message>
    <message>
        <source>Pitch</source>
        <translation>音高</translation>
    </message>
    <message>
        <source>Time</source>
        <translation>時間</translation>
    </message>
    <message>
        <source>Open Recent</source>
        <translation>最近使ったファイル</translation>
    </message>
</context>
<context>
    <name>Palette</name>
    <message>
        <source>What do you want to do?</source>
        <translation>何をしますか?</translation>
    </message>
    <message>
        <source>Search commands</source>
        <translation>コマンドを検索</translation>
    </message>
    <message>
        <source>Commands</source>
        <translation>コマンド</translation>
    </message>
    <message>
        <source>No command is called that.</source>
        <translation>該当する操作がありません。</translation>
    </message>
</context>
<context>
    <name>Questions</name>
    <message>
        <source>Unsaved changes</source>
        <translation>未保存の変更</translation>
    </message>
    <message>
        <source>Save the changes to {name}?</source>
        <translation>{name} への変更を保存しますか?</translation>
    </message>
    <message>
        <source>They are lost if you do not save them.</source>
        <translation>保存しないと失われます。</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>保存</translation>
    </message>
    <message>
        <source>Don&apos;t Save</source>
        <translation>保存しない</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>キャンセル</translation>
    </message>
    <message>
        <source>Remove character</source>
        <translation>キャラクターの削除</translation>
    </message>
    <message>
        <source>Remove {name} and its file for good?</source>
        <translation>{name} とそのファイルを完全に削除しますか?</translation>
    </message>
    <message>
        <source>These players are this character and will not be seen: {players}</source>
        <translation>次のプレイヤーはこのキャラクターを使っており、表示されなくなります: {players}</translation>
    </message>
    <message>
        <source>Remove</source>
        <translation>削除</translation>
    </message>
    <message>
        <source>Replace {name}?</source>
        <translation>{name} を置き換えますか?</translation>
    </message>
    <message>
        <source>The folder has a file of this name. What it holds is lost.</source>
        <translation>このフォルダーには同じ名前のファイルがあります。その内容は失われます。</translation>
    </message>
    <message>
        <source>Replace</source>
        <translation>置き換える</translation>
    </message>
</context>
<context>
    <name>Recorder</name>
    <message>
        <source>Take {number}</source>
        <translation>テイク {number}</translation>
    </message>
    <message>
        <source>Recovered take {number}</source>
        <translation>復元したテイク {number}</translation>
    </message>
</context>
<context>
    <name>StartPage</name>
    <message>
        <source>The performance of a wind ensemble, from its MIDI, for animation.</source>
        <translation>MIDI から管楽アンサンブルの演奏を作る、アニメーション制作のための道具です。</translation>
    </message>
    <message>
        <source>Begin</source>
        <translation>はじめる</translation>
    </message>
    <message>
        <source>How it works</source>
        <translation>使い方</translation>
    </message>
    <message>
        <source>Recent files</source>
        <translation>最近使ったファイル</translation>
    </message>
    <message>
        <source>Open a MIDI file or project</source>
        <translation>MIDI ファイルかプロジェクトを開く</translation>
    </message>
    <message>
        <source>New piece</source>
        <translation>新しい曲</translation>
    </message>
    <message>
        <source>Try the example quartet</source>
        <translation>サンプルの四重奏を試す</translation>
    </message>
    <message>
        <source>Try the example with a dancer</source>
        <translation>ダンサーのいるサンプルを試す</translation>
    </message>
    <message>
        <source>1. Open the MIDI of a piece: every part gets a player, with fingerings, breaths and cues.</source>
        <translation>1. 曲の MIDI を開くと、パートごとにプレイヤーが付き、運指・ブレス・合図が作られます。</translation>
    </message>
    <message>
        <source>2. Change what you would do differently. What you set by hand stays, whatever is generated.</source>
        <translation>2. 気になるところを直します。手で決めたことは、生成し直しても残ります。</translation>
    </message>
    <message>
        <source>3. Export players and instruments as FBX and BVH. Files can also be dropped onto the window.</source>
        <translation>3. プレイヤーと楽器を FBX と BVH に書き出します。ファイルはウィンドウにドロップしても開けます。</translation>
    </message>
    <message>
        <source>a piece that was never saved</source>
        <translation>一度も保存していない曲</translation>
    </message>
    <message>
        <source>Unsaved work was found: {name}, {when}</source>
        <translation>未保存の作業が見つかりました: {name}、{when}</translation>
    </message>
    <message>
        <source>The project&apos;s file no longer exists.</source>
        <translation>プロジェクトのファイルはもうありません。</translation>
    </message>
    <message>
        <source>The project&apos;s file has changed since.</source>
        <translation>プロジェクトのファイルはその後変更されています。</translation>
    </message>
    <message>
        <source>Recover</source>
        <translation>復元</translation>
    </message>
    <message>
        <source>Discard</source>
        <translation>破棄</translation>
    </message>
    <message>
        <source>Files you open appear here.</source>
        <translation>開いたファイルがここに並びます。</translation>
    </message>
    <message>
        <source>Remove from this list</source>
        <translation>この一覧から外す</translation>
    </message>
</context>
<context>
    <name>StatusLine</name>
    <message>
        <source>Show everything that was said</source>
        <translation>これまでの通知を表示</translation>
    </message>
    <message>
        <source>problems: {count}</source>
        <translation>問題: {count} 件</translation>
    </message>
    <message>
        <source>no problems</source>
        <translation>問題なし</translation>
    </message>
    <message>
        <source>faulty instruments: {count}</source>
        <translation>楽器定義のエラー: {count}</translation>
    </message>
    <message>
        <source>Show the instruments</source>
        <translation>楽器を表示</translation>
    </message>
    <message>
        <source>choose a MIDI device</source>
        <translation>MIDI機器を選択</translation>
    </message>
    <message>
        <source>waiting for {device}</source>
        <translation>{device} を待っています</translation>
    </message>
    <message>
        <source>{device} connected</source>
        <translation>{device} 接続中</translation>
    </message>
    <message>
        <source>{device} unplugged</source>
        <translation>{device} が外れました</translation>
    </message>
    <message>
        <source>{device} cannot be opened</source>
        <translation>{device} を開けません</translation>
    </message>
    <message>
        <source>MIDI devices: choose, watch what comes in</source>
        <translation>MIDI機器の選択と入力モニター</translation>
    </message>
    <message>
        <source>looking for {host}</source>
        <translation>{host} を検索中</translation>
    </message>
    <message>
        <source>VMC to {host}:{ports}, {rate}/s</source>
        <translation>VMC → {host}:{ports}  {rate} fps</translation>
    </message>
    <message>
        <source>VMC: nobody listens at {host}:{ports}</source>
        <translation>VMC: {host}:{ports} は受信されていません</translation>
    </message>
    <message>
        <source>VMC: {host} cannot be reached</source>
        <translation>VMC: {host} に送信できません</translation>
    </message>
    <message>
        <source>Live stream: what is sent, and where</source>
        <translation>ライブ配信: 送信内容と送信先</translation>
    </message>
    <message>
        <source>Unsaved work at risk: Save As...</source>
        <translation>未保存の作業が危険です: 名前を付けて保存...</translation>
    </message>
    <message>
        <source>saved</source>
        <translation>保存済み</translation>
    </message>
    <message>
        <source>not saved yet</source>
        <translation>未保存</translation>
    </message>
    <message>
        <source>{count} s ago</source>
        <translation>{count} 秒前</translation>
    </message>
    <message>
        <source>{count} min ago</source>
        <translation>{count} 分前</translation>
    </message>
    <message>
        <source>{count} h ago</source>
        <translation>{count} 時間前</translation>
    </message>
    <message>
        <source>autosaved {ago}</source>
        <translation>{ago}に自動保存</translation>
    </message>
    <message>
        <source>saved {ago}</source>
        <translation>{ago}に保存</translation>
    </message>
    <message>
        <source>{rate} fps</source>
        <translation>{rate} fps</translation>
    </message>
    <message>
        <source>making motion</source>
        <translation>モーション作成中</translation>
    </message>
    <message>
        <source>motion ready</source>
        <translation>モーション準備完了</translation>
    </message>
    <message>
        <source>Close this notice</source>
        <translation>この通知を閉じる</translation>
    </message>
    <message>
        <source>Go to the next problem</source>
        <translation>次の問題へ</translation>
    </message>
    <message>
        <source>How much of the players&apos; motion is made</source>
        <translation>モーションの作成状況</translation>
    </message>
</context>
<context>
    <name>Window</name>
    <message>
        <source>Nothing yet</source>
        <translation>まだありません</translation>
    </message>
    <message>
        <source>There is unsaved work on an earlier version of this file; the file has changed since.</source>
        <translation>このファイルの以前の版に対する未保存の作業があります。ファイルはその後変更されています。</translation>
    </message>
    <message>
        <source>There is unsaved work on this project.</source>
        <translation>このプロジェクトには未保存の作業があります。</translation>
    </message>
    <message>
        <source>Recover</source>
        <translation>復元</translation>
    </message>
    <message>
        <source>Discard</source>
        <translation>破棄</translation>
    </message>
    <message>
        <source>The recording {name} is not where it was. Without it the synthesiser is heard.</source>
        <translation>録音 {name} が元の場所にありません。それまではシンセサイザーで鳴らします。</translation>
    </message>
    <message>
        <source>Find It...</source>
        <translation>探す...</translation>
    </message>
    <message>
        <source>Remove It</source>
        <translation>外す</translation>
    </message>
    <message>
        <source>{name} was changed by somebody else since it was opened. It was not saved.</source>
        <translation>{name}は開いた後に別の場所で変更されています。保存していません。</translation>
    </message>
    <message>
        <source>Save As...</source>
        <translation>名前を付けて保存...</translation>
    </message>
    <message>
        <source>Replace It</source>
        <translation>上書きする</translation>
    </message>
    <message>
        <source>Find {name}</source>
        <translation>{name} を探す</translation>
    </message>
    <message>
        <source>Players</source>
        <translation>プレイヤー</translation>
    </message>
    <message>
        <source>Inspector</source>
        <translation>インスペクター</translation>
    </message>
    <message>
        <source>Timeline</source>
        <translation>タイムライン</translation>
    </message>
    <message>
        <source>Search...   {keys}</source>
        <translation>検索...   {keys}</translation>
    </message>
    <message>
        <source>Search commands</source>
        <translation>コマンドを検索</translation>
    </message>
</context>
<context>
    <name>_Details</name>
    <message>
        <source>Copy</source>
        <translation>コピー</translation>
    </message>
</context>
<context>
    <name>_TaskRow</name>
    <message>
        <source>Stop</source>
        <translation>停止</translation>
    </message>
</context>
</TS>
