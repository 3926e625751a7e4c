/* tobiuo sample --with BODY: places that move and turn with a body, by its rows in bodies.csv. Drawback: of a
   body that deforms the frame is that of the table, its centre of mass and its turn as a whole. */
#define _GNU_SOURCE
#include "sample.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static double cell_of(const table *t, size_t row, const char *name, const char *end)
{
    char column[48];
    snprintf(column, sizeof column, "%s_%s", name, end);
    const int k = table_column(t, column);
    return k < 0 ? NAN : table_number(t, row, k);
}

/* The axes of a unit quaternion w, x, y, z. */
static void find_axes(const double q[4], double r[3][3])
{
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double m[3][3] = { { 1 - 2*(y*y + z*z), 2*(x*y - w*z), 2*(x*z + w*y) },
                             { 2*(x*y + w*z), 1 - 2*(x*x + z*z), 2*(y*z - w*x) },
                             { 2*(x*z - w*y), 2*(y*z + w*x), 1 - 2*(x*x + y*y) } };
    memcpy(r, m, sizeof m);
}

static int read_row(const sample_run *s, size_t row, sample_frame *f)
{
    static const char *const axes[] = { "x", "y", "z" }, *const parts[] = { "w", "x", "y", "z" };
    double q[4], length = 0, sum = 0;
    for (int k = 0; k < 4; k++) {
        q[k] = cell_of(&s->bodies, row, "orientation", parts[k]);
        length += q[k]*q[k];
    }
    for (int k = 0; k < 4; k++) q[k] /= sqrt(length);
    find_axes(q, f->axes);
    for (int a = 0; a < 3; a++) {
        f->place[a] = cell_of(&s->bodies, row, "position", axes[a]);
        f->velocity[a] = cell_of(&s->bodies, row, "velocity", axes[a]);
        f->spin[a] = cell_of(&s->bodies, row, "angular_velocity", axes[a]);
        sum += f->place[a] + f->velocity[a] + f->spin[a] + q[a + 1];
    }
    return isfinite(sum) ? 0 : complain("%s: the row of '%s' at %s s has no place, turn or velocity",
                                        s->bodies.path, s->options->body,
                                        s->bodies.cells[row*(size_t)s->bodies.columns]);
}

static int is_of(const sample_run *s, size_t row, int column)
{
    return strcmp(s->bodies.cells[row*(size_t)s->bodies.columns + (size_t)column], s->options->body) == 0;
}

/* The row of the body at an output; without one the frame at the start is that of the first row. */
static int find_frame(const sample_run *s, double time, sample_frame *f)
{
    const int name = table_column(&s->bodies, "name"), when = table_column(&s->bodies, "time");
    for (size_t row = 0; row < s->bodies.rows; row++)
        if (is_of(s, row, name) && fabs(table_number(&s->bodies, row, when) - time) <= 1e-9*(1 + fabs(time)))
            return read_row(s, row, f);
    return complain("%s: has no row of '%s' at the output of %g s", s->bodies.path, s->options->body, time);
}

static int complain_body(const sample_run *s)
{
    const char *names[64];
    size_t count = 0;
    char list[400] = "";
    for (int k = 0; k < s->looks.body_count && count < 64; k++) {
        if (s->looks.bodies[k].is_line) continue;
        names[count++] = s->looks.bodies[k].body;
        const size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", used ? ", " : "", s->looks.bodies[k].body);
    }
    if (count == 0) return complain("--with %s: %s has no bodies", s->options->body, s->options->dir);
    const char *near = tobi_suggest(s->options->body, names, count);
    if (near) return complain("--with: there is no body '%s'; did you mean %s?", s->options->body, near);
    return complain("--with: there is no body '%s'; there are %s", s->options->body, list);
}

