# Makefile - build, set up, try, test and install; `make help` lists the targets
#
# Everything made goes under build/, the programs into build/bin/.  The
# variables below can be given on the command line, as in
# `make test config=sanitize` or `make CC=clang`.

SHELL := /bin/sh
.DELETE_ON_ERROR:
.DEFAULT_GOAL := all

config ?= release
JOBS   ?= $(shell nproc 2>/dev/null || echo 2)

# release is the default and lives in build/ itself.
ifeq ($(config),release)
B     := build
FLAGS := -O2 -g
else ifeq ($(config),debug)
B     := build/debug
FLAGS := -O0 -g3
else ifeq ($(config),sanitize)
B     := build/sanitize
FLAGS := -O1 -g -fno-omit-frame-pointer -fsanitize=address,undefined \
         -fno-sanitize-recover=all
else ifeq ($(config),coverage)
B     := build/coverage
FLAGS := -O1 -g --coverage
else
$(error config=$(config): expected release, debug, sanitize or coverage)
endif

CFLAGS   ?=
CPPFLAGS ?=
LDFLAGS  ?=
WARN     := -Wall -Wextra -Wshadow -Wconversion -Wstrict-prototypes \
            -Wmissing-prototypes -Wvla -Wno-missing-field-initializers
# libxml2's headers lie in a folder of their own, which its own script knows.
XML2     := $(firstword $(filter -I%,$(shell xml2-config --cflags 2>/dev/null)) \
              -I/usr/include/libxml2)
# Multiply and add stay apart, so that the scalar and the batch path agree to
# the last bit.  Nobody reads the exception flags, and without them a loop may
# compute both sides of a condition.  c17 hides POSIX, which _GNU_SOURCE brings
# back.
LANGUAGE := -std=c17 -D_GNU_SOURCE -ffp-contract=off -fno-math-errno \
            -fno-trapping-math -fopenmp -I. \
            -DBSDF_DATA_DIR='"$(CURDIR)/data"' $(XML2)
COMPILE   = $(CC) $(LANGUAGE) $(FLAGS) $(WARN) $(CPPFLAGS) $(CFLAGS)
LIBS     := -lxml2 -lgsl -lgslcblas -lyaml -ljansson -ldl -lm
# What the integrator needs besides; the other programs do not link it.
INTEGRATOR_LIBS := -lembree3 -lassimp -lOpenEXRCore -lpng -llzma

# `make V=1` shows the commands.
SAY := @printf '  %-5s %s\n'
Q   := @
ifdef V
SAY := @:
Q   :=
endif

# -- what there is to build ---------------------------------------------------

