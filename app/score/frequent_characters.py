"""Frequencies of characters in the languages of part names, as evidence for a text's encoding (`app.score.texts`).

Covers the most frequent characters of everyday and musical text; the characters of the vocabulary of instruments are
added to them.
"""

from __future__ import annotations

from typing import Final

SIMPLIFIED: Final = frozenset(
    "的一是不了人我在有他这为之大来以个中上们到说国和地也子时道出而要于就下得可你年生自会那后能对着事其里所去行过家十用发天如"
    "然作方成者多日都三小军二无同么经法当起与好看学进种将还分此心前面又定见只主没公从西音乐曲歌声部第四五六七八九首奏合器管弦"
    "鼓号笛琴长短高低调降升单双圆铜木打击独主副伴旋律节拍轨道名字版新春夏秋冬花月夜雨风雪海山水火光爱情梦想思念恋故乡黄河长江"
    "北京东方红红旗歌唱祖国进行队伍少女孩世界永远快乐悲伤回忆明天今再见朋友老师校青民族欢庆喜浪漫手机游戏动画电影片头尾"
)
TRADITIONAL: Final = frozenset(
    "的一是不了人我在有他這為之大來以個中上們到說國和地也子時道出而要於就下得可你年生自會那後能對著事其裡所去行過家十用發天如"
    "然作方成者多日都三小軍二無同麼經法當起與好看學進種將還分此心前面又定見只主沒公從西音樂曲歌聲部第四五六七八九首奏合器管弦"
    "鼓號笛琴長短高低調降升單雙圓銅木打擊獨主副伴旋律節拍軌道名字版新春夏秋冬花月夜雨風雪海山水火光愛情夢想思念戀故鄉黃河長江"
    "北京東方紅旗隊伍少女孩世界永遠快樂悲傷回憶明天今再見朋友老師校青民族歡慶喜浪漫手機遊戲動畫電影片頭尾臺灣"
)
KANJI: Final = frozenset(
    "日一国人年大十二本中長出三時行見月後前生五間上東四今金九入学高円子外八六下来気小七山話女北午百書先名川千水半男西電校語土"
    "木聞食車何南万毎白天母火右読友左休父雨音楽曲歌声部第番奏合吹交響管弦打器独主副旋律節拍版新春夏秋冬花夜風雪海空光愛情夢想"
    "思恋故郷星祭祝典序章組幻想物語行進作編自由組曲変奏協奏全終楽器低木金笛太鼓手元気世界永遠心君僕私言葉涙笑顔明道街朝夕"
)
HANGUL: Final = frozenset(
    "이다는에의가고을를은한하지기사로시그리서아도나어인들자나라스해게만대정있부과지수일구주전제오보장조성상비여동우모마원신소경내"
    "무없안유연공세저거선학문국간방중적면위바말물것생미교단니때라요와음악곡노래합주악보제일이삼사오번트럼펫호른본튜바플루클리넷"
    "색소폰오보에바순피아노첼로올린드럼베이스기타코넷소프알테너톤고음파트독서행진애국봄여름가을겨울사랑꿈별밤비눈바람꽃하늘강산"
)
CYRILLIC: Final = {
    letter: cost
    for cost, letters in (
        (2.3, "о"),
        (2.6, "еаинт"),
        (3.0, "српвлк"),
        (3.5, "мдубя"),
        (4.0, "ыьгзч"),
        (4.6, "йхжшюцф"),
        (5.6, "щэ"),
        (7.5, "ъё"),
    )
    for letter in letters
}
"""Negative log likelihood of Russian letters in nats."""
ACCENTED: Final = frozenset("äöüßéèêëàâáãåçñíìîïóòôõøúùûœæ")
CENTRAL: Final = frozenset("ąćęłńóśźżáčďéěíňřšťúůýžľôäöőüű")
"""Accented letters of Polish, Czech, Slovak and Hungarian."""
GREEK: Final = {
    form: cost + capital
    for letters, cost in (
        ("αοι", 2.4),
        ("ετσνηυρ", 2.8),
        ("πκμλς", 3.1),
        ("γδωχθφ", 4.0),
        ("άέίόήύώ", 3.8),
        ("βξζψϊϋΐΰ", 5.0),
    )
    for letter in letters
    for form, capital in ((letter, 0.0), (letter.upper(), 1.2))
    if len(form) == 1
}
"""Negative log likelihood of Greek letters in nats."""
