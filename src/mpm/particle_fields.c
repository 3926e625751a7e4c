/* The fields of the material point method: how they start, what of them is shown in results. Drawback: volume
   and mass of a particle hide in unused components of its strain. */
#include "base/language.h"
#include "mpm/particle_fields.h"
#include "mpm/contact/clamp.h"

#define ROW(...) TOBI_FIELD_ROW(mpm_fields, __VA_ARGS__)
static const tobi_field fields[] = { MPM_FIELDS(ROW) };
const tobi_field_list mpm_field_list = { fields, sizeof fields/sizeof *fields, sizeof(mpm_fields) };

const tobi_output mpm_outputs[] = {
    { TR("material"), 1, "1", 0 }, { TR("von_mises"), 1, "Pa", 0 }, { TR("stress"), 6, "Pa", 0 },
    { "J", 1, "1", 0 }, { TR("deformation_gradient"), 9, "1", 0 }, { TR("plastic"), 1, "1", 0 },
    { TR("rest_position"), 3, "m", 0 }, { TR("piece"), 1, "1", 0 }, { TR("cut_side"), 1, "1", 0 },
    { TR("damage"), 1, "1", 0 }, { TR("texture_coordinates"), 2, "1", 0 },
    { TR("part"), 1, "1", 0 }, { NULL, 0, NULL, 0 }
};

unsigned mpm_needs(const tobi_system *s, int full)
{
    unsigned needs = s->sim->soft.solids == s ? MPM_NEED_LIQUID : 0;
    (void)full;
    for (int k = 0; k < s->sim->body_count; k++)
        if (s->sim->bodies[k].blade) needs |= MPM_NEED_BLADES;
    for (int k = 0; k < s->solid_count; k++)
        if (s->solids[k].def.clamped_to) needs |= MPM_NEED_CLAMP;
    return needs;
}

void mpm_place(tobi_system *s, int64_t i, const tobi_start *start)
{
    const mpm_fields *f = mpm_fields_of(&s->particles);
    const tobi_double3 x = s->particles.position[i];
    const float w[3] = {(float)start->spin[0], (float)start->spin[1], (float)start->spin[2]};
    f->affine[i] = (tobi_columns){{{0, w[2], -w[1], 0}, {-w[2], 0, w[0], 0}, {w[1], -w[0], 0, 0}}};
    if (s->box.dimension == 2)
        f->affine[i].c[0].z = f->affine[i].c[1].z = f->affine[i].c[2].x = f->affine[i].c[2].y = 0;
    f->strain[i] = (tobi_columns){0};
    f->strain[i].c[0].w = (float)start->volume;
    f->strain[i].c[2].w = (float)start->mass;
    f->rest[i] = (tobi_float4){(float)x.x, (float)x.y, (float)x.z, (float)start->core};
    mpm_clamp_place(s, i);
}

double mpm_mass(const tobi_system *s, int64_t i) { return mpm_fields_of(&s->particles)->strain[i].c[2].w; }
