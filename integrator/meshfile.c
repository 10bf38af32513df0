/* meshfile.c - meshes from PLY and OBJ files, by assimp
 *
 * A PLY file's header is looked through first, as assimp allocates what it
 * claims: elements with so many properties take at least so many bytes.
 */
#include "integrator/meshfile.h"

#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "integrator/xml.h"

static size_t property_bytes(const char *type)
{
    static const struct {
        const char *name;
        size_t bytes;
    } types[] = {
        { "char", 1 },  { "uchar", 1 },   { "int8", 1 },   { "uint8", 1 },
        { "short", 2 }, { "ushort", 2 },  { "int16", 2 },  { "uint16", 2 },
        { "int", 4 },   { "uint", 4 },    { "int32", 4 },  { "uint32", 4 },
        { "float", 4 }, { "float32", 4 }, { "double", 8 }, { "float64", 8 },
        { NULL, 0 },
    };
    for (int i = 0; types[i].name; i++)
        if (strcmp(types[i].name, type) == 0)
            return types[i].bytes;
    return 0;
}

/* What a header claims so far. */
struct claims {
    const char *path;
    size_t left;          /* bytes not claimed yet */
    char element[32];     /* the one that properties belong to */
    unsigned long long n; /* how many of them */
    size_t numbers;       /* claimed so far */
    bool binary;
};

static bool too_many(const struct claims *c, int number, struct err *err)
{
    return err_set(err,
                   "%s:%d: %llu of \"%s\" are claimed, but the file is too "
                   "short for them",
                   c->path, number, c->n, c->element);
}

static bool header_line(struct claims *c, const char *line, int number,
                        struct err *err)
{
    char a[32] = "", b[32] = "", extra[32] = "";
    const int words = sscanf(line, "%*31s %31s %31s %31s", a, b, extra);
    size_t bytes = 0;
    if (strncmp(line, "format ", 7) == 0) {
        c->binary = strncmp(a, "binary", 6) == 0;
        return true;
    }
    if (strncmp(line, "element ", 8) == 0) {
        char *end = b;
        memcpy(c->element, a, sizeof a);
        c->n = strtoull(b, &end, 10);
        if (words != 2 || end == b || *end || b[0] == '-')
            return err_set(err,
                           "%s:%d: \"%.60s\": expected a name and a number",
                           c->path, number, line);
        return c->n <= c->left || too_many(c, number, err);
    }
    if (strncmp(line, "property ", 9) != 0)
        return true;
    const bool list = strcmp(a, "list") == 0;
    const size_t one = property_bytes(list ? b : a);
    const size_t item = list ? property_bytes(extra) : 1;
    if (one == 0 || item == 0)
        return err_set(err, "%s:%d: \"%.60s\": expected a type such as float",
                       c->path, number, line);
    /* A face has at least three corners, other lists perhaps nothing; a number
     * of a text takes a digit and a blank. */
    const size_t items = list && strcmp(c->element, "face") == 0 ? 3 : 0;
    bytes = c->binary ? one + items * item : 2 + 2 * items;
    if (c->n > c->left / bytes)
        return too_many(c, number, err);
    c->left -= (size_t)c->n * bytes;
    c->numbers += (size_t)c->n * (1 + items);
    return true;
}

/* Whether a text has the numbers that are claimed; assimp makes them up where
 * it has not. */
static bool text_check(const struct claims *c, const char *text, size_t size,
                       struct err *err)
{
    size_t words = 0;
    bool inside = false;
    for (size_t i = 0; i < size; i++) {
        const bool space = (unsigned char)text[i] <= ' ';
        words += !space && !inside;
        inside = !space;
    }
    return c->binary || words >= c->numbers ||
           err_set(err, "%s: %zu numbers are claimed, but there are %zu",
                   c->path, c->numbers, words);
}