int sample_find_body(sample_run *s)
{
    int known = 0;
    if (!s->options->body) return 0;
    for (int k = 0; k < s->looks.body_count; k++)
        known |= !s->looks.bodies[k].is_line && strcmp(s->looks.bodies[k].body, s->options->body) == 0;
    if (!known) return complain_body(s);
    char *path = join_path(s->options->dir, "bodies.csv");
    const int code = table_read(&s->bodies, path) == 0 ? 0 : EXIT_ERROR;
    free(path);
    if (code) return code;
    table_strip_units(&s->bodies);
    if (table_column(&s->bodies, "name") < 0 || table_column(&s->bodies, "time") < 0)
        return complain("%s: has no columns time and name", s->bodies.path);
    return find_frame(s, tobi_results_time(s->results, 0), &s->start);
}

/* Turned from the start to now, or back: axes now, times those of the start transposed. */
static void turn(const sample_run *s, int back, const double from[3], double to[3])
{
    const sample_frame *a = back ? &s->now : &s->start, *b = back ? &s->start : &s->now;
    double own[3] = { 0 };
    for (int k = 0; k < 3; k++)
        for (int n = 0; n < 3; n++) own[k] += a->axes[n][k]*from[n];
    for (int k = 0; k < 3; k++) {
        to[k] = 0;
        for (int n = 0; n < 3; n++) to[k] += b->axes[k][n]*own[n];
    }
}

int sample_move_places(sample_run *s, double time)
{
    if (!s->options->body) return 0;
    const int code = find_frame(s, time, &s->now);
    for (int64_t i = 0; i < s->places.count && !code; i++) {
        double arm[3];
        for (int a = 0; a < 3; a++) arm[a] = s->places.x[i][a] - s->start.place[a];
        turn(s, 0, arm, s->moved[i]);
        for (int a = 0; a < 3; a++) s->moved[i][a] += s->now.place[a];
    }
    return code;
}

/* The velocity of the body at a place. */
static void find_velocity(const sample_frame *f, const double x[3], double u[3])
{
    double arm[3];
    for (int a = 0; a < 3; a++) arm[a] = x[a] - f->place[a];
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1)%3, c = (a + 2)%3;
        u[a] = f->velocity[a] + f->spin[b]*arm[c] - f->spin[c]*arm[b];
    }
}

/* The columns of a matrix, back into the axes of the start. */
static void turn_columns(const sample_run *s, double m[3][3])
{
    for (int c = 0; c < 3; c++) {
        const double from[3] = { m[0][c], m[1][c], m[2][c] };
        double to[3];
        turn(s, 1, from, to);
        for (int a = 0; a < 3; a++) m[a][c] = to[a];
    }
}

/* Stresses are turned on both sides, xx, yy, zz, xy, yz, zx. */
static void turn_stress(const sample_run *s, double *at)
{
    const double x = at[3], y = at[4], z = at[5];
    double m[3][3] = { { at[0], x, z }, { x, at[1], y }, { z, y, at[2] } }, half[3][3];
    turn_columns(s, m);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) half[a][b] = m[b][a];
    turn_columns(s, half);
    const double turned[6] = { half[0][0], half[1][1], half[2][2], half[0][1], half[1][2], half[2][0] };
    memcpy(at, turned, sizeof turned);
}

/* Deformation gradients on the side of the present alone: their other side is the shape at rest. */
static void turn_gradient(const sample_run *s, double *at)
{
    double m[3][3];
    memcpy(m, at, sizeof m);
    turn_columns(s, m);
    memcpy(at, m, sizeof m);
}

static void turn_vector(const sample_run *s, int64_t place, int is_velocity, double *at)
{
    double u[3] = { 0, 0, 0 };
    if (is_velocity) find_velocity(&s->now, s->moved[place], u);
    for (int a = 0; a < 3; a++) u[a] = at[a] - u[a];
    turn(s, 1, u, at);
}

void sample_turn_values(sample_run *s)
{
    for (int f = 0; f < s->field_count && s->options->body; f++) {
        const int n = s->field[f].all, is_velocity = strcmp(s->field[f].source, "velocity") == 0;
        for (int64_t i = 0; i < s->places.count && n > 1; i++) {
            double *at = s->field[f].read + n*i;
            if (n == 3) turn_vector(s, i, is_velocity, at);
            if (n == 6) turn_stress(s, at);
            if (n == 9) turn_gradient(s, at);
        }
    }
}
