#!/usr/bin/env python3
"""Every request of the language server, with checked answers. The last line is `N passed, N failed, N skipped`.

    requests.py PROGRAM [NAME ...]      only the tests whose names contain one of the words
"""

import json
import os
import subprocess
import sys
import tempfile
import time
import traceback

from client import FULL, Client, ServerError, uri_of

PROGRAM = os.path.abspath(sys.argv[1])
TESTS = []


def test(function):
    TESTS.append(function)
    return function


class Workspace:
    """A folder with files, and a client that has opened some of them."""

    def __init__(self, files, opened=None, **options):
        self.temporary = tempfile.TemporaryDirectory()
        root = os.path.realpath(self.temporary.name)
        self.folder = os.path.join(root, "work")
        os.mkdir(self.folder)
        for name, text in files.items():
            os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
            with open(self.path(name), "w", encoding="utf-8", newline="") as out:
                out.write(text)
        self.client = Client(PROGRAM, self.folder, environment={"XDG_CACHE_HOME": os.path.join(root, "cache")}, **options)
        for name in opened or [next(iter(files))]:
            self.client.open(self.uri(name), files[name])

    def path(self, name):
        return os.path.join(self.folder, name)

    def uri(self, name):
        return uri_of(self.path(name))

    def __enter__(self):
        return self, self.client, self.uri("a.cag")

    def __exit__(self, kind, *rest):
        if kind is None:
            assert self.client.end() == 0, "the exit status"
        self.client.process.kill()
        self.temporary.cleanup()


def equal(found, expected):
    assert found == expected, f"expected {expected!r}, found {found!r}"


def has(text, *parts):
    for part in parts:
        assert part in text, f"{text!r} lacks {part!r}"


def hover(client, uri, mark, inside=0):
    answer = client.ask("textDocument/hover", client.at(uri, mark, inside))
    return answer and answer["contents"]["value"]


def labels(client, uri, mark, inside=None):
    """The proposals at the end of `mark`, by label."""
    inside = len(mark) if inside is None else inside
    answer = client.ask("textDocument/completion", client.at(uri, mark, inside))
    return {item["label"]: item for item in answer["items"]}


def completed(client, uri, mark, label):
    """The text after a proposal was chosen."""
    item = labels(client, uri, mark)[label]
    return client.apply(uri, [item["textEdit"], *item.get("additionalTextEdits", [])])


def places(client, answer):
    """The text of each range, with the name of its file and its line from 1."""
    out = []
    for place in answer:
        path = place["uri"].split("/")[-1]
        out.append(f"{path}:{place['range']['start']['line'] + 1}:{place['range']['start']['character'] + 1}")
    return out


def actions(client, uri, mark, length=None, only=None):
    """The actions for the text `mark`, by title."""
    at = client.texts[uri].index(mark)
    span = {"start": client.position(uri, at), "end": client.position(uri, at + (len(mark) if length is None else length))}
    context = {"diagnostics": client.wait_for(uri)}
    if only:
        context["only"] = only
    answer = client.ask("textDocument/codeAction", {"textDocument": {"uri": uri}, "range": span, "context": context})
    return {action["title"]: action for action in answer}


def acted(client, uri, mark, title, length=None):
    """The text after an action."""
    found = actions(client, uri, mark, length)
    assert title in found, f"no action {title!r} among {list(found)}"
    return client.apply(uri, found[title]["edit"]["changes"][uri])


def mistakes(client, uri):
    """Code and text of each diagnostic."""
    return [(d["code"], client.part(uri, d["range"])) for d in client.wait_for(uri)]


# --- Diagnostics ---


@test
def errors_of_syntax_names_arity_types_and_units():
    with Workspace({"a.cag": "x = 1 +* 2\nshow spher(3)\nprint sin(30)\nprint box()\nprint 1 + \"a\"\nunused = 4\n"}) as (_, c, uri):
        equal(mistakes(c, uri), [("E0120", "*"), ("E0201", "spher"), ("E0301", "30"), ("E0302", "box()"), ("E0321", "1 + \"a\"")])
        message = c.wait_for(uri)[1]["message"]
        has(message, "unknown name `spher`", "help: did you mean `sphere`?")


@test
def more_than_twenty_errors_are_reported():
    with Workspace({"a.cag": "".join(f"x{i} = ${i}\ny{i} = z{i}\n" for i in range(500))}) as (_, c, uri):
        found = mistakes(c, uri)
        equal(len(found), 1000)
        equal([code for code, _ in found].count("E0201"), 500)


@test
def a_broken_line_of_a_block_hides_nothing():
    with Workspace({"a.cag": "f(a) = {\n  x = a +* 2\n  y = x + nothing\n  y\n}\nprint f(1)\n"}) as (_, c, uri):
        equal(mistakes(c, uri), [("E0120", "*"), ("E0201", "nothing")])


@test
def unused_definitions_are_faded():
    with Workspace({"a.cag": "import std.robots\nx = 1\nprint 2\n"}) as (_, c, uri):
        found = c.wait_for(uri)
        equal([(d["severity"], d["tags"], c.part(uri, d["range"])) for d in found], [(4, [1], "std.robots"), (4, [1], "x")])


@test
def a_second_definition_has_its_first_as_a_related_place():
    with Workspace({"a.cag": "x = 1\nx = 2\nprint x\n"}) as (_, c, uri):
        related = c.wait_for(uri)[0]["relatedInformation"][0]
        equal((related["location"]["uri"], related["location"]["range"]["start"]["line"], related["message"]), (uri, 0, "first defined here"))


