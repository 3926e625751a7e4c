/* What a terminal can show. Colours and bars go to terminals only, and to none where NO_COLOR is set or
   TERM is dumb; files and pipes get plain text. */
#include "app.h"
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

int has_colours(FILE *file)
{
    const char *none = getenv("NO_COLOR"), *term = getenv("TERM");
    if (none && *none) return 0;
    return isatty(fileno(file)) && term && strcmp(term, "dumb") != 0;
}

const char *colour(FILE *file, const char *code) { return has_colours(file) ? code : ""; }

int terminal_columns(FILE *file)
{
    struct winsize size;
    if (!isatty(fileno(file))) return 0;
    return ioctl(fileno(file), TIOCGWINSZ, &size) == 0 && size.ws_col ? size.ws_col : 80;
}
