/* mutant_table.c - the mistakes that renderers made, and some that they may
 *
 * The numbers are those of bugs that were found in public renderers; the column
 * `seen` has the commit or the thread of each.  Behind them are mistakes that a
 * diagnosis should be able to name.
 */
#include "tests/mutant_table.h"

#include <stdio.h>
#include <string.h>

#define METAL .type = &type_broken_metal
#define GLASS .type = &type_broken_glass
#define MIX .type = &type_broken_mix
#define COAT .type = &type_broken_coat
#define SHARE .way = MUTANT_SHARE, .original = 1
#define FACTOR .way = MUTANT_FACTOR, .original
#define FIXED .way = MUTANT_FIXED, .original
#define FROM(...) .theta_deg = { __VA_ARGS__ }

const struct mutant mutants[] = {
    { "1", "refraction_jacobian", "pbrt-v4 dfa11074", GLASS, "fault=jacobian",
      SHARE, FROM(50), .caught_by = "pdf chi2" },
    { "1", "back_facing", "pbrt-v4 dfa11074", GLASS, "fault=back_facing", SHARE,
      FROM(75), .caught_by = "pdf chi2 energy" },
    { "2", "pdf_without_sides", "mitsuba3 0a7a0410a", GLASS, "fault=no_sides",
      SHARE, FROM(75), .caught_by = "pdf chi2" },
    { "3", "same_side", "pbrt-v3 #228", GLASS, "fault=same_side", SHARE,
      FROM(50), .caught_by = "energy reciprocity" },
    { "4", "unoriented_fresnel", "pbrt-v3 478b2e6", GLASS, "fault=unoriented",
      SHARE, FROM(140), .caught_by = "reciprocity",
      .diagnosis = "Fresnel at the wrong angle" },
    { "5", "g1_of_wo_twice", "pbrt-v3 a8c3616", METAL, "fault=masking_twice",
      SHARE, FROM(50), .caught_by = "reciprocity",
      .diagnosis = "doubled masking" },
    { "6", "other_alpha_sampled", "pbrt-v3 277d749", METAL,
      "fault=sampled_alpha", FACTOR = 1.3, FROM(20), .caught_by = "pdf chi2",
      .diagnosis = "another alpha" },
    { "6", "no_cos_h", "pbrt-v3 277d749", METAL, "fault=no_cos_h", SHARE,
      FROM(20), .caught_by = "pdf chi2", .diagnosis = "cos_h" },
    { "7", "default_pdf", "pbrt-v3 d318197", .type = &type_broken_wrapper,
      "fault=default_pdf", SHARE, FROM(50), .caught_by = "sample chi2" },
    { "8", "swapped_directions", "pbrt-v4 #215", GLASS, "fault=swapped", SHARE,
      FROM(50), .caught_by = "pdf chi2 energy reciprocity",
      .diagnosis = "swapped directions" },
    { "9", "wrong_variable_tested", "pbrt-v4 #214", MIX,
      "fault=wrong_tested,a=(roughdielectric:lobes=transmission,alpha=0.3),"
      "b=(diffuse)",
      SHARE, FROM(50), .caught_by = "pdf chi2" },
    { "10", "signed_cosine", "pbrt-v4 7ad70fe7, mitsuba 5b413228",
      .type = &type_broken_pane, "fault=signed", SHARE, FROM(140),
      .caught_by = "pdf delta" },
    { "11", "cosine_ratio", "mitsuba 9b225443, tungsten eec36db", COAT,
      "fault=cosine_ratio", SHARE, FROM(50), .caught_by = "reciprocity" },
    { "12", "coat_jacobian", "tungsten 2d95bdd", COAT, "fault=jacobian", SHARE,
      FROM(50), .caught_by = "pdf chi2", .diagnosis = "eta^2" },
    { "12", "coat_jacobian_rough", "tungsten 2d95bdd", COAT,
      "fault=jacobian,base=(roughconductor:alpha=0.2)", SHARE, FROM(50),
      .caught_by = "pdf chi2", .diagnosis = "eta^2" },
    { "13", "no_one_over_pi", "tungsten 83e8316", .type = &type_broken_diffuse,
      "fault=no_pi", SHARE, FROM(50), .caught_by = "energy",
      .diagnosis = "factor pi" },
    { "14", "pdf_below", "tungsten d008dc6", METAL, "fault=pdf_below", SHARE,
      FROM(20), .caught_by = "support pdf chi2",
      .diagnosis = "mass below the horizon" },
    { "14", "f_below", "tungsten d008dc6", METAL, "fault=f_below,alpha=0.1",
      SHARE, FROM(60), .caught_by = "support energy",
      .diagnosis = "mass below the horizon" },
    { "15", "remapped_beyond_1", "mitsuba3 cebf9862e", MIX,
      "fault=remap,tint=0.3", SHARE, FROM(50), .caught_by = "finite" },
    { "15", "remapped_short_of_1", "mitsuba3 cebf9862e", MIX,
      "fault=remap,tint=0.7", SHARE, FROM(50), .caught_by = "chi2" },
    { "16", "one_lobe", "mitsuba3 ae5e05bab", MIX, "fault=one_lobe", SHARE,
      FROM(50), .caught_by = "sample", .diagnosis = "one lobe's pdf only" },
    { "17", "f_without_weight", "mitsuba3 fe1578215", MIX, "fault=no_weight",
      SHARE, FROM(50), .caught_by = "sample",
      .diagnosis = "missing lobe probability" },
    { "18", "max_f_against_max_1_f", "OSL PR #2158", MIX,
      "fault=max_and_min,tint=0.8/0.5/0.2", SHARE, FROM(50),
      .caught_by = "chi2" },
    { "19", "other_lobe_weights", "three-gpu-pathtracer #847", MIX,
      "fault=other_share", SHARE, FROM(50), .caught_by = "chi2" },
    { "20", "transmission_without_1_f", "GLSL-PathTracer #24", GLASS,
      "fault=no_share", SHARE, FROM(50), .caught_by = "pdf chi2",
      .diagnosis = "missing lobe probability" },
    { "20", "coat_without_1_f", "GLSL-PathTracer #24", COAT, "fault=no_share",
      SHARE, FROM(50), .caught_by = "pdf",
      .diagnosis = "missing lobe probability" },
    { "21", "g1_is_0_below", "openpbr-bsdf #15", GLASS, "fault=g1_below", SHARE,
      FROM(50), .caught_by = "lobes" },
    { "22", "selection_squared", "openpbr-bsdf #19", MIX, "fault=squared",
      SHARE, FROM(50), .sound = "drawn otherwise, and the pdf says so" },
    { "23", "albedo_divided_out_twice", "mitsuba 641f0a96", COAT,
      "fault=albedo_twice", SHARE, FROM(50), .caught_by = "sample" },
    { "24", "one_less_reflectance", "mitsuba3 62a0295e8",
      .type = &type_broken_pane, "fault=complement", SHARE, FROM(50),
      .blind =
          "an albedo of 1, reciprocal, drawn as it says: another pane than "
          "was meant" },
    { "25", "table_pdf_off_by_one", "mitsuba3 396cd83df",
      .type = &type_broken_table, "fault=pdf_off", SHARE, FROM(50),
      .caught_by = "pdf chi2" },
    { "25", "table_f_off_by_one", "mitsuba3 396cd83df",
      .type = &type_broken_table, "fault=f_off", SHARE, FROM(50),
      .caught_by = "reciprocity" },
    { "25", "table_f_off_both_ways", "mitsuba3 396cd83df",
      .type = &type_broken_table, "fault=f_both_off", SHARE, FROM(50),
      .blind = "the same function of both directions, of an albedo below 1: "
               "another surface than was meant" },
    { "26", "alpha_0", "pbrt-v4 8e128c18", METAL, "fault=zero_alpha", FIXED = 1,
      FROM(50), .caught_by = "finite" },
    { "26", "wo_z_0", "pbrt-v3 4637058", METAL, "fault=grazing_wo", FIXED = 1,
      FROM(50), .caught_by = "finite" },
    { "26", "underflow", "pbrt-v3 4637058", METAL, "fault=underflow,alpha=0.05",
      FIXED = 1, FROM(50), .caught_by = "finite" },
    { "26", "u_rounded_to_1", "mitsuba3 6e783edb9", METAL, "fault=float_u",
      FIXED = 1, FROM(50), .caught_by = "finite" },
    { "27", "furnace_of_a_half", "appleseed #1308", METAL, "fault=d_factor",
      FACTOR = 0.5, FROM(50), .caught_by = "furnace", .diagnosis = "factor 2" },
    { "28", "lambda_with_pi", "CS184 project 3-2", METAL,
      "fault=lambda_pi,alpha=0.5", SHARE, FROM(85),
      .caught_by = "energy furnace" },
    { "28", "fresnel_at_the_normal", "CS184 project 3-2", METAL,
      "fault=fresnel_normal,r0=0.5", SHARE, FROM(50),
      .caught_by = "reciprocity", .diagnosis = "Fresnel at the wrong angle" },

    { "-", "pdf_times_2", "", METAL, "fault=pdf_factor", FACTOR = 2, FROM(20),
      .caught_by = "pdf chi2", .diagnosis = "factor 2" },
    { "-", "pdf_over_4", "", METAL, "fault=pdf_factor", FACTOR = 0.25, FROM(20),
      .caught_by = "pdf chi2", .diagnosis = "factor 4" },
    { "-", "pdf_over_pi", "", METAL, "fault=pdf_factor",
      FACTOR = 0.31830988618379067, FROM(20), .caught_by = "pdf chi2",
      .diagnosis = "factor pi" },
    { "-", "f_times_4", "", METAL, "fault=f_factor", FACTOR = 4, FROM(20),
      .caught_by = "energy", .diagnosis = "factor 4" },
    { "-", "f_over_2", "", METAL, "fault=f_factor", FACTOR = 0.5, FROM(20),
      .blind = "a rough mirror that absorbs half" },
    { "-", "pdf_without_jacobian", "", METAL, "fault=no_jacobian", SHARE,
      FROM(20), .caught_by = "pdf chi2", .diagnosis = "4 wi.h" },
    { "-", "weight_without_cos_i", "", METAL, "fault=no_cosine", SHARE,
      FROM(50), .caught_by = "sample", .diagnosis = "cos_i" },
    { "-", "f_with_cos_i", "", METAL, "fault=f_cos_i", SHARE, FROM(50),
      .caught_by = "reciprocity", .diagnosis = "cos_i" },
    { "-", "f_without_cos_o", "", METAL, "fault=no_cos_o", SHARE, FROM(50),
      .caught_by = "reciprocity", .diagnosis = "cos_o" },
    { "-", "f_without_masking", "", METAL, "fault=no_masking", SHARE, FROM(80),
      .caught_by = "energy", .diagnosis = "missing masking" },
    { "-", "f_with_g_squared", "", METAL, "fault=g_squared", SHARE, FROM(80),
      .blind = "reciprocal, and loses more: another surface with more "
               "masking" },
    { "-", "pdf_without_masking", "", METAL,
      "fault=pdf_no_masking,visible=true", SHARE, FROM(80),
      .caught_by = "pdf chi2", .diagnosis = "missing masking" },
    { "-", "pdf_with_masking_twice", "", METAL,
      "fault=pdf_masking,visible=true", SHARE, FROM(80),
      .caught_by = "pdf chi2", .diagnosis = "doubled masking" },
    { "-", "alpha_squared_sampled", "", METAL, "fault=sampled_alpha",
      FACTOR = 0.3, FROM(20), .caught_by = "chi2",
      .diagnosis = "alpha against alpha^2" },
    { "-", "swapped_alphas", "", METAL, "fault=swapped_alphas,alpha_v=0.15",
      SHARE, FROM(20), .caught_by = "chi2",
      .diagnosis = "swapped alpha_u and alpha_v" },
    { "-", "glass_without_eta_2", "", GLASS, "fault=no_square", SHARE, FROM(50),
      .caught_by = "energy reciprocity", .diagnosis = "eta^2" },
    { "-", "mixture_pdf_without_weight", "", MIX, "fault=pdf_no_weight", SHARE,
      FROM(50), .caught_by = "pdf chi2",
      .diagnosis = "missing lobe probability" },
    { "-", "good_samples_refused", "", METAL, "fault=refuses", .original = 0.1,
      FROM(20), .caught_by = "pdf chi2" },
    { "-", "samples_leaked", "", METAL, "fault=leaks,alpha=0.05",
      .original = 0.1, FROM(10), .caught_by = "chi2" },
    { "-", "half_never_sampled", "", METAL, "fault=half", SHARE, FROM(20),
      .caught_by = "energy" },
    { "-", "weight_times_2", "", METAL, "fault=weight_factor", FACTOR = 2,
      FROM(50), .caught_by = "sample", .diagnosis = "factor 2" },
    { "-", "pdf_of_the_sample_times_2", "", METAL, "fault=sample_pdf",
      FACTOR = 2, FROM(50), .caught_by = "sample", .diagnosis = "factor 2" },
    { "-", "nan_near_the_horizon", "", METAL, "fault=nan_f", .original = 1e-3,
      FROM(50), .caught_by = "finite" },
    { "-", "rare_nan_weight", "", METAL, "fault=rare_nan", .original = 1e-3,
      FROM(20), .caught_by = "finite" },
    { "-", "negative_pdf", "", METAL, "fault=negative_pdf", .original = 1e-3,
      FROM(50), .caught_by = "finite" },
    { "-", "long_wi", "", METAL, "fault=long_wi", .original = 1e-3, FROM(50),
      .caught_by = "finite" },
    { "-", "sampler_with_a_memory", "", METAL, "fault=forgetful", FIXED = 1,
      FROM(20), .caught_by = "finite" },
    { "-", "g1_shown_is_off", "", METAL, "fault=g1_factor", FACTOR = 1.1,
      FROM(50), .caught_by = "furnace" },
    { "-", "mirror_tilted", "", .type = &type_broken_mirror, "fault=tilted",
      .original = 0.1, FROM(50), .caught_by = "delta" },
    { "-", "mirror_drawn_too_rarely", "", .type = &type_broken_mirror,
      "fault=rare", FACTOR = 0.5, FROM(50), .caught_by = "pdf delta" },
    { 0 },
};

