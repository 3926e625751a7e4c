/* tobiuo sample: its files in DIR/sample. Tables appear whole or not at all. Drawback: a grid holds doubles,
   with twice the bytes that ParaView would need. */
#define _GNU_SOURCE
#include "sample.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const char *sample_component(int components, int k)
{
    static const char *const axes[] = { "x", "y", "z" };
    static const char *const pairs[] = { "xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz" };
    static const char *const halves[] = { "xx", "yy", "zz", "xy", "yz", "zx" };
    static const char *const numbers[] = { "0", "1", "2", "3", "4", "5", "6", "7", "8" };
    return components == 1 ? "" : components == 3 ? axes[k] : components == 6 ? halves[k]
         : components == 9 ? pairs[k] : numbers[k];
}

static int open_table(const sample_run *s, const char *end, sample_table *t)
{
    *t = (sample_table){ 0 };
    char *folder = join_path(s->options->dir, "sample");
    if (asprintf(&t->path, "%s/%s%s.csv", folder, s->name, end) < 0 ||
        asprintf(&t->part, "%s.part", t->path) < 0)
        exit(complain("out of memory"));
    free(folder);
    unlink(t->part);
    t->file = fopen(t->part, "wx");
    return t->file ? 0 : complain("cannot write %s: %s", t->path, tr(strerror(errno)));
}

int sample_end_table(sample_table *t, int code)
{
    const int bad = t->file && ferror(t->file);
    if (t->file && (fclose(t->file) != 0 || bad) && !code)
        code = complain("cannot write %s: %s", t->path, tr(strerror(errno)));
    if (t->file && !code && rename(t->part, t->path) != 0)
        code = complain("cannot write %s: %s", t->path, tr(strerror(errno)));
    if (code && t->part) unlink(t->part);
    free(t->path);
    free(t->part);
    *t = (sample_table){ 0 };
    return code;
}

static void write_head(const sample_run *s, FILE *file)
{
    if (s->options->line_count > 1) fputs("line,", file);
    fputs(s->places.way ? "index,way [m],x [m],y [m],z [m]" : "index,x [m],y [m],z [m]", file);
}

static void write_place(const sample_run *s, int64_t i, FILE *file)
{
    const sample_places *p = &s->places;
    if (s->options->line_count > 1) fprintf(file, "%d,", p->line[i] + 1);
    fprintf(file, "%lld", (long long)(p->line ? i%s->options->count : i));
    if (p->way) fprintf(file, ",%.9g", p->way[i]);
    fprintf(file, ",%.9g,%.9g,%.9g", p->x[i][0], p->x[i][1], p->x[i][2]);
}

/* Columns of a field, as ",mean_velocity_x [m/s]". */
static void write_columns(const sample_field *f, const char *before, FILE *file)
{
    for (int k = 0; k < f->components; k++) {
        const char *part = sample_component(f->components, k);
        fprintf(file, ",%s%s%s%s", before, f->name, *part ? "_" : "", part);
        if (*f->unit) fprintf(file, " [%s]", f->unit);
    }
}

static void write_numbers(const double *values, int count, FILE *file)
{
    for (int k = 0; k < count; k++)
        if (isfinite(values[k])) fprintf(file, ",%.9g", values[k]);
        else fputc(',', file);
}

int sample_begin_table(const sample_run *s, sample_table *t)
{
    const int code = open_table(s, "", t);
    if (code) return code;
    fputs("time [s],", t->file);
    write_head(s, t->file);
    fputs(",wet", t->file);
    for (int f = 0; f < s->field_count; f++) write_columns(&s->field[f], "", t->file);
    fputc('\n', t->file);
    return 0;
}

int sample_write_rows(const sample_run *s, double time, sample_table *t)
{
    for (int64_t i = 0; i < s->places.count; i++) {
        fprintf(t->file, "%.17g,", time);
        write_place(s, i, t->file);
        fprintf(t->file, ",%d", s->wet[i]);
        for (int f = 0; f < s->field_count; f++) {
            const sample_field *field = &s->field[f];
            write_numbers(field->at + i*field->components, field->components, t->file);
        }
        fputc('\n', t->file);
    }
    return ferror(t->file) ? complain("cannot write %s: %s", t->path, tr(strerror(errno))) : 0;
}

static int write_arrays(const sample_run *s, const char *end, const tobi_sample_array *arrays, int count,
                        const uint8_t *wet)
{
    tobi_error err = { 0 };
    tobi_sample_grid g = { .arrays = arrays, .array_count = count, .wet = wet };
    char *path = NULL;
    for (int a = 0; a < 3; a++)
        g.origin[a] = s->places.origin[a], g.cell[a] = s->places.cell[a], g.count[a] = s->places.n[a];
    if (asprintf(&path, "%s/sample/%s_%s.vti", s->options->dir, s->name, end) < 0)
        exit(complain("out of memory"));
    const int code = tobi_sample_write(path, &g, &err) == TOBI_OK ? 0 : complain("%s", err.text);
    free(path);
    return code;
}

