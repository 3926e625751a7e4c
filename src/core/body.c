/* A body becomes quadrature points on its mesh, which move with the triangles they lie on, so that
   deforming and rigid bodies are one case. Drawback: points are equally fine on flat and on curved
   parts. */
#include "core/body.h"
#include "base/error.h"
#include "geom/vec3.h"
#include "geom/vessel.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Spacings: walls of vessels that have none, if nothing else is asked for. */
static const double VESSEL_WALLS = 2;

static tobi_status allocate(tobi_body *b, tobi_error *err)
{
    size_t v = (size_t)b->mesh.vertex_count, n = (size_t)b->surface.count, p = (size_t)b->particle_count;
    void **arrays[] = {(void **)&b->vertex,          (void **)&b->next,
                       (void **)&b->vertex_velocity, (void **)&b->vertex_before,
                       (void **)&b->point_before, (void **)&b->piece,
                       (void **)&b->piece_normal,    (void **)&b->piece_velocity,
                       (void **)&b->point,           (void **)&b->normal,
                       (void **)&b->point_velocity,  (void **)&b->particle};
    size_t rows[] = {v, v, v, v, n, n, n, n, n, n, n, p};
    int failed = 0;
    for (size_t k = 0; k < sizeof rows/sizeof *rows; k++) {
        *arrays[k] = calloc(rows[k] + 1, 3*sizeof(double));
        failed |= !*arrays[k];
    }
    b->piece_area = calloc(n + 1, sizeof *b->piece_area);
    b->area = calloc(n + 1, sizeof *b->area);
    b->weight = calloc(n + 1, sizeof *b->weight);
    b->wet = calloc(n + 1, sizeof *b->wet);
    b->covered = calloc(n + 1, sizeof *b->covered);
    b->outermost = calloc(n + 1, sizeof *b->outermost);
    b->point_of = calloc(n + 1, sizeof *b->point_of);
    failed |= !b->piece_area || !b->area || !b->weight || !b->wet || !b->covered || !b->outermost ||
              !b->point_of;
    if (!failed) return TOBI_OK;
    return tobi_fail(err, TOBI_NO_MEMORY, "body '%s': no memory for %zu surface points", b->name, n);
}

/* A piece's cell of the rest pose and the side its normal looks to. */
typedef struct piece_key { int32_t cell[3], side, piece; } piece_key;

static int compare_keys(const void *a, const void *b)
{
    const piece_key *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p->cell[k] != q->cell[k]) return p->cell[k] < q->cell[k] ? -1 : 1;
    if (p->side != q->side) return p->side < q->side ? -1 : 1;
    return p->piece < q->piece ? -1 : p->piece > q->piece;
}

/* Where parts of the mesh overlap, pieces with the same side of the surface before and behind them are
   no boundary of the body: they go. Judged once, in the pose the body starts in. */
static void drop_inner_pieces(tobi_body *b, double width)
{
    tobi_quadrature *s = &b->surface;
    int64_t kept = 0;
    if (!b->mesh.overlapping) return;
    tobi_bvh_use_winding(b->bvh);
    tobi_quadrature_update(s, (const double(*)[3])b->vertex, (const int32_t(*)[3])b->mesh.triangles, b->piece,
                        b->piece_normal, b->piece_area);
    for (int64_t i = 0; i < s->count; i++) {
        double before[3], behind[3];
        for (int a = 0; a < 3; a++) {
            before[a] = b->piece[i][a] + 1e-3*width*b->piece_normal[i][a];
            behind[a] = b->piece[i][a] - 1e-3*width*b->piece_normal[i][a];
        }
        if (tobi_bvh_inside(b->bvh, before) == tobi_bvh_inside(b->bvh, behind)) continue;
        tobi_quadrature_move(s, i, kept++);
    }
    s->count = kept;
}

/* Meshes finer than the fluid would cost more than they tell: pieces of one cell that face the same
   way become one quadrature point. */
