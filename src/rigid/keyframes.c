/* Reading the rows, slopes at the rows, and the curve between two of them. Quaternions are w x y z. */
#define _POSIX_C_SOURCE 200809L
#include "rigid/keyframes.h"
#include "base/plain.h"
#include "core/rigid.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/types.h>

#define DEGREE (3.14159265358979323846/180)
/* Bound of all numbers and rates: cubes of such numbers are finite, so the curve is. */
#define LARGEST 1e30
enum { MOST_ROWS = 20000000, MOST_COLUMNS = 1024, FILE_LIMIT = 1 << 30 /* bytes */ };

typedef enum column {
    TIME, X, Y, Z, QW, QX, QY, QZ, AX, AY, AZ, ANGLE, ROLL, PITCH, YAW, SPEED, RATE, TORQUE,
    POSITION, FORCE, LEVEL, OTHER, COLUMNS       /* OTHER: of a record, not read */
} column;

static const char *const column_names[COLUMNS] = {"time", "x",  "y",  "z",     "qw",   "qx",    "qy", "qz",
                                                  "ax",   "ay", "az", "angle", "roll", "pitch", "yaw",
                                                  "speed", "flow_rate", "torque", "position", "force",
                                                  "level", "other"};

/* Of x, y and z in records of ships, as of the motions of these names. */
static const char *const ship_names[3] = {"surge", "sway", "heave"};

/* The units that a column's name may bring along, as in "x [mm]", and how many of the first one is; the first
   holds without a unit. */
