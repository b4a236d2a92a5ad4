<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="ja">
<context>
    <name>TransportBar</name>
    <message>
        <source>REC</source>
        <translation>録音中</translation>
    </message>
    <message>
        <source>REC {number}</source>
        <translation>録音中 {number}</translation>
    </message>
    <message>
        <source>To the start</source>
        <translation>先頭へ</translation>
    </message>
    <message>
        <source>Play, or stop here</source>
        <translation>再生／この位置で停止</translation>
    </message>
    <message>
        <source>Stop; once more: to the start of the loop or the piece</source>
        <translation>停止（もう一度押すとループまたは曲の先頭へ）</translation>
    </message>
    <message>
        <source>Loop the selection, else the bar</source>
        <translation>選択範囲をループ（選択がなければ小節）</translation>
    </message>
    <message>
        <source>Record the player in front, or the armed one, from the playhead on</source>
        <translation>手前の奏者（または指定した奏者）を再生位置から録音</translation>
    </message>
    <message>
        <source>Metronome</source>
        <translation>メトロノーム</translation>
    </message>
    <message>
        <source>The timeline follows the playhead</source>
        <translation>タイムラインを再生位置に追従</translation>
    </message>
    <message>
        <source>Bar, beat, ticks. Click to type, drag to move</source>
        <translation>小節・拍・ティック。クリックで入力、ドラッグで移動</translation>
    </message>
    <message>
        <source>Bar, beat, ticks</source>
        <translation>小節・拍・ティック</translation>
    </message>
    <message>
        <source>Minutes and seconds. Click to type, drag to move</source>
        <translation>分・秒。クリックで入力、ドラッグで移動</translation>
    </message>
    <message>
        <source>Seconds</source>
        <translation>秒</translation>
    </message>
    <message>
        <source>f</source>
        <comment>frame</comment>
        <translation>f</translation>
    </message>
    <message>
        <source>Frame. Click to type, drag to step</source>
        <translation>フレーム。クリックで入力、ドラッグでコマ送り</translation>
    </message>
    <message>
        <source>Frame</source>
        <translation>フレーム</translation>
    </message>
    <message>
        <source>Tempo and metre at the playhead; the ruler edits them</source>
        <translation>再生位置のテンポと拍子（ルーラーで編集）</translation>
    </message>
    <message>
        <source>Volume</source>
        <translation>音量</translation>
    </message>
    <message>
        <source>Volume. Double-click: 80 %</source>
        <translation>音量。ダブルクリックで80 %</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>速度</translation>
    </message>
    <message>
        <source>Speed; the pitch stays. Double-click: 100 %</source>
        <translation>再生速度（音程は変わりません）。ダブルクリックで100 %</translation>
    </message>
    <message>
        <source>What is heard</source>
        <translation>再生する音</translation>
    </message>
    <message>
        <source>Recording</source>
        <translation>録音</translation>
    </message>
    <message>
        <source>Synthesiser</source>
        <translation>シンセ</translation>
    </message>
    <message>
        <source>Both</source>
        <translation>両方</translation>
    </message>
    <message>
        <source>Edits snap to the grid; Alt suspends it</source>
        <translation>編集をグリッドにスナップ（Altで一時解除）</translation>
    </message>
    <message>
        <source>Step of the grid: note values, triplets (T), dotted (.)</source>
        <translation>グリッドの単位：音符、3連符（T）、付点（.）</translation>
    </message>
    <message>
        <source>Step of the grid</source>
        <translation>グリッドの単位</translation>
    </message>
    <message>
        <source>There is no audio device: it plays silently, in time. Connect one and play again.</source>
        <translation>オーディオデバイスがないため、無音で再生します。接続してから再生し直してください。</translation>
    </message>
    <message>
        <source>No audio device: silent</source>
        <translation>オーディオデバイスなし：無音</translation>
    </message>
</context>
</TS>
