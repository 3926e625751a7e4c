/* tobiuo describe [WORD] */
#include "app.h"
#include <stdio.h>
#include <stdlib.h>

static error_t parse(int key, char *value, struct argp_state *state)
{
    const char **topic = state->input;
    if (key != ARGP_KEY_ARG) return ARGP_ERR_UNKNOWN;
    if (*topic) usage_error(state, tr("one WORD only"));
    *topic = value;
    return 0;
}

const struct argp describe_argp = { .parser = parse, .args_doc = "[WORD]",
    .doc = "Tell what a WORD means: a topic such as fluid or history, or any key of a scene, field of "
           "particles or column of a table. Without WORD, the topics." };

int tobiuo_describe(int argc, char **argv)
{
    const char *topic = NULL;
    parse_arguments(&describe_argp, argc, argv, &topic);
    char *text = tobi_scene_describe(topic);
    if (!text) {
        char *near = tobi_scene_suggest(topic ? topic : "");
        if (near) complain("nothing is called '%s'; did you mean %s?", topic, near);
        else complain("nothing is called '%s'; \"tobiuo describe\" lists the topics", topic ? topic : "");
        free(near);
        return EXIT_ERROR;
    }
    fputs(text, stdout);
    free(text);
    return 0;
}
