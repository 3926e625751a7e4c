/* Oracles of what a body does to a particle: images in its face, and the gap beside it. For
   test_isph_oracle.c, which has the view, the sums and compare(). */
#pragma once

/* Before a kernel lists images, or makes their velocities anew. */
static void prepare_images(const char *name)
{
    if (!strcmp(name, "isph_list_images")) groups = 0;
    if (strcmp(name, "isph_refresh_images")) return;
    for (int64_t g = 0; g < groups; g++)
        for (int k = 0; k < 8; k++)
            view.group[g].images.normal_velocity[k] = view.group[g].images.velocity_change[k] = -1;
}

/* As many as the images that are in the face: alone, or besides in sides. */
static void oracle_isph_list_images(check *c, int64_t i, const sums *s)
{
    int listed = 0;
    assert_true(groups <= GROUPS);
    for (int64_t g = bodies && near_body[i] >= 0 ? view.first_group[near_body[i]] : -1; g >= 0;
         g = view.group[g].images.next)
        for (int k = 0; k < 8; k++) {
            const isph_image_group *m = &view.group[g].images;
            if (!(m->weight[k] > 0)) continue;
            compare(c, m->normal_velocity[k], FLOW, 1);
            compare(c, m->velocity_change[k], CHANGE, 1);
            listed++;
        }
    compare(c, listed, s->in_face, 1);
}

static void oracle_isph_refresh_images(check *c, int64_t i, const sums *s)
{
    oracle_isph_list_images(c, i, s);
}

/* How surely it is a gap beside the body that i misses. The face has the normal x: c_x > 0 says that
   neighbours are missing towards it. */
static double gap_of(int64_t i, const sums *s)
{
    const double *c = s->gradient_c, d = view.spacing, away = c[0] > 0 ? 0 : c[0],
                 rest = sqrt(away*away + c[1]*c[1] + c[2]*c[2]);
    const isph_mirror *m = near_body[i] >= 0 ? &mirror[near_body[i]] : NULL;
    double closing = 0;
    if (!view.open || !m || !(loss_of(s) > 0.1)) return 0;
    for (int a = 0; a < 3; a++) closing += (m->velocity[a] - (&view.velocity[i].x)[a])*m->normal[a];
    return clip((0.25 - rest*d)/0.1)*clip((0.4 - loss_of(s))/0.1)*clip((2.25 - m->offset[0]/d)/0.5)*
           clip((0.3 - closing/view.gap_speed)/0.2);
}
