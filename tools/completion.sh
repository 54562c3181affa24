#!/bin/sh
# Writes the completion script of a shell from the program's tables: commands, options, values of options, and operands (files by
# extension, error codes, names of functions).
#   build/tools/tables | sh tools/completion.sh bash|zsh > FILE
set -eu
shell=$1
exec awk -F '\t' -v shell="$shell" '
  # The extensions of the files that a command accepts as operands, or other kinds of operands.
  function operand_kind(command, operands) {
    if (operands == "-") return "nothing"
    if (operands ~ /CODE/) return "codes"
    if (operands ~ /EXPR/) return "names"
    if (operands ~ /FOLDER/) return "folders"
    if (operands ~ /^FILE/) return "cag"
    if (operands ~ /NAME/) return operands ~ /PATH|FILE/ ? "names cag" : "names"
    if (operands ~ /\.csv/) return "csv json"
    if (operands == "A B") return "exr png"
    return "cag"
  }
  # The same for the value of an option.
  function value_kind(argument, name, command) {
    if (name == "format") return "=" (command == "render" ? "exr png" : formats)
    if (argument ~ /^[a-z|]+$/) { gsub(/\|/, " ", argument); return "=" argument }
    if (argument == "DIR") return "folders"
    if (argument == "FILE" || argument == "OUT") return "files"
    return "nothing"
  }
  function quoted(s) { gsub(/\047/, "\047\\\047\047", s); return "\047" s "\047" }
  function described(s) { gsub(/[][\\:]/, "\\\\&", s); return s }
  function flags(i,   s) {
    s = letter[i] != "-" ? "-" letter[i] : ""
    if (name[i] != "-") s = s (s != "" ? " " : "") "--" name[i]
    return s
  }
  $1 == "command" { commands[++command_count] = $2; kind[$2] = operand_kind($2, $3); summary[$2] = $4 }
  $1 == "format" { formats = formats (formats ? " " : "") $2 }
  $1 == "error" { codes = codes (codes ? " " : "") $2 }
  ($1 == "function" || $1 == "constant") && !($2 in seen) { seen[$2] = 1; names = names (names ? " " : "") $2 }
  $1 == "option" { n++; of[n] = $2; letter[n] = $4; name[n] = $5; argument[n] = $6; help[n] = $7 }
  END { if (shell == "zsh") zsh(); else bash() }

  function bash(   c, i, k, m, list, parts) {
    for (c = 1; c <= command_count; c++) list = list (c > 1 ? " " : "") commands[c]
    print "# bash completion of cag"
    print "_cag_codes=\"" codes "\""
    print "_cag_names=\"" names "\""
    print "_cag_files() {\n  local IFS=$\047\\n\047 ending"
    print "  COMPREPLY+=($(compgen -d -- \"$1\"))\n  local word=$1\n  shift"
    print "  for ending; do COMPREPLY+=($(compgen -f -X \"!*.$ending\" -- \"$word\")); done"
    print "  compopt -o filenames 2> /dev/null\n}"
    print "_cag() {"
    print "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command= options= operands= i"
    print "  COMPREPLY=()"
    print "  [[ $word == \"=\" ]] && word="
    print "  [[ $before == \"=\" ]] && before=${COMP_WORDS[COMP_CWORD-2]}"
    print "  for ((i = 1; i < COMP_CWORD; i++)); do"
    print "    case \" " list " \" in *\" ${COMP_WORDS[i]} \"*) command=${COMP_WORDS[i]}; break;; esac"
    print "  done"
    print "  case \"$command $before\" in"
    for (i = 1; i <= n; i++) {
      if (argument[i] == "-") continue
      k = value_kind(argument[i], name[i], of[i])
      m = split(flags(i), parts, " ")
      printf "    \"%s %s\"%s) ", of[i], parts[1], (m == 2 ? "|\"" of[i] " " parts[2] "\"" : "")
      if (k ~ /^=/) printf "COMPREPLY=($(compgen -W \"%s\" -- \"$word\"))", substr(k, 2)
      else if (k == "folders") printf "_cag_files \"$word\""
      else if (k == "files") printf "_cag_any \"$word\""
      else printf ":"
      print "; return;;"
    }
    print "  esac\n  case $command in"
    for (c = 1; c <= command_count; c++) {
      printf "    %s) options=\"", commands[c]
      for (i = 1; i <= n; i++) if (of[i] == commands[c]) printf "%s ", flags(i)
      print "\" operands=\"" kind[commands[c]] "\";;"
    }
    print "    *) options=\"--help --version -h\";;\n  esac"
    print "  if [[ $word == -* ]]; then COMPREPLY=($(compgen -W \"$options\" -- \"$word\")); return; fi"
    print "  if [[ -z $command ]]; then COMPREPLY=($(compgen -W \"" list "\" -- \"$word\")); return; fi"
    print "  for i in $operands; do"
    print "    case $i in"
    print "      nothing) ;;"
    print "      codes) COMPREPLY+=($(compgen -W \"$_cag_codes\" -- \"$word\"));;"
    print "      names) COMPREPLY+=($(compgen -W \"$_cag_names\" -- \"$word\"));;"
    print "      *) _cag_files \"$word\" $operands; return;;"
    print "    esac\n  done\n}"
    print "_cag_any() {\n  local IFS=$\047\\n\047\n  COMPREPLY=($(compgen -f -- \"$1\"))\n  compopt -o filenames 2> /dev/null\n}"
    print "complete -F _cag cag"
  }

  function action(k,   parts, m, j, globs) {
    if (k ~ /^=/) return "(" substr(k, 2) ")"
    if (k == "folders") return "_files -/"
    if (k == "files") return "_files"
    if (k == "codes") return "_cag_codes"
    if (k == "names") return "_cag_names"
    if (k == "names cag") return "_cag_names_or_files"
    if (k == "nothing") return " "
    m = split(k, parts, " ") # a single name in parentheses would qualify the pattern
    for (j = 1; j <= m; j++) globs = globs (j > 1 ? "|" : "") parts[j]
    return "_files -g \"*." (m == 1 ? globs : "(" globs ")") "\""
  }
  function zsh(   c, i, k, both) {
    print "#compdef cag\n# zsh completion of cag"
    print "_cag_codes() { compadd -- " codes " }"
    print "_cag_names() { compadd -- " names " }"
    print "_cag_names_or_files() { _files -g \"*.cag\"; _cag_names }"
    print "_cag() {\n  local curcontext=$curcontext state line\n  typeset -A opt_args"
    print "  local -a commands=("
    for (c = 1; c <= command_count; c++) print "    " quoted(commands[c] ":" described(summary[commands[c]]))
    print "  )\n  _arguments -C \047(- *)\047{-h,--help}\047[show this]\047 \047(- *)--version[show the version]\047 \\"
    print "    \0471: :->command\047 \047*:: :->operands\047 && return"
    print "  if [[ $state == command ]]; then _describe -t commands command commands; return; fi"
    print "  case $words[1] in"
    for (c = 1; c <= command_count; c++) {
      print "    " commands[c] ") _arguments -s \\"
      for (i = 1; i <= n; i++) {
        if (of[i] != commands[c]) continue
        k = "[" described(help[i]) "]"
        if (argument[i] != "-") k = k ":" described(argument[i]) ":" action(value_kind(argument[i], name[i], of[i]))
        # -D and -I can be repeated.
        both = letter[i] ~ /[DI]/ ? "*" : ""
        if (letter[i] != "-") print "      " quoted(both "-" letter[i] (argument[i] != "-" ? "+" : "") k) " \\"
        if (name[i] != "-") print "      " quoted(both "--" name[i] (argument[i] != "-" ? "=" : "") k) " \\"
      }
      print "      " quoted("*:operand:" action(kind[commands[c]])) ";;"
    }
    print "  esac\n}"
    print "if [[ $funcstack[1] == _cag ]]; then _cag \"$@\"; else compdef _cag cag; fi"
  }'
