<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="ja">
<context>
    <name>TransportBar</name>
    <message>
        <location filename="../../widgets/transport/bar.py" line="232" />
        <source>To the start</source>
        <translation>先頭へ</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="233" />
        <source>Play, or stop here</source>
        <translation>再生／この位置で停止</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="234" />
        <source>Stop; once more: to the start of the loop or the piece</source>
        <translation>停止（もう一度押すとループまたは曲の先頭へ）</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="235" />
        <source>Loop the selection, else the bar</source>
        <translation>選択範囲をループ（選択がなければ小節）</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="236" />
        <source>Metronome</source>
        <translation>メトロノーム</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="237" />
        <source>The timeline follows the playhead</source>
        <translation>タイムラインを再生位置に追従</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="241" />
        <source>Bar, beat, ticks. Click to type, drag to move</source>
        <translation>小節・拍・ティック。クリックで入力、ドラッグで移動</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="242" />
        <source>Bar, beat, ticks</source>
        <translation>小節・拍・ティック</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="243" />
        <source>Minutes and seconds. Click to type, drag to move</source>
        <translation>分・秒。クリックで入力、ドラッグで移動</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="244" />
        <source>Seconds</source>
        <translation>秒</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="245" />
        <source>f</source>
        <comment>frame</comment>
        <translation>f</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="245" />
        <source>Frame. Click to type, drag to step</source>
        <translation>フレーム。クリックで入力、ドラッグでコマ送り</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="246" />
        <source>Frame</source>
        <translation>フレーム</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="247" />
        <source>Tempo and metre at the playhead; the ruler edits them</source>
        <translation>再生位置のテンポと拍子（ルーラーで編集）</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="248" />
        <source>Volume</source>
        <translation>音量</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="248" />
        <source>Volume. Double-click: 80 %</source>
        <translation>音量。ダブルクリックで80 %</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="249" />
        <source>Speed</source>
        <translation>速度</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="249" />
        <source>Speed; the pitch stays. Double-click: 100 %</source>
        <translation>再生速度（音程は変わりません）。ダブルクリックで100 %</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="250" />
        <location filename="../../widgets/transport/bar.py" line="251" />
        <source>What is heard</source>
        <translation>再生する音</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="254" />
        <source>Recording</source>
        <translation>録音</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="255" />
        <source>Synthesiser</source>
        <translation>シンセ</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="256" />
        <source>Both</source>
        <translation>両方</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="259" />
        <source>Edits snap to the grid; Alt suspends it</source>
        <translation>編集をグリッドにスナップ（Altで一時解除）</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="262" />
        <source>Step of the grid: note values, triplets (T), dotted (.)</source>
        <translation>グリッドの単位：音符、3連符（T）、付点（.）</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="263" />
        <source>Step of the grid</source>
        <translation>グリッドの単位</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="265" />
        <source>There is no audio device: it plays silently, in time. Connect one and play again.</source>
        <translation>オーディオデバイスがないため、無音で再生します。接続してから再生し直してください。</translation>
    </message>
    <message>
        <location filename="../../widgets/transport/bar.py" line="266" />
        <source>No audio device: silent</source>
        <translation>オーディオデバイスなし：無音</translation>
    </message>
</context>
</TS>