typedef struct unit { const char *name; double scale; } unit;
static const unit length_units[] = {{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {0}};
static const unit time_units[] = {{"s", 1}, {"ms", 1e-3}, {"min", 60}, {"h", 3600}, {0}};
static const unit pull_units[] = {{"m/s2", 1}, {"m/s^2", 1}, {0}};
static const unit speed_units[] = {{"m/s", 1}, {"cm/s", 1e-2}, {"mm/s", 1e-3}, {0}};
static const unit rate_units[] = {{"m3/s", 1}, {"m2/s", 1}, {"l/s", 1e-3}, {0}};
static const unit plain_units[] = {{"1", 1}, {0}};
static const unit turn_units[] = {{"degrees/s", 1}, {"deg/s", 1}, {"rad/s", 1/DEGREE}, {0}};
static const unit angle_units[] = {{"degrees", 1}, {"deg", 1}, {"rad", 1/DEGREE}, {0}};
static const unit torque_units[] = {{"N m", 1}, {"Nm", 1}, {"kN m", 1e3}, {"kNm", 1e3}, {0}};
static const unit force_units[] = {{"N", 1}, {"kN", 1e3}, {0}};

typedef struct keyframe {
    double time, shift[3], turn[4];     /* s, m, unit quaternion                       */
    double velocity[3], spin[3];        /* m/s; rad/s about the body's own axes        */
} keyframe;

struct tobi_keyframes {
    keyframe *rows;
    int64_t count;
};

typedef struct reader {
    const char *what, *path;            /* "keyframes", "gravity", "flow", "motor" or "record" */
    const char *level;                  /* the name of its column, of recorded levels; else NULL */
    char others[160];                   /* columns of a record that are not read, for messages   */
    int slides;                         /* 1: the motor of a guide                     */
    int64_t line;
    const char *separators;             /* those that the header may have, then the one that it has */
    int meaning[MOST_COLUMNS];          /* column of each field of a line              */
    double scale[MOST_COLUMNS];         /* of its unit                                 */
    int fields;
    int given[COLUMNS];
} reader;

/* --- quaternions -------------------------------------------------------------------------- */

/* The turn by |v| radians about v. */
static void from_vector(const double v[3], double scale, double q[4])
{
    double angle = scale*sqrt(v[0]*v[0] + v[1]*v[1] + v[2]*v[2]);
    double s = fabs(angle) > 1e-9 ? scale*sin(0.5*angle)/angle : 0.5*scale;
    q[0] = cos(0.5*angle);
    for (int k = 0; k < 3; k++) q[k + 1] = s*v[k];
}

/* The inverse, the short way. */
static void to_vector(const double q[4], double v[3])
{
    double s = sqrt(q[1]*q[1] + q[2]*q[2] + q[3]*q[3]), sign = q[0] < 0 ? -1 : 1;
    double scale = s > 1e-12 ? sign*2*atan2(s, fabs(q[0]))/s : 2*sign;
    for (int k = 0; k < 3; k++) v[k] = scale*q[k + 1];
}

/* What turns a into b, seen from a. */
static void between(const double a[4], const double b[4], double v[3])
{
    double q[4];
    tobi_quaternion_product((double[4]){a[0], -a[1], -a[2], -a[3]}, b, q);
    to_vector(q, v);
}

/* --- reading ------------------------------------------------------------------------------ */

static tobi_status fail_here(const reader *r, tobi_error *err, const char *what, const char *word)
{
    return tobi_fail(err, TOBI_INVALID, "%s %s:%lld: %s%s", r->what, r->path, (long long)r->line, what, word);
}

/* The next field of a line, without blanks and quotes around it; NULL at the end. */
static char *next_field(const reader *r, char **rest)
{
    char *field = *rest;
    if (!field) return NULL;
    char *end = strpbrk(field, r->separators);
    *rest = end ? end + 1 : NULL;
    if (end) *end = 0;
    field += strspn(field, " \"\r\n");
    for (size_t n = strlen(field); n && strchr(" \"\r\n", field[n - 1]);) field[--n] = 0;
    return field;
}

static int is_gravity(const reader *r) { return strcmp(r->what, "gravity") == 0; }
static int is_flow(const reader *r) { return strcmp(r->what, "flow") == 0; }
static int is_motor(const reader *r) { return strcmp(r->what, "motor") == 0; }

/* Whether tables of this kind may have the column. */
static int is_allowed(const reader *r, int c)
{
    if (is_motor(r) && r->slides) return c == TIME || c == POSITION || c == SPEED || c == FORCE;
    if (is_motor(r)) return c == TIME || c == ANGLE || c == SPEED || c == TORQUE;
    return c < SPEED || (is_flow(r) && c < TORQUE);
}

static tobi_status check_flow_columns(const reader *r, tobi_error *err)
{
    int others = 0;
    for (int c = X; c < SPEED; c++) others += r->given[c];
    if (others || r->given[SPEED] + r->given[RATE] != 1)
        return fail_here(r, err, tr("a flow has the columns time (s) and one of speed (m/s) and flow_rate "
                         "(m3/s)"), "");
    return TOBI_OK;
}

static const char *motor_columns(const reader *r)
{
    return r->slides ? tr("position (m), speed (m/s) and force (N), as it is of a guide")
                     : tr("angle (degrees), speed (degrees/s) and torque (N m)");
}

static tobi_status check_level_column(const reader *r, tobi_error *err)
{
    if (r->given[LEVEL]) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "%s %s:%lld: there is no column of levels named %s; beside the time "
                     "there are %s", r->what, r->path, (long long)r->line, tobi_excerpt(r->level).text,
                     r->others[0] ? r->others : tr("none"));
}

static void remember_other(reader *r, const char *field)
{
    const size_t used = strlen(r->others);
    snprintf(r->others + used, sizeof r->others - used, "%s%s", used ? ", " : "", tobi_excerpt(field).text);
}

