# cag batch: what rows may say, what they depend on, and how failed ones are told. cases_batch.sh has the rest.

script ball.cag 'param r = 10
show sphere(r)'
table() { cat > "$1"; }
column() { cut -d, -f"$2" "$1" | tail -n +2 | tr '\n' ' ' | sed 's/ $//'; }
column_is() { [ "$(column "$1" "$2")" = "$3" ] || wrong "column $2 of $1 is $(column "$1" "$2"), not $3"; }
# wrong_rows COLUMNS, then lines ROW | MESSAGE: each row is the only wrong one of a table.
wrong_rows() {
  columns=$1
  while IFS='|' read -r row message; do
    printf '%s\n%s\n' "$columns" "${row% }" > wrong.csv
    try batch wrong.csv
    status 2
    says "wrong.csv:2: ${message# }"
    says 'has 1 problem; nothing was run'
  done
}

it 'a wrong row is told'
mkdir folder.cag
wrong_rows script,output,frames,size,tiles <<'END'
-,a.stl,,, | E0913: row 1: cannot read the script '-': rows cannot share standard input
folder.cag,a.stl,,, | E0913: row 1: cannot read the script 'folder.cag': it is not a regular file
/no/where.cag,a.stl,,, | E0913: row 1: cannot read the script '/no/where.cag': No such file or directory
,a.stl,,, | E0913: row 1: the script is missing
ball.cag,ball,,, | E0916: row 1: the output 'ball' has no extension that determines its format
ball.cag,.png,,, | E0916: row 1: the output '.png' has no extension that determines its format
ball.cag,ball.,,, | E0916: row 1: the output 'ball.' has no extension that determines its format
ball.cag,a.b/c,,, | E0916: row 1: the output 'a.b/c' has no extension that determines its format
ball.cag,-,,, | E0916: row 1: the output '-' has no extension that determines its format
ball.cag,a%d%d.png,0..1,, | E0912: row 1: the output 'a%d%d.png' has several placeholders for a frame number
ball.cag,a%q.png,0..1,, | E0912: row 1: a % in the output 'a%q.png' is not a placeholder for a frame number
ball.cag,a%d.png,0..2000000,, | E0912: row 1: with this row, the batch has more than 1000000 pictures
ball.cag,a.png,,640x32,1x2 | E0912: row 1: tiles 1x2 of a picture of 640 by 32 pixels are smaller than 32 pixels
ball.cag,a.png,,32x640,2x1 | E0912: row 1: tiles 2x1 of a picture of 32 by 640 pixels are smaller than 32 pixels
ball.cag,a.stl,,,2x2 | E0912: row 1: an export has no tiles
ball.cag,a.stl,0..3,, | E0912: row 1: an export has no frames
END

it 'a script that may not be read is told'
if needs_permissions; then
  cp ball.cag secret.cag
  chmod 000 secret.cag
  printf 'script,output\nsecret.cag,a.stl\n' > secret.csv
  try batch secret.csv
  status 2
  says "cannot read the script 'secret.cag': Permission denied"
fi

it 'an output is none of the files that the batch needs'
printf '[{"script": "ball.cag", "output": "own.json"}]' > own.json
try batch own.json
status 2
says 'E0914: row 1: the output'
says 'own files'
try batch own.json --diagnostics json
status 2
says '"row":1'
says_like '"help":"choose another name"'
printf 'script,output\nball.cag,/zz-of-cag-test.stl\nball.cag,/./zz-of-cag-test.stl\n' > root.csv
try batch root.csv
status 2
says "E0914: row 2: the output '/zz-of-cag-test.stl' is also the output of row 1"
is_missing /zz-of-cag-test.stl

it 'of many problems the first are told'
{
  echo script,output
  for i in $(seq 60); do echo ball.cag,a; done
} > fifty.csv
try batch fifty.csv
status 2
says 'row 50:'
says_not 'row 51:'
says 'has 60 problems; nothing was run'
says 'only the first ones are listed'

it '-D frames=N is the length of all films'
printf 'script,output,frames,size,quality\nball.cag,film.%%d.png,2..3,32x24,draft\n' > film.csv
for frames in 3 x 3x; do
  try batch film.csv -D frames=$frames
  status 2
  says "E0912: row 1: frames 2..3 exceed -D frames=$frames"
done

it 'a film tells its frames the length, and a percent sign stays' povray
script frames.cag 'param q = 0
assert frames == 8 and q == 1
show sphere(10)'
printf 'script,output,frames,size,quality\nframes.cag,n%%%%%%d.png,2..3,32x24,draft\nframes.cag,one.png,3..3,32x24,draft\n' > film.csv
try batch film.csv -D frames=8 -D q=1
status 0
exists n%2.png
exists n%3.png
exists one.png

it 'one tile is the whole picture' povray
printf 'script,output,size,quality,tiles\nball.cag,one.exr,64x48,draft,1x1\n' > tile.csv
try batch tile.csv -v
status 0
says 'row 1: wrote one.exr'
says_not 'tile'
is_missing tile.csv.tiles

