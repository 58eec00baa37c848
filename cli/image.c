/*
 * nephroid image: images in another format or size, or side by side.
 */
#include "arguments.h"
#include "command.h"
#include "exposure.h"
#include "layers.h"
#include "message.h"

static struct {
    char *output, *size, *columns, *exposure, *layer;
} given;

static const GOptionEntry entries[] = {
    {"output", 'o', 0, G_OPTION_ARG_FILENAME, &given.output,
     "Write the image there: FORMATS", "FILE"},
    {"size", 0, 0, G_OPTION_ARG_STRING, &given.size,
     "Scale each image to so many pixels, by the mean over areas", "WxH"},
    {"layer", 0, 0, G_OPTION_ARG_STRING, &given.layer,
     "One layer of each EXR file, such as caustic or depth", "NAME"},
    {"columns", 0, 0, G_OPTION_ARG_STRING, &given.columns,
     "Columns of a sheet of several images; 1 if not given", "N"},
    {"exposure", 0, 0, G_OPTION_ARG_STRING, &given.exposure,
     "Brighten 8-bit images by so many stops", "STOPS"},
    G_OPTION_ENTRY_NULL};

static const usage how = {
    .name = "image",
    .operands = "IMAGE...",
    .n_operands = 1,
    .or_more = true,
    .summary = "Writes an image in another format or size; several as a contact sheet.",
    .entries = entries};

/* What the options mean, checked. */
typedef struct job {
    int width, height; /* 0: each its own */
    guint64 columns;
    double exposure;
} job;

static bool job_init(job *j, char **images, GError **error)
{
    *j = (job){.columns = 1};
    return (!given.size ||
            argument_size("--size", given.size, &j->width, &j->height, error)) &&
           (!given.columns ||
            argument_count("--columns", given.columns, 1, 1000, &j->columns, error)) &&
           (!given.exposure ||
            argument_real("--exposure", given.exposure, &j->exposure, error)) &&
           neph_file_spares(given.output, (const char *const *)images, error) &&
           neph_image_can_write(given.output, error);
}

static NephImage *read_one(const job *j, const char *path, GError **error)
{
    NephImage *image = neph_image_read(path, error);
    if (image && given.layer) {
        NephImage *whole = image;
        image = layer_picture(whole, given.layer, given.output, error);
        g_prefix_error(error, "%s: ", path);
        neph_image_free(whole);
    }
    if (!image || !j->width)
        return image;
    NephImage *scaled = neph_image_scale(image, j->width, j->height, error);
    neph_image_free(image);
    return scaled;
}

static void free_image(void *image)
{
    neph_image_free(image);
}

static bool write_one(const job *j, const NephImage *image, GError **error)
{
    const exposure_wish wish = {.stops = (float)j->exposure};
    float stops = exposure_of(image, &wish, !has_eight_bits(given.output));
    return neph_image_write(image, given.output, stops, error);
}

/* A single image keeps all its channels. */
static bool write_all(const job *j, char **paths, int n, GError **error)
{
    g_autoptr(GPtrArray) images = g_ptr_array_new_with_free_func(free_image);
    for (int i = 0; i < n; i++) {
        NephImage *image = read_one(j, paths[i], error);
        if (!image)
            return false;
        g_ptr_array_add(images, image);
    }
    if (n == 1)
        return write_one(j, images->pdata[0], error);
    g_autoptr(NephImage) sheet = neph_image_sheet((const NephImage *const *)images->pdata,
                                                  (size_t)n, j->columns, error);
    return sheet && write_one(j, sheet, error);
}

int command_image(int argc, char **argv)
{
    int exit_code;
    job j;
    g_autoptr(GError) error = NULL;
    if (!arguments_parse(&how, &argc, &argv, &exit_code))
        return exit_code;
    if (!given.output)
        return usage_error("-o FILE is missing");
    if (!job_init(&j, argv + 1, &error) || !write_all(&j, argv + 1, argc - 1, &error))
        return report_error(error);
    return EXIT_DONE;
}