@test
def errors_of_imported_files_are_reported_in_them():
    with Workspace({"a.cag": "import b: x\nprint x\n", "b.cag": "x = 1 $\n"}) as (w, c, uri):
        equal(c.wait_for(uri), [])
        equal([d["code"] for d in c.wait_for(w.uri("b.cag"), 0)], ["E0102"])
        # An open document counts instead of its file, and reports for itself.
        c.open(w.uri("b.cag"), "x = 1\n")
        equal(c.wait_for(w.uri("b.cag")), [])
        c.replace(w.uri("b.cag"), "x", "y")
        c.wait_for(w.uri("b.cag"))
        c.diagnostics.pop(uri)
        equal(mistakes(c, uri), [("E0245", "x")])


@test
def a_change_of_a_file_on_disk_is_noticed():
    with Workspace({"a.cag": "import b: x\nprint x\n", "b.cag": "x = 1\n"}) as (w, c, uri):
        equal(c.wait_for(uri), [])
        with open(w.path("b.cag"), "w") as out:
            out.write("other = 1\n")
        c.diagnostics.pop(uri)
        c.tell("workspace/didChangeWatchedFiles", {"changes": [{"uri": w.uri("b.cag"), "type": 2}]})
        equal(mistakes(c, uri), [("E0245", "x")])


@test
def a_closed_document_has_no_diagnostics():
    with Workspace({"a.cag": "x = $\n"}) as (_, c, uri):
        equal(len(c.wait_for(uri)), 1)
        c.diagnostics.pop(uri)
        c.close(uri)
        equal(c.wait_for(uri, 0), [])


@test
def many_changes_cause_one_check():
    with Workspace({"a.cag": "".join(f"print name + {i}\n" for i in range(333)) + "name = 1\n"}) as (_, c, uri):
        c.wait_for(uri)
        before = len([n for n in c.notes if n["method"] == "textDocument/publishDiagnostics"])
        answer = c.ask("textDocument/rename", {**c.at(uri, "name = 1"), "newName": "title"})
        edits = answer["changes"][uri]
        equal(len(edits), 334)
        c.change(uri, [(c.offset(uri, e["range"]["start"]), c.offset(uri, e["range"]["end"]), e["newText"]) for e in reversed(edits)])
        equal(c.wait_for(uri), [])
        equal(len([n for n in c.notes if n["method"] == "textDocument/publishDiagnostics"]) - before, 1)


# --- Runs ---


@test
def a_save_runs_the_script():
    text = "x = sqrt(0 - 1)\nprint [for i in 0..2: i]\nassert 1 > 2, \"one is more\"\nprint x\n"
    with Workspace({"a.cag": text}) as (_, c, uri):
        c.replace(uri, "x = sqrt(0 - 1)", "x = len(text(1))")
        with open(uri[7:], "w") as out:
            out.write(c.texts[uri])
        equal(c.wait_for(uri), [])
        c.diagnostics.pop(uri)
        c.tell("textDocument/didSave", {"textDocument": {"uri": uri}})
        found = c.wait_for(uri)
        equal([(d["source"], c.part(uri, d["range"])) for d in found], [("cag run", "1 > 2")])
        has(found[0]["message"], "one is more")
        # An error in a function names its callers.
        c.change(uri, [(0, len(c.texts[uri]), "g(x) = sqrt(x) + 1\nf(x) = g(x - len(\"ab\")) + 1\nprint f(1)\n")])
        with open(uri[7:], "w") as out:
            out.write(c.texts[uri])
        equal(c.wait_for(uri), [])
        c.diagnostics.pop(uri)
        c.tell("textDocument/didSave", {"textDocument": {"uri": uri}})
        found = c.wait_for(uri)
        equal([(r["message"], c.part(uri, r["location"]["range"])) for r in found[0]["relatedInformation"]],
              [("called from here in f", "g(x - len(\"ab\"))"), ("called from here", "f(1)")])
        c.change(uri, [(0, len(c.texts[uri]), text.replace("x = sqrt(0 - 1)", "x = len(text(1))"))])
        c.wait_for(uri)
        # The next change makes the result obsolete.
        c.replace(uri, "1 > 2", "1 < 2")
        equal(c.wait_for(uri), [])


@test
def a_run_reports_geometry_and_stops_when_the_text_changes():
    with Workspace({"a.cag": "show intersection(sphere(1), sphere(1) |> translate([9, 0, 0]))\n"}) as (_, c, uri):
        equal(c.wait_for(uri), [])
        c.diagnostics.pop(uri)
        c.tell("textDocument/didSave", {"textDocument": {"uri": uri}})
        has(" ".join(d["message"] for d in c.wait_for(uri)), "empty")
        loop = "f(n) = if n == 0 then 1 else f(n - 1) + f(n - 1)\nprint f(60)\n"
        c.change(uri, [(0, len(c.texts[uri]), loop)])
        with open(uri[7:], "w") as out:
            out.write(loop)
        c.tell("textDocument/didSave", {"textDocument": {"uri": uri}})
        time.sleep(0.3)
        start = time.monotonic()
        c.replace(uri, "60", "61")
        equal(c.wait_for(uri), [])
        assert time.monotonic() - start < 5


@test
def typing_runs_nothing():
    with Workspace({"a.cag": "print 1\n"}, arguments=[]) as (w, c, uri):
        c.change(uri, [(0, 0, "assert false\n")])
        equal(c.wait_for(uri), [])
        time.sleep(0.2)
        equal(c.wait_for(uri), [])


# --- Completion ---


