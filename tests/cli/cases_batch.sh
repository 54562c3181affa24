# cag batch: rows of a table, journal, limits, and tiles. cases_slurm.sh covers the queue.

script ball.cag 'param r = 10
show sphere(r)'
script endless.cag 'f(n) = f(n + 1)
print f(0)'
table() { cat > "$1"; }
# The fields of a column of a report, one row after the other.
column() { cut -d, -f"$2" "$1" | tail -n +2 | tr '\n' ' ' | sed 's/ $//'; }
column_is() { [ "$(column "$1" "$2")" = "$3" ] || wrong "column $2 of $1 is $(column "$1" "$2"), not $3"; }

it 'rows of a CSV are renders and exports, params are columns' povray
table jobs.csv <<'END'
script,output,size,quality,tolerance,r
ball.cag,a.png,32x24,draft,,5
ball.cag,b.stl,,,0.1,20
ball.cag,c.obj,,,,
END
try batch jobs.csv
status 0
prints_exactly '3 done, 0 failed, 0 skipped (already done)'
says_nothing
begins_with a.png 89504e470d0a1a0a
exists b.stl
exists c.obj
column_is jobs.report.csv 4 'done done done'
column_is jobs.report.csv 7 '1 1 1'
no_temporaries .
try export ball.cag -o expected.stl --tolerance 0.1 -D r=20
same b.stl expected.stl

it 'a second call does nothing' povray
try batch jobs.csv
status 0
prints_exactly '0 done, 0 failed, 3 skipped (already done)'
column_is jobs.report.csv 4 'already done already done already done'

it 'a changed row runs again, and an output that is gone' povray
sed -i 's/,20$/,21/' jobs.csv
rm c.obj
try batch jobs.csv
prints_exactly '2 done, 0 failed, 1 skipped (already done)'

it 'a changed script runs all its rows again' povray
echo '// more' >> ball.cag
try batch jobs.csv
prints_exactly '3 done, 0 failed, 0 skipped (already done)'

it 'a changed module runs what imports it again'
mkdir lib
script lib/part.cag 'side = 3'
script user.cag 'import "lib/part.cag" as part
show box([part.side, 1, 1])'
table module.csv <<'END'
script,output
user.cag,user.stl
END
try batch module.csv
prints_exactly '1 done, 0 failed, 0 skipped (already done)'
script lib/part.cag 'side = 4'
try batch module.csv
prints_exactly '1 done, 0 failed, 0 skipped (already done)'
try batch module.csv
prints_exactly '0 done, 0 failed, 1 skipped (already done)'

it '--fresh forgets what was done' povray
try batch jobs.csv --fresh
prints_exactly '3 done, 0 failed, 0 skipped (already done)'

it 'paths of rows are seen from the folder of the jobs'
mkdir elsewhere
cp ball.cag elsewhere
table elsewhere/jobs.csv <<'END'
script,output
ball.cag,here.stl
END
try batch elsewhere/jobs.csv --report told.csv
status 0
exists elsewhere/here.stl
exists told.csv
is_missing elsewhere/jobs.report.csv

it 'rows of JSON'
table jobs.json <<'END'
[{"script": "ball.cag", "output": "j1.stl", "r": 7, "tolerance": 0.1},
 {"script": "ball.cag", "output": "j2.stl", "r": "3 + 4", "tolerance": null, "size": ""}]
END
try batch jobs.json -v --tolerance 0.1
status 0
prints '2 done'
says 'row 1: wrote j1.stl'
try export ball.cag -o expected.stl --tolerance 0.1 -D r=7
same j1.stl expected.stl
same j2.stl expected.stl

it 'quotes, blanks and newlines of a CSV'
printf '\357\273\277script;output ;"r"\r\n"ball.cag"; "q 1.stl" ;"2 +\n 3"\r\n\r\n' > quotes.csv
try batch quotes.csv
status 0
exists 'q 1.stl'

it 'a film is one row, resumed by its frames' povray
script film.cag 'show sphere(10 + frame / frames)'
table film.csv <<'END'
script,output,frames,size,quality
film.cag,film.%02d.png,0..3,32x24,draft
END
try batch film.csv
status 0
prints_exactly '1 done, 0 failed, 0 skipped (already done)'
for i in 0 1 2 3; do exists film.0$i.png; done
rm film.02.png
try batch film.csv -v
says 'wrote film.02.png'
says_not 'film.01.png'
try render film.cag -o whole.%02d.png --frames 0..3 --size 32x24 --quality draft
same film.02.png whole.02.png