static tobi_status group_pieces(tobi_body *b, double width, tobi_error *err)
{
    int64_t n = b->surface.count;
    piece_key *keys = malloc((size_t)(n + 1)*sizeof *keys);
    if (!keys)
        return tobi_fail(err, TOBI_NO_MEMORY, "body '%s': no memory for %lld surface pieces",
                         b->name, (long long)n);
    tobi_quadrature_update(&b->surface, (const double(*)[3])b->vertex,
                        (const int32_t(*)[3])b->mesh.triangles, b->piece, b->piece_normal,
                        b->piece_area);
    for (int64_t i = 0; i < n; i++) {
        const double *m = b->piece_normal[i];
        int axis = fabs(m[0]) >= fabs(m[1]) && fabs(m[0]) >= fabs(m[2]) ? 0
                   : fabs(m[1]) >= fabs(m[2])                           ? 1
                                                                        : 2;
        keys[i].side = 2*axis + (m[axis] > 0);
        keys[i].piece = (int32_t)i;
        for (int a = 0; a < 3; a++) keys[i].cell[a] = (int32_t)floor(b->piece[i][a]/width);
    }
    qsort(keys, (size_t)n, sizeof *keys, compare_keys);
    for (int64_t i = 0; i < n; i++) {
        int same = i > 0 && keys[i].side == keys[i - 1].side &&
                   memcmp(keys[i].cell, keys[i - 1].cell, sizeof keys[i].cell) == 0;
        if (!same) b->point_count++;
        b->point_of[keys[i].piece] = (int32_t)(b->point_count - 1);
    }
    free(keys);
    return TOBI_OK;
}

/* Sums value times area of the pieces of every point. */
static void gather_points(const tobi_body *b, const double (*value)[3], double (*out)[3])
{
    memset(out, 0, (size_t)b->point_count*sizeof *out);
    for (int64_t i = 0; i < b->surface.count; i++)
        for (int a = 0; a < 3; a++) out[b->point_of[i]][a] += b->piece_area[i]*value[i][a];
}

static void divide_by_weight(const tobi_body *b, double (*out)[3])
{
    for (int64_t k = 0; k < b->point_count; k++)
        for (int a = 0; a < 3; a++) out[k][a] = b->weight[k] > 0 ? out[k][a]/b->weight[k] : 0;
}

/* Points of a body that moves by forces, in a pose; out may be rest. */
static void pose_points(const tobi_body *b, const double centre[3], const double position[3],
                        const double orientation[4], int64_t n, const double (*rest)[3], double (*out)[3])
{
    double m[3][3];
    tobi_quaternion_matrix(orientation, m);
    for (int64_t i = 0; i < n; i++) {
        double arm[3];
        vec3_sub(arm, rest[i], centre);
        for (int a = 0; a < 3; a++) out[i][a] = b->lower[a] + (position[a] + vec3_dot(m[a], arm));
    }
}

void tobi_body_pose_shape(const tobi_body *b, int64_t n, double (*at)[3])
{
    pose_points(b, b->swimmer->centre, b->rigid.position, b->rigid.orientation, n, (const double (*)[3])at,
                at);
}

tobi_status tobi_body_locate(const tobi_body *b, double t, int64_t n, const double (*rest)[3],
                             double (*out)[3], tobi_error *err)
{
    if (b->rigid.kind != TOBI_PRESCRIBED && !b->swimmer) {
        pose_points(b, b->rest.centre, b->rigid.position, b->rigid.orientation, n, rest, out);
        return TOBI_OK;
    }
    if (!b->motion) {
        memcpy(out, rest, (size_t)n*sizeof *out);
        return TOBI_OK;
    }
    if (b->swimmer && b->steer) b->steer(b->motion_user, b->swimmer->steer);
    TOBI_TRY(tobi_body_ask_motion(b, t, n, rest, out, err));
    if (b->swimmer) tobi_body_pose_shape(b, n, out);
    return TOBI_OK;
}

tobi_status tobi_body_locate_start(const tobi_body *b, double t, int64_t n, const double (*rest)[3],
                                   double (*out)[3], tobi_error *err)
{
    const tobi_swimmer *w = b->swimmer;
    if (b->steer) b->steer(b->motion_user, w->start.steer);
    TOBI_TRY(tobi_body_ask_motion(b, t, n, rest, out, err));
    pose_points(b, w->start.centre, w->start.position, w->start.orientation, n, (const double (*)[3])out,
                out);
    return TOBI_OK;
}

