/* surface.h - f |cos theta_i| over all directions, as a mesh
 *
 *   mean     f |cos theta_i| [1/sr] in a direction wi, one number for all
 * bands: the luminance of R, G, B, or the mean of wavelengths radius   of the
 * surface there: the mean, or with logarithms top (1 + log10(mean / top) /
 * SURFACE_DECADES), at least 0
 *
 * Each side of the surface has a mesh in theta_i and phi_i.  Its lines start
 * from a coarse grid and from angles ever closer to the peak, which pilot
 * directions find however narrow it is.  Intervals are halved until the chords
 * between neighbours are as good as the surface, everywhere along a line; then
 * lines that no chord needs are left out.
 */
#ifndef PLOTS_SURFACE_H
#define PLOTS_SURFACE_H

#include "plots/pilots.h"

enum { SURFACE_LINES_MAX = 512, SURFACE_DECADES = 6 };

struct surface_lines {
    double deg[SURFACE_LINES_MAX];
    size_t n;
};

struct surface_peak {
    double theta_deg, phi_deg; /* phi from that of the mirror direction */
    double mean;               /* f |cos|, of the bands */
};

struct surface_side {
    double from_deg, to_deg; /* of theta */
    struct surface_peak peak;
    struct surface_lines theta, phi;
};

struct surface {
    const struct bsdf *bsdf;
    struct vec3 wo;
    double mirror_phi_deg;
    struct surface_side side[2]; /* above and below */
    struct pilots pilots;
    double top; /* of logarithms: a power of ten at or above all; else 0 */
    size_t odd; /* directions where a value is not a finite number */
};

/** Finds the peaks and lays the meshes; the model is borrowed. */
void surface_make(struct surface *s, const struct bsdf *b, struct vec3 wo,
                  bool log, uint64_t seed);

/** Whether there is light on a side. */
bool surface_present(const struct surface_side *side);

/** A direction from theta and from phi about the mirror direction. */
struct vec3 surface_direction(const struct surface *s, double theta_deg,
                              double phi_deg);

/** f |cos| in each band, 0 where it is not a finite number; the mean and the
 * radius; and the largest radius. */
struct spectrum surface_value(const struct surface *s, struct vec3 wi);
double surface_mean(const struct surface *s, struct vec3 wi);
double surface_radius(const struct surface *s, struct vec3 wi);
double surface_largest(const struct surface *s);

#endif
