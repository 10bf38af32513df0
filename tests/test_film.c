/* test_film.c - pictures come back from files as they were, or not at all */
#include "integrator/film.h"

#include <errno.h>
#include <fcntl.h>
#include <png.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <OpenEXR/openexr.h>

#include "bsdf/rng.h"
#include "tests/close.h"
#include "tests/shell.h"

struct bytes {
    unsigned char *data;
    size_t size;
};

static struct bytes slurp(const char *path)
{
    FILE *f = fopen(path, "rb");
    struct bytes b = { .size = 0 };
    assert_non_null(f);
    assert_int_equal(fseek(f, 0, SEEK_END), 0);
    b.size = (size_t)ftell(f);
    rewind(f);
    b.data = malloc(b.size + 1);
    assert_non_null(b.data);
    assert_int_equal(fread(b.data, 1, b.size, f), b.size);
    fclose(f);
    return b;
}

static void spill(const char *path, const void *data, size_t size)
{
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(data, 1, size, f), size);
    fclose(f);
}

static unsigned char *find(struct bytes b, const char *what, size_t size)
{
    unsigned char *found = memmem(b.data, b.size, what, size);
    assert_non_null(found);
    return found;
}

/* -- films ----------------------------------------------------------------- */

static const struct film_note notes[] = { { "scene", "a b\xc3\xbc" },
                                          { "seed", "17" },
                                          { NULL, NULL } };

/* All bits are random: NaNs, denormals, infinities, negative zeros. */
static struct film *random_film(int width, int height, uint64_t stream)
{
    struct film *f = film_new(width, height, NULL);
    assert_non_null(f);
    uint32_t *word = (uint32_t *)f->pixel;
    const size_t n = (size_t)width * (size_t)height * sizeof *f->pixel / 4;
    for (size_t i = 0; i < n; i++)
        word[i] = (uint32_t)(rng_uniform((struct rng){ 3, stream }, i).x *
                             4294967296);
    return f;
}

static void assert_same(const struct film *a, const struct film *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_memory_equal(a->pixel, b->pixel,
                        (size_t)a->width * (size_t)a->height *
                            sizeof *a->pixel);
}

static struct film *read_or_fail(const char *path)
{
    struct err err;
    struct film *f = film_read_exr(path, &err);
    if (!f)
        fail_msg("%s", err.text);
    return f;
}

static void write_or_fail(const struct film *f, const char *path)
{
    struct err err;
    if (!film_write_exr(f, path, notes, &err))
        fail_msg("%s", err.text);
}

/* The error of reading, which names the path and the text. */
static void assert_refused(const char *path, const char *text)
{
    struct err err = { "" };
    assert_null(film_read_exr(path, &err));
    assert_has(err.text, path);
    assert_has(err.text, text);
}

static void every_bit_comes_back(void **state)
{
    static const int sizes[][2] = { { 1, 1 },   { 17, 33 }, { 100, 16 },
                                    { 3, 200 }, { 1, 15 },  { 301, 1 } };
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        const char *path = in_folder("a.exr");
        struct film *f = random_film(sizes[i][0], sizes[i][1], i);
        write_or_fail(f, path);
        struct film *g = read_or_fail(path);
        assert_same(f, g);
        film_free(f);
        film_free(g);
    }
}

static void the_same_film_gives_the_same_bytes(void **state)
{
    struct film *f = random_film(37, 41, 1);
    (void)state;
    write_or_fail(f, in_folder("a.exr"));
    struct bytes a = slurp(in_folder("a.exr"));
    write_or_fail(f, in_folder("b.exr"));
    struct bytes b = slurp(in_folder("b.exr"));
    assert_int_equal(a.size, b.size);
    assert_memory_equal(a.data, b.data, a.size);
    find(a, "scene\0string\0\5\0\0\0a b\xc3\xbc", 22);
    find(a, "seed\0string\0\2\0\0\00017", 18);
    film_free(f);
    free(a.data);
    free(b.data);
}

static void the_sizes_of_films_are_bounded(void **state)
{
    struct err err;
    (void)state;
    assert_null(film_new(0, 5, &err));
    assert_has(err.text, "0 x 5");
    assert_null(film_new(65537, 1, &err));
    assert_null(film_new(1, -1, &err));
    assert_null(film_new(65536, 4097, &err));
    assert_has(err.text, "65536 x 4097");
    assert_true(film_size_ok(65536, 4096));
}

/* -- writing --------------------------------------------------------------- */

