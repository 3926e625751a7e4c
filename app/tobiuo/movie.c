/* tobiuo movie DIR: the pictures of a run as a movie, encoded by ffmpeg, or as a sheet (sheet.c). Pictures
   that are missing are drawn from the results (decision 91). The movie runs as fast as the scene did, or
   slower by a given factor. Drawback: what makes it is a second program. */
#define _GNU_SOURCE
#include "app.h"
#include "language.h"
#include "table.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

/* Pictures per second at most: more are left out. */
static const double FASTEST = 60;
/* Pictures per second that ffmpeg reads. */
static const double LEAST_RATE = 1e-3, MOST_RATE = 1e6;

typedef struct movie_options {
    const char *dir, *out, *view;
    double slow;
    int force;
    overrides set;
} movie_options;

enum { KEY_SLOW = KEY_OWN, KEY_FORCE, KEY_VIEW, KEY_VALUE };

static const struct argp_option options[] = {
    { "out", 'o', "FILE", 0, "the movie: .mp4, .webm, .webp or .gif; or a sheet of a dozen pictures: .png "
        "(DIR/movie.mp4)", 0 },
    { "view", KEY_VIEW, "NAME", 0, "the pictures of this entry of output.views", 0 },
    { "set", KEY_VALUE, "PATH=VALUE", 0, "draw all pictures anew with this value of the scene, e.g. "
        "output.picture.field=pressure", 0 },
    { "slow", KEY_SLOW, "N", 0, "N times slower than the scene was (1)", 0 },
    { "force", KEY_FORCE, NULL, 0, "replace FILE", 0 },
    { 0 }
};

/* How each kind of movie is made. yuv420p and even sizes are what all players know. */
#define EVEN "pad=ceil(iw/2)*2:ceil(ih/2)*2"
static const struct kind { const char *ending, *format, *option[11]; } kinds[] = {
    { ".mp4", "mp4", { "-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p", "-vf", EVEN, NULL } },
    { ".webm", "webm", { "-c:v", "libvpx-vp9", "-crf", "30", "-pix_fmt", "yuv420p", "-vf", EVEN, NULL } },
    { ".webp", "webp", { "-c:v", "libwebp", "-loop", "0", "-q:v", "50", "-vf", "scale='min(560,iw)':-2",
                         NULL } },
    { ".gif", "gif", { "-vf", "split[a][b];[a]palettegen[p];[b][p]paletteuse", NULL } },
};
enum { KINDS = sizeof kinds/sizeof *kinds };
/* The movie of a report: small enough to be part of a page. */
static const struct kind small = { "", "mp4", { "-c:v", "libx264", "-preset", "slow", "-crf", "30",
                                                "-pix_fmt", "yuv420p", "-vf", "scale=640:-2", NULL } };

static const struct kind *find_kind(const char *path)
{
    const char *dot = strrchr(path, '.');
    for (int k = 0; dot && k < KINDS; k++)
        if (strcasecmp(dot, kinds[k].ending) == 0) return &kinds[k];
    return NULL;
}

const char *movie_objection(const char *path)
{
    return find_kind(path) ? NULL
                           : tr("is no movie that can be made: its name ends in .mp4, .webm, .webp or .gif");
}

int is_png(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && strcasecmp(dot, ".png") == 0;
}

static error_t parse(int key, char *value, struct argp_state *state)
{
    movie_options *o = state->input;
    switch (key) {
    case 'o':
        if (movie_objection(value) && !is_png(value))
            usage_error(state, tr("--out: '%s' %s, that of a sheet in .png"), value, movie_objection(value));
        o->out = value;
        break;
    case KEY_SLOW: o->slow = parse_positive(state, "--slow", value); break;
    case KEY_VIEW: o->view = value; break;
    case KEY_VALUE: overrides_add(&o->set, "%s", value); break;
    case KEY_FORCE: o->force = 1; break;
    default: return parse_argument(state, key, value, "DIR", &o->dir);
    }
    return 0;
}

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The median: the last output may come sooner than the others, and a table may lack rows. */
static double find_usual_step(const table *t, int column)
{
    const size_t count = t->rows - 1;
    double *step = malloc(count*sizeof *step + 1), usual = 0;
    for (size_t k = 0; step && k < count; k++)
        step[k] = table_number(t, k + 1, column) - table_number(t, k, column);
    if (step && count > 0) {
        qsort(step, count, sizeof *step, compare_numbers);
        usual = step[count/2];
    }
    free(step);
    return usual;
}

