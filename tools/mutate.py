#!/usr/bin/env python3
"""Measures how many random changes to the code the tests notice (a mutation score). Not part of the tests: 100 changes take an hour.

    N=100 SEED=1 python3 tools/mutate.py

SKIP=20 skips the first 20 changes of the seed, to continue an earlier run. FOLDERS="geom/curve" changes only files in these folders.
LONGEST=60 leaves out suites that take more than 60 s: the score is then a lower bound. JOBS=1 tries one change at a time (default: one
per processor).

Works on a copy of the tree in build-mutate/. First, every suite runs once in a build that counts which lines it reaches. The counts are
kept in build-mutate/reach/ until the suite or a tenth of the sources change. Each change then replaces one operator or constant on one
line of base, cli, geom, interp, lang, or live, by the table tools/mutations.txt. A change that does not compile (warnings are errors) or does not change the
object file is replaced with another one, and so are those in tools/equivalent_mutations.txt, after which the program computes the same,
for the reasons given there, and those that only allocate room for more elements than needed.

The changed file is compiled for AddressSanitizer and UndefinedBehaviorSanitizer and linked with the suites that reach the line. They run
until one fails, starting with those that are quick and likely to detect the change: unit tests that include the changed file's header, then
all others by their time. Each has a limit of memory, and one of processor time: 15 s plus 4 times the time it took while it was counted. A
suite detects a change only if it passes without the change; one of the whole program must also fail twice, since some of these depend on
how busy the machine is. Changes that no suite detects are printed and stored in build-mutate/survivors.txt. The suite cli/install, which
tests the files of a build, takes no part.
"""

import filecmp
import glob
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor

HERE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
WORK = os.path.join(HERE, "build-mutate")
REACH = os.path.join(WORK, "reach")
MEMORY = 4000  # MiB
SANITIZERS = ["-fsanitize=address,undefined", "-fno-sanitize-recover=undefined"]
WRAPPED = "malloc calloc realloc strdup strndup realpath asprintf vasprintf open_memstream".split()


def option(name, default):
    return type(default)(os.environ.get(name) or default)


N = option("N", 100)
SEED = option("SEED", 1)
SKIP = option("SKIP", 0)
FOLDERS = option("FOLDERS", "base cli geom interp lang live").split()
LONGEST = option("LONGEST", 1800)
JOBS = option("JOBS", os.cpu_count())


def output_of(command, **options):
    """The status of a command and all that it prints."""
    done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          errors="replace", **options)
    return done.returncode, done.stdout


def build(folder, *arguments):
    status, text = output_of(["make", "-s", f"-j{os.cpu_count()}", f"BUILD={folder}", *arguments])
    if status != 0:
        sys.exit(text[-2000:])