#define CONTROL(what, ...)                                                     \
    "0", what, "", __VA_ARGS__, FIXED = 1, .sound = "nothing is wrong with it"
const struct mutant mutant_controls[] = {
    { CONTROL("metal", METAL, "fault=none"), FROM(50, 80) },
    { CONTROL("metal_visible", METAL, "fault=none,visible=true"),
      FROM(20, 80) },
    { CONTROL("metal_narrow", METAL, "fault=none,alpha=0.05"), FROM(10, 50) },
    { CONTROL("metal_two_alphas", METAL, "fault=none,alpha_v=0.15"), FROM(20) },
    { CONTROL("metal_rough", METAL, "fault=none,alpha=0.5"), FROM(85) },
    { CONTROL("metal_schlick", METAL, "fault=none,r0=0.5"), FROM(50) },
    { CONTROL("diffuse", .type = &type_broken_diffuse, "fault=none"),
      FROM(50) },
    { CONTROL("mirror", .type = &type_broken_mirror, "fault=none"), FROM(50) },
    { CONTROL("glass", GLASS, "fault=none"), FROM(50, 140) },
    { CONTROL("glass_grazing", GLASS, "fault=none"), FROM(75) },
    { CONTROL("pane", .type = &type_broken_pane, "fault=none"), FROM(50, 140) },
    { CONTROL("mix", MIX, "fault=none"), FROM(50) },
    { CONTROL("mix_tints", MIX, "fault=none,tint=0.8/0.5/0.2"), FROM(50) },
    { CONTROL("mix_by_first", MIX,
              "fault=by_first,tint=0.3,b=(roughconductor:alpha=0.01)"),
      FROM(10, 50) },
    { CONTROL("mix_transmits", MIX,
              "fault=none,a=(roughdielectric:lobes=transmission,alpha=0.3),"
              "b=(diffuse)"),
      FROM(50) },
    { CONTROL("coat", COAT, "fault=none"), FROM(50, 80) },
    { CONTROL("coat_rough", COAT, "fault=none,base=(roughconductor:alpha=0.2)"),
      FROM(50, 80) },
    { CONTROL("wrapper", .type = &type_broken_wrapper, "fault=none"),
      FROM(50) },
    { CONTROL("table", .type = &type_broken_table, "fault=none"),
      FROM(50, 80) },
    { CONTROL("table_steps", .type = &type_broken_table,
              "fault=none,steps=true"),
      FROM(50, 80) },
    { 0 },
};

