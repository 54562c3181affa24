# The forms of diagnostics.

script bad.cag 'a = 1
f(x) = sin(x)
print f(30)
'
script two.cag 'print nothing1
print nothing2'

it 'an error shows its line, underlined, with the mend and the chain of calls'
try run bad.cag
status 1
says 'error: sin expects an angle'
says ' --> bad.cag:2:12'
says '2 | f(x) = sin(x)'
says '^'
says 'called from bad.cag:3:7'

it 'colors are there when asked for, and only then'
escape=$(printf '\033[')
try run bad.cag --color always
says "$escape"
try run bad.cag --color never
says_not "$escape"
try run bad.cag
says_not "$escape"

it 'JSON is one object a line, with all fields'
try run two.cag --diagnostics json
status 1
[ "$(wc -l < err)" -eq 2 ] || wrong 'not two lines'
[ "$(grep -c '^{.*}$' err)" -eq 2 ] || wrong 'not an object a line'
for field in '"severity":"error"' '"code":"E0201"' '"message":' '"file":"two.cag"' '"line":2' '"column":7' '"end_line":2' '"end_column":' '"related":'; do
  tail -n 1 err | tr -d ' ' > line
  grep -qF -e "$field" line || wrong "the second line lacks $field"
done

it 'the JSON reads as JSON'
# The program's own reader decides.
sed -n 1p err > first.json
script judge.cag 'e = read_json("first.json")
print e.code, e.line, e.column, type_of(e.message)'
try run judge.cag
status 0
prints_exactly 'E0201 1 7 text'

it 'strange texts in JSON are escaped'
printf 'print "a\\tb" + `c"\\d\n\001`\nprint (\"q\\\"\" - 1)\n' > strange.cag
try run strange.cag --diagnostics json
status 1
sed -n 1p err > first.json
try run judge.cag
status 0

it 'with JSON nothing else is on standard error'
script shows.cag 'ball = sphere(1)
show ball'
try run shows.cag --diagnostics json
status 0
says_nothing

it 'trace writes to standard error'
script trace.cag 'print trace(3, "three") + 1'
try run trace.cag
status 0
prints_exactly 4
says three
