/* tobiuo info: what a report of a fault should begin with. */
#include "app.h"
#include "tobiuo/overlay.h"
#include <assimp/version.h>
#include <hdf5.h>
#include <jansson.h>
#include <luajit.h>
#include <lz4.h>
#include <png.h>
#include <stdio.h>
#include <jpeglib.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

static void print_processor(void)
{
    FILE *file = fopen("/proc/cpuinfo", "r");
    char line[256];
    while (file && fgets(line, sizeof line, file)) {
        const char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) != 0 || !colon) continue;
        printf("processor     %s", colon + 2);
        break;
    }
    if (file) fclose(file);
    printf("cores         %ld\n", sysconf(_SC_NPROCESSORS_ONLN));
    printf("memory        %.1f GB\n",
           (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE) * 1e-9);
}

static void print_instruction_sets(void)
{
#ifdef __x86_64__
    __builtin_cpu_init();
    printf("instructions  x86-64");
    if (__builtin_cpu_supports("sse4.2")) printf(" v2");
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2")) printf(" v3");
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq")) printf(" v4");
    putchar('\n');
#endif
}

static void print_libraries(void)
{
    unsigned major, minor, release;
    H5get_libversion(&major, &minor, &release);
    printf("libraries     HDF5 %u.%u.%u, assimp %u.%u.%u,", major, minor, release,
           aiGetVersionMajor(), aiGetVersionMinor(), aiGetVersionPatch());
    printf(" jansson %s, %s, zlib %s, LZ4 %s, libpng %s, libjpeg %d\n", jansson_version_str(),
           LUAJIT_VERSION, zlibVersion(), LZ4_versionString(), png_get_libpng_ver(NULL), JPEG_LIB_VERSION);
}

static void print_font(void)
{
    tobi_letters *letters = tobi_letters_open();
    printf("letters       %s\n", letters ? tobi_letters_font(letters) :
           "none: the system has no font, pictures have no text (Debian: fonts-dejavu-core)");
    tobi_letters_close(letters);
}

const struct argp info_argp = { .doc = "Version, machine, libraries, methods." };

int tobiuo_info(int argc, char **argv)
{
    parse_arguments(&info_argp, argc, argv, NULL);
    printf("tobiuo        %s\n", tobi_version());
#ifdef __clang__
    printf("compiler      clang %s\n", __clang_version__);
#else
    printf("compiler      gcc %s\n", __VERSION__);
#endif
    print_processor();
    print_instruction_sets();
    print_libraries();
    print_font();
    const char *method;
    printf("methods      ");
    for (int k = 0; (method = tobi_method_name(k)); k++) printf(" %s", method);
    putchar('\n');
    char *scenes = tobi_scene_shipped(".");
    printf("scenes        %s\n", scenes ? scenes : "not found");
    free(scenes);
    return 0;
}
