/* ior.h - measured optical constants: the complex index n + i k of a material
 *
 *   nm    vacuum wavelength [nm]; the files have micrometres.
 *   n     index of refraction [1].
 *   k     extinction coefficient [1], positive where the material absorbs; 0
 *         where a page gives none.
 *
 * A page is what one publication measured of one material, in the YAML form of
 * the refractiveindex.info database [1].  A page is named MATERIAL/PAGE, as in
 * Ca/Mathewson, after the folder and the file that hold it.  Three of its
 * tables come along in data/ior/; a user's copy of the database goes before
 * them.
 *
 * Between two wavelengths of a table n and k are linear, and outside it they
 * are unknown.  Formulas for n are not read yet.
 *
 * The programs never call setlocale, so that a decimal point is one; a library
 * user's locale has to have it too.
 *
 * [1] M. N. Polyanskiy, Refractiveindex.info database of optical constants,
 *     Scientific Data 11, 94, 2024.
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

/** Never changes once loaded, so threads may share it. */
struct ior_page;

/** Reads a page, of at most 64 MiB and 10^6 rows.  NULL and the file, line,
 * row and reason if it makes no sense; owned by the caller. */
struct ior_page *ior_page_load(const char *path, struct err *err);
void ior_page_free(struct ior_page *page); /* NULL is fine */

/* What the page owns and lends: */

const char *ior_page_path(const struct ior_page *page);

/** Who measured it, as lines of plain text; "" if the page does not say. */
const char *ior_page_reference(const struct ior_page *page);
const char *ior_page_comments(const struct ior_page *page);

/** What was odd and how it was read, such as rows out of order that have been
 * sorted; sentences, the last followed by NULL. */
const char *const *ior_page_warnings(const struct ior_page *page);

struct ior_table ior_page_n(const struct ior_page *page); /* has rows */
struct ior_table ior_page_k(const struct ior_page *page);
bool ior_page_has_k(const struct ior_page *page);

/** From the least to the greatest wavelength [nm] that has both n and k, or n
 * if the page has no k; the same twice if there is just one. */
void ior_page_range(const struct ior_page *page, double *lo_nm, double *hi_nm);

/** Linear between rows; false outside the range, and next to a row where the
 * value is negative, which some measurements give and no material has. */
bool ior_page_at(const struct ior_page *page, double nm, double *n, double *k,
                 struct err *err);

/** Finds and loads the page that a name stands for; owned by the caller.
 *
 * A name is a path that ends in .yml, or MATERIAL/PAGE, or MATERIAL alone: for
 * its usual page (see ior.c), or else for the only one there is.  Capitals
 * count: Co is no CO.  Of a folder such as "CH4N2O - urea" the part before
 * " - " is name enough.
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
