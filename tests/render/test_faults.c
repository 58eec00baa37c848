/*
 * faults: whichever allocation of a big array fails, from reading a scene to the last
 * file, there is an error that says so, nothing breaks, nothing is lost that was there,
 * and the same job done again does well. Under a sanitizer nothing leaks either.
 */
#include "base/memory.h"
#include "image/image.h"
#include "render/kept/checkpoint.h"
#include "render/kept/photon_file.h"
#include "render/photons.h"
#include "rooms.h"

#include <glib/gstdio.h>
#include <string.h>

static char *folder, *picture, *kept, *left, *mine;
static const render_identity me = {(char *)"test 1", (char *)"room"};

/* What is done, from its beginning; false with an error. */
typedef bool (*whole_job)(const char *words, GError **error);

static char *scene_file(const char *name)
{
    return g_build_filename(folder, name, NULL);
}

static view *read_view(const char *name, GError **error)
{
    const load_options how = {.threads = 1};
    g_autofree char *path = scene_file(name);
    return format_load_view(path, &how, error);
}

/* Read once, before. */
static view *room;

static bool load_scene(const char *words, GError **error)
{
    g_autoptr(view) v = read_view(words, error);
    return v != NULL;
}

static bool write_picture(const render *r, GError **error)
{
    g_autoptr(image) img = render_image(r, error);
    return img && image_write(img, picture, NULL, error);
}

/* Plans, renders, keeps and goes on. */
static bool render_all(const char *words, GError **error)
{
    const view *v = room;
    const settings how = settings_with(v->scene, words);
    g_autoptr(render) r = render_new(v, &how, error);
    return r && render_run(r, NULL, NULL, error) && write_picture(r, error) &&
           render_save_checkpoint(r, &me, mine, error);
}

static bool resume(const char *words, GError **error)
{
    const view *v = room;
    const settings how = settings_with(v->scene, words);
    g_autoptr(render) r = render_new(v, &how, error);
    return r && render_resume(r, &me, left, error) && render_run(r, NULL, NULL, error);
}

static bool trace_photons(const char *words, GError **error)
{
    const view *v = room;
    const settings how = settings_with(v->scene, words);
    g_autoptr(render_photons) p = render_trace_photons(v, &how, NULL, error);
    return p && render_photons_follow(p, NULL, error);
}

static bool keep_photons(const char *words, GError **error)
{
    const view *v = room;
    const settings how = settings_with(v->scene, words);
    const photon_file_order order = {.view = v, .how = &how, .who = &me, .n_passes = 2};
    return photon_file_write(&order, kept, NULL, error);
}

static bool use_photons(const char *words, GError **error)
{
    const view *v = room;
    const settings how = settings_with(v->scene, words);
    g_autoptr(render) r = render_new(v, &how, error);
    return r && render_use_photons(r, &me, kept, error) &&
           render_run(r, NULL, NULL, error);
}

/* ---- The n-th ---- */

typedef struct job {
    const char *name, *words;
    whole_job run;
    const char *writes; /* a file that must be what it was where the job fails */
} job;

static char *read_file(const char *path, gsize *size)
{
    char *bytes = NULL;
    *size = 0;
    return g_file_get_contents(path, &bytes, size, NULL) ? bytes : NULL;
}

/* What failed was not told of: a file may be written before something else fails. */
static void fail_once(const job *j, unsigned n, bool *is_beyond)
{
    g_autoptr(GError) error = NULL;
    big_alloc_fail_at(n);
    bool done = j->run(j->words, &error);
    *is_beyond = big_alloc_fail_left() > 0;
    big_alloc_fail_at(0);
    if (*is_beyond) {
        g_assert_no_error(error);
        g_assert_true(done);
        return;
    }
    if (done)
        g_error("%s: allocation %u failed, and nobody said so", j->name, n);
    if (!strstr(error->message, "out of memory"))
        g_error("%s: allocation %u: %s", j->name, n, error->message);
    g_assert_cmpint(error->code, !=, ERROR_CANCELLED);
}

enum { ALL = 150 }; /* then every few */

static void test_nth(const void *data)
{
    const job *j = data;
    gsize size_before, size_after;
    size_t in_use = memory_left();
    g_autoptr(GError) error = NULL;
    j->run(j->words, &error);
    g_assert_no_error(error);
    bool is_beyond = false;
    unsigned n_tried = 0, n = 1;
    g_autofree char *before = j->writes ? read_file(j->writes, &size_before) : NULL;
    for (; !is_beyond; n += n < ALL ? 1 : n / 16, n_tried++) {
        size_t own = memory_left();
        fail_once(j, n, &is_beyond);
        if (memory_left() != own)
            g_error("%s: allocation %u failed, and %zd bytes leaked", j->name, n,
                    (ssize_t)(own - memory_left()));
    }
    g_test_message("%u of %u allocations", n_tried, n);
    if (j->writes) {
        g_autofree char *after = read_file(j->writes, &size_after);
        g_assert_cmpmem(before, size_before, after, size_after);
    }
    g_assert_cmpuint(memory_left(), >=, in_use / 2);
}

