/* The files per output: particles, surfaces, and the lists that give them their times. All but names
   and folders runs on the thread of the writer, and looks at snapshots. */
#include "geom/texture.h"
#include "io/exchange.h"
#include "record/record.h"
#include "world/scalars.h"
#include "world/world.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* --- names ----------------------------------------------------------------------------- */

/* Fields that are small whole numbers. */
static bool is_number(const char *field)
{
    static const char *const names[] = { "object_id", "material", "part", "piece", "cut_side" };
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
        field->bodies = tobi_body_has_field(k);
        field->type = strcmp(known, "particle_id") == 0 ? TOBI_I64 : is_number(known) ? TOBI_I32 : TOBI_F32;
        return TOBI_OK;
    }
    return TOBI_NOT_FOUND;
}

tobi_status tobi_record_find_field(const tobi_run *run, const char *key, const char *name, size_t length,
                                   tobi_record_field *field, tobi_error *err)
{
    const char *known;
    const tobi_world *w = run->world;
    int has = 0;
    for (int n = 0; n < w->system_count && find_field(name, length, field) == TOBI_OK; n++)
        for (int k = 0; (known = tobi_method_field(w->system[n].method->name, k)); k++)
            has |= strcmp(known, field->name) == 0;
    if (has && tobi_scalars_know(w, field->name, NULL) == TOBI_OK) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "%s: there is no field '%.*s' of %s", key, (int)length, name,
                     w->system[0].method->name);
}

/* A name twice counts once. */
static tobi_status add_field(tobi_run *run, const char *name, size_t length, tobi_error *err)
{
    tobi_record_field field = { 0 };
    TOBI_TRY(tobi_record_find_field(run, "output.fields", name, length, &field, err));
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
                                         "von_mises", "material", "part", "piece", "cut_side" };
    const int parts = tobi_record_has_pieces(run->world);
    const int count = parts ? 10 : tobi_world_solids(run->world) ? 8 : 5;
    for (int k = 0; k < count; k++) TOBI_TRY(add_field(run, usual[k], strlen(usual[k]), err));
    if (count == 5 && tobi_record_has_kinds(run->world))
        TOBI_TRY(add_field(run, "material", strlen("material"), err));
    tobi_scalar_info scalar;
    for (int k = 0; tobi_world_scalar(run->world, k, &scalar); k++)
        TOBI_TRY(add_field(run, scalar.field, strlen(scalar.field), err));
    const char *texture = "texture_coordinates", *rest = "rest_position";
    if (run->world->solid_images > 0) TOBI_TRY(add_field(run, rest, strlen(rest), err));
    return tobi_world_has_textures(run->world) ? add_field(run, texture, strlen(texture), err) : TOBI_OK;
}

tobi_status tobi_series_fields(tobi_run *run, tobi_error *err)
{
    run->field_count = 0;
    if (run->output.grid && !tobi_world_solids(run->world))
        return tobi_fail(err, TOBI_INVALID, "output.grid: %s has no grid",
                         run->world->system[0].method->name);
    if (run->output.tractions && !tobi_world_fluids(run->world))
        return tobi_fail(err, TOBI_INVALID, "output.tractions: %s has no fluid that presses on bodies",
                         run->world->system[0].method->name);
    for (const char *p = run->output.fields ? run->output.fields : ""; *p;) {
        p += strspn(p, ", ");
        size_t length = strcspn(p, ", ");
        if (length == 0) break;
        bool usual = length == 5 && memcmp(p, "usual", 5) == 0;
        TOBI_TRY(usual ? add_usual(run, err) : add_field(run, p, length, err));
        p += length;
    }
    TOBI_TRY(tobi_frames_prepare(run, err));
    return tobi_record_surface_fields(run, err);
}

static const char *const set_names[TOBI_SETS] = { "fluid", "bodies", "grid" };

/* What has a file in each output: folder/NAME_000000.extension. */
typedef struct series { const char *name, *folder, *extension; } series;

