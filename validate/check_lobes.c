/* check_lobes.c - what a model claims to do, it does
 *
 * Every lobe that is claimed carries energy: reflection and transmission, each
 * as a delta and spread out, is drawn with a weight above 0 from wo or from one
 * of eight other directions.  value counts the kinds that never are.
 */
#include "validate/checks.h"

#include <stdio.h>

enum { KINDS = 4, DRAWS = SUBJECT_BATCH };

static const struct {
    const char *name;
    unsigned lobes;
} kind[KINDS] = {
    { "spread reflection", BSDF_DIFFUSE_REFLECTION | BSDF_GLOSSY_REFLECTION },
    { "spread transmission",
      BSDF_DIFFUSE_TRANSMISSION | BSDF_GLOSSY_TRANSMISSION },
    { "delta reflection", BSDF_DELTA_REFLECTION },
    { "delta transmission", BSDF_DELTA_TRANSMISSION },
};

static int kind_of(const struct bsdf_sample *a, struct vec3 wo)
{
    return (a->delta ? 2 : 0) + (a->wi.z * wo.z < 0);
}

/* Counts by kind the samples that carry something. */
static void look(const struct subject *s, uint64_t seen[KINDS])
{
    struct bsdf_sample sample[DRAWS];
    subject_draw(s, subject_rng(s, STREAM_LOBES), 0, DRAWS, sample);
    for (size_t i = 0; i < DRAWS; i++) {
        bool carries = false;
        for (int b = 0; b < BANDS_MAX; b++)
            carries |= sample[i].weight.band[b] > 0;
        seen[kind_of(&sample[i], s->wo)] += carries;
    }
}

static bool all_seen(unsigned lobes, const uint64_t seen[KINDS])
{
    for (int k = 0; k < KINDS; k++)
        if ((lobes & kind[k].lobes) && seen[k] == 0)
            return false;
    return true;
}

static void run(const struct subject *s, struct verdict *v)
{
    static const double theta_deg[] = { 30, 150, 3, 177, 60, 120, 85, 95 };
    uint64_t seen[KINDS] = { 0 };
    look(s, seen);
    for (int i = 0; i < 8 && !all_seen(s->claims.lobes, seen); i++)
        if (theta_deg[i] < 90 || s->claims.two_sided) {
            const struct subject other = subject_plain(
                s->bsdf, dir_from_degrees(theta_deg[i], 40), s->plan);
            look(&other, seen);
        }
    v->unit = "kinds";
    v->limit = 0;
    for (int k = 0; k < KINDS; k++)
        if ((s->claims.lobes & kind[k].lobes) && seen[k] == 0) {
            v->value += 1;
            verdict_add(v, "%s%s is claimed, but never drawn",
                        v->note[0] ? "; " : "", kind[k].name);
        }
    if (s->claims.lobes == 0) {
        v->applies = false;
        verdict_note(v, "no lobe is claimed");
    } else if (v->value == 0)
        verdict_note(v, "all that are claimed carry energy");
}

const struct check check_lobes = {
    .name = "lobes",
    .about = "every lobe that is claimed carries energy",
    .run = run,
};