@test
def completion_proposes_names_in_scope():
    text = "top = 1\nf(first, second = 2) = {\n  inner = first\n  g(x) = x + inner\n  [for item in 0..3: item + \n  ]\n}\n"
    with Workspace({"a.cag": text}) as (_, c, uri):
        found = labels(c, uri, "item + ")
        for name in ["top", "f", "first", "second", "inner", "g", "item", "sphere", "pi", "if", "not"]:
            assert name in found, name
        assert "x" not in found, "the parameter of another function"
        assert found["item"]["sortText"] < found["top"]["sortText"] < found["sphere"]["sortText"]
        has(found["sphere"]["documentation"]["value"], "Returns a ball")
        equal(found["sphere"]["detail"], "sphere(radius)")


@test
def completion_proposes_members():
    text = "import std.materials as mat\nr = { size: 1, inner: { depth: 2 } }\nprint mat.gl\nprint r.\nprint r.inner.\nx = [1, 2]\nprint x.\nprint mat.brass.\n"
    with Workspace({"a.cag": text}) as (_, c, uri):
        c.wait_for(uri)
        found = list(labels(c, uri, "print mat.gl"))
        assert "glazed" in found and "matte" not in found, found
        equal(completed(c, uri, "print mat.gl", "glazed").split("\n")[2], "print mat.glazed($0)")
        equal(list(labels(c, uri, "print r.")), ["size", "inner"])
        equal(list(labels(c, uri, "print r.inner.")), ["depth"])
        equal(list(labels(c, uri, "print x.")), ["x", "y", "z"])
        has(str(list(labels(c, uri, "print mat.brass."))), "color", "roughness")


@test
def completion_proposes_arguments_and_their_texts():
    text = "c = circle(10)\nshow bspline([[0, 0]], degree: 2, \nshow sweep(c, c, \nprint sweep(c, c, orient: \"\")\nbolt(length, head = 3) = length\nprint bolt(\n"
    with Workspace({"a.cag": text}) as (_, c, uri):
        found = labels(c, uri, "degree: 2, ")
        assert "degree: " not in found, "it is given"
        assert "closed: " in found and "knots: " in found
        has(found["closed: "]["detail"], "bool")
        has(str(list(labels(c, uri, "sweep(c, c, "))), "orient: ", "twist: ")
        equal([x for x in labels(c, uri, "orient: \"") if x in ("rmf", "frenet", "fixed")], ["rmf", "frenet", "fixed"])
        equal(completed(c, uri, "orient: \"", "frenet").split("\n")[3], "print sweep(c, c, orient: \"frenet\")")
        found = list(labels(c, uri, "print bolt("))
        equal(found[:2], ["length: ", "head: "])


@test
def completion_writes_calls_with_gaps():
    text = "bolt(length, head = 3) = length\nshow con\nshow cone(1, 2) |> translat\nprint bol\nprint spher(2)\nprint p\n"
    with Workspace({"a.cag": text}) as (_, c, uri):
        equal(labels(c, uri, "show con")["cone"]["textEdit"]["newText"], "cone(${1:height}, ${2:radius})")
        equal(labels(c, uri, "|> translat")["translate"]["textEdit"]["newText"], "translate(${1:V})")
        equal(labels(c, uri, "print bol")["bolt"]["textEdit"]["newText"], "bolt(${1:length})")
        equal(labels(c, uri, "print spher")["sphere"]["textEdit"]["newText"], "sphere")
        equal(labels(c, uri, "print p")["pi"]["textEdit"]["newText"], "pi")
    with Workspace({"a.cag": "show con\n"}, capabilities={}) as (_, c, uri):
        equal(labels(c, uri, "show con")["cone"]["textEdit"]["newText"], "cone")


@test
def completion_proposes_modules_and_their_names():
    with Workspace({"a.cag": "import std.ma\nimport std.robots: pu\nimport \nimport \"pa\"\n", "parts/b.cag": "x = 1\n", "gear.cag": "y = 1\n"}) as (_, c, uri):
        assert "std.materials" in labels(c, uri, "import std.ma")
        equal(completed(c, uri, "import std.ma", "std.materials").split("\n")[0], "import std.materials")
        assert "puma560" in labels(c, uri, "std.robots: pu")
        found = labels(c, uri, "std.robots: pu\nimport ")
        assert "gear" in found and "std.curves" in found, list(found)
        equal(sorted(labels(c, uri, "import \"")), ["a.cag", "gear.cag", "parts/"])
        equal(list(labels(c, uri, "import \"pa")), ["parts/"])


@test
def completion_proposes_files_colors_and_statements():
    with Workspace({"a.cag": "m = read_mesh(\"\")\nshow sphere(1) |> color(\"\")\n\nprint 1 \n// note \n", "part.stl": ""}) as (_, c, uri):
        assert "part.stl" in labels(c, uri, "read_mesh(\"")
        assert "teal" in labels(c, uri, "color(\"")
        start = labels(c, uri, "color(\"\")\n")
        assert {"show", "param", "import"} <= set(start), list(start)
        equal(start["param ..."]["insertTextFormat"], 2)
        equal(labels(c, uri, "// note "), {})


@test
def completion_imports_the_module_that_has_a_name():
    with Workspace({"a.cag": "// A note.\n\nprint glaz\n"}) as (_, c, uri):
        equal(completed(c, uri, "print glaz", "glazed"), "// A note.\n\nimport std.materials: glazed\nprint glazed($0)\n")


# --- Hover and signatures ---


