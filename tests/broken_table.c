/* broken_table.c - a model that looks its numbers up
 *
 *   f = t(cos_o) t(cos_i) / pi, t linear between the nodes of a table
 *   pdf = p(cos_i) / (2 pi), p like t cos at the nodes and linear between them,
 *         or constant where steps is set
 *
 * t <= 1 makes the albedo at most 1.  What is wrong is mixed in with a share of
 * size.
 */
#include "tests/broken.h"

enum { CELLS = 16 };

struct table {
    double size;
    int fault, steps;
    double t[CELLS + 1];
    double p[CELLS][2];      /* where a cell starts and ends */
    double below[CELLS + 1]; /* share of what is drawn */
};

/* In the pdf the next cell [25]; in f the next node, for wi alone; for both. */
enum { PDF_OFF = 1, F_OFF, F_BOTH_OFF };
static const char *const table_faults[] = { "none", "pdf_off", "f_off",
                                            "f_both_off", NULL };

static const struct bsdf_param table_params[] = {
    { "fault", BSDF_CHOICE, offsetof(struct table, fault), "none", 0, 0,
      table_faults, "what is wrong" },
    { "size", BSDF_NUMBER, offsetof(struct table, size), "1", 0, 1, NULL,
      "share of it" },
    { "steps", BSDF_FLAG, offsetof(struct table, steps), "false", 0, 0, NULL,
      "a pdf that jumps" },
    { 0 },
};

static bool table_init(void *state, const struct bands *bands, struct err *err)
{
    struct table *m = state;
    double sum = 0;
    (void)bands, (void)err;
    /* Any smooth numbers below 1. */
    for (int i = 0; i <= CELLS; i++)
        m->t[i] = 0.9 - 0.6 * pow(1 - (double)i / CELLS, 3);
    for (int i = 0; i < CELLS; i++) {
        m->p[i][0] = m->t[i] * i;
        m->p[i][1] = m->t[i + 1] * (i + 1);
        const double mean = (m->p[i][0] + m->p[i][1]) / 2;
        if (m->steps)
            m->p[i][0] = m->p[i][1] = mean;
        sum += mean;
        m->below[i + 1] = sum;
    }
    for (int i = 0; i < CELLS; i++) {
        m->p[i][0] *= CELLS / sum;
        m->p[i][1] *= CELLS / sum;
        m->below[i + 1] /= sum;
    }
    m->below[CELLS] = 1;
    return true;
}

static struct bsdf_claims table_claims(const void *state,
                                       const struct bands *bands)
{
    (void)state, (void)bands;
    return (struct bsdf_claims){ .lobes = BSDF_DIFFUSE_REFLECTION,
                                 .reciprocal = true,
                                 .eta = 1 };
}

static double mixed(double right, double wrong, double share)
{
    return right + share * (wrong - right);
}

static int cell(double c)
{
    return (int)fmin(c * CELLS, CELLS - 1);
}

/* Linear between nodes, or between those one further on. */
static double look_up(const struct table *m, double c, bool off)
{
    const int i = cell(c), k = i + 1 < CELLS ? i + 1 : i;
    const double x = c * CELLS - i;
    const double right = mixed(m->t[i], m->t[i + 1], x);
    const double wrong = mixed(m->t[k], m->t[k + 1], x);
    return off ? mixed(right, wrong, m->size) : right;
}

static struct spectrum table_eval(const void *state, struct vec3 wo,
                                  struct vec3 wi)
{
    const struct table *m = state;
    if (!(wo.z > 0 && wi.z > 0))
        return (struct spectrum){ { 0 } };
    return spectrum_of(3, look_up(m, fmin(wo.z, 1), m->fault == F_BOTH_OFF) *
                              look_up(m, fmin(wi.z, 1), m->fault >= F_OFF) /
                              PI);
}

static double table_pdf(const void *state, struct vec3 wo, struct vec3 wi)
{
    const struct table *m = state;
    if (!(wo.z > 0 && wi.z > 0))
        return 0;
    const double c = fmin(wi.z, 1);
    const int i = cell(c), k = i + 1 < CELLS ? i + 1 : i;
    const double x = c * CELLS - i;
    const double right = mixed(m->p[i][0], m->p[i][1], x);
    const double wrong = mixed(m->p[k][0], m->p[k][1], x);
    return (m->fault == PDF_OFF ? mixed(right, wrong, m->size) : right) /
           (2 * PI);
}

static struct bsdf_sample table_sample(const void *state, struct vec3 wo,
                                       struct vec3 u)
{
    const struct table *m = state;
    int i = 0;
    if (!(wo.z > 0))
        return (struct bsdf_sample){ 0 };
    while (i + 1 < CELLS && u.x >= m->below[i + 1])
        i++;
    /* The share v of a cell in which p goes from a to b is below x. */
    const double v = (u.x - m->below[i]) / (m->below[i + 1] - m->below[i]);
    const double a = m->p[i][0], b = m->p[i][1];
    const double root = sqrt(a * a + v * (b - a) * (b + a));
    const double x = v > 0 ? v * (a + b) / (a + root) : 0;
    const double z = (i + fmin(x, 1 - 0x1p-53)) / CELLS;
    const double r = sqrt((1 - z) * (1 + z)), phi = 2 * PI * u.y;
    const struct vec3 wi = { r * cos(phi), r * sin(phi), z };
    const double pdf = table_pdf(m, wo, wi);
    if (!(pdf > 0))
        return (struct bsdf_sample){ 0 };
    return (struct bsdf_sample){
        .wi = wi,
        .pdf = pdf,
        .weight = spectrum_scale(wi.z / pdf, table_eval(m, wo, wi)),
    };
}

const struct bsdf_type type_broken_table = {
    .name = "broken_table",
    .about = "looks its numbers up, with a fault",
    .params = table_params,
    .size = sizeof(struct table),
    .claims = table_claims,
    .eval = table_eval,
    .pdf = table_pdf,
    .sample = table_sample,
    .init = table_init,
};
