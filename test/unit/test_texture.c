/* Texture coordinates: from the file to the particles of a solid and to the surface of a body. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <png.h>
#include <jpeglib.h>
#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include "geom/texture.h"
#include "tobiuo/drawing.h"
#include "tobiuo/surface.h"
#include "tobiuo/run.h"
#include "stripes_rig.h"
#include "world/world.h"

static const double one[3] = { 1, 1, 1 }, up[3] = { 0, 0, 1 };

/* A cube of side 1; face f (-x, +x, -y, +y, -z, +z) has the stripe f/6 .. (f + 1)/6 of the picture, so that
   every edge is a cut_face. faces: how many of the six have coordinates. */
static void write_cube(const char *path, int faces)
{
    static const int corner[6][4] = { { 1, 3, 7, 5 }, { 2, 6, 8, 4 }, { 1, 5, 6, 2 },
                                      { 3, 4, 8, 7 }, { 1, 2, 4, 3 }, { 5, 7, 8, 6 } };
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    for (int k = 0; k < 8; k++) fprintf(f, "v %d %d %d\n", k & 1, k >> 1 & 1, k >> 2);
    for (int k = 0; k < 6; k++)
        for (int c = 0; c < 4; c++) fprintf(f, "vt %.9g %d\n", (k + (c == 1 || c == 2))/6.0, c/2);
    for (int k = 0; k < 6; k++)
        for (int t = 0; t < 2; t++) {
            fprintf(f, t ? "f" : "o face%d\nf", k);
            for (int c = 0; c < 3; c++) {
                int at = c == 0 ? 0 : c + t;
                if (k < faces) fprintf(f, " %d/%d", corner[k][at], 4*k + at + 1);
                else fprintf(f, " %d", corner[k][at]);
            }
            fprintf(f, "\n");
        }
    fclose(f);
}

static void read_cube(tobi_mesh *mesh, int faces)
{
    tobi_error err = { 0 };
    write_cube("cube.obj", faces);
    if (tobi_mesh_read("cube.obj", mesh, &err) != TOBI_OK) fail_msg("%s", err.text);
}

static void expect(const tobi_mesh *mesh, double x, double y, double z, double u, double v)
{
    float uv[2];
    double at[3] = { x, y, z };
    tobi_texture_look(mesh->texture, at, uv);
    if (fabs(uv[0] - u) > 1e-6 || fabs(uv[1] - v) > 1e-6)
        fail_msg("%g %g at %g %g %g", uv[0], uv[1], x, y, z);
}

static void test_reading(void **state)
{
    (void)state;
    tobi_mesh mesh;
    tobi_error err = { 0 };
    read_cube(&mesh, 0);
    assert_null(mesh.texture);
    tobi_mesh_free(&mesh);
    read_cube(&mesh, 6);
    assert_int_equal(mesh.vertex_count, 8);      /* welded in spite of the cut_faces */
    assert_int_equal(mesh.texture->count, 12);
    double mirror[3] = { -2, 2, 2 }, shift[3] = { 5, 0, 0 };
    assert_int_equal(tobi_mesh_transform(&mesh, mirror, up, 0, shift, &err), TOBI_OK);
    assert_int_equal(tobi_mesh_orient(&mesh, "cube.obj", &err), TOBI_OK);
    assert_int_equal(tobi_mesh_refine(&mesh, 0.3, &err), TOBI_OK);
    assert_non_null(mesh.texture);
    assert_int_equal(tobi_texture_prepare(mesh.texture, &err), TOBI_OK);
    /* the face -x lies at 5 m now: y turns into u, z into v; deep inside and outside the nearest counts */
    expect(&mesh, 5, 0.5, 1, 0.25/6, 0.5);
    expect(&mesh, 4.9, 0.5, 1, 0.25/6, 0.5);
    expect(&mesh, 9, 0.5, 1, 0.25/6, 0.5);
    /* from the front the face +z: y turns into u, x into v from 5 m down; beside it the nearest again */
    mesh.texture->front = 1;
    expect(&mesh, 3.5, 0.5, 0.1, (5 + 0.25)/6, 0.75);
    expect(&mesh, 3.5, 0.5, 9, (5 + 0.25)/6, 0.75);
    expect(&mesh, 9, 0.5, 1, 0.25/6, 0.5);
    tobi_mesh_free(&mesh);
    read_cube(&mesh, 2);
    assert_int_equal(mesh.texture->count, 4);
    tobi_mesh_free(&mesh);
}

