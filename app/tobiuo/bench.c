/* tobiuo bench [CASE] */
#include "app.h"

int tobiuo_bench(int argc, char **argv)
{
    (void)argc;
    (void)argv;
    return complain("bench: not made yet");
}
