/* Reading a world: fields in id order, surfaces, the state hash. */
#include "base/error.h"
#include "base/language.h"
#include "geom/vec3.h"
#include "world/step.h"
#include "world/scalars.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Fields for results that every method has; those of one method are in its `outputs`. */
static const tobi_output common[] = {
    { TR("position"), 3, "m", 0 }, { TR("velocity"), 3, "m/s", 0 }, { TR("pressure"), 1, "Pa", 0 },
    { TR("density"), 1, "kg/m3", 0 }, { TR("object_id"), 1, "1", 0 },
    { TR("particle_id"), 1, "1", 0 },
};
enum { COMMON = sizeof common/sizeof *common };

/* Field k of a method, NULL past the last. */
static const tobi_output *find_output(const tobi_method *m, int k)
{
    if (k < COMMON) return &common[k];
    for (const tobi_output *o = m->outputs; o && o->name; o++)
        if (k-- == COMMON) return o;
    return NULL;
}

static const tobi_output *find_name(const tobi_method *m, const char *name)
{
    const tobi_output *o;
    for (int k = 0; (o = find_output(m, k)); k++)
        if (strcmp(o->name, name) == 0) return o;
    return NULL;
}

/* Field number k of all methods: none is counted twice. */
static const tobi_output *find_any(int k)
{
    if (k < 0) return NULL;
    if (k < COMMON) return &common[k];
    k -= COMMON;
    for (int i = 0; tobi_method_at(i); i++)
        for (const tobi_output *o = tobi_method_at(i)->outputs; o && o->name; o++) {
            int before = 0;
            for (int j = 0; j < i; j++) before |= find_name(tobi_method_at(j), o->name) != NULL;
            if (!before && k-- == 0) return o;
        }
    return NULL;
}

const char *tobi_method_field(const char *method, int index)
{
    const tobi_method *m = tobi_method_find(method);
    const tobi_output *o = index < 0 ? NULL : m ? find_output(m, index) : find_any(index);
    return o ? o->name : NULL;
}

const char *tobi_world_field_name(int field, int *components, const char **unit)
{
    const tobi_output *o = find_any(field);
    if (!o) return NULL;
    if (components) *components = o->components;
    if (unit) *unit = o->unit;
    return o->name;
}

/* Behind the name of a field and "_"; -1: none of its components. */
static int find_component(const char *letters, int components)
{
    static const char *const three[] = { "x", "y", "z" };
    static const char *const six[] = { "xx", "yy", "zz", "xy", "yz", "zx" };
    static const char *const nine[] = { "xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz" };
    const char *const *names = components == 3 ? three : components == 6 ? six
                             : components == 9 ? nine : NULL;
    for (int k = 0; names && k < components; k++)
        if (strcmp(names[k], letters) == 0) return k;
    return components == 6 && strcmp(letters, "xz") == 0 ? 5 : -1;
}

const char *tobi_world_find_field(const char *name, int *component, const char **unit)
{
    const tobi_output *o;
    int part = -1, found = 0;
    for (int k = 0; name && !found && (o = find_any(k)); k++) {
        const size_t length = strlen(o->name);
        if (strncmp(name, o->name, length) != 0) continue;
        part = name[length] == '_' ? find_component(name + length + 1, o->components) : -1;
        found = name[length] == '\0' || part >= 0;
    }
    if (!found) return NULL;
    if (component) *component = part;
    if (unit) *unit = o->unit;
    return o->name;
}

void tobi_field_label(const char *name, char *text, size_t size)
{
    static const char speed[] = TR("speed");
    const char *unit = NULL;
    const char *field = name && strcmp(name, speed) == 0 ? speed : tobi_world_find_field(name, NULL, &unit);
    const char *part = field ? name + strlen(field) : "", *shown = field ? tr(field) : name ? name : "";
    if (!text || size == 0) return;
    if (field == speed) unit = "m/s";
    const int bare = !unit || strcmp(unit, "1") == 0;
    /* A component of a field that has a name in another language stands apart from it. */
    if (*part && shown != field) snprintf(text, size, bare ? "%s %s" : "%s %s [%s]", shown, part + 1, unit);
    else snprintf(text, size, bare ? "%s%s" : "%s%s [%s]", shown, part, unit);
}

int tobi_body_has_field(int field)
{
    return field >= 0 && field < COMMON && strcmp(common[field].name, "pressure") != 0;
}

