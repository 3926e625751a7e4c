/* tobiuo waves --response: how bodies, moorings and joints follow the waves (decision 149). Drawback: waves
   go one way; answers of second order, as slow drift, are in the significant values and not in the gains. */
#define _GNU_SOURCE
#include "app.h"
#include "language.h"
#include "waves.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOTIONS = 6 };
static const int FEW_ROWS = 10;       /* of a period: with fewer a cubic loses crests */
static const double FEW_PERIODS = 8;  /* of fewer a gain is that of the waves that happened to come */

/* One quantity over time. */
typedef struct response {
    wave_gauge record;
    char label[200], unit[24];
    double least, most;             /* of the rows, mean included                              */
    double way;                     /* m, from the first gauge of the waves to its mean place  */
    wave_gain *gain;                /* owned, of wave_set.bins frequencies                     */
} response;

/* All of them, and the waves that they follow. */
typedef struct answers {
    const wave_run *run;
    response list[RESPONSES*MOTIONS];
    int count;
    double complex *waves;          /* owned                                                   */
    double height;                  /* m: H_m0 of these waves                                  */
    double direction[3], first[3];  /* of the waves; place of the first gauge, m               */
    size_t peak;                    /* of the list of frequencies                              */
} answers;

/* Rows of a table that have values. */
typedef struct rows {
    double *time, *value[MOTIONS];  /* owned */
    size_t count;
} rows;

static void free_rows(rows *r)
{
    free(r->time);
    for (int k = 0; k < MOTIONS; k++) free(r->value[k]);
}

static int make_rows(rows *r, size_t count)
{
    *r = (rows){ .time = calloc(count + 1, sizeof(double)) };
    int good = r->time != NULL;
    for (int k = 0; k < MOTIONS; k++) good &= (r->value[k] = calloc(count + 1, sizeof(double))) != NULL;
    return good ? 0 : complain("out of memory");
}

/* --- reading --- */

/* The cubic through the four rows around each time of the set: at ends those that there are. */
static int resample(const wave_run *w, const rows *r, int column, const char *name, response *one)
{
    const wave_set *s = &w->set;
    const double end = s->begin + ((double)s->count - 1)*s->step, slack = 1e-6*s->step;
    const double *t = r->time, *v = r->value[column];
    if (r->count < 4 || t[0] > s->begin + slack || t[r->count - 1] < end - s->step - slack)
        return complain("--response %s: its rows do not cover %.4g to %.4g s, the time of the levels", name,
                        s->begin, end);
    if (!(one->record.eta = calloc(s->count, sizeof(double)))) return complain("out of memory");
    one->least = INFINITY, one->most = -INFINITY;
    for (size_t n = 0, i = 0; n < s->count; n++) {
        const double at = fmin(s->begin + (double)n*s->step, t[r->count - 1]);
        while (i + 4 < r->count && t[i + 2] < at) i++;
        double sum = 0;
        for (size_t a = i; a < i + 4; a++) {
            double weight = 1;
            for (size_t b = i; b < i + 4; b++)
                if (b != a) weight *= (at - t[b])/(t[a] - t[b]);
            sum += weight*v[a];
        }
        one->record.eta[n] = sum;
    }
    for (size_t i = 0; i < r->count; i++)      /* of the rows: the cubic goes past the ends of a snatch */
        if (t[i] >= s->begin - slack && t[i] <= end + slack)
            one->least = fmin(one->least, v[i]), one->most = fmax(one->most, v[i]);
    return 0;
}

static void note_rows(const wave_run *w, const rows *r, const char *name)
{
    const double step = (r->time[r->count - 1] - r->time[0])/((double)r->count - 1);
    const double period = 1/w->set.peak;
    if (period < FEW_ROWS*step)
        fprintf(stderr, tr("tobiuo: note: --response %s: %.1f rows in a period of the waves; take an "
                "interval of the output of %.2g s or less\n"), name, period/step, period/FEW_ROWS);
}

