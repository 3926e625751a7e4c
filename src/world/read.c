/* Reading a world: fields in id order, surfaces, the state hash. */
#include "base/error.h"
#include "core/cuts.h"
#include "world/world.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* owner: which methods have it; bodies: whether their particles have it too. Of 6: xx, yy, zz, xy, yz, zx, as
   ParaView names them; of 9: by rows. */
static const struct { const char *name; int components; const char *unit; int owner, bodies; } fields[] = {
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
    if (set == TOBI_FLUID) return w->sim.particles.count;
    int64_t n = 0;
    for (int k = 0; k < w->sim.body_count; k++) n += w->sim.bodies[k].particle_count;
    return n;
}

/* Ids go up to the capacity; those of particles that have left are passed over. */
static void order_rows(tobi_world *w)
{
    const tobi_particles *p = &w->sim.particles;
    int64_t n = 0;
    if (p->count < p->capacity) memset(w->row_of, -1, (size_t)p->capacity*sizeof *w->row_of);
    for (int64_t i = 0; i < p->count; i++) w->row_of[p->id[i]] = (int32_t)i;
    if (p->count == p->capacity) return;
    for (int64_t id = 0; id < p->capacity; id++)
        if (w->row_of[id] >= 0) w->row_of[n++] = w->row_of[id];
}