FOLDERS  := $(patsubst %/,%,$(wildcard bsdf/ validate/ plots/ integrator/))
SOURCES  := $(foreach d,$(FOLDERS),$(wildcard $(d)/*.c))
HEADERS  := $(foreach d,$(FOLDERS) tests,$(wildcard $(d)/*.h))
TESTS    := $(patsubst tests/%.c,%,$(wildcard tests/test_*.c))
# What `make test` runs.  Statistics over thousands of cases, pictures, and what
# pages say ask nothing new of memory, and sanitizers make them take minutes.
RUN      := $(if $(filter sanitize,$(config)),$(filter-out test_calibration \
              test_course test_depth test_docs test_mutants test_writeup,\
              $(TESTS)),$(TESTS))
# Those that take minutes begin first, so that they do not end alone.
LONGEST  := test_mutants test_calibration test_writeup test_docs test_plots \
            test_figures test_report test_checks test_transport test_render
ORDERED  := $(filter $(RUN),$(LONGEST)) $(filter-out $(LONGEST),$(RUN))
# Programs of tests/ that `make test` does not run, each with its own target.
LONG     := $(wildcard $(patsubst %,tests/%.c,bench bench_render mutants baselines calibrate))
HELPERS  := $(filter-out $(TESTS:%=tests/%.c) $(LONG),$(wildcard tests/*.c))

# Loops over lanes, which see more of the registers with -O3.
ifeq ($(config),release)
LANED    := $(patsubst %,$(B)/obj/%.o,bsdf/diffuse bsdf/facets bsdf/rng \
              bsdf/roughconductor bsdf/roughdielectric integrator/camera \
              integrator/light integrator/path integrator/sampler \
              integrator/trace tests/bench validate/partition \
              validate/quadrature validate/sphere validate/subject \
              validate/survey)
$(LANED): FLAGS += -O3
endif

objects   = $(patsubst %.c,$(B)/obj/%.o,$(1))
libof     = $(B)/lib$(1).a
# Of a program, by the file with its main().
libs      = $(if $(filter integrator/%,$(1)),$(INTEGRATOR_LIBS)) $(LIBS)
# Each library before those that it uses.
LIBRARIES := $(foreach d,integrator plots validate bsdf,\
               $(if $(filter $(d),$(FOLDERS)),$(call libof,$(d))))

# The programs, by the file with their main().
PROGRAM_bsdf/main       := bsdf-info
PROGRAM_validate/main   := bsdf-validate
PROGRAM_validate/host   := bsdf-plugin-host
PROGRAM_plots/main      := bsdf-plot
PROGRAM_integrator/main := bsdf-render
MAINS     := $(foreach s,$(SOURCES),$(if $(PROGRAM_$(s:.c=)),$(s)))
PROGRAMS  := $(foreach m,$(MAINS),$(B)/bin/$(PROGRAM_$(m:.c=)))

.PHONY: all
all: tools-found $(PROGRAMS) scenes ## build the programs into build/bin/ (the default)

define library
$(call libof,$(1)): $(call objects,$(filter-out $(MAINS),$(filter $(1)/%,$(SOURCES))))
	$$(SAY) AR $$@
	$$(Q)rm -f $$@ && ar rcs $$@ $$^
endef
define program
$(B)/bin/$(PROGRAM_$(1:.c=)): $(call objects,$(1)) $(LIBRARIES)
	@mkdir -p $$(@D)
	$$(SAY) LINK $$@
	$$(Q)$$(COMPILE) $(LDFLAGS) -o $$@ $$^ $(call libs,$(1))
endef
$(foreach m,$(MAINS),$(eval $(call program,$(m))))
$(foreach d,$(FOLDERS),$(eval $(call library,$(d))))

$(B)/obj/%.o: %.c Makefile
	@mkdir -p $(@D)
	$(SAY) CC $<
	$(Q)$(COMPILE) -MMD -MP -c -o $@ $<

$(B)/bin/tests/%: $(B)/obj/tests/%.o $(call objects,$(HELPERS)) $(LIBRARIES)
	@mkdir -p $(@D)
	$(SAY) LINK $@
	$(Q)$(COMPILE) $(LDFLAGS) -o $@ $^ -lcmocka -Wl,--as-needed $(INTEGRATOR_LIBS) $(LIBS)

# The scenes, and a mesh that is too large to be kept.
KNOT    := $(B)/obj/data/scenes/knot
SCENES  := $(patsubst data/%,$(B)/%,$(wildcard data/scenes/*.xml)) \
           $(B)/scenes/knot.ply

.PHONY: scenes
scenes: $(SCENES) ## data/scenes/ and the mesh of mesh.xml, in build/scenes/

$(B)/scenes/%.xml: data/scenes/%.xml
	@mkdir -p $(@D)
	$(Q)cp $< $@

$(B)/scenes/knot.ply: $(KNOT)
	@mkdir -p $(@D)
	$(SAY) MESH $@
	$(Q)$< $@

$(KNOT): $(KNOT).o
	$(SAY) LINK $@
	$(Q)$(COMPILE) $(LDFLAGS) -o $@ $^ -lm

-include $(shell find $(B)/obj -name '*.d' 2>/dev/null)
.PRECIOUS: $(B)/obj/%.o

# -- set-up -------------------------------------------------------------------
# One line a library: what to include, how to link, Debian's package.  A tool
# has a line as well.  Looked for by compiling and linking; a gnuplot that is
# there, of whatever flavour, is left alone.  What is extra is installed where
# that can be done, and else done without.

define NEEDS
library stdio.h            -lm                  libc6-dev
library gsl/gsl_cdf.h      -lgsl,-lgslcblas,-lm libgsl-dev
library Random123/threefry.h -lm                librandom123-dev
library yaml.h             -lyaml               libyaml-dev
library jansson.h          -ljansson            libjansson-dev
library libxml/xmlwriter.h $(XML2),-lxml2 libxml2-dev
library lzma.h             -llzma               liblzma-dev
library embree3/rtcore.h   -lembree3            libembree-dev
library assimp/cimport.h   -lassimp             libassimp-dev
library OpenEXR/openexr.h  -lOpenEXRCore        libopenexr-dev
library png.h              -lpng                libpng-dev
library cmocka.h           -lcmocka             libcmocka-dev
library omp.h              -fopenmp             $(if $(findstring clang,$(CC)),libomp-dev,gcc)
tool    gnuplot            -                    gnuplot-nox
extra   help2man           -                    help2man
endef
export NEEDS

# Prints the packages that are missing; with $extras set, extra ones as well.
define FIND_MISSING
echo "$$NEEDS" | while read -r kind what link package; do \
    case $$kind in \
    library) printf '#include <%s>\n' stdarg.h stddef.h stdint.h setjmp.h $$what | \
        { cat; echo 'int main(void) { return 0; }'; } | \
        $(CC) -x c - -o /dev/null -fopenmp $$(echo $$link | tr , ' ') \
        >/dev/null 2>&1 || printf '%s ' $$package;; \
    extra) [ -z "$$extras" ] || command -v $$what >/dev/null 2>&1 || \
        printf '%s ' $$package;; \
    tool) command -v $$what >/dev/null 2>&1 || printf '%s ' $$package;; \
    esac; \
done
endef

.PHONY: setup tools-found
setup: build/.setup-$(notdir $(firstword $(CC))) ## install what is missing (Debian); demo and test do it themselves

build/.setup-$(notdir $(firstword $(CC))): Makefile
	@mkdir -p build; \
	extras=$$(command -v apt-get); \
	missing=$$($(FIND_MISSING)); \
	if [ -n "$$missing" ]; then \
	    if ! command -v apt-get >/dev/null 2>&1; then \
	        echo "missing, by the names of Debian's packages: $$missing" >&2; \
	        exit 2; \
	    fi; \
	    if [ "$$(id -u)" = 0 ]; then as=; else as=sudo; fi; \
	    echo "installing: $$missing"; \
	    $$as apt-get update -qq && \
	    $$as env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq \
	        --no-install-recommends $$missing >build/setup.log 2>&1 || \
	        { tail -n 20 build/setup.log >&2; exit 2; }; \
	    extras=; \
	    missing=$$($(FIND_MISSING)); \
	    if [ -n "$$missing" ]; then \
	        echo "still missing after the installation: $$missing" >&2; \
	        exit 2; \
	    fi; \
	fi; \
	touch $@

# A plain `make` installs nothing; it says what is missing before the compiler
# does.
tools-found:
	@[ -e build/.setup-$(notdir $(firstword $(CC))) ] || { \
	    extras=; \
	    missing=$$($(FIND_MISSING)); \
	    [ -z "$$missing" ] || { \
	        echo "missing, by the names of Debian's packages: $$missing" \
	             "(make setup installs them)" >&2; exit 2; }; }

# -- use ----------------------------------------------------------------------

DEMO := build/demo
BIN  := $(B)/bin
CALCIUM := roughconductor:material=Ca,alpha=0.25

.PHONY: demo
demo: setup ## from measured calcium to a verdict and pictures, in build/demo/
	@$(MAKE) --no-print-directory -j$(JOBS) all
	@mkdir -p $(DEMO)
	@echo
	@echo "The optical constants of calcium, as measured:"
	$(BIN)/bsdf-info ior Ca --nm 614,549,466
	@echo
	@echo "Is a rough conductor made of them sound?"
	$(BIN)/bsdf-validate '$(CALCIUM)' --json $(DEMO)/verdict.json
	@echo
	@echo "Its lobe, and what it samples against what it says it samples:"
	$(BIN)/bsdf-plot lobe '$(CALCIUM)' --wo 45,0 -o $(DEMO)/lobe.svg
	$(BIN)/bsdf-plot histogram '$(CALCIUM)' --wo 45,0 -o $(DEMO)/histogram.svg

# The pages of the pictures say how each is made: the commands of their sh
# blocks are run, in a folder of their own, and what they draw is copied.
# $(1) where to, $(2) the pages, the later ones going on where the others end.
define draw
	@rm -rf build/gallery && mkdir -p build/gallery
	@cd build/gallery && export PATH="$(abspath $(BIN)):$$PATH" \
	    BSDF="$(CURDIR)" CPATH="$(CURDIR)" && \
	    for page in $(2); do \
	        sh "$$BSDF/tests/blocks.sh" sh "$$BSDF/$$page" >blocks && \
	            sh -e blocks >printed || exit 1; \
	    done
	@cd build/gallery && grep -ho '$(1)/[a-z0-9_-]*\.[a-z]*' \
	    $(addprefix $(CURDIR)/,$(lastword $(2))) | sort -u | while read -r f; do \
	        cp "$$(basename "$$f")" $(CURDIR)/$(dir $(lastword $(2)))$(1)/ && \
	            echo "$(dir $(lastword $(2)))$$f"; \
	    done
endef

.PHONY: gallery
gallery: all ## draw the pictures of the README and of validate/README.md again
	$(call draw,gallery,plots/GALLERY.md)
	$(call draw,pictures,validate/TUTORIAL.md validate/README.md)

# Its own rules know what has changed; it goes on where it was interrupted.
QUALITY ?= draft
.PHONY: writeup
writeup: setup ## a course's write-up, every figure and number made anew, into build/writeup/ (QUALITY=draft|final, COURSE_SCENES=DIR)
	@$(MAKE) --no-print-directory -j$(JOBS) all
	@$(MAKE) --no-print-directory -j$(JOBS) -f plots/writeup/writeup.mk BIN=$(BIN) QUALITY=$(QUALITY)

# -- installing ---------------------------------------------------------------
# What is installed looks for its tables below PREFIX: the one file that knows
# where they are is compiled again, into STAGE.  DESTDIR goes before each path
# that is written to, and into no file.

PREFIX  ?= /usr/local
DESTDIR ?=
STAGE   := $(B)/install
VERSION  = $(shell sed -n 's/^\#define BSDF_VERSION "\(.*\)"/\1/p' bsdf/cli.h)

# bsdf.h, and what else a renderer may want, with all that they include.
PUBLIC  := $(patsubst %,bsdf/%.h,bands bsdf cie colour err fresnel ior ndf plugin rng vec)
TABLES  := $(shell find data -type f ! -name '.*' ! -name '*.c')
STAGED  := $(PROGRAMS:$(B)/bin/%=$(STAGE)/%) $(STAGE)/libbsdf.a $(STAGE)/libbsdf.pc
# Programs that tell their options, and so have a manual page and completion.
TALKING := $(filter-out bsdf-plugin-host,$(PROGRAMS:$(B)/bin/%=%))
COMPLETIONS := share/bash-completion/completions
# from=to, the latter below PREFIX
INSTALLED := $(foreach f,$(PROGRAMS:$(B)/bin/%=%),$(STAGE)/$(f)=bin/$(f)) \
             $(foreach f,$(TALKING),bsdf/completion.bash=$(COMPLETIONS)/$(f)) \
             $(foreach f,$(TALKING),$(B)/man/$(f).1=share/man/man1/$(f).1) \
             $(STAGE)/libbsdf.a=lib/libbsdf.a \
             $(STAGE)/libbsdf.pc=lib/pkgconfig/libbsdf.pc \
             $(foreach f,$(PUBLIC),$(f)=include/$(f)) \
             validate/adapters/course.hpp=include/bsdf/course.hpp \
             validate/report.schema.json=share/bsdf/report.schema.json \
             $(foreach f,$(TABLES),$(f)=share/bsdf/$(f)) \
             $(B)/scenes/knot.ply=share/bsdf/data/scenes/knot.ply

# Manual pages are made of what the programs say of their options, by help2man;
# where there is none they are left out, and said to be.
HAS_HELP2MAN := $(shell command -v help2man 2>/dev/null)
MANUAL       := $(if $(HAS_HELP2MAN),$(TALKING:%=$(B)/man/%.1))
INSTALLING   := $(if $(MANUAL),$(INSTALLED),$(filter-out %.1,$(INSTALLED)))

.PHONY: man
man: tools-found ## the manual pages, into build/man/ (help2man)
	@$(call install_tool,help2man,help2man)
	@$(MAKE) --no-print-directory $(TALKING:%=$(B)/man/%.1)

define page
$(B)/man/$(PROGRAM_$(1:.c=)).1: $(B)/bin/$(PROGRAM_$(1:.c=)) \
    $(dir $(1))$(PROGRAM_$(1:.c=)).h2m
	@mkdir -p $$(@D)
	$$(SAY) MAN $$@
	$$(Q)help2man --no-info --include=$$(lastword $$^) -o $$@ $$<
endef
$(foreach m,$(MAINS),$(eval $(call page,$(m))))

# One word that starts with a slash.
CHECK_PREFIX = $(if $(filter 1/,$(words $(PREFIX))$(patsubst /%,/,$(PREFIX))),,$\
               $(error PREFIX=$(PREFIX): expected an absolute path without spaces))

.PHONY: install uninstall always
install: tools-found $(STAGED) $(MANUAL) scenes ## programs, libbsdf, manual pages, tables and more, to PREFIX=/usr/local (and DESTDIR)
	@for f in $(INSTALLING); do \
	    to="$(DESTDIR)$(PREFIX)/$${f#*=}"; \
	    case $$f in *=bin/*) mode=755;; *) mode=644;; esac; \
	    mkdir -p "$$(dirname "$$to")" && \
	        install -m $$mode "$${f%%=*}" "$$to" || exit 1; \
	done
	@echo "installed $(words $(INSTALLING)) files below $(DESTDIR)$(PREFIX)"
	@[ -n "$(MANUAL)" ] || echo "without manual pages, as help2man is missing" \
	    "(on Debian make man installs it; then make install again)" >&2

# Folders such as lib/ may be others' as well, and stay.
uninstall: ## remove what `make install` put there, given the same PREFIX and DESTDIR
	$(CHECK_PREFIX)@for f in $(INSTALLED); do \
	    to=$${f#*=}; \
	    rm -f "$(DESTDIR)$(PREFIX)/$$to" || exit 1; \
	    case $$to in include/*|share/*) \
	        (cd "$(DESTDIR)$(PREFIX)/$${to%%/*}" && \
	            rmdir -p "$$(dirname "$${to#*/}")") 2>/dev/null;; \
	    esac; \
	done; :