/* Every corner of every face reads its own stripe, also on a refined mesh. */
static void test_skin(void **state)
{
    (void)state;
    tobi_error err = { 0 };
    for (int refined = 0; refined < 2; refined++) {
        tobi_mesh mesh;
        tobi_skin skin;
        double area = 0;
        read_cube(&mesh, 6);
        assert_int_equal(tobi_mesh_orient(&mesh, "cube.obj", &err), TOBI_OK);
        if (refined) assert_int_equal(tobi_mesh_refine(&mesh, 0.3, &err), TOBI_OK);
        assert_int_equal(tobi_texture_prepare(mesh.texture, &err), TOBI_OK);
        assert_int_equal(tobi_skin_build(&mesh, &skin, &err), TOBI_OK);
        if (!refined) assert_int_equal(skin.vertex_count, 24);
        for (int64_t t = 0; t < mesh.triangle_count; t++) {
            const float *p = skin.uv[skin.triangles[t][0]], *q = skin.uv[skin.triangles[t][1]],
                        *r = skin.uv[skin.triangles[t][2]];
            area += 0.5*fabs((double)(q[0] - p[0])*(r[1] - p[1]) - (double)(r[0] - p[0])*(q[1] - p[1]));
            for (int k = 0; k < 3; k++)
                assert_int_equal(skin.vertex[skin.triangles[t][k]], mesh.triangles[t][k]);
        }
        print_message("%d vertices for %d, area of the picture %.9f\n", (int)skin.vertex_count,
                      (int)mesh.vertex_count, area);
        assert_true(fabs(area - 1) < 1e-5);      /* the six stripes, each once */
        tobi_skin_free(&skin);
        tobi_mesh_free(&mesh);
    }
}

static tobi_world *make_world(int faces)
{
    tobi_world_def def = tobi_default_world_def();
    tobi_error err = { 0 };
    tobi_world *w;
    write_cube("cube.obj", faces);
    def.method = "mlsmpm";
    def.spacing = 0.1;
    for (int a = 0; a < 3; a++) def.domain_max[a] = 4;
    assert_int_equal(tobi_world_create(&def, NULL, &w, &err), TOBI_OK);
    for (int k = 0; k < 2; k++) {
        tobi_solid_def solid = tobi_default_solid_def();
        tobi_fill_def fill = tobi_default_fill_def();
        solid.name = k ? "plain" : "cube";
        fill.mesh = k ? NULL : "cube.obj";
        memcpy(fill.scale, one, sizeof one);
        for (int a = 0; a < 3; a++) {
            fill.translation[a] = 0.5;
            fill.box_min[a] = 2;
            fill.box_max[a] = 3;
        }
        assert_int_equal(tobi_world_add_solid(w, &solid, &fill, 1, &err), TOBI_OK);
    }
    tobi_body_def body = tobi_default_body_def();
    body.name = "box";
    body.mesh = "cube.obj";
    body.translation[0] = 3;
    if (tobi_world_add_body(w, &body, &err) != TOBI_OK) fail_msg("%s", err.text);
    return w;
}

