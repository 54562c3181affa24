#!/bin/sh
# Tests of the REPL: through a pipe, and through a real terminal (tmux). The last line is `N passed, N failed, N
# skipped`: what needs a tool that is missing is skipped.
#
#   BUILD=build sh tests/repl/run.sh

script=$(cd "$(dirname "$0")" && pwd)/run.sh
build=${BUILD:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
cag=$build/cag
work=$(mktemp -d) || exit 1
session=cag-repl-$$
passed=0
failed=0
skipped=0
trap 'tmux -L "$session" kill-server 2>/dev/null; rm -rf "$work"' EXIT
trap 'exit 130' INT TERM
cd "$work" || exit 1
export XDG_STATE_HOME="$work/state"

# result NAME: counts the status of the command before.
result() {
  if [ "$2" = 0 ]; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "FAILED $1"
    [ -z "$3" ] || printf '%s\n' "$3" | sed 's/^/  /'
  fi
}

# skip REASON NAME ...: counts tests that cannot be made here.
skip() {
  reason=$1
  shift
  for name in "$@"; do
    skipped=$((skipped + 1))
    echo "skipped: $name: $reason"
  done
}

# skip_part REASON WORDS: the same of all tests in the part of this file between the lines `# WORDS` and `# End: WORDS`.
skip_part() {
  sed -n "/^# $2\$/,/^# End: $2\$/s/^ *\(shows\|completes\|result\) '\([^']*\)'.*/\2/p" "$script" >"$work/part"
  while IFS= read -r line; do skip "$1" "$line"; done <"$work/part"
}

# --- Through a pipe ---

# prints NAME EXPECTED INPUT: what INPUT makes the REPL write to standard output.
prints() {
  got=$(printf '%s\n' "$3" | "$cag" repl 2>"$work/errors")
  [ "$got" = "$2" ]
  result "$1" $? "expected: $2
got:      $got
errors:   $(cat "$work/errors")"
}

# complains NAME STATUS WORDS INPUT: what it writes to standard error, and its exit status.
complains() {
  printf '%s\n' "$4" | "$cag" repl >/dev/null 2>"$work/errors"
  status=$?
  [ $status = "$2" ] && { [ -z "$3" ] || grep -qF -- "$3" "$work/errors"; }
  result "$1" $? "expected: status $2, $3
got:      status $status, $(cat "$work/errors")"
}

prints 'an expression is printed with its type' '3 : number' '1 + 2'
prints 'a text is printed as written' '"a" : text' '"a"'
prints 'print prints the bare text' 'a' 'print "a"'
prints 'definitions say nothing' '' 'x = 3'
prints 'what depends on a name follows its new definition' '6 : number
20 : number' 'a = 3
b = a * 2
b
a = 10
b'
prints 'a function may be defined again' '10 : number' 'f(x) = x
g(x) = f(x) * 2
f(x) = x + 3
g(2)'
prints 'an open bracket asks for another line' '[1, 2] : list' '[1,
2]'
prints 'a line that begins with a pipe goes on' '9 : number' '3
  |> (x => x^2)'
prints 'lines of an if belong together' '2 : number' 'if false
  then 1
  else 2'
prints 'a comment alone says nothing' '' '// nothing'
prints 'an error leaves what was defined' '3 : number' 'x = 3
sin(30)
x'
prints 'there is no prompt on a pipe' '' ''
prints ':type gives the type' 'angle' ':type 30deg'
prints ':list shows the definitions' 'x = 1
f(a) = a + 1' 'x = 1
f(a) = a + 1
:list'
prints ':clear forgets' '' 'x = 1
:clear
:list'
prints ':quit ends' '1 : number' '1
:quit
2'
prints 'a unique beginning names a command' '' ':q'
prints ':scene tells what is shown' 's: sphere, radius 10' 's = sphere(10)
show s
:scene'
prints ':hide takes what is shown out of the scene' 'b: box, 1 x 1 x 1' 's = sphere(10)
b = box(1)
show s, b
show s
:hide s
:scene'
prints ':hide takes an expression too' '' 'show sphere(3)
:hide sphere(3)
:scene'
complains ':hide names what is not shown' 2 '`t` is not shown' 't = 3
:hide t'
prints 'exit ends' '1 : number' '1
exit
2'
prints 'quit() ends' '1 : number' '1
quit()
2'
prints 'quit may be defined' '5 : number' 'quit = 5
quit'
prints 'help lists the commands' "$(printf ':help\n' | "$cag" repl)" 'help'
prints ':help shows documentation of a definition' 'r = 3
  the radius' '/// the radius