@test
def hover_describes_names():
    text = ("import std.materials as mat\n/// The area of a ring.\n///\n/// - `outer`: number, mm: the radius outside\nring(outer, inner = outer / 2) = pi * (outer^2 - inner^2)\n"
            "size = 2 * 3 + 1\nparam height = 120 in 50..300  \"height, mm\"\nprint ring(size), height, mat.glazed(\"teal\"), sin(30deg), 2.5cm, 1turn\nprint if true then 1 else 2\n")
    with Workspace({"a.cag": text}) as (_, c, uri):
        has(hover(c, uri, "ring(size)"), "ring(outer, inner = outer / 2)", "The area of a ring")
        has(hover(c, uri, "size),"), "size = 2 * 3 + 1", "a number", "Value: `7`")
        has(hover(c, uri, "height, mat"), "param height = 120 in 50..300", "height, mm")
        has(hover(c, uri, "glazed("), "glazed(color = \"white\")", "Glazed pottery", "std.materials")
        has(hover(c, uri, "mat.gl"), "import std.materials", "what a surface looks like")
        has(hover(c, uri, "sin("), "sin(angle)", "```cag\nprint", "`angle`")
        has(hover(c, uri, "2.5cm", 3), "25 mm")
        has(hover(c, uri, "30deg", 1), "30 degrees", "0.5235987755")
        has(hover(c, uri, "1turn", 2), "360 degrees")
        has(hover(c, uri, "if true"), "if CONDITION then VALUE else VALUE")
        equal(hover(c, uri, " = 2 * 3", 1), None)


@test
def signature_help_follows_the_arguments():
    text = "/// A bolt.\n///\n/// - `length`: number, mm: from end to end\nbolt(length, head = 3) = length\nprint bolt(1, \nprint cone(3, centered: true\nprint sphere(2) |> translate(\n"
    with Workspace({"a.cag": text}) as (_, c, uri):
        def active(mark):
            answer = c.ask("textDocument/signatureHelp", c.at(uri, mark, len(mark)))
            s = answer["signatures"][answer["activeSignature"]]
            k = s["activeParameter"]
            start, end = s["parameters"][k]["label"]
            return s["label"], s["label"][start:end], s["parameters"][k].get("documentation", {}).get("value", "")

        equal(active("print bolt(1, "), ("bolt(length, head = 3)", "head = 3", ""))
        equal(active("print bolt("), ("bolt(length, head = 3)", "length", "number, mm: from end to end"))
        label, part, meaning = active("centered: true")
        has(label, "cone(height, radius, centered = false) -> solid")
        equal(part, "centered = false")
        equal(active("translate(")[1], "V")
        equal(c.ask("textDocument/signatureHelp", c.at(uri, "bolt(length")), None)


# --- Navigation ---

MODEL = {
    "a.cag": "import parts.gear as g\nimport parts.gear: tooth\nshow g.wheel(12, module: 2)\nprint tooth, g.tooth, g.wheel\n",
    "parts/gear.cag": "/// A tooth.\ntooth = 3\n/// A wheel.\nwheel(count, module = 1) = cylinder(tooth * module, count)\n_own = tooth\n",
    "b.cag": "import parts.gear\nprint gear.tooth\n",
}


@test
def definitions_are_found_across_files():
    with Workspace(MODEL) as (_, c, uri):
        def goes_to(mark, inside=0):
            return places(c, c.ask("textDocument/definition", c.at(uri, mark, inside)))

        equal(goes_to("wheel(12"), ["gear.cag:4:1"])
        equal(goes_to("tooth,"), ["gear.cag:2:1"])
        equal(goes_to("parts.gear as"), ["gear.cag:1:1"])
        equal(goes_to("g.tooth"), ["gear.cag:1:1"])
        equal(goes_to("module: 2"), ["gear.cag:4:14"])
        equal(goes_to("show"), [])


@test
def the_library_opens_from_read_only_files():
    with Workspace({"a.cag": "import std.materials as mat\nshow sphere(1) |> material(mat.brass)\n"}) as (_, c, uri):
        answer = c.ask("textDocument/definition", c.at(uri, "brass"))
        path = answer[0]["uri"][7:]
        equal(oct(os.stat(path).st_mode & 0o777), "0o444")
        with open("stdlib/materials.cag", encoding="utf-8") as text, open(path, encoding="utf-8") as copy:
            source = text.read()
            equal(copy.read(), source)
        c.open(answer[0]["uri"], source)
        equal(c.part(answer[0]["uri"], answer[0]["range"]), "brass")
        has(hover(c, answer[0]["uri"], "metal(color"), "metal(color = \"silver\", roughness = 0.2)")
        found = c.ask("textDocument/references", {**c.at(uri, "brass"), "context": {"includeDeclaration": True}})
        equal([p.split(":")[0] for p in places(c, found)], ["a.cag", "materials.cag"])


@test
def references_are_found_in_all_files():
    with Workspace(MODEL) as (_, c, uri):
        answer = c.ask("textDocument/references", {**c.at(uri, "tooth,"), "context": {"includeDeclaration": True}})
        equal(sorted(places(c, answer)), ["a.cag:2:20", "a.cag:4:16", "a.cag:4:7", "b.cag:2:12", "gear.cag:2:1", "gear.cag:4:37", "gear.cag:5:8"])
        answer = c.ask("textDocument/references", {**c.at(uri, "tooth,"), "context": {"includeDeclaration": False}})
        equal(len(answer), 6)
        answer = c.ask("textDocument/references", {**c.at(uri, "module: 2"), "context": {"includeDeclaration": True}})
        equal(sorted(places(c, answer)), ["a.cag:3:18", "gear.cag:4:14", "gear.cag:4:45"])


@test
def highlights_stay_in_the_document():
    with Workspace(MODEL) as (_, c, uri):
        answer = c.ask("textDocument/documentHighlight", c.at(uri, "g.tooth"))
        equal([c.part(uri, h["range"]) for h in answer], ["g", "g", "g", "g"])