/* Particles keep what they had where they started, when they have moved, too. */
static void test_particles(void **state)
{
    (void)state;
    tobi_world *w = make_world(6);
    tobi_error err = { 0 };
    assert_int_equal(tobi_world_advance(w, 0.05, NULL, &err), TOBI_OK);
    int64_t n = tobi_world_count(w, TOBI_FLUID), near = 0;
    double *uv = malloc((size_t)n*2*sizeof *uv), *rest = malloc((size_t)n*3*sizeof *rest);
    double *material = malloc((size_t)n*sizeof *material);
    assert_int_equal(tobi_world_read(w, TOBI_FLUID, "texture_coordinates", uv, n, &err), TOBI_OK);
    assert_int_equal(tobi_world_read(w, TOBI_FLUID, "rest_position", rest, n, &err), TOBI_OK);
    assert_int_equal(tobi_world_read(w, TOBI_FLUID, "material", material, n, &err), TOBI_OK);
    for (int64_t i = 0; i < n; i++) {
        const double *x = rest + 3*i, *t = uv + 2*i;
        if (material[i] == 1) {
            assert_true(t[0] == 0 && t[1] == 0);
            continue;
        }
        double other = fmin(fmin(x[1] - 0.5, 1.5 - x[1]), fmin(x[2] - 0.5, 1.5 - x[2]));
        if (!(x[0] - 0.5 < other - 1e-3)) continue;      /* nearest is the face at the lower x */
        near++;
        assert_true(fabs(t[0] - (x[1] - 0.5)/6) < 1e-5 && fabs(t[1] - (x[2] - 0.5)) < 1e-5);
    }
    assert_true(near > 50);
    free(uv);
    free(rest);
    free(material);
    tobi_world_destroy(w);
}

static int holds(const char *path, const char *words)
{
    char text[4000] = "";
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    size_t n = fread(text, 1, sizeof text - 1, f);
    fclose(f);
    for (size_t k = 0; k < n; k++) if (!text[k]) text[k] = ' ';
    return strstr(text, words) != NULL;
}

/* usual has them where the mesh has, and nothing is made where it has none. */
static void test_files(void **state)
{
    (void)state;
    for (int faces = 0; faces <= 6; faces += 6) {
        tobi_world *w = make_world(faces);
        tobi_output_def output = tobi_default_output_def();
        tobi_run *run;
        tobi_error err = { 0 };
        output.fields = "usual";
        output.surfaces = 1;
        const char *dir = faces ? "with" : "without";
        if (tobi_run_create(w, &output, dir, 0, "{}", &run, &err) != TOBI_OK) fail_msg("%s", err.text);
        char path[100];
        snprintf(path, sizeof path, "%s/fluid/fluid_000000.vtu", dir);
        assert_int_equal(holds(path, "<PointData TCoords=\"texture_coordinates\">"), faces > 0);
        snprintf(path, sizeof path, "%s/surfaces/box_000000.vtp", dir);
        assert_int_equal(holds(path, "NumberOfPoints=\"24\""), faces > 0);
        assert_int_equal(holds(path, "Name=\"texture_coordinates\" NumberOfComponents=\"2\""), faces > 0);
        assert_int_equal(w->texture != NULL, faces > 0);
        tobi_run_free(run);
        tobi_world_destroy(w);
    }
}

static const double core[3] = { 120, 120, 120 };

