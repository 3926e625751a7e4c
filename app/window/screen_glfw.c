/* A window of GLFW with one picture in it, drawn as a texture by OpenGL 1.1, which every driver has, the
   software renderer of Mesa too. Drawback: pixels cross the bus at each change, 3 MB at 1280 x 720. */
#include "screen.h"
#include "../tobiuo/language.h"
#include <GLFW/glfw3.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROOM = 256 };       /* events that wait */

struct screen {
    GLFWwindow *window;
    event waiting[ROOM];
    int first, count;
    double x, y;                /* of the last move: glfwGetCursorPos tells of those still to come too */
    GLuint texture;
};

static void push(GLFWwindow *window, event e)
{
    screen *s = glfwGetWindowUserPointer(window);
    if (s->count == ROOM) return;
    s->waiting[(s->first + s->count++)%ROOM] = e;
}

static void on_key(GLFWwindow *window, int key, int code, int action, int mods)
{
    static const struct { int glfw, key; } named[] = {
        { GLFW_KEY_LEFT, KEY_LEFT }, { GLFW_KEY_RIGHT, KEY_RIGHT }, { GLFW_KEY_UP, KEY_UP },
        { GLFW_KEY_DOWN, KEY_DOWN }, { GLFW_KEY_HOME, KEY_HOME }, { GLFW_KEY_END, KEY_END },
        { GLFW_KEY_ESCAPE, KEY_ESCAPE }, { GLFW_KEY_ENTER, KEY_ENTER }, { GLFW_KEY_KP_ENTER, KEY_ENTER },
        { GLFW_KEY_F1, KEY_F1 },
    };
    (void)code;
    if (action == GLFW_RELEASE) return;
    for (size_t k = 0; k < sizeof named/sizeof *named; k++)
        if (named[k].glfw == key)
            push(window, (event){ .kind = EVENT_KEY, .key = named[k].key, .shift = mods & GLFW_MOD_SHIFT });
}

static void on_letter(GLFWwindow *window, unsigned letter)
{
    if (letter < 128) push(window, (event){ .kind = EVENT_KEY, .key = (int)letter });
}

/* Positions are in units of the window; the picture has those of the framebuffer. */
static void to_pixels(GLFWwindow *window, double *x, double *y)
{
    int w, h, fw, fh;
    glfwGetWindowSize(window, &w, &h);
    glfwGetFramebufferSize(window, &fw, &fh);
    if (w > 0 && h > 0) *x *= (double)fw/w, *y *= (double)fh/h;
}

static void on_button(GLFWwindow *window, int button, int action, int mods)
{
    const screen *s = glfwGetWindowUserPointer(window);
    push(window, (event){ .kind = action == GLFW_PRESS ? EVENT_PRESS : EVENT_RELEASE, .x = s->x, .y = s->y,
                          .button = button != GLFW_MOUSE_BUTTON_LEFT, .shift = mods & GLFW_MOD_SHIFT });
}

static void on_move(GLFWwindow *window, double x, double y)
{
    screen *s = glfwGetWindowUserPointer(window);
    to_pixels(window, &x, &y);
    s->x = x;
    s->y = y;
    push(window, (event){ .kind = EVENT_MOVE, .x = x, .y = y });
}

static void on_scroll(GLFWwindow *window, double x, double y)
{
    (void)x;
    push(window, (event){ .kind = EVENT_SCROLL, .amount = y });
}

static void on_redraw(GLFWwindow *window) { push(window, (event){ .kind = EVENT_REDRAW }); }
static void on_size(GLFWwindow *window, int w, int h) { (void)w, (void)h, on_redraw(window); }
static void on_close(GLFWwindow *window) { push(window, (event){ .kind = EVENT_CLOSE }); }

static screen *fail(screen *s, char *why)
{
    const char *text = NULL;
    glfwGetError(&text);
    snprintf(why, 200, "%s", text ? text : tr("no reason is known"));
    why[strcspn(why, "\n")] = '\0';
    screen_close(s);
    return NULL;
}

screen *screen_open(int width, int height, const char *title, char *why)
{
    screen *s = calloc(1, sizeof *s);
    if (!s || !glfwInit()) return fail(s, why);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 1);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 1);
    s->window = glfwCreateWindow(width, height, title, NULL, NULL);
    if (!s->window) return fail(s, why);
    glfwSetWindowUserPointer(s->window, s);
    glfwSetKeyCallback(s->window, on_key);
    glfwSetCharCallback(s->window, on_letter);
    glfwSetMouseButtonCallback(s->window, on_button);
    glfwSetCursorPosCallback(s->window, on_move);
    glfwSetScrollCallback(s->window, on_scroll);
    glfwSetWindowRefreshCallback(s->window, on_redraw);
    glfwSetFramebufferSizeCallback(s->window, on_size);
    glfwSetWindowCloseCallback(s->window, on_close);
    glfwMakeContextCurrent(s->window);
    glfwSwapInterval(0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glGenTextures(1, &s->texture);
    glBindTexture(GL_TEXTURE_2D, s->texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    return s;
}

void screen_size(screen *s, int *width, int *height)
{
    glfwGetFramebufferSize(s->window, width, height);
    if (*width < 1) *width = 1;
    if (*height < 1) *height = 1;
}

event screen_next(screen *s, double seconds)
{
    if (s->count == 0) {
        if (seconds > 0) glfwWaitEventsTimeout(seconds);
        else glfwPollEvents();
    }
    if (s->count == 0) return (event){ .kind = EVENT_NONE };
    const event e = s->waiting[s->first];
    s->first = (s->first + 1)%ROOM;
    s->count--;
    return e;
}

void screen_show(screen *s, const uint8_t *rgb, int width, int height)
{
    int w, h;
    screen_size(s, &w, &h);
    glViewport(0, 0, w, h);
    glEnable(GL_TEXTURE_2D);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, width, height, 0, GL_RGB, GL_UNSIGNED_BYTE, rgb);
    glBegin(GL_TRIANGLE_STRIP);
    glTexCoord2f(0, 1), glVertex2f(-1, -1);
    glTexCoord2f(1, 1), glVertex2f(1, -1);
    glTexCoord2f(0, 0), glVertex2f(-1, 1);
    glTexCoord2f(1, 0), glVertex2f(1, 1);
    glEnd();
    glfwSwapBuffers(s->window);
}

void screen_wake(screen *s)
{
    (void)s;
    glfwPostEmptyEvent();
}

void screen_close(screen *s)
{
    if (s && s->window) glfwDestroyWindow(s->window);
    glfwTerminate();
    free(s);
}