def run_limited(command, seconds, **options):
    """Runs a command within a limit of processor time, and six times that of any time. True if its status is 0."""
    command = ["prlimit", f"--cpu={int(seconds)}", "--core=0", *command]
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               start_new_session=True, **options)
    try:
        return process.wait(timeout=6 * seconds) == 0
    except subprocess.TimeoutExpired:
        return False
    finally:
        try:
            os.killpg(process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        process.wait()


# --- Suites ---

# Those with a program of their own, by its source. All others run build/cag.
PROGRAMS = {"vectors": "tests/vectors/run", "fuzz": "tests/fuzz/fuzz", "memory": "tests/fuzz/memory"}


def all_suites():
    suites = sorted(name[:-2] for name in glob.glob("tests/*/*_test.c"))
    # Each script of the language is a suite, but those of errors, which are many and quick, are one.
    suites += ["scripts/errors"]
    suites += ["scripts/" + name[15:-4] for name in sorted(glob.glob("tests/language/*/*.cag")) if "/errors/" not in name]
    suites += ["stdlib", "examples", "vectors", "fuzz", "memory", "repl", "editors", "scenes"]
    suites += [re.sub(r".*cases_(.*)\.sh", r"cli/\1", name) for name in sorted(glob.glob("tests/cli/cases_*.sh"))]
    suites.remove("cli/install")
    return suites


def path_of_scripts(suite):
    path = "tests/language/" + suite[8:]
    return path if os.path.isdir(path) else path + ".cag"


def program_of(suite):
    """The program of a suite, below the folder of a build."""
    return PROGRAMS.get(suite, suite if suite.startswith("tests/") else "cag")


def command_of(suite, folder):
    """The command that runs a suite with the programs in a folder, given by its full path."""
    program = os.path.join(folder, program_of(suite))
    if suite == "vectors":
        return [program, "tests/vectors", *sorted(glob.glob("tests/data/0*.json"))]
    if suite == "fuzz":
        return [program, "1"]
    if suite == "memory":
        return ["sh", "-c", f"{program} -n 1 && {program} -n 1 -x tests/fuzz/scripts/*.cag"]
    if suite in ("repl", "editors"):
        return ["sh", f"tests/{suite}/run.sh"]
    if suite.startswith("cli/"):
        return ["sh", "tests/cli/run.sh", suite[4:]]
    if suite.startswith("scripts/"):
        return [program, "test", "--no-pictures", path_of_scripts(suite)]
    if suite in ("stdlib", "examples"):
        return [program, "test", "--no-pictures", suite]
    if suite == "scenes":
        return [program, "test", "tests/scenes"]
    return [program]


def run_suite(suite, folder, seconds):
    folder = os.path.abspath(folder)
    # Leaks count where they do in the sanitized part of the test run.
    leaks = int(suite.startswith(("tests/", "scripts/")) or suite in ("vectors", "fuzz"))
    options = f"hard_rss_limit_mb={MEMORY}:detect_leaks={leaks}"
    return run_limited(command_of(suite, folder), seconds, env={**os.environ, "BUILD": folder, "ASAN_OPTIONS": options})


# --- Which lines a suite reaches ---


def sources_of(suite):
    """The files that are the suite, beside the program it tests."""
    if suite.startswith("tests/"):
        return [suite + ".c", *glob.glob("tests/*/*.h")]
    if suite.startswith("cli/"):
        return [f"tests/cli/cases_{suite[4:]}.sh"]
    if suite.startswith("scripts/") and path_of_scripts(suite).endswith(".cag"):
        return [path_of_scripts(suite)]
    folder = path_of_scripts(suite) if suite.startswith("scripts/") else suite if os.path.isdir(suite) else "tests/" + suite
    return [name for name in glob.glob(folder + "/**", recursive=True) if os.path.isfile(name)]


def measure_suite(suite):
    """Runs a suite in the build that counts, and writes its processor time to REACH/SUITE.time. Suites that have not changed are kept."""
    counts = os.path.join(REACH, suite)
    time = counts + ".time"
    if os.path.exists(time) and all(os.path.getmtime(name) < os.path.getmtime(time) for name in sources_of(suite)):
        return
    shutil.rmtree(counts, ignore_errors=True)
    os.makedirs(counts)
    objects = os.path.abspath("build-reach/obj")
    folder = os.path.abspath("build-reach")
    environment = {**os.environ, "BUILD": folder, "GCOV_PREFIX": counts, "GCOV_PREFIX_STRIP": str(objects.count("/"))}
    # A test of time limits may fail here; what it reached counts nevertheless.
    command = ["bash", "-c", "TIMEFORMAT='%0U %0S'; time timeout -k 5 1800 \"$@\" > /dev/null 2>&1 < /dev/null", "bash"]
    _, text = output_of(command + command_of(suite, folder), env=environment)
    with open(time, "w") as file:
        file.write(str(1 + sum(int(part) for part in text.split()[-2:])))


def notes_of(source):
    """The compiler's notes on a source: those that the counts belong to, and those of the build that counts."""
    return f"{REACH}/notes/{source[:-2]}.gcno", f"build-reach/obj/{source[:-2]}.gcno"


def measure_suites():
    """Counts again where a suite has changed, and all suites if a source is new or a tenth of the sources have changed."""
    os.makedirs("build-reach", exist_ok=True)
    status, text = output_of(["cc", "-std=c17", "-fPIC", "-c", "tests/coverage/exit.c", "-o", "build-reach/exit.o"])
    if status != 0:
        sys.exit(text)
    build("build-reach", "OPT=-O0", "SANITIZE=--coverage -DCAG_ONE_COPY", "LDFLAGS=-Wl,--wrap=_exit build-reach/exit.o",
          "test-programs")
    notes = [notes_of(source) for top in ("base", "geom", "interp", "lang") for source in glob.glob(f"{top}/**/*.c", recursive=True)]
    notes = [(kept, made) for kept, made in notes if os.path.exists(made)]
    is_new = any(not os.path.exists(kept) for kept, _ in notes)
    if is_new or 10 * sum(not filecmp.cmp(kept, made, shallow=False) for kept, made in notes) > len(notes):
        shutil.rmtree(REACH, ignore_errors=True)
        for kept, made in notes:
            os.makedirs(os.path.dirname(kept), exist_ok=True)
            shutil.copy(made, kept)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(measure_suite, all_suites()))