/* The same stripes; of four inks or one gray the first channels. */
static void write_jpeg(const char *path, J_COLOR_SPACE space, int channels)
{
    enum { W = 360, H = 40 };
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr errors;
    FILE *file = fopen(path, "wb");
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    jpeg_stdio_dest(&jpeg, file);
    jpeg.image_width = W, jpeg.image_height = H;
    jpeg.input_components = channels;
    jpeg.in_color_space = space;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 95, TRUE);
    if (channels == 1) jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    for (int y = 0; y < H; y++) {
        uint8_t row[4*W] = { 0 };
        JSAMPROW line = row;
        for (int x = 0; x < W; x++)
            memcpy(row + channels*x, stripe[x/60], (size_t)(channels < 3 ? channels : 3));
        jpeg_write_scanlines(&jpeg, &line, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    fclose(file);
}

/* In the middles of the stripes the colours are those that were written, but for the loss of JPEG. */
static void test_jpeg(void **state)
{
    (void)state;
    for (int channels = 1; channels <= 3; channels += 2) {
        tobi_image *image;
        tobi_error err = { 0 };
        int width, height;
        const uint8_t *rgb;
        write_jpeg("stripes.jpg", channels == 1 ? JCS_GRAYSCALE : JCS_RGB, channels);
        if (tobi_image_read("stripes.jpg", &image, &err)) fail_msg("%s", err.text);
        tobi_image_size(image, &width, &height, &rgb);
        assert_int_equal(width, 360);
        assert_int_equal(height, 40);
        for (int k = 0; k < 6; k++)
            for (int c = 0; c < 3; c++)
                assert_true(abs(rgb[3*(20*360 + 60*k + 30) + c] - stripe[k][channels == 1 ? 0 : c]) <= 8);
        tobi_image_free(image);
    }
}

static void test_images(void **state)
{
    (void)state;
    static const struct { const char *path, *says; } bad[] = {
        { "nothing.png", "nothing.png" }, { "cube.obj", "texture 'cube.obj' is no PNG or JPEG file" },
        { "cut.png", "texture 'cut.png' cannot be read: it ends early" },
        { "cut.jpg", "texture 'cut.jpg' cannot be read: Premature end of JPEG file" },
        { "head.jpg", "texture 'head.jpg' cannot be read: " },
        { "inks.jpg", "texture 'inks.jpg' cannot be read: it has 4 inks, as for print" } };
    const uint8_t four[4][3] = { { 255, 0, 0 }, { 0, 255, 0 }, { 0, 0, 255 }, { 255, 255, 255 } };
    tobi_image *image;
    tobi_error err = { 0 };
    float color[3];
    assert_int_equal(tobi_image_make(2, 2, four[0], &image, &err), TOBI_OK);
    for (int k = 0; k < 4; k++) {      /* the middles of the pixels, rows from the top; and one turn on */
        const float uv[2] = { 0.25f + 0.5f*(float)(k%2) + 3, 0.75f - 0.5f*(float)(k/2) - 2 };
        tobi_image_color(image, uv, color);
        for (int c = 0; c < 3; c++) assert_true(fabs(color[c] - four[k][c]/255.0) < 0.01);
    }
    tobi_image_free(image);
    assert_int_equal(tobi_image_make(0, 2, four[0], &image, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "an image of 0 x 2 pixels, allowed are 1 to 8192"));
    write_stripes("stripes.png");
    write_cube("cube.obj", 6);
    write_jpeg("inks.jpg", JCS_CMYK, 4);
    write_jpeg("whole.jpg", JCS_RGB, 3);
    assert_int_equal(system("head -c 200 stripes.png > cut.png; head -c 700 whole.jpg > cut.jpg;"
                            "head -c 4 whole.jpg > head.jpg"), 0);
    for (size_t k = 0; k < sizeof bad/sizeof *bad; k++) {
        assert_int_not_equal(tobi_image_read(bad[k].path, &image, &err), TOBI_OK);
        if (!strstr(err.text, bad[k].says)) fail_msg("%s", err.text);
        assert_null(image);
    }
}

/* A cube as a body at 2.2 .. 3.2 m along x, and one as a solid at 0.5 .. 1.5 m. */
static tobi_world *make_textured(int faces, double opacity, tobi_status expected, tobi_error *err)
{
    tobi_world_def def = tobi_default_world_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def body = tobi_default_body_def();
    tobi_world *w;
    write_stripes("stripes.png");
    write_cube("cube.obj", faces);
    def.method = "mlsmpm";
    def.spacing = 0.1;
    for (int a = 0; a < 3; a++) def.domain_max[a] = 4, fill.translation[a] = 0.5;
    assert_int_equal(tobi_world_create(&def, NULL, &w, err), TOBI_OK);
    solid.name = "cube";
    solid.texture = body.texture = "stripes.png";
    memcpy(solid.core_color, core, sizeof core);
    memcpy(fill.scale, one, sizeof one);
    fill.mesh = body.mesh = "cube.obj";
    body.name = "box";
    body.opacity = opacity;
    body.translation[0] = 2.2, body.translation[1] = 0.5, body.translation[2] = 0.5;
    assert_int_equal(tobi_world_add_solid(w, &solid, &fill, 1, err), expected);
    if (expected == TOBI_OK) assert_int_equal(tobi_world_add_body(w, &body, err), TOBI_OK);
    return w;
}

/* What stands in the picture at the middle of the cube that an eye sees from -y; half: only particles with x
   below 1 m were at rest, seen from +x. turned: the solid has turned by 90 degrees about z. */
static int see(tobi_world *w, int turned, int half, const double eye[3], const double target[3])
{
    enum { SIDE = 64 };
    tobi_looks looks;
    tobi_drawing *d;
    tobi_error err = { 0 };
    const tobi_view_def view = tobi_default_output_def().view;
    tobi_moment m = { .count = tobi_world_count(w, TOBI_FLUID) };
    tobi_moment_surface surface = { .name = "box" };
    static uint8_t rgb[SIDE][SIDE][3];
    m.fields = calloc(4, sizeof *m.fields);
    m.positions = calloc((size_t)m.count, sizeof *m.positions);
    add_field(w, &m, "material", 1);
    add_field(w, &m, "part", 1);
    add_field(w, &m, "rest_position", 3);
    const double (*rest)[3] = (const double (*)[3])m.fields[2].values;
    for (int64_t i = 0; i < m.count; i++) {
        const double x = rest[i][0] - 1, y = rest[i][1] - 1;
        m.positions[i][0] = 1 + (turned ? -y : x), m.positions[i][1] = 1 + (turned ? x : y);
        m.positions[i][2] = half && x > 0 ? NAN : rest[i][2];
    }
    const double (*vertices)[3];
    const int32_t (*triangles)[3];
    assert_int_equal(tobi_world_surface(w, 0, &surface.vertex_count, &vertices, &surface.triangle_count,
                                        &triangles), TOBI_OK);
    surface.vertices = (double (*)[3])vertices, surface.triangles = (int32_t (*)[3])triangles;
    m.surfaces = &surface, m.surface_count = 1;
    assert_int_equal(tobi_world_looks(w, &looks, &err), TOBI_OK);
    if (tobi_drawing_make(&looks, &m, &view, &d, &err)) fail_msg("%s", err.text);
    tobi_picture *p = tobi_drawing_picture(d);
    p->width = p->height = SIDE;
    p->has_camera = 1, p->field_of_view = 10;
    memcpy(p->eye, eye, sizeof p->eye);
    memcpy(p->target, target, sizeof p->target);
    p->title = NULL;
    if (tobi_picture_draw(p, &rgb[0][0][0], &err)) fail_msg("%s", err.text);
    tobi_drawing_free(d);
    tobi_looks_free(&looks);
    m.surfaces = NULL, m.surface_count = 0;
    tobi_moment_free(&m);
    return find_stripe(rgb[SIDE/2][SIDE/2]);
}

/* A face in a picture has the stripe of the face that it was at rest; a cut shows the core. */
static void test_pictures(void **state)
{
    (void)state;
    static const double body[3] = { 2.7, 1, 1 }, solid[3] = { 1, 1, 1 };
    tobi_error err = { 0 };
    tobi_world *w = make_textured(6, 0.97, TOBI_OK, &err);      /* of glass: mixes front and back */
    assert_int_equal(tobi_world_start(w, &err), TOBI_OK);
    assert_true(see(w, 0, 0, (const double[3]){ 2.8, 1.07, 2.1 }, body) >= 4);
    tobi_world_destroy(w);
    w = make_textured(6, 1, TOBI_OK, &err);
    assert_int_equal(tobi_world_start(w, &err), TOBI_OK);
    for (int k = 0; k < 6; k++) {      /* faces -x, +x, -y, +y, -z, +z */
        double eye[2][3];
        memcpy(eye[0], body, sizeof body);
        memcpy(eye[1], solid, sizeof solid);
        for (int n = 0; n < 2; n++) eye[n][k/2] += k%2 ? 1.1 : -1.1;
        for (int n = 0; n < 2; n++) eye[n][(k/2 + 1)%3] += 0.1, eye[n][(k/2 + 2)%3] += 0.07;
        assert_int_equal(see(w, 0, 0, eye[0], body), k);
        assert_int_equal(see(w, 0, 0, eye[1], solid), k);
        /* turned: at -x is what was at +y, at +x -y, at -y -x, at +y +x */
        static const int was[6] = { 3, 2, 0, 1, 4, 5 };
        assert_int_equal(see(w, 1, 0, eye[1], solid), was[k]);
        if (k == 1) assert_int_equal(see(w, 0, 1, eye[1], solid), -1);
    }
    tobi_world_destroy(w);
    w = make_textured(0, 1, TOBI_INVALID, &err);
    if (!strstr(err.text, "solid 'cube' has a texture, but no mesh with texture coordinates"))
        fail_msg("%s", err.text);
    tobi_world_destroy(w);
}

/* The stripe of a face by its image, as assimp reads the file. */
static int stripe_of(const struct aiMesh *m, const struct aiFace *f, const tobi_image *image)
{
    float uv[2] = { 0, 0 }, color[3];
    uint8_t rgb[3];
    for (int k = 0; k < 3; k++) {
        uv[0] += m->mTextureCoords[0][f->mIndices[k]].x/3;
        uv[1] += m->mTextureCoords[0][f->mIndices[k]].y/3;
    }
    tobi_image_color(image, uv, color);
    for (int c = 0; c < 3; c++) rgb[c] = (uint8_t)(255*color[c]);
    return find_stripe(rgb);
}

/* Faces -x, +x, -y, +y, -z, +z by their normal, with y upwards; -1: none of them quite. */
static int side_of(const struct aiMesh *m, const struct aiFace *f)
{
    double p[3][3], n[3];
    for (int k = 0; k < 3; k++) {
        const struct aiVector3D *v = &m->mVertices[f->mIndices[k]];
        p[k][0] = v->x, p[k][1] = v->y, p[k][2] = v->z;
    }
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1)%3, c = (a + 2)%3;
        n[a] = (p[1][b] - p[0][b])*(p[2][c] - p[0][c]) - (p[1][c] - p[0][c])*(p[2][b] - p[0][b]);
    }
    const double size = sqrt(n[0]*n[0] + n[1]*n[1] + n[2]*n[2]);
    for (int a = 0; a < 3; a++)
        if (fabs(n[a]) > 0.97*size) return 2*a + (n[a] > 0);
    return -1;
}

