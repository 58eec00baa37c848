/*
 * Driving the program $NEPHROID as a shell would, each test in a folder of its own that
 * holds one small scene, box.pbrt: a glass ball in a sphere with a point light, 16 x 12
 * pixels, two passes.
 */
#pragma once

#include <glib.h>
#include <stdbool.h>

/** @brief A fixture for g_test_add. */
typedef struct folder {
    char *path;
} folder;

void folder_set_up(folder *f, gconstpointer data);
void folder_tear_down(folder *f, gconstpointer data);
/** @brief Adds a test with such a folder. */
void folder_add_test(const char *path, void (*test)(folder *, gconstpointer));
void folder_write(const folder *f, const char *name, const char *text);
char *folder_read(const folder *f, const char *name);
bool folder_has(const folder *f, const char *name);
/** @brief All entries, hidden ones too. */
unsigned folder_count(const folder *f);

/** @brief What the program did; code -1: it did not exit by itself. */
typedef struct result {
    int code;
    char *out, *err;
} result;

void result_clear(result *r);
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(result, result_clear)

/** @brief Path of the program. */
const char *run_program(void);
/** @brief Runs it with arguments split as by a shell. */
result run(const folder *f, const char *arguments);
/** @brief The same, and asserts that all is well. */
void run_well(const folder *f, const char *arguments);

/** @brief A command that is refused: with what exit code, and a part of what it says. */
typedef struct refused_run {
    const char *arguments, *part;
    int code;
} refused_run;

/** @brief Runs n of them, each after what all begin with, and asserts so. */
void run_refused(const folder *f, const char *begin, const refused_run *cases, size_t n);
/** @brief A pseudo-terminal. @param name of what stands at its other end; freed by the
 * caller @return -1 if there are none */
int terminal_open(char **name);
/** @brief In a child, before it becomes the program: its errors go to that terminal. */
void terminal_enter(gpointer name);
/** @brief Reads until the text appears; false after half a minute. */
bool terminal_wait(int terminal, const char *part, GString *seen);
/** @brief Asserts that text contains part. */
void contains(const char *text, const char *part);
unsigned count_parts(const char *text, const char *part);

/* The pieces of box.pbrt. */
extern const char scene_head[], scene_integrator[], scene_body[];