/* s from one output to the next; 0 if the table does not say. *outputs: how many there were; -1 after a
   complaint. */
static double find_interval(const char *dir, int64_t *outputs)
{
    table t = { 0 };
    char *path = NULL;
    double interval = 0;
    *outputs = -1;
    if (asprintf(&path, "%s/history.csv", dir) < 0) return 0;
    if (table_read(&t, path) == 0) {
        const int column = table_column(&t, "time");
        *outputs = (int64_t)t.rows;
        if (column >= 0 && t.rows > 1) interval = find_usual_step(&t, column);
    }
    table_free(&t);
    free(path);
    return isfinite(interval) && interval > 0 ? interval : 0;
}

static char *append(char *to, const char *text)
{
    for (; *text; text++) {
        if (*text == '%') *to++ = '%';
        *to++ = *text;
    }
    *to = '\0';
    return to;
}

/* DIR/frames/frame_%06d.png; ffmpeg reads a % of a name as two. */
static char *name_pictures(const char *dir, const char *view)
{
    if (!view) view = "frame";
    char *path = malloc(2*(strlen(dir) + strlen(view)) + 32), *to = path;
    if (!path) return NULL;
    to = append(to, dir);
    to = append(stpcpy(to, "/frames/"), view);
    strcpy(to, "_%06d.png");
    return path;
}

/* Transparent pictures on white, in a movie that has no alpha: of the negative black is the paper. */
#define ON_WHITE "format=gbrap,negate,premultiply=inplace=1,negate,"

static int has_pictures_with_alpha(const char *dir, const char *view)
{
    char *path = frame_path(dir, view, find_pictures(dir, view).first);
    const int alpha = path && is_transparent(path);
    free(path);
    return alpha;
}

/* The options of a kind behind argument n; the next n. *filter is the caller's. */
static int add_options(const struct kind *kind, int alpha, char **argument, int n, char **filter)
{
    for (int k = 0; kind->option[k]; k++) {
        argument[n++] = (char *)kind->option[k];
        if (!alpha || k == 0 || strcmp(kind->option[k - 1], "-vf") != 0) continue;
        if (asprintf(filter, ON_WHITE "%s", kind->option[k]) < 0) *filter = NULL;
        else argument[n - 1] = *filter;
    }
    return n;
}

/* What ffmpeg did not make, and which picture it may be because of. */
static int complain_encoder(const char *dir, const char *view, const char *pictures, const char *said)
{
    char *damaged = find_damaged(dir, view);
    if (damaged) complain("%s is damaged; delete it, and the movie draws it anew from the results", damaged);
    else complain("ffmpeg failed on %s: %s", pictures, said);
    free(damaged);
    return EXIT_ERROR;
}

static int encode(const char *dir, const char *view, const char *part, const struct kind *kind, double rate)
{
    enum { ARGUMENTS = 32 };
    char *filter = NULL;
    int opaque = 0;
    for (int k = 0; kind->option[k]; k++) opaque |= strcmp(kind->option[k], "yuv420p") == 0;
    char *argument[ARGUMENTS], speed[32], most[32], *pictures = name_pictures(dir, view), *file = NULL;
    int n = 0;
    if (!pictures || asprintf(&file, "file:%s", part) < 0) {
        free(pictures);
        return complain("out of memory");
    }
    snprintf(speed, sizeof speed, "%.9g", rate);
    snprintf(most, sizeof most, "%.9g", fmin(rate, FASTEST));
    /* -xerror: without it a movie whose end had no room on the disk is a success. */
    const char *const first[] = { "ffmpeg", "-y", "-nostdin", "-xerror", "-loglevel", "error", "-framerate",
                                  speed, "-i", pictures };
    const char *const last[] = { "-r", most, "-f", kind->format, file };
    for (size_t k = 0; k < sizeof first/sizeof *first; k++) argument[n++] = (char *)first[k];
    n = add_options(kind, opaque && has_pictures_with_alpha(dir, view), argument, n, &filter);
    for (size_t k = 0; k < sizeof last/sizeof *last; k++) argument[n++] = (char *)last[k];
    argument[n] = NULL;
    char said[TOOL_SAYS];
    int code = run_tool(NULL, argument, tr("makes the movie"), "ffmpeg", 0, said);
    if (code < 0) code = complain_encoder(dir, view, pictures, said);
    free(filter);
    free(pictures);
    free(file);
    return code;
}