/* Vertices at t relative to the box. */
static tobi_status move_vertices(const tobi_body *b, double t, double (*out)[3], tobi_error *err)
{
    TOBI_TRY(tobi_body_locate(b, t, b->mesh.vertex_count, (const double (*)[3])b->mesh.vertices, out, err));
    for (int64_t i = 0; i < b->mesh.vertex_count; i++)
        for (int a = 0; a < 3; a++) out[i][a] += (b->is_absent ? b->away[a] : 0) - b->lower[a];
    return TOBI_OK;
}

tobi_status tobi_body_place_within(tobi_body *b, double t, double way, double more, tobi_error *err)
{
    double frame[3][3];
    if (!b->motion) return TOBI_OK;
    TOBI_TRY(tobi_body_find_frame(b, t + way, b->rigid.position, frame, err));
    vec3_sub(b->rigid.position, b->rigid.position, b->lower);
    tobi_frame_quaternion((const double (*)[3])frame, b->rigid.orientation);
    if (!b->deforms) return TOBI_OK;
    for (int64_t i = 0; i < b->mesh.vertex_count; i++)
        vec3_add_scaled(b->vertex[i], b->vertex[i], more, b->vertex_velocity[i]);
    tobi_bvh_refit(b->bvh, (const double (*)[3])b->vertex);
    return TOBI_OK;
}

/* Of a body that moves by forces, by its orientation. */
static void turn_frame(tobi_body *b)
{
    double m[3][3];
    tobi_quaternion_matrix(b->rigid.orientation, m);
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < 3; a++) b->frame[k][a] = m[a][k];
}

void tobi_body_update_surface(tobi_body *b)
{
    tobi_bvh_refit(b->bvh, (const double (*)[3])b->vertex);
    tobi_quadrature_update(&b->surface, (const double(*)[3])b->vertex,
                        (const int32_t(*)[3])b->mesh.triangles, b->piece, b->piece_normal,
                        b->piece_area);
    memset(b->weight, 0, (size_t)b->point_count*sizeof *b->weight);
    for (int64_t i = 0; i < b->surface.count; i++) b->weight[b->point_of[i]] += b->piece_area[i];
    gather_points(b, (const double (*)[3])b->piece, b->point);
    divide_by_weight(b, b->point);
    gather_points(b, (const double (*)[3])b->piece_normal, b->normal);
    for (int64_t k = 0; k < b->point_count; k++) {
        double size = sqrt(b->normal[k][0] * b->normal[k][0] + b->normal[k][1] * b->normal[k][1] +
                           b->normal[k][2] * b->normal[k][2]);
        for (int a = 0; a < 3; a++) b->normal[k][a] = size > 0 ? b->normal[k][a]/size : 0;
        b->area[k] = size;
    }
}

/* Contact reads every body's pose and velocities from `rigid`, whatever moves it. */
static void mirror_motion(tobi_body *b)
{
    vec3_sub(b->rigid.position, b->centre, b->lower);
    memcpy(b->rigid.orientation, b->info.orientation, sizeof b->rigid.orientation);
    memcpy(b->rigid.velocity, b->info.velocity, sizeof b->rigid.velocity);
    memcpy(b->rigid.angular_velocity, b->info.angular_velocity, sizeof b->rigid.angular_velocity);
}

tobi_status tobi_body_place(tobi_body *b, double t, tobi_error *err)
{
    TOBI_TRY(move_vertices(b, t, b->vertex, err));
    tobi_body_update_surface(b);
    TOBI_TRY(tobi_body_find_frame(b, t, b->centre, b->frame, err));
    if (b->rigid.kind != TOBI_PRESCRIBED) {
        if (b->swimmer) turn_frame(b);
        tobi_body_report(b);
        return TOBI_OK;
    }
    memcpy(b->info.position, b->centre, sizeof b->centre);
    tobi_frame_quaternion((const double (*)[3])b->frame, b->info.orientation);
    mirror_motion(b);
    return TOBI_OK;
}

