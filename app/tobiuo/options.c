/* Values of options. */
#include "app.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

void parse_arguments(const struct argp *argp, int argc, char **argv, void *input)
{
    const struct argp common = { .options = common_options(), .parser = parse_common };
    const struct argp_child children[] = { { .argp = &common }, { 0 } };
    struct argp whole = *argp;
    whole.children = children;
    const error_t code = argp_parse(&whole, argc, argv, ARGP_NO_HELP | ARGP_NO_ERRS, NULL, input);
    if (code) exit(complain("the arguments cannot be read: %s", tr(strerror(code))));
}

double parse_positive(struct argp_state *state, const char *option, const char *text)
{
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(value) || value <= 0.0)
        usage_error(state, tr("%s: '%s' is not a positive number"), option, text);
    return value;
}

double parse_time(struct argp_state *state, const char *option, const char *text)
{
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(value) || value < 0)
        usage_error(state, tr("%s: '%s' is not a number from 0 on"), option, text);
    return value;
}

int parse_threads(struct argp_state *state, const char *text)
{
    char *end;
    long value = strtol(text, &end, 10);
    if (end == text || *end != '\0' || value < 0 || value > 4096)
        usage_error(state, tr("--threads: '%s' is not a number from 0 (all cores) to 4096"), text);
    return (int)value;
}

void parse_language(struct argp_state *state, const char *value)
{
    if (choose_language(value) != 0)
        usage_error(state, tr("--language: '%s' is neither ja nor en"), value);
}

int take_language(int argc, char **argv)
{
    static const char option[] = "--language";
    const size_t length = strlen(option);
    if (argc < 2 || strncmp(argv[1], option, length) != 0) return 0;
    const char *value = argv[1][length] == '=' ? argv[1] + length + 1 : argc > 2 ? argv[2] : "";
    if (argv[1][length] && argv[1][length] != '=') return 0;
    if (choose_language(value) == 0) return argv[1][length] ? 1 : 2;
    complain("--language: '%s' is neither ja nor en", value);
    return -1;
}

error_t parse_argument(struct argp_state *state, int key, const char *value, const char *name,
                       const char **argument)
{
    switch (key) {
    case ARGP_KEY_ARG:
        if (*argument && strchr(value, '='))
            usage_error(state, tr("one %s only; a value is changed by --set %s"), name, value);
        if (*argument) usage_error(state, tr("one %s only"), name);
        if (!*value) usage_error(state, tr("%s is empty"), name);
        *argument = value;
        return 0;
    case ARGP_KEY_END:
        if (!*argument) usage_error(state, tr("which %s?"), name);
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

error_t parse_scene_option(struct argp_state *state, int key, const char *value, overrides *set,
                           const char **scene)
{
    switch (key) {
    case KEY_UNTIL:
        overrides_add(set, "end_time=%.17g", parse_positive(state, "--until", value));
        return 0;
    case KEY_SPACING:
        overrides_add(set, "spacing=%.17g", parse_positive(state, "--spacing", value));
        return 0;
    case KEY_SET:
        if (!strchr(value, '=') || value[0] == '=')
            usage_error(state, tr("--set wants PATH=VALUE, not '%s'"), value);
        overrides_add(set, "%s", value);
        return 0;
    default: return parse_argument(state, key, value, "SCENE", scene);
    }
}