/* A process that writes the one film and the other in turn is killed at some
 * moment, over and over: one of the two is there, whole. */
static void a_kill_leaves_the_old_or_the_new(void **state)
{
    struct film *a = random_film(120, 90, 5), *b = random_film(120, 90, 6);
    (void)state;
    const char *path = in_folder("killed.exr");
    write_or_fail(a, path);
    for (int i = 0; i < 25; i++) {
        const pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0)
            for (;;) {
                film_write_exr(b, path, notes, NULL);
                film_write_exr(a, path, notes, NULL);
            }
        usleep((useconds_t)(500 + 1709 * i));
        kill(child, SIGKILL);
        waitpid(child, NULL, 0);
        struct film *f = read_or_fail(path);
        assert_same(f, f->pixel[0].count == a->pixel[0].count ? a : b);
        film_free(f);
    }
    film_free(a);
    film_free(b);
}

static void what_cannot_be_written_is_named(void **state)
{
    struct film *f = random_film(300, 200, 7);
    struct err err;
    (void)state;
    for (size_t i = 0; i < (size_t)f->width * (size_t)f->height; i++)
        f->pixel[i].mean[0] = 0.3f;
    assert_false(film_write_exr(f, "/dev/full", NULL, &err));
    assert_has(err.text, "/dev/full: cannot be written: No space left");
    assert_false(film_write_png(f, "/dev/full", FILM_SRGB, 1, &err));
    assert_has(err.text, "/dev/full: cannot be written: No space left");
    assert_false(film_write_exr(f, "/no/such/a.exr", NULL, &err));
    assert_has(err.text, "/no/such/a.exr: cannot be written: No such file");
    assert_false(film_write_exr(f, folder, NULL, &err));
    assert_has(err.text, folder);

    const char *fifo = in_folder("fifo");
    assert_int_equal(mkfifo(fifo, 0600), 0);
    const int fd = open(fifo, O_RDONLY | O_NONBLOCK);
    assert_false(film_write_exr(f, fifo, NULL, &err));
    assert_has(err.text, "pipe");
    close(fd);
    film_free(f);
}

/* Notes that the format keeps for itself, or that are too long for it: nothing
 * is written. */
static void a_failure_leaves_what_was_there(void **state)
{
    char longest[300];
    const struct film_note bad[][2] = { { { "channels", "x" } },
                                        { { "", "x" } },
                                        { { longest, "x" } } };
    struct film *f = random_film(5, 5, 8);
    struct err err;
    (void)state;
    memset(longest, 'n', sizeof longest - 1);
    longest[sizeof longest - 1] = 0;
    const char *path = in_folder("old.exr");
    write_or_fail(f, path);
    for (size_t i = 0; i < 3; i++) {
        assert_false(film_write_exr(f, path, bad[i], &err));
        assert_has(err.text, path);
        struct film *g = read_or_fail(path);
        assert_same(f, g);
        film_free(g);
    }
    film_free(f);
}

static void notes_may_be_empty_or_have_long_names(void **state)
{
    static const struct film_note odd[] = {
        { "empty", "" },
        { "a_name_of_more_than_thirty_one_letters", "x" },
        { NULL, NULL }
    };
    struct film *f = random_film(5, 5, 8);
    struct err err = { "" };
    (void)state;
    const char *path = in_folder("notes.exr");
    if (!film_write_exr(f, path, odd, &err))
        fail_msg("%s", err.text);
    struct film *g = read_or_fail(path);
    assert_same(f, g);
    film_free(f);
    film_free(g);
}

/* -- files of others ------------------------------------------------------- */

struct foreign {
    exr_storage_t storage;
    exr_compression_t compression;
    exr_pixel_type_t type; /* of R, G and B; data are float or of the type */
    bool second_part, no_green, subsampled, cropped, falling, half_count;
};

static void check(exr_result_t r)
{
    if (r != EXR_ERR_SUCCESS)
        fail_msg("%s", exr_get_default_error_message(r));
}

static void print(exr_const_context_t c, exr_result_t r, const char *text)
{
    (void)c;
    (void)r;
    print_message("%s\n", text);
}

/* By the library itself a file without its pixels would be removed. */
static int64_t put(exr_const_context_t c, void *file, const void *data,
                   uint64_t size, uint64_t offset,
                   exr_stream_error_func_ptr_t error)
{
    (void)c;
    (void)error;
    assert_int_equal(fseek(file, (long)offset, SEEK_SET), 0);
    assert_int_equal(fwrite(data, 1, size, file), size);
    return (int64_t)size;
}

