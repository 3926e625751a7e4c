/* tobiuo describe [TOPIC] */
#include "app.h"
#include <stdio.h>
#include <stdlib.h>

static error_t parse(int key, char *value, struct argp_state *state)
{
    const char **topic = state->input;
    if (key != ARGP_KEY_ARG) return ARGP_ERR_UNKNOWN;
    if (*topic) argp_error(state, "one TOPIC only");
    *topic = value;
    return 0;
}

int tobiuo_describe(int argc, char **argv)
{
    static const struct argp argp = { .parser = parse, .args_doc = "[TOPIC]",
        .doc = "Parameters of a method or of a part of a scene; without TOPIC, the topics." };
    const char *topic = NULL;
    argp_parse(&argp, argc, argv, 0, NULL, &topic);
    char *text = tobi_scene_describe(topic);
    if (!text) {
        complain("there is no topic '%s'", topic ? topic : "");
        text = tobi_scene_describe(NULL);
        if (text) fputs(text, stderr);
        free(text);
        return EXIT_ERROR;
    }
    fputs(text, stdout);
    free(text);
    return 0;
}
