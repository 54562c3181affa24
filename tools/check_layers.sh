#!/bin/sh
# Fails if an include crosses the layers: base sees only itself, lang and geom see base and themselves, and interp sees all.
bad=$(grep -rnE '#include "(lang|geom|interp)/' base; grep -rnE '#include "(geom|interp)/' lang; grep -rnE '#include "(lang|interp)/' geom)
if [ -n "$bad" ]; then
  echo "$bad"
  echo "check-layers: an include crosses the layers (interp -> lang, interp -> geom, all -> base, nothing else)"
  exit 1
fi
echo "check-layers: ok"