tobi_status tobi_world_refresh(tobi_world *w, tobi_error *err)
{
    tobi_simulation *s = &w->sim;
    TOBI_TRY(tobi_world_start(w, err));
    if (w->fresh) return TOBI_OK;
    tobi_pieces_free(&w->pieces);
    tobi_step_info kept = s->info;
    if (!w->diverged && w->method->refresh) TOBI_TRY(w->method->refresh(s, w->method_state, err));
    double mean = s->info.density_error_mean, max = s->info.density_error_max;
    s->info = kept;
    s->info.density_error_mean = mean;
    s->info.density_error_max = max;
    order_rows(w);
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
static int read_plain(const tobi_simulation *s, const char *field, int64_t i, double *out)
{
    const tobi_particles *p = &s->particles;
    if (!strcmp(field, "position")) {
        out[0] = p->position[i].x + s->box.lower[0];
        out[1] = p->position[i].y + s->box.lower[1];
        out[2] = p->position[i].z + s->box.lower[2];
    } else if (!strcmp(field, "velocity")) {
        const tobi_float4 *v = &p->velocity[i];
        out[0] = v->x; out[1] = v->y; out[2] = v->z;
    } else if (!strcmp(field, "particle_id")) {
        out[0] = (double)p->id[i];
    } else if (!strcmp(field, "object_id")) {
        out[0] = 0;      /* of every fluid and solid; bodies count from 1 */
    } else if (!strcmp(field, "cut_side")) {
        out[0] = latest_cut(p, i);
    } else return 0;
    return 1;
}

/* 0 where no mesh has any. */
static void read_texture(const tobi_world *w, int64_t i, double *out)
{
    for (int c = 0; c < 2; c++) out[c] = w->texture ? w->texture[w->sim.particles.id[i]][c] : 0;
}

static void read_fluid(const tobi_simulation *s, const char *field, int64_t i, double *out)
{
    const tobi_particles *p = &s->particles;
    if (!strcmp(field, "acceleration") || !strcmp(field, "vorticity")) {
        const tobi_float4 *v = &p->accel[i];
        out[0] = v->x; out[1] = v->y; out[2] = v->z;
    } else if (!strcmp(field, "pressure")) {
        const double x[3] = {p->position[i].x, p->position[i].y, p->position[i].z};
        out[0] = p->product[i] + tobi_simulation_hydrostatic(s, x);
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
    int64_t row = 0, id = w->sim.particles.capacity;
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

tobi_status tobi_world_read(tobi_world *w, tobi_set set, const char *field, double *buffer,
                            int64_t count, tobi_error *err)
{
    int k = 0, components = 0;
    TOBI_NEED_WORLD(w);
    TOBI_NEED(field, "the field");
    TOBI_NEED(buffer || count == 0, "the buffer");
    if (set != TOBI_FLUID && set != TOBI_BODIES)
        return tobi_fail(err, TOBI_INVALID, "there is no set of particles %d; allowed are TOBI_FLUID and "
                         "TOBI_BODIES", (int)set);
    while (k < FIELD_COUNT && strcmp(fields[k].name, field) != 0) k++;
    if (k == FIELD_COUNT) return tobi_fail(err, TOBI_NOT_FOUND, "there is no field '%s'", field);
    if (!(fields[k].owner & (TOBI_ALL | w->method->fields)))
        return tobi_fail(err, TOBI_NOT_FOUND, "%s has no field '%s'", w->method->name, field);
    if (set == TOBI_BODIES && !fields[k].bodies)
        return tobi_fail(err, TOBI_NOT_FOUND, "bodies have no field '%s'", field);
    components = fields[k].components;
    TOBI_TRY(tobi_world_start(w, err));
    if (count < tobi_world_count(w, set))
        return tobi_fail(err, TOBI_INVALID, "field '%s' has %lld rows, room for %lld given", field,
                         (long long)tobi_world_count(w, set), (long long)count);
    if (set == TOBI_BODIES) return read_bodies(w, field, components, buffer, err);
    TOBI_TRY(tobi_world_refresh(w, err));
    const tobi_pieces *unused;
    const int piece = !strcmp(field, "piece");
    if (piece) TOBI_TRY(tobi_world_pieces(w, &unused, err));
    int derived = !strcmp(field, "acceleration") || !strcmp(field, "vorticity");
    if (!w->diverged && derived && w->method->derive)
        w->method->derive(&w->sim, w->method_state, field);
    int textures = !strcmp(field, "texture_coordinates");
    if (textures) TOBI_TRY(tobi_world_find_texture(w, err));
    #pragma omp parallel for num_threads(w->sim.exec.threads)
    for (int64_t r = 0; r < w->sim.particles.count; r++) {
        double *out = buffer + r*components;
        if (piece) out[0] = w->pieces.of[w->row_of[r]];
        else if (textures) read_texture(w, w->row_of[r], out);
        if (piece || textures) continue;
        if (read_plain(&w->sim, field, w->row_of[r], out)) continue;
        if (w->method->read) w->method->read(&w->sim, w->method_state, field, w->row_of[r], out);
        else read_fluid(&w->sim, field, w->row_of[r], out);
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
    tobi_particles *p = &w->sim.particles;
    if (!velocity && !p->pressure)
        return tobi_fail(err, TOBI_NOT_FOUND, "%s has no field '%s'", w->method->name, field);
    if (count != p->count)
        return tobi_fail(err, TOBI_INVALID, "field '%s' has %lld rows, %lld given", field,
                         (long long)p->count, (long long)count);
    double fastest = 0;
    TOBI_TRY(check_values(field, buffer, count, velocity ? 3 : 1, err));
    for (int64_t r = 0; r < count; r++) {
        const double *v = buffer + r*(velocity ? 3 : 1);
        int64_t i = w->row_of[r];
        if (!velocity) {
            p->pressure[i] = (float)v[0];
            continue;
        }
        p->velocity[i] = (tobi_float4){(float)v[0], (float)v[1], (float)v[2], 0};
        fastest = fmax(fastest, v[0]*v[0] + v[1]*v[1] + v[2]*v[2]);
    }
    double *memory;
    w->method->memory(w->method_state, &memory);
    if (velocity) memory[0] = w->sim.start_speed = sqrt(fastest);
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
    tobi_simulation *s = &w->sim;
    *grid = &w->grid;
    if (!w->method->nodes) return tobi_fail(err, TOBI_UNSUPPORTED, "%s has no grid", w->method->name);
    TOBI_TRY(tobi_world_start(w, err));
    tobi_world_free_grid(w);
    TOBI_TRY(w->method->nodes(s, w->method_state, &w->grid, err));
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

uint64_t tobi_world_hash(tobi_world *w)
{
    uint64_t h = 14695981039346656037u;
    if (!w || tobi_world_refresh(w, NULL) != TOBI_OK) return 0;
    const tobi_particles *p = &w->sim.particles;
    h = mix(h, &w->sim.time, sizeof w->sim.time);
    for (int64_t r = 0; r < p->count; r++) {
        int64_t i = w->row_of[r];
        h = mix(h, &p->position[i], sizeof p->position[i]);
        h = mix(h, &p->velocity[i], 3*sizeof(float));
        if (p->pressure) h = mix(h, &p->pressure[i], sizeof p->pressure[i]);
        if (p->strain) h = mix(h, &p->strain[i], sizeof p->strain[i]);
    }
    for (int k = 0; k < w->sim.body_count; k++) {
        const tobi_rigid *r = &w->sim.bodies[k].rigid;
        if (r->kind != TOBI_PRESCRIBED) h = mix(h, TOBI_RIGID_STATE(r), TOBI_RIGID_DOUBLES*sizeof(double));
    }
    return h;
}