static bool ply_check(const char *path, const char *text, size_t size,
                      struct err *err)
{
    /* The last line of a text may lack its end. */
    struct claims c = { .path = path, .left = size + 1 };
    int number = 1;
    if (strncmp(text, "ply", 3) != 0 || (text[3] != '\n' && text[3] != '\r'))
        return err_set(err, "%s:1: expected \"ply\"", path);
    for (const char *at = text, *end; (size_t)(at - text) < size;
         at = end + 1, number++) {
        char line[128];
        end = memchr(at, '\n', size - (size_t)(at - text));
        if (!end)
            break;
        const size_t n = (size_t)(end - at);
        snprintf(line, sizeof line, "%.*s",
                 (int)(n < sizeof line ? n : sizeof line - 1), at);
        line[strcspn(line, "\r")] = '\0';
        if (strcmp(line, "end_header") == 0)
            return text_check(&c, end, size - (size_t)(end - text), err);
        if (!header_line(&c, line, number, err))
            return false;
    }
    return err_set(err, "%s:%d: expected end_header", path, number);
}

/* Whether every vertex has its numbers; assimp leaves those out that have not,
 * and the next ones take their places. */
static bool obj_check(const char *path, const char *text, struct err *err)
{
    int number = 1;
    for (const char *at = text; at; number++) {
        const char *const next = strchr(at, '\n');
        const bool vertex = at[0] == 'v' && (at[1] == ' ' || at[1] == '\t');
        const char *from = at + 1;
        for (int i = 0; i < (vertex ? 3 : 0); i++) {
            char *end;
            strtod(from, &end);
            if (end == from || (next && end > next))
                return err_set(
                    err, "%s:%d: \"%.*s\": expected three numbers", path,
                    number, next && next - at < 60 ? (int)(next - at) : 60, at);
            from = end;
        }
        at = next ? next + 1 : NULL;
    }
    return true;
}

/* Whether a number begins with the point that is at i. */
static bool bare_point(const char *text, size_t i, size_t size)
{
    size_t before = i;
    if (before > 0 && (text[before - 1] == '-' || text[before - 1] == '+'))
        before--;
    return text[i] == '.' && i + 1 < size && text[i + 1] >= '0' &&
           text[i + 1] <= '9' && before > 0 &&
           (text[before - 1] == ' ' || text[before - 1] == '\t');
}

/* A copy in which .5 is 0.5, as assimp leaves out a vertex that begins with the
 * former; NULL when out of memory.  Owned by the caller. */
static char *with_digits(const char *text, size_t *size)
{
    size_t more = 0, at = 0;
    for (size_t i = 0; i < *size; i++)
        more += bare_point(text, i, *size);
    char *out = malloc(*size + more + 1);
    for (size_t i = 0; out && i < *size; i++) {
        if (bare_point(text, i, *size))
            out[at++] = '0';
        out[at++] = text[i];
    }
    if (out)
        out[at] = '\0';
    *size = at;
    return out;
}

/* -- what assimp made of it -- */

static bool counted(const struct aiScene *a, const char *path, size_t *vertices,
                    size_t *triangles, bool *normals, struct err *err)
{
    *vertices = *triangles = 0;
    *normals = true;
    for (unsigned i = 0; i < a->mNumMeshes; i++) {
        const struct aiMesh *m = a->mMeshes[i];
        for (unsigned k = 0; k < m->mNumFaces; k++)
            if (m->mFaces[k].mNumIndices >= 3)
                *triangles += m->mFaces[k].mNumIndices - 2;
        *vertices += m->mNumVertices;
        *normals &= m->mNormals != NULL;
        if (m->mNumVertices && !m->mVertices)
            return err_set(err, "%s: its vertices have no coordinates", path);
    }
    return *triangles ||
           err_set(err, "%s: expected triangles, and there are none", path);
}

static void put3(float *to, struct vec3 v)
{
    to[0] = (float)v.x, to[1] = (float)v.y, to[2] = (float)v.z;
}

static struct vec3 vector(struct aiVector3D v)
{
    return (struct vec3){ (double)v.x, (double)v.y, (double)v.z };
}

