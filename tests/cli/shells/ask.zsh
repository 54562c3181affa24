# Prints zsh's proposals at the end of a line, one per line:  zsh -f ask.zsh FOLDER 'cag render '    FOLDER has _cag.
# The proposals are intercepted on their way to a real line editor, in a pseudo terminal of zsh.
zmodload zsh/zpty
folder=$1 line=$2
zpty editor zsh -f -i
zpty -w editor "PS1= PROMPT_EOL_MARK= fpath=($folder \$fpath); autoload -U compinit && compinit -u -D"
zpty -w editor "zstyle ':completion:*' insert-tab false; setopt nobeep; LISTMAX=10000"
zpty -w editor "zle -C catcher complete-word catch; catch() { local -a got; compadd() { local -a some; builtin compadd -O some \"\$@\"; got+=(\$some); builtin compadd \"\$@\"; }; _main_complete; unfunction compadd; print -rl -- '<<<' \$got '>>>'; compstate[insert]= compstate[list]=; }; bindkey '^T' catcher; print RE''ADY"
zpty -r editor out '*READY*'
zpty -n -w editor "$line"$'\C-T'
zpty -r editor out '*>>>*'
print -r -- "${${out#*<<<}%>>>*}" | tr -d '\r' | grep . | sort -u
zpty -d editor
