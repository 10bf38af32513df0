/* ior.h - measured optical constants: the complex index n + i k of a material
 *
 *   nm    vacuum wavelength [nm]; the files have micrometres.
 *   n     index of refraction [1].
 *   k     extinction coefficient [1], positive where the material absorbs; 0
 *         where a page gives none.
 *
 * A page is what one publication says of one material, in one of these forms:
 *
 * - PAGE.yml, as in the refractiveindex.info database [1]: tables, and for n
 *   any of its dispersion formulas 1 to 9 [2];
 * - NAME.eta.spd and NAME.k.spd, a pair of tables as Mitsuba has them, of n and
 *   of k, where either name stands for the pair;
 * - .txt, .csv, .dat, .nk: a table of wavelength [nm], n and maybe k (but
 *   Windt's IMD has angstroms in a .nk).
 *
 * A page of the first form is named MATERIAL/PAGE, as in Ca/Mathewson, after
 * the folder and the file that hold it.  Fifteen of them come along in
 * data/ior/; a user's copy of the database goes before them.
 *
 * Between two wavelengths of a table n and k are linear, and outside it they
 * are unknown; so is n outside the range that is stated for its formula.
 *
 * The programs never call setlocale, so that a decimal point is one; a library
 * user's locale has to have it too.
 *
 * [1] M. N. Polyanskiy, Refractiveindex.info database of optical constants,
 *     Scientific Data 11, 94, 2024.
 * [2] M. N. Polyanskiy, Dispersion formulas, refractiveindex.info.
 */
#ifndef BSDF_IOR_H
#define BSDF_IOR_H

#include <stdbool.h>
#include <stddef.h>

#include "bsdf/bands.h"
#include "bsdf/err.h"

/** n or k against wavelength: rising, none twice. */
struct ior_table {
    size_t rows; /* 0 where a page has none of it */
    const double *nm;
    const double *value; /* as written, so a bad measurement may be negative */
};

/** n by a dispersion formula, over a range; ior_page_at evaluates it. */
struct ior_formula {
    int number; /* 1 to 9; 0 where n is a table */
    size_t count;
    const double *c; /* C1 is c[0]; for wavelengths in [um] */
    double lo_nm, hi_nm;
};

/** Never changes once loaded, so threads may share it. */
struct ior_page;

/** Reads a page, of at most 64 MiB and 10^6 rows, in the form that its ending
 * stands for; YAML for any other.  NULL and the file, line, row and reason if
 * it makes no sense; owned by the caller. */
struct ior_page *ior_page_load(const char *path, struct err *err);
void ior_page_free(struct ior_page *page); /* NULL is fine */

/* What the page owns and lends: */

const char *ior_page_path(const struct ior_page *page); /* as given */

/** Who measured it, as lines of plain text; "" if the page does not say. */
const char *ior_page_reference(const struct ior_page *page);
const char *ior_page_comments(const struct ior_page *page);

/** BibTeX for a page: an entry for each of its references, keyed like
 * Mathewson1971 and @article as far as authors, title and journal can be told
 * apart, or else @misc with the text as its note; then, for a .yml, the
 * database's own entry.  In UTF-8, TeX's special characters escaped.  False,
 * and an empty text, if it does not fit; 8 KiB will do for all pages seen. */
bool ior_page_bibtex(const struct ior_page *page, char *text, size_t size);

/** What was odd and how it was read, such as rows out of order that have been
 * sorted; sentences, the last followed by NULL. */
const char *const *ior_page_warnings(const struct ior_page *page);

/** One of the two is there: rows of n, or the number of a formula. */
struct ior_table ior_page_n(const struct ior_page *page);
struct ior_formula ior_page_formula(const struct ior_page *page);

struct ior_table ior_page_k(const struct ior_page *page);
bool ior_page_has_k(const struct ior_page *page);

/** From the least to the greatest wavelength [nm] that has both n and k, or n
 * if the page has no k; the same twice if there is just one. */
void ior_page_range(const struct ior_page *page, double *lo_nm, double *hi_nm);

/** Linear between rows; false outside the range, next to a row where the value
 * is negative, which some measurements give and no material has, and where a
 * formula gives no n that is real, finite and not negative. */
bool ior_page_at(const struct ior_page *page, double nm, double *n, double *k,
                 struct err *err);

/** Finds and loads the page that a name stands for; owned by the caller.
 *
 * A name is a path that ends in one of the above, or MATERIAL/PAGE, or MATERIAL
 * alone: for its usual page (see ior.c), or else for the only one there is.
 * Capitals count: Co is no CO.  Of a folder such as "CH4N2O - urea" the part
 * before " - " is name enough.
 *
 * ior_path is where a copy of the refractiveindex.info database lies, its root
 * or the data folder in it, old layout or new; NULL means the environment's
 * BSDF_IOR_PATH, and "" none.  It is searched first, shelf by shelf and main
 * before the others; then the tables that come along, in the folder ior of the
 * environment's BSDF_DATA or of what BSDF_DATA_DIR was when this was built.
 *
 * NULL and a list of what there is if nothing goes by that name. */
struct ior_page *ior_find(const char *name, const char *ior_path,
                          struct err *err);

/** n and k of the page that ior_find(name, NULL) gives, in each band; both
 * untouched on failure.  With k NULL a page without k will do. */
bool ior_lookup(const char *name, const struct bands *bands,
                struct spectrum *eta, struct spectrum *k, struct err *err);

/** Calls each with the name ("Ca/Mathewson") of every page that comes along,
 * sorted; the name is lent for the call. */
bool ior_list(void (*each)(void *ctx, const char *name), void *ctx,
              struct err *err);

#endif
