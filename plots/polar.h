/* polar.h - traces as curves, about the point that scatters or in a panel
 *
 * Of a single trace there is a curve for each band, unless all are the same; of
 * several one each, the mean of the bands.  Trace i is block i of the table,
 * and the single directions come behind all of them.
 */
#ifndef PLOTS_POLAR_H
#define PLOTS_POLAR_H

#include "plots/chart.h"
#include "plots/trace.h"

enum { POLAR_TRACES_MAX = 8, POLAR_CURVES_MAX = 8 };

struct polar {
    const struct trace *trace;
    int traces;
    bool log;

    struct chart_curve curve[2][POLAR_CURVES_MAX]; /* of f and of f |cos| */
    int curves;
    double most[2]; /* of what is drawn */
};

/** What there is to draw of some traces, at least one. */
struct polar polar_of(const struct trace *trace, int traces, bool log);

/** Writes the blocks of the table. */
void polar_table(FILE *out, const struct polar *p);

/** The axis of f or of f |cos|. */
struct chart_axis polar_axis(const struct polar *p, bool cosine);

/** A half disk about (x, y) of the page, or a whole one where light may be
 * below the surface: so much of it to either side, above with its title, and
 * below. */
enum {
    POLAR_SIDE = 196,
    POLAR_ABOVE = 215,
    POLAR_BELOW = 34,
    POLAR_BACK = 196
};
void polar_disk(struct figure *fig, const struct polar *p, bool cosine,
                double x, double y);
bool polar_half(const struct polar *p);

/** The key: curves, wo, mirror direction and single directions; y is the middle
 * of its top row. */
int polar_key_rows(const struct polar *p);
void polar_key(struct figure *fig, const struct polar *p, double y);

#endif
