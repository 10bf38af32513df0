# writeup.mk - renders, draws and measures all that writeup.txt tells of
#
# Run by `make writeup`.  What is made lies in OUT: for each job NAME a script
# NAME.sh that runs in that folder with the programs on PATH, what it makes, and
# NAME.done.  A script is written again only when its commands change, and a job
# is done again only when its script, a program, a scene or a job that it builds
# on has changed; one that was interrupted has no NAME.done.

MAKEFLAGS += --no-builtin-rules
.DELETE_ON_ERROR:
.SUFFIXES:
.SECONDARY:

ROOT    ?= .
BIN     ?= build/bin
DATA    := $(abspath $(BIN)/..)
QUALITY ?= draft
OUT     ?= $(DATA)/writeup/$(QUALITY)$(if $(COURSE_SCENES),-course)
HERE    := $(ROOT)/plots/writeup

# Pixels; samples a pixel of the spheres, of the roughnesses, of copper and of
# calcium; of adaptive sampling at most, a batch, and the tolerance; of a
# validation; of a plot.
ifeq ($(QUALITY),draft)
W := 240
H := 180
SPP := 32 32 64
ADAPTIVE := 64 16 0.2
SAMPLES := 1e6 1e6
else ifeq ($(QUALITY),final)
W := 480
H := 360
SPP := 256 128 64
ADAPTIVE := 256 64 0.05
SAMPLES := 1e6 1e6
else ifeq ($(QUALITY),test)
W := 60
H := 45
SPP := 2 2 2
ADAPTIVE := 4 2 0.5
SAMPLES := 2e4 2e4
else
$(error QUALITY=$(QUALITY): expected draft or final)
endif
spp      = $(word $(1),$(SPP))

ifneq ($(COURSE_SCENES),)
ifneq ($(words $(wildcard $(patsubst %,$(COURSE_SCENES)/CB%,spheres.dae \
  bunny_microfacet_cu.dae dragon_microfacet_au.dae.xz))),3)
$(error COURSE_SCENES=$(COURSE_SCENES): expected a folder with CBspheres.dae, \
  CBbunny_microfacet_cu.dae and CBdragon_microfacet_au.dae.xz)
endif
endif

all: $(OUT)/writeup.html $(OUT)/writeup.tex $(OUT)/writeup.pdf.done
	@echo $(patsubst $(CURDIR)/%,%,$(OUT))/writeup.html

# -- scenes -------------------------------------------------------------------
# Where things are in the pictures: shares of width and height, from the upper
# left corner: x, y, width, height.

ALPHAS := 0.005 0.05 0.25 0.5
NM     := 614,549,466
FIXED  := --rgb fixed:$(NM)

ifeq ($(COURSE_SCENES),)
SPHERES   := spheres.xml
VIEW      := -r $(W) $(H)
REGIONS   := wall   .250 .680 .042 .083  glass .635 .694 .083 .139 \
             image  .3835 .714 .023 .031  spot  .700 .930 .052 .022 \
             roof   .313 .600 .031 .022
MESH_PART := .31 .34 .42 .58
CROP      := .33 .55 .25 .25
CROP_VIEW  = -r $(W) $(H) -p $(call pixels,$(CROP))
gold       = mesh.xml -D material=Au -D alpha=$(1) $(FIXED)
copper     = mesh.xml -D material=Cu -D alpha=0.05 $(FIXED)
calcium    = mesh.xml -D material=Ca -D alpha=0.1 --rgb $(1)
MESH_FILES := mesh.xml knot.ply
MESHES := mesh.xml
GOLDEN := The knot
COPPERY := The knot
COPPER_ALPHA := 0.05
CALCIUM_ALPHA := 0.1
else
SPHERES   := CBspheres.dae
# The course's camera sees so much at 800 x 600; of that, the middle.
VIEW      := -r $(shell expr $(W) \* 5 / 3) $(shell expr $(H) \* 5 / 3) \
             -p $(shell expr $(W) / 3) $(shell expr $(H) / 3) $(W) $(H)
REGIONS   := wall   .271 .667 .042 .083  glass .620 .694 .083 .125 \
             image  .396 .711 .025 .033  spot  .646 .897 .073 .022 \
             roof   .330 .589 .030 .020
MESH_PART := .25 .30 .50 .62
CROP      := .33 .55 .25 .25
crop      := $(shell echo $(W) $(H) $(CROP) | awk '{ printf "%d %d %d %d", \
               $$1 / 3 + $$1 * $$3, $$2 / 3 + $$2 * $$4, $$1 * $$5, $$2 * $$6 }')
