/* tobiuo sweep SCENE --set KEY=A,B ...: runs of all combinations, one table and one plot of them. All are
   checked before the first one runs. Drawback: a value with a comma of its own must stand in brackets. */
#define _GNU_SOURCE
#include "sweep.h"
#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { KEY_SLURM = KEY_OWN, KEY_ONLY, KEY_TABLE, KEY_PLOT, KEY_WAVES, KEY_FROM };

static const struct argp_option options[] = {
    { "set", KEY_SET, "PATH=A,B,...", 0, "values of a key of the scene; several --set: all combinations", 0 },
    { "until", KEY_UNTIL, "S", 0, "simulated time to stop at, s", 0 },
    { "from", KEY_FROM, "S", 0, "means and extremes of the table begin at this time, s (0)", 0 },
    { "out", 'o', "DIR", 0, "where the runs go (out/<scene>_sweep)", 0 },
    { "jobs", 'j', "N", 0, "runs at the same time; they share the cores (1)", 0 },
    { "slurm", KEY_SLURM, NULL, 0, "write DIR/sweep.slurm, an array job, and run nothing", 0 },
    { "only", KEY_ONLY, "K", 0, "only the run number K, from 0, without the table", 0 },
    { "table", KEY_TABLE, NULL, 0, "run nothing; write the table and the plot of what there is", 0 },
    { "plot", KEY_PLOT, "COLUMN", 0,
      "what the plot shows: a column of probes.csv, lines.csv, joints.csv, porous_zones.csv, scalars.csv or "
      "history.csv; "
      "or of a body: "
      "BODY_position_x, BODY_force_z", 0 },
    { "waves", KEY_WAVES, "OPTIONS", 0, "at the end \"tobiuo waves\" of each run with these options, and its "
      "tables of all runs in one", 0 },
    { 0 }
};

/* --- the combinations ---------------------------------------------------------------------- */

static void *grow(void *list, size_t count, size_t size)
{
    void *more = reallocarray(list, count, size);
    if (!more) exit(complain("out of memory"));
    return more;
}

/* The end of the value that begins at text: a comma outside of brackets and quotes. */
static const char *end_of_value(const char *text)
{
    int depth = 0, quoted = 0;
    for (; *text && (*text != ',' || depth > 0 || quoted); text++) {
        quoted ^= *text == '"';
        if (!quoted) depth += (*text == '[' || *text == '{') - (*text == ']' || *text == '}');
    }
    return text;
}

static void add_axis(sweep *s, struct argp_state *state, const char *text)
{
    const char *equals = strchr(text, '=');
    if (!equals || equals == text || !equals[1])
        usage_error(state, tr("--set wants PATH=A,B,..., not '%s'"), text);
    s->axes = grow(s->axes, (size_t)s->axis_count + 1, sizeof *s->axes);
    sweep_axis *a = &s->axes[s->axis_count++];
    *a = (sweep_axis){ .path = strndup(text, (size_t)(equals - text)) };
    for (const char *at = equals + 1;;) {
        const char *end = end_of_value(at);
        if (end == at) usage_error(state, tr("--set %s: a value is empty"), text);
        a->value = grow(a->value, (size_t)a->count + 1, sizeof *a->value);
        char *value = a->value[a->count] = strndup(at, (size_t)(end - at));
        for (int k = 0; k < a->count; k++)
            if (strcmp(a->value[k], value) == 0)
                usage_error(state, tr("--set %s: %s is there twice"), text, value);
        a->count++;
        if (!*end) break;
        at = end + 1;
    }
    for (int k = 0; k < s->axis_count - 1; k++)
        if (strcmp(s->axes[k].path, a->path) == 0) usage_error(state, tr("--set %s is given twice"), a->path);
}

static const char *last_key(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && dot[1] ? dot + 1 : path;
}

static int finish_axes(sweep *s)
{
    double runs = 1;
    if (s->axis_count == 0) return complain("a sweep varies something: --set spacing=0.02,0.01");
    for (int k = 0; k < s->axis_count; k++) {
        int alone = 1;
        runs *= s->axes[k].count;
        for (int j = 0; j < s->axis_count; j++)
            alone &= j == k || strcmp(last_key(s->axes[j].path), last_key(s->axes[k].path)) != 0;
        s->axes[k].label = strdup(alone ? last_key(s->axes[k].path) : s->axes[k].path);
    }
    if (runs > SWEEP_RUNS) return complain("%g combinations, allowed are %d", runs, SWEEP_RUNS);
    s->runs = (int)runs;
    if (s->only < s->runs) return 0;
    return complain("--only %d: the runs have numbers from 0 to %d", s->only, s->runs - 1);
}

/* The last axis changes fastest. */
const char *sweep_value(const sweep *s, int run, int axis)
{
    for (int k = s->axis_count - 1; k > axis; k--) run /= s->axes[k].count;
    return s->axes[axis].value[run % s->axes[axis].count];
}

char *sweep_name(const sweep *s, int run)
{
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!out) exit(complain("out of memory"));
    for (int k = 0; k < s->axis_count; k++)
        if (s->axes[k].count > 1)
            fprintf(out, "%s%s=%s", ftell(out) > 0 ? "_" : "", s->axes[k].label, sweep_value(s, run, k));
    if (ftell(out) == 0) fputs("run", out);
    if (fclose(out) != 0) exit(complain("out of memory"));
    for (char *c = text; *c; c++)
        if ((unsigned char)*c <= ' ' || strchr("/\\:*?\"<>|,'[]{}", *c)) *c = '_';
    return text;
}

