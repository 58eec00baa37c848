#include "window/appearance.h"

#include <gio/gio.h>

#define PORTAL "org.freedesktop.portal.Desktop"
#define PORTAL_PATH "/org/freedesktop/portal/desktop"
#define PORTAL_SETTINGS "org.freedesktop.portal.Settings"
#define NAMESPACE "org.freedesktop.appearance"
#define KEY "color-scheme"

struct appearance {
    GDBusConnection *bus; /* NULL: none (yet) */
    guint subscription;
    GCancellable *asking; /* cancelled: the appearance is gone */
    appearance_scheme scheme;
    void (*changed)(appearance_scheme scheme, void *data);
    void *data;
};

/* A number in a variant, in a variant, ...: the portal's older method wraps twice. */
static appearance_scheme read_scheme(GVariant *value)
{
    g_autoptr(GVariant) at = g_variant_ref(value);
    while (g_variant_is_of_type(at, G_VARIANT_TYPE_VARIANT)) {
        GVariant *inner = g_variant_get_variant(at);
        g_variant_unref(at);
        at = inner;
    }
    guint32 number =
        g_variant_is_of_type(at, G_VARIANT_TYPE_UINT32) ? g_variant_get_uint32(at) : 0;
    return number <= SCHEME_LIGHT ? (appearance_scheme)number : SCHEME_UNKNOWN;
}

static void hear(appearance *a, GVariant *value)
{
    appearance_scheme scheme = read_scheme(value);
    if (scheme == a->scheme)
        return;
    a->scheme = scheme;
    a->changed(scheme, a->data);
}

static void setting_changed(GDBusConnection *bus, const char *sender, const char *path,
                            const char *interface, const char *signal,
                            GVariant *arguments, void *data)
{
    (void)bus, (void)sender, (void)path, (void)interface, (void)signal;
    if (!g_variant_is_of_type(arguments, G_VARIANT_TYPE("(ssv)")))
        return;
    g_autoptr(GVariant) key = g_variant_get_child_value(arguments, 1);
    g_autoptr(GVariant) value = g_variant_get_child_value(arguments, 2);
    if (g_strcmp0(g_variant_get_string(key, NULL), KEY) == 0)
        hear(data, value);
}

static void answered(GObject *source, GAsyncResult *result, void *data)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(GVariant) answer =
        g_dbus_connection_call_finish(G_DBUS_CONNECTION(source), result, &error);
    if (!answer) /* also when the appearance is gone */
        return;
    g_autoptr(GVariant) value = g_variant_get_child_value(answer, 0);
    hear(data, value);
}

static void connected(GObject *source, GAsyncResult *result, void *data)
{
    (void)source;
    g_autoptr(GError) error = NULL;
    GDBusConnection *bus = g_bus_get_finish(result, &error);
    if (!bus)
        return;
    appearance *a = data;
    a->bus = bus;
    a->subscription = g_dbus_connection_signal_subscribe(
        bus, NULL, PORTAL_SETTINGS, "SettingChanged", PORTAL_PATH, NAMESPACE,
        G_DBUS_SIGNAL_FLAGS_NONE, setting_changed, a, NULL);
    g_dbus_connection_call(bus, PORTAL, PORTAL_PATH, PORTAL_SETTINGS, "Read",
                           g_variant_new("(ss)", NAMESPACE, KEY), G_VARIANT_TYPE("(v)"),
                           G_DBUS_CALL_FLAGS_NONE, -1, a->asking, answered, a);
}

appearance *appearance_new(void (*changed)(appearance_scheme scheme, void *data),
                           void *data)
{
    appearance *a = g_new0(appearance, 1);
    a->changed = changed;
    a->data = data;
    a->asking = g_cancellable_new();
    g_bus_get(G_BUS_TYPE_SESSION, a->asking, connected, a);
    return a;
}

void appearance_free(appearance *a)
{
    if (!a)
        return;
    g_cancellable_cancel(a->asking);
    g_object_unref(a->asking);
    if (a->bus)
        g_dbus_connection_signal_unsubscribe(a->bus, a->subscription);
    g_clear_object(&a->bus);
    g_free(a);
}

appearance_scheme appearance_get(const appearance *a)
{
    return a->scheme;
}