r = 3
:help r'
prints 'letters of all alphabets are names' '3 : number' 'радиус = 3
радиус'
prints 'values computed before an error are kept' '1 : number
2 : number' '1; 2; 1/0'

printf '%s\n' ':time 1 + 1' | "$cag" repl 2>&1 | grep -qE '^[0-9.e-]+ (ms|s)$'
result ':time tells how long it took' $?
printf '%s\n' ':help' | "$cag" repl 2>&1 | grep -q '^:render'
result ':help lists the commands' $?
printf '%s\n' ':help sphere' | "$cag" repl 2>&1 | grep -q '^sphere(radius)'
result ':help shows documentation of a built-in' $?
printf '%s\n' ':doc' | "$cag" repl 2>&1 | grep -qw 'bspline'
result ':doc lists the built-ins' $?
if command -v python3 >/dev/null; then
  told=$(python3 "$(dirname "$script")/widths.py" "$cag")
  result 'the lists of :help and :doc are as wide as the terminal at most' $? "$told"
else
  skip 'python3 is missing' 'the lists of :help and :doc are as wide as the terminal at most'
fi

complains 'an error shows its line' 1 '1 | sin(30)' 'sin(30)'
complains 'an error of names gives the nearest' 1 'did you mean `radius`?' 'radius = 3
raduis'
complains 'an unknown command gives the nearest' 2 'did you mean `:help`?' ':hlep'
complains 'an input cut off says what is open' 1 'never closed' '[1, 2'
complains 'a command that is not there says so' 2 'unknown command `:view`' ':view'
complains 'a command without its operand says what it expects' 2 ':load FILE' ':load'
complains ':type rejects a statement' 2 'expects an expression' ':type x = 1'
complains 'a script that is missing has status 3' 3 'missing.cag' ':load missing.cag'
complains 'nothing fails' 0 '' 'x = 1'

cat >part.cag <<'END'
/// how wide
width = 40
show box(width)
END
prints ':load adds the definitions of a script' '40 : number' ':load part.cag
width'
prints ':reload takes the script as it is now, and drops what was typed' '40 : number
width = 40' ':load part.cag
width = 3
:reload
width
:list'
got=$(echo 'width + 1' | "$cag" repl part.cag 2>&1)
[ "$got" = '41 : number' ]
result 'cag repl FILE loads the file' $? "$got"
echo 'x = 1' >once.cag
echo 'param height = 3 in 1..9' >param.cag
got=$(echo 'height' | "$cag" repl param.cag -D height=7 2>&1)
[ "$got" = '7 : number' ]
result '-D sets the params of the file' $? "$got"

printf '%s\n' 'r = 3' 'f(x) = x * r' 'r = 4' 'show sphere(r)' ':save saved.cag' | "$cag" repl >/dev/null 2>&1
[ "$("$cag" eval 'read_text("saved.cag")' 2>/dev/null)" ] && "$cag" run saved.cag 2>&1 | grep -q 'radius 4'
result ':save writes a script with the newest definitions' $? "$(cat saved.cag 2>&1)"
printf '%s\n' 'show box(10)' ':export box.stl' | "$cag" repl 2>&1 | grep -q 'wrote box.stl' && [ -s box.stl ]
result ':export writes a file and says its path' $?
if command -v povray >/dev/null; then
  printf '%s\n' 'show sphere(10), camera([90, -60, 40], size: [32, 24])' ':render ball.png' | "$cag" repl 2>&1 |
    grep -q 'wrote ball.png' && [ -s ball.png ]
  result ':render writes a picture and says its path' $?