static response *add_response(answers *a, const char *unit)
{
    response *one = &a->list[a->count++];
    *one = (response){ 0 };
    snprintf(one->unit, sizeof one->unit, "%s", unit);
    return one;
}

/* The part of the attitude q beyond q0 as a rotation about fixed axes, degrees. */
static void find_turn(const double q[4], const double q0[4], double turn[3])
{
    const double w = q[0]*q0[0] + q[1]*q0[1] + q[2]*q0[2] + q[3]*q0[3];
    double v[3], size = 0;
    v[0] = -q[0]*q0[1] + q[1]*q0[0] - q[2]*q0[3] + q[3]*q0[2];
    v[1] = -q[0]*q0[2] + q[2]*q0[0] - q[3]*q0[1] + q[1]*q0[3];
    v[2] = -q[0]*q0[3] + q[3]*q0[0] - q[1]*q0[2] + q[2]*q0[1];
    for (int k = 0; k < 3; k++) size += v[k]*v[k];
    size = sqrt(size);
    const double angle = 2*atan2(size, fabs(w))*(w < 0 ? -1 : 1);
    for (int k = 0; k < 3; k++) turn[k] = size > 0 ? angle*v[k]/size*180/acos(-1) : 0;
}

/* Shifts, then turns; in 2-D x, y and the turn about z. */
static int read_body_rows(const wave_run *w, const table *t, const char *body, rows *r)
{
    static const char *const columns[] = { "position_x", "position_y", "position_z", "orientation_w",
                                           "orientation_x", "orientation_y", "orientation_z" };
    const int time = table_column(t, "time"), name = table_column(t, "name");
    const int angle = table_column(t, "angle");
    int column[7];
    double q0[4] = { 0 };
    for (int k = 0; k < 7; k++) column[k] = table_column(t, columns[k]);
    if (time < 0 || name < 0 || column[0] < 0 || (w->dimension == 2 ? angle : column[6]) < 0)
        return complain("%s: it lacks places and attitudes of bodies", t->path);
    if (make_rows(r, t->rows) != 0) return EXIT_ERROR;
    for (size_t i = 0; i < t->rows; i++) {
        if (strcmp(t->cells[i*(size_t)t->columns + (size_t)name], body) != 0) continue;
        const size_t n = r->count;
        double q[4], turn[3] = { 0, 0, 0 };
        r->time[n] = table_number(t, i, time);
        if (!isfinite(r->time[n]) || (n > 0 && !(r->time[n] > r->time[n - 1]))) continue;
        for (int k = 0; k < w->dimension; k++) r->value[k][n] = table_number(t, i, column[k]);
        for (int k = 0; k < 4 && w->dimension == 3; k++) q[k] = table_number(t, i, column[3 + k]);
        if (n == 0) memcpy(q0, q, sizeof q0);
        if (w->dimension == 2) turn[2] = table_number(t, i, angle);
        else find_turn(q, q0, turn);
        for (int k = 0; k < 3; k++) r->value[3 + k][n] = turn[k];
        r->count += isfinite(r->value[0][n]) && isfinite(turn[2]);
    }
    return 0;
}

static int add_body(answers *a, const table *t, const char *body)
{
    static const char *const part[] = { "x", "y", "z", "turn_x", "turn_y", "turn_z" };
    const wave_run *w = a->run;
    rows r = { 0 };
    const double end = w->set.begin + ((double)w->set.count - 1)*w->set.step;
    double way = 0;
    int code = read_body_rows(w, t, body, &r), moves = 0;
    for (int k = 0; k < MOTIONS && !code; k++) {
        double mean = 0, low = INFINITY, high = -INFINITY, count = 0;
        for (size_t n = 0; n < r.count; n++) {
            const double value = r.value[k][n];
            if (r.time[n] < w->set.begin || r.time[n] > end) continue;
            mean += value, count++;
            low = fmin(low, value), high = fmax(high, value);
        }
        mean /= fmax(count, 1);
        if (k < 3) way += a->direction[k]*(mean - a->first[k]);
        if (!(high > low)) continue;
        response *one = add_response(a, k < 3 ? "m" : "degrees");
        snprintf(one->label, sizeof one->label, "%.180s_%s", body, part[k]);
        code = resample(w, &r, k, body, one);
        moves++;
    }
    for (int k = 0; k < moves; k++) a->list[a->count - 1 - k].way = way;
    if (!code && !moves) code = complain("--response %s: the body does not move", body);
    if (!code) note_rows(w, &r, body);
    free_rows(&r);
    return code;
}

