/* ior.c - from the name of a material to the page that has its n and k
 *
 * Layouts that are walked, of the refractiveindex.info database and of data/:
 *
 *   SHELF/[GROUP/...]MATERIAL/nk/PAGE.yml    in database/data
 *   SHELF/[GROUP/...]MATERIAL/PAGE.yml       before, in database/data-nk
 *   MATERIAL/PAGE.yml                        data/ior
 *
 * No path is ever made from a name: folders are listed and what they hold is
 * compared with it, so that a name cannot lead out of them.
 */
#include "bsdf/ior.h"
#include "bsdf/cie.h"
#include "bsdf/ior_page.h"

#include <assert.h>
#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* The database has its materials at most three folders down, and 3,720 pages of
 * them; a loop of links has more. */
enum { DEPTH_MAX = 5, ENTRIES_MAX = 50000 };

/* What a material's name alone stands for: a page that covers all of 360 to
 * 830 nm, by measurement if there is one, and not by a model fitted to others'
 * figures or by a calculation.  The customary one where that leaves
 * several.  Each file in data/ior/ says more. */
static const struct {
    const char *material, *page;
} usual[] = {
    /* The only one that goes through the visible; the other ends at 316 nm. */
    { "Ca", "Mathewson" },
    /* P. B. Johnson and R. W. Christy's noble metals, 188 to 1937 nm, which
     * are the usual ones in rendering; and their transition metals, measured
     * alike.  The pages next to these are of thin films (Cr/Sytchkova, 12 nm),
     * start at 400 nm (Ti/Mash), or are electron energy losses turned into n
     * and k (Werner), which in the visible reflect far too well. */
    { "Ag", "Johnson" },
    { "Au", "Johnson" },
    { "Cu", "Johnson" },
    { "Cr", "Johnson" },
    { "Fe", "Johnson" },
    { "Ni", "Johnson" },
    { "Ti", "Johnson" },
    /* Measurements by several, freed of the oxide that all aluminium grows and
     * made consistent by Kramers and Kronig's relation.  Mathewson's direct
     * ones start at 496 nm, where their reflectance is within .01. */
    { "Al", "Rakic" },
    /* Measured on a crystal; Werner's reflect .84 at 550 nm instead of .50. */
    { "W", "Weaver" },
    /* The only ellipsometry; the others are Werner's, with .93 instead of .73
     * at 550 nm, and models. */
    { "Pt", "Tselin" },
    /* The maker's own; Lane's starts at 5 um. */
    { "BK7", "Schott" },
    /* Measured on many specimens of fused silica.  The other pages are a film,
     * crystalline quartz and the far infrared. */
    { "SiO2", "Malitson" },
    /* n measured to 6 digits, at 20 degrees; without k, which no surface of
     * water needs.  Hale's has k, and n to 3 digits, from a survey. */
    { "H2O", "Daimon-20.0C" },
    /* Diamond, from its reflectance; Peter's, which agrees within .01, ends at
     * 760 nm, and the third is graphite. */
    { "C", "Phillip" },
};

/* -- lists of words -------------------------------------------------------- */

struct words {
    char **at; /* the last is NULL, once there is one */
    size_t count;
};

static bool words_add(struct words *words, const char *word, struct err *err)
{
    char **at = realloc(words->at, (words->count + 2) * sizeof *at);
    if (at)
        words->at = at;
    if (!at || !(at[words->count] = strdup(word)))
        return err_set(err, "optical constants: out of memory");
    at[++words->count] = NULL;
    return true;
}

static bool words_have(const struct words *words, const char *word)
{
    for (size_t i = 0; i < words->count; i++)
        if (strcmp(words->at[i], word) == 0)
            return true;
    return false;
}

static void words_clear(struct words *words)
{
    for (size_t i = 0; i < words->count; i++)
        free(words->at[i]);
    free(words->at);
    *words = (struct words){ 0 };
}