static void judge_gltf(void)
{
    static const int was[6] = { 3, 2, 0, 1, 4, 5 };
    tobi_error err = { 0 };
    tobi_image *image;
    const struct aiScene *scene = aiImportFile("cube.glb", 0);
    if (!scene) fail_msg("%s", aiGetErrorString());
    assert_int_equal(scene->mNumTextures, 1);
    const struct aiTexture *t = scene->mTextures[0];
    FILE *f = fopen("glb.png", "wb");
    assert_true(t->mHeight == 0 && f && fwrite(t->pcData, 1, t->mWidth, f) == t->mWidth && fclose(f) == 0);
    if (tobi_image_read("glb.png", &image, &err)) fail_msg("%s", err.text);
    int count[6] = { 0 }, right[6] = { 0 }, inside = 0;
    for (unsigned k = 0; k < scene->mNumMeshes; k++) {
        const struct aiMesh *m = scene->mMeshes[k];
        const struct aiMaterial *material = scene->mMaterials[m->mMaterialIndex];
        const int has = aiGetMaterialTextureCount(material, aiTextureType_DIFFUSE) > 0;
        assert_non_null(m->mTextureCoords[0]);
        for (unsigned q = 0; q < m->mNumFaces; q++) {
            const int side = side_of(m, &m->mFaces[q]);
            const struct aiColor4D *c = &m->mColors[0][m->mFaces[q].mIndices[0]];
            assert_true(has ? c->r == 1 && c->g == 1 && c->b == 1 : c->r == 0 && c->g == 1 && c->b == 0);
            inside += !has && side == 5;
            if (side < 0 || !has) continue;
            count[side]++;
            right[side] += stripe_of(m, &m->mFaces[q], image) == was[side];
        }
    }
    for (int k = 0; k < 6; k++) {
        print_message("side %d: %d of %d\n", k, right[k], count[k]);
        if (k != 5) assert_true(count[k] > 25 && right[k] > 0.98*count[k]);
    }
    assert_true(inside > 50);
    aiReleaseImport(scene);
    tobi_image_free(image);
}

