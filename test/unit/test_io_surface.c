/* Surfaces as files: read back by assimp, which knows OBJ, PLY, STL and glTF; movies; mistakes in words. VTP
   is read by VTK in test/api/surface.sh. */
#define _GNU_SOURCE 1
#include "calls.h"
#include "surface_rig.h"
#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <stdio.h>
#include <unistd.h>

#define D 0.01

static tobi_surface *make_ball(double radius, double x)
{
    rig_points p = rig_box((int[3]){ 14, 14, 14 }, (double[3]){ x, 0, 100 }, D, 0.3);
    rig_cut_ball(&p, (double[3]){ x + 0.07, 0.07, 100.07 }, radius);
    const tobi_surface_field field = { "place of it", 3, &p.position[0][0] };
    tobi_surface_def d = tobi_default_surface();
    tobi_surface *s;
    d.particle_count = p.count, d.positions = (const double (*)[3])p.position, d.spacing = D;
    d.fields = &field, d.field_count = 1;
    OK(tobi_surface_make(&d, &s, &err));
    free(p.position);
    return s;
}

/* A mesh of assimp, against the surface: as many triangles, the same volume. */
static void expect_mesh(const struct aiMesh *m, const tobi_surface *s)
{
    double sum = 0;
    assert_int_equal(m->mNumFaces, s->triangle_count);
    for (unsigned t = 0; t < m->mNumFaces; t++) {
        double p[3][3];
        for (int k = 0; k < 3; k++) {
            const struct aiVector3D *v = &m->mVertices[m->mFaces[t].mIndices[k]];
            const double q[3] = { v->x - m->mVertices[0].x, v->y - m->mVertices[0].y,
                                  v->z - m->mVertices[0].z };
            memcpy(p[k], q, sizeof q);
        }
        sum += (p[0][0]*(p[1][1]*p[2][2] - p[1][2]*p[2][1]) + p[0][1]*(p[1][2]*p[2][0] - p[1][0]*p[2][2]) +
                p[0][2]*(p[1][0]*p[2][1] - p[1][1]*p[2][0]))/6;
    }
    /* floats at 100 m */
    if (fabs(sum/rig_volume(s) - 1) > 2e-3) fail_msg("a volume of %g instead of %g", sum, rig_volume(s));
}

static void test_formats(void **state)
{
    (void)state;
    const char *const names[] = { "a.obj", "a.PLY", "a.stl", "a.glb" };
    tobi_surface *s = make_ball(0.06, 0);
    for (int k = 0; k < 4; k++) {
        OK(tobi_surface_write(names[k], s, &err));
        const struct aiScene *scene = aiImportFile(names[k], 0);
        if (!scene) fail_msg("%s: %s", names[k], aiGetErrorString());
        assert_int_equal(scene->mNumMeshes, 1);
        expect_mesh(scene->mMeshes[0], s);
        aiReleaseImport(scene);
        unlink(names[k]);
    }
    OK(tobi_surface_write("a.vtp", s, &err));
    assert_int_equal(unlink("a.vtp"), 0);
    tobi_surface_free(s);
}