static tobi_status check_columns(const reader *r, tobi_error *err)
{
    const int *g = r->given;
    int quaternion = g[QW] + g[QX] + g[QY] + g[QZ], axis = g[AX] + g[AY] + g[AZ] + g[ANGLE];
    int angles = g[ROLL] + g[PITCH] + g[YAW];
    if (!g[TIME]) return fail_here(r, err, tr("there is no column \"time\""), "");
    if (r->level) return check_level_column(r, err);
    if (is_flow(r)) return check_flow_columns(r, err);
    if (is_motor(r) && g[ANGLE] + g[POSITION] + g[SPEED] + g[TORQUE] + g[FORCE] == 1) return TOBI_OK;
    if (is_motor(r))
        return fail_here(r, err, tr("a motor has the columns time (s) and one of "), motor_columns(r));
    if (is_gravity(r) && quaternion + axis + angles)
        return fail_here(r, err, tr("gravity does not turn: allowed are time (s), x, y and z (m/s2)"), "");
    if ((quaternion && quaternion < 4) || (axis && axis < 4))
        return fail_here(r, err, tr("a turn needs all of "), quaternion ? "qw, qx, qy, qz"
                         : "ax, ay, az, angle");
    if (!!quaternion + !!axis + !!angles > 1)
        return fail_here(r, err, tr("a turn is given twice: allowed is one of qw qx qy qz, ax ay az angle "
                         "and roll pitch yaw"), "");
    if (g[X] + g[Y] + g[Z] + quaternion + axis + angles == 0)
        return fail_here(r, err, tr("no column says where the body is: x, y, z or a turn is needed"), "");
    return TOBI_OK;
}

static const unit *column_units(const reader *r, column c)
{
    if (c == TIME) return time_units;
    if (c == FORCE) return force_units;
    if (c >= SPEED && c < POSITION)
        return c == TORQUE ? torque_units : c == RATE ? rate_units : is_motor(r) && !r->slides ? turn_units
                                                                                               : speed_units;
    if (c <= Z || c == POSITION || c == LEVEL) return is_gravity(r) ? pull_units : length_units;
    return c < ANGLE ? plain_units : angle_units;
}

/* "x [m]" or "x (m)" becomes "x"; returns "m]" or "m)", or NULL if the name brings no unit. */
static char *split_unit(char *field, char *closing)
{
    char *unit = strpbrk(field, "[("), *end = unit;
    if (!unit) return NULL;
    *closing = *unit == '[' ? ']' : ')';
    while (end > field && end[-1] == ' ') end--;
    *end = 0;
    return unit + 1;
}

/* A unit that is not known would be misread, so it is refused. */
static tobi_status read_unit(const reader *r, char *text, char closing, column c, double *scale,
                             tobi_error *err)
{
    const unit *units = column_units(r, c);
    size_t n = strlen(text);
    if (n < 2 || text[n - 1] != closing)
        return fail_here(r, err, closing == ']' ? tr("no ] after the unit [") : tr("no ) after the unit ("),
                         tobi_excerpt(text).text);
    text[n - 1] = 0;
    char all[80] = "";
    for (int k = 0; units[k].name; k++) {
        *scale = units[k].scale;
        if (strcmp(text, units[k].name) == 0) return TOBI_OK;
        snprintf(all + strlen(all), sizeof all - strlen(all), "%s[%s]", k ? ", " : "", units[k].name);
    }
    return tobi_fail(err, TOBI_INVALID, "%s %s:%lld: column %s is in [%s]; allowed is %s or no unit, which "
                     "is %s", r->what, r->path, (long long)r->line, column_names[c], tobi_excerpt(text).text,
                     all, units[0].name);
}

/* The column that the name of a field means. */
static column find_column(const reader *r, const char *field)
{
    if (strcasecmp(field, "t") == 0) return TIME;
    if (r->level)
        return strcasecmp(field, r->level) == 0 ? LEVEL : strcasecmp(field, "time") == 0 ? TIME : OTHER;
    for (int c = 0; c < LEVEL; c++)
        if (is_allowed(r, c) && strcasecmp(field, column_names[c]) == 0) return c;
    for (int a = 0; a < 3 && is_allowed(r, X) && !is_gravity(r); a++)
        if (strcasecmp(field, ship_names[a]) == 0) return X + a;
    return COLUMNS;
}

static tobi_status fail_column(const reader *r, const char *field, tobi_error *err)
{
    return tobi_fail(err, TOBI_INVALID, "%s %s:%lld: there is no column \"%s\"; allowed are "
                     "time (s)%s%s", r->what, r->path, (long long)r->line, tobi_excerpt(field).text,
                     is_flow(r) ? tr(", speed (m/s) and flow_rate (m3/s)")
                     : is_motor(r) ? tr(" and one of ")
                     : is_gravity(r) ? ", x, y, z (m/s2)"
                     : tr(", x, y, z (m) and qw, qx, qy, qz or ax, ay, az, angle or roll, pitch, yaw "
                       "(degrees)"), is_motor(r) ? motor_columns(r) : "");
}

