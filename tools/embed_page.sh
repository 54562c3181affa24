#!/bin/sh
# Writes C source with the files of the page, which are compressed: embed_page.sh FILE.gz ...
echo '#include "live/page_files.h"'
i=0
for f in "$@"; do
  printf 'static const unsigned char file_%d[] = {\n' $i
  od -An -v -tx1 "$f" | sed 's/ \(..\)/0x\1,/g'
  echo '};'
  i=$((i + 1))
done
echo 'const CagPageFile cag_page_files[] = {'
i=0
for f in "$@"; do
  printf '    {"/%s", file_%d, sizeof file_%d},\n' "$(basename "$f" .gz)" $i $i
  i=$((i + 1))
done
echo '    {0, 0, 0}};'
