# cag test: its output, parallel runs, and its report in XML.

script good.cag 'print 1 + 1 // expect: 2'
script bad.cag 'print "a<b" // expect: a>b'
script also_good.cag 'assert 1 < 2'

it 'a failed expectation shows the line, expected and got'
try test bad.cag
status 1
prints 'bad.cag:1'
prints 'expected: a>b'
prints 'got:      a<b'
prints '0 passed, 1 failed, 0 skipped'

it 'the report does not depend on how many run at once'
for i in 1 2 3 4 5 6 7 8; do cp bad.cag "many_$i.cag"; done
try test many_*.cag --jobs 1
cp out one_by_one
try test many_*.cag --jobs 4
status 1
same out one_by_one

it 'the report in XML is well formed and tells all'
try test good.cag bad.cag also_good.cag --report tests.xml
status 1
if needs xmllint; then
  try_command xmllint --noout tests.xml
  status 0
fi
try_command cat tests.xml
prints 'tests="3" failures="1"'
prints 'expected: a&gt;b'

it 'a report that cannot be written is told'
try test good.cag --report nowhere/tests.xml
status 3
says 'nowhere'

it 'no job at all is refused'
try test good.cag --jobs 0
status 2

it 'the report in XML has the elements and counts that its readers ask for'
script endless.cag 'f(n) = f(n + 1)
print f(0)'
script crash.cag 'f(x) = 1 / x
g(x) = f(x - 1)
print g(1)'
try test good.cag bad.cag endless.cag crash.cag --max-time 1 --report all.xml
status 1
cat > junit.rng << 'END'
<grammar xmlns="http://relaxng.org/ns/structure/1.0" datatypeLibrary="http://www.w3.org/2001/XMLSchema-datatypes">
  <start><element name="testsuites"><optional><attribute name="name"/></optional>
    <ref name="counts"/>
    <zeroOrMore><element name="testsuite">
      <attribute name="name"/><ref name="counts"/>
      <zeroOrMore><element name="testcase">
        <attribute name="name"/><attribute name="classname"/><attribute name="time"><data type="decimal"/></attribute>
        <optional><choice>
          <element name="failure"><attribute name="message"/><optional><attribute name="type"/></optional><text/></element>
          <element name="skipped"><optional><attribute name="message"/></optional></element>
        </choice></optional>
      </element></zeroOrMore>
    </element></zeroOrMore>
  </element></start>
  <define name="counts">
    <attribute name="tests"><data type="nonNegativeInteger"/></attribute>
    <attribute name="failures"><data type="nonNegativeInteger"/></attribute>
    <optional><attribute name="errors"><data type="nonNegativeInteger"/></attribute></optional>
    <optional><attribute name="skipped"><data type="nonNegativeInteger"/></attribute></optional>
    <optional><attribute name="time"><data type="decimal"/></attribute></optional>

  </define>
</grammar>
END
if needs xmllint; then
  try_command xmllint --noout --relaxng junit.rng all.xml
  status 0
fi

it 'a test that never ends is ended, and one that fails shows its calls'
try test endless.cag crash.cag --max-time 1
status 1
prints 'E0603'
prints 'called from crash.cag:2'
prints '0 passed, 2 failed, 0 skipped'

it 'scripts of one name in several folders do not meet'
if needs povray; then
  for folder in one two three; do
    mkdir "$folder"
    script "$folder/scene.cag" "show sphere(10) |> material({color: \"$([ $folder = two ] && echo red || echo teal)\"}), camera([90, -60, 40], size: [32, 24])"
    "$CAG" render "$folder/scene.cag" -o "$folder/scene.png" > out 2> err || wrong 'there is no picture'
  done
  try test one two three --jobs 3
  status 0
  prints '6 passed, 0 failed, 0 skipped'
fi

it 'a picture that is not as its reference is kept, and --update renews the reference'
if needs povray; then
  cp two/scene.png one/scene.png
  try test one
  status 1
  prints 'one/scene.cag: the picture differs from one/scene.png'
  try test one --update
  status 0
  prints 'renewed'
  try test one
  status 0
fi

it 'the run with --picture is the one that the reference picture is of'
if needs povray; then
  script film.cag 'show sphere(10 + 8 * time), camera([90, -60, 40], size: [32, 24])'
  try render film.cag -o film.png -D time=1
  try test film.cag
  status 1
  echo '// run: -D time=1 --picture' >> film.cag
  try test film.cag -v
  status 0
  prints 'film.cag -D time=1 --picture (picture)'
fi

