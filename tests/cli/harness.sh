# The functions in which the tests of the command line are written:
#
#   it 'a missing script is status 3'      begins a test, and ends the previous one
#   try run missing.cag                    runs cag; its output is captured in the files `out` and `err`
#   status 3                               the expected exit status
#   says 'missing.cag'                     a text that standard error must contain; `prints`: standard output
#
# A test fails at its first unmet expectation, and is shown with the command that was run. A test that cannot run here, or only in part, is
# skipped:
#
#   it 'a picture is as said' povray       a program that the whole test needs: without it, `try` does nothing
#   if needs admesh; then ...              a program that a part of the test needs
#   skip 'it takes root'                   another reason
#
# A skipped test has neither passed nor failed, unless another of its expectations is not met.

test_name= test_state=

it() {
  case $test_state in
    good) passed=$((passed + 1)) ;;
    bad) failed=$((failed + 1)) ;;
    skipped | left_out) skipped=$((skipped + 1)) ;;
  esac
  test_name=$1 test_state=
  [ -z "$1" ] || test_state=good
  ran= code= bound=
  [ $# -eq 0 ] || shift
  needs "$@" || test_state=left_out
}

skip() {
  [ "$test_state" = good ] || return 0
  test_state=skipped
  echo "skipped: $test_name: $1"
}
# Whether the whole test is skipped. If so, its commands do nothing.
is_left_out() {
  [ "$test_state" = left_out ] || return 1
  code=0
  : > out
  : > err
}
have() { command -v "$1" > /dev/null 2>&1; }
needs() {
  for program in "$@"; do
    have "$program" || {
      skip "$program is missing"
      return 1
    }
  done
}
# For tests of files without read or write permission: root ignores permissions, so `try` runs cag without this privilege until the test
# ends.
bound=
needs_permissions() {
  [ "$(id -u)" -eq 0 ] || return 0
  needs setpriv || return 1
  bound='setpriv --inh-caps=-dac_override,-dac_read_search --bounding-set=-dac_override,-dac_read_search'
  $bound true 2> /dev/null || {
    bound=
    skip 'root may do all, and cannot give it up'
    return 1
  }
}
# skip_behind NAME TEST REASON: skips all tests of cases_NAME.sh after this one.
skip_behind() {
  sed "1,/^ *it '$2'[a-z0-9 ]*\$/d" "$here/cases_$1.sh" | sed -n "s/^ *it '\(.*\)'[a-z0-9 ]*$/\1/p" > behind
  while IFS= read -r behind; do
    it "$behind"
    skip "$3"
  done < behind
  it ''
}

wrong() {
  [ "$test_state" = good ] || [ "$test_state" = skipped ] || return 0
  test_state=bad
  echo "FAILED: $test_name"
  echo "  $1"
  echo "  ran: $ran, status $code"
  head -c 1500 out | sed 's/^/  out: /'
  head -c 3000 err | sed 's/^/  err: /'
}

# No command takes long: a run that hangs is killed and fails.
LONGEST=120
try() { with_input /dev/null "$@"; }
with_input() {
  is_left_out && return
  input=$1
  shift
  ran="cag $*"
  $bound timeout $LONGEST "$CAG" "$@" < "$input" > out 2> err
  code=$?
  check_end
}
# Runs a command other than cag.
try_command() {
  is_left_out && return
  ran=$*
  "$@" < /dev/null > out 2> err
  code=$?
  check_end
}
check_end() {
  [ $code -ne 124 ] || wrong "it hung"
  [ $code -lt 128 ] || [ $code -eq 130 ] || wrong "it crashed"
  ! grep -q 'Sanitizer\|runtime error:' err || wrong "a sanitizer found something"
}

status() { [ "$code" -eq "$1" ] || wrong "expected status $1"; }
says() { grep -qF -e "$1" err || wrong "standard error lacks: $1"; }
says_not() { ! grep -qF -e "$1" err || wrong "standard error has: $1"; }
prints() { grep -qF -e "$1" out || wrong "standard output lacks: $1"; }
says_nothing() { [ ! -s err ] || wrong "standard error is not empty"; }
prints_nothing() { [ ! -s out ] || wrong "standard output is not empty"; }
prints_exactly() { [ "$(cat out)" = "$1" ] || wrong "standard output is not: $1"; }
# A pattern, for variable text.
says_like() { grep -q -e "$1" err || wrong "standard error has nothing like: $1"; }
prints_like() { grep -q -e "$1" out || wrong "standard output has nothing like: $1"; }
holds() { [ "$(cat "$1")" = "$2" ] || wrong "the file $1 does not hold: $2"; }
same() { cmp -s "$1" "$2" || wrong "$1 differs from $2"; }
exists() { [ -s "$1" ] || wrong "the file $1 is missing or empty"; }
is_missing() { [ ! -e "$1" ] || wrong "the file $1 is there"; }
# Checks that a killed or failed run leaves no temporary files in a folder.
no_temporaries() { [ -z "$(ls -A "$1" | grep -e '\.tmp$' -e '^cag-' -e '^\.')" ] || wrong "temporaries are left in $1: $(ls -A "$1")"; }
bytes_at_most() { [ "$(wc -c < "$1")" -le "$2" ] || wrong "$1 is longer than $2 bytes"; }
# The first bytes of a file, in hexadecimal.
begins_with() { [ "$(head -c $((${#2} / 2)) "$1" | od -An -v -tx1 | tr -d ' \n')" = "$2" ] || wrong "$1 does not begin with $2"; }

# Writes a script with this name and text.
script() { printf '%s\n' "$2" > "$1"; }