#define SMALL "passes=2 spp=1 photons=600 threads=1"

static const job jobs[] = {
    {"load/room", "room.pbrt", load_scene, NULL},
    {"load/many", "many.pbrt", load_scene, NULL},
    {"render/photonmap", SMALL, render_all, NULL},
    {"render/one-map", SMALL " one_map=on direct_illumination=off", render_all, NULL},
    {"render/gather", SMALL " final_gather=on gather_rays=4", render_all, NULL},
    {"render/nearest", SMALL " indirect_nearest=8 photon_map=kdtree", render_all, NULL},
    {"render/sppm", SMALL " integrator=sppm", render_all, NULL},
    {"render/vcm", SMALL " integrator=vcm", render_all, NULL},
    {"render/path", SMALL " integrator=path denoise=on", render_all, NULL},
    {"render/auto", "integrator=auto passes=2 spp=8 threads=1", render_all, NULL},
    {"resume", SMALL " passes=3", resume, NULL},
    {"trace", SMALL " integrator=auto spp=8", trace_photons, NULL},
    {"keep", SMALL, keep_photons, NULL},
    {"use", SMALL, use_photons, NULL},
};

static void write_scenes(void)
{
    static const char box[] = ROOM_CAMERA
        "Film \"gbuffer\" \"integer xresolution\" 12 \"integer yresolution\" 10\n"
        "WorldBegin\nLightSource \"point\" \"rgb I\" [9 9 9] \"point3 from\" [0 0 1.9] "
        "\"string group\" \"top\"\n" ROOM_WALLS GLASS_BALL;
    static const char many[] = ROOM_CAMERA SIZE(8) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n"
        "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"t.pfm\"\n"
        "Material \"diffuse\" \"texture reflectance\" \"t\"\n"
        "LightSource \"infinite\" \"string filename\" \"t.pfm\"\n"
        "ObjectBegin \"o\" Shape \"sphere\" Shape \"disk\" ObjectEnd\n"
        "ObjectInstance \"o\" Translate 3 0 0 ObjectInstance \"o\"\n"
        "Shape \"loopsubdiv\" \"integer levels\" 1 \"point3 P\" [0 0 0 1 0 0 0 1 0 0 0 "
        "1] "
        "\"integer indices\" [0 2 1 0 1 3 0 3 2 1 2 3]\n"
        "Shape \"curve\" \"point3 P\" [0 0 0 1 0 0 1 1 0 1 1 1] \"float width\" 0.1\n";
    g_autofree char *a = scene_file("room.pbrt"), *b = scene_file("many.pbrt");
    g_autofree char *t = scene_file("t.pfm");
    g_autoptr(GString) pfm = g_string_new("PF\n4 4\n-1.0\n");
    const float grey = 0.5f;
    for (int i = 0; i < 48; i++)
        g_string_append_len(pfm, (const char *)&grey, sizeof grey);
    g_assert_true(g_file_set_contents(a, box, -1, NULL));
    g_assert_true(g_file_set_contents(b, many, -1, NULL));
    g_assert_true(g_file_set_contents(t, pfm->str, (gssize)pfm->len, NULL));
}

/* What others begin with. */
static void prepare(void)
{
    g_assert_true(keep_photons(SMALL, NULL));
    g_assert_true(render_all(SMALL, NULL));
    g_assert_cmpint(g_rename(mine, left), ==, 0);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder = g_dir_make_tmp("faults-XXXXXX", NULL);
    picture = g_build_filename(folder, "a.exr", NULL);
    kept = g_build_filename(folder, "kept", NULL);
    left = g_build_filename(folder, "left", NULL);
    mine = g_build_filename(folder, "mine", NULL);
    write_scenes();
    room = read_view("room.pbrt", NULL);
    prepare();
    for (size_t i = 0; i < G_N_ELEMENTS(jobs); i++) {
        g_autofree char *path = g_strconcat("/faults/", jobs[i].name, NULL);
        g_test_add_data_func(path, &jobs[i], test_nth);
    }
    int result = g_test_run();
    view_free(room);
    g_autofree char *command = g_strdup_printf("rm -r '%s'", folder);
    g_assert_true(g_spawn_command_line_sync(command, NULL, NULL, NULL, NULL));
    return result;
}
