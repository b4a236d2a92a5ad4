<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="ja" sourcelanguage="en">
<context>
    <name>Header</name>
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
        <translation>手</translation>
    </message>
    <message>
        <source>Mouth</source>
        <translation>口</translation>
    </message>
    <message>
        <source>Feet</source>
        <translation>足</translation>
    </message>
    <message>
        <source>Everyone, from the audience</source>
        <translation>客席側から全員を表示</translation>
    </message>
    <message>
        <source>The selected players from their front</source>
        <translation>選択したプレイヤーを正面から表示</translation>
    </message>
    <message>
        <source>The selected players from their right side</source>
        <translation>選択したプレイヤーを右側面から表示</translation>
    </message>
    <message>
        <source>The selected players from above</source>
        <translation>選択したプレイヤーを真上から表示</translation>
    </message>
    <message>
        <source>Hands of the player in front; the camera follows them</source>
        <translation>前面のプレイヤーの手を表示（カメラが追従）</translation>
    </message>
    <message>
        <source>Mouth of the player in front; the camera follows it</source>
        <translation>前面のプレイヤーの口を表示（カメラが追従）</translation>
    </message>
    <message>
        <source>Feet of the player in front; the camera follows them</source>
        <translation>前面のプレイヤーの足を表示（カメラが追従）</translation>
    </message>
    <message>
        <source>View</source>
        <translation>ビュー</translation>
    </message>
    <message>
        <source>Players&apos; names</source>
        <translation>プレイヤー名</translation>
    </message>
    <message>
        <source>Skeleton</source>
        <translation>スケルトン</translation>
    </message>
    <message>
        <source>Contact points and their distances</source>
        <translation>接触点と距離</translation>
    </message>
    <message>
        <source>Wireframe</source>
        <translation>ワイヤーフレーム</translation>
    </message>
    <message>
        <source>Pose</source>
        <translation>ポーズ</translation>
    </message>
    <message>
        <source>Hold bell, head, elbows or torso differently by dragging handles</source>
        <translation>ハンドルをドラッグしてベル・頭・ひじ・上体の構えを直す</translation>
    </message>
    <message>
        <source>Frame the selected players</source>
        <translation>選択したプレイヤーを画面に収める</translation>
    </message>
    <message>
        <source>Show beside the players</source>
        <translation>重ねて表示するもの</translation>
    </message>
    <message>
        <source>The viewport alone on the whole screen, or not</source>
        <translation>ビューポートだけを全画面に表示（もう一度で戻す）</translation>
    </message>
</context>
<context>
    <name>Scene</name>
    <message>
        <source>No players yet. Open or import a piece to see it performed.</source>
        <translation>プレイヤーがいません。曲を開くか読み込むと、演奏がここに表示されます。</translation>
    </message>
    <message>
        <source>Loading the players …</source>
        <translation>プレイヤーを読み込んでいます…</translation>
    </message>
    <message>
        <source>Making the first motion …</source>
        <translation>最初の動きを生成しています…</translation>
    </message>
    <message>
        <source>up {degrees}°</source>
        <translation>上 {degrees}°</translation>
    </message>
    <message>
        <source>down {degrees}°</source>
        <translation>下 {degrees}°</translation>
    </message>
    <message>
        <source>left {degrees}°</source>
        <translation>左 {degrees}°</translation>
    </message>
    <message>
        <source>right {degrees}°</source>
        <translation>右 {degrees}°</translation>
    </message>
    <message>
        <source>lean left {degrees}°</source>
        <translation>左へ傾き {degrees}°</translation>
    </message>
    <message>
        <source>lean right {degrees}°</source>
        <translation>右へ傾き {degrees}°</translation>
    </message>
</context>
<context>
    <name>ViewportPanel</name>
    <message>
        <source>Drag a handle · Shift: finely · Alt: lean · double-click: back</source>
        <translation>ハンドルをドラッグ · Shift：微調整 · Alt：傾き · ダブルクリック：元に戻す</translation>
    </message>
    <message>
        <source>Viewport</source>
        <translation>ビューポート</translation>
    </message>
    <message>
        <source>The players cannot be drawn here: there is no usable OpenGL 2.
({reason})

Timeline, players, inspector, sound and export work all the same. An up-to-date graphics driver usually brings the picture back.</source>
        <translation>ここではプレイヤーを描画できません。OpenGL 2 が使えないためです。
（{reason}）

タイムライン、プレイヤー、インスペクター、音声、書き出しは通常どおり使えます。グラフィックドライバーを更新すると表示できるようになることがあります。</translation>
    </message>
</context>
</TS>