/* The series by number; 0 past the last. */
static int series_at(const tobi_run *run, int number, series *out)
{
    const int bodies = tobi_world_body_count(run->world);
    const int has[TOBI_SETS] = { 1, bodies > 0, run->output.grid };
    for (int k = 0; k < TOBI_SETS; k++)
        if (has[k] && number-- == 0) return *out = (series){ set_names[k], set_names[k], "vtu" }, 1;
    if (run->output.surface && number-- == 0) return *out = (series){ "surface", "surface", "vtp" }, 1;
    if (run->output.surfaces && number < bodies)
        return *out = (series){ run->body_file[number], "surfaces", "vtp" }, 1;
    if (run->output.surfaces) number -= bodies;
    const int lines = run->output.surfaces ? tobi_world_line_count(run->world) : 0;
    if (number < lines) return *out = (series){ run->line_file[number], "surfaces", "vtp" }, 1;
    number -= lines;
    if (!run->output.tractions || number >= bodies) return 0;
    *out = (series){ run->traction_file[number], "tractions", "vtp" };
    return 1;
}

tobi_status tobi_series_prepare(tobi_run *run, tobi_error *err)
{
    TOBI_TRY(tobi_record_name_bodies(run->world, &run->body_file, &run->traction_file, &run->line_file, err));
    for (series s; series_at(run, run->series, &s);) run->series++;
    run->list = calloc((size_t)run->series + 1, sizeof *run->list);
    return run->list ? tobi_series_folders(run, err)
                     : tobi_fail(err, TOBI_NO_MEMORY, "run: out of memory");
}

tobi_status tobi_series_folders(const tobi_run *run, tobi_error *err)
{
    TOBI_TRY(tobi_record_make_dir(run->dir, "fluid", err));
    TOBI_TRY(tobi_record_make_dir(run->dir, "checkpoints", err));
    if (run->output.frames) TOBI_TRY(tobi_record_make_dir(run->dir, "frames", err));
    if (run->output.ply) TOBI_TRY(tobi_record_make_dir(run->dir, "ply", err));
    if (run->output.grid) TOBI_TRY(tobi_record_make_dir(run->dir, "grid", err));
    if (run->output.surface) TOBI_TRY(tobi_record_make_dir(run->dir, "surface", err));
    if (tobi_world_body_count(run->world) == 0) return TOBI_OK;
    TOBI_TRY(tobi_record_make_dir(run->dir, "bodies", err));
    if (run->output.obj) TOBI_TRY(tobi_record_make_dir(run->dir, "obj", err));
    if (run->output.tractions) TOBI_TRY(tobi_record_make_dir(run->dir, "tractions", err));
    return run->output.surfaces ? tobi_record_make_dir(run->dir, "surfaces", err) : TOBI_OK;
}

/* --- files of a snapshot --------------------------------------------------------------- */

static tobi_status fail_memory(tobi_error *err)
{
    return tobi_fail(err, TOBI_NO_MEMORY, "output: out of memory");
}

static tobi_status write_set(tobi_run *run, const tobi_snapshot *snapshot, int k, tobi_error *err)
{
    const tobi_point_set *set = &snapshot->set[k];
    char *path = tobi_record_path(run->dir, "%s/%s_%06lld.vtu", set_names[k], set_names[k],
                                  (long long)snapshot->number);
    tobi_status status =
        path ? tobi_vtu_write(path, (tobi_compression)run->output.compression, set->count,
                              (const double (*)[3])set->position, set->array, set->arrays, err)
             : fail_memory(err);
    free(path);
    return status;
}

static tobi_status write_ply(tobi_run *run, const tobi_snapshot *snapshot, int unused, tobi_error *err)
{
    (void)unused;
    const tobi_point_set *set = &snapshot->set[TOBI_SET_FLUID];
    char *path = tobi_record_path(run->dir, "ply/fluid_%06lld.ply", (long long)snapshot->number);
    tobi_status status =
        path ? tobi_ply_write(path, set->count, (const double (*)[3])set->position, err) : fail_memory(err);
    free(path);
    return status;
}

