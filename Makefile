# The only build. `make` leaves the program at build/cag; BUILD= chooses another folder.
#
#   make             program and libraries          make test            all suites, closing with `N passed, N failed, N skipped`
#   make test-sanitize  under ASan and UBSan        make bench           benchmarks, with comparisons
#   make test-threads   code with threads, under the thread sanitizer
#   make silhouettes    compares the outlines that the preview and POV-Ray draw
#   make coverage    lines and branches by folder   make mutate N=100    mutation score: random changes that the tests detect
#   make format      clang-format everything        make check-format / check-layers / analyze / tidy
#   make web         bundles the page of `cag view` make check-web       shows that web/dist is what the sources give
#   make playground  cag as WebAssembly with its page and documentation, as static files in build/playground (wasm/build.mk)
#   make EMBREE=1    with Embree for rays at large meshes; `make test-embree` runs the tests of rays with it for all meshes
#   make install PREFIX=/usr/local DESTDIR=      make deb             Debian packages
#   make vsix        the extension of Visual Studio Code
#   make brep        cag-brep, the helper for boundaries of solids; part of `make` if Open CASCADE is installed
#                    (libocct-modeling-algorithms-dev, libocct-data-exchange-dev)

BUILD   ?= build
PREFIX  ?= /usr/local
DESTDIR ?=
# Where libraries go below PREFIX.
LIBDIR  ?= lib
VERSION := 0.1.0
SONAME  := libcag.so.0
CC      ?= cc
OPT     ?= -O3
# Of the tests themselves, whose time is spent in the library.
TEST_OPT ?= -O1
# Wide vectors never cross a file boundary, so their ABI does not matter.
WARN    := -Wall -Wextra -Werror -Wno-psabi
SANITIZE ?=
# V=1 shows the commands.
V ?=
Q := $(if $(V),,@)

# For each library: its pkg-config name, and the Debian package to install if it is missing.
NEEDS := OpenEXR:libopenexr-dev lapacke:liblapacke-dev libedit:libedit-dev libcjson:libcjson-dev \
         libpng:libpng-dev libutf8proc:libutf8proc-dev glu:libglu1-mesa-dev zlib:zlib1g-dev \
         libcmark-gfm:libcmark-gfm-dev libxml-2.0:libxml2-dev libmicrohttpd:libmicrohttpd-dev \
         harfbuzz:libharfbuzz-dev fribidi:libfribidi-dev fontconfig:libfontconfig-dev
MODULES := $(foreach n,$(NEEDS),$(firstword $(subst :, ,$(n))))
ifeq ($(filter clean format check-format check-layers,$(MAKECMDGOALS)),)
MISSING := $(foreach n,$(NEEDS),$(shell pkg-config --exists $(firstword $(subst :, ,$(n))) || echo $(lastword $(subst :, ,$(n)))))
# Embree has no pkg-config file.
EMBREE ?=
EMBREE_H := $(wildcard /usr/include/embree3/rtcore.h)
MISSING += $(if $(EMBREE),$(if $(EMBREE_H),,libembree-dev))
ifneq ($(strip $(MISSING)),)
$(error cag needs packages that are not here: apt-get install $(strip $(MISSING)))
endif
endif
PKG_CFLAGS := $(shell pkg-config --cflags $(MODULES) 2>/dev/null)
# The tables of Markdown come in a library that has no pkg-config file (libcmark-gfm-extensions-dev).
# The program loads these when it first needs them: servers, and fonts.
LOADED     := libmicrohttpd harfbuzz fribidi fontconfig
PKG_LIBS   := -lcmark-gfm-extensions $(shell pkg-config --libs $(filter-out $(LOADED),$(MODULES)) 2>/dev/null)
ifneq ($(EMBREE),)
PKG_CFLAGS += -DCAG_EMBREE
PKG_LIBS   += -lembree3
endif

CFLAGS_ALL := -std=c17 -D_GNU_SOURCE $(OPT) -g $(WARN) -fno-math-errno -fno-trapping-math -ffp-contract=off \
              -fPIC -fvisibility=hidden -MMD -MP -I. -Iinclude -I$(BUILD)/gen \
              -DCAG_VERSION='"$(VERSION)"' $(PKG_CFLAGS) $(SANITIZE) $(CFLAGS)