static int add_column(answers *a, const table *t, int column, const char *name)
{
    const int time = table_column(t, "time [s]") >= 0 ? table_column(t, "time [s]") : table_column(t, "time");
    rows r = { 0 };
    const char *unit = strstr(t->names[column], " [");
    char own[24] = "1";
    if (time < 0) return complain("%s has no column \"time\"", t->path);
    if (make_rows(&r, t->rows) != 0) return free_rows(&r), EXIT_ERROR;
    for (size_t i = 0; i < t->rows; i++) {
        const double at = table_number(t, i, time), value = table_number(t, i, column);
        if (!isfinite(at) || !isfinite(value) || (r.count > 0 && !(at > r.time[r.count - 1]))) continue;
        r.time[r.count] = at, r.value[0][r.count++] = value;
    }
    if (unit) snprintf(own, sizeof own, "%.*s", (int)strcspn(unit + 2, "]"), unit + 2);
    response *one = add_response(a, own);
    snprintf(one->label, sizeof one->label, "%.180s", name);
    const int code = resample(a->run, &r, 0, name, one);
    if (!code) note_rows(a->run, &r, name);
    free_rows(&r);
    return code;
}

/* Of a name with or without its unit; -1: there is none. */
static int find_column(const table *t, const char *name)
{
    const size_t length = strlen(name);
    for (int k = 0; k < t->columns; k++)
        if (strncmp(t->names[k], name, length) == 0 &&
            (t->names[k][length] == '\0' || strncmp(t->names[k] + length, " [", 2) == 0)) return k;
    return -1;
}

static int has_body(const table *t, const char *body)
{
    const int name = table_column(t, "name");
    for (size_t i = 0; name >= 0 && i < t->rows; i++)
        if (strcmp(t->cells[i*(size_t)t->columns + (size_t)name], body) == 0) return 1;
    return 0;
}

/* Names that --response takes, owned. */
typedef struct known { char *name[256]; size_t count; } known;

static void add_known(known *k, const char *name)
{
    const char *unit = strstr(name, " [");
    for (size_t n = 0; n < k->count; n++)
        if (strcmp(k->name[n], name) == 0) return;
    if (k->count == sizeof k->name/sizeof *k->name) return;
    if ((k->name[k->count] = strndup(name, unit ? (size_t)(unit - name) : strlen(name)))) k->count++;
}

/* The bodies of bodies.csv, the columns of other tables but for the time. */
static void add_names(known *k, const table *t, int bodies)
{
    const int name = table_column(t, "name");
    for (size_t i = 0; bodies && name >= 0 && i < t->rows; i++)
        add_known(k, t->cells[i*(size_t)t->columns + (size_t)name]);
    for (int c = 1; !bodies && c < t->columns; c++) add_known(k, t->names[c]);
}

static int complain_name(const answers *a, const known *k, const char *name)
{
    const char *near = tobi_suggest(name, (const char *const *)k->name, k->count);
    char list[200] = "";
    size_t used = 0;
    for (size_t n = 0; n < k->count && !near && used + strlen(k->name[n]) < sizeof list - 8; n++)
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", n ? ", " : "", k->name[n]);
    return complain("--response %s: %s has no body of this name, and no such column in probes.csv, lines.csv "
                    "or joints.csv; %s %s%s", name, a->run->options->dir, near ? tr("did you mean")
                    : tr("there are"),
                    near ? near : k->count ? list : tr("none"), near ? "?" : "");
}

