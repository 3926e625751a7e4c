/* Writing a translated scene to a file of its own. */
#define _GNU_SOURCE 1
#include "base/file.h"
#include "base/language.h"
#include "scene/import/import.h"
#include "scene/scene.h"
#include "scene/write.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *const matter[] = { "fluids", "solids" };

/* "directory/a/b" becomes "a/b"; other paths stay. 0 without memory. */
static int shorten(json_t *object, const char *key, const char *directory)
{
    const char *path = json_string_value(json_object_get(object, key));
    size_t n = strlen(directory);
    if (!path || strncmp(path, directory, n) != 0 || path[n] != '/' || n < 2) return 1;
    return json_object_set_new(object, key, json_string(path + n + 1)) == 0;
}

static int shorten_paths(json_t *root, const char *directory)
{
    size_t i;
    int whole = 1;
    json_t *body;
    json_array_foreach(json_object_get(root, "bodies"), i, body) {
        whole &= shorten(body, "mesh", directory);
        whole &= shorten(json_object_get(body, "motion"), "script", directory);
        whole &= shorten(json_object_get(body, "control"), "script", directory);
    }
    for (int k = 0; k < 2; k++)
        json_array_foreach(json_object_get(root, matter[k]), i, body)
            whole &= shorten(json_array_get(json_object_get(body, "fill"), 0), "mesh", directory);
    return whole;
}

/* The table with the paths that the new scene has; owned by the caller, NULL without memory. */
static char *shorten_table(const char *table, const char *directory)
{
    json_t *folder = json_string(directory);
    char *quoted = folder ? json_dumps(folder, JSON_ENCODE_ANY) : NULL, *out = quoted ? strdup(table) : NULL;
    if (out && directory[1]) {
        size_t n = strlen(quoted);      /* "directory" becomes "directory/ */
        quoted[n - 1] = '/';
        for (char *at = out; (at = strstr(at, quoted)) != NULL;) {
            at++;
            memmove(at, at + n - 1, strlen(at + n - 1) + 1);
        }
    }
    free(quoted);
    json_decref(folder);
    return out;
}

/* Adds a line about a file of `object` that is named by an absolute path; 0 without memory. */
static int tell_absolute(char **table, json_t *object, const char *key)
{
    const char *path = json_string_value(json_object_get(object, key));
    char *longer;
    if (!path || path[0] != '/') return 1;
    if (asprintf(&longer, tr("%sAbsolute path: %s. To move the new scene, copy this file beside it and "
                             "name it from there.\n"), *table, path) < 0) return 0;
    free(*table);
    *table = longer;
    return 1;
}

static int tell_absolutes(char **table, json_t *root)
{
    size_t i;
    int whole = 1;
    json_t *body;
    json_array_foreach(json_object_get(root, "bodies"), i, body) {
        whole &= tell_absolute(table, body, "mesh");
        whole &= tell_absolute(table, json_object_get(body, "motion"), "script");
        whole &= tell_absolute(table, json_object_get(body, "control"), "script");
    }
    for (int k = 0; k < 2; k++)
        json_array_foreach(json_object_get(root, matter[k]), i, body)
            whole &= tell_absolute(table, json_array_get(json_object_get(body, "fill"), 0), "mesh");
    return whole;
}

static tobi_status write_scene(const tobi_scene *scene, const char *from, const char *path, char **table,
                               tobi_error *err)
{
    char *directory = tobi_scene_find_directory(path);
    json_t *root = directory ? json_deep_copy(scene->root) : NULL;
    int whole = root && shorten_paths(root, directory);
    char *text = whole ? tobi_write_json(root) : NULL;
    *table = text ? shorten_table(scene->import_table, directory) : NULL;
    if (!*table || !tell_absolutes(table, root)) {
        free(text);
        text = NULL;
    }
    tobi_status status = text ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory for the scene");
    tobi_file file;
    if (status == TOBI_OK) status = tobi_file_open(&file, path, err);
    if (status == TOBI_OK) {
        const char *slash = strrchr(from, '/');
        tobi_file_print(&file, tr("# Translated from %s, a scene of %s. What became of\n"
                                  "# its keys:\n"),
                        slash ? slash + 1 : from, tr(scene->import_program));
        for (const char *line = *table; *line;) {
            size_t length = strcspn(line, "\n");
            tobi_file_print(&file, "#   %.*s\n", (int)length, line);
            line += length + (line[length] == '\n');
        }
        tobi_file_write(&file, text, strlen(text));
        status = tobi_file_commit(&file, err);
    }
    free(text);
    json_decref(root);
    free(directory);
    return status;
}

static int is_same_file(const char *a, const char *b)
{
    struct stat one, other;
    return a && stat(a, &one) == 0 && stat(b, &other) == 0 && one.st_dev == other.st_dev &&
           one.st_ino == other.st_ino;
}

/* With --force too. */
static tobi_status check_sources(const tobi_scene *scene, const char *old_path, const char *new_path,
                                 tobi_error *err)
{
    const char *file;
    int same = is_same_file(old_path, new_path);
    for (int k = 0; (file = tobi_scene_file(scene, k)); k++) same |= is_same_file(file, new_path);
    if (!same) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "%s: is what the scene is read from; choose another name", new_path);
}

tobi_status tobi_scene_import(const char *old_path, const char *new_path, int force, char **table,
                              tobi_report **report, tobi_error *err)
{
    tobi_scene *scene;
    TOBI_NEED(table, "where the table goes");
    *table = NULL;
    if (report) *report = NULL;
    TOBI_NEED(old_path && new_path, "a path");
    if (!force && access(new_path, F_OK) == 0)
        return tobi_fail(err, TOBI_INVALID, "%s exists; nothing was changed (choose another name, or "
                         "--force to replace it)", new_path);
    TOBI_TRY(tobi_scene_load_foreign(old_path, &scene, report, err));
    tobi_status status = check_sources(scene, old_path, new_path, err);
    if (status == TOBI_OK) status = write_scene(scene, old_path, new_path, table, err);
    if (status != TOBI_OK) {
        free(*table);
        *table = NULL;
    }
    tobi_scene_free(scene);
    return status;
}
