/*
 * Following the desktop's light or dark, against a portal of the test's own on a bus of
 * its own.
 */
#include "window/appearance.h"

#include <gio/gio.h>

static const char description[] =
    "<node><interface name='org.freedesktop.portal.Settings'>"
    "<method name='Read'><arg type='s' direction='in'/><arg type='s' direction='in'/>"
    "<arg type='v' direction='out'/></method>"
    "<signal name='SettingChanged'><arg type='s'/><arg type='s'/><arg type='v'/></signal>"
    "</interface></node>";

static guint32 scheme_of_portal;
static int n_asked, n_heard;
static appearance_scheme heard;

static void asked(GDBusConnection *bus, const char *sender, const char *path,
                  const char *interface, const char *method, GVariant *arguments,
                  GDBusMethodInvocation *invocation, void *data)
{
    (void)bus, (void)sender, (void)path, (void)interface, (void)method, (void)data;
    const char *space, *key;
    g_variant_get(arguments, "(&s&s)", &space, &key);
    g_assert_cmpstr(space, ==, "org.freedesktop.appearance");
    g_assert_cmpstr(key, ==, "color-scheme");
    n_asked++;
    GVariant *inner = g_variant_new_variant(g_variant_new_uint32(scheme_of_portal));
    g_dbus_method_invocation_return_value(invocation, g_variant_new("(v)", inner));
}

/* A portal on a connection of its own: as another program. */
static GDBusConnection *start_portal(GTestDBus *bus)
{
    static const GDBusInterfaceVTable table = {.method_call = asked};
    g_autoptr(GDBusNodeInfo) node = g_dbus_node_info_new_for_xml(description, NULL);
    GDBusConnection *portal = g_dbus_connection_new_for_address_sync(
        g_test_dbus_get_bus_address(bus),
        G_DBUS_CONNECTION_FLAGS_AUTHENTICATION_CLIENT |
            G_DBUS_CONNECTION_FLAGS_MESSAGE_BUS_CONNECTION,
        NULL, NULL, NULL);
    g_assert_nonnull(portal);
    guint id =
        g_dbus_connection_register_object(portal, "/org/freedesktop/portal/desktop",
                                          node->interfaces[0], &table, NULL, NULL, NULL);
    g_assert_cmpuint(id, >, 0);
    g_autoptr(GVariant) named = g_dbus_connection_call_sync(
        portal, "org.freedesktop.DBus", "/org/freedesktop/DBus", "org.freedesktop.DBus",
        "RequestName", g_variant_new("(su)", "org.freedesktop.portal.Desktop", 0), NULL,
        G_DBUS_CALL_FLAGS_NONE, -1, NULL, NULL);
    g_assert_nonnull(named);
    return portal;
}

static void hear(appearance_scheme scheme, void *data)
{
    (void)data;
    heard = scheme;
    n_heard++;
}

static void say(GDBusConnection *portal, const char *key, GVariant *value)
{
    g_dbus_connection_emit_signal(
        portal, NULL, "/org/freedesktop/portal/desktop",
        "org.freedesktop.portal.Settings", "SettingChanged",
        g_variant_new("(ssv)", "org.freedesktop.appearance", key, value), NULL);
}

static void wait_for(appearance_scheme scheme)
{
    gint64 limit = g_get_monotonic_time() + 20 * G_USEC_PER_SEC;
    while (heard != scheme) {
        g_assert_cmpint(g_get_monotonic_time(), <, limit);
        g_main_context_iteration(NULL, FALSE);
        g_usleep(500);
    }
}

static void test_followed(void)
{
    g_autofree char *daemon = g_find_program_in_path("dbus-daemon");
    if (!daemon) {
        g_test_skip("no dbus-daemon");
        return;
    }
    g_autoptr(GTestDBus) bus = g_test_dbus_new(G_TEST_DBUS_NONE);
    g_test_dbus_up(bus);
    scheme_of_portal = 1;
    GDBusConnection *portal = start_portal(bus);
    appearance *a = appearance_new(hear, NULL);
    g_assert_cmpint(appearance_get(a), ==, SCHEME_UNKNOWN);
    wait_for(SCHEME_DARK);
    g_assert_cmpint(appearance_get(a), ==, SCHEME_DARK);
    g_assert_cmpint(n_asked, ==, 1);
    say(portal, "color-scheme", g_variant_new_uint32(2));
    wait_for(SCHEME_LIGHT);
    say(portal, "accent-color", g_variant_new_uint32(1));
    say(portal, "color-scheme", g_variant_new_string("nonsense"));
    wait_for(SCHEME_UNKNOWN);
    g_assert_cmpint(n_heard, ==, 3);
    appearance_free(a);
    say(portal, "color-scheme", g_variant_new_uint32(1));
    g_dbus_connection_flush_sync(portal, NULL, NULL);
    for (int i = 0; i < 50; i++) {
        g_main_context_iteration(NULL, FALSE);
        g_usleep(500);
    }
    g_assert_cmpint(n_heard, ==, 3);
    g_object_unref(portal);
    g_test_dbus_stop(bus);
}

/* Gone before the bus has answered. */
static void test_no_bus(void)
{
    g_setenv("DBUS_SESSION_BUS_ADDRESS", "unix:path=/nowhere", TRUE);
    n_heard = 0;
    appearance *a = appearance_new(hear, NULL);
    g_main_context_iteration(NULL, FALSE);
    appearance_free(a);
    a = appearance_new(hear, NULL);
    for (int i = 0; i < 50; i++) {
        g_main_context_iteration(NULL, FALSE);
        g_usleep(500);
    }
    g_assert_cmpint(appearance_get(a), ==, SCHEME_UNKNOWN);
    appearance_free(a);
    g_assert_cmpint(n_heard, ==, 0);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/appearance/followed", test_followed);
    g_test_add_func("/appearance/no-bus", test_no_bus);
    return g_test_run();
}
