# cag compare, with pictures rendered here.

script red.cag 'show sphere(10) |> material({color: "#d04030"})'
script blue.cag 'show sphere(10) |> material({color: "#3040d0"})'
quick='--size 64x48 --quality draft'
"$CAG" render red.cag -o red.exr $quick
"$CAG" render blue.cag -o blue.exr $quick
"$CAG" render red.cag -o red.png $quick
"$CAG" render red.cag -o wide.exr --size 80x48 --quality draft

it 'a picture equals itself' povray
try compare red.exr red.exr
status 0
prints '0 of 3072'

it 'pictures that differ are status 1, with figures' povray
try compare red.exr blue.exr
status 1
for figure in RMSE maximum PSNR CIEDE2000 'differ by more than 0'; do prints "$figure"; done
says_nothing

it 'a threshold above all differences is status 0' povray
try compare red.exr blue.exr --threshold 100
status 0

it '-q leaves the figures out' povray
try compare -q red.exr blue.exr
status 1
prints_nothing
says_nothing

it 'a heatmap is a picture' povray
try compare red.exr blue.exr --heatmap heat.exr
status 1
begins_with heat.exr 762f3101
try compare red.exr blue.exr --heatmap heat.png
begins_with heat.png 89504e470d0a1a0a

it 'a heatmap that cannot be written'
try compare red.exr blue.exr --heatmap nowhere/heat.exr
status 3
try compare red.exr blue.exr --heatmap heat.txt
status 2

it 'PNG is read too' povray
try compare red.png red.png
status 0

it '- is standard input' povray
with_input red.exr compare - red.exr
status 0
try compare - -
status 2

it 'pictures of different sizes cannot be compared' povray
try compare red.exr wide.exr
status 1
says '64'
says '80'

it 'a picture that is not there' povray
try compare red.exr missing.exr
status 3
says missing.exr

it 'a folder is no picture'
mkdir folder.exr
try compare folder.exr red.exr
status 3
says folder.exr

it 'something else is no picture' povray
cp red.cag text.exr
try compare red.exr text.exr
status 3
says text.exr
cp red.cag text.png
try compare text.png red.exr
status 3

size=0
[ ! -e red.exr ] || size=$(wc -c < red.exr)
for part in 0 1 4 20 200 $((size / 2)) $((size - 1)); do
  it "an EXR that ends after $part of $size bytes" povray
  head -c "$part" red.exr > cut.exr
  try compare red.exr cut.exr --heatmap never.exr
  status 3
  says cut.exr
  is_missing never.exr
done

it 'a truncated PNG' povray
head -c 100 red.png > cut.png
try compare red.png cut.png
status 3
says cut.png
