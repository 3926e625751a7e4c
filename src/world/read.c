/* Reading a world: fields in id order, surfaces, the state hash. */
#include "base/error.h"
#include "core/cuts.h"
#include "world/step.h"
#include "world/world.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* owner: which methods have it; bodies: whether their particles have it too. Of 6: xx, yy, zz, xy, yz, zx, as
   ParaView names them; of 9: by rows. */
typedef struct known_field {
    const char *name;
    int components;
    const char *unit;
    int owner, bodies;
} known_field;

static const known_field fields[] = {
    {"position", 3, "m", TOBI_ALL, 1},        {"velocity", 3, "m/s", TOBI_ALL, 1},
    {"pressure", 1, "Pa", TOBI_ALL, 0},       {"density", 1, "kg/m3", TOBI_ALL, 1},
    {"object_id", 1, "1", TOBI_ALL, 1},       {"particle_id", 1, "1", TOBI_ALL, 1},
    {"acceleration", 3, "m/s2", TOBI_SPH, 0}, {"vorticity", 3, "1/s", TOBI_SPH, 0},
    {"surface", 1, "1", TOBI_SPH, 0},         {"material", 1, "1", TOBI_MPM, 0},
    {"von_mises", 1, "Pa", TOBI_MPM, 0},      {"stress", 6, "Pa", TOBI_MPM, 0},
    {"J", 1, "1", TOBI_MPM, 0},               {"deformation_gradient", 9, "1", TOBI_MPM, 0},
    {"plastic", 1, "1", TOBI_MPM, 0},         {"rest_position", 3, "m", TOBI_MPM, 0},
    {"piece", 1, "1", TOBI_MPM, 0},           {"cut_side", 1, "1", TOBI_MPM, 0},
    {"damage", 1, "1", TOBI_MPM, 0},          {"texture_coordinates", 2, "1", TOBI_MPM, 0},
};
enum { FIELD_COUNT = sizeof fields/sizeof *fields };

int tobi_world_list_fields(const char *method, const char *names[TOBI_WORLD_FIELDS])
{
    const tobi_method *m = tobi_method_find(method);
    int owners = m ? TOBI_ALL | m->fields : ~0, count = 0;
    for (int k = 0; k < FIELD_COUNT; k++)
        if (fields[k].owner & owners) names[count++] = fields[k].name;
    return count;
}

const char *tobi_world_field_name(int field, int *components, const char **unit)
{
    if (field < 0 || field >= FIELD_COUNT) return NULL;
    if (components) *components = fields[field].components;
    if (unit) *unit = fields[field].unit;
    return fields[field].name;
}

int tobi_world_bodies_have(int field) { return fields[field].bodies; }

int64_t tobi_world_count(const tobi_world *w, tobi_set set)
{
    if (!w) return 0;
    int64_t n = 0;
    for (int k = 0; set == TOBI_FLUID && k < w->system_count; k++) n += w->system[k].particles.count;
    if (set == TOBI_FLUID) return n;
    for (int k = 0; k < w->sim.body_count; k++) n += w->sim.bodies[k].particle_count;
    return n;
}

/* Ids go up to the capacity; those of particles that have left are passed over. */
static void order_rows(tobi_system *s)
{
    const tobi_particles *p = &s->particles;
    int64_t n = 0;
    if (p->count < p->capacity) memset(s->row_of, -1, (size_t)p->capacity*sizeof *s->row_of);
    for (int64_t i = 0; i < p->count; i++) s->row_of[p->id[i]] = (int32_t)i;
    if (p->count == p->capacity) return;
    for (int64_t id = 0; id < p->capacity; id++)
        if (s->row_of[id] >= 0) s->row_of[n++] = s->row_of[id];
}

static tobi_status refresh_system(tobi_world *w, tobi_system *s, tobi_error *err)
{
    const tobi_step_info kept = s->info;
    if (w->failure.status != TOBI_DIVERGED && s->method->refresh) TOBI_TRY(s->method->refresh(s, err));
    const double mean = s->info.density_error_mean, max = s->info.density_error_max;
    s->info = kept;
    s->info.density_error_mean = mean;
    s->info.density_error_max = max;
    order_rows(s);
    return TOBI_OK;
}

