#!/bin/sh
# Writes the man pages below a folder: man1/cag.1 and one for each command, from the program's tables, and man7/cag-language.7, from
# docs/language-card.md. The pages are written as Markdown, which CONVERTER, build/tools/markdown_man, converts to man pages.
#   build/tools/tables | sh tools/man.sh CONVERTER FOLDER
set -eu
converter=$1
folder=$2
here=$(dirname "$0")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
tables=$work/tables
cat > "$tables"
if [ -n "${SOURCE_DATE_EPOCH-}" ]; then day=$(date -u -d "@$SOURCE_DATE_EPOCH" +%Y-%m-%d); else day=$(date -u +%Y-%m-%d); fi
version=$(awk -F '\t' '$1 == "version" { print $2 }' "$tables")
mkdir -p "$folder/man1" "$folder/man7"

# Converts the Markdown on standard input to a man page. The converter's output is adapted: a heading is one line without a paragraph
# macro after it, a paragraph with a quotation is a tagged paragraph, fonts are those of all man macro sets, and code is an example.
#   man_page NAME SECTION
man_page() {
  printf '.TH %s %s %s "cag %s" "cag"\n' "$(printf '%s' "$1" | tr a-z A-Z | sed 's/-/\\-/g')" "$2" "$day" "$version"
  "$converter" > "$work/page"
  awk '
    function flush(   i) { for (i = below && held ? 2 : 1; i <= held; i++) print line[i]; if (held) below = held = 0 }
    { gsub(/\\f\[C\]/, "\\fB"); gsub(/\\f\[\]/, "\\fP"); gsub(/\\f\[B\]/, "\\fB"); gsub(/\\f\[I\]/, "\\fI") }
    { gsub(/\^/, "\\(ha"); gsub(/~/, "\\(ti"); gsub(/`/, "\\(ga") }
    !/^[.]/ { gsub(/\047/, "\\(aq") }
    title { print ".SH " $0; title = 0; below = 1; next }
    $0 == ".SH" { flush(); title = 1; next }
    $0 == ".IP" { flush(); code = 1; next }
    code == 1 && $0 == ".nf" { if (!below) print ".PP"; print ".RS 4\n.EX"; getline; code = 2; below = 0; next }
    code == 2 && $0 == "\\fP" { getline; print ".EE\n.RE"; code = 0; next }
    $0 == ".PP" { flush(); line[held = 1] = $0; next }
    $0 == ".RS" && held == 2 { print ".TP"; print line[2]; below = held = 0; getline; quoted = 1; next }
    $0 == ".RE" && quoted { quoted = 0; next }
    held == 1 { line[held = 2] = $0; next }
    { flush(); below = 0; print }
    END { flush() }' "$work/page"
}

# Shared by all pages: what is outside of `code` in a text of the tables is literal in Markdown.
common='
  function literal(s) { gsub(/[][\\*_<>#&]/, "\\\\&", s); return s }
  function text(s,   out, n, part, i) {
    n = split(s, part, "`")
    for (i = 1; i <= n; i++) out = out (i % 2 ? literal(part[i]) : "`" part[i] "`")
    return out
  }
  function section(name) { print "\n# " name "\n" }
  # A term and its description.
  function term(head, story) { return head "\n\n> " text(story) "\n" }
'

command_page() {
  awk -F '\t' -v command="$1" "$common"'
    function usage(letter, name, argument,   s) {
      if (letter != "-") s = "**-" letter "**" (name != "-" ? ", " : "")
      if (name != "-") s = s "**--" name "**"
      if (argument ~ /^[a-z|]+$/) { gsub(/\|/, "**|**", argument); s = s " **" argument "**" }
      else if (argument != "-") s = s " *" literal(argument) "*"
      return s
    }
    function listed(title, rows, count,   i) {
      if (!count) return
      section(title)
      for (i = 1; i <= count; i++) print rows[i]
    }
    function examples(   i) {
      if (!example_count) return
      section("EXAMPLES")
      print "```"
      for (i = 1; i <= example_count; i++) print example[i]
      print "```"
    }
    function operand_text(name) { return operands[name] != "-" ? " " literal(operands[name]) : "" }
    $1 == "command" { names[++command_count] = $2; operands[$2] = $3; summary[$2] = $4; story[$2] = $5 }
    $1 == "example" && $2 == command { example[++example_count] = $3 }
    $1 == "example" && command == "" && $2 != last { last = $2; example[++example_count] = $3 }
    $1 == "option" && $2 == (command == "" ? "run" : command) {
      if ($3 == "own") own[++own_count] = term(usage($4, $5, $6), $7)
      else shared[++shared_count] = term(usage($4, $5, $6), $7)
    }
    $1 == "repl" && command == "repl" { repl[++repl_count] = term("**" literal($2) "**" ($3 != "-" ? " " text($3) : ""), $4) }
    $1 == "format" && command == "export" { format[++format_count] = term("**" $2 "**", $3) }
    END {
      section("NAME")
      if (command == "") print "cag - turn geometry scripts into meshes, scenes, and pictures"
      else print "cag-" command " - " text(summary[command])
      section("SYNOPSIS")
      if (command == "") {
        print "**cag** *COMMAND* \\[*OPERAND* ...\\] \\[*OPTION* ...\\]\n\n**cag**"
        section("DESCRIPTION")
        print "**cag** is a small declarative language for geometry. A script defines curves, surfaces, solids, and scenes. The program turns scripts into meshes, exact CAD files, scenes, drawings, and pictures. Without a command, it works interactively."
        section("COMMANDS")
        for (i = 1; i <= command_count; i++) print term("**" names[i] "**" operand_text(names[i]), summary[names[i]])
        listed("SHARED OPTIONS", shared, shared_count)
        section("OPERANDS")
        print "Instead of a file, `-` stands for standard input or output. `--` ends the options."
        section("ENVIRONMENT")
        print term("**VISUAL**, **EDITOR**", "the editor of `:edit` in the REPL (vi)")
        print term("**XDG_STATE_HOME**", "the folder of `cag/history`, the history of the REPL (`~/.local/state`)")
        print term("**NO_COLOR**", "if set, errors have no colors")
        print term("**TMPDIR**", "the folder of temporary files (`/tmp`)")
        print term("**PATH**", "the folders in which `povray` is searched for")
        examples()
      } else {
        print "**cag " command "**" operand_text(command) " \\[*OPTION* ...\\]"
        section("DESCRIPTION")
        print story[command] != "-" ? text(story[command]) : text(toupper(substr(summary[command], 1, 1)) substr(summary[command], 2) ".")
        listed("COMMANDS OF THE REPL", repl, repl_count)
        examples()
        listed("OPTIONS", own, own_count)
        listed("SHARED OPTIONS", shared, shared_count)
        listed("FORMATS", format, format_count)
      }
      section("EXIT STATUS")
      n = split("0|success;1|the script, a test, or the comparison failed;2|wrong usage;3|a file could not be read or written;4|the renderer failed;5|a limit was exceeded;130|interrupted", statuses, ";")
      for (i = 1; i <= n; i++) { split(statuses[i], part, "|"); print term(part[1], part[2]) }
      section("SEE ALSO")
      if (command != "") print "**cag**(1),"
      else for (i = 1; i <= command_count; i++) print "**cag-" names[i] "**(1),"
      print "**cag-language**(7)"
    }' "$tables"
}

command_page '' | man_page cag 1 > "$folder/man1/cag.1"
for command in $(awk -F '\t' '$1 == "command" { print $2 }' "$tables"); do
  command_page "$command" | man_page "cag-$command" 1 > "$folder/man1/cag-$command.1"
done

# The language card: its title becomes the name of the page, and the rows of its tables become terms. The names of the built-in
# functions, by family, follow.
language_page() {
  printf '# NAME\n\ncag-language - the language of cag scripts\n\n# DESCRIPTION\n\n'
  awk '
    /^```/ { code = !code }
    code { print; next }
    /^# / { next }
    /^## / { print "# " toupper(substr($0, 4)); next }
    /^\|[- |]*\|$/ { next }
    /^\| / {
      sub(/^\| /, ""); sub(/ \|$/, "")
      at = index($0, " | ")
      gsub(/\\\|/, "|")
      at = index($0, " | ")
      if (substr($0, 1, at - 1) !~ /^ *$/) print substr($0, 1, at - 1) "\n\n> " substr($0, at + 3) "\n"
      next
    }
    { print }' "$here/../docs/language-card.md"
  awk -F '\t' "$common"'
    $1 == "module" { modules = modules (modules ? ", " : "") "`" $2 "`" }
    $1 == "function" || $1 == "constant" {
      family = $3 == "-" ? "Of every script" : $3
      if (!(family in names)) order[++families] = family
      if (!((family, $2) in seen)) names[family] = names[family] (names[family] ? ", " : "") $2
      seen[family, $2] = 1
    }
    END {
      section("BUILT-IN NAMES")
      print "In the REPL, **:help** *NAME* shows the documentation of a name.\n"
      for (i = 1; i <= families; i++) print term(literal(order[i]), names[order[i]])
      section("STANDARD LIBRARY")
      print modules "."
      section("SEE ALSO")
      print "**cag**(1)"
    }' "$tables"
}
language_page | man_page cag-language 7 > "$folder/man7/cag-language.7"
