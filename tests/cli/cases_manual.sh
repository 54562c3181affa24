# Every command line of the manual and the README, in a folder with the files that they name. Pictures are small and in draft quality, and
# films are short: the test is that the commands are valid.

page_files="README.md docs/batch.md docs/curves-and-regions.md docs/embedding.md docs/from-openscad.md docs/from-povray.md docs/geometry.md docs/getting-started.md docs/language.md docs/live.md docs/robots.md docs/scenes-and-files.md docs/sensing.md docs/solids-and-meshes.md docs/solids.md docs/surfaces-and-quadrics.md"

# The lines of shell blocks, and the commands in the text except those with a placeholder such as FILE.
block_lines() { awk '/^```sh/ { on = 1; next } /^```/ { on = 0 } on' "$1"; }
inline_lines() {
  grep -o '`cag [^`]*`' "$1" | tr -d '`' | grep -v '[A-Z]\{4\}\|[AB]\.exr' | awk 'NF > 2 || $2 == "info" || $2 == "doc"' | grep -v -- '--[a-z-]*$'
}

script film.cag 'show sphere(5 + time) |> translate([frames, 0, 0])'
script vase.cag 'param height = 120 in 50..300
param color = "red" in ["red", "teal"]
param quality_of_mesh = 1
show material(cylinder(height, 20), {color: color})'
script flat.cag 'show rectangle(20, 10)'
script depth.cag 'depth = image(4, 3, (x, y) => 100 + 20*x + 30*y)
show depth'
mkdir -p tests/language parts
script tests/language/one.cag 'print 1   // expect: 1'
cp film.cag parts/
awk '/^```csv/ { on = 1; next } /^```/ { on = 0 } on' "$root/docs/batch.md" | sed 's/1280x720/32x24/; s/640x360/32x24/; s/normal/draft/; s/0\.\.47/0..1/' > jobs.csv
printf '[{"script": "vase.cag", "output": "json/low.png", "size": "32x24", "quality": "draft", "color": "\\"teal\\""}]\n' > jobs.json
# The cup is the block of the README that has the param.
awk '/^```/ { if (block ~ /^\/\/ cup.cag/) printf "%s", block; block = ""; next } { block = block $0 "\n" }' "$root/README.md" > cup.cag
"$CAG" render film.cag -o before.exr --size 32x24 --quality draft --passes color,object
"$CAG" render film.cag -o after.exr --size 32x24 --quality draft --passes color,object

shortened() {
  sed 's/  *#.*//; s/ --watch//; s/--size [0-9x]*//; s/--quality [a-z]*//; s/0\.\.47 *$/0..1/; s/24\.\.47/24..25/
    /^cag render/s/$/ --size 32x24 --quality draft/'
}

# The program is found as `cag`, as for a reader.
mkdir -p bin
ln -sf "$CAG" bin/cag
(for page in $page_files; do
  block_lines "$root/$page" | sed "s|^|$page |"
  inline_lines "$root/$page" | sed "s|^|$page |"
done) | sort -u > lines
while IFS= read -r line; do
  page=${line%% *} line=${line#* }
  case $line in
    *'cag batch'*slurm*) [ -n "${SBATCH_TESTED:-}" ] || continue ;; # cases_slurm.sh
    'cag view'*) continue ;; # serves until it is ended: tests/live/view.py
    cag\ *) ;;
    cag) ;;
    *) continue ;; # installing, and building embed.c: cases_install.sh
  esac
  tools=
  case $line in *'cag render'* | *'cag batch'* | *'cag compare'*) tools=povray ;; esac
  it "the command line of $page: $line" $tools
  printf '%s\n' "$line" | shortened > line.sh
  rm -f jobs.csv.journal
  try_command env PATH="$PWD/bin:$PATH" sh ./line.sh
  status 0
done < lines

it 'a batch makes the folders of its outputs' povray
[ -s pictures/low.png ] && [ -s pictures/high.stl ] && [ -s pictures/film.0001.png ] && [ -s json/low.png ] || wrong 'an output of the table is missing'

it 'a text is given to a param with quotes or without'
for value in teal '"teal"'; do
  try run vase.cag -D "color=$value"
  status 0
done
script mode.cag 'param mode = "whole" in ["whole", "parts", "a \"b\""]
print mode'
try run mode.cag -D 'mode="parts"'
prints_exactly parts
try run mode.cag -D 'mode="a \"b\""'
prints_exactly 'a "b"'
try run mode.cag -D 'mode=a "b"'
prints_exactly 'a "b"'