@test
def a_name_is_changed_in_all_files():
    with Workspace(MODEL, list(MODEL)) as (w, c, uri):
        c.wait_for(uri)
        edits = c.ask("textDocument/rename", {**c.at(uri, "tooth,"), "newName": "cog"})["changes"]
        equal(c.apply(uri, edits[uri]), MODEL["a.cag"].replace("tooth", "cog"))
        gear = w.uri("parts/gear.cag")
        equal(c.apply(gear, edits[gear]), MODEL["parts/gear.cag"].replace("tooth", "cog").replace("A cog", "A tooth"))
        equal(c.apply(w.uri("b.cag"), edits[w.uri("b.cag")]), MODEL["b.cag"].replace("tooth", "cog"))
        edits = c.ask("textDocument/rename", {**c.at(uri, "module: 2"), "newName": "pitch"})["changes"]
        equal(c.apply(uri, edits[uri]), MODEL["a.cag"].replace("module", "pitch"))
        edits = c.ask("textDocument/rename", {**c.at(w.uri("b.cag"), "gear.tooth"), "newName": "z"})["changes"]
        equal(c.apply(w.uri("b.cag"), edits[w.uri("b.cag")]), "import parts.gear as z\nprint z.tooth\n")
        edits = c.ask("textDocument/rename", {**c.at(uri, "g.tooth"), "newName": "z"})["changes"]
        equal(c.apply(uri, edits[uri]), MODEL["a.cag"].replace("as g", "as z").replace("g.", "z.").replace("partsz.", "parts."))


@test
def a_change_of_a_name_that_breaks_a_script_is_refused():
    text = "a = 1\nb = 2\nf(x) = x + a\nprint f(b), sqrt(4), [for i in 0..2: i + a]\n"
    with Workspace({"a.cag": text}) as (_, c, uri):
        def refused(mark, name, *why):
            try:
                c.ask("textDocument/rename", {**c.at(uri, mark), "newName": name})
            except ServerError as error:
                equal(error.code, -32803)
                has(str(error), *why)
                return
            raise AssertionError("it was not refused")

        refused("a = 1", "b", "b is defined twice")
        refused("a = 1", "x", "x")  # the parameter would capture it
        refused("a = 1", "sqrt")  # it would capture the built-in
        refused("a = 1", "2x", "`2x` is not a name")
        refused("a = 1", "if", "`if` is not a name")
        refused("sqrt(4)", "root", "built in")
        equal(c.ask("textDocument/prepareRename", c.at(uri, "sqrt(4)")), None)
        equal(c.part(uri, c.ask("textDocument/prepareRename", c.at(uri, "x + a"))), "x")


# --- Structure ---


@test
def symbols_form_a_tree():
    with Workspace({"a.cag": "param p = 1 in 0..2 \"how much\"\nf(x, y = 2) = {\n  inner = x\n  inner + y\n}\nr = { size: 1, at: [0, 0] }\nprint f(p), r\n"}) as (_, c, uri):
        answer = c.ask("textDocument/documentSymbol", {"textDocument": {"uri": uri}})
        equal([(s["name"], s.get("detail"), [k["name"] for k in s["children"]]) for s in answer],
              [("p", "how much", []), ("f", "(x, y = 2)", ["inner"]), ("r", None, ["size", "at"])])
        equal(c.part(uri, answer[1]["range"]), "f(x, y = 2) = {\n  inner = x\n  inner + y\n}")


@test
def workspace_symbols_match_letters_in_order():
    with Workspace(MODEL) as (_, c, uri):
        answer = c.ask("workspace/symbol", {"query": "WHL"})
        equal([(s["name"], s["location"]["uri"].split("/")[-1]) for s in answer], [("wheel", "gear.cag")])
        equal(sorted(s["name"] for s in c.ask("workspace/symbol", {"query": ""})), ["_own", "tooth", "wheel"])


@test
def parts_of_several_lines_fold():
    with Workspace({"a.cag": "// A note\n// of two lines.\nimport std.robots\nimport std.curves\n\nf(x) = {\n  y = x\n  y\n}\nz = [\n  1, 2\n]\n"}) as (_, c, uri):
        answer = c.ask("textDocument/foldingRange", {"textDocument": {"uri": uri}})
        equal([(f["startLine"], f["endLine"], f.get("kind")) for f in answer], [(0, 1, "comment"), (2, 3, "imports"), (5, 7, None), (9, 10, None)])


@test
def selections_grow():
    with Workspace({"a.cag": "x = 1 + max(2, alpha * 3)\nalpha = 1\n"}) as (_, c, uri):
        answer = c.ask("textDocument/selectionRange", {"textDocument": {"uri": uri}, "positions": [c.position(uri, 16)]})
        texts, node = [], answer[0]
        while node:
            texts.append(c.part(uri, node["range"]))
            node = node.get("parent")
        equal(texts, ["alpha", "alpha * 3", "max(2, alpha * 3)", "1 + max(2, alpha * 3)", "x = 1 + max(2, alpha * 3)", c.texts[uri]])


def decode(c, uri, data, legend):
    text, line, column, out = c.texts[uri].split("\n"), 0, 0, []
    for i in range(0, len(data), 5):
        line, column = line + data[i], data[i + 1] + (column if data[i] == 0 else 0)
        flags = [m for k, m in enumerate(legend["tokenModifiers"]) if data[i + 4] >> k & 1]
        units = text[line].encode("utf-16-le")
        word = units[2 * column:2 * (column + data[i + 2])].decode("utf-16-le")
        out.append((word, legend["tokenTypes"][data[i + 3]], flags))
    return out


