/* PNG files as textures: what is read has pixels everywhere, and a colour at any place. */
#include "target.h"
#include "tobiuo/picture.h"
#include <math.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const float places[][2] = { { 0, 0 }, { 0.5f, 1 }, { -3.25f, 1e9f }, { 1e-9f, -1 } };
    char path[64];
    snprintf(path, sizeof path, "fuzz_image_%d.png", (int)getpid());
    FILE *file = fopen(path, "wb");
    PROMISE(file && (size == 0 || fwrite(data, 1, size, file) == size));
    fclose(file);
    tobi_image *image;
    tobi_error err = { 0 };
    if (passed(tobi_image_read(path, &image, &err), &err)) {
        int width, height;
        const uint8_t *rgb;
        tobi_image_size(image, &width, &height, &rgb);
        PROMISE(width > 0 && height > 0 && rgb);
        for (size_t k = 0; k < sizeof places/sizeof *places; k++) {
            float color[3];
            tobi_image_color(image, places[k], color);
            for (int c = 0; c < 3; c++) PROMISE(color[c] >= 0 && color[c] <= 1);
        }
        tobi_image_free(image);
    }
    unlink(path);
    return 0;
}
