# Prints bash's proposals for the last word, one per line:  bash ask.bash COMPLETION cag render ''
. "$1"
shift
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
compopt() { :; } # bash expects to be completing for it
_cag
printf '%s\n' "${COMPREPLY[@]}" | sort