static int by_letters(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* The shelf main comes before all others. */
static int by_shelf(const void *a, const void *b)
{
    const int main_a = strcmp(*(char *const *)a, "main") == 0;
    const int main_b = strcmp(*(char *const *)b, "main") == 0;
    return main_a || main_b ? main_b - main_a : by_letters(a, b);
}

static void words_sort(struct words *words,
                       int (*order)(const void *, const void *))
{
    if (words->count > 1)
        qsort(words->at, words->count, sizeof *words->at, order);
}

/* "Au, Ca and 7 more". */
static void words_print(const struct words *words, char *text, size_t size)
{
    const size_t room = sizeof ", and 50000 more";
    size_t used = 0;
    text[0] = '\0';
    for (size_t i = 0; i < words->count; i++) {
        if (used + strlen(words->at[i]) + room > size) {
            snprintf(text + used, size - used, " and %zu more",
                     words->count - i);
            return;
        }
        used += (size_t)snprintf(text + used, size - used, "%s%s",
                                 i ? ", " : "", words->at[i]);
    }
}

/* -- walking through folders ----------------------------------------------- */

enum go_on { GO_ON, FOUND, FAILED };

struct walk {
    const char *only; /* pages of this material, or NULL: of all */
    enum go_on (*each)(void *ctx, const char *material, const char *page,
                       const char *path, struct err *err);
    void *ctx;
    int entries; /* seen so far */
    struct err *err;
};

static bool is_folder(const char *path)
{
    struct stat s;
    return stat(path, &s) == 0 && S_ISDIR(s.st_mode);
}

static bool join(char path[PATH_MAX], const char *folder, const char *name)
{
    return snprintf(path, PATH_MAX, "%s/%s", folder, name) < PATH_MAX;
}

/* Whether a name ends in .yml, after at least one letter. */
static bool is_yml(const char *name)
{
    const size_t length = strlen(name);
    return length > 4 && strcmp(name + length - 4, ".yml") == 0;
}

/* Sorts what a folder holds into page files and folders. */
static bool list(struct walk *w, const char *folder, struct words *files,
                 struct words *folders)
{
    DIR *dir = opendir(folder);
    if (!dir)
        return err_set(w->err, "%.400s: %s", folder, strerror(errno));
    bool good = true;
    char path[PATH_MAX];
    for (const struct dirent *e; good && (e = readdir(dir));) {
        if (e->d_name[0] == '.' || !join(path, folder, e->d_name))
            continue;
        if (++w->entries > ENTRIES_MAX)
            good = err_set(w->err,
                           "%.400s: gave up after %d files and folders; no "
                           "database of optical constants has as many",
                           folder, ENTRIES_MAX);
        else if (strcmp(e->d_name, "about.yml") == 0)
            continue;
        else if (is_yml(e->d_name))
            good = words_add(files, e->d_name, w->err);
        else if (e->d_type == DT_DIR ||
                 (e->d_type != DT_REG && is_folder(path)))
            good = words_add(folders, e->d_name, w->err);
    }
    closedir(dir);
    words_sort(files, by_letters);
    words_sort(folders, by_shelf);
    return good;
}

static enum go_on pages_in(struct walk *w, const char *folder,
                           const char *material, bool nk_too)
{
    struct words files = { 0 }, folders = { 0 };
    char path[PATH_MAX];
    enum go_on go = list(w, folder, &files, &folders) ? GO_ON : FAILED;
    for (size_t i = 0; go == GO_ON && i < files.count; i++) {
        if (!join(path, folder, files.at[i]))
            continue;
        files.at[i][strlen(files.at[i]) - 4] = '\0'; /* .yml */
        go = w->each(w->ctx, material, files.at[i], path, w->err);
    }
    if (go == GO_ON && nk_too && words_have(&folders, "nk") &&
        join(path, folder, "nk"))
        go = pages_in(w, path, material, false);
    words_clear(&files);
    words_clear(&folders);
    return go;
}

/* How much of a folder's name is that of a material: up to " - ". */
static size_t material_length(const char *folder)
{
    const char *dash = strstr(folder, " - ");
    return dash ? (size_t)(dash - folder) : strlen(folder);
}

static bool matches(const char *folder, const char *material)
{
    const size_t length = material_length(folder);
    return strcmp(folder, material) == 0 ||
           (strlen(material) == length &&
            strncmp(folder, material, length) == 0);
}

/* The folders in one, first as materials and then as shelves or groups. */
static enum go_on walk(struct walk *w, const char *folder, int depth)
{
    struct words files = { 0 }, folders = { 0 };
    char path[PATH_MAX];
    enum go_on go = list(w, folder, &files, &folders) ? GO_ON : FAILED;
    for (int deeper = 0; deeper <= (depth < DEPTH_MAX); deeper++)
        for (size_t i = 0; go == GO_ON && i < folders.count; i++) {
            char *name = folders.at[i];
            if (strcmp(name, "nk") == 0 || strcmp(name, "n2") == 0 ||
                !join(path, folder, name))
                continue;
            if (deeper) {
                go = walk(w, path, depth + 1);
            } else if (!w->only || matches(name, w->only)) {
                char material[NAME_MAX + 1];
                snprintf(material, sizeof material, "%.*s",
                         (int)material_length(name), name);
                go = pages_in(w, path, material, true);
            }
        }
    words_clear(&files);
    words_clear(&folders);
    return go;
}

/* -- where pages are ------------------------------------------------------- */

struct roots {
    char at[2][PATH_MAX]; /* searched in this order */
    int count;
};

static bool in_tree(char root[PATH_MAX], struct err *err)
{
    const char *data = data_folder();
    if (!join(root, data, "ior") || !is_folder(root))
        return err_set(err,
                       "%.400s/ior: no such folder, and the optical constants "
                       "that come along should be there; BSDF_DATA can name "
                       "the data folder",
                       data);
    return true;
}

/* The folder of a database that holds its shelves, or else the one given. */
static bool in_database(char root[PATH_MAX], const char *given, struct err *err)
{
    static const char *const folders[] = { "database/data", "database/data-nk",
                                           "data", "data-nk" };
    char shelf[PATH_MAX];
    if (!is_folder(given))
        return err_set(err,
                       "%.400s: no such folder; expected a copy of the "
                       "refractiveindex.info database",
                       given);
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++)
        if (join(root, given, folders[i]) && join(shelf, root, "main") &&
            is_folder(shelf))
            return true;
    snprintf(root, PATH_MAX, "%s", given); /* fits, as it could be opened */
    return true;
}

