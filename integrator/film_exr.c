/* film_exr.c - pictures in OpenEXR files, by the format's C core
 *
 * Channels lie in the film as they are; the library is told where, and how far
 * one pixel is from the next.
 *
 * ASWF, Technical Introduction to OpenEXR, for what channels are called;
 * OpenEXR File Layout, for what a header may claim.
 */
#include "integrator/film.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <OpenEXR/openexr.h>

#include "bsdf/outfile.h"

/* Deflate makes 1032 bytes of one at the most (RFC 1951: 258 of two bits); no
 * other compression of the format is meant to do better. */
enum { INFLATES_TO = 1032 };

/* Of scan lines that are decoded at once [bytes]: ours have 75 MB at the widest
 * picture. */
static const uint64_t chunk_max = (uint64_t)1 << 29;

struct channel {
    const char *name;
    size_t offset; /* in struct film_pixel */
    exr_pixel_type_t type;
    bool required;
    float missing;
};

#define AT(field) offsetof(struct film_pixel, field)

static const struct channel channels[] = {
    { "R", AT(mean[0]), EXR_PIXEL_FLOAT, .required = true },
    { "G", AT(mean[1]), EXR_PIXEL_FLOAT, .required = true },
    { "B", AT(mean[2]), EXR_PIXEL_FLOAT, .required = true },
    { "Z", AT(depth), EXR_PIXEL_FLOAT },
    { "albedo.R", AT(albedo[0]), EXR_PIXEL_FLOAT },
    { "albedo.G", AT(albedo[1]), EXR_PIXEL_FLOAT },
    { "albedo.B", AT(albedo[2]), EXR_PIXEL_FLOAT },
    { "count", AT(count), EXR_PIXEL_UINT },
    { "normal.X", AT(normal[0]), EXR_PIXEL_FLOAT },
    { "normal.Y", AT(normal[1]), EXR_PIXEL_FLOAT },
    { "normal.Z", AT(normal[2]), EXR_PIXEL_FLOAT },
    { "variance.R", AT(variance[0]), EXR_PIXEL_FLOAT, .missing = NAN },
    { "variance.G", AT(variance[1]), EXR_PIXEL_FLOAT, .missing = NAN },
    { "variance.B", AT(variance[2]), EXR_PIXEL_FLOAT, .missing = NAN },
    { "variance.Y", AT(luminance_variance), EXR_PIXEL_FLOAT, .missing = NAN },
};
enum { CHANNELS = sizeof channels / sizeof channels[0] };

/* -- what both ways share -------------------------------------------------- */

/* The file that the library is given to read or write. */
struct stream {
    int fd;       /* to read */
    int64_t size; /* of it */
    FILE *file;   /* to write */
    int why;      /* errno of what failed */
};

/* The first that the library complained of since the last start.  It may hold
 * the context's lock when it does, so the stream cannot be asked for. */
static _Thread_local char complaint[256];

static void complain(exr_const_context_t context, exr_result_t code,
                     const char *text)
{
    (void)context;
    (void)code;
    if (!complaint[0])
        snprintf(complaint, sizeof complaint, "%s", text);
}

static exr_context_initializer_t initializer(struct stream *s)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    complaint[0] = 0;
    init.error_handler_fn = complain;
    init.user_data = s;
    return init;
}

static const struct channel *channel_of(const char *name)
{
    for (int i = 0; i < CHANNELS; i++)
        if (strcmp(channels[i].name, name) == 0)
            return &channels[i];
    return NULL;
}

/* Where the library finds or puts a chunk's channels, from line y on; others
 * are passed over. */
static void point(exr_coding_channel_info_t *info, int count,
                  const struct film *f, int y)
{
    for (int i = 0; i < count; i++) {
        const struct channel *c = channel_of(info[i].channel_name);
        info[i].decode_to_ptr = NULL;
        if (!c)
            continue;
        info[i].user_data_type = (uint16_t)c->type;
        info[i].user_bytes_per_element = 4;
        info[i].user_pixel_stride = sizeof(struct film_pixel);
        info[i].user_line_stride =
            (int32_t)sizeof(struct film_pixel) * f->width;
        info[i].decode_to_ptr =
            (uint8_t *)(f->pixel + (size_t)y * (size_t)f->width) + c->offset;
    }
}

/* -- writing --------------------------------------------------------------- */

