#!/bin/sh
# Fails when an include crosses the layers: lang and geom see only themselves; interp sees all; nothing sees interp.
bad=$(grep -rnE '#include "(geom|interp)/' lang; grep -rnE '#include "(lang|interp)/' geom)
if [ -n "$bad" ]; then
  echo "$bad"
  echo "check-layers: an include crosses the layers (interp -> lang, interp -> geom, nothing else)"
  exit 1
fi
echo "check-layers: ok"