enum { W = 22, H = 37 };

/* Multiples of 2^-8, which a half can tell. */
static float foreign_value(int x, int y, int c)
{
    return (float)(c + 1) / 4 + (float)(x + 3 * y) / 256;
}

static void declare(exr_context_t context, const struct foreign *f, int part)
{
    const exr_attr_box2i_t display = { { .x = -4, .y = 5 },
                                       { .x = W - 5, .y = H + 4 } };
    exr_attr_box2i_t data = display;
    const exr_attr_v2f_t center = { 0 };
    data.max.x -= f->cropped;
    check(exr_initialize_required_attr(
        context, part, &display, &data, 1, &center, 1,
        f->falling ? EXR_LINEORDER_DECREASING_Y : EXR_LINEORDER_INCREASING_Y,
        f->compression));
    if (f->storage == EXR_STORAGE_TILED || f->storage == EXR_STORAGE_DEEP_TILED)
        check(exr_set_tile_descriptor(context, part, 16, 16, EXR_TILE_ONE_LEVEL,
                                      EXR_TILE_ROUND_DOWN));
    static const char *const names[3] = { "R", "G", "B" };
    for (int c = 0; c < 3; c++)
        if (c != 1 || !f->no_green)
            check(exr_add_channel(context, part, names[c], f->type,
                                  EXR_PERCEPTUALLY_LINEAR,
                                  f->subsampled ? 2 : 1, 1));
    if (f->storage == EXR_STORAGE_DEEP_SCANLINE ||
        f->storage == EXR_STORAGE_DEEP_TILED)
        check(exr_set_version(context, part, 1));
    if (f->half_count)
        check(exr_add_channel(context, part, "count", EXR_PIXEL_HALF,
                              EXR_PERCEPTUALLY_LINEAR, 1, 1));
}

static void encode_lines(exr_context_t context, const float *rgb, int y,
                         bool first, exr_encode_pipeline_t *pipe)
{
    exr_chunk_info_t chunk;
    check(exr_write_scanline_chunk_info(context, 0, 5 + y, &chunk));
    check(first ? exr_encoding_initialize(context, 0, &chunk, pipe)
                : exr_encoding_update(context, 0, &chunk, pipe));
    for (int i = 0; i < pipe->channel_count; i++) {
        exr_coding_channel_info_t *info = &pipe->channels[i];
        const int c = (int)(strchr("RGB", info->channel_name[0]) - "RGB");
        info->user_data_type = EXR_PIXEL_FLOAT;
        info->user_bytes_per_element = 4;
        info->user_pixel_stride = 12;
        info->user_line_stride = 12 * W;
        info->encode_from_ptr = (const uint8_t *)(rgb + 3 * W * y + c);
    }
    if (first)
        check(exr_encoding_choose_default_routines(context, 0, pipe));
    check(exr_encoding_run(context, 0, pipe));
}

static void encode(exr_context_t context)
{
    static float rgb[H * W * 3];
    exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
    int32_t lines = 1;
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            for (int c = 0; c < 3; c++)
                rgb[3 * (y * W + x) + c] = foreign_value(x, y, c);
    check(exr_get_scanlines_per_chunk(context, 0, &lines));
    for (int y = 0; y < H; y += lines)
        encode_lines(context, rgb, y, y == 0, &pipe);
    exr_encoding_destroy(context, &pipe);
}

/* Only the header where the storage is not in lines. */
static void write_foreign(const struct foreign *f, const char *path)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t context;
    init.error_handler_fn = print;
    init.write_fn = put;
    init.user_data = fopen(path, "wb");
    assert_non_null(init.user_data);
    check(exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, &init));
    for (int i = 0; i <= f->second_part; i++) {
        int part;
        check(exr_add_part(context, i ? "two" : "one", f->storage, &part));
        declare(context, f, part);
    }
    check(exr_write_header(context));
    if (f->storage == EXR_STORAGE_SCANLINE && !f->second_part && !f->no_green &&
        !f->subsampled && !f->cropped && !f->half_count &&
        f->type != EXR_PIXEL_UINT)
        encode(context);
    exr_finish(&context);
    fclose(init.user_data);
}

