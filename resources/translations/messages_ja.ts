<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="ja" sourcelanguage="en">
    <context>
        <name>Message</name>
        <message>
            <source>{file} is no sound that can be read ({detail}); choose a WAV, FLAC, OGG or MP3 file, or convert it to one</source>
            <translation>{file} は読み込める音声ではありません（{detail}）。WAV、FLAC、OGG、MP3 のいずれかを選ぶか、変換してください</translation>
        </message>
        <message>
            <source>{file} has {channels} channels at {rate_hz} Hz, which is no recording; export it as stereo at 48000 Hz</source>
            <translation>{file} は {channels} チャンネル・{rate_hz} Hz で、録音として扱えません。48000 Hz のステレオで書き出してください</translation>
        </message>
        <message>
            <source>{file} holds no sound; choose another recording</source>
            <translation>{file} には音が入っていません。別の録音を選んでください</translation>
        </message>
        <message>
            <source>{file} holds more than {minutes} minutes of silence, far more than a file of its size has of sound; cut it to the piece</source>
            <translation>{file} には {minutes} 分を超える無音が入っています。このサイズのファイルに入る音よりもはるかに長いので、曲の長さに切ってください</translation>
        </message>
        <message>
            <source>{file} is longer than {most_hours} hours; cut it to the piece</source>
            <translation>{file} は {most_hours} 時間を超えています。曲の部分だけに切り詰めてください</translation>
        </message>
        <message>
            <source>{file} breaks off after {seconds} s: the file is damaged or was not copied whole</source>
            <translation>{file} は {seconds} 秒で途切れています。壊れているか、コピーが不完全です</translation>
        </message>
        <message>
            <source>there is no device for sound: it plays silently, in time</source>
            <translation>音声デバイスがありません。無音のまま正しい時間で再生します</translation>
        </message>
        <message>
            <source>the recording or the score is silent: there is nothing to find the offset by</source>
            <translation>録音か楽譜が無音のため、オフセットを推定できません</translation>
        </message>
        <message>
            <source>the piece was not recognised in the recording (confidence {percent} %): nothing was changed; drag the waveform or type the offset</source>
            <translation>録音の中に曲が見つかりませんでした（確信度 {percent} %）。何も変更していません。波形をドラッグするか、オフセットを入力してください</translation>
        </message>
        <message>
            <source>the recording begins at {offset_s:.3f} s (confidence {percent} %)</source>
            <translation>録音の開始位置は {offset_s:.3f} 秒です（確信度 {percent} %）</translation>
        </message>
        <message>
            <source>the recording begins at {offset_s:.3f} s (confidence {percent} %); its tempo differs by {tempo_percent:+.1f} %: Play &gt; Recording &gt; Fit the Tempo to the Recording</source>
            <translation>録音の開始位置は {offset_s:.3f} 秒です（確信度 {percent} %）。テンポが {tempo_percent:+.1f} % 違います:「再生 &gt; 録音 &gt; テンポを録音に合わせる」</translation>
        </message>
        <message>
            <source>the recording begins at {offset_s:.3f} s (confidence {percent} %); the score is played {tempo_percent:+.1f} % faster</source>
            <translation>録音の開始位置は {offset_s:.3f} 秒です（確信度 {percent} %）。楽譜を {tempo_percent:+.1f} % 速く演奏します</translation>
        </message>
        <message>
            <source>MIDI devices cannot be reached: {detail}; they need Python 3.11 or 3.12 and, on Linux, the package libasound2</source>
            <translation>MIDI機器を利用できません: {detail}。Python 3.11 または 3.12 が必要です。Linuxではパッケージ libasound2 も必要です</translation>
        </message>
        <message>
            <source>no MIDI system answers; on Linux, load the kernel's sequencer (sudo modprobe snd-seq) or start JACK</source>
            <translation>MIDIシステムが応答しません。Linuxではカーネルのシーケンサーを読み込むか (sudo modprobe snd-seq)、JACKを起動してください</translation>
        </message>
        <message>
            <source>there is no MIDI system {name!r} here; possible: {possible}</source>
            <translation>MIDIシステム「{name}」はここにはありません。使えるもの: {possible}</translation>
        </message>
        <message>
            <source>no MIDI device is connected; plug one in and switch it on</source>
            <translation>MIDI機器が接続されていません。接続して電源を入れてください</translation>
        </message>
        <message>
            <source>no MIDI device is called {port!r}; there are: {possible}</source>
            <translation>「{port}」というMIDI機器はありません。接続中の機器: {possible}</translation>
        </message>
        <message>
            <source>{port} is not connected; it is used as soon as it is</source>
            <translation>{port} は接続されていません。接続されしだい使用します</translation>
        </message>
        <message>
            <source>{port} cannot be opened ({detail}): another program may be using it; close it there, and it is opened here</source>
            <translation>{port} を開けません ({detail})。ほかのプログラムが使用している可能性があります。そちらで閉じると、ここで開きます</translation>
        </message>
        <message>
            <source>{file} cannot be written: {reason}; recording goes on and is written as soon as there is room</source>
            <translation>{file} に書き込めません: {reason}。録音は続いており、空きができしだい書き込みます</translation>
        </message>
        <message>
            <source>{file} cannot be written: {reason}; the end of the recording is missing in it</source>
            <translation>{file} に書き込めません: {reason}。録音の終わりの部分は保存されていません</translation>
        </message>
        <message>
            <source>the recorder ended unexpectedly and was started again; what it had heard is kept</source>
            <translation>録音プロセスが予期せず終了したため、再起動しました。それまでに録音した内容は残っています</translation>
        </message>
        <message>
            <source>the recorder cannot be started ({detail})</source>
            <translation>録音プロセスを開始できません ({detail})</translation>
        </message>
        <message>
            <source>say with --port which device to record from; 'suisou ports' lists them</source>
            <translation>録音する機器を --port で指定してください。「suisou ports」で一覧を表示できます</translation>
        </message>
        <message>
            <source>{file} is there already; choose another name, or delete it</source>
            <translation>{file} はすでにあります。別の名前を選ぶか、削除してください</translation>
        </message>
        <message>
            <source>another recording into {file} is running; choose another name</source>
            <translation>{file} への別の録音が進行中です。別の名前を選んでください</translation>
        </message>
        <message>
            <source>{journal} is there already: a recording was not finished; write it with 'suisou record --rescue --to {file}'</source>
            <translation>{journal} がすでにあります。終了していない録音です。「suisou record --rescue --to {file}」で書き出してください</translation>
        </message>
        <message>
            <source>{file} cannot be written: {reason}; the recording is kept in {journal}: make room, then write it with 'suisou record --rescue --to {file}'</source>
            <translation>{file} に書き込めません: {reason}。録音は {journal} に残っています。空き容量を作ってから「suisou record --rescue --to {file}」で書き出してください</translation>
        </message>
        <message>
            <source>nothing was heard from {port}: no file was written</source>
            <translation>{port} から何も受信しませんでした。ファイルは書き出していません</translation>
        </message>
        <message>
            <source>{file} is there already: another recording is running, or one was not finished</source>
            <translation>{file} はすでにあります。別の録音が進行中か、終了していない録音が残っています</translation>
        </message>
        <message>
            <source>{file} is no journal of a take: its first line does not say what it is</source>
            <translation>{file} はテイクのジャーナルではありません。1行目に内容を示す記述がありません</translation>
        </message>
        <message>
            <source>{file} was written by a newer version of the program (journal {version}); use that one</source>
            <translation>{file} は新しいバージョンのプログラムで書かれています (ジャーナル {version})。そのバージョンをお使いください</translation>
        </message>
        <message>
            <source>{file}, line {line}: {detail}</source>
            <translation>{file}、{line} 行目: {detail}</translation>
        </message>
        <message>
            <source>the choreography has no source {source}; --prefer one of {sources}</source>
            <translation>振り付けにソース {source} はありません。--prefer には次のいずれかを指定してください: {sources}</translation>
        </message>
        <message>
            <source>{file} is not a choreography file or is damaged ({place}: {detail}); copy it again from where it is whole, or learn it again with 'suisou choreography learn'</source>
            <translation>{file} は振り付けのファイルではないか、破損しています（{place}: {detail}）。破損していない元のファイルをコピーし直すか、'suisou choreography learn' で学習し直してください</translation>
        </message>
        <message>
            <source>{file} was written by a newer version of the program (its file version is {version}, this program knows up to {known}); use the newer version</source>
            <translation>{file} はより新しいバージョンのプログラムで書き出されています（ファイルのバージョンは {version}、このプログラムが対応するのは {known} まで）。新しいバージョンを使ってください</translation>
        </message>
        <message>
            <source>{file}, line {line}: {text!r} is no time; write one time in seconds in each line</source>
            <translation>{file} の {line} 行目: {text!r} は時刻ではありません。1 行に 1 つ、秒で時刻を書いてください</translation>
        </message>
        <message>
            <source>{file}, line {line}: a motion needs a time at which it starts and a later one at which it ends; put the times in order</source>
            <translation>{file} の {line} 行目: 動きには始まりの時刻と、それより後の終わりの時刻が必要です。時刻を順に並べてください</translation>
        </message>
        <message>
            <source>{motion} cannot be cut into a motion from frame {start} to {end} with its accent at {accent}: cuts have to be in order, with their accents between them, within the {frames} frames of the motion</source>
            <translation>{motion} は、フレーム {start} から {end}、アクセント {accent} の動きに区切れません。区切りは順に並び、アクセントがその間にあり、動きの {frames} フレームに収まっている必要があります</translation>
        </message>
        <message>
            <source>the piece has no percussion: dancers take their rhythm from its melody, its bass and its accents</source>
            <translation>曲に打楽器がないため、ダンサーはメロディ、低音、アクセントからリズムを取ります</translation>
        </message>
        <message>
            <source>basic motion {number} is not danced here although it is pinned: the choreography does not have it, or another correction is too near; unpin it or pin another one</source>
            <translation>固定された基本動作 {number} を、ここでは踊れません。振り付けにこの基本動作がないか、別の修正が近すぎます。固定を解除するか、別の基本動作を固定してください</translation>
        </message>
        <message>
            <source>segment {number} is not danced here although it is selected: the choreography does not have it, or another correction is too near; unpin it or select another one</source>
            <translation>選択されたセグメント {number} を、ここでは踊れません。振り付けにこのセグメントがないか、別の修正が近すぎます。固定を解除するか、別のセグメントを選んでください</translation>
        </message>
        <message>
            <source>basic motion {number} is danced here although it is forbidden: nothing else fits; forbid fewer basic motions, or for a shorter time</source>
            <translation>禁止された基本動作 {number} が、ここで踊られています。ほかに合う動作がありません。禁止する基本動作を減らすか、区間を短くしてください</translation>
        </message>
        <message>
            <source>the change from basic motion {before} to {after} can be seen: pin another motion here, or move this one</source>
            <translation>基本動作 {before} から {after} への切り替わりが目立ちます。ここに別の動作を固定するか、この動作を移動してください</translation>
        </message>
        <message>
            <source>the {side} foot slides over the floor while it stands: pin another motion here, or move this one</source>
            <translation>{side}足が接地しているあいだに床の上を滑ります。ここに別の動作を固定するか、この動作を移動してください</translation>
        </message>
        <message>
            <source>there is no motion to learn from in {motions}: the body is still, or the clips are too short</source>
            <translation>{motions} には学習できる動きがありません。体が静止しているか、クリップが短すぎます</translation>
        </message>
        <message>
            <source>{states} basic motions cannot be learned from {segments} motions; ask for fewer states</source>
            <translation>{segments} 個の動きから {states} 個の基本動作は学習できません。状態の数を小さくしてください</translation>
        </message>
        <message>
            <source>no percussion of {music} sounds during the motions of {motion}; correct the offset of this pair, or leave it to be found</source>
            <translation>{motion} の動きの間に {music} の打楽器が鳴りません。この組のオフセットを修正するか、自動で検出させてください</translation>
        </message>
        <message>
            <source>{file}: {states} basic {states:motion|motions} (states) of {segments} {segments:segment|segments}, {length_s:.1f} s ({frames} {frames:frame|frames})</source>
            <translation>{file}: 基本動作（状態） {states} 個、セグメント {segments} 個、{length_s:.1f} 秒（{frames} フレーム）</translation>
        </message>
        <message>
            <source>{file} has no percussion to learn from (notes on channel 10); pair the motion with a file that has a drum part</source>
            <translation>{file} には学習に使う打楽器（チャンネル 10 のノート）がありません。ドラムパートのあるファイルと組み合わせてください</translation>
        </message>
        <message>
            <source>arms up to {apart_mm} mm from their place in the file: its collars move</source>
            <translation>腕がファイルでの位置から最大 {apart_mm} mm ずれています（鎖骨が動くため）</translation>
        </message>
        <message>
            <source>joints that are guessed: {joints}</source>
            <translation>推定した関節: {joints}</translation>
        </message>
        <message>
            <source>{n} {n:flip|flips} of the capture mended</source>
            <translation>キャプチャの反転を {n} 箇所修復しました</translation>
        </message>
        <message>
            <source>{n} {n:frame|frames} of a rest pose at its start left out</source>
            <translation>先頭のレストポーズ {n} フレームを除きました</translation>
        </message>
        <message>
            <source>its unit is not known: the body is made 1.7 m high</source>
            <translation>単位が不明のため、身長を 1.7 m にしました</translation>
        </message>
        <message>
            <source>{rate} frames/s (its file says {said})</source>
            <translation>{rate} フレーム/秒（ファイルの値は {said}）</translation>
        </message>
        <message>
            <source>settings of the piece</source>
            <translation>曲の設定</translation>
        </message>
        <message>
            <source>estimated offset of the recording</source>
            <translation>録音のオフセットの推定</translation>
        </message>
        <message>
            <source>offset and tempo fitted to the recording</source>
            <translation>オフセットとテンポを録音に合わせる</translation>
        </message>
        <message>
            <source>remove the recording</source>
            <translation>録音を外す</translation>
        </message>
        <message>
            <source>another recording</source>
            <translation>録音の変更</translation>
        </message>
        <message>
            <source>move {count} {count:event|events}</source>
            <translation>{count} 個のイベントを移動</translation>
        </message>
        <message>
            <source>resize {count} {count:event|events}</source>
            <translation>{count} 個のイベントの長さを変更</translation>
        </message>
        <message>
            <source>change how much of {count} {count:event|events}</source>
            <translation>{count} 個のイベントの量を変更</translation>
        </message>
        <message>
            <source>change fades</source>
            <translation>フェードを変更</translation>
        </message>
        <message>
            <source>change the expression</source>
            <translation>表情を変更</translation>
        </message>
        <message>
            <source>change the embouchure of {count} {count:note|notes}</source>
            <translation>{count} 音のアンブシュアを変更</translation>
        </message>
        <message>
            <source>fingering of {count} {count:note|notes}</source>
            <translation>{count} 音の運指</translation>
        </message>
        <message>
            <source>add a breath</source>
            <translation>ブレスを追加</translation>
        </message>
        <message>
            <source>add a cue</source>
            <translation>合図を追加</translation>
        </message>
        <message>
            <source>add a gesture</source>
            <translation>ジェスチャーを追加</translation>
        </message>
        <message>
            <source>add an expression</source>
            <translation>表情を追加</translation>
        </message>
        <message>
            <source>preparation on or off</source>
            <translation>準備動作の切り替え</translation>
        </message>
        <message>
            <source>delete {count} {count:event|events}</source>
            <translation>{count} 個のイベントを削除</translation>
        </message>
        <message>
            <source>back to the generator's</source>
            <translation>自動生成に戻す</translation>
        </message>
        <message>
            <source>face of {expression}</source>
            <translation>{expression}の顔を変更</translation>
        </message>
        <message>
            <source>an expression made from {expression}</source>
            <translation>{expression}から表情を作成</translation>
        </message>
        <message>
            <source>rename an expression</source>
            <translation>表情の名前を変更</translation>
        </message>
        <message>
            <source>remove {expression}</source>
            <translation>{expression}を削除</translation>
        </message>
        <message>
            <source>{name} is kept for other projects</source>
            <translation>{name}を他のプロジェクト用に保存しました</translation>
        </message>
        <message>
            <source>re-attach a correction</source>
            <translation>修正を付け直す</translation>
        </message>
        <message>
            <source>revert all corrections of {player}</source>
            <translation>{player} の修正をすべて取り消す</translation>
        </message>
        <message>
            <source>offset of the recording</source>
            <translation>録音のオフセット</translation>
        </message>
        <message>
            <source>there is no note after this place to breathe for</source>
            <translation>この位置より後に、ブレスの対象となる音符がありません</translation>
        </message>
        <message>
            <source>{label} is no fingering of this note; there are: {known}</source>
            <translation>{label} はこの音の運指ではありません。使えるもの: {known}</translation>
        </message>
        <message>
            <source>there are no problems</source>
            <translation>問題はありません</translation>
        </message>
        <message>
            <source>there is no note after this place to give a cue to</source>
            <translation>この位置より後に、合図を出す音符がありません</translation>
        </message>
        <message>
            <source>another performance by everyone</source>
            <translation>全員の演奏を作り直す</translation>
        </message>
        <message>
            <source>another performance by players: {count}</source>
            <translation>{count} 人の演奏を作り直す</translation>
        </message>
        <message>
            <source>another performance of some bars</source>
            <translation>一部の小節の演奏を作り直す</translation>
        </message>
        <message>
            <source>some bars as at first</source>
            <translation>一部の小節を最初の演奏に戻す</translation>
        </message>
        <message>
            <source>performed anew; corrections kept: {kept}</source>
            <translation>演奏を作り直しました。残した修正: {kept} 件</translation>
        </message>
        <message>
            <source>performed anew; corrections kept: {kept}; without a place now, kept all the same: {lost}</source>
            <translation>演奏を作り直しました。残した修正: {kept} 件。対象を失ったものの残してある修正: {lost} 件</translation>
        </message>
        <message>
            <source>hold the bell differently</source>
            <translation>ベルの構えを変更</translation>
        </message>
        <message>
            <source>hold the head differently</source>
            <translation>頭の構えを変更</translation>
        </message>
        <message>
            <source>hold the left elbow differently</source>
            <translation>左ひじの構えを変更</translation>
        </message>
        <message>
            <source>hold the right elbow differently</source>
            <translation>右ひじの構えを変更</translation>
        </message>
        <message>
            <source>hold the torso differently</source>
            <translation>胴の構えを変更</translation>
        </message>
        <message>
            <source>pose back to the generator's</source>
            <translation>ポーズを自動生成に戻す</translation>
        </message>
        <message>
            <source>{dancer} dances basic motion {number}</source>
            <translation>{dancer}に基本動作{number}を踊らせる</translation>
        </message>
        <message>
            <source>{dancer} dances another segment</source>
            <translation>{dancer}に別の区間を踊らせる</translation>
        </message>
        <message>
            <source>move a motion of {dancer}</source>
            <translation>{dancer}の動作を移動</translation>
        </message>
        <message>
            <source>{dancer} does not dance basic motion {number}</source>
            <translation>{dancer}に基本動作{number}を踊らせない</translation>
        </message>
        <message>
            <source>dance of {dancer} back to the generator's</source>
            <translation>{dancer}の踊りを自動生成に戻す</translation>
        </message>
        <message>
            <source>add a dancer</source>
            <translation>ダンサーを追加</translation>
        </message>
        <message>
            <source>duplicate {dancer}</source>
            <translation>{dancer} を複製</translation>
        </message>
        <message>
            <source>remove {dancer}</source>
            <translation>{dancer} を削除</translation>
        </message>
        <message>
            <source>rename {dancer}</source>
            <translation>{dancer} の名前を変更</translation>
        </message>
        <message>
            <source>order of the dancers</source>
            <translation>ダンサーの順番</translation>
        </message>
        <message>
            <source>choreography of {dancer}</source>
            <translation>{dancer} の振り付け</translation>
        </message>
        <message>
            <source>character of {dancer}</source>
            <translation>{dancer} のキャラクター</translation>
        </message>
        <message>
            <source>{parameter} of {dancer}</source>
            <translation>{dancer} の{parameter}</translation>
        </message>
        <message>
            <source>mirror {dancer}</source>
            <translation>{dancer} を左右反転</translation>
        </message>
        <message>
            <source>place {dancer} on the stage</source>
            <translation>{dancer} をステージに配置</translation>
        </message>
        <message>
            <source>rename {player}</source>
            <translation>{player} の名前を変更</translation>
        </message>
        <message>
            <source>add {player}</source>
            <translation>{player} を追加</translation>
        </message>
        <message>
            <source>duplicate players: {count}</source>
            <translation>プレイヤーを複製: {count} 人</translation>
        </message>
        <message>
            <source>remove players: {count}</source>
            <translation>プレイヤーを削除: {count} 人</translation>
        </message>
        <message>
            <source>one person plays instruments: {count}</source>
            <translation>一人で持ち替え: {count}</translation>
        </message>
        <message>
            <source>separate players: {count}</source>
            <translation>プレイヤーを分ける: {count}</translation>
        </message>
        <message>
            <source>order of the players</source>
            <translation>プレイヤーの順番</translation>
        </message>
        <message>
            <source>mute players: {count}</source>
            <translation>ミュート: {count} 人</translation>
        </message>
        <message>
            <source>unmute players: {count}</source>
            <translation>ミュート解除: {count} 人</translation>
        </message>
        <message>
            <source>solo players: {count}</source>
            <translation>ソロ: {count} 人</translation>
        </message>
        <message>
            <source>end of solo for players: {count}</source>
            <translation>ソロ解除: {count} 人</translation>
        </message>
        <message>
            <source>another part for players: {count}</source>
            <translation>パートを変更: {count} 人</translation>
        </message>
        <message>
            <source>another instrument for players: {count}</source>
            <translation>楽器を変更: {count} 人</translation>
        </message>
        <message>
            <source>another character for players: {count}</source>
            <translation>キャラクターを変更: {count} 人</translation>
        </message>
        <message>
            <source>colour of players: {count}</source>
            <translation>プレイヤーの色: {count} 人</translation>
        </message>
        <message>
            <source>{parameter}, players: {count}</source>
            <translation>{parameter}: {count} 人</translation>
        </message>
        <message>
            <source>reset players: {count}</source>
            <translation>プレイヤーをリセット: {count} 人</translation>
        </message>
        <message>
            <source>randomise players: {count}</source>
            <translation>ランダム化: {count} 人</translation>
        </message>
        <message>
            <source>place players: {count}</source>
            <translation>ステージでの配置: {count} 人</translation>
        </message>
        <message>
            <source>automatic arc</source>
            <translation>自動で弧に並べる</translation>
        </message>
        <message>
            <source>preset {preset} for players: {count}</source>
            <translation>プリセット {preset}: {count} 人</translation>
        </message>
        <message>
            <source>the preset {name} is saved</source>
            <translation>プリセット {name} を保存しました</translation>
        </message>
        <message>
            <source>{player} and {other} are not played in one posture, so that one person cannot play both</source>
            <translation>{player}と{other}は同じ姿勢で演奏できないため、一人では持ち替えられません</translation>
        </message>
        <message>
            <source>{player} and {other} sound at once for {seconds:g} s, so that one person cannot play both</source>
            <translation>{player}と{other}は合わせて{seconds:g}秒同時に鳴るため、一人では持ち替えられません</translation>
        </message>
        <message>
            <source>a project can have {most} players</source>
            <translation>1 つのプロジェクトに置けるプレイヤーは {most} 人までです</translation>
        </message>
        <message>
            <source>a name must have at least one sign that can be seen</source>
            <translation>名前には、目に見える文字が 1 つ以上必要です</translation>
        </message>
        <message>
            <source>a project can have {most} dancers</source>
            <translation>1 つのプロジェクトに置けるダンサーは {most} 人までです</translation>
        </message>
        <message>
            <source>{file} is neither a choreography file (.choreography) nor a choreography that comes with the program; choose one of these</source>
            <translation>{file} は、振り付けのファイル（.choreography）でも、プログラムに付属する振り付けでもありません。そのいずれかを選んでください</translation>
        </message>
        <message>
            <source>re-import the MIDI file</source>
            <translation>MIDI ファイルの再読み込み</translation>
        </message>
        <message>
            <source>{file} cannot be read: {reason}</source>
            <translation>{file} を読み込めません: {reason}</translation>
        </message>
        <message>
            <source>{file} cannot be written: {reason}</source>
            <translation>{file} に書き込めません: {reason}</translation>
        </message>
        <message>
            <source>{file} is not a file but a folder, a pipe or a device; choose a file</source>
            <translation>{file} はファイルではなく、フォルダー、パイプまたはデバイスです。ファイルを選んでください</translation>
        </message>
        <message>
            <source>{file} is too large ({size_mb} MB; at most {most_mb} MB are read); choose a smaller file</source>
            <translation>{file} は大きすぎます ({size_mb} MB。読み込めるのは {most_mb} MB まで)。もっと小さいファイルを選んでください</translation>
        </message>
        <message>
            <source>{file} is damaged: {detail}</source>
            <translation>{file} は壊れています: {detail}</translation>
        </message>
        <message>
            <source>{file}: {place}: {detail}; the default is used</source>
            <translation>{file}: {place}: {detail}。既定値を使います</translation>
        </message>
        <message>
            <source>{file} cannot be used: settings changed now last only until the editor ends; correct the file or remove it</source>
            <translation>{file} を使えません。いま変更した設定はエディターを終了するまでしか保たれません。ファイルを修正するか削除してください</translation>
        </message>
        <message>
            <source>files written to {folder}: {count}</source>
            <translation>{folder} に書き出したファイル: {count}</translation>
        </message>
        <message>
            <source>the film is written: {file}</source>
            <translation>動画を書き出しました: {file}</translation>
        </message>
        <message>
            <source>{file} cannot be written as a film: {detail}</source>
            <translation>{file} に動画を書き出せません: {detail}</translation>
        </message>
        <message>
            <source>{file} is not a binary FBX file</source>
            <translation>{file} はバイナリー形式の FBX ファイルではありません</translation>
        </message>
        <message>
            <source>{file} ends in the middle of a record (byte {offset})</source>
            <translation>{file} がレコードの途中で終わっています（バイト {offset}）</translation>
        </message>
        <message>
            <source>{file}: the record at byte {offset} does not fit into its surroundings</source>
            <translation>{file}: バイト {offset} のレコードが前後と整合しません</translation>
        </message>
        <message>
            <source>{file}: the property at byte {offset} is of an unknown kind or too long for its record</source>
            <translation>{file}: バイト {offset} のプロパティーは種類が不明か、レコードに対して長すぎます</translation>
        </message>
        <message>
            <source>{file}: the array at byte {offset} is damaged</source>
            <translation>{file}: バイト {offset} の配列が壊れています</translation>
        </message>
        <message>
            <source>{file}: the records at byte {offset} are nested too deeply</source>
            <translation>{file}: バイト {offset} のレコードの入れ子が深すぎます</translation>
        </message>
        <message>
            <source>{file} has no {what}</source>
            <translation>{file} に {what} がありません</translation>
        </message>
        <message>
            <source>{file}: {what} is not supported</source>
            <translation>{file}: {what} には対応していません</translation>
        </message>
        <message>
            <source>{file} is not an FBX file</source>
            <translation>{file} は FBX ファイルではありません</translation>
        </message>
        <message>
            <source>{file} is damaged ({detail}); export it again</source>
            <translation>{file} は壊れています（{detail}）。もう一度書き出してください</translation>
        </message>
        <message>
            <source>{file} describes far more data than a file of its size holds; export the character alone</source>
            <translation>{file} の内容がファイルのサイズに対して大きすぎます。キャラクターだけを書き出してください</translation>
        </message>
        <message>
            <source>{file} contradicts itself: {detail}</source>
            <translation>{file} の内容が矛盾しています: {detail}</translation>
        </message>
        <message>
            <source>{file}, line {line}: {found} does not belong here</source>
            <translation>{file}、{line} 行目: ここに {found} は置けません</translation>
        </message>
        <message>
            <source>{file} ends too early</source>
            <translation>{file} が途中で終わっています</translation>
        </message>
        <message>
            <source>{file}: the motion does not fit the skeleton ({detail})</source>
            <translation>{file}: モーションがスケルトンに合いません（{detail}）</translation>
        </message>
        <message>
            <source>{file} describes far more data than a file of its size holds; export the motion alone</source>
            <translation>{file} の内容がファイルのサイズに対して大きすぎます。モーションだけを書き出してください</translation>
        </message>
        <message>
            <source>{file}, line {line}: {what} is not supported</source>
            <translation>{file}、{line} 行目: {what} には対応していません</translation>
        </message>
        <message>
            <source>{file}: no bone was found for {joints}; only the motion of a whole human body can be read</source>
            <translation>{file}: {joints} のボーンが見つかりません。読み込めるのは人体全身のモーションだけです</translation>
        </message>
        <message>
            <source>{file} is damaged: it has a joint farther away than any body goes; export it again</source>
            <translation>{file} は破損しています。人の体ではありえないほど遠くに関節があります。書き出し直してください</translation>
        </message>
        <message>
            <source>{file} is not a file of motion that can be read; export the motion as BVH, FBX or GLB</source>
            <translation>{file} は読み込めるモーションのファイルではありません。モーションを BVH、FBX または GLB で書き出してください</translation>
        </message>
        <message>
            <source>{file} has no animation; export it with its animation baked</source>
            <translation>{file} にはアニメーションがありません。アニメーションをベイクして書き出してください</translation>
        </message>
        <message>
            <source>{file} has too much motion to be read at once; export it in shorter parts</source>
            <translation>{file} のモーションは一度に読み込むには多すぎます。短く分けて書き出してください</translation>
        </message>
        <message>
            <source>USD files need the package usd-core, which is not installed: pip install usd-core</source>
            <translation>USD ファイルの書き出しにはパッケージ usd-core が必要ですが、インストールされていません: pip install usd-core</translation>
        </message>
        <message>
            <source>add a note</source>
            <translation>音符を追加</translation>
        </message>
        <message>
            <source>erase {count} {count:note|notes}</source>
            <translation>{count} 音を消す</translation>
        </message>
        <message>
            <source>move {count} {count:note|notes}</source>
            <translation>{count} 音を移動</translation>
        </message>
        <message>
            <source>transpose {count} {count:note|notes}</source>
            <translation>{count} 音を移調</translation>
        </message>
        <message>
            <source>nudge {count} {count:note|notes}</source>
            <translation>{count} 音をずらす</translation>
        </message>
        <message>
            <source>length of {count} {count:note|notes}</source>
            <translation>{count} 音の長さ</translation>
        </message>
        <message>
            <source>split {count} {count:note|notes}</source>
            <translation>{count} 音を分割</translation>
        </message>
        <message>
            <source>join {count} {count:note|notes}</source>
            <translation>{count} 音を結合</translation>
        </message>
        <message>
            <source>duplicate {count} {count:note|notes}</source>
            <translation>{count} 音を複製</translation>
        </message>
        <message>
            <source>velocity of {count} {count:note|notes}</source>
            <translation>{count} 音のベロシティー</translation>
        </message>
        <message>
            <source>quantise {count} {count:note|notes}</source>
            <translation>{count} 音をクオンタイズ</translation>
        </message>
        <message>
            <source>cut {count} {count:note|notes}</source>
            <translation>{count} 音を切り取り</translation>
        </message>
        <message>
            <source>paste {count} {count:note|notes}</source>
            <translation>{count} 音を貼り付け</translation>
        </message>
        <message>
            <source>set the tempo</source>
            <translation>テンポを設定</translation>
        </message>
        <message>
            <source>move a tempo</source>
            <translation>テンポを移動</translation>
        </message>
        <message>
            <source>move a metre change</source>
            <translation>拍子記号を移動</translation>
        </message>
        <message>
            <source>remove a tempo</source>
            <translation>テンポを削除</translation>
        </message>
        <message>
            <source>set the felt beat</source>
            <translation>拍の単位を変更</translation>
        </message>
        <message>
            <source>set the metre</source>
            <translation>拍子を設定</translation>
        </message>
        <message>
            <source>remove a metre</source>
            <translation>拍子を削除</translation>
        </message>
        <message>
            <source>A note would begin before the piece.</source>
            <translation>曲の始まりより前に音符が来てしまいます。</translation>
        </message>
        <message>
            <source>A note would end later than any piece can last.</source>
            <translation>扱える曲の長さを超えて音符が続いてしまいます。</translation>
        </message>
        <message>
            <source>There is no pitch {pitch}; pitches go from {low} to {high}.</source>
            <translation>音高 {pitch} はありません。{low} から {high} までです。</translation>
        </message>
        <message>
            <source>There is no velocity {velocity}; velocities go from {low} to {high}.</source>
            <translation>ベロシティー {velocity} はありません。{low} から {high} までです。</translation>
        </message>
        <message>
            <source>A note needs a length of at least one tick.</source>
            <translation>音符には 1 ティック以上の長さが必要です。</translation>
        </message>
        <message>
            <source>No chosen note sounds across this place: there is nothing to split.</source>
            <translation>この位置をまたぐ選択中の音符がないため、分割できません。</translation>
        </message>
        <message>
            <source>To join notes, choose two or more of one pitch that follow one another.</source>
            <translation>結合するには、連続する同じ音高の音符を 2 つ以上選んでください。</translation>
        </message>
        <message>
            <source>There are no notes on the clipboard: copy some first.</source>
            <translation>クリップボードに音符がありません。先にコピーしてください。</translation>
        </message>
        <message>
            <source>There is no player to paste the notes to: add one first.</source>
            <translation>貼り付け先のプレイヤーがいません。先に追加してください。</translation>
        </message>
        <message>
            <source>the players cannot be drawn here, because there is no usable OpenGL 2 ({reason})</source>
            <translation>OpenGL 2 が使えないため、ここではプレイヤーを描画できません（{reason}）</translation>
        </message>
        <message>
            <source>the players are still being loaded; try again in a moment</source>
            <translation>プレイヤーを読み込み中です。少し待ってからもう一度お試しください</translation>
        </message>
        <message>
            <source>the rest of {rest_s:g} s is too short to change from {before} to {after}: about {needed_s:g} s are needed</source>
            <translation>{before}から{after}への持ち替えには休みが{rest_s:g}秒では短すぎます: 約{needed_s:g}秒必要です</translation>
        </message>
        <message>
            <source>{before} still sounds {seconds:g} s into {after}, but one person plays both: the change takes notes away</source>
            <translation>一人で持ち替えますが、{after}の始まりから{seconds:g}秒間まだ{before}が鳴っています: 持ち替えの間の音は演奏できません</translation>
        </message>
        <message>
            <source>{label}: the first choice</source>
            <translation>{label}: 第一候補</translation>
        </message>
        <message>
            <source>{label} instead of {first}: less motion in a trill at {time_ms} ms a note</source>
            <translation>{first} の代わりに {label}: 1 音 {time_ms} ms のトリルで動きが少なくなります</translation>
        </message>
        <message>
            <source>{label} instead of {first}: less motion where a note has {time_ms} ms</source>
            <translation>{first} の代わりに {label}: 1 音が {time_ms} ms のところで動きが少なくなります</translation>
        </message>
        <message>
            <source>{label}: set by hand</source>
            <translation>{label}: 手で指定</translation>
        </message>
        <message>
            <source>note {note}: {pitch} lies outside the range of this instrument, {low} to {high}; shown with the fingering of {played_pitch}</source>
            <translation>音符 {note}：{pitch} はこの楽器の音域 {low}～{high} の外です。{played_pitch} の運指で表示します</translation>
        </message>
        <message>
            <source>the way to {label} takes {needed_ms} ms, but only {available_ms} ms are free before note {note}; it starts earlier</source>
            <translation>{label} への移動には {needed_ms} ms かかりますが、音符 {note} の前には {available_ms} ms しかありません。早めに動き始めます</translation>
        </message>
        <message>
            <source>note {note} is struck together with the higher note {other}: only one can sound, and it is left out</source>
            <translation>音符 {note} は、より高い音符 {other} と同時です。一度に 1 音しか出せないため、省きます</translation>
        </message>
        <message>
            <source>note {note} still sounds for {overlap_ms} ms when {other} begins: it ends there</source>
            <translation>音符 {note} は {other} が始まってからも {overlap_ms} ms 鳴っているため、そこで終わらせます</translation>
        </message>
        <message>
            <source>{label} is out of this player's reach: {control} stops {gap_mm} mm short of it; take another fingering, or a character with longer arms</source>
            <translation>{label} はこの奏者の手が届かず、{control}が {gap_mm} mm 手前で止まります。別の運指か、腕の長いキャラクターにしてください</translation>
        </message>
        <message>
            <source>plays an instrument of {percent} % of its size: so hands and arms reach it</source>
            <translation>手と腕が届くように、{percent} % の大きさの楽器を演奏します</translation>
        </message>
        <message>
            <source>the {side} hand has fingers that do not bend: it lies on the instrument as a whole, and what they would press moves by itself</source>
            <translation>{side}手の指は曲がりません。手全体を楽器に添え、押される部分はひとりでに動きます</translation>
        </message>
        <message>
            <source>the {side} hand has no skin to touch with: it hangs down while the other one plays</source>
            <translation>{side}手には触れる表面がありません。下ろしたまま、もう一方の手で演奏します</translation>
        </message>
        <message>
            <source>the head has no skin to find a mouth on: the instrument is held where lips would be</source>
            <translation>頭に口を見つけられる表面がありません。楽器は唇があるはずの位置に保ちます</translation>
        </message>
        <message>
            <source>the mouth has no morph that opens it: breaths do not show on it, and lips stay shut</source>
            <translation>口を開くモーフがありません。息継ぎは口に表れず、唇は閉じたままです</translation>
        </message>
        <message>
            <source>{character} cannot be made to hold {instrument} ({detail}); correct the instrument's map, or take another character</source>
            <translation>{character} に {instrument} を持たせられません（{detail}）。インストゥルメントマップを直すか、別のキャラクターを選んでください</translation>
        </message>
        <message>
            <source>how the instrument is held is being found out; the player is seen as soon as that is known</source>
            <translation>楽器の持ち方を計算しています。終わり次第、奏者が表示されます</translation>
        </message>
        <message>
            <source>{count} {count:touch does|touches do} not meet this instrument, the {touch} misses by {gap_mm} mm: hands and instrument are of too different sizes or shapes</source>
            <translation>{count} か所の接点がこの楽器に届きません（{touch}が最大 {gap_mm} mm 外れます）。手と楽器の大きさや形が合っていません</translation>
        </message>
        <message>
            <source>the {side} hand comes off the instrument: it stays {gap_mm} mm from its place; lessen the pose correction or the gesture here, or take a character of another size</source>
            <translation>{side}手が楽器から離れています（本来の位置から {gap_mm} mm）。ここのポーズ補正やジェスチャーを弱めるか、体格の違うキャラクターを選んでください</translation>
        </message>
        <message>
            <source>{control} stops {gap_mm} mm short of its place: the {side} hand comes no farther; lessen the pose correction or the gesture here, or take a character with longer arms</source>
            <translation>{side}手がこれ以上届かず、{control}が本来の位置の {gap_mm} mm 手前で止まります。ここのポーズ補正やジェスチャーを弱めるか、腕の長いキャラクターを選んでください</translation>
        </message>
        <message>
            <source>the {touch} misses {control} by {gap_mm} mm; lessen the pose correction here, or take a character of another size</source>
            <translation>{touch}が{control}に {gap_mm} mm 届いていません。ここのポーズ補正を弱めるか、体格の違うキャラクターを選んでください</translation>
        </message>
        <message>
            <source>the {touch} does not touch the instrument: {gap_mm} mm are missing; lessen the pose correction here, or take a character of another size</source>
            <translation>{touch}が楽器に触れていません（{gap_mm} mm 離れています）。ここのポーズ補正を弱めるか、体格の違うキャラクターを選んでください</translation>
        </message>
        <message>
            <source>the lips are {gap_mm} mm off the mouthpiece while a note sounds; move or remove the gesture that lowers the instrument here</source>
            <translation>音が鳴っている間に唇がマウスピースから {gap_mm} mm 離れています。ここで楽器を下ろすジェスチャーを移動するか削除してください</translation>
        </message>
        <message>
            <source>the {side} foot leaves its place on the floor by {gap_mm} mm; lessen sway, weight shift or the pose correction</source>
            <translation>{side}足が床の位置から {gap_mm} mm ずれています。揺れ・体重移動・ポーズ補正のいずれかを弱めてください</translation>
        </message>
        <message>
            <source>the first breath, in the {beats:g} beats before the entry</source>
            <translation>最初のブレス。入りの前の {beats:g} 拍で吸います</translation>
        </message>
        <message>
            <source>a rest of {rest_beats:g} beats (from {min_beats:g} to below {last_beat_beats:g}): the breath takes all of it</source>
            <translation>{rest_beats:g} 拍の休符（{min_beats:g} 以上 {last_beat_beats:g} 未満）: 休符全体でブレスします</translation>
        </message>
        <message>
            <source>heard in the breath: {gap_s:g} s without blowing</source>
            <translation>ブレスの記録から：{gap_s:g} 秒間息が止まっています</translation>
        </message>
        <message>
            <source>heard in the breath: {gap_s:g} s without blowing; getting ready to breathe</source>
            <translation>ブレスの記録から：{gap_s:g} 秒間息が止まっています。ブレスの準備です</translation>
        </message>
        <message>
            <source>heard in the breath: {gap_s:g} s without blowing, taken because air was needed</source>
            <translation>ブレスの記録から：{gap_s:g} 秒間息が止まっています。息が足りないためここで吸います</translation>
        </message>
        <message>
            <source>a rest of {rest_beats:g} beats (from {last_beat_beats:g} to below {prepare_beats:g}): the breath takes its last beat</source>
            <translation>{rest_beats:g} 拍の休符（{last_beat_beats:g} 以上 {prepare_beats:g} 未満）: 最後の拍でブレスします</translation>
        </message>
        <message>
            <source>a rest of {rest_beats:g} beats (from {prepare_beats:g}): prepared, then the last beat</source>
            <translation>{rest_beats:g} 拍の休符（{prepare_beats:g} 以上）: 準備してから最後の拍でブレスします</translation>
        </message>
        <message>
            <source>a rest of {rest_beats:g} beats (from {prepare_beats:g}): getting ready to breathe</source>
            <translation>{rest_beats:g} 拍の休符（{prepare_beats:g} 以上）: ブレスの準備</translation>
        </message>
        <message>
            <source>a catch breath after note {after_note}: {phrase_s:g} s without a breath in a rest need more than the {lung_s:g} s of air there are; {from_note_ms:g} ms come out of that note's tail</source>
            <translation>音符 {after_note} の後の素早いブレス: 休符でブレスしないまま {phrase_s:g} 秒続き、{lung_s:g} 秒分の息では足りません。その音の終わりから {from_note_ms:g} ms を使います</translation>
        </message>
        <message>
            <source>a catch breath instead of note {after_note}, which is left out: {phrase_s:g} s without a breath in a rest need more than the {lung_s:g} s of air there are, and no note is long enough to take it from</source>
            <translation>音符 {after_note} を省いた素早いブレス: 休符でブレスしないまま {phrase_s:g} 秒続き、{lung_s:g} 秒分の息では足りません。息継ぎできる長さの音もありません</translation>
        </message>
        <message>
            <source>a catch breath instead of notes {first_note} and {after_note}, which are left out: {phrase_s:g} s without a breath in a rest need more than the {lung_s:g} s of air there are, and no note is long enough to take it from</source>
            <translation>音符 {first_note} と {after_note} を省いた素早いブレス: 休符でブレスしないまま {phrase_s:g} 秒続き、{lung_s:g} 秒分の息では足りません。息継ぎできる長さの音もありません</translation>
        </message>
        <message>
            <source>a breath within a note that others of the line hold on: it takes {air_s:g} s of air, and there are {lung_s:g}</source>
            <translation>同じ声部の他の奏者がのばしている音の途中のブレス: {air_s:g} 秒分の息が要りますが、{lung_s:g} 秒分しかありません</translation>
        </message>
        <message>
            <source>from note {note} on, {phrase_s:g} s must be played on one breath; it takes {air_s:g} s of air, and there are {lung_s:g}</source>
            <translation>音符 {note} から {phrase_s:g} 秒をひと息で吹く必要があります。{air_s:g} 秒分の息が要りますが、{lung_s:g} 秒分しかありません</translation>
        </message>
        <message>
            <source>this breath, placed by hand, lies inside the sounding note {note}</source>
            <translation>手で置いたこのブレスは、鳴っている音符 {note} の途中にあります</translation>
        </message>
        <message>
            <source>starts the piece ({leader_reason}); the preparatory beat lasts {beat_s:g} s</source>
            <translation>曲を始める合図（{leader_reason}）。予備拍は {beat_s:g} 秒です</translation>
        </message>
        <message>
            <source>brings everyone in after a general pause of {rest_s:g} s ({leader_reason}); the preparatory beat lasts {beat_s:g} s</source>
            <translation>{rest_s:g} 秒のゲネラルパウゼの後に全員を入れる合図（{leader_reason}）。予備拍は {beat_s:g} 秒です</translation>
        </message>
        <message>
            <source>goes on after a fermata ({leader_reason}); the preparatory beat lasts {beat_s:g} s</source>
            <translation>フェルマータの後を続ける合図（{leader_reason}）。予備拍は {beat_s:g} 秒です</translation>
        </message>
        <message>
            <source>gives the new tempo of {bpm:g} beats a minute ({leader_reason}); the preparatory beat lasts {beat_s:g} s</source>
            <translation>1 分に {bpm:g} 拍の新しいテンポを示す合図（{leader_reason}）。予備拍は {beat_s:g} 秒です</translation>
        </message>
        <message>
            <source>brings in {count} {count:player|players} after {rest_s:g} s of rest, while others play ({leader_reason}); the preparatory beat lasts {beat_s:g} s</source>
            <translation>ほかの奏者の演奏中、{rest_s:g} 秒休んだ奏者 {count} 人を入れる合図（{leader_reason}）。予備拍は {beat_s:g} 秒です</translation>
        </message>
        <message>
            <source>comes in after {rest_s:g} s of rest, while others play; the preparatory beat lasts {beat_s:g} s</source>
            <translation>ほかの奏者の演奏中、{rest_s:g} 秒休んだ後に入る合図。予備拍は {beat_s:g} 秒です</translation>
        </message>
        <message>
            <source>brings everyone in after {rest_s:g} s of common rest ({leader_reason}); the preparatory beat lasts {beat_s:g} s</source>
            <translation>{rest_s:g} 秒の全休の後に全員を入れる合図（{leader_reason}）。予備拍は {beat_s:g} 秒です</translation>
        </message>
        <message>
            <source>half a swing in {beats:g} beats of {beat_s:g} s</source>
            <translation>{beat_s:g} 秒の拍 {beats:g} つで半往復の揺れ</translation>
        </message>
        <message>
            <source>a shift of weight to the {side} foot</source>
            <translation>{side} の足への重心移動</translation>
        </message>
        <message>
            <source>the melody is around {pitch}; the line's mean is {mean_pitch}</source>
            <translation>旋律は {pitch} のあたり。パートの平均は {mean_pitch}</translation>
        </message>
        <message>
            <source>an accent, {more:g} louder than the notes around it</source>
            <translation>アクセント：前後の音より {more:g} 大きく演奏されます</translation>
        </message>
        <message>
            <source>{rest_s:g} s of rest: the instrument comes down and is up again before the entry</source>
            <translation>{rest_s:g} 秒の休み: 楽器を下ろし、入りの前に構え直します</translation>
        </message>
        <message>
            <source>{after_s:g} s after the last note the instrument comes down</source>
            <translation>最後の音から {after_s:g} 秒後に楽器を下ろします</translation>
        </message>
        <message>
            <source>the entry is {rest_s:g} s away: the instrument is still down</source>
            <translation>入りまで {rest_s:g} 秒あるため、楽器はまだ下ろしています</translation>
        </message>
        <message>
            <source>{pitch} in a range of {low} to {high}, loudness {loudness:g}</source>
            <translation>音域 {low}～{high} の中の {pitch}、音量 {loudness:g}</translation>
        </message>
        <message>
            <source>{pitch} in a range of {low} to {high}; heard in the breath: loudness {loudness:g} on average</source>
            <translation>{pitch}（音域 {low}～{high}）、ブレスの記録から：音量は平均 {loudness:g}</translation>
        </message>
        <message>
            <source>the face at rest</source>
            <translation>力を抜いた顔</translation>
        </message>
        <message>
            <source>effort {effort:g} (from {threshold:g}): high, loud or long</source>
            <translation>負担 {effort:g}（{threshold:g} 以上）: 高い・強い・長い音</translation>
        </message>
        <message>
            <source>{pitch} lies below {easy_low} and is loud ({loudness:g})</source>
            <translation>{pitch} は {easy_low} より低く、強い音です（{loudness:g}）</translation>
        </message>
        <message>
            <source>gives the entry</source>
            <translation>入りの合図を出す</translation>
        </message>
        <message>
            <source>comes in after {rest_s:g} s of rest</source>
            <translation>{rest_s:g} 秒の休みの後に入る</translation>
        </message>
        <message>
            <source>the last note is over: a bright end, in major, {bpm:g} beats a minute and not soft</source>
            <translation>最後の音が終わりました：長調、1 分に {bpm:g} 拍、弱くない明るい終わり</translation>
        </message>
        <message>
            <source>set by hand</source>
            <translation>手で指定</translation>
        </message>
        <message>
            <source>the correction ({kind}) for {anchor} has lost its place: it is kept, but does nothing</source>
            <translation>{anchor} への修正（{kind}）は対象を失いました。残してありますが、効果はありません</translation>
        </message>
        <message>
            <source>there is no expression {name!r}; there are: {known}</source>
            <translation>表情 {name!r} はありません。使えるもの: {known}</translation>
        </message>
        <message>
            <source>the correction ({kind}) for {anchor} ends before it begins: it is kept, but does nothing</source>
            <translation>{anchor} への修正（{kind}）は、始まる前に終わっています。残してありますが、効果はありません</translation>
        </message>
        <message>
            <source>the {target} was to be held {asked_deg:g} degrees ({angle}), but a body or the instrument's hold goes no further than {most_deg:g}</source>
            <translation>{target} を {asked_deg:g} 度（{angle}）にする指定ですが、体や楽器の構えの限度は {most_deg:g} 度です</translation>
        </message>
        <message>
            <source>{label} is not a fingering of note {note} on this instrument; the search chose</source>
            <translation>{label} はこの楽器での音符 {note} の運指ではないため、自動で選びました</translation>
        </message>
        <message>
            <source>{file} is no project file or is damaged: {detail}; the version before it was last saved may be beside it, with .bak at the end of its name</source>
            <translation>{file} はプロジェクトファイルではないか、壊れています: {detail}。前回保存する前のものが、名前の末尾に .bak を付けて隣にあるかもしれません</translation>
        </message>
        <message>
            <source>{file} cannot be opened: {place}: {detail}; put it right there in a text editor, or open the version before it was last saved, which has .bak at the end of its name</source>
            <translation>{file} を開けません: {place}: {detail}。テキストエディターでその箇所を直すか、名前の末尾が .bak の前回保存前のものを開いてください</translation>
        </message>
        <message>
            <source>{file} was saved by a newer version of the program (its file version is {version}, this program knows up to {known}); open it with the newer version</source>
            <translation>{file} はより新しいバージョンで保存されています（ファイルのバージョン {version}、対応は {known} まで）。新しいバージョンで開いてください</translation>
        </message>
        <message>
            <source>{file} was not saved, it could not be opened again: {place}: {detail}; undo the last edit, then save</source>
            <translation>{file} は保存されませんでした。そのままでは開けなくなります: {place}: {detail}。直前の編集を元に戻してから保存してください</translation>
        </message>
        <message>
            <source>{file} is write-protected; save it under another name or allow writing</source>
            <translation>{file} は書き込み禁止です。別の名前で保存するか、書き込みを許可してください</translation>
        </message>
        <message>
            <source>{file} is open in another window too; what is saved here and there replaces each other</source>
            <translation>{file}は別のウィンドウでも開かれています。両方で保存すると互いに上書きされます</translation>
        </message>
        <message>
            <source>--written says how the pitches of a MIDI file are read; {file} is a project, whose notes are transposed in the editor</source>
            <translation>--written は MIDI ファイルの音高の読み方を指定します。{file} はプロジェクトで、音符の移調はエディターで行えます</translation>
        </message>
        <message>
            <source>--assign gives instruments to the parts of a MIDI file; {file} is a project; there use --set 'PLAYER.instrument=ID'</source>
            <translation>--assign は MIDI ファイルのパートに楽器を割り当てます。{file} はプロジェクトです。--set 'PLAYER.instrument=ID' を使ってください</translation>
        </message>
        <message>
            <source>--assign: {assignment!r} is not PART=INSTRUMENT, for instance 'Lead=trumpet_Bb'</source>
            <translation>--assign: {assignment!r} は「パート=楽器」の形ではありません（例: 'Lead=trumpet_Bb'）</translation>
        </message>
        <message>
            <source>there is no instrument {instrument!r}; there are: {possible}</source>
            <translation>楽器 {instrument!r} はありません。使える楽器: {possible}</translation>
        </message>
        <message>
            <source>{reason} with --assign '{part}=INSTRUMENT'</source>
            <translation>{reason}。--assign '{part}=INSTRUMENT' で指定できます</translation>
        </message>
        <message>
            <source>--encoding says how the texts of a MIDI file are read; {file} is a project and needs none</source>
            <translation>--encoding は MIDI ファイルの文字の読み方を指定するものです。{file} はプロジェクトなので不要です</translation>
        </message>
        <message>
            <source>{file} cannot be autosaved in its own folder ({reason}); for now it is autosaved in {folder} and offered from there after a crash. Free some space or allow writing, or save the project in another folder</source>
            <translation>{file} は、そのフォルダーに自動保存できません（{reason}）。当面は {folder} に自動保存され、異常終了後はそこから復元を提案します。空き容量を増やすか書き込みを許可するか、プロジェクトを別のフォルダーに保存してください</translation>
        </message>
        <message>
            <source>unsaved work is at risk: {file} can be autosaved neither in its own folder ({reason}) nor in {folder} ({folder_reason}); save the project in another folder now</source>
            <translation>未保存の作業が失われる恐れがあります。{file} は、そのフォルダー（{reason}）にも {folder}（{folder_reason}）にも自動保存できません。すぐにプロジェクトを別のフォルダーに保存してください</translation>
        </message>
        <message>
            <source>unsaved work is at risk: it cannot be autosaved in {folder} ({reason}); save the project in another folder now</source>
            <translation>未保存の作業が失われる恐れがあります。{folder} に自動保存できません（{reason}）。すぐにプロジェクトを別のフォルダーに保存してください</translation>
        </message>
        <message>
            <source>{file} cannot be written ({reason}): new pieces are not autosaved until they are saved to a file, and unsaved work is offered only when its file is opened; allow writing there or free some space</source>
            <translation>{file} に書き込めません（{reason}）。新しい曲はファイルに保存するまで自動保存されず、未保存の作業はそのファイルを開いたときにだけ復元を提案します。書き込みを許可するか、空き容量を増やしてください</translation>
        </message>
        <message>
            <source>{player} plays the instrument {id!r}, which is not installed; choose another one or install it</source>
            <translation>{player} の楽器 {id!r} が入っていません。別の楽器を選ぶか、追加してください</translation>
        </message>
        <message>
            <source>{player} is the character {id!r}, which is not installed; choose another one or install it</source>
            <translation>{player} のキャラクター {id!r} が入っていません。別のキャラクターを選ぶか、追加してください</translation>
        </message>
        <message>
            <source>{dancer} dances the choreography {name!r}, which does not come with this version of the program; choose a choreography file or one of: {known}</source>
            <translation>{dancer} の振り付け {name!r} は、このバージョンには付属していません。振り付けのファイルか、次のいずれかを選んでください: {known}</translation>
        </message>
        <message>
            <source>{dancer} dances the choreography {file}, which is not there; put the file back or choose another choreography</source>
            <translation>{dancer} の振り付け {file} が見つかりません。ファイルを元の場所に戻すか、別の振り付けを選んでください</translation>
        </message>
        <message>
            <source>a remark of another version of the program ({remark})</source>
            <translation>別のバージョンのプログラムによる注記（{remark}）</translation>
        </message>
        <message>
            <source>a tempo must be from {low:g} to {high:g} quarters per minute</source>
            <translation>テンポは毎分 {low:g} から {high:g} 四分音符までです</translation>
        </message>
        <message>
            <source>what holds from the beginning can be changed, but neither moved nor removed</source>
            <translation>曲頭のものは変更できますが、移動や削除はできません</translation>
        </message>
        <message>
            <source>no tempo begins at tick {tick}</source>
            <translation>ティック {tick} から始まるテンポはありません</translation>
        </message>
        <message>
            <source>tick {tick} lies outside every piece</source>
            <translation>ティック {tick} は曲の範囲外です</translation>
        </message>
        <message>
            <source>no metre begins at tick {tick}</source>
            <translation>ティック {tick} から始まる拍子はありません</translation>
        </message>
        <message>
            <source>{numerator}/{denominator} is no metre; the lower number must be 1, 2, 4, 8, 16, 32 or 64</source>
            <translation>{numerator}/{denominator} という拍子はありません。分母は 1、2、4、8、16、32、64 のいずれかです</translation>
        </message>
        <message>
            <source>a pickup is shorter than a whole bar: at most {most} ticks</source>
            <translation>弱起は 1 小節より短く、最長 {most} ティックです</translation>
        </message>
        <message>
            <source>no metre can begin within the pickup; change the pickup first</source>
            <translation>弱起の途中から拍子は始められません。先に弱起を変更してください</translation>
        </message>
        <message>
            <source>{what} must be from {low:g} to {high:g}</source>
            <translation>{what} は {low:g} から {high:g} までです</translation>
        </message>
        <message>
            <source>there is no recording that an offset could belong to; choose one first</source>
            <translation>オフセットを付ける録音がありません。先に録音を選んでください</translation>
        </message>
        <message>
            <source>the path {path} cannot be kept in a project; rename the file or move it</source>
            <translation>パス {path} はプロジェクトに保存できません。ファイル名を変えるか、移動してください</translation>
        </message>
        <message>
            <source>the expression {name!r} cannot be kept: {place}: {detail}</source>
            <translation>表情 {name!r} を保存できません: {place}: {detail}</translation>
        </message>
        <message>
            <source>an expression needs a name that can be seen</source>
            <translation>表情には、目に見える名前が必要です</translation>
        </message>
        <message>
            <source>there is an expression {name!r} already; choose another name</source>
            <translation>表情 {name!r} はすでにあります。別の名前にしてください</translation>
        </message>
        <message>
            <source>there is no expression {name!r} of your own in this project</source>
            <translation>このプロジェクトに、自作の表情 {name!r} はありません</translation>
        </message>
        <message>
            <source>the MIDI file is taken in; notes found again: {kept}, corrections without a note: {lost}</source>
            <translation>MIDI ファイルを取り込みました。引き継いだ音符: {kept}、音符のない修正: {lost}</translation>
        </message>
        <message>
            <source>a correction of this kind ({kind}) belongs to no note</source>
            <translation>この種類の修正（{kind}）は音符に付くものではありません</translation>
        </message>
        <message>
            <source>the player does not play the note {note}; choose one of theirs</source>
            <translation>このプレイヤーは音符 {note} を演奏しません。このプレイヤーの音符を選んでください</translation>
        </message>
        <message>
            <source>a preset needs a name that can be seen</source>
            <translation>プリセットには、目に見える名前が必要です</translation>
        </message>
        <message>
            <source>there is no preset {name!r}</source>
            <translation>プリセット {name!r} はありません</translation>
        </message>
        <message>
            <source>record {count} {count:take|takes}</source>
            <translation>テイクを録音 ({count})</translation>
        </message>
        <message>
            <source>There is no player to record: add one first.</source>
            <translation>録音する奏者がいません。先に奏者を追加してください。</translation>
        </message>
        <message>
            <source>No MIDI device is listened to: choose one in Record &gt; Devices.</source>
            <translation>MIDI機器が選ばれていません。「録音 &gt; 機器」で選んでください。</translation>
        </message>
        <message>
            <source>There is nowhere to write a take to: save the project first.</source>
            <translation>テイクの書き込み先がありません。先にプロジェクトを保存してください。</translation>
        </message>
        <message>
            <source>No note was played: nothing was recorded.</source>
            <translation>音が演奏されなかったため、何も録音されませんでした。</translation>
        </message>
        <message>
            <source>The player who was recorded is no longer there; what was played is kept in {file}.</source>
            <translation>録音した奏者はもういません。演奏は{file}に残してあります。</translation>
        </message>
        <message>
            <source>{device} was unplugged; it is listened to again when it comes back.</source>
            <translation>{device}が抜かれました。つなぎ直すと再び使えます。</translation>
        </message>
        <message>
            <source>{device} was unplugged; what was played is kept, and recording goes on when it comes back.</source>
            <translation>{device}が抜かれました。演奏済みの分は残り、つなぎ直すと録音が続きます。</translation>
        </message>
        <message>
            <source>{device} is back.</source>
            <translation>{device}が再びつながりました。</translation>
        </message>
        <message>
            <source>{count} {count:take|takes} of a recording that was cut short {count:was|were} recovered.</source>
            <translation>中断された録音からテイクを{count}個復元しました。</translation>
        </message>
        <message>
            <source>--set {text}: expected PLAYER.parameter=value</source>
            <translation>--set {text}: 「プレイヤー.パラメーター=値」の形で指定してください</translation>
        </message>
        <message>
            <source>--set: there is no player {player!r}; there are: {possible}</source>
            <translation>--set: プレイヤー {player!r} はいません。指定できるもの: {possible}</translation>
        </message>
        <message>
            <source>--set: there is no parameter {parameter!r}; there are: {possible}</source>
            <translation>--set: パラメーター {parameter!r} はありません。指定できるもの: {possible}</translation>
        </message>
        <message>
            <source>--set: {player} plays {instrument}, which is not played {value}; possible: {possible}</source>
            <translation>--set: {player} の楽器 {instrument} は {value} では演奏しません。指定できるもの: {possible}</translation>
        </message>
        <message>
            <source>--set: {parameter} cannot be {value!r}; possible: {possible}</source>
            <translation>--set: {parameter} に {value!r} は指定できません。指定できる値: {possible}</translation>
        </message>
        <message>
            <source>there is no player {player!r}; there are: {possible}</source>
            <translation>プレイヤー {player!r} はいません。指定できるもの: {possible}</translation>
        </message>
        <message>
            <source>there are no bars {first} to {last}; the piece has {lowest} to {highest}</source>
            <translation>{first} から {last} の小節はありません。この曲は {lowest} から {highest} までです</translation>
        </message>
        <message>
            <source>{file}: there is nobody to export; 'suisou inspect' says why each part is not played</source>
            <translation>{file}: 書き出すプレイヤーがいません。演奏されない理由は「suisou inspect」で分かります</translation>
        </message>
        <message>
            <source>{player} is left out: {reason}</source>
            <translation>{player} は除外されました: {reason}</translation>
        </message>
        <message>
            <source>{player} cannot be seen because of a fault of the program: {detail}</source>
            <translation>{player} はプログラムの不具合のため表示できません: {detail}</translation>
        </message>
        <message>
            <source>these players cannot be seen: {players}; the list of problems says why</source>
            <translation>表示できないプレイヤーがいます: {players}。理由は問題の一覧にあります</translation>
        </message>
        <message>
            <source>{file}: none of the players can be seen: {reasons}</source>
            <translation>{file}: 演奏できるプレイヤーがいません: {reasons}</translation>
        </message>
        <message>
            <source>{file}: {frames} frames are more than the {most} that one export holds; take some bars with --from-bar and --to-bar</source>
            <translation>{file}: {frames} フレームは一度に書き出せる {most} を超えています。--from-bar と --to-bar で小節を絞ってください</translation>
        </message>
        <message>
            <source>the piece would last {hours:g} hours, with {quarters} quarter notes and {bars} bars; at most {most_hours} hours, {most_quarters} quarter notes and {most_bars} bars can be played; shorten it</source>
            <translation>曲の長さが {hours:g} 時間（四分音符 {quarters} 個、{bars} 小節）になります。演奏できるのは {most_hours} 時間、四分音符 {most_quarters} 個、{most_bars} 小節までです。短くしてください</translation>
        </message>
        <message>
            <source>{file} is a recording; open the piece that it belongs to first, then drop it again</source>
            <translation>{file} は録音です。先に曲を開いてから、もう一度ドロップしてください</translation>
        </message>
        <message>
            <source>something went wrong in the program: {detail}; your work was written down; please report this with the file {log}</source>
            <translation>プログラムで問題が起きました: {detail}。作業内容は書き留めてあります。ファイル {log} を添えてご報告ください</translation>
        </message>
        <message>
            <source>stopped; nothing was written</source>
            <translation>中止しました。何も書き込んでいません</translation>
        </message>
        <message>
            <source>{file} is empty</source>
            <translation>{file} は空です</translation>
        </message>
        <message>
            <source>{file} is not a MIDI file: byte {byte} has {found} where the header MThd belongs</source>
            <translation>{file} は MIDI ファイルではありません: ヘッダー MThd があるべきバイト {byte} が {found} です</translation>
        </message>
        <message>
            <source>{file} ends within its header, at byte {byte}</source>
            <translation>{file} がヘッダーの途中（バイト {byte}）で終わっています</translation>
        </message>
        <message>
            <source>{file}: the time division at byte {byte} is 0, so the notes have no times</source>
            <translation>{file}: バイト {byte} の分解能が 0 のため、音符の時間が決まりません</translation>
        </message>
        <message>
            <source>{file} has no track: byte {byte} has {found} where a track MTrk belongs</source>
            <translation>{file} にトラックがありません: トラック MTrk があるべきバイト {byte} が {found} です</translation>
        </message>
        <message>
            <source>{file}: there is no text encoding {encoding!r}</source>
            <translation>{file}: 文字コード {encoding!r} はありません</translation>
        </message>
        <message>
            <source>{file}: track {track}, which begins at byte {byte}, cannot be read: {detail}</source>
            <translation>{file}: バイト {byte} から始まるトラック {track} を読み込めません: {detail}</translation>
        </message>
        <message>
            <source>{file}: {parts} parts (channels of tracks) have notes; at most {most} can be read; delete those that no wind player plays, in the program that the file comes from</source>
            <translation>{file}: ノートのあるパート（トラックごとのチャンネル）が {parts} あります。読み込めるのは {most} までです。元のソフトで、管楽器が演奏しないパートを削除してください</translation>
        </message>
        <message>
            <source>{file}: the last note of track {track} ends after {hours:g} hours, {quarters} quarter notes and {bars} bars; at most {most_hours} hours, {most_quarters} quarter notes and {most_bars} bars can be played; delete what lies far behind the music, or correct the tempo, in the program that the file comes from</source>
            <translation>{file}: トラック {track} の最後のノートが {hours:g} 時間後（四分音符 {quarters} 個、{bars} 小節）に終わります。演奏できるのは {most_hours} 時間、四分音符 {most_quarters} 個、{most_bars} 小節までです。元のソフトで、曲から遠く離れたノートを削除するか、テンポを直してください</translation>
        </message>
        <message>
            <source>the header says that it is {length} bytes long and is not (byte {byte}); its first 6 bytes were taken</source>
            <translation>ヘッダーの長さが {length} バイトとありますが、違います（バイト {byte}）。先頭の 6 バイトを使いました</translation>
        </message>
        <message>
            <source>the file says it has the unknown format {format}; its tracks were taken as simultaneous</source>
            <translation>不明なフォーマット {format} のファイルです。トラックは同時に鳴るものとして読みました</translation>
        </message>
        <message>
            <source>the file says it has one track (format 0) and has {tracks}; they were taken as simultaneous</source>
            <translation>トラックが 1 つ（フォーマット 0）のはずですが、{tracks} あります。同時に鳴るものとして読みました</translation>
        </message>
        <message>
            <source>the length of track {track} (byte {byte}) is wrong; the track was read up to its real end</source>
            <translation>トラック {track} の長さ（バイト {byte}）が誤っています。実際の終わりまで読みました</translation>
        </message>
        <message>
            <source>the header promises {expected} tracks, the file has {found}</source>
            <translation>ヘッダーには {expected} トラックとありますが、実際は {found} です</translation>
        </message>
        <message>
            <source>{count} {count:byte|bytes} after the last track, from byte {byte}, {count:is|are} no part of a MIDI file and {count:was|were} left out</source>
            <translation>最後のトラックの後、バイト {byte} からの {count} バイトは MIDI の内容ではないため省きました</translation>
        </message>
        <message>
            <source>track {track} breaks off within an event at byte {byte}; what came before was read</source>
            <translation>トラック {track} はバイト {byte} のイベントの途中で切れています。その前までを読みました</translation>
        </message>
        <message>
            <source>{count} {count:byte|bytes} of track {track} {count:is no MIDI event and was|are no MIDI events and were} left out, the first at byte {byte}</source>
            <translation>トラック {track} の {count} バイトは MIDI イベントではないため省きました（最初はバイト {byte}）</translation>
        </message>
        <message>
            <source>the file counts time in frames of 1/{rate} s, which is no SMPTE rate; it was taken literally</source>
            <translation>時間の単位が 1/{rate} 秒で、SMPTE にはない値です。そのまま使いました</translation>
        </message>
        <message>
            <source>the file has {patterns} independent patterns (format 2); they follow one another</source>
            <translation>独立した {patterns} 個のパターン（フォーマット 2）です。続けて並べました</translation>
        </message>
        <message>
            <source>{count} {count:note|notes} of track {track} never {count:ends; it ends|end; they end} where the next note of the channel begins, and after four quarters at the latest</source>
            <translation>トラック {track} の {count} 音にノートオフがないため、同じチャンネルの次のノートの始まりまで、長くても四分音符 4 個分としました</translation>
        </message>
        <message>
            <source>{count} {count:note|notes} of track {track} {count:has no length; it lasts|have no length; they last} one tick</source>
            <translation>トラック {track} の {count} 音には長さがないため、1 ティックとしました</translation>
        </message>
        <message>
            <source>{count} {count:event|events} of track {track} {count:lies|lie} beyond the last possible tick and {count:was|were} left out</source>
            <translation>トラック {track} の {count} 個のイベントは最大のティックを超えているため、省きました</translation>
        </message>
        <message>
            <source>track {track} has {count} impossible time {count:signature|signatures}, the first at tick {tick}; {count:it was|they were} left out</source>
            <translation>トラック {track} に不正な拍子記号が {count} 個あるため（最初はティック {tick}）、省きました</translation>
        </message>
        <message>
            <source>track {track} has {count} impossible {count:tempo|tempos}, the first at tick {tick}; {count:it was|they were} left out</source>
            <translation>トラック {track} に不正なテンポが {count} 個あるため（最初はティック {tick}）、省きました</translation>
        </message>
        <message>
            <source>{file} is written: {count} {count:track|tracks}</source>
            <translation>{file} を書き出しました（{count} トラック）</translation>
        </message>
        <message>
            <source>{file} is written, but: {first} ({count} {count:remark|remarks} in all)</source>
            <translation>{file} を書き出しましたが、注意があります：{first}（全 {count} 件）</translation>
        </message>
        <message>
            <source>bar {bar}: a MIDI file cannot hold a tempo of {bpm:g} quarters per minute, only {low:g} to {high:g}; change it and export again</source>
            <translation>小節 {bar}：MIDI ファイルのテンポは ♩={low:g}～{high:g} に限られ、♩={bpm:g} は保存できません。変更してからもう一度書き出してください</translation>
        </message>
        <message>
            <source>{part}: {count} {count:note sounds|notes sound} within another of the same pitch; in a MIDI file the two exchange their ends</source>
            <translation>{part}：同じ高さの音の中で鳴る音が {count} 個あります。MIDI ファイルでは両者の終わりが入れ替わります</translation>
        </message>
        <message>
            <source>{part}: its name says {said}, so who reads the file takes it for that and not for {played}</source>
            <translation>{part}：名前が {said} を示すため、読み込むと {played} ではなくそちらとして扱われます</translation>
        </message>
        <message>
            <source>{part}: notes sound together; who reads the file shares them among players</source>
            <translation>{part}：同時に鳴る音があるため、読み込むと複数の奏者に分けられます</translation>
        </message>
        <message>
            <source>{file} is what the piece was read from, and holds {count} {count:part|parts} more that nobody plays here; write to another file</source>
            <translation>{file} は曲の読み込み元で、ここで演奏されないパートがほかに {count} 個入っています。別のファイルに書き出してください</translation>
        </message>
        <message>
            <source>{file} would be replaced by what was read from it; write to another file</source>
            <translation>{file} は読み込み元なので上書きできません。別のファイルに書き出してください</translation>
        </message>
        <message>
            <source>there is no instrument map for {instrument} yet</source>
            <translation>{instrument} のインストゥルメントマップはまだありません</translation>
        </message>
        <message>
            <source>left out on import</source>
            <translation>読み込み時に外しました</translation>
        </message>
        <message>
            <source>{instrument} is percussion</source>
            <translation>{instrument} は打楽器です</translation>
        </message>
        <message>
            <source>{instrument} is not a wind instrument</source>
            <translation>{instrument} は管楽器ではありません</translation>
        </message>
        <message>
            <source>neither its name nor its program says what it is, and no instrument map reaches its notes ({lowest} to {highest})</source>
            <translation>名前からもプログラム番号からも楽器が分からず、音域（{lowest}～{highest}）に合うマップもありません</translation>
        </message>
        <message>
            <source>{part}: there is no instrument map for {instrument}; {map} plays it instead</source>
            <translation>{part}: {instrument} のマップがないため、{map} で代わりに演奏します</translation>
        </message>
        <message>
            <source>{part}: neither its name nor its program says what it is; the file's name does, so {map} plays it</source>
            <translation>{part}: パート名とプログラムからは楽器が分かりません。ファイル名から {map} が演奏します</translation>
        </message>
        <message>
            <source>{part}: neither its name nor its program says what it is; {map} plays it because the range fits</source>
            <translation>{part}: 名前からもプログラム番号からも楽器が分かりません。音域が合う {map} で演奏します</translation>
        </message>
        <message>
            <source>{part}: neither its name nor its program says what it is; {map} plays it, though {outside} of {total} notes lie outside its range, the first at bar {bar}, beat {beat:g} ({pitch})</source>
            <translation>{part}: 名前からもプログラム番号からも楽器が分かりません。{map} で演奏しますが、{total} 音中 {outside} 音が音域外です（最初は {bar} 小節 {beat:g} 拍目の {pitch}）</translation>
        </message>
        <message>
            <source>{part}: {outside} of {total} notes lie outside the range of {map}, the first at bar {bar}, beat {beat:g} ({pitch}), but all fit as written pitches: the part looks untransposed; import its pitches as written</source>
            <translation>{part}: {total} 音のうち {outside} 音が{map}の音域から外れていますが（最初は {bar} 小節 {beat:g} 拍目の {pitch}）、記譜音と見なすとすべて収まります。記譜音のまま書き出されたパートのようです。「記譜音」として読み込んでください</translation>
        </message>
        <message>
            <source>the piece has {most} players already, and more cannot play</source>
            <translation>奏者がすでに {most} 人いて、これ以上は演奏できません</translation>
        </message>
        <message>
            <source>nothing says which instrument plays it ({lowest} to {highest}); choose one</source>
            <translation>楽器が分かりません（{lowest}～{highest}）。楽器を選んでください</translation>
        </message>
        <message>
            <source>{part}: split between {most} players; {count} {count:note that sounds|notes that sound} together with theirs {count:is|are} left out, the first at bar {bar}, beat {beat:g} ({pitch})</source>
            <translation>{part}: {most} 人で分担し、それ以上に重なる {count} 音を省きました（最初は {bar} 小節 {beat:g} 拍目の {pitch}）</translation>
        </message>
        <message>
            <source>{part}: the player of this track changes to {instrument} for {count} {count:note|notes}, the first at bar {bar}, beat {beat:g} ({pitch})</source>
            <translation>{part}: このトラックのプレイヤーは{count}音を{instrument}に持ち替えて演奏します。最初は{bar}小節{beat:g}拍目 ({pitch})</translation>
        </message>
        <message>
            <source>{count} {count:note sounds|notes sound} together with others, the first at bar {bar}, beat {beat:g} ({pitch}); too few and too short for another player</source>
            <translation>{count} 音がほかの音と重なります（最初は {bar} 小節 {beat:g} 拍目の {pitch}）。別のプレイヤーに分けるには少なく短いため、省きました</translation>
        </message>
        <message>
            <source>{count} {count:note lasts|notes last} into the next one and {count:ends|end} there, slurred; the first in {part} at bar {bar}, beat {beat:g} ({pitch})</source>
            <translation>{count} 音が次の音に重なるため、スラーとして次の音の始めまで縮めました（最初は {part} の {bar} 小節 {beat:g} 拍目の {pitch}）</translation>
        </message>
        <message>
            <source>{count} {count:note|notes} far from the range of the instrument {count:is a key switch|are key switches}, the first at bar {bar}, beat {beat:g} ({pitch})</source>
            <translation>楽器の音域から遠い {count} 音はキースイッチと見なしました（最初は {bar} 小節 {beat:g} 拍目の {pitch}）</translation>
        </message>
        <message>
            <source>{part}: split between {voices} players, because {count} {count:note keeps|notes keep} sounding together with others, the first at bar {bar}, beat {beat:g} ({pitch})</source>
            <translation>{part}: {count} 音がほかの音と重なって鳴り続けるため、{voices} 人で分担します（最初は {bar} 小節 {beat:g} 拍目の {pitch}）</translation>
        </message>
        <message>
            <source>{file} has several root bones ({bones}); Unreal takes only one, so the bone {root} was put above them</source>
            <translation>{file} にはルートボーンが複数あります（{bones}）。Unreal はルートを 1 つしか受け付けないため、その上にボーン {root} を加えました</translation>
        </message>
        <message>
            <source>{file}: {armature}, which Blender keeps the bones in, is no bone in Unreal and is left out; the root bone is {root}</source>
            <translation>{file}：Blender がボーンを収める {armature} は Unreal ではボーンにならないため、含めません。ルートボーンは {root} です</translation>
        </message>
        <message>
            <source>the root bone is {ours}, the asset's is {theirs}: Unreal would refuse the animation</source>
            <translation>ルートボーンは {ours} ですが、アセットでは {theirs} です。Unreal はこのアニメーションを受け付けません</translation>
        </message>
        <message>
            <source>{bone} hangs from {ours}, in the asset from {theirs}</source>
            <translation>{bone} の親は {ours} ですが、アセットでは {theirs} です</translation>
        </message>
        <message>
            <source>lengths are {factor} times the asset's: it is in another unit</source>
            <translation>長さがアセットの {factor} 倍です。単位が異なります</translation>
        </message>
        <message>
            <source>{count} {count:bone that moves is|bones that move are} not in the asset, so that what {count:it does|they do} would be lost: {bones}</source>
            <translation>動くボーンのうち {count} 個がアセットにないため、その動きは失われます：{bones}</translation>
        </message>
        <message>
            <source>{count} {count:bone|bones} that nothing moves {count:is|are} not in the asset: {bones}</source>
            <translation>動かないボーンのうち {count} 個はアセットにありません：{bones}</translation>
        </message>
        <message>
            <source>{count} {count:bone|bones} of the asset {count:is|are} not in the file and {count:keeps its|keep their} rest pose: {bones}</source>
            <translation>アセットのボーンのうち {count} 個はファイルになく、レストポーズのままです：{bones}</translation>
        </message>
        <message>
            <source>{count} {count:bone rests|bones rest} turned against the asset, at most by {most} degrees ({bone})</source>
            <translation>{count} 個のボーンのレスト回転がアセットと異なります（最大 {most} 度、{bone}）</translation>
        </message>
        <message>
            <source>{count} {count:bone rests|bones rest} elsewhere than in the asset, at most by {most} mm ({bone})</source>
            <translation>{count} 個のボーンのレスト位置がアセットと異なります（最大 {most} mm、{bone}）</translation>
        </message>
        <message>
            <source>{file} has another skeleton than the one that {player} would be written on: {detail}</source>
            <translation>{file} のスケルトンは、{player} を書き出すスケルトンと異なります：{detail}</translation>
        </message>
        <message>
            <source>no computer is called {host!r}: check the spelling, or type its address in numbers such as 192.168.0.20</source>
            <translation>{host!r} というコンピューターは見つかりません。つづりを確かめるか、192.168.0.20 のような数字のアドレスを入力してください</translation>
        </message>
        <message>
            <source>--host {host} is a multicast or broadcast address, which every computer on the network can receive from; add --broadcast if that is intended</source>
            <translation>--host {host} はマルチキャストまたはブロードキャストのアドレスで、ネットワーク上のすべてのコンピューターが受信できます。意図したものなら --broadcast を付けてください</translation>
        </message>
        <message>
            <source>{host} is a multicast or broadcast address: every computer on the network could receive what is sent. Nothing was sent</source>
            <translation>{host} はマルチキャストまたはブロードキャストのアドレスです。送信すると、ネットワーク上のすべてのコンピューターが受信できます。まだ何も送信していません</translation>
        </message>
        <message>
            <source>there are no players or dancers to stream</source>
            <translation>配信する出演者がいません</translation>
        </message>
        <message>
            <source>--from {time_s:g}: the piece goes from {first_s:g} to {end_s:g} seconds</source>
            <translation>--from {time_s:g}: 曲は {first_s:g} 秒から {end_s:g} 秒までです</translation>
        </message>
        <message>
            <source>{port} is no port that can be sent to; possible: {least} to {most}</source>
            <translation>{port} は送信できるポートではありません。{least} から {most} までを指定してください</translation>
        </message>
        <message>
            <source>{count} {count:performer needs|performers need} {count} {count:port|ports} from {port} on, and the last one is {most}: choose a lower port</source>
            <translation>出演者 {count} 人には {port} から {count} 個のポートが必要ですが、最後のポートは {most} です。小さいポート番号を選んでください</translation>
        </message>
        <message>
            <source>nothing can be sent to {host}, port {port} ({reason}): check the address and the network; it is tried again</source>
            <translation>{host} のポート {port} に送信できません ({reason})。アドレスとネットワークを確かめてください。自動で再試行します</translation>
        </message>
        <message>
            <source>{file}, line {line}, column {column}: {detail}; correct it in a text editor</source>
            <translation>{file}、{line} 行 {column} 列: {detail}。テキストエディターで修正してください</translation>
        </message>
        <message>
            <source>{file}: {place}: {detail}</source>
            <translation>{file}: {place}: {detail}</translation>
        </message>
        <message>
            <source>{file} is not UTF-8 text (byte {byte}); save it as UTF-8 in a text editor</source>
            <translation>{file} は UTF-8 のテキストではありません (バイト {byte})。テキストエディターで UTF-8 として保存してください</translation>
        </message>
        <message>
            <source>{file}: {detail}</source>
            <translation>{file}: {detail}</translation>
        </message>
        <message>
            <source>{file} is not a glTF 2.0 file</source>
            <translation>{file} は glTF 2.0 ファイルではありません</translation>
        </message>
        <message>
            <source>{file} is damaged: {what} is wrong</source>
            <translation>{file} が壊れています: {what} が正しくありません</translation>
        </message>
        <message>
            <source>{file} needs the file {uri} beside it; only files that hold everything themselves are read</source>
            <translation>{file} には別ファイル {uri} が必要です。すべてを含む単独のファイルだけを読み込めます</translation>
        </message>
        <message>
            <source>{file} uses {what}, which is not supported</source>
            <translation>{file} は未対応の {what} を使っています</translation>
        </message>
        <message>
            <source>{file} nests its nodes more than {most} deep; export the character alone</source>
            <translation>{file} のノードの階層が {most} 段を超えています。キャラクターだけを書き出してください</translation>
        </message>
        <message>
            <source>{file} is neither VRM, glTF nor FBX</source>
            <translation>{file} は VRM、glTF、FBX のいずれでもありません</translation>
        </message>
        <message>
            <source>{file} describes more data than any character has; export the character alone</source>
            <translation>{file} のデータ量は、キャラクターとしてあり得ない大きさです。キャラクターだけを書き出してください</translation>
        </message>
        <message>
            <source>{file} has no bones: a character needs a skeleton to play with</source>
            <translation>{file} にはボーンがありません。演奏するにはスケルトンのあるキャラクターが必要です</translation>
        </message>
        <message>
            <source>{file} makes its figure {height_m} m tall, so its unit is wrong: sizes are taken times {factor}</source>
            <translation>{file} のキャラクターの身長が {height_m} m になるため、単位が誤っているとみなし、大きさを {factor} 倍して読み込みます</translation>
        </message>
        <message>
            <source>{file} makes its figure {height_m} m tall; if that is not meant, export it in the right unit</source>
            <translation>{file} のキャラクターの身長は {height_m} m です。意図したものでなければ、正しい単位で書き出し直してください</translation>
        </message>
        <message>
            <source>{file} cannot play: no bone was found for {joints}; name those bones by hand</source>
            <translation>{file} は演奏できません。次の関節に当たるボーンが見つかりません：{joints}。ボーンを手動で指定してください</translation>
        </message>
        <message>
            <source>{file} names {name}, which is not beside it</source>
            <translation>{file} に書かれた {name} が同じフォルダーにありません</translation>
        </message>
        <message>
            <source>the name of {file} has characters that cannot be shown; rename it</source>
            <translation>{file} の名前に表示できない文字があります。名前を変更してください</translation>
        </message>
        <message>
            <source>{file} describes {id!r}, which is one of our own characters; give it another name</source>
            <translation>{file} は付属のキャラクター {id!r} と同じ名前です。ファイルの名前を変えてください</translation>
        </message>
        <message>
            <source>{file} cannot play; what it lacks is said above</source>
            <translation>{file} は演奏できません。足りないものは上に示したとおりです</translation>
        </message>
        <message>
            <source>{text!r} names no joint and its bone; write e.g. leftHand=Wrist_L</source>
            <translation>{text!r} は関節とボーンの指定ではありません。leftHand=Wrist_L のように書いてください</translation>
        </message>
        <message>
            <source>{text!r} names no shape and what makes it; write e.g. jawOpen=Mouth_A:0.8+Teeth_A:0.8</source>
            <translation>{text!r} はシェイプとモーフの指定ではありません。jawOpen=Mouth_A:0.8+Teeth_A:0.8 のように書いてください</translation>
        </message>
        <message>
            <source>{file} is not valid; problems: {count}</source>
            <translation>{file} に問題が {count} 件あります</translation>
        </message>
        <message>
            <source>read again: {maps}</source>
            <translation>再読み込みしました：{maps}</translation>
        </message>
        <message>
            <source>{file}: cannot be read: {detail}</source>
            <translation>{file}: 読み込めません: {detail}</translation>
        </message>
        <message>
            <source>{file}: its table of fingerings is written in a way that cannot be changed here; change it in a text editor</source>
            <translation>{file}：運指表がここでは変更できない書き方になっています。テキストエディタで変更してください</translation>
        </message>
        <message>
            <source>{text!r} says nothing on this instrument; its signs are: {signs}</source>
            <translation>{text!r} はこの楽器では意味がありません。使える記号：{signs}</translation>
        </message>
        <message>
            <source>{text!r} is no place of the slide; there are: {places}</source>
            <translation>{text!r} というスライドポジションはありません。使えるもの：{places}</translation>
        </message>
        <message>
            <source>{text!r} is there already for this note</source>
            <translation>{text!r} はこの音にすでに登録されています</translation>
        </message>
        <message>
            <source>{text!r} is no number of cents</source>
            <translation>{text!r} はセントの数値ではありません</translation>
        </message>
        <message>
            <source>the only fingering of a note cannot be removed</source>
            <translation>音に残った唯一の運指は削除できません</translation>
        </message>
        <message>
            <source>there is no instrument map named {id!r}</source>
            <translation>{id!r} というインストゥルメントマップはありません</translation>
        </message>
        <message>
            <source>{file}: there is no joint named {joint!r}; there are: {joints}</source>
            <translation>{file}：{joint!r} という関節はありません。使えるもの：{joints}</translation>
        </message>
        <message>
            <source>{file} has no bone named {bone!r}, which is said to be {joint}</source>
            <translation>{file} には、{joint} に指定されたボーン {bone!r} がありません</translation>
        </message>
        <message>
            <source>{file}: there is no shape of the face named {shape!r} among ARKit's</source>
            <translation>{file}：{shape!r} という形は ARKit のブレンドシェイプにありません</translation>
        </message>
        <message>
            <source>{file} has no morph named {morph!r}, which is said to make {shape}</source>
            <translation>{file} には、{shape} に指定されたモーフ {morph!r} がありません</translation>
        </message>
        <message>
            <source>there is no {kind} named {name!r}; there are: {known}</source>
            <translation>{kind} に {name!r} はありません。使えるもの: {known}</translation>
        </message>
        <message>
            <source>there is no character named {id!r}; there are: {known}</source>
            <translation>{id!r} というキャラクターはありません。使えるもの: {known}</translation>
        </message>
        <message>
            <source>{name} is there now: choose it for a player, under Character</source>
            <translation>{name} を追加しました。プレイヤーの「キャラクター」で選べます</translation>
        </message>
        <message>
            <source>the character {id!r} lacks what playing needs: {missing}</source>
            <translation>キャラクター {id!r} には演奏に必要なものがありません: {missing}</translation>
        </message>
        <message>
            <source>some bars from {take}</source>
            <translation>{take}から一部を採用</translation>
        </message>
        <message>
            <source>all of {take}</source>
            <translation>{take}をすべて採用</translation>
        </message>
        <message>
            <source>what was there before the takes</source>
            <translation>テイク前の内容に戻す</translation>
        </message>
        <message>
            <source>call a take {take}</source>
            <translation>テイクの名前を{take}に変更</translation>
        </message>
        <message>
            <source>colour of {take}</source>
            <translation>{take}の色</translation>
        </message>
        <message>
            <source>delete {take}</source>
            <translation>{take}を削除</translation>
        </message>
        <message>
            <source>another place for {take}</source>
            <translation>{take}の並び順を変更</translation>
        </message>
        <message>
            <source>clean {take}</source>
            <translation>{take}のクリーニング</translation>
        </message>
        <message>
            <source>tempo of {take}</source>
            <translation>{take}のテンポ</translation>
        </message>
        <message>
            <source>Finding the beats of {take}</source>
            <translation>{take}の拍を検出中</translation>
        </message>
        <message>
            <source>The piece follows {take}: {count} {count:beat|beats}, {bpm:.0f} a minute.</source>
            <translation>曲のテンポを{take}に合わせました。{count} 拍、毎分 {bpm:.0f} 拍。</translation>
        </message>
        <message>
            <source>{take} was changed while its beats were looked for; nothing was done.</source>
            <translation>拍の検出中に{take}が変更されたため、何も行いませんでした。</translation>
        </message>
        <message>
            <source>There is no take {take} any more.</source>
            <translation>テイク {take} はもうありません。</translation>
        </message>
        <message>
            <source>A project has room for {most} takes: delete some first.</source>
            <translation>プロジェクトに入るテイクは{most}個までです。先にいくつか削除してください。</translation>
        </message>
        <message>
            <source>What was recorded cannot be used: {place}: {detail}. Its journal is damaged.</source>
            <translation>録音された内容を使用できません: {place}: {detail}。ジャーナルファイルが壊れています。</translation>
        </message>
        <message>
            <source>{part} has notes already, so the tempo cannot follow one take. Quantise the take instead.</source>
            <translation>{part}にはすでに音符があるため、テンポを1つのテイクに合わせられません。代わりにテイクをクオンタイズしてください。</translation>
        </message>
        <message>
            <source>The take has {count} {count:note|notes}; beats can be found from {least} on.</source>
            <translation>このテイクの音符は{count}個です。拍の検出には{least}個以上必要です。</translation>
        </message>
        <message>
            <source>No beat can be heard in this take.</source>
            <translation>このテイクからは拍を検出できません。</translation>
        </message>
        <message>
            <source>{file} is not there; choose the .uproject file, or the folder that it is in</source>
            <translation>{file} がありません。.uproject ファイルか、それがあるフォルダーを選んでください</translation>
        </message>
        <message>
            <source>{file} is no Unreal project; choose the .uproject file, or the folder that it is in</source>
            <translation>{file} は Unreal プロジェクトではありません。.uproject ファイルか、それがあるフォルダーを選んでください</translation>
        </message>
        <message>
            <source>{file} holds several Unreal projects ({names}); choose one of the .uproject files</source>
            <translation>{file} には Unreal プロジェクトが複数あります ({names})。いずれかの .uproject ファイルを選んでください</translation>
        </message>
        <message>
            <source>{file} cannot be read as an Unreal project: {detail}</source>
            <translation>{file} を Unreal プロジェクトとして読み込めません: {detail}</translation>
        </message>
        <message>
            <source>{file} belongs to Unreal Engine {version}; version {least} or newer is needed</source>
            <translation>{file} は Unreal Engine {version} のプロジェクトです。バージョン {least} 以降が必要です</translation>
        </message>
        <message>
            <source>{file} is write-protected; nothing was written; allow writing into the project's folder and export again</source>
            <translation>{file} は書き込み禁止です。何も書き出していません。プロジェクトのフォルダーへの書き込みを許可してから、もう一度書き出してください</translation>
        </message>
        <message>
            <source>{file} is write-protected, as version control leaves it; nothing was written; check it out, then export again</source>
            <translation>{file} は書き込み禁止です (バージョン管理でチェックアウトされていないようです)。何も書き出していません。チェックアウトしてから、もう一度書き出してください</translation>
        </message>
        <message>
            <source>{file} is damaged ({detail}), so that nobody knows which files are whose; nothing was written; move its folder away, then export again</source>
            <translation>{file} が壊れていて ({detail})、どのファイルがこのプログラムのものか分かりません。何も書き出していません。そのフォルダーを別の場所に移してから、もう一度書き出してください</translation>
        </message>
        <message>
            <source>{file} is not from this program and would be replaced; nothing was written; move it or rename it, then export again</source>
            <translation>{file} はこのプログラムが作ったものではなく、上書きされてしまいます。何も書き出していません。移動するか名前を変えてから、もう一度書き出してください</translation>
        </message>
        <message>
            <source>{file} was changed by somebody since it was exported; nothing was written; move it away to keep it, or delete it, then export again</source>
            <translation>{file} は書き出した後に変更されています。何も書き出していません。残すなら別の場所に移し、不要なら削除してから、もう一度書き出してください</translation>
        </message>
        <message>
            <source>{file} is not needed any more, but was changed by somebody and is left alone</source>
            <translation>{file} はもう不要ですが、変更されているため、そのまま残します</translation>
        </message>
        <message>
            <source>{file} is a plug-in of that name that is not from this program; nothing was written; move it away, then export again</source>
            <translation>{file} は同名の別のプラグインです。何も書き出していません。別の場所に移してから、もう一度書き出してください</translation>
        </message>
        <message>
            <source>{file} was written wrongly ({what}: {found}, not {wanted}); nothing was changed in the project; please report this</source>
            <translation>{file} が正しく書き出されませんでした ({what}: {wanted} ではなく {found})。プロジェクトは変更していません。この問題を報告してください</translation>
        </message>
        <message>
            <source>files written into the Unreal project {project}: {count}</source>
            <translation>Unreal プロジェクト {project} に書き出したファイル: {count}</translation>
        </message>
        <message>
            <source>--format is for a folder of files; an Unreal project gets what Unreal reads</source>
            <translation>--format はフォルダーへの書き出し用です。Unreal プロジェクトには Unreal が読み込むファイルを書き出します</translation>
        </message>
        <message>
            <source>{file}: another export into it is under way; wait until it has finished, then export again</source>
            <translation>{file} には別の書き出しが進行中です。終わってから、もう一度書き出してください</translation>
        </message>
        <message>
            <source>{file} is a link to {target}, out of the folder that is exported into; nothing was written; put a folder in its place, then export again</source>
            <translation>{file} は書き出し先の外にある {target} へのリンクです。何も書き込んでいません。リンクをフォルダーに置き換えてから、もう一度書き出してください</translation>
        </message>
        <message>
            <source>{file} was to be given back as it was before the export and cannot be: {reason}; close the program that has it open, then export again</source>
            <translation>{file} を書き出し前の状態に戻せません: {reason}。このファイルを開いているプログラムを閉じてから、もう一度書き出してください</translation>
        </message>
        <message>
            <source>{file} cannot be replaced: {reason}; everything is as it was; close the program that has it open, then export again</source>
            <translation>{file} を置き換えられません: {reason}。すべて元のままです。このファイルを開いているプログラムを閉じてから、もう一度書き出してください</translation>
        </message>
        <message>
            <source>opening</source>
            <translation>開いています</translation>
        </message>
        <message>
            <source>saving</source>
            <translation>保存しています</translation>
        </message>
        <message>
            <source>writing unsaved work down</source>
            <translation>自動保存しています</translation>
        </message>
        <message>
            <source>looking for unsaved work</source>
            <translation>未保存の作業を探しています</translation>
        </message>
        <message>
            <source>removing temporary files of earlier runs</source>
            <translation>以前の実行で残った一時ファイルを削除しています</translation>
        </message>
        <message>
            <source>planning what {players} players do</source>
            <translation>{players} 人の演奏を組み立てています</translation>
        </message>
        <message>
            <source>finding out how {players} players hold their instruments</source>
            <translation>{players} 人の楽器の持ち方を計算しています</translation>
        </message>
        <message>
            <source>reading your instruments</source>
            <translation>自分の楽器を読み込んでいます</translation>
        </message>
        <message>
            <source>loading the players' figures</source>
            <translation>キャラクターを読み込んでいます</translation>
        </message>
        <message>
            <source>what the generator would do for {player}</source>
            <translation>{player} の自動生成の結果を調べています</translation>
        </message>
        <message>
            <source>learning {file}</source>
            <translation>{file} を学習中</translation>
        </message>
        <message>
            <source>reading the MIDI file again</source>
            <translation>MIDI ファイルを読み直しています</translation>
        </message>
        <message>
            <source>drawing the characters' portraits</source>
            <translation>キャラクターの肖像を描いています</translation>
        </message>
        <message>
            <source>reading the choreography</source>
            <translation>振り付けを読み込んでいます</translation>
        </message>
        <message>
            <source>finding out what the dancers dance</source>
            <translation>ダンサーの振り付けを決定中</translation>
        </message>
        <message>
            <source>looking for {host}</source>
            <translation>{host} を検索中</translation>
        </message>
        <message>
            <source>reading {file}</source>
            <translation>{file} を読み込んでいます</translation>
        </message>
        <message>
            <source>adding {name}</source>
            <translation>{name} を追加中</translation>
        </message>
        <message>
            <source>drawing the character</source>
            <translation>キャラクターを描画中</translation>
        </message>
        <message>
            <source>reading your characters</source>
            <translation>自分のキャラクターを読み込み中</translation>
        </message>
        <message>
            <source>writing the files</source>
            <translation>ファイルを書き出しています</translation>
        </message>
        <message>
            <source>comparing the skeletons with {file}</source>
            <translation>スケルトンを {file} と比較中</translation>
        </message>
        <message>
            <source>writing the MIDI file</source>
            <translation>MIDI ファイルの書き出し</translation>
        </message>
        <message>
            <source>making the film</source>
            <translation>動画を作っています</translation>
        </message>
        <message>
            <source>making the sound</source>
            <translation>音を作っています</translation>
        </message>
        <message>
            <source>finding the recording's offset</source>
            <translation>録音のオフセットを推定しています</translation>
        </message>
    </context>
</TS>