# The script asserts the time of each frame of a repeating film of 4 frames: 0, 1/4, 1/2, 3/4.
it '--loop sets time to frame/frames in the films of a table' povray
script loops.cag 'assert time == frame / 4
show sphere(10)'
table loops.csv <<'END'
script,output,frames,size,quality
loops.cag,loops.%02d.png,0..3,32x24,draft
END
try batch loops.csv
status 1
try batch loops.csv --loop
status 0
prints_exactly '1 done, 0 failed, 0 skipped (already done)'
try batch loops.csv --loop
prints_exactly '0 done, 0 failed, 1 skipped (already done)'
try batch loops.csv
status 1
table still.csv <<'END'
script,output,size,quality
loops.cag,still.png,32x24,draft
END
try batch still.csv --loop
status 2
says 'no row has frames'

it 'all problems of a file are told at once, with their rows'
table bad.csv <<'END'
script,output,size,frames,quality,tiles
nothere.cag,a1.png,,,,
ball.cag,a2.png,64x,,,
ball.cag,a3.png,,,best,
ball.cag,a4.foo,,,,
ball.cag,/proc/no/where/a5.png,,,,
ball.cag,a6.png,,0..3,,
ball.cag,a7.%04d.png,,,,
ball.cag,same.png,,,,
ball.cag,./same.png,,,,
ball.cag,a10.stl,64x48,,,
ball.cag,a11.png,,,,4x4
ball.cag,film.%03d.png,,0..2,,
ball.cag,film.002.png,,,,
ball.cag,,,,,
ball.cag,bad.report.csv,,,,
END
try batch bad.csv
status 2
prints_nothing
says "bad.csv:2: E0913: row 1: cannot read the script 'nothere.cag'"
says "bad.csv:3: E0912: row 2: size '64x': expected a size"
says "bad.csv:4: E0912: row 3: quality 'best'"
says "bad.csv:5: E0916: row 4: unknown format '.foo'"
says 'bad.csv:6: E0915: row 5: cannot write'
says 'bad.csv:7: E0914: row 6: all frames would be written to the same output'
says 'bad.csv:8: E0912: row 7: '
says 'bad.csv:10: E0914: row 9: '
says 'also the output of row 8'
says 'bad.csv:11: E0912: row 10: an export has no size'
says 'bad.csv:12: E0912: row 11: a picture in tiles needs its size'
says 'bad.csv:14: E0914: row 13: '
says 'bad.csv:15: E0916: row 14: the output is missing'
says 'nothing was run'
is_missing bad.csv.journal
is_missing bad.report.csv

it 'missing columns'
printf 'scritp,output\nball.cag,a.png\n' > columns.csv
try batch columns.csv
status 2
says "E0911: the column 'script' is missing"
says "if the column 'scritp' is meant, rename it"
try batch columns.csv --diagnostics json
says '"code":"E0911"'

it 'files that are no jobs'
: > empty.csv
printf '[{"script":' > broken.json
printf '{"script": "ball.cag"}' > record.json
printf '[3, {"script": "ball.cag", "output": "x.stl", "r": {"a": 1}}]' > values.json
printf 'script,output\n\377\376,x.stl\n' > bytes.csv
printf 'script,output\n"ball.cag,x.stl\n' > quote.csv
printf 'script,output\n' > norow.csv
printf 'script,output,output\nball.cag,x.stl,y.stl\n' > twice.csv
for f in empty.csv broken.json record.json values.json bytes.csv quote.csv norow.csv twice.csv; do
  try batch $f
  status 2
  says ': E091'
done
try batch nothere.csv
status 3
try batch ball.cag
status 2

it 'a failed row does not stop the others, and is tried again'
table some.csv <<'END'
script,output,r
ball.cag,s1.stl,1
ball.cag,s2.stl,-1
ball.cag,s3.stl,3
ball.cag,s4.stl,nothere
END
try batch some.csv --retries 2
status 1
prints_exactly '2 done, 2 failed, 0 skipped (already done)'
says 'some.csv:3: E0917: row 2: '
says 'some.csv:5: E0917: row 4: '
column_is some.report.csv 4 'done failed done failed'
column_is some.report.csv 7 '1 3 1 3'
is_missing s2.stl
sed -i 's/-1$/2/; s/nothere$/4/' some.csv
try batch some.csv
status 0
prints_exactly '2 done, 0 failed, 2 skipped (already done)'

