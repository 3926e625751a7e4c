#include "base/error.h"
#include <stdio.h>

tobi_status tobi_fail(tobi_error *err, tobi_status status, const char *format, ...)
{
    if (!err) return status;
    err->status = status;
    va_list args;
    va_start(args, format);
    vsnprintf(err->text, sizeof err->text, format, args);
    va_end(args);
    return status;
}
