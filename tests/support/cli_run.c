#define _GNU_SOURCE /* pseudo-terminals */
#include "cli_run.h"

#include <fcntl.h>
#include <glib/gstdio.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* ---- A folder with a scene ---- */

const char scene_head[] = "LookAt 0 0 -2  0 0 0  0 1 0\n"
                          "Camera \"perspective\" \"float fov\" 50\n"
                          "Film \"rgb\" \"integer xresolution\" 16\n"
                          "    \"integer yresolution\" 12\n";
const char scene_body[] = "WorldBegin\n"
                          "LightSource \"point\" \"rgb I\" [10 10 10]\n"
                          "    \"point3 from\" [0 1.8 0]\n"
                          "Material \"diffuse\" \"rgb reflectance\" [0.7 0.5 0.3]\n"
                          "Shape \"sphere\" \"float radius\" 3\n"
                          "Material \"dielectric\"\n"
                          "Shape \"sphere\" \"float radius\" 0.4\n";
const char scene_integrator[] =
    "Integrator \"photonmap\" \"integer passes\" 2 \"integer photons\" 2000\n"
    "    \"integer spp\" 1 \"string caustic_emission\" \"uniform\"\n";

void folder_write(const folder *f, const char *name, const char *text)
{
    g_autofree char *path = g_build_filename(f->path, name, NULL);
    g_assert_true(g_file_set_contents(path, text, -1, NULL));
}

char *folder_read(const folder *f, const char *name)
{
    g_autofree char *path = g_build_filename(f->path, name, NULL);
    char *text = NULL;
    g_file_get_contents(path, &text, NULL, NULL);
    return text;
}

bool folder_has(const folder *f, const char *name)
{
    g_autofree char *path = g_build_filename(f->path, name, NULL);
    return g_file_test(path, G_FILE_TEST_IS_REGULAR);
}

static unsigned visit_entries(const folder *f, bool removing)
{
    unsigned n = 0;
    g_autoptr(GDir) dir = g_dir_open(f->path, 0, NULL);
    for (const char *name; (name = g_dir_read_name(dir)); n++) {
        g_autofree char *path = g_build_filename(f->path, name, NULL);
        if (removing)
            g_remove(path);
    }
    return n;
}

unsigned folder_count(const folder *f)
{
    return visit_entries(f, false);
}

void folder_set_up(folder *f, gconstpointer data)
{
    (void)data;
    f->path = g_dir_make_tmp("nephroid-cli-XXXXXX", NULL);
    g_autofree char *scene = g_strconcat(scene_head, scene_integrator, scene_body, NULL);
    folder_write(f, "box.pbrt", scene);
}

void folder_tear_down(folder *f, gconstpointer data)
{
    (void)data;
    visit_entries(f, true);
    g_rmdir(f->path);
    g_free(f->path);
}

/* ---- Running the program ---- */

void result_clear(result *r)
{
    g_free(r->out);
    g_free(r->err);
}

void folder_add_test(const char *path, void (*test)(folder *, gconstpointer))
{
    g_test_add(path, folder, NULL, folder_set_up, test, folder_tear_down);
}

const char *run_program(void)
{
    const char *program = g_getenv("NEPHROID");
    return program ? program : "nephroid";
}

result run(const folder *f, const char *arguments)
{
    g_autofree char *line = g_strconcat("nephroid ", arguments, NULL);
    g_auto(GStrv) argv = NULL;
    g_autoptr(GError) error = NULL;
    g_assert_true(g_shell_parse_argv(line, NULL, &argv, &error));
    g_free(argv[0]);
    argv[0] = g_strdup(run_program());
    result r = {0};
    int status = 0;
    g_spawn_sync(f->path, argv, NULL, G_SPAWN_DEFAULT, NULL, NULL, &r.out, &r.err,
                 &status, &error);
    g_assert_no_error(error);
    r.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    g_test_message("nephroid %s: %d\n%s%s", arguments, r.code, r.out, r.err);
    return r;
}

void run_well(const folder *f, const char *arguments)
{
    g_auto(result) r = run(f, arguments);
    g_assert_cmpint(r.code, ==, 0);
}

void run_refused(const folder *f, const char *begin, const refused_run *cases, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        g_autofree char *line = g_strconcat(begin, cases[i].arguments, NULL);
        g_auto(result) r = run(f, line);
        g_test_message("%s: %s", line, r.err);
        g_assert_cmpint(r.code, ==, cases[i].code);
        contains(r.err, cases[i].part);
    }
}

/* ---- Terminals ---- */

int terminal_open(char **name)
{
    int terminal = posix_openpt(O_RDWR | O_NOCTTY);
    if (terminal < 0 || grantpt(terminal) != 0 || unlockpt(terminal) != 0)
        return -1;
    *name = g_strdup(ptsname(terminal));
    return terminal;
}

void terminal_enter(gpointer name)
{
    int fd = open(name, O_WRONLY | O_NOCTTY);
    if (fd >= 0)
        dup2(fd, STDERR_FILENO);
}

bool terminal_wait(int terminal, const char *part, GString *seen)
{
    for (int tries = 0; tries < 300 && !strstr(seen->str, part); tries++) {
        struct pollfd ready = {.fd = terminal, .events = POLLIN};
        char buffer[256];
        if (poll(&ready, 1, 100) <= 0)
            continue;
        ssize_t n = read(terminal, buffer, sizeof buffer);
        if (n > 0)
            g_string_append_len(seen, buffer, n);
    }
    return strstr(seen->str, part) != NULL;
}

/* ---- Texts ---- */

void contains(const char *text, const char *part)
{
    if (!strstr(text, part))
        g_error("'%s' lacks '%s'", text, part);
}

unsigned count_parts(const char *text, const char *part)
{
    unsigned n = 0;
    while ((text = strstr(text, part))) {
        text += strlen(part);
        n++;
    }
    return n;
}