@test
def semantic_words_have_kinds_and_changes():
    with Workspace({"a.cag": "import std.materials as mat\n/// Doc.\nf(x) = x + \"θ😀 {x}\"  // note\nshow mat.brass, f(pi)\n"}) as (_, c, uri):
        legend = c.capabilities["semanticTokensProvider"]["legend"]
        whole = {"textDocument": {"uri": uri}}
        answer = c.ask("textDocument/semanticTokens/full", whole)
        words = decode(c, uri, answer["data"], legend)
        for word in [("import", "keyword", []), ("mat", "namespace", ["definition"]), ("/// Doc.", "comment", ["documentation"]), ("f", "function", ["definition"]),
                     ("x", "parameter", ["definition"]), ("x", "parameter", []), ("\"θ😀 {", "string", []), ("// note", "comment", []),
                     ("brass", "variable", ["defaultLibrary", "readonly"]), ("pi", "variable", ["defaultLibrary", "readonly"]), ("+", "operator", [])]:
            assert word in words, (word, words)
        c.replace(uri, "f(pi)", "f(pi), 3")
        delta = c.ask("textDocument/semanticTokens/full/delta", {**whole, "previousResultId": answer["resultId"]})
        data = list(answer["data"])
        for change in delta["edits"]:
            data[change["start"]:change["start"] + change["deleteCount"]] = change.get("data", [])
        equal(data, c.ask("textDocument/semanticTokens/full", whole)["data"])
        part = c.ask("textDocument/semanticTokens/range", {**whole, "range": {"start": {"line": 3, "character": 0}, "end": {"line": 4, "character": 0}}})
        equal([w[0] for w in decode(c, uri, part["data"], legend)], ["show", "mat", "brass", "f", "pi", "3"])


@test
def hints_name_arguments_if_wanted():
    text = "bolt(length, head = 3) = length + head\nprint bolt(1, 2), cone(3, 4), bolt(1, head: 2)\n"
    with Workspace({"a.cag": text}, options={"inlayHints": True}) as (_, c, uri):
        whole = {"textDocument": {"uri": uri}, "range": {"start": {"line": 0, "character": 0}, "end": {"line": 9, "character": 0}}}
        answer = c.ask("textDocument/inlayHint", whole)
        equal([(h["label"], h["position"]["character"]) for h in answer], [("length:", 11), ("head:", 14), ("height:", 23), ("radius:", 26), ("length:", 35)])
        c.tell("workspace/didChangeConfiguration", {"settings": {"cag": {"inlayHints": False}}})
        equal(c.ask("textDocument/inlayHint", whole), [])


@test
def links_lead_to_modules_and_files():
    with Workspace({"a.cag": "import b\nimport std.curves\nm = read_mesh(\"part.stl\")\nshow m, b.x, curves.f\n", "b.cag": "x = 1\n", "part.stl": ""}) as (w, c, uri):
        answer = c.ask("textDocument/documentLink", {"textDocument": {"uri": uri}})
        equal([(c.part(uri, k["range"]), k["target"].split("/")[-1]) for k in answer], [("b", "b.cag"), ("std.curves", "curves.cag"), ("\"part.stl\"", "part.stl")])


@test
def colors_have_a_picker():
    with Workspace({"a.cag": "show sphere(1) |> color(\"teal\")\nc = \"#0a8\"\nshow sphere(2) |> color(c)\nprint \"red\"\n"}) as (_, c, uri):
        answer = c.ask("textDocument/documentColor", {"textDocument": {"uri": uri}})
        # CSS: teal is #008080.
        equal([(c.part(uri, k["range"]), [round(255 * k["color"][x]) for x in ("red", "green", "blue")]) for k in answer],
              [("\"teal\"", [0, 128, 128]), ("\"#0a8\"", [0, 170, 136])])
        span = answer[0]["range"]
        answer = c.ask("textDocument/colorPresentation", {"textDocument": {"uri": uri}, "range": span, "color": {"red": 1, "green": 0.2, "blue": 0, "alpha": 1}})
        equal(answer[0]["textEdit"]["newText"], "\"#f30\"")
        answer = c.ask("textDocument/colorPresentation", {"textDocument": {"uri": uri}, "range": span, "color": {"red": 0.5, "green": 0.25, "blue": 0, "alpha": 1}})
        equal(answer[0]["label"], "\"#804000\"")


# --- Edits ---

UNTIDY = "a=1\n\n// note\nf(x)=x+  a\nprint   f( 2 )\n"


@test
def formatting_is_that_of_cag_fmt():
    with Workspace({"a.cag": UNTIDY}) as (w, c, uri):
        tidy = subprocess.run([PROGRAM, "fmt", "-"], input=UNTIDY, capture_output=True, text=True, check=True).stdout
        answer = c.ask("textDocument/formatting", {"textDocument": {"uri": uri}, "options": {}})
        equal(c.apply(uri, answer), tidy)
        c.change(uri, [(0, len(UNTIDY), tidy)])
        equal(c.ask("textDocument/formatting", {"textDocument": {"uri": uri}, "options": {}}), [])
        c.change(uri, [(0, 0, "b=$\n")])
        equal(c.ask("textDocument/formatting", {"textDocument": {"uri": uri}, "options": {}}), [])


@test
def a_range_is_formatted_beside_errors():
    with Workspace({"a.cag": UNTIDY + "b=$\n"}) as (_, c, uri):
        span = {"start": {"line": 3, "character": 0}, "end": {"line": 3, "character": 4}}
        answer = c.ask("textDocument/rangeFormatting", {"textDocument": {"uri": uri}, "range": span, "options": {}})
        equal(c.apply(uri, answer), "a=1\n\n// note\nf(x) = x + a\nprint   f( 2 )\nb=$\n")