int64_t tobi_world_count(const tobi_world *w, tobi_set set)
{
    if (!w) return 0;
    int64_t n = 0;
    for (int k = 0; set == TOBI_FLUID && k < w->system_count; k++) n += w->system[k].particles.count;
    if (set == TOBI_FLUID) return n;
    for (int k = 0; k < w->sim.body_count; k++) n += w->sim.bodies[k].particle_count;
    return n;
}

static tobi_status order_rows(tobi_system *s, tobi_error *err)
{
    const int64_t n = s->particles.count;
    if (s->row_capacity < n) {
        free(s->row_of);
        s->row_capacity = n + n/8;
        s->row_of = malloc((size_t)s->row_capacity*sizeof *s->row_of);
    }
    int32_t *spare = malloc((size_t)(n + 1)*sizeof *spare);
    if (spare && (s->row_of || n == 0)) tobi_particles_order(&s->particles, s->row_of, spare);
    else s->row_capacity = 0;
    free(spare);
    return spare && (s->row_of || n == 0)
               ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld rows", (long long)n);
}

static tobi_status refresh_system(tobi_world *w, tobi_system *s, tobi_error *err)
{
    const tobi_step_info kept = s->info;
    if (w->failure.status != TOBI_DIVERGED && s->method->refresh) TOBI_TRY(s->method->refresh(s, err));
    const double mean = s->info.density_error_mean, max = s->info.density_error_max;
    s->info = kept;
    s->info.density_error_mean = mean;
    s->info.density_error_max = max;
    return order_rows(s, err);
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

/* A field that no method knows more of; 0 if it is none of them. */
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
    } else return 0;
    return 1;
}

/* 0 where no mesh has any. */
static void read_texture(const tobi_world *w, const tobi_system *s, int64_t i, double *out)
{
    for (int c = 0; c < 2; c++) out[c] = w->texture ? w->texture[s->particles.id[i]][c] : 0;
}

/* The mean shift and turn that particles make by `way` about `centre`. */
static void find_rigid_part(const tobi_body *b, const double (*way)[3], double shift[3], double turn[3])
{
    double moment[3] = { 0 }, inertia[9] = { 0 }, inverse[9], arm[3], lever[3];
    const int64_t n = b->particle_count;
    memset(shift, 0, 3*sizeof *shift);
    memset(turn, 0, 3*sizeof *turn);
    for (int64_t i = 0; i < n; i++) {
        vec3_add_scaled(shift, shift, 1.0/(double)n, way[i]);
        vec3_sub(arm, b->particle[i], b->centre);
        vec3_cross(lever, arm, way[i]);
        vec3_add_scaled(moment, moment, 1, lever);
        for (int k = 0; k < 9; k++)
            inertia[k] += (k%4 ? 0 : vec3_dot(arm, arm)) - arm[k/3]*arm[k%3];
    }
    if (!tobi_rigid_invert(inertia, inverse)) return;
    for (int a = 0; a < 3; a++) turn[a] = vec3_dot(inverse + 3*a, moment);
}

/* Of a swimmer: the change of its shape, less what of it is a shift and a turn, and the rigid velocities. */
static tobi_status read_swimmer_velocity(tobi_body *b, double t, double (*out)[3], tobi_error *err)
{
    const double span = 1e-5;
    double shift[3], turn[3];
    TOBI_TRY(tobi_body_place_particles(b, t + span, err));
    memcpy(out, b->particle, (size_t)b->particle_count*sizeof *out);
    TOBI_TRY(tobi_body_place_particles(b, t, err));
    for (int64_t i = 0; i < b->particle_count; i++) vec3_sub(out[i], out[i], b->particle[i]);
    find_rigid_part(b, (const double (*)[3])out, shift, turn);
    for (int64_t i = 0; i < b->particle_count; i++) {
        double arm[3], spin[3], turning[3];
        vec3_sub(arm, b->particle[i], b->centre);
        vec3_add_scaled(spin, b->rigid.angular_velocity, -1/span, turn);
        vec3_cross(turning, spin, arm);
        for (int a = 0; a < 3; a++)
            out[i][a] = (out[i][a] - shift[a])/span + b->rigid.velocity[a] + turning[a];
    }
    return TOBI_OK;
}

/* Of a body without a motion: its velocity and its turn, both 0 of a fixed one. */
static tobi_status read_rigid_velocity(tobi_body *b, double t, double (*out)[3], tobi_error *err)
{
    TOBI_TRY(tobi_body_place_particles(b, t, err));
    for (int64_t i = 0; i < b->particle_count; i++) {
        double arm[3];
        vec3_sub(arm, b->particle[i], b->centre);
        vec3_cross(out[i], b->rigid.angular_velocity, arm);
        for (int a = 0; a < 3; a++) out[i][a] += b->rigid.velocity[a];
    }
    return TOBI_OK;
}

