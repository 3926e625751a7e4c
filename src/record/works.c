/* Work since the start of a run: the power of each step times its length. It is kept beside the world, which
   needs it for nothing. Drawback: a program that steps a world without a run sums up by itself. */
#include "record/record.h"
#include "world/energies.h"
#include "world/world.h"
#include <jansson.h>
#include <math.h>
#include <stdlib.h>

/* In 2-D: the pose without whole turns, and those of before; a body turns by less than half in a step. */
static void follow_turns(tobi_run *run)
{
    const double turn = 2*acos(-1);
    for (int k = 0; k < tobi_world_body_count(run->world); k++) {
        const double *q = run->world->sim.bodies[k].info.orientation, pose = 2*atan2(q[3], q[0]);
        double *angle = &run->works.angle[k];
        *angle = pose + turn*round((*angle - pose)/turn);
    }
}

bool tobi_works_open(tobi_run *run)
{
    run->works.body = calloc((size_t)tobi_world_body_count(run->world) + 1, sizeof *run->works.body);
    run->works.joint = calloc((size_t)tobi_world_joint_count(run->world) + 1, sizeof *run->works.joint);
    run->works.porous = calloc(TOBI_POROUS_LIMIT, sizeof *run->works.porous);
    run->works.scalar = calloc(TOBI_SCALAR_VALUE_LIMIT, sizeof *run->works.scalar);
    run->works.angle = calloc((size_t)tobi_world_body_count(run->world) + 1, sizeof *run->works.angle);
    if (run->works.angle) follow_turns(run);
    return run->works.body && run->works.joint && run->works.angle && run->works.porous && run->works.scalar;
}

void tobi_works_free(tobi_run *run)
{
    free(run->works.body);
    free(run->works.joint);
    free(run->works.angle);
    free(run->works.porous);
    free(run->works.scalar);
}

void tobi_works_add(tobi_run *run, double dt)
{
    tobi_works *w = &run->works;
    tobi_joint_info joint;
    tobi_scalar_flow flow;
    for (int k = 0; k < tobi_world_body_count(run->world); k++)
        for (int by = 0; by < TOBI_POWERS; by++) w->body[k][by] += dt*run->world->sim.bodies[k].power[by];
    for (int k = 0; tobi_world_joint(run->world, k, &joint); k++) w->joint[k] += dt*joint.power;
    w->lines += dt*tobi_energy_line_power(run->world);
    for (int k = 0; k < run->world->sim.porous_count; k++)
        w->porous[k] += dt*run->world->sim.porous[k].power;
    for (int k = 0; tobi_world_scalar_flow(run->world, k, &flow); k++) w->scalar[k] += dt*flow.flow;
    w->buoyancy += dt*run->world->sim.scalar_power;
    follow_turns(run);
}

double tobi_works_bodies(const tobi_run *run, int by)
{
    double sum = 0;
    for (int k = 0; k < tobi_world_body_count(run->world); k++) sum += run->works.body[k][by];
    return sum;
}

double tobi_works_joints(const tobi_run *run)
{
    double sum = 0;
    for (int k = 0; k < tobi_world_joint_count(run->world); k++) sum += run->works.joint[k];
    return sum;
}

double tobi_works_porous(const tobi_run *run)
{
    double sum = 0;
    for (int k = 0; k < run->world->sim.porous_count; k++) sum += run->works.porous[k];
    return sum;
}

json_t *tobi_works_to_json(const tobi_run *run)
{
    json_t *bodies = json_array(), *joints = json_array(), *angles = json_array(), *porous = json_array(),
           *scalars = json_array();
    for (int k = 0; k < tobi_world_body_count(run->world); k++) {
        json_t *row = json_array();
        for (int by = 0; by < TOBI_POWERS; by++)
            json_array_append_new(row, json_real(run->works.body[k][by]));
        json_array_append_new(bodies, row);
    }
    for (int k = 0; k < tobi_world_body_count(run->world); k++)
        json_array_append_new(angles, json_real(run->works.angle[k]));
    for (int k = 0; k < tobi_world_joint_count(run->world); k++)
        json_array_append_new(joints, json_real(run->works.joint[k]));
    for (int k = 0; k < run->world->sim.porous_count; k++)
        json_array_append_new(porous, json_real(run->works.porous[k]));
    for (int k = 0; tobi_world_scalar_flow(run->world, k, NULL); k++)
        json_array_append_new(scalars, json_real(run->works.scalar[k]));
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:f, s:f}", "bodies", bodies, "joints", joints,
                     "angles", angles, "porous_zones", porous, "scalars", scalars, "lines", run->works.lines,
                     "buoyancy", run->works.buoyancy);
}

bool tobi_works_from_json(const json_t *json, tobi_run *run)
{
    const size_t bodies = (size_t)tobi_world_body_count(run->world),
                 joints = (size_t)tobi_world_joint_count(run->world);
    const json_t *of_bodies = json_object_get(json, "bodies"), *of_joints = json_object_get(json, "joints"),
                 *angles = json_object_get(json, "angles"), *lines = json_object_get(json, "lines");
    follow_turns(run);
    if (!json) return true;
    if (json_array_size(of_bodies) != bodies || json_array_size(of_joints) != joints) return false;
    if (!json_is_number(lines)) return false;
    run->works.lines = json_number_value(lines);
    for (size_t k = 0; k < (size_t)run->world->sim.porous_count; k++)      /* absent: 0 */
        run->works.porous[k] = json_number_value(json_array_get(json_object_get(json, "porous_zones"), k));
    run->works.buoyancy = json_number_value(json_object_get(json, "buoyancy"));
    for (int k = 0; tobi_world_scalar_flow(run->world, k, NULL); k++)
        run->works.scalar[k] = json_number_value(json_array_get(json_object_get(json, "scalars"), (size_t)k));
    for (size_t k = 0; k < bodies; k++)
        for (size_t by = 0; by < TOBI_POWERS; by++)
            run->works.body[k][by] = json_number_value(json_array_get(json_array_get(of_bodies, k), by));
    for (size_t k = 0; k < bodies; k++)
        run->works.angle[k] = json_number_value(json_array_get(angles, k));
    follow_turns(run);
    for (size_t k = 0; k < joints; k++)
        run->works.joint[k] = json_number_value(json_array_get(of_joints, k));
    return true;
}
