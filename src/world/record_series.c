/* The files per output: particles, surfaces, and the lists that give them their times. */
#include "geom/texture.h"
#include "io/exchange.h"
#include "io/vtk.h"
#include "world/record.h"
#include "world/world.h"
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/* --- names ----------------------------------------------------------------------------- */

/* Fields that are small whole numbers. */
static bool is_number(const char *field)
{
    static const char *const names[] = { "object_id", "material", "piece", "cut_side" };
    for (size_t k = 0; k < sizeof names/sizeof *names; k++)
        if (strcmp(field, names[k]) == 0) return true;
    return false;
}

static tobi_status find_field(const char *name, size_t length, tobi_record_field *field)
{
    const char *known, *unit;
    for (int k = 0; (known = tobi_world_field_name(k, &field->components, &unit)); k++) {
        if (strlen(known) != length || memcmp(known, name, length) != 0) continue;
        field->name = known;
        field->bodies = tobi_world_bodies_have(k);
        field->type = strcmp(known, "particle_id") == 0 ? TOBI_I64 : is_number(known) ? TOBI_I32 : TOBI_F32;
        return TOBI_OK;
    }
    return TOBI_NOT_FOUND;
}

/* A name twice counts once. */
static tobi_status add_field(tobi_run *run, const char *name, size_t length, tobi_error *err)
{
    const char *known[TOBI_WORLD_FIELDS];
    tobi_record_field field = { 0 };
    int has = 0, count = tobi_world_list_fields(run->world->method->name, known);
    if (find_field(name, length, &field) == TOBI_OK)
        for (int k = 0; k < count; k++) has |= known[k] == field.name;
    if (!has)
        return tobi_fail(err, TOBI_INVALID, "output.fields: there is no field '%.*s' of %s",
                         (int)length, name, run->world->method->name);
    bool again = strcmp(field.name, "position") == 0;      /* always written, as the points */
    for (int k = 0; k < run->field_count; k++) again |= run->field[k].name == field.name;
    if (again) return TOBI_OK;
    if (run->field_count == TOBI_RECORD_FIELD_LIMIT)
        return tobi_fail(err, TOBI_INVALID, "output.fields: more than %d", TOBI_RECORD_FIELD_LIMIT);
    run->field[run->field_count++] = field;
    return TOBI_OK;
}

static tobi_status add_usual(tobi_run *run, tobi_error *err)
{
    static const char *const usual[] = { "velocity", "pressure", "density", "object_id", "particle_id",
                                         "von_mises", "material", "piece", "cut_side" };
    const tobi_simulation *s = &run->world->sim;
    int count = run->world->method->fields & TOBI_MPM ? 7 : 5;
    for (int k = 0; k < s->body_count && count == 7; k++)
        if (s->bodies[k].blade) count = 9;
    for (int k = 0; k < count; k++) TOBI_TRY(add_field(run, usual[k], strlen(usual[k]), err));
    const char *texture = "texture_coordinates";
    return tobi_world_has_textures(run->world) ? add_field(run, texture, strlen(texture), err) : TOBI_OK;
}

tobi_status tobi_series_fields(tobi_run *run, tobi_error *err)
{
    run->field_count = 0;
    if (run->output.grid && !run->world->method->nodes)
        return tobi_fail(err, TOBI_INVALID, "output.grid: %s has no grid", run->world->method->name);
    for (const char *p = run->output.fields ? run->output.fields : ""; *p;) {
        p += strspn(p, ", ");
        size_t length = strcspn(p, ", ");
        if (length == 0) break;
        bool usual = length == 5 && memcmp(p, "usual", 5) == 0;
        TOBI_TRY(usual ? add_usual(run, err) : add_field(run, p, length, err));
        p += length;
    }
    return TOBI_OK;
}

static bool is_taken(const tobi_run *run, int count, const char *name)
{
    static const char *const ours[] = { "all", "fluid", "bodies", "grid" };
    for (size_t k = 0; k < sizeof ours/sizeof *ours; k++)
        if (strcmp(ours[k], name) == 0) return true;
    for (int k = 0; k < count; k++)
        if (strcmp(run->body_file[k], name) == 0) return true;
    return false;
}

/* A file name for each body: its own name with odd characters as '_', and a number if taken. */
static tobi_status name_bodies(tobi_run *run, tobi_error *err)
{
    int count = tobi_world_body_count(run->world);
    run->body_file = calloc((size_t)count + 1, sizeof *run->body_file);
    if (!run->body_file) return tobi_fail(err, TOBI_NO_MEMORY, "run: out of memory");
    for (int k = 0; k < count; k++) {
        char stem[64] = "", name[80];
        const char *own = tobi_world_body_name(run->world, k);
        for (size_t n = 0; own[n] && n + 1 < sizeof stem; n++)
            stem[n] = isalnum((unsigned char)own[n]) || strchr("-_", own[n]) ? own[n] : '_';
        if (!*stem) strcpy(stem, "body");
        snprintf(name, sizeof name, "%s", stem);
        for (int i = 2; is_taken(run, k, name); i++) snprintf(name, sizeof name, "%s_%d", stem, i);
        strcpy(run->body_file[k], name);
    }
    return TOBI_OK;
}

