/* The surface of fluids and solids at an output. What belongs together is one group: a fluid, or a piece of a
   solid, so that the faces of a cut stay apart. The arrays are taken between steps; the mesh is made on the
   writer's thread. Drawback: the fields of the surface are read a second time, in double. */
#include "io/surface_files.h"
#include "record/record.h"
#include "world/world.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct tobi_record_surface {
    double (*position)[3];       /* NAN: what waits in an inlet */
    int32_t *group;
    double *spacing;             /* m; NULL: all have that of the looks */
    double *values[TOBI_SURFACE_FIELD_LIMIT];
} tobi_record_surface;

void tobi_record_free_surface(tobi_record_surface *s)
{
    if (!s) return;
    for (int f = 0; f < TOBI_SURFACE_FIELD_LIMIT; f++) free(s->values[f]);
    free(s->group);
    free(s->spacing);
    free(s->position);
    free(s);
}

/* A name twice counts once. */
static tobi_status add_field(tobi_run *run, const char *name, size_t length, tobi_error *err)
{
    tobi_record_surface_field field = { .component = -1 };
    snprintf(field.name, sizeof field.name, "%.*s", (int)length, name);
    const char *whole = tobi_world_find_field(field.name, &field.component, NULL);
    const int is_part = whole && field.component >= 0;
    TOBI_TRY(tobi_record_find_field(run, "output.surface.fields", is_part ? whole : name,
                                    is_part ? strlen(whole) : length, &field.of, err));
    for (int k = 0; k < run->surface_fields; k++)
        if (strcmp(run->surface_field[k].name, field.name) == 0) return TOBI_OK;
    if (run->surface_fields == TOBI_SURFACE_FIELD_LIMIT)
        return tobi_fail(err, TOBI_INVALID, "output.surface.fields: more than %d", TOBI_SURFACE_FIELD_LIMIT);
    run->surface_field[run->surface_fields++] = field;
    return TOBI_OK;
}

tobi_status tobi_record_surface_fields(tobi_run *run, tobi_error *err)
{
    run->surface_fields = 0;
    if (!run->output.surface) return TOBI_OK;
    if (run->world->sim.def.dimension != 3)
        return tobi_fail(err, TOBI_INVALID,
                         "output.surface: a world of %d dimensions has no surface, one of 3 has",
                         run->world->sim.def.dimension);
    for (const char *p = run->output.surface_fields ? run->output.surface_fields : ""; *p;) {
        p += strspn(p, ", ");
        const size_t length = strcspn(p, ", ");
        if (length == 0) break;
        const bool usual = length == 5 && memcmp(p, "usual", 5) == 0;
        TOBI_TRY(add_field(run, usual ? "velocity" : p, usual ? 8 : length, err));
        if (usual) TOBI_TRY(add_field(run, "pressure", 8, err));
        p += length;
    }
    return TOBI_OK;
}

/* Fluids and solids by number; pieces of solids behind them. Ids name the rows. */
static tobi_status find_groups(tobi_run *run, int32_t *group, tobi_error *err)
{
    tobi_world *w = run->world;
    const int materials = tobi_world_first_material(w, w->system + w->system_count);
    const tobi_pieces *unused;
    if (tobi_world_solids(w)) TOBI_TRY(tobi_world_pieces(w, &unused, err));
    int64_t to = 0;
    for (int k = 0; k < w->system_count; k++) {
        const tobi_system *s = &w->system[k];
        for (int64_t n = 0; n < s->particles.count; n++) {
            const int64_t row = s->row_of[n];                       /* rows are fresh: just read */
            const int32_t piece = s->solid_count ? (int32_t)w->pieces.of[row] : -1;
            const int32_t material = tobi_world_first_material(w, s) + s->particles.fluid[row];
            group[to++] = piece >= 0 ? (materials + piece)%(1 << 20) : material;
        }
    }
    return TOBI_OK;
}