# Made anew when PREFIX is another one than the last time.
$(STAGE)/prefix: always
	$(CHECK_PREFIX)@mkdir -p $(@D)
	@echo '$(PREFIX)' | cmp -s - $@ || echo '$(PREFIX)' >$@

$(STAGE)/libbsdf.a: $(call libof,bsdf) $(STAGE)/prefix
	$(SAY) AR $@
	$(Q)$(COMPILE) -UBSDF_DATA_DIR -DBSDF_DATA_DIR='"$(PREFIX)/share/bsdf/data"' \
	    -c -o $(STAGE)/cie.o bsdf/cie.c
	$(Q)cp $< $@ && ar r $@ $(STAGE)/cie.o

$(STAGE)/libbsdf.pc: bsdf/libbsdf.pc.in bsdf/cli.h Makefile $(STAGE)/prefix
	$(Q)sed 's|@PREFIX@|$(PREFIX)|; s|@VERSION@|$(VERSION)|' $< >$@

define staged
$(STAGE)/$(PROGRAM_$(1:.c=)): $(call objects,$(1)) \
    $(LIBRARIES:$(call libof,bsdf)=$(STAGE)/libbsdf.a)
	$$(SAY) LINK $$@
	$$(Q)$$(COMPILE) $(LDFLAGS) -o $$@ $$^ $(call libs,$(1))