int sample_write_grid(const sample_run *s, int64_t output)
{
    tobi_sample_array arrays[TOBI_SAMPLE_FIELD_LIMIT];
    char end[32];
    for (int f = 0; f < s->field_count; f++)
        arrays[f] = (tobi_sample_array){ s->field[f].name, s->field[f].components, s->field[f].at };
    snprintf(end, sizeof end, "%06lld", (long long)output);
    return write_arrays(s, end, arrays, s->field_count, s->wet);
}

/* --- means --- */

/* Of a field, at all places. */
typedef struct means { double *average, *rms, *products; char names[3][64]; } means;

static int read_means(const sample_run *s, int f, double *share, means *m)
{
    const sample_field *field = &s->field[f];
    const size_t places = (size_t)s->places.count, n = (size_t)field->components;
    const int is_velocity = strcmp(field->name, "velocity") == 0 && n == 3;
    tobi_error err = { 0 };
    m->average = malloc(places*n*sizeof(double) + 1);
    m->rms = malloc(places*n*sizeof(double) + 1);
    m->products = is_velocity ? malloc(places*6*sizeof(double) + 1) : NULL;
    if (!m->average || !m->rms || (is_velocity && !m->products)) return complain("out of memory");
    snprintf(m->names[0], sizeof m->names[0], "mean_%s", field->name);
    snprintf(m->names[1], sizeof m->names[1], "rms_%s", field->name);
    return tobi_sample_mean_read(field->mean, share, m->average, m->rms, m->products, &err) == TOBI_OK ? 0
        : complain("%s", err.text);
}

static int write_mean_table(const sample_run *s, const double *share, const means *m)
{
    static const char *const pairs[] = { "xx", "xy", "xz", "yy", "yz", "zz" };
    sample_table t;
    const int code = open_table(s, "_mean", &t);
    if (code) return sample_end_table(&t, code);
    write_head(s, t.file);
    fputs(",wet_share", t.file);
    for (int f = 0; f < s->field_count; f++) {
        write_columns(&s->field[f], "mean_", t.file);
        write_columns(&s->field[f], "rms_", t.file);
        if (!m[f].products) continue;
        for (int k = 0; k < 6; k++) fprintf(t.file, ",reynolds_%s [m2/s2]", pairs[k]);
    }
    fputc('\n', t.file);
    for (int64_t i = 0; i < s->places.count; i++) {
        write_place(s, i, t.file);
        fprintf(t.file, ",%.9g", share[i]);
        for (int f = 0; f < s->field_count; f++) {
            const int n = s->field[f].components;
            write_numbers(m[f].average + n*i, n, t.file);
            write_numbers(m[f].rms + n*i, n, t.file);
            if (m[f].products) write_numbers(m[f].products + 6*i, 6, t.file);
        }
        fputc('\n', t.file);
    }
    return sample_end_table(&t, 0);
}

/* VTK's order of a symmetric tensor: xx, yy, zz, xy, yz, xz. */
static void order_products(double *p, int64_t places)
{
    static const int from[6] = { 0, 3, 5, 1, 4, 2 };
    for (int64_t i = 0; i < places; i++) {
        double old[6];
        memcpy(old, p + 6*i, sizeof old);
        for (int k = 0; k < 6; k++) p[6*i + k] = old[from[k]];
    }
}

static int write_mean_grid(const sample_run *s, const double *share, const means *m)
{
    tobi_sample_array arrays[3*TOBI_SAMPLE_FIELD_LIMIT + 1];
    int n = 0;
    arrays[n++] = (tobi_sample_array){ "wet_share", 1, share };
    for (int f = 0; f < s->field_count; f++) {
        arrays[n++] = (tobi_sample_array){ m[f].names[0], s->field[f].components, m[f].average };
        arrays[n++] = (tobi_sample_array){ m[f].names[1], s->field[f].components, m[f].rms };
        if (!m[f].products) continue;
        order_products(m[f].products, s->places.count);
        arrays[n++] = (tobi_sample_array){ "reynolds", 6, m[f].products };
    }
    return write_arrays(s, "mean", arrays, n, NULL);
}

int sample_write_means(const sample_run *s)
{
    double *share = malloc((size_t)s->places.count*sizeof *share + 1);
    means *m = calloc((size_t)s->field_count + 1, sizeof *m);
    int code = share && m ? 0 : complain("out of memory");
    for (int f = 0; f < s->field_count && !code; f++) code = read_means(s, f, share, &m[f]);
    if (!code) code = s->places.is_grid ? write_mean_grid(s, share, m) : write_mean_table(s, share, m);
    for (int f = 0; m && f < s->field_count; f++) {
        free(m[f].average);
        free(m[f].rms);
        free(m[f].products);
    }
    free(m);
    free(share);
    return code;
}