void tobi_body_restore(tobi_body *b, const double (*vertex)[3], const tobi_body_at *place)
{
    memcpy(b->vertex, vertex, (size_t)b->mesh.vertex_count*sizeof *b->vertex);
    tobi_body_find_absence(b);
    tobi_body_update_surface(b);
    memcpy(b->centre, place->centre, sizeof b->centre);
    memcpy(b->frame, place->frame, sizeof b->frame);
}

tobi_status tobi_body_place_particles(tobi_body *b, double t, tobi_error *err)
{
    return tobi_body_locate(b, t, b->particle_count, (const double (*)[3])b->particle_rest, b->particle, err);
}

/* Said before allocating: a spacing far below the mesh's size asks for more than the machine has. */
static tobi_status check_pieces(const tobi_body *b, double point_spacing, int dimension, tobi_error *err)
{
    double pieces = dimension == 3 ? 4 * b->rest.area / (point_spacing * point_spacing)
                                   : 2 * b->rest.area / point_spacing;
    double inside = fabs(b->rest.volume)/pow(b->spacing, dimension);
    double bytes = 200*pieces + 48*inside;
    double have = (double)sysconf(_SC_PHYS_PAGES)*(double)sysconf(_SC_PAGESIZE);
    if (bytes < 0.9*have) return TOBI_OK;
    return tobi_fail(
        err, TOBI_NO_MEMORY,
        "body '%s' at spacing %g m needs %.3g particles and %.3g surface points, about %.3g GiB; "
        "this machine has %.3g GiB. A larger spacing needs less",
        b->name, b->spacing, inside, pieces, bytes / 1073741824, have / 1073741824);
}

static tobi_status load_mesh(tobi_body *b, const tobi_body_def *def, const tobi_box *box,
                             double point_spacing, tobi_error *err)
{
    int dimension = box->dimension;
    char hint[200];
    b->vessel = def->vessel;
    b->sealed = def->sealed;
    TOBI_TRY(tobi_body_make_mesh(b, def, box, err));
    TOBI_TRY(tobi_mesh_transform(&b->mesh, def->scale, def->rotation_axis, def->rotation_angle,
                                 def->translation, err));
    if (tobi_mesh_hint_units(&b->mesh, dimension, box->size, hint, sizeof hint) > 0)
        return tobi_fail(err, TOBI_INVALID, "body '%s' does not fit: %s", b->name, hint);
    if (hint[0]) tobi_mesh_note(&b->mesh, "%s", hint);
    const char *name = def->mesh ? def->mesh : b->name;
    if (def->vessel)
        TOBI_TRY(tobi_mesh_make_vessel(&b->mesh, def->wall_thickness, VESSEL_WALLS*b->spacing,
                                       def->open_side, dimension, name, err));
    else TOBI_TRY(tobi_mesh_orient(&b->mesh, name, err));
    if (dimension == 3) TOBI_TRY(tobi_massprops_volume(&b->mesh, &b->rest, err));
    else TOBI_TRY(tobi_massprops_section(&b->mesh, &b->rest, err));
    tobi_body_take_centre(b, def, dimension);
    TOBI_TRY(check_pieces(b, point_spacing, dimension, err));
    if (!def->motion || def->motion_rigid) return TOBI_OK;
    return tobi_mesh_refine(&b->mesh, 3*b->spacing, err);
}

static void tell_size(tobi_body *b, int dimension)
{
    b->info.volume = b->rest.volume;
    b->info.mass = b->rigid.mass;
    memcpy(b->info.inertia, b->rigid.inertia, sizeof b->info.inertia);
    b->info.particles = b->particle_count;
    b->info.sampled_volume = (double)b->particle_count*pow(b->spacing, dimension);
}

