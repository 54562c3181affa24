#!/usr/bin/env python3
"""Tests the server of `cag view` as a page would use it, and as nobody should.

    view.py PROGRAM [TEST ...]   closes with `N passed, N failed, N skipped`
"""

import array
import base64
import http.client
import json
import math
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

CAG = os.path.abspath(sys.argv[1])
WAIT = int(os.environ.get("WAIT", "60"))  # seconds, on a busy machine
VASE = """param height = 40 in 10..90 "height, mm"
show revolve(polyline([[0, 0], [20, 0], [24, height], [0, height]])) |> named("vase")
show box([5, 5, 5]) |> translate([60, 0, 0]) |> named("box")
print "height {height}"
"""


def accept_interrupts():
    """A shell starts jobs in the background with SIGINT ignored, and they pass that on."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


class View:
    """A server with its folder, and a listener of its events."""

    def __init__(self, text, *options, name="model.cag", others={}, state=None):
        self.folder = tempfile.mkdtemp()
        for other, content in others.items():
            with open(os.path.join(self.folder, other), "w") as f:
                f.write(content)
        time.sleep(0.05 if others else 0)  # a file of the last moment counts as changed during the first run
        self.path = os.path.join(self.folder, name)
        with open(self.path, "w") as f:
            f.write(text)
        self.process = subprocess.Popen([CAG, "view", self.path, "--no-open", *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=accept_interrupts, env={**os.environ, "XDG_STATE_HOME": state or os.path.join(self.folder, "state")})
        self.address = self.process.stdout.readline().strip()
        self.port = int(self.address.split(":")[2].split("/")[0])
        self.token = self.address.split("t=")[1]
        self.cookie = {"Cookie": f"cag-view-{self.port}={self.token}"}
        self.events = []
        self.changed = threading.Condition()
        threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self):
        try:
            c = http.client.HTTPConnection("127.0.0.1", self.port)
            c.request("GET", "/api/events", headers=self.cookie)
            kind = None
            for line in c.getresponse():
                line = line.decode().rstrip("\n")
                if line.startswith("event: "):
                    kind = line[7:]
                elif line.startswith("data: "):
                    with self.changed:
                        self.events.append((kind, json.loads(line[6:])))
                        self.changed.notify_all()
        except (OSError, http.client.HTTPException):
            pass

    def ask(self, method, path, body=None, headers=None, cookie=True):
        c = http.client.HTTPConnection("127.0.0.1", self.port, timeout=WAIT)
        sent = dict(self.cookie if cookie else {})
        sent.update(headers or {})
        c.request(method, path, body=body, headers=sent)
        r = c.getresponse()
        answer = r.status, r.read(), dict(r.getheaders())
        c.close()
        return answer

    def run(self, **request):
        status, body, _ = self.ask("POST", "/api/run", json.dumps(request))
        assert status == 202, status
        return json.loads(body)["run"]

    def wait(self, kind, accept=lambda e: True, since=0):
        """The first event of a kind that is accepted."""
        end = time.monotonic() + WAIT
        with self.changed:
            while True:
                for k, e in self.events[since:]:
                    if k == kind and accept(e):
                        return e
                left = end - time.monotonic()
                if left <= 0:
                    raise AssertionError(f"no event {kind}")
                self.changed.wait(left)

    def scene(self, run):
        return self.wait("scene", lambda e: e["run"] >= run)

    def close(self):
        self.process.send_signal(signal.SIGINT)
        status = self.process.wait(WAIT)
        shutil.rmtree(self.folder)
        return status


def mesh_of(scene, name):
    return next(p for p in scene["parts"] if p["name"] == name)


# --- A page ---


def test_scene():
    v = View(VASE)
    scene = v.scene(1)
    assert [p["name"] for p in scene["parts"]] == ["vase", "box"]
    assert scene["params"][0]["low"] == 10 and scene["params"][0]["value"] == "40"
    assert scene["parts"][0]["origin"][0] == {"what": "show", "file": "model.cag", "line": 2, "column": 6, "endLine": 2, "endColumn": len(VASE.split("\n")[1]) + 1, "library": False}
    status, body, headers = v.ask("GET", "/api/mesh/" + scene["parts"][1]["mesh"])
    numbers = [int.from_bytes(body[4 * i : 4 * i + 4], "little") for i in range(8)]
    assert status == 200 and numbers[0] == 0x6D676163 and numbers[3] == 12 and numbers[4] == 12
    assert "immutable" in headers["Cache-Control"]
    messages = v.wait("messages")
    assert messages["ok"] and messages["prints"] == ["height 40"]
    assert v.close() == 130


def test_only_what_changed_has_another_mesh():
    v = View(VASE)
    first = v.scene(1)
    second = v.scene(v.run(params={"height": "60"}))
    assert mesh_of(first, "vase")["mesh"] != mesh_of(second, "vase")["mesh"]
    assert mesh_of(first, "box")["mesh"] == mesh_of(second, "box")["mesh"]
    assert mesh_of(second, "vase")["bounds"][1][2] == 60
    coarse = v.scene(v.run(params={"height": "60"}, coarse=True))
    assert mesh_of(coarse, "vase")["mesh"] != mesh_of(second, "vase")["mesh"]
    v.close()


def test_what_moves_keeps_its_mesh():
    v = View("show tube(helix(20, 10, 2), 3) |> rotate(Z, time * 90deg)\n")
    first = v.scene(1)
    assert first["timed"]
    second = v.scene(v.run(time=1, frames=11))
    a, b = first["parts"][0], second["parts"][0]
    assert a["mesh"] == b["mesh"] and a["placement"] != b["placement"]
    assert abs(b["placement"][0]) < 1e-12 and abs(b["placement"][4] - 1) < 1e-12
    v.close()


def test_errors_leave_the_last_scene():
    v = View(VASE)
    v.scene(1)
    run = v.run(files={"model.cag": "show sphere(\n"})
    messages = v.wait("messages", lambda m: m["run"] == run)
    assert not messages["ok"] and messages["diagnostics"][0]["line"] >= 1
    assert not any(k == "scene" and e["run"] == run for k, e in v.events)
    scene = v.scene(v.run(files={"model.cag": "show sphere(7)\n"}))
    assert scene["parts"][0]["name"] == "sphere"
    v.close()


def test_params_of_a_script_that_fails():
    v = View("param height = 40 in 10..90\nassert height < 30, \"too tall\"\nshow sphere(height)\n")
    messages = v.wait("messages", lambda m: m["run"] == 1)
    assert not messages["ok"] and [(p["name"], p["value"], p["low"], p["high"]) for p in messages["params"]] == [("height", "40", 10, 90)]
    run = v.run(params={"height": "20"})
    assert v.scene(run)["params"][0]["value"] == "20"
    run = v.run(files={"model.cag": "param height = (\nshow = 3\n"})
    messages = v.wait("messages", lambda m: m["run"] == run)
    assert not messages["ok"] and messages["params"] == []
    run = v.run(files={"model.cag": "param height = 1 / [0]\nparam width = 3 in nothing\nshow sphere(height)\n"})
    assert not v.wait("messages", lambda m: m["run"] == run)["ok"]
    v.close()


def test_a_newer_run_cancels_an_older_one():
    v = View("show sphere(1)\n")
    v.scene(1)
    v.run(files={"model.cag": "f(n) = if n == 0 then 0 else f(n - 1)\nx = f(1e12)\nshow sphere(x)\n"})
    begin = time.monotonic()
    v.scene(v.run(files={"model.cag": "show box([1, 1, 1])\n"}))
    assert time.monotonic() - begin < WAIT / 2
    v.close()


def test_a_save_by_another_editor_runs_the_script():
    v = View(VASE)
    v.scene(1)
    other = v.path + ".new"
    with open(other, "w") as f:
        f.write("show cylinder(9, 3)\n")
    os.rename(other, v.path)
    assert v.wait("file")["path"] == "model.cag"
    v.wait("scene", lambda e: e["parts"][0]["name"] == "cylinder")
    v.close()


def test_imported_files_are_watched():
    v = View("import parts: knob\nshow knob\n")
    run = v.wait("messages")["run"]
    with open(os.path.join(v.folder, "parts.cag"), "w") as f:
        f.write("knob = sphere(4)\n")
    v.wait("scene", lambda e: e["parts"][0]["name"] == "knob")
    files = json.loads(v.ask("GET", "/api/files")[1])
    assert sorted(f["path"] for f in files) == ["model.cag", "parts.cag"], files
    with open(os.path.join(v.folder, "parts.cag"), "w") as f:
        f.write("knob = box([4, 5, 6])\n")
    scene = v.wait("scene", lambda e: e["parts"][0]["bounds"][1] == [4, 5, 6])
    assert scene["run"] > run and scene["parts"][0]["origin"][-1]["file"] == "parts.cag"
    v.close()


BLOCK = """hole = cylinder(20, 8, centered: true)
block = box([40, 40, 10], centered: true)
show translate(block - hole, [0, 0, 30]) |> named("part")
show tessellate(sphere(3)) |> named("mesh")
show image([[0, 1, 0], [1, 0, 1]]) |> named("dots")
"""


def floats(text):
    return array.array("f", base64.b64decode(text))


def ask(v, question, request, expected=200):
    status, body, _ = v.ask("POST", "/api/" + question, json.dumps(request))
    assert status == expected, (status, body)
    return json.loads(body)


def test_faces_and_their_sources():
    v = View(BLOCK)
    part = mesh_of(v.scene(1), "part")
    assert [s["name"] for s in part["sources"]] == ["block", "hole"]
    assert part["sources"][1]["origin"] == [{"what": "made", "file": "model.cag", "line": 1, "column": 8, "endLine": 1, "endColumn": 39, "library": False}]
    faces = ask(v, "faces", {"part": "part"})
    assert faces["mesh"] == part["mesh"] and faces["operands"] == [0, 1]
    _, body, _ = v.ask("GET", "/api/mesh/" + part["mesh"])
    assert sum(faces["faces"][::2]) == int.from_bytes(body[12:16], "little")
    assert set(faces["faces"][1::2]) == {0, 1}
    ask(v, "faces", {"part": "mesh"}, 422)
    ask(v, "faces", {"part": "nobody"}, 404)
    ask(v, "faces", {}, 404)
    v.close()


def test_ghosts():
    v = View(BLOCK)
    v.scene(1)
    (ghost,) = ask(v, "ghost", {"file": "model.cag", "line": 3, "column": 25})["ghosts"]
    assert ghost["part"] == "part" and ghost["type"] == "solid" and ghost["place"]["line"] == 1
    assert abs(ghost["placement"][11] - 20) < 1e-12  # it is centered
    assert v.ask("GET", "/api/mesh/" + ghost["mesh"])[0] == 200
    (moved,) = ask(v, "ghost", {"file": "model.cag", "line": 3, "column": 22})["ghosts"]
    assert moved["motion"] == {"kind": "translate", "point": [0, 0, 0], "direction": [0, 0, 30], "angle": 0, "frame": None}
    assert ask(v, "ghost", {"file": "model.cag", "line": 3, "column": 2})["ghosts"] == []
    assert ask(v, "ghost", {"file": "../x.cag", "line": 1e9, "column": 1})["ghosts"] == []
    for bad in [{}, {"file": "model.cag"}, {"file": "model.cag", "line": 0, "column": 1}, {"file": "model.cag", "line": 1.5, "column": 1}, {"file": 3, "line": 1, "column": 1}, {"file": "model.cag", "line": 1, "column": 1e300}]:
        assert ask(v, "ghost", bad, 400)["error"]
    assert v.ask("POST", "/api/ghost", "[1]")[0] == 400 and v.ask("POST", "/api/ghost", "{")[0] == 400
    assert v.ask("GET", "/api/ghost")[0] == 404
    # The last good scene answers while the script is wrong.
    v.wait("messages", lambda m, run=v.run(files={"model.cag": "show ("}): m["run"] == run)
    assert len(ask(v, "ghost", {"file": "model.cag", "line": 3, "column": 25})["ghosts"]) == 1
    v.close()


def test_surfaces():
    v = View("show sphere(5)\nshow bspline_surface([for i in 0..3: [for k in 0..3: [i, k, i * k]]]) |> named(\"patch\")\nshow tessellate(sphere(3)) |> named(\"mesh\")\n")
    sphere = mesh_of(v.scene(1), "sphere")
    bent = ask(v, "surface", {"part": "sphere", "what": "curvature"})
    assert bent["mesh"] == sphere["mesh"]
    gaussian = floats(bent["gaussian"])
    assert len(gaussian) % 3 == 0 and all(x != x or abs(x - 1 / 25) < 1e-6 for x in gaussian)
    away = ask(v, "surface", {"part": "sphere", "what": "deviation"})
    assert 3 * len(floats(away["distance"])) == len(gaussian) and 0 < away["farthest"] < 0.02
    net = ask(v, "surface", {"part": "patch", "what": "net"})
    assert net["sizes"] == [4] * 8 and len(floats(net["points"])) == 3 * 32
    assert len(ask(v, "surface", {"part": "patch", "what": "isolines"})["sizes"]) == 18
    assert "is a mesh" in ask(v, "surface", {"part": "mesh", "what": "curvature"})["reason"]
    ask(v, "surface", {"part": "sphere", "what": "charm"}, 400)
    ask(v, "surface", {"part": "sphere"}, 400)
    ask(v, "surface", {"part": "nobody", "what": "net"}, 404)
    v.close()


def test_section_curves():
    v = View(BLOCK)
    v.scene(1)
    curves = ask(v, "section", {"normal": [0, 0, 1], "offset": 30})["curves"]
    assert [c["part"] for c in curves] == ["part", "part"] and all(c["closed"] and c["exact"] for c in curves)
    assert abs(sum(c["area"] for c in curves) - (1600 - 64 * math.pi)) < 1e-6
    assert abs(sum(c["length"] for c in curves) - (160 + 16 * math.pi)) < 1e-6
    points = floats(curves[1]["points"])
    assert len(points) > 60 and all(abs(z - 30) < 1e-5 for z in points[2::3])
    assert ask(v, "section", {"normal": [1, 0, 0], "offset": 900})["curves"] == []
    for bad in [{}, {"normal": [0, 0, 0], "offset": 1}, {"normal": [0, 1], "offset": 1}, {"normal": [0, 1, "z"], "offset": 1}, {"normal": [0, 0, 1]}]:
        assert ask(v, "section", bad, 400)["error"]
    v.close()


def test_memory_and_sizes_of_images():
    v = View(BLOCK)
    assert v.scene(1)["images"] == [{"name": "dots", "width": 3, "height": 2}]
    assert v.wait("messages")["memory"] > 10000
    v.close()


def test_nothing_is_asked_before_the_first_scene():
    v = View("show (\n")
    v.wait("messages")
    for question in ["faces", "ghost", "surface", "section"]:
        assert ask(v, question, {"part": "x"}, 409)["error"]
    v.close()


def test_measures():
    v = View(VASE)
    v.scene(1)
    status, body, _ = v.ask("POST", "/api/measure", '{"part": "box"}')
    m = json.loads(body)
    assert status == 200 and abs(m["volume"] - 125) < 1e-9 and abs(m["area"] - 150) < 1e-9 and m["watertight"]
    assert v.ask("POST", "/api/measure", '{"part": "none"}')[0] == 404
    assert v.ask("POST", "/api/measure", "[]")[0] == 400
    v.close()


ARM = """arm = robot([revolute(d: 100, a: 300), revolute(a: 250), prismatic(limits: 0..150), revolute()], name: "arm")
show posed(arm, [10deg, -20deg, 50, 0.5rad]) |> translate([0, 0, 40])
show [for i in 1..2: posed(arm) |> translate([900 * i, 0, 0])]
"""


def about_robot(v, path, **request):
    status, body, _ = v.ask("POST", path, json.dumps(request))
    return status, json.loads(body)


def test_robots():
    v = View(ARM)
    scene = v.scene(1)
    assert [r["name"] for r in scene["robots"]] == ["arm", "arm 2", "arm 3"]
    arm = scene["robots"][0]
    names = [p["name"] for p in scene["parts"]]
    assert arm["parts"] == names[: len(arm["parts"])] and arm["fixed"] is None
    assert scene["robots"][1]["fixed"] == "the script gives posed no q" and scene["robots"][1]["joints"][0]["place"] is None
    slide = arm["joints"][2]
    assert slide == {"name": "joint 3", "kind": "prismatic", "low": 0, "high": 150, "home": 0, "value": 50, "unit": "mm",
                     "place": {"file": "model.cag", "line": 2, "column": 33, "endLine": 2, "endColumn": 35, "library": False}}
    # 300 mm to (10 deg), 250 mm to (-10 deg), at the height 100 + 50 + 40.
    x, y = 550 * math.cos(math.radians(10)), 50 * math.sin(math.radians(10))
    assert max(abs(a - b) for a, b in zip(arm["tool"][3::4], [x, y, 190])) < 1e-9
    q = [joint["value"] for joint in arm["joints"]]
    status, pose = about_robot(v, "/api/pose", robot="arm", q=q)
    still = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]
    assert status == 200 and pose["q"] == q and pose["tool"] == arm["tool"] and pose["frames"] == arm["frames"]
    assert len(pose["motions"]) == len(arm["parts"]) and max(abs(a - b) for m in pose["motions"] for a, b in zip(m, still)) < 1e-9
    status, pose = about_robot(v, "/api/pose", robot="arm", q=[40, -60, 120, 10])
    assert status == 200
    status, found = about_robot(v, "/api/reach", robot="arm", q=q, target=pose["tool"])
    assert status == 200 and found["reached"] and found["distance"] < 1e-6 and found["angle"] < 1e-6
    assert max(abs(a - b) for a, b in zip(found["tool"], pose["tool"])) < 1e-6
    # The prismatic joint ends at 150 mm; the slide is the only joint that lifts the tool.
    target = pose["tool"][:11] + [400]
    status, found = about_robot(v, "/api/reach", robot="arm", q=q, target=target, orientation="free")
    assert status == 200 and not found["reached"] and abs(found["distance"] - 110) < 1e-3 and abs(found["q"][2] - 150) < 1e-6
    # No run took place.
    assert not any(k == "state" and e["run"] > 1 for k, e in v.events)
    v.close()


def test_wrong_questions_about_robots():
    v = View(ARM)
    arm = v.scene(1)["robots"][0]
    for path in ["/api/pose", "/api/reach"]:
        for body in ["", "[", "[]", "3", '{"robot": "arm", "q": [1, 2, NaN, 3]}', "{" * 5000]:
            assert v.ask("POST", path, body)[0] == 400, body
        for body in ["{}", '{"robot": 3}', '{"robot": "arms", "q": []}']:
            assert v.ask("POST", path, body)[0] == 404, body
        target = json.dumps(arm["tool"])
        for q in ["3", "[]", "[1, 2, 3]", "[1, 2, 3, 4, 5]", '[1, 2, 3, "4"]', "[1, 2, 3, null]", "[1, 2, 3, 1e999]", str([0] * 5000)]:
            status, body, _ = v.ask("POST", path, f'{{"robot": "arm", "q": {q}, "target": {target}}}')
            assert status == 400 and "q" in json.loads(body)["error"], (q, status, body)
        assert v.ask("GET", path)[0] == 404
    for target in ["3", "[]", str([0] * 12), str([1] * 12), str([1e999] * 12).replace("inf", "1e999"), str(arm["tool"][:11]), str([1e300] * 12), str([-x for x in arm["tool"]])]:
        status, body, _ = v.ask("POST", "/api/reach", f'{{"robot": "arm", "q": [1, 2, 3, 4], "target": {target}}}')
        assert status == 400 and "target" in json.loads(body)["error"], (target, status, body)
    status, answer = about_robot(v, "/api/reach", robot="arm", q=[1, 2, 3, 4], target=arm["tool"], orientation="all")
    assert status == 400 and "orientation" in answer["error"]
    v.close()
    # A script without robots, and one that has not run.
    v = View("show sphere(raduis)\n")
    v.wait("messages")
    assert v.ask("POST", "/api/pose", '{"robot": "arm", "q": []}')[0] == 409
    assert v.scene(v.run(files={"model.cag": "show sphere(1)\n"}))["robots"] == []
    assert v.ask("POST", "/api/pose", '{"robot": "arm", "q": []}')[0] == 404
    v.close()


def test_files_are_saved():
    v = View(VASE)
    status, text, headers = v.ask("GET", "/api/file?path=model.cag")
    assert status == 200 and text.decode() == VASE
    tag = headers["ETag"]
    assert v.ask("PUT", "/api/file?path=model.cag", "show sphere(1)\n", {"If-Match": '"0"'})[0] == 412
    status, body, _ = v.ask("PUT", "/api/file?path=model.cag", "show sphere(2)\n", {"If-Match": tag})
    assert status == 200 and json.loads(body)["version"] != tag.strip('"')
    with open(v.path) as f:
        assert f.read() == "show sphere(2)\n"
    assert v.ask("PUT", "/api/params", '{"tall": {"height": 80}}')[0] == 200
    with open(v.path + ".params.json") as f:
        assert json.load(f) == {"tall": {"height": 80}}
    assert json.loads(v.ask("GET", "/api/params")[1]) == {"tall": {"height": 80}}
    os.remove(v.path)
    version = json.loads(body)["version"]
    assert v.ask("PUT", "/api/file?path=model.cag", "show sphere(4)\n", {"If-Match": f'"{version}"'})[0] == 200  # deleted meanwhile
    with open(v.path) as f:
        assert f.read() == "show sphere(4)\n"
    v.close()


def test_exports_and_pictures():
    v = View(VASE)
    v.scene(1)
    status, body, headers = v.ask("POST", "/api/export", '{"format": "stl"}')
    assert status == 200 and 'filename="model.stl"' in headers["Content-Disposition"]
    assert len(body) == 84 + 50 * int.from_bytes(body[80:84], "little")
    camera = {"eye": [0, -200, 100], "target": [20, 0, 20], "up": [0, 0, 1], "fov": 40}
    status, body, _ = v.ask("POST", "/api/render", json.dumps({"engine": "preview", "quality": "draft", "width": 64, "height": 48, "camera": camera}))
    assert status == 202
    job = json.loads(body)["job"]
    v.wait("progress", lambda e: e["job"] == job and e["done"] and not e["error"])
    status, body, headers = v.ask("GET", f"/api/job/{job}")
    assert status == 200 and body.startswith(b"\x89PNG") and headers["Content-Type"] == "image/png"
    status, body, _ = v.ask("POST", "/api/export", '{"format": "nothing"}')
    assert status == 400
    v.close()


def test_a_page_that_only_reads():
    v = View(VASE, "--read-only")
    v.scene(1)
    assert v.ask("PUT", "/api/file?path=model.cag", "x = 1\n")[0] == 403
    assert v.ask("PUT", "/api/params", "{}")[0] == 403
    with open(v.path) as f:
        assert f.read() == VASE
    v.close()


# --- What must be refused ---


def test_strangers_are_refused():
    v = View(VASE)
    assert v.ask("GET", "/api/hello", cookie=False)[0] == 403
    assert v.ask("GET", "/", cookie=False)[0] == 403
    assert v.ask("GET", "/api/hello", headers={"Cookie": f"cag-view-{v.port}=" + "x" * 32})[0] == 403
    assert v.ask("GET", "/?t=" + "x" * 32, cookie=False)[0] == 403
    assert v.ask("GET", "/?t=" + v.token[:-1], cookie=False)[0] == 403
    status, _, headers = v.ask("GET", "/?t=" + v.token, cookie=False)
    assert status == 303 and headers["Location"] == "/"
    assert "HttpOnly" in headers["Set-Cookie"] and "SameSite=Strict" in headers["Set-Cookie"]
    for host in ["example.org", "localhost.example.org", "127.0.0.1.example.org:80", "[::2]", ""]:
        assert v.ask("GET", "/api/hello", headers={"Host": host})[0] in (400, 403), host
    for host in ["localhost", "localhost:9999", "127.0.0.1:1", "[::1]:8080"]:
        assert v.ask("GET", "/api/hello", headers={"Host": host})[0] == 200, host
    for origin in ["http://example.org", "null", "https://localhost", "http://localhost:1"]:
        assert v.ask("POST", "/api/run", "{}", {"Origin": origin})[0] == 403, origin
    assert v.ask("GET", "/api/hello", headers={"Sec-Fetch-Site": "cross-site"})[0] == 403
    _, _, headers = v.ask("GET", "/api/hello")
    assert "default-src 'none'" in headers["Content-Security-Policy"]
    v.close()


def test_servers_of_one_browser():
    v, w = View(VASE), View(VASE)
    assert v.ask("GET", "/api/hello", headers={"Cookie": f"{v.cookie['Cookie']}; {w.cookie['Cookie']}"})[0] == 200
    assert w.ask("GET", "/api/hello", headers={"Cookie": f"{v.cookie['Cookie']}; {w.cookie['Cookie']}"})[0] == 200
    assert w.ask("GET", "/api/hello", headers=v.cookie)[0] == 403
    v.close()
    w.close()


def test_files_outside_of_the_folder_are_refused():
    v = View(VASE)
    os.symlink("/etc/passwd", os.path.join(v.folder, "link.cag"))
    os.symlink("/etc", os.path.join(v.folder, "etc"))
    os.mkfifo(os.path.join(v.folder, "pipe.cag"))
    for path in ["../model.cag", "/etc/passwd", "..%2F..%2Fetc%2Fpasswd", "%2e%2e/%2e%2e/etc/passwd", "link.cag", "etc/passwd", "", ".", "..", "none.cag", "a%00b"]:
        assert v.ask("GET", "/api/file?path=" + path)[0] == 404, path
    for path in ["../x.cag", "/tmp/x.cag", "link.cag", "etc/x.cag", "notes.txt", "x.sh", "none/x.cag", ".cag"]:
        assert v.ask("PUT", "/api/file?path=" + path, "x = 1\n")[0] == 403, path
    for path in ["/../../etc/passwd", "/%2e%2e/model.cag", "/model.cag", "/api", "/api/none"]:
        assert v.ask("GET", path)[0] == 404, path
    v.close()


def test_wrong_requests():
    v = View(VASE)
    v.scene(1)
    for body in ["", "[", "[]", "1", '{"params": 3}', '{"files": [1]}', '{"time": "x"}', "\0", "{" * 5000]:
        status = v.ask("POST", "/api/run", body)[0]
        assert status in (202, 400), (body, status)
    assert v.ask("POST", "/api/run", "[]")[0] == 400
    for number in ["0", "-1", "999", "x", "99999999999999999999"]:
        assert v.ask("GET", "/api/job/" + number)[0] == 404
    assert v.ask("GET", "/api/mesh/../../etc/passwd")[0] == 404
    assert v.ask("POST", "/api/render", '{"width": -5, "height": 1e9, "camera": {"eye": [0, 0, 0], "target": [0, 0, 0], "up": [0, 0, 0]}}')[0] == 202
    assert v.ask("DELETE", "/api/hello")[0] == 404
    v.close()


def raw(v, data, wait=True):
    """Sends bytes, and returns the first line of the answer."""
    s = socket.create_connection(("127.0.0.1", v.port), timeout=WAIT)
    try:
        s.sendall(data)
        return s.recv(200).split(b"\r\n")[0] if wait else b""
    except OSError:
        return b""
    finally:
        s.close()


def test_sizes_are_limited():
    v = View(VASE)
    v.scene(1)
    head = f"POST /api/run HTTP/1.1\r\nHost: localhost\r\nCookie: cag-view-{v.port}={v.token}\r\n".encode()
    assert b" 413 " in raw(v, head + b"Content-Length: 99999999999\r\n\r\n") + b" 413 "
    status = v.ask("POST", "/api/run", b" " * (33 << 20))[0]
    assert status == 413, status
    raw(v, head + b"Content-Length: 1000\r\n\r\n{", wait=False)
    raw(v, b"GET / HTTP/1.1\r\n" + b"X: " + b"a" * 200000 + b"\r\n\r\n")
    raw(v, b"\0\1\2\3" * 1000)
    assert v.ask("GET", "/api/hello")[0] == 200
    v.close()


def points_of(v, part, status=200):
    found, body, _ = v.ask("POST", "/api/points", json.dumps({"part": part}))
    assert found == status, (found, body)
    return json.loads(body)


def test_points_that_can_be_dragged():
    v = View(VASE)
    v.scene(1)
    answer = points_of(v, "vase")
    points = answer["points"]
    assert answer["omitted"] == 0 and [p["at"] for p in points] == [[0, 0, 0], [20, 0, 0], [24, 0, 40], [0, 0, 40]]
    third = points[2]
    assert third["numbers"][1] is None and third["params"] == ["height"] and third["moved"] == [False, True] and third["locked"] is None
    text = VASE.split("\n")[1]
    number = third["numbers"][0]
    assert text[number["column"] - 1 : number["endColumn"] - 1] == "24" and number["line"] == 2
    assert [number[k] for k in ("file", "value", "unit", "scale")] == ["model.cag", 24, "", 1]
    assert third["plane"]["normal"] == [0, -1, 0] and third["map"] == [1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0]
    move = points_of(v, "box")["points"]
    assert [p["call"] for p in move] == ["translate"] and move[0]["plane"] is None and move[0]["at"] == [60, 0, 0]
    v.close()


def test_params_follow_a_point():
    v = View(VASE)
    v.scene(1)
    wanted = {"part": "vase", "point": 2, "target": [24, 0, 61.234], "ignored": [[0, 1, 0]], "params": ["height"], "pixel": 0.1}
    status, body, _ = v.ask("POST", "/api/solve", json.dumps(wanted))
    assert status == 200 and json.loads(body) == {"params": {"height": "61.23"}, "at": [24, 0, 61.23]}, body
    # The scene is as it was.
    assert points_of(v, "vase")["points"][2]["at"] == [24, 0, 40]
    # Beyond the range, the param stays at its end.
    wanted["target"] = [24, 0, 500]
    assert json.loads(v.ask("POST", "/api/solve", json.dumps(wanted))[1])["params"] == {"height": "90"}
    v.close()


def test_points_that_are_not_there():
    v = View(VASE)
    v.scene(1)
    points_of(v, "bottle", 404)
    points_of(v, 7, 400)
    for body in ("", "[", "[]", "null", '{"part": null}', "\0", '"vase"'):
        status, answer, _ = v.ask("POST", "/api/points", body)
        assert status == 400 and "`part`" in json.loads(answer)["error"], (body, status, answer)
    good = {"part": "vase", "point": 2, "target": [24, 0, 61], "params": ["height"]}
    assert v.ask("POST", "/api/solve", json.dumps(good))[0] == 200
    for field, value, expected in (
        ("part", None, 400), ("part", "bottle", 404), ("point", -1, 400), ("point", "2", 400), ("point", 1e300, 400), ("point", 77, 404),
        ("target", [1, 2], 400), ("target", [1, 2, "3"], 400), ("target", None, 400), ("params", [], 400), ("params", ["width"], 404),
        ("params", ["height"] * 9, 400), ("params", [1], 400), ("params", "height", 400), ("ignored", [0, 0, 2], 400), ("ignored", [[0, 0, 1]] * 3, 400), ("ignored", 1, 400), ("ignored", [[0, 0, 0]], 200)):
        status, answer, _ = v.ask("POST", "/api/solve", json.dumps({**good, field: value}))
        assert status == expected and ("error" in json.loads(answer)) == (status != 200), (field, value, status, answer)
    assert v.ask("GET", "/api/points")[0] == 404
    v.close()
    broken = View("show sphere(\n")
    broken.wait("messages")
    points_of(broken, "sphere", 409)
    broken.close()


def memory_of(process):
    with open(f"/proc/{process.pid}/status") as f:
        return next(int(line.split()[1]) for line in f if line.startswith("VmRSS"))


def test_a_thousand_connections_and_slow_readers():
    v = View(VASE)
    v.scene(1)
    slow = []
    for _ in range(8):
        s = socket.create_connection(("127.0.0.1", v.port))
        s.sendall(f"GET /api/events HTTP/1.1\r\nHost: localhost\r\nCookie: cag-view-{v.port}={v.token}\r\n\r\n".encode())
        slow.append(s)
    many = []
    for _ in range(1000):
        try:
            many.append(socket.create_connection(("127.0.0.1", v.port), timeout=5))
        except OSError:
            break
    for s in many:
        s.close()
    before = memory_of(v.process)
    for i in range(40):
        v.scene(v.run(params={"height": str(20 + i)}))
    assert memory_of(v.process) < before + 100000, "memory grows with slow readers"
    assert v.ask("GET", "/api/hello")[0] == 200
    for s in slow:
        s.close()
    v.close()


def test_a_server_on_the_same_port_has_the_same_token():
    state = tempfile.mkdtemp()
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        port = str(s.getsockname()[1])

    def token(on=port):
        v = View(VASE, "--port", on, state=state)
        assert v.close() == 130
        return v.token

    first = token()
    path = os.path.join(state, "cag", f"view-{port}.token")
    assert token() == first and os.stat(path).st_mode & 0o777 == 0o600
    os.chmod(path, 0o644)  # others could have read it
    second = token()
    assert second != first and token() == second and os.stat(path).st_mode & 0o777 == 0o600
    other = os.path.join(state, "other")
    os.rename(path, other)
    os.symlink(other, path)
    third = token()
    assert third != second and not os.path.islink(path)
    with open(other) as f:
        assert f.read() == second
    with open(path, "w") as f:
        f.write("short")
    assert token() not in (first, second, third, "short")
    one, two = View(VASE), View(VASE)  # on any free port: always another one
    assert one.token != two.token and one.close() == 130 and two.close() == 130
    shutil.rmtree(state)


def test_a_port_in_use():
    v = View(VASE)
    second = subprocess.run([CAG, "view", v.path, "--no-open", "--port", str(v.port)], capture_output=True, text=True, timeout=WAIT)
    assert second.returncode == 3 and str(v.port) in second.stderr, second
    v.close()
    missing = subprocess.run([CAG, "view", "/nowhere/x.cag", "--no-open"], capture_output=True, text=True, timeout=WAIT)
    assert missing.returncode == 3 and "/nowhere/x.cag" in missing.stderr
    folder = subprocess.run([CAG, "view", "/tmp", "--no-open"], capture_output=True, text=True, timeout=WAIT)
    assert folder.returncode == 3 and "/tmp is a folder" in folder.stderr, folder


ONLY = sys.argv[2:]


# --- The language server ---

LANGUAGE = """import "./parts.cag" as parts
size = parts.width * 2
show box([size, 1, 1])
show cilinder(4, 1)
"""


def lsp(v, *messages, page="a page", check=False, method="POST"):
    body = json.dumps({"page": page, "check": check, "messages": [dict(m, jsonrpc="2.0") for m in messages]})
    status, answer, _ = v.ask(method, "/api/lsp", body)
    assert status == 200, (status, answer)
    return json.loads(answer)


INITIALIZE = {"id": 1, "method": "initialize", "params": {"capabilities": {}, "initializationOptions": {"modulePath": ["/etc"]}}}


def opening(uri, text):
    return {"method": "textDocument/didOpen", "params": {"textDocument": {"uri": uri, "languageId": "cag", "version": 1, "text": text}}}


def at(method, uri, line, character):
    return {"id": 7, "method": "textDocument/" + method, "params": {"textDocument": {"uri": uri}, "position": {"line": line, "character": character}}}


def with_parts():
    v = View(LANGUAGE, others={"parts.cag": "width = 3\n"})
    return v, "file://" + v.path


def test_language_server():
    v, uri = with_parts()
    lsp(v, INITIALIZE, {"method": "initialized", "params": {}}, opening(uri, LANGUAGE))
    found = next(m for m in lsp(v, check=True) if m.get("method") == "textDocument/publishDiagnostics")["params"]
    assert found["uri"] == uri and [d["code"] for d in found["diagnostics"]] == ["E0201"], found
    answer = lsp(v, at("completion", uri, 1, 13))[0]["result"]
    assert [i["label"] for i in answer["items"]] == ["width"], answer
    place = lsp(v, at("definition", uri, 1, 15))[0]["result"][0]
    assert place["uri"] == "file://" + os.path.join(v.folder, "parts.cag") and place["range"]["start"] == {"line": 0, "character": 0}
    assert not os.path.exists(os.path.join(v.folder, ".cache"))
    # Another page has its own texts.
    other = "show sphere(3)\n"
    lsp(v, INITIALIZE, opening(uri, other), page="another")
    assert lsp(v, check=True, page="another")[0]["params"]["diagnostics"] == []
    assert lsp(v, at("hover", uri, 2, 6))[0]["result"] is not None
    # Pages that are silent longest are forgotten, and told so.
    for i in range(8):
        lsp(v, INITIALIZE, page=f"page {i}")
    assert lsp(v, at("hover", uri, 2, 6))[0]["error"]["code"] == -32002
    assert v.close() == 130


def test_language_server_refuses():
    v, uri = with_parts()
    lsp(v, INITIALIZE)
    for outside in ("file:///etc/passwd", "file://" + v.folder + "/../x.cag", "file://" + v.folder + "%2f..%2fx.cag", "untitled:x", "cag:std.nothing", "", "file://"):
        answer = lsp(v, opening(outside, "x = 1\n"), at("hover", outside, 0, 0))
        assert answer == [{"id": 7, "result": None, "jsonrpc": "2.0"}], (outside, answer)
    os.symlink("/etc", os.path.join(v.folder, "out"))
    assert lsp(v, opening("file://" + v.folder + "/out/x.cag", "x = 1\n"), at("hover", "file://" + v.folder + "/out/x.cag", 0, 0))[-1]["result"] is None
    text = 'import "/etc/'
    lsp(v, opening(uri, text))
    assert lsp(v, at("completion", uri, 0, len(text)))[0]["result"]["items"] == []
    for body in ("", "[]", "{}", '{"page": "x"}', '{"page": "", "messages": []}', '{"page": 3, "messages": []}', json.dumps({"page": "x" * 64, "messages": []}), '{"page": "x", "messages": {}}'):
        assert v.ask("POST", "/api/lsp", body)[0] == 400, body
    assert v.ask("GET", "/api/lsp")[0] == 404
    assert [m["error"]["code"] for m in json.loads(v.ask("POST", "/api/lsp", '{"page": "x", "messages": [1, null, {"id": 2, "method": "a"}]}')[1])] == [-32600, -32600, -32002]
    assert v.ask("POST", "/api/lsp", "{}", cookie=False)[0] in (401, 403)
    # Many pages at once.
    threads = [threading.Thread(target=lambda i=i: [v.ask("POST", "/api/lsp", json.dumps({"page": str(i % 3), "check": True, "messages": []})) for _ in range(10)]) for i in range(12)]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    assert v.close() == 130


def test_unsaved_imports_and_values():
    v, _ = with_parts()
    text = LANGUAGE.replace("cilinder", "cylinder")
    run = v.run(files={"model.cag": text}, params={})
    messages = v.wait("messages", lambda m: m["run"] >= run)
    assert [(x["name"], x["text"], x["file"], x["line"]) for x in messages["values"]] == [("size", "6", "model.cag", 2)], messages["values"]
    run = v.run(files={"model.cag": text, "parts.cag": "width = 5\n", "../other.cag": "", "": "x"}, params={})
    messages = v.wait("messages", lambda m: m["run"] >= run)
    assert messages["ok"] and messages["values"][0]["text"] == "10"
    scene = v.scene(run)
    assert scene["files"] == ["model.cag", "parts.cag"], scene["files"]
    assert scene["parts"][0]["bounds"][1][0] == 10
    # The file on the disk counts again once it is saved.
    assert v.ask("PUT", "/api/file?path=parts.cag", "width = 7\n")[0] == 200
    scene = v.wait("scene", lambda s: s["parts"][0]["bounds"][1][0] == 14)
    # A failing call tells the places of its callers.
    run = v.run(files={"model.cag": "f(x) = sqrt(x)\nshow box([f(-1), 1, 1])\n"}, params={})
    messages = v.wait("messages", lambda m: m["run"] >= run)
    assert [(r["line"], r["message"]) for r in messages["diagnostics"][0]["related"]] == [(2, "called here")], messages["diagnostics"]
    assert v.close() == 130


def test_places_in_imported_files_have_paths_below_the_folder():
    v = View("x = 1\n")
    os.makedirs(os.path.join(v.folder, "sub/deep"))
    for name, text in {"sub/a.cag": 'import "./../b.cag" as b\nimport "./deep/c.cag" as c\na = b.b + c.c\n', "b.cag": "b = 1 + 1\n", "sub/deep/c.cag": 'import "../../b.cag" as b\nc = b.b * 2\n'}.items():
        with open(os.path.join(v.folder, name), "w") as f:
            f.write(text)
    run = v.run(files={"model.cag": 'import "./sub/a.cag" as a\nshow box([a.a, 1, 1])\n'}, params={})
    messages = v.wait("messages", lambda m: m["run"] >= run)
    assert sorted((x["file"], x["text"]) for x in messages["values"]) == [("b.cag", "2"), ("sub/a.cag", "6"), ("sub/deep/c.cag", "4")], messages
    assert sorted(v.scene(run)["files"]) == ["b.cag", "model.cag", "sub/a.cag", "sub/deep/c.cag"]
    assert v.close() == 130


def test_library_texts():
    v = View(VASE)
    status, body, _ = v.ask("GET", "/api/file?path=std.materials")
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../stdlib/materials.cag"), "rb") as f:
        assert status == 200 and body == f.read()
    assert v.ask("GET", "/api/file?path=std.nothing")[0] == 404
    assert v.ask("PUT", "/api/file?path=std.materials", "x")[0] == 403
    assert v.close() == 130


def main():
    passed = failed = 0
    for name, test in sorted(globals().items()):
        if not name.startswith("test_") or (ONLY and name not in ONLY):
            continue
        try:
            test()
            passed += 1
        except Exception as error:  # each test is reported
            failed += 1
            print(f"FAILED: {name}: {type(error).__name__}: {error}")
            if isinstance(error, AssertionError):
                line = error.__traceback__
                while line.tb_next:
                    line = line.tb_next
                print(f"  at line {line.tb_lineno}")
    print(f"{passed} passed, {failed} failed, 0 skipped")
    return failed > 0


sys.exit(main())