endef
$(foreach m,$(MAINS),$(eval $(call staged,$(m))))

# -- tests --------------------------------------------------------------------

.PHONY: test run-tests headers
test: setup ## set up, build, run every test (config=sanitize: with sanitizers)
	@$(MAKE) --no-print-directory -j$(JOBS) all headers $(RUN:%=$(B)/bin/tests/%)
	@$(MAKE) --no-print-directory run-tests

# Side by side; what one prints stays together.
run-tests:
	@$(MAKE) --no-print-directory -k -O -j$(JOBS) $(ORDERED:%=run-%)

run-%:
	@BIN=$(BIN) $(WRAP) $(B)/bin/tests/$*

headers: $(HEADERS:%=$(B)/obj/%.alone)
$(B)/obj/%.h.alone: %.h Makefile
	@mkdir -p $(@D)
	@printf '#include "%s"\n' $< | $(COMPILE) -fsyntax-only -x c - && touch $@

.PHONY: check-clone
check-clone: all $(B)/bin/tests/test_docs ## what the pages say, from sources of which nothing is built yet
	@FRESH=1 BIN=$(BIN) $(B)/bin/tests/test_docs

.PHONY: valgrind
valgrind: test ## the tests that malformed input goes through, under valgrind
	@command -v valgrind >/dev/null || { echo "valgrind is missing" >&2; exit 2; }
	@$(MAKE) --no-print-directory run-tests RUN='$(filter test_spec test_ior test_cli test_film,$(TESTS))' \
	    WRAP='valgrind -q --error-exitcode=99 --leak-check=full --errors-for-leak-kinds=definite,indirect'