static tobi_status read_header(reader *r, char *line, tobi_error *err)
{
    char *rest = line;
    const char *first = strpbrk(line, r->separators = ",;\t");
    if (first) r->separators = *first == ',' ? "," : *first == ';' ? ";" : "\t";
    for (char *field; (field = next_field(r, &rest)) != NULL;) {
        char closing = 0, *text = split_unit(field, &closing);
        double scale = 1;
        if (!*field) return fail_here(r, err, tr("an empty column name (a comma too many?)"), "");
        const column found = find_column(r, field);
        if (found == COLUMNS) return fail_column(r, field, err);
        if (r->fields == MOST_COLUMNS)
            return fail_here(r, err, tr("more columns than are allowed, 1024"), "");
        if (text && found != OTHER) TOBI_TRY(read_unit(r, text, closing, found, &scale, err));
        if (found == OTHER) remember_other(r, field);
        else if (r->given[found]++)
            return fail_here(r, err, tr("a column comes twice: "), column_names[found]);
        r->scale[r->fields] = scale;
        r->meaning[r->fields++] = found;
    }
    return check_columns(r, err);
}

static tobi_status read_numbers(const reader *r, char *line, double value[COLUMNS], tobi_error *err)
{
    char *rest = line, *field;
    int n = 0;
    for (; (field = next_field(r, &rest)) != NULL; n++) {
        char *end;
        if (n == r->fields) break;
        if (r->meaning[n] == OTHER) continue;
        double x = strtod(field, &end);
        if (end == field || *end || !isfinite(x))
            return tobi_fail(err, TOBI_INVALID, "%s %s:%lld: \"%s\" in column %s is no finite "
                             "number%s", r->what, r->path, (long long)r->line, tobi_excerpt(field).text,
                             column_names[r->meaning[n]],
                             end > field && *end == ',' ? tr("; decimals follow a point") : "");
        if (fabs(x) > LARGEST)
            return tobi_fail(err, TOBI_INVALID, "%s %s:%lld: %.4g in column %s is too large; allowed "
                             "is up to %g", r->what, r->path, (long long)r->line, x,
                             column_names[r->meaning[n]], LARGEST);
        value[r->meaning[n]] = r->scale[n]*x;
    }
    if (n == r->fields && !field) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "%s %s:%lld: the row has %s columns than the header, %d",
                     r->what, r->path, (long long)r->line, field ? tr("more") : tr("fewer"), r->fields);
}

static tobi_status read_turn(const reader *r, const double v[COLUMNS], double q[4], tobi_error *err)
{
    memcpy(q, (double[4]){1, 0, 0, 0}, 4*sizeof *q);
    if (r->given[QW]) {
        double length = sqrt(v[QW]*v[QW] + v[QX]*v[QX] + v[QY]*v[QY] + v[QZ]*v[QZ]);
        if (!(length > 1e-100) || !isfinite(length))
            return fail_here(r, err, tr("the quaternion has no length"), "");
        for (int k = 0; k < 4; k++) q[k] = v[QW + k]/length;
    } else if (r->given[AX]) {
        double axis[3] = {v[AX], v[AY], v[AZ]};
        double length = sqrt(axis[0]*axis[0] + axis[1]*axis[1] + axis[2]*axis[2]);
        if (!isfinite(length) || (!(length > 1e-100) && v[ANGLE] != 0))
            return fail_here(r, err, tr("the axis ax, ay, az has no length"), "");
        from_vector(axis, length > 1e-100 ? fmod(v[ANGLE], 360)*DEGREE/length : 0, q);
    } else {
        for (int a = 0; a < 3; a++) {      /* roll first, so it stands rightmost */
            double one[4], axis[3] = {a == 0, a == 1, a == 2};
            from_vector(axis, fmod(v[ROLL + a], 360)*DEGREE, one);
            tobi_quaternion_product(one, q, q);
        }
    }
    return TOBI_OK;
}

