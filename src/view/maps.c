/* Colour maps by name, as steps of equal difference to the eye: viridis, magma and gray grow lighter,
   cividis looks the same to people who do not tell red from green, coolwarm (Moreland 2009) parts at its
   middle. The numbers are those of matplotlib. Drawback: sixteen steps, linear in between. */
#include "view/draw.h"
#include <string.h>

static const char *const names[] = { "viridis", "magma", "cividis", "coolwarm", "gray" };
enum { MAPS = sizeof names/sizeof *names, STEPS = 16 };

static const float map[MAPS][STEPS][3] = {
    { { 0.267f, 0.005f, 0.329f }, { 0.283f, 0.100f, 0.422f }, { 0.277f, 0.185f, 0.490f }, { 0.254f, 0.265f,
                                                                                            0.530f },
      { 0.222f, 0.339f, 0.549f }, { 0.191f, 0.407f, 0.556f }, { 0.164f, 0.471f, 0.558f }, { 0.139f, 0.534f,
                                                                                            0.555f },
      { 0.121f, 0.596f, 0.544f }, { 0.135f, 0.659f, 0.518f }, { 0.208f, 0.719f, 0.473f }, { 0.328f, 0.774f,
                                                                                            0.407f },
      { 0.478f, 0.821f, 0.318f }, { 0.647f, 0.858f, 0.210f }, { 0.825f, 0.885f, 0.106f }, { 0.993f, 0.906f,
                                                                                            0.144f } },
    { { 0.001f, 0.000f, 0.014f }, { 0.044f, 0.034f, 0.142f }, { 0.124f, 0.067f, 0.296f }, { 0.232f, 0.060f,
                                                                                            0.438f },
      { 0.341f, 0.081f, 0.493f }, { 0.445f, 0.123f, 0.507f }, { 0.550f, 0.161f, 0.506f }, { 0.658f, 0.196f,
                                                                                            0.490f },
      { 0.767f, 0.234f, 0.458f }, { 0.869f, 0.288f, 0.409f }, { 0.944f, 0.378f, 0.365f }, { 0.981f, 0.498f,
                                                                                            0.370f },
      { 0.995f, 0.624f, 0.427f }, { 0.997f, 0.748f, 0.517f }, { 0.993f, 0.870f, 0.626f }, { 0.987f, 0.991f,
                                                                                            0.750f } },
    { { 0.000f, 0.135f, 0.305f }, { 0.000f, 0.182f, 0.422f }, { 0.118f, 0.226f, 0.434f }, { 0.209f, 0.273f,
                                                                                            0.425f },
      { 0.279f, 0.319f, 0.423f }, { 0.342f, 0.365f, 0.429f }, { 0.401f, 0.412f, 0.441f }, { 0.458f, 0.460f,
                                                                                            0.460f },
      { 0.518f, 0.508f, 0.473f }, { 0.582f, 0.559f, 0.468f }, { 0.648f, 0.611f, 0.455f }, { 0.716f, 0.664f,
                                                                                            0.432f },
      { 0.786f, 0.720f, 0.400f }, { 0.858f, 0.779f, 0.353f }, { 0.932f, 0.840f, 0.286f }, { 0.996f, 0.909f,
                                                                                            0.218f } },
    { { 0.230f, 0.299f, 0.754f }, { 0.309f, 0.413f, 0.850f }, { 0.394f, 0.522f, 0.925f }, { 0.484f, 0.622f,
                                                                                            0.975f },
      { 0.576f, 0.709f, 0.998f }, { 0.667f, 0.779f, 0.993f }, { 0.754f, 0.830f, 0.961f }, { 0.831f, 0.860f,
                                                                                            0.903f },
      { 0.900f, 0.848f, 0.818f }, { 0.947f, 0.795f, 0.717f }, { 0.968f, 0.721f, 0.612f }, { 0.963f, 0.628f,
                                                                                            0.508f },
      { 0.932f, 0.519f, 0.406f }, { 0.877f, 0.395f, 0.312f }, { 0.801f, 0.251f, 0.226f }, { 0.706f, 0.016f,
                                                                                            0.150f } },
    { { 0.000f, 0.000f, 0.000f }, { 0.067f, 0.067f, 0.067f }, { 0.133f, 0.133f, 0.133f }, { 0.200f, 0.200f,
                                                                                            0.200f },
      { 0.267f, 0.267f, 0.267f }, { 0.333f, 0.333f, 0.333f }, { 0.400f, 0.400f, 0.400f }, { 0.467f, 0.467f,
                                                                                            0.467f },
      { 0.533f, 0.533f, 0.533f }, { 0.600f, 0.600f, 0.600f }, { 0.667f, 0.667f, 0.667f }, { 0.733f, 0.733f,
                                                                                            0.733f },
      { 0.800f, 0.800f, 0.800f }, { 0.867f, 0.867f, 0.867f }, { 0.933f, 0.933f, 0.933f }, { 1.000f, 1.000f,
                                                                                            1.000f } },
};

const float (*tobi_color_map(const char *name, int *count))[3]
{
    for (int k = 0; name && k < MAPS; k++)
        if (strcmp(name, names[k]) == 0) {
            *count = STEPS;
            return map[k];
        }
    *count = 0;
    return NULL;
}

const char *tobi_color_map_name(int number) { return number >= 0 && number < MAPS ? names[number] : NULL; }
