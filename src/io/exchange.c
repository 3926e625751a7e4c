/* PLY and OBJ written directly: both are a header and numbers. Drawback: OBJ is text, three times the
   size of its numbers. */
#include "io/exchange.h"
#include "base/file.h"

tobi_status tobi_ply_write(const char *path, int64_t n, const double (*points)[3], tobi_error *err)
{
    tobi_file file;
    TOBI_TRY(tobi_file_open(&file, path, err));
    tobi_file_print(&file, "ply\nformat binary_little_endian 1.0\nelement vertex %lld\n"
                    "property float x\nproperty float y\nproperty float z\nend_header\n", (long long)n);
    for (int64_t i = 0; i < n && !file.error; i++) {
        float x[3] = { (float)points[i][0], (float)points[i][1], (float)points[i][2] };
        tobi_file_write(&file, x, sizeof x);
    }
    return tobi_file_commit(&file, err);
}

tobi_status tobi_obj_write(const char *path, int64_t vertex_count, const double (*vertices)[3],
                           int64_t triangle_count, const int32_t (*triangles)[3], tobi_error *err)
{
    tobi_file file;
    TOBI_TRY(tobi_file_open(&file, path, err));
    for (int64_t i = 0; i < vertex_count && !file.error; i++)
        tobi_file_print(&file, "v %.9g %.9g %.9g\n", vertices[i][0], vertices[i][1], vertices[i][2]);
    for (int64_t i = 0; i < triangle_count && !file.error; i++)
        tobi_file_print(&file, "f %d %d %d\n", triangles[i][0] + 1, triangles[i][1] + 1,
                        triangles[i][2] + 1);
    return tobi_file_commit(&file, err);
}
