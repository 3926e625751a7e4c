/* inputs.json: size and SHA-256 of each file that a run's scene names. A run that goes on, and a reader of
   its results, can tell by it whether they are still the same. Drawback: the files are read once more. */
#include "scene/scene.h"
#include "scene/write.h"
#include "base/file.h"
#include "base/sha256.h"
#include <stdlib.h>
#include <string.h>

static char *find_list(const char *dir)
{
    static const char name[] = "/inputs.json";
    char *path = malloc(strlen(dir) + sizeof name);
    if (path) strcat(strcpy(path, dir), name);
    return path;
}

/* What the folder has, an empty list if there is none; NULL: no memory. */
static json_t *read_list(const char *dir)
{
    char *path = find_list(dir);
    json_t *list = path ? json_load_file(path, 0, NULL) : NULL;
    if (path && !json_is_array(list)) {
        json_decref(list);
        list = json_array();
    }
    free(path);
    return list;
}

/* The last entry of a path, NULL if there is none. */
static const json_t *find_entry(const json_t *list, const char *path)
{
    for (size_t k = json_array_size(list); k-- > 0;) {
        const json_t *entry = json_array_get(list, k);
        const char *is = json_string_value(json_object_get(entry, "path"));
        if (is && strcmp(is, path) == 0) return entry;
    }
    return NULL;
}

static int is_same(const json_t *entry, const char *digest)
{
    const char *then = json_string_value(json_object_get(entry, "sha256"));
    return then && strcmp(then, digest) == 0;
}

int tobi_scene_file_changed(const tobi_scene *scene, const char *dir, int index)
{
    char digest[TOBI_SHA256_TEXT];
    int64_t size;
    tobi_error err;
    const char *path = dir ? tobi_scene_file(scene, index) : NULL;
    json_t *list = path ? read_list(dir) : NULL;
    const json_t *entry = list ? find_entry(list, path) : NULL;
    const int known = entry && tobi_sha256_file(path, digest, &size, &err) == TOBI_OK;
    const int changed = known && !is_same(entry, digest);
    json_decref(list);
    return changed;
}

/* What was read from `time` on has not come to be, or is computed once more. */
static void drop_later(json_t *list, double time)
{
    for (size_t k = json_array_size(list); k-- > 0;)
        if (json_number_value(json_object_get(json_array_get(list, k), "time")) >= time)
            json_array_remove(list, k);
}

static tobi_status add_file(json_t *list, const char *path, double time, tobi_error *err)
{
    char digest[TOBI_SHA256_TEXT];
    int64_t size;
    TOBI_TRY(tobi_sha256_file(path, digest, &size, err));
    if (is_same(find_entry(list, path), digest)) return TOBI_OK;
    json_t *entry = json_pack("{s:f, s:s, s:I, s:s}", "time", time, "path", path, "bytes", (json_int_t)size,
                              "sha256", digest);
    if (json_array_append_new(list, entry) == 0) return TOBI_OK;
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the list of files");
}

static tobi_status write_list(const json_t *list, const char *dir, tobi_error *err)
{
    char *path = find_list(dir), *text = path ? tobi_write_json(list) : NULL;
    tobi_status status = text ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory for the list of files");
    tobi_file file;
    if (status == TOBI_OK) status = tobi_file_open(&file, path, err);
    if (status == TOBI_OK) {
        tobi_file_write(&file, text, strlen(text));
        status = tobi_file_commit(&file, err);
    }
    free(path);
    free(text);
    return status;
}

tobi_status tobi_scene_note_files(const tobi_scene *scene, const char *dir, double time, tobi_error *err)
{
    TOBI_NEED(scene, "scene");
    TOBI_NEED(dir, "the directory");
    const char *path;
    tobi_status status = TOBI_OK;
    if (!tobi_scene_file(scene, 0)) return TOBI_OK;
    json_t *list = read_list(dir);
    if (!list) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the list of files");
    drop_later(list, time);
    for (int k = 0; status == TOBI_OK && (path = tobi_scene_file(scene, k)); k++)
        status = add_file(list, path, time, err);
    if (status == TOBI_OK) status = write_list(list, dir, err);
    json_decref(list);
    return status;
}