/* ffmpeg wants numbers from 0 on without gaps. */
static int encode_row(const char *dir, const char *view, const char *part, const struct kind *kind,
                      double rate)
{
    const pictures p = find_pictures(dir, view);
    char *folder = NULL;
    if (p.first == 0 && p.count == p.end) return encode(dir, view, part, kind, rate);
    if (asprintf(&folder, "%s.XXXXXX", part) < 0) return complain("out of memory");
    int code = link_pictures(dir, view, &p, folder);
    if (code == 0) {
        code = encode(folder, view, part, kind, rate);
        clear_pictures(folder, view);
    }
    free(folder);
    return code;
}

/* A movie is there whole or not at all. */
static int write_movie(const char *dir, const char *view, const char *out, const struct kind *kind,
                       double rate)
{
    char *part = NULL;
    if (asprintf(&part, "%s.part", out) < 0) return complain("out of memory");
    int code = encode_row(dir, view, part, kind, rate);
    if (code == 0 && rename(part, out) != 0) code = complain("cannot write %s: %s", out, tr(strerror(errno)));
    if (code != 0) unlink(part);
    free(part);
    return code;
}

int prepare_movie(const char *out, int force)
{
    return force || access(out, F_OK) != 0 ? 0 : complain("%s exists; --force replaces it", out);
}

int check_encoder(void)
{
    char *const ask[] = { "ffmpeg", "-version", NULL };
    const int code = run_tool(NULL, ask, tr("makes the movie"), "ffmpeg", 1, NULL);
    return code < 0 ? complain("ffmpeg does not work") : code;
}

int encode_pictures(const char *dir, const char *out, double rate)
{
    return write_movie(dir, NULL, out, find_kind(out), rate);
}

/* s between the pictures of a run, of which there are `count`; 0 after a complaint. */
static double check_pictures(const char *dir, int64_t count, int64_t *outputs)
{
    const double interval = count > 0 ? find_interval(dir, outputs) : 0;
    if (access(dir, F_OK) != 0) complain_run(dir, tr("there is no run"));
    else if (count == 0) complain("%s has no pictures", dir);
    else if (count > 1 && !(interval > 0))
        complain("%s/history.csv does not tell the times of two outputs, which a movie needs", dir);
    else if (count < 2 || !(interval > 0)) complain("%s has one output only, which is no movie", dir);
    else return interval;
    return 0;
}

static void say_gaps(const char *dir, const char *view, const char *out, const pictures *p, int64_t outputs)
{
    char *gaps = p->count < p->end - p->first ? list_gaps(dir, view, p) : NULL;
    if (p->first > 0)
        complain("%s begins with output %lld; the pictures before it are missing", out, (long long)p->first);
    if (gaps)
        complain("the pictures of these outputs are missing: %s; %s shows the picture before in their place",
                 gaps, out);
    if (outputs > p->end)
        complain("%s ends before output %lld of %lld, whose picture is missing", out, (long long)p->end,
                 (long long)outputs - 1);
    free(gaps);
}

/* Of the run in dir, whose pictures are in at/frames. */
static int make_movie_of(const char *dir, const char *at, const char *view, const char *out, double slow)
{
    const pictures p = find_pictures(at, view);
    const int64_t count = p.end - p.first;
    int64_t outputs;
    const double interval = check_pictures(dir, p.count, &outputs);
    if (!(interval > 0)) return EXIT_ERROR;
    const int code = write_movie(at, view, out, find_kind(out), 1/(interval*slow));
    const int whole = outputs <= p.end && p.count == p.end;
    if (code == 0 && !whole) say_gaps(at, view, out, &p, outputs);
    if (code == 0)
        printf(tr("movie: %s, %lld pictures, %.4g s\n"), out, (long long)count, (double)count*interval*slow);
    return code == 0 && !whole ? EXIT_UNWRITTEN : code;
}

int make_movie(const char *dir, const char *view, const char *out, double slow, int force)
{
    const int code = prepare_movie(out, force);
    return code == 0 ? make_movie_of(dir, dir, view, out, slow) : code;
}

int make_small_movie(const char *dir, const char *out, double *slow)
{
    static const double SHORTEST = 4, STEPS[] = { 1, 2, 5, 10 };       /* s of a movie */
    const pictures p = find_pictures(dir, NULL);
    const int64_t count = p.end - p.first;
    int64_t outputs;
    const double interval = check_pictures(dir, p.count, &outputs);
    if (!(interval > 0)) return EXIT_ERROR;
    const double wanted = fmax(1, SHORTEST/((double)count*interval)), ten = pow(10, floor(log10(wanted)));
    for (int k = 0; k < 4; k++) {
        *slow = STEPS[k]*ten;
        if (*slow >= 0.999*wanted) break;
    }
    return write_movie(dir, NULL, out, &small, 1/(interval**slow));
}