static void other_pictures_in_lines_are_read(void **state)
{
    static const struct foreign kinds[] = {
        { .compression = EXR_COMPRESSION_NONE, .type = EXR_PIXEL_FLOAT },
        { .compression = EXR_COMPRESSION_RLE, .type = EXR_PIXEL_HALF },
        { .compression = EXR_COMPRESSION_ZIPS, .type = EXR_PIXEL_FLOAT },
        { .compression = EXR_COMPRESSION_ZIP, .type = EXR_PIXEL_HALF },
        { .compression = EXR_COMPRESSION_PIZ, .type = EXR_PIXEL_HALF },
        { .compression = EXR_COMPRESSION_ZIP,
          .type = EXR_PIXEL_FLOAT,
          .falling = true },
    };
    (void)state;
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        const char *path = in_folder("foreign.exr");
        write_foreign(&kinds[i], path);
        struct film *f = read_or_fail(path);
        assert_int_equal(f->width, W);
        assert_int_equal(f->height, H);
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++) {
                const struct film_pixel *p = &f->pixel[y * W + x];
                for (int c = 0; c < 3; c++)
                    assert_true(p->mean[c] == foreign_value(x, y, c));
                assert_true(isnan(p->variance[2]));
                assert_true(isnan(p->luminance_variance));
                assert_true(p->count == 0 && p->depth == 0 &&
                            p->normal[1] == 0 && p->albedo[2] == 0);
            }
        film_free(f);
    }
}

static void pictures_of_another_nature_are_refused(void **state)
{
    static const struct {
        struct foreign f;
        const char *why;
    } cases[] = {
        { { .storage = EXR_STORAGE_TILED, .type = EXR_PIXEL_FLOAT }, "tiled" },
        { { .storage = EXR_STORAGE_DEEP_SCANLINE, .type = EXR_PIXEL_FLOAT },
          "deep" },
        { { .storage = EXR_STORAGE_DEEP_TILED, .type = EXR_PIXEL_FLOAT },
          "deep" },
        { { .type = EXR_PIXEL_FLOAT, .second_part = true }, "2 parts" },
        { { .type = EXR_PIXEL_FLOAT, .no_green = true },
          "channel G is missing" },
        { { .type = EXR_PIXEL_UINT },
          "channel R is of 32-bit whole numbers, expected float or half" },
        { { .type = EXR_PIXEL_FLOAT, .subsampled = true },
          "a sample every 2 x 1 pixels" },
        { { .type = EXR_PIXEL_FLOAT, .cropped = true },
          "not the display window" },
        { { .type = EXR_PIXEL_FLOAT, .half_count = true },
          "channel count is of half, expected 32-bit whole "
          "numbers or float" },
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *path = in_folder("nature.exr");
        write_foreign(&cases[i].f, path);
        assert_refused(path, cases[i].why);
    }
}

/* -- broken files ---------------------------------------------------------- */

static void no_picture_is_refused(void **state)
{
    (void)state;
    assert_refused(folder, "expected a regular file");
    assert_refused("/dev/zero", "expected a regular file");
    assert_refused("/no/such.exr", "No such file");
    spill(in_folder("empty.exr"), "", 0);
    assert_refused(in_folder("empty.exr"), ": ");
    spill(in_folder("text.exr"), "<svg>What is this, a picture?</svg>", 35);
    assert_refused(in_folder("text.exr"), "not an OpenEXR");
}

static void every_cut_is_refused(void **state)
{
    struct film *f = random_film(5, 19, 9);
    const char *path = in_folder("cut.exr");
    (void)state;
    write_or_fail(f, path);
    struct bytes b = slurp(path);
    for (size_t size = 0; size < b.size; size++) {
        spill(path, b.data, size);
        assert_refused(path, ": ");
    }
    free(b.data);
    film_free(f);
}

/* Any answer will do, as long as there is one. */
static void no_broken_byte_does_harm(void **state)
{
    static const unsigned char flips[] = { 0x01, 0x80, 0xff };
    struct film *f = random_film(5, 19, 9);
    const char *path = in_folder("flip.exr");
    (void)state;
    write_or_fail(f, path);
    struct bytes b = slurp(path);
    for (size_t i = 0; i < b.size && i < 2000; i++)
        for (size_t k = 0; k < sizeof flips; k++) {
            struct err err;
            b.data[i] ^= flips[k];
            spill(path, b.data, b.size);
            film_free(film_read_exr(path, &err));
            b.data[i] ^= flips[k];
        }
    free(b.data);
    film_free(f);
}

/* The header of a small picture with other windows in it. */
static void claim(const char *path, const int32_t window[4])
{
    static const char *const names[2] = { "dataWindow", "displayWindow" };
    struct bytes b = slurp(path);
    for (int i = 0; i < 2; i++)
        memcpy(find(b, names[i], strlen(names[i])) + strlen(names[i]) + 11,
               window, 16);
    spill(path, b.data, b.size);
    free(b.data);
}