tobi_status tobi_world_refresh(tobi_world *w, tobi_error *err)
{
    TOBI_TRY(tobi_world_start(w, err));
    if (w->fresh) return TOBI_OK;
    tobi_pieces_free(&w->pieces);
    for (int k = 0; k < w->system_count; k++) TOBI_TRY(refresh_system(w, &w->system[k], err));
    tobi_step_sum_up(w);
    w->fresh = 1;
    return TOBI_OK;
}

/* The latest cut that a particle remembers, with the sign of its side. */
static double latest_cut(const tobi_particles *p, int64_t i)
{
    double cut = 0;
    for (int k = 0; p->cuts && k < TOBI_CUTS_EACH && p->cuts[i].c[k].w != 0; k++) cut = p->cuts[i].c[k].w;
    return cut;
}

/* A field that every method has, or that no method knows more of; 0 if it is none of them. */
static int read_plain(const tobi_system *s, const char *field, int64_t i, double *out)
{
    const tobi_particles *p = &s->particles;
    if (!strcmp(field, "position")) {
        out[0] = p->position[i].x + s->box.lower[0];
        out[1] = p->position[i].y + s->box.lower[1];
        out[2] = p->position[i].z + s->box.lower[2];
    } else if (!strcmp(field, "velocity")) {
        const tobi_float4 *v = &p->velocity[i];
        out[0] = v->x; out[1] = v->y; out[2] = v->z;
    } else if (!strcmp(field, "object_id")) {
        out[0] = 0;      /* of every fluid and solid; bodies count from 1 */
    } else if (!strcmp(field, "cut_side")) {
        out[0] = latest_cut(p, i);
    } else return 0;
    return 1;
}

/* 0 where no mesh has any. */
static void read_texture(const tobi_world *w, const tobi_system *s, int64_t i, double *out)
{
    for (int c = 0; c < 2; c++) out[c] = w->texture ? w->texture[s->particles.id[i]][c] : 0;
}

static void read_fluid(const tobi_system *s, const char *field, int64_t i, double *out)
{
    const tobi_particles *p = &s->particles;
    if (!strcmp(field, "acceleration") || !strcmp(field, "vorticity")) {
        const tobi_float4 *v = &p->accel[i];
        out[0] = v->x; out[1] = v->y; out[2] = v->z;
    } else if (!strcmp(field, "pressure")) {
        const double x[3] = {p->position[i].x, p->position[i].y, p->position[i].z};
        out[0] = p->product[i] + tobi_system_hydrostatic(s, x);
    } else if (!strcmp(field, "density")) {
        out[0] = p->density[i]*s->fluid[p->fluid[i]].density;
    } else {
        out[0] = p->surface[i];
    }
}

/* Velocities of a body's particles: central difference of its motion in double; no motion is asked for times
   before 0. */
static tobi_status read_body_velocity(tobi_body *b, double t, double (*out)[3], tobi_error *err)
{
    const double half = 1e-5, before = fmax(t - half, 0);
    if (!b->motion) {
        memset(out, 0, (size_t)b->particle_count*sizeof *out);
        return TOBI_OK;
    }
    TOBI_TRY(tobi_body_place_particles(b, before, err));
    memcpy(out, b->particle, (size_t)b->particle_count*sizeof *out);
    TOBI_TRY(tobi_body_place_particles(b, t + half, err));
    for (int64_t i = 0; i < b->particle_count; i++)
        for (int a = 0; a < 3; a++) out[i][a] = (b->particle[i][a] - out[i][a])/(t + half - before);
    return TOBI_OK;
}