/* Velocities of a body's particles: central difference of its motion in double; no motion is asked for times
   before 0. */
static tobi_status read_body_velocity(tobi_body *b, double t, double (*out)[3], tobi_error *err)
{
    const double half = 1e-5, before = fmax(t - half, 0);
    if (b->swimmer) return read_swimmer_velocity(b, t, out, err);
    if (!b->motion) return read_rigid_velocity(b, t, out, err);
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
    int64_t row = 0, id = w->sim.body_first_id;
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

/* The field of the first system that has it, NULL without. */
static const tobi_output *find_in_world(const tobi_world *w, const char *name)
{
    for (int k = 0; k < w->system_count; k++) {
        const tobi_output *o = find_name(w->system[k].method, name);
        if (o) return o;
    }
    return NULL;
}

/* The array of a method's state field and the bytes of its rows; NULL and 0 without. */
static void *find_state(const tobi_particles *p, const char *name, size_t *bytes)
{
    void *data;
    const tobi_field *f;
    for (int k = 0; (f = tobi_particles_state(p, k, &data)) && strcmp(f->name, name) != 0;) k++;
    *bytes = f ? f->bytes : 0;
    return data;
}

/* An output that is a state field of floats or doubles; 0 if there is none. */
static void read_state(const tobi_system *s, const tobi_output *output, int64_t i, double *out)
{
    size_t bytes;
    const void *data = find_state(&s->particles, output->name, &bytes);
    for (int c = 0; c < output->components; c++) {
        const int64_t k = i*output->components + c;
        const int is_float = bytes == (size_t)output->components*sizeof(float);
        out[c] = !data ? 0 : is_float ? ((const float *)data)[k] : ((const double *)data)[k];
    }
}

/* Of a world that has diverged nothing is refreshed, because neighbours may be anywhere: what a refresh makes
   is not there. */
static int is_stale(const tobi_world *w, const tobi_system *s)
{
    return w->failure.status == TOBI_DIVERGED && s->method->refresh;
}

/* One particle; a field that its system does not have is 0. */
static void read_particle(const tobi_world *w, const tobi_system *s, const tobi_output *f, int64_t i,
                          double *out)
{
    if (!strcmp(f->name, "particle_id")) out[0] = (double)(s->first_id + s->particles.id[i]);
    else if (!strcmp(f->name, "material")) out[0] = tobi_world_first_material(w, s) + s->particles.fluid[i];
    else if (!find_name(s->method, f->name)) memset(out, 0, (size_t)f->components*sizeof *out);
    else if (!strcmp(f->name, "piece")) out[0] = w->pieces.of[i];
    else if (!strcmp(f->name, "texture_coordinates")) read_texture(w, s, i, out);
    else if (read_plain(s, f->name, i, out)) return;
    else if (!s->method->read) read_state(s, f, i, out);
    else if (!is_stale(w, s)) s->method->read(s, f->name, i, out);
    else for (int c = 0; c < f->components; c++) out[c] = NAN;
}

typedef struct reading {
    const tobi_world *w;
    const tobi_system *s;
    const tobi_output *field;
    double *buffer;
} reading;

static void read_rows(const void *view, int64_t begin, int64_t end)
{
    const reading *r = view;
    for (int64_t k = begin; k < end; k++)
        read_particle(r->w, r->s, r->field, r->s->row_of[k], r->buffer + k*r->field->components);
}

static void read_system(const tobi_world *w, tobi_system *s, const tobi_output *f, double *buffer)
{
    const tobi_output *own = find_name(s->method, f->name);
    if (w->failure.status != TOBI_DIVERGED && own && own->derived) s->method->derive(s, f->name);
    const reading view = { w, s, f, buffer };
    tobi_loop(w->sim.exec.threads, s->particles.count, 0, read_rows, &view);
}

/* Finds a field by its name and checks that there is room for it. Then the rows are in order. */
static tobi_status find_field(tobi_world *w, tobi_set set, const char *field, int64_t count,
                              const tobi_output **found, tobi_error *err)
{
    if (set != TOBI_FLUID && set != TOBI_BODIES)
        return tobi_fail(err, TOBI_INVALID, "there is no set of particles %d; allowed are TOBI_FLUID and "
                         "TOBI_BODIES", (int)set);
    const char *name = strcmp(field, "id") == 0 ? "particle_id" : field;
    const tobi_output *known = NULL;
    int k = 0;
    while ((known = find_any(k)) && strcmp(known->name, name) != 0) k++;
    if (!known) return tobi_fail(err, TOBI_NOT_FOUND, "there is no field '%s'", field);
    *found = find_in_world(w, name);
    TOBI_TRY(tobi_scalars_know(w, name, err));
    if (!*found)
        return tobi_fail(err, TOBI_NOT_FOUND, "%s has no field '%s'", w->system[0].method->name, field);
    if (set == TOBI_BODIES && !tobi_body_has_field(k))
        return tobi_fail(err, TOBI_NOT_FOUND, "bodies have no field '%s'", field);
    TOBI_TRY(tobi_world_start(w, err));
    if (count < tobi_world_count(w, set))
        return tobi_fail(err, TOBI_INVALID, "field '%s' has %lld rows, room for %lld given", field,
                         (long long)tobi_world_count(w, set), (long long)count);
    return set == TOBI_FLUID ? tobi_world_refresh(w, err) : TOBI_OK;
}

tobi_status tobi_world_read_ids(tobi_world *w, tobi_set set, int64_t *buffer, int64_t count, tobi_error *err)
{
    const tobi_output *unused;
    TOBI_NEED_WORLD(w);
    TOBI_NEED(buffer || count == 0, "the buffer");
    TOBI_TRY(find_field(w, set, "id", count, &unused, err));
    const int64_t bodies = set == TOBI_BODIES ? tobi_world_count(w, set) : 0;
    for (int k = 0; k < w->system_count && set == TOBI_FLUID; k++) {
        const tobi_system *s = &w->system[k];
        for (int64_t r = 0; r < s->particles.count; r++)
            *buffer++ = s->first_id + s->particles.id[s->row_of[r]];
    }
    for (int64_t r = 0; r < bodies; r++) buffer[r] = w->sim.body_first_id + r;
    return TOBI_OK;
}

tobi_status tobi_world_read(tobi_world *w, tobi_set set, const char *name, double *buffer, int64_t count,
                            tobi_error *err)
{
    const tobi_output *found;
    TOBI_NEED_WORLD(w);
    TOBI_NEED(name, "the field");
    TOBI_NEED(buffer || count == 0, "the buffer");
    TOBI_TRY(find_field(w, set, name, count, &found, err));
    const char *field = found->name;
    const int components = found->components;
    if (set == TOBI_BODIES) return read_bodies(w, field, components, buffer, err);
    const tobi_pieces *unused;
    if (!strcmp(field, "piece")) TOBI_TRY(tobi_world_pieces(w, &unused, err));
    if (!strcmp(field, "texture_coordinates")) TOBI_TRY(tobi_world_find_texture(w, err));
    for (int n = 0; n < w->system_count; n++) {
        read_system(w, &w->system[n], found, buffer);
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
    tobi_system_memory(s, &memory);
    memory[0] = s->start_speed = sqrt(fastest);
}

static void write_pressure(tobi_system *s, const double *pressure)
{
    size_t bytes;
    float *to = find_state(&s->particles, "pressure", &bytes);
    for (int64_t r = 0; to && r < s->particles.count; r++) to[s->row_of[r]] = (float)pressure[r];
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
        else write_pressure(&w->system[k], buffer);
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
    *vertex_count = b->is_absent ? 0 : b->mesh.vertex_count;
    *vertices = (const double (*)[3])b->next;
    *triangle_count = b->is_absent ? 0 : b->mesh.triangle_count;
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
    size_t pressure_row, strain_row;
    const char *pressure = find_state(p, "pressure", &pressure_row);
    const char *strain = find_state(p, "strain", &strain_row);
    for (int64_t r = 0; r < p->count; r++) {
        int64_t i = s->row_of[r];
        h = mix(h, &p->position[i], sizeof p->position[i]);
        h = mix(h, &p->velocity[i], 3*sizeof(float));
        h = mix(h, pressure + (size_t)i*pressure_row, pressure_row);
        h = mix(h, strain + (size_t)i*strain_row, strain_row);
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
        if (r->finer_by) h = mix(h, r->finer, sizeof r->finer);
        double kept = 0;        /* a body without a program has the hash that it always had */
        for (int n = 0; n < TOBI_CONTROL_STATE; n++) kept += fabs(r->memory[n]);
        if (kept > 0) h = mix(h, r->memory, sizeof r->memory);
    }
    return h;
}