/* Mean rates of the piece from row i to the next. */
static void mean_rates(const keyframe *k, double velocity[3], double spin[3])
{
    double h = k[1].time - k[0].time;
    between(k[0].turn, k[1].turn, spin);
    for (int a = 0; a < 3; a++) {
        velocity[a] = (k[1].shift[a] - k[0].shift[a])/h;
        spin[a] /= h;
    }
}

/* Rows so close in time, or so far apart in space, that the rate between them is no useful number. */
static tobi_status check_rates(const reader *r, const keyframe *k, tobi_error *err)
{
    double velocity[3], spin[3];
    mean_rates(k, velocity, spin);
    for (int a = 0; a < 3; a++) {
        if (fabs(velocity[a]) <= LARGEST && fabs(spin[a]) <= LARGEST) continue;
        int turns = fabs(velocity[a]) <= LARGEST;
        return tobi_fail(err, TOBI_INVALID, "%s %s:%lld: from %.10g s of the row before to %.10g s "
                         "the body %s too fast; allowed is up to %g %s", r->what, r->path, (long long)r->line,
                         k[0].time, k[1].time, turns ? tr("turns") : tr("moves"), LARGEST, turns ? "rad/s"
                         : "m/s");
    }
    return TOBI_OK;
}

static tobi_status add_row(tobi_keyframes *f, int64_t *room, const reader *r, char *line, tobi_error *err)
{
    double value[COLUMNS] = {0};
    keyframe row = {0};
    TOBI_TRY(read_numbers(r, line, value, err));
    row.time = value[TIME];
    memcpy(row.shift, value + X, sizeof row.shift);
    if (r->level) row.shift[0] = value[LEVEL];
    if (is_flow(r)) row.shift[0] = value[SPEED] + value[RATE];
    if (is_motor(r))
        row.shift[0] = value[ANGLE] + value[POSITION] + value[SPEED] + value[TORQUE] + value[FORCE];
    if (is_flow(r) && row.shift[0] < 0)
        return fail_here(r, err, tr("the flow is below 0: an inlet lets nothing out"), "");
    TOBI_TRY(read_turn(r, value, row.turn, err));
    if (f->count && !(row.time > f->rows[f->count - 1].time))
        return tobi_fail(err, TOBI_INVALID, "%s %s:%lld: time %.10g s does not come after %.10g s of "
                         "the row before", r->what, r->path, (long long)r->line, row.time,
                         f->rows[f->count - 1].time);
    if (f->count == MOST_ROWS) return fail_here(r, err, tr("more rows than are allowed, 20 million"), "");
    if (f->count == *room) {
        keyframe *more = realloc(f->rows, (size_t)(2**room + 64)*sizeof *more);
        if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "%s %s: out of memory", r->what, r->path);
        f->rows = more;
        *room = 2**room + 64;
    }
    f->rows[f->count++] = row;
    return f->count > 1 ? check_rates(r, f->rows + f->count - 2, err) : TOBI_OK;
}

static tobi_status read_rows(FILE *file, reader *r, tobi_keyframes *f, tobi_error *err)
{
    char *line = NULL;
    size_t size = 0;
    int64_t room = 0;
    tobi_status status = TOBI_OK;
    for (ssize_t n; status == TOBI_OK && (n = getline(&line, &size, file)) > 0;) {
        char *text = line;
        r->line++;
        if (r->line == 1 && n >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) text += 3;   /* byte order mark */
        text += strspn(text, " \r\n");
        if (strlen(line) != (size_t)n)
            status = fail_here(r, err, tr("holds a zero byte: no plain text, or UTF-16; save it as UTF-8"),
                               "");
        else if (!*text || *text == '#') continue;
        else if (!r->fields) status = read_header(r, text, err);
        else status = add_row(f, &room, r, text, err);
    }
    free(line);
    if (status == TOBI_OK && ferror(file))
        status = tobi_fail(err, TOBI_IO, "%s %s: cannot be read to its end: %s", r->what,
                           r->path, tobi_reason(errno));
    if (status == TOBI_OK && !f->count)
        status = tobi_fail(err, TOBI_INVALID, "%s %s: no rows; a header with the columns' names and "
                           "a row per time are needed", r->what, r->path);
    return status;
}

