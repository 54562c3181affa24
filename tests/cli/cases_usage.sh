# The command line itself: commands, options, help, and invalid usage. No script is run.

script ball.cag 'show sphere(10)'

it 'the version is printed'
try --version
status 0
prints_like '^cag [0-9][0-9]*\.[0-9][0-9]*\.[0-9][0-9]*$'
says_nothing

it 'help lists all commands'
try --help
status 0
for command in run eval export render measure mcp compare test fmt check explain info repl view lsp; do prints "  $command "; done

for command in run eval export render measure mcp compare test fmt check explain info repl view lsp; do
  it "cag $command --help shows examples"
  try $command --help
  status 0
  prints "Usage: cag $command"
  prints 'Examples:'
  prints '--diagnostics'
  says_nothing
done

it 'the help of render lists its options'
try render --help
for option in '-o OUT' '--size' '--quality' '--camera' '--frames' '--exposure' '--engine' '--tolerance' '--max-time'; do prints "$option"; done

it 'the help of export lists the formats'
try export --help
for format in obj stl ply glb pov svg json; do prints_like "^  $format "; done

it 'a misspelt command gets the nearest'
try rendr ball.cag
status 2
says 'did you mean `cag render`?'

it 'a command that this version does not have is unknown'
try serve
status 2
says 'unknown command `serve`'

it 'a script in the place of a command gets its mend'
try ball.cag
status 2
says 'cag run ball.cag'

it 'a misspelt option gets the nearest'
try render ball.cag -o a.png --sise 3x3
status 2
says 'cag render: '
says 'did you mean --size?'
is_missing a.png

it 'an option of another command is refused'
try run ball.cag --size 3x3
status 2
says '--size is an option of other commands'

it 'an option without its value is refused'
try render ball.cag -o a.png --quality
status 2
says '--quality needs a value'

it 'an option is not the value of the option before it'
try render ball.cag -o --size 3x3
status 2
says '-o needs a value'

it 'a flag takes no value'
try run ball.cag --help=yes
status 2
says '--help takes no value'

it 'a missing operand is wrong usage'
try run
status 2
says 'cag run FILE'

it 'an operand too many is wrong usage'
try compare a.exr b.exr c.exr
status 2
says "unexpected argument 'c.exr'"

it 'export expects an output'
try export ball.cag
status 2
says '-o OUT'

it 'a second output is refused'
try export ball.cag -o a.stl -o b.stl
status 2
says "'a.stl' and 'b.stl'"
is_missing a.stl
is_missing b.stl

it 'an output without an ending expects --format'
try export ball.cag -o thing
status 2
says '--format'
is_missing thing

for ending in dxf xyz; do
  it "there is no format .$ending, and the message names those that there are"
  try export ball.cag -o "a.$ending"
  status 2
  says ".obj .stl .ply"
  is_missing "a.$ending"
done

it 'export of a picture of shapes is refused with the fix'
try export ball.cag -o a.png
status 1
says 'shows no image'
says 'cag render'
is_missing a.png

it 'render of a mesh gets its mend'
try render ball.cag -o a.stl
status 2
says 'cag export'

it 'an engine that is not there names those that are'
try render ball.cag -o a.png --engine cycles
status 2
says 'choose povray, preview, or auto'

it 'a pass that is not there names those that are'
try render ball.cag -o a.exr --passes color,gloss
status 2
says 'unknown pass `gloss`'
says 'color, depth, normal'
try render ball.cag -o a.png --passes color
status 2
says 'passes need an .exr file'
try render ball.cag -o a.exr --passes color --engine povray
status 2
says 'made by the built-in renderer'

for wrong in '--size 10' '--size 0x4' '--size 4x4x4' '--size 999999x4' '--size -3x4' '--quality best' '--exposure bright' '--exposure nan' \
  '--frames 3' '--frames 5..3' '--frames a..b' '--frames 1..2..3' '--tolerance 0' '--tolerance -1' '--tolerance fine' '--max-memory lots' \
  '--max-memory 5X' '--max-memory 0' '--max-time 0' '--max-time soon' '--max-depth 0' '--max-depth 1.5' '--max-triangles none' \
  '--diagnostics xml' '--color red' '-D height' '-D =3'; do
  it "render $wrong is wrong usage"
  try render ball.cag -o 'a.%04d.png' $wrong
  status 2
  says "${wrong%% *}"
  prints_nothing
done

it 'options stand before, between and behind the operands, with = or without'
script param.cag 'param n = 1
print n'
try -D n=2 run param.cag
status 0
prints_exactly 2
try run -Dn=3 param.cag
prints_exactly 3
try run param.cag --color=never -qD n=4
prints_exactly 4

it '-- ends the options'
script -strange.cag 'print 5'
try run -- -strange.cag
status 0
prints_exactly 5

it 'explain tells a code at length, whatever its case'
try explain e0201
status 0
prints 'E0201'
prints 'example'

it 'explain without a code lists all'
try explain
status 0
prints 'E0101'
prints 'E0601'

it 'every code that is listed is explained'
"$CAG" explain > codes
while read -r one rest; do
  "$CAG" explain "$one" > out 2> err || wrong "cag explain $one failed"
  [ "$(wc -l < out)" -ge 3 ] || wrong "cag explain $one says too little"
