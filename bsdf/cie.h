/* cie.h - the eye of the standard observer, and daylight
 *
 * The colour matching functions of CIE 1931 (2 degrees) and the illuminant D65
 * [1, 2], every nanometre from 360 to 830, as in data/cie/cie1931_d65.tsv.
 *
 * Sums over the table stand for integrals over wavelength, as [3] has it.  The
 * table's wavelengths are those in air, which are up to .23 nm shorter than in
 * vacuum; no colour here is known so well that this would show.
 *
 * The programs never call setlocale, so that a decimal point is one; a library
 * user's locale has to have it too.
 *
 * [1] ISO/CIE 11664-1:2019, Colorimetry, part 1: CIE standard colorimetric
 *     observers.
 * [2] ISO/CIE 11664-2:2022, Colorimetry, part 2: CIE standard illuminants.
 * [3] CIE 015:2018, Colorimetry, 4th ed., sec. 7.
 */
#ifndef BSDF_CIE_H
#define BSDF_CIE_H

#include <stdbool.h>

#include "bsdf/err.h"

enum { CIE_LO_NM = 360, CIE_HI_NM = 830, CIE_ROWS = CIE_HI_NM - CIE_LO_NM + 1 };

/** One row for each nanometre, the first for CIE_LO_NM; 15 kB, owned by the
 * caller, and once loaded never changed, so that threads may share it. */
struct cie {
    double bar[CIE_ROWS][3]; /* xbar, ybar, zbar [1] */
    double d65[CIE_ROWS];    /* relative power [1], 100 at 560 nm */
};

/** Loads cie/cie1931_d65.tsv of the data folder; false, and the file, the line
 * and the reason, if that cannot be. */
bool cie_load(struct cie *cie, struct err *err);

/** The same from a file: lines of nm, xbar, ybar, zbar and D65 between white
 * space, none of them negative, in order and complete; others start with #. */
bool cie_load_file(struct cie *cie, const char *path, struct err *err);

/** Where the tables that come along are: the environment's BSDF_DATA, or what
 * BSDF_DATA_DIR was when this was built.  Lent by the environment. */
const char *data_folder(void);

#endif
