/* Curves beside the picture: of the whole the energies, of each body the force of the particles on it. They
   are read from the tables of the results. Drawback: a table is read whole each time there is a new output.
   */
#define _GNU_SOURCE 1
#include "viewer.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void graph_free(graph *g)
{
    free(g->time);
    for (int c = 0; c < GRAPH_CURVES; c++) free(g->value[c]);
    *g = (graph){ 0 };
}

static int read_file(const viewer *v, const char *name, table *t)
{
    char *path = NULL;
    if (asprintf(&path, "%s/%s", v->def.dir, name) < 0) return -1;
    const int code = access(path, R_OK) == 0 ? table_read(t, path) : -1;
    free(path);
    return code;
}

/* One value per row: the sum of up to two columns, in rows of that name (NULL: all). */
static void fill(graph *g, const table *t, const char *name, const char *const columns[GRAPH_CURVES][2])
{
    const int time = table_column(t, "time"), names = name ? table_column(t, "name") : -1;
    g->time = calloc(t->rows + 1, sizeof *g->time);
    for (int c = 0; c < GRAPH_CURVES; c++) g->value[c] = calloc(t->rows + 1, sizeof *g->value[c]);
    if (time < 0 || !g->time || !g->value[0] || !g->value[1] || !g->value[2]) return;
    for (size_t i = 0; i < t->rows; i++) {
        if (names >= 0 && strcmp(t->cells[i*(size_t)t->columns + (size_t)names], name) != 0) continue;
        g->time[g->count] = table_number(t, i, time);
        for (int c = 0; c < g->curves; c++)
            for (int k = 0; k < 2; k++) {
                const int column = columns[c][k] ? table_column(t, columns[c][k]) : -1;
                if (column >= 0) g->value[c][g->count] += table_number(t, i, column);
            }
        g->count++;
    }
}

static void read_whole(viewer *v, graph *g)
{
    static const char *const columns[GRAPH_CURVES][2] = { { "kinetic_energy", NULL }, { "elastic_energy",
            NULL },
                                                          { NULL, NULL } };
    table t = { 0 };
    if (read_file(v, "history.csv", &t) != 0) return;
    snprintf(g->title, sizeof g->title, "%s", window_text(v, TEXT("energy, J")));
    g->curves = 2;
    g->label[0] = window_text(v, TEXT("kinetic"));
    g->label[1] = window_text(v, TEXT("elastic"));
    fill(g, &t, NULL, columns);
    table_free(&t);
}

/* Body `number` of the table; -1: there are not so many. */
static int read_body(viewer *v, graph *g, int number)
{
    static const char *const columns[GRAPH_CURVES][2] = {
        { "mean_pressure_force_x", "mean_viscous_force_x" },
        { "mean_pressure_force_y", "mean_viscous_force_y" },
        { "mean_pressure_force_z", "mean_viscous_force_z" } };
    table t = { 0 };
    if (read_file(v, "bodies.csv", &t) != 0) return -1;
    const int names = table_column(&t, "name");
    size_t row = (size_t)number;
    if (names < 0 || row >= t.rows ||
        (row > 0 && strcmp(t.cells[row*(size_t)t.columns + (size_t)names], t.cells[(size_t)names]) == 0)) {
        table_free(&t);
        return -1;
    }
    const char *name = t.cells[row*(size_t)t.columns + (size_t)names];
    snprintf(g->title, sizeof g->title, window_text(v, TEXT("force on %.100s, N")), name);
    g->curves = v->def.looks.dimension;
    g->label[0] = "x";
    g->label[1] = "y";
    g->label[2] = "z";
    fill(g, &t, name, columns);
    table_free(&t);
    return 0;
}

void graph_read(viewer *v)
{
    graph_free(&v->graph);
    v->changed = 1;
    if (v->graph_number > 0 && read_body(v, &v->graph, v->graph_number - 1) != 0) v->graph_number = -1;
    if (v->graph_number == 0) read_whole(v, &v->graph);
}
