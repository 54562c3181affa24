#!/bin/sh
# Writes the man pages below a folder: man1/cag.1 and one for each command, from the program's tables, and man7/cag-language.7, from
# docs/language-card.md.
#   build/tools/tables | sh tools/man.sh FOLDER
set -eu
folder=$1
here=$(dirname "$0")
tables=$(mktemp)
trap 'rm -f "$tables"' EXIT
cat > "$tables"
if [ -n "${SOURCE_DATE_EPOCH-}" ]; then day=$(date -u -d "@$SOURCE_DATE_EPOCH" +%Y-%m-%d); else day=$(date -u +%Y-%m-%d); fi
mkdir -p "$folder/man1" "$folder/man7"

# What all pages share: text becomes lines of troff, `words` in it are bold.
common='
  function plain(s) {
    gsub(/\\/, "\\e", s); gsub(/-/, "\\-", s); gsub(/\047/, "\\(aq", s); gsub(/\^/, "\\(ha", s); gsub(/~/, "\\(ti", s)
    return s
  }
  function start(s) { return s ~ /^[.]/ ? "\\&" s : s }
  function rich(s,   out, at) {
    s = plain(s)
    gsub(/`` `/, "\\fB\\(ga", s); gsub(/` ``/, "\\(ga\\fP", s)
    while ((at = index(s, "`")) > 0) {
      out = out substr(s, 1, at - 1)
      s = substr(s, at + 1)
      at = index(s, "`")
      if (at == 0) return out "\\(ga" s
      out = out "\\fB" substr(s, 1, at - 1) "\\fP"
      s = substr(s, at + 1)
    }
    return out s
  }
  function text(s) { print start(rich(s)) }
  function sentences(s,   n) {
    while ((n = match(s, /[.] [A-Z]/)) > 0) { text(substr(s, 1, n)); s = substr(s, n + 2) }
    if (s != "") text(s)
  }
  function heading(name, section) { printf ".TH %s %s %s \"cag %s\" \"cag\"\n", toupper(plain(name)), section, day, version }
'

page() {
  awk -F '\t' -v command="$1" -v day="$day" "$common"'
    function usage(letter, name, argument,   s) {
      if (letter != "-") s = "\\fB\\-" letter "\\fP" (name != "-" ? ", " : "")
      if (name != "-") s = s "\\fB\\-\\-" plain(name) "\\fP"
      if (argument ~ /^[a-z|]+$/) { gsub(/\|/, "\\fP|\\fB", argument); s = s " \\fB" argument "\\fP" }
      else if (argument != "-") s = s " \\fI" plain(argument) "\\fP"
      return s
    }
    function examples(   i) {
      if (!example_count) return
      print ".SH EXAMPLES\n.nf"
      for (i = 1; i <= example_count; i++) print start(plain(example[i]))
      print ".fi"
    }
    function listed(title, rows, count,   i) {
      if (!count) return
      print ".SH " title
      for (i = 1; i <= count; i++) print rows[i]
    }
    function finish() {
      examples()
      listed("OPTIONS", own, own_count)
      listed("SHARED OPTIONS", shared, shared_count)
      listed("FORMATS", format, format_count)
    }
    function term(head, story) { return ".TP\n" head "\n" start(rich(story)) }
    $1 == "version" { version = $2 }
    $1 == "command" { names[++command_count] = $2; operands[$2] = $3; summary[$2] = $4; story[$2] = $5 }
    $1 == "example" && $2 == command { example[++example_count] = $3 }
    $1 == "example" && command == "" && $2 != last { last = $2; example[++example_count] = $3 }
    $1 == "option" && $2 == (command == "" ? "run" : command) {
      if ($3 == "own") own[++own_count] = term(usage($4, $5, $6), $7)
      else shared[++shared_count] = term(usage($4, $5, $6), $7)
    }
    $1 == "repl" && command == "repl" { repl[++repl_count] = term("\\fB" $2 "\\fP" ($3 != "-" ? " " rich($3) : ""), $4) }
    $1 == "format" && command == "export" { format[++format_count] = term("\\fB" $2 "\\fP", $3) }
    END {
      name = command == "" ? "cag" : "cag-" command
      heading(name, 1)
      print ".SH NAME"
      print plain(name) " \\- " rich(command == "" ? "turn geometry scripts into meshes, scenes, and pictures" : summary[command])
      print ".SH SYNOPSIS"
      if (command == "") {
        print ".B cag\n.I COMMAND\n.RI [ OPERAND \" ...]\" \" \" [ OPTION \" ...]\"\n.br\n.B cag"
        print ".SH DESCRIPTION"
        sentences("`cag` is a small declarative language for geometry. A script defines curves, surfaces, solids, and scenes. The program turns scripts into meshes, exact CAD files, scenes, drawings, and pictures. Without a command, it works interactively.")
        print ".SH COMMANDS"
        for (i = 1; i <= command_count; i++) print term("\\fB" names[i] "\\fP" (operands[names[i]] != "-" ? " " rich(operands[names[i]]) : ""), summary[names[i]])
        listed("SHARED OPTIONS", shared, shared_count)
        print ".SH OPERANDS"
        sentences("Instead of a file, `-` stands for standard input or output. `--` ends the options.")
        print ".SH ENVIRONMENT"
        print term("\\fBVISUAL\\fP, \\fBEDITOR\\fP", "the editor of `:edit` in the REPL (vi)")
        print term("\\fBXDG_STATE_HOME\\fP", "the folder of `cag/history`, the history of the REPL (`~/.local/state`)")
        print term("\\fBNO_COLOR\\fP", "if set, errors have no colors")
        print term("\\fBTMPDIR\\fP", "the folder of temporary files (`/tmp`)")
        print term("\\fBPATH\\fP", "the folders in which POV-Ray is searched")
        examples()
      } else {
        print ".B cag " plain(command)
        if (operands[command] != "-") print start(plain(operands[command]))
        print ".RI [ OPTION \" ...]\""
        print ".SH DESCRIPTION"
        if (story[command] != "-") sentences(story[command])
        else sentences(toupper(substr(summary[command], 1, 1)) substr(summary[command], 2) ".")
        listed("COMMANDS OF THE REPL", repl, repl_count)
        finish()
      }
      print ".SH EXIT STATUS"
      n = split("0|success;1|the script, a test, or the comparison failed;2|wrong usage;3|a file could not be read or written;4|the renderer failed;5|a limit was exceeded;130|interrupted", statuses, ";")
      for (i = 1; i <= n; i++) { split(statuses[i], part, "|"); print term(part[1], part[2]) }
      print ".SH SEE ALSO"
      line = ""
      if (command != "") line = ".BR cag (1),\n"
      else for (i = 1; i <= command_count; i++) line = line ".BR cag\\-" names[i] " (1),\n"
      print line ".BR cag\\-language (7)"
    }' "$tables"
}

