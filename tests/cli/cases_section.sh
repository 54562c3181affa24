# Views and sections: `cag render --views`, `--section` on render, export, and measure.

script ball.cag 'show sphere(10) |> color([1, 0, 0])'
script plate.cag 'show box([40, 30, 10]) - translate(cylinder(20, 5), [10, 10, -5])'
quick='--size 64x48 --quality draft'

it 'views are named by their cameras'
try render ball.cag -o 'v.%s.png' --views iso,front,top,right $quick
status 0
for view in iso front top right; do
  exists v.$view.png
  try render ball.cag -o one.png --camera $view $quick
  same v.$view.png one.png
done

# A view from below hides the floor; the picture after it must have it again.
it 'views do not depend on their order'
try render ball.cag -o 'w.%s.png' --views bottom,front,bottom2 $quick
status 2
says 'unknown camera `bottom2`'
is_missing w.bottom.png
try render ball.cag -o 'w.%s.png' --views bottom,front $quick
status 0
same w.front.png v.front.png
try render ball.cag -o one.png --camera bottom $quick
same w.bottom.png one.png

it 'views run the script once'
script counted.cag 'print "once"
show sphere(1), camera([9, 9, 9], origin) |> named("mine")'
try render counted.cag -o 'c.%s.png' --views top,mine $quick
status 0
prints_exactly once
exists c.mine.png

it 'views that make no sense are refused'
for case in 'v.png --views top,front' 'v.%s.png --views top,top' 'v.%s.png --views ../top' 'v.%s.png --views top,,front' \
  'v.%s.png' 'v.%d.png --views top,front' 'v.%s.png --views top --camera top' 'v.%s.png --views top --frames 0..1' '- --format png --views top'; do
  try render ball.cag -o $case $quick
  status 2
  prints_nothing
done

it 'a section of a picture cuts with both renderers'
try render ball.cag -o whole.png --camera front $quick --size 320x240
try render ball.cag -o cut.png --camera front --section z=0 $quick --size 320x240
status 0
try compare -q whole.png cut.png
status 1

# Seen from the front, a ball that is cut at its middle is a half disk. The orthographic view frames it, so the share of red pixels is that
# of pi/2 r^2 in the picture that it fills: the width is 2 r/(1 - 0.09), the height 3/4 of it.
it 'half of the ball is left'
try_command python3 "$here/png_share.py" cut.png red
share=$(cat out)
python3 -c "
import math
expected = math.pi / 2 / (2 / 0.91) / (2 / 0.91 * 0.75)
exit(abs($share / expected - 1) > 0.03)" || wrong "the share of red is $share"
if needs povray; then
  try render ball.cag -o pov.png --camera front --section z=0 --size 320x240 --engine povray
  status 0
  try_command python3 "$here/png_share.py" pov.png red
  python3 -c "exit(abs($(cat out) / $share - 1) > 0.05)" || wrong "POV-Ray has the share $(cat out), and not $share"
fi

it 'a drawing of a section has exact outlines'
try export plate.cag -o plate.svg --section z=6
status 0
grep -q 'd="M 0 0 L 40 0 L 40 -30 L 0 -30 L 0 0 Z"><title>difference</title>' plate.svg || wrong 'the outline is missing'
grep -q 'A 5 5 0 0 1 5 -10 A 5 5 0 0 1 15 -10 Z"><title>difference.2</title>' plate.svg || wrong 'the hole is not of arcs'

it 'a mesh of a section is closed'
try export plate.cag -o plate.stl --section z=6
status 0
if needs admesh; then
  try_command admesh plate.stl
  prints 'Total disconnected facets        :     0'
  prints_like 'Volume *: *67[23]'
fi

it 'the other side of a plane'
try measure plate.cag --section -z=6
status 0
prints 'min         [0, 0, 6]'

it 'a section beside everything says where the shapes are'
try export plate.cag -o none.svg --section z=600
status 1
says 'the shapes reach from 0 to 10 along [0, 0, 1]'
is_missing none.svg
try export plate.cag -o none.stl --section -x=600
status 1
says 'the shapes reach from 0 to 40 along [1, 0, 0]'

it 'a plane that cannot be read is refused'
for plane in '' z 'z=' w=1 'z=1=2' z=nan '--z=1' 'z=1cm' zz=1; do
  try export plate.cag -o none.stl "--section=$plane"
  status 2
  says '--section'
done

it 'a section in each format'
script all.cag 'show (box([9, 9, 9]) |> color("gold")) | (sphere(5) |> color("navy")), torus_surface(20, 3), circle(30)
show region(circle(40)) |> translate([0, 0, -2]), tessellate(sphere(2)) |> translate([60, 0, 0])'
for format in obj stl ply glb gltf 3mf pov svg json; do
  try export all.cag -o all.$format --section z=1
  status 0
  exists all.$format
done
# A cut surface is a mesh.
try export all.cag -o all.igs --section z=1
status 1
says 'is a mesh'
for format in urdf png exr; do
  try export all.cag -o all.$format --section z=1
  status 2
  says '--section does not apply'
done