static bool find_roots(struct roots *roots, const char *ior_path,
                       struct err *err)
{
    if (!ior_path)
        ior_path = getenv("BSDF_IOR_PATH");
    roots->count = 0;
    if (ior_path && *ior_path &&
        !in_database(roots->at[roots->count++], ior_path, err))
        return false;
    /* Whoever brings a database can do without ours. */
    if (in_tree(roots->at[roots->count], roots->count ? NULL : err))
        roots->count++;
    return roots->count > 0;
}

/* -- finding --------------------------------------------------------------- */

/* What is looked for, and what is seen on the way. */
struct search {
    const char *page;    /* stop at this one, unless NULL */
    char path[PATH_MAX]; /* of that page, or of the first one seen */
    struct words seen;   /* names of pages, or of materials */
    bool materials;      /* which of the two */
};

static enum go_on look(void *ctx, const char *material, const char *page,
                       const char *path, struct err *err)
{
    struct search *s = ctx;
    const bool found = s->page && strcmp(s->page, page) == 0;
    const char *word = s->materials ? material : page;
    if (found || !s->seen.count)
        snprintf(s->path, sizeof s->path, "%s", path);
    if (!words_have(&s->seen, word) && !words_add(&s->seen, word, err))
        return FAILED;
    return found ? FOUND : GO_ON;
}

static enum go_on search(const struct roots *roots, const char *material,
                         struct search *s, struct err *err)
{
    enum go_on go = GO_ON;
    for (int r = 0; go == GO_ON && r < roots->count; r++) {
        struct walk w = { material, look, s, 0, err };
        go = walk(&w, roots->at[r], 0);
    }
    return go;
}

struct name {
    char material[NAME_MAX + 1];
    char page[NAME_MAX + 1]; /* "" if not given */
};

static bool read_part(char part[NAME_MAX + 1], const char *text, size_t length)
{
    if (length == 0 || length > NAME_MAX || text[0] == '.')
        return false; /* "..", hidden files, absolute paths */
    memcpy(part, text, length);
    part[length] = '\0';
    return true;
}

static bool read_name(struct name *name, const char *text, struct err *err)
{
    const size_t first = strcspn(text, "/");
    name->page[0] = '\0';
    if (!read_part(name->material, text, first) ||
        (text[first] &&
         (strchr(text + first + 1, '/') ||
          !read_part(name->page, text + first + 1, strlen(text + first + 1)))))
        return err_set(err,
                       "optical constants \"%.200s\": expected MATERIAL, "
                       "MATERIAL/PAGE or a file that ends in .yml, .eta.spd, "
                       ".k.spd, .txt, .csv, .dat or .nk, as in Ca, "
                       "Ca/Mathewson or my/Ca.yml",
                       text);
    return true;
}