page '' > "$folder/man1/cag.1"
for command in $(awk -F '\t' '$1 == "command" { print $2 }' "$tables"); do
  page "$command" > "$folder/man1/cag-$command.1"
done

# The card of the language: a Markdown of headings, paragraphs, lists, code and tables of two columns. The names of the built-in
# functions follow it by their families.
{
  cat "$tables"
  printf 'card\n'
  cat "$here/../docs/language-card.md"
} | awk -v day="$day" "$common"'
  function close_code() { if (code) { print ".EE"; print ".RE"; code = 0 } }
  function flush() { if (paragraph != "") { sentences(paragraph); paragraph = "" } }
  !card && /^version\t/ { split($0, f, "\t"); version = f[2] }
  !card && /^(function|constant|module)\t/ {
    split($0, f, "\t")
    if (f[1] == "module") { modules = modules (modules ? ", " : "") "`" f[2] "`"; next }
    if (f[3] == "-") f[3] = "Of every script"
    if (!(f[3] in names)) order[++families] = f[3]
    if (!((f[3], f[2]) in seen)) names[f[3]] = names[f[3]] (names[f[3]] ? ", " : "") f[2]
    seen[f[3], f[2]] = 1
  }
  $0 == "card" && !card { card = 1; next }
  !card { next }
  /^```/ { flush(); if (code) { close_code() } else { print ".PP"; print ".RS 4"; print ".EX"; code = 1 } next }
  code { print start(plain($0)); next }
  /^# / { heading("cag-language", 7); print ".SH NAME"; print "cag\\-language \\- the language of cag scripts"; print ".SH DESCRIPTION"; fresh = 1; next }
  /^## / { flush(); print ".SH " toupper(plain(substr($0, 4))); fresh = 1; next }
  /^\|[- |]*\|$/ { next }
  /^\| / { flush(); sub(/^\| /, ""); sub(/ \|$/, ""); at = index($0, " | "); left = substr($0, 1, at - 1); right = substr($0, at + 3)
           gsub(/\\\|/, "|", left); gsub(/\\\|/, "|", right)
           if (left ~ /^ *$/) next
           print ".TP"; print start(rich(left)); sentences(right); fresh = 0; next }
  /^- / { flush(); print ".IP \\(bu 2"; paragraph = substr($0, 3); fresh = 0; next }
  /^  / { sub(/^ +/, ""); paragraph = paragraph " " $0; next }
  /^$/ { flush(); next }
  { if (paragraph == "" && !fresh) print ".PP"; fresh = 0; paragraph = paragraph (paragraph == "" ? "" : " ") $0 }
  END {
    flush()
    print ".SH BUILT\\-IN NAMES"
    print "In the REPL,"
    print ".B :help"
    print ".I NAME"
    print "shows the documentation of a name."
    for (i = 1; i <= families; i++) { print ".TP"; print start(plain(order[i])); text(names[order[i]]) }
    print ".SH STANDARD LIBRARY"
    text(modules ".")
    print ".SH SEE ALSO"
    print ".BR cag (1)"
  }' > "$folder/man7/cag-language.7"
