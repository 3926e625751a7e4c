/* What a run will write, before it runs.

   One factor per kind of compression turns bytes in memory into bytes on the disk: numbers in motion are
   noise in their lower bits, so that little depends on the scene. Drawback: fields that stand still, or
   are 0, take less than is told: bodies that hardly move half. */
#include "base/param.h"
#include "record/record.h"
#include "world/world.h"
#include <math.h>

/* By tobi_compression: none, zlib, LZ4, ASCII. Measured on the shipped scenes, as the constants below. */
static const double packed[] = { 1, 0.6, 0.72, 1.9 };

enum { HEAD = 1900, HISTORY_ROW = 300, BODY_ROW = 400, LIST_ENTRY = 110, PICTURE = 100000,
       NODE = 80, PIECE = 128, CHECKPOINT = 30000, CHECKPOINT_PARTICLE = 90 };
/* Bytes of a particle while an output is taken: nine numbers at a time; the search for pieces of solids. */
enum { BUFFER = 9*sizeof(double), PIECES = 150 };

/* A point with its cell, and the fields of the fluid's or the bodies' particles. */
static double row_bytes(const tobi_run *run, int bodies)
{
    double bytes = 3*sizeof(double) + 2*sizeof(int64_t) + 1;
    for (int k = 0; k < run->field_count; k++) {
        const tobi_record_field *f = &run->field[k];
        if (!bodies || f->bodies)
            bytes += (double)(tobi_type_size((tobi_type)f->type)*(size_t)f->components);
    }
    return bytes;
}

static void add_files(tobi_run_size *size, int files, double bytes)
{
    size->files += files;
    size->bytes += files*bytes;
}

static void add_surface(tobi_run_size *size, const tobi_output_def *o, const tobi_body *b)
{
    const tobi_mesh *m = &b->mesh;
    const double v = (double)m->vertex_count, t = (double)m->triangle_count;
    if (o->surfaces) {
        add_files(size, 1, 0.5*HEAD + packed[o->compression]*(v*3*sizeof(double) + t*20));    /* VTP */
        add_files(size, 1, 84 + 50*t);                                                        /* STL */
    }
    if (o->tractions) add_files(size, 1, HEAD + packed[o->compression]*PIECE*(double)b->surface.count);
    if (o->obj) add_files(size, 1, 36*v + 16*t);
}

/* The surface of a compact body of so many particles,
    at the usual cell twice: nothing is known of its shape. */
static double surface_bytes(const tobi_run *run, double particles)
{
    double vertices = 2*6*cbrt(particles)*cbrt(particles), each = 3*sizeof(double) + 16 + 2*20;
    for (int k = 0; k < run->surface_fields; k++) {
        const tobi_record_surface_field *f = &run->surface_field[k];
        each += 4*(f->component < 0 ? f->of.components : 1);
    }
    return vertices*each/pow(run->output.surface_cell/0.75, 2);
}

/* Files and bytes of one output, which is in so many lists besides that of all. */
static tobi_run_size size_output(const tobi_run *run, double particles, double body_particles, int lists)
{
    const tobi_output_def *o = &run->output;
    const int bodies = tobi_world_body_count(run->world);
    const double pack = packed[o->compression];
    tobi_run_size size = { .bytes = HISTORY_ROW + BODY_ROW*bodies + 2*LIST_ENTRY*lists };
    add_files(&size, 1, HEAD + pack*row_bytes(run, 0)*particles);
    add_files(&size, bodies > 0, HEAD + pack*row_bytes(run, 1)*body_particles);
    for (int b = 0; b < bodies; b++) add_surface(&size, o, &run->world->sim.bodies[b]);
    add_files(&size, o->surfaces*tobi_world_line_count(run->world),
              HEAD + pack*(24*TOBI_TUBE_VERTICES + 20*TOBI_TUBE_TRIANGLES));
    add_files(&size, o->grid, HEAD + pack*NODE*0.5*particles);
    if (o->surface) add_files(&size, 1, 0.5*HEAD + pack*surface_bytes(run, particles));
    add_files(&size, o->ply, 12*particles);
    add_files(&size, o->frames*run->view_count, PICTURE);
    return size;
}

tobi_status tobi_run_estimate(tobi_world *world, const tobi_output_def *output, double end,
                              tobi_run_size *size, tobi_error *err)
{
    int64_t particles, body_particles, memory;
    TOBI_NEED_WORLD(world);
    TOBI_NEED(output, "the output");
    tobi_run run = { .world = world, .output = *output };
    TOBI_NEED(size, "where the size goes");
    TOBI_TRY(tobi_param_check(&tobi_output_table, output, err));
    TOBI_TRY(tobi_series_fields(&run, err));
    TOBI_TRY(tobi_world_estimate(world, &particles, &body_particles, &memory, err));
    const double every = output->checkpoint_interval;
    const int bodies = tobi_world_body_count(world), checkpoints = every > 0 && every < end ? 2 : 1,
              lists = 1 + (bodies > 0) + output->grid + output->surface +
                      (output->surfaces + output->tractions)*bodies +
                      output->surfaces*tobi_world_line_count(world),
              tables = 1 + (bodies > 0) + (tobi_world_probe_count(world) > 0) +
                       (tobi_world_line_count(world) > 0) + (tobi_world_joint_count(world) > 0) +
                       (tobi_world_solid_count(world) > 0) + (world->sim.porous_count > 0);
    const int search = tobi_world_solid_count(world) > 0 ? PIECES : 0;
    const double taken = (double)particles*(row_bytes(&run, 0) + BUFFER + search) +
                         (double)body_particles*row_bytes(&run, 1);
    *size = size_output(&run, (double)particles, (double)body_particles, lists);
    size->memory = taken;
    size->outputs = tobi_record_count(output->interval, end);
    /* Besides: the list of all, resolved.json, summary.json. */
    size->files = (double)size->outputs*size->files + lists + tables + 3 + 2*checkpoints;
    size->bytes = (double)size->outputs*size->bytes +
                  checkpoints*(CHECKPOINT + CHECKPOINT_PARTICLE*(double)particles);
    return TOBI_OK;
}
