#!/bin/sh
# Writes C source that contains the given files.
#   embed.sh FILE.cag ...                 the standard library: cag_stdlib[] of { "std.name", text, length }
#   embed.sh --documents FILE ...         documents: cag_documents[] of { "path", text, length }
#   embed.sh --fonts FILE ...             the compiled-in fonts: cag_compiled_fonts[] of { bytes, size }
documents= fonts=
if [ "${1:-}" = --fonts ]; then
  fonts=1
  shift
  echo '#include "geom/letter/font.h"'
elif [ "${1:-}" = --documents ]; then
  documents=1
  shift
  echo '#include "interp/doc/doc.h"'
else
  echo '#include "interp/vm/stdlib.h"'
fi
i=0
for f in "$@"; do
  printf 'static const unsigned char file_%d[] = {\n' $i
  od -An -v -tx1 "$f" | sed 's/ \(..\)/0x\1,/g'
  echo '0};'
  i=$((i + 1))
done
if [ -n "$fonts" ]; then
  echo 'const CagFontFile cag_compiled_fonts[] = {'
  for j in $(seq 0 $((i - 1))); do printf '    {file_%d, sizeof file_%d - 1},\n' "$j" "$j"; done
  echo '};'
  exit
fi
if [ -n "$documents" ]; then echo 'const CagDocument cag_documents[] = {'; else echo 'const CagStdlibFile cag_stdlib[] = {'; fi
i=0
for f in "$@"; do
  if [ -n "$documents" ]; then name=$f; else name=std.$(basename "$f" .cag); fi
  printf '    {"%s", (const char *)file_%d, sizeof file_%d - 1},\n' "$name" $i $i
  i=$((i + 1))
done
echo '    {0, 0, 0}};'