it 'tiles are told with -v, and one that fails' povray
printf 'script,output,size,quality,tiles\nball.cag,t.exr,64x64,draft,2x1\n' > tile.csv
try batch tile.csv -v --threads 1
status 0
says 'row 1: tile 1 of 2 in'
says 'row 1: tile 2 of 2 in'
script fails.cag 'show nowhere'
printf 'script,output,size,quality,tiles\nfails.cag,t.exr,64x64,draft,2x1\n' > tile.csv
try batch tile.csv
status 1
prints_exactly '0 done, 1 failed, 0 skipped (already done)'
says 'E0917: row 1: tile 1 of 2: fails.cag:1: '
column_is tile.report.csv 4 failed

it 'names that begin with - are files'
cp ball.cag -- -s.cag
printf 'script,output\n-s.cag,-o.stl\n' > minus.csv
try batch minus.csv
status 0
exists ./-o.stl

it 'modules of -I, and all that scripts name, belong to what a row depends on'
mkdir lib other
script lib/part.cag 'import second
side = second.side'
script lib/second.cag 'import part // in a ring, which is an error only where it is run
side = 3'
script other/size.txt 'not read'
script user.cag '// "lib" is a folder, "nowhere.txt" is not there, and this quote is alone: "
// import
names = ["other/size.txt", "other/size.txt", ""]
show box([1, 2, 3])'
printf 'script,output\nuser.cag,user.stl\nuser.cag,two.stl\n' > user.csv
runs() {
  try batch user.csv -I lib --jobs 5000
  status 0
  prints_exactly "$1 done, 0 failed, $((2 - $1)) skipped (already done)"
}
runs 2
runs 0
script other/size.txt 'changed'
runs 2
sed -i 's/^names.*/import second/' user.cag
script lib/part.cag 'side = 4'
script lib/second.cag 'import part
side = part.side'
runs 2
runs 0
script lib/part.cag 'side = 5'
runs 2
: > two.stl # an output without bytes is none
runs 1

it 'a large file counts by its size and time'
truncate -s 65M large.bin
script large.cag '// reads "large.bin"
show box(1)'
printf 'script,output\nlarge.cag,large.stl\n' > large.csv
try batch large.csv
prints_exactly '1 done, 0 failed, 0 skipped (already done)'
try batch large.csv
prints_exactly '0 done, 0 failed, 1 skipped (already done)'
truncate -s 66M large.bin
try batch large.csv
prints_exactly '1 done, 0 failed, 0 skipped (already done)'

it 'a param names a file that the row depends on'
script reads.cag 'param file = ""
print read_text(file)
show box(1)'
echo 1 > a.txt
echo 1 > b.txt
printf 'script,output,file\nreads.cag,r1.stl,"""a.txt"""\nreads.cag,r2.stl,b.txt\n' > reads.csv
try batch reads.csv -q
prints_nothing
echo 2 > a.txt
try batch reads.csv
prints_exactly '1 done, 0 failed, 1 skipped (already done)'

it 'a row that takes too much memory beside its values is stopped'
printf 'script,output,tolerance\nball.cag,much.stl,0.00002\n' > much.csv
try batch much.csv --max-memory 2M
status 1
column_is much.report.csv 8 5
is_missing much.stl

# The processes of a batch, by the script that they run.
child_of() { grep -l -a "$1" /proc/[0-9]*/cmdline 2> /dev/null | cut -d/ -f3 | while read -r p; do
  tr '\0' ' ' 2> /dev/null < "/proc/$p/cmdline" | grep -q ' export ' && echo "$p"; done; }
script endless.cag 'f(n) = f(n + 1)
print f(0)'
printf 'script,output\nendless.cag,killed-%d.stl\n' $$ > killed.csv
it 'a process that somebody kills is told'
ran='cag batch killed.csv (its process is killed)'
"$CAG" batch killed.csv > out 2> err &
batch=$!
process=
patience=200
while [ -z "$process" ] && [ $patience -gt 0 ]; do
  sleep 0.1
  process=$(child_of "killed-$$.stl")
  patience=$((patience - 1))
done
kill -KILL ${process:-$batch}
wait $batch
code=$?
status 1
says 'E0917: row 1: killed by signal 9 (Killed); the system may have run out of memory'

# The bar on a terminal: with counts of what is done, at work, failed, and the time that is left.
it 'a batch on a terminal shows its progress'
if needs python3; then
  script slow.cag 'print sum([for i in 0..3e6: i])
show box(1)'
  {
    echo script,output,r
    echo ball.cag,p0.stl,wrong
    for i in 1 2 3 4 5 6; do echo "slow.cag,p$i.stl,"; done
  } > progress.csv
  try_command python3 "$here/on_terminal.py" "$CAG" batch progress.csv --jobs 1
  status 1
  prints_like 'of 7 done, 1 running, 1 failed, [0-9]*:[0-9][0-9] left'
  rm progress.csv.journal
  try_command python3 "$here/on_terminal.py" "$CAG" batch progress.csv --jobs 1 -q
  ! grep -q 'running' out || wrong 'a bar is drawn with -q'
fi