tobi_status tobi_body_create(tobi_body *b, const tobi_body_def *def, const tobi_box *box,
                             double point_spacing, tobi_error *err)
{
    int dimension = box->dimension;
    memset(b, 0, sizeof *b);
    snprintf(b->name, sizeof b->name, "%s", def->name && def->name[0] ? def->name : "body");
    b->density = def->density;
    b->friction = def->friction;
    b->blade = def->blade;
    b->edge_resistance = def->edge_resistance;
    b->contact_cosine = cos(def->contact_angle*acos(-1)/180);
    b->visible = def->visible, b->opacity = def->opacity;
    memcpy(b->color, def->color, sizeof b->color);
    b->spacing = def->spacing > 0 ? def->spacing : 2*point_spacing;
    b->motion = def->motion;
    b->motion_user = def->motion_user;
    b->steer = def->motion_steer;
    b->deforms = def->motion && !def->motion_rigid;
    memcpy(b->lower, box->lower, sizeof b->lower);
    tobi_status status = load_mesh(b, def, box, point_spacing, err);
    if (status == TOBI_OK) {
        double centre[3];
        vec3_sub(centre, b->rest.centre, b->lower);
        status = tobi_rigid_init(&b->rigid, def, &b->rest, centre, dimension, err);
    }
    if (status == TOBI_OK)
        status = tobi_quadrature_build(&b->mesh, point_spacing, dimension, &b->surface, err);
    if (status == TOBI_OK)
        status = tobi_sample_volume(&b->mesh, NULL, b->spacing, dimension, &b->particle_rest,
                                    &b->particle_count, err);
    if (status == TOBI_OK) status = allocate(b, err);
    if (status == TOBI_OK) status = tobi_swimmer_create(b, dimension, err);
    if (status == TOBI_OK) status = move_vertices(b, 0, b->vertex, err);
    if (status == TOBI_OK)
        status = tobi_bvh_build(b->mesh.vertex_count, (const double(*)[3])b->vertex,
                                b->mesh.triangle_count, (const int32_t(*)[3])b->mesh.triangles,
                                &b->bvh, err);
    if (status == TOBI_OK) drop_inner_pieces(b, point_spacing);
    if (status == TOBI_OK) status = group_pieces(b, point_spacing, err);
    if (status == TOBI_OK) status = tobi_body_place(b, 0, err);
    if (status == TOBI_OK) status = tobi_body_find_edge(b, def, dimension, err);
    if (status != TOBI_OK) {
        tobi_body_free(b);
        return status;
    }
    tobi_body_find_outermost(b, point_spacing);
    tell_size(b, dimension);
    return TOBI_OK;
}

int64_t tobi_body_bytes(const tobi_body *b)
{
    const tobi_quadrature *q = &b->surface;
    const size_t place = sizeof *b->vertex;
    const size_t vertices = 1 + (b->vertex != NULL) + (b->next != NULL) + (b->vertex_velocity != NULL) +
                            (b->vertex_before != NULL) + (b->rest_vertex != NULL),
                 piece = sizeof *q->triangle + (1 + (q->b != NULL))*place + sizeof *q->fraction + 3*place +
                         sizeof *b->piece_area + sizeof *b->point_of,
                 point = 4*place + sizeof *b->wet + sizeof *b->covered + sizeof *b->outermost +
                         sizeof *b->area + sizeof *b->weight;
    return b->mesh.vertex_count*(int64_t)(vertices*place) +
           b->mesh.triangle_count*(int64_t)sizeof *b->mesh.triangles + q->count*(int64_t)piece +
           b->point_count*(int64_t)point + b->particle_count*(int64_t)(2*place) + tobi_bvh_bytes(b->bvh) +
           tobi_bvh_bytes(b->rest_bvh);
}

void tobi_body_free(tobi_body *b)
{
    tobi_mesh_free(&b->mesh);
    tobi_swimmer_free(b->swimmer);
    tobi_bvh_free(b->bvh);
    tobi_quadrature_free(&b->surface);
    free(b->vertex); free(b->next); free(b->vertex_velocity);
    free(b->vertex_before);
    free(b->point_before);
    free(b->piece); free(b->piece_normal); free(b->piece_velocity); free(b->piece_area); free(b->point_of);
    free(b->point); free(b->normal); free(b->point_velocity); free(b->area); free(b->weight); free(b->wet);
    free(b->covered); free(b->outermost);
    free(b->particle_rest); free(b->particle);
    free(b->rest_vertex);
    free(b->edge);
    free(b->edge_now);
    free(b->edge_share);
    free(b->edge_foot);
    tobi_bvh_free(b->rest_bvh);
    memset(b, 0, sizeof *b);
}