else
  skip 'povray is missing' ':render writes a picture and says its path'
fi
printf '%s\n' 'x = 3' ':edit' 'x' | VISUAL='sed -i s/3/8/' "$cag" repl 2>&1 | grep -q '^8 : number$'
result ':edit takes back what the editor left' $?
# --- Commands ---

complains 'an ambiguous command lists the candidates' 2 '`:s` could be :scene, :save' ':s'
complains 'a command without operands rejects one' 2 ':list takes no argument, found `x`' ':list x   '
complains 'a word unlike any command refers to the list' 2 'unknown command `:qqqqqq`; :help lists all commands' ':qqqqqq'
complains ':doc gives the nearest built-in' 2 'unknown name `sphree`; did you mean `sphere`?' ':doc sphree'
complains ':doc gives the nearest definition' 2 'did you mean `flange_width`?' 'flange_width = 3
:doc flange_widht'
complains ':doc of an unknown word refers to the list' 2 ':doc lists the functions' ':doc qqqqqqqqqq'
complains ':doc of an unknown error code reports it' 2 'unknown name `E9999`' ':doc E9999'
complains ':reload requires a loaded script' 2 'no script is loaded; use :load FILE' ':reload'
complains ':clear also forgets the loaded script' 2 'no script is loaded' ':load part.cag
:clear
:reload'
complains ':save reports where it cannot write' 3 'cannot write missing/x.cag' 'x = 3
:save missing/x.cag'
complains ':export reports where it cannot write' 3 'missing' 'show box(1)
:export missing/x.stl'
complains ':export rejects an unknown format' 2 'unknown format `qqq`' 'show box(1)
:export x.qqq'
complains ':time rejects a statement' 2 ':time expects an expression' ':time x = 1'
complains ':type of an error is the error' 1 'sin expects an angle' ':type sin(1)'
complains 'the exit status is that of the first failure' 1 'unknown command' 'sin(1)
:view'
prints ':help of a command tells what it does' ':load FILE
  add the definitions of a script' ':help :load'