# By file as well with V=1.
define COVERAGE
$$1 == "File" { name = substr($$2, 2, length($$2) - 2) }
/^Lines executed/ && name ~ /\.c$$/ {
    hit = int(substr($$2, 10) / 100 * $$4 + 0.5)
    folder = name
    sub("/.*", "", folder)
    if ("$(V)" != "")
        print row(name, $$4, hit)
    lines[folder] += $$4; hits[folder] += hit
    lines_all += $$4; hits_all += hit
}
{ if (!/^File/) name = "" }
function row(name, lines, hits) {
    return sprintf("%-28s%8d%9d%9.1f %%", name, lines, hits,
        lines ? 100 * hits / lines : 0)
}
END {
    printf "%-28s%8s%9s%11s\n", "", "lines", "reached", "share"
    fflush()
    for (f in lines)
        print row(f "/", lines[f], hits[f]) | "sort"
    close("sort")
    print row("all", lines_all, hits_all)
}
endef
export COVERAGE
GCOV ?= gcov

.PHONY: coverage
coverage: ## run the tests and count the lines that they reach, by folder (gcc)
	@find build/coverage -name '*.gcda' -delete 2>/dev/null; \
	$(MAKE) --no-print-directory config=coverage test; status=$$?; \
	$(GCOV) -n $(SOURCES:%.c=build/coverage/obj/%.gcno) 2>/dev/null | \
	    awk "$$COVERAGE"; exit $$status

