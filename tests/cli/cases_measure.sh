# cag measure: text, JSON, definitions, and errors. Expected numbers are formulas.

script parts.cag 'print "noise"
ball = sphere(3)
plate = box([4, 5, 6])
_hidden = box(2)
height = 12
both = [ball, translate(plate, [10, 0, 0])]
wire = circle(2)
deck = rectangle(4, 3)
tube = revolve(line([2, 0], [2, 5]))
round_one = revolve(arc(2, -90deg..90deg))
lost = box(1) - box(2)
open_mesh = mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
show ball, plate |> translate([10, 0, 0])'

it 'measures are for people'
try measure parts.cag
status 0
says noise
prints 'ball: solid, sphere'
prints 'volume      120 mm3'
prints 'total of 2 parts'
prints 'max         [14, 5, 6]'

# json EXPRESSION: whether a Python expression of `m`, the JSON in the file out, is true.
json() {
  python3 -c "
import json, math
def near(a, b): return abs(a - b) <= 1e-12 * abs(b)
m = json.load(open('out'))
p = m['parts'][0] if m.get('parts') else None
exit(not ($1))" || wrong "the JSON does not fulfil $1"
}

it 'measures are JSON, with all digits'
try measure parts.cag --json
status 0
json 'm["file"] == "parts.cag" and m["name"] is None and m["unit"] == "mm" and len(m["parts"]) == 2'
json 'near(p["volume"], 36 * math.pi) and near(p["area"], 36 * math.pi) and p["centroid"] == [0, 0, 0]'
json 'p["name"] == "ball" and p["type"] == "solid" and p["kind"] == "sphere" and p["exact"] and p["faces"] == 1'
json 'p["bounds"] == {"min": [-3, -3, -3], "max": [3, 3, 3], "size": [6, 6, 6]}'
json 'm["parts"][1]["faces"] == 6 and m["parts"][1]["watertight"] and m["parts"][1]["centroid"] == [12, 2.5, 3]'
json 'm["total"]["parts"] == 2 and near(m["total"]["volume"], 120 + 36 * math.pi)'
json 'near(m["total"]["centroid"][0], 1440 / (120 + 36 * math.pi)) and m["total"]["bounds"]["max"] == [14, 5, 6]'
grep -q '113.097335529232' out || wrong 'the volume has not all digits'

it 'each kind of shape is measured'
try measure parts.cag wire --json
json 'p["type"] == "curve" and near(p["length"], 4 * math.pi) and p["closed"] and p["area"] is None and p["watertight"] is None'
try measure parts.cag deck --json
json 'p["type"] == "region" and p["area"] == 12 and p["length"] == 14 and p["watertight"] == False and p["faces"] == 1'
try measure parts.cag tube --json
json 'p["type"] == "surface" and near(p["area"], 20 * math.pi) and p["volume"] is None and not p["watertight"]'
json 'near(p["centroid"][2], 2.5)'
try measure parts.cag round_one --json
json 'near(p["area"], 16 * math.pi) and near(p["volume"], 32 / 3 * math.pi) and p["watertight"]'
try measure parts.cag open_mesh --json
json 'p["area"] == 0.5 and p["volume"] is None and not p["watertight"] and p["faces"] == 1'
json 'near(p["centroid"][0], 1 / 3) and p["kind"] == "mesh"'
try measure parts.cag lost --json
status 1
says 'only empty shapes'

it 'a definition is measured by its name'
try measure parts.cag both --json
status 0
json 'm["name"] == "both" and [q["name"] for q in m["parts"]] == ["both", "both.2"]'
try measure parts.cag _hidden --json
json 'p["volume"] == 8'
try measure parts.cag height --json
json 'm["value"] == "12" and m["type"] == "number" and m["parts"] == []'
try measure parts.cag height
prints_exactly 'height: number
  12'

it 'an unknown definition gets the nearest'
try measure parts.cag heigth
status 1
says 'parts.cag defines no name `heigth`'
says 'did you mean `height`?'
prints_nothing

it 'set operations are measured by their mesh, within the tolerance'
script drilled.cag 'show box([40, 30, 10]) - translate(cylinder(20, 5), [10, 10, -5])'
try measure drilled.cag --json --tolerance 0.0001
json 'not p["exact"] and p["faces"] is None and abs(p["volume"] / (12000 - 250 * math.pi) - 1) < 1e-5 and p["watertight"]'
try measure drilled.cag --section x=10 --json --tolerance 0.0001
json 'abs(p["volume"] / (3000 - 125 * math.pi) - 1) < 1e-5 and p["bounds"]["max"] == [10, 30, 10]'

it 'errors of a script'
script bad.cag 'show box(0)'
try measure bad.cag --json
status 1
prints_nothing
try measure missing.cag
status 3
try measure parts.cag ball more
status 2
