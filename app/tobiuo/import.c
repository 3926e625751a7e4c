/* tobiuo import OLD --out NEW.json: a scene of the Taichi program as a native one. */
#include "app.h"
#include <stdio.h>
#include <stdlib.h>

typedef struct import_options { const char *scene, *out; int force, quiet; } import_options;

enum { KEY_FORCE = KEY_OWN };

static const struct argp_option options[] = {
    { "out", 'o', "FILE", 0, "the native scene to write", 0 },
    { "force", KEY_FORCE, NULL, 0, "replace FILE if it exists", 0 },
    { "quiet", 'q', NULL, 0, "do not print what became of the keys", 0 },
    { 0 }
};

static error_t parse(int key, char *value, struct argp_state *state)
{
    import_options *o = state->input;
    switch (key) {
    case 'o': o->out = value; break;
    case 'q': o->quiet = 1; break;
    case KEY_FORCE: o->force = 1; break;
    case ARGP_KEY_SUCCESS:
        if (!o->out || !*o->out) argp_error(state, "--out says where the native scene goes");
        break;
    default: return parse_argument(state, key, value, "SCENE", &o->scene);
    }
    return 0;
}

const struct argp import_argp = { .options = options, .parser = parse, .args_doc = "SCENE",
    .doc = "Translate a scene of the Taichi program (SPH_Taichi and its relatives), or parameters.py of "
           "the one that cuts an apple, into a native scene. "
           "\"run\" and \"check\" take such scenes as they are." };

int tobiuo_import(int argc, char **argv)
{
    import_options o = { 0 };
    parse_arguments(&import_argp, argc, argv, &o);
    char *table = NULL, *path = scene_path(o.scene);
    tobi_report *report = NULL;
    tobi_error err = { 0 };
    tobi_status status = tobi_scene_import(path, o.out, o.force, &table, &report, &err);
    int code = status == TOBI_OK ? 0 : complain_scene(report, &err);
    if (code == 0 && !o.quiet) printf("%s\nwritten to %s\n", table, o.out);
    free(table);
    free(path);
    return code;
}