tobi_status tobi_series_prepare(tobi_run *run, tobi_error *err)
{
    TOBI_TRY(name_bodies(run, err));
    TOBI_TRY(tobi_record_make_dir(run->dir, "fluid", err));
    TOBI_TRY(tobi_record_make_dir(run->dir, "checkpoints", err));
    if (run->output.frames) TOBI_TRY(tobi_record_make_dir(run->dir, "frames", err));
    if (run->output.ply) TOBI_TRY(tobi_record_make_dir(run->dir, "ply", err));
    if (run->output.grid) TOBI_TRY(tobi_record_make_dir(run->dir, "grid", err));
    if (tobi_world_body_count(run->world) == 0) return TOBI_OK;
    TOBI_TRY(tobi_record_make_dir(run->dir, "bodies", err));
    if (run->output.obj) TOBI_TRY(tobi_record_make_dir(run->dir, "obj", err));
    return run->output.surfaces ? tobi_record_make_dir(run->dir, "surfaces", err) : TOBI_OK;
}

/* --- particles ------------------------------------------------------------------------- */

/* Turns n doubles into the type they have in files, in a new array. */
static void *convert(const double *from, int64_t n, int type)
{
    void *to = malloc((size_t)n * tobi_type_size((tobi_vtk_type)type) + 1);
    if (!to) return NULL;
    if (type == TOBI_F32) for (int64_t i = 0; i < n; i++) ((float *)to)[i] = (float)from[i];
    else if (type == TOBI_I32)
        for (int64_t i = 0; i < n; i++) ((int32_t *)to)[i] = (int32_t)from[i];
    else for (int64_t i = 0; i < n; i++) ((int64_t *)to)[i] = (int64_t)from[i];
    return to;
}

/* Reads every chosen field that the set has, *count of them; arrays[k].data is owned by the caller, also
   after a failure. */
static tobi_status read_arrays(tobi_run *run, tobi_set set, double *buffer, tobi_vtk_array *arrays,
                               int *count, tobi_error *err)
{
    int64_t n = tobi_world_count(run->world, set);
    for (int k = 0; k < run->field_count; k++) {
        const tobi_record_field *f = &run->field[k];
        if (set == TOBI_BODIES && !f->bodies) continue;
        TOBI_TRY(tobi_world_read(run->world, set, f->name, buffer, n, err));
        tobi_vtk_array *array = &arrays[(*count)++];
        *array = (tobi_vtk_array){ f->name, (tobi_vtk_type)f->type, f->components,
                                   convert(buffer, n * f->components, f->type) };
        if (!array->data) return tobi_fail(err, TOBI_NO_MEMORY, "output: out of memory");
    }
    return TOBI_OK;
}

static tobi_status write_particles(tobi_run *run, tobi_set set, const char *name, tobi_error *err)
{
    int64_t n = tobi_world_count(run->world, set);
    int count = 0;
    tobi_vtk_array arrays[TOBI_RECORD_FIELD_LIMIT] = { 0 };
    char *path =
        tobi_record_path(run->dir, "%s/%s_%06lld.vtu", name, name, (long long)run->outputs);
    double *points = malloc((size_t)n * 3 * sizeof *points + 1);
    double *buffer = malloc((size_t)n * 9 * sizeof *buffer + 1);
    tobi_status status = TOBI_OK;
    if (!path || !points || !buffer)
        status = tobi_fail(err, TOBI_NO_MEMORY, "output: out of memory");
    if (status == TOBI_OK) status = tobi_world_read(run->world, set, "position", points, 3 * n, err);
    if (status == TOBI_OK) status = read_arrays(run, set, buffer, arrays, &count, err);
    if (status == TOBI_OK)
        status = tobi_vtu_write(path, (tobi_compression)run->output.compression, n,
                                (const double (*)[3])points, arrays, count, err);
    for (int k = 0; k < count; k++) free((void *)arrays[k].data);
    free(buffer);
    free(points);
    free(path);
    return status;
}

