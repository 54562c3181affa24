#!/bin/sh
# Copies the files for editors into a folder, and updates the names of the built-in functions and constants from the program's tables.
#   TABLES | sh tools/editors.sh FOLDER        TABLES is the output of build/tools/tables; FOLDER may be editors itself
set -eu
folder=$1
source=$(dirname "$0")/../editors
tables=$(mktemp)
trap 'rm -f "$tables" "$tables.new"' EXIT
cat > "$tables"
names() { awk -F '\t' -v kind="$1" '$1 == kind { print $2 }' "$tables" | LC_ALL=C sort -u | tr '\n' ' ' | sed 's/ $//'; }
functions=$(names function)
constants=$(names constant)
[ -n "$functions" ] && [ -n "$constants" ]

# Replaces the line after `"comment": "functions"` in the grammar, and the lines `syn keyword cagFunction` of Vim.
(cd "$source" && find . -type f) | while read -r file; do
  mkdir -p "$folder/$(dirname "$file")"
  awk -v functions="$functions" -v constants="$constants" '
    # Names that Vim would interpret as options are written with an optional last letter.
    function words(s) {
      s = " " s " "
      n = split("conceal cchar contained contains containedin display extend fold keepend nextgroup oneline skipempty skipnl skipwhite transparent", option, " ")
      for (i = 1; i <= n; i++) sub(" " option[i] " ", " " substr(option[i], 1, length(option[i]) - 1) "[" substr(option[i], length(option[i])) "] ", s)
      gsub(/^ | $/, "", s)
      return s
    }
    function alternatives(s) { gsub(/ /, "|", s); return s }
    function renew(s, list) { sub(/\(\?:[A-Za-z0-9_|]*\)\(\?!/, "(?:" alternatives(list) ")(?!", s); return s }
    /"comment": "functions"/ { kind = "f" }
    /"comment": "constants"/ { kind = "c" }
    kind && /"match":/ { $0 = renew($0, kind == "f" ? functions : constants); kind = "" }
    /^syn keyword cagFunction / { $0 = "syn keyword cagFunction contained " words(functions) }
    /^syn keyword cagConstant / { $0 = "syn keyword cagConstant contained " words(constants) }
    { print }' "$source/$file" > "$tables.new"
  cat "$tables.new" > "$folder/$file"
done