it 'a picture is skipped where POV-Ray is missing, and neither passes nor fails'
mkdir no_programs still
script still/ball.cag 'print 1 // expect: 1
show sphere(10), camera([90, -60, 40], size: [32, 24])'
printf 'no picture' > still/ball.png
without_povray() {
  ran="PATH without povray: cag $*"
  PATH=$PWD/no_programs "$CAG" "$@" < /dev/null > out 2> err
  code=$?
  check_end
}
without_povray test still --report still.xml
status 0
prints_exactly '1 passed, 0 failed, 1 skipped'
says 'cag test: still/ball.cag (picture) is skipped: '
says 'POV-Ray'
[ "$(grep -c 'tests="2" failures="0" errors="0" skipped="1"' still.xml)" -eq 2 ] || wrong 'the report in XML does not count it'
! needs xmllint || xmllint --noout --relaxng junit.rng still.xml 2> err || wrong 'the report in XML is not as its readers ask for'
grep -q '<testcase classname="still/ball.cag" name="still/ball.cag (picture)" time="0.000"><skipped message=' still.xml || wrong 'the report in XML does not name it'
without_povray test bad.cag still
status 1
prints '1 passed, 1 failed, 1 skipped'
without_povray test still -q
says_nothing
without_povray test still --no-pictures
prints_exactly '1 passed, 0 failed, 0 skipped'

it 'pictures of the built-in renderer are compared without POV-Ray'
mkdir preview
script preview/ball.cag 'param r = 10
show sphere(r), camera([90, -60, 40], size: [64, 48])
// run: --picture --engine preview --samples 2'
"$CAG" render preview/ball.cag --engine preview --samples 2 -o preview/ball.png > out 2> err || wrong 'there is no picture'
without_povray test preview
status 0
prints_exactly '2 passed, 0 failed, 0 skipped'
without_povray test preview -D r=14
status 1
prints 'preview/ball.cag: the picture differs from preview/ball.png'
"$CAG" render preview/ball.cag --quality draft --camera top -o preview/ball.png > out 2> err || wrong 'there is no picture'
without_povray test preview
status 1
sed -i 's/--engine.*/--quality draft --camera top/' preview/ball.cag
without_povray test preview
status 0
sed -i '/run:/d' preview/ball.cag
"$CAG" render preview/ball.cag --quality draft -o preview/ball.png > out 2> err || wrong 'there is no picture'
without_povray test preview --engine preview --quality draft
status 0
prints_exactly '2 passed, 0 failed, 0 skipped'
sed -i '$a // run: --picture --engine raytracer' preview/ball.cag
try test preview
status 1
prints 'found raytracer'

it 'what is skipped is a note in JSON'
script still/ball.cag 'show sphere(10), camera([90, -60, 40], size: [32, 24])'
without_povray test still --diagnostics json
status 0
prints_exactly '1 passed, 0 failed, 1 skipped'
says '{"severity":"note","code":null,"message":"skipped: '
says '"file":"still/ball.cag","test":"still/ball.cag (picture)"}'
[ "$(wc -l < err)" -eq 1 ] || wrong 'there is not one line'

it 'a test of the command line that lacks its tool is skipped, and one that fails besides has failed'
cat > counted.sh << 'END'
here=$1
passed=0 failed=0 skipped=0
. "$here/harness.sh"
ran=nothing code=0
: > out
: > err
it 'as a whole'
needs no-such-program || :
it 'in part'
prints_nothing
needs sh no-such-program || :
says_nothing
it 'in part, and the rest fails'
needs no-such-program || :
prints 'something'
it 'what there is'
needs sh && says_nothing
it ''
echo "$passed passed, $failed failed, $skipped skipped"
END
mkdir counted
try_command sh -c 'cd counted && sh ../counted.sh "$1"' sh "$here"
status 0
says_nothing
prints 'skipped: as a whole: no-such-program is missing'
prints 'FAILED: in part, and the rest fails'
[ "$(tail -n 1 out)" = '1 passed, 1 failed, 2 skipped' ] || wrong 'the last line is not the count'

script miss.cag 'print 1 // Expect: 1
print 2 // expects: 2
print 3 // expect : 3
print 4 // exepct: 5
print 5 // expected error: E0301
print 6 // expect error E0301
print 7 // expert: nobody
// What to expect: nothing. Except: this.'

it 'comments that look like expectations are reported'
try test miss.cag
status 1
prints 'miss.cag:1: `// Expect: 1` expects nothing; write `// expect:`'
prints 'miss.cag:2: `// expects: 2` expects nothing; write `// expect:`'
prints 'miss.cag:3: `// expect : 3` expects nothing; write `// expect:`'
prints 'miss.cag:4: `// exepct: 5` expects nothing; write `// expect:`'
prints 'miss.cag:5: `// expected error: E0301` expects nothing; write `// expect error:`'
prints 'miss.cag:6: `// expect error E0301` expects nothing; write `// expect error:`'
! grep -q 'miss.cag:[78]' out || wrong 'prose is taken for an expectation'
prints '0 passed, 1 failed, 0 skipped'

