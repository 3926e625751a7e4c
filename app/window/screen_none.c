/* In a build without GLFW there is no window, only the reason. Drawback: GLFW must be there when the
   program is built, not when it runs. */
#include "screen.h"
#include "../tobiuo/language.h"
#include <stdio.h>

screen *screen_open(int width, int height, const char *title, char *why)
{
    (void)width, (void)height, (void)title;
    snprintf(why, 200, "%s", tr("this build has none: install libglfw3-dev and build again"));
    return NULL;
}

void screen_size(screen *s, int *width, int *height) { (void)s, *width = *height = 1; }
event screen_next(screen *s, double seconds) { return (void)s, (void)seconds, (event){ .kind =
        EVENT_CLOSE }; }
void screen_show(screen *s, const uint8_t *rgb, int width, int height) { (void)s, (void)rgb, (void)width,
        (void)height; }
void screen_wake(screen *s) { (void)s; }
void screen_close(screen *s) { (void)s; }
