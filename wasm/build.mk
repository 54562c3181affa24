# The playground: cag as WebAssembly, with a page, as one static folder. Included by the Makefile.
#
# `make playground` needs emscripten, clang, libeigen3-dev, and dpkg-dev, and downloads the Debian sources of the libraries once.
# Files of the folder wasm/ replace those that need threads, processes, or libraries that are not there.

PLAYGROUND_OPT ?= -O2 -fno-unroll-loops
# Of code that takes little of the time, so that less is sent.
PLAYGROUND_OPT_SMALL ?= -Os
PLAYGROUND_OPT_SMALLEST ?= -Oz
WASM      := $(BUILD)/wasm
WASM_DEPS := $(BUILD)/playground-deps
# emcc looks for its packages where Debian's node does.
EMCC      := NODE_PATH=/usr/share/nodejs emcc
# The one that emcc calls.
WASM_CLANG ?= $(notdir $(firstword $(wildcard /usr/bin/clang-14) clang))
# Linear memory for the C stack, in bytes.
WASM_STACK := 4194304

WASM_LEFT_OUT := base/aside.c base/library.c base/parallel.c base/large_stack.c base/reserve.c interp/session/watch.c \
                 geom/letter/compiled.c geom/letter/libraries.c interp/formats/system_fonts.c \
                 interp/render/exr_read.c interp/render/exr_write.c interp/render/exr_complaint.c \
                 interp/render/povray.c interp/render/povray_files.c interp/render/povray_log.c interp/render/povray_process.c \
                 interp/kernel/answers.c interp/kernel/ask.c interp/kernel/read_boundary.c interp/kernel/unnamed_file.c interp/formats/brep_check.c interp/render/sandbox.c interp/session/markdown.c $(wildcard interp/session/site*.c)
WASM_LIVE := $(patsubst %,live/%.c,json json_write lsp lsp_files lsp_requests measures model_answers model_files model_run place_json points_json questions request robot_json scene_json)
WASM_SRC  := $(filter-out $(WASM_LEFT_OUT),$(BASE_SRC) $(LANG_SRC) $(GEOM_SRC) $(INTERP_SRC)) $(WASM_LIVE) \
             $(filter-out wasm/case_table.c,$(sort $(wildcard wasm/*.c wasm/*/*.c wasm/*/*/*.c)))
WASM_OBJ  := $(patsubst %.c,$(WASM)/%.o,$(WASM_SRC)) $(patsubst %,$(WASM)/gen/%.o,stdlib builtins) $(WASM)/wasm/lapack.o
# The flags of emcc are asked for when they are needed. Calling clang directly takes half of the time of emcc.
WASM_SMALL := base geom/camera geom/image geom/letter geom/meet geom/robot geom/solid interp/scene lang
WASM_SMALLEST := interp/builtin interp/check interp/doc interp/document interp/formats interp/session live wasm
wasm_in = $(filter $(addsuffix /%,$(1)),$<)
WASM_FLAGS = $$(cat $(WASM)/flags) $(if $(call wasm_in,$(WASM_SMALLEST)),$(PLAYGROUND_OPT_SMALLEST),$(if $(call wasm_in,$(WASM_SMALL)),$(PLAYGROUND_OPT_SMALL),$(PLAYGROUND_OPT))) -msimd128 $(WARN) -Iwasm -I$(WASM) -I$(WASM_DEPS)/include -MMD -MP
WASM_CFLAGS = $(WASM_FLAGS) -std=c17 -D_GNU_SOURCE -fno-math-errno -fno-trapping-math -ffp-contract=off -I. -Iinclude -I$(BUILD)/gen \
              -DCAG_VERSION='"$(VERSION)"'
WASM_LINK := -s MODULARIZE=1 -s EXPORT_ES6=1 -s USE_ES6_IMPORT_META=0 -s ENVIRONMENT=worker -s DYNAMIC_EXECUTION=0 \
             -s FILESYSTEM=1 -s FORCE_FILESYSTEM=1 -s ALLOW_MEMORY_GROWTH=1 -s INITIAL_MEMORY=33554432 -s MAXIMUM_MEMORY=2147483648 \
             -s TOTAL_STACK=$(WASM_STACK) -Wl,--stack-first -s EXPORTED_FUNCTIONS=_malloc,_free -s EXPORTED_RUNTIME_METHODS=FS,UTF8ToString --no-entry