/* --- slopes and curves -------------------------------------------------------------------- */

static int is_zero(const double v[3]) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

/* Slope of the parabola through three rows at the middle one, from the mean rates beside it; 0 next to a
   piece that stands still. */
static void blend_rates(const double before[3], const double after[3], double h0, double h1, double out[3])
{
    int still = is_zero(before) || is_zero(after);
    for (int a = 0; a < 3; a++) out[a] = still ? 0 : (h1*before[a] + h0*after[a])/(h0 + h1);
}

/* At the end of the rows: the same parabola, from its slope one row further in. */
static void end_rates(const double mean[3], const double inner[3], double out[3])
{
    for (int a = 0; a < 3; a++) out[a] = is_zero(mean) ? 0 : 2*mean[a] - inner[a];
}

static void find_slopes(tobi_keyframes *f)
{
    keyframe *k = f->rows;
    int64_t n = f->count;
    double v[2][3], w[2][3];                   /* of the pieces before and after a row */
    if (n < 2) return;
    mean_rates(k, v[0], w[0]);
    memcpy(k[0].velocity, v[0], sizeof v[0]);
    memcpy(k[0].spin, w[0], sizeof w[0]);
    for (int64_t i = 1; i + 1 < n; i++) {
        double h0 = k[i].time - k[i - 1].time, h1 = k[i + 1].time - k[i].time;
        mean_rates(k + i, v[1], w[1]);
        blend_rates(v[0], v[1], h0, h1, k[i].velocity);
        blend_rates(w[0], w[1], h0, h1, k[i].spin);
        if (i == 1) {
            end_rates(v[0], k[1].velocity, k[0].velocity);
            end_rates(w[0], k[1].spin, k[0].spin);
        }
        memcpy(v[0], v[1], sizeof v[0]);
        memcpy(w[0], w[1], sizeof w[0]);
    }
    memcpy(k[n - 1].velocity, v[0], sizeof v[0]);
    memcpy(k[n - 1].spin, w[0], sizeof w[0]);
    if (n == 2) return;
    end_rates(v[0], k[n - 2].velocity, k[n - 1].velocity);
    end_rates(w[0], k[n - 2].spin, k[n - 1].spin);
}

/* q(s) = q0 exp(b1 w1) exp(b2 w2) exp(b3 w3) with the cumulative Bernstein basis b. */
static void curve_turn(const keyframe *k, double h, double s, double q[4])
{
    double first[4], last[4], inner[4], middle[3];
    double b[3] = {1 - (1 - s)*(1 - s)*(1 - s), s*s*(3 - 2*s), s*s*s};
    from_vector(k[0].spin, -h/3, first);
    from_vector(k[1].spin, -h/3, last);
    tobi_quaternion_product((double[4]){k[0].turn[0], -k[0].turn[1], -k[0].turn[2], -k[0].turn[3]},
                            k[1].turn, inner);
    if (inner[0] < 0)
        for (int a = 0; a < 4; a++) inner[a] = -inner[a];
    tobi_quaternion_product(first, inner, inner);
    tobi_quaternion_product(inner, last, inner);
    to_vector(inner, middle);
    memcpy(q, k[0].turn, sizeof k[0].turn);
    from_vector(k[0].spin, b[0]*h/3, first);
    tobi_quaternion_product(q, first, q);
    from_vector(middle, b[1], inner);
    tobi_quaternion_product(q, inner, q);
    from_vector(k[1].spin, b[2]*h/3, last);
    tobi_quaternion_product(q, last, q);
}

static void curve_shift(const keyframe *k, double h, double s, double shift[3])
{
    double rise = s*s*(3 - 2*s), early = s*(1 - s)*(1 - s)*h, late = -s*s*(1 - s)*h;
    for (int a = 0; a < 3; a++)
        shift[a] = k[0].shift[a] + rise*(k[1].shift[a] - k[0].shift[a]) + early*k[0].velocity[a] +
                   late*k[1].velocity[a];
}