def seconds_of(suite):
    with open(os.path.join(REACH, suite + ".time")) as file:
        return int(file.read())


class Reach:
    """Which lines of a file each suite runs."""

    def __init__(self):
        self.lock = threading.Lock()
        self.lines = {}

    def of(self, suite, source):
        """The lines with code and those of them that the suite runs, or None where it runs nothing of the file."""
        with self.lock:
            if (suite, source) not in self.lines:
                self.lines[suite, source] = self.read(suite, source)
            return self.lines[suite, source]

    def read(self, suite, source):
        counts = f"{REACH}/{suite}/{source[:-2]}.gcda"
        if not os.path.exists(counts):
            return None
        notes, made = notes_of(source)
        # Counts belong to the notes of one build. Of a source that has changed since, every line counts as reached.
        if not filecmp.cmp(notes, made, shallow=False):
            return set(), set()
        # gcov looks for the notes beside the counts, and reads the source.
        shutil.copy(counts, f"{WORK}/line.gcda")
        shutil.copy(notes, f"{WORK}/line.gcno")
        code, run, here = set(), set(), False
        for row in output_of(["gcov", "--stdout", f"{WORK}/line.gcda"])[1].splitlines():
            parts = row.split(":", 2)
            if len(parts) < 3:
                continue
            count, line = parts[0].strip(), parts[1].strip()
            if line == "0" and parts[2].startswith("Source:"):
                here = parts[2] == "Source:" + source
            elif here and count != "-":
                code.add(int(line))
                if not count.startswith("#"):
                    run.add(int(line))
        return code, run

    def reaches(self, suite, source, line):
        """A line without code of its own, in a table or in a statement of several lines, counts as reached."""
        lines = self.of(suite, source)
        return lines is not None and (line not in lines[0] or line in lines[1])


# --- Changes ---


def allocates_more(row, old, new):
    """Whether a larger number after this part of a line is one more element, or byte, of an allocation."""
    call = max(row.rfind("alloc("), row.rfind("_array("))
    is_inside = call >= 0 and row.count("(", call) > row.count(")", call)
    return is_inside and old in (" 1)", " 2)") and new > old and row[-1] in "+:,"


class Change:
    def __init__(self, source, line, column, old, new):
        self.source, self.line, self.old, self.new = source, line, old, new
        with open(source) as file:
            lines = file.read().split("\n")
        self.before = lines[line - 1]
        self.after = self.before[:column] + new + self.before[column + len(old):]
        lines[line - 1] = self.after
        self.text = "\n".join(lines)

        self.allocates_more = allocates_more(self.before[:column], old, new)

    def __str__(self):
        return f"{self.source}:{self.line}: `{self.old}` -> `{self.new}`: {self.before.strip()}"


def list_places():
    """Every change that the table allows: source, line, column from 0, old, new."""
    with open("tools/mutations.txt") as file:
        table = [row.rstrip("\n").split("\t") for row in file]
    places = []
    for folder in FOLDERS:
        for source in glob.glob(f"{folder}/**/*.c", recursive=True):
            with open(source) as file:
                for number, row in enumerate(file.read().split("\n"), 1):
                    if re.match(r" *(//|#)|static_assert", row) or '"' in row:
                        continue
                    code = re.sub(r" *//.*", "", row)
                    for old, new in table:
                        column = code.find(old)
                        while column >= 0:
                            places.append((source, number, column, old, new))
                            column = code.find(old, column + len(old))
    return sorted(places)


