/*
 * Files of strangers and the program: what they hold reaches the terminal as text only.
 */
#include "cli_run.h"

#include <string.h>

/* A terminal's title, a colour, what moves to the left, the same in one character of
 * UTF-8 each, lines' and paragraphs' ends and a turn of direction; then what is not
 * UTF-8. */
static const char *const commands[] = {
    "\033]0;title\007\033[31m_a\rb_a\bb_\177_\302\2332J_\302\205_\342\200\250_"
    "\342\200\256txt",
    "\001_\313\355\033[31m\377",
};

/* Every line but what ends it is of characters that are seen. */
static void assert_harmless(const char *text, const char *what)
{
    g_auto(GStrv) lines = g_strsplit(text, "\n", -1);
    for (char **line = lines; *line; line++)
        for (const char *c = *line; *c; c = g_utf8_next_char(c)) {
            gunichar seen = g_utf8_get_char_validated(c, -1);
            if (seen >= 0x7fffffff || g_unichar_iscntrl(seen) || seen == 0x2028 ||
                seen == 0x202e)
                g_error("%s lets U+%04X through: %s", what, seen, text);
        }
}

static void run_harmlessly(const folder *f, const char *arguments)
{
    g_auto(result) r = run(f, arguments);
    g_assert_cmpint(r.code, >=, 0);
    assert_harmless(r.out, arguments);
    assert_harmless(r.err, arguments);
}

/* Places for the text in files of all kinds; % stands for it. */
static const struct {
    const char *name, *text, *arguments;
} cases[] = {
    {"a.pbrt", "%", "info a.pbrt"},
    {"a.pbrt", "WorldBegin\nMaterial \"%\"\n", "info a.pbrt"},
    {"a.pbrt", "WorldBegin\nShape \"sphere\" \"float %\" 1\n", "info a.pbrt"},
    {"a.pbrt", "WorldBegin\nInclude \"%\"\n", "info a.pbrt"},
    {"a.pbrt", "WorldBegin\nNamedMaterial \"%\"\n", "info a.pbrt"},
    {"a.pbrt", "Film \"rgb\" \"string sensor\" \"%\"\nWorldBegin\n", "info a.pbrt"},
    {"a.pbrt", "Option \"string %\" \"%\"\nWorldBegin\n", "render a.pbrt -q"},
    {"a.pbrt",
     "Film \"rgb\" \"string filename\" \"%.exr\"\nMakeNamedMedium \"%\" \"string type\" "
     "\"homogeneous\"\nMediumInterface \"\" \"%\"\nCamera \"perspective\"\nWorldBegin\n"
     "LightSource \"point\"\nMakeNamedMaterial \"%\" \"string type\" \"conductor\"\n"
     "NamedMaterial \"%\"\nShape \"sphere\"\n",
     "info a.pbrt"},
    {"a.pbrt",
     "Camera \"perspective\"\nWorldBegin\nLightSource \"point\" \"string group\" \"%\"\n"
     "MakeNamedMaterial \"%\" \"string type\" \"diffuse\"\nNamedMaterial \"%\"\n"
     "Shape \"sphere\"\n",
     "bsdf none --scene a.pbrt"},
    {"a.gltf", "{\"asset\":{\"version\":\"%\"}}", "info a.gltf"},
    {"a.gltf", "%", "info a.gltf"},
    {"a.gltf",
     "{\"asset\":{\"version\":\"2.0\"},\"extensionsRequired\":[\"%\"],"
     "\"extensionsUsed\":[\"%\"]}",
     "info a.gltf"},
    {"a.gltf",
     "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":1,\"uri\":\"%\"}],"
     "\"meshes\":[{\"name\":\"%\",\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
     "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"%\"}"
     "],\"nodes\":[{\"mesh\":0}]}",
     "info a.gltf"},
    {"a.ply", "ply\nformat % 1.0\nend_header\n", "info a.ply"},
    {"a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty % x\nend_header\n",
     "info a.ply"},
    {"a.obj", "mtllib %.mtl\nusemtl %\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
     "info a.obj"},
    {"a.set", "% = 3\n", "info box.pbrt --settings a.set"},
    {"a.set", "photons = %\n", "info box.pbrt --settings a.set"},
    {"a.pfm", "PF\n%\n", "compare a.pfm a.pfm"},
    {"a.hdr", "#?RADIANCE\n%\n\n-Y % +X 1\n", "compare a.hdr a.hdr"},
};

static void test_terminal(folder *f, gconstpointer data)
{
    (void)data;
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++)
        for (size_t j = 0; j < G_N_ELEMENTS(commands); j++) {
            g_auto(GStrv) parts = g_strsplit(cases[i].text, "%", -1);
            g_autofree char *text = g_strjoinv(commands[j], parts);
            folder_write(f, cases[i].name, text);
            run_harmlessly(f, cases[i].arguments);
        }
}