# Clang 14 moves loads past stores to another variable that has the same place on the stack.
WASM_CORRECT := -mllvm -no-stack-coloring

$(WASM)/flags: wasm/build.mk
	@mkdir -p $(@D)
	$Qecho $$($(EMCC) --cflags) $(WASM_CORRECT) > $@
$(WASM_DEPS)/libdeps.a: wasm/deps.sh
	@echo "libraries for WebAssembly"
	$QNODE_PATH=/usr/share/nodejs CLANG=$(WASM_CLANG) OPT="-Os $(WASM_CORRECT)" sh wasm/deps.sh $(WASM_DEPS)
$(WASM)/case_table.h: wasm/case_table.c
	@mkdir -p $(@D)
	$Q$(CC) $(CFLAGS_ALL) $< -lutf8proc -o $(WASM)/case_table && $(WASM)/case_table > $@
$(WASM)/wasm/base/unicode.o: $(WASM)/case_table.h
$(WASM)/%.o: %.c $(WASM)/flags | $(WASM_DEPS)/libdeps.a $(BUILD)/gen/builtin_functions.h
	@mkdir -p $(@D)
	@echo "wasm $<"
	$Q$(WASM_CLANG) $(WASM_CFLAGS) -c $< -o $@
$(WASM)/gen/%.o: $(BUILD)/gen/%.c $(WASM)/flags | $(WASM_DEPS)/libdeps.a
	@mkdir -p $(@D)
	@echo "wasm $<"
	$Q$(WASM_CLANG) $(WASM_CFLAGS) -c $< -o $@
$(WASM)/wasm/lapack.o: wasm/lapack.cpp wasm/lapacke.h $(WASM)/flags
	@mkdir -p $(@D)
	@echo "wasm $<"
	$Q$(WASM_CLANG) -x c++ $(WASM_FLAGS) -Wno-deprecated-declarations -std=c++17 -fno-exceptions -fno-rtti -DEIGEN_NO_DEBUG -DNDEBUG -DEIGEN_MPL2_ONLY \
	  -isystem /usr/include/eigen3 -isystem $$(sed -n 's/.*--sysroot=\([^ ]*\).*/\1/p' $(WASM)/flags)/include/c++/v1 -c $< -o $@
$(WASM)/cag.mjs: $(WASM_OBJ) $(WASM_DEPS)/libdeps.a wasm/build.mk
	@echo "link $@"
	$Q$(EMCC) $(PLAYGROUND_OPT) $(WASM_LINK) $(WASM_OBJ) $(WASM_DEPS)/libdeps.a -lc++ -lc++abi -o $@

# Everything together. PLAYGROUND_PICTURES=--no-pictures leaves out the pictures of the examples and of the documentation.
PLAYGROUND := $(BUILD)/playground
PLAYGROUND_PICTURES ?=
$(PLAYGROUND)/worker.js: $(WASM)/cag.mjs web/playground.sh $(FONTS) $(wildcard web/src/*) | web/node_modules
	@echo "bundle $(PLAYGROUND)"
	$Qsh web/playground.sh $(PLAYGROUND) $(WASM)/cag.mjs $(WASM_DEPS)/sources
$(PLAYGROUND)/examples.json: tools/playground_examples.mjs $(wildcard examples/*.cag examples/*/*.cag) | $(BUILD)/cag
	@mkdir -p $(@D)
	@echo "examples of $(PLAYGROUND)"
	$Qnode tools/playground_examples.mjs $(BUILD)/cag $(PLAYGROUND) $(PLAYGROUND_PICTURES)
$(PLAYGROUND)/docs/index.html: $(BUILD)/cag
	@echo "documentation of $(PLAYGROUND)"
	$Q$(BUILD)/cag doc --html $(PLAYGROUND)/docs --playground ../ $(PLAYGROUND_PICTURES) && touch $@
playground: $(PLAYGROUND)/worker.js $(PLAYGROUND)/examples.json $(PLAYGROUND)/docs/index.html

-include $(shell find $(WASM) -name '*.d' 2>/dev/null)