.PHONY: bench
bench: tools-found ## what calls, a chi-square, bin masses and a picture cost, as ratios
	@$(MAKE) --no-print-directory config=release -j$(JOBS) build/bin/tests/bench build/bin/tests/bench_render
	@build/bin/tests/bench
	@build/bin/tests/bench_render

# The seed is 1 and is printed; `make mutants SEED=2` takes another.
SEED ?= 1

.PHONY: mutants
mutants: tools-found ## known mistakes: which check catches which, how small, and what it is said to be (SEED=1)
	@$(MAKE) --no-print-directory config=release -j$(JOBS) build/bin/tests/mutants
	@build/bin/tests/mutants --seed $(SEED)

.PHONY: baselines
baselines: tools-found ## the chi-square tests of three renderers beside ours, into the README too (SEED=1)
	@$(MAKE) --no-print-directory config=release -j$(JOBS) build/bin/tests/baselines
	@build/bin/tests/baselines --seed $(SEED) --readme README.md

.PHONY: mutants-tester
mutants-tester: tools-found ## mistakes in the checks themselves: a test must notice each
	@sh tests/mutate_tester.sh build/mutants-tester $(JOBS)
# Both write their tables into the README; CALIBRATE="--seed 7" for another
# seed, PUBLISH= to print only.
CALIBRATE ?=
PUBLISH   ?= --publish README.md
.PHONY: calibrate power
calibrate: ## what the checks say of 10^4 sound cases, into the README (10 minutes)
power: ## which mistakes the checks catch, into the README (15 minutes)
calibrate power: tools-found
	@$(MAKE) --no-print-directory config=release -j$(JOBS) build/bin/tests/calibrate
	@build/bin/tests/calibrate $(if $(filter power,$@),--power) $(PUBLISH) $(CALIBRATE)