/* The page that a material's name alone stands for; NULL if none is usual. */
static const char *usual_page(const char *material)
{
    for (size_t i = 0; i < sizeof usual / sizeof *usual; i++)
        if (strcmp(usual[i].material, material) == 0)
            return usual[i].page;
    return NULL;
}

/* Why no page was found, given those that its material has. */
static void explain(const struct name *name, const struct words *pages,
                    const struct roots *roots, struct err *err)
{
    struct search s = { .materials = true };
    const bool known = pages->count > 0; /* the material is */
    if (!known && search(roots, NULL, &s, err) == FAILED) {
        words_clear(&s.seen);
        return;
    }
    const struct words *there = known ? pages : &s.seen;
    const char *meant = known ? name->page : name->material;
    char all[400], where[320], maybe[100] = "";
    words_print(there, all, sizeof all);
    snprintf(where, sizeof where, "%.150s%s%.150s", roots->at[0],
             roots->count > 1 ? " or " : "",
             roots->count > 1 ? roots->at[1] : "");
    if (there->count) {
        const char *near = err_nearest(meant, (const char *const *)there->at);
        if (near)
            snprintf(maybe, sizeof maybe, " (did you mean %s?)", near);
    }
    if (!there->count)
        err_set(err, "no optical constants at all in %s", where);
    else if (!known)
        err_set(err, "no optical constants of \"%.100s\" in %s%s, only of %s",
                meant, where, maybe, all);
    else if (*meant)
        err_set(err, "no page \"%.60s\" of %.60s in %s%s, only %s", meant,
                name->material, where, maybe, all);
    else
        err_set(err,
                "%.60s has %zu pages of optical constants in %s; choose one, "
                "as in %.60s/%.60s: %s",
                name->material, there->count, where, name->material,
                there->at[0], all);
    words_clear(&s.seen);
}

struct ior_page *ior_find(const char *name, const char *ior_path,
                          struct err *err)
{
    assert(name);
    if (ior_is_file(name))
        return ior_page_load(name, err);

    struct ior_page *page = NULL;
    struct roots roots;
    struct name parts;
    if (!read_name(&parts, name, err) || !find_roots(&roots, ior_path, err))
        return NULL;
    struct search s = { .page = *parts.page ? parts.page
                                            : usual_page(parts.material) };
    enum go_on go = search(&roots, parts.material, &s, err);
    if (go == GO_ON && !*parts.page && s.seen.count == 1)
        go = FOUND;
    if (go == FOUND)
        page = ior_page_load(s.path, err);
    else if (go == GO_ON)
        explain(&parts, &s.seen, &roots, err);
    words_clear(&s.seen);
    return page;
}

bool ior_lookup(const char *name, const struct bands *bands,
                struct spectrum *eta, struct spectrum *k, struct err *err)
{
    struct spectrum n_read = { { 0 } }, k_read = { { 0 } };
    struct ior_page *page = ior_find(name, NULL, err);
    bool good = page != NULL;
    if (good && k && !ior_page_has_k(page))
        good = err_set(err,
                       "%.400s: the page gives n alone, and an absorbing "
                       "material needs k",
                       ior_page_path(page));
    for (int b = 0; good && b < bands->count; b++)
        good = ior_page_at(page, bands->nm[b], &n_read.band[b], &k_read.band[b],
                           err);
    if (good) {
        *eta = n_read;
        if (k)
            *k = k_read;
    }
    ior_page_free(page);
    return good;
}

/* -- listing --------------------------------------------------------------- */

static enum go_on note(void *ctx, const char *material, const char *page,
                       const char *path, struct err *err)
{
    char name[2 * NAME_MAX + 2];
    (void)path;
    snprintf(name, sizeof name, "%s/%s", material, page);
    return words_add(ctx, name, err) ? GO_ON : FAILED;
}

bool ior_list(void (*each)(void *ctx, const char *name), void *ctx,
              struct err *err)
{
    struct words names = { 0 };
    struct walk w = { NULL, note, &names, 0, err };
    char root[PATH_MAX];
    const bool good = in_tree(root, err) && walk(&w, root, 0) != FAILED;
    words_sort(&names, by_letters);
    for (size_t i = 0; good && i < names.count; i++)
        each(ctx, names.at[i]);
    words_clear(&names);
    return good;
}
