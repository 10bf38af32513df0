/* ior_spd.c - columns of plain text: Mitsuba's .spd pairs, and nm, n and k
 *
 *   NAME.eta.spd, NAME.k.spd   rows of a wavelength [nm] and n or k, on grids
 *                              of their own [1]
 *   .txt .csv .dat .nk         rows of a wavelength [nm], n and maybe k, with
 *                              white space or commas between them
 *
 * What follows a # is a comment; the comments are kept as those of the page.
 * Wavelengths that are all below 50 nm are taken for micrometres by mistake,
 * and refused.
 *
 * [1] W. Jakob et al., Mitsuba 3 renderer, 2022, documentation of spectra.
 */
#include "bsdf/ior_page.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* No table of visible light ends below, and few in micrometres go so far. */
static const double least_nm = 50;

/* Appends the text of a comment, as far as there is room. */
static void add_comment(char text[IOR_TEXT_MAX + 1], size_t *used,
                        const char *s, size_t length)
{
    while (length && (*s == '#' || ior_is_space(*s)))
        s++, length--;
    while (length && ior_is_space(s[length - 1]))
        length--;
    if (length && *used && *used < IOR_TEXT_MAX)
        text[(*used)++] = '\n';
    while (length) {
        const size_t letter = ior_letter(s, length), n = letter ? letter : 1;
        if (*used + n > IOR_TEXT_MAX)
            break;
        if (letter && !ior_is_space(*s))
            memcpy(text + *used, s, n);
        else
            text[*used] = letter ? ' ' : '?';
        *used += n;
        s += n;
        length -= n;
    }
    text[*used] = '\0';
}

/* Takes the comments out, and a byte order mark; every line ends in \n.  In
 * place, as it only gets shorter. */
static bool strip(struct ior_source *file)
{
    char *s = file->bytes;
    size_t used = 0, written = 0, line = 1;
    char *comments = calloc(1, IOR_TEXT_MAX + 1);
    if (!comments)
        return ior_out_of_memory(file);
    if (file->page->comments)
        used = strlen(strcpy(comments, file->page->comments));
    free(file->page->comments);
    file->page->comments = comments;

    size_t i = file->size >= 3 && memcmp(s, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    for (size_t end; i < file->size; i = end, line++) {
        const char *hash = NULL;
        for (end = i; end < file->size; end++) {
            if (s[end] == '\n' || s[end] == '\r')
                break;
            if ((unsigned char)s[end] < ' ' && s[end] != '\t')
                return ior_fail(file, line, "byte %d, expected plain text",
                                s[end]);
            if (s[end] == '#' && !hash)
                hash = s + end;
        }
        if (hash)
            add_comment(comments, &used, hash, (size_t)(s + end - hash));
        const size_t kept = (hash ? (size_t)(hash - s) : end) - i;
        if (end < file->size && s[end] == '\r')
            end += end + 1 < file->size && s[end + 1] == '\n';
        end += end < file->size;
        memmove(s + written, s + i, kept);
        written += kept;
        if (end > i + kept)
            s[written++] = '\n';
    }
    file->size = written;
    return true;
}

static bool read_columns(struct ior_source *file, const struct ior_kind *kind,
                         const struct ior_column *column)
{
    const struct ior_lines lines = { file->bytes, file->size, 1, true, 0 };
    if (!ior_read_rows(file, kind, &lines))
        return false;
    const double hi = column->nm[column->rows - 1];
    if (hi < least_nm)
        return ior_fail(file, 0,
                        "%s: wavelengths from %g to %g nm; expected some from "
                        "%g nm on, and these may be micrometres",
                        kind->type, column->nm[0], hi, least_nm);
    return true;
}

bool ior_read_plain(struct ior_source *file)
{
    static const struct ior_kind kinds[] = {
        { "the table", 3, "wavelength, n and k", .has_n = true, .has_k = true,
          .nm = true, .csv = true },
        { "the table", 2, "wavelength and n", .has_n = true, .nm = true,
          .csv = true },
    };
    struct ior_span values[3];
    if (!strip(file))
        return false;
    /* As many values as the first row has. */
    int count = 0;
    for (size_t i = 0, end; i < file->size && !count; i = end + 1) {
        for (end = i; end < file->size && file->bytes[end] != '\n'; end++)
            ;
        count = ior_split(file->bytes + i, end - i, true, values);
    }
    return read_columns(file, &kinds[count == 2], &file->page->n);
}

bool ior_read_spd(struct ior_source *file)
{
    static const struct {
        const char *ending;
        struct ior_kind kind;
    } halves[] = {
        { ".eta.spd",
          { "eta", 2, "wavelength and eta", .has_n = true, .nm = true } },
        { ".k.spd", { "k", 2, "wavelength and k", .has_k = true, .nm = true } },
    };
    const size_t length = strlen(file->path);
    struct ior_page *page = file->page;
    int given = 0;
    for (; given < 2; given++) {
        const size_t n = strlen(halves[given].ending);
        if (length > n &&
            strcmp(file->path + length - n, halves[given].ending) == 0)
            break;
    }
    if (given == 2)
        return ior_fail(file, 0,
                        "expected a name that ends in .eta.spd or .k.spd");
    if (access(file->path, F_OK) != 0)
        return ior_fail(file, 0, "%s", strerror(errno));
    const size_t stem = length - strlen(halves[given].ending);
    const size_t size = stem + sizeof ".eta.spd";
    char *path = malloc(size);
    if (!path)
        return ior_out_of_memory(file);
    bool good = true;
    for (int h = 0; good && h < 2; h++) {
        struct ior_source half = { .path = path,
                                   .page = page,
                                   .err = file->err };
        snprintf(path, size, "%.*s%s", (int)stem, file->path, halves[h].ending);
        if (h != given && access(path, F_OK) != 0)
            good = ior_fail(&half, 0, "no such file, and %.300s needs it",
                            file->path);
        good = good && ior_source_open(&half) && strip(&half) &&
               read_columns(&half, &halves[h].kind, h ? &page->k : &page->n);
        ior_source_close(&half);
    }
    free(path);
    return good;
}