.PHONY: golden
golden: ## make the golden tables again, in 50 digits (Python, mpmath from PyPI)
	@[ -x build/venv/bin/python ] || python3 -m venv build/venv
	@build/venv/bin/python -c 'import mpmath' 2>/dev/null || \
	    build/venv/bin/pip install -q mpmath
	build/venv/bin/python tests/golden.py tests/golden

# LLVM is what Mitsuba's vectorised variants compile with; versions before 17
# cannot.  Without it the scalar ones serve, more slowly.
MITSUBA        ?= mitsuba==3.9.1
MITSUBA_PYTHON := build/venv-mitsuba/bin/python
HAS_LLVM       := $(MITSUBA_PYTHON) -c 'import drjit, sys; \
                  sys.exit(drjit.detail.llvm_version()[0] < 17)' >/dev/null 2>&1

.PHONY: peer-mitsuba mitsuba
peer-mitsuba: all mitsuba ## validate the BSDFs of Mitsuba 3, and why some fail (Python, mitsuba from PyPI)
	python3 tests/peer_mitsuba.py $(BIN)/bsdf-validate $(MITSUBA_PYTHON) $(ONLY)

mitsuba: setup
	@[ -x $(MITSUBA_PYTHON) ] || python3 -m venv build/venv-mitsuba
	@$(MITSUBA_PYTHON) -c 'import mitsuba, numpy' 2>/dev/null || \
	    $(MITSUBA_PYTHON) -m pip install -q $(MITSUBA) numpy
	@$(HAS_LLVM) || ! command -v apt-get >/dev/null 2>&1 || { \
	    if [ "$$(id -u)" = 0 ]; then as=; else as=sudo; fi; \
	    $$as apt-get update -qq && $$as apt-get install -y -qq \
	        --no-install-recommends libllvm19 >/dev/null; }

