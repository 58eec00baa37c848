#include "overrides.h"

#include "message.h"

#include <string.h>

static bool apply_pair(NephSettings *settings, const char *pair, GError **error)
{
    const char *equals = strchr(pair, '=');
    if (!equals) {
        g_set_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_USAGE,
                    "--set: expected name=value, found '%s'", pair);
        return false;
    }
    g_autofree char *name = g_strndup(pair, (gsize)(equals - pair));
    return neph_settings_set(settings, g_strstrip(name), equals + 1, error);
}

static bool apply_flag(NephSettings *settings, const char *name, const char *value,
                       GError **error)
{
    return !value || neph_settings_set(settings, name, value, error);
}

bool overrides_apply(const overrides *o, NephSettings *settings, GError **error)
{
    if ((o->time || o->noise) && !neph_settings_set(settings, "passes", "0", error))
        return false;
    if (o->preset && !neph_settings_load_preset(settings, o->preset, error))
        return false;
    if (o->file && !neph_settings_load(settings, o->file, error))
        return false;
    for (char **pair = o->set; pair && *pair; pair++)
        if (!apply_pair(settings, *pair, error))
            return false;
    return apply_flag(settings, "integrator", o->integrator, error) &&
           apply_flag(settings, "passes", o->passes, error) &&
           apply_flag(settings, "time", o->time, error) &&
           apply_flag(settings, "noise", o->noise, error) &&
           apply_flag(settings, "spp", o->spp, error) &&
           apply_flag(settings, "threads", o->threads, error) &&
           apply_flag(settings, "denoise", o->denoise, error) &&
           apply_flag(settings, "seed", o->seed, error);
}

void overrides_tell_unread(const overrides *o, const NephSettings *settings)
{
    g_autoptr(NephSettings) given = neph_settings_new();
    if (!overrides_apply(o, given, NULL))
        return;
    g_auto(GStrv) unread = neph_settings_unread(settings, given);
    for (char **line = unread; *line; line++)
        tell("note", "%s", *line);
}

bool overrides_check(const overrides *o, unsigned *threads, GError **error)
{
    g_autoptr(NephSettings) trial = neph_settings_new();
    if (!overrides_apply(o, trial, error))
        return false;
    g_autofree char *text = neph_settings_get(trial, "threads");
    *threads = (unsigned)g_ascii_strtoull(text, NULL, 10);
    return true;
}