static tobi_status write_ply(tobi_run *run, tobi_error *err)
{
    int64_t n = tobi_world_count(run->world, TOBI_FLUID);
    char *path = tobi_record_path(run->dir, "ply/fluid_%06lld.ply", (long long)run->outputs);
    double *points = malloc((size_t)n * 3 * sizeof *points + 1);
    tobi_status status =
        path && points ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "output: out of memory");
    if (status == TOBI_OK)
        status = tobi_world_read(run->world, TOBI_FLUID, "position", points, 3 * n, err);
    if (status == TOBI_OK) status = tobi_ply_write(path, n, (const double (*)[3])points, err);
    free(points);
    free(path);
    return status;
}

static tobi_status write_grid(tobi_run *run, tobi_error *err)
{
    const tobi_grid *g;
    TOBI_TRY(tobi_world_grid(run->world, &g, err));
    tobi_vtk_array arrays[] = {
        { "velocity", TOBI_F32, 3, convert(&g->velocity[0][0], 3 * g->count, TOBI_F32) },
        { "mass", TOBI_F32, 1, convert(g->mass, g->count, TOBI_F32) },
        { "stress", TOBI_F32, 6, convert(&g->stress[0][0], 6 * g->count, TOBI_F32) },
    };
    char *path = tobi_record_path(run->dir, "grid/grid_%06lld.vtu", (long long)run->outputs);
    tobi_status status = TOBI_OK;
    if (!path || !arrays[0].data || !arrays[1].data || !arrays[2].data)
        status = tobi_fail(err, TOBI_NO_MEMORY, "output: out of memory");
    if (status == TOBI_OK)
        status = tobi_vtu_write(path, (tobi_compression)run->output.compression, g->count,
                                (const double (*)[3])g->position, arrays, 3, err);
    for (int k = 0; k < 3; k++) free((void *)arrays[k].data);
    free(path);
    return status;
}

/* --- surfaces -------------------------------------------------------------------------- */

/* The skin of a body whose mesh has a texture, made at the first output. */
static tobi_status find_skin(tobi_run *run, int body, tobi_error *err)
{
    tobi_mesh *mesh = &run->world->sim.bodies[body].mesh;
    if (!run->skin)
        run->skin = calloc((size_t)tobi_world_body_count(run->world) + 1, sizeof *run->skin);
    if (!run->skin) return tobi_fail(err, TOBI_NO_MEMORY, "output: out of memory");
    run->skin_count = tobi_world_body_count(run->world);
    if (run->skin[body].vertex_count > 0) return TOBI_OK;
    TOBI_TRY(tobi_texture_prepare(mesh->texture, err));
    return tobi_skin_build(mesh, &run->skin[body], err);
}

/* The same surface with its vertices doubled along seams of the texture; *vertices is the caller's. */
static tobi_status put_on_skin(const tobi_skin *skin, tobi_vtk_surface *s, tobi_vtk_array *uv,
                               double (**vertices)[3], tobi_error *err)
{
    *vertices = malloc((size_t)skin->vertex_count * sizeof **vertices);
    if (!*vertices) return tobi_fail(err, TOBI_NO_MEMORY, "output: out of memory");
    for (int64_t i = 0; i < skin->vertex_count; i++)
        memcpy((*vertices)[i], s->vertices[skin->vertex[i]], sizeof **vertices);
    *uv = (tobi_vtk_array){ "texture_coordinates", TOBI_F32, 2, skin->uv };
    s->vertex_count = skin->vertex_count;
    s->vertices = (const double (*)[3])*vertices;
    s->triangles = (const int32_t (*)[3])skin->triangles;
    s->point_arrays = uv;
    s->point_array_count = 1;
    return TOBI_OK;
}

void tobi_series_free(tobi_run *run)
{
    for (int k = 0; k < run->skin_count; k++) tobi_skin_free(&run->skin[k]);
    free(run->skin);
}

static tobi_status write_vtp(tobi_run *run, int body, const char *path, tobi_vtk_surface s, tobi_error *err)
{
    tobi_compression form = (tobi_compression)run->output.compression;
    tobi_vtk_array uv;
    double (*vertices)[3] = NULL;
    if (!run->world->sim.bodies[body].mesh.texture) return tobi_vtp_write(path, form, &s, err);
    TOBI_TRY(find_skin(run, body, err));
    tobi_status status = put_on_skin(&run->skin[body], &s, &uv, &vertices, err);
    if (status == TOBI_OK) status = tobi_vtp_write(path, form, &s, err);
    free(vertices);
    return status;
}

