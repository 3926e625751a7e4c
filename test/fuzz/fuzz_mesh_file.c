/* Mesh files through the importer's child process; the content decides the format's name. Slow under
   libFuzzer (a process per input), so its corpus is written by hand. */
#include "target.h"
#include "geom/texture.h"

static const char *choose_format(const uint8_t *data, size_t size)
{
    if (size >= 3 && memcmp(data, "ply", 3) == 0) return "ply";
    return (size >= 5 && memcmp(data, "solid", 5) == 0) || (size && memchr(data, 0, size)) ? "stl" : "obj";
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[64];
    snprintf(path, sizeof path, "fuzz_mesh_%d.%s", (int)getpid(), choose_format(data, size));
    FILE *file = fopen(path, "wb");
    PROMISE(file && (size == 0 || fwrite(data, 1, size, file) == size));
    fclose(file);
    tobi_mesh mesh;
    tobi_error err = { 0 };
    if (passed(tobi_mesh_read(path, &mesh, &err), &err)) {
        PROMISE(mesh.vertex_count > 0 && mesh.triangle_count > 0);
        tobi_skin skin;
        if (passed(tobi_mesh_orient(&mesh, path, &err), &err) && mesh.texture &&
            passed(tobi_texture_prepare(mesh.texture, &err), &err) &&
            passed(tobi_skin_build(&mesh, &skin, &err), &err)) {
            PROMISE(skin.vertex_count > 0 && skin.vertex_count <= 3*mesh.triangle_count);
            tobi_skin_free(&skin);
        }
        tobi_mesh_free(&mesh);
    }
    unlink(path);
    return 0;
}