done < codes
[ "$(wc -l < codes)" -ge 100 ] || wrong 'there are few codes'

it 'an unknown code is wrong usage'
try explain E9999
status 2
says 'E9999'

it 'info tells versions, what was found and the limits' povray
try info
status 0
for line in '^cag ' '^OpenEXR  *3' '^LAPACK  *3' '^POV-Ray  *3\.7' '^memory  *4G' '^depth  *10000'; do prints_like "$line"; done

it 'info says when POV-Ray is missing'
mkdir -p empty
ran='cag info' && PATH=$PWD/empty "$CAG" info > out 2> err
code=$?
status 0
prints_like '^POV-Ray  *not found'

it 'usage errors are JSON when that is asked for'
try run --diagnostics json
status 2
says_like '^{"severity":"error",.*"message":".*"help":".*"}$'

it 'invalid values of options are rejected with a hint'
printf 'print 1\n' > option.cag
# refuses MESSAGE HELP ARGUMENT ...
refuses() {
  message=$1 help=$2
  shift 2
  try "$@"
  status 2
  says "$message"
  says "$help"
}
refuses "--threshold 'x': expected a number of at least 0" 'give a number of at least 0' compare a.png b.png --threshold x
refuses "--threshold '-1': expected a number of at least 0" 'give a number of at least 0' compare a.png b.png --threshold -1
refuses "-I '': expected a name" 'name a folder' run option.cag -I=
refuses 'there are too many frames' 'the first and the last frame' render option.cag -o a%d.png --frames 0..99999999999
refuses 'the last frame comes before the first' 'the first and the last frame' render option.cag -o a%d.png --frames 5..3
refuses "--frames '1': " 'the first and the last frame' render option.cag -o a%d.png --frames 1
refuses "--frames '1..2x': " 'the first and the last frame' render option.cag -o a%d.png --frames 1..2x
refuses "--region '0x5+1+1': the region is empty" 'width x height' render option.cag -o a.png --region 0x5+1+1
refuses "--region '5x0+1+1': the region is empty" 'width x height' render option.cag -o a.png --region 5x0+1+1
refuses "--region '1x1+1': expected a region" 'width x height' render option.cag -o a.png --region 1x1+1
refuses "--region '9999999x1+1+1': expected a region" 'width x height' render option.cag -o a.png --region 9999999x1+1+1
refuses "--threads 'x': expected a count" 'a whole number of at least 1' render option.cag -o a.png --threads x
refuses "--threads '': expected a count" 'a whole number of at least 1' render option.cag -o a.png --threads=
refuses "--threads ' 1': expected a count" 'a whole number of at least 1' render option.cag -o a.png '--threads= 1'
refuses "--samples '1.5': expected a count" 'a whole number of at least 1' render option.cag -o a.png --samples 1.5
refuses "--jobs '1e99': expected a count" 'a whole number of at least 1' batch jobs.csv --jobs 1e99
refuses "--element 'x': expected a number" "the number of the array's task" batch plan --element x
refuses "--max-memory '1GiX': expected a size" 'K, M, G, or T' run option.cag --max-memory 1GiX
refuses "--max-memory '.': expected a size" 'K, M, G, or T' run option.cag --max-memory .
refuses "--max-memory ':1': expected a size" 'K, M, G, or T' run option.cag --max-memory :1
refuses "--max-memory '9e99': expected a size" 'K, M, G, or T' run option.cag --max-memory 9e99
refuses "--max-time 's': expected a time" 'give a number of seconds greater than 0' eval 1 --max-time s
refuses "--max-time 'inf': expected a time" 'give a number of seconds greater than 0' eval 1 --max-time inf
refuses "--size '0x5': width and height must be 1 to" 'width x height' render option.cag -o a.png --size 0x5
refuses "--size '5x0': width and height must be 1 to" 'width x height' render option.cag -o a.png --size 5x0
refuses "--size '5x99999999': width and height must be 1 to" 'width x height' render option.cag -o a.png --size 5x99999999
refuses "--tiles '0x1': expected tiles" 'columns x rows' batch jobs.csv --tiles 0x1
refuses 'the output is missing' 'name the output with -o OUT' render option.cag
refuses 'unknown picture format' '.exr or .png' render option.cag -o a.png --format gif
refuses "--format exr and the output 'a.png' contradict each other" 'omit --format' render option.cag -o a.png --format exr
for frames in 0.5 x '' 1.5 1e99; do
  refuses "-D frames=$frames: expected the length of a film" 'an integer, such as 96' render option.cag -o a%d.png --frames 0..3 -D "frames=$frames"
done
refuses '--frames sets `time`' 'omit one of them' render option.cag -o a%d.png --frames 0..3 -D time=0.5
refuses '--frames sets `frame`' 'omit one of them' render option.cag -o a%d.png --frames 0..3 -D frame=1
refuses "expected A B, found only 'a.png'" 'cag compare A B' compare a.png
refuses 'FILE is missing' 'cag export FILE' export

it 'sizes and times may have units'
for size in 512M 512MB 512MiB 536870912 .5G; do
  try eval "--max-memory=$size" 1+1
  status 0
  prints_exactly 2
done
try eval --max-time 5s 1+1
status 0
prints_exactly 2