.PHONY: peer-mitsuba-render
peer-mitsuba-render: all mitsuba ## data/scenes/ here and by Mitsuba 3: the same pictures? (Python, mitsuba from PyPI)
	python3 tests/peer_render.py $(BIN)/bsdf-render $(MITSUBA_PYTHON) build/peer-render $(ONLY)

.PHONY: course
course: all ## the course's scenes against pictures that others made (BSDF_SHARED=../shared)
	sh tests/course.sh $(BIN) $${BSDF_SHARED:-../shared} build/course

# -- order --------------------------------------------------------------------

C_FILES = $(SOURCES) $(HEADERS) $(TESTS:%=tests/%.c) $(LONG) $(HELPERS) \
          data/scenes/knot.c
# What other programs include or compile by themselves, and so not linted here.
ALONE   = $(wildcard validate/adapters/*.hpp tests/plugins/*.c tests/plugins/*.cpp)

# Off where it is wrong about C: widths of products that are small, arrays of
# pointers, OpenMP's clauses; or a matter of taste.
TIDY := bugprone-*,clang-analyzer-*,$\
        -bugprone-easily-swappable-parameters,$\
        -bugprone-implicit-widening-of-multiplication-result,$\
        -bugprone-narrowing-conversions,$\
        -bugprone-sizeof-expression,$\
        -clang-analyzer-deadcode.DeadStores,$\
        -clang-analyzer-security.FloatLoopCounter,$\
        -clang-analyzer-security.insecureAPI.DeprecatedOrUnsafeBufferHandling,$\
        -clang-analyzer-security.insecureAPI.strcpy

.PHONY: format check-format check-layers lint clean help
format: ## lay the sources out
	clang-format -i $(C_FILES) $(ALONE)

check-format: ## fail where `make format` would change something
	@$(call install_tool,clang-format,clang-format)
	clang-format --dry-run --Werror $(C_FILES) $(ALONE)

check-layers: ## fail where an include goes against the order of the folders
	@sh tests/layers.sh

lint: ## everything compiled by gcc and clang, warnings as errors; layers; clang-tidy
	@$(call install_tool,clang,clang libomp-dev)
	@$(call install_tool,clang-tidy,clang-tidy)
	@for cc in gcc clang; do \
	    for f in $(C_FILES); do \
	        printf '#include "%s"\n' $$f | \
	            $$cc $(LANGUAGE) $(WARN) -O2 -Werror -fsyntax-only -x c - || exit 1; \
	    done; \
	    echo "$$cc: no warning in $(words $(C_FILES)) files"; \
	done
	@sh tests/layers.sh
	@for f in $(SOURCES); do \
	    clang-tidy --quiet --warnings-as-errors='*' --checks='-*,$(TIDY)' $$f -- \
	        $(LANGUAGE) 2>/dev/null || exit 1; \
	done; echo "clang-tidy: nothing found in $(words $(SOURCES)) files"

# A tool that only developers need: $(1) the command, $(2) Debian's packages.
define install_tool
command -v $(1) >/dev/null 2>&1 || { \
    command -v apt-get >/dev/null 2>&1 || { echo "missing: $(2)" >&2; exit 2; }; \
    if [ "$$(id -u)" = 0 ]; then as=; else as=sudo; fi; \
    $$as apt-get update -qq && $$as apt-get install -y -qq --no-install-recommends \
        $(2) >/dev/null; }
endef

clean: ## remove build/
	rm -rf build

help: ## this list
	@sed -n 's/^\([a-z][a-z-]*\):[^#]*## \(.*\)/make \1\t\2/p' $(firstword $(MAKEFILE_LIST)) | \
	    sort | while IFS='	' read -r target about; do \
	        printf '%-18s %s\n' "$$target" "$$about"; done