/* Of materials with a spacing of their own. */
static tobi_status find_spacings(const tobi_run *run, tobi_record_surface *s, int64_t count, tobi_error *err)
{
    const tobi_world *w = run->world;
    int64_t to = 0;
    if (!tobi_looks_differ(&run->looks)) return TOBI_OK;
    s->spacing = malloc((size_t)count*sizeof *s->spacing + 1);
    if (!s->spacing) return tobi_fail(err, TOBI_NO_MEMORY, "surface: out of memory");
    for (int k = 0; k < w->system_count; k++)
        for (int64_t n = 0; n < w->system[k].particles.count; n++)
            s->spacing[to++] = w->system[k].smoothing.spacing;
    return TOBI_OK;
}

static tobi_status take_values(tobi_run *run, const tobi_record_surface_field *f, int64_t n, double **values,
                               tobi_error *err)
{
    const int64_t each = f->of.components;
    double *v = *values = malloc((size_t)(n*each)*sizeof *v + 1);
    if (!v) return tobi_fail(err, TOBI_NO_MEMORY, "surface: out of memory");
    TOBI_TRY(tobi_world_read(run->world, TOBI_FLUID, f->of.name, v, n*each, err));
    for (int64_t i = 0; f->component >= 0 && i < n; i++) v[i] = v[each*i + f->component];
    return TOBI_OK;
}

tobi_status tobi_record_take_surface(tobi_run *run, tobi_snapshot *snapshot, tobi_error *err)
{
    const int64_t n = snapshot->set[TOBI_SET_FLUID].count;
    tobi_record_surface *s = snapshot->skin = calloc(1, sizeof *s);
    if (s) s->group = malloc((size_t)n*sizeof *s->group + 1);
    if (s) s->position = malloc((size_t)n*sizeof *s->position + 1);
    if (!s || !s->group || !s->position) return tobi_fail(err, TOBI_NO_MEMORY, "surface: out of memory");
    TOBI_TRY(tobi_record_find_looks(run, err));
    TOBI_TRY(find_spacings(run, s, n, err));
    for (int64_t i = 0; i < n; i++) {
        const double time = tobi_world_time(run->world);
        memcpy(s->position[i], snapshot->set[TOBI_SET_FLUID].position[i], sizeof s->position[i]);
        if (tobi_looks_hides(&run->looks, time, s->position[i])) s->position[i][0] = NAN;
    }
    for (int f = 0; f < run->surface_fields; f++)
        TOBI_TRY(take_values(run, &run->surface_field[f], n, &s->values[f], err));
    return find_groups(run, s->group, err);
}

tobi_status tobi_record_write_surface(tobi_run *run, const tobi_snapshot *snapshot, int unused,
                                      tobi_error *err)
{
    (void)unused;
    const tobi_world_def *w = &run->world->sim.def;
    const tobi_point_set *set = &snapshot->set[TOBI_SET_FLUID];
    tobi_surface_field fields[TOBI_SURFACE_FIELD_LIMIT];
    tobi_surface_def d = tobi_default_surface();
    d.particle_count = set->count;
    d.positions = (const double (*)[3])snapshot->skin->position;
    d.group = snapshot->skin->group;
    d.spacing = run->looks.spacing;
    d.spacings = snapshot->skin->spacing;
    d.cell = run->output.surface_cell;
    d.smoothing = run->output.surface_smoothing;
    d.threads = w->threads;
    d.fields = fields;
    d.field_count = run->surface_fields;
    for (int f = 0; f < d.field_count; f++) {
        const tobi_record_surface_field *own = &run->surface_field[f];
        fields[f] = (tobi_surface_field){ own->name, own->component < 0 ? own->of.components : 1,
                                          snapshot->skin->values[f] };
    }
    for (int a = 0; a < 3; a++) {
        d.box_min[a] = w->domain_min[a], d.box_max[a] = w->domain_max[a];
        d.flat_min[a] = d.flat_max[a] = 1;
    }
    tobi_surface *surface;
    TOBI_TRY(tobi_surface_make(&d, &surface, err));
    char *path = tobi_record_path(run->dir, "surface/surface_%06lld.vtp", (long long)snapshot->number);
    tobi_status status =
        path ? tobi_surface_write_vtp(path, (tobi_compression)run->output.compression, surface, err)
             : tobi_fail(err, TOBI_NO_MEMORY, "surface: out of memory");
    free(path);
    tobi_surface_free(surface);
    return status;
}
