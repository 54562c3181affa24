# cag test: what it shows, several at a time, and its report in XML.

script good.cag 'print 1 + 1 // expect: 2'
script bad.cag 'print "a<b" // expect: a>b'
script also_good.cag 'assert 1 < 2'

it 'a failed expectation shows the line, expected and got'
try test bad.cag
status 1
prints 'bad.cag:1'
prints 'expected: a>b'
prints 'got:      a<b'
prints '0 passed, 1 failed'

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
try_command xmllint --noout tests.xml
status 0
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