CROP_VIEW  = -r $(wordlist 2,3,$(VIEW)) -p $(crop)
gold       = dragon-$(1).dae
copper     = CBbunny_microfacet_cu.dae
calcium    = bunny-$(firstword $(subst :, ,$(1))).dae
MESH_FILES := $(ALPHAS:%=dragon-%.dae) CBbunny_microfacet_cu.dae \
              bunny-fixed.dae bunny-fit.dae
MESHES := CBdragon and CBbunny
GOLDEN := The dragon
COPPERY := The bunny
COPPER_ALPHA := 0.05
CALCIUM_ALPHA := 0.05
endif
# A part in shares to the pixels of -p.
pixels = $(shell echo $(W) $(H) $(1) | awk '{ printf "%d %d %d %d", $$1 * $$3, \
           $$2 * $$4, $$1 * $$5 < 1 ? 1 : $$1 * $$5, $$2 * $$6 < 1 ? 1 : $$2 * $$6 }')

# -- jobs ---------------------------------------------------------------------

JOBS_ALL :=
.PHONY: all always

# $(1) its name, $(2) what it does, for people, $(3) what it needs in OUT, $(4)
# its commands.
define job
JOBS_ALL += $(1)
NUMBER_$(1) := $$(words $$(JOBS_ALL))
define TEXT_$(1)
#!/bin/sh
# $(1): $(2).
# It runs in its own folder, with the programs of the project on PATH.
set -e
cd "$$$$(dirname "$$$$0")"
$(4)
endef
$(OUT)/$(1).sh: export TEXT = $$(TEXT_$(1))
$(OUT)/$(1).done: $(OUT)/$(1).sh $(3:%=$(OUT)/%)
$(OUT)/$(1).done: ABOUT = $(2)
endef

$(OUT)/%.sh: always
	@mkdir -p $(@D)/tex
	@printf '%s\n' "$$TEXT" >$@.new
	@if cmp -s $@.new $@; then rm $@.new; else mv $@.new $@; fi

$(OUT)/%.done:
	@echo "[$(NUMBER_$*)/$(words $(JOBS_ALL))] $(ABOUT)"
	@rm -f $@
	@PATH="$(abspath $(BIN)):$$PATH" sh $(OUT)/$*.sh >$(OUT)/$*.log 2>&1 || \
	    { cat $(OUT)/$*.log >&2; echo "$(OUT)/$*.sh failed" >&2; exit 2; }
	@touch $@

# A program by what is in it, since linking it again may change nothing; its
# tables go with it.
TABLES := $(shell find $(ROOT)/data/ior $(ROOT)/data/cie -type f)
$(OUT)/%.sum: $(BIN)/% $(TABLES)
	@mkdir -p $(@D)
	@cksum <$< >$@.new; cat $(TABLES) | cksum >>$@.new
	@if cmp -s $@.new $@; then rm $@.new; else mv $@.new $@; fi

# Scenes and texts lie beside the scripts.
copy = @mkdir -p $(@D); cmp -s $< $@ || cp $< $@
$(OUT)/%.xml: $(DATA)/scenes/%.xml
	$(copy)
$(OUT)/%.ply: $(DATA)/scenes/%.ply
	$(copy)
$(OUT)/%.awk: $(HERE)/%.awk
	$(copy)
$(OUT)/writeup.txt: $(HERE)/writeup.txt
	$(copy)
$(OUT)/CB%.dae: $(COURSE_SCENES)/CB%.dae
	$(copy)
# The dragon and the bunny with another alpha, or of another metal.
$(OUT)/dragon-%.dae: $(COURSE_SCENES)/CBdragon_microfacet_au.dae.xz
	@mkdir -p $(@D)
	@xz -dc $< | sed 's|<alpha>[^<]*</alpha>|<alpha>$*</alpha>|' >$@.new
	@mv $@.new $@
$(OUT)/bunny-fixed.dae: METHOD = 614, 549, 466 nm
$(OUT)/bunny-fit.dae: METHOD = R, G, B (fit)
$(OUT)/bunny-%.dae: $(COURSE_SCENES)/CBbunny_microfacet_cu.dae $(OUT)/bsdf-info.sum
	@$(BIN)/bsdf-info ior Ca --rgb all | awk -F '\t' -v method='$(METHOD)' \
	    '$$1 == method { print "s|<eta>[^<]*</eta>|<eta>" $$2, $$3, $$4 "</eta>|"; \
	       print "s|<k>[^<]*</k>|<k>" $$5, $$6, $$7 "</k>|" }' >$@.sed
	@sed -f $@.sed $< >$@.new && mv $@.new $@ && rm $@.sed

# -- renderings ---------------------------------------------------------------

