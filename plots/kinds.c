/* kinds.c - the list of plots, and what their captions share */
#include "plots/kinds.h"

#include "bsdf/cli.h"

const struct plot *const plots[] = {
    &plot_lobe,     &plot_lobe3d,      &plot_histogram, &plot_slice,
    &plot_albedo,   &plot_convergence, &plot_compare,   &plot_ndf,
    &plot_fresnel,  &plot_ior,         &plot_colour,    &plot_kill_matrix,
    &plot_p_values, &plot_series,      &plot_report,    &plot_writeup,
    NULL,
};

void plot_caption(struct figure *fig, const struct plot *plot,
                  const struct plot_request *r, const char *subject,
                  const char *shows)
{
    char bands[96];
    figure_caption(fig, "%s ", shows);
    for (int i = 0; i < r->bsdfs; i++) {
        figure_caption(fig, i ? "; " : "Model: ");
        figure_caption_spec(fig, bsdf_spec(r->bsdf[i]));
    }
    if (subject)
        figure_caption_spec(fig, subject);
    figure_caption(fig, ". ");
    for (int i = 0; (plot->heeds & HEEDS_WO) && i < r->wos; i++) {
        const struct angles a = dir_to_degrees(r->wo[i]);
        figure_caption(fig, "%s%.6g°, φ = %.6g°",
                       i ? "; " : "ωₒ: θ = ", a.theta_deg, a.phi_deg);
    }
    if ((plot->heeds & HEEDS_WO) && r->wos > 0)
        figure_caption(fig, ". ");
    if (plot->subject != PLOT_FILE) {
        bands_print(&r->bands, bands, sizeof bands);
        figure_caption(fig, "%s: %s. ",
                       r->bands.kind == BANDS_NM ? "Wavelengths" : "Bands",
                       bands);
    }
    if (plot->heeds & HEEDS_SAMPLES)
        figure_caption(fig, "Seed %llu, %llu samples. ",
                       (unsigned long long)r->seed,
                       (unsigned long long)r->samples);
    figure_caption(fig, "Made by bsdf-plot %s " BSDF_VERSION ".", plot->name);
}
