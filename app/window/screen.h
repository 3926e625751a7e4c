/* A window of the system that shows pixels and tells what keys and mouse did. One at a time, used by the
   thread that opened it, except screen_wake. */
#pragma once
#include <stdint.h>

typedef struct screen screen;

typedef enum event_kind {
    EVENT_NONE, EVENT_KEY,          /* key: a letter as typed, or one of below                      */
    EVENT_PRESS, EVENT_RELEASE,     /* button 0 left, 1 other; x, y                                 */
    EVENT_MOVE, EVENT_SCROLL,       /* x, y; amount: steps of the wheel, away from the user > 0     */
    EVENT_REDRAW, EVENT_CLOSE       /* the size may have changed; the system's close button         */
} event_kind;
enum { KEY_LEFT = 256, KEY_RIGHT, KEY_UP, KEY_DOWN, KEY_HOME, KEY_END, KEY_ESCAPE, KEY_ENTER, KEY_F1 };
typedef struct event { event_kind kind; int key, button, shift; double x, y, amount; } event;

/* NULL, with a sentence in why[200], where there is no display, no OpenGL or no GLFW in this build. */
screen *screen_open(int width, int height, const char *title, char *why);
void screen_size(screen *s, int *width, int *height);       /* pixels, at least 1 */
/* The next event, waited for at most `seconds`; kind EVENT_NONE: nothing came. */
event screen_next(screen *s, double seconds);
void screen_show(screen *s, const uint8_t *rgb, int width, int height);
/* Ends a wait of screen_next; any thread may call it. */
void screen_wake(screen *s);
void screen_close(screen *s);