MEASURED :=
# A picture and its numbers: name, about, scene's files, scene and settings.
define picture
$(eval $(call job,$(1),$(2),bsdf-render.sum $(3),bsdf-render $(4) -f $(1).exr -f $(1).png
bsdf-render --measure $(1).exr >$(1).tsv$(5)))
$(eval MEASURED += $(1))
endef
# Parts of it, to NAME-PART.tsv: pairs of a part's name and four shares.
define parts
$(if $(2),
bsdf-render --measure $(1).exr -p $(call pixels,$(wordlist 2,5,$(2))) >$(1)-$(word 1,$(2)).tsv$(call parts,$(1),$(wordlist 6,99,$(2)))$(eval PARTS += $(1)-$(word 1,$(2))))
endef
PARTS :=

# $(1) the bounces at most
$(foreach m,0 1 2 3 4 5,$(call picture,m$(m),the spheres by at most $(m) bounces,$(SPHERES),$(SPHERES) $(VIEW) -s $(call spp,1) -l 1 -m $(m) --seed $(m)))
$(call picture,m100,the spheres by at most 100 bounces,$(SPHERES),$(SPHERES) $(VIEW) -s $(call spp,1) -l 1 -m 100 --rr-depth 5 --seed 100)
$(foreach b,0 1 2 3 4 5,$(call picture,b$(b),the spheres by the light of bounce $(b) alone,$(SPHERES),$(SPHERES) $(VIEW) -s $(call spp,1) -l 1 -m $(b) --only-bounce $(b) --exposure 2 --seed 20$(b),$(call parts,b$(b),$(REGIONS))))
$(foreach m,5 100,$(call picture,a$(m),the spheres by at most $(m) bounces with adaptive sampling,$(SPHERES),$(SPHERES) $(VIEW) -s $(word 1,$(ADAPTIVE)) -a $(wordlist 2,3,$(ADAPTIVE)) -l 1 -m $(m) --rr-depth 5 --seed 30$(m)))

stem = $(subst .,,$(1:0.%=%))
$(foreach a,$(ALPHAS),$(call picture,au$(call stem,$(a)),gold of alpha $(a) lit as in the course,$(MESH_FILES),$(call gold,$(a)) $(VIEW) -s $(call spp,2) -l 1 -m 5 --direct light --seed 41,$(call parts,au$(call stem,$(a)),mesh $(MESH_PART))))
$(foreach a,$(ALPHAS),$(call picture,mis$(call stem,$(a)),gold of alpha $(a) lit by both ways of sampling,$(MESH_FILES),$(call gold,$(a)) $(VIEW) -s $(call spp,2) -l 1 -m 5 --seed 42,$(call parts,mis$(call stem,$(a)),mesh $(MESH_PART))))

COPPER  = $(copper) -s $(call spp,3) -l 1 -m 5 --direct light
$(call picture,cu-cosine,copper with cosine sampling,$(MESH_FILES),$(COPPER) $(VIEW) --sampling cosine --seed 51,$(call parts,cu-cosine,mesh $(MESH_PART)))
$(call picture,cu-importance,copper with importance sampling,$(MESH_FILES),$(COPPER) $(VIEW) --seed 52,$(call parts,cu-importance,mesh $(MESH_PART)))
$(call picture,crop-cosine,a part of the same with cosine sampling,$(MESH_FILES),$(COPPER) $(CROP_VIEW) --sampling cosine --seed 51)
$(call picture,crop-importance,a part of the same with importance sampling,$(MESH_FILES),$(COPPER) $(CROP_VIEW) --seed 52)
$(call picture,ca-fixed,calcium at three wavelengths,$(MESH_FILES),$(call calcium,fixed:$(NM)) -s $(call spp,3) $(VIEW) -l 1 -m 5 --seed 61)
$(call picture,ca-fit,calcium fitted to its colour,$(MESH_FILES),$(call calcium,fit) -s $(call spp,3) $(VIEW) -l 1 -m 5 --seed 61)

# Two pictures against each other, with a map of the differences.
define against
$(eval $(call job,$(1)-$(2),$(1) against $(2),bsdf-render.sum $(1).done $(2).done,bsdf-render --compare $(1).exr $(2).exr --numbers --map $(1)-$(2).png >$(1)-$(2).tsv || test $$$$? = 1))
$(eval MEASURED += $(1)-$(2))
endef
$(call against,m4,m5)
$(call against,m5,m100)
$(call against,m5,a5)
$(call against,cu-cosine,cu-importance)

# -- plots --------------------------------------------------------------------