static int64_t write_at(exr_const_context_t context, void *user,
                        const void *buffer, uint64_t size, uint64_t offset,
                        exr_stream_error_func_ptr_t error)
{
    (void)context;
    (void)error;
    struct stream *s = user;
    if (fseeko(s->file, (off_t)offset, SEEK_SET) == 0 &&
        fwrite(buffer, 1, size, s->file) == size)
        return (int64_t)size;
    if (!s->why)
        s->why = errno;
    return -1;
}

static exr_result_t describe(exr_context_t context, const struct film *f,
                             const struct film_note *notes)
{
    int part;
    exr_result_t r = exr_add_part(context, NULL, EXR_STORAGE_SCANLINE, &part);
    if (r == EXR_ERR_SUCCESS)
        r = exr_initialize_required_attr_simple(context, part, f->width,
                                                f->height, EXR_COMPRESSION_ZIP);
    for (int i = 0; i < CHANNELS && r == EXR_ERR_SUCCESS; i++)
        r = exr_add_channel(context, part, channels[i].name, channels[i].type,
                            EXR_PERCEPTUALLY_LINEAR, 1, 1);
    for (; notes && notes->name && r == EXR_ERR_SUCCESS; notes++)
        r = exr_attr_set_string(context, part, notes->name, notes->value);
    return r == EXR_ERR_SUCCESS ? exr_write_header(context) : r;
}

static exr_result_t encode(exr_context_t context, const struct film *f)
{
    exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_chunk_info_t chunk;
    int32_t lines = 1;
    exr_result_t r = exr_get_scanlines_per_chunk(context, 0, &lines);
    for (int y = 0; y < f->height && r == EXR_ERR_SUCCESS; y += lines) {
        r = exr_write_scanline_chunk_info(context, 0, y, &chunk);
        if (r != EXR_ERR_SUCCESS)
            break;
        r = y ? exr_encoding_update(context, 0, &chunk, &pipe)
              : exr_encoding_initialize(context, 0, &chunk, &pipe);
        if (r != EXR_ERR_SUCCESS)
            break;
        point(pipe.channels, pipe.channel_count, f, y);
        if (y == 0)
            r = exr_encoding_choose_default_routines(context, 0, &pipe);
        if (r == EXR_ERR_SUCCESS)
            r = exr_encoding_run(context, 0, &pipe);
    }
    exr_encoding_destroy(context, &pipe);
    return r;
}

static exr_result_t write_film(struct stream *s, const struct film *f,
                               const char *path, const struct film_note *notes)
{
    exr_context_initializer_t init = initializer(s);
    init.write_fn = write_at;
    exr_context_t context = NULL;
    exr_result_t r =
        exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, &init);
    if (r == EXR_ERR_SUCCESS)
        r = exr_set_longname_support(context, 1);
    if (r == EXR_ERR_SUCCESS)
        r = describe(context, f, notes);
    if (r == EXR_ERR_SUCCESS)
        r = encode(context, f);
    /* Which writes the table of chunks. */
    const exr_result_t end = context ? exr_finish(&context) : r;
    return r == EXR_ERR_SUCCESS ? end : r;
}

bool film_write_exr(const struct film *f, const char *path,
                    const struct film_note *notes, struct err *err)
{
    struct outfile out;
    if (!outfile_open(&out, path, err))
        return false;
    if (fseeko(out.stream, 0, SEEK_SET) != 0) {
        outfile_abandon(&out);
        return err_set(err, "%s: OpenEXR cannot be written to a pipe", path);
    }
    struct stream s = { .file = out.stream };
    const exr_result_t r = write_film(&s, f, path, notes);
    if (r == EXR_ERR_SUCCESS && !s.why)
        return outfile_close(&out, err);
    outfile_abandon(&out);
    return err_set(err, "%s: cannot be written: %s", path,
                   s.why          ? strerror(s.why)
                   : complaint[0] ? complaint
                                  : exr_get_default_error_message(r));
}

/* -- reading --------------------------------------------------------------- */

static int64_t read_at(exr_const_context_t context, void *user, void *buffer,
                       uint64_t size, uint64_t offset,
                       exr_stream_error_func_ptr_t error)
{
    (void)context;
    (void)error;
    struct stream *s = user;
    uint64_t done = 0;
    while (done < size) {
        const ssize_t n = pread(s->fd, (char *)buffer + done, size - done,
                                (off_t)(offset + done));
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0) {
            s->why = errno;
            return -1;
        }
        if (n == 0)
            break;
        done += (uint64_t)n;
    }
    return (int64_t)done;
}