/* The surface of the turned cube as glTF: assimp finds the image and, on each side, the stripe that was there
   at rest; half of the cube has a side of the inside, without an image. */
static void test_gltf(void **state)
{
    (void)state;
    tobi_error err = { 0 };
    tobi_looks looks;
    tobi_surface *s;
    tobi_surface_movie *movie;
    tobi_world *w = make_textured(6, 1, TOBI_OK, &err);
    assert_int_equal(tobi_world_start(w, &err), TOBI_OK);
    assert_int_equal(tobi_world_looks(w, &looks, &err), TOBI_OK);
    const int64_t n = tobi_world_count(w, TOBI_FLUID);
    double (*rest)[3] = calloc((size_t)n, sizeof *rest), (*at)[3] = calloc((size_t)n, sizeof *at);
    int16_t *skin = calloc((size_t)n, sizeof *skin);
    double *white = malloc(4*(size_t)n*sizeof *white);
    assert_int_equal(tobi_world_read(w, TOBI_FLUID, "rest_position", rest[0], 3*n, &err), TOBI_OK);
    for (int64_t i = 0; i < n; i++) {
        at[i][0] = 1 - rest[i][1], at[i][1] = rest[i][0] - 1, at[i][2] = rest[i][2];
        if (at[i][2] > 1) at[i][2] = NAN;      /* the upper half is gone */
        for (int c = 0; c < 4; c++) white[4*i + c] = 0.25;
    }
    tobi_picture_skin one_skin = looks.materials[0].skin;
    memcpy(one_skin.inside, (float[3]){ 0, 1, 0 }, sizeof one_skin.inside);
    const tobi_surface_skins skins = { &one_skin, 1, skin, (const double (*)[3])rest };
    const tobi_surface_field color = { "color", 4, white };
    tobi_surface_def d = tobi_default_surface();
    d.particle_count = n, d.positions = (const double (*)[3])at, d.spacing = looks.spacing;
    d.fields = &color, d.field_count = 1;
    if (tobi_surface_make_skinned(&d, &skins, &s, &err)) fail_msg("%s", err.text);
    assert_int_equal(tobi_surface_movie_create("cube.glb", 1, (const double[3]){ 0, 1, 0 }, &movie, &err),
                     TOBI_OK);
    assert_int_equal(tobi_surface_movie_add(movie, 0, s, -1, 0, 1, &err), TOBI_OK);
    if (tobi_surface_movie_finish(movie, &err)) fail_msg("%s", err.text);
    tobi_surface_movie_free(movie);
    tobi_surface_free(s);
    judge_gltf();
    tobi_looks_free(&looks);
    tobi_world_destroy(w);
    free(rest);
    free(at);
    free(skin);
    free(white);
}

int main(void)
{
    char folder[] = "/tmp/tobiuo_texture_XXXXXX", command[100];
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reading), cmocka_unit_test(test_skin), cmocka_unit_test(test_particles),
        cmocka_unit_test(test_files), cmocka_unit_test(test_images), cmocka_unit_test(test_jpeg),
        cmocka_unit_test(test_pictures),
        cmocka_unit_test(test_gltf),
    };
    if (!mkdtemp(folder) || chdir(folder) != 0) return 1;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    if (chdir("/") == 0) snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command) != 0 || failed;
}