/* Names of files, too, and whole other alphabets stay. */
static void test_names(folder *f, gconstpointer data)
{
    (void)data;
    folder_write(f, "\033[31m\n.pbrt", "WorldBegin\nFrobnicate\n");
    run_harmlessly(f, "info '\033[31m\n.pbrt'");
    folder_write(f, "gl\303\244sern.pbrt", "WorldBegin\n\346\227\245\346\234\254\n");
    g_auto(result) r = run(f, "info gl\303\244sern.pbrt");
    contains(r.err, "gl\303\244sern.pbrt:2:1: error: ");
    contains(r.err, "found '\346\227\245\346\234\254'");
}

/* A name of two lines cannot pass for another error. */
static void test_forged_line(folder *f, gconstpointer data)
{
    (void)data;
    folder_write(f, "a.pbrt",
                 "WorldBegin\nNamedMaterial \"x\\nbox.pbrt:1:1: error: forged\"\n");
    g_auto(result) r = run(f, "info a.pbrt");
    g_assert_null(strstr(r.err, "\nbox.pbrt"));
    contains(r.err, "x\\nbox.pbrt:1:1: error: forged");
}

/* ---- What is no scene's is not quoted ---- */

static const char *const secrets[] = {
    "root:$6$SECRET$x:19000:0:99999:7:::\n",
    "SECRET\n",
    "\"SECRET\"\n",
    "# a comment\nsecret = SECRET\n",
    "SECRET 1 2",
    "1 2 3 SECRET\n",
    "[SECRET]\n",
    "{\"SECRET\"",
    "SECRET\nTILT = SECRET\n",
};

#define WORLD                                                                            \
    "Camera \"perspective\"\nWorldBegin\nLightSource \"point\"\n"                        \
    "Shape \"sphere\"\n"

static const char *const ways[][2] = {
    {"a.pbrt", WORLD "Include \"stolen\"\n"},
    {"a.pbrt", WORLD "Import \"stolen\"\n"},
    {"a.pbrt", WORLD "Shape \"plymesh\" \"string filename\" \"stolen\"\n"},
    {"a.pbrt", WORLD "Material \"diffuse\" \"spectrum reflectance\" \"stolen\"\n"},
    {"a.pbrt", WORLD "LightSource \"point\" \"spectrum I\" \"stolen\"\n"},
    {"a.pbrt", WORLD "LightSource \"infinite\" \"string filename\" \"stolen\"\n"},
    {"a.pbrt", WORLD "LightSource \"goniometric\" \"string filename\" \"stolen\"\n"},
    {"a.pbrt", WORLD "LightSource \"goniometric\" \"string filename\" \"stolen.ies\"\n"},
    {"a.gltf",
     "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":999,\"uri\":"
     "\"stolen\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":999}],"
     "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
     "\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
     "\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}]}"},
    {"a.obj", "mtllib stolen\nusemtl x\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
};

static void test_secrets(folder *f, gconstpointer data)
{
    (void)data;
    for (size_t i = 0; i < G_N_ELEMENTS(secrets); i++) {
        folder_write(f, "stolen", secrets[i]);
        folder_write(f, "stolen.ies", secrets[i]);
        for (size_t j = 0; j < G_N_ELEMENTS(ways); j++) {
            g_autofree char *arguments = g_strconcat("info ", ways[j][0], NULL);
            folder_write(f, ways[j][0], ways[j][1]);
            g_auto(result) r = run(f, arguments);
            g_assert_cmpint(r.code, >=, 0);
            if (strstr(r.err, "SECRET") || strstr(r.out, "SECRET"))
                g_error("%s\nshows\n%s%s", ways[j][1], r.out, r.err);
        }
        g_auto(result) r = run(f, "info box.pbrt --settings stolen");
        g_assert_null(strstr(r.err, "SECRET"));
    }
}

/* But a mistake in a part of a scene is told as ever. */
static void test_included_mistake(folder *f, gconstpointer data)
{
    (void)data;
    folder_write(f, "part.pbrt", "Material \"diffuse\"\nFrobnicate\n");
    folder_write(f, "a.pbrt", WORLD "Include \"part.pbrt\"\n");
    g_auto(result) r = run(f, "info a.pbrt");
    contains(r.err, "part.pbrt:2:1: error: expected a directive, found 'Frobnicate'");
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder_add_test("/cli/hostile/terminal", test_terminal);
    folder_add_test("/cli/hostile/names", test_names);
    folder_add_test("/cli/hostile/forged-line", test_forged_line);
    folder_add_test("/cli/hostile/secrets", test_secrets);
    folder_add_test("/cli/hostile/included-mistake", test_included_mistake);
    return g_test_run();
}