class Programs:
    """Compiles changed files and links them with the suites. The unchanged objects are those of build/.

    Most programs take the code from a shared library in the folder they are in, so that one link serves all suites. Those that test
    failing allocations or the sources of the command line contain it.
    """

    def __init__(self):
        settings = output_of(["make", "-s", "-p", "-n", "-q"])[1]
        variable = lambda name: re.search(rf"^{name} :?= (.*)$", settings, re.M).group(1).split()
        self.compile_flags = ("-std=c17 -D_GNU_SOURCE -O1 -g0 -Wall -Wextra -Werror -Wno-psabi -fno-math-errno -fno-trapping-math "
                              "-ffp-contract=off -fPIC -fno-semantic-interposition -I. -Iinclude -Ibuild/gen").split()
        self.compile_flags += ['-DCAG_VERSION="{}"'.format(*variable("VERSION")), *variable("PKG_CFLAGS")]
        self.libraries = [*variable("PKG_LIBS"), "-lm", "-lpthread", "-lcmocka"] + SANITIZERS
        if shutil.which("mold"):
            self.libraries.append("-fuse-ld=mold")
        self.tool = sorted(set(glob.glob("cli/*.c")) - {"cli/main.c"})
        objects = glob.glob("build/obj/**/*.o", recursive=True)
        self.objects = sorted(name for name in objects if not name.startswith("build/obj/cli/"))
        self.lock = threading.Lock()

    def compile(self, source, target, flags=()):
        return output_of(["cc", *self.compile_flags, *flags, "-c", source, "-o", target])

    def compile_test(self, name):
        target = f"build/checked/{name}.o"
        os.makedirs(os.path.dirname(target), exist_ok=True)
        status, text = self.compile(name + ".c", target, SANITIZERS)
        if status != 0:
            sys.exit(text)

    def run_linker(self, *arguments):
        # The C++ compiler, because some libraries of OpenEXR are in that language.
        status, text = output_of(["c++", *arguments, *self.libraries])
        if status != 0:
            sys.exit(text)

    def link_library(self, folder, source=None, changed=None):
        """Links the library of a folder, with the object of a changed source if there is one."""
        target = f"{folder}/libcag.so"
        if not os.path.exists(target):
            objects = [changed if source and name == f"build/obj/{source[:-2]}.o" else name for name in self.objects]
            self.run_linker("-shared", "-Wl,-Bsymbolic", *objects, "-o", target)

    def link_shared(self, program):
        """Links a program with the library of the folder that it will be in. Returns the path."""
        target = f"{WORK}/programs/{program}"
        with self.lock:
            if not os.path.exists(target):
                os.makedirs(os.path.dirname(target), exist_ok=True)
                self.link_library(f"{WORK}/programs")
                if program == "cag":
                    objects = [f"build/obj/{name[:-2]}.o" for name in self.tool + ["cli/main.c"]]
                else:
                    objects = [f"build/checked/{program}.o"]
                up = "/.." * program.count("/")
                self.run_linker(*objects, "-o", target, f"-L{WORK}/programs", "-lcag", f"-Wl,-rpath,$ORIGIN{up}")
        return target

    def link_static(self, program, target, source, changed):
        objects, extra = [changed] if changed else [], []
        if program != "cag":
            objects.append(f"build/checked/{program}.o")
        if program == "cag" or program.startswith("tests/interp/tool_"):
            tool = self.tool + ["cli/main.c"] * (program == "cag")
            objects += [f"build/obj/{name[:-2]}.o" for name in tool if name != source]
        if program == "tests/fuzz/memory" or program.startswith("tests/interp/tool_"):
            extra = [f"-Wl,--wrap={name}" for name in WRAPPED]
        if program.startswith("tests/geom/memory_"):
            extra = [f"-Wl,--wrap={name}" for name in ("malloc", "calloc", "realloc", "free")]
        self.run_linker(*objects, "build/libcag.a", "-o", target, *extra)

    def link(self, suite, folder, source=None, changed=None):
        """Makes the program of a suite in a folder, with the object of a changed source if there is one."""
        program = program_of(suite)
        target = f"{folder}/{program}"
        if os.path.exists(target):
            return
        os.makedirs(os.path.dirname(target), exist_ok=True)
        if source in self.tool + ["cli/main.c"] or re.match("tests/(interp/tool_|geom/memory_|fuzz/memory)", program):
            self.link_static(program, target, source, changed)
        else:
            self.link_library(folder, source, changed)
            os.link(self.link_shared(program), target)
        for name in ("gen", "tools", "npm"):
            if os.path.exists(f"build/{name}") and not os.path.lexists(f"{folder}/{name}"):
                os.symlink(os.path.abspath(f"build/{name}"), f"{folder}/{name}")