@test
def typing_formats_the_statement_that_ends():
    with Workspace({"a.cag": "f(x)=x+  1\n\ng(y)={\n z=y\n z}\n"}) as (_, c, uri):
        answer = c.ask("textDocument/onTypeFormatting", {"textDocument": {"uri": uri}, "position": {"line": 1, "character": 0}, "ch": "\n", "options": {}})
        equal(c.apply(uri, answer).split("\n")[0], "f(x) = x + 1")
        answer = c.ask("textDocument/onTypeFormatting", {"textDocument": {"uri": uri}, "position": {"line": 4, "character": 3}, "ch": "}", "options": {}})
        equal(c.apply(uri, answer), "f(x)=x+  1\n\ng(y) = {\n  z = y\n  z\n}\n")


@test
def actions_apply_the_fix_of_an_error():
    with Workspace({"a.cag": ""}) as (_, c, uri):
        for before, mark, title, after in [
                ("show spher(3)\n", "spher", "Change to `sphere`", "show sphere(3)\n"),
                ("print sin(30)\n", "30", "Write 30deg", "print sin(30deg)\n"),
                ("print sin(30)\n", "30", "Write 30rad", "print sin(30rad)\n"),
                ("print 2 + 30deg\n", "2 + 30deg", "Write 2deg", "print 2deg + 30deg\n"),
                ("let x = 2\nprint x\n", "let", "Remove the word", "x = 2\nprint x\n"),
                ("print(1, 2)\n", "(1, 2)", "Remove the parentheses", "print 1, 2\n"),
                ("x = (1, 2)\nprint x\n", "(1, 2)", "Write [1, 2]", "x = [1, 2]\nprint x\n"),
                ("print box(size = 2)\n", "=", "Write a colon", "print box(size: 2)\n"),
                ("print max(1, 2\nx = 3\n", "(", "Insert )", "print max(1, 2)\nx = 3\n"),
                ("sphere(3)\n", "sphere(3)", "Show it", "show sphere(3)\n"),
                ("print true && false\n", "&&", "Write and", "print true and false\n"),
                ("import std.material\nprint material.brass\n", "std.material", "Change to `std.materials`", "import std.materials\nprint material.brass\n"),
                ("print cone(3, 2, centred: true)\n", "centred", "Change to `centered`", "print cone(3, 2, centered: true)\n"),
                ("print 1)\n", ")", "Remove the bracket", "print 1\n")]:
            c.change(uri, [(0, len(c.texts[uri]), before)])
            equal(acted(c, uri, mark, title), after)


@test
def actions_import_define_and_remove():
    files = {"a.cag": "", "parts/bolt.cag": "thread = 6\n", "nut.cag": "hex = 5\n"}
    with Workspace(files) as (_, c, uri):
        for before, mark, title, after in [
                ("show sphere(3) |> material(glazed(\"teal\"))\n", "glazed", "Import glazed from std.materials", "import std.materials: glazed\nshow sphere(3) |> material(glazed(\"teal\"))\n"),
                ("print thread\n", "thread", "Import thread from parts.bolt", "import parts.bolt: thread\nprint thread\n"),
                ("print hex\n", "hex", "Import hex from nut", "import nut: hex\nprint hex\n"),
                ("import nut: hex\nprint hex + width\n", "width", "Add the param width", "import nut: hex\nparam width = 10\nprint hex + width\n"),
                ("x = 1\nprint x + width\n", "width", "Define width", "x = 1\nwidth = 10\nprint x + width\n"),
                ("/// A number.\nx = 1\nprint 2\n", "x", "Remove the unused x", "print 2\n"),
                ("import nut: hex\nprint 2\n", "hex", "Remove the unused hex", "print 2\n"),
                ("f(a) = {\n  b = a\n  a\n}\nprint f(1)\n", "b", "Remove the unused b", "f(a) = {\n  a\n}\nprint f(1)\n"),
                ("import std.curves\nprint 2\n", "std.curves", "Remove the unused std.curves", "print 2\n")]:
            c.change(uri, [(0, len(c.texts[uri]), before)])
            equal(acted(c, uri, mark, title), after)


@test
def actions_extract():
    with Workspace({"a.cag": ""}) as (_, c, uri):
        for before, mark, title, after in [
                ("show sphere(2 + 3) |> translate([1, 2, 3])\n", "2 + 3", "Extract to a definition", "value = 2 + 3\nshow sphere(value) |> translate([1, 2, 3])\n"),
                ("value = 1\nprint value, 2 * 3\n", "2 * 3", "Extract to a definition", "value = 1\nvalue2 = 2 * 3\nprint value, value2\n"),
                ("f(x) = {\n  y = x\n  y + x * 2\n}\n", "x * 2", "Extract to a definition", "f(x) = {\n  y = x\n  value = x * 2\n  y + value\n}\n"),
                ("import std.curves\nshow cone(height: 30, radius: 4)\n", "30", "Make it the param height", "import std.curves\nparam height = 30\nshow cone(height: height, radius: 4)\n"),
                ("size = 120\nprint size\n", "size", "Make size a param", "param size = 120\nprint size\n")]:
            c.change(uri, [(0, len(c.texts[uri]), before)])
            equal(acted(c, uri, mark, title), after)
        c.change(uri, [(0, len(c.texts[uri]), "f(x) = x + 1\nprint f(2)\n")])
        assert "Extract to a definition" not in actions(c, uri, "x + 1"), "it depends on a parameter"


@test
def actions_are_filtered_by_kind():
    with Workspace({"a.cag": "show spher(2 + 3)\n"}) as (_, c, uri):
        assert "Change to `sphere`" in actions(c, uri, "spher", only=["quickfix"])
        equal(list(actions(c, uri, "2 + 3", only=["refactor"])), ["Extract to a definition"])
        fix = actions(c, uri, "spher")["Change to `sphere`"]
        equal((fix["kind"], fix["isPreferred"], fix["diagnostics"][0]["code"]), ("quickfix", True, "E0201"))