# For the page and for TeX: name, about, arguments, what it needs.
define plot
$(eval $(call job,$(1),$(2),bsdf-plot.sum $(4),bsdf-plot $(3) --width 160 -o tex/$(1).tex
bsdf-plot $(3) -o $(1).svg))
endef
comma  := ,
ROUGH  := roughconductor:material=Au$(comma)alpha=0.25
COURSE := course_microfacet:material=Au$(comma)alpha=0.5
MENDED := $(COURSE)$(comma)lambda=exact$(comma)fresnel_at=half
AT     := --samples $(word 2,$(SAMPLES)) --nm $(NM)
$(call plot,facets,D and G1 and Lambda of Beckmann's facets,ndf '$(ROUGH)' $(AT))
$(call plot,fresnel,the Fresnel term of gold,fresnel 'conductor:material=Au' --nm $(NM))
$(call plot,variant,the course's variant against the mended one,compare '$(COURSE)' '$(MENDED)' --wo 75$(comma)0 $(AT))
$(call plot,sampled,samples of the mended variant against its pdf,histogram '$(MENDED)' --wo 60$(comma)0 $(AT))
$(call plot,sampled-course,samples of the course's variant against its pdf,histogram '$(COURSE)' --wo 60$(comma)0 $(AT))
$(call plot,calcium,n and k of calcium,ior Ca)
$(call plot,colours,colours of calcium by method,colour Ca)

# Verdicts, as text and as a report.
define verdicts
$(eval $(call job,$(1),$(2),bsdf-validate.sum,bsdf-validate $(3) --nm $(NM) --samples $(word 1,$(SAMPLES)) --json $(1).json >$(1).txt || test $$$$? = 1))
endef
WOS := --wo 0$(comma)0 --wo 30$(comma)0 --wo 60$(comma)0 --wo 85$(comma)0
$(call verdicts,course,the course's variant is validated,'$(COURSE)' $(WOS))
$(call verdicts,mended,the mended variant is validated,'$(MENDED)' $(WOS))
$(call verdicts,ours,the model of the pictures is validated,$(foreach a,$(ALPHAS),'roughconductor:material=Au$(comma)alpha=$(a)') $(WOS))

# -- numbers ------------------------------------------------------------------

define CONSTANTS
bsdf-info ior Ca --rgb all >constants.txt
bsdf-info ior --match 0.29294/0.28568/0.28733 2.7181/2.3479/1.8333 >match.txt
endef
$(eval $(call job,constants,the optical constants of calcium are looked up,bsdf-info.sum,$(CONSTANTS)))
$(eval $(call job,settings,what was set,,printf '%s\t%s\n' quality $(QUALITY) spheres $(SPHERES) meshes '$(MESHES)' golden '$(GOLDEN)' coppery '$(COPPERY)' width $(W) height $(H) spp $(call spp,1) spp_alpha $(call spp,2) spp_copper $(call spp,3) adaptive $(word 1,$(ADAPTIVE)) batch $(word 2,$(ADAPTIVE)) tolerance $(word 3,$(ADAPTIVE)) samples $(word 1,$(SAMPLES)) copper_alpha $(COPPER_ALPHA) calcium_alpha $(CALCIUM_ALPHA) course '$(COURSE)' mended '$(MENDED)' rough '$(ROUGH)' >settings.tsv))
$(eval $(call job,numbers,the numbers of the text,numbers.awk constants.done settings.done $(MEASURED:%=%.done),awk -f numbers.awk settings.tsv constants.txt match.txt $(addsuffix .tsv,$(MEASURED) $(PARTS))))

# Their curves.  numbers.awk writes NAME.points.
$(call plot,luminance,mean luminance by M,series luminance.points,numbers.done)
$(call plot,bounces,light by bounce in parts of the picture,series bounces.points --log,numbers.done)
$(call plot,noise,noise by alpha,series noise.points --log,numbers.done)

# -- the page -----------------------------------------------------------------

PAGE := $(JOBS_ALL:%=%.done) writeup.txt bsdf-plot.sum
$(OUT)/writeup.html $(OUT)/writeup.tex: $(PAGE:%=$(OUT)/%)
	@$(BIN)/bsdf-plot writeup $(OUT)/writeup.txt -o $@ >/dev/null

# Where there is a LaTeX the document is made as well; TeX wants a second look
# at nothing, as there are no references.
$(OUT)/writeup.pdf.done: $(OUT)/writeup.tex
	@if command -v pdflatex >/dev/null 2>&1; then \
	    cd $(OUT) && pdflatex -interaction=batchmode -halt-on-error writeup.tex \
	        >writeup.pdf.log 2>&1 || { tail -n 30 writeup.log; exit 2; }; \
	    echo "$(OUT)/writeup.pdf"; \
	else \
	    echo "without writeup.pdf, as there is no pdflatex (on Debian:" \
	        "texlive-latex-recommended texlive-pictures)"; \
	fi
	@touch $@