static void fill_matrix(const double quaternion[4], double m[3][3])
{
    double length = sqrt(quaternion[0]*quaternion[0] + quaternion[1]*quaternion[1] +
                         quaternion[2]*quaternion[2] + quaternion[3]*quaternion[3]);
    double unit[4];
    for (int k = 0; k < 4; k++) unit[k] = quaternion[k]/length;
    tobi_quaternion_matrix(unit, m);
}

static tobi_status load(reader *r, tobi_keyframes **out, tobi_error *err)
{
    *out = NULL;
    FILE *file;
    TOBI_TRY(tobi_plain_open(r->path, r->what, FILE_LIMIT, &file, NULL, err));
    tobi_keyframes *f = calloc(1, sizeof *f);
    tobi_status status = f ? read_rows(file, r, f, err)
                           : tobi_fail(err, TOBI_NO_MEMORY, "%s %s: out of memory", r->what, r->path);
    fclose(file);
    if (status != TOBI_OK) {
        tobi_keyframes_free(f);
        return status;
    }
    find_slopes(f);
    *out = f;
    return TOBI_OK;
}

tobi_status tobi_keyframes_load(const char *path, tobi_keyframes **out, tobi_error *err)
{
    reader r = {.what = tr("keyframes"), .path = path};
    return load(&r, out, err);
}

tobi_status tobi_keyframes_load_gravity(const char *path, int given[3], tobi_keyframes **out, tobi_error *err)
{
    reader r = {.what = tr("gravity"), .path = path};
    TOBI_TRY(load(&r, out, err));
    for (int a = 0; a < 3; a++) given[a] = r.given[X + a];
    return TOBI_OK;
}

tobi_status tobi_keyframes_load_flow(const char *path, int *is_rate, tobi_keyframes **out, tobi_error *err)
{
    reader r = {.what = tr("flow"), .path = path};
    TOBI_TRY(load(&r, out, err));
    *is_rate = r.given[RATE];
    return TOBI_OK;
}

tobi_status tobi_keyframes_load_motor(const char *path, int slides, int *column, tobi_keyframes **out,
                                      tobi_error *err)
{
    reader r = {.what = tr("motor"), .path = path, .slides = slides};
    TOBI_TRY(load(&r, out, err));
    *column = r.given[SPEED] ? 0 : r.given[ANGLE] || r.given[POSITION] ? 1 : 2;
    return TOBI_OK;
}

tobi_status tobi_keyframes_load_levels(const char *path, const char *name, tobi_keyframes **out,
                                       tobi_error *err)
{
    reader r = {.what = tr("record"), .path = path, .level = name && *name ? name : "level"};
    return load(&r, out, err);
}

int64_t tobi_keyframes_count(const tobi_keyframes *f) { return f->count; }

double tobi_keyframes_row(const tobi_keyframes *f, int64_t row, double shift[3])
{
    memcpy(shift, f->rows[row].shift, sizeof f->rows[row].shift);
    return f->rows[row].time;
}

void tobi_keyframes_free(tobi_keyframes *f)
{
    if (!f) return;
    free(f->rows);
    free(f);
}

void tobi_keyframes_pose(const tobi_keyframes *f, double t, double shift[3], double turn[3][3])
{
    int64_t low = 0, high = f->count - 1;
    double q[4];
    if (!(t > f->rows[0].time)) high = 0;
    else if (t >= f->rows[high].time) low = high;
    while (high - low > 1) {
        int64_t middle = (low + high)/2;
        if (f->rows[middle].time <= t) low = middle;
        else high = middle;
    }
    const keyframe *k = &f->rows[low];
    if (low == high) {
        memcpy(shift, k->shift, sizeof k->shift);
        fill_matrix(k->turn, turn);
        return;
    }
    double h = k[1].time - k[0].time, s = (t - k[0].time)/h;
    curve_shift(k, h, s, shift);
    curve_turn(k, h, s, q);
    fill_matrix(q, turn);
}
