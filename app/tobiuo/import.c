/* tobiuo import OLD --out NEW.json: a scene of the Taichi program, or a folder of the tank program, as a
   native one. */
#define _GNU_SOURCE
#include "app.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct import_options {
    const char *scene, *out;
    char *path, *beside;           /* owned: the file meant, and the place of its translation; NULL = none */
    int force, quiet;
} import_options;

enum { KEY_FORCE = KEY_OWN };

static const struct argp_option options[] = {
    { "out", 'o', "FILE", 0, "the native scene to write (of a setting.json: scene.json beside it)", 0 },
    { "force", KEY_FORCE, NULL, 0, "replace FILE if it exists", 0 },
    { "quiet", 'q', NULL, 0, "do not print what became of the keys", 0 },
    { 0 }
};

static int is_setting(const char *path)
{
    const char *slash = strrchr(path, '/');
    return strcmp(slash ? slash + 1 : path, "setting.json") == 0;
}

static char *place_beside(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *place = NULL;
    if (asprintf(&place, "%.*sscene.json", slash ? (int)(slash - path) + 1 : 0, path) < 0)
        exit(complain("out of memory"));
    return place;
}

static error_t parse(int key, char *value, struct argp_state *state)
{
    import_options *o = state->input;
    switch (key) {
    case 'o': o->out = value; break;
    case 'q': o->quiet = 1; break;
    case KEY_FORCE: o->force = 1; break;
    case ARGP_KEY_SUCCESS:
        o->path = import_path(o->scene);
        if (!o->out && is_setting(o->path)) o->out = o->beside = place_beside(o->path);
        if (!o->out && access(o->path, F_OK) != 0)
            usage_error(state, tr("there is no %s: a scene, or a folder with a setting.json"), o->path);
        if (!o->out || !*o->out) usage_error(state, tr("--out says where the native scene goes"));
        break;
    default: return parse_argument(state, key, value, "SCENE", &o->scene);
    }
    return 0;
}

const struct argp import_argp = { .options = options, .parser = parse, .args_doc = "SCENE",
    .doc = "Translate a scene of the Taichi program (SPH_Taichi and its relatives), or parameters.py of "
           "the one that cuts an apple, or a folder of the tank program (setting.json), into a native scene. "
           "\"run\" and \"check\" take such scenes as they are." };

int tobiuo_import(int argc, char **argv)
{
    import_options o = { 0 };
    parse_arguments(&import_argp, argc, argv, &o);
    char *table = NULL;
    tobi_report *report = NULL;
    tobi_error err = { 0 };
    tobi_status status = tobi_scene_import(o.path, o.out, o.force, &table, &report, &err);
    int code = status == TOBI_OK ? 0 : complain_scene(report, &err);
    if (code == 0 && !o.quiet) printf(tr("%s\nwritten to %s\n"), table, o.out);
    free(table);
    free(o.path);
    free(o.beside);
    return code;
}