void tobi_body_place_next(tobi_body *b)
{
    const tobi_rigid *r = &b->rigid;
    const double (*shape)[3] = (const double (*)[3])(b->swimmer ? b->swimmer->shape : b->mesh.vertices);
    pose_points(b, b->swimmer ? b->swimmer->next_centre : b->rest.centre, r->next_position,
                r->next_orientation, b->mesh.vertex_count, shape, b->next);
    for (int64_t i = 0; i < b->mesh.vertex_count; i++) vec3_sub(b->next[i], b->next[i], b->lower);
}

void tobi_body_correct(tobi_body *b, const double velocity[3], const double spin[3], double dt)
{
    b->rigid.is_corrected = 1;
    tobi_rigid_drift_by(&b->rigid, velocity, spin, dt);
    tobi_body_place_next(b);
}

static void drive_points(const tobi_rigid *r, const double velocity[3], const double spin[3], int64_t n,
                         const double (*at)[3], double (*out)[3])
{
    for (int64_t i = 0; i < n; i++) {
        double arm[3], turning[3];
        vec3_sub(arm, at[i], r->position);
        vec3_cross(turning, spin, arm);
        vec3_add_scaled(out[i], velocity, 1, turning);
    }
}

static void add_flow(int64_t n, const double (*flow)[3], double (*out)[3])
{
    for (int64_t i = 0; i < n; i++) vec3_add_scaled(out[i], out[i], 1, flow[i]);
}

void tobi_body_carry(const tobi_body *b, const double place[3], const double u[6], double out[3])
{
    double arm[3];
    for (int a = 0; a < 3; a++) arm[a] = place[a] + b->lower[a] - b->centre[a];
    vec3_cross(out, u + 3, arm);
    for (int a = 0; a < 3; a++) out[a] += u[a];
}

void tobi_body_set_velocity(tobi_body *b, const double velocity[3], const double spin[3])
{
    memcpy(b->rigid.driven, velocity, 3*sizeof *velocity);
    memcpy(b->rigid.driven + 3, spin, 3*sizeof *spin);
    drive_points(&b->rigid, velocity, spin, b->mesh.vertex_count, (const double (*)[3])b->vertex,
                 b->vertex_velocity);
    drive_points(&b->rigid, velocity, spin, b->point_count, (const double (*)[3])b->point, b->point_velocity);
    if (!b->swimmer) return;
    add_flow(b->mesh.vertex_count, (const double (*)[3])b->swimmer->flow, b->vertex_velocity);
    add_flow(b->point_count, (const double (*)[3])b->swimmer->point_flow, b->point_velocity);
}

static void interpolate_points(tobi_body *b, const double (*vertex)[3], double (*point)[3])
{
    tobi_quadrature_interpolate(&b->surface, (const int32_t (*)[3])b->mesh.triangles, vertex,
                                b->piece_velocity);
    gather_points(b, (const double (*)[3])b->piece_velocity, point);
    divide_by_weight(b, point);
}

/* The drift of a free body, and the velocities its vertices have now. */
static tobi_status predict_free(tobi_body *b, double t, double dt, tobi_error *err)
{
    tobi_rigid *r = &b->rigid;
    if (b->swimmer) {
        TOBI_TRY(tobi_swimmer_predict(b, t, dt, err));
        interpolate_points(b, (const double (*)[3])b->swimmer->flow, b->swimmer->point_flow);
    }
    tobi_rigid_drift(r, dt);
    tobi_body_place_next(b);
    drive_points(r, r->velocity, r->angular_velocity, b->mesh.vertex_count, (const double (*)[3])b->vertex,
                 b->vertex_velocity);
    if (b->swimmer) add_flow(b->mesh.vertex_count, (const double (*)[3])b->swimmer->flow, b->vertex_velocity);
    return TOBI_OK;
}

