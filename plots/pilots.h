/* pilots.h - a few draws that say where a model sends light */
#ifndef PLOTS_PILOTS_H
#define PLOTS_PILOTS_H

#include "validate/subject.h"

enum { PILOTS_MAX = 4096 };

struct pilots {
    struct vec3 wi[PILOTS_MAX]; /* with a density, as they were drawn */
    size_t n;
    struct delta delta[DELTAS_MAX]; /* and the single ones, by rising theta */
    int deltas;
};

void pilots_draw(struct pilots *p, const struct bsdf *b, struct vec3 wo,
                 uint64_t seed);

/** Says "δ at θᵢ = 45°: probability 1, weight 0.2, 0.5, 0.8". */
void delta_text(const struct delta *d, int bands, double theta_deg, char *text,
                size_t size);

#endif