prints ':doc of an error code explains it' "$("$cag" explain E0301)" ':doc E0301'
prints ':list tells imports and the first line of definitions' 'puma560 (imported)
f(x) = { ...
a = 1' 'import std.robots: puma560
f(x) = {
  y = x
  y + 1
}
a = 1
:list'
got=$(printf ':load ~/part.cag\nwidth\n:export ~/home.stl\n' | HOME="$work" "$cag" repl 2>&1)
[ "$got" = "40 : number
wrote $work/home.stl" ]
result 'a path that begins with ~ is in the home directory' $? "$got"
prints 'a line that divides goes on' '4 : number' '8
  / 2'
prints 'a comment ends the input before it' '8 : number
2 : number' '8
// half
2'
prints 'words that go on with the line before' 'true : bool
[1, 3] : list' 'true
and true
[for i in 1..4
by 2: i]'
prints 'help() is the command, help(x) is none' "$(printf ':help\n' | "$cag" repl)" 'help()'
prints 'a block comment at the beginning of a line begins an input' '8 : number
3 : number' '8
/* three */ 3'
got=$(printf ':view\nsin(1)\n' | "$cag" repl --diagnostics json 2>&1)
printf '%s\n' "$got" | head -n 1 | grep -q '^{.*"message":"unknown command `:view`' &&
  printf '%s\n' "$got" | sed -n 2p | grep -q '^{.*"code":"E0301"'
result 'errors of the program are JSON if errors of scripts are' $? "$got"

cat >all.cag <<'END'
import std.robots: puma560
/// how wide
/// it is
width = 40
f(x) = x * width
assert f(1) == 40
show box(width), sphere(f(2))
END
printf '%s\n' ':load all.cag' ':hide sphere(f(2))' ':save again.cag' | "$cag" repl >/dev/null 2>&1
sed 's/, sphere(f(2))//' all.cag | diff - again.cag >difference
result ':save keeps imports, documentation and asserts' $? "$(cat difference)"

prints 'a word that only begins like one that goes on begins an input' '1 : number
5 : number' '1
order = 5
order'
prints 'a word alone on a line goes on' '1 : number' 'if true then 1
else
2'
prints 'exit; ends' '1 : number' '1
exit;
2'
prints 'a name that is defined beside others is no command' '5 : number
1 : number' 'x = 1
exit = 5
exit
x'
prints 'a text of letters and digits is no error code' '' ':doc Exxxx'
prints ':doc of an error code takes small letters' "$("$cag" explain E0301)" ':doc e0301'
prints 'a script that is loaded twice is reloaded once' 'x = 1' ':load once.cag
:load once.cag
:reload
:list'
got=$(printf ':load ~/part.cag\n' | env -u HOME "$cag" repl 2>&1)
[ "${got#*~/part.cag}" != "$got" ]
result 'without a home directory ~ is a name' $? "$got"
got=$(printf ':type 1\n' | "$cag" repl -q 2>&1)
[ "$got" = number ]
result '-q keeps answers' $? "$got"

# edits NAME EXPECTED EDITOR INPUT: compares what INPUT prints when EDITOR is the editor.
edits() {
  got=$(printf '%s\n' "$4" | VISUAL="$3" EDITOR=false "$cag" repl 2>&1)
  [ "$got" = "$2" ]
  result "$1" $? "expected: $2
got:      $got"
}
edits ':edit of a script loads it' '41 : number' 'sed -i s/40/41/' ':edit part.cag
width'
edits ':edit takes the script loaded last, and loads all again' '41 : number
42 : number' 'sed -i s/41/42/' ':load part.cag
width
:edit
width'
edits 'an editor that fails is named' 'error: the editor `false` failed; set VISUAL or EDITOR to another one
3 : number' '' 'x = 3
:edit
x'
edits ':edit of a script that is loaded loads all again' '3 : number
4 : number' 'sed -i s/1/4/' ':load part.cag
:load once.cag
x = 3
x
:edit once.cag
x'
got=$(printf 'x = 3\n:edit\nx\n' | VISUAL='' EDITOR='sed -i s/3/6/' "$cag" repl 2>&1)
[ "$got" = '6 : number' ]
result 'EDITOR is used where VISUAL is empty' $? "$got"
mkdir bin
printf '#!/bin/sh\nexec sed -i s/3/7/ "$1"\n' >bin/vi
chmod +x bin/vi
got=$(printf 'x = 3\n:edit\nx\n' | env -u VISUAL EDITOR= TMPDIR= PATH="$work/bin:$PATH" "$cag" repl 2>&1)
[ "$got" = '7 : number' ]
result 'vi is the editor where none is named' $? "$got"
got=$(printf 'x = 3\n:edit\n' | env -u TMPDIR -u VISUAL -u EDITOR PATH="$work/bin:$PATH" "$cag" repl 2>&1)
[ -z "$got" ]
result 'the same without the variables' $? "$got"
got=$(printf 'x = 3\n:edit\n' | VISUAL='kill -KILL $$ #' "$cag" repl 2>&1)
[ "${got#*failed; set VISUAL or EDITOR}" != "$got" ]
result 'an editor that is killed has failed' $? "$got"
got=$(printf 'x = 3\n:edit\n' | TMPDIR="$work/missing" VISUAL=true "$cag" repl 2>&1)
[ "${got#*cannot write "$work"/missing/cag-}" != "$got" ]
result ':edit reports where it cannot write' $? "$got"
got=$(printf 'x = 3\n:edit\nx\n' | TMPDIR="$work" VISUAL='sed -i s/3/5/' "$cag" repl 2>&1)
[ "$got" = '5 : number' ] && [ -z "$(find "$work" -name 'cag-*')" ]
result ':edit leaves no file' $? "$got"
[ ! -e "$XDG_STATE_HOME/cag/history" ]
result 'a pipe leaves no history' $?

# --- Through a terminal ---

screen() { tmux -L "$session" capture-pane -p -t repl 2>/dev/null; }

keys() { tmux -L "$session" send-keys -t repl "$@"; }

# wait_for WORDS: waits until the last line of the screen that is not blank is WORDS.
wait_for() {
  tries=0
  while [ $tries -lt 100 ] && [ "$(screen | sed 's/ *$//' | grep . | tail -n 1)" != "$1" ]; do
    sleep 0.02
    tries=$((tries + 1))
  done
}

# shows NAME WORDS: waits until a line of the screen is WORDS.
shows() {
  tries=0
  while [ $tries -lt 100 ]; do
    if screen | sed 's/ *$//' | grep -qxF -- "$2"; then
      result "$1" 0
      return
    fi
    sleep 0.05
    tries=$((tries + 1))
  done
  result "$1" 1 "no line: $2
$(screen)"
}

# completes NAME TEXT LINE: what Tab makes of a text that is typed, which is dropped then.
completes() {
  wait_for 'cag>'
  keys -l "$2"
  wait_for "cag> $2"
  keys Tab
  wait_for "cag> $3"
  got=$(screen | sed 's/ *$//' | grep . | tail -n 1)
  [ "$got" = "cag> $3" ]
  result "$1" $? "expected: cag> $3
got:      $got"
  keys C-c
  wait_for 'cag>'
}

open_terminal() {
  tmux -L "$session" -f /dev/null new-session -d -s repl -x 100 -y 40 \
    env XDG_STATE_HOME="$XDG_STATE_HOME" LC_ALL=C.UTF-8 TERM=screen NO_COLOR=1 "$cag"
}

# What a session shows
if ! command -v tmux >/dev/null; then
  skip_part 'tmux is missing' 'What a session shows'
elif ! open_terminal; then
  skip_part 'tmux does not start' 'What a session shows'
else
  shows 'a prompt waits' 'cag>'
  keys '1 + 2' Enter
  shows 'a value is shown' '3 : number'
  keys '[10,' Enter
  shows 'an open bracket changes the prompt' '...>'
  keys '20]' Enter
  shows 'the bracket closes' '[10, 20] : list'
  keys 'sphere_s' Tab '(2)' Enter
  shows 'Tab completes names' 'cag> sphere_surface(2)'
  keys 'bspline([[0, 0], [1, 1]], degr' Tab '1)' Enter
  shows 'Tab completes named arguments' 'cag> bspline([[0, 0], [1, 1]], degree: 1)'
  keys 'r = {height: 7, hue: 1}' Enter 'r.hei' Tab Enter
  shows 'Tab completes members' '7 : number'
  keys ':sc' Tab Enter
  shows 'Tab completes commands' 'cag> :scene'
  keys ':load par' Tab 't' Tab Enter 'width' Enter
  shows 'Tab completes files' '42 : number'
  echo 'span = 3' >gripper.cag
  completes 'Tab completes modules of the library' 'import std.ro' 'import std.robots'
  completes 'Tab completes scripts that can be imported' 'import gri' 'import gripper'
  completes 'Tab completes files in the text of an import' 'import "gri' 'import "gripper.cag'
  completes 'Tab completes names of the module that is imported' 'import std.robots: pand' 'import std.robots: panda'
  completes 'Tab completes names of a script that is imported' 'import gripper: s' 'import gripper: span'
  completes 'Tab completes files in the text of a function that reads one' 'read_text("gri' 'read_text("gripper.cag'
  completes 'Tab completes nothing in other texts' 'print "sphere_s' 'print "sphere_s'
  completes 'Tab completes names within the braces of a text' 'print "a {sphere_s' 'print "a {sphere_surface'
  completes 'Tab completes files behind :export' ':export grip' ':export gripper.cag'
  completes 'Tab completes files behind the beginning of a command' ':lo grip' ':lo gripper.cag'
  completes 'Tab completes names behind :help' ':help sphere_s' ':help sphere_surface'
  completes 'a bracket within a text opens nothing' 'print "(", sphere_s' 'print "(", sphere_surface'
  keys 'import std.robots as robots' Enter 'plate(width, thickness = 2) = width' Enter 'ball = sphere(5)' Enter 'turned = rotate(Z, 30deg)' Enter
  keys 'wqz_one = 1; wqz_two = 2; wqa = 3; радиол = 4; радиал = 5' Enter
  completes 'Tab goes on as far as all names agree' 'wqz' 'wqz_'
  completes 'Tab inserts nothing where names part already' 'wq' 'wq'
  completes 'Tab inserts whole letters' 'ра' 'ради'
  completes 'Tab completes members of a module' 'robots.puma5' 'robots.puma560'
  completes 'Tab completes members of a transform' 'turned.ori' 'turned.origin'
  completes 'Tab completes members of members' 'robots.puma560.conv' 'robots.puma560.convention'
  completes 'Tab completes arguments of functions defined here' 'plate(1, thickn' 'plate(1, thickness:'
  keys 'bspline(' Enter '[[0, 0], [1, 1]], degr' Tab '1)' Enter
  shows 'Tab completes named arguments of the line before' '...> [[0, 0], [1, 1]], degree: 1)'
  keys 'width = 3' Enter 'twice = 2 * width' Enter 'twice' Enter 'width = 50' Enter 'twice' Enter
  shows 'what depends on a name follows on a terminal' '100 : number'
  keys 'f(n) = f(n + 1)' Enter 'f(0)' Enter
  sleep 0.5
  keys C-c
  shows 'Ctrl-C stops an evaluation' 'interrupted'
  keys '5 * 5' Enter
  shows 'the session goes on after Ctrl-C' '25 : number'
  keys C-l 'double(n, t) = if n == 0 then t else double(n - 1, [t, t])' Enter
  keys 'double(60, 1)' Enter
  sleep 0.2
  keys C-c
  shows 'Ctrl-C stops the printing of what shares its parts' 'interrupted'
  if command -v povray >/dev/null; then
    keys 'show ball, camera([90, -60, 40], size: [4000, 4000])' Enter ':render large.png' Enter
    sleep 1
    keys C-c
    wait_for 'cag>'
    keys '5 * 7' Enter
    shows 'Ctrl-C stops a render and keeps the session' '35 : number'
    [ ! -e large.png ] && ! ls large* >/dev/null 2>&1
    result 'a render that was stopped leaves nothing' $? "$(ls)"
    keys ':clear' Enter 'show sphere(10), camera([90, -60, 40], size: [32, 24])' Enter ':render' Enter
    shows ':render says the path of the picture' 'wrote scene.png'
  else
    skip 'povray is missing' 'Ctrl-C stops a render and keeps the session' 'a render that was stopped leaves nothing' ':render says the path of the picture'
  fi
  keys 'never evaluated'
  wait_for 'cag> never evaluated'
  keys C-c
  wait_for 'cag>'
  keys '6 * 6' Enter
  shows 'Ctrl-C at the prompt drops the line' '36 : number'
  keys '[1,' Enter
  wait_for '...>'
  keys C-c
  wait_for 'cag>'
  keys '7 * 7' Enter
  shows 'Ctrl-C drops an input that is not complete' '49 : number'
  keys 'θ = 30deg' Enter 'sin(θ)' Enter
  shows 'letters of all alphabets can be typed' '0.5 : number'
  keys 'радиус = 8' Enter 'рад' Tab ' + 1' Enter
  shows 'Tab completes letters of all alphabets' '9 : number'
  keys 'half(n) = {' Enter
  wait_for '...>'
  keys '  k = n / 2' Enter '  k + 1' Enter '}' Enter 'half(4)' Enter
  shows 'a definition of several lines' '3 : number'
  keys ':clear' Enter C-l Up Up Up
  wait_for '}'
  keys Enter 'half(6)' Enter
  shows 'a definition of several lines comes back whole' '4 : number'
  keys '1000 + 1' Enter
  shows 'a value to find again' '1001 : number'
  keys Up BSpace '3' Enter
  shows 'the line before can be edited' '1003 : number'
  keys C-d
  tries=0
  while tmux -L "$session" has-session -t repl 2>/dev/null && [ $tries -lt 100 ]; do
    sleep 0.05
    tries=$((tries + 1))
  done
  ! tmux -L "$session" has-session -t repl 2>/dev/null
  result 'Ctrl-D ends' $?
  grep -qxF '1000 + 3' "$XDG_STATE_HOME/cag/history"
  result 'the history is kept' $?
  grep -qxF "$(printf 'half(n) = {\037  k = n / 2\037  k + 1\037}')" "$XDG_STATE_HOME/cag/history"
  result 'the history keeps texts of several lines whole' $?
  open_terminal
  shows 'a prompt waits again' 'cag>'
  keys Up Enter
  shows 'history is there in the next session' '1003 : number'
  keys C-l Up Up Up Up
  wait_for '}'
  keys Enter 'half(8)' Enter
  shows 'so are its texts of several lines' '5 : number'
  keys ':quit' Enter
fi
# End: What a session shows

# In a shell of a narrow window: stopping, going on, other sizes, many lines at once
if ! command -v tmux >/dev/null; then
  skip_part 'tmux is missing' 'In a shell of a narrow window: stopping, going on, other sizes, many lines at once'
else
  sleep 0.2
  tmux -L "$session" -f /dev/null new-session -d -s repl -x 40 -y 30 \
    env XDG_STATE_HOME="$XDG_STATE_HOME" LC_ALL=C.UTF-8 TERM=screen NO_COLOR=1 PS1='shell> ' bash --norc
  keys " $cag" Enter
  shows 'a prompt waits in a shell' 'cag>'
  keys 'forty = 40' Enter 'forty +'
  wait_for 'cag> forty +'
  keys C-z
  wait_for 'shell>'
  keys 'fg' Enter
  wait_for 'cag> forty +'
  keys ' 2' Enter
  shows 'Ctrl-Z stops at the prompt, and fg goes on with the line' '42 : number'
  keys -l 'len("0123456789012345678901234567890123456789"'
  sleep 0.2
  tmux -L "$session" resize-window -t repl -x 30 -y 30
  sleep 0.5 # tmux tells of a size that has stood for a quarter of a second
  tmux -L "$session" resize-window -t repl -x 60 -y 30
  sleep 0.5
  keys ')' Enter
  shows 'a line goes on in a window of another size' 'cag> len("0123456789012345678901234567890123456789")'
  shows 'and is read as it was typed' '40 : number'
  keys C-l ':help degree' Enter
  wait_for 'cag>'
  # A word of a longer line would stand at the left edge.
  told=$(screen | sed -n '/->/,/Example/p')
  [ "$(printf '%s\n' "$told" | grep -c '^  ')" -ge 4 ] && ! printf '%s\n' "$told" | grep -v -e '->' -e '^ ' | grep -q .
  result 'documentation is wrapped in a narrow window' $? "$(screen)"
  keys C-l ':help' Enter
  shows 'the list of commands is wrapped as well' '                command, or an error code; without NAME, all'
  awk 'BEGIN { for (i = 1; i <= 500; i++) printf "v%d = %d + 1\n", i, i; print "v500" }' >lines.txt
  tmux -L "$session" load-buffer lines.txt
  tmux -L "$session" paste-buffer -t repl
  shows '500 lines can be pasted' '501 : number'
  keys 'import std.materials as mat' Enter C-l ':doc mat.glazed' Enter
  shows 'documentation of what is imported by another name' 'glazed(color = "white")'
  keys C-d
  wait_for 'shell>'
  tmux -L "$session" kill-session -t repl
fi
# End: In a shell of a narrow window: stopping, going on, other sizes, many lines at once

# The state's folder cannot be made below a file.
: >"$work/file"
XDG_STATE_HOME=$work/file/state
unwritable='a history that cannot be written harms nothing'
if ! command -v tmux >/dev/null; then
  skip 'tmux is missing' "$unwritable"
else
  sleep 0.2
  if open_terminal 2>/dev/null; then
    keys '4 * 4' Enter
    shows "$unwritable" '16 : number'
    keys C-d
  else
    skip 'tmux does not start' "$unwritable"
  fi
fi

# Other environments: colors, other letters, a window of 40 columns, a history that has grown, and no place for one
if ! command -v tmux >/dev/null; then
  skip_part 'tmux is missing' 'Other environments: colors, other letters, a window of 40 columns, a history that has grown, and no place for one'
else
  # begins ENVIRONMENT ...: cag in a window of 40 columns, in this environment.
  begins() {
    sleep 0.2
    tmux -u -L "$session" -f /dev/null new-session -d -s repl -x 40 -y 60 env "$@" TERM=screen "$cag" $options
  }
  ends() {
    keys C-d
    tries=0
    while tmux -L "$session" has-session -t repl 2>/dev/null && [ $tries -lt 100 ]; do
      sleep 0.05
      tries=$((tries + 1))
    done
  }
  options=-q
  home=$work/home
  mkdir -p "$home/.local/state/cag"
  # 4,100 lines, of which two are equal, and one is empty.
  {
    seq 1 4097
    printf '4097\n\n4098'
  } >"$home/.local/state/cag/history"
  begins -u XDG_STATE_HOME -u NO_COLOR HOME="$home" LC_ALL=C
  shows '-q hides the greeting' 'cag>'
  ! screen | grep -q ':help lists'
  result 'nothing stands above the prompt' $? "$(screen)"
  [ "$(wc -l <"$home/.local/state/cag/history")" -le 2001 ] && [ "$(tail -n 1 "$home/.local/state/cag/history")" = 4098 ]
  result 'a history that has grown is cut at its beginning' $? "$(wc -l "$home/.local/state/cag/history")"
  keys Up Up Up
  wait_for 'cag> 4096'
  keys Enter
  shows 'lines of the history that are equal are one' '4096 : number'
  tmux -L "$session" capture-pane -e -p -t repl | grep -q "$(printf '4096 .*\033\[2m: number')"
  result 'types are dim where colors are' $? "$(tmux -L "$session" capture-pane -e -p -t repl)"
  keys 'θ = 30deg' Enter 'sin(θ)' Enter
  wait_for 'cag>'
  shows 'letters of all alphabets can be typed in every locale' '0.5 : number'
  keys 'sphere_surf' Tab
  wait_for 'cag> sphere_surface'
  keys Tab '(1)'
  shows 'Tab leaves a complete name alone' 'cag> sphere_surface(1)'
  keys C-c
  wait_for 'cag>'
  keys 'sphere' Tab
  shows 'Tab lists several proposals in columns' 'sphere          sphere_surface'
  shows 'with the line below them' 'cag> sphere'
  keys C-c C-l ':help' Enter
  shows 'the commands stand above their descriptions in a narrow window' ':time EXPR'
  shows 'which are indented' '    a value, and how long it took'
  keys C-l ':doc degree' Enter
  wait_for 'cag>'
  tmux -L "$session" capture-pane -e -p -t repl | grep -q "$(printf '\033')\["
  result 'documentation has colors where there are some' $? "$(screen)"
  ends
  [ "$(stat -c %a "$home/.local/state/cag/history")" = 600 ]
  result 'the history is for the user alone' $?
  options=
  begins -u XDG_STATE_HOME -u HOME LC_ALL=C.UTF-8
  shows 'a session begins without a place for a history' 'cag>'
  keys '3 * 3' Enter
  shows 'and evaluates' '9 : number'
  keys Up Enter
  wait_for 'cag>'
  ends
  if command -v povray >/dev/null; then
    mkdir -p parts.d
    echo 'show sphere(10), camera([90, -60, 40], size: [32, 24])' >parts.d/ball.cag
    printf '%s\n' ':load parts.d/ball.cag' ':render' | "$cag" repl 2>/dev/null | grep -qxF 'wrote ball.png' && [ -s ball.png ]
    result 'a picture without a name has that of the script loaded last' $?
  else
    skip 'povray is missing' 'a picture without a name has that of the script loaded last'
  fi
fi
# End: Other environments: colors, other letters, a window of 40 columns, a history that has grown, and no place for one

echo "$passed passed, $failed failed, $skipped skipped"
[ $failed = 0 ]
