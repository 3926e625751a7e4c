/* Surfaces of particles as VTP, PLY, OBJ, STL and glTF, by the ending of the path. Drawback: OBJ has
   room for colours and texture coordinates alone, STL for no field. */
#include "io/surface_files.h"
#include "base/file.h"
#include <math.h>
#include <string.h>
#include <strings.h>

tobi_status tobi_surface_write_vtp(const char *path, tobi_compression compression, const tobi_surface *s,
                                   tobi_error *err)
{
    tobi_vtk_array array[TOBI_SURFACE_FIELD_LIMIT + 2];
    int n = 0;
    array[n++] = (tobi_vtk_array){ "group", TOBI_I32, 1, s->group };
    array[n++] = (tobi_vtk_array){ "normals", TOBI_F32, 3, s->normals };
    for (int f = 0; f < s->field_count; f++)
        array[n++] = (tobi_vtk_array){ s->field_names[f], TOBI_F32, s->field_components[f], s->fields[f] };
    const tobi_vtk_surface out = { .vertex_count = s->vertex_count, .triangle_count = s->triangle_count,
                                   .vertices = (const double (*)[3])s->vertices,
                                   .triangles = (const int32_t (*)[3])s->triangles,
                                   .point_arrays = array, .point_array_count = n };
    return tobi_vtp_write(path, compression, &out, err);
}

static tobi_status write_stl(const char *path, const tobi_surface *s, tobi_error *err)
{
    return tobi_stl_write(path, s->vertex_count, (const double (*)[3])s->vertices, s->triangle_count,
                          (const int32_t (*)[3])s->triangles, err);
}

/* The values of a field of so many components by its name, or NULL. */
static const float *find_field(const tobi_surface *s, const char *name, int components)
{
    for (int f = 0; f < s->field_count; f++)
        if (s->field_components[f] == components && strcmp(s->field_names[f], name) == 0) return s->fields[f];
    return NULL;
}

const float *tobi_surface_colors(const tobi_surface *s) { return find_field(s, "color", 4); }

/* Colours behind the place, as Blender, MeshLab and others read them. */
static void print_obj_vertex(tobi_file *file, const tobi_surface *s, int64_t i)
{
    const double *v = s->vertices[i];
    const float *color = tobi_surface_colors(s);
    if (!color) tobi_file_print(file, "v %.9g %.9g %.9g\n", v[0], v[1], v[2]);
    else tobi_file_print(file, "v %.9g %.9g %.9g %.4f %.4f %.4f\n", v[0], v[1], v[2], (double)color[4*i],
                         (double)color[4*i + 1], (double)color[4*i + 2]);
}