# A renderer that fails at first.
mkdir flaky
cat > flaky/povray <<'END'
#!/bin/sh
case $* in *version*) exec /usr/bin/povray "$@" ;; esac
exit 1
END
chmod +x flaky/povray
it 'a renderer that fails is tried again' povray
table flaky.csv <<'END'
script,output,size,engine
ball.cag,flaky.png,32x24,povray
END
(PATH=$PWD/flaky:$PATH; try batch flaky.csv --retries 1; status 1; echo "$test_state" > state)
[ "$(cat state)" != bad ] || test_state=bad
column_is flaky.report.csv 7 2
try batch flaky.csv
status 0

it 'the time of a row is bounded'
table slow.csv <<'END'
script,output
endless.cag,e.stl
ball.cag,e2.stl
END
try batch slow.csv --max-time 1
status 1
prints_exactly '1 done, 1 failed, 0 skipped (already done)'
column_is slow.report.csv 8 '5 0'

it 'the memory of a row is bounded'
script memory.cag 'print len([for i in 0..<1e8: [i, i, i]])
show sphere(1)'
table memory.csv <<'END'
script,output
memory.cag,m.stl
END
try batch memory.csv --max-memory 64M
status 1
column_is memory.report.csv 8 5

# A renderer that never ends, identified by its odd argument.
mkdir hanging
cat > hanging/povray <<'END'
#!/bin/sh
exec sleep 71.3519
END
chmod +x hanging/povray
renders() { grep -l -a '71\.3519' /proc/[0-9]*/cmdline 2> /dev/null | grep -q .; }
table many.csv <<'END'
script,output,size,engine
ball.cag,k1.stl,,
ball.cag,k2.stl,,
ball.cag,k3.png,32x24,povray
ball.cag,k4.png,32x24,povray
ball.cag,k5.png,32x24,povray
END
mkdir temporary
for signal in TERM KILL; do
  it "after SIG$signal nothing runs, nothing is half-written, and a second call does the rest" povray
  rm -f many.csv.journal k*.stl k*.png
  ran="cag batch (SIG$signal)"
  (PATH=$PWD/hanging:$PATH TMPDIR=$PWD/temporary exec "$CAG" batch many.csv --jobs 2 > out 2> err) &
  child=$!
  for _ in 1 2 3 4 5 6 7 8 9 10; do
    sleep 0.3
    renders && [ -s k1.stl ] && [ -s k2.stl ] && break
  done
  sleep 0.3
  kill -$signal $child
  wait $child 2> /dev/null
  code=$?
  if [ $signal = TERM ]; then
    status 130
    prints '2 done, 0 failed, 0 skipped (already done), 3 not done'
    column_is many.report.csv 4 'done done not done not done not done'
  fi
  sleep 1
  ! renders || wrong 'a renderer still runs'
  no_temporaries .
  no_temporaries temporary
  try batch many.csv
  status 0
  prints_exactly '3 done, 0 failed, 2 skipped (already done)'
done

it 'a torn last line of the journal is passed over' povray
printf '{"what":"done","key":"00' >> many.csv.journal
try batch many.csv
status 0
prints_exactly '0 done, 0 failed, 5 skipped (already done)'
rm k1.stl
try batch many.csv
prints_exactly '1 done, 0 failed, 4 skipped (already done)'
try batch many.csv
prints_exactly '0 done, 0 failed, 5 skipped (already done)'

it 'killed at any moment, it ends with the same files'
table kills.csv <<'END'
script,output,r
ball.cag,z1.stl,1
ball.cag,z2.stl,2
ball.cag,z3.stl,3
ball.cag,z4.stl,4
ball.cag,z5.stl,5
ball.cag,z6.stl,6
END
for after in 0.01 0.03 0.05 0.07 0.1 0.15; do
  timeout -s KILL $after "$CAG" batch kills.csv --jobs 1 > /dev/null 2>&1
done
sleep 0.5
try batch kills.csv
status 0
no_temporaries .
for i in 1 2 3 4 5 6; do
  try export ball.cag -o expected.stl -D r=$i
  same z$i.stl expected.stl
