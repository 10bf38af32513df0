/* ior_page.c - files into pages, and n and k out of them
 */
#include "bsdf/ior_page.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* -- a page that has been read --------------------------------------------- */

void ior_page_free(struct ior_page *page)
{
    if (!page)
        return;
    for (size_t i = 0; page->warnings && i <= IOR_WARNINGS_MAX; i++)
        free(page->warnings[i]);
    free(page->warnings);
    free(page->n.nm);
    free(page->n.value);
    free(page->k.nm);
    free(page->k.value);
    free(page->path);
    free(page->reference);
    free(page->comments);
    free(page);
}

const char *ior_page_path(const struct ior_page *page)
{
    return page->path;
}

const char *ior_page_reference(const struct ior_page *page)
{
    return page->reference ? page->reference : "";
}

const char *ior_page_comments(const struct ior_page *page)
{
    return page->comments ? page->comments : "";
}

const char *const *ior_page_warnings(const struct ior_page *page)
{
    static const char *const none[] = { NULL };
    return page->warnings ? (const char *const *)page->warnings : none;
}

struct ior_table ior_page_n(const struct ior_page *page)
{
    return (struct ior_table){ page->n.rows, page->n.nm, page->n.value };
}

struct ior_table ior_page_k(const struct ior_page *page)
{
    return (struct ior_table){ page->k.rows, page->k.nm, page->k.value };
}

struct ior_formula ior_page_formula(const struct ior_page *page)
{
    const struct ior_dispersion *f = &page->formula;
    return (struct ior_formula){ f->number, f->count, f->c, f->lo_nm,
                                 f->hi_nm };
}

bool ior_page_has_k(const struct ior_page *page)
{
    return page->k.rows > 0;
}

void ior_page_range(const struct ior_page *page, double *lo_nm, double *hi_nm)
{
    *lo_nm = page->lo;
    *hi_nm = page->hi;
}

/* Linear in the wavelength, which is inside the table.  A row's own wavelength
 * gives its value to the bit, and asks nothing of its neighbours. */
static bool at(const struct ior_page *page, const struct ior_column *t,
               const char *what, double nm, double *value, struct err *err)
{
    size_t below = 0, above = t->rows; /* nm[below] <= nm < nm[above] */
    while (above - below > 1) {
        const size_t middle = below + (above - below) / 2;
        if (t->nm[middle] <= nm)
            below = middle;
        else
            above = middle;
    }
    const bool on_row = t->nm[below] == nm;
    for (size_t i = below; i <= below + !on_row; i++)
        if (t->value[i] < 0)
            return err_set(err,
                           "%.400s: no %s at %.10g nm, as the measured %s is "
                           "%g at %.10g nm, and it should not be negative",
                           page->path, what, nm, what, t->value[i], t->nm[i]);
    *value = t->value[below];
    if (!on_row)
        *value += (nm - t->nm[below]) / (t->nm[above] - t->nm[below]) *
                  (t->value[above] - t->value[below]);
    return true;
}

bool ior_page_at(const struct ior_page *page, double nm, double *n, double *k,
                 struct err *err)
{
    double n_read, k_read = 0;
    char why[80];
    if (!(nm >= page->lo && nm <= page->hi)) /* a NaN fails too */
        return err_set(err,
                       "%.400s: wavelength %.10g nm is outside [%.10g, %.10g] "
                       "nm, which the page covers",
                       page->path, nm, page->lo, page->hi);
    if (page->formula.number &&
        !ior_formula_at(&page->formula, nm, &n_read, why, sizeof why))
        return err_set(err,
                       "%.400s: no n at %.10g nm, as %s there; expected a "
                       "number that is not negative",
                       page->path, nm, why);
    if (page->n.rows && !at(page, &page->n, "n", nm, &n_read, err))
        return false;
    if (page->k.rows && !at(page, &page->k, "k", nm, &k_read, err))
        return false;
    *n = n_read;
    *k = k_read;
    return true;
}

/* -- a file that is being read --------------------------------------------- */

bool ior_fail(const struct ior_source *file, size_t line, const char *format,
              ...)
{
    char why[512];
    va_list args;
    va_start(args, format);
    vsnprintf(why, sizeof why, format, args);
    va_end(args);
    if (line)
        return err_set(file->err, "%.400s:%zu: %s", file->path, line, why);
    return err_set(file->err, "%.400s: %s", file->path, why);
}