static void claims_are_held_against_the_file(void **state)
{
    static const struct {
        int32_t window[4];
        const char *why;
    } cases[] = {
        { { 0, 0, 65535, 4095 }, "can hold" },
        { { 0, 0, 65536, 10 }, "" },
        { { 0, 0, 65535, 65535 }, "" },
        { { 5, 5, 4, 4 }, "" },
        { { -2147483647 - 1, 0, 2147483647, 0 }, "" },
        { { 0, 0, 0, 2147483647 }, "" },
    };
    struct film *f = random_film(2, 2, 10);
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *path = in_folder("claim.exr");
        write_or_fail(f, path);
        claim(path, cases[i].window);
        assert_refused(path, cases[i].why);
    }
    film_free(f);
}

/* -- PNG ------------------------------------------------------------------- */

static struct film *row(const float (*rgb)[3], int n)
{
    struct film *f = film_new(n, 1, NULL);
    assert_non_null(f);
    for (int i = 0; i < n; i++)
        memcpy(f->pixel[i].mean, rgb[i], sizeof rgb[i]);
    return f;
}

static struct png read_png(const char *path)
{
    struct err err;
    struct png png;
    if (!png_read(&png, path, &err))
        fail_msg("%s", err.text);
    return png;
}

static const float shades[][3] = {
    { 0.5f, 0.25f, 0.18f },     { 0.001f, 0.9f, 0.05f }, { -1, 1, 2 },
    { 0, INFINITY, -INFINITY }, { 0.2f, NAN, 0.3f },
};
enum { SHADES = sizeof shades / sizeof shades[0] };

/* By the formulas, in double, elsewhere. */
static void tones_are_as_defined(void **state)
{
    static const unsigned char srgb[SHADES][3] = { { 188, 137, 118 },
                                                   { 3, 243, 63 },
                                                   { 0, 255, 255 },
                                                   { 0, 255, 0 },
                                                   { 255, 0, 255 } };
    static const unsigned char course[SHADES][3] = { { 217, 158, 136 },
                                                     { 12, 255, 76 },
                                                     { 0, 255, 255 },
                                                     { 0, 255, 0 },
                                                     { 255, 0, 255 } };
    struct film *f = row(shades, SHADES);
    struct err err;
    (void)state;
    assert_true(film_write_png(f, in_folder("s.png"), FILM_SRGB, 1, &err));
    struct png png = read_png(in_folder("s.png"));
    assert_memory_equal(png.rgb, srgb, sizeof srgb);
    free(png.rgb);
    assert_true(film_write_png(f, in_folder("c.png"), FILM_COURSE, 1, &err));
    png = read_png(in_folder("c.png"));
    assert_memory_equal(png.rgb, course, sizeof course);
    free(png.rgb);
    assert_true(film_write_png(f, in_folder("e.png"), FILM_SRGB, 2, &err));
    png = read_png(in_folder("e.png"));
    assert_int_equal(png.rgb[0], 255);
    assert_int_equal(png.rgb[1], 188);
    free(png.rgb);
    struct bytes b = slurp(in_folder("s.png"));
    find(b, "\0\0\0\1sRGB", 8);
    free(b.data);
    film_free(f);
}

static void rates_go_from_blue_to_red(void **state)
{
    static const uint32_t counts[] = { 0, 16, 32, 48, 64, 100 };
    static const unsigned char expected[6][3] = {
        { 0, 0, 255 },   { 0, 127, 127 }, { 0, 255, 0 },
        { 127, 127, 0 }, { 255, 0, 0 },   { 255, 0, 0 },
    };
    struct film *f = film_new(6, 1, NULL);
    struct err err;
    (void)state;
    for (int i = 0; i < 6; i++)
        f->pixel[i].count = counts[i];
    assert_true(film_write_rate(f, in_folder("r.png"), 64, &err));
    struct png png = read_png(in_folder("r.png"));
    assert_memory_equal(png.rgb, expected, sizeof expected);
    free(png.rgb);
    film_free(f);
}