it 'failures are reported as JSON, one object a line'
try test bad.cag miss.cag --diagnostics json
status 1
prints '0 passed, 2 failed, 0 skipped'
says '"severity":"error"'
says '"file":"bad.cag","line":1,"test":"bad.cag","expected":"a>b","got":"a<b"'
says '"file":"miss.cag","line":6,"test":"miss.cag"'
cp err lines
[ "$(wc -l < lines)" -eq 7 ] || wrong 'there is not one line for each failure'
if needs python3; then
  try_command python3 -c 'import json; print(sorted({json.loads(l)["severity"] for l in open("lines")}))'
  prints "['error']"
fi
try test good.cag --diagnostics json
status 0
says_nothing

it 'what failed is told with its lines, and nothing of what passed'
script wrong.cag 'param h = 1
print h // expect: 1
// run: -D h=2
// expect: 3
// run: -D h=4'
script broken.cag 'x = 1
print x + ""'
try test good.cag wrong.cag broken.cag
status 1
says_nothing
prints_exactly 'FAILED wrong.cag -D h=2
  wrong.cag:4: the output is different
    expected: 3
    got:      2
FAILED broken.cag
  broken.cag:2: unexpected error: E0321
  error: cannot apply `+` to the number 1 and the text ""
   --> broken.cag:2:7
    |
  2 | print x + ""
    |       ^^^^^^ put the value into the text: "... {x}"
3 passed, 2 failed, 0 skipped'

it 'with -v what passed is told too, with its time'
try test good.cag wrong.cag -v
status 1
sed 's/ in [0-9]*\.[0-9][0-9] s$/ in T/' out > told
[ "$(cat told)" = 'passed good.cag in T
passed wrong.cag in T
FAILED wrong.cag -D h=2
  wrong.cag:4: the output is different
    expected: 3
    got:      2
passed wrong.cag -D h=4 in T
3 passed, 1 failed, 0 skipped' ] || wrong "it is told otherwise: $(cat told)"

it 'runs are chosen by their names, and have the definitions of the command line'
try test good.cag wrong.cag --filter h=4
status 0
prints_exactly '1 passed, 0 failed, 0 skipped'
try test wrong.cag -D h=5
status 1
prints 'wrong.cag:2: the output is different'
prints '    got:      5'
prints '1 passed, 2 failed, 0 skipped'
try test good.cag --filter nowhere
status 0
prints_exactly '0 passed, 0 failed, 0 skipped'

it 'standard input is tested under a name of its own'
printf 'print 1 // expect: 2\n' > input
with_input input test -
status 1
prints_exactly 'FAILED <stdin>
  <stdin>:1: the output is different
    expected: 2
    got:      1
0 passed, 1 failed, 0 skipped'

it 'folders stand for the scripts below them, and what is missing is told'
mkdir -p many/inner empty
for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
  echo "print $i // expect: $i" > "many/inner/$i.cag"
done
try test many good.cag
status 0
prints_exactly '21 passed, 0 failed, 0 skipped'
try test empty
status 0
says 'cag test: no scripts found'
prints_exactly '0 passed, 0 failed, 0 skipped'
try test nowhere.cag good.cag
[ "$code" -ne 0 ] || wrong 'the status is 0'
says 'nowhere.cag'

it 'the report in XML has each run with its failure'
printf 'print "a\\u{1}b \\"&\\" <i>" // expect: '"'\n" > signs.cag
try test good.cag wrong.cag signs.cag --report each.xml
status 1
sed 's/ time="[0-9]*\.[0-9][0-9][0-9]"/ time="T"/g' each.xml > told
printf '%s\n' '<?xml version="1.0" encoding="UTF-8"?>
<testsuites name="cag" tests="5" failures="2" errors="0" skipped="0" time="T">
  <testsuite name="good.cag" tests="1" failures="0" errors="0" skipped="0" time="T">
    <testcase classname="good.cag" name="good.cag" time="T"/>
  </testsuite>
  <testsuite name="wrong.cag" tests="3" failures="1" errors="0" skipped="0" time="T">
    <testcase classname="wrong.cag" name="wrong.cag" time="T"/>
    <testcase classname="wrong.cag" name="wrong.cag -D h=2" time="T"><failure message="not as expected">  wrong.cag:4: the output is different
    expected: 3
    got:      2
</failure></testcase>
    <testcase classname="wrong.cag" name="wrong.cag -D h=4" time="T"/>
  </testsuite>
  <testsuite name="signs.cag" tests="1" failures="1" errors="0" skipped="0" time="T">
    <testcase classname="signs.cag" name="signs.cag" time="T"><failure message="not as expected">  signs.cag:1: the output is different
    expected: &apos;
    got:      a b &quot;&amp;&quot; &lt;i&gt;
</failure></testcase>
  </testsuite>
</testsuites>' > expected
same told expected
