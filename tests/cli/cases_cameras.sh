# Cameras that measure: the pixel of project_point is where POV-Ray's picture shows the point.

dots='points = [for i in 0..2, j in 0..2, k in 0..1: [14 * i - 14, 14 * j - 14, 12 * k - 3]]
white = { pov: `texture { pigment { rgb 1 } finish { ambient 0 diffuse 0 emission 1 } }` }
show [for p in points: translate(sphere(1), p) |> material(white)]
show background("black")
show sun([0, 0, -1], strength: 0)
show eye
print [for p in points: project_point(eye, p).pixel]'

# agrees NAME 'camera' [OPTION ...]
agrees() {
  name=$1
  script "$name.cag" "eye = $2
$dots"
  shift 2
  it "$name: project_point agrees with the picture" povray python3
  try render "$name.cag" -o "$name.png" --quality final "$@"
  status 0
  cp out "$name.txt"
  try_command python3 "$here/camera_dots.py" "$name.png" "$name.txt"
  status 0
  it "$name: project_point agrees with the exported .pov file" povray python3
  try export "$name.cag" -o "$name.pov"
  status 0
  try_command povray "+I$name.pov" "+O${name}_pov.png" +W320 +H240 +A0.02 +AM2 +R4 -J -D +WT1
  status 0
  try_command python3 "$here/camera_dots.py" "${name}_pov.png" "$name.txt"
  status 0
}
agrees perspective 'camera([60, -90, 50], [3, 2, 4], up: [0.2, 0, 1], fov: 32deg, size: [320, 240])'
agrees orthographic 'camera([60, -90, 50], [3, 2, 4], kind: "orthographic", width: 70, size: [320, 240])'
agrees orthographic_by_distance 'camera([60, -90, 50], [3, 2, 4], kind: "orthographic", fov: 34deg, size: [320, 240])'
agrees pinhole 'pinhole(look_at([60, -90, 50], [3, 2, 4], [0.2, 0, 1]), 8, 0.0125, [320, 240])'
agrees beside 'pinhole(look_at([60, -90, 50], [3, 2, 4]), 8, 0.0125, [320, 240], principal: [140, 150])'
agrees oblong 'pinhole(look_at([60, -90, 50], [3, 2, 4]), 8, [0.0125, 0.014], [320, 240], principal: [170, 130], skew: 25)'
agrees moved 'pinhole(identity, 8, 0.0125, [320, 240]) |> moved(look_at([30, -45, 25], [1.5, 1, 2])) |> scale(2)'
agrees mirrored_pinhole 'pinhole(look_at([60, -90, 50], [3, 2, 4]), 8, 0.0125, [320, 240], principal: [150, 110]) |> reflect(plane([0, 0, 3], [1, 0.2, 0.1]))'
agrees mirrored_camera 'camera([60, -90, 50], [3, 2, 4], fov: 32deg, size: [320, 240]) |> reflect(Y)'
agrees mirrored_orthographic 'camera([60, -90, 50], [3, 2, 4], kind: "orthographic", width: 70, size: [320, 240]) |> reflect(X)'
agrees carried 'carried(pinhole(identity, 8, 0.0125, [320, 240]), robot([revolute(a: 100, alpha: 40deg)]), [100deg], mount: inverse(fk(robot([revolute(a: 100, alpha: 40deg)]), [100deg])) * look_at([60, -90, 50], [3, 2, 4]))'
agrees calibrated 'calibrate([for i in 0..7: [i % 2, floor(i / 2) % 2, floor(i / 4)]], [for i in 0..7: project_point(pinhole(look_at([60, -90, 50], [3, 2, 4]), 8, 0.0125, [320, 240]), [i % 2, floor(i / 2) % 2, floor(i / 4)]).pixel]).camera'