static tobi_status read_bodies(tobi_world *w, const char *field, int components, double *buffer,
                               tobi_error *err)
{
    int64_t row = 0, id = tobi_world_first_id(w, &w->system[w->system_count]);
    for (int k = 0; k < w->sim.body_count; k++) {
        tobi_body *b = &w->sim.bodies[k];
        double *out = buffer + row*components;
        if (!strcmp(field, "velocity")) {
            TOBI_TRY(read_body_velocity(b, w->sim.time, (double (*)[3])(void *)out, err));
        } else if (!strcmp(field, "position")) {
            TOBI_TRY(tobi_body_place_particles(b, w->sim.time, err));
            memcpy(out, b->particle, (size_t)b->particle_count*sizeof *b->particle);
        } else {
            int number = !strcmp(field, "particle_id"), object = !strcmp(field, "object_id");
            for (int64_t i = 0; i < b->particle_count; i++)
                out[i] = number ? (double)(id + row + i) : object ? k + 1 : b->density;
        }
        row += b->particle_count;
    }
    return TOBI_OK;
}

static int has_field(const tobi_world *w, int owner)
{
    int has = 0;
    for (int k = 0; k < w->system_count; k++) has |= owner & (TOBI_ALL | w->system[k].method->fields);
    return has;
}

/* One particle; a field that its system does not have is 0. */
static void read_particle(const tobi_world *w, const tobi_system *s, const known_field *f, int64_t i,
                          double *out)
{
    if (!strcmp(f->name, "particle_id")) out[0] = (double)(tobi_world_first_id(w, s) + s->particles.id[i]);
    else if (!strcmp(f->name, "material")) out[0] = tobi_world_first_material(w, s) + s->particles.fluid[i];
    else if (!(f->owner & (TOBI_ALL | s->method->fields))) memset(out, 0, (size_t)f->components*sizeof *out);
    else if (!strcmp(f->name, "piece")) out[0] = w->pieces.of[i];
    else if (!strcmp(f->name, "texture_coordinates")) read_texture(w, s, i, out);
    else if (read_plain(s, f->name, i, out)) return;
    else if (s->method->read) s->method->read(s, f->name, i, out);
    else read_fluid(s, f->name, i, out);
}

typedef struct reading {
    const tobi_world *w;
    const tobi_system *s;
    const known_field *field;
    double *buffer;
} reading;

static void read_rows(const void *view, int64_t begin, int64_t end)
{
    const reading *r = view;
    for (int64_t k = begin; k < end; k++)
        read_particle(r->w, r->s, r->field, r->s->row_of[k], r->buffer + k*r->field->components);
}

static void read_system(const tobi_world *w, tobi_system *s, const known_field *f, double *buffer)
{
    const int derived = !strcmp(f->name, "acceleration") || !strcmp(f->name, "vorticity");
    if (w->failure.status != TOBI_DIVERGED && derived && s->method->derive) s->method->derive(s, f->name);
    const reading view = { w, s, f, buffer };
    tobi_loop(w->sim.exec.threads, s->particles.count, 0, read_rows, &view);
}

/* Finds a field by its name and checks that there is room for it. Then the rows are in order. */
static tobi_status find_field(tobi_world *w, tobi_set set, const char *field, const void *buffer,
                              int64_t count, int *number, tobi_error *err)
{
    int k = 0;
    TOBI_NEED_WORLD(w);
    TOBI_NEED(field, "the field");
    TOBI_NEED(buffer || count == 0, "the buffer");
    if (set != TOBI_FLUID && set != TOBI_BODIES)
        return tobi_fail(err, TOBI_INVALID, "there is no set of particles %d; allowed are TOBI_FLUID and "
                         "TOBI_BODIES", (int)set);
    const char *name = strcmp(field, "id") == 0 ? "particle_id" : field;
    while (k < FIELD_COUNT && strcmp(fields[k].name, name) != 0) k++;
    if (k == FIELD_COUNT) return tobi_fail(err, TOBI_NOT_FOUND, "there is no field '%s'", field);
    if (!has_field(w, fields[k].owner))
        return tobi_fail(err, TOBI_NOT_FOUND, "%s has no field '%s'", w->system[0].method->name, field);
    if (set == TOBI_BODIES && !fields[k].bodies)
        return tobi_fail(err, TOBI_NOT_FOUND, "bodies have no field '%s'", field);
    TOBI_TRY(tobi_world_start(w, err));
    if (count < tobi_world_count(w, set))
        return tobi_fail(err, TOBI_INVALID, "field '%s' has %lld rows, room for %lld given", field,
                         (long long)tobi_world_count(w, set), (long long)count);
    *number = k;
    return set == TOBI_FLUID ? tobi_world_refresh(w, err) : TOBI_OK;
}