static tobi_status write_surface(tobi_run *run, int body, tobi_error *err)
{
    tobi_vtk_surface s = { 0 };
    TOBI_TRY(tobi_world_surface(run->world, body, &s.vertex_count, &s.vertices, &s.triangle_count,
                                &s.triangles));
    long long k = (long long)run->outputs;
    char *vtp = tobi_record_path(run->dir, "surfaces/%s_%06lld.vtp", run->body_file[body], k);
    char *stl = tobi_record_path(run->dir, "surfaces/%s_%06lld.stl", run->body_file[body], k);
    tobi_status status =
        vtp && stl ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "output: out of memory");
    if (status == TOBI_OK)
        status = write_vtp(run, body, vtp, s, err);
    if (status == TOBI_OK)
        status =
            tobi_stl_write(stl, s.vertex_count, s.vertices, s.triangle_count, s.triangles, err);
    free(vtp);
    free(stl);
    return status;
}

static tobi_status write_obj(tobi_run *run, int body, tobi_error *err)
{
    int64_t vertices, triangles;
    const double (*vertex)[3];
    const int32_t (*triangle)[3];
    TOBI_TRY(tobi_world_surface(run->world, body, &vertices, &vertex, &triangles, &triangle));
    char *path = tobi_record_path(run->dir, "obj/%s_%06lld.obj", run->body_file[body],
                                  (long long)run->outputs);
    if (!path) return tobi_fail(err, TOBI_NO_MEMORY, "output: out of memory");
    tobi_status status = tobi_obj_write(path, vertices, vertex, triangles, triangle, err);
    free(path);
    return status;
}

/* --- lists ----------------------------------------------------------------------------- */

/* What has a file in each output: folder/NAME_000000.extension. */
typedef struct series { const char *name, *folder, *extension; } series;

/* The series by number; 0 past the last. */
static int series_at(const tobi_run *run, int number, series *out)
{
    const int bodies = tobi_world_body_count(run->world);
    const series particles[] = { { "fluid", "fluid", "vtu" }, { "bodies", "bodies", "vtu" },
                                 { "grid", "grid", "vtu" } };
    const int has[] = { 1, bodies > 0, run->output.grid };
    for (int k = 0; k < 3; k++)
        if (has[k] && number-- == 0) return *out = particles[k], 1;
    if (!run->output.surfaces || number >= bodies) return 0;
    *out = (series){ run->body_file[number], "surfaces", "vtp" };
    return 1;
}

/* NAME.pvd of the first `count` outputs: `parts` series from number `first` on, by time, then by series. */
static tobi_status write_list(const tobi_run *run, const char *name, int first, int parts, int64_t count,
                              tobi_error *err)
{
    enum { ROOM = 128 };
    const size_t room = (size_t)count * (size_t)parts;
    tobi_pvd_entry *entries = malloc(room * sizeof *entries + 1);
    char (*files)[ROOM] = malloc(room * sizeof *files + 1);
    char *path = tobi_record_path(run->dir, "%s.pvd", name);
    tobi_status status = TOBI_OK;
    if (!entries || !files || !path)
        status = tobi_fail(err, TOBI_NO_MEMORY, "output: out of memory");
    for (int part = 0; status == TOBI_OK && part < parts; part++) {
        series s;
        series_at(run, first + part, &s);
        for (int64_t k = 0; k < count; k++) {
            const int64_t at = k * parts + part;
            snprintf(files[at], ROOM, "%s/%s_%06lld.%s", s.folder, s.name, (long long)k, s.extension);
            entries[at] = (tobi_pvd_entry){ .time = tobi_record_time(run, k), .file = files[at],
                                            .name = s.name, .part = part };
        }
    }
    if (status == TOBI_OK) status = tobi_pvd_write(path, entries, (int64_t)room, err);
    free(path);
    free(files);
    free(entries);
    return status;
}

/* A list of each series, then one of all. */
static tobi_status write_lists(const tobi_run *run, int64_t count, tobi_error *err)
{
    series s;
    int parts = 0;
    for (; series_at(run, parts, &s); parts++) TOBI_TRY(write_list(run, s.name, parts, 1, count, err));
    return write_list(run, "all", 0, parts, count, err);
}

tobi_status tobi_series_lists(tobi_run *run, tobi_error *err)
{
    return write_lists(run, run->outputs, err);
}

tobi_status tobi_series_write(tobi_run *run, tobi_error *err)
{
    int bodies = tobi_world_body_count(run->world);
    TOBI_TRY(write_particles(run, TOBI_FLUID, "fluid", err));
    if (bodies) TOBI_TRY(write_particles(run, TOBI_BODIES, "bodies", err));
    for (int b = 0; run->output.surfaces && b < bodies; b++) TOBI_TRY(write_surface(run, b, err));
    if (run->output.grid) TOBI_TRY(write_grid(run, err));
    if (run->output.ply) TOBI_TRY(write_ply(run, err));
    for (int b = 0; run->output.obj && b < bodies; b++) TOBI_TRY(write_obj(run, b, err));
    if (run->output.frames) TOBI_TRY(tobi_record_frame(run, err));
    return write_lists(run, run->outputs + 1, err);
}
