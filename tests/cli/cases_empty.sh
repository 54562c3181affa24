# Empty shapes among what a script shows.

it 'a union with an empty part exports in every format that holds unions, and renders'
script part.cag 'show named(sphere(5) | (box(1) - box(2)), "ball")
show rectangle(4, 4) - rectangle(1, 1), rectangle(1, 1) - rectangle(2, 2)'
for ending in stl obj ply glb gltf 3mf pov json svg; do
  try export part.cag -o "part.$ending"
  status 0
  says 'region.2: the shape is empty, so it adds nothing to the scene'
done
if needs povray; then
  try render part.cag -o part.png --size 48x32 --quality draft
  status 0
fi

it 'a script that shows only empty shapes is an error, which tells where'
script lost.cag 'lost = box(1) - box(2)
show lost'
try export lost.cag -o lost.stl
status 1
says 'lost: the shape is empty, so it adds nothing to the scene'
says 'lost.cag:1:8'
says 'shows only empty shapes'
[ ! -e lost.stl ] || wrong 'a file was written'
try export lost.cag -o lost.svg
status 1
try render lost.cag -o lost.png
status 1
try run lost.cag
status 0
