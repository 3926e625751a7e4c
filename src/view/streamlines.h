/* Streamlines of the velocity of a moment. */
#pragma once
#include "view/draw.h"

/* Lines as points, in the direction of the flow; line n has those from first[n] to first[n + 1]. */
typedef struct stream_lines {
    double (*point)[3];          /* m */
    int64_t count;
    int64_t *first;
    int lines;
} stream_lines;

/* So many side by side along the longest edge as f->streamlines says, by f->flow. False: no memory. */
bool view_trace_streamlines(const tobi_picture *f, stream_lines *out);
void view_free_streamlines(stream_lines *lines);
/* Traces and draws them. False: no memory. */
bool view_draw_streamlines(canvas *c, const tobi_picture *f);
