#!/bin/sh
# Tests of the files for editors: all examples and the standard library are tokenized by the grammar of Visual Studio Code (node and npm)
# and by the syntax of Vim, and the scopes in script.cag are checked. The last line is `N passed, N failed, N skipped`. Tests that need a
# missing tool are skipped.
#
#   BUILD=build sh tests/editors/run.sh
set -u
cd "$(dirname "$0")/../.."
build=${BUILD:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
passed=0 failed=0 skipped=0

# result NAME STATUS TEXT: counts a test, and shows the text if it failed.
result() {
  if [ "$2" = 0 ]; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "FAILED $1"
    [ -z "${3-}" ] || printf '%s\n' "$3" | head -n 12 | sed 's/^/  /'
  fi
}

# skip_part REASON COMMAND: counts the tests between the lines `# COMMAND` and `# End: COMMAND`, which cannot run here.
skip_part() {
  count=$(sed -n "/^# $2\$/,/^# End: $2\$/p" tests/editors/run.sh | grep -cE '^ *(has|lacks|result) ')
  skipped=$((skipped + count))
  echo "skipped: $count tests of $2: $1"
}

# has FILE WORD SCOPE: a token with this text must have a scope that ends with SCOPE.
has() {
  awk -F '\t' -v word="$2" -v scope="$3" '$1 == word && (" " $2 "$") ~ ("[ ]" scope "[$]") { found = 1 } END { exit !found }' "$1"
  result "\`$2\` is $3" $? "$(awk -F '\t' -v word="$2" '$1 == word' "$1")"
}
# lacks FILE WORD SCOPE: no token with this text may have it.
lacks() {
  ! awk -F '\t' -v word="$2" -v scope="$3" '$1 == word && (" " $2 "$") ~ ("[ ]" scope "[$]") { found = 1 } END { exit !found }' "$1"
  result "\`$2\` is not $3" $?
}

"$build/tools/tables" > "$work/tables" && sh tools/editors.sh "$work/editors" < "$work/tables"
result 'the files are written with the names of the program' $?
scripts=$(find examples stdlib -name '*.cag')
for name in $(awk -F '\t' '$1 == "function" || $1 == "constant" { print $2 }' "$work/tables"); do
  grep -q "[:|]$name[|)]" "$work/editors/vscode/syntaxes/cag.tmLanguage.json" && grep -q "^syn keyword cag.* $name\( \|\$\)\|^syn keyword cag.* ${name%?}\[" "$work/editors/vim/syntax/cag.vim" ||
    echo "$name"
done > "$work/missing"
[ ! -s "$work/missing" ]
result 'every built-in name is in both' $? "$(cat "$work/missing")"

# The packages come from npm, once per build folder.
packages=$build/npm-editors
if command -v node > /dev/null && command -v npm > /dev/null && [ ! -d "$packages/node_modules/vscode-textmate" ]; then
  mkdir -p "$packages"
  timeout 90 npm install --prefix "$packages" --fetch-retries=1 --fetch-timeout=30000 --no-audit --no-fund --silent vscode-textmate@9.3.2 vscode-oniguruma@2.0.1 > "$work/npm" 2>&1 < /dev/null ||
    echo "vscode-textmate could not be installed: $(tail -n 1 "$work/npm")"
fi
# the grammar of Visual Studio Code
if [ -d "$packages/node_modules/vscode-textmate" ]; then
  grammar=$work/editors/vscode/syntaxes/cag.tmLanguage.json
  NODE_PATH=$packages/node_modules
  export NODE_PATH
  for file in package.json language-configuration.json syntaxes/cag.tmLanguage.json; do
    node -e 'JSON.parse(require("fs").readFileSync(process.argv[1], "utf8"))' "$work/editors/vscode/$file"
    result "$file is JSON" $?
  done
  node tests/editors/tokens.js "$grammar" all $scripts > "$work/out" 2> "$work/err"
  code=$?
  [ $code = 0 ] && [ ! -s "$work/out" ] && grep -q '^[1-9][0-9]* tokens$' "$work/err"
  result 'no token of the scripts is left without a scope' $? "$(cat "$work/out" "$work/err")"
  node tests/editors/tokens.js "$grammar" scopes < tests/editors/script.cag > "$work/tokens"
  has "$work/tokens" import 'keyword.control.import.cag'
  has "$work/tokens" mat 'entity.name.namespace.cag'
  has "$work/tokens" nested 'comment.block.cag comment.block.cag'
  has "$work/tokens" comment 'comment.block.cag'
  has "$work/tokens" '/// what it is' 'comment.line.documentation.cag'
  has "$work/tokens" height 'variable.other.definition.cag'
  has "$work/tokens" 120 'constant.numeric.cag'
  has "$work/tokens" rad 'constant.numeric.cag keyword.other.unit.cag'
  has "$work/tokens" f 'entity.name.function.definition.cag'
  has "$work/tokens" more 'string.quoted.other.raw.cag'
  has "$work/tokens" in 'variable.parameter.label.cag'
  has "$work/tokens" in 'keyword.operator.word.cag'
  has "$work/tokens" in 'string.quoted.double.cag string.quoted.double.cag'
  has "$work/tokens" '\u{3b8}' 'constant.character.escape.cag'
  has "$work/tokens" '// tail' 'comment.line.double-slash.cag'
  has "$work/tokens" 'θ' 'variable.other.definition.cag'
  has "$work/tokens" for 'keyword.control.loop.cag'
  has "$work/tokens" sphere 'support.function.cag'
  has "$work/tokens" revolve 'support.function.cag'
  has "$work/tokens" glazed 'entity.name.function.member.cag'
  has "$work/tokens" '|>' 'keyword.operator.pipe.cag'
  lacks "$work/tokens" '// tail' 'string.quoted.double.cag'
else
  skip_part 'node, or its package vscode-textmate, is missing' 'the grammar of Visual Studio Code'
fi
# End: the grammar of Visual Studio Code

# groups MODE FILE ...: the output of tokens.vim.
groups() {
  MODE=$1
  shift
  EDITORS=$work/editors MODE=$MODE OUT=$work/groups timeout 300 vim -u NONE -i NONE -n -es -S tests/editors/tokens.vim "$@" < /dev/null > "$work/out" 2>&1
}
# the syntax of Vim
if command -v vim > /dev/null && vim --version | grep -q '+syntax'; then
  groups all $scripts
  [ $? = 0 ] && [ ! -s "$work/groups" ] && [ ! -s "$work/out" ]
  result 'Vim leaves nothing of the scripts without a group' $? "$(cat "$work/groups" "$work/out")"
  groups groups tests/editors/script.cag
  has "$work/groups" import cagImport
  has "$work/groups" nested cagComment
  has "$work/groups" what cagDocumentation
  has "$work/groups" height cagDefined
  has "$work/groups" rad cagUnit
  has "$work/groups" f cagDefinition
  has "$work/groups" more cagRaw
  has "$work/groups" in cagLabel
  has "$work/groups" in cagWordOperator
  has "$work/groups" in cagMember
  has "$work/groups" in cagText
  has "$work/groups" '\u{3b8}' cagEscape
  has "$work/groups" tail cagComment
  has "$work/groups" 'θ' cagDefinition
  has "$work/groups" for cagRepeat
  has "$work/groups" sphere cagFunction
  has "$work/groups" glazed cagMember
  has "$work/groups" '|>' cagPipe
  lacks "$work/groups" tail cagText
else
  skip_part 'vim, or its syntax, is missing' 'the syntax of Vim'
fi
# End: the syntax of Vim
echo "$passed passed, $failed failed, $skipped skipped"
[ $failed = 0 ]