tobi_status tobi_body_predict(tobi_body *b, double t, double dt, double *speed, tobi_error *err)
{
    tobi_body_follow_absence(b, t);
    if (!b->motion && b->rigid.kind == TOBI_PRESCRIBED) {
        memcpy(b->next, b->vertex, (size_t)b->mesh.vertex_count*sizeof *b->next);
        return TOBI_OK;
    }
    int prescribed = b->rigid.kind == TOBI_PRESCRIBED;
    if (prescribed) TOBI_TRY(move_vertices(b, t + dt, b->next, err));
    else TOBI_TRY(predict_free(b, t, dt, err));
    double fastest = 0;
    for (int64_t i = 0; i < b->mesh.vertex_count; i++) {
        for (int a = 0; a < 3 && prescribed; a++)
            b->vertex_velocity[i][a] = (b->next[i][a] - b->vertex[i][a])/dt;
        fastest = fmax(fastest, vec3_dot(b->vertex_velocity[i], b->vertex_velocity[i]));
    }
    fastest = sqrt(fastest);
    if (fastest > TOBI_SPEED_LIMIT)
        return tobi_fail(err, prescribed ? TOBI_INVALID : TOBI_DIVERGED, "body '%s' moves at %g m/s at "
                         "t = %.9g s; allowed are up to %g m/s", b->name, fastest, t, TOBI_SPEED_LIMIT);
    *speed = fmax(*speed, fastest);
    return TOBI_OK;
}

void tobi_body_set_point_velocities(tobi_body *b)
{
    interpolate_points(b, (const double (*)[3])b->vertex_velocity, b->point_velocity);
}

void tobi_body_set_previous_velocities(tobi_body *b)
{
    interpolate_points(b, (const double (*)[3])b->vertex_before, b->point_before);
}

static void swap_vertices(tobi_body *b)
{
    double (*swap)[3] = b->vertex;
    b->vertex = b->next;
    b->next = swap;
}

static void advance_free(tobi_body *b)
{
    tobi_rigid *r = &b->rigid;
    memcpy(r->position, r->next_position, sizeof r->position);
    memcpy(r->orientation, r->next_orientation, sizeof r->orientation);
    memset(r->push, 0, sizeof r->push);
    memset(r->turn, 0, sizeof r->turn);
    tobi_rigid_apply_locks(r);
    turn_frame(b);
    swap_vertices(b);
    if (b->swimmer) {
        tobi_swimmer_advance(b);
        tobi_body_update_surface(b);
    }
    tobi_body_report(b);
}

/* Velocities that the motion of the last step had where the vertices are in the middle of this one: a round
   vessel that turns about its axis does not accelerate what slips along it. */
static void carry_before(tobi_body *b, double dt)
{
    for (int64_t k = 0; k < b->mesh.vertex_count; k++) {
        double more[3];
        vec3_cross(more, b->info.angular_velocity, b->vertex_before[k]);
        vec3_add_scaled(b->vertex_before[k], b->vertex_before[k], dt, more);
    }
}

tobi_status tobi_body_advance(tobi_body *b, double t, double dt, tobi_error *err)
{
    if (b->rigid.kind != TOBI_PRESCRIBED) {
        memcpy(b->rigid.before, b->rigid.driven, sizeof b->rigid.before);
        advance_free(b);
        return TOBI_OK;
    }
    if (!b->motion) return TOBI_OK;
    memcpy(b->vertex_before, b->vertex_velocity, (size_t)b->mesh.vertex_count*sizeof *b->vertex_before);
    double old_centre[3], old_frame[3][3];
    memcpy(old_centre, b->centre, sizeof old_centre);
    memcpy(old_frame, b->frame, sizeof old_frame);
    swap_vertices(b);
    if (b->deforms) tobi_body_update_surface(b);
    TOBI_TRY(tobi_body_find_frame(b, t, b->centre, b->frame, err));
    for (int a = 0; a < 3; a++) b->info.velocity[a] = (b->centre[a] - old_centre[a])/dt;
    memcpy(b->info.position, b->centre, sizeof b->centre);
    tobi_frame_quaternion((const double (*)[3])b->frame, b->info.orientation);
    tobi_frame_rate((const double (*)[3])old_frame, (const double (*)[3])b->frame, dt,
                    b->info.angular_velocity);
    if (!b->deforms) carry_before(b, dt);
    mirror_motion(b);
    return TOBI_OK;
}