static int add_named(answers *a, const char *name)
{
    static const char *const files[] = { "bodies.csv", "probes.csv", "lines.csv", "joints.csv" };
    const char *dir = a->run->options->dir;
    known others = { .count = 0 };
    int code = 0, found = 0;
    for (int k = 0; k < 4 && !found && !code; k++) {
        table t = { 0 };
        char *path = join_path(dir, files[k]);
        const int there = access(path, F_OK) == 0;
        if (there && table_read(&t, path) != 0) code = EXIT_ERROR;
        free(path);
        if (!there || code) continue;
        const int column = k > 0 ? find_column(&t, name) : -1;
        found = k > 0 ? column >= 0 : has_body(&t, name);
        if (found) code = k > 0 ? add_column(a, &t, column, name) : add_body(a, &t, name);
        else add_names(&others, &t, k == 0);
        table_free(&t);
    }
    if (!found && !code) code = complain_name(a, &others, name);
    for (size_t n = 0; n < others.count; n++) free(others.name[n]);
    return code;
}

/* --- what is told --- */

static int take_waves(answers *a)
{
    const wave_run *w = a->run;
    const wave_set *s = &w->set;
    const int alone[1] = { 0 }, *group = w->options->group_count ? w->group[0] : alone;
    double at[MEMBERS] = { 0 };
    const int code = w->options->group_count ? waves_line_up(w, 0, at, a->direction) : 0;
    if (code) return code;
    if (!(a->waves = calloc(s->bins, sizeof *a->waves))) return complain("out of memory");
    wave_find_incident(s, group, at, w->options->group_count ? w->members[0] : 1, a->waves);
    a->height = w->options->group_count ? w->result[0].forward : s->gauge[0].height_m0;
    memcpy(a->first, s->gauge[group[0]].place, sizeof a->first);
    const double peak = s->peak*(double)s->count*s->step;       /* in frequencies, from 1 */
    a->peak = (size_t)fmin(fmax(peak - 0.5, 0), (double)s->bins - 1);
    return 0;
}

static void print_responses(const answers *a)
{
    const wave_run *w = a->run;
    printf(tr("response               unit            mean      least       most significant  "
              "gain at %.3g s, per m  phase\n"), 1/w->set.peak);
    for (const response *r = a->list; r < a->list + a->count; r++) {
        printf("%-22s ", r->label);
        print_columns(stdout, tr(r->unit), 8);
        printf("  %10.4g %10.4g %10.4g %11.4g  %21.4g %6.0f\n", r->record.mean, r->least, r->most,
               r->record.height_m0, r->gain[a->peak].gain, r->gain[a->peak].phase);
    }
    printf(tr("waves: %s, H_m0 %.4g m\n"), w->options->group_count
           ? tr("those that go on past the first --gauges")
           : w->set.gauge[0].name, a->height);
}

static void put(FILE *out, double value)
{
    if (isfinite(value)) fprintf(out, ",%.9g", value);
    else fputc(',', out);
}

static void write_significant(FILE *out, const void *what)
{
    const answers *a = what;
    fputs("response,unit,mean,least,most,significant,T_p [s],T_mean [s],gain [unit per m],phase [degrees],"
          "coherence\n", out);
    for (const response *r = a->list; r < a->list + a->count; r++) {
        fprintf(out, "%s,%s", r->label, r->unit);
        const double value[] = { r->record.mean, r->least, r->most, r->record.height_m0,
                                 r->record.peak_period, r->record.mean_period, r->gain[a->peak].gain,
                                 r->gain[a->peak].phase, r->gain[a->peak].coherence };
        for (size_t k = 0; k < sizeof value/sizeof *value; k++) put(out, value[k]);
        fputc('\n', out);
    }
}