bool ior_out_of_memory(const struct ior_source *file)
{
    return ior_fail(file, 0, "out of memory");
}

void ior_warn(struct ior_page *page, const char *format, ...)
{
    char text[256];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    if (!page->warnings)
        page->warnings = calloc(IOR_WARNINGS_MAX + 2, sizeof *page->warnings);
    if (page->warnings && page->warned < IOR_WARNINGS_MAX)
        page->warnings[page->warned] = strdup(text);
    page->warned++;
}

bool ior_source_open(struct ior_source *file)
{
    bool good = false;
    ssize_t got;
    struct stat s;
    const int fd =
        open(file->path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (fd < 0 || fstat(fd, &s) != 0) {
        ior_fail(file, 0, "%s", strerror(errno));
        goto done;
    }
    if (!S_ISREG(s.st_mode)) {
        ior_fail(file, 0,
                 S_ISDIR(s.st_mode) ? "a folder, expected a file"
                                    : "not a regular file");
        goto done;
    }
    if (s.st_size > IOR_BYTES_MAX) {
        ior_fail(file, 0, "%lld bytes, expected at most %d",
                 (long long)s.st_size, IOR_BYTES_MAX);
        goto done;
    }
    file->bytes = malloc((size_t)s.st_size + 1);
    if (!file->bytes) {
        ior_out_of_memory(file);
        goto done;
    }
    while ((got = read(fd, file->bytes + file->size,
                       (size_t)s.st_size - file->size)) > 0)
        file->size += (size_t)got;
    good = got == 0 || ior_fail(file, 0, "%s", strerror(errno));
done:
    if (fd >= 0)
        close(fd);
    return good;
}

void ior_source_close(struct ior_source *file)
{
    free(file->bytes);
    file->bytes = NULL;
    file->size = 0;
}

/* Where there are n and k both, and the last of the warnings. */
static bool settle(const struct ior_source *file)
{
    struct ior_page *page = file->page;
    const struct ior_column *n = &page->n, *k = &page->k;
    assert(n->rows || page->formula.number);
    const double lo = n->rows ? n->nm[0] : page->formula.lo_nm;
    const double hi = n->rows ? n->nm[n->rows - 1] : page->formula.hi_nm;
    page->lo = k->rows ? fmax(lo, k->nm[0]) : lo;
    page->hi = k->rows ? fmin(hi, k->nm[k->rows - 1]) : hi;
    if (page->lo > page->hi)
        return ior_fail(file, 0,
                        "no wavelength has both, n in [%.10g, %.10g] and k in "
                        "[%.10g, %.10g] nm",
                        lo, hi, k->nm[0], k->nm[k->rows - 1]);
    if (page->warnings && page->warned > IOR_WARNINGS_MAX) {
        char text[64];
        snprintf(text, sizeof text, "and %zu more such warnings",
                 page->warned - IOR_WARNINGS_MAX);
        page->warnings[IOR_WARNINGS_MAX] = strdup(text);
    }
    return true;
}

static bool ends_in(const char *path, const char *ending)
{
    const size_t length = strlen(path), n = strlen(ending);
    return length > n && strcmp(path + length - n, ending) == 0;
}

static bool is_plain(const char *path)
{
    return ends_in(path, ".txt") || ends_in(path, ".csv") ||
           ends_in(path, ".dat") || ends_in(path, ".nk");
}

bool ior_is_file(const char *name)
{
    return ends_in(name, ".yml") || ends_in(name, ".spd") || is_plain(name);
}

struct ior_page *ior_page_load(const char *path, struct err *err)
{
    assert(path);
    struct ior_source file = { .path = path, .err = err };
    bool good = (file.page = calloc(1, sizeof *file.page)) &&
                (file.page->path = strdup(path));
    if (!good)
        ior_out_of_memory(&file);
    if (good && ends_in(path, ".spd"))
        good = ior_read_spd(&file);
    else
        good = good && ior_source_open(&file) &&
               (is_plain(path) ? ior_read_plain(&file) : ior_read_yaml(&file));
    good = good && settle(&file);
    ior_source_close(&file);
    if (good)
        return file.page;
    ior_page_free(file.page);
    return NULL;
}
