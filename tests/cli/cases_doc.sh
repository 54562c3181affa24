# cag doc: in a terminal, and as a site.

it 'a function is told with parameters, defaults, errors and example'
try doc insert_knot
status 0
prints 'insert_knot(C, t, times = 1) -> curve'
prints 'insert_knot(S, u = none, v = none, times = 1) -> surface'
prints 'integer in 1..1000: the number of times; default 1'
prints 'knot-multiplicity'
prints 'Example'

it 'without a name all functions are listed by family'
try doc
status 0
prints 'Robots: inverse kinematics'
prints 'std.materials'

it 'a module of the library is told, and a definition in it, with std. or without'
try doc std.robots
status 0
prints 'puma560'
try doc robots.puma560
prints 'Unimation PUMA 560'
try doc kinematics.gripper_tips
prints 'number, mm: the distance between the jaws'

it 'a chapter of the manual is shown'
try doc geometry
status 0
prints '# Geometry'

it 'an error code is told'
try doc E0301
status 0
prints 'E0301 (type)'

it 'a misspelt name gets the nearest one'
try doc bsplin
status 2
says 'did you mean `cag doc bspline`?'
try doc robots.puma56
status 2
says 'did you mean `cag doc robots.puma560`?'

script flange.cag '// A flange.
// It has holes.

/// How far across.
param width = 40 in 10..90 "mm, outside"
/// A plate of this size.
///
///     show plate(30)
plate(size, thickness = 3) = box([size, size, thickness])
_hidden = 1
show plate(width)'

it 'a script is told by its /// lines, and not run'
try doc flange.cag
status 0
prints 'It has holes.'
prints 'param width = 40 in 10..90'
prints 'mm, outside'
prints 'How far across.'
prints 'plate(size, thickness = 3)'
prints 'A plate of this size.'
! grep -q _hidden out || wrong 'private names are shown'
with_input flange.cag doc -
status 0
prints 'A plate of this size.'

it 'a script with errors, or that is not there, is told'
script broken.cag 'a = ('
try doc broken.cag
status 1
says 'broken.cag:1'
try doc nowhere.cag
status 3
says 'nowhere.cag'

it 'no colors go to a pipe, unless asked for'
try doc sin
! grep -q "$(printf '\033')" out || wrong 'codes of colors'
try doc sin --color always
grep -q "$(printf '\033')" out || wrong 'no codes of colors'

it 'the site is made, and every example on it does what it says'
try doc --html site --no-pictures
status 0
says 'scripts run'
for file in index.html index.js search.js style.css errors.html guide/getting-started.html guide/language.html \
  guide/geometry.html guide/curves-and-regions.html guide/embedding.html cookbook/index.html library/robots.html functions/bspline.html; do
  exists "site/$file"
done

it 'without cag-brep, examples that need it are shown without output'
try_command env CAG_BREP="$PWD/none" "$CAG" doc --html kernel-free --no-pictures
status 0
says 'scripts have no output, because the program cag-brep is missing'
grep -q 'needs the package <code>cag-brep</code>' kernel-free/functions/exact.html || wrong 'the page does not name the package'

it 'examples have no links to a playground, unless its address is given'
! grep -rq 'class="edit"' site || wrong 'there is a link'
try doc --html linked --no-pictures --playground ../play/
status 0
grep -q '<a class="edit" href="../../play/#text=print%20' linked/functions/sin.html || wrong 'a function has no link'
grep -q '<a class="edit" href="../../play/#text=' linked/cookbook/index.html || wrong 'the cookbook has no links'
! grep -q 'expect%3A' linked/functions/sin.html || wrong 'the link has expectations'

it 'every function has a page'
"$CAG" doc | sed -n '/^Library/q;s/^  //p' | tr ' ' '\n' | sort -u > names
[ "$(wc -l < names)" -gt 400 ] || wrong 'there are few names'
while read -r name; do exists "site/functions/$name.html"; done < names

it 'pages show signature, parameters, example and output'
grep -q 'integer &gt;= 1' site/functions/bspline.html || wrong 'no parameters'
grep -q 'class="output"' site/functions/bspline.html || wrong 'no output'
grep -q 'cag_session_new' site/guide/embedding.html || wrong 'the program of the embedding guide is missing'
[ "$(grep -c '<section class="recipe">' site/cookbook/index.html)" -ge 25 ] || wrong 'fewer than 25 recipes'

it 'no link or anchor of the site leads nowhere'
if needs node; then
  try_command node "$here/site_links.js" site
  status 0
fi

it 'the pages are HTML'
if needs xmllint; then
  ran='xmllint --html' code=0
  # xmllint does not know the elements of HTML 5; its other messages are checked.
  find site -name '*.html' -exec xmllint --html --noout {} + 2>&1 | grep 'error :' | grep -v 'Tag [a-z]* invalid' > err
  [ ! -s err ] || wrong 'xmllint finds errors'