static void write_gains(FILE *out, const void *what)
{
    const answers *a = what;
    const wave_set *s = &a->run->set;
    fputs("frequency [Hz]", out);
    for (const response *r = a->list; r < a->list + a->count; r++)
        fprintf(out, ",%s_density [(%s)2/Hz],%s_gain [%s per m],%s_phase [degrees],%s_coherence", r->label,
                r->unit, r->label, r->unit, r->label, r->label);
    for (size_t k = 0; k < s->bins; k++) {
        fprintf(out, "\n%.9g", (double)(k + 1)/((double)s->count*s->step));
        for (const response *r = a->list; r < a->list + a->count; r++) {
            put(out, r->record.density[k]);
            put(out, r->gain[k].gain);
            put(out, r->gain[k].phase);
            put(out, r->gain[k].coherence);
        }
    }
    fputc('\n', out);
}

/* A panel for each unit. */
static int draw_gains(const answers *a)
{
    picture p = { .x_label = tr("frequency, Hz"),
                  .begin = 0.4*a->run->set.peak, .end = 2*a->run->set.peak };
    char units[PANEL_LIMIT][24];
    snprintf(p.title, sizeof p.title, "%s", tr("Gains over the waves"));
    for (const response *r = a->list; r < a->list + a->count; r++) {
        int k = 0;
        while (k < p.panels && strcmp(units[k], r->unit) != 0) k++;
        if (k == PANEL_LIMIT) continue;
        if (k == p.panels) {
            snprintf(units[p.panels++], sizeof units[0], "%s", r->unit);
            snprintf(p.panel[k].y_label, sizeof p.panel[k].y_label, tr("gain, %s per m"), r->unit);
        }
        waves_add_curve(a->run, &p.panel[k], r->label, &r->gain[0].gain, sizeof *r->gain/sizeof(double));
    }
    const int code = waves_draw(a->run, &p, "wave_gains");
    picture_free(&p);
    return code;
}

static void free_answers(answers *a)
{
    for (int k = 0; k < a->count; k++) {
        free(a->list[k].record.eta);
        free(a->list[k].record.density);
        free(a->list[k].gain);
    }
    free(a->waves);
    free(a);
}

static int tell(answers *a)
{
    const wave_run *w = a->run;
    int code = take_waves(a);
    const double periods = w->set.peak*(double)w->set.count*w->set.step;
    if (!code && periods < FEW_PERIODS)
        fprintf(stderr, tr("tobiuo: note: --response: %.3g periods of the waves; gains and phases of fewer "
                "than %g are rough\n"), periods, FEW_PERIODS);
    for (int k = 0; k < w->options->response_count && !code; k++) {
        const char *name = w->options->responses[k];
        for (int n = 0; n < k && !code; n++)
            if (strcmp(w->options->responses[n], name) == 0)
                code = complain("--response %s: is asked for twice", name);
        if (!code) code = add_named(a, name);
    }
    for (int k = 0; k < a->count && !code; k++) {
        response *r = &a->list[k];
        r->gain = calloc(w->set.bins, sizeof *r->gain);
        if (!r->gain || wave_measure_record(&w->set, &r->record) != 0 ||
            wave_find_gains(&w->set, &r->record, a->waves, r->way, r->gain) != 0)
            code = complain("out of memory");
    }
    if (code) return code;
    print_responses(a);
    code = waves_write_table(w, "wave_responses.csv", write_significant, a);
    if (!code) code = waves_write_table(w, "wave_gains.csv", write_gains, a);
    return code ? code : draw_gains(a);
}

int tell_responses(const wave_run *w)
{
    answers *a = w->options->response_count ? calloc(1, sizeof *a) : NULL;
    if (!w->options->response_count) return 0;
    if (!a) return complain("out of memory");
    a->run = w;
    const int code = tell(a);
    free_answers(a);
    return code;
}