LDLIBS_ALL := $(PKG_LIBS) -lm -lpthread $(SANITIZE) $(LDFLAGS)
# There are hundreds of test programs: LLVM's linker takes a quarter of the time.
CFLAGS_TEST := $(CFLAGS_ALL) $(TEST_OPT) $(if $(shell command -v ld.lld),-fuse-ld=lld)

# The helper program links Open CASCADE, without the parts that draw. The modules, which it loads when they are needed, link the rest.
OCCT_H     := $(wildcard /usr/include/opencascade/BRepAlgoAPI_Fuse.hxx)
OCCT_LIBS  := $(patsubst %,-l%,TKSTEP TKSTEP209 TKSTEPAttr TKSTEPBase TKIGES TKXSBase TKOffset TKFillet TKBool TKBO TKPrim TKShHealing \
              TKTopAlgo TKBRep TKGeomAlgo TKGeomBase TKG3d TKG2d TKMath TKernel)
BREP_OPT   ?= -O2
BREP_MODULES := cag-brep-exchange cag-brep-operations
BREP_EXCHANGE := brep/exchange.cpp brep/exchange_module.cpp
BREP_OPERATIONS := brep/blends.cpp brep/offsets.cpp brep/operations.cpp brep/operations_module.cpp
BREP_SRC   := $(filter-out $(BREP_EXCHANGE) $(BREP_OPERATIONS),$(sort $(wildcard brep/*.cpp)))

BASE_SRC   := $(shell find base -name '*.c' | sort)
LANG_SRC   := $(shell find lang -name '*.c' | sort)
GEOM_SRC   := $(shell find geom -name '*.c' | sort)
INTERP_SRC := $(shell find interp -name '*.c' | sort)
MAIN_SRC   := cli/main.c
CLI_SRC    := $(filter-out $(MAIN_SRC),$(shell find cli live -name '*.c' | sort))
# The documentation lists the families of built-in functions in this order.
PARAMETERS := interp/vm/parameter_kinds.def interp/vm/parameter_types.def
ROWS       := $(patsubst %,interp/builtin/%.rows,constants numbers angles vectors lists texts records control \
              random calculus matrices files formula transforms curves regions letters bsplines functions frenet hulls \
              conics splines fits surfaces tensors sections meetings triangles solids exacts checks mesh_files figures assemblies \
              quality robots robot_files inverse scene cameras rays sensors images image_measures image_filters image_templates)
STDLIB     := $(shell find stdlib -name '*.cag' | sort)
DOCUMENTS  := $(filter-out docs/architecture.md docs/contributing.md,$(sort $(wildcard docs/*.md docs/cookbook/*.cag docs/site/*)))

obj = $(patsubst %.c,$(BUILD)/obj/%.o,$(1))
BASE_OBJ := $(call obj,$(BASE_SRC))
LANG_OBJ := $(call obj,$(LANG_SRC))
GEOM_OBJ := $(call obj,$(GEOM_SRC)) $(BUILD)/obj/gen/fonts.o
INTERP_OBJ := $(call obj,$(INTERP_SRC)) $(patsubst %,$(BUILD)/obj/gen/%.o,stdlib documents builtins)
CLI_OBJ  := $(call obj,$(CLI_SRC) $(MAIN_SRC)) $(BUILD)/obj/gen/page_files.o
# The compiled-in fonts, as `make fonts` leaves them.
FONTS    := $(patsubst %,fonts/Sans-%.ttf,Regular Bold Italic BoldItalic)
# The page of `cag view`, as `make web` leaves it.
PAGE     := $(sort $(wildcard web/dist/*.gz))

.PHONY: all clean unit unit-base unit-lang unit-geom unit-interp test test-programs test-programs-clang test-sanitize test-programs-threads test-threads test-embree coverage mutate bench silhouettes format check-format check-layers analyze tidy install deb editors brep web check-web fonts playground screenshots vsix
.SECONDARY:
# The program with Clang is for tests of the C code, which need no helper.
HAS_BREP := $(if $(OCCT_H),$(if $(filter clang,$(CC)),,yes))
all: $(BUILD)/cag $(BUILD)/libcag.a $(BUILD)/libcag.so $(if $(HAS_BREP),brep)

$(BUILD)/obj/%.o: %.c
	@mkdir -p $(@D)
	@echo "cc $<"
	$Q$(CC) $(CFLAGS_ALL) -c $< -o $@

$(BUILD)/liblang.a: $(BASE_OBJ) $(LANG_OBJ)
	@rm -f $@; ar rcs $@ $^
$(BUILD)/libgeom.a: $(BASE_OBJ) $(GEOM_OBJ)
	@rm -f $@; ar rcs $@ $^
$(BUILD)/libcag.a: $(BASE_OBJ) $(LANG_OBJ) $(GEOM_OBJ) $(INTERP_OBJ)
	@rm -f $@; ar rcs $@ $^
$(BUILD)/libcag.so: $(BASE_OBJ) $(LANG_OBJ) $(GEOM_OBJ) $(INTERP_OBJ)
	$Q$(CC) -shared -Wl,-soname,$(SONAME) $^ -o $@ $(LDLIBS_ALL)
	@ln -sf libcag.so $(BUILD)/$(SONAME)

# The standard library, as C arrays.
$(BUILD)/gen/stdlib.c: $(STDLIB) tools/embed.sh
	@mkdir -p $(@D)
	sh tools/embed.sh $(STDLIB) > $@.tmp && mv $@.tmp $@
# The documents for `cag doc` and the documentation site.
$(BUILD)/gen/fonts.c: $(FONTS) tools/embed.sh
	@mkdir -p $(@D)
	sh tools/embed.sh --fonts $(FONTS) > $@.tmp && mv $@.tmp $@
$(BUILD)/gen/documents.c: $(DOCUMENTS) tools/embed.sh
	@mkdir -p $(@D)
	sh tools/embed.sh --documents $(DOCUMENTS) > $@.tmp && mv $@.tmp $@
$(BUILD)/gen/page_files.c: $(PAGE) tools/embed_page.sh
	@mkdir -p $(@D)
	sh tools/embed_page.sh $(PAGE) > $@.tmp && mv $@.tmp $@
# The built-in functions. The prototypes do not depend on summaries and examples.
$(BUILD)/gen/builtins.c: $(PARAMETERS) $(ROWS) tools/rows.awk
	@mkdir -p $(@D)
	@echo "awk $@"
	$QLC_ALL=C awk -f tools/rows.awk $(PARAMETERS) $(ROWS) > $@.tmp && mv $@.tmp $@
$(BUILD)/gen/builtin_functions.h: $(PARAMETERS) $(ROWS) tools/rows.awk
	@mkdir -p $(@D)
	@echo "awk $@"
	$QLC_ALL=C awk -v header=1 -f tools/rows.awk $(PARAMETERS) $(ROWS) > $@.tmp
	@if cmp -s $@.tmp $@; then rm $@.tmp; else mv $@.tmp $@; fi
$(INTERP_OBJ): | $(BUILD)/gen/builtin_functions.h
$(BUILD)/obj/gen/%.o: $(BUILD)/gen/%.c
	@mkdir -p $(@D)
	@echo "cc $<"
	$Q$(CC) $(CFLAGS_ALL) -c $< -o $@

$(BUILD)/cag: $(CLI_OBJ) $(BUILD)/libcag.a
	$Q$(CC) $^ -o $@ $(LDLIBS_ALL)

brep: $(BUILD)/cag-brep $(patsubst %,$(BUILD)/%.so,$(BREP_MODULES))
$(BUILD)/obj/brep/%.o: brep/%.cpp
	@mkdir -p $(@D)
	@echo "c++ $<"
	$Q$(CXX) -std=c++17 $(BREP_OPT) -g -Wall -Wextra -Werror -MMD -MP -I. -isystem $(dir $(OCCT_H)) -DCAG_VERSION='"$(VERSION)"' $(SANITIZE) \
	  $(CXXFLAGS) -fPIC -c $< -o $@
# The modules use functions of the program.
$(BUILD)/cag-brep: $(patsubst %.cpp,$(BUILD)/obj/%.o,$(BREP_SRC)) | $(patsubst %,$(BUILD)/%.so,$(BREP_MODULES))
	$Q$(CXX) $^ -o $@ -rdynamic -Wl,--as-needed $(OCCT_LIBS) $(SANITIZE) $(LDFLAGS)
$(BUILD)/cag-brep-exchange.so: $(patsubst %.cpp,$(BUILD)/obj/%.o,$(BREP_EXCHANGE))
$(BUILD)/cag-brep-operations.so: $(patsubst %.cpp,$(BUILD)/obj/%.o,$(BREP_OPERATIONS))
$(patsubst %,$(BUILD)/%.so,$(BREP_MODULES)):
	$Q$(CXX) -shared $^ -o $@ -Wl,--as-needed $(OCCT_LIBS) $(SANITIZE) $(LDFLAGS)

# A test of a part of the program, which tests/brep/protocol.py runs.
$(BUILD)/tests/brep/%: tests/brep/%.cpp $(patsubst %.cpp,$(BUILD)/obj/%.o,$(filter-out brep/main.cpp,$(BREP_SRC)))
	@mkdir -p $(@D)
	@echo "c++ $<"
	$Q$(CXX) -std=c++17 $(BREP_OPT) -g -Wall -Wextra -Werror -I. -isystem $(dir $(OCCT_H)) $^ -o $@ -Wl,--as-needed $(OCCT_LIBS) $(SANITIZE) $(LDFLAGS)

# Writes the program's tables, as input for tools/*.sh.
$(BUILD)/tools/tables: tools/tables.c $(filter-out %/cli/main.o,$(CLI_OBJ)) $(BUILD)/libcag.a
	@mkdir -p $(@D)
	$Q$(CC) $(CFLAGS_ALL) $(filter %.c %.o %.a,$^) -o $@ $(LDLIBS_ALL)

# Converts Markdown to man pages, for tools/man.sh.
$(BUILD)/tools/markdown_man: tools/markdown_man.c
	@mkdir -p $(@D)
	$Q$(CC) $(CFLAGS_ALL) $< -o $@ $(LDLIBS_ALL)

# Allocation functions that tests wrap to make them fail (tests/fuzz/failing.h).
WRAPPED := malloc calloc realloc strdup strndup realpath asprintf vasprintf open_memstream
WRAP := $(foreach f,$(WRAPPED),-Wl,--wrap=$(f))

# C unit tests (cmocka): one program per file of tests/base, tests/lang, tests/geom, tests/interp.
UNIT = $(patsubst %.c,$(BUILD)/%,$(wildcard tests/$(1)/*_test.c))
$(BUILD)/tests/base/%: tests/base/%.c $(BUILD)/liblang.a
	@mkdir -p $(@D)
	@echo "cc $<"
	$Q$(CC) $(CFLAGS_TEST) $< $(BUILD)/liblang.a -o $@ -lcmocka $(LDLIBS_ALL)
$(BUILD)/tests/lang/%: tests/lang/%.c $(BUILD)/liblang.a
	@mkdir -p $(@D)
	@echo "cc $<"
	$Q$(CC) $(CFLAGS_TEST) $< $(BUILD)/liblang.a -o $@ -lcmocka $(LDLIBS_ALL)
# Tests of failing allocations replace these functions with their own (tests/geom/faults.h).
$(BUILD)/tests/geom/memory_%: LDLIBS_ALL += -Wl,--wrap=malloc,--wrap=calloc,--wrap=realloc,--wrap=free
$(BUILD)/tests/geom/%: tests/geom/%.c $(BUILD)/libgeom.a
	@mkdir -p $(@D)
	@echo "cc $<"
	$Q$(CC) $(CFLAGS_TEST) $< $(BUILD)/libgeom.a -o $@ -lcmocka $(LDLIBS_ALL)
# Tests of the parts of the program that the library lacks. Allocations can fail in them.
$(BUILD)/tests/interp/tool_%: tests/interp/tool_%.c $(filter-out %/cli/main.o,$(CLI_OBJ)) $(BUILD)/libcag.a
	@mkdir -p $(@D)
	@echo "cc $<"
	$Q$(CC) $(CFLAGS_TEST) $(filter %.c %.o %.a,$^) -o $@ -lcmocka $(WRAP) $(LDLIBS_ALL)
$(BUILD)/tests/interp/%: tests/interp/%.c $(BUILD)/libcag.a
	@mkdir -p $(@D)
	@echo "cc $<"
	$Q$(CC) $(CFLAGS_TEST) $< $(BUILD)/libcag.a -o $@ -lcmocka $(LDLIBS_ALL)
unit-base: $(call UNIT,base)
	@for t in $^; do case $$t in /*) $$t;; *) ./$$t;; esac || exit 1; done
unit-lang: $(call UNIT,lang)
	@for t in $^; do case $$t in /*) $$t;; *) ./$$t;; esac || exit 1; done
unit-geom: $(call UNIT,geom)
	@for t in $^; do case $$t in /*) $$t;; *) ./$$t;; esac || exit 1; done
unit-interp: $(call UNIT,interp)
	@for t in $^; do case $$t in /*) $$t;; *) ./$$t;; esac || exit 1; done

$(BUILD)/tests/vectors/run: tests/vectors/run.c $(BUILD)/libcag.a
	@mkdir -p $(@D)
	@echo "cc $<"
	$Q$(CC) $(CFLAGS_TEST) $< $(BUILD)/libcag.a -o $@ $(LDLIBS_ALL)

$(BUILD)/tests/fuzz/fuzz: tests/fuzz/fuzz.c $(BUILD)/libcag.a
	@mkdir -p $(@D)
	@echo "cc $<"
	$Q$(CC) $(CFLAGS_TEST) $< $(BUILD)/libcag.a -o $@ $(LDLIBS_ALL)

$(BUILD)/tests/fuzz/memory: tests/fuzz/memory.c $(BUILD)/libcag.a
	@mkdir -p $(@D)
	@echo "cc $<"
	$Q$(CC) $(CFLAGS_TEST) $< $(BUILD)/libcag.a -o $@ $(WRAP) $(LDLIBS_ALL)

test-programs: all $(BUILD)/tools/tables $(BUILD)/tools/markdown_man $(call UNIT,base) $(call UNIT,lang) $(call UNIT,geom) $(call UNIT,interp) $(BUILD)/tests/vectors/run $(BUILD)/tests/fuzz/fuzz $(BUILD)/tests/fuzz/memory $(if $(HAS_BREP),$(BUILD)/tests/brep/poles_test)
test: test-programs
	BUILD=$(BUILD) sh tests/run_all.sh

# Builds and runs all suites under AddressSanitizer and UndefinedBehaviorSanitizer. The Clang programs have a directory of their own and
# serve the shorter run of tools/test.sh.
SANITIZED := OPT="-O1 -DCAG_CHECKED" TEST_OPT=-O0 SANITIZE="-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer"
test-sanitize:
	$(MAKE) BUILD=$(BUILD)-sanitize $(SANITIZED) test
test-programs-clang:
	$(MAKE) BUILD=$(BUILD)-clang CC=clang $(SANITIZED) test-programs

# Runs what has threads under the thread sanitizer: work that is left behind, interruptions, the pages of a site, scripts that are tested side
# by side, and the server of the page. One copy of each function: the choice between copies is made before the sanitizer has begun.
VOLATILE := $(BUILD)-threads/volatile.o
THREADED := OPT="-O0 -DCAG_ONE_COPY --param tsan-distinguish-volatile=1" SANITIZE="-fsanitize=thread"
THREAD_TESTS := base/aside_test interp/interrupt_test interp/site_test
THREAD_SCRIPTS := tests/language/values tests/language/modules tests/language/words
THREAD_PAGES := $(addprefix test_,a_newer_run_cancels_an_older_one a_save_by_another_editor_runs_the_script exports_and_pictures language_server)
test-programs-threads:
	@mkdir -p $(BUILD)-threads
	gcc -std=c17 $(WARN) -fPIC -c tests/threads/volatile.c -o $(VOLATILE)
	$(MAKE) BUILD=$(BUILD)-threads CC=gcc $(THREADED) LDFLAGS=$(VOLATILE) \
	  $(patsubst %,$(BUILD)-threads/%,cag $(addprefix tests/,$(THREAD_TESTS)))
test-threads: test-programs-threads
	@for t in $(THREAD_TESTS); do $(abspath $(BUILD)-threads)/tests/$$t || exit 1; done
	$(BUILD)-threads/cag test --jobs 4 $(THREAD_SCRIPTS)
	TSAN_OPTIONS=exitcode=66 python3 tests/live/view.py $(BUILD)-threads/cag $(THREAD_PAGES)

# Runs the tests of rays with Embree for all meshes, however small. Needs libembree-dev.
EMBREE_TESTS := ray ray_mesh caster_nearest nearest nearest_planar nearest_swept
test-embree:
	$(MAKE) BUILD=$(BUILD)-embree EMBREE=1 CFLAGS=-DCAG_EMBREE_TRIANGLES=1 $(patsubst %,$(BUILD)-embree/tests/geom/%_test,$(EMBREE_TESTS))
	@for t in $(EMBREE_TESTS); do $(abspath $(BUILD)-embree)/tests/geom/$${t}_test || exit 1; done

# A failing test, such as a timing test, does not stop the report. More allocations fail than in `make test`.
COVERAGE_EXIT := $(BUILD)-coverage/exit.o
coverage:
	@mkdir -p $(BUILD)-coverage
	$(CC) -std=c17 $(WARN) -fPIC -c tests/coverage/exit.c -o $(COVERAGE_EXIT)
	-MEMORY_POINTS=30 $(MAKE) BUILD=$(BUILD)-coverage OPT=-O0 TEST_OPT=-O0 SANITIZE="--coverage -DCAG_ONE_COPY" LDFLAGS="-Wl,--wrap=_exit $(COVERAGE_EXIT)" test
	BUILD=$(BUILD)-coverage sh tools/coverage.sh
# Measures how many of N random changes to the code the tests detect. SEED= selects other changes.
mutate:
	N=$(N) SEED=$(SEED) python3 tools/mutate.py

$(BUILD)/tests/bench/%: tests/bench/%.c $(BUILD)/libcag.a
	@mkdir -p $(@D)
	$Q$(CC) $(CFLAGS_ALL) $< $(BUILD)/libcag.a -o $@ $(LDLIBS_ALL)
# SISL is compared only in this benchmark, and only if its header is installed.
$(BUILD)/tests/bench/curves: tests/bench/curves.c $(BUILD)/libcag.a
	@mkdir -p $(@D)
	$Q$(CC) $(CFLAGS_ALL) $$(test -f /usr/include/sisl.h && echo -DCAG_SISL) $< $(BUILD)/libcag.a -o $@ \
	  $$(test -f /usr/include/sisl.h && echo -lsisl) $(LDLIBS_ALL)
# Orocos KDL is also compared, by a separate C++ program that is built only if its header is installed.
KDL := $(wildcard /usr/include/kdl/chain.hpp)
$(BUILD)/tests/bench/robots_kdl: tests/bench/robots_kdl.cpp tests/bench/robots.h
	@mkdir -p $(@D)
	$Q$(CXX) -std=c++17 -O3 -I. -isystem /usr/include/eigen3 $< -o $@ -lorocos-kdl
# So is Open CASCADE.
OCCT := $(wildcard /usr/include/opencascade/BRepMesh_IncrementalMesh.hxx)
$(BUILD)/tests/bench/surfaces: tests/bench/surfaces.c $(BUILD)/libcag.a
	@mkdir -p $(@D)
	$Q$(CC) $(CFLAGS_ALL) $$(test -f /usr/include/sisl.h && echo -DCAG_SISL) $< $(BUILD)/libcag.a -o $@ \
	  $$(test -f /usr/include/sisl.h && echo -lsisl) $(LDLIBS_ALL)
$(BUILD)/tests/bench/occt: tests/bench/occt.cpp
	@mkdir -p $(@D)
	$Q$(CXX) -std=c++17 -O3 -isystem $(dir $(OCCT)) $< -o $@ -lTKMesh -lTKTopAlgo -lTKBRep -lTKG3d -lTKGeomBase \
	  -lTKMath -lTKernel
$(BUILD)/tests/bench/occt_solids: tests/bench/occt_solids.cpp
	@mkdir -p $(@D)
	$Q$(CXX) -std=c++17 -O3 -isystem $(dir $(OCCT_H)) $< -o $@ -Wl,--as-needed $(OCCT_LIBS)
# Embree, too.
$(BUILD)/tests/bench/rays: tests/bench/rays.c $(BUILD)/libcag.a
	@mkdir -p $(@D)
	$Q$(CC) $(CFLAGS_ALL) $(if $(EMBREE_H),-DCAG_PEER_EMBREE) $< $(BUILD)/libcag.a -o $@ $(if $(EMBREE_H),-lembree3) $(LDLIBS_ALL)
# Completion with Tab is part of the program, not of the library.
$(BUILD)/tests/bench/complete: tests/bench/complete.c $(filter-out %/cli/main.o,$(CLI_OBJ)) $(BUILD)/libcag.a
	@mkdir -p $(@D)
	$Q$(CC) $(CFLAGS_ALL) $(filter %.c %.o %.a,$^) -o $@ $(LDLIBS_ALL)
bench: all $(BUILD)/tests/bench/complete $(BUILD)/tests/bench/surfaces $(if $(OCCT),$(BUILD)/tests/bench/occt) $(if $(OCCT_H),$(BUILD)/tests/bench/occt_solids) $(BUILD)/tests/bench/solids $(BUILD)/tests/bench/export $(BUILD)/tests/bench/curves $(BUILD)/tests/bench/robots $(if $(KDL),$(BUILD)/tests/bench/robots_kdl) $(BUILD)/tests/bench/booleans $(BUILD)/tests/bench/rays $(BUILD)/tests/bench/first_picture
	BUILD=$(BUILD) sh tests/bench/run.sh
silhouettes: all
	python3 tests/bench/silhouettes.py $(BUILD)/cag

FORMATTED = $(shell find include base lang geom interp live cli wasm tests tools -name '*.[ch]' | sort) $(wildcard brep/*.[ch]pp)
format:
	clang-format -i $(FORMATTED)
check-format:
	clang-format --dry-run -Werror $(FORMATTED)
check-layers:
	python3 tools/check_layers.py
# GCC's path-sensitive static analysis. Its check of uninitialized values is off, because it reports loops that always run at least once.
# GCC's ordinary warnings, Clang, and the sanitizers detect such values. GCC 12 also reports a leak of memory that is stored in an array
# element at a variable index, such as that of the tasks of a batch. Leaks in cli/, which allocates with malloc, are therefore left to
# `make tidy`. The other folders allocate with cag_malloc, which neither tool follows.
ANALYZED := base lang geom interp live cli
# ANALYZE_EFFORT bounds the states of a function that it looks at; 5 is the default of GCC.
ANALYZE_EFFORT ?= 5
ANALYZE  := -O1 -fanalyzer --param analyzer-bb-explosion-factor=$(ANALYZE_EFFORT) -Wno-analyzer-use-of-uninitialized-value
$(BUILD)/analyzed/%.o: %.c
	@mkdir -p $(@D)
	@echo "analyze $<"
	$Qgcc $(CFLAGS_ALL) $(ANALYZE) -c $< -o $@
$(BUILD)/analyzed/live/%.o $(BUILD)/analyzed/cli/%.o: ANALYZE += -Wno-analyzer-malloc-leak -Wno-analyzer-file-leak
$(patsubst %.c,$(BUILD)/analyzed/%.o,$(INTERP_SRC)): | $(BUILD)/gen/builtin_functions.h
analyze: $(patsubst %.c,$(BUILD)/analyzed/%.o,$(shell find $(ANALYZED) -name '*.c'))

# clang-tidy, with the checks of .clang-tidy. Its analyzer takes nearly all of the time; TIDY_CHECKS=-clang-analyzer-* leaves it out.
TIDIED := base lang geom interp live cli
TIDY_CHECKS :=
TIDY_OK := $(BUILD)/tidied$(if $(TIDY_CHECKS),/some)
$(TIDY_OK)/%.ok: %.c .clang-tidy
	@mkdir -p $(@D)
	@echo "tidy $<"
	$Qclang-tidy --quiet $(if $(TIDY_CHECKS),'--checks=$(TIDY_CHECKS)') $< -- $(filter-out -Werror -MMD -MP $(SANITIZE),$(CFLAGS_ALL)) 2> $@.log || { cat $@.log; false; }
	@touch $@
$(patsubst %.c,$(TIDY_OK)/%.ok,$(INTERP_SRC)): | $(BUILD)/gen/builtin_functions.h
tidy: $(patsubst %.c,$(TIDY_OK)/%.ok,$(shell find $(TIDIED) -name '*.c'))

# Installs the program, the libraries with their pkg-config file, and the files of tools/install.sh.
install: all $(BUILD)/tools/tables $(BUILD)/tools/markdown_man
	install -d $(addprefix $(DESTDIR)$(PREFIX)/,bin $(LIBDIR)/pkgconfig include share)
	install -m 755 $(BUILD)/cag $(DESTDIR)$(PREFIX)/bin/cag
	install -m 644 $(BUILD)/libcag.a $(DESTDIR)$(PREFIX)/$(LIBDIR)/libcag.a
	install -m 755 $(BUILD)/libcag.so $(DESTDIR)$(PREFIX)/$(LIBDIR)/libcag.so.$(VERSION)
	ln -sf libcag.so.$(VERSION) $(DESTDIR)$(PREFIX)/$(LIBDIR)/$(SONAME)
	ln -sf $(SONAME) $(DESTDIR)$(PREFIX)/$(LIBDIR)/libcag.so
	install -m 644 include/cag.h $(DESTDIR)$(PREFIX)/include/cag.h
	if [ -x $(BUILD)/cag-brep ]; then \
	  install -d $(DESTDIR)$(PREFIX)/lib/cag && install -m 755 $(BUILD)/cag-brep $(DESTDIR)$(PREFIX)/lib/cag/cag-brep && \
	  install -m 644 $(patsubst %,$(BUILD)/%.so,$(BREP_MODULES)) $(DESTDIR)$(PREFIX)/lib/cag; fi
	sed -e 's|@PREFIX@|$(PREFIX)|' -e 's|@LIBDIR@|$(LIBDIR)|' -e 's|@VERSION@|$(VERSION)|' -e 's|@LIBS@|$(strip $(PKG_LIBS))|' tools/libcag.pc.in \
	  > $(DESTDIR)$(PREFIX)/$(LIBDIR)/pkgconfig/libcag.pc
	$(BUILD)/tools/tables > $(BUILD)/tables.txt
	sh tools/install.sh $(BUILD)/tables.txt $(BUILD)/tools/markdown_man $(DESTDIR)$(PREFIX)/share

# Debian packages in $(BUILD)/deb: the program, the library, and the development files.
deb: all $(BUILD)/tools/tables $(BUILD)/tools/markdown_man
	BUILD=$(BUILD) VERSION=$(VERSION) sh packaging/deb.sh
# The names of the built-in functions in the files for editors.
editors: $(BUILD)/tools/tables
	$(BUILD)/tools/tables | sh tools/editors.sh editors

# The page's sources are checked and bundled into web/dist, which is committed: only this needs node and esbuild.
web/node_modules: web/package-lock.json
	cd web && npm ci --ignore-scripts --no-audit --no-fund
	@touch $@
web: web/node_modules
	cd web && node_modules/.bin/tsc -p .
	sh web/build.sh web/dist
# The compiled-in fonts; needs fonts-liberation2 and python3-fonttools.
fonts:
	sh tools/fonts.sh fonts
# The picture of the page in the README; needs node and Chromium.
screenshots: all
	node tools/screenshots.js $(BUILD)/cag docs/pictures
check-web: web/node_modules
	cd web && node_modules/.bin/tsc -p .
	@rm -rf $(BUILD)/web && sh web/build.sh $(BUILD)/web
	diff -r $(BUILD)/web web/dist

# The extension of Visual Studio Code.
vsix: $(BUILD)/cag.vsix
$(BUILD)/cag.vsix: $(BUILD)/tools/tables tools/vsix.py tools/editors.sh $(shell find editors/vscode -type f)
	$(BUILD)/tools/tables | sh tools/editors.sh $(BUILD)/editors
	python3 tools/vsix.py $(BUILD)/editors/vscode $@

include wasm/build.mk

clean:
	rm -rf $(BUILD) $(BUILD)-sanitize $(BUILD)-clang $(BUILD)-threads $(BUILD)-embree $(BUILD)-coverage $(BUILD)-mutate

-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