/* The same surface with its vertices doubled along seams of the texture; *vertices is the caller's. */
static tobi_status put_on_skin(const tobi_skin *skin, tobi_vtk_surface *s, tobi_vtk_array *uv,
                               double (**vertices)[3], tobi_error *err)
{
    *vertices = malloc((size_t)skin->vertex_count * sizeof **vertices);
    if (!*vertices) return fail_memory(err);
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

static tobi_status write_vtp(const tobi_run *run, int body, const char *path, tobi_vtk_surface s,
                             tobi_error *err)
{
    tobi_compression form = (tobi_compression)run->output.compression;
    tobi_vtk_array uv;
    double (*vertices)[3] = NULL;
    if (!run->world->sim.bodies[body].mesh.texture || s.vertex_count == 0)
        return tobi_vtp_write(path, form, &s, err);
    tobi_status status = put_on_skin(&run->skin[body], &s, &uv, &vertices, err);
    if (status == TOBI_OK) status = tobi_vtp_write(path, form, &s, err);
    free(vertices);
    return status;
}

/* kind: 0 VTP, 1 STL, 2 OBJ. */
static tobi_status write_surface(const tobi_run *run, const tobi_snapshot *snapshot, int body, int kind,
                                 tobi_error *err)
{
    static const char *const folders[] = { "surfaces", "surfaces", "obj" };
    static const char *const ends[] = { "vtp", "stl", "obj" };
    const tobi_mesh *mesh = &run->world->sim.bodies[body].mesh;
    const int there = snapshot->surface[body] != NULL;
    const tobi_vtk_surface s = { .vertex_count = there ? mesh->vertex_count : 0,
                                 .triangle_count = there ? mesh->triangle_count : 0,
                                 .vertices = (const double (*)[3])snapshot->surface[body],
                                 .triangles = (const int32_t (*)[3])mesh->triangles };
    char *path = tobi_record_path(run->dir, "%s/%s_%06lld.%s", folders[kind], run->body_file[body],
                                  (long long)snapshot->number, ends[kind]);
    tobi_status status =
        !path ? fail_memory(err)
        : kind == 0 ? write_vtp(run, body, path, s, err)
        : kind == 1 ? tobi_stl_write(path, s.vertex_count, s.vertices, s.triangle_count, s.triangles, err)
                    : tobi_obj_write(path, s.vertex_count, s.vertices, s.triangle_count, s.triangles, err);
    free(path);
    return status;
}

static tobi_status write_body_vtp(tobi_run *run, const tobi_snapshot *s, int body, tobi_error *err)
{
    return write_surface(run, s, body, 0, err);
}

static tobi_status write_body_stl(tobi_run *run, const tobi_snapshot *s, int body, tobi_error *err)
{
    return write_surface(run, s, body, 1, err);
}

static tobi_status write_body_obj(tobi_run *run, const tobi_snapshot *s, int body, tobi_error *err)
{
    return write_surface(run, s, body, 2, err);
}

static tobi_status write_line(tobi_run *run, const tobi_snapshot *snapshot, int line, tobi_error *err)
{
    const tobi_line_tube *t = &snapshot->tube[line];
    const tobi_vtk_surface s = { .vertex_count = TOBI_TUBE_VERTICES, .triangle_count = TOBI_TUBE_TRIANGLES,
                                 .vertices = t->vertex, .triangles = t->triangle };
    char *path = tobi_record_path(run->dir, "surfaces/%s_%06lld.vtp", run->line_file[line],
                                  (long long)snapshot->number);
    const tobi_status status = path ? tobi_vtp_write(path, (tobi_compression)run->output.compression, &s, err)
                                    : fail_memory(err);
    free(path);
    return status;
}

/* --- lists ----------------------------------------------------------------------------- */

/* Output `number` in the list of each series and in that of all. */
static tobi_status list_output(tobi_run *run, int64_t number, tobi_error *err)
{
    series s;
    for (int k = 0; series_at(run, k, &s); k++) {
        char file[128];
        snprintf(file, sizeof file, "%s/%s_%06lld.%s", s.folder, s.name, (long long)number, s.extension);
        tobi_pvd_entry entry = { .time = tobi_record_time_taken(run, number), .file = file, .name = s.name };
        char *path = tobi_record_path(run->dir, "%s", file);
        const bool there = path && access(path, F_OK) == 0;
        free(path);
        run->missing += !there;
        if (!there) continue;
        TOBI_TRY(tobi_pvd_add(&run->list[k], &entry, err));
        entry.part = k;
        TOBI_TRY(tobi_pvd_add(&run->list[run->series], &entry, err));
    }
    return TOBI_OK;
}

static void forget_lists(tobi_run *run)
{
    for (int k = 0; run->list && k <= run->series; k++) tobi_pvd_free(&run->list[k]);
    run->listed = run->missing = 0;
}

static tobi_status write_lists(tobi_run *run, int64_t outputs, tobi_error *err)
{
    while (run->listed < outputs) {
        tobi_status status = list_output(run, run->listed, err);
        if (status != TOBI_OK) forget_lists(run);      /* half an output may be in them */
        TOBI_TRY(status);
        run->listed++;
    }
    for (int k = 0; k <= run->series; k++) {
        series s = { .name = "all" };
        series_at(run, k, &s);
        char *path = tobi_record_path(run->dir, "%s.pvd", s.name);
        tobi_status status = path ? tobi_pvd_write(path, &run->list[k], err) : fail_memory(err);
        free(path);
        TOBI_TRY(status);
    }
    return TOBI_OK;
}

tobi_status tobi_series_lists(tobi_run *run, tobi_error *err)
{
    forget_lists(run);
    return write_lists(run, run->outputs, err);
}

void tobi_series_free(tobi_run *run)
{
    forget_lists(run);
    free(run->list);
    free(run->body_file);
    free(run->traction_file);
    free(run->line_file);
    tobi_looks_free(&run->looks);
    tobi_moment_free(&run->tracks);
}

/* A file of an output: its kind, and which of them. */
typedef struct file_job {
    tobi_record_kind kind;
    int which;
    tobi_status (*write)(tobi_run *run, const tobi_snapshot *s, int which, tobi_error *err);
} file_job;

/* The files of an output by number; 0 past the last. */
static int job_at(const tobi_run *run, const tobi_snapshot *s, int number, file_job *out)
{
    const tobi_output_def *o = &run->output;
    const int bodies = s->surfaces;
    const struct { int count; file_job job; } list[] = {
        { 1, { TOBI_KIND_PARTICLES, TOBI_SET_FLUID, write_set } },
        { bodies > 0, { TOBI_KIND_PARTICLES, TOBI_SET_BODIES, write_set } },
        { o->surfaces ? bodies : 0, { TOBI_KIND_SURFACES, 0, write_body_vtp } },
        { o->surfaces ? bodies : 0, { TOBI_KIND_COPIES, 0, write_body_stl } },
        { o->surfaces ? s->lines : 0, { TOBI_KIND_SURFACES, 0, write_line } },
        { o->tractions ? bodies : 0, { TOBI_KIND_SURFACES, 0, tobi_tractions_write } },
        { o->grid != 0, { TOBI_KIND_PARTICLES, TOBI_SET_GRID, write_set } },
        { o->surface != 0, { TOBI_KIND_SURFACES, 0, tobi_record_write_surface } },
        { o->ply != 0, { TOBI_KIND_COPIES, 0, write_ply } },
        { o->obj ? bodies : 0, { TOBI_KIND_COPIES, 0, write_body_obj } },
        { o->frames ? run->view_count : 0, { TOBI_KIND_PICTURES, 0, tobi_frames_write } },
    };
    for (size_t k = 0; k < sizeof list/sizeof *list; number -= list[k++].count) {
        if (number >= list[k].count) continue;
        *out = list[k].job;
        out->which += number;
        return 1;
    }
    return 0;
}

/* A second try where the kind was well until now: a disk may be full for a moment. TOBI_IO: the folder was
   gone, and the output has to be written anew. */
static tobi_status write_job(tobi_run *run, const tobi_snapshot *s, const file_job *j, tobi_error *err)
{
    tobi_status status = j->write(run, s, j->which, err);
    if (status == TOBI_IO && tobi_record_is_folder_gone(run) &&
        (!run->goes_on || tobi_record_keep_dir(run, NULL) == TOBI_OK)) return status;
    if (status == TOBI_IO && run->goes_on && !tobi_trouble_lasts(run, j->kind))
        status = j->write(run, s, j->which, err);
    return tobi_trouble_pass(run, j->kind, s->number, status, err);
}

tobi_status tobi_series_write(tobi_run *run, const tobi_snapshot *s, tobi_error *err)
{
    file_job job;
    for (int k = 0; job_at(run, s, k, &job); k++) TOBI_TRY(write_job(run, s, &job, err));
    return tobi_trouble_pass(run, TOBI_KIND_LISTS, s->number, write_lists(run, s->number + 1, err), err);
}