char *sweep_path(const sweep *s, const char *format, ...)
{
    char *rest = NULL, *path = NULL;
    va_list args;
    va_start(args, format);
    if (vasprintf(&rest, format, args) < 0) rest = NULL;
    va_end(args);
    if (!rest || asprintf(&path, "%s/%s", s->dir, rest) < 0) exit(complain("out of memory"));
    free(rest);
    return path;
}

json_t *sweep_summary(const sweep *s, int run)
{
    char *name = sweep_name(s, run), *path = sweep_path(s, "%s/summary.json", name);
    json_t *json = json_load_file(path, 0, NULL);
    free(path);
    free(name);
    return json;
}

/* Every combination as a scene, so that a mistake is told before hours of computing. */
static int check_runs(const sweep *s)
{
    int code = 0;
    for (int run = 0; run < s->runs && !code; run++) {
        overrides set = { 0 };
        if (s->until) overrides_add(&set, "end_time=%s", s->until);
        for (int k = 0; k < s->axis_count; k++)
            overrides_add(&set, "%s=%s", s->axes[k].path, sweep_value(s, run, k));
        tobi_scene *scene = load_scene(s->scene, &set);
        char *name = sweep_name(s, run);
        if (scene && run == 0 && s->waves) code = sweep_check_waves(s, scene);
        if (!scene) code = complain("run %d of %d, %s, cannot be; nothing has been run", run, s->runs, name);
        free(name);
        tobi_scene_free(scene);
    }
    return code;
}

/* --- the command --------------------------------------------------------------------------- */

static int parse_count(struct argp_state *state, const char *option, const char *text, long least, long most)
{
    char *end;
    const long value = strtol(text, &end, 10);
    if (end == text || *end || value < least || value > most)
        usage_error(state, tr("%s: '%s' is not a number from %ld to %ld"), option, text, least, most);
    return (int)value;
}

static error_t parse(int key, char *value, struct argp_state *state)
{
    sweep *s = state->input;
    switch (key) {
    case KEY_SET: add_axis(s, state, value); break;
    case KEY_UNTIL:
        parse_positive(state, "--until", value);
        s->until = value;
        break;
    case KEY_FROM: s->from = parse_time(state, "--from", value); break;
    case 'o':
        if (!*value) usage_error(state, tr("--out is empty"));
        s->dir = value;
        break;
    case 'j': s->jobs = parse_count(state, "--jobs", value, 1, 256); break;
    case KEY_SLURM: s->slurm = 1; break;
    case KEY_ONLY: s->only = parse_count(state, "--only", value, 0, SWEEP_RUNS - 1); break;
    case KEY_TABLE: s->table = 1; break;
    case KEY_PLOT: s->plot = value; break;
    case KEY_WAVES: s->waves = value; break;
    default: return parse_argument(state, key, value, "SCENE", &s->scene);
    }
    return 0;
}

const struct argp sweep_argp = { .options = options, .parser = parse, .args_doc = "SCENE",
    .doc = "Run a scene with all combinations of the values of some keys, and write one table and one plot "
           "of all runs. What is complete is not run again, what began is resumed." };

static int make_folders(const char *path)
{
    char *copy = strdup(path);
    int failed = !copy;
    for (char *p = copy; p && *p && !failed; p++) {
        if (p[1] && (p[1] != '/' || p == copy)) continue;
        const char kept = p[1];
        p[1] = '\0';
        failed = mkdir(copy, 0777) != 0 && errno != EEXIST;
        p[1] = kept;
    }
    free(copy);
    struct stat is;
    if (!failed && stat(path, &is) == 0 && !S_ISDIR(is.st_mode)) failed = 1, errno = ENOTDIR;
    return failed ? complain("cannot make the directory %s: %s", path, tr(strerror(errno))) : 0;
}

/* Without --out: out/SCENE_sweep, by the scene's own name. */
static int choose_folder(sweep *s)
{
    overrides none = { 0 };
    tobi_scene *scene = s->dir ? NULL : load_scene(s->scene, &none);
    if (!s->dir && !scene) return EXIT_ERROR;
    if (scene && asprintf(&s->own_dir, "out/%s_sweep", tobi_scene_name(scene)) < 0)
        exit(complain("out of memory"));
    tobi_scene_free(scene);
    if (!s->dir) s->dir = s->own_dir;
    return 0;
}

/* A run has one end. */
static int has_two_ends(const sweep *s)
{
    int has = 0;
    for (int k = 0; k < s->axis_count; k++) has |= s->until && strcmp(s->axes[k].path, "end_time") == 0;
    return has;
}

static int do_sweep(sweep *s)
{
    if (has_two_ends(s)) return complain("--until and --set end_time: one of them");
    int code = finish_axes(s);
    if (!code) code = choose_folder(s);
    if (!code) code = check_runs(s);
    double end = 0;
    for (int run = 0; run < s->runs && !code; run++) sweep_look(s, run, &end, &code);
    if (!code) code = make_folders(s->dir);
    if (code) return code;
    if (s->slurm) return sweep_write_slurm(s);
    if (!s->table) code = sweep_run(s);
    if (s->only >= 0 || code == EXIT_INTERRUPTED) return code;
    int drawn = sweep_write_table(s);
    if (!drawn) drawn = sweep_draw(s);
    if (!drawn && s->waves) drawn = sweep_analyse_waves(s);
    return code ? code : drawn;
}

int tobiuo_sweep(int argc, char **argv)
{
    sweep s = { .jobs = 1, .only = -1 };
    parse_arguments(&sweep_argp, argc, argv, &s);
    const int code = do_sweep(&s);
    for (int k = 0; k < s.axis_count; k++) {
        for (int v = 0; v < s.axes[k].count; v++) free(s.axes[k].value[v]);
        free(s.axes[k].value);
        free(s.axes[k].path);
        free(s.axes[k].label);
    }
    free(s.axes);
    free(s.own_dir);
    return code;
}