tobi_status tobi_world_read_ids(tobi_world *w, tobi_set set, int64_t *buffer, int64_t count, tobi_error *err)
{
    int unused;
    TOBI_TRY(find_field(w, set, "id", buffer, count, &unused, err));
    const int64_t bodies = set == TOBI_BODIES ? tobi_world_count(w, set) : 0;
    for (int k = 0; k < w->system_count && set == TOBI_FLUID; k++) {
        const tobi_system *s = &w->system[k];
        for (int64_t r = 0; r < s->particles.count; r++)
            *buffer++ = tobi_world_first_id(w, s) + s->particles.id[s->row_of[r]];
    }
    for (int64_t r = 0; r < bodies; r++) buffer[r] = tobi_world_first_id(w, &w->system[w->system_count]) + r;
    return TOBI_OK;
}

tobi_status tobi_world_read(tobi_world *w, tobi_set set, const char *name, double *buffer, int64_t count,
                            tobi_error *err)
{
    int number;
    TOBI_TRY(find_field(w, set, name, buffer, count, &number, err));
    const char *field = fields[number].name;
    const int components = fields[number].components;
    if (set == TOBI_BODIES) return read_bodies(w, field, components, buffer, err);
    const tobi_pieces *unused;
    if (!strcmp(field, "piece")) TOBI_TRY(tobi_world_pieces(w, &unused, err));
    if (!strcmp(field, "texture_coordinates")) TOBI_TRY(tobi_world_find_texture(w, err));
    for (int n = 0; n < w->system_count; n++) {
        read_system(w, &w->system[n], &fields[number], buffer);
        buffer += w->system[n].particles.count*components;
    }
    return TOBI_OK;
}

/* Of "velocity" or "pressure"; before any of them is taken. */
static tobi_status check_values(const char *field, const double *v, int64_t count, int components,
                                tobi_error *err)
{
    const double most = components == 3 ? TOBI_SPEED_LIMIT : 1e30;
    for (int64_t k = 0; k < count*components; k++)
        if (!(fabs(v[k]) <= most))
            return tobi_fail(err, TOBI_INVALID, "row %lld of field '%s' holds %g; allowed is %g to %g",
                             (long long)(k/components), field, v[k], -most, most);
    return TOBI_OK;
}

static void write_velocity(tobi_system *s, const double *v)
{
    double fastest = 0, *memory;
    for (int64_t r = 0; r < s->particles.count; r++, v += 3) {
        s->particles.velocity[s->row_of[r]] = (tobi_float4){(float)v[0], (float)v[1], (float)v[2], 0};
        fastest = fmax(fastest, v[0]*v[0] + v[1]*v[1] + v[2]*v[2]);
    }
    s->method->memory(s, &memory);
    memory[0] = s->start_speed = sqrt(fastest);
}

static void write_pressure(tobi_system *s, const double *pressure)
{
    for (int64_t r = 0; r < s->particles.count; r++) s->particles.pressure[s->row_of[r]] = (float)pressure[r];
}

tobi_status tobi_world_write(tobi_world *w, const char *field, const double *buffer, int64_t count,
                             tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(field, "the field");
    TOBI_NEED(buffer || count == 0, "the buffer");
    int velocity = strcmp(field, "velocity") == 0;
    if (!velocity && strcmp(field, "pressure") != 0)
        return tobi_fail(err, TOBI_INVALID,
                         "field '%s' cannot be set; allowed are velocity and pressure", field);
    TOBI_TRY(tobi_world_refresh(w, err));
    if (!velocity && !tobi_world_fluids(w))
        return tobi_fail(err, TOBI_NOT_FOUND, "%s has no field '%s'", w->system[0].method->name, field);
    if (count != tobi_world_count(w, TOBI_FLUID))
        return tobi_fail(err, TOBI_INVALID, "field '%s' has %lld rows, %lld given", field,
                         (long long)tobi_world_count(w, TOBI_FLUID), (long long)count);
    TOBI_TRY(check_values(field, buffer, count, velocity ? 3 : 1, err));
    for (int k = 0; k < w->system_count; k++) {
        if (velocity) write_velocity(&w->system[k], buffer);
        else if (w->system[k].particles.pressure) write_pressure(&w->system[k], buffer);
        buffer += w->system[k].particles.count*(velocity ? 3 : 1);
    }
    w->fresh = 0;
    return TOBI_OK;
}

