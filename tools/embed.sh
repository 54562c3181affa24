#!/bin/sh
# Writes C source that holds the given standard library files: cag_stdlib[] of { "std.name", text, length }.
echo '#include "interp/eval/stdlib.h"'
i=0
for f in "$@"; do
  printf 'static const unsigned char file_%d[] = {\n' $i
  od -An -v -tx1 "$f" | sed 's/ \(..\)/0x\1,/g'
  echo '0};'
  i=$((i + 1))
done
echo 'const CagStdlibFile cag_stdlib[] = {'
i=0
for f in "$@"; do
  name=$(basename "$f" .cag)
  printf '    {"std.%s", (const char *)file_%d, sizeof file_%d - 1},\n' "$name" $i $i
  i=$((i + 1))
done
echo '    {0, 0, 0}};'