/* The direction of a normal; what has none has none. */
static struct vec3 direction(struct vec3 n)
{
    const double length = vec3_length(n);
    return length > 0 ? vec3_scale(1 / length, n) : n;
}

/* Appends one of assimp's meshes, faces as triangles around their first corner.
 * assimp's own ways to make triangles and to check indices end the program
 * where a file is odd. */
static bool append(struct mesh *m, size_t *vertex, size_t *triangle,
                   const struct aiMesh *from, bool normals,
                   const struct meshfile_options *o, const char *path,
                   struct err *err)
{
    for (unsigned i = 0; i < from->mNumFaces; i++) {
        const struct aiFace *f = &from->mFaces[i];
        for (unsigned k = 0; k < f->mNumIndices; k++)
            if (f->mIndices[k] >= from->mNumVertices)
                return err_set(err,
                               "%s: a face has vertex %u: expected a number "
                               "below %u, as many as there are",
                               path, f->mIndices[k], from->mNumVertices);
        for (unsigned k = 2; k < f->mNumIndices; k++, ++*triangle) {
            const unsigned corner[] = { 0, o->flip_normals ? k : k - 1,
                                        o->flip_normals ? k - 1 : k };
            for (int j = 0; j < 3; j++)
                m->index[3 * *triangle + (size_t)j] =
                    (unsigned)(*vertex + f->mIndices[corner[j]]);
        }
    }
    for (unsigned i = 0; i < from->mNumVertices; i++, ++*vertex) {
        put3(m->xyz + 3 * *vertex,
             affine_point(&o->to_world, vector(from->mVertices[i])));
        if (!normals)
            continue;
        const struct vec3 n =
            affine_normal(&o->to_world, vector(from->mNormals[i]));
        put3(m->normal + 3 * *vertex,
             direction(vec3_scale(o->flip_normals ? -1 : 1, n)));
    }
    return true;
}

static struct mesh *convert(const struct aiScene *a, const char *path,
                            const struct meshfile_options *o, struct err *err)
{
    size_t vertices, triangles, vertex = 0, triangle = 0;
    bool normals;
    if (!counted(a, path, &vertices, &triangles, &normals, err))
        return NULL;
    normals &= !o->face_normals;
    struct mesh *m = mesh_new(vertices, triangles, normals, err);
    for (unsigned i = 0; m && i < a->mNumMeshes; i++)
        if (!append(m, &vertex, &triangle, a->mMeshes[i], normals, o, path,
                    err)) {
            mesh_free(m);
            return NULL;
        }
    if (m && mesh_check(m, path, err) &&
        (normals || o->face_normals || mesh_smooth(m, err)))
        return m;
    mesh_free(m);
    return NULL;
}

struct mesh *meshfile_read(const char *path,
                           const struct meshfile_options *options,
                           struct err *err)
{
    size_t bytes;
    const char *ending = strrchr(path, '.');
    const bool ply = ending && strcasecmp(ending, ".ply") == 0;
    struct mesh *m = NULL;
    if (!ply && !(ending && strcasecmp(ending, ".obj") == 0)) {
        err_set(err, "%s: expected a name that ends in .ply or .obj", path);
        return NULL;
    }
    char *text = xml_read_file(path, &bytes, err);
    if (text && !ply) {
        char *const written = with_digits(text, &bytes);
        free(text);
        text = written;
        if (!text)
            err_set(err, "%s: out of memory", path);
    }
    if (!text)
        return NULL;
    if (bytes == 0)
        err_set(err, "%s: it is empty", path);
    else if (ply ? ply_check(path, text, bytes, err)
                 : obj_check(path, text, err)) {
        const struct aiScene *a = aiImportFileFromMemory(
            text, (unsigned)bytes, ply ? 0 : aiProcess_JoinIdenticalVertices,
            ply ? "ply" : "obj");
        if (a)
            m = convert(a, path, options, err);
        else
            err_set(err, "%s: %.300s", path, aiGetErrorString());
        aiReleaseImport(a);
    }
    free(text);
    return m;
}
