/* Mass properties. Sums run relative to the middle of the mesh's box, so that a body far from the
   origin loses no digits. */
#include "geom/massprops.h"
#include "geom/lines.h"
#include "geom/section.h"
#include "geom/vec3.h"
#include <string.h>

/* Lines across the longest side, where parts overlap; no whole number, so that they seldom run within the
   faces of boxes. */
#define LINES 1000.37

/* Adds what the winding number says wrongly where parts of the surface overlap: the integral of
   (1 if inside, else 0) - winding number, exact along lines, by the middle rule across them. */
static tobi_status correct_overlaps(const tobi_mesh *mesh, const tobi_section *section,
                                    const double origin[3], double *volume, double first[3],
                                    double second[3][3], tobi_error *err)
{
    double min[3], max[3], size = 0;
    tobi_lines l = {0};
    if (!mesh->overlapping) return TOBI_OK;
    tobi_mesh_box(mesh, min, max);
    for (int k = 0; k < 3; k++) size = fmax(size, max[k] - min[k]);
    tobi_status status = tobi_lines_cut(&l, mesh, section, size/LINES, err);
    int along = section ? 1 : 2;
    double width = section ? l.fine : l.fine*l.fine, x[3] = {0};
    for (int64_t i = 0; status == TOBI_OK && i < l.size[0]; i++)
        for (int64_t j = 0; j < l.size[1]; j++) {
            int64_t line = i*l.size[1] + j;
            int wound = 0;
            x[0] = (double)(i + l.low[0])*l.fine + l.middle[0] - origin[0];
            if (!section) x[1] = (double)(j + l.low[1])*l.fine + l.middle[1] - origin[1];
            for (int64_t c = l.start[line]; c + 1 < l.start[line + 1]; c++) {
                wound += l.cuts[c].turn;
                double shift = l.middle[along] - origin[along];
                double p = l.cuts[c].at + shift, q = l.cuts[c + 1].at + shift;
                double part = ((wound > 0) - wound)*(q - p)*width;
                if (part == 0) continue;
                x[along] = 0.5*(p + q);
                *volume += part;
                for (int a = 0; a <= along; a++) {
                    first[a] += part*x[a];
                    for (int b = a; b <= along; b++) second[a][b] += part*x[a]*x[b];
                }
                second[along][along] += part*(q - p)*(q - p)/12;
            }
        }
    tobi_lines_free(&l);
    return status;
}

tobi_status tobi_massprops_volume(const tobi_mesh *mesh, tobi_massprops *out, tobi_error *err)
{
    double min[3], max[3], origin[3], first[3] = {0}, second[3][3] = {{0}}, volume = 0, area = 0;
    memset(out, 0, sizeof *out);
    tobi_mesh_box(mesh, min, max);
    for (int k = 0; k < 3; k++) origin[k] = 0.5*(min[k] + max[k]);

    for (int64_t t = 0; t < mesh->triangle_count; t++) {
        double e[3][3], n[3], ab[3], ac[3], sum[3];
        for (int c = 0; c < 3; c++) vec3_sub(e[c], mesh->vertices[mesh->triangles[t][c]], origin);
        vec3_sub(ab, e[1], e[0]);
        vec3_sub(ac, e[2], e[0]);
        vec3_cross(n, ab, ac);
        area += 0.5*vec3_length(n);
        /* six times the signed volume of the tetrahedron (origin, a, b, c) */
        double det = vec3_dot(e[0], n);
        volume += det/6;
        for (int i = 0; i < 3; i++) {
            sum[i] = e[0][i] + e[1][i] + e[2][i];
            first[i] += det*sum[i]/24;
        }
        /* integral of x_i x_j over the tetrahedron = det/120 (sum_i sum_j + a_i a_j + b_i b_j + c_i c_j) */
        for (int i = 0; i < 3; i++)
            for (int j = i; j < 3; j++)
                second[i][j] += det/120*(sum[i]*sum[j] + e[0][i]*e[0][j] + e[1][i]*e[1][j] +
                                         e[2][i]*e[2][j]);
    }
    TOBI_TRY(correct_overlaps(mesh, NULL, origin, &volume, first, second, err));
    if (!(volume > 0))
        return tobi_fail(err, TOBI_INVALID, "the mesh encloses a volume of %g m3; it must be closed and "
                         "oriented outwards", volume);
    double c[3], m[3][3];
    for (int i = 0; i < 3; i++) c[i] = first[i]/volume;
    for (int i = 0; i < 3; i++)
        for (int j = i; j < 3; j++) m[i][j] = m[j][i] = second[i][j] - volume*c[i]*c[j];
    double trace = m[0][0] + m[1][1] + m[2][2];
    for (int i = 0; i < 3; i++) {
        out->centre[i] = origin[i] + c[i];
        for (int j = 0; j < 3; j++) out->inertia[3*i + j] = (i == j ? trace : 0) - m[i][j];
    }
    out->volume = volume;
    out->area = area;
    return TOBI_OK;
}

tobi_status tobi_massprops_section(const tobi_mesh *mesh, tobi_massprops *out, tobi_error *err)
{
    tobi_section s;
    double area = 0, first[3] = {0}, second[3][3] = {{0}}, length = 0;
    memset(out, 0, sizeof *out);
    TOBI_TRY(tobi_section_cut(mesh, &s, err));
    const double origin[3] = {s.from[0][0], s.from[0][1], 0};
    for (int64_t i = 0; i < s.count; i++) {
        double a[2] = {s.from[i][0] - origin[0], s.from[i][1] - origin[1]};
        double b[2] = {s.to[i][0] - origin[0], s.to[i][1] - origin[1]};
        double det = a[0]*b[1] - a[1]*b[0];
        area += det/2;
        for (int k = 0; k < 2; k++) {
            first[k] += det*(a[k] + b[k])/6;
            for (int j = 0; j < 2; j++)
                second[k][j] += det*(2*a[k]*a[j] + a[k]*b[j] + b[k]*a[j] + 2*b[k]*b[j])/24;
        }
        length += hypot(b[0] - a[0], b[1] - a[1]);
    }
    tobi_status status = correct_overlaps(mesh, &s, origin, &area, first, second, err);
    tobi_section_free(&s);
    TOBI_TRY(status);
    second[1][0] = second[0][1];
    if (!(area > 0))
        return tobi_fail(err, TOBI_INVALID, "the section of the mesh with z = 0 has an area of %g m2; it "
                         "must be closed and oriented outwards", area);
    out->volume = area;
    out->area = length;
    for (int k = 0; k < 2; k++) {
        out->centre[k] = origin[k] + first[k]/area;
        for (int j = 0; j < 2; j++) second[k][j] -= first[k]*first[j]/area;
    }
    out->inertia[0] = second[1][1];
    out->inertia[4] = second[0][0];
    out->inertia[1] = out->inertia[3] = -second[0][1];
    out->inertia[8] = second[0][0] + second[1][1];
    return TOBI_OK;
}