fi

it 'the search finds a function and leads to it'
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
if [ -z "$browser" ]; then
  skip 'chromium is missing'
elif needs node; then
  try_command node "$here/site_search.js" "$browser" site bspline functions/bspline.html
  status 0
  prints 'Enter leads to functions/bspline.html: bspline'
fi

it 'pictures are made without POV-Ray, and those of another site are kept'
ran="PATH without povray" && PATH=/nowhere "$CAG" doc --html drawings --jobs 2 > out 2> err
code=$?
status 0
grep -q 'pictures/[0-9a-f]*\.svg' drawings/functions/bspline.html || wrong 'no drawing of a spline'
grep -q 'pictures/[0-9a-f]*\.png' drawings/functions/sphere.html || wrong 'no picture of a sphere'
first=$(ls -i drawings/pictures | head -n 1)
PATH=/nowhere "$CAG" doc --html drawings --jobs 2 > out 2> err
[ "$(ls -i drawings/pictures | head -n 1)" = "$first" ] || wrong 'a picture was made again'

it 'a folder that cannot be made is told'
try doc --html flange.cag/site --no-pictures
status 3
says 'flange.cag/site'

# --- Scripts of the user ---

script flange.cag '// A flange.
import parts.gripper: jaw

/// How far across.
param width = 40 in 10..90 "mm, outside"
/// A plate of this size.
///
/// - `size`: number, mm: how far across
/// - `thickness`: number, mm: how thick,
///   seen from the side
///
///     show plate(30)
///     print volume(plate(2, thickness: 1)) // expect: 4
plate(size, thickness = 3) = box([size, size, thickness])
show plate(jaw(width))'
mkdir -p parts
script parts/gripper.cag '// Jaws.

/// How far <apart> & jaws are.
///
///     print jaw(3)   // expect: 6
jaw(x) = 2 * x'

it 'a script tells of the parameters of its functions'
try doc flange.cag parts/gripper.cag
status 0
prints 'number, mm: how thick, seen from the side; default 3'
prints 'How far <apart>'
try doc parts
status 0
prints 'parts/gripper.cag'

it 'examples in the documentation of a script are tests'
try test flange.cag parts -v
status 0
prints 'passed flange.cag: example of plate'
prints 'passed parts/gripper.cag: example of jaw'
prints '4 passed, 0 failed, 0 skipped'

it 'an example that does not print the expected output is told by its place in the script'
script off.cag '/// Twice.
///
///     print twice(3)   // expect: 7
///
/// And an error:
///
///     print twice(3,
///       4)
///
/// And as a member:
///
///     y = 3
///     print off.twice(y), twice(y)   // expect: 6 6
twice(x) = 2 * x'
try test off.cag
status 1
prints 'FAILED off.cag: example of twice'
prints 'off.cag:3: the output is different'
prints 'FAILED off.cag: example 2 of twice'
prints 'off.cag:7:15'
prints '2 passed, 2 failed, 0 skipped'
try test off.cag --filter 'example 3 of twice'
status 0
prints '1 passed, 0 failed, 0 skipped'

it 'scripts and folders get pages in the site, in its index, and in its search'
try doc --html own flange.cag parts --no-pictures
status 0
exists own/scripts/index.html
exists own/scripts/flange.html
exists own/scripts/parts.gripper.html
grep -q 'how thick, seen from the side' own/scripts/flange.html || wrong 'the parameters are missing'
grep -q 'How far &lt;apart&gt; &amp; jaws are' own/scripts/parts.gripper.html || wrong 'a text is not escaped'
grep -q 'class="output"' own/scripts/flange.html || wrong 'the example was not run'
grep -q 'href="scripts/flange.html#plate"' own/index.html || wrong 'the index lacks the function'
grep -q '"flange.plate","script"' own/index.js || wrong 'the search lacks the function'
! grep -q "$PWD" -r own || wrong 'the folder of the scripts is told'
try_command node "$here/site_links.js" own
status 0

it 'a site has no part for scripts where there are none'
! grep -q 'scripts/' site/index.html || wrong 'there is a link to scripts'

it 'a wrong example of a script fails the site'
try doc --html own off.cag --no-pictures
status 1
says 'an example of off.cag does not print the expected output'

it 'scripts with errors, and those that are not there, make no site'
try doc --html none broken.cag --no-pictures
status 1
says 'broken.cag:1'
try doc --html none nowhere.cag --no-pictures
status 3
says 'nowhere.cag'
is_missing none

it '--html takes no name'
try doc --html site bspline
status 2
says 'omit the name'
