#!/bin/sh
# Installs the other files of `make install`: man pages, completions, documents, examples, and files for editors.
#   sh tools/install.sh TABLES CONVERTER SHARE
# TABLES is the output of build/tools/tables, CONVERTER is build/tools/markdown_man, and SHARE is the folder share/ of the installation.
set -eu
tables=$1 converter=$(realpath "$2") share=$3
cd "$(dirname "$0")/.."

# put FOLDER FILE ...: copies files into a folder of SHARE.
put() {
  mkdir -p "$share/$1"
  folder=$share/$1
  shift
  install -m 644 "$@" "$folder"
}

sh tools/man.sh "$converter" "$share/man" < "$tables"
mkdir -p "$share/bash-completion/completions" "$share/zsh/site-functions"
sh tools/completion.sh bash < "$tables" > "$share/bash-completion/completions/cag"
sh tools/completion.sh zsh < "$tables" > "$share/zsh/site-functions/_cag"

put doc/cag README.md
for kind in docs examples; do
  find $kind -type f ! -name '.*' | while read -r file; do put "doc/cag/$(dirname "$file")" "$file"; done
done

editors=$(mktemp -d)
trap 'rm -rf "$editors"' EXIT
sh tools/editors.sh "$editors" < "$tables"
for kind in syntax ftdetect ftplugin; do put "vim/vimfiles/$kind" "$editors/vim/$kind/cag.vim"; done
(cd "$editors" && find emacs helix kate neovim vim-ale vscode -type f) | while read -r file; do put "cag/editors/$(dirname "$file")" "$editors/$file"; done