class Trials:
    def __init__(self, programs, reach):
        self.programs, self.reach = programs, reach
        self.lock = threading.Lock()
        self.passing = {}  # whether a suite passes without a change
        self.unchanged = f"{WORK}/unchanged"  # their programs
        with open("tools/equivalent_mutations.txt") as file:
            self.equivalent = {row.rstrip("\n") for row in file}
        self.headers = {}

    def valid(self, change):
        """Whether the change compiles, changes the object, and is not known to be without effect."""
        if change.allocates_more or f"{change.source}\t{change.after.strip(' ')}" in self.equivalent:
            return False
        # Both from the same name, which the object may contain.
        objects = []
        with open(change.source) as file:
            texts = (change.text, file.read())
        for text in texts:
            with open(f"{WORK}/changed.c", "w") as file:
                file.write(text)
            if self.programs.compile(f"{WORK}/changed.c", f"{WORK}/changed.o")[0] != 0:
                return False
            with open(f"{WORK}/changed.o", "rb") as file:
                objects.append(file.read())
        return objects[0] != objects[1]

    def suites_for(self, change):
        header = f'"{change.source[:-2]}.h"'
        near = {name for name in glob.glob("tests/*/*_test.c") if header in open(name).read()}
        return sorted(all_suites(), key=lambda suite: (suite + ".c" not in near, seconds_of(suite)))

    def run(self, suite, folder):
        return run_suite(suite, folder, 15 + 4 * seconds_of(suite))

    def passes_unchanged(self, suite):
        with self.lock:
            if suite not in self.passing:
                self.programs.link(suite, self.unchanged)
                self.passing[suite] = self.run(suite, self.unchanged)
                if not self.passing[suite]:
                    print(f"{suite} fails without a change and takes no part", flush=True)
            return self.passing[suite]

    def who_notices(self, change, folder):
        """The suite that fails with the change, or None."""
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        with open(f"{folder}/changed.c", "w") as file:
            file.write(change.text)
        status, text = self.programs.compile(f"{folder}/changed.c", f"{folder}/changed.o", SANITIZERS)
        if status != 0:
            return "the compiler"
        for suite in self.suites_for(change):
            if seconds_of(suite) > LONGEST or not self.reach.reaches(suite, change.source, change.line):
                continue
            self.programs.link(suite, folder, change.source, f"{folder}/changed.o")
            tries = 2 if program_of(suite) == "cag" else 1
            if not any(self.run(suite, folder) for _ in range(tries)) and self.passes_unchanged(suite):
                return suite
        return None


def copy_tree():
    """A copy of the files in the repository, with builds of an earlier copy."""
    tree = os.path.join(WORK, "tree")
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=HERE, stdout=subprocess.PIPE, text=True, check=True).stdout
    names = set(filter(None, listed.split("\0")))
    os.makedirs(tree, exist_ok=True)
    os.chdir(tree)
    for folder, folders, files in os.walk("."):
        folders[:] = [name for name in folders if not name.startswith("build")]
        for name in (os.path.normpath(os.path.join(folder, file)) for file in files):
            if name not in names:
                os.remove(name)
    for name in names:
        source = os.path.join(HERE, name)
        # Files that have not changed keep their times, so that they are not built again.
        if os.path.islink(source) or not os.path.exists(name) or not filecmp.cmp(source, name, shallow=False):
            os.makedirs(os.path.dirname(name) or ".", exist_ok=True)
            if os.path.islink(name):
                os.remove(name)
            shutil.copy(source, name, follow_symlinks=False)


def main():
    copy_tree()
    build("build", "OPT=-O1", "CFLAGS=-g0 -fvisibility=default", "all", "build/tools/tables")
    measure_suites()
    for name in ("programs", "unchanged"):
        shutil.rmtree(f"{WORK}/{name}", ignore_errors=True)
        os.makedirs(f"{WORK}/{name}")
    programs, reach = Programs(), Reach()
    with ThreadPoolExecutor(JOBS) as pool:
        list(pool.map(programs.compile_test, [program_of(s) for s in all_suites() if program_of(s) != "cag"]))
    trials = Trials(programs, reach)
    places = list_places()
    random.Random(SEED).shuffle(places)
    free = [f"{WORK}/job{k}" for k in range(JOBS)]
    results = []

    def try_change(change):
        folder = free.pop()
        suite = trials.who_notices(change, folder)
        free.append(folder)
        results.append(suite)
        print(f"{suite or 'not noticed'}: {change}", flush=True)
        if suite is None:
            with open(f"{WORK}/survivors.txt", "a") as file:
                file.write(f"{change}\n")

    if SKIP == 0:
        open(f"{WORK}/survivors.txt", "w").close()
    tried, slots, trials_under_way = 0, threading.Semaphore(JOBS), []
    with ThreadPoolExecutor(JOBS) as pool:
        for place in places:
            if tried == SKIP + N:
                break
            change = Change(*place)
            if not trials.valid(change):
                continue
            tried += 1
            if tried <= SKIP:
                continue
            slots.acquire()
            trials_under_way.append(pool.submit(try_change, change))
            trials_under_way[-1].add_done_callback(lambda done: slots.release())
    for trial in trials_under_way:
        trial.result()
    noticed = sum(suite is not None for suite in results)
    print(f"{noticed} of {len(results)} changes noticed ({100 * noticed / max(1, len(results)):.0f} %)")


if __name__ == "__main__":
    main()