# --- Lenses and commands ---


@test
def lenses_offer_what_can_be_done():
    with Workspace({"a.cag": "x = 2\nshow sphere(x)\nprint x  // expect: 2\n"}) as (_, c, uri):
        answer = c.ask("textDocument/codeLens", {"textDocument": {"uri": uri}})
        equal([(k["command"]["title"], k["command"]["command"], k["range"]["start"]["line"]) for k in answer],
              [("Preview", "cag.preview", 1), ("Render", "cag.render", 1), ("Run test", "cag.runTest", 2)])
        answer = c.ask("workspace/executeCommand", {"command": "cag.runTest", "arguments": [uri]})
        equal(answer["status"], 0)
        has(answer["output"], "1 passed, 0 failed, 0 skipped")


@test
def commands_report_their_failure():
    with Workspace({"a.cag": "print 1  // expect: 2\n"}) as (_, c, uri):
        answer = c.ask("workspace/executeCommand", {"command": "cag.runTest", "arguments": [uri]})
        equal(answer["status"], 1)
        has(c.wait_note("window/showMessage")["message"], "1 failed")
        for bad in [{"command": "cag.nothing", "arguments": [uri]}, {"command": "cag.render", "arguments": []}, {"command": "cag.render", "arguments": ["untitled:1"]}, {}]:
            try:
                c.ask("workspace/executeCommand", bad)
                raise AssertionError("it was accepted")
            except ServerError as error:
                equal(error.code, -32602)


@test
def a_picture_is_rendered_and_shown():
    with Workspace({"a.cag": "show sphere(2)\nshow camera(eye: [9, 9, 9], target: [0, 0, 0], size: [32, 24])\n"}) as (w, c, uri):
        answer = c.ask("workspace/executeCommand", {"command": "cag.render", "arguments": [uri]}, timeout=120)
        equal(answer["status"], 0)
        equal(answer["picture"], w.path("a.png"))
        equal(open(w.path("a.png"), "rb").read(4), b"\x89PNG")
        equal(c.wait_note("window/showDocument")["uri"], w.uri("a.png"))


# --- The protocol ---


@test
def positions_are_utf_16_or_utf_8():
    text = "θ = \"😀é\" + x\n"
    for encodings, column in [(["utf-16"], 12), (["utf-8", "utf-16"], 16), (None, 12)]:
        general = {"positionEncodings": encodings} if encodings else {}
        with Workspace({"a.cag": text}, capabilities={**FULL, "general": general}) as (_, c, uri):
            equal(c.capabilities["positionEncoding"], "utf-8" if column == 16 else "utf-16")
            start = c.wait_for(uri)[0]["range"]["start"]
            equal(start, {"line": 0, "character": column})
            c.replace(uri, "x", "θ2")
            equal(mistakes(c, uri), [("E0201", "θ2")])


@test
def a_canceled_request_is_answered_as_such():
    with Workspace({"a.cag": "x = 1\n" * 20000}) as (_, c, uri):
        first = c.begin("textDocument/documentSymbol", {"textDocument": {"uri": uri}})
        second = c.begin("textDocument/hover", c.at(uri, "x"))
        c.tell("$/cancelRequest", {"id": second})
        try:
            c.answer(first)
        except ServerError:
            raise AssertionError("the wrong one was canceled")
        try:
            c.answer(second)
        except ServerError as error:
            equal(error.code, -32800)


@test
def the_life_of_the_server():
    c = Client(PROGRAM, False)
    for method, code in [("textDocument/hover", -32002), ("shutdown", -32002)]:
        try:
            c.ask(method, {})
            raise AssertionError("it was answered")
        except ServerError as error:
            equal(error.code, code)
    c.ask("initialize", {"capabilities": {}, "processId": None, "rootUri": None})
    try:
        c.ask("no/such", {})
    except ServerError as error:
        equal(error.code, -32601)
    c.tell("$/setTrace", {"value": "off"})
    equal(c.ask("shutdown", None), None)
    try:
        c.ask("textDocument/hover", {})
        raise AssertionError("it was answered")
    except ServerError as error:
        equal(error.code, -32600)
    c.tell("exit", None)
    equal(c.process.wait(10), 0)
    c = Client(PROGRAM, False)
    c.tell("exit", None)
    equal(c.process.wait(10), 1)


@test
def a_text_in_no_file_is_a_document():
    with Workspace({"a.cag": "x = 1\n"}) as (_, c, uri):
        c.open("untitled:Untitled-1", "show spher(3)\n")
        equal(mistakes(c, "untitled:Untitled-1"), [("E0201", "spher")])
        c.open("zipfile:///a/b.zip::c.cag", "import std.curves\n")
        equal(mistakes(c, "zipfile:///a/b.zip::c.cag"), [("E0900", "std.curves")])


@test
def modules_are_found_on_the_module_path():
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "far.cag"), "w") as out:
            out.write("x = 1\n")
        for options in [{"options": {"modulePath": [folder]}}, {"arguments": ["-I", folder]}]:
            with Workspace({"a.cag": "import far\nprint far.x\n"}, **options) as (_, c, uri):
                equal(c.wait_for(uri), [])


def main():
    wanted = sys.argv[2:]
    passed = failed = 0
    for function in TESTS:
        if wanted and not any(word in function.__name__ for word in wanted):
            continue
        try:
            function()
            passed += 1
        except Exception:
            failed += 1
            print(f"FAILED {function.__name__}")
            print("  " + "\n  ".join(traceback.format_exc().strip().split("\n")[-6:]))
    print(f"{passed} passed, {failed} failed, 0 skipped")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