done

it 'a journal is held by one batch'
(PATH=$PWD/hanging:$PATH exec "$CAG" batch flaky.csv --fresh > /dev/null 2>&1) &
child=$!
sleep 0.7
try batch flaky.csv
status 3
says 'another batch of this table is running'
kill -TERM $child
wait $child

it 'what is no journal stays as it is'
printf 'my\nown\ntext\n' > module.csv.journal
try batch module.csv --fresh
status 3
holds module.csv.journal 'my
own
text'

it 'a picture in tiles is the picture' povray
table tiles.csv <<'END'
script,output,size,quality,tiles
ball.cag,t.exr,200x150,draft,3x2
ball.cag,whole.exr,200x150,draft,
ball.cag,t.png,200x150,draft,2x2
ball.cag,whole.png,200x150,draft,
END
try batch tiles.csv
status 0
try compare t.exr whole.exr
status 0
try compare t.png whole.png
status 0
is_missing tiles.csv.tiles
try batch tiles.csv
prints_exactly '0 done, 0 failed, 4 skipped (already done)'

it 'tiles in a folder with odd letters' povray
mkdir 'o d%d'
cp ball.cag 'o d%d'
printf 'script,output,size,quality,tiles\nball.cag,t.exr,200x150,draft,2x2\n' > 'o d%d/a%d.csv'
try batch 'o d%d/a%d.csv'
status 0
try compare 'o d%d/t.exr' whole.exr
status 0
[ "$(ls 'o d%d' | wc -l)" -eq 5 ] || wrong "something is left: $(ls 'o d%d')"

it '--tiles is for all pictures' povray
table all.csv <<'END'
script,output,size,quality
ball.cag,all.exr,200x150,draft
ball.cag,all.stl,,
END
try batch all.csv --tiles 2x2
status 0
try compare all.exr whole.exr
status 0
try batch all.csv --tiles 0x2
status 2
try batch all.csv --tiles 20x20
status 2
says 'smaller than 32 pixels'

it 'a region of a picture is a part of it' povray
try render ball.cag -o region.exr --size 200x150 --quality draft --region 64x32+32+64
status 0
try compare region.exr whole.exr
status 1
try render ball.cag -o region.exr --size 200x150 --region 64x32+150+64
status 2
says 'exceeds the picture'
try render ball.cag -o region.exr --region 64x32
status 2

it 'options of a batch are checked'
try batch jobs.csv --jobs 0
status 2
try batch jobs.csv --retries -1
status 2
try batch jobs.csv --engine-queue pbs
status 2
try batch jobs.csv --report no/where/report.csv
status 3
try batch --element 0 jobs.json
status 3
says 'is not a plan of a batch'
try batch
status 2
try batch --help
status 0
prints 'cag batch poster.csv --tiles 4x4'

it 'a file with a line that is no journal is left alone'
printf 'script,output\nball.cag,line.stl\n' > line.csv
echo 'a shopping list' > line.csv.journal
try batch line.csv
status 3
says 'the file is not a journal'
holds line.csv.journal 'a shopping list'
truncate -s 1000 zeros.csv.journal
cp line.csv zeros.csv
try batch zeros.csv
status 3

it 'a journal that was torn at any place is taken up'
printf 'script,output,r\nball.cag,torn1.stl,1\nball.cag,torn2.stl,2\n' > torn.csv
try batch torn.csv
cp torn.csv.journal whole.journal
for size in 1 9 60 106 107 150; do
  head -c $size whole.journal > torn.csv.journal
  try batch torn.csv
  status 0
  prints_like '[012] done, 0 failed'
  try batch torn.csv
  prints_exactly '0 done, 0 failed, 2 skipped (already done)'
done

it 'two names of one file are one output'
ln -s torn1.stl link.stl
printf 'script,output\nball.cag,torn1.stl\nball.cag,link.stl\n' > link.csv
try batch link.csv
status 2
says 'E0914: row 2'

it 'what a killed check leaves'
printf 'script,output\n' > many.csv
for i in $(seq 300); do echo "ball.cag,many$i.stl" >> many.csv; done
for after in 0.01 0.02 0.03 0.04 0.05; do
  timeout -s KILL $after "$CAG" batch many.csv --jobs 1 > out 2> err
done
sleep 0.5
no_temporaries .
