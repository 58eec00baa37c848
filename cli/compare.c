/*
 * nephroid compare: how far an image is from a reference.
 */
#include "arguments.h"
#include "command.h"
#include "message.h"

#include <math.h>
#include <string.h>

static gboolean as_json;
static char *metric, *output, *layer;

static const GOptionEntry entries[] = {
    {"metric", 'm', 0, G_OPTION_ARG_STRING, &metric,
     "Only one number: rmse, relmse, psnr or flip", "NAME"},
    {"layer", 0, 0, G_OPTION_ARG_STRING, &layer,
     "This layer of IMAGE in place of R, G and B: denoised, caustic ...", "NAME"},
    {"output", 'o', 0, G_OPTION_ARG_FILENAME, &output,
     "Write where they differ as an image: red is brighter than the reference, blue is "
     "darker",
     "FILE"},
    {"json", 0, 0, G_OPTION_ARG_NONE, &as_json, "For programs", NULL},
    G_OPTION_ENTRY_NULL};

static const usage how = {
    .name = "compare",
    .operands = "IMAGE REFERENCE",
    .n_operands = 2,
    .summary = "Measures how far an image is from a reference of the same size, over R, "
               "G and B.",
    .description = "rmse    root of the mean squared difference\n"
                   "relmse  mean of (a - b)² / (b² + 0.01), b the reference\n"
                   "psnr    dB, sRGB-encoded and clipped to 0..1\n"
                   "flip    mean error of FLIP (Andersson et al. 2020), 67 pixels a "
                   "degree\n\n"
                   "With -o, half of the reference's luminance off is the end of the "
                   "scale, white.\n",
    .entries = entries};

static const struct {
    const char *name;
    size_t offset;
} metrics[] = {
    {"rmse", offsetof(NephImageDifference, rmse)},
    {"relmse", offsetof(NephImageDifference, relmse)},
    {"psnr", offsetof(NephImageDifference, psnr)},
    {"flip", offsetof(NephImageDifference, flip)},
};

/* Index of the metric asked for, or -1. */
static int find_metric(void)
{
    for (int i = 0; i < (int)G_N_ELEMENTS(metrics); i++)
        if (strcmp(metrics[i].name, metric) == 0)
            return i;
    return -1;
}

static bool write_map(const NephImage *image, const NephImage *reference, GError **error)
{
    if (!output)
        return true;
    g_autoptr(NephImage) map = neph_image_difference_map(image, reference, error);
    return map && neph_image_write(map, output, 0.0f, error);
}

static bool compare_files(char *const names[2], NephImageDifference *out, GError **error)
{
    const char *const inputs[] = {names[0], names[1], NULL};
    if (output && (!neph_file_spares(output, inputs, error) ||
                   !neph_image_can_write(output, error)))
        return false;
    g_autoptr(NephImage) image = neph_image_read(names[0], error);
    if (image && layer) {
        g_autoptr(NephImage) whole = image;
        image = neph_image_layer(whole, layer, error);
    }
    g_autoptr(NephImage) reference = image ? neph_image_read(names[1], error) : NULL;
    return reference && neph_image_compare(image, reference, out, error) &&
           write_map(image, reference, error);
}

static int print_metric(const NephImageDifference *d, int which)
{
    double value = *(const double *)((const char *)d + metrics[which].offset);
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    g_ascii_formatd(text, sizeof text, "%.9g", value);
    if (!as_json)
        return print_result("%s\n", text);
    return print_result("{\"%s\": %s}\n", metrics[which].name,
                        isfinite(value) ? text : "null");
}

int command_compare(int argc, char **argv)
{
    int exit_code;
    if (!arguments_parse(&how, &argc, &argv, &exit_code))
        return exit_code;
    int which = metric ? find_metric() : -1;
    if (metric && which < 0)
        return usage_error("--metric: expected rmse, relmse, psnr or flip, found '%s'",
                           metric);
    g_autoptr(GError) error = NULL;
    NephImageDifference difference;
    if (!compare_files(argv + 1, &difference, &error))
        return report_error(error);
    if (which >= 0)
        return print_metric(&difference, which);
    g_autofree char *text = neph_image_difference_text(&difference, as_json);
    return print_result("%s", text);
}