static int64_t size_of(exr_const_context_t context, void *user)
{
    (void)context;
    return ((struct stream *)user)->size;
}

static bool open_stream(struct stream *s, const char *path, struct err *err)
{
    struct stat st;
    *s = (struct stream){ .fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC) };
    if (s->fd < 0)
        return err_set(err, "%s: cannot be read: %s", path, strerror(errno));
    if (fstat(s->fd, &st) == 0 && S_ISREG(st.st_mode)) {
        s->size = st.st_size;
        return true;
    }
    close(s->fd);
    return err_set(err, "%s: expected a regular file", path);
}

/* A header, as far as it is of use. */
struct header {
    exr_attr_box2i_t window;
    int width, height;
    const exr_attr_chlist_t *list;
};

static bool failed(exr_result_t r, const struct stream *s, const char *path,
                   struct err *err)
{
    if (r == EXR_ERR_SUCCESS)
        return false;
    err_set(err, "%s: %s", path,
            s->why         ? strerror(s->why)
            : complaint[0] ? complaint
                           : exr_get_default_error_message(r));
    return true;
}

static bool check_nature(exr_const_context_t context, const struct stream *s,
                         const char *path, struct err *err)
{
    int parts = 0;
    exr_storage_t storage;
    if (failed(exr_get_count(context, &parts), s, path, err))
        return false;
    if (parts != 1)
        return err_set(err, "%s: has %d parts, expected a single one", path,
                       parts);
    if (failed(exr_get_storage(context, 0, &storage), s, path, err))
        return false;
    if (storage != EXR_STORAGE_SCANLINE)
        return err_set(err, "%s: is %s, expected scan lines", path,
                       storage == EXR_STORAGE_TILED ? "tiled" : "deep");
    return true;
}

static bool check_windows(struct header *h, exr_const_context_t context,
                          const struct stream *s, const char *path,
                          struct err *err)
{
    exr_attr_box2i_t display;
    if (failed(exr_get_data_window(context, 0, &h->window), s, path, err) ||
        failed(exr_get_display_window(context, 0, &display), s, path, err))
        return false;
    const exr_attr_box2i_t *w = &h->window;
    const int64_t width = (int64_t)w->max.x - w->min.x + 1;
    const int64_t height = (int64_t)w->max.y - w->min.y + 1;
    if (!film_size_ok(width, height))
        return err_set(err,
                       "%s: claims %lld x %lld pixels, expected sides from 1 "
                       "to %d and at most %d pixels",
                       path, (long long)width, (long long)height, FILM_SIDE_MAX,
                       FILM_PIXELS_MAX);
    if (memcmp(w, &display, sizeof display) != 0)
        return err_set(err,
                       "%s: the data window, (%d, %d) to (%d, %d), is not the "
                       "display window: expected a picture that is not cropped",
                       path, w->min.x, w->min.y, w->max.x, w->max.y);
    h->width = (int)width;
    h->height = (int)height;
    return true;
}

static const exr_attr_chlist_entry_t *find(const exr_attr_chlist_t *list,
                                           const char *name)
{
    for (int i = 0; i < list->num_channels; i++)
        if (strcmp(list->entries[i].name.str, name) == 0)
            return &list->entries[i];
    return NULL;
}

static bool check_channel(const struct channel *c,
                          const exr_attr_chlist_entry_t *e, const char *path,
                          struct err *err)
{
    static const char *const names[] = { "32-bit whole numbers", "half",
                                         "float" };
    if (!e)
        return c->required
                   ? err_set(err, "%s: channel %s is missing", path, c->name)
                   : true;
    const exr_pixel_type_t type = e->pixel_type;
    if (type == (c->type == EXR_PIXEL_UINT ? EXR_PIXEL_HALF : EXR_PIXEL_UINT))
        return err_set(err, "%s: channel %s is of %s, expected %s", path,
                       c->name, names[type],
                       c->type == EXR_PIXEL_UINT
                           ? "32-bit whole numbers or float"
                           : "float or half");
    if (e->x_sampling != 1 || e->y_sampling != 1)
        return err_set(err,
                       "%s: channel %s has a sample every %d x %d pixels, "
                       "expected one a pixel",
                       path, c->name, e->x_sampling, e->y_sampling);
    return true;
}