static tobi_status write_obj(const char *path, const tobi_surface *s, tobi_error *err)
{
    const float *uv = find_field(s, "texture_coordinates", 2);
    tobi_file file;
    TOBI_TRY(tobi_file_open(&file, path, err));
    for (int64_t i = 0; i < s->vertex_count && !file.error; i++)
        print_obj_vertex(&file, s, i);
    for (int64_t i = 0; uv && i < s->vertex_count && !file.error; i++)
        tobi_file_print(&file, "vt %.6g %.6g\n", (double)uv[2*i], (double)uv[2*i + 1]);
    for (int64_t i = 0; i < s->vertex_count && !file.error; i++)
        tobi_file_print(&file, "vn %.4f %.4f %.4f\n", (double)s->normals[i][0], (double)s->normals[i][1],
                        (double)s->normals[i][2]);
    for (int64_t i = 0; i < s->triangle_count && !file.error; i++) {
        const int a = s->triangles[i][0] + 1, b = s->triangles[i][1] + 1, c = s->triangles[i][2] + 1;
        if (uv) tobi_file_print(&file, "f %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a, a, b, b, b, c, c, c);
        else tobi_file_print(&file, "f %d//%d %d//%d %d//%d\n", a, a, b, b, c, c);
    }
    return tobi_file_commit(&file, err);
}

/* Names of properties have no blanks. */
static void print_property(tobi_file *file, const char *name, int component, int components)
{
    char word[48];
    snprintf(word, sizeof word, "%s", name);
    for (char *c = word; *c; c++)
        if (*c <= ' ') *c = '_';
    if (components == 1) tobi_file_print(file, "property float %s\n", word);
    else tobi_file_print(file, "property float %s_%d\n", word, component);
}

static void print_ply_head(tobi_file *file, const tobi_surface *s)
{
    tobi_file_print(file, "ply\nformat binary_little_endian 1.0\nelement vertex %lld\n"
                    "property double x\nproperty double y\nproperty double z\n"
                    "property float nx\nproperty float ny\nproperty float nz\nproperty int group\n",
                    (long long)s->vertex_count);
    if (tobi_surface_colors(s))
        tobi_file_print(file, "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                        "property uchar alpha\n");
    for (int f = 0; f < s->field_count; f++)
        for (int c = 0; c < s->field_components[f] && s->fields[f] != tobi_surface_colors(s); c++)
            print_property(file, s->field_names[f], c, s->field_components[f]);
    tobi_file_print(file, "element face %lld\nproperty list uchar int vertex_indices\nend_header\n",
                    (long long)s->triangle_count);
}

static tobi_status write_ply(const char *path, const tobi_surface *s, tobi_error *err)
{
    const float *color = tobi_surface_colors(s);
    tobi_file file;
    TOBI_TRY(tobi_file_open(&file, path, err));
    print_ply_head(&file, s);
    for (int64_t i = 0; i < s->vertex_count && !file.error; i++) {
        tobi_file_write(&file, s->vertices[i], sizeof s->vertices[i]);
        tobi_file_write(&file, s->normals[i], sizeof s->normals[i]);
        tobi_file_write(&file, &s->group[i], sizeof s->group[i]);
        for (int k = 0; color && k < 4; k++)
            tobi_file_write(&file, &(uint8_t){ (uint8_t)lrintf(255*color[4*i + k]) }, 1);
        for (int f = 0; f < s->field_count; f++) {
            const size_t n = s->fields[f] == color ? 0 : (size_t)s->field_components[f];
            tobi_file_write(&file, s->fields[f] + (size_t)i*n, n*sizeof(float));
        }
    }
    for (int64_t i = 0; i < s->triangle_count && !file.error; i++) {
        tobi_file_write(&file, &(uint8_t){ 3 }, 1);
        tobi_file_write(&file, s->triangles[i], sizeof s->triangles[i]);
    }
    return tobi_file_commit(&file, err);
}

static tobi_status write_glb(const char *path, const tobi_surface *s, tobi_error *err)
{
    tobi_surface_movie *movie;
    TOBI_TRY(tobi_surface_movie_create(path, 1, (const double[3]){ 0, 0, 1 }, &movie, err));
    tobi_status status = tobi_surface_movie_add(movie, 0, s, -1, 0, 1, err);
    if (status == TOBI_OK) status = tobi_surface_movie_finish(movie, err);
    tobi_surface_movie_free(movie);
    return status;
}

tobi_status tobi_surface_write(const char *path, const tobi_surface *s, tobi_error *err)
{
    TOBI_NEED(path, "path");
    TOBI_NEED(s, "surface");
    const char *dot = strrchr(path, '.');
    if (dot && strcasecmp(dot, ".vtp") == 0) return tobi_surface_write_vtp(path, TOBI_COMPRESS_ZLIB, s, err);
    if (dot && strcasecmp(dot, ".ply") == 0) return write_ply(path, s, err);
    if (dot && strcasecmp(dot, ".obj") == 0) return write_obj(path, s, err);
    if (dot && strcasecmp(dot, ".stl") == 0) return write_stl(path, s, err);
    if (dot && strcasecmp(dot, ".glb") == 0) return write_glb(path, s, err);
    return tobi_fail(err, TOBI_INVALID, "%s: the name of a surface ends in .vtp, .ply, .obj, .stl or .glb",
                     path);
}
