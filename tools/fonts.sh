#!/bin/sh
# Makes the fonts that are compiled into the program, from Debian's fonts-liberation2: fonts.sh FOLDER. Needs python3-fonttools.
#
# The fonts are subsets of Liberation Sans without hints. Its license (OFL) reserves the name for unchanged fonts, so they have another one.
set -eu
folder=$1
source=/usr/share/fonts/truetype/liberation2
# Latin, Greek, Cyrillic, and Hebrew, with combining marks, punctuation, currencies, arrows, signs of mathematics, and simple shapes.
characters="U+0020-007E,U+00A0-017F,U+0192,U+01CD-01DC,U+01FA-01FF,U+0218-021B,U+0237,U+02C6,U+02C7,U+02C9,U+02D8-02DD,U+0300-030C,U+0323,U+0327,U+0328,\
U+0384-03CE,U+03D1,U+03D5,U+0400-045F,U+0490,U+0491,U+05B0-05EA,U+05F0-05F4,U+1E80-1E85,U+1EBC-1EBD,U+1EF2,U+1EF3,U+2002-200F,U+2010-2027,U+2030,U+2032,U+2033,\
U+2039,U+203A,U+203C,U+2044,U+2070-208E,U+20A0-20BF,U+2116,U+2122,U+2126,U+212E,U+215B-215E,U+2190-2195,U+2202-2265,U+25A0-25CF,U+FB01,U+FB02,U+FB1D-FB4F"
for style in Regular Bold Italic BoldItalic; do
  # Debian's Python, which has the package.
  /usr/bin/python3 - "$source/LiberationSans-$style.ttf" "$characters" "$folder/Sans-$style.ttf" << 'END'
import sys
from fontTools import subset
from fontTools.ttLib import TTFont

source, characters, target = sys.argv[1:]
options = subset.Options(hinting=False, layout_features=["*"], name_IDs=[0, 1, 2, 3, 4, 6, 13, 14], notdef_outline=True, drop_tables=subset.Options().drop_tables + ["FFTM"])
font = subset.load_font(source, options)
subsetter = subset.Subsetter(options)
subsetter.populate(unicodes=subset.parse_unicodes(characters))
subsetter.subset(font)
# The sign for missing characters, which the slanted fonts do not have.
if font["glyf"][".notdef"].numberOfContours == 0:
    upright = TTFont(source.replace("BoldItalic", "Bold").replace("Italic", "Regular"))
    upright["glyf"][".notdef"].removeHinting()
    font["glyf"][".notdef"], font["hmtx"][".notdef"] = upright["glyf"][".notdef"], upright["hmtx"][".notdef"]
for name in font["name"].names:
    if name.nameID in (1, 3, 4, 6): name.string = str(name).replace("Liberation Sans", "Cag Sans").replace("LiberationSans", "CagSans")
font["head"].modified = font["head"].created
font.recalcTimestamp = False
font.save(target)
END
done