double mutant_size(const struct mutant *m, double scale)
{
    return m->way == MUTANT_SHARE    ? m->original * scale
           : m->way == MUTANT_FACTOR ? 1 + (m->original - 1) * scale
                                     : m->original;
}

void mutant_settings(const struct mutant *m, double scale, char *text,
                     size_t size)
{
    if (m->way == MUTANT_FIXED)
        snprintf(text, size, "%s", m->settings);
    else
        snprintf(text, size, "%s,size=%.17g", m->settings,
                 mutant_size(m, scale));
}

static void found_add(struct mutant_found *found, const struct verdict *v,
                      int check)
{
    if (!v->applies)
        return;
    found->applied |= 1u << check;
    if (v->passed)
        return;
    if (found->failed == 0)
        snprintf(found->note, sizeof found->note, "%s", v->note);
    if (found->diagnosis[0] == '\0')
        snprintf(found->diagnosis, sizeof found->diagnosis, "%s", v->diagnosis);
    found->failed |= 1u << check;
}

bool mutant_run(const struct mutant *m, double scale, const struct plan *plan,
                struct mutant_found *found, struct err *err)
{
    char settings[256];
    struct run run;
    struct vec3 wo[2];
    size_t wos = 0;
    *found = (struct mutant_found){ 0 };
    mutant_settings(m, scale, settings, sizeof settings);
    struct bsdf *b = bsdf_new_of(m->type, settings, &bands_default, err);
    if (!b)
        return false;
    for (int i = 0; i < 2; i++)
        if (m->theta_deg[i] > 0)
            wo[wos++] = dir_from_degrees(m->theta_deg[i], 40);
    const bool ok = run_checks(&run, plan, (const struct bsdf *const *)&b, 1,
                               wo, wos, NULL, NULL, err);
    for (size_t i = 0; ok && i < run.results; i++)
        for (int c = 0; c < checks_count(); c++)
            found_add(found, &run.result[i].verdict[c], c);
    if (ok)
        run_clear(&run);
    bsdf_free(b);
    return ok;
}

void mutant_names(unsigned set, char *names, size_t size)
{
    size_t used = 0;
    names[0] = '\0';
    for (int c = 0; c < checks_count() && used < size; c++)
        if (set & 1u << c)
            used += (size_t)snprintf(names + used, size - used, "%s%s",
                                     used ? " " : "", checks[c]->name);
}

bool mutant_has_all(unsigned set, const char *names)
{
    for (const char *at = names; *at;) {
        const size_t length = strcspn(at, " ");
        bool has = false;
        for (int c = 0; c < checks_count(); c++)
            has |= (set & 1u << c) && strlen(checks[c]->name) == length &&
                   strncmp(checks[c]->name, at, length) == 0;
        if (!has)
            return false;
        at += length;
        at += strspn(at, " ");
    }
    return true;
}
