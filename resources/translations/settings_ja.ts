<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="ja" sourcelanguage="en">
    <context>
        <name>Setting</name>
        <message>
            <source>Language</source>
            <translation>言語</translation>
        </message>
        <message>
            <source>The system's</source>
            <translation>システムに合わせる</translation>
        </message>
        <message>
            <source>English</source>
            <translation>English</translation>
        </message>
        <message>
            <source>日本語</source>
            <translation>日本語</translation>
        </message>
        <message>
            <source>Theme</source>
            <translation>テーマ</translation>
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
            <source>Pitches</source>
            <translation>音高</translation>
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
            <source>Middle C</source>
            <translation>中央ハ</translation>
        </message>
        <message>
            <source>C4</source>
            <translation>C4</translation>
        </message>
        <message>
            <source>C3</source>
            <translation>C3</translation>
        </message>
        <message>
            <source>Names of notes</source>
            <translation>音名</translation>
        </message>
        <message>
            <source>C D E</source>
            <translation>C D E</translation>
        </message>
        <message>
            <source>Do Re Mi</source>
            <translation>ドレミ</translation>
        </message>
        <message>
            <source>Time</source>
            <translation>時間</translation>
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
    </context>
</TS>
