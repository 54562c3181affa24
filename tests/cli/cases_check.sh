# cag check: errors without running, warnings, exit status, JSON for editors.

script good.cag 'print 1'
script unused.cag 'a = 1
print 2'
script wrong.cag 'error_when_run = error("it ran")
print sin(30), error_when_run'

it 'a good script is well'
try check good.cag
status 0
prints_nothing
says_nothing

it 'an error is told with its mend, and nothing runs'
try check wrong.cag
status 1
says 'sin expects an angle, found a number'
says 'write 30deg or 30rad'
says_not 'it ran'

it 'a warning does not fail'
try check unused.cag
status 0
says 'warning: nothing uses a'

it 'JSON for editors'
try check wrong.cag unused.cag --diagnostics json
status 1
says '"severity":"error","code":"E0301"'
says '"severity":"warning","code":"E0900"'

it 'standard input can be checked'
with_input wrong.cag check -
status 1
says '<stdin>:2'

it 'a script that is not there is told'
try check nowhere.cag
status 3

it 'the examples, the cookbook and the library have nothing to warn of'
try check "$root/examples" "$root/stdlib" "$root/docs/cookbook"
status 0
prints_nothing
says_nothing
