# The guides for those who come from other programs: both sides of each pair are run.

it 'the shapes of OpenSCAD in the guide have the volumes and areas of ours' openscad python3
try_command python3 "$here/openscad_guide.py" "$root/docs/from-openscad.md" "$CAG" shapes
status 0

it 'the values of OpenSCAD in the guide are ours' openscad python3
try_command python3 "$here/openscad_guide.py" "$root/docs/from-openscad.md" "$CAG" values
status 0

it 'the scripts of OpenSCAD in the guide have the volumes of ours' openscad python3
try_command python3 "$here/openscad_guide.py" "$root/docs/from-openscad.md" "$CAG" scripts
status 0

it 'the objects of POV-Ray in the guide have the bounds of ours' povray python3
try_command python3 "$here/povray_guide.py" "$root/docs/from-povray.md" "$CAG" objects
status 0

it 'the values of POV-Ray in the guide are ours' povray python3
try_command python3 "$here/povray_guide.py" "$root/docs/from-povray.md" "$CAG" values
status 0

it 'the scenes of POV-Ray in the guide look like ours' povray python3
try_command python3 "$here/povray_guide.py" "$root/docs/from-povray.md" "$CAG" scenes
status 0