/* A movie, or a sheet, of the pictures in at/frames. */
static int make(const movie_options *o, const char *at, const char *out)
{
    if (!is_png(out)) return make_movie_of(o->dir, at, o->view, out, o->slow);
    const int code = make_sheet(at, o->view, out);
    if (code == 0) printf(tr("sheet: %s\n"), out);
    return code;
}

/* Neither a table nor a picture: no run that a movie could be of. */
static int is_run(const movie_options *o)
{
    char *history = NULL;
    const int there = asprintf(&history, "%s/history.csv", o->dir) >= 0 && access(history, F_OK) == 0;
    free(history);
    return there || find_pictures(o->dir, o->view).count > 0;
}

/* With what is there, if the rest cannot be drawn: somebody may have kept the pictures alone. */
static int complete_and_make(const movie_options *o, const char *out)
{
    int64_t outputs;
    int code = 0;
    find_interval(o->dir, &outputs);
    const pictures p = find_pictures(o->dir, o->view);
    if (p.count < outputs || p.count < p.end) code = draw_missing(o->dir, o->view, &o->set, o->dir);
    return code == 0 || find_pictures(o->dir, o->view).count > 0 ? make(o, o->dir, out) : code;
}

/* In a folder that is removed: the pictures of the run stay as its scene has them. */
static int redraw_and_make(const movie_options *o, const char *out)
{
    char *folder = NULL;
    if (asprintf(&folder, "%s/movie.XXXXXX", o->dir) < 0) return complain("out of memory");
    int code = mkdtemp(folder) ? 0 : complain("cannot make a folder in %s: %s", o->dir, tr(strerror(errno)));
    if (code == 0) {
        code = draw_missing(o->dir, o->view, &o->set, folder);
        if (code == 0 || find_pictures(folder, o->view).count > 0) code = make(o, folder, out);
        clear_pictures(folder, o->view);
    }
    free(folder);
    return code;
}

/* Which the pictures of the run do not show. */
static int has_foam(const char *dir)
{
    char *path = join_path(dir, "foam.pvd");
    const int there = access(path, F_OK) == 0;
    free(path);
    return there;
}

/* Before anything is drawn for it. */
static int check_speed(const movie_options *o)
{
    int64_t outputs;
    const double interval = find_interval(o->dir, &outputs), rate = 1/(interval*o->slow);
    if (outputs < 0) return EXIT_ERROR;
    if (!(interval > 0) || (rate >= LEAST_RATE && rate <= MOST_RATE)) return 0;
    return complain("--slow %g makes %.3g pictures per second of outputs %g s apart; allowed are %g to %g",
                    o->slow, rate, interval, LEAST_RATE, MOST_RATE);
}

const struct argp movie_argp = { .options = options, .parser = parse, .args_doc = "DIR",
    .doc = "Make a movie of the run in DIR, with ffmpeg, or a sheet of a dozen pictures. Pictures that the "
           "run did not draw are drawn now, from its results; all of them where there is foam." };

int tobiuo_movie(int argc, char **argv)
{
    movie_options o = { .slow = 1 };
    char *own = NULL;
    parse_arguments(&movie_argp, argc, argv, &o);
    if (asprintf(&own, "%s/movie%s%s.mp4", o.dir, o.view ? "_" : "", o.view ? o.view : "") < 0)
        return complain("out of memory");
    const char *out = o.out ? o.out : own;
    int code = is_run(&o) ? 0 : complain_run(o.dir, tr("there is no run (no history.csv)"));
    if (code == 0 && !is_png(out)) code = check_speed(&o);
    if (code == 0) code = prepare_movie(out, o.force);
    if (code == 0 && !is_png(out)) code = check_encoder();
    if (code == 0) code = o.set.count || has_foam(o.dir) ? redraw_and_make(&o, out)
        : complete_and_make(&o, out);
    overrides_free(&o.set);
    free(own);
    return code;
}

char *movie_of_view(const char *out, const char *view)
{
    char *path = NULL;
    const char *dot = strrchr(out, '.');
    return asprintf(&path, "%.*s_%s%s", (int)(dot - out), out, view, dot) < 0 ? NULL : path;
}