tobi_status tobi_world_surface(const tobi_world *w, int body, int64_t *vertex_count,
                               const double (**vertices)[3], int64_t *triangle_count,
                               const int32_t (**triangles)[3])
{
    if (!w || !vertex_count || !vertices || !triangle_count || !triangles) return TOBI_INVALID;
    if (body < 0 || body >= w->sim.body_count) return TOBI_NOT_FOUND;
    tobi_body *b = &w->sim.bodies[body];
    /* `next` is free between steps: it holds the pose in world coordinates. */
    for (int64_t i = 0; i < b->mesh.vertex_count; i++)
        for (int a = 0; a < 3; a++) b->next[i][a] = b->vertex[i][a] + b->lower[a];
    *vertex_count = b->mesh.vertex_count;
    *vertices = (const double (*)[3])b->next;
    *triangle_count = b->mesh.triangle_count;
    *triangles = (const int32_t (*)[3])b->mesh.triangles;
    return TOBI_OK;
}

void tobi_world_free_grid(tobi_world *w)
{
    free(w->grid.position);
    free(w->grid.velocity);
    free(w->grid.mass);
    free(w->grid.stress);
    w->grid = (tobi_grid){ 0 };
}

tobi_status tobi_world_grid(tobi_world *w, const tobi_grid **grid, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(grid, "where the grid goes");
    tobi_system *s = tobi_world_solids(w);
    *grid = &w->grid;
    if (!s) return tobi_fail(err, TOBI_UNSUPPORTED, "%s has no grid", w->system[0].method->name);
    TOBI_TRY(tobi_world_start(w, err));
    tobi_world_free_grid(w);
    TOBI_TRY(s->method->nodes(s, &w->grid, err));
    for (int64_t k = 0; k < w->grid.count; k++)
        for (int a = 0; a < 3; a++) w->grid.position[k][a] += s->box.lower[a];
    return TOBI_OK;
}

static uint64_t mix(uint64_t h, const void *data, size_t bytes)
{
    const unsigned char *p = data;
    for (size_t k = 0; k < bytes; k++) h = (h ^ p[k])*1099511628211u;   /* FNV-1a */
    return h;
}

static uint64_t mix_system(uint64_t h, const tobi_system *s)
{
    const tobi_particles *p = &s->particles;
    for (int64_t r = 0; r < p->count; r++) {
        int64_t i = s->row_of[r];
        h = mix(h, &p->position[i], sizeof p->position[i]);
        h = mix(h, &p->velocity[i], 3*sizeof(float));
        if (p->pressure) h = mix(h, &p->pressure[i], sizeof p->pressure[i]);
        if (p->strain) h = mix(h, &p->strain[i], sizeof p->strain[i]);
    }
    return h;
}

uint64_t tobi_world_hash(tobi_world *w)
{
    uint64_t h = 14695981039346656037u;
    if (!w || tobi_world_refresh(w, NULL) != TOBI_OK) return 0;
    h = mix(h, &w->sim.time, sizeof w->sim.time);
    for (int k = 0; k < w->system_count; k++) h = mix_system(h, &w->system[k]);
    for (int k = 0; k < w->sim.body_count; k++) {
        const tobi_rigid *r = &w->sim.bodies[k].rigid;
        if (r->kind != TOBI_PRESCRIBED) h = mix(h, TOBI_RIGID_STATE(r), TOBI_RIGID_DOUBLES*sizeof(double));
    }
    return h;
}
