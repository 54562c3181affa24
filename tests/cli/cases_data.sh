# JSON and CSV files that scripts read: what the formats allow, and the place of what they do not.

# Reads 1.txt, 2.txt ... and prints the value or the message of each, a line for each file.
script read_all.cag 'param format = "json"
param count = 1
read(f) = if format == "json" then read_json(f) else read_csv(f, separator: ";")
print join([for i in 1..count: attempt(() => "{read("{i}.txt")}", e => replace(e.message, "read_{format} cannot read \"{i}.txt\": ", ""))], "\n")'
# The next file has this text, in the escapes of printf, and gives this value or message.
files=0
case_of() {
  files=$((files + 1))
  printf "$1" > "$files.txt"
  printf '%s\n' "$2" >> expected
}
# Compares all the cases so far.
as_expected() {
  try run read_all.cag -D format="$1" -D count="$files"
  status 0
  diff expected out > differences || wrong "a value or a message differs: $(cat differences)"
  rm expected
  files=0
}

it 'texts, numbers, lists and records of JSON'
case_of ' [1, -2.5e+1 , 0.5E-1, true,false, null ]' '[1, -25, 0.05, true, false, none]'
case_of '{ }' '{}'
case_of '[\n]' '[]'
case_of '{"a": {"b": []}, "c d": "x"}' '{a: {b: []}, "c d": "x"}'
case_of '"\\u0041\\u00e9\\u20AC\\ud83d\\uDE00"' 'Aé€😀'
case_of '"\\"\\\\\\/"' '"\/'
case_of '["\\b\\f\\n\\r\\t"]' '["\u{8}\u{c}\n\u{d}\t"]'
as_expected json

it 'what is not JSON is refused with its place'
case_of '' 'line 1, column 1: the file ends where a value was expected'
case_of '[1, ' 'line 1, column 5: the file ends where a value was expected'
case_of '[1 2]' 'line 1, column 4: expected `,` or `]`'
case_of '{"a": 1 "b": 2}' 'line 1, column 9: expected `,` or `}`'
case_of '{"a" 1}' 'line 1, column 6: expected `:`'
case_of '{"a": 1, }' 'line 1, column 10: expected a name in quotes'
case_of '{a: 1}' 'line 1, column 2: expected a name in quotes'
case_of '{"a' 'line 1, column 2: a text that is never closed'
case_of '"a\nb"' 'line 1, column 1: a text that is never closed'
case_of '"a\tb"' 'line 1, column 3: a control character in a text: write \u0009'
case_of '["\\q"]' 'line 1, column 4: an unknown escape'
case_of '"\\' 'line 1, column 2: an unknown escape'
case_of '"\\u12G4"' 'line 1, column 6: expected four hexadecimal digits'
case_of '"\\u12' 'line 1, column 6: expected four hexadecimal digits'
case_of '"\\ud83d"' 'line 1, column 4: an incomplete surrogate pair'
case_of '"\\ud83dx\\ude00"' 'line 1, column 4: an incomplete surrogate pair'
case_of '"\\ud83d\\n"' 'line 1, column 4: an incomplete surrogate pair'
case_of '"\\ud83d\\u0041"' 'line 1, column 4: an incomplete surrogate pair'
case_of '"\\ud83d\\uf000"' 'line 1, column 4: an incomplete surrogate pair'
case_of '"\\ude00"' 'line 1, column 4: an incomplete surrogate pair'
case_of '"\\u0000"' 'line 1, column 4: a NUL character'
case_of '[\000]' 'line 1, column 2: a NUL character'
case_of '["\377"]' 'line 1, column 3: not UTF-8: the byte 0xff'
case_of 'nul' 'line 1, column 1: expected a value'
case_of '[,]' 'line 1, column 2: expected a value'
case_of '1e999' 'line 1, column 1: the number is too large'
case_of '1-2' 'line 1, column 1: the number is too large'
case_of '\n  1 2' 'line 2, column 5: unexpected text after the value'
as_expected json

it 'cells of CSV with quotes, empty cells and all ends of lines'
case_of 'a;b\r\n1;2\r\n' '[{a: 1, b: 2}]'
case_of 'a;b\r1;2\r' '[{a: 1, b: 2}]'
case_of 'a;b\n\n\r\n1;2' '[{a: 1, b: 2}]'
case_of 'a;b\n"x;y";"say ""no"""' '[{a: "x;y", b: "say \"no\""}]'
case_of 'a;b\n"two\nlines";3\n;4\n' '[{a: "two\nlines", b: 3}, {a: none, b: 4}]'
case_of '1;2\n3;4\n' '[[1, 2], [3, 4]]'
case_of 'a;b\n' '[]'
case_of '1;2\n""\n' '[[1, 2], [none]]'
as_expected csv

it 'what is no CSV is refused with its place'
case_of 'a;b\n"x"y;2' 'line 2, column 4: there is text after the closing quote of a cell'
case_of 'a;b\n"x' 'line 2, column 1: a quote that is never closed'
case_of 'a;b\n1;\000' 'line 2, column 3: a NUL character'
as_expected csv