/* Three frames, the second of them empty; each has a channel of scales. */
static void test_movie(void **state)
{
    (void)state;
    tobi_surface_movie *movie;
    tobi_surface *s[3];
    OK(tobi_surface_movie_create("m.glb", 3, (const double[3]){ 0, 0, 2 }, &movie, &err));
    for (int k = 0; k < 3; k++) {
        s[k] = make_ball(k == 1 ? 0 : 0.05 + 0.005*k, 0.1*k);
        OK(tobi_surface_movie_add(movie, 0.5 + 0.1*k, s[k], k == 2 ? 0 : -1, 0, 200, &err));
        assert_int_equal(access("m.glb", F_OK), -1);
    }
    OK(tobi_surface_movie_finish(movie, &err));
    tobi_surface_movie_free(movie);
    const struct aiScene *scene = aiImportFile("m.glb", 0);
    if (!scene) fail_msg("m.glb: %s", aiGetErrorString());
    assert_int_equal(scene->mNumMeshes, 2);
    expect_mesh(scene->mMeshes[0], s[0]);
    expect_mesh(scene->mMeshes[1], s[2]);
    assert_int_equal(scene->mNumAnimations, 1);
    assert_int_equal(scene->mAnimations[0]->mNumChannels, 3);
    for (unsigned k = 0; k < 3; k++) {
        const struct aiNodeAnim *c = scene->mAnimations[0]->mChannels[k];
        assert_true(c->mNumScalingKeys >= 2);
        for (unsigned q = 0; q < c->mNumScalingKeys; q++) {
            const float scale = c->mScalingKeys[q].mValue.x;
            assert_true(scale == 0 || scale == 1);
        }
    }
    aiReleaseImport(scene);
    unlink("m.glb");
    for (int k = 0; k < 3; k++) tobi_surface_free(s[k]);
}

static void test_mistakes(void **state)
{
    (void)state;
    tobi_surface_movie *movie;
    const double up[3] = { 0, 1, 0 };
    tobi_surface *s = make_ball(0.05, 0);
    REFUSED(tobi_surface_write("a.xyz", s, &err), TOBI_INVALID, "ends in .vtp, .ply, .obj, .stl or .glb");
    REFUSED(tobi_surface_write(NULL, s, &err), TOBI_INVALID, "path is NULL");
    REFUSED(tobi_surface_write("a.obj", NULL, &err), TOBI_INVALID, "surface is NULL");
    REFUSED(tobi_surface_write("nowhere/a.obj", s, &err), TOBI_IO, "nowhere/a.obj");
    tobi_surface *s2;
    tobi_surface_def many = tobi_default_surface();
    many.field_count = TOBI_SURFACE_FIELD_LIMIT;
    REFUSED(tobi_surface_make_skinned(&many, &(tobi_surface_skins){ .count = 0 }, &s2, &err), TOBI_INVALID,
            "32 fields, with skins allowed are 0 to 31");
    REFUSED(tobi_surface_movie_create("m.glb", 0, up, &movie, &err), TOBI_INVALID,
            "0 frames, allowed are 1 to");
    REFUSED(tobi_surface_movie_create("m.glb", 1, (const double[3]){ 0, 0, 0 }, &movie, &err), TOBI_INVALID,
            "direction upwards is 0 0 0");
    OK(tobi_surface_movie_create("m.glb", 2, up, &movie, &err));
    REFUSED(tobi_surface_movie_finish(movie, &err), TOBI_INVALID, "without a frame");
    REFUSED(tobi_surface_movie_add(movie, 0, s, 1, 0, 1, &err), TOBI_INVALID, "has no field 1, but 1");
    OK(tobi_surface_movie_add(movie, 1, s, -1, 0, 1, &err));
    REFUSED(tobi_surface_movie_add(movie, 1, s, 0, 0, 1, &err), TOBI_INVALID, "not after the one before");
    const int64_t count = s->vertex_count;
    s->vertex_count = (int64_t)1 << 28;
    REFUSED(tobi_surface_movie_add(movie, 2, s, 0, 0, 1, &err), TOBI_INVALID, "more than 4 GB at 2 s");
    s->vertex_count = count;
    OK(tobi_surface_movie_add(movie, 2, s, 0, 0, 1, &err));
    REFUSED(tobi_surface_movie_add(movie, 3, s, 0, 0, 1, &err), TOBI_INVALID, "more than the 2 frames");
    tobi_surface_movie_free(movie);
    assert_int_equal(access("m.glb", F_OK), -1);
    assert_int_equal(access("m.glb.part", F_OK), -1);
    tobi_surface_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_formats), cmocka_unit_test(test_movie), cmocka_unit_test(test_mistakes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