/* Room is made for so much only as a file of that size can hold. */
static bool check_claims(const struct header *h, exr_const_context_t context,
                         const struct stream *s, const char *path,
                         struct err *err)
{
    uint64_t chunk = 0, pixel = 0;
    for (int i = 0; i < h->list->num_channels; i++)
        pixel += h->list->entries[i].pixel_type == EXR_PIXEL_HALF ? 2 : 4;
    const uint64_t all = pixel * (uint64_t)h->width * (uint64_t)h->height;
    if (all / INFLATES_TO > (uint64_t)s->size)
        return err_set(err,
                       "%s: claims %d x %d pixels of %llu bytes, more than its "
                       "%lld bytes can hold",
                       path, h->width, h->height, (unsigned long long)pixel,
                       (long long)s->size);
    if (failed(exr_get_chunk_unpacked_size(context, 0, &chunk), s, path, err))
        return false;
    if (chunk > chunk_max)
        return err_set(err,
                       "%s: claims %llu bytes of scan lines at once, expected "
                       "at most %llu",
                       path, (unsigned long long)chunk,
                       (unsigned long long)chunk_max);
    return true;
}

static bool check_header(struct header *h, exr_const_context_t context,
                         const struct stream *s, const char *path,
                         struct err *err)
{
    if (!check_nature(context, s, path, err) ||
        !check_windows(h, context, s, path, err) ||
        failed(exr_get_channels(context, 0, &h->list), s, path, err))
        return false;
    for (int i = 0; i < CHANNELS; i++)
        if (!check_channel(&channels[i], find(h->list, channels[i].name), path,
                           err))
            return false;
    return check_claims(h, context, s, path, err);
}

/* What the file does not have, in the lines that were read. */
static void fill(struct film *f, const struct header *h, int y, int lines)
{
    for (int i = 0; i < CHANNELS; i++) {
        if (find(h->list, channels[i].name) || !isnan(channels[i].missing))
            continue;
        for (int64_t k = (int64_t)y * f->width;
             k < (int64_t)(y + lines) * f->width; k++)
            memcpy((char *)(f->pixel + k) + channels[i].offset,
                   &channels[i].missing, sizeof(float));
    }
}

static exr_result_t decode(exr_const_context_t context, struct film *f,
                           const struct header *h)
{
    exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_chunk_info_t chunk;
    int32_t lines = 1;
    exr_result_t r = exr_get_scanlines_per_chunk(context, 0, &lines);
    for (int y = 0; y < f->height && r == EXR_ERR_SUCCESS; y += lines) {
        r = exr_read_scanline_chunk_info(context, 0, h->window.min.y + y,
                                         &chunk);
        if (r != EXR_ERR_SUCCESS)
            break;
        r = y ? exr_decoding_update(context, 0, &chunk, &pipe)
              : exr_decoding_initialize(context, 0, &chunk, &pipe);
        if (r != EXR_ERR_SUCCESS)
            break;
        point(pipe.channels, pipe.channel_count, f, y);
        r = exr_decoding_choose_default_routines(context, 0, &pipe);
        if (r == EXR_ERR_SUCCESS)
            r = exr_decoding_run(context, 0, &pipe);
        if (r == EXR_ERR_SUCCESS)
            fill(f, h, y, lines < f->height - y ? lines : f->height - y);
    }
    exr_decoding_destroy(context, &pipe);
    return r;
}

static struct film *read_film(struct stream *s, const char *path,
                              struct err *err)
{
    exr_context_initializer_t init = initializer(s);
    init.read_fn = read_at;
    init.size_fn = size_of;
    init.max_image_width = init.max_image_height = FILM_SIDE_MAX;
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    exr_context_t context = NULL;
    struct header h = { .list = NULL };
    struct film *f = NULL;
    const exr_result_t r = exr_start_read(&context, path, &init);
    if (!failed(r, s, path, err) && check_header(&h, context, s, path, err))
        f = film_new(h.width, h.height, err);
    if (f && failed(decode(context, f, &h), s, path, err)) {
        film_free(f);
        f = NULL;
    }
    if (context)
        exr_finish(&context);
    return f;
}

struct film *film_read_exr(const char *path, struct err *err)
{
    struct stream s;
    if (!open_stream(&s, path, err))
        return NULL;
    struct film *f = read_film(&s, path, err);
    close(s.fd);
    return f;
}
