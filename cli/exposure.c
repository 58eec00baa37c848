#include "exposure.h"

#include "message.h"

static void tell_of(NephExposure is, float better, const exposure_wish *wish)
{
    const char *looks = is == NEPH_EXPOSURE_DARK ? "black" : "white";
    if (is == NEPH_EXPOSURE_BLACK)
        tell("warning", "the picture is black: no light reaches what the camera sees");
    else if (!wish->is_free)
        tell("warning", "the picture is nearly %s: '--exposure %g' shows it", looks,
             (double)better);
    else if (!wish->no_notes)
        tell("note",
             "pictures of eight bits would be nearly %s and are exposed by %+g stops: "
             "'--exposure 0' leaves them",
             looks, (double)better);
}

float exposure_of(const NephImage *image, const exposure_wish *wish, bool silent)
{
    float better;
    NephExposure is = neph_image_exposure(image, wish->stops, &better);
    if (is != NEPH_EXPOSURE_GOOD && !silent)
        tell_of(is, better, wish);
    return wish->is_free ? better : wish->stops;
}

bool has_eight_bits(const char *path)
{
    bool has;
    neph_image_is_written(path, &has);
    return has;
}