/* What others write, through libpng. */
static void other_pngs_become_rgb(void **state)
{
    static const unsigned char grey[2] = { 17, 200 };
    static const unsigned char rgba[8] = { 1, 2, 3, 255, 9, 9, 9, 0 };
    static const unsigned char grey_as[6] = { 17, 17, 17, 200, 200, 200 };
    static const unsigned char rgba_as[6] = { 1, 2, 3, 0, 0, 0 };
    png_image image = { .version = PNG_IMAGE_VERSION, .width = 2, .height = 1 };
    (void)state;
    image.format = PNG_FORMAT_GRAY;
    assert_true(
        png_image_write_to_file(&image, in_folder("g.png"), 0, grey, 0, NULL));
    struct png png = read_png(in_folder("g.png"));
    assert_int_equal(png.width, 2);
    assert_memory_equal(png.rgb, grey_as, 6);
    free(png.rgb);
    image.format = PNG_FORMAT_RGBA;
    assert_true(
        png_image_write_to_file(&image, in_folder("a.png"), 0, rgba, 0, NULL));
    png = read_png(in_folder("a.png"));
    assert_memory_equal(png.rgb, rgba_as, 6);
    free(png.rgb);
}

static void broken_pngs_are_refused(void **state)
{
    const char *path = in_folder("broken.png");
    struct film *f = row(shades, SHADES);
    struct err err;
    struct png png;
    (void)state;
    assert_true(film_write_png(f, path, FILM_SRGB, 1, &err));
    film_free(f);
    struct bytes b = slurp(path);
    for (size_t size = 0; size + 16 < b.size; size++) {
        spill(path, b.data, size);
        assert_false(png_read(&png, path, &err));
        assert_has(err.text, path);
        assert_null(png.rgb);
    }
    for (size_t i = 0; i < b.size; i++) {
        b.data[i] ^= 0x55;
        spill(path, b.data, b.size);
        if (png_read(&png, path, &err))
            free(png.rgb);
        b.data[i] ^= 0x55;
    }
    free(b.data);
    assert_false(png_read(&png, folder, &err));
    assert_has(err.text, folder);
}

/* A header of 30000 x 8000 pixels, its checksum right, and nothing after it. */
static void pngs_cannot_claim_more_than_they_hold(void **state)
{
    static const unsigned char header[] = {
        0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0,    0, 0,    13,
        'I',  'H', 'D', 'R', 0,    0,    0x75, 0x30, 0,    0, 0x1f, 0x40,
        8,    2,   0,   0,   0,    0x0,  0x0,  0x0,  0x0,  0, 0,    0,
        0,    'I', 'D', 'A', 'T',  0x35, 0xaf, 0x06, 0x1e,
    };
    unsigned char data[sizeof header];
    struct err err;
    struct png png;
    (void)state;
    memcpy(data, header, sizeof data);
    uint32_t crc = ~0u;
    for (int i = 12; i < 29; i++)
        for (int k = 0; k < 8; k++) {
            if (k == 0)
                crc ^= data[i];
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
        }
    for (int i = 0; i < 4; i++)
        data[29 + i] = (unsigned char)(~crc >> (24 - 8 * i));
    spill(in_folder("claim.png"), data, sizeof data);
    assert_false(png_read(&png, in_folder("claim.png"), &err));
    assert_has(err.text, "claims 30000 x 8000 pixels");
}

static int setup(void **state)
{
    (void)state;
    return shell_setup("film", "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        { "every bit of a film comes back", every_bit_comes_back },
        { "the same film and notes give the same bytes",
          the_same_film_gives_the_same_bytes },
        { "the sizes of films are bounded", the_sizes_of_films_are_bounded },
        { "a kill leaves the old film or the new one",
          a_kill_leaves_the_old_or_the_new },
        { "what cannot be written is named, and why",
          what_cannot_be_written_is_named },
        { "a failure leaves what was there", a_failure_leaves_what_was_there },
        { "notes may be empty or have long names",
          notes_may_be_empty_or_have_long_names },
        { "other pictures in scan lines are read",
          other_pictures_in_lines_are_read },
        { "pictures of another nature are refused",
          pictures_of_another_nature_are_refused },
        { "what is no picture is refused", no_picture_is_refused },
        { "a film cut off anywhere is refused", every_cut_is_refused },
        { "no broken byte does harm", no_broken_byte_does_harm },
        { "what a header claims is held against the file",
          claims_are_held_against_the_file },
        { "tones are as defined", tones_are_as_defined },
        { "rates go from blue over green to red", rates_go_from_blue_to_red },
        { "PNGs of other kinds become RGB", other_pngs_become_rgb },
        { "broken PNGs are refused", broken_pngs_are_refused },
        { "PNGs cannot claim more than they hold",
          pngs_cannot_claim_more_than_they_hold },
    };
    return cmocka_run_group_tests_name("film", tests, setup, shell_teardown);
}
