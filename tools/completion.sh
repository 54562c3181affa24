#!/bin/sh
# Writes the completion of bash for the program, made from its --help.
#   sh tools/completion.sh PROGRAM > FILE
set -eu
cag=$1
commands=$("$cag" --help | sed -n '/^Commands:/,/^$/s/^  \([a-z]\{1,\}\).*/\1/p' | tr '\n' ' ')

# The options in a text of --help: the words that begin with - on lines that begin with one.
options() { sed -n 's/^  \(-[^ ]*\)\(, \(--[^ ]*\)\)\{0,1\}.*/\1 \3/p' | tr -d ',' | tr '\n' ' '; }

cat <<HEAD
# bash completion of cag
_cag() {
  local word=\${COMP_WORDS[COMP_CWORD]} before=\${COMP_WORDS[COMP_CWORD-1]} command= options= i
  for ((i = 1; i < COMP_CWORD; i++)); do
    case " $commands" in *" \${COMP_WORDS[i]} "*) command=\${COMP_WORDS[i]}; break;; esac
  done
  case \$before in
    --quality) COMPREPLY=(\$(compgen -W "draft normal final" -- "\$word")); return;;
    --engine) COMPREPLY=(\$(compgen -W "povray" -- "\$word")); return;;
    --diagnostics) COMPREPLY=(\$(compgen -W "text json" -- "\$word")); return;;
    --color) COMPREPLY=(\$(compgen -W "auto always never" -- "\$word")); return;;
  esac
  case \$command in
HEAD
for command in $commands; do
  echo "    $command) options=\"$("$cag" "$command" --help | options)\";;"
done
cat <<TAIL
    *) options="$("$cag" --help | options)";;
  esac
  if [[ \$word == -* ]]; then COMPREPLY=(\$(compgen -W "\$options" -- "\$word"))
  elif [[ -z \$command ]]; then COMPREPLY=(\$(compgen -W "$commands" -- "\$word"))
  else COMPREPLY=(\$(compgen -f -- "\$word")); fi
}
complete -o filenames -F _cag cag
TAIL
