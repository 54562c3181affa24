#!/bin/sh
# Writes the man pages into a folder: one for cag and one per command, made from the program's --help.
#   sh tools/man.sh PROGRAM FOLDER
set -eu
cag=$1 folder=$2
version=$("$cag" --version)

# --help as a page: its first line is the NAME, a line that ends in a colon begins a section.
page() {
  awk -v name="$1" -v version="$version" '
    function escape(s) { gsub(/\\/, "\\e", s); gsub(/-/, "\\-", s); if (s ~ /^[.\x27]/) s = "\\&" s; return s }
    function section(title) { if (open) print ".fi"; print ".SH " toupper(title); print ".nf"; open = 1 }
    NR == 1 { print ".TH " toupper(name) " 1 \"\" \"" version "\""; print ".SH NAME"
              sub(/^[^:]*: /, ""); print name " \\- " escape($0); next }
    /^Usage: / { section("SYNOPSIS"); sub(/^Usage: /, ""); print escape($0); usage = 1; next }
    /^[A-Z][a-z ]*:$/ { sub(/:$/, ""); section($0); usage = 0; next }
    usage && /^$/ { next }
    usage && /^[^ ]/ { section("DESCRIPTION"); usage = 0 }
    usage { sub(/^ +/, "") }
    { print escape($0) }
    END { if (open) print ".fi" }'
}

"$cag" --help | page cag > "$folder/cag.1"
for command in $("$cag" --help | sed -n '/^Commands:/,/^$/s/^  \([a-z]\{1,\}\).*/\1/p'); do
  "$cag" "$command" --help | page "cag-$command" > "$folder/cag-$command.1"
done
